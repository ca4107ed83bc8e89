//! Reflection in microfacets, for two directions above.

use crate::TrowbridgeReitz;
use math::Vector3;

/// The facets that mirror one direction into another.
pub(super) struct Mirror {
    /// The value, if they reflect all light.
    pub f: f32,
    /// The density of their sampling, by what the first direction sees.
    pub pdf: f32,
    /// The cosine at which light meets them.
    pub cosine: f32,
}

impl Mirror {
    /// `None` for the facets of a smooth surface.
    #[inline]
    pub fn new(facets: &TrowbridgeReitz, wo: Vector3, wi: Vector3) -> Option<Self> {
        if facets.effectively_smooth() {
            return None;
        }
        let wm = (wo + wi).try_normalize()?;
        let quarter = 0.25 * facets.d(wm) / wo.z;
        let visible = 1.0 + facets.lambda(wo);
        let f = quarter / (wi.z * (visible + facets.lambda(wi)));
        Some(Self { f, pdf: quarter / visible, cosine: wo.dot(wm) })
    }
}
