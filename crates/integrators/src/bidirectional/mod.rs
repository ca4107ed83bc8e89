//! Paths from both ends: what light tracing, bidirectional path tracing, Metropolis and photon
//! methods share.
//!
//! A path x₀ x₁ … x_k leads from a light to the camera. It can be made by a *light subpath* of s
//! vertices and a *camera subpath* of t vertices whose ends are connected, for any s + t = k + 1;
//! each (s, t) is a strategy of its own, good at other paths [Veach 1997 ch. 10]:
//!
//! | s, t | made by |
//! |---|---|
//! | 0, t | the camera subpath meets a light by chance |
//! | 1, t | a point on a light is chosen for the end of the camera subpath |
//! | s, 1 | the end of the light subpath is connected to a point on the lens |
//! | s, t | two surfaces are connected |
//!
//! Vertices of the light subpath may also be *merged* with those of camera subpaths that come near:
//! photon mapping. Each path is found by all strategies, so each is weighted: [`Partial`] says how.
//!
//! A [`Walk`] goes from vertex to vertex, from either end; [`Bidirectional`] makes paths of its
//! vertices. The depth of a vertex is the number of scattering events on its subpath, its own
//! included: 1 at the first surface. A path whose ends have the depths j and k has j + k of them
//! when connected, j + k − 1 when merged, and the vertices s = j + 1, t = k + 1.
//!
//! Light subpaths carry *importance-weighted power*: β of a vertex is the flux that arrives there
//! along `wo`, over the density of the subpath. Their BSDFs are the adjoint ones,
//! [`TransportMode::Importance`]: refraction does not scale by η², and shading normals scale by
//! |wo·ns||wi·ng| / |wo·ng||wi·ns| ([Veach 1997 §5.3]).
//!
//! Dispersion ends all wavelengths but the first of a subpath. What two subpaths make together is
//! then known at the first wavelength only; [`hero_only`] turns it into light at the wavelengths
//! that both began with.

mod bdpt;
mod connect;
mod light_end;
mod light_vertex;
mod partial;
mod subpaths;
#[cfg(test)]
mod tests;
mod vertex;
mod walk;

use scene::light_sampler::{LightSampler, LightSamplerKind, PowerLightSampler};
use scene::{Scene, View};
use spectrum::SampledSpectrum;

pub use bdpt::Bdpt;
pub(crate) use bdpt::techniques;
pub(crate) use connect::Found;
pub(crate) use light_vertex::LightVertex;
pub(crate) use partial::{Balance, Merges, Partial};
pub(crate) use subpaths::OnTheWay;
pub(crate) use vertex::Vertex;
pub(crate) use walk::Walk;

/// What chooses lights.
#[derive(Clone, Debug)]
pub(crate) struct Lights {
    /// For a point.
    pub seen_from: LightSampler,
    /// Where light subpaths start.
    pub emitting: PowerLightSampler,
}

impl Lights {
    /// Those of no scene.
    pub fn none() -> Self {
        Self { seen_from: LightSampler::default(), emitting: PowerLightSampler::default() }
    }

    pub fn of(scene: &Scene) -> Self {
        Self {
            seen_from: scene.light_sampler(LightSamplerKind::Bvh),
            emitting: PowerLightSampler::new(scene.lights()),
        }
    }
}

/// Makes paths.
#[derive(Clone, Copy)]
pub(crate) struct Bidirectional<'a> {
    pub scene: &'a Scene,
    pub view: &'a View,
    pub lights: &'a Lights,
    /// How strategies share paths.
    pub balance: Balance,
    /// Most scattering events of a path.
    pub max_depth: u32,
    /// Roughen surfaces after the first rough one of each subpath.
    pub regularize: bool,
}

/// Light that is known at the first wavelength alone, as light at all that have the same mean.
pub(crate) fn hero_only(l: SampledSpectrum) -> SampledSpectrum {
    let mut hero = SampledSpectrum::ZERO;
    hero[0] = l[0] * spectrum::N as f32;
    hero
}
