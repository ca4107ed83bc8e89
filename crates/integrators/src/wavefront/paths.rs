//! The paths of a batch.

use sampling::Sampler;
use spectrum::SampledSpectrum;

use crate::transport::path_state::PathState;
use crate::transport::pixel_samples::PixelSample;

/// A path.
pub(super) struct PathRecord {
    /// The index of its tile in the batch.
    pub tile: usize,
    /// The sample of the pixel.
    pub sample: PixelSample,
    /// The random numbers.
    pub sampler: Sampler,
    /// The state between two vertices.
    pub state: PathState,
    /// The light so far.
    pub l: SampledSpectrum,
    /// Whether it was scattered by a rough surface before.
    pub rough_before: bool,
}
