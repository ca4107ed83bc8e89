//! Transparent bases: what is reflected inside, and what passes.

use super::shares::{Rests, Shares};
use super::{OpenPbr, of_viewer};
use crate::{BsdfSample, BxdfFlags, Directions, TransportMode, reflect, refract};
use lanes::{Callee, Mask, Real};
use math::{Vec2, Vec3, Vector3, same_hemisphere, sqr};
use spectrum::SampledSpectrum;
use std::f32::consts::PI;

impl<R: Real> OpenPbr<'_, R> {
    /// The reflectance of facets of glass from inside: what the base reflects, and what the layers
    /// outside do of the rest. Beyond the critical angle all light is reflected.
    #[inline(always)]
    pub(super) fn inner_reflectance(&self, cosine: R) -> SampledSpectrum<R> {
        R::call(InnerReflectance { surface: self, cosine })
    }

    /// The probability that a sample of glass with facets of normal `wm` is reflected.
    #[inline(always)]
    fn reflects(&self, wo: Vector3<R>, wm: Vector3<R>, directions: Directions) -> R {
        match directions {
            Directions::Reflection => R::one(),
            Directions::Transmission => R::zero(),
            Directions::All => {
                let cosine = wo.dot(wm).abs();
                let outside = self.stack.dielectrics(cosine, &self.waves).average();
                let is_below = !wo.z.gt(R::zero());
                if !is_below.any() {
                    return outside;
                }
                R::select(is_below, self.inner_reflectance(cosine).average(), outside)
            }
        }
    }

    /// A direction sampled by the facets of glass, without its value, and of the density only that
    /// of a smooth surface.
    #[inline(always)]
    pub(super) fn sample_glass(
        &self,
        wo: Vector3<R>,
        uc: R,
        u: Vec2<R>,
        directions: Directions,
    ) -> BsdfSample<R> {
        let is_smooth = self.stack.base.effectively_smooth();
        let wm = self.stack.base.sample_wm(wo, u);
        let wm = Vec3::select(is_smooth, Vec3::broadcast(Vec3::Z), wm);
        let share = self.reflects(wo, wm, directions);
        let reflects = uc.lt(share);
        let (refracted, eta, is_refracted) = refract(wo, wm, self.stack.index);
        let wi = Vec3::select(reflects, reflect(wo, wm), refracted);
        let on_its_side = !(same_hemisphere(wo, wi) ^ reflects) & wi.z.ne(R::zero());
        let width = BxdfFlags::choose(is_smooth, BxdfFlags::SPECULAR, BxdfFlags::GLOSSY);
        let side = BxdfFlags::choose(reflects, BxdfFlags::REFLECTION, BxdfFlags::TRANSMISSION);
        let pdf = R::select(reflects, share, R::one() - share);
        let sample = BsdfSample::new(SampledSpectrum::zero(), wi, pdf, width | side);
        let valid = (reflects | is_refracted) & on_its_side;
        BsdfSample { eta: R::select(reflects, R::one(), eta), valid, ..sample }
    }

    /// The density of [`Self::sample_glass`].
    #[inline(always)]
    pub(super) fn pdf_glass(&self, wo: Vector3<R>, wi: Vector3<R>, directions: Directions) -> R {
        let boundary = self.boundary();
        let (facet, is_met) = boundary.facet(wo, wi);
        if !is_met.any() {
            return R::zero();
        }
        let is_reflected = same_hemisphere(wo, wi);
        let share = self.reflects(wo, facet.wm, directions);
        let chance = R::select(is_reflected, share, R::one() - share);
        let side = R::select(is_reflected, R::one(), R::zero());
        R::select(is_met, chance * boundary.pdf_facet(wo, wi, &facet, side), R::zero())
    }

    /// The value of glass for two directions below.
    #[inline(always)]
    pub(super) fn reflected_inside(
        &self,
        shares: [&Shares<R>; 2],
        rests: &Rests<R>,
        wo: Vector3<R>,
        wi: Vector3<R>,
    ) -> SampledSpectrum<R> {
        let boundary = self.boundary();
        let (facet, is_met) = boundary.facet(wo, wi);
        let mut f = SampledSpectrum::zero();
        if is_met.any() {
            let white = boundary.f_facet(wo, wi, &facet, R::one(), TransportMode::Radiance);
            let white = R::select(is_met, white, R::zero());
            f += self.inner_reflectance(wo.dot(facet.wm).abs()) * white;
        }
        let has_rest = rests.glass_below.gt(R::zero());
        if has_rest.any() {
            let left = shares[0].inside.left * shares[1].inside.left;
            let again = left / (R::splat(PI) * rests.glass_below) * (R::one() - rests.through_below);
            f += SampledSpectrum::splat(R::select(has_rest, again, R::zero()));
        }
        f * self.glass()
    }

    /// The value of glass for directions on both sides.
    #[inline(always)]
    pub(super) fn transmitted(
        &self,
        shares: [&Shares<R>; 2],
        rests: &Rests<R>,
        [wo, wi]: [Vector3<R>; 2],
        mode: TransportMode,
    ) -> SampledSpectrum<R> {
        let is_above = wo.z.gt(R::zero());
        let outside = Vec3::select(is_above, wo, wi);
        let [o, i] = shares;
        let boundary = self.boundary();
        let (facet, is_met) = boundary.facet(wo, wi);
        let mut f = SampledSpectrum::zero();
        if is_met.any() {
            let outer = outside.dot(facet.wm).abs();
            let mut white = boundary.f_facet(wo, wi, &facet, R::zero(), mode);
            let has_layers = self.stack.has_layers();
            if has_layers.any() {
                // At least what `inner_reflectance` sends back does not pass.
                let below_coat = R::select(is_above, o.taken.below_coat, i.taken.below_coat);
                let passed = below_coat.min(self.passed(outer));
                white = R::select(has_layers, white * passed, white);
            }
            let white = R::select(is_met, white, R::zero());
            let reflected = self.stack.dielectrics(outer, &self.waves);
            f += (SampledSpectrum::splat(R::one()) - reflected) * white;
        }
        let has_rest = rests.glass_below.gt(R::zero());
        if has_rest.any() {
            // The rest of one side to that of the other, as energy from above to below.
            let above = R::select(is_above, o.glass_rest, i.glass_rest);
            let below = R::select(is_above, i.inside.left, o.inside.left);
            let down = above * below * rests.through_above / (R::splat(PI) * rests.glass_below);
            let scale = R::one() / sqr(self.stack.index);
            let scale = match mode {
                TransportMode::Radiance => R::select(is_above, scale, R::one()),
                TransportMode::Importance => R::select(is_above, R::one(), scale),
            };
            f += SampledSpectrum::splat(R::select(has_rest, down * scale, R::zero()));
        }
        // Tilts of the coat are not seen from inside.
        let is_outside = of_viewer([wo.z, wi.z], mode).gt(R::zero());
        let seen = R::select(is_outside, of_viewer([o.seen, i.seen], mode), R::one());
        f * self.transmission_color * self.absorbed(self.coat_length(outside.z)) * (self.glass() * seen)
    }
}

/// The reflectance of glass from inside.
struct InnerReflectance<'b, 'a, R: Real> {
    surface: &'b OpenPbr<'a, R>,
    cosine: R,
}

impl<R: Real> Callee<R> for InnerReflectance<'_, '_, R> {
    type Output = SampledSpectrum<R>;

    #[inline(always)]
    fn run(self) -> SampledSpectrum<R> {
        let Self { surface, cosine } = self;
        let one = SampledSpectrum::splat(R::one());
        // Of the cosine outside.
        let squared = R::one() - (R::one() - sqr(cosine)) * sqr(surface.stack.index);
        let outer = squared.max(R::zero()).sqrt();
        let mut reflected = surface.stack.dielectrics(outer, &surface.waves);
        let has_layers = surface.stack.has_layers();
        if has_layers.any() {
            let kept = R::one() - surface.passed(outer);
            let with_layers = reflected + (one - reflected) * kept;
            reflected = SampledSpectrum::select(has_layers, with_layers, reflected);
        }
        SampledSpectrum::select(squared.gt(R::zero()), reflected, one)
    }
}
