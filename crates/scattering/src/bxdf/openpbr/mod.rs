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
//! symmetric, so that f is reciprocal but under a coat with a normal of its own (coat.rs), and what
//! absorbs nothing reflects or transmits all light, exactly but for tables. A material has a table
//! of the shares (table.rs).
//!
//! Refraction is by the index of the glass alone, as the coat has parallel sides. Inside the coat
//! light is reflected back to the base again and again: darkening follows the specification's form
//! with mean albedos, so that it does not depend on directions. From below, glass is met from
//! inside, and an opaque base is as from above. Colours only absorb. Sources: [OpenPBR 2024],
//! [Kulla 2017]. Thin walls are in thin.rs.

mod albedo;
mod chances;
mod coat;
mod facets;
mod film;
mod fuzz;
mod glass;
mod mirror;
mod oren_nayar;
mod parameters;
mod shares;
mod stack;
mod table;
mod thin;
mod under;
mod value;

pub use parameters::OpenPbrParameters;
pub use table::{OpenPbrTable, PlainOpenPbrTable};

use super::{BsdfSample, Dielectric, Scatter};
use crate::fresnel::mean_fresnel;
use crate::{BxdfFlags, Directions, Interior, TransportMode, TrowbridgeReitz, reflect};
use chances::{COAT, Chances, ChosenLobe, FACETS, FUZZ, GLASS, THROUGH, UNDER};
use lanes::{Callee, Int, Mask, Real};
use math::{Vec2, Vec3, Vector3, lerp, sqr};
use sampling::warp::{cosine_hemisphere_pdf, sample_cosine_hemisphere, sample_uniform_hemisphere};
use shares::Shares;
use spectrum::{N, SampledSpectrum, SampledWavelengths};
use stack::Stack;
use std::f32::consts::FRAC_1_PI;
use table::Location;
use under::Part;

/// Directions nearer to the horizon scatter nothing.
const HORIZON: f32 = 1e-6;

/// A principled surface.
#[derive(Clone, Copy, Debug)]
pub struct OpenPbr<'a, R: Real = f32> {
    table: &'a OpenPbrTable,
    /// The place in the table.
    location: Location<R>,
    stack: Stack<R>,
    /// The optical thickness of the film in wavelengths.
    waves: SampledSpectrum<R>,
    metalness: R,
    transmission: R,
    metal: Metal<R>,
    diffuse_base: DiffuseBase<R>,
    specular_color: SampledSpectrum<R>,
    transmission_color: SampledSpectrum<R>,
    subsurface_color: SampledSpectrum<R>,
    subsurface_weight: R,
    /// The medium under the surface; black where there is none.
    interior: Interior<R>,
    part: Part,
    coat_color: SampledSpectrum<R>,
    /// Its normal.
    coat_normal: Vector3<R>,
    /// Factor on opaque bases.
    darkening: SampledSpectrum<R>,
    fuzz_color: SampledSpectrum<R>,
}

/// The base of metal.
#[derive(Clone, Copy, Debug)]
struct Metal<R: Real> {
    /// Factor on its reflectance.
    weight: R,
    /// F₀.
    color: SampledSpectrum<R>,
    /// The share of light that is kept between its facets.
    again: SampledSpectrum<R>,
}

/// The diffuse base.
#[derive(Clone, Copy, Debug)]
struct DiffuseBase<R: Real> {
    roughness: R,
    color: SampledSpectrum<R>,
    /// The share that has this colour.
    weight: R,
    /// The colour without what is scattered under the surface.
    over: SampledSpectrum<R>,
    /// Light that the rest of it, within a thin wall, scatters, and the share of that which is
    /// transmitted.
    scattered: SampledSpectrum<R>,
    forward: R,
}

/// Weights of the lobes that directions on one side of the surface meet.
struct Weights<R = f32> {
    /// Fuzz and coat.
    layers: R,
    metal: R,
    diffuse: R,
    /// The share of the diffuse base that paths go under.
    under: R,
    glass: R,
}

