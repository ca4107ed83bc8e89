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
//! what is left at the end (stack.rs), and the weights w of lobes,
//!
//! ```text
//! f = w_f f_fuzz + min(T_f(θo), T_f(θi)) w_c f_coat
//!   + A(θo, θi) (min(T(θo), T(θi)) f_facets + L(θo) L(θi)/L̄ f_rest)
//! ```
//!
//! A narrow lobe keeps what the layers above pass on, as both directions have nearly the same T.
//! What the minimum takes from a wide one, what the facets mask, and what they let pass is the rest
//! L: it is scattered by the diffuse base or, as in [Kulla 2017], between facets. All factors are
//! symmetric, so that f is reciprocal, and what absorbs nothing reflects or transmits all light,
//! exactly but for tables. A material has a table of the shares (table.rs).
//!
//! Refraction is by the index of the glass alone, as the coat has parallel sides. Inside the coat
//! light is reflected back to the base again and again: darkening follows the specification's form
//! with mean albedos, so that it does not depend on directions. From below, glass is met from
//! inside, and an opaque base is as from above. Colours only absorb. Sources: [OpenPBR 2024],
//! [Kulla 2017]. Thin walls are in thin.rs.

mod albedo;
mod chances;
mod coat;
mod diffuse;
mod facets;
mod film;
mod fuzz;
mod glass;
mod grid;
mod mirror;
mod parameters;
mod shares;
mod stack;
mod table;
mod thin;
mod under;
mod value;

pub use parameters::OpenPbrParameters;
pub use table::OpenPbrTable;

use super::{BsdfSample, Dielectric, Scatter};
use crate::fresnel::mean_fresnel;
use crate::{BxdfFlags, Directions, Interior, TransportMode, TrowbridgeReitz, reflect};
use chances::{Chances, Lobe};
use math::{Vec2, Vec3, Vector3, lerp, sqr};
use sampling::warp::{cosine_hemisphere_pdf, sample_cosine_hemisphere, sample_uniform_hemisphere};
use shares::{Rests, Shares};
use spectrum::{SampledSpectrum, SampledWavelengths};
use stack::Stack;
use std::f32::consts::FRAC_1_PI;
use table::Numbers;
use under::Part;

/// Directions nearer to the horizon scatter nothing.
const HORIZON: f32 = 1e-6;

/// A principled surface.
#[derive(Clone, Copy, Debug)]
pub struct OpenPbr<'a> {
    table: &'a OpenPbrTable,
    /// The place in the table.
    numbers: Numbers,
    stack: Stack,
    /// The thickness of the film in wavelengths.
    waves: SampledSpectrum,
    metalness: f32,
    transmission: f32,
    /// Factor on the reflectance of metal.
    metal_weight: f32,
    diffuse_roughness: f32,
    /// F₀ of metal.
    metal_color: SampledSpectrum,
    /// The share of light that metal keeps between its facets.
    metal_again: SampledSpectrum,
    specular_color: SampledSpectrum,
    transmission_color: SampledSpectrum,
    diffuse_color: SampledSpectrum,
    /// The share of the diffuse base that has this colour.
    diffuse_weight: f32,
    /// The diffuse colour without what is scattered under the surface.
    base_color: SampledSpectrum,
    subsurface_color: SampledSpectrum,
    subsurface_weight: f32,
    /// The medium under the surface.
    interior: Option<Interior>,
    part: Part,
    /// What the rest of it, within a thin wall, scatters, and the share of that which it transmits.
    scattered: SampledSpectrum,
    forward: f32,
    coat_color: SampledSpectrum,
    /// Its normal.
    coat_normal: Vector3,
    /// Factor on opaque bases.
    darkening: SampledSpectrum,
    fuzz_color: SampledSpectrum,
}

/// What all values and densities of one direction share.
struct View {
    /// Of the direction or, if it is below, of its opposite.
    shares: Shares,
    rests: Rests,
}

impl View {
    /// For a direction off the horizon.
    #[inline]
    fn new(surface: &OpenPbr, wo: Vector3) -> Self {
        Self { shares: surface.shares(wo), rests: surface.rests() }
    }
}

/// Weights of the lobes that directions on one side of the surface meet.
struct Weights {
    /// Fuzz and coat.
    layers: f32,
    metal: f32,
    diffuse: f32,
    /// The share of the diffuse base that paths go under.
    under: f32,
    glass: f32,
}

