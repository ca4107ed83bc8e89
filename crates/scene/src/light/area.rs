//! Surfaces that emit the same radiance in all directions: a constant, or an image over their (u,
//! v).
//!
//! Every primitive of an emitting geometry is a light of its own; a row of the table names the
//! geometry, the instances through which it is seen, and the emission. Power: Φ = π·A·L, twice that
//! when both sides emit. Where an alpha texture cuts the surface out, it does not emit; a surface
//! with the constant alpha 0 is an invisible light, which rays never hit but light sampling still
//! finds. Rays pass through holes and may meet a round surface a second time: where that emits, the
//! surface is sampled by area, and the density of a direction is that of the point which the ray
//! has hit. Emitted rays are uniform in area (patches may follow an image) and cosine-distributed,
//! on either side with equal probability if both emit. Sources: [Pharr 2023 §12.4].

use super::emitter::{Emitter, motion_bounds};
use super::{
    EmissionId, LightBounds, LightLeSample, LightLiSample, LightModel, LightPart, LightPoint,
    LightSampleContext,
};
use crate::texture::{FloatTextureId, TextureContext};
use geometry::{GeometryId, InstancePath, ShapeSample, World};
use math::{DirectionCone, Frame, Normal3, Point2, Point3, Ray, Vector3};
use sampling::{hash_float, warp};
use spectrum::{Rgb, SampledSpectrum, SampledWavelengths};
use std::f32::consts::PI;

/// The primitives of an emitting geometry.
#[derive(Clone, Debug)]
pub struct AreaLight {
    /// The geometry that emits.
    pub geometry: GeometryId,
    /// The instances through which it is seen.
    pub instance: InstancePath,
    /// Its emission.
    pub emission: EmissionId,
    /// Alpha texture; `None` is opaque or invisible.
    pub alpha: Option<FloatTextureId>,
    /// Whether no ray ever hits the surface (its alpha is constantly 0).
    pub invisible: bool,
    /// The scale of the emission by primitive, where the description requests a power for each;
    /// `None` where all have the emission's own scale.
    pub scales: Option<Box<[f32]>>,
}

impl AreaLight {
    /// Calls `f` with the emitter of a primitive at `time`; `None` if there is no such primitive or
    /// `f` returns `None`.
    #[inline]
    fn with_emitter<T>(
        &self,
        world: &World,
        primitive: u32,
        time: f32,
        f: impl FnOnce(&Emitter) -> Option<T>,
    ) -> Option<T> {
        let shape = world.geometry(self.geometry).shape(primitive)?;
        Emitter::with(&shape, world, &self.instance, time, f)
    }

    fn scale(&self, part: &LightPart) -> f32 {
        match &self.scales {
            Some(scales) => scales[part.primitive as usize],
            None => part.emission(self.emission).radiance.scale,
        }
    }

    fn is_moving(&self, world: &World) -> bool {
        let moves = |&id| world.render_from_instance(id).is_moving();
        self.instance.ids().iter().any(moves) || world.geometry(self.geometry).is_moving()
    }

    /// The area of a primitive; for a moving one, the mean of the areas at the start and the end of
    /// motion.
    pub(crate) fn area(&self, world: &World, primitive: u32) -> f32 {
        let at =
            |time| self.with_emitter(world, primitive, time, |emitter| Some(emitter.area())).unwrap_or(0.0);
        if self.is_moving(world) { 0.5 * (at(f32::MIN) + at(f32::MAX)) } else { at(0.0) }
    }

    /// The mean radiance over (u, v) before the scale of a primitive: the same for all primitives.
    pub(super) fn mean_radiance(&self, part: &LightPart, lambda: &SampledWavelengths) -> SampledSpectrum {
        let emission = part.emission(self.emission);
        match &emission.image {
            None => emission.radiance.spectrum.sample(lambda),
            Some((image, _)) => {
                let (mut sum, mut count) = (SampledSpectrum::ZERO, 0u32);
                for rgb in image.pixels() {
                    sum += image.sample(rgb, lambda);
                    count += 1;
                }
                sum * (1.0 / count.max(1) as f32)
            }
        }
    }

    /// The power of a primitive, given [`mean_radiance`](Self::mean_radiance).
    pub(super) fn power(&self, part: &LightPart, mean_radiance: SampledSpectrum) -> SampledSpectrum {
        let sides = if part.emission(self.emission).two_sided { 2.0 } else { 1.0 };
        mean_radiance * self.scale(part) * (PI * sides * self.area(part.world(), part.primitive))
    }

    /// Whether rays may meet light of the surface behind its holes.
    fn shines_through_holes(&self, part: &LightPart, emitter: &Emitter) -> bool {
        let is_one_sided = !part.emission(self.emission).two_sided;
        (self.alpha.is_some() || self.invisible) && !emitter.is_hit_once(is_one_sided)
    }

    /// The stochastic alpha test of a point, decided by a hash of it.
    fn passes_alpha_test(&self, part: &LightPart, s: &ShapeSample) -> bool {
        let Some(alpha) = self.alpha.filter(|_| !self.invisible) else { return true };
        let context = TextureContext { p: s.p.p, n: s.n, uv: s.uv, ..Default::default() };
        let alpha = part.textures().float(alpha, &context);
        alpha >= 1.0 || hash_float(&s.p.p.to_array().map(f32::to_bits)) < alpha
    }
}