impl<'a, R: Real> OpenPbr<'a, R> {
    /// The surface at the wavelengths of a path, of a material with a table for its numbers.
    #[inline(always)]
    pub fn new(table: &'a OpenPbrTable, p: &OpenPbrParameters<R>, lambda: &SampledWavelengths<R>) -> Self {
        let (zero, one) = (R::zero(), R::one());
        let (black, white) = (SampledSpectrum::zero(), SampledSpectrum::splat(one));
        let base_color = p.base_color * p.base_weight;
        let mut surface = Self {
            table,
            location: table.locate(p),
            stack: Stack::new(p),
            waves: black,
            metalness: p.base_metalness,
            transmission: p.transmission_weight,
            metal: Metal { weight: p.specular_weight.min(one), color: base_color, again: black },
            diffuse_base: DiffuseBase {
                roughness: p.base_diffuse_roughness,
                color: base_color.lerp(p.subsurface_color, p.subsurface_weight),
                weight: one,
                over: base_color,
                scattered: black,
                forward: zero,
            },
            specular_color: p.specular_color,
            transmission_color: p.transmission_color,
            subsurface_color: p.subsurface_color,
            subsurface_weight: p.subsurface_weight,
            interior: under::interior(p),
            part: Part::Whole,
            coat_color: p.coat_color,
            coat_normal: p.geometry_coat_normal,
            darkening: white,
            fuzz_color: p.fuzz_color,
        };
        if p.geometry_thin_walled {
            surface.diffuse_base.color = base_color;
            surface.diffuse_base.weight = one - p.subsurface_weight;
            surface.diffuse_base.scattered = p.subsurface_color * p.subsurface_weight;
            surface.diffuse_base.forward = R::splat(0.5) * (one + p.subsurface_scatter_anisotropy);
        }
        let is_filmed = p.thin_film_weight.gt(zero);
        if is_filmed.any() {
            let thickness = R::splat(1000.0) * p.thin_film_thickness * p.thin_film_ior;
            for i in 0..N {
                surface.waves[i] = R::select(is_filmed, thickness / lambda.lambda()[i], zero);
            }
        }
        let is_darkened = p.coat_weight.gt(zero) & p.coat_darkening.gt(zero);
        if is_darkened.any() {
            let darkened = white.lerp(surface.darkened(), p.coat_weight * p.coat_darkening);
            surface.darkening = SampledSpectrum::select(is_darkened, darkened, white);
        }
        let has_rest = p.base_metalness.gt(zero) & surface.stack.spreads();
        if has_rest.any() {
            let kept = table.means(&surface.location, surface.waves[0]).white;
            let mut again = surface.mean_metal();
            for f in &mut again.0 {
                *f = sqr(*f) * kept / (one - *f * (one - kept));
            }
            surface.metal.again = SampledSpectrum::select(has_rest, again, black);
        }
        surface
    }

    /// The share of light that reflections in the coat leave of an opaque base.
    #[inline(always)]
    fn darkened(&self) -> SampledSpectrum<R> {
        let (zero, one) = (R::zero(), R::one());
        let stack = &self.stack;
        let mean = mean_fresnel(stack.below / stack.above).max(zero);
        let DiffuseBase { color, weight, scattered, .. } = self.diffuse_base;
        let diffuse = color * weight + scattered;
        let dielectric = SampledSpectrum::splat(mean) + diffuse * (one - mean);
        // Inside, light is reflected as outside where the base keeps its directions, and beyond the
        // critical angle, too, where it spreads them.
        let outer = mean_fresnel(stack.coat_ior);
        let inner = one - (one - outer) / sqr(stack.coat_ior);
        let roughness = lerp(self.metalness, one, stack.base.mean_alpha().sqrt());
        let k = lerp(roughness, outer, inner);
        let mut darkened = dielectric.lerp(self.metal.color, self.metalness);
        for albedo in &mut darkened.0 {
            *albedo = (one - k) / (one - k * *albedo);
        }
        darkened
    }

    /// Whether the diffuse base is that of a thin wall which transmits light.
    #[inline(always)]
    fn transmits_diffusely(&self) -> R::Mask {
        self.diffuse_base.forward.gt(R::zero()) & !self.diffuse_base.scattered.is_black()
    }

    /// What the diffuse base reflects of the light that is left for it.
    #[inline(always)]
    fn diffuse_albedo(&self, weights: &Weights<R>) -> SampledSpectrum<R> {
        if self.stack.is_thin {
            let DiffuseBase { color, weight, scattered, forward, .. } = self.diffuse_base;
            return color * weight + scattered * (R::one() - forward);
        }
        let over = self.diffuse_base.over * (R::one() - weights.under);
        SampledSpectrum::select(weights.under.gt(R::zero()), over, self.diffuse_base.color)
    }

    /// The share of the surface that is glass.
    #[inline(always)]
    fn glass(&self) -> R {
        (R::one() - self.metalness) * self.transmission
    }

    /// The boundary of the base.
    #[inline(always)]
    fn boundary(&self) -> Dielectric<R> {
        Dielectric { eta: self.stack.index, distribution: self.stack.base }
    }

