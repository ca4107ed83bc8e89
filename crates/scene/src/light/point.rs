//! A light at a point that emits uniformly into all directions: L = I / r².
//!
//! Parameters: radiant intensity I; power 4π·I. Emitted rays are uniform in direction. Sources:
//! [Pharr 2023 §12.2].

use super::{Emission, LightBounds, LightLeSample, LightLiSample, LightModel, LightPart, LightSampleContext};
use lanes::{Each, Real};
use math::{AnimatedTransform, Bounds3, Normal3, Point2, Point3, Point3Error, Ray, Vec3, Vector3, balance};
use sampling::warp;
use spectrum::{SampledSpectrum, SampledWavelengths};
use std::f32::consts::PI;

/// A point light.
#[derive(Clone, Debug)]
pub struct PointLight {
    /// Position in render space; in the light's own space if it moves.
    pub p: Point3,
    /// From the light's own space to render space; `None` for a light at rest.
    pub motion: Option<Box<AnimatedTransform>>,
    /// Radiant intensity.
    pub intensity: Emission,
}

impl PointLight {
    /// The position in render space at a shutter time.
    pub fn position(&self, time: f32) -> Point3 {
        self.motion.as_ref().map_or(self.p, |motion| motion.at(time).point(self.p))
    }

    /// Light at rest that arrives at points: irradiance on a perpendicular surface, direction to
    /// the light, and where there is one.
    #[inline(always)]
    pub fn sample_at_rest<R: Real>(
        &self,
        from: Point3<R>,
        lambda: &SampledWavelengths<R>,
    ) -> (SampledSpectrum<R>, Vector3<R>, R::Mask) {
        let p = Vec3::from_array(self.p.to_array().each(R::splat));
        let (wi, [distance2, scale], is_apart) = towards(p, from);
        (self.intensity.sample(lambda) / distance2 * scale * scale, wi, is_apart)
    }
}

/// The direction to a point, the square of its distance times a power of two, whose square keeps
/// that from overflow, and whether the distance is above zero.
#[inline(always)]
fn towards<R: Real>(p: Point3<R>, from: Point3<R>) -> (Vector3<R>, [R; 2], R::Mask) {
    let way = p - from;
    let scale = balance(way.abs().max_element());
    let way = way * scale;
    let distance2 = way.length_squared();
    (way / distance2.sqrt(), [distance2, scale], distance2.gt(R::zero()))
}

/// Bounds of the point over all times.
pub(super) fn reach(p: Point3, motion: Option<&AnimatedTransform>) -> Bounds3 {
    let here = Bounds3::new(p, p);
    motion.map_or(here, |motion| motion.motion_bounds(&here))
}

/// Light from the point `p`: what arrives along a direction away from it at the square of a
/// distance is `l`; `None` if it is zero.
pub(super) fn sample_point(
    p: Point3,
    context: &LightSampleContext,
    l: impl FnOnce(Vector3, f32) -> SampledSpectrum,
) -> Option<LightLiSample> {
    let (wi, [distance2, scale], is_apart) = towards(p, context.p.p);
    if !is_apart {
        return None;
    }
    let l = l(-wi, distance2) * scale * scale;
    (!l.is_black()).then(|| LightLiSample { l, wi, pdf: 1.0, p: Some(Point3Error::exact(p)), n: Vec3::ZERO })
}

impl LightModel for PointLight {
    fn is_delta(&self) -> bool {
        true
    }

    fn phi(&self, _part: &LightPart, lambda: &SampledWavelengths) -> SampledSpectrum {
        self.intensity.sample(lambda) * (4.0 * PI)
    }

    fn sample_li(
        &self,
        _part: &LightPart,
        context: &LightSampleContext,
        _u: Point2,
        lambda: &SampledWavelengths,
        _allow_incomplete: bool,
    ) -> Option<LightLiSample> {
        let l = |_, distance2| self.intensity.sample(lambda) / distance2;
        sample_point(self.position(context.time), context, l)
    }

    fn sample_le(
        &self,
        _part: &LightPart,
        _u_position: Point2,
        u_direction: Point2,
        time: f32,
        lambda: &SampledWavelengths,
    ) -> Option<LightLeSample> {
        let p = self.position(time);
        Some(LightLeSample {
            l: self.intensity.sample(lambda),
            ray: Ray::new(p, warp::sample_uniform_sphere(u_direction), time),
            p: Some(Point3Error::exact(p)),
            n: Vec3::ZERO,
            pdf_position: 1.0,
            pdf_direction: warp::uniform_sphere_pdf(),
        })
    }

    fn pdf_le(&self, _part: &LightPart, _p: Point3, _n: Normal3, _w: Vector3, _time: f32) -> (f32, f32) {
        (0.0, warp::uniform_sphere_pdf())
    }

    fn bounds(&self, _part: &LightPart) -> Option<LightBounds> {
        Some(LightBounds {
            bounds: reach(self.p, self.motion.as_deref()),
            w: Vec3::Z,
            phi: 4.0 * PI * self.intensity.max_value(),
            cos_theta_o: -1.0,
            cos_theta_e: 0.0,
            two_sided: false,
        })
    }
}
