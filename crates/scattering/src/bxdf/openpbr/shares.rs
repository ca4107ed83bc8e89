//! How layers share the light from one direction.
//!
//! Every layer takes what its lobe reflects, by the tables of albedos, and passes on the rest; the
//! last one scatters whatever is left, diffusely or between microfacets, so that nothing is lost
//! or gained unless something absorbs.

use super::OpenPbr;
use super::albedo::{Glass, HATS, Hats, White, dot, hat_cosines, hats};
use super::fuzz::Scattered;
use crate::fr_dielectric;
use spectrum::SampledSpectrum;

/// The reflectances of facets at the cosines of hats.
pub(super) struct Facing {
    coat: Hats,
    dielectric: [SampledSpectrum; HATS],
}

/// Shares of the light from one direction above, as they were if nothing absorbed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shares {
    /// What a whole layer of fuzz does.
    pub fuzz: Scattered,
    /// What passes the fuzz.
    pub below_fuzz: f32,
    /// What the coat reflects.
    pub coat: f32,
    /// What passes the fuzz and the coat.
    pub below_coat: f32,
    /// What the facets of metal reflect, as if there were no other base.
    pub metal: f32,
    /// The same of the dielectric.
    pub dielectric: SampledSpectrum,
    /// What the facets of glass refract.
    pub refracted: SampledSpectrum,
    /// What is left for scattering between the facets of metal.
    pub metal_rest: f32,
    /// What is left for the diffuse base.
    pub diffuse_rest: SampledSpectrum,
    /// What is left for scattering between the facets of glass.
    pub glass_rest: f32,
}

impl Facing {
    pub fn new(surface: &OpenPbr) -> Self {
        let cosines = hat_cosines();
        let coat = match surface.coat_weight {
            0.0 => [0.0; HATS],
            _ => cosines.map(|cosine| fr_dielectric(cosine, surface.coat_ior)),
        };
        let dielectric = match surface.metalness {
            1.0 => [SampledSpectrum::ZERO; HATS],
            _ => cosines.map(|cosine| surface.facets.dielectric(cosine)),
        };
        Self { coat, dielectric }
    }

    /// What white facets of the base let pass.
    pub fn passed(&self, white: &White) -> SampledSpectrum {
        let reflected = |i: usize| dot(&white.shares, &self.dielectric.map(|f| f[i]));
        SampledSpectrum::new(std::array::from_fn(|i| 1.0 - reflected(i)))
    }
}

/// The layers over the base: what each passes on, at the cosines of hats.
#[derive(Clone, Copy, Debug)]
pub(super) struct Above {
    pub fuzz: Hats,
    pub coat: Hats,
}

/// The albedo of facets whose reflectance is `at_hats` at the cosines of hats, and `here` at that
/// of the direction, at which `own` are the hats. Exact for smooth facets.
fn albedo(white: &White, own: &Hats, at_hats: &Hats, here: f32) -> f32 {
    let correction: f32 =
        (0..own.len()).map(|k| at_hats[k] * (white.shares[k] - own[k] * white.albedo)).sum();
    (here * white.albedo + correction).clamp(0.0, 1.0)
}

/// Shares of the light from one direction below, in glass.
#[derive(Clone, Copy, Debug)]
pub(super) struct Inside {
    /// What facets reflect, with what the layers above send back.
    pub reflected: f32,
    /// What passes.
    pub refracted: f32,
    /// What is left for scattering between facets.
    pub rest: f32,
}

impl Inside {
    /// For the cosine to the normal that points down.
    pub fn new(surface: &OpenPbr, facing: &Facing, cosine: f32) -> Self {
        let table = Glass::at(1.0 / surface.index, surface.roughness(), cosine);
        let (mut reflected, mut refracted) = (table.total, 0.0);
        for k in 0..HATS {
            let passed = (1.0 - facing.dielectric[k].average()) * surface.above.coat[k];
            reflected += (1.0 - passed) * table.reflected[k];
            refracted += passed * table.refracted[k];
        }
        let rest = if surface.spreads() { (1.0 - reflected - refracted).max(0.0) } else { 0.0 };
        Self { reflected, refracted, rest }
    }
}

impl Shares {
    /// For a cosine > 0.
    pub fn new(surface: &OpenPbr, facing: &Facing, cosine: f32) -> Self {
        let own = hats(cosine);
        let mut fuzz = Scattered { once: 0.0, more: 0.0 };
        if surface.fuzz_weight > 0.0 {
            fuzz = Scattered::at(surface.fuzz_roughness, cosine);
        }
        let below_fuzz = 1.0 - surface.fuzz_weight * fuzz.upwards();
        let (mut coat, mut below_coat) = (0.0, below_fuzz);
        if surface.coat_weight > 0.0 {
            let white = White::at(surface.coat_roughness(), cosine);
            let reflected = albedo(&white, &own, &facing.coat, fr_dielectric(cosine, surface.coat_ior));
            let lost = dot(&white.losses, &surface.above.fuzz) / white.albedo;
            coat = surface.coat_weight * reflected * (below_fuzz - lost);
            below_coat = below_fuzz * (1.0 - surface.coat_weight * reflected);
        }
        let white = White::at(surface.roughness(), cosine);
        let met = below_coat - dot(&white.losses, &surface.above.coat) / white.albedo;
        let here =
            if surface.metalness == 1.0 { SampledSpectrum::ZERO } else { surface.facets.dielectric(cosine) };
        let of = |i: usize| albedo(&white, &own, &facing.dielectric.map(|f| f[i]), here[i]);
        // Only a film colours the reflection.
        let reflected = match surface.facets.film.weight {
            0.0 => SampledSpectrum::splat(of(0)),
            _ => SampledSpectrum::new(std::array::from_fn(of)),
        };
        let mut glass = SampledSpectrum::ZERO;
        if surface.glass() > 0.0 {
            let table = Glass::at(surface.index, surface.roughness(), cosine);
            for (reflected, kept) in facing.dielectric.iter().zip(table.refracted) {
                glass += (SampledSpectrum::ONE - *reflected) * kept;
            }
            // At the direction's own reflectance where facets are smooth.
            let kept: f32 = table.refracted.iter().sum();
            for (reflected, own) in facing.dielectric.iter().zip(own) {
                glass += (*reflected - here) * (own * kept);
            }
            glass = glass.clamp(0.0, 1.0) * below_coat;
        }
        let (metal, dielectric) = (met * white.albedo, reflected * met);
        let rest = 1.0 - surface.fuzz_weight * fuzz.upwards() - coat;
        let spreads = surface.spreads();
        let left = |taken: SampledSpectrum| (SampledSpectrum::splat(rest) - taken).clamp_zero();
        Self {
            fuzz,
            below_fuzz,
            coat,
            below_coat,
            metal,
            dielectric,
            refracted: glass,
            metal_rest: if spreads { (rest - metal).max(0.0) } else { 0.0 },
            diffuse_rest: left(dielectric),
            glass_rest: if spreads { left(dielectric + glass).average() } else { 0.0 },
        }
    }
}