    /// What is met from the side of `z`.
    #[inline(always)]
    fn weights(&self, z: R) -> Weights<R> {
        let (zero, one, glass) = (R::zero(), R::one(), self.glass());
        let diffuse = (one - self.metalness) * (one - self.transmission);
        let whole = z.gt(zero) | R::Mask::splat(self.stack.is_thin);
        Weights {
            layers: R::select(whole, one, one - glass),
            metal: self.metalness,
            diffuse,
            under: self.share_under(z),
            glass: R::select(whole, glass, zero),
        }
    }
}

impl OpenPbr<'_> {
    /// Index of refraction of the glass that it is or could be; 1 for thin walls.
    pub fn eta(&self) -> f32 {
        self.outer_index()
    }
}

impl<R: Real> OpenPbr<'_, R> {
    /// The index of refraction that light meets from above.
    #[inline(always)]
    fn outer_index(&self) -> R {
        if self.stack.is_thin { R::one() } else { self.stack.index }
    }
}

/// `w` on the side of z > 0 where `below`.
#[inline(always)]
fn upright<R: Real>(below: R::Mask, w: Vector3<R>) -> Vector3<R> {
    Vec3::select(below, -w, w)
}

/// Of what belongs to `wo` and to `wi` that of the direction from which light is seen.
#[inline(always)]
fn of_viewer<R: Real>([o, i]: [R; 2], mode: TransportMode) -> R {
    match mode {
        TransportMode::Radiance => o,
        TransportMode::Importance => i,
    }
}

/// A direction mirrored by the plane of the surface.
#[inline(always)]
fn turned<R: Real>(w: Vector3<R>) -> Vector3<R> {
    Vec3::new(w.x, w.y, -w.z)
}

/// A sample of the mirror images of a direction above in facets, without its value, and of the
/// density only that of a smooth surface.
#[inline(always)]
fn mirrored<R: Real>(facets: &TrowbridgeReitz<R>, wo: Vector3<R>, u: Vec2<R>) -> BsdfSample<R> {
    let is_smooth = facets.effectively_smooth();
    let turned = Vec3::new(-wo.x, -wo.y, wo.z);
    let wi = Vec3::select(is_smooth, turned, reflect(wo, facets.sample_wm(wo, u)));
    let lobe = BxdfFlags::choose(is_smooth, BxdfFlags::SPECULAR_REFLECTION, BxdfFlags::GLOSSY_REFLECTION);
    BsdfSample { valid: wi.z.gt(R::zero()), ..BsdfSample::new(SampledSpectrum::zero(), wi, R::one(), lobe) }
}

/// Whether a direction is off the horizon.
#[inline(always)]
fn is_off_horizon<R: Real>(w: Vector3<R>) -> R::Mask {
    w.z.abs().gt(R::splat(HORIZON))
}

/// The width of facets.
#[inline(always)]
fn width<R: Real>(facets: &TrowbridgeReitz<R>) -> BxdfFlags<R> {
    BxdfFlags::choose(facets.effectively_smooth(), BxdfFlags::SPECULAR, BxdfFlags::GLOSSY)
}

/// `flags` where the mask is true, else no scattering.
#[inline(always)]
fn only<R: Real>(mask: R::Mask, flags: BxdfFlags<R>) -> BxdfFlags<R> {
    BxdfFlags::select(mask, flags, BxdfFlags::splat(BxdfFlags::NONE))
}

impl<R: Real> Scatter<R> for OpenPbr<'_, R> {
    #[inline(always)]
    fn flags(&self) -> BxdfFlags<R> {
        if self.is_lobe() {
            return BxdfFlags::splat(BxdfFlags::DIFFUSE_REFLECTION);
        }
        let zero = R::zero();
        let weights = self.weights(R::one());
        let is_glass = self.glass().gt(zero);
        let mut flags = BxdfFlags::splat(BxdfFlags::REFLECTION) | width(&self.stack.base);
        flags |= only(self.stack.coat_weight.gt(zero), width(&self.stack.coat));
        if self.stack.is_thin {
            flags |= only(is_glass, width(&self.stack.sheet()));
        }
        let transmits = is_glass | weights.diffuse.gt(zero) & self.transmits_diffusely();
        flags |= BxdfFlags::only_where(transmits, BxdfFlags::TRANSMISSION);
        flags |= BxdfFlags::only_where(self.stack.spreads(), BxdfFlags::GLOSSY);
        let over = weights.diffuse * (R::one() - weights.under);
        let is_diffuse = over.gt(zero) | self.stack.fuzz_weight.gt(zero);
        flags | BxdfFlags::only_where(is_diffuse, BxdfFlags::DIFFUSE)
    }

    #[inline(always)]
    fn f(&self, wo: Vector3<R>, wi: Vector3<R>, mode: TransportMode) -> SampledSpectrum<R> {
        R::call(OpenPbrValue { surface: self, wo, wi, mode })
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
        R::call(OpenPbrSample { surface: self, wo, uc, u, mode, directions })
    }

    #[inline(always)]
    fn pdf(&self, wo: Vector3<R>, wi: Vector3<R>, mode: TransportMode, directions: Directions) -> R {
        R::call(OpenPbrDensity { surface: self, wo, wi, mode, directions })
    }

    /// The layers pass on what they did before: what is wider loses a little.
    #[inline(always)]
    fn regularize(&mut self, mask: R::Mask) {
        let (mut base, mut coat) = (self.stack.base, self.stack.coat);
        base.regularize(mask);
        coat.regularize(mask);
        (self.stack.base, self.stack.coat) = (base, coat);
    }
}

