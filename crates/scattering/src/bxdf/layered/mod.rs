//! Layers: a dielectric coat over an opaque base, with a medium between them or without.
//!
//! Light that enters the coat is reflected between base and coat until it leaves. With the
//! transmission T and inner reflection R of the coat and the reflection B of the base,
//!
//! ```text
//! f = f_coat + T B T + T B R B T + T B R B R B T + …
//! ```
//!
//! where each product is an integral over the directions between two layers. Random walks estimate
//! the sum, but for a smooth clear coat over a diffuse base, where it has a closed form. The medium
//! has the extinction coefficient 1, so that `thickness` is an optical one, and a Henyey–Greenstein
//! phase function. Without scattering (`albedo` 0) it only absorbs.
//!
//! An estimated `f` is the same for the same directions and `seed`, and a steady function of the
//! directions but for choices within the walk. Samples are walks of their own
//! whose densities are unknown: [`BsdfSample::pdf_is_proportional`]. `pdf` approximates their
//! density by a closed form: reflection by the coat; one reflection by the base, in a lobe that is
//! widened by the refractions; and a tenth of everything that enters spread evenly over the
//! hemisphere, for all that is neither. So it is a density, though not exactly that of the samples,
//! and weights of multiple importance sampling may be computed from it in any algorithm.
//!
//! A walk has `max_depth` events between entrance and exit at most. Both sides of the surface are
//! coated. Sources: [Guo 2018], [Pharr 2023 §14.3].

mod closed;
mod walk;

use super::{BsdfSample, Conductor, Dielectric, Diffuse, Scatter};
use crate::fresnel::mean_fresnel;
use crate::{BxdfFlags, Directions, HenyeyGreenstein, TransportMode, fr_dielectric, refract};
use lanes::{Callee, Int, Mask, Real, exp};
use math::{Vec2, Vec3, Vector3, lerp, sqr};
use sampling::HashSequence;
use sampling::warp::cosine_hemisphere_pdf;
use spectrum::SampledSpectrum;
use walk::{Estimate, SampleWalk};

pub use closed::inner_reflectance;

/// A dielectric coat over an opaque base.
#[derive(Clone, Copy, Debug)]
pub struct Layered<B, R: Real = f32> {
    /// What lies below the coat, with indices of refraction relative to it.
    pub base: B,
    /// The outer surface of the coat.
    pub interface: Dielectric<R>,
    /// Optical thickness of the medium in the coat; ≥ 0.
    pub thickness: R,
    /// Single-scattering albedo of that medium; 0 where it only absorbs.
    pub albedo: SampledSpectrum<R>,
    /// Its phase function.
    pub phase: HenyeyGreenstein<R>,
    /// The [`inner_reflectance`] of the coat if it is smooth. Below zero where that is not known;
    /// there is no closed form then.
    pub inner: R,
    /// The number of events inside of the coat, at most.
    pub max_depth: u32,
    /// Walks per value of `f`; ≥ 1.
    pub samples: u32,
    /// Chooses the walks of values, see [`Scatter::seed`].
    pub seed: R::Int,
}

/// What lies below a coat.
pub trait CoatedBase<R: Real>: Scatter<R> + Copy {
    /// The albedo of a base that scatters light evenly, whatever its direction, and where it does.
    fn even_albedo(&self) -> (SampledSpectrum<R>, R::Mask);

    /// The density outside of the coat of light from `wo` that is refracted inwards, reflected by
    /// the base once and refracted outwards, given that it enters. Both directions are above.
    fn pdf_through(&self, interface: &Dielectric<R>, wo: Vector3<R>, wi: Vector3<R>) -> R;
}

impl<R: Real> CoatedBase<R> for Diffuse<R> {
    #[inline(always)]
    fn even_albedo(&self) -> (SampledSpectrum<R>, R::Mask) {
        (self.reflectance, R::Mask::splat(true))
    }

