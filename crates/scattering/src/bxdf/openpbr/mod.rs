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
mod grid;
mod parameters;
mod shares;

pub use parameters::OpenPbrParameters;

use super::{BsdfSample, Dielectric, Scatter};
use crate::fresnel::mean_fresnel;
use crate::{BxdfFlags, Directions, TransportMode, TrowbridgeReitz};
use albedo::{HATS, White, hat_cosines};
use chances::{Chances, Lobe};
use diffuse::oren_nayar;
use facets::{Facets, Film};
use grid::mean;
use math::{Vec2, Vector3, same_hemisphere, sqr};
use sampling::warp::{sample_cosine_hemisphere, sample_uniform_hemisphere};
use shares::{Above, Facing, Shares, glass_rest_below};
use spectrum::{SampledSpectrum, SampledWavelengths};
use std::f32::consts::PI;

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
        let (mut metal, mut glass, mut diffuse) = (0.0, 0.0, SampledSpectrum::ZERO);
        for (cosine, weight) in grid::nodes() {
            let shares = Shares::new(self, &facing, cosine);
            metal += weight * shares.metal_rest;
            glass += weight * shares.glass_rest;
            diffuse += shares.diffuse_rest * weight;
        }
        let rests = &mut self.rests;
        (rests.metal, rests.diffuse, rests.glass[0]) = (metal, diffuse, glass);
        if self.fuzz_weight > 0.0 {
            self.rests.fuzz = fuzz::mean_scattered_again(self.fuzz_roughness);
        }
        if self.metalness > 0.0 && self.spreads() {
            let roughness = self.roughness();
            let kept = mean(|cosine| White::at(roughness, cosine).albedo);
            let mut reflected = SampledSpectrum::ZERO;
            for (cosine, weight) in grid::nodes() {
                reflected += self.facets.metal(cosine) * weight;
            }
            self.rests.metal_color = reflected.map(|f| sqr(f) * kept / (1.0 - f * (1.0 - kept)));
        }
        if self.glass() > 0.0 {
            let below = mean(|cosine| glass_rest_below(self, &facing, cosine));
            self.rests.glass[1] = below;
            if glass > 0.0 && below > 0.0 {
                let most = sqr(self.index) * below / glass;
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

    /// Absorption in the coat on paths of these lengths, in units of its thickness.
    fn absorbed(&self, lengths: f32) -> SampledSpectrum {
        if self.coat_weight == 0.0 || self.coat_color == SampledSpectrum::ONE {
            return SampledSpectrum::ONE;
        }
        SampledSpectrum::ONE.lerp(self.coat_color.powf(0.5 * lengths), self.coat_weight)
    }

    /// The length of a path through the coat.
    fn coat_length(&self, cosine: f32) -> f32 {
        1.0 / (1.0 - (1.0 - sqr(cosine)) / sqr(self.coat_ior)).sqrt().max(1e-3)
    }

    /// The reflectance of the facets of the base met from above at a cosine.
    fn reflectance(&self, cosine: f32, weights: &Weights) -> SampledSpectrum {
        let mut reflected = SampledSpectrum::ZERO;
        if weights.metal > 0.0 {
            reflected += self.facets.metal(cosine) * self.darkening * weights.metal;
        }
        if weights.diffuse + weights.glass > 0.0 {
            let dielectric = self.facets.dielectric(cosine) * self.specular_color;
            reflected +=
                dielectric * (self.darkening * weights.diffuse + SampledSpectrum::splat(weights.glass));
        }
        reflected
    }

    /// The value for two directions above of what `weights` say.
    fn reflected(&self, view: &View, wo: Vector3, wi: Vector3, weights: &Weights) -> SampledSpectrum {
        let (o, i) = (&view.shares, Shares::new(self, &view.facing, wi.z));
        let mode = TransportMode::Radiance;
        let mut f = SampledSpectrum::ZERO;
        if self.fuzz_weight > 0.0 {
            let fibres = [o.fuzz, i.fuzz];
            let fuzz = fuzz::value(self.fuzz_color, self.fuzz_roughness, self.rests.fuzz, [wo, wi], fibres);
            f += fuzz * (self.fuzz_weight * weights.layers);
        }
        if self.coat_weight > 0.0 {
            let coat = self.coat_boundary().f(wo, wi, mode) * o.below_fuzz.min(i.below_fuzz);
            f += coat * (self.coat_weight * weights.layers);
        }
        let mut base = SampledSpectrum::ZERO;
        let boundary = self.boundary();
        let (facet, is_met) = boundary.facet(wo, wi);
        if is_met {
            let white = boundary.f_facet(wo, wi, &facet, 1.0, mode) * o.below_coat.min(i.below_coat);
            base += self.reflectance(wo.dot(facet.wm), weights) * white;
        }
        if weights.diffuse > 0.0 {
            let left = (o.diffuse_rest * i.diffuse_rest).safe_div(self.rests.diffuse);
            let diffuse = oren_nayar(self.diffuse_color, self.diffuse_roughness, wo, wi);
            base += diffuse * left * self.darkening * weights.diffuse;
        }
        if weights.metal > 0.0 && self.rests.metal > 0.0 {
            let left = o.metal_rest * i.metal_rest / (PI * self.rests.metal);
            base += self.rests.metal_color * self.darkening * (left * weights.metal);
        }
        if weights.glass > 0.0 && self.rests.glass[0] > 0.0 {
            let left = o.glass_rest * i.glass_rest / (PI * self.rests.glass[0]);
            base += SampledSpectrum::splat(left * (1.0 - self.rests.through[0]) * weights.glass);
        }
        f + base * self.absorbed(self.coat_length(wo.z) + self.coat_length(wi.z))
    }

    /// The cosine outside of light that meets glass from inside at a cosine; `None` if all of it is
    /// reflected.
    fn outer_cosine(&self, cosine: f32) -> Option<f32> {
        let squared = 1.0 - (1.0 - sqr(cosine)) * sqr(self.index);
        (squared > 0.0).then(|| squared.sqrt())
    }

    /// The reflectance of facets of glass from inside: what the base reflects, and what the layers
    /// outside do of the rest.
    fn inner_reflectance(&self, cosine: f32, facing: &Facing) -> SampledSpectrum {
        let Some(outer) = self.outer_cosine(cosine) else { return SampledSpectrum::ONE };
        let reflected = self.facets.dielectric(outer);
        if !self.has_layers() {
            return reflected;
        }
        let kept = 1.0 - Shares::new(self, facing, outer.max(HORIZON)).below_coat;
        reflected + (SampledSpectrum::ONE - reflected) * kept
    }

    /// The value of glass for two directions below.
    fn reflected_inside(&self, view: &View, wo: Vector3, wi: Vector3) -> SampledSpectrum {
        let boundary = self.boundary();
        let (facet, is_met) = boundary.facet(wo, wi);
        let mut f = SampledSpectrum::ZERO;
        if is_met {
            let white = boundary.f_facet(wo, wi, &facet, 1.0, TransportMode::Radiance);
            f += self.inner_reflectance(wo.dot(facet.wm).abs(), &view.facing) * white;
        }
        if self.rests.glass[1] > 0.0 {
            let [o, i] = [wo, wi].map(|w| glass_rest_below(self, &view.facing, -w.z));
            let left = o * i;
            f += SampledSpectrum::splat(left / (PI * self.rests.glass[1]) * (1.0 - self.rests.through[1]));
        }
        f * self.glass()
    }

    /// The value of glass for directions on both sides.
    fn transmitted(&self, view: &View, wo: Vector3, wi: Vector3, mode: TransportMode) -> SampledSpectrum {
        let outside = if wo.z > 0.0 { wo } else { wi };
        let inside = if wo.z > 0.0 { wi } else { wo };
        let shares = match wo.z > 0.0 {
            true => view.shares,
            false => Shares::new(self, &view.facing, outside.z),
        };
        let boundary = self.boundary();
        let (facet, is_met) = boundary.facet(wo, wi);
        let mut f = SampledSpectrum::ZERO;
        if is_met {
            let white = boundary.f_facet(wo, wi, &facet, 0.0, mode) * shares.below_coat;
            let reflected = self.facets.dielectric(outside.dot(facet.wm).abs());
            f += (SampledSpectrum::ONE - reflected) * white;
        }
        if self.rests.glass[1] > 0.0 {
            // The rest of one side to that of the other, as energy from above to below.
            let left = shares.glass_rest * glass_rest_below(self, &view.facing, -inside.z);
            let down = left * self.rests.through[0] / (PI * self.rests.glass[1]);
            let scale = match (mode, wo.z > 0.0) {
                (TransportMode::Importance, true) | (TransportMode::Radiance, false) => 1.0,
                _ => 1.0 / sqr(self.index),
            };
            f += SampledSpectrum::splat(down * scale);
        }
        f * self.transmission_color * self.absorbed(self.coat_length(outside.z)) * self.glass()
    }

    /// The value for two directions off the horizon.
    fn value(&self, view: &View, wo: Vector3, wi: Vector3, mode: TransportMode) -> SampledSpectrum {
        let glass = self.glass() > 0.0;
        match (same_hemisphere(wo, wi), wo.z > 0.0) {
            (true, true) => self.reflected(view, wo, wi, &self.weights(1.0)),
            (true, false) => {
                let mut f = SampledSpectrum::ZERO;
                if self.glass() < 1.0 {
                    f += self.reflected(view, -wo, -wi, &self.weights(-1.0));
                }
                if glass { f + self.reflected_inside(view, wo, wi) } else { f }
            }
            (false, _) if glass => self.transmitted(view, wo, wi, mode),
            (false, _) => SampledSpectrum::ZERO,
        }
    }

    /// A specular sample with the value of the lobe that it chose.
    fn specular(
        &self,
        View { facing, shares }: &View,
        wo: Vector3,
        (lobe, sample): (Lobe, BsdfSample),
        mode: TransportMode,
    ) -> BsdfSample {
        let cosine = wo.z.abs();
        let value = if lobe == Lobe::Glass && wo.z < 0.0 {
            let reflected = self.inner_reflectance(cosine, facing);
            let through = || self.absorbed(self.coat_length(sample.wi.z)) * self.transmission_color;
            let share = match sample.flags.is_reflective() {
                true => reflected,
                false => (SampledSpectrum::ONE - reflected) * through(),
            };
            share * self.glass()
        } else {
            let weights = self.weights(wo.z);
            let length = self.coat_length(cosine);
            let base = |weights: Weights| self.reflectance(cosine, &weights) * self.absorbed(2.0 * length);
            match lobe {
                Lobe::Coat => {
                    let coat = crate::fr_dielectric(cosine, self.coat_ior) * shares.below_fuzz;
                    SampledSpectrum::splat(coat * self.coat_weight * weights.layers)
                }
                Lobe::Glass if sample.flags.is_transmissive() => {
                    let refracted = SampledSpectrum::ONE - self.facets.dielectric(cosine);
                    let tint = self.transmission_color * self.absorbed(length);
                    refracted * tint * (shares.below_coat * weights.glass)
                }
                Lobe::Glass => base(Weights { metal: 0.0, diffuse: 0.0, ..weights }) * shares.below_coat,
                _ => base(Weights { glass: 0.0, ..weights }) * shares.below_coat,
            }
        };
        let scale = match mode {
            TransportMode::Radiance => 1.0 / sqr(sample.eta),
            TransportMode::Importance => 1.0,
        };
        BsdfSample { f: value * (scale / sample.wi.z.abs()), ..sample }
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
            Lobe::Glass => Some(boundary(self.boundary(), wo, uc, directions)),
            Lobe::Fuzz | Lobe::Rest | Lobe::Through => None,
        };
        let (wi, flags, eta) = match facets {
            Some(sample) if !sample.valid => return BsdfSample::invalid(),
            Some(sample) => {
                let turned = if lobe == Lobe::Glass { sample.wi } else { flip(below, sample.wi) };
                let sample = BsdfSample { wi: turned, pdf: sample.pdf * chance, ..sample };
                if sample.flags.is_specular() {
                    return self.specular(&view, wo, (lobe, sample), mode);
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
