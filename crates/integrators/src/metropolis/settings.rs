//! Settings of Metropolis light transport.

use description::MltTechnique;

/// Settings of [`Mlt`](crate::Mlt).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MltSettings {
    /// What makes paths; default `Bdpt`.
    pub technique: MltTechnique,
    /// Most scattering events; default 5.
    pub max_depth: u32,
    /// Roughen surfaces after the first rough one of each subpath; default false.
    pub regularize: bool,
    /// Most paths among which the chains of a pass choose their starts, above 0; default 100,000.
    /// No more are looked at than a quarter of the pass's mutations.
    pub bootstrap_samples: u32,
    /// Most chains of a pass, above 0; default 1000. None has fewer than 256 mutations, but where
    /// the picture is smaller.
    pub chains: u32,
    /// Passes, each of as many mutations as there are pixels; default 100.
    pub mutations_per_pixel: u32,
    /// Probability of a large step, from 0 to 1; default 0.3.
    pub large_step_probability: f32,
    /// Standard deviation of a small step in each coordinate, above 0; default 0.01.
    pub sigma: f32,
}
