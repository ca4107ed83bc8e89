//! Tables of directional albedos of microfacets, by quadrature over their visible normals.
//!
//! Microfacets of one roughness that reflect all light have the albedo E(μ) = ∫ G₂/G₁ D_μ(m) dm,
//! less than 1 by what hits another facet. Two expansions in hat functions over the cosine make one
//! small table serve every Fresnel reflectance and every layer above:
//!
//! ```text
//! E_F(μ) = Σ_k F(c_k) S_k(μ)      S_k = the share of E reflected at angles of incidence around c_k
//! L_T(μ) = Σ_k T(c_k) D_k(μ)      the light lost where T(μ) becomes T(min(μ, μ_i)), of T(μ) E(μ)
//! ```
//!
//! Facets that refract all light are expanded likewise, over the cosine in the thinner medium.
//! Where the direction there is nearer to the horizon than that to the facet, a layer takes more;
//! this loss has the weight 1 − F of the bare boundary. Roughness is √α.

use crate::grid::{Grid, Place, from, round};
use crate::{TrowbridgeReitz, fr_dielectric, reflect, refract};
use math::{Vector3, safe_sqrt, sqr};
use std::sync::LazyLock;

/// Hat functions, of maxima at the squares of 0, 1/9, … 1, which are nodes of the tables.
pub(super) const HATS: usize = 10;
/// Indices of refraction of the table of glass, with (η − 1)/(η + 1) evenly from −½ to ½.
const INDICES: usize = 13;
/// Visible normals of a quadrature, each way.
const STEPS: usize = 32;
const NORMALS: f64 = (STEPS * STEPS) as f64;

/// Values of all hats.
pub(super) type Hats = [f32; HATS];

/// The cosines of the maxima of hats.
pub(super) fn hat_cosines() -> Hats {
    std::array::from_fn(|k| sqr(k as f32 / (HATS - 1) as f32))
}

/// The hats at a cosine.
pub(super) fn hats(cosine: f32) -> Hats {
    let place: Place = Place::new(safe_sqrt(cosine), HATS);
    let mut hats = [0.0; HATS];
    let first = place.index as usize;
    hats[first..first + 2].copy_from_slice(&place.weights());
    hats
}

/// Σ of products.
#[inline]
pub(super) fn dot(a: &Hats, b: &Hats) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// White microfacets seen from one direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct White {
    /// S: the albedo by the angle of incidence on facets.
    pub shares: Hats,
    /// D: the loss under a layer, by the layer's transmittance.
    pub losses: Hats,
    /// E: the whole albedo.
    pub albedo: f32,
}

impl White {
    /// Of facets seen from a direction above: if they are alike both ways, from a table.
    pub fn seen(facets: &TrowbridgeReitz, wo: Vector3) -> Self {
        static TABLE: LazyLock<Grid<White>> =
            LazyLock::new(|| Grid::new(|roughness, cosine| White::compute(&round(roughness), from(cosine))));
        if !facets.is_isotropic() {
            return Self::compute(facets, wo);
        }
        let mut sum = Self { shares: [0.0; HATS], losses: [0.0; HATS], albedo: 0.0 };
        for (weight, node) in TABLE.around(facets.mean_alpha().sqrt(), wo.z) {
            for k in 0..HATS {
                sum.shares[k] += weight * node.shares[k];
                sum.losses[k] += weight * node.losses[k];
            }
            sum.albedo += weight * node.albedo;
        }
        sum
    }

    fn compute(facets: &TrowbridgeReitz, wo: Vector3) -> Self {
        let mut sums = [[0f64; HATS]; 2];
        let own = hats(wo.z);
        for wm in facets.visible_normals(wo, STEPS) {
            let wi = reflect(wo, wm);
            if wi.z <= 0.0 {
                continue;
            }
            let kept = facets.kept(wo, wi);
            let [met, lower] = [hats(wo.dot(wm)), hats(wo.z.min(wi.z))];
            for k in 0..HATS {
                sums[0][k] += f64::from(kept * met[k]);
                sums[1][k] += f64::from(kept * (own[k] - lower[k]));
            }
        }
        let [shares, losses] = sums.map(|sum| sum.map(|value| (value / NORMALS) as f32));
        Self { shares, losses, albedo: shares.iter().sum() }
    }
}

/// Facets of glass seen from one direction, by the cosine at which light meets them in the thinner
/// medium.
#[derive(Clone, Copy, Debug)]
pub(super) struct Glass {
    /// What is kept of light that is reflected, where some would be refracted.
    pub reflected: Hats,
    /// What is kept of light that is refracted.
    pub refracted: Hats,
    /// What of it is lost under a layer, by the layer's transmittance, for light from the denser
    /// medium.
    pub losses: Hats,
    /// What is kept of light that can only be reflected.
    pub total: f32,
}

impl Glass {
    /// Of facets of a relative index, as the light meets it, seen from a direction with z > 0: if
    /// they are alike both ways, from a table.
    pub fn seen(eta: f32, facets: &TrowbridgeReitz, wo: Vector3) -> Self {
        static TABLE: LazyLock<[Grid<Glass>; INDICES]> = LazyLock::new(|| {
            std::array::from_fn(|i| {
                let x = i as f32 / (INDICES - 1) as f32 - 0.5;
                let eta = (1.0 + x) / (1.0 - x);
                Grid::new(|roughness, cosine| Glass::compute(eta, &round(roughness), from(cosine)))
            })
        });
        if !facets.is_isotropic() {
            return Self::compute(eta, facets, wo);
        }
        let place: Place = Place::new((eta - 1.0) / (eta + 1.0) + 0.5, INDICES);
        let none = [0.0; HATS];
        let mut sum = Self { reflected: none, refracted: none, losses: none, total: 0.0 };
        for (i, share) in place.weights().into_iter().enumerate() {
            for (weight, node) in TABLE[place.index as usize + i].around(facets.mean_alpha().sqrt(), wo.z) {
                for k in 0..HATS {
                    sum.reflected[k] += share * weight * node.reflected[k];
                    sum.refracted[k] += share * weight * node.refracted[k];
                    sum.losses[k] += share * weight * node.losses[k];
                }
                sum.total += share * weight * node.total;
            }
        }
        sum
    }

    fn compute(eta: f32, facets: &TrowbridgeReitz, wo: Vector3) -> Self {
        let mut sums = [[0f64; HATS]; 3];
        let mut total = 0.0;
        for wm in facets.visible_normals(wo, STEPS) {
            let reflected = reflect(wo, wm);
            let (refracted, _, is_refracted) = refract(wo, wm, eta);
            let outer = if eta < 1.0 { -refracted.dot(wm) } else { wo.dot(wm) };
            let met = hats(outer);
            for (i, wi) in [reflected, -refracted].into_iter().enumerate() {
                let share = if wi.z > 0.0 { f64::from(facets.kept(wo, wi)) } else { 0.0 };
                if is_refracted {
                    (0..HATS).for_each(|k| sums[i][k] += share * f64::from(met[k]));
                } else if i == 0 {
                    total += share;
                }
                if is_refracted && i == 1 && eta < 1.0 {
                    let passed = share * f64::from(1.0 - fr_dielectric(outer, 1.0 / eta));
                    let lower = hats(outer.min(wi.z.max(0.0)));
                    (0..HATS).for_each(|k| sums[2][k] += passed * f64::from(met[k] - lower[k]));
                }
            }
        }
        let [reflected, refracted, losses] = sums.map(|sum| sum.map(|value| (value / NORMALS) as f32));
        Self { reflected, refracted, losses, total: (total / NORMALS) as f32 }
    }
}
