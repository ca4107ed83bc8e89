//! The layers by their numbers alone, and what each takes of the light from a direction.
//!
//! Every layer takes what its lobe reflects, by the tables of albedos, and passes on the rest; the
//! last one scatters whatever is left, diffusely or between microfacets, so that nothing is lost
//! or gained unless something absorbs. Below a coat light meets the base at a smaller angle:
//! sin θ' = sin θ/η_coat. A sheet of glass sums the reflections between its sides, and light that
//! passes it goes on in its direction.

use super::OpenPbrParameters;
use super::albedo::{Glass, HATS, Hats, White, dot, hat_cosines, hats};
use super::film::{Complex, film_reflectance};
use super::fuzz::Scattered;
use crate::{TrowbridgeReitz, fr_dielectric};
use math::{Vec3, Vector3, lerp, safe_sqrt, sqr};
use spectrum::SampledSpectrum;

/// The numbers of the layers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stack {
    /// The facets of the base.
    pub base: TrowbridgeReitz,
    /// Those of the coat.
    pub coat: TrowbridgeReitz,
    pub coat_weight: f32,
    pub coat_ior: f32,
    pub fuzz_weight: f32,
    pub fuzz_roughness: f32,
    /// Index of refraction above the base: that of the coat where there is one.
    pub above: f32,
    /// Index of refraction of the dielectric for its reflection.
    pub below: f32,
    /// Index of refraction of glass.
    pub index: f32,
    /// Presence of a film on the base.
    pub film_weight: f32,
    /// Its index of refraction.
    pub film_ior: f32,
    /// Whether glass is a sheet.
    pub is_thin: bool,
}

/// What the layers do with light from one direction above, as if nothing absorbed.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Taken {
    /// What a whole layer of fuzz scatters once upwards.
    pub fuzz_once: f32,
    /// What it scatters more often.
    pub fuzz_more: f32,
    /// What the coat reflects.
    pub coat: f32,
    /// What passes the fuzz and the coat.
    pub below_coat: f32,
    /// What the facets of metal reflect, as if there were no other base.
    pub metal: f32,
    /// The same of the dielectric.
    pub dielectric: f32,
    /// What the facets of glass refract.
    pub refracted: f32,
    /// What is left by the fuzz and the coat for the base.
    pub left: f32,
}

/// The numbers of [`Taken`], as tables have them.
pub(super) type Row = [f32; 8];

impl Taken {
    #[inline]
    pub fn from_row(row: Row) -> Self {
        let [fuzz_once, fuzz_more, coat, below_coat, metal, dielectric, refracted, left] = row;
        Self { fuzz_once, fuzz_more, coat, below_coat, metal, dielectric, refracted, left }
    }

    pub fn to_row(self) -> Row {
        let Self { fuzz_once, fuzz_more, coat, below_coat, metal, dielectric, refracted, left } = self;
        [fuzz_once, fuzz_more, coat, below_coat, metal, dielectric, refracted, left]
    }
}

/// What glass does with light from one direction below or, if it is a sheet, from either side.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Inside {
    /// What facets reflect; from below, with what the layers above send back.
    pub reflected: f32,
    /// What passes.
    pub refracted: f32,
    /// What is left for scattering between facets, before it is cut off at zero.
    left: f32,
}

impl Inside {
    #[inline]
    pub fn add(&mut self, weight: f32, inside: &Self) {
        self.reflected += weight * inside.reflected;
        self.refracted += weight * inside.refracted;
        self.left += weight * inside.left;
    }

    /// What is left for scattering between facets.
    pub fn left(&self) -> f32 {
        self.left.max(0.0)
    }
}

/// What the layers over the base pass on, at the cosines of hats.
#[derive(Clone, Copy, Debug)]
pub(super) struct Above {
    fuzz: Hats,
    coat: Hats,
}

/// Microfacets seen from one direction, and the direction.
pub(super) struct Seen {
    wo: Vector3,
    coat: White,
    base: White,
    glass: Option<SeenGlass>,
}

/// Facets of glass seen from one direction.
enum SeenGlass {
    /// From above, and from below with the opposite direction.
    Body([Glass; 2]),
    /// Those that light which passes a sheet seems to be mirrored by.
    Sheet(White),
}

impl Seen {
    /// What white facets of the base reflect.
    pub fn white(&self) -> f32 {
        self.base.albedo
    }
}

/// α both ways, of a roughness and anisotropy in [0, 1].
fn distribution(roughness: f32, anisotropy: f32) -> TrowbridgeReitz {
    let narrow = 1.0 - anisotropy;
    let alpha_x = sqr(roughness) * (2.0 / (1.0 + sqr(narrow))).sqrt();
    TrowbridgeReitz::new(alpha_x, narrow * alpha_x)
}

