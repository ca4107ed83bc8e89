//! MIS weights of strategies, accumulated along the subpaths.
//!
//! The balance heuristic gives strategy i of a path the weight w_i = p_i / Σ p_j, the p being the
//! densities with which the strategies sample the path (times the number of samples of each) [Veach
//! 1997 §9.2]. Written 1/w_i = 1 + Σ p_j/p_i over j ≠ i, the sum splits in two: strategies that
//! sample more of the path from the camera, and those that sample more of it from the light. Each
//! part is a sum over one subpath's vertices, and is updated from vertex to vertex by a recursion.
//! So a subpath carries three numbers, and the weight of a strategy follows from the quantities at
//! its two ends ([Georgiev 2012]; [van Antwerpen 2011]).
//!
//! With p→ the density per area with which the subpath sampled a vertex from the one before, p←
//! that with which the other subpath would, g← the factor from solid angle to area in p←, and η =
//! nπr² for n light subpaths merged within the radius r:
//!
//! ```text
//! d_vcm = 1 / p→
//! d_vc  = g←/p→ · (d_vcm' + p←'·d_vc')
//! d_vm  = g←/p→ · (m'·η + k'·p←'·d_vm')
//! ```
//!
//! where ' marks the vertex before and p←' is per solid angle. d_vc sums over connections, d_vm
//! over merges: m is the α of a vertex that can be merged, else 0, and k is 1 where merges further
//! back count. α is the probability with which a ray hits the surface, 1 without an alpha texture.
//! All strategies have it once for each vertex, so that it cancels; but merging has it twice for
//! the merged vertex, which both subpaths have hit. In a medium the ball of volume 4πr³/3 takes the
//! place of the disk, and α is σ_t·4r/3, the probability of a collision over the length by which
//! the two differ. Direct light is not merged, because next-event estimation finds it with less
//! noise (m = 0 next to a light). Nor are vertices beyond a diffuse surface merged, seen from the
//! camera ([`vcm`](crate::photons::vcm) says why): behind one a camera subpath has m = 0, and at
//! one a light subpath has k = 0 ([`Merges`]). Specular vertices can be neither connected nor
//! merged: their d_vcm is 0 and the sums lose those terms. Between two vertices a [`Partial`] lacks
//! the factors of the next vertex, which [`Partial::arrive`] supplies.

use std::f32::consts::PI;

/// The partial MIS weights of a subpath.
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
    /// Whether rays cannot hit the light.
    pub is_delta: bool,
}

/// The vertices of a subpath at which merging is one of the strategies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Merges {
    /// At the last vertex: the probability with which rays hit its surface, or 0 without merging.
    pub here: f32,
    /// Whether the vertices before it count, as far as they can be merged.
    pub before: bool,
}

impl Merges {
    /// These if `condition` is true, else none.
    pub fn only_if(self, condition: bool) -> Self {
        if condition { self } else { Self { here: 0.0, before: false } }
    }
}

/// The sample counts and the merging radius by which strategies are weighted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Balance {
    /// Light subpaths in a pass, for each sample of a pixel: the number that each may be connected
    /// to the camera.
    pub light_paths: f32,
    /// η: merging counts so much more than connecting; 0 without merging.
    pub merging: f32,
    /// The radius of merging.
    pub radius: f32,
    /// 1; 0 if light subpaths are not connected to anything, so that camera subpaths find light by
    /// chance or by choice alone.
    pub connecting: f32,
}

impl Balance {
    /// For `light_paths` light subpaths, without merging.
    pub fn connecting(light_paths: f32) -> Self {
        Self { light_paths, merging: 0.0, radius: 0.0, connecting: 1.0 }
    }

    /// For `light_paths` light subpaths that are connected and `photon_paths` that are merged
    /// within a radius.
    pub fn merging(light_paths: usize, photon_paths: usize, radius: f32) -> Self {
        let merging = photon_paths as f32 * (PI * radius * radius);
        Self { merging, radius, ..Self::connecting(light_paths as f32) }
    }

    /// For merging within a radius at the ends of camera subpaths, which before their end sample
    /// lights by next-event estimation and by BSDF sampling.
    pub fn at_the_end(photon_paths: usize, radius: f32) -> Self {
        Self { connecting: 0.0, ..Self::merging(photon_paths, photon_paths, radius) }
    }

    /// The length of a medium that has the volume of the merging ball over the area of the merging
    /// disk: 4r/3.
    pub fn merging_length(&self) -> f32 {
        self.radius * (4.0 / 3.0)
    }

    /// The initial value of a camera subpath whose first direction has the density `pdf` on the
    /// film (per pixel).
    pub fn at_camera(&self, pdf: f32) -> Partial {
        Partial { vcm: self.light_paths / pdf, vc: 0.0, vm: 0.0 }
    }

    /// The value of a light subpath at its first surface, where it arrives at `cos_theta` to the
    /// normal.
    pub fn at_light(&self, end: &LightEnd, cos_theta: f32) -> Partial {
        let scale = end.cos_theta / (end.emission * cos_theta);
        let vc = if end.is_delta { 0.0 } else { scale };
        Partial { vcm: end.direct * scale, vc, vm: 0.0 }
    }

    /// The sum over the strategies with s ≥ 2 for a camera subpath that has hit a light, along a
    /// direction at `cos_theta` to the normal of the vertex before; to be multiplied by the density
    /// of the light's emission in that direction. That vertex cannot be merged, which was not known
    /// when the subpath left it: `merges` is what was counted then, and is subtracted.
    pub fn connecting_from_light(&self, partial: &Partial, cos_theta: f32, merges: Merges) -> f32 {
        let before = partial.vm - self.merging * merges.here * cos_theta * partial.vcm;
        // Not `max`, which would hide NaN.
        self.connecting * (partial.vc + if before < 0.0 { 0.0 } else { before })
    }

    /// The sum over the strategies that sample fewer vertices by this subpath, at an end from which
    /// the other subpath would continue with the density `pdf_back`; to be multiplied by the
    /// density with which the other subpath samples this end.
    pub fn connecting_back(&self, partial: &Partial, pdf_back: f32, merges: Merges) -> f32 {
        let merging = self.merging_there(partial, pdf_back, merges);
        self.connecting * (partial.vcm + pdf_back * partial.vc + merging)
    }

    /// The same for merging at the end, without that factor.
    pub fn merging_back(&self, partial: &Partial, pdf_back: f32, merges: Merges) -> f32 {
        let others = self.connecting_back(partial, pdf_back, Merges { here: 0.0, ..merges });
        others / (self.merging * merges.here)
    }

    /// The terms of merging in these sums.
    fn merging_there(&self, partial: &Partial, pdf_back: f32, merges: Merges) -> f32 {
        let here = self.merging * merges.here;
        if merges.before { here + pdf_back * partial.vm } else { here }
    }

    /// Leaves a vertex along a direction of the density `pdf`, at `cos_theta` to the normal;
    /// `pdf_back` is the density of the reverse direction.
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
    /// Leaves a vertex in the direction of a specular lobe.
    pub fn leave_specular(&self, cos_theta: f32) -> Self {
        Self { vcm: 0.0, vc: self.vc * cos_theta, vm: self.vm * cos_theta }
    }

    /// Arrives at a surface at `cos_theta` to its normal, at the given squared distance; 1 from
    /// infinity.
    pub fn arrive(&self, distance_squared: f32, cos_theta: f32) -> Self {
        Self {
            vcm: self.vcm * distance_squared / cos_theta,
            vc: self.vc / cos_theta,
            vm: self.vm / cos_theta,
        }
    }
}
