//! Ambient occlusion: the cosine-weighted share of the hemisphere that is not occluded.
//!
//! A = 1/π ∫ V(p, ω) (n·ω) dω over the hemisphere around the geometric normal n on the camera's
//! side, where the visibility V is 0 for directions that hit a surface nearer than `max_distance`.
//! The result is A times the illuminant of the film's colour space at unit luminance, so that an
//! unoccluded point is white (A = 1). Lights and materials are ignored; a camera ray that hits
//! nothing is black. Sources: [Zhukov 1998], [Pharr 2023 §13].

use std::f32::consts::PI;

use description::AmbientOcclusionDesc;
use lanes::Real;
use math::{Frame, RayDifferential, Vec2, Vec3, Vector3};
use sampling::warp;
use scene::Interfaces;
use scene::light::LightSampleContext;
use spectrum::{RgbColorSpace, SampledSpectrum, SampledWavelengths, Spectrum};

use crate::transport::ShadowRay;
use crate::{RayIntegrator, Tracer};

/// Ambient occlusion.
#[derive(Clone, Debug)]
pub struct AmbientOcclusion {
    settings: AmbientOcclusionDesc,
    white: Spectrum,
    white_scale: f32,
}

impl AmbientOcclusion {
    /// With unoccluded points as the white of `color_space`.
    pub fn new(settings: AmbientOcclusionDesc, color_space: &RgbColorSpace) -> Self {
        let white = color_space.illuminant();
        let white_scale = 1.0 / white.to_photometric();
        Self { settings, white, white_scale }
    }

    /// A ray over the hemisphere of a point on the side of `wo`, and the light along it if nothing
    /// occludes it.
    #[inline(always)]
    pub(crate) fn sample<R: Real>(
        &self,
        point: &LightSampleContext<R>,
        wo: Vector3<R>,
        u: Vec2<R>,
        lambda: &SampledWavelengths<R>,
    ) -> (ShadowRay<R>, SampledSpectrum<R>) {
        let (wi, pdf) = if self.settings.cos_sample {
            let wi = warp::sample_cosine_hemisphere(u);
            (wi, warp::cosine_hemisphere_pdf(wi.z))
        } else {
            (warp::sample_uniform_hemisphere(u), R::splat(warp::uniform_hemisphere_pdf()))
        };
        let n = Vec3::select(point.n.dot(wo).lt(R::zero()), -point.n, point.n);
        let scale = R::splat(self.white_scale) * wi.z / (R::splat(PI) * pdf);
        let scale = R::select(pdf.eq(R::zero()), R::zero(), scale);
        let ray = point.spawn_ray(Frame::from_z(n).from_local(wi));
        let shadow = ShadowRay { ray, t_max: R::splat(self.settings.max_distance) };
        (shadow, self.white.sample(lambda) * scale)
    }
}

impl RayIntegrator for AmbientOcclusion {
    fn li(
        &self,
        tracer: &mut Tracer,
        RayDifferential { mut ray, .. }: RayDifferential,
        lambda: &mut SampledWavelengths,
    ) -> SampledSpectrum {
        loop {
            let Some(hit) = tracer.hit(&ray) else { return SampledSpectrum::ZERO };
            let surface = tracer.scene.interaction(&hit, tracer.scene.world().surface(&ray, &hit));
            if tracer.scene.is_interface(&hit, &ray) {
                ray = surface.spawn_ray(ray.d);
                continue;
            }
            let (u, point) = (tracer.sampler.get_2d(), surface.light_context());
            let (outward, l) = self.sample(&point, surface.surface.wo, u, lambda);
            if l.is_black() || tracer.occluded(&outward, Interfaces::Stop) {
                return SampledSpectrum::ZERO;
            }
            return l;
        }
    }
}
