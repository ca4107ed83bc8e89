//! A principled surface: metal, glass and diffuse bases under a coat and fuzz, after OpenPBR
//! Surface 1.1.
//!
//! ```text
//! fuzz            fibres, as fuzz.rs has them
//! coat            a dielectric layer: GGX reflection, absorption along the path in it
//! base            metal:    GGX reflection, F82
//!                 glass:    GGX reflection and refraction
//!                 diffuse:  GGX reflection over Oren–Nayar
//! ```
//!
//! with a thin film on the facets of the base. From above, with the shares that layers pass on and
//! what is left at the end (shares.rs), and the weights w of lobes,
//!
//! ```text
//! f = w_f f_fuzz + min(T_f(θo), T_f(θi)) w_c f_coat
//!   + A(θo, θi) (min(T(θo), T(θi)) f_facets + L(θo) L(θi)/L̄ f_rest)
//! ```
//!
//! A narrow lobe keeps what the layers above pass on, as both directions have nearly the same T.
//! What the minimum takes from a wide one, what the facets mask, and what they let pass is the rest
//! L: it is scattered by the diffuse base or, as in [Kulla 2017], between facets. All factors are
//! symmetric, so that f is reciprocal, and what absorbs nothing reflects or transmits all light:
//! exactly but for tables, for facets that are alike both ways.
//!
//! Refraction is by the index of the glass alone, as the coat has parallel sides. Inside the coat
//! light is reflected back to the base again and again: darkening follows the specification's form
//! with mean albedos, so that it does not depend on directions. From below, glass is met from
//! inside, and an opaque base is as from above. Colours only absorb. Sources: [OpenPBR 2024],
//! [Kulla 2017].

mod albedo;
mod chances;
mod diffuse;
mod facets;
mod film;
mod fuzz;
mod glass;
mod grid;
mod parameters;
mod shares;
mod value;

pub use parameters::OpenPbrParameters;

use super::{BsdfSample, Dielectric, Scatter};
use crate::fresnel::mean_fresnel;
use crate::{BxdfFlags, Directions, TransportMode, TrowbridgeReitz};
use albedo::{HATS, White, hat_cosines};
use chances::{Chances, Lobe};
use facets::{Facets, Film};
use grid::mean;
use math::{Vec2, Vector3, sqr};
use sampling::warp::{sample_cosine_hemisphere, sample_uniform_hemisphere};
use shares::{Above, Facing, Inside, Shares};
use spectrum::{SampledSpectrum, SampledWavelengths};

/// Directions nearer to the horizon scatter nothing.
const HORIZON: f32 = 1e-6;

/// A principled surface.
#[derive(Clone, Copy, Debug)]
pub struct OpenPbr {
    base: TrowbridgeReitz,
    facets: Facets,
    /// Index of refraction of glass.
    index: f32,
    metalness: f32,
    transmission: f32,
    specular_color: SampledSpectrum,
    transmission_color: SampledSpectrum,
    diffuse_color: SampledSpectrum,
    diffuse_roughness: f32,
    coat: TrowbridgeReitz,
    coat_weight: f32,
    coat_ior: f32,
    coat_color: SampledSpectrum,
    /// Factor on opaque bases.
    darkening: SampledSpectrum,
    fuzz_weight: f32,
    fuzz_color: SampledSpectrum,
    fuzz_roughness: f32,
    above: Above,
    rests: Rests,
}

/// Means of what is left for the last layer, over directions by their cosine.
#[derive(Clone, Copy, Debug)]
struct Rests {
    fuzz: f32,
    metal: f32,
    /// The share of light that metal keeps between its facets.
    metal_color: SampledSpectrum,
    diffuse: SampledSpectrum,
    glass: [f32; 2],
    /// The share of the rest of glass that passes to the other side, from above and from below.
    through: [f32; 2],
}

/// What all values and densities of one direction share.
struct View {
    facing: Facing,
    /// Of the direction or, if it is below, of its opposite.
    shares: Shares,
}

