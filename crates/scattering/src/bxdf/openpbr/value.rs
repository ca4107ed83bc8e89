//! Values of the lobes from above, and of specular ones.

use super::chances::{COAT, GLASS};
use super::fuzz;
use super::mirror::Mirror;
use super::oren_nayar::oren_nayar;
use super::shares::{Rests, Shares};
use super::{OpenPbr, Weights, is_off_horizon, of_viewer, upright};
use crate::{BsdfSample, Scatter, TransportMode};
use lanes::{Callee, Int, Mask, Real, pow};
use math::{Vector3, same_hemisphere, sqr};
use spectrum::{N, SampledSpectrum};
use std::f32::consts::PI;

impl<R: Real> OpenPbr<'_, R> {
    /// Absorption in the coat on paths of these lengths, in units of its thickness.
    #[inline(always)]
    pub(super) fn absorbed(&self, lengths: R) -> SampledSpectrum<R> {
        let one = SampledSpectrum::splat(R::one());
        let is_clear = (self.coat_color - one).is_black();
        let absorbs = self.stack.coat_weight.gt(R::zero()) & !is_clear;
        if !absorbs.any() {
            return one;
        }
        let passed = R::call(Absorption { color: self.coat_color, lengths });
        SampledSpectrum::select(absorbs, one.lerp(passed, self.stack.coat_weight), one)
    }

    /// The length of a path through the coat.
    #[inline(always)]
    pub(super) fn coat_length(&self, cosine: R) -> R {
        let squared = R::one() - (R::one() - sqr(cosine)) / sqr(self.stack.coat_ior);
        R::one() / squared.sqrt().max(R::splat(1e-3))
    }

    /// The reflectance of the facets of the base met from above at a cosine.
    #[inline(always)]
    pub(super) fn reflectance(&self, cosine: R, weights: &Weights<R>) -> SampledSpectrum<R> {
        let zero = R::zero();
        let mut reflected = SampledSpectrum::zero();
        let mut glass = weights.glass;
        if self.stack.is_thin {
            if glass.gt(zero).any() {
                let [sheet, _] = self.sheet_shares(cosine);
                reflected += sheet * self.specular_color * glass;
            }
            glass = zero;
        }
        if weights.metal.gt(zero).any() {
            reflected += self.metal(cosine) * self.darkening * weights.metal;
        }
        if (weights.diffuse + glass).gt(zero).any() {
            let dielectric = self.stack.dielectrics(cosine, &self.waves) * self.specular_color;
            reflected += dielectric * (self.darkening * weights.diffuse + SampledSpectrum::splat(glass));
        }
        reflected
    }

    /// The value for two directions above of what `weights` say.
    #[inline(always)]
    pub(super) fn reflected(
        &self,
        [o, i]: [&Shares<R>; 2],
        rests: &Rests<R>,
        [wo, wi]: [Vector3<R>; 2],
        mode: TransportMode,
        weights: &Weights<R>,
    ) -> SampledSpectrum<R> {
        let (zero, black) = (R::zero(), SampledSpectrum::zero());
        let mut f = black;
        let has_fuzz = self.stack.fuzz_weight.gt(zero);
        if has_fuzz.any() {
            let fuzz = self.fuzz([o, i], rests, [wo, wi], weights);
            f += SampledSpectrum::select(has_fuzz, fuzz, black);
        }
        let is_coated = self.stack.coat_weight.gt(zero);
        if is_coated.any() {
            let mut below_fuzz = o.below_fuzz().min(i.below_fuzz());
            let is_tilted = self.is_tilted();
            if is_tilted.any() {
                let seen = of_viewer([o.below_fuzz(), i.below_fuzz()], mode);
                below_fuzz = R::select(is_tilted, seen, below_fuzz);
            }
            let coat = self.coat(wo, wi, mode) * below_fuzz;
            let coat = coat * self.stack.coat_weight * weights.layers;
            f += SampledSpectrum::splat(R::select(is_coated, coat, zero));
        }
        let mirror = Mirror::new(&self.stack.base, wo, wi);
        let white = mirror.f * o.taken.below_coat.min(i.taken.below_coat);
        let mut base = black;
        if white.gt(zero).any() {
            base += self.reflectance(mirror.cosine, weights) * white;
        }
        if weights.diffuse.gt(zero).any() {
            base += self.diffuse([o, i], rests, [wo, wi], weights);
        }
        let has_metal_rest = weights.metal.gt(zero) & rests.metal.gt(zero);
        if has_metal_rest.any() {
            let left = o.metal_rest() * i.metal_rest() / (R::splat(PI) * rests.metal);
            let left = R::select(has_metal_rest, left * weights.metal, zero);
            base += self.metal.again * self.darkening * left;
        }
        let has_glass_rest = weights.glass.gt(zero) & rests.glass_above.gt(zero);
        if has_glass_rest.any() {
            let left = o.glass_rest * i.glass_rest / (R::splat(PI) * rests.glass_above);
            let again = left * (R::one() - rests.through_above) * weights.glass;
            base += SampledSpectrum::splat(R::select(has_glass_rest, again, zero));
        }
        let seen = of_viewer([o.seen, i.seen], mode);
        f + base * self.absorbed(self.coat_length(wo.z) + self.coat_length(wi.z)) * seen
    }

    /// The value of the fibres.
    #[inline(always)]
    fn fuzz(
        &self,
        [o, i]: [&Shares<R>; 2],
        rests: &Rests<R>,
        directions: [Vector3<R>; 2],
        weights: &Weights<R>,
    ) -> SampledSpectrum<R> {
        let more = [o.taken.fuzz_more, i.taken.fuzz_more];
        let fuzz = fuzz::value(self.fuzz_color, self.stack.fuzz_roughness, rests.fuzz, directions, more);
        fuzz * (self.stack.fuzz_weight * weights.layers)
    }

    /// The value of the diffuse base, below the coat.
    #[inline(always)]
    fn diffuse(
        &self,
        [o, i]: [&Shares<R>; 2],
        rests: &Rests<R>,
        [wo, wi]: [Vector3<R>; 2],
        weights: &Weights<R>,
    ) -> SampledSpectrum<R> {
        let left = (o.diffuse_rest * i.diffuse_rest).safe_div(rests.diffuse);
        let goes_under = weights.under.gt(R::zero());
        let color = SampledSpectrum::select(goes_under, self.diffuse_base.over, self.diffuse_base.color);
        let over = R::one() - weights.under;
        let mut diffuse = oren_nayar(color, self.diffuse_base.roughness, wo, wi) * over;
        if self.stack.is_thin {
            let reflected = self.scattered(R::one() - self.diffuse_base.forward, wo, wi);
            diffuse = diffuse * self.diffuse_base.weight + reflected;
        }
        diffuse * left * self.darkening * weights.diffuse
    }

    /// The value for two directions off the horizon, of which `shares` are.
    #[inline(always)]
    pub(super) fn value(
        &self,
        shares: [&Shares<R>; 2],
        rests: &Rests<R>,
        directions: [Vector3<R>; 2],
        mode: TransportMode,
    ) -> SampledSpectrum<R> {
        R::call(ValueOf { surface: self, shares, rests, directions, mode })
    }

    /// The value of the lobe that a specular sample has chosen.
    #[inline(always)]
    pub(super) fn specular(
        &self,
        shares: &Shares<R>,
        wo: Vector3<R>,
        lobe: R::Int,
        sample: &BsdfSample<R>,
        mode: TransportMode,
    ) -> SampledSpectrum<R> {
        let (zero, wi) = (R::zero(), sample.wi);
        let is_coat = lobe.eq(R::Int::splat(COAT));
        let is_glass = lobe.eq(R::Int::splat(GLASS));
        let mut value = self.specular_base(shares, wo, is_glass, sample);
        let (mut seen, mut below_fuzz) = (shares.seen, shares.below_fuzz());
        let is_tilted = self.is_tilted();
        if mode == TransportMode::Importance && is_tilted.any() {
            let there = self.shares(wi);
            seen = there.seen;
            below_fuzz = R::select(is_tilted, there.below_fuzz(), below_fuzz);
        }
        if !self.stack.is_thin {
            // Tilts of the coat are not seen from inside.
            let is_inside = is_glass & of_viewer([wo.z, wi.z], mode).lt(zero);
            seen = R::select(is_inside, R::one(), seen);
        }
        value *= seen;
        if is_coat.any() {
            let is_above = wo.z.gt(zero);
            let (up, out) = (upright(!is_above, wo), upright(!is_above, wi));
            let coat = self.specular_coat(up, out, mode) * below_fuzz;
            let layers = self.weights(wo.z).layers;
            let coat = SampledSpectrum::splat(coat * self.stack.coat_weight * layers);
            value = SampledSpectrum::select(is_coat, coat, value);
        }
        let scale = match mode {
            TransportMode::Radiance => R::one() / sqr(sample.eta),
            TransportMode::Importance => R::one(),
        };
        value * (scale / wi.z.abs())
    }

    /// The share of light that the smooth base, below the layers, reflects or, where a sample is of
    /// the lobe of glass, scatters into its direction.
    #[inline(always)]
    fn specular_base(
        &self,
        shares: &Shares<R>,
        wo: Vector3<R>,
        is_glass: R::Mask,
        sample: &BsdfSample<R>,
    ) -> SampledSpectrum<R> {
        let (zero, cosine) = (R::zero(), wo.z.abs());
        let Weights { layers, metal, diffuse, under, glass } = self.weights(wo.z);
        let mut glass_here = glass;
        if !self.stack.is_thin {
            glass_here = R::select(is_glass, glass, zero);
        }
        let here = Weights {
            layers,
            metal: R::select(is_glass, zero, metal),
            diffuse: R::select(is_glass, zero, diffuse),
            under,
            glass: glass_here,
        };
        let tint = self.absorbed(R::splat(2.0) * self.coat_length(cosine));
        let mut value = self.reflectance(cosine, &here) * (tint * shares.taken.below_coat);
        if is_glass.any() {
            if self.stack.is_thin {
                let [_, passed] = self.sheet_shares(cosine);
                let through = passed * tint * (shares.taken.below_coat * self.glass());
                value = SampledSpectrum::select(is_glass, through, value);
            } else {
                let is_inside = is_glass & !wo.z.gt(zero);
                if is_inside.any() {
                    let inside = self.inner_reflectance(cosine) * self.glass();
                    value = SampledSpectrum::select(is_inside, inside, value);
                }
                let is_refracted = is_glass & sample.flags.is_transmissive();
                if is_refracted.any() {
                    let refracted = self.refracted(shares, wo, sample.wi);
                    value = SampledSpectrum::select(is_refracted, refracted, value);
                }
            }
        }
        value
    }

    /// The share of light that smooth glass refracts from one direction into another.
    #[inline(always)]
    fn refracted(&self, shares: &Shares<R>, wo: Vector3<R>, wi: Vector3<R>) -> SampledSpectrum<R> {
        let is_above = wo.z.gt(R::zero());
        let outside = R::select(is_above, wo.z, wi.z);
        let reflected = self.stack.dielectrics(outside, &self.waves);
        let tint = self.transmission_color * self.absorbed(self.coat_length(outside));
        let mut passed = shares.taken.below_coat;
        if !is_above.all() {
            passed = R::select(is_above, passed, self.passed(outside));
        }
        (SampledSpectrum::splat(R::one()) - reflected) * tint * (passed * self.glass())
    }
}

