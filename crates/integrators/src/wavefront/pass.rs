//! What all batches of a pass share.

use lanes::InstructionSet;

use super::area_lights::AreaLights;
use super::materials::LaneMaterials;
use super::media::LaneMedia;
use crate::Control;
use crate::transport::pixel_samples::PixelSamples;

/// What all batches of a pass share.
#[derive(Clone, Copy)]
pub(super) struct Pass<'a> {
    pub materials: &'a LaneMaterials,
    pub media: &'a LaneMedia,
    pub area_lights: &'a AreaLights,
    pub pixels: &'a PixelSamples<'a>,
    pub control: &'a Control,
    pub instruction_set: InstructionSet,
}

impl Pass<'_> {
    /// Whether a light is chosen among several.
    #[inline(always)]
    pub fn has_several_lights(&self) -> bool {
        self.pixels.scene.lights().len() > 1
    }
}
