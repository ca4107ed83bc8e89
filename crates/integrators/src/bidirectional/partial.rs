//! Weights of strategies without looking at the path twice.
//!
//! The balance heuristic gives strategy i of a path the weight w_i = p_i / Σ p_j, the p being the
//! densities with which the strategies make the path (times the number of paths that each may take)
//! [Veach 1997 §9.2]. Written 1/w_i = 1 + Σ p_j/p_i over j ≠ i, the sum falls into two: strategies
//! that have more of the path made from the camera, and those that have more made from the light.
//! Each part is a sum over one subpath's vertices, and goes from vertex to vertex by a recursion;
//! so a subpath carries three numbers, and a strategy needs only what is known at its two ends
//! ([Georgiev 2012]; [van Antwerpen 2011]).
//!
//! With p→ the density per area with which the subpath made a vertex from the one before, p← that
//! with which the other subpath would, g← the factor from solid angle to area in p←, and η = nπr²
//! for n light subpaths merged within the radius r:
//!
//! ```text
//! d_vcm = 1 / p→
//! d_vc  = g←/p→ · (d_vcm' + p←'·d_vc')
//! d_vm  = g←/p→ · (m'·η + k'·p←'·d_vm')
//! ```
//!
//! where ' marks the vertex before and p←' is per solid angle. d_vc sums what connects, d_vm what
//! merges: m is the α of a vertex that can be merged, else 0, and k is 1 where merges further back
//! count. α is the probability with which a ray meets the surface, 1 where no texture cuts it out.
//! All strategies have it once for each vertex, so that it cancels; but merging has it twice for
//! the merged one, which both subpaths have met. What comes straight from a light is not merged,
//! because choosing a point on the light finds the same with less noise (m = 0 next to a light).
//! Nor is anything merged that lies beyond a diffuse surface, seen from the camera
//! ([`vcm`](crate::photons::vcm) says why): behind one a camera subpath has m = 0, and at one a
//! light subpath has k = 0 ([`Merges`]). What is specular can neither be connected nor merged: its
//! d_vcm is 0 and the sums lose those terms. A [`Partial`] on its way between two vertices lacks
//! the factors of the vertex that it will arrive at, which [`Partial::arrive`] supplies.

use std::f32::consts::PI;

/// What a subpath carries for its weights.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Partial {
    pub vcm: f32,
    pub vc: f32,
    pub vm: f32,
}

/// Densities at the light's end of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LightEnd {
    /// Density per solid angle with which the surface chooses the point, or direction, on the
    /// light.
    pub direct: f32,
    /// Density per area and solid angle with which the light sends the ray.
    pub emission: f32,
    /// |cos| at the light's surface; 1 where it has none.
    pub cos_theta: f32,
    /// Whether rays cannot meet the light.
    pub is_delta: bool,
}

/// Where merging is one of a path's strategies, on one side of a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Merges {
    /// At the vertex there: the probability with which light meets its surface, or 0 without
    /// merging.
    pub here: f32,
    /// At those before it on its subpath that can be merged themselves.
    pub before: bool,
}

impl Merges {
    /// These if something is so, else none.
    pub fn only_if(self, it_is: bool) -> Self {
        if it_is { self } else { Self { here: 0.0, before: false } }
    }
}

/// How strategies share paths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Balance {
    /// Light subpaths in a pass, for each sample of a pixel: the number that each may be connected
    /// to the camera.
    pub light_paths: f32,
    /// η: merging counts so much more than connecting; 0 without merging.
    pub merging: f32,
    /// 1; 0 if light subpaths are not connected to anything, so that camera subpaths find light by
    /// chance or by choice alone.
    pub connecting: f32,
}

impl Balance {
    /// For as many light subpaths, without merging.
    pub fn connecting(light_paths: f32) -> Self {
        Self { light_paths, merging: 0.0, connecting: 1.0 }
    }

    /// The same, and merging with other light subpaths within a radius.
    pub fn merging(light_paths: usize, photon_paths: usize, radius: f32) -> Self {
        let merging = photon_paths as f32 * (PI * radius * radius);
        Self { merging, ..Self::connecting(light_paths as f32) }
    }

