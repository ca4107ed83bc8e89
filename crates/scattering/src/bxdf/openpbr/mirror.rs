//! Reflection in microfacets, for two directions above.

use crate::TrowbridgeReitz;
use lanes::Real;
use math::Vector3;

/// The facets that mirror one direction into another. All is zero where the surface is smooth.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mirror<R> {
    /// The value, if they reflect all light.
    pub f: R,
    /// The density of their sampling, by what the first direction sees.
    pub pdf: R,
    /// The cosine at which light meets them.
    pub cosine: R,
}

impl<R: Real> Mirror<R> {
    /// The facets of a surface for two directions.
    #[inline(always)]
    pub fn new(facets: &TrowbridgeReitz<R>, wo: Vector3<R>, wi: Vector3<R>) -> Self {
        let (wm, is_found) = (wo + wi).normalize_masked();
        let is_found = is_found & !facets.effectively_smooth();
        let quarter = R::splat(0.25) * facets.d(wm) / wo.z;
        let visible = R::one() + facets.lambda(wo);
        let f = quarter / (wi.z * (visible + facets.lambda(wi)));
        let zero = R::zero();
        Self {
            f: R::select(is_found, f, zero),
            pdf: R::select(is_found, quarter / visible, zero),
            cosine: R::select(is_found, wo.dot(wm), zero),
        }
    }
}