/// The value for two directions.
struct OpenPbrValue<'b, 'a, R: Real> {
    surface: &'b OpenPbr<'a, R>,
    wo: Vector3<R>,
    wi: Vector3<R>,
    mode: TransportMode,
}

impl<R: Real> Callee<R> for OpenPbrValue<'_, '_, R> {
    type Output = SampledSpectrum<R>;

    #[inline(always)]
    fn run(self) -> SampledSpectrum<R> {
        let Self { surface, wo, wi, mode } = self;
        let black = SampledSpectrum::zero();
        let mut valid = is_off_horizon(wo) & is_off_horizon(wi);
        if surface.is_lobe() {
            valid = valid & wo.z.gt(R::zero()) & wi.z.gt(R::zero());
        }
        if !valid.any() {
            return black;
        }
        if surface.is_lobe() {
            return SampledSpectrum::select(valid, surface.lobe(wi), black);
        }
        let (o, i, rests) = (surface.shares(wo), surface.shares(wi), surface.rests());
        SampledSpectrum::select(valid, surface.value([&o, &i], &rests, [wo, wi], mode), black)
    }
}

/// The density of a direction.
struct OpenPbrDensity<'b, 'a, R: Real> {
    surface: &'b OpenPbr<'a, R>,
    wo: Vector3<R>,
    wi: Vector3<R>,
    mode: TransportMode,
    directions: Directions,
}

impl<R: Real> Callee<R> for OpenPbrDensity<'_, '_, R> {
    type Output = R;

    #[inline(always)]
    fn run(self) -> R {
        let Self { surface, wo, wi, mode, directions } = self;
        let valid = is_off_horizon(wo) & is_off_horizon(wi);
        if !valid.any() {
            return R::zero();
        }
        if surface.is_lobe() {
            if directions == Directions::Transmission {
                return R::zero();
            }
            let valid = valid & wo.z.gt(R::zero()) & wi.z.gt(R::zero());
            return R::select(valid, cosine_hemisphere_pdf(wi.z), R::zero());
        }
        let (shares, rests) = (surface.shares(wo), surface.rests());
        let chances = Chances::new(surface, &shares, &rests, wo, mode, directions);
        R::select(valid, chances.pdf(surface, [wo, wi], mode, directions), R::zero())
    }
}

/// A sample of directions.
struct OpenPbrSample<'b, 'a, R: Real> {
    surface: &'b OpenPbr<'a, R>,
    wo: Vector3<R>,
    uc: R,
    u: Vec2<R>,
    mode: TransportMode,
    directions: Directions,
}

impl<R: Real> Callee<R> for OpenPbrSample<'_, '_, R> {
    type Output = BsdfSample<R>;

