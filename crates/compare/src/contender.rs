//! The contenders of a comparison: integrators with settings of their own.

use std::fmt;
use std::str::FromStr;

use alhazen::Overrides;
use alhazen::description::schema::Settings;
use alhazen::description::{OptionsDesc, SceneDesc};

/// An integrator with settings of its own, written `NAME` or `NAME:KEY=VALUE:KEY=VALUE`, as in
/// `path:maxdepth=8`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Contender {
    integrator: String,
    settings: Vec<(String, String)>,
}

impl Contender {
    /// The overrides of this contender: the `shared` ones, without settings that its integrator
    /// does not have, then its own settings.
    pub(super) fn overrides(&self, scene: &SceneDesc, shared: &Overrides) -> Overrides {
        let mut overrides = shared.with_integrator(&self.integrator, scene);
        overrides.settings.extend_from_slice(&self.settings);
        overrides
    }

    /// The description that this contender renders, with its [`overrides`](Self::overrides)
    /// applied. Its own settings may concern integrator, sampler and what runs them only, as all
    /// contenders share one scene and film.
    pub(super) fn scene(&self, scene: &SceneDesc, overrides: &Overrides) -> Result<SceneDesc, String> {
        let error = |problem: &dyn fmt::Display| format!("{self}: {problem}");
        let with_settings = |settings: &[(String, String)]| {
            let mut desc = scene.clone();
            desc.integrator.remove_extra_outputs();
            let overrides = Overrides { settings: settings.to_vec(), ..overrides.clone() };
            overrides.apply(&mut desc).map(|()| desc).map_err(|problem| error(&problem))
        };
        let mut desc = with_settings(&overrides.settings)?;
        if desc.integrator.remove_extra_outputs() {
            return Err(error(&"a comparison writes no files but its report"));
        }
        if !self.settings.is_empty() {
            let mut shared =
                with_settings(&overrides.settings[..overrides.settings.len() - self.settings.len()])?;
            let OptionsDesc { engine, schedule, .. } = desc.options.value;
            (shared.options.engine, shared.options.schedule) = (engine, schedule);
            let differs = desc.options.value != shared.options.value
                || desc.film.value != shared.film.value
                || desc.filter.value != shared.filter.value
                || desc.accelerator.value != shared.accelerator.value;
            if differs {
                return Err(error(
                    &"scene and film are shared by all; only settings of integrator and sampler, `engine` and \
                      `schedule` may differ",
                ));
            }
        }
        Ok(desc)
    }

    /// Its name in a report: the integrator of its `desc`, with its own settings.
    pub(super) fn title(&self, desc: &SceneDesc) -> String {
        let settings = self.settings.iter().map(|(key, value)| format!(":{key}={value}"));
        settings.fold(desc.integrator.name().to_owned(), |title, setting| title + &setting)
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
            _ => Err("expected NAME or NAME:KEY=VALUE, as in path:maxdepth=8".into()),
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
    use alhazen::description::{IntegratorDesc, PathDesc, VcmDesc};

    fn scene(text: &str) -> Result<SceneDesc, String> {
        let contender: Contender = text.parse()?;
        with(&contender, &[])
    }

    fn with(contender: &Contender, shared: &[(&str, &str)]) -> Result<SceneDesc, String> {
        let desc = SceneDesc::default();
        let settings = shared.iter().map(|&(name, value)| (name.into(), value.into())).collect();
        let overrides = contender.overrides(&desc, &Overrides { settings, ..Overrides::default() });
        contender.scene(&desc, &overrides)
    }

    #[test]
    fn shared_settings_apply_to_integrators_that_have_them() {
        let shared = [("radius", "3"), ("maxdepth", "2"), ("alpha", "0.5")];
        let [path, vcm] =
            ["path", "vcm:alpha=0.75"].map(|name| with(&name.parse().unwrap(), &shared).unwrap());
        assert!(matches!(path.integrator.value, IntegratorDesc::Path(PathDesc { max_depth: 2, .. })));
        let expected = VcmDesc { max_depth: 2, radius: Some(3.0), alpha: 0.75 };
        assert_eq!(vcm.integrator.value, IntegratorDesc::Vcm(expected));
    }

    #[test]
    fn extra_outputs_are_refused() {
        for wrong in ["radiosity:mesh-out=a.ply", "bdpt:techniques=true"] {
            assert_eq!(
                scene(wrong).unwrap_err(),
                format!("{wrong}: a comparison writes no files but its report")
            );
        }
        assert!(scene("bdpt:techniques=false").is_ok());
    }

    #[test]
    fn names_and_settings_are_parsed() {
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
    fn errors_name_the_contender() {
        assert_eq!(scene("paht").unwrap_err(), "paht: no integrator is called `paht`; did you mean `path`?");
        assert!(
            scene("path:maxdepth=deep").unwrap_err().starts_with("path:maxdepth=deep: cannot set maxdepth")
        );
        assert!(
            scene("path:filter=box").unwrap_err().starts_with("path:filter=box: scene and film are shared")
        );
        for right in ["path:sampler=halton", "path:schedule=wavefront", "path:engine=scalar"] {
            assert!(scene(right).is_ok(), "{right}");
        }
    }
}
