//! Subpaths under the surface of bodies.
//!
//! A camera subpath that is transmitted into a body at po leaves it at pi by the exit lobe
//! ([`subsurface`](crate::transport::subsurface)). Light samples, light vertices and photons are
//! connected to pi and merged with it; at po there is only the reflection by the boundary. The way
//! from po to pi is a factor of every strategy that finds the path, as none but the camera subpath
//! makes it: no light subpath has a vertex at po, nor goes on from pi to po. So pi is like the
//! first vertex of a camera subpath of which nothing further is sampled from the light, and its
//! partial weights are 0. The other strategies for the path are connections and merges on the
//! light's side of pi, and merges at pi itself, which the recursion adds from there on.
//!
//! Algorithms that end their camera subpaths early, where they are connected to light subpaths or
//! merged with photons, let light subpaths go under surfaces, too. At pi these are reflected, or
//! shine through the boundary, to be seen from inside; most enter by the exit lobe, and leave at po
//! as `Tracer::emerge` says. Then both kinds of subpaths make the way
//! from po to pi, but no path has two ways to be found: the algorithm has one vertex where they
//! meet.

use scattering::{Body, Directions};

use math::Vector3;

/// The share of the light subpaths that a body takes up which shine into it instead. Most bodies
/// are not seen from inside.
const SHINES_IN: f32 = 0.125;

/// How a light subpath goes on where it arrives at a body.
pub(super) struct LightWay {
    /// The directions of the boundary, or under the surface.
    pub directions: Option<Directions>,
    /// The probability of this choice.
    pub probability: f32,
    /// A new random number, independent of the choice.
    pub uc: f32,
}

impl LightWay {
    /// One that `uc` chooses for light from `wo`, in the local frame.
    pub fn choose(body: Body, wo: Vector3, uc: f32) -> Self {
        let stays = body.boundary_probability(wo);
        let dielectric = matches!(body, Body::Subsurface(_));
        if uc < stays {
            let directions = Some(if dielectric { Directions::Reflection } else { Directions::All });
            return Self { directions, probability: stays, uc: uc / stays };
        }
        let (passes, uc) = (1.0 - stays, (uc - stays) / (1.0 - stays));
        if !dielectric {
            return Self { directions: None, probability: passes, uc };
        }
        if uc < SHINES_IN {
            let directions = Some(Directions::Transmission);
            return Self { directions, probability: passes * SHINES_IN, uc: uc / SHINES_IN };
        }
        let uc = (uc - SHINES_IN) / (1.0 - SHINES_IN);
        Self { directions: None, probability: passes * (1.0 - SHINES_IN), uc }
    }
}
