//! The contract of all algorithms.

use std::path::PathBuf;

use film::Film;
use geometry::RayStats;
use image::Image;
use scene::{Scene, View};

use crate::{Cancelled, Control};

/// An algorithm of light transport, run by [`render`](crate::render()).
///
/// The result of a pass depends on the scene, the view, the settings, the seed and the number of the
/// pass alone: not on threads, nor on which passes were done before, as long as their numbers are
/// lower. It is added to the film; but a pass of an algorithm that converges to one solution may
/// replace the picture so far ([`Radiosity`](crate::Radiosity)).
pub trait Integrator: Send {
    /// How many passes the picture takes.
    fn passes(&self) -> u32;

    /// How many of these passes a pixel of the finished picture is the mean of.
    fn samples_per_pixel(&self) -> u32 {
        self.passes()
    }

    /// Builds what depends on the scene and the view; called once, before the first pass. `Err` if
    /// it was cancelled: then it has to be called again before a pass.
    fn prepare(&mut self, scene: &Scene, view: &View, control: &Control) -> Result<(), Cancelled>;

    /// Does one pass, one sample per pixel, on the threads of rayon's current pool. A cancelled pass
    /// ends within a few rays, and leaves some pixels with one sample less, for which their weights
    /// account.
    fn pass(
        &mut self,
        pass: u32,
        scene: &Scene,
        view: &View,
        film: &mut Film,
        control: &Control,
    ) -> Result<RayStats, Cancelled>;

    /// What the passes so far have produced beside the picture.
    fn by_products(&self) -> Vec<ByProduct> {
        Vec::new()
    }

    /// Facts about the passes so far, as names of one or two words and values.
    fn summary(&self) -> Vec<(&'static str, String)> {
        Vec::new()
    }
}

/// Something that is produced beside the picture.
pub enum ByProduct {
    /// An image, and the suffix of its name after that of the picture.
    Picture(String, Image),
    /// The contents of a file that a setting asks for.
    File(PathBuf, Vec<u8>),
}