    #[inline(always)]
    fn run(self) -> BsdfSample<R> {
        let Self { surface, wo, uc, u, mode, directions } = self;
        let mut valid = is_off_horizon(wo);
        if !valid.any() {
            return BsdfSample::invalid();
        }
        if surface.is_lobe() {
            let wi = sample_cosine_hemisphere(u);
            valid = valid & is_off_horizon(wi) & wo.z.gt(R::zero());
            if directions == Directions::Transmission {
                return BsdfSample::invalid();
            }
            let lobe = BxdfFlags::splat(BxdfFlags::DIFFUSE_REFLECTION);
            let sample = BsdfSample::new(surface.lobe(wi), wi, cosine_hemisphere_pdf(wi.z), lobe);
            return BsdfSample { valid, ..sample };
        }
        let (shares, rests) = (surface.shares(wo), surface.rests());
        let chances = Chances::new(surface, &shares, &rests, wo, mode, directions);
        let choice = chances.choose(uc);
        let sample = surface.direction(wo, &choice, u, mode, directions);
        valid = valid & choice.chance.gt(R::zero()) & sample.valid;
        let is_under = choice.lobe.eq(R::Int::splat(UNDER));
        let is_specular = sample.flags.is_specular();
        let (mut f, mut pdf) = (sample.f, sample.pdf * choice.chance);
        if (valid & is_specular).any() {
            let specular = surface.specular(&shares, wo, choice.lobe, &sample, mode);
            f = SampledSpectrum::select(is_specular, specular, f);
        }
        if (valid & is_under).any() {
            let under = surface.goes_under(&shares, wo) * R::splat(FRAC_1_PI);
            f = SampledSpectrum::select(is_under, under, f);
            pdf = R::select(is_under, choice.chance * cosine_hemisphere_pdf(sample.wi.z.abs()), pdf);
            valid = valid & (!is_under | is_off_horizon(sample.wi));
        }
        let is_wide = valid & !(is_specular | is_under);
        if is_wide.any() {
            let there = surface.shares(sample.wi);
            let value = surface.value([&shares, &there], &rests, [wo, sample.wi], mode);
            f = SampledSpectrum::select(is_wide, value, f);
            pdf = R::select(is_wide, chances.pdf(surface, [wo, sample.wi], mode, directions), pdf);
            valid = valid & (!is_wide | pdf.gt(R::zero()) & is_off_horizon(sample.wi));
        }
        BsdfSample { f, pdf, valid, ..sample }
    }
}

impl<R: Real> OpenPbr<'_, R> {
    /// A direction of the lobe that is chosen, without its value, and of the density only that of
    /// a smooth surface.
    #[inline(always)]
    fn direction(
        &self,
        wo: Vector3<R>,
        choice: &ChosenLobe<R>,
        u: Vec2<R>,
        mode: TransportMode,
        directions: Directions,
    ) -> BsdfSample<R> {
        let is_below = wo.z.lt(R::zero());
        let up = upright(is_below, wo);
        let is_fuzz = choice.lobe.eq(R::Int::splat(FUZZ));
        let is_coat = choice.lobe.eq(R::Int::splat(COAT));
        let is_facets = choice.lobe.eq(R::Int::splat(FACETS));
        let is_glass = choice.lobe.eq(R::Int::splat(GLASS));
        let is_through = choice.lobe.eq(R::Int::splat(THROUGH));
        let is_under = choice.lobe.eq(R::Int::splat(UNDER));
        // The rest, and what else is by the cosine; with `wo` above.
        let is_diffuse = self.weights(R::one()).diffuse.gt(R::zero());
        let wi = sample_cosine_hemisphere(u);
        let rest = BxdfFlags::choose(is_diffuse, BxdfFlags::DIFFUSE_REFLECTION, BxdfFlags::GLOSSY_REFLECTION);
        let mut sample = BsdfSample::new(SampledSpectrum::zero(), wi, R::one(), rest);
        if is_fuzz.any() {
            sample.wi = Vec3::select(is_fuzz, sample_uniform_hemisphere(u), sample.wi);
            let lobe = BxdfFlags::splat(BxdfFlags::DIFFUSE_REFLECTION);
            sample.flags = BxdfFlags::select(is_fuzz, lobe, sample.flags);
        }
        if (is_through | is_under).any() {
            let is_diffuse = is_under | is_diffuse & self.transmits_diffusely();
            let lobe = BxdfFlags::choose(
                is_diffuse,
                BxdfFlags::DIFFUSE_TRANSMISSION,
                BxdfFlags::GLOSSY_TRANSMISSION,
            );
            let index = self.outer_index();
            let met = R::select(is_below, R::one() / index, index);
            sample.wi = Vec3::select(is_through | is_under, -wi, sample.wi);
            sample.flags = BxdfFlags::select(is_through | is_under, lobe, sample.flags);
            sample.eta = R::select(is_through, met, sample.eta);
        }
        if is_coat.any() {
            sample = BsdfSample::select(is_coat, self.sample_coat(up, choice.u, u, mode), sample);
        }
        if is_facets.any() {
            sample = BsdfSample::select(is_facets, mirrored(&self.stack.base, up, u), sample);
        }
        if is_glass.any() {
            if self.stack.is_thin {
                sample = BsdfSample::select(is_glass, self.sample_sheet(up, u), sample);
            } else {
                let glass = self.sample_glass(wo, choice.u, u, directions);
                let wi = upright(is_below, glass.wi);
                sample = BsdfSample::select(is_glass, BsdfSample { wi, ..glass }, sample);
            }
        }
        BsdfSample { wi: upright(is_below, sample.wi), ..sample }
    }
}
