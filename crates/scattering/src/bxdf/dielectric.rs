//! Glass, water and other dielectrics: light is reflected and refracted, by a smooth surface or by
//! microfacets that are.
//!
//! With F the Fresnel reflectance at the microfacet and η' the relative index that light from `wo`
//! meets,
//!
//! ```text
//! reflection     wm ∝ wo + wi
//!                f = D(wm) G F / |4 cos θ_i cos θ_o|
//!                p = F · D_wo(wm) / (4 |wo·wm|)
//! transmission   wm ∝ wo + η' wi
//!                f = D(wm) G (1 − F) |wi·wm wo·wm / (cos θ_i cos θ_o (wi·wm + wo·wm/η')²)|
//!                p = (1 − F) · D_wo(wm) |wi·wm| / (wi·wm + wo·wm/η')²
//! ```
//!
//! and transmitted radiance is divided by η'². An index of 1 is no interface at all, whatever the
//! roughness. Multiple scattering between microfacets is ignored. Sources: [Walter 2007],
//! [Pharr 2023 §9.5, §9.7].

use super::{BsdfSample, Scatter};
use crate::{BxdfFlags, Directions, TransportMode, TrowbridgeReitz, fr_dielectric, reflect, refract};
use lanes::{Mask, Real};
use math::{Vec2, Vec3, Vector3, same_hemisphere, sqr};
use spectrum::SampledSpectrum;

/// An interface between dielectrics.
#[derive(Clone, Copy, Debug)]
pub struct Dielectric<R = f32> {
    /// Index of refraction below the surface over that above; > 0.
    pub eta: R,
    /// Roughness.
    pub distribution: TrowbridgeReitz<R>,
}

/// What turns `wo` into `wi`: microfacets of normal `wm` in the upper hemisphere.
pub(super) struct Facet<R: Real> {
    pub wm: Vector3<R>,
    /// Whether the facet reflects; else it refracts.
    reflects: R::Mask,
    /// The relative index met from `wo` to `wi`; 1 where the facet reflects.
    eta: R,
}

impl<R: Real> Dielectric<R> {
    #[inline(always)]
    fn is_specular(&self) -> R::Mask {
        self.eta.eq(R::one()) | self.distribution.effectively_smooth()
    }

    /// The facets that turn `wo` into `wi`, and where there are any that are not those of a smooth
    /// surface and both directions are on their front side.
    #[inline(always)]
    pub(super) fn facet(&self, wo: Vector3<R>, wi: Vector3<R>) -> (Facet<R>, R::Mask) {
        let reflects = same_hemisphere(wo, wi);
        let eta = R::select(wo.z.gt(R::zero()), self.eta, R::one() / self.eta);
        let eta = R::select(reflects, R::one(), eta);
        let (wm, valid) = (wi * eta + wo).normalize_masked();
        let wm = Vec3::select(wm.z.lt(R::zero()), -wm, wm);
        let valid = valid & faces(wm, wo) & faces(wm, wi) & !self.is_specular();
        (Facet { wm, reflects, eta }, valid)
    }

    /// The value at `facet`, which reflects the share `fresnel`.
    #[inline(always)]
    pub(super) fn f_facet(
        &self,
        wo: Vector3<R>,
        wi: Vector3<R>,
        facet: &Facet<R>,
        fresnel: R,
        mode: TransportMode,
    ) -> R {
        let Facet { wm, reflects, eta } = *facet;
        let facets = self.distribution.d(wm) * self.distribution.g(wo, wi) / (wi.z * wo.z).abs();
        let fr = R::splat(0.25) * facets * fresnel;
        if reflects.all() {
            return fr;
        }
        let (cos_i, cos_o) = (wi.dot(wm), wo.dot(wm));
        let ft = facets * (R::one() - fresnel) * (cos_i * cos_o).abs() / sqr(cos_i + cos_o / eta);
        let ft = match mode {
            TransportMode::Radiance => ft / sqr(eta),
            TransportMode::Importance => ft,
        };
        R::select(reflects, fr, ft)
    }

    /// The density of `wi` where `facet` is sampled and reflects with probability `pr`.
    #[inline(always)]
    pub(super) fn pdf_facet(&self, wo: Vector3<R>, wi: Vector3<R>, facet: &Facet<R>, pr: R) -> R {
        let Facet { wm, reflects, eta } = *facet;
        let pdf_wm = self.distribution.pdf(wo, wm);
        let reflection = pr * pdf_wm / (R::splat(4.0) * wo.dot(wm).abs());
        if reflects.all() {
            return reflection;
        }
        let (cos_i, cos_o) = (wi.dot(wm), wo.dot(wm));
        let refraction = (R::one() - pr) * pdf_wm * cos_i.abs() / sqr(cos_i + cos_o / eta);
        R::select(reflects, reflection, refraction)
    }