    /// For merging within a radius where camera subpaths end, which on their way find light by
    /// themselves.
    pub fn at_the_end(photon_paths: usize, radius: f32) -> Self {
        Self { connecting: 0.0, ..Self::merging(photon_paths, photon_paths, radius) }
    }

    /// What a camera subpath begins with, whose first direction has the density `pdf` on the film
    /// (per pixel).
    pub fn at_camera(&self, pdf: f32) -> Partial {
        Partial { vcm: self.light_paths / pdf, vc: 0.0, vm: 0.0 }
    }

    /// What a light subpath has at its first surface, where it arrives at `cos_theta` to the
    /// normal.
    pub fn at_light(&self, end: &LightEnd, cos_theta: f32) -> Partial {
        let scale = end.cos_theta / (end.emission * cos_theta);
        let vc = if end.is_delta { 0.0 } else { scale };
        Partial { vcm: end.direct * scale, vc, vm: 0.0 }
    }

    /// The sum over the strategies with s ≥ 2 for a camera subpath that has met a light, along a
    /// direction at `cos_theta` to the normal of the vertex before; to be multiplied by the density
    /// with which the light sends light there. That vertex cannot be merged, which was not known
    /// when it was left: `merges` is what was counted then.
    pub fn connecting_from_light(&self, partial: &Partial, cos_theta: f32, merges: Merges) -> f32 {
        let before = partial.vm - self.merging * merges.here * cos_theta * partial.vcm;
        // Not `max`, which would hide what is no number.
        self.connecting * (partial.vc + if before < 0.0 { 0.0 } else { before })
    }

    /// The sum over the strategies that have more made by the subpath's own kind, at an end from
    /// which the other subpath would go on with the density `pdf_back`; to be multiplied by the
    /// density with which the other subpath makes this end.
    pub fn connecting_back(&self, partial: &Partial, pdf_back: f32, merges: Merges) -> f32 {
        let merging = self.merging_there(partial, pdf_back, merges);
        self.connecting * (partial.vcm + pdf_back * partial.vc + merging)
    }

    /// The same for merging at the end, which is possible there, to be used as it is.
    pub fn merging_back(&self, partial: &Partial, pdf_back: f32, merges: Merges) -> f32 {
        let others = self.connecting_back(partial, pdf_back, Merges { here: 0.0, ..merges });
        others / (self.merging * merges.here)
    }

    /// The part of merging in these sums.
    fn merging_there(&self, partial: &Partial, pdf_back: f32, merges: Merges) -> f32 {
        let here = self.merging * merges.here;
        if merges.before { here + pdf_back * partial.vm } else { here }
    }

    /// Leaves a vertex along a direction of the density `pdf`, at `cos_theta` to the normal;
    /// `pdf_back` is the density of the way back.
    pub fn leave(
        &self,
        partial: &Partial,
        pdf: f32,
        pdf_back: f32,
        cos_theta: f32,
        merges: Merges,
    ) -> Partial {
        let scale = cos_theta / pdf;
        Partial {
            vcm: 1.0 / pdf,
            vc: scale * (partial.vcm + pdf_back * partial.vc),
            vm: scale * self.merging_there(partial, pdf_back, merges),
        }
    }
}

impl Partial {
    /// Leaves a vertex in the one direction that a specular lobe has.
    pub fn leave_specular(&self, cos_theta: f32) -> Self {
        Self { vcm: 0.0, vc: self.vc * cos_theta, vm: self.vm * cos_theta }
    }

    /// Arrives at a surface at `cos_theta` to its normal from a distance whose square is given;
    /// from a direction without a place the square is 1.
    pub fn arrive(&self, distance_squared: f32, cos_theta: f32) -> Self {
        Self {
            vcm: self.vcm * distance_squared / cos_theta,
            vc: self.vc / cos_theta,
            vm: self.vm / cos_theta,
        }
    }
}