    /// Uniform radiance below the coat leaves it as T(cos θ), by the reciprocity of T.
    #[inline(always)]
    fn pdf_through(&self, interface: &Dielectric<R>, _: Vector3<R>, wi: Vector3<R>) -> R {
        let transmitted = R::one() - fr_dielectric(wi.z, interface.eta);
        cosine_hemisphere_pdf(wi.z) * transmitted / (R::one() - mean_fresnel(interface.eta))
    }
}

impl<R: Real> CoatedBase<R> for Conductor<R> {
    #[inline(always)]
    fn even_albedo(&self) -> (SampledSpectrum<R>, R::Mask) {
        (SampledSpectrum::zero(), R::Mask::splat(false))
    }

    /// A reflection off microfacets of slope s turns light by 2s, a refraction by (1 − 1/η)s.
    #[inline(always)]
    fn pdf_through(&self, interface: &Dielectric<R>, wo: Vector3<R>, wi: Vector3<R>) -> R {
        let up = Vec3::broadcast(Vec3::Z);
        let (inner_o, eta, enters) = refract(wo, up, interface.eta);
        let (inner_i, _, leaves) = refract(wi, up, interface.eta);
        let turn = R::one() - R::one() / eta;
        let distribution = self.distribution.widened(&interface.distribution, sqr(turn) * R::splat(0.5));
        let lobe = Conductor { distribution, ..*self };
        let pdf = lobe.pdf(-inner_o, -inner_i, TransportMode::Radiance, Directions::All);
        // The solid angle inside over that outside.
        let squeeze = wi.z / (sqr(eta) * inner_i.z.abs());
        R::select(enters & leaves & inner_i.z.ne(R::zero()), pdf * squeeze, R::zero())
    }
}

impl<R: Real, B: CoatedBase<R>> Layered<B, R> {
    #[inline(always)]
    fn has_medium(&self) -> R::Mask {
        !self.albedo.is_black()
    }

    /// The random numbers of walk `index` of a value.
    #[inline(always)]
    fn random(&self, index: u32) -> HashSequence<R::Int> {
        HashSequence::new([self.seed, R::Int::splat(index)])
    }
}

/// `w` turned around where `below`.
#[inline(always)]
fn flip<R: Real>(below: R::Mask, w: Vector3<R>) -> Vector3<R> {
    Vec3::select(below, -w, w)
}

impl<R: Real, B: CoatedBase<R>> Scatter<R> for Layered<B, R> {
    #[inline(always)]
    fn flags(&self) -> BxdfFlags<R> {
        let (coat, base) = (self.interface.flags(), self.base.flags());
        let smooth = coat.is_specular();
        let diffuse = base.is_diffuse() | self.has_medium();
        BxdfFlags::splat(BxdfFlags::REFLECTION)
            | BxdfFlags::only_where(smooth, BxdfFlags::SPECULAR)
            | BxdfFlags::only_where(diffuse, BxdfFlags::DIFFUSE)
            | BxdfFlags::only_where(!smooth | base.is_glossy(), BxdfFlags::GLOSSY)
    }

    #[inline(always)]
    fn f(&self, wo: Vector3<R>, wi: Vector3<R>, mode: TransportMode) -> SampledSpectrum<R> {
        let below = wo.z.lt(R::zero());
        R::call(Value { layers: self, wo: flip::<R>(below, wo), wi: flip::<R>(below, wi), mode })
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
        if !directions.reflection() {
            return BsdfSample::invalid();
        }
        let below = wo.z.lt(R::zero());
        let sample = R::call(Sample { layers: self, wo: flip::<R>(below, wo), uc, u, mode });
        let valid = sample.valid & wo.z.ne(R::zero());
        BsdfSample { wi: flip::<R>(below, sample.wi), valid, ..sample }
    }

    #[inline(always)]
    fn pdf(&self, wo: Vector3<R>, wi: Vector3<R>, mode: TransportMode, directions: Directions) -> R {
        if !directions.reflection() {
            return R::zero();
        }
        let below = wo.z.lt(R::zero());
        R::call(Density { layers: self, wo: flip::<R>(below, wo), wi: flip::<R>(below, wi), mode })
    }

    #[inline(always)]
    fn regularize(&mut self, mask: R::Mask) {
        self.interface.regularize(mask);
        self.base.regularize(mask);
    }

