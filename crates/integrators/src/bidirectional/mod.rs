//! Bidirectional path tracing, and the subpaths that it shares with light tracing, Metropolis and
//! photon methods.
//!
//! A path x₀ x₁ … x_k leads from a light to the camera. It can be built from a *light subpath* of s
//! vertices and a *camera subpath* of t vertices whose ends are connected, for any s + t = k + 1;
//! each (s, t) is a strategy with a low variance for other paths [Veach 1997 ch. 10]:
//!
//! | s, t | strategy |
//! |---|---|
//! | 0, t | the camera subpath hits a light |
//! | 1, t | next-event estimation: a point on a light is sampled for the end of the camera subpath |
//! | s, 1 | the end of the light subpath is connected to a point on the lens |
//! | s, t | two vertices are connected |
//!
//! Vertices of the light subpath can also be *merged* with nearby vertices of camera subpaths:
//! photon mapping. Every path is found by all strategies, so each is weighted by multiple
//! importance sampling; [`Partial`] holds a subpath's part of the weights.
//!
//! Vertices lie on surfaces or in participating media. In a medium the phase function takes the
//! place of the BSDF, and cosines are 1. The throughput of a vertex there includes the coefficient
//! of scattering σ_s over the density of the collision. For the weights the density of a collision
//! per length is σ_t, without the transmittance before it: all strategies sample a vertex with the
//! same factor σ_t, which cancels except where merging is involved, and weights may be functions of
//! the vertices alone.
//!
//! Camera subpaths go under the surfaces of bodies; `under_surface.rs`
//! says what that means for the weights.
//!
//! A [`Walk`] samples vertex after vertex, from either end; [`Bidirectional`] builds paths from the
//! vertices. The depth of a vertex is the number of scattering events on its subpath, its own
//! included: 1 at the first surface. A path whose ends have the depths j and k has j + k scattering
//! events when connected and j + k − 1 when merged, and the vertices s = j + 1, t = k + 1.
//!
//! Light subpaths carry *power*: β of a vertex is the flux that arrives there along `wo`, over the
//! density of the subpath. Their BSDFs are the adjoint ones, [`TransportMode::Importance`]:
//! refraction does not scale by η², and shading normals scale by |wo·ns||wi·ng| / |wo·ng||wi·ns|
//! ([Veach 1997 §5.3]).
//!
//! Dispersion terminates the secondary wavelengths of a subpath. The contribution of a path is then
//! known at the first wavelength only; [`hero_only`] converts it to radiance at the wavelengths
//! that both subpaths began with.

mod bdpt;
mod connect;
mod interaction;
mod light_end;
mod light_vertex;
mod medium_emission;
mod partial;
mod paths;
mod subpaths;
#[cfg(test)]
mod tests;
mod under_surface;
mod vertex;
mod walk;

pub use bdpt::Bdpt;
pub(crate) use bdpt::techniques;
pub(crate) use connect::Found;
pub(crate) use interaction::{Interaction, Law, MediumInteraction};
pub(crate) use light_vertex::LightVertex;
pub(crate) use partial::{Balance, Merges, Partial};
pub(crate) use paths::{Bidirectional, Lights, hero_only};
pub(crate) use subpaths::Encounter;
pub(crate) use vertex::Vertex;
pub(crate) use walk::{Arrival, Walk};