impl View {
    /// For a direction off the horizon.
    fn new(surface: &OpenPbr, wo: Vector3) -> Self {
        let facing = Facing::new(surface);
        Self { shares: Shares::new(surface, &facing, wo.z.abs()), facing }
    }
}

/// Weights of the lobes that directions on one side of the surface meet.
struct Weights {
    /// Fuzz and coat.
    layers: f32,
    metal: f32,
    diffuse: f32,
    glass: f32,
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
    math::lerp(p.coat_weight, p.specular_roughness, under)
}

impl OpenPbr {
    /// The surface at the wavelengths of a path.
    pub fn new(p: &OpenPbrParameters, lambda: &SampledWavelengths) -> Self {
        let above = math::lerp(p.coat_weight, 1.0, p.coat_ior);
        // The weight scales the reflectance at normal incidence, ((η − 1)/(η + 1))².
        let root = (p.specular_ior - above) / (p.specular_ior + above);
        let root = (root * p.specular_weight.sqrt()).clamp(-0.999, 0.999);
        let facets = Facets {
            above,
            below: above * (1.0 + root) / (1.0 - root),
            metal: p.base_color * p.base_weight,
            edge: p.specular_color,
            metal_weight: p.specular_weight.min(1.0),
            film: Film {
                weight: p.thin_film_weight,
                thickness: 1000.0 * p.thin_film_thickness,
                ior: p.thin_film_ior,
                lambda: SampledSpectrum::new(*lambda.lambda()),
            },
        };
        let black = SampledSpectrum::ZERO;
        let mut surface = Self {
            base: distribution(roughened(p), p.specular_roughness_anisotropy),
            facets,
            index: p.specular_ior.max(1.001),
            metalness: p.base_metalness,
            transmission: p.transmission_weight,
            specular_color: p.specular_color,
            transmission_color: p.transmission_color,
            diffuse_color: (p.base_color * p.base_weight).lerp(p.subsurface_color, p.subsurface_weight),
            diffuse_roughness: p.base_diffuse_roughness,
            coat: distribution(p.coat_roughness, p.coat_roughness_anisotropy),
            coat_weight: p.coat_weight,
            coat_ior: p.coat_ior,
            coat_color: p.coat_color,
            darkening: SampledSpectrum::ONE,
            fuzz_weight: p.fuzz_weight,
            fuzz_color: p.fuzz_color,
            fuzz_roughness: p.fuzz_roughness,
            above: Above { fuzz: [1.0; HATS], coat: [1.0; HATS] },
            rests: Rests {
                fuzz: 1.0,
                metal: 0.0,
                metal_color: black,
                diffuse: black,
                glass: [0.0; 2],
                through: [0.0; 2],
            },
        };
        if p.coat_weight > 0.0 && p.coat_darkening > 0.0 {
            let amount = p.coat_weight * p.coat_darkening;
            surface.darkening = SampledSpectrum::ONE.lerp(surface.darkened(), amount);
        }
        surface.balance();
        surface
    }

    /// Index of refraction of the glass that it is or could be.
    pub fn eta(&self) -> f32 {
        self.index
    }

    /// The share of light that reflections in the coat leave of an opaque base.
    fn darkened(&self) -> SampledSpectrum {
        let one = SampledSpectrum::ONE;
        let reflected = SampledSpectrum::splat(mean_fresnel(self.facets.below / self.facets.above).max(0.0));
        let dielectric = reflected + (one - reflected) * self.diffuse_color;
        let albedo = dielectric.lerp(self.facets.metal, self.metalness);
        // Inside, light is reflected as outside where the base keeps its directions, and beyond the
        // critical angle, too, where it spreads them.
        let outer = mean_fresnel(self.coat_ior);
        let inner = 1.0 - (1.0 - outer) / sqr(self.coat_ior);
        let roughness = math::lerp(self.metalness, 1.0, self.roughness());
        let k = math::lerp(roughness, outer, inner);
        albedo.map(|albedo| (1.0 - k) / (1.0 - k * albedo))
    }

