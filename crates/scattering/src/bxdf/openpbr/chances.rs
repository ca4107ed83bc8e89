//! The probabilities of lobes, about what each scatters from a direction, and their densities.

use super::mirror::Mirror;
use super::shares::{Rests, Shares};
use super::{OpenPbr, upright};
use crate::{Directions, TransportMode};
use lanes::{Callee, Int, Mask, Real};
use math::{Vector3, same_hemisphere};
use sampling::warp::{cosine_hemisphere_pdf, uniform_hemisphere_pdf};
use spectrum::SampledSpectrum;

// Lobes, by what their directions are drawn from.

/// Fuzz, evenly over the hemisphere.
pub(super) const FUZZ: u32 = 0;
/// The coat, by its facets.
pub(super) const COAT: u32 = 1;
/// The reflection of opaque bases, by their facets.
pub(super) const FACETS: u32 = 2;
/// Glass, reflected or refracted by its facets; of a sheet, what passes it.
pub(super) const GLASS: u32 = 3;
/// The diffuse base, and what facets keep between them, by the cosine.
const REST: u32 = 4;
/// The rest of glass and of thin walls on their other side, by its cosine.
pub(super) const THROUGH: u32 = 5;
/// The beginning of a path under the surface.
pub(super) const UNDER: u32 = 6;

/// Lobes of less than this share are rounding errors, and not sampled.
const NEGLIGIBLE: f32 = 1e-6;

/// The probabilities of all lobes.
pub(super) struct Chances<R = f32> {
    of: [R; 7],
}

/// A lobe that is chosen.
pub(super) struct ChosenLobe<R: Real> {
    pub lobe: R::Int,
    /// Its probability; zero if there is no lobe.
    pub chance: R,
    /// A number in [0, 1) that is left to choose with.
    pub u: R,
}

impl<R: Real> Chances<R> {
    /// For light to `wo`, off the horizon. All are zero if nothing is scattered.
    #[inline(always)]
    pub fn new(
        surface: &OpenPbr<R>,
        shares: &Shares<R>,
        rests: &Rests<R>,
        wo: Vector3<R>,
        mode: TransportMode,
        directions: Directions,
    ) -> Self {
        let (zero, one, half) = (R::zero(), R::one(), R::splat(0.5));
        let cosine = wo.z.abs();
        let taken = &shares.taken;
        let weights = surface.weights(wo.z);
        let upwards = taken.fuzz_once + half * taken.fuzz_more;
        let fuzz = surface.stack.fuzz_weight * upwards * surface.fuzz_color.average();
        let (mut reflected, mut rest) = (SampledSpectrum::zero(), SampledSpectrum::zero());
        if weights.diffuse.gt(zero).any() {
            reflected += shares.dielectric * surface.specular_color * weights.diffuse;
            rest += shares.diffuse_rest * surface.diffuse_albedo(&weights) * weights.diffuse;
        }
        if weights.metal.gt(zero).any() {
            reflected += surface.metal(cosine) * (taken.metal * weights.metal);
            let has_rest = rests.metal.gt(zero);
            let left = R::select(has_rest, shares.metal_rest() * weights.metal, zero);
            rest += surface.metal.again * left;
        }
        // What is seen of the base; light from one direction may be seen from others.
        let mut seen = shares.seen;
        let mut coat = weights.layers * shares.coat;
        let is_tilted = surface.is_tilted();
        if mode == TransportMode::Importance && is_tilted.any() {
            let least = R::splat(0.1) * weights.layers * shares.below_fuzz() * surface.stack.coat_weight;
            coat = R::select(is_tilted, coat.max(least), coat);
            seen = one;
        }
        let is_coated = surface.stack.coat_weight.gt(zero);
        if is_coated.any() {
            let length = R::splat(2.0) * surface.coat_length(cosine);
            let opaque = surface.darkening * surface.absorbed(length) * seen;
            reflected = SampledSpectrum::select(is_coated, reflected * opaque, reflected);
            rest = SampledSpectrum::select(is_coated, rest * opaque, rest);
        }
        let mut of = [zero; 7];
        of[FUZZ as usize] = weights.layers * fuzz;
        of[COAT as usize] = coat;
        of[FACETS as usize] = reflected.average();
        of[REST as usize] = rest.average();
        if surface.glass().gt(zero).any() {
            let glass = surface.scattered_by_glass(shares, rests, wo, seen);
            if surface.stack.is_thin {
                of[FACETS as usize] += glass.reflected;
                of[GLASS as usize] = glass.refracted;
            } else {
                of[GLASS as usize] = glass.reflected + glass.refracted;
            }
            of[REST as usize] += glass.rest;
            of[THROUGH as usize] = glass.through;
        }
        if surface.stack.is_thin {
            let transmitted = shares.diffuse_rest * surface.diffuse_base.scattered * surface.darkening;
            of[THROUGH as usize] +=
                transmitted.average() * (surface.diffuse_base.forward * weights.diffuse * seen);
        }
        if mode == TransportMode::Radiance && weights.under.gt(zero).any() {
            let color = surface.subsurface_color;
            let goes_under = (surface.goes_under(shares, wo) * color).average();
            of[UNDER as usize] = R::select(weights.under.gt(zero), goes_under, zero);
        }
        let mut chances = Self { of };
        chances.restrict(directions, surface.stack.is_thin);
        chances.normalize();
        chances
    }

