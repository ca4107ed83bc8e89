//! A light at a point that emits into a cone, with a soft edge: L = I · s(cos θ) / r², where the
//! smooth step s falls from 1 at the start of the falloff to 0 at the cone's end.
//!
//! Power 2π·I·((1 − cos θ_start) + (cos θ_start − cos θ_end)/2). Rays leave with the density of the
//! intensity itself, p_direction = s(cos θ)·I/Φ: uniform in the inner cone, and by the smooth step
//! of cos θ around it; each ray carries all of Φ. Sources: [Pharr 2023 §12.2.1].

use super::point::{reach, sample_point};
use super::{Emission, LightBounds, LightLeSample, LightLiSample, LightModel, LightPart, LightSampleContext};
use math::{
    AnimatedTransform, Frame, Normal3, Point2, Point3, Point3Error, Ray, Vec2, Vec3, Vector3, safe_acos,
    safe_sqrt, smooth_step, spherical_direction,
};
use sampling::{sample_discrete, warp};
use spectrum::{SampledSpectrum, SampledWavelengths};
use std::f32::consts::{PI, TAU};

/// A spot light.
#[derive(Clone, Debug)]
pub struct SpotLight {
    /// Position in render space; in the light's own space if it moves.
    pub p: Point3,
    /// Unit axis of the cone, in the same space.
    pub axis: Vector3,
    /// From the light's own space to render space; `None` for a light at rest.
    pub motion: Option<Box<AnimatedTransform>>,
    /// Radiant intensity on the axis.
    pub intensity: Emission,
    /// Cosine of the angle where the falloff starts.
    pub cos_falloff_start: f32,
    /// Cosine of the angle where the intensity becomes zero; at most `cos_falloff_start`.
    pub cos_falloff_end: f32,
}

impl SpotLight {
    /// The solid angle that has the same power at full intensity.
    pub fn effective_solid_angle(cos_falloff_start: f32, cos_falloff_end: f32) -> f32 {
        2.0 * PI * ((1.0 - cos_falloff_start) + (cos_falloff_start - cos_falloff_end) / 2.0)
    }

    /// Position and unit axis in render space at a shutter time.
    pub fn placement(&self, time: f32) -> (Point3, Vector3) {
        match &self.motion {
            None => (self.p, self.axis),
            Some(motion) => {
                let transform = motion.at(time);
                (transform.point(self.p), transform.vector(self.axis).normalize_or(self.axis))
            }
        }
    }

    /// The intensity at the cosine `cos_theta` with the axis, as a fraction of that on the axis.
    fn falloff(&self, cos_theta: f32) -> f32 {
        smooth_step(cos_theta, self.cos_falloff_end, self.cos_falloff_start)
    }

    /// Density of a direction at the cosine `cos_theta` with the axis: in proportion to the
    /// intensity.
    fn pdf_direction(&self, cos_theta: f32) -> f32 {
        let solid_angle = Self::effective_solid_angle(self.cos_falloff_start, self.cos_falloff_end);
        if solid_angle > 0.0 { self.falloff(cos_theta) / solid_angle } else { 0.0 }
    }
}

impl LightModel for SpotLight {
    fn is_delta(&self) -> bool {
        true
    }

    fn phi(&self, _part: &LightPart, lambda: &SampledWavelengths) -> SampledSpectrum {
        self.intensity.sample(lambda)
            * Self::effective_solid_angle(self.cos_falloff_start, self.cos_falloff_end)
    }

    fn sample_li(
        &self,
        _part: &LightPart,
        context: &LightSampleContext,
        _u: Point2,
        lambda: &SampledWavelengths,
        _allow_incomplete: bool,
    ) -> Option<LightLiSample> {
        let (p, axis) = self.placement(context.time);
        sample_point(p, context, |w, distance2| {
            self.intensity.sample(lambda) * (self.falloff(w.dot(axis)) / distance2)
        })
    }

    fn sample_le(
        &self,
        _part: &LightPart,
        _u_position: Point2,
        u: Point2,
        time: f32,
        lambda: &SampledWavelengths,
    ) -> Option<LightLeSample> {
        let (start, end) = (self.cos_falloff_start, self.cos_falloff_end);
        // The cone of full intensity, and the ring around it of half as much on average.
        let ring = sample_discrete(&[1.0 - start, 0.5 * (start - end)], u.x)?;
        let local = if ring.index == 0 {
            warp::sample_uniform_cone(Vec2::new(ring.u_remapped, u.y), start)
        } else {
            let cos_theta = warp::sample_smooth_step(ring.u_remapped, end, start);
            spherical_direction(safe_sqrt(1.0 - cos_theta * cos_theta), cos_theta, TAU * u.y)
        };
        let (p, axis) = self.placement(time);
        let w = Frame::from_z(axis).from_local(local);
        let cos_theta = w.dot(axis);
        let pdf_direction = self.pdf_direction(cos_theta);
        (pdf_direction > 0.0).then(|| LightLeSample {
            l: self.intensity.sample(lambda) * self.falloff(cos_theta),
            ray: Ray::new(p, w, time),
            p: Some(Point3Error::exact(p)),
            n: Vec3::ZERO,
            pdf_position: 1.0,
            pdf_direction,
        })
    }

    fn pdf_le(&self, _part: &LightPart, _p: Point3, _n: Normal3, w: Vector3, time: f32) -> (f32, f32) {
        (0.0, self.pdf_direction(w.dot(self.placement(time).1)))
    }

    fn bounds(&self, _part: &LightPart) -> Option<LightBounds> {
        let edge = safe_acos(self.cos_falloff_end) - safe_acos(self.cos_falloff_start);
        Some(LightBounds {
            bounds: reach(self.p, self.motion.as_deref()),
            w: self.axis,
            phi: 4.0 * PI * self.intensity.max_value(),
            cos_theta_o: if self.motion.is_some() { -1.0 } else { self.cos_falloff_start },
            // A margin for rounding, so that points just inside of the edge keep some importance.
            cos_theta_e: lanes::cos(edge).min(0.999),
            two_sided: false,
        })
    }
}
