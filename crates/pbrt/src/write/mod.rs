//! A [`SceneDesc`] written as pbrt-v4 text, and the files that the text names.
//!
//! [`export`] writes what an importer reads back as the same scene: all that is rendered, with
//! numbers as the shortest decimals that are read as the same floats. What a program may put into a
//! description and the format cannot express is an [`ExportError`]. The same description gives the
//! same bytes.

mod camera;
mod files;
mod lights;
mod materials;
mod media;
mod names;
mod number;
mod settings;
mod shapes;
mod statement;
mod text;
mod textures;
mod world;

use std::collections::BTreeSet;
use std::{fmt, io};

use description::SceneDesc;

pub use camera::export_camera;

use files::Files;
use names::Names;
use number::decimal;
use text::Text;
use world::World;

/// A scene as text.
#[derive(Clone, Debug, PartialEq)]
pub struct Exported {
    /// The text of the scene's file.
    pub text: String,
    /// What of it pbrt-v4 itself does not know, as in `material openpbr`: sorted, each once.
    pub extensions: Vec<String>,
}

/// Why a scene could not be written.
#[derive(Debug)]
pub enum ExportError {
    /// The format cannot express it.
    Unsupported(String),
    /// A file of this name could not be written.
    File(String, io::Error),
}

impl fmt::Display for ExportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unsupported(problem) => write!(f, "pbrt-v4 cannot express the scene: {problem}"),
            Self::File(name, error) => write!(f, "cannot write {name}: {error}"),
        }
    }
}

impl std::error::Error for ExportError {}

/// Writes a scene.
///
/// Meshes, images and tables go to `sink`, each with its name in `folder`, which is the path from
/// the scene's file to where they will be. The text is complete when all of them are written.
///
/// ```
/// use alhazen_pbrt::export;
/// use description::{SceneDesc, ShapeDesc, ShapeKind};
///
/// let mut desc = SceneDesc::default();
/// let sphere = ShapeKind::Sphere { radius: 0.5, z_min: -0.5, z_max: 0.5, phi_max: 360.0 };
/// desc.shapes.push(ShapeDesc::from(sphere));
/// let exported = export(&desc, "files", &mut |_, _| Ok(())).expect("nothing in it is unusual");
/// assert!(exported.text.contains(r#"Shape "sphere" "float radius" 0.5"#));
/// ```
pub fn export(
    desc: &SceneDesc,
    folder: &str,
    sink: &mut dyn FnMut(&str, &[u8]) -> io::Result<()>,
) -> Result<Exported, ExportError> {
    let names = Names::new(desc);
    let mut files = Files::new(folder, sink);
    let mut text = Text::new();
    let mut extensions = BTreeSet::new();
    settings::options(desc, &mut text, &mut extensions);
    match camera::times(desc) {
        Ok([0.0, 1.0]) => (),
        Ok(times) => text.line(&format!("TransformTimes {}", times.map(decimal).join(" "))),
        Err(problem) => text.fail(problem),
    }
    camera::film(desc, &mut text, &mut extensions);
    settings::member("PixelFilter", &desc.filter.value, &mut text, &mut extensions);
    settings::member("Sampler", &desc.sampler.value, &mut text, &mut extensions);
    settings::member("Integrator", &desc.integrator.value, &mut text, &mut extensions);
    settings::member("Accelerator", &desc.accelerator.value, &mut text, &mut extensions);
    camera::camera(desc, &names, &mut files, &mut text, &mut extensions);
    text.paragraph();
    text.line("WorldBegin");
    text.paragraph();
    textures::textures(desc, &names, &mut files, &mut text, &mut extensions);
    text.paragraph();
    media::media(desc, &names, &mut files, &mut text);
    text.paragraph();
    materials::materials(desc, &names, &mut files, &mut text, &mut extensions);
    text.paragraph();
    lights::lights(desc, &names, &mut files, &mut text, &mut extensions);
    text.paragraph();
    World { desc, names: &names, files: &mut files, text: &mut text, extensions: &mut extensions }.write();
    files.finish().map_err(|(name, error)| ExportError::File(name, error))?;
    let text = text.finish().map_err(ExportError::Unsupported)?;
    Ok(Exported { text, extensions: extensions.into_iter().collect() })
}