/// Light that is left after ways through the coat.
struct Absorption<R: Real> {
    color: SampledSpectrum<R>,
    lengths: R,
}

impl<R: Real> Callee<R> for Absorption<R> {
    type Output = SampledSpectrum<R>;

    #[inline(always)]
    fn run(self) -> SampledSpectrum<R> {
        let mut passed = self.color;
        // Not over the values, so that the translation for GPUs has the long function once.
        for i in 0..N {
            passed[i] = pow(passed[i], R::splat(0.5) * self.lengths);
        }
        passed
    }
}

/// The value for two directions off the horizon.
struct ValueOf<'b, 'a, R: Real> {
    surface: &'b OpenPbr<'a, R>,
    shares: [&'b Shares<R>; 2],
    rests: &'b Rests<R>,
    directions: [Vector3<R>; 2],
    mode: TransportMode,
}

impl<R: Real> Callee<R> for ValueOf<'_, '_, R> {
    type Output = SampledSpectrum<R>;

    #[inline(always)]
    fn run(self) -> SampledSpectrum<R> {
        let Self { surface, shares, rests, directions, mode } = self;
        let [wo, wi] = directions;
        let (zero, black) = (R::zero(), SampledSpectrum::zero());
        let is_below = wo.z.lt(zero);
        let is_same = same_hemisphere(wo, wi);
        let up = [upright(is_below, wo), upright(is_below, wi)];
        let glass = surface.glass();
        let is_glass = glass.gt(zero);
        let mut f = black;
        if surface.stack.is_thin {
            if is_same.any() {
                f = surface.reflected(shares, rests, up, mode, &surface.weights(R::one()));
            }
            if !is_same.all() {
                let through = surface.passed_through(shares, rests, up, mode);
                f = SampledSpectrum::select(is_same, f, through);
            }
            return f;
        }
        let reflects = is_same & (!is_below | glass.lt(R::one()));
        if reflects.any() {
            let reflected = surface.reflected(shares, rests, up, mode, &surface.weights(wo.z));
            f = SampledSpectrum::select(reflects, reflected, black);
        }
        let reflects_inside = is_same & is_below & is_glass;
        if reflects_inside.any() {
            let inside = surface.reflected_inside(shares, rests, wo, wi);
            f += SampledSpectrum::select(reflects_inside, inside, black);
        }
        let transmits = !is_same & is_glass;
        if transmits.any() {
            let through = surface.transmitted(shares, rests, [wo, wi], mode);
            f = SampledSpectrum::select(transmits, through, f);
        }
        f
    }
}

impl OpenPbr<'_> {
    /// The value of fibres and the diffuse base alone, for two directions on the same side.
    pub(in super::super) fn diffused(
        &self,
        wo: Vector3,
        wi: Vector3,
        mode: TransportMode,
    ) -> SampledSpectrum {
        if !(is_off_horizon(wo) && is_off_horizon(wi)) {
            return SampledSpectrum::ZERO;
        }
        if self.is_lobe() {
            return self.f(wo, wi, mode);
        }
        let (below, weights) = (wo.z < 0.0, self.weights(wo.z));
        let directions @ [wo, wi] = [upright(below, wo), upright(below, wi)];
        let (o, i, rests) = (self.shares(wo), self.shares(wi), self.rests());
        let absorbed = self.absorbed(self.coat_length(wo.z) + self.coat_length(wi.z));
        let mut f = SampledSpectrum::ZERO;
        if self.stack.fuzz_weight > 0.0 {
            f += self.fuzz([&o, &i], &rests, directions, &weights);
        }
        if weights.diffuse > 0.0 {
            let seen = of_viewer([o.seen, i.seen], mode);
            f += self.diffuse([&o, &i], &rests, directions, &weights) * absorbed * seen;
        }
        f
    }
}
