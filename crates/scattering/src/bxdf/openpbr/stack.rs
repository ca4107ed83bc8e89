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
use lanes::{Callee, Mask, Real};
use math::{Vec3, Vector3, lerp, safe_sqrt, sqr};
use spectrum::{N, SampledSpectrum};
use std::f32::consts::FRAC_1_SQRT_2;

/// The numbers of the layers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stack<R = f32> {
    /// The facets of the base.
    pub base: TrowbridgeReitz<R>,
    /// Those of the coat.
    pub coat: TrowbridgeReitz<R>,
    pub coat_weight: R,
    pub coat_ior: R,
    pub fuzz_weight: R,
    pub fuzz_roughness: R,
    /// Index of refraction above the base: that of the coat where there is one.
    pub above: R,
    /// Index of refraction of the dielectric for its reflection.
    pub below: R,
    /// Index of refraction of glass.
    pub index: R,
    /// Presence of a film on the base.
    pub film_weight: R,
    /// Its index of refraction.
    pub film_ior: R,
    /// Whether glass is a sheet.
    pub is_thin: bool,
}

/// What the layers do with light from one direction above, as if nothing absorbed.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Taken<R = f32> {
    /// What a whole layer of fuzz scatters once upwards.
    pub fuzz_once: R,
    /// What it scatters more often.
    pub fuzz_more: R,
    /// What the coat reflects.
    pub coat: R,
    /// What passes the fuzz and the coat.
    pub below_coat: R,
    /// What the facets of metal reflect, as if there were no other base.
    pub metal: R,
    /// The same of the dielectric.
    pub dielectric: R,
    /// What the facets of glass refract.
    pub refracted: R,
    /// What is left by the fuzz and the coat for the base.
    pub left: R,
}

/// What glass does with light from one direction below or, if it is a sheet, from either side.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Inside<R = f32> {
    /// What facets reflect; from below, with what the layers above send back.
    pub reflected: R,
    /// What passes.
    pub refracted: R,
    /// What is left for scattering between facets; of rows of tables, before it is cut off at zero.
    pub left: R,
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
#[inline(always)]
fn distribution<R: Real>(roughness: R, anisotropy: R) -> TrowbridgeReitz<R> {
    let narrow = R::one() - anisotropy;
    let alpha_x = sqr(roughness) * (R::splat(2.0) / (R::one() + sqr(narrow))).sqrt();
    TrowbridgeReitz::new(alpha_x, narrow * alpha_x)
}

/// The roughness of a base under a coat, by the variance that refraction in it adds.
#[inline(always)]
fn roughened<R: Real>(p: &OpenPbrParameters<R>) -> R {
    let (base, coat) = (sqr(sqr(p.specular_roughness)), sqr(sqr(p.coat_roughness)));
    let under = (base + R::splat(2.0) * coat).min(R::one()).sqrt().sqrt();
    lerp(p.coat_weight, p.specular_roughness, under)
}

/// The albedo of facets whose reflectance is `at_hats` at the cosines of hats, and `here` at that
/// of the direction, at which `own` are the hats. Exact for smooth facets.
fn albedo(white: &White, own: &Hats, at_hats: &Hats, here: f32) -> f32 {
    let correction: f32 =
        (0..own.len()).map(|k| at_hats[k] * (white.shares[k] - own[k] * white.albedo)).sum();
    (here * white.albedo + correction).clamp(0.0, 1.0)
}

impl<R: Real> Stack<R> {
    #[inline(always)]
    pub fn new(p: &OpenPbrParameters<R>) -> Self {
        let one = R::one();
        let above = lerp(p.coat_weight, one, p.coat_ior);
        // The weight scales the reflectance at normal incidence, ((η − 1)/(η + 1))².
        let root = (p.specular_ior - above) / (p.specular_ior + above);
        let root = (root * p.specular_weight.sqrt()).clamp(R::splat(-0.999), R::splat(0.999));
        Self {
            base: distribution(roughened(p), p.specular_roughness_anisotropy),
            coat: distribution(p.coat_roughness, p.coat_roughness_anisotropy),
            coat_weight: p.coat_weight,
            coat_ior: p.coat_ior,
            fuzz_weight: p.fuzz_weight,
            fuzz_roughness: p.fuzz_roughness,
            above,
            below: above * (one + root) / (one - root),
            index: p.specular_ior.max(R::splat(1.001)),
            film_weight: p.thin_film_weight,
            film_ior: p.thin_film_ior,
            is_thin: p.geometry_thin_walled,
        }
    }

