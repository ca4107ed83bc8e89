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

use lanes::{Each, Real};
use math::{Vec2, Vec3, Vector3, lerp, safe_sqrt, sqr};
use sampling::warp::sample_uniform_disk_polar;
use std::f32::consts::PI;

/// The Trowbridge–Reitz distribution of microfacet normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrowbridgeReitz<R = f32> {
    alpha_x: R,
    alpha_y: R,
}

impl<R: Real> TrowbridgeReitz<R> {
    /// The roughnesses α along x and y of the local frame, each ≥ 0. Unless both are so small that
    /// the surface counts as [smooth](Self::effectively_smooth), neither is let below 0.0001.
    #[inline(always)]
    pub fn new(alpha_x: R, alpha_y: R) -> Self {
        let smooth = Self { alpha_x, alpha_y }.effectively_smooth();
        let [alpha_x, alpha_y] =
            [alpha_x, alpha_y].each(|alpha| R::select(smooth, alpha, alpha.max(R::splat(1e-4))));
        Self { alpha_x, alpha_y }
    }

    /// The α of a perceptually uniform roughness in [0, 1]: its square root.
    #[inline(always)]
    pub fn roughness_to_alpha(roughness: R) -> R {
        roughness.sqrt()
    }

    /// Whether the surface is to be treated as a perfect mirror: both α below 0.001.
    #[inline(always)]
    pub fn effectively_smooth(&self) -> R::Mask {
        self.alpha_x.max(self.alpha_y).lt(R::splat(1e-3))
    }

    /// D: the area of microfacets with normal `wm`, per solid angle and area of surface.
    #[inline(always)]
    pub fn d(&self, wm: Vector3<R>) -> R {
        let stretch = sqr(wm.x / self.alpha_x) + sqr(wm.y / self.alpha_y) + sqr(wm.z);
        R::one() / (R::splat(PI) * self.alpha_x * self.alpha_y * sqr(stretch))
    }

    /// Λ: microfacet area invisible from `w` (back-facing or masked) over the area visible.
    #[inline(always)]
    pub fn lambda(&self, w: Vector3<R>) -> R {
        let alpha2_tan2 = (sqr(w.x * self.alpha_x) + sqr(w.y * self.alpha_y)) / sqr(w.z);
        ((R::one() + alpha2_tan2).sqrt() - R::one()) * R::splat(0.5)
    }

    /// G₁: the fraction of the microfacets facing `w` that are visible from it.
    #[inline(always)]
    pub fn g1(&self, w: Vector3<R>) -> R {
        R::one() / (R::one() + self.lambda(w))
    }

    /// G: the fraction of microfacets visible from both directions, height-correlated.
    #[inline(always)]
    pub fn g(&self, wo: Vector3<R>, wi: Vector3<R>) -> R {
        R::one() / (R::one() + self.lambda(wo) + self.lambda(wi))
    }

    /// D_w: the density per solid angle of the normal `wm` among those that `w`, off the horizon,
    /// sees.
    #[inline(always)]
    pub fn d_visible(&self, w: Vector3<R>, wm: Vector3<R>) -> R {
        self.g1(w) / w.z.abs() * self.d(wm) * w.dot(wm).abs()
    }

    /// A normal in the upper hemisphere with the density of [`Self::pdf`].
    #[inline(always)]
    #[doc(alias = "Sample_wm")]
    pub fn sample_wm(&self, w: Vector3<R>, u: Vec2<R>) -> Vector3<R> {
        let stretched = Vec3::new(self.alpha_x * w.x, self.alpha_y * w.y, w.z).normalize();
        let wh = Vec3::select(stretched.z.lt(R::zero()), -stretched, stretched);
        let across = Vec3::new(-wh.y, wh.x, R::zero()).normalize();
        let t1 = Vec3::select(wh.z.lt(R::splat(0.99999)), across, Vec3::broadcast(Vec3::X));
        let t2 = wh.cross(t1);

        let Vec2 { x, y } = sample_uniform_disk_polar(u);
        let y = lerp((R::one() + wh.z) * R::splat(0.5), safe_sqrt(R::one() - x * x), y);
        let nh = t1 * x + t2 * y + wh * safe_sqrt(R::one() - x * x - y * y);
        Vec3::new(self.alpha_x * nh.x, self.alpha_y * nh.y, nh.z.max(R::splat(1e-6))).normalize()
    }

    /// The density of [`Self::sample_wm`]: [`Self::d_visible`].
    #[inline(always)]
    pub fn pdf(&self, w: Vector3<R>, wm: Vector3<R>) -> R {
        self.d_visible(w, wm)
    }

    /// Whether both α are the same.
    #[inline(always)]
    pub(crate) fn is_isotropic(&self) -> R::Mask {
        self.alpha_x.eq(self.alpha_y)
    }

    /// The distribution whose α are `scale` times as large.
    #[inline(always)]
    pub(crate) fn scaled(&self, scale: R) -> Self {
        Self::new(self.alpha_x * scale, self.alpha_y * scale)
    }

    /// √(α_x α_y).
    #[inline(always)]
    pub(crate) fn mean_alpha(&self) -> R {
        (self.alpha_x * self.alpha_y).sqrt()
    }

    /// The distribution whose α² are larger by `scale` times those of `by`.
    #[inline(always)]
    pub(crate) fn widened(&self, by: &Self, scale: R) -> Self {
        let alpha_x = (sqr(self.alpha_x) + scale * sqr(by.alpha_x)).sqrt();
        let alpha_y = (sqr(self.alpha_y) + scale * sqr(by.alpha_y)).sqrt();
        Self::new(alpha_x, alpha_y)
    }

    /// Roughens nearly smooth surfaces where the mask is true, so that paths with small probability
    /// are found: α below 0.3 is doubled, clamped to [0.1, 0.3].
    #[inline(always)]
    pub fn regularize(&mut self, mask: R::Mask) {
        for alpha in [&mut self.alpha_x, &mut self.alpha_y] {
            let rough = (R::splat(2.0) * *alpha).clamp(R::splat(0.1), R::splat(0.3));
            *alpha = R::select(mask & alpha.lt(R::splat(0.3)), rough, *alpha);
        }
    }
}

impl TrowbridgeReitz {
    /// `steps`² normals of facets that a direction sees, each of the same share of what it sees.
    pub(crate) fn visible_normals(&self, wo: Vector3, steps: usize) -> impl Iterator<Item = Vector3> {
        let middle = move |i: usize| (i as f32 + 0.5) / steps as f32;
        (0..steps * steps).map(move |i| self.sample_wm(wo, Vec2::new(middle(i % steps), middle(i / steps))))
    }

    /// The share of the light from facets seen by `wo` that leaves to `wi`.
    pub(crate) fn kept(&self, wo: Vector3, wi: Vector3) -> f32 {
        self.g(wo, wi) / self.g1(wo)
    }
}
