//! What is drawn of a file that has several scenes, cameras, variants and times: the text after `#`
//! of its path, such as `walk.glb#time=0.5,camera=1`.

use std::path::{Path, PathBuf};

use description::{SceneDesc, SourceMap};

use crate::log::{Fault, Log, Result};
use assets::AssetSource;
use assets::number;
use description::Imported;

/// A choice by its name or its number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Choice(pub String);

impl Choice {
    /// The index of the chosen one of some names.
    pub fn index(&self, what: &str, names: &[&str]) -> Result<usize> {
        let named = names.iter().position(|name| *name == self.0);
        let numbered = || self.0.parse().ok().filter(|&index: &usize| index < names.len());
        named.or_else(numbered).ok_or_else(|| {
            let message =
                format!("there is no {what} `{}`; there are {}: {}", self.0, names.len(), names.join(", "));
            Fault::new("unknown-choice", "", message)
        })
    }
}

/// What is drawn of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Selection {
    pub scene: Option<usize>,
    pub camera: Option<Choice>,
    pub variant: Option<Choice>,
    pub animation: Option<Choice>,
    /// Seconds from the start of the animation; without it nodes rest as they are described.
    pub time: Option<f64>,
    /// Seconds that the shutter is open.
    pub shutter: f64,
}

impl Selection {
    /// The path of the file, and what is drawn of it.
    pub fn of(path: &Path, assets: &dyn AssetSource) -> (PathBuf, Result<Self>) {
        let name = path.to_string_lossy();
        match name.rsplit_once('#') {
            Some((file, text)) if !assets.exists(path) => (PathBuf::from(file), Self::parse(text)),
            _ => (path.to_owned(), Ok(Self::default())),
        }
    }

    /// The extension of the file of a path, in lower case; empty without one.
    pub fn extension(path: &Path, assets: &dyn AssetSource) -> String {
        let (file, _) = Self::of(path, assets);
        file.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
    }

    fn parse(text: &str) -> Result<Self> {
        let mut selection = Self::default();
        for part in text.split(',') {
            let unknown = || {
                let message = format!(
                    "after `#` are settings such as `time=0.5,camera=1`, not `{part}`; there are `animation`, `camera`, `scene`, `shutter`, `time` and `variant`"
                );
                Fault::new("unknown-choice", "", message)
            };
            let (key, value) = part.split_once('=').ok_or_else(unknown)?;
            let seconds = || {
                number::float(value.as_bytes())
                    .map(f64::from)
                    .filter(|seconds| seconds.is_finite() && *seconds >= 0.0)
                    .ok_or_else(|| {
                        Fault::new("unknown-choice", "", format!("`{value}` is not a number of seconds"))
                    })
            };
            let choice = Some(Choice(value.to_owned()));
            match key {
                "animation" => selection.animation = choice,
                "camera" => selection.camera = choice,
                "variant" => selection.variant = choice,
                "scene" => selection.scene = Some(value.parse().map_err(|_| unknown())?),
                "time" => selection.time = Some(seconds()?),
                "shutter" => selection.shutter = seconds()?,
                _ => return Err(unknown()),
            }
        }
        if selection.animation.is_some() || selection.shutter > 0.0 {
            selection.time.get_or_insert(0.0);
        }
        Ok(selection)
    }
}

/// Reads a file as a scene: `fill` makes of its path and bytes what is selected. What went wrong is
/// in the messages, and what was read before is in the scene.
pub(crate) fn read(
    path: &Path,
    assets: &dyn AssetSource,
    fill: impl FnOnce(&mut SceneDesc, (&Path, Vec<u8>), &Selection, &mut Log) -> Result<()>,
) -> Imported {
    let (mut desc, mut log) = (SceneDesc::default(), Log::default());
    let (file, selection) = Selection::of(path, assets);
    let filled = selection.and_then(|selection| {
        let bytes = assets.read(&file).map_err(|error| {
            Fault::new("unreadable-file", "", format!("cannot read `{}`: {error}", file.display()))
        })?;
        fill(&mut desc, (&file, bytes), &selection, &mut log)
    });
    log.keep(filled);
    Imported { desc, sources: SourceMap::default(), diagnostics: log.finish() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use assets::MemoryAssets;

    #[test]
    fn a_fragment_selects() {
        let assets = MemoryAssets::default().with("a#time=1.glb", "").with("b.glb", "");
        let of = |name: &str| Selection::of(Path::new(name), &assets);
        assert_eq!(of("a#time=1.glb"), ("a#time=1.glb".into(), Ok(Selection::default())));
        let (path, selection) = of("b.glb#time=0.5,shutter=0.02,variant=red");
        assert_eq!(path, Path::new("b.glb"));
        let expected = Selection {
            time: Some(0.5),
            shutter: f64::from(0.02_f32),
            variant: Some(Choice("red".into())),
            ..Selection::default()
        };
        assert_eq!(selection, Ok(expected));
        for wrong in ["b.glb#", "b.glb#speed=1", "b.glb#time=-1", "b.glb#scene=a"] {
            assert_eq!(of(wrong).1.unwrap_err().code, "unknown-choice", "{wrong}");
        }
        assert_eq!(Choice("red".into()).index("variant", &["blue", "red"]), Ok(1));
        assert_eq!(Choice("0".into()).index("variant", &["blue", "red"]), Ok(0));
        assert!(Choice("2".into()).index("variant", &["blue", "red"]).is_err());
    }
}