    /// Computes what depends on all layers.
    fn balance(&mut self) {
        let facing = Facing::new(self);
        if self.has_layers() {
            let cosines = hat_cosines().map(|cosine| cosine.max(HORIZON));
            self.above.fuzz = cosines.map(|cosine| Shares::new(self, &facing, cosine).below_fuzz);
            self.above.coat = cosines.map(|cosine| Shares::new(self, &facing, cosine).below_coat);
        }
        let white = White::mean(self.roughness());
        if self.has_layers() || self.glass() > 0.0 {
            let mut rests =
                Rests { metal: 0.0, diffuse: SampledSpectrum::ZERO, glass: [0.0; 2], ..self.rests };
            for (cosine, weight) in grid::nodes() {
                let shares = Shares::new(self, &facing, cosine);
                rests.metal += weight * shares.metal_rest;
                rests.glass[0] += weight * shares.glass_rest;
                rests.diffuse += shares.diffuse_rest * weight;
            }
            self.rests = rests;
        } else {
            self.rests.metal = if self.spreads() { 1.0 - white.albedo } else { 0.0 };
            self.rests.diffuse = facing.passed(&white);
        }
        if self.fuzz_weight > 0.0 {
            self.rests.fuzz = fuzz::mean_scattered_again(self.fuzz_roughness);
        }
        if self.metalness > 0.0 && self.spreads() {
            let kept = white.albedo;
            let mut reflected = SampledSpectrum::ZERO;
            for (cosine, weight) in grid::nodes() {
                reflected += self.facets.metal(cosine) * weight;
            }
            self.rests.metal_color = reflected.map(|f| sqr(f) * kept / (1.0 - f * (1.0 - kept)));
        }
        if self.glass() > 0.0 {
            let below = mean(|cosine| Inside::new(self, &facing, cosine).rest);
            self.rests.glass[1] = below;
            let above = self.rests.glass[0];
            if above > 0.0 && below > 0.0 {
                let most = sqr(self.index) * below / above;
                let through = (1.0 - mean_fresnel(self.index)).min(most);
                self.rests.through = [through, through / most];
            }
        }
    }

    /// √α of the base, the geometric mean of both ways.
    fn roughness(&self) -> f32 {
        self.base.mean_alpha().sqrt()
    }

    /// √α of the coat.
    fn coat_roughness(&self) -> f32 {
        self.coat.mean_alpha().sqrt()
    }

    fn has_layers(&self) -> bool {
        self.coat_weight > 0.0 || self.fuzz_weight > 0.0
    }

    /// The share of the surface that is glass.
    fn glass(&self) -> f32 {
        (1.0 - self.metalness) * self.transmission
    }

    /// Whether some layer spreads light, so that there is a rest to scatter.
    fn spreads(&self) -> bool {
        let rough = |facets: &TrowbridgeReitz| !facets.effectively_smooth();
        rough(&self.base) || self.coat_weight > 0.0 && rough(&self.coat) || self.fuzz_weight > 0.0
    }

    /// The boundary of the base.
    fn boundary(&self) -> Dielectric {
        Dielectric { eta: self.index, distribution: self.base }
    }

    /// The boundary of the coat.
    fn coat_boundary(&self) -> Dielectric {
        Dielectric { eta: self.coat_ior, distribution: self.coat }
    }

    /// What is met from the side of `z`.
    fn weights(&self, z: f32) -> Weights {
        let glass = self.glass();
        let diffuse = (1.0 - self.metalness) * (1.0 - self.transmission);
        if z > 0.0 {
            return Weights { layers: 1.0, metal: self.metalness, diffuse, glass };
        }
        Weights { layers: 1.0 - glass, metal: self.metalness, diffuse, glass: 0.0 }
    }
}

/// `w` on the side of z > 0 where `below`.
fn flip(below: bool, w: Vector3) -> Vector3 {
    if below { -w } else { w }
}

/// Whether a direction is off the horizon.
fn is_off_horizon(w: Vector3) -> bool {
    w.z.abs() > HORIZON
}