/// The roughness of a base under a coat, by the variance that refraction in it adds.
fn roughened(p: &OpenPbrParameters) -> f32 {
    let under = (p.specular_roughness.powi(4) + 2.0 * p.coat_roughness.powi(4)).min(1.0).sqrt().sqrt();
    lerp(p.coat_weight, p.specular_roughness, under)
}

/// The albedo of facets whose reflectance is `at_hats` at the cosines of hats, and `here` at that
/// of the direction, at which `own` are the hats. Exact for smooth facets.
fn albedo(white: &White, own: &Hats, at_hats: &Hats, here: f32) -> f32 {
    let correction: f32 =
        (0..own.len()).map(|k| at_hats[k] * (white.shares[k] - own[k] * white.albedo)).sum();
    (here * white.albedo + correction).clamp(0.0, 1.0)
}

impl Stack {
    pub fn new(p: &OpenPbrParameters) -> Self {
        let above = lerp(p.coat_weight, 1.0, p.coat_ior);
        // The weight scales the reflectance at normal incidence, ((η − 1)/(η + 1))².
        let root = (p.specular_ior - above) / (p.specular_ior + above);
        let root = (root * p.specular_weight.sqrt()).clamp(-0.999, 0.999);
        Self {
            base: distribution(roughened(p), p.specular_roughness_anisotropy),
            coat: distribution(p.coat_roughness, p.coat_roughness_anisotropy),
            coat_weight: p.coat_weight,
            coat_ior: p.coat_ior,
            fuzz_weight: p.fuzz_weight,
            fuzz_roughness: p.fuzz_roughness,
            above,
            below: above * (1.0 + root) / (1.0 - root),
            index: p.specular_ior.max(1.001),
            film_weight: p.thin_film_weight,
            film_ior: p.thin_film_ior,
            is_thin: p.geometry_thin_walled,
        }
    }

    /// Whether there is something over the base.
    pub fn has_layers(&self) -> bool {
        self.coat_weight > 0.0 || self.fuzz_weight > 0.0
    }

    /// Whether some layer spreads light, so that there is a rest to scatter.
    pub fn spreads(&self) -> bool {
        let rough = |facets: &TrowbridgeReitz| !facets.effectively_smooth();
        rough(&self.base) || self.coat_weight > 0.0 && rough(&self.coat) || self.fuzz_weight > 0.0
    }

    /// The cosine at which the base is met by light that meets the surface at `cosine` in air.
    pub fn inner_cosine(&self, cosine: f32) -> f32 {
        if self.above == 1.0 { cosine } else { safe_sqrt(1.0 - (1.0 - sqr(cosine)) / sqr(self.above)) }
    }

    /// The reflectance of the dielectric met at a cosine in air, under a film of so many
    /// wavelengths.
    pub fn dielectric(&self, cosine: f32, waves: f32) -> f32 {
        let cosine = self.inner_cosine(cosine);
        let bare = fr_dielectric(cosine, self.below / self.above);
        if self.film_weight == 0.0 {
            return bare;
        }
        let below = Complex::real(self.below);
        lerp(self.film_weight, bare, film_reflectance(cosine, self.above, self.film_ior, below, waves))
    }

    /// The same at all wavelengths of a path.
    pub fn dielectrics(&self, cosine: f32, waves: &SampledSpectrum) -> SampledSpectrum {
        match self.film_weight {
            0.0 => SampledSpectrum::splat(self.dielectric(cosine, 0.0)),
            _ => waves.map(|waves| self.dielectric(cosine, waves)),
        }
    }

    /// The reflectances of the dielectric and of the coat at the cosines of hats.
    pub fn facing(&self, waves: f32) -> [Hats; 2] {
        let cosines = hat_cosines();
        let dielectric = cosines.map(|cosine| self.dielectric(cosine, waves));
        [dielectric, cosines.map(|cosine| fr_dielectric(cosine, self.coat_ior))]
    }

    /// What the facets do with light to `wo`, above; those of glass only where asked for.
    pub fn seen(&self, wo: Vector3, with_glass: bool) -> Seen {
        let base = White::seen(&self.base, wo);
        let coat = if self.coat_weight > 0.0 { White::seen(&self.coat, wo) } else { base };
        let body = |eta| Glass::seen(eta, &self.base, wo);
        let glass = with_glass.then(|| match self.is_thin {
            true => SeenGlass::Sheet(White::seen(&self.sheet(), wo)),
            false => SeenGlass::Body([body(self.index), body(1.0 / self.index)]),
        });
        Seen { wo, base, coat, glass }
    }