    /// Whether there is something over the base.
    #[inline(always)]
    pub fn has_layers(&self) -> R::Mask {
        self.coat_weight.gt(R::zero()) | self.fuzz_weight.gt(R::zero())
    }

    /// Whether some layer spreads light, so that there is a rest to scatter.
    #[inline(always)]
    pub fn spreads(&self) -> R::Mask {
        let has_rough_coat = self.coat_weight.gt(R::zero()) & !self.coat.effectively_smooth();
        !self.base.effectively_smooth() | has_rough_coat | self.fuzz_weight.gt(R::zero())
    }

    /// The cosine at which the base is met by light that meets the surface at `cosine` in air.
    #[inline(always)]
    pub fn inner_cosine(&self, cosine: R) -> R {
        let inner = safe_sqrt(R::one() - (R::one() - sqr(cosine)) / sqr(self.above));
        R::select(self.above.eq(R::one()), cosine, inner)
    }

    /// The reflectance of the dielectric met at a cosine in air, under a film of so many
    /// wavelengths.
    #[inline(always)]
    pub fn dielectric(&self, cosine: R, waves: R) -> R {
        let cosine = self.inner_cosine(cosine);
        let bare = fr_dielectric(cosine, self.below / self.above);
        let is_filmed = self.film_weight.gt(R::zero());
        if !is_filmed.any() {
            return bare;
        }
        let below = Complex::real(self.below);
        let filmed = film_reflectance(cosine, self.above, self.film_ior, below, waves);
        R::select(is_filmed, lerp(self.film_weight, bare, filmed), bare)
    }

    /// The same at all wavelengths of a path.
    #[inline(always)]
    pub fn dielectrics(&self, cosine: R, waves: &SampledSpectrum<R>) -> SampledSpectrum<R> {
        if self.film_weight.gt(R::zero()).any() {
            return R::call(FilmedDielectric { stack: self, cosine, waves });
        }
        SampledSpectrum::splat(fr_dielectric(self.inner_cosine(cosine), self.below / self.above))
    }

    /// The facets that mirror light, turned over, as a sheet with rough sides refracts it.
    ///
    /// A facet of slope m mirrors light by an angle of 2m and refracts it by (η − 1) m; the two
    /// sides are independent, so that their variances add.
    #[inline(always)]
    pub fn sheet(&self) -> TrowbridgeReitz<R> {
        self.base.scaled(((self.index - R::one()) * R::splat(FRAC_1_SQRT_2)).min(R::one()))
    }
}

/// The reflectance of the dielectric under a film.
struct FilmedDielectric<'b, R: Real> {
    stack: &'b Stack<R>,
    cosine: R,
    waves: &'b SampledSpectrum<R>,
}

impl<R: Real> Callee<R> for FilmedDielectric<'_, R> {
    type Output = SampledSpectrum<R>;

    #[inline(always)]
    fn run(self) -> SampledSpectrum<R> {
        let mut reflected = *self.waves;
        for i in 0..N {
            reflected[i] = self.stack.dielectric(self.cosine, self.waves[i]);
        }
        reflected
    }
}

impl Stack {
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
            // At the direction's own reflectance where facets are smooth. The layers pass what they
            // pass for the facet, if that is less.
            let kept: f32 = glass.refracted.iter().sum();
            let passed = |k: usize| (1.0 - facing[k]) * below_coat.min(above.coat[k]);
            let turned: f32 = (0..HATS).map(|k| passed(k) * (glass.refracted[k] - own[k] * kept)).sum();
            refracted = ((1.0 - here) * kept * below_coat + turned).clamp(0.0, 1.0);
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
                inside.refracted -= dot(&glass.losses, &above.coat);
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
}

/// What a clear sheet reflects whose sides reflect the share `f`: F + F (1 − F)²/(1 − F²).
fn sheet_reflectance(f: f32) -> f32 {
    2.0 * f / (1.0 + f)
}
