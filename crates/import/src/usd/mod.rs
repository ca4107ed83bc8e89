//! USD: scenes of layers as texts (`.usda`), in binary (`.usdc`) or packed (`.usdz`).
//!
//! The crate `openusd` parses layers and composes them to one stage: sublayers, references,
//! payloads, variants, and values at a time. What prims mean is read here: `stage` has prims and
//! their values, a file each reads one noun of the schemas, and `scene` puts all together. Every
//! fault names its place as the path of a prim and the name of a property.

mod binary;
mod camera;
mod curves;
mod files;
mod instancer;
mod layer;
mod light;
mod material;
mod mesh;
mod pictures;
mod primvar;
mod scene;
mod solid;
mod stage;
mod subdivision;
mod texture;
mod topology;
mod value;
mod xform;

use std::path::Path;

use description::SceneDesc;

use crate::log::{Fault, Log, Result};
use crate::selection::{self, Selection};
use crate::studio;
use assets::AssetSource;
use description::Imported;
use files::{Files, Resolver};
use material::Materials;
use scene::Assembly;
use stage::{INVALID, Stage};

/// The stack of the thread that reads, which goes down the prims of a scene.
const STACK: usize = 256 << 20;

/// Whether a path names a file of this format, by its extension.
pub(crate) fn is_named_by(path: &Path, assets: &dyn AssetSource) -> bool {
    matches!(Selection::extension(path, assets).as_str(), "usd" | "usda" | "usdc" | "usdz")
}

/// Reads a file as a scene.
pub(crate) fn read(path: &Path, assets: &dyn AssetSource) -> Imported {
    selection::read(path, assets, |desc, (path, _), selection, log| {
        guarded(desc, path, selection, assets, log)
    })
}

/// Reads in a thread of its own, for a stack that is large enough, while this one answers for its
/// files. A panic of `openusd` over a damaged file ends that thread only, and is a fault.
fn guarded(
    desc: &mut SceneDesc,
    path: &Path,
    selection: &Selection,
    assets: &dyn AssetSource,
    log: &mut Log,
) -> Result<()> {
    let files = Files::new(assets);
    let (resolver, questions) = Resolver::new();
    std::thread::scope(|scope| {
        let reader = std::thread::Builder::new().name("usd".to_owned()).stack_size(STACK);
        let reader = reader.spawn_scoped(scope, || fill(desc, path, selection, &files, resolver, log));
        let reader = reader
            .map_err(|error| Fault::new("unreadable-file", "", format!("cannot start a thread: {error}")))?;
        files.answer(&questions);
        reader
            .join()
            .unwrap_or_else(|_| Err(Fault::new(INVALID, "", "the file is damaged so that it cannot be read")))
    })
}

fn fill(
    desc: &mut SceneDesc,
    path: &Path,
    selection: &Selection,
    files: &Files,
    resolver: Resolver,
    log: &mut Log,
) -> Result<()> {
    for (name, is_given) in [
        ("animation", selection.animation.is_some()),
        ("scene", selection.scene.is_some()),
        ("variant", selection.variant.is_some()),
    ] {
        if is_given {
            let message =
                format!("a USD file has no choice of `{name}`; there are `camera`, `shutter` and `time`");
            return Err(Fault::new("unknown-choice", "", message));
        }
    }
    let stage = match Stage::open(&path.to_string_lossy(), resolver, selection.time, selection.shutter) {
        Ok(stage) => stage,
        Err(fault) => {
            let faults = files.text_faults();
            let faults = if faults.is_empty() { vec![fault] } else { faults };
            faults.into_iter().for_each(|fault| log.fault(fault));
            return Ok(());
        }
    };
    let mut assembly = Assembly::new(desc, log, Materials::new(files));
    let bounds = assembly.add_all(&stage)?;
    let (views, lamps) = (std::mem::take(&mut assembly.views), std::mem::take(&mut assembly.lamps));
    let (faults, left_out) = stage.composition();
    left_out.into_iter().for_each(|text| log.warn("not-drawn", "", text));
    if !faults.is_empty() {
        faults.into_iter().chain(files.text_faults()).for_each(|fault| log.fault(fault));
    }
    let view = scene::chosen(views, selection.camera.as_ref())?;
    studio::complete(desc, view, bounds, &lamps, log);
    Ok(())
}
