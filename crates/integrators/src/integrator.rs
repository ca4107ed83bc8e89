//! The contract of all algorithms.

use std::path::PathBuf;

use film::Film;
use geometry::RayStats;
use image::Image;
use scene::Scene;

use crate::{Cancelled, Control};

/// An algorithm of light transport, run by [`render`](crate::render()).
///
/// What a pass finds depends on the scene, the settings, the seed and the pass's number alone: not
/// on threads, nor on which passes came before it, if only their numbers were lower. It is added to
/// the film; but a pass of an algorithm that gets ever nearer to one solution may put a new picture
/// in the place of the old one ([`Radiosity`](crate::Radiosity)).
pub trait Integrator: Send {
    /// How many passes make the picture.
    fn passes(&self) -> u32;

    /// How many of these passes a pixel of the finished picture is the mean of.
    fn samples_per_pixel(&self) -> u32 {
        self.passes()
    }

    /// Looks at the scene; called once, before the first pass.
    fn prepare(&mut self, scene: &Scene);

    /// Does one pass, one sample per pixel, on the threads of rayon's current pool, and looks at
    /// `control` at least once per tile of the film. A pass that was cancelled leaves some pixels
    /// with a sample less, which their weights account for.
    fn pass(
        &mut self,
        pass: u32,
        scene: &Scene,
        film: &mut Film,
        control: &Control,
    ) -> Result<RayStats, Cancelled>;

    /// What the passes so far have made beside the picture.
    fn by_products(&self) -> Vec<ByProduct> {
        Vec::new()
    }

    /// What else is worth telling of the passes so far, as names of one or two words and what there
    /// is to say.
    fn summary(&self) -> Vec<(&'static str, String)> {
        Vec::new()
    }
}

/// Something that is made beside the picture.
pub enum ByProduct {
    /// A picture, to stand beside the main one and be called like it with this added.
    Picture(String, Image),
    /// The contents of a file that was asked for.
    File(PathBuf, Vec<u8>),
}