    #[inline(always)]
    fn seed(&mut self, seed: R::Int) {
        self.seed = seed;
    }
}

/// The value for `wo` above. Like samples and densities it is called, because kernels of several
/// algorithms have it.
struct Value<'a, B, R: Real> {
    layers: &'a Layered<B, R>,
    wo: Vector3<R>,
    wi: Vector3<R>,
    mode: TransportMode,
}

impl<R: Real, B: CoatedBase<R>> Callee<R> for Value<'_, B, R> {
    type Output = SampledSpectrum<R>;

    #[inline(always)]
    fn run(self) -> SampledSpectrum<R> {
        let Self { layers, wo, wi, mode } = self;
        let valid = wo.z.gt(R::zero()) & wi.z.gt(R::zero()) & layers.flags().is_non_specular();
        if !valid.any() {
            return SampledSpectrum::zero();
        }
        let mut f = SampledSpectrum::zero();
        let (albedo, closed) = layers.closed_form();
        if closed.any() {
            f = layers.f_closed(albedo, wo, wi);
        }
        let estimated = valid & !closed;
        if estimated.any() {
            let mut sum = SampledSpectrum::zero();
            for index in 0..layers.samples {
                sum += R::call(Estimate { layers, wo, wi, mode, random: layers.random(index) });
            }
            let estimate = layers.interface.f(wo, wi, mode) + sum / R::splat(layers.samples as f32);
            f = SampledSpectrum::select(estimated, estimate, f);
        }
        SampledSpectrum::select(valid, f, SampledSpectrum::zero())
    }
}

/// A sample for `wo` above.
struct Sample<'a, B, R: Real> {
    layers: &'a Layered<B, R>,
    wo: Vector3<R>,
    uc: R,
    u: Vec2<R>,
    mode: TransportMode,
}

impl<R: Real, B: CoatedBase<R>> Callee<R> for Sample<'_, B, R> {
    type Output = BsdfSample<R>;

    #[inline(always)]
    fn run(self) -> BsdfSample<R> {
        let Self { layers, wo, uc, u, mode } = self;
        let (albedo, closed) = layers.closed_form();
        if !closed.any() {
            return R::call(SampleWalk { layers, wo, uc, u, mode });
        }
        let exact = layers.sample_closed(albedo, wo, uc, u, mode);
        if closed.all() {
            return exact;
        }
        let walk = R::call(SampleWalk { layers, wo, uc, u, mode });
        BsdfSample { pdf_is_proportional: true, ..BsdfSample::select(closed, exact, walk) }
    }
}

/// The density for `wo` above.
struct Density<'a, B, R: Real> {
    layers: &'a Layered<B, R>,
    wo: Vector3<R>,
    wi: Vector3<R>,
    mode: TransportMode,
}

impl<R: Real, B: CoatedBase<R>> Callee<R> for Density<'_, B, R> {
    type Output = R;

    #[inline(always)]
    fn run(self) -> R {
        let Self { layers, wo, wi, mode } = self;
        let valid = wo.z.gt(R::zero()) & wi.z.gt(R::zero()) & layers.flags().is_non_specular();
        if !valid.any() {
            return R::zero();
        }
        let interface = &layers.interface;
        let reflected = interface.pdf(wo, wi, mode, Directions::All);
        let entering = R::one() - fr_dielectric(wo.z, interface.eta);
        // Of the light that goes down and up again, the share that the medium scatters.
        let in_medium = R::one() - exp(layers.thickness * R::splat(-2.0));
        let in_medium = R::select(layers.has_medium(), in_medium, R::zero());
        let even = R::splat(0.1) + R::splat(0.9) * in_medium;
        let through = layers.base.pdf_through(interface, wo, wi);
        let mut pdf = reflected + entering * lerp(even, through, cosine_hemisphere_pdf(wi.z));
        let (_, closed) = layers.closed_form();
        if closed.any() {
            pdf = R::select(closed, layers.pdf_closed(wo, wi), pdf);
        }
        R::select(valid, pdf, R::zero())
    }
}
