//! What takes part in a comparison: an integrator with settings of its own.

use std::fmt;
use std::str::FromStr;

use description::SceneDesc;

use crate::{OverrideError, Overrides, integrator_name};

/// An integrator with settings of its own, written `NAME` or `NAME:KEY=VALUE:KEY=VALUE`, as in `path:maxdepth=8`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Contender {
    integrator: String,
    settings: Vec<(String, String)>,
}

impl Contender {
    /// The scene as this contender renders it: changed by `overrides`, then by its own settings. These may concern the
    /// algorithm and its sampler only, as all contenders render one scene onto one kind of film.
    pub(super) fn scene(&self, scene: &SceneDesc, overrides: &Overrides) -> Result<SceneDesc, OverrideError> {
        let changed = |settings: &[(String, String)]| {
            let mut desc = scene.clone();
            let mut overrides = Overrides { integrator: Some(self.integrator.clone()), ..overrides.clone() };
            overrides.settings.extend_from_slice(settings);
            overrides
                .apply(&mut desc)
                .map(|()| desc)
                .map_err(|error| OverrideError::new(format!("{self}: {error}")))
        };
        let desc = changed(&self.settings)?;
        if !self.settings.is_empty() {
            let shared = changed(&[])?;
            let own = desc.options.value != shared.options.value
                || desc.film.value != shared.film.value
                || desc.filter.value != shared.filter.value
                || desc.accelerator.value != shared.accelerator.value;
            if own {
                return Err(OverrideError::new(format!(
                    "{self}: scene and film are the same for all; of its own an integrator has its settings and a sampler"
                )));
            }
        }
        Ok(desc)
    }

    /// What it is called in a report, once its scene is known to make sense.
    pub(super) fn title(&self, desc: &SceneDesc) -> String {
        let settings = self.settings.iter().map(|(key, value)| format!(":{key}={value}"));
        settings.fold(integrator_name(&desc.integrator).to_owned(), |title, setting| title + &setting)
    }
}

impl FromStr for Contender {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut parts = text.trim().split(':');
        let integrator = parts.next().unwrap_or_default().trim().to_owned();
        let settings = parts.map(|part| {
            let (key, value) = part.split_once('=')?;
            Some((key.trim().to_owned(), value.trim().to_owned()))
        });
        match settings.collect() {
            Some(settings) if !integrator.is_empty() => Ok(Self { integrator, settings }),
            _ => Err("it is written NAME or NAME:KEY=VALUE, as in path:maxdepth=8".into()),
        }
    }
}

impl fmt::Display for Contender {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.integrator)?;
        self.settings.iter().try_for_each(|(key, value)| write!(f, ":{key}={value}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(text: &str) -> Result<SceneDesc, String> {
        let contender: Contender = text.parse()?;
        contender.scene(&SceneDesc::default(), &Overrides::default()).map_err(|error| error.to_string())
    }

    #[test]
    fn names_and_settings_are_read() {
        let contender: Contender = " path:maxdepth=8: lightsampler = power".parse().unwrap();
        assert_eq!(contender.to_string(), "path:maxdepth=8:lightsampler=power");
        let desc = scene("simplepath:maxdepth=2").unwrap();
        assert_eq!(
            "simplepath:maxdepth=2".parse::<Contender>().unwrap().title(&desc),
            "simple-path:maxdepth=2"
        );
        for wrong in ["", ":maxdepth=8", "path:maxdepth"] {
            assert!(wrong.parse::<Contender>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn what_makes_no_sense_is_told_with_who_said_it() {
        assert_eq!(scene("paht").unwrap_err(), "paht: no integrator is called `paht`; did you mean `path`?");
        assert!(
            scene("path:maxdepth=deep").unwrap_err().starts_with("path:maxdepth=deep: cannot set maxdepth")
        );
        assert!(
            scene("path:filter=box").unwrap_err().starts_with("path:filter=box: scene and film are the same")
        );
        assert!(scene("path:sampler=halton").is_ok());
    }
}