impl<'a> OpenPbr<'a> {
    /// The surface at the wavelengths of a path, of a material with a table for its numbers.
    #[inline]
    pub fn new(table: &'a OpenPbrTable, p: &OpenPbrParameters, lambda: &SampledWavelengths) -> Self {
        let mut surface = Self {
            table,
            numbers: table.place(p),
            stack: table.stack(p),
            waves: SampledSpectrum::ZERO,
            metalness: p.base_metalness,
            transmission: p.transmission_weight,
            metal_weight: p.specular_weight.min(1.0),
            diffuse_roughness: p.base_diffuse_roughness,
            metal_color: p.base_color * p.base_weight,
            metal_again: SampledSpectrum::ZERO,
            specular_color: p.specular_color,
            transmission_color: p.transmission_color,
            diffuse_color: (p.base_color * p.base_weight).lerp(p.subsurface_color, p.subsurface_weight),
            diffuse_weight: 1.0,
            base_color: p.base_color * p.base_weight,
            subsurface_color: p.subsurface_color,
            subsurface_weight: p.subsurface_weight,
            interior: under::interior(p),
            part: Part::Whole,
            scattered: SampledSpectrum::ZERO,
            forward: 0.0,
            coat_color: p.coat_color,
            coat_normal: p.geometry_coat_normal,
            darkening: SampledSpectrum::ONE,
            fuzz_color: p.fuzz_color,
        };
        if p.geometry_thin_walled {
            surface.diffuse_color = surface.metal_color;
            surface.diffuse_weight = 1.0 - p.subsurface_weight;
            surface.scattered = p.subsurface_color * p.subsurface_weight;
            surface.forward = 0.5 * (1.0 + p.subsurface_scatter_anisotropy);
        }
        if surface.stack.film_weight > 0.0 {
            let thickness = SampledSpectrum::splat(1000.0 * p.thin_film_thickness);
            surface.waves = thickness / SampledSpectrum::new(*lambda.lambda());
        }
        if p.coat_weight > 0.0 && p.coat_darkening > 0.0 {
            let amount = p.coat_weight * p.coat_darkening;
            surface.darkening = SampledSpectrum::ONE.lerp(surface.darkened(), amount);
        }
        if p.base_metalness > 0.0 && surface.stack.spreads() {
            let kept = table.means(&surface.numbers, surface.waves[0]).white;
            surface.metal_again = surface.mean_metal().map(|f| sqr(f) * kept / (1.0 - f * (1.0 - kept)));
        }
        surface
    }

    /// Index of refraction of the glass that it is or could be; 1 for thin walls.
    pub fn eta(&self) -> f32 {
        if self.stack.is_thin { 1.0 } else { self.stack.index }
    }

    /// The share of light that reflections in the coat leave of an opaque base.
    fn darkened(&self) -> SampledSpectrum {
        let one = SampledSpectrum::ONE;
        let stack = &self.stack;
        let reflected = SampledSpectrum::splat(mean_fresnel(stack.below / stack.above).max(0.0));
        let dielectric =
            reflected + (one - reflected) * (self.diffuse_color * self.diffuse_weight + self.scattered);
        let albedo = dielectric.lerp(self.metal_color, self.metalness);
        // Inside, light is reflected as outside where the base keeps its directions, and beyond the
        // critical angle, too, where it spreads them.
        let outer = mean_fresnel(stack.coat_ior);
        let inner = 1.0 - (1.0 - outer) / sqr(stack.coat_ior);
        let roughness = lerp(self.metalness, 1.0, stack.base.mean_alpha().sqrt());
        let k = lerp(roughness, outer, inner);
        albedo.map(|albedo| (1.0 - k) / (1.0 - k * albedo))
    }

    /// Whether the diffuse base is that of a thin wall which transmits light.
    fn transmits_diffusely(&self) -> bool {
        self.forward > 0.0 && !self.scattered.is_black()
    }

    /// What the diffuse base reflects of the light that is left for it.
    #[inline]
    fn diffuse_albedo(&self, weights: &Weights) -> SampledSpectrum {
        match self.stack.is_thin {
            true => self.diffuse_color * self.diffuse_weight + self.scattered * (1.0 - self.forward),
            false if weights.under > 0.0 => self.base_color * (1.0 - weights.under),
            false => self.diffuse_color,
        }
    }

    /// The share of the surface that is glass.
    #[inline]
    fn glass(&self) -> f32 {
        (1.0 - self.metalness) * self.transmission
    }

    /// The boundary of the base.
    fn boundary(&self) -> Dielectric {
        Dielectric { eta: self.stack.index, distribution: self.stack.base }
    }

    /// What is met from the side of `z`.
    fn weights(&self, z: f32) -> Weights {
        let glass = self.glass();
        let diffuse = (1.0 - self.metalness) * (1.0 - self.transmission);
        if z > 0.0 || self.stack.is_thin {
            let under = self.share_under(z);
            return Weights { layers: 1.0, metal: self.metalness, diffuse, under, glass };
        }
        Weights { layers: 1.0 - glass, metal: self.metalness, diffuse, under: 0.0, glass: 0.0 }
    }
}

/// `w` on the side of z > 0 where `below`.
fn flip(below: bool, w: Vector3) -> Vector3 {
    if below { -w } else { w }
}

