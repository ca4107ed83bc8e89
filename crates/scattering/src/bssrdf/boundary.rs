//! Rough boundaries that let in all light which they do not reflect.
//!
//! Facets that scatter light once lose what meets a second one. As a dielectric reflects little,
//! most of that enters. So what facets refract between a direction ωo outside and the inside counts
//! for more, by the gain
//!
//! ```text
//! (1 − E_r(ωo))/E_t(ωo)
//! ```
//!
//! with the shares E_r and E_t of light from ωo that they reflect and refract once: all that is not
//! reflected enters, in the directions of refracted light. The gain is the same both ways, so that
//! paths from the camera and from lights agree.

use crate::grid::{Grid, from, round};
use crate::{TrowbridgeReitz, fr_dielectric, reflect, refract};
use math::{Vector3, sqr};

/// Strata of directions inside, within the critical angle and as many beyond it; in each part the
/// squares of cosines are divided evenly.
pub(super) const STRATA: usize = 16;
/// Directions outside that are seen through a boundary.
const DIRECTIONS: usize = 64;
/// Visible normals of quadratures, each way, for tables and at a point.
const STEPS: usize = 32;
const FEW_STEPS: usize = 8;

/// All roughnesses of boundaries of a relative index of refraction.
#[derive(Clone, Debug)]
pub(super) struct Boundary {
    eta: f32,
    gains: Grid<f32>,
}

impl Boundary {
    /// Of an index, below over above.
    pub fn new(eta: f32) -> Self {
        let gain = |roughness, cosine| gain(eta, &round(roughness), from(cosine), STEPS);
        Self { eta, gains: Grid::new(gain) }
    }

    /// The index.
    pub fn eta(&self) -> f32 {
        self.eta
    }

    /// The gain for a direction above.
    pub fn gain(&self, facets: &TrowbridgeReitz, w: Vector3) -> f32 {
        if !facets.is_isotropic() {
            return gain(self.eta, facets, w, FEW_STEPS);
        }
        let nodes = self.gains.around(facets.mean_alpha().sqrt(), w.z);
        nodes.into_iter().map(|(weight, gain)| weight * gain).sum()
    }

    /// The gains of isotropic ones, a row for each roughness.
    pub fn gains(&self) -> &[f32] {
        self.gains.values()
    }

    /// The square of the cosine of the critical angle inside; 0 if there is none.
    pub fn critical(&self) -> f32 {
        (1.0 - 1.0 / sqr(self.eta)).max(0.0)
    }

    /// The distribution over strata, those beyond the critical angle first, of the light of a
    /// uniform sky that enters through facets of a roughness.
    pub fn entering(&self, roughness: f32) -> [f64; 2 * STRATA] {
        let (facets, critical) = (round(roughness), self.critical());
        let mut shares = [0.0; 2 * STRATA];
        for i in 0..DIRECTIONS {
            // Under a uniform sky the squares of cosines are uniform.
            let wo = from(((i as f32 + 0.5) / DIRECTIONS as f32).sqrt());
            let gain = self.gain(&facets, wo);
            for wm in facets.visible_normals(wo, STEPS) {
                let Some((wi, share)) = refracted(self.eta, &facets, wo, wm) else { continue };
                let (part, width) = if sqr(wi.z) < critical {
                    (sqr(wi.z) / critical, 0)
                } else {
                    ((sqr(wi.z) - critical) / (1.0 - critical), STRATA)
                };
                let stratum = ((part * STRATA as f32) as usize).min(STRATA - 1) + width;
                shares[stratum] += f64::from(gain) * share;
            }
        }
        let total: f64 = shares.iter().sum();
        shares.map(|share| share / total)
    }
}

/// The direction below of light from above that a facet refracts, and the share of it that leaves
/// to there.
fn refracted(eta: f32, facets: &TrowbridgeReitz, wo: Vector3, wm: Vector3) -> Option<(Vector3, f64)> {
    let (wi, _, is_refracted) = refract(wo, wm, eta);
    let passes = 1.0 - fr_dielectric(wo.dot(wm), eta);
    (is_refracted && wi.z < 0.0).then(|| (wi, f64::from(passes * facets.kept(wo, wi))))
}

/// The gain for a direction above, by quadrature over the normals that it sees.
fn gain(eta: f32, facets: &TrowbridgeReitz, wo: Vector3, steps: usize) -> f32 {
    let (mut left, mut entered) = (0.0, 0.0);
    for wm in facets.visible_normals(wo, steps) {
        let wi = reflect(wo, wm);
        let reflected = fr_dielectric(wo.dot(wm), eta);
        let leaves = if wi.z > 0.0 { reflected * facets.kept(wo, wi) } else { 0.0 };
        left += 1.0 - f64::from(leaves);
        entered += refracted(eta, facets, wo, wm).map_or(0.0, |(_, share)| share);
    }
    // Where all light is reflected there is nothing that could count for more.
    if entered > 0.0 { (left / entered) as f32 } else { 1.0 }
}
