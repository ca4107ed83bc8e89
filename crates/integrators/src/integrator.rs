//! The contract of all algorithms.

use std::path::PathBuf;

use description::Diagnostic;
use film::{Film, Filter};
use geometry::RayStats;
use scene::{Scene, View};

use crate::{Cancelled, Control, PassError, Record};

/// An algorithm of light transport, run by a [`Session`](crate::Session).
///
/// The contribution of a pass to the film depends only on the scene, the view, the settings, the
/// seed and the number of the pass: not on threads, nor on other passes. The [drafts](Self::drafts)
/// have the first numbers.
pub trait Integrator: Send {
    /// The planned number of passes, each with one sample per pixel. A render may take fewer or
    /// more.
    fn passes(&self) -> u32;

    /// The number of passes before those that each replace the picture by a better draft. They do
    /// not contribute to the finished picture.
    fn drafts(&self) -> u32 {
        0
    }

    /// Whether passes splat light to the film, for which it needs [memory](Film::reserve_splats).
    fn splats(&self) -> bool {
        false
    }

    /// What it renders differently from the scene's description.
    fn warnings(&self, _scene: &Scene) -> Vec<Diagnostic> {
        Vec::new()
    }

    /// Builds data that depends on the scene and the view; called once, before the first pass.
    /// After an `Err` (cancelled) it has to be called again before a pass.
    fn prepare(&mut self, scene: &Scene, view: &View, control: &Control) -> Result<(), Cancelled>;

    /// Does one pass, one sample per pixel, on the threads of rayon's current pool. A cancelled
    /// pass ends within a few rays, and leaves some pixels with one sample less and a smaller sum
    /// of weights. A pass that runs out of memory leaves the film unchanged.
    fn pass(
        &mut self,
        pass: u32,
        scene: &Scene,
        view: &View,
        film: &mut Film,
        control: &Control,
    ) -> Result<RayStats, PassError>;

    /// The steps of a sample of a pixel, given by its index; `None` by algorithms that do not
    /// estimate pixels one by one. `filter` is that of the film.
    fn record(
        &self,
        _pixel: [i32; 2],
        _index: u32,
        _scene: &Scene,
        _view: &View,
        _filter: &Filter,
        _control: &Control,
    ) -> Option<Result<Record, Cancelled>> {
        None
    }

    /// The additional films of the passes so far, with their names. Their pictures are saved beside
    /// the main one, under its name with theirs appended.
    fn films(&self) -> Vec<(String, &Film)> {
        Vec::new()
    }

    /// Continues with films from [`films`](Self::films); called before the first pass.
    fn set_films(&mut self, _films: Vec<(String, Film)>) {}

    /// The requested additional files, as far as they are complete.
    fn files(&self) -> Vec<OutputFile> {
        Vec::new()
    }

    /// Statistics of the passes so far: names of one or two words, and values.
    fn summary(&self) -> Vec<(&'static str, String)> {
        Vec::new()
    }
}

/// A file that is written beside the picture.
pub struct OutputFile {
    /// Its path.
    pub path: PathBuf,
    /// Its contents.
    pub contents: Vec<u8>,
}