    /// What the layers over the base pass on.
    pub fn above(&self) -> Above {
        let mut above = Above { fuzz: [1.0; HATS], coat: [1.0; HATS] };
        if self.has_layers() {
            let facing = self.facing(0.0);
            for (k, cosine) in hat_cosines().into_iter().enumerate() {
                // Any azimuth serves a layer that is alike both ways, and the middle one others.
                let cosine = cosine.max(1e-4);
                let across = safe_sqrt(0.5 * (1.0 - sqr(cosine)));
                let seen = self.seen(Vec3::new(across, across, cosine), false);
                let taken = self.taken(&seen, &above, &facing, 0.0);
                above.fuzz[k] = 1.0 - self.fuzz_weight * (taken.fuzz_once + 0.5 * taken.fuzz_more);
                above.coat[k] = taken.below_coat;
            }
        }
        above
    }

    /// What the layers take of the light to a direction, under a film of so many wavelengths.
    pub fn taken(&self, seen: &Seen, above: &Above, facing: &[Hats; 2], waves: f32) -> Taken {
        let [facing, facing_coat] = facing;
        let cosine = seen.wo.z;
        let own = hats(cosine);
        let mut fuzz = Scattered { once: 0.0, more: 0.0 };
        if self.fuzz_weight > 0.0 {
            fuzz = Scattered::at(self.fuzz_roughness, cosine);
        }
        let below_fuzz = 1.0 - self.fuzz_weight * fuzz.upwards();
        let (mut coat, mut below_coat) = (0.0, below_fuzz);
        if self.coat_weight > 0.0 {
            let here = fr_dielectric(cosine, self.coat_ior);
            let reflected = albedo(&seen.coat, &own, facing_coat, here);
            let lost = dot(&seen.coat.losses, &above.fuzz) / seen.coat.albedo;
            coat = self.coat_weight * reflected * (below_fuzz - lost);
            below_coat = below_fuzz * (1.0 - self.coat_weight * reflected);
        }
        let white = &seen.base;
        let met = below_coat - dot(&white.losses, &above.coat) / white.albedo;
        let here = self.dielectric(cosine, waves);
        let mut refracted = 0.0;
        if let Some(SeenGlass::Body([glass, _])) = &seen.glass {
            // At the direction's own reflectance where facets are smooth.
            let kept: f32 = glass.refracted.iter().sum();
            let passed =
                |k: usize| (1.0 - facing[k]) * glass.refracted[k] + (facing[k] - here) * own[k] * kept;
            refracted = (0..HATS).map(passed).sum::<f32>().clamp(0.0, 1.0) * below_coat;
        }
        Taken {
            fuzz_once: fuzz.once,
            fuzz_more: fuzz.more,
            coat,
            below_coat,
            metal: met * white.albedo,
            dielectric: albedo(white, &own, facing, here) * met,
            refracted,
            left: 1.0 - self.fuzz_weight * fuzz.upwards() - coat,
        }
    }

    /// What glass does with light from the direction opposite to one seen with glass or, if it is
    /// a sheet, from either.
    pub fn inside(&self, seen: &Seen, above: &Above, facing: &[Hats; 2], waves: f32) -> Inside {
        match &seen.glass {
            None => Inside::default(),
            Some(SeenGlass::Body([_, glass])) => {
                let mut inside = Inside { reflected: glass.total, refracted: 0.0, left: 0.0 };
                for (k, facing) in facing[0].into_iter().enumerate() {
                    let passed = (1.0 - facing) * above.coat[k];
                    inside.reflected += (1.0 - passed) * glass.reflected[k];
                    inside.refracted += passed * glass.refracted[k];
                }
                Inside { left: 1.0 - inside.reflected - inside.refracted, ..inside }
            }
            Some(SeenGlass::Sheet(passing)) => {
                let own = hats(seen.wo.z);
                let here = sheet_reflectance(self.dielectric(seen.wo.z, waves));
                let at_hats = facing[0].map(sheet_reflectance);
                let taken = self.taken(seen, above, facing, waves);
                let met = |white: &White| taken.below_coat - dot(&white.losses, &above.coat) / white.albedo;
                let reflected = albedo(&seen.base, &own, &at_hats, here) * met(&seen.base);
                let passed = albedo(passing, &own, &at_hats.map(|f| 1.0 - f), 1.0 - here);
                let refracted = passed * met(passing);
                Inside { reflected, refracted, left: taken.left - reflected - refracted }
            }
        }
    }

    /// The facets that mirror light, turned over, as a sheet with rough sides refracts it.
    ///
    /// A facet of slope m mirrors light by an angle of 2m and refracts it by (η − 1) m; the two
    /// sides are independent, so that their variances add.
    pub fn sheet(&self) -> TrowbridgeReitz {
        self.base.scaled(((self.index - 1.0) * std::f32::consts::FRAC_1_SQRT_2).min(1.0))
    }
}

/// What a clear sheet reflects whose sides reflect the share `f`: F + F (1 − F)²/(1 − F²).
fn sheet_reflectance(f: f32) -> f32 {
    2.0 * f / (1.0 + f)
}
