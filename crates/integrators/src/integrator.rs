//! The contract of all algorithms.

use std::path::PathBuf;

use description::Diagnostic;
use film::Film;
use geometry::RayStats;
use scene::{Scene, View};

use crate::{Cancelled, Control, PassError};

/// An algorithm of light transport, run by a [`Session`](crate::Session).
///
/// What a pass adds to the film depends on the scene, the view, the settings, the seed and the
/// number of the pass alone: not on threads, nor on which passes were done before. The numbers
/// begin with those of the [drafts](Self::drafts).
pub trait Integrator: Send {
    /// How many passes the picture is planned for: the samples of a pixel that it is the mean of.
    /// There may be fewer, and more.
    fn passes(&self) -> u32;

    /// How many passes come before those, each of which puts a better draft in the place of the
    /// picture. They add nothing to the finished one.
    fn drafts(&self) -> u32 {
        0
    }

    /// Whether passes splat light to the film, for which it needs [memory](Film::reserve_splats).
    fn splats(&self) -> bool {
        false
    }

    /// What of the scene it draws otherwise than described.
    fn warnings(&self, _scene: &Scene) -> Vec<Diagnostic> {
        Vec::new()
    }

    /// Builds what depends on the scene and the view; called once, before the first pass. `Err` if
    /// it was cancelled: then it has to be called again before a pass.
    fn prepare(&mut self, scene: &Scene, view: &View, control: &Control) -> Result<(), Cancelled>;

    /// Does one pass, one sample per pixel, on the threads of rayon's current pool. A cancelled
    /// pass ends within a few rays, and leaves some pixels with one sample less, for which their
    /// weights account. A pass that lacks memory leaves the film as it was.
    fn pass(
        &mut self,
        pass: u32,
        scene: &Scene,
        view: &View,
        film: &mut Film,
        control: &Control,
    ) -> Result<RayStats, PassError>;

    /// Films that the passes so far have filled beside the picture's, with their names. Their
    /// pictures stand beside the main one and are called like it with the name added.
    fn films(&self) -> Vec<(String, &Film)> {
        Vec::new()
    }

    /// Goes on with films that [`films`](Self::films) has given; called before the first pass.
    fn set_films(&mut self, _films: Vec<(String, Film)>) {}

    /// The files that were asked for, as far as the passes so far have made them.
    fn files(&self) -> Vec<OutputFile> {
        Vec::new()
    }

    /// Facts about the passes so far, as names of one or two words and values.
    fn summary(&self) -> Vec<(&'static str, String)> {
        Vec::new()
    }
}

/// A file that is made beside the picture.
pub struct OutputFile {
    /// Where it goes.
    pub path: PathBuf,
    /// Its contents.
    pub contents: Vec<u8>,
}