    /// Leaves out lobes that scatter in no direction that is asked for.
    #[inline(always)]
    fn restrict(&mut self, directions: Directions, is_thin: bool) {
        let zero = R::zero();
        if directions == Directions::Reflection {
            self.of[THROUGH as usize] = zero;
            self.of[UNDER as usize] = zero;
            if is_thin {
                self.of[GLASS as usize] = zero;
            }
        }
        if directions == Directions::Transmission {
            self.of[FUZZ as usize] = zero;
            self.of[COAT as usize] = zero;
            self.of[FACETS as usize] = zero;
            self.of[REST as usize] = zero;
        }
    }

    /// Makes probabilities of them.
    #[inline(always)]
    fn normalize(&mut self) {
        let mut sum = R::zero();
        for i in 0..7 {
            sum += self.of[i];
        }
        for i in 0..7 {
            let is_sampled = self.of[i].gt(R::splat(NEGLIGIBLE) * sum);
            self.of[i] = R::select(is_sampled, self.of[i] / sum, R::zero());
        }
    }

    /// A lobe.
    #[inline(always)]
    pub fn choose(&self, u: R) -> ChosenLobe<R> {
        let mut choice = ChosenLobe { lobe: R::Int::splat(0), chance: R::zero(), u };
        let mut left = u;
        let mut is_found = R::Mask::splat(false);
        for (i, &chance) in self.of.iter().enumerate() {
            let is_here = !is_found & chance.gt(R::zero());
            let rest = (left / chance).min(R::splat(math::ONE_MINUS_EPSILON));
            choice.lobe = R::Int::select(is_here, R::Int::splat(i as u32), choice.lobe);
            choice.chance = R::select(is_here, chance, choice.chance);
            choice.u = R::select(is_here, rest, choice.u);
            is_found = is_found | is_here & left.lt(chance);
            left = R::select(is_here, left - chance, left);
        }
        choice
    }

    /// The density of `wi`, off the horizon.
    #[inline(always)]
    pub fn pdf(
        &self,
        surface: &OpenPbr<R>,
        [wo, wi]: [Vector3<R>; 2],
        mode: TransportMode,
        directions: Directions,
    ) -> R {
        R::call(DensityOf { chances: self, surface, wo, wi, mode, directions })
    }
}

/// Light that the glass of a surface scatters from a direction.
struct GlassShares<R> {
    /// By its facets, reflected.
    reflected: R,
    /// By them, refracted; of a sheet, what passes it.
    refracted: R,
    /// The part that they keep between them, on the side where light comes from.
    rest: R,
    /// The same on the other side.
    through: R,
}

impl<R: Real> OpenPbr<'_, R> {
    /// Light to `wo` that glass scatters, of which from above this share is seen.
    #[inline(always)]
    fn scattered_by_glass(
        &self,
        shares: &Shares<R>,
        rests: &Rests<R>,
        wo: Vector3<R>,
        seen: R,
    ) -> GlassShares<R> {
        let zero = R::zero();
        let is_inside = wo.z.lt(zero) & R::Mask::splat(!self.stack.is_thin);
        let outside = shares.reflected * self.specular_color.average();
        let reflects = R::select(is_inside, shares.inside.reflected, outside);
        let refracts = R::select(is_inside, shares.inside.refracted, shares.refracted);
        let left = R::select(is_inside, shares.inside.left, shares.glass_rest);
        let mean = R::select(is_inside, rests.glass_below, rests.glass_above);
        let passes = R::select(is_inside, rests.through_below, rests.through_above);
        let left = R::select(mean.gt(zero), left, zero);
        let glass = R::select(is_inside, self.glass(), self.glass() * seen);
        let tint = glass * self.transmission_color.average();
        GlassShares {
            reflected: glass * reflects,
            refracted: tint * refracts,
            rest: glass * left * (R::one() - passes),
            through: tint * left * passes,
        }
    }
}

/// The density of a direction.
struct DensityOf<'b, 'a, R: Real> {
    chances: &'b Chances<R>,
    surface: &'b OpenPbr<'a, R>,
    wo: Vector3<R>,
    wi: Vector3<R>,
    mode: TransportMode,
    directions: Directions,
}

impl<R: Real> Callee<R> for DensityOf<'_, '_, R> {
    type Output = R;

    #[inline(always)]
    fn run(self) -> R {
        let Self { chances, surface, wo, wi, mode, directions } = self;
        let zero = R::zero();
        let [fuzz, coat, facets, glass, rest, through, _] = chances.of;
        let is_same = same_hemisphere(wo, wi);
        let is_below = wo.z.lt(zero);
        let (up, out) = (upright(is_below, wo), upright(is_below, wi));
        let mut pdf = zero;
        if glass.gt(zero).any() {
            if surface.stack.is_thin {
                pdf = R::select(is_same, zero, glass * surface.pdf_sheet(up, out));
            } else {
                pdf = R::select(glass.gt(zero), glass * surface.pdf_glass(wo, wi, directions), zero);
            }
        }
        let cosine = cosine_hemisphere_pdf(wi.z.abs());
        let across = pdf + through * cosine;
        if !is_same.any() {
            return across;
        }
        if coat.gt(zero).any() {
            pdf += R::select(coat.gt(zero), coat * surface.pdf_coat(up, out, mode), zero);
        }
        if facets.gt(zero).any() {
            pdf += facets * Mirror::new(&surface.stack.base, up, out).pdf;
        }
        let same = pdf + rest * cosine + fuzz * R::splat(uniform_hemisphere_pdf());
        R::select(is_same, same, across)
    }
}