impl LightModel for AreaLight {
    fn is_delta(&self) -> bool {
        self.invisible
    }

    fn phi(&self, part: &LightPart, lambda: &SampledWavelengths) -> SampledSpectrum {
        self.power(part, self.mean_radiance(part, lambda))
    }

    fn radiance(
        &self,
        part: &LightPart,
        n: Normal3,
        uv: Point2,
        w: Vector3,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        let emission = part.emission(self.emission);
        if !emission.two_sided && n.dot(w) < 0.0 {
            return SampledSpectrum::ZERO;
        }
        let spectrum = match &emission.image {
            None => emission.radiance.spectrum.sample(lambda),
            Some((image, lookup)) => image.sample(Rgb::from(lookup.rgb(&image.image, uv)), lambda),
        };
        spectrum * self.scale(part)
    }

    fn sample_li(
        &self,
        part: &LightPart,
        context: &LightSampleContext,
        u: Point2,
        lambda: &SampledWavelengths,
        _allow_incomplete: bool,
    ) -> Option<LightLiSample> {
        let s = self.with_emitter(part.world(), part.primitive, context.time, |emitter| {
            if self.shines_through_holes(part, emitter) {
                context.by_solid_angle(emitter.sample(u)?)
            } else {
                emitter.sample_from(context, u)
            }
        })?;
        let to_light = s.p.p - context.p.p;
        if s.pdf == 0.0 || to_light == Vector3::ZERO || !self.passes_alpha_test(part, &s) {
            return None;
        }
        let wi = to_light.normalize();
        let l = self.radiance(part, s.n, s.uv, -wi, lambda);
        (!l.is_black()).then_some(LightLiSample { l, wi, pdf: s.pdf, p: Some(s.p), n: s.n })
    }

    fn pdf_li(
        &self,
        part: &LightPart,
        context: &LightSampleContext,
        wi: Vector3,
        point: LightPoint,
        _allow_incomplete: bool,
    ) -> f32 {
        self.with_emitter(part.world(), part.primitive, context.time, |emitter| match point {
            Some((p, n)) if self.shines_through_holes(part, emitter) => {
                Some(context.pdf_per_solid_angle(emitter.pdf_area(p, n), p, n))
            }
            _ => Some(emitter.pdf_from(context, wi)),
        })
        .filter(|pdf| pdf.is_finite())
        .unwrap_or(0.0)
    }

    /// Uniform by area, cosine-distributed on the sides that emit.
    fn sample_le(
        &self,
        part: &LightPart,
        u_position: Point2,
        u_direction: Point2,
        time: f32,
        lambda: &SampledWavelengths,
    ) -> Option<LightLeSample> {
        let s =
            self.with_emitter(part.world(), part.primitive, time, |emitter| emitter.sample(u_position))?;
        if !self.passes_alpha_test(part, &s) {
            return None;
        }
        let emission = part.emission(self.emission);
        let mut u = u_direction;
        let mut side = s.n;
        if emission.two_sided {
            u.x *= 2.0;
            if u.x >= 1.0 {
                u.x -= 1.0;
                side = -s.n;
            }
        }
        let w = Frame::from_z(side).from_local(warp::sample_cosine_hemisphere(u));
        let l = self.radiance(part, s.n, s.uv, w, lambda);
        let pdf_direction = emission.pdf_direction(s.n, w);
        (pdf_direction > 0.0 && !l.is_black()).then(|| LightLeSample {
            l,
            ray: Ray::spawn(s.p, s.n, w, time),
            p: Some(s.p),
            n: s.n,
            pdf_position: s.pdf,
            pdf_direction,
        })
    }

    fn pdf_le(&self, part: &LightPart, p: Point3, n: Normal3, w: Vector3, time: f32) -> (f32, f32) {
        let position = self
            .with_emitter(part.world(), part.primitive, time, |emitter| Some(emitter.pdf_area(p, n)))
            .unwrap_or(0.0);
        (position, part.emission(self.emission).pdf_direction(n, w))
    }

    fn bounds(&self, part: &LightPart) -> Option<LightBounds> {
        let (emission, scale) = (part.emission(self.emission), self.scale(part));
        let peak = match &emission.image {
            None => emission.radiance.spectrum.max_value() * scale,
            Some((image, _)) => image.mean() * scale,
        };
        let normals = if self.is_moving(part.world()) {
            DirectionCone::ENTIRE_SPHERE
        } else {
            self.with_emitter(part.world(), part.primitive, 0.0, |emitter| Some(emitter.normal_bounds()))?
        };
        let shape = part.world().geometry(self.geometry).shape(part.primitive)?;
        let area = self.area(part.world(), part.primitive);
        Some(LightBounds {
            bounds: motion_bounds(&shape, part.world(), &self.instance)?,
            w: normals.w,
            phi: peak * area * PI,
            cos_theta_o: normals.cos_theta,
            cos_theta_e: 0.0,
            two_sided: emission.two_sided,
        })
    }
}