impl Scatter for OpenPbr {
    fn flags(&self) -> BxdfFlags {
        let kind = |facets: &TrowbridgeReitz| match facets.effectively_smooth() {
            true => BxdfFlags::SPECULAR,
            false => BxdfFlags::GLOSSY,
        };
        let mut flags = BxdfFlags::REFLECTION | kind(&self.base);
        if self.coat_weight > 0.0 {
            flags |= kind(&self.coat);
        }
        if self.glass() > 0.0 {
            flags |= BxdfFlags::TRANSMISSION;
        }
        if self.spreads() {
            flags |= BxdfFlags::GLOSSY;
        }
        if self.weights(1.0).diffuse > 0.0 || self.fuzz_weight > 0.0 {
            flags |= BxdfFlags::DIFFUSE;
        }
        flags
    }

    fn f(&self, wo: Vector3, wi: Vector3, mode: TransportMode) -> SampledSpectrum {
        if !(is_off_horizon(wo) && is_off_horizon(wi)) {
            return SampledSpectrum::ZERO;
        }
        self.value(&View::new(self, wo), wo, wi, mode)
    }

    fn sample_f(
        &self,
        wo: Vector3,
        uc: f32,
        u: Vec2,
        mode: TransportMode,
        directions: Directions,
    ) -> BsdfSample {
        if !is_off_horizon(wo) {
            return BsdfSample::invalid();
        }
        let view = View::new(self, wo);
        let chances = Chances::new(self, &view, wo, directions);
        let Some((lobe, chance, uc)) = chances.choose(uc) else { return BsdfSample::invalid() };
        let below = wo.z < 0.0;
        let rest = match self.weights(1.0).diffuse > 0.0 {
            true => BxdfFlags::DIFFUSE,
            false => BxdfFlags::GLOSSY,
        };
        let above = |w: Vector3, kind| (flip(below, w), BxdfFlags::REFLECTION | kind);
        let boundary =
            |boundary: Dielectric, wo, uc, directions| boundary.sample_f(wo, uc, u, mode, directions);
        let reflection = Directions::Reflection;
        let facets = match lobe {
            Lobe::Coat => Some(boundary(self.coat_boundary(), flip(below, wo), uc, reflection)),
            Lobe::Facets => Some(boundary(self.boundary(), flip(below, wo), uc, reflection)),
            Lobe::Glass => Some(self.sample_glass(wo, uc, u, mode, directions)),
            Lobe::Fuzz | Lobe::Rest | Lobe::Through => None,
        };
        let (wi, flags, eta) = match facets {
            Some(sample) if !sample.valid => return BsdfSample::invalid(),
            Some(sample) => {
                let turned = if lobe == Lobe::Glass { sample.wi } else { flip(below, sample.wi) };
                let sample = BsdfSample { wi: turned, pdf: sample.pdf * chance, ..sample };
                if sample.flags.is_specular() {
                    return self.specular(&view.shares, wo, (lobe, sample), mode);
                }
                (sample.wi, sample.flags, sample.eta)
            }
            None if lobe == Lobe::Through => {
                let wi = flip(!below, sample_cosine_hemisphere(u));
                let eta = if below { 1.0 / self.index } else { self.index };
                (wi, BxdfFlags::GLOSSY_TRANSMISSION, eta)
            }
            None => {
                let (wi, flags) = match lobe {
                    Lobe::Fuzz => above(sample_uniform_hemisphere(u), BxdfFlags::DIFFUSE),
                    _ => above(sample_cosine_hemisphere(u), rest),
                };
                (wi, flags, 1.0)
            }
        };
        let pdf = chances.pdf(self, wo, wi, mode, directions);
        let sample = BsdfSample::new(self.value(&view, wo, wi, mode), wi, pdf, flags);
        BsdfSample { eta, valid: pdf > 0.0 && is_off_horizon(wi), ..sample }
    }

    fn pdf(&self, wo: Vector3, wi: Vector3, mode: TransportMode, directions: Directions) -> f32 {
        if !(is_off_horizon(wo) && is_off_horizon(wi)) {
            return 0.0;
        }
        Chances::new(self, &View::new(self, wo), wo, directions).pdf(self, wo, wi, mode, directions)
    }

    fn regularize(&mut self, mask: bool) {
        self.base.regularize(mask);
        self.coat.regularize(mask);
        self.balance();
    }
}