/// A sample of the mirror images of a direction above in facets, without its value, and of the
/// density only that of a smooth surface.
fn mirrored(facets: &TrowbridgeReitz, wo: Vector3, u: Vec2) -> BsdfSample {
    let (wi, lobe) = match facets.effectively_smooth() {
        true => (Vec3::new(-wo.x, -wo.y, wo.z), BxdfFlags::SPECULAR_REFLECTION),
        false => (reflect(wo, facets.sample_wm(wo, u)), BxdfFlags::GLOSSY_REFLECTION),
    };
    BsdfSample { valid: wi.z > 0.0, ..BsdfSample::new(SampledSpectrum::ZERO, wi, 1.0, lobe) }
}

/// Whether a direction is off the horizon.
fn is_off_horizon(w: Vector3) -> bool {
    w.z.abs() > HORIZON
}

impl Scatter for OpenPbr<'_> {
    fn flags(&self) -> BxdfFlags {
        if self.is_lobe() {
            return BxdfFlags::DIFFUSE_REFLECTION;
        }
        let kind = |facets: &TrowbridgeReitz| match facets.effectively_smooth() {
            true => BxdfFlags::SPECULAR,
            false => BxdfFlags::GLOSSY,
        };
        let mut flags = BxdfFlags::REFLECTION | kind(&self.stack.base);
        if self.stack.coat_weight > 0.0 {
            flags |= kind(&self.stack.coat);
        }
        if self.glass() > 0.0 {
            flags |= BxdfFlags::TRANSMISSION;
            if self.stack.is_thin {
                flags |= kind(&self.stack.sheet());
            }
        }
        if self.weights(1.0).diffuse > 0.0 && self.transmits_diffusely() {
            flags |= BxdfFlags::TRANSMISSION;
        }
        if self.stack.spreads() {
            flags |= BxdfFlags::GLOSSY;
        }
        let weights = self.weights(1.0);
        if weights.diffuse * (1.0 - weights.under) > 0.0 || self.stack.fuzz_weight > 0.0 {
            flags |= BxdfFlags::DIFFUSE;
        }
        flags
    }

    fn f(&self, wo: Vector3, wi: Vector3, mode: TransportMode) -> SampledSpectrum {
        if !(is_off_horizon(wo) && is_off_horizon(wi)) {
            return SampledSpectrum::ZERO;
        }
        if self.is_lobe() {
            return if wo.z > 0.0 && wi.z > 0.0 { self.lobe(wi) } else { SampledSpectrum::ZERO };
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
        if self.is_lobe() {
            let wi = sample_cosine_hemisphere(u);
            let pdf = self.pdf(wo, wi, mode, directions);
            let sample = BsdfSample::new(self.f(wo, wi, mode), wi, pdf, BxdfFlags::DIFFUSE_REFLECTION);
            return BsdfSample { valid: pdf > 0.0, ..sample };
        }
        let view = View::new(self, wo);
        let chances = Chances::new(self, &view, wo, mode, directions);
        let Some((lobe, chance, uc)) = chances.choose(uc) else { return BsdfSample::invalid() };
        let below = wo.z < 0.0;
        let rest = match self.weights(1.0).diffuse > 0.0 {
            true => BxdfFlags::DIFFUSE,
            false => BxdfFlags::GLOSSY,
        };
        let above = |w: Vector3, kind| (flip(below, w), BxdfFlags::REFLECTION | kind);
        let facets = match lobe {
            Lobe::Coat => Some(self.sample_coat(flip(below, wo), u)),
            Lobe::Facets => Some(mirrored(&self.stack.base, flip(below, wo), u)),
            Lobe::Glass if self.stack.is_thin => Some(self.sample_sheet(wo, u)),
            Lobe::Glass => Some(self.sample_glass(wo, uc, u, mode, directions)),
            Lobe::Under => {
                let wi = -sample_cosine_hemisphere(u);
                let f = self.goes_under(&view.shares, wo) * FRAC_1_PI;
                let pdf = chance * cosine_hemisphere_pdf(-wi.z);
                let sample = BsdfSample::new(f, wi, pdf, BxdfFlags::DIFFUSE_TRANSMISSION);
                return BsdfSample { valid: is_off_horizon(wi), ..sample };
            }
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
                let eta = if below { 1.0 / self.eta() } else { self.eta() };
                let kind = if self.transmits_diffusely() { rest } else { BxdfFlags::GLOSSY };
                (wi, BxdfFlags::TRANSMISSION | kind, eta)
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
        if self.is_lobe() {
            let is_above = wo.z > 0.0 && wi.z > 0.0 && directions.reflection();
            return if is_above { cosine_hemisphere_pdf(wi.z) } else { 0.0 };
        }
        let chances = Chances::new(self, &View::new(self, wo), wo, mode, directions);
        chances.pdf(self, wo, wi, mode, directions)
    }

    /// The layers pass on what they did before: what is wider loses a little.
    fn regularize(&mut self, mask: bool) {
        self.stack.base.regularize(mask);
        self.stack.coat.regularize(mask);
    }
}
