//! The Trowbridge–Reitz (GGX) distribution of microfacet normals, with Smith's masking and
//! shadowing.
//!
//! ```text
//! D(m)        = 1 / (π α_x α_y (x²/α_x² + y²/α_y² + z²)²)                  m = (x, y, z)
//! Λ(w)        = (√(1 + α² tan²θ) − 1)/2                    α² = α_x² cos²φ + α_y² sin²φ
//! G₁(w)       = 1/(1 + Λ(w))          G(wo, wi) = 1/(1 + Λ(wo) + Λ(wi))    height-correlated
//! D_w(m)      = G₁(w) |w·m| D(m) / |cos θ|                                 normals visible from w
//! ```
//!
//! D_w is sampled exactly: stretched by α, the surface is a hemisphere, whose projection towards w
//! is a disk next to half an ellipse.
//!
//! Sources: [Trowbridge 1975], [Walter 2007], [Heitz 2014], [Heitz 2018] for the sampling,
//! [Pharr 2023 §9.6].

use math::{Vec2, Vec3, Vector3, lerp, safe_sqrt, sqr};
use sampling::warp::sample_uniform_disk_polar;
use std::f32::consts::PI;

/// The Trowbridge–Reitz distribution of microfacet normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrowbridgeReitz {
    alpha_x: f32,
    alpha_y: f32,
}

impl TrowbridgeReitz {
    /// The roughnesses α along x and y of the local frame, each ≥ 0. Unless both are so small that
    /// the surface counts as [smooth](Self::effectively_smooth), neither is let below 0.0001.
    #[inline]
    pub fn new(alpha_x: f32, alpha_y: f32) -> Self {
        let distribution = Self { alpha_x, alpha_y };
        if distribution.effectively_smooth() {
            return distribution;
        }
        Self { alpha_x: alpha_x.max(1e-4), alpha_y: alpha_y.max(1e-4) }
    }

    /// The α of a perceptually uniform roughness in [0, 1]: its square root.
    #[inline]
    pub fn roughness_to_alpha(roughness: f32) -> f32 {
        roughness.sqrt()
    }

    /// Whether the surface is to be treated as a perfect mirror: both α below 0.001.
    #[inline]
    pub fn effectively_smooth(&self) -> bool {
        self.alpha_x.max(self.alpha_y) < 1e-3
    }

    /// D: the area of microfacets with normal `wm`, per solid angle and area of surface.
    #[inline]
    pub fn d(&self, wm: Vector3) -> f32 {
        let stretch = sqr(wm.x / self.alpha_x) + sqr(wm.y / self.alpha_y) + sqr(wm.z);
        1.0 / (PI * self.alpha_x * self.alpha_y * sqr(stretch))
    }

    /// Λ: microfacet area invisible from `w` (back-facing or masked) over the area visible.
    #[inline]
    pub fn lambda(&self, w: Vector3) -> f32 {
        let alpha2_tan2 = (sqr(w.x * self.alpha_x) + sqr(w.y * self.alpha_y)) / sqr(w.z);
        0.5 * ((1.0 + alpha2_tan2).sqrt() - 1.0)
    }

    /// G₁: the fraction of the microfacets facing `w` that are visible from it.
    #[inline]
    pub fn g1(&self, w: Vector3) -> f32 {
        1.0 / (1.0 + self.lambda(w))
    }

    /// G: the fraction of microfacets visible from both directions, height-correlated.
    #[inline]
    pub fn g(&self, wo: Vector3, wi: Vector3) -> f32 {
        1.0 / (1.0 + self.lambda(wo) + self.lambda(wi))
    }

    /// D_w: the density per solid angle of the normal `wm` among those that `w`, off the horizon,
    /// sees.
    #[inline]
    pub fn d_visible(&self, w: Vector3, wm: Vector3) -> f32 {
        self.g1(w) / w.z.abs() * self.d(wm) * w.dot(wm).abs()
    }

    /// A normal in the upper hemisphere with the density of [`Self::pdf`].
    #[inline]
    #[doc(alias = "Sample_wm")]
    pub fn sample_wm(&self, w: Vector3, u: Vec2) -> Vector3 {
        let stretched = Vec3::new(self.alpha_x * w.x, self.alpha_y * w.y, w.z).normalize();
        let wh = if stretched.z < 0.0 { -stretched } else { stretched };
        let t1 = if wh.z < 0.99999 { Vec3::new(-wh.y, wh.x, 0.0).normalize() } else { Vec3::X };
        let t2 = wh.cross(t1);

        let Vec2 { x, y } = sample_uniform_disk_polar(u);
        let y = lerp(0.5 * (1.0 + wh.z), safe_sqrt(1.0 - x * x), y);
        let nh = x * t1 + y * t2 + safe_sqrt(1.0 - x * x - y * y) * wh;
        Vec3::new(self.alpha_x * nh.x, self.alpha_y * nh.y, nh.z.max(1e-6)).normalize()
    }

    /// The density of [`Self::sample_wm`]: [`Self::d_visible`].
    #[inline]
    pub fn pdf(&self, w: Vector3, wm: Vector3) -> f32 {
        self.d_visible(w, wm)
    }

    /// Roughens a nearly smooth surface, so that paths with small probability are found: α below
    /// 0.3 is doubled, clamped to [0.1, 0.3].
    #[inline]
    pub fn regularize(&mut self) {
        for alpha in [&mut self.alpha_x, &mut self.alpha_y] {
            if *alpha < 0.3 {
                *alpha = (2.0 * *alpha).clamp(0.1, 0.3);
            }
        }
    }
}