    #[inline(always)]
    fn sample_specular(
        &self,
        wo: Vector3<R>,
        uc: R,
        mode: TransportMode,
        directions: Directions,
    ) -> BsdfSample<R> {
        let fresnel = fr_dielectric(wo.z, self.eta);
        let fresnel = R::select(self.eta.eq(R::one()), R::zero(), fresnel);
        let (pr, valid) = directions.probability_of_reflection(fresnel, R::one() - fresnel);
        let reflects = uc.lt(pr);
        let mirrored = Vec3::new(-wo.x, -wo.y, wo.z);
        let (refracted, eta, not_total) = refract(wo, Vec3::broadcast(Vec3::Z), self.eta);
        let wi = Vec3::select(reflects, mirrored, refracted);
        let scale = match mode {
            TransportMode::Radiance => R::one() / sqr(eta),
            TransportMode::Importance => R::one(),
        };
        let share = R::select(reflects, fresnel, scale * (R::one() - fresnel));
        let lobe =
            BxdfFlags::choose(reflects, BxdfFlags::SPECULAR_REFLECTION, BxdfFlags::SPECULAR_TRANSMISSION);
        let f = SampledSpectrum::splat(share / wi.z.abs());
        let pdf = R::select(reflects, pr, R::one() - pr);
        let eta = R::select(reflects, R::one(), eta);
        BsdfSample { eta, valid: valid & (reflects | not_total), ..BsdfSample::new(f, wi, pdf, lobe) }
    }

    #[inline(always)]
    fn sample_glossy(
        &self,
        wo: Vector3<R>,
        uc: R,
        u: Vec2<R>,
        mode: TransportMode,
        directions: Directions,
    ) -> BsdfSample<R> {
        let wm = self.distribution.sample_wm(wo, u);
        let fresnel = fr_dielectric(wo.dot(wm), self.eta);
        let (pr, valid) = directions.probability_of_reflection(fresnel, R::one() - fresnel);
        let reflects = uc.lt(pr);
        let (refracted, eta, not_total) = refract(wo, wm, self.eta);
        let wi = Vec3::select(reflects, reflect(wo, wm), refracted);
        let eta = R::select(reflects, R::one(), eta);
        let on_its_side = !(same_hemisphere(wo, wi) ^ reflects) & wi.z.ne(R::zero());
        let valid = valid & (reflects | not_total) & on_its_side;
        if !valid.any() {
            return BsdfSample::invalid();
        }
        let facet = Facet { wm, reflects, eta };
        let f = SampledSpectrum::splat(self.f_facet(wo, wi, &facet, fresnel, mode));
        let pdf = self.pdf_facet(wo, wi, &facet, pr);
        let lobe = BxdfFlags::choose(reflects, BxdfFlags::GLOSSY_REFLECTION, BxdfFlags::GLOSSY_TRANSMISSION);
        BsdfSample { eta, valid, ..BsdfSample::new(f, wi, pdf, lobe) }
    }
}

impl<R: Real> Scatter<R> for Dielectric<R> {
    #[inline(always)]
    fn flags(&self) -> BxdfFlags<R> {
        let width = BxdfFlags::choose(
            self.is_specular(),
            BxdfFlags::SPECULAR_TRANSMISSION,
            BxdfFlags::GLOSSY_TRANSMISSION,
        );
        width | BxdfFlags::only_where(self.eta.ne(R::one()), BxdfFlags::REFLECTION)
    }

    #[inline(always)]
    fn f(&self, wo: Vector3<R>, wi: Vector3<R>, mode: TransportMode) -> SampledSpectrum<R> {
        let (facet, valid) = self.facet(wo, wi);
        if !valid.any() {
            return SampledSpectrum::zero();
        }
        let fresnel = fr_dielectric(wo.dot(facet.wm), self.eta);
        let f = self.f_facet(wo, wi, &facet, fresnel, mode);
        SampledSpectrum::splat(R::select(valid, f, R::zero()))
    }

    #[inline(always)]
    fn sample_f(
        &self,
        wo: Vector3<R>,
        uc: R,
        u: Vec2<R>,
        mode: TransportMode,
        directions: Directions,
    ) -> BsdfSample<R> {
        let specular = self.is_specular();
        let sample = if specular.all() {
            self.sample_specular(wo, uc, mode, directions)
        } else {
            let glossy = self.sample_glossy(wo, uc, u, mode, directions);
            if specular.any() {
                BsdfSample::select(specular, self.sample_specular(wo, uc, mode, directions), glossy)
            } else {
                glossy
            }
        };
        BsdfSample { valid: sample.valid & wo.z.ne(R::zero()), ..sample }
    }

    #[inline(always)]
    fn pdf(&self, wo: Vector3<R>, wi: Vector3<R>, _: TransportMode, directions: Directions) -> R {
        let (facet, valid) = self.facet(wo, wi);
        if !valid.any() {
            return R::zero();
        }
        let fresnel = fr_dielectric(wo.dot(facet.wm), self.eta);
        let (pr, scatters) = directions.probability_of_reflection(fresnel, R::one() - fresnel);
        R::select(valid & scatters, self.pdf_facet(wo, wi, &facet, pr), R::zero())
    }

    #[inline(always)]
    fn regularize(&mut self, mask: R::Mask) {
        self.distribution.regularize(mask);
    }
}
/// Whether `w` lies on the same side of a microfacet as of the surface.
#[inline(always)]
fn faces<R: Real>(wm: Vector3<R>, w: Vector3<R>) -> R::Mask {
    w.z.ne(R::zero()) & (wm.dot(w) * w.z).ge(R::zero())
}
