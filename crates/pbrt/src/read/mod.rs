//! The reader, in two steps: the [`interpreter`] runs the directives of all files and collects
//! statements, each with its graphics state; then [`build`] turns statements into descriptions and
//! resolves names. Names may therefore be used before their definition (except for textures in
//! textures).

mod build;
mod builder;
mod declarations;
mod foreign;
mod interpreter;
mod names;
mod parameter;
mod search;
mod state;
mod statement;
mod token;
mod transform;

use std::path::Path;

pub use builder::{Argument, ArgumentValues, Motion, Placement, SceneBuilder};

use assets::AssetSource;
use description::Imported;

/// Reads a scene.
pub fn read(path: impl AsRef<Path>, assets: &dyn AssetSource) -> Imported {
    let path = path.as_ref();
    let assets = &search::SceneFiles::new(assets, path);
    let mut interpreter = interpreter::Interpreter::new(assets);
    interpreter.run(path);
    let (report, sources, statements) = (interpreter.report, interpreter.sources, interpreter.statements);
    let (desc, report) = build::build(statements, report, &sources, assets);
    Imported { desc, sources, diagnostics: report.finish() }
}
