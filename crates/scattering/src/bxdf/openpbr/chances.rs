//! The probabilities of lobes, about what each scatters from a direction, and their densities.

use super::mirror::Mirror;
use super::{OpenPbr, View, flip};
use crate::{Directions, TransportMode};
use math::{Vector3, same_hemisphere};
use sampling::warp::{cosine_hemisphere_pdf, uniform_hemisphere_pdf};
use spectrum::SampledSpectrum;

/// What a sample is drawn from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Lobe {
    /// Fuzz, evenly over the hemisphere.
    Fuzz,
    /// The coat, by its facets.
    Coat,
    /// The reflection of opaque bases, by their facets.
    Facets,
    /// Glass, reflected or refracted by its facets; of a sheet, what passes it.
    Glass,
    /// The rest, by its cosine.
    Rest,
    /// The rest of glass and of thin walls on their other side, by its cosine.
    Through,
    /// The beginning of a path under the surface.
    Under,
}

const LOBES: [Lobe; 7] =
    [Lobe::Fuzz, Lobe::Coat, Lobe::Facets, Lobe::Glass, Lobe::Rest, Lobe::Through, Lobe::Under];

/// Lobes of less than this share are rounding errors, and not sampled.
const NEGLIGIBLE: f32 = 1e-6;

/// The probabilities of all lobes.
pub(super) struct Chances([f32; 7]);

impl Chances {
    /// For light to `wo`, off the horizon. All are zero if nothing is scattered.
    pub fn new(
        surface: &OpenPbr,
        view: &View,
        wo: Vector3,
        mode: TransportMode,
        directions: Directions,
    ) -> Self {
        let cosine = wo.z.abs();
        let (shares, rests) = (&view.shares, &view.rests);
        let taken = &shares.taken;
        let weights = surface.weights(wo.z);
        let mut fuzz = 0.0;
        if surface.stack.fuzz_weight > 0.0 {
            let upwards = taken.fuzz_once + 0.5 * taken.fuzz_more;
            fuzz = surface.stack.fuzz_weight * upwards * surface.fuzz_color.average();
        }
        let (mut reflected, mut rest) = (SampledSpectrum::ZERO, SampledSpectrum::ZERO);
        if weights.diffuse > 0.0 {
            reflected += shares.dielectric * surface.specular_color * weights.diffuse;
            rest += shares.diffuse_rest * surface.diffuse_albedo(&weights) * weights.diffuse;
        }
        if weights.metal > 0.0 {
            reflected += surface.metal(cosine) * (taken.metal * weights.metal);
            if rests.metal > 0.0 {
                rest += surface.metal_again * (shares.metal_rest() * weights.metal);
            }
        }
        if surface.stack.coat_weight > 0.0 {
            let opaque = surface.darkening * surface.absorbed(2.0 * surface.coat_length(cosine));
            (reflected, rest) = (reflected * opaque, rest * opaque);
        }
        let mut reflected = reflected.average();
        let mut rest = rest.average();
        let (mut facets, mut through) = (0.0, 0.0);
        let glass = surface.glass();
        if glass > 0.0 {
            let inside = (wo.z < 0.0 && !surface.stack.is_thin).then(|| surface.inside(wo));
            let (reflects, refracts, left) = match inside {
                Some(inside) => (inside.reflected, inside.refracted, inside.left()),
                None => {
                    let tint = surface.specular_color.average();
                    (shares.reflected * tint, shares.refracted, shares.glass_rest)
                }
            };
            let side = usize::from(inside.is_some());
            let left = if rests.glass[side] > 0.0 { left } else { 0.0 };
            rest += glass * left * (1.0 - rests.through[side]);
            let tint = glass * surface.transmission_color.average();
            facets = glass * reflects + tint * refracts;
            through = tint * left * rests.through[side];
            if surface.stack.is_thin {
                reflected += glass * reflects;
                facets = tint * refracts;
            }
        }
        if weights.diffuse > 0.0 && surface.stack.is_thin {
            let transmitted = shares.diffuse_rest * surface.scattered * surface.darkening;
            through += transmitted.average() * (surface.forward * weights.diffuse);
        }
        let coat = weights.layers * taken.coat;
        let mut under = 0.0;
        if weights.under > 0.0 && mode == TransportMode::Radiance {
            under = (surface.goes_under(shares, wo) * surface.subsurface_color).average();
        }
        let mut chances = [weights.layers * fuzz, coat, reflected, facets, rest, through, under];
        match directions {
            Directions::All => (),
            Directions::Reflection => {
                (chances[5], chances[6]) = (0.0, 0.0);
                if surface.stack.is_thin {
                    chances[3] = 0.0;
                }
            }
            Directions::Transmission => [0, 1, 2, 4].into_iter().for_each(|i| chances[i] = 0.0),
        }
        let sum: f32 = chances.iter().sum();
        if sum > 0.0 {
            for chance in &mut chances {
                *chance = if *chance > NEGLIGIBLE * sum { *chance / sum } else { 0.0 };
            }
        }
        Self(chances)
    }

    /// A lobe, its probability, and a number in [0, 1) that is left to choose with; `None` if there
    /// is no lobe.
    pub fn choose(&self, u: f32) -> Option<(Lobe, f32, f32)> {
        let mut left = u;
        let mut last = None;
        for (lobe, &chance) in LOBES.into_iter().zip(&self.0) {
            if chance > 0.0 {
                let rest = (left / chance).min(math::ONE_MINUS_EPSILON);
                if left < chance {
                    return Some((lobe, chance, rest));
                }
                last = Some((lobe, chance, rest));
                left -= chance;
            }
        }
        last
    }

    /// The density of `wi`, off the horizon.
    pub fn pdf(
        &self,
        surface: &OpenPbr,
        wo: Vector3,
        wi: Vector3,
        mode: TransportMode,
        directions: Directions,
    ) -> f32 {
        let [fuzz, coat, facets, glass, rest, through, _] = self.0;
        let mut pdf = 0.0;
        if glass > 0.0 && surface.stack.is_thin {
            if !same_hemisphere(wo, wi) {
                pdf += glass * surface.pdf_sheet(wo, wi);
            }
        } else if glass > 0.0 {
            pdf += glass * surface.pdf_glass(wo, wi, mode, directions);
        }
        let cosine = cosine_hemisphere_pdf(wi.z.abs());
        if !same_hemisphere(wo, wi) {
            return pdf + through * cosine;
        }
        let [wo, wi] = [wo, wi].map(|w| flip(wo.z < 0.0, w));
        if coat > 0.0 {
            pdf += coat * surface.pdf_coat(wo, wi);
        }
        if facets > 0.0
            && let Some(mirror) = Mirror::new(&surface.stack.base, wo, wi)
        {
            pdf += facets * mirror.pdf;
        }
        pdf + rest * cosine + fuzz * uniform_hemisphere_pdf()
    }
}
