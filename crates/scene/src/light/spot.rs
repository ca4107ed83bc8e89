//! A light at a point that shines into a cone, with a soft edge: L = I · s(cos θ) / r², where the
//! smooth step s falls from 1 at the start of the falloff to 0 at the cone's end.
//!
//! Power 2π·I·((1 − cos θ_start) + (cos θ_start − cos θ_end)/2). Rays leave with the density of the
//! intensity itself, p_direction = s(cos θ)·I/Φ: evenly within the start of the falloff, around it
//! with cos θ by the smooth step; each carries all of Φ. Sources: [Pharr 2023 §12.2.1].

use super::{Emission, LightBounds, LightLeSample, LightLiSample, LightSampleContext};
use math::{
    Bounds3, Frame, Point2, Point3, Point3Error, Ray, Vec2, Vec3, Vector3, safe_acos, safe_sqrt, smooth_step,
    spherical_direction,
};
use sampling::{sample_discrete, warp};
use spectrum::{SampledSpectrum, SampledWavelengths};
use std::f32::consts::{PI, TAU};

/// A spot light.
#[derive(Clone, Debug)]
pub struct SpotLight {
    /// Position in render space.
    pub p: Point3,
    /// Unit axis of the cone in render space.
    pub axis: Vector3,
    /// Radiant intensity on the axis.
    pub intensity: Emission,
    /// Cosine of the angle where the falloff starts.
    pub cos_falloff_start: f32,
    /// Cosine of the angle where no light is left; at most `cos_falloff_start`.
    pub cos_falloff_end: f32,
}

impl SpotLight {
    /// The solid angle that shines at full intensity with the same power.
    pub fn effective_solid_angle(cos_falloff_start: f32, cos_falloff_end: f32) -> f32 {
        2.0 * PI * ((1.0 - cos_falloff_start) + (cos_falloff_start - cos_falloff_end) / 2.0)
    }

    /// The part of the intensity on the axis that leaves along `w`.
    fn falloff(&self, w: Vector3) -> f32 {
        smooth_step(w.dot(self.axis), self.cos_falloff_end, self.cos_falloff_start)
    }

    pub(super) fn phi(&self, lambda: &SampledWavelengths) -> SampledSpectrum {
        self.intensity.sample(lambda)
            * Self::effective_solid_angle(self.cos_falloff_start, self.cos_falloff_end)
    }

    pub(super) fn sample_li(
        &self,
        context: &LightSampleContext,
        lambda: &SampledWavelengths,
    ) -> Option<LightLiSample> {
        let to_light = self.p - context.p.p;
        let distance2 = to_light.length_squared();
        if distance2 == 0.0 {
            return None;
        }
        let wi = to_light / distance2.sqrt();
        let falloff = self.falloff(-wi);
        (falloff > 0.0).then(|| LightLiSample {
            l: self.intensity.sample(lambda) * (falloff / distance2),
            wi,
            pdf: 1.0,
            p: Some(Point3Error::exact(self.p)),
            n: Vec3::ZERO,
        })
    }

    pub(super) fn sample_le(
        &self,
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
        let w = Frame::from_z(self.axis).from_local(local);
        let pdf_direction = self.pdf_le(w);
        (pdf_direction > 0.0).then(|| LightLeSample {
            l: self.intensity.sample(lambda) * self.falloff(w),
            ray: Ray::new(self.p, w, time),
            p: Some(Point3Error::exact(self.p)),
            n: Vec3::ZERO,
            pdf_position: 1.0,
            pdf_direction,
        })
    }

    /// Density of the direction: in proportion to the light that leaves along it.
    pub(super) fn pdf_le(&self, w: Vector3) -> f32 {
        let solid_angle = Self::effective_solid_angle(self.cos_falloff_start, self.cos_falloff_end);
        if solid_angle > 0.0 { self.falloff(w) / solid_angle } else { 0.0 }
    }

    pub(super) fn bounds(&self) -> Option<LightBounds> {
        let edge = safe_acos(self.cos_falloff_end) - safe_acos(self.cos_falloff_start);
        Some(LightBounds {
            bounds: Bounds3::new(self.p, self.p),
            w: self.axis,
            phi: 4.0 * PI * self.intensity.max_value(),
            cos_theta_o: self.cos_falloff_start,
            // Room for rounding, so that points just inside of the edge keep some importance, be it
            // soft or hard.
            cos_theta_e: edge.cos().min(0.999),
            two_sided: false,
        })
    }
}
