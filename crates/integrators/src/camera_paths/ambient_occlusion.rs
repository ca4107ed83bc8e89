//! Ambient occlusion: the cosine-weighted share of the hemisphere that is not occluded.
//!
//! A = 1/π ∫ V(p, ω) (n·ω) dω over the hemisphere around the geometric normal n on the camera's
//! side, where the visibility V is 0 for directions that hit a surface nearer than `max_distance`.
//! The result is A times the illuminant of the film's colour space at unit luminance, so that an
//! unoccluded point is white (A = 1). Lights and materials are ignored; a camera ray that hits
//! nothing is black. Sources: [Zhukov 1998], [Pharr 2023 §13].

use description::AmbientOcclusionDesc;
use math::{Frame, RayDifferential};
use sampling::warp;
use scene::Interfaces;
use spectrum::{RgbColorSpace, SampledSpectrum, SampledWavelengths, Spectrum};
use std::f32::consts::PI;

use crate::transport::path_state::pass_through;
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
}

impl RayIntegrator for AmbientOcclusion {
    fn li(
        &self,
        tracer: &mut Tracer,
        mut ray: RayDifferential,
        lambda: &mut SampledWavelengths,
    ) -> SampledSpectrum {
        let surface = loop {
            let Some((mut surface, t)) = tracer.intersect(&ray.ray) else {
                return SampledSpectrum::ZERO;
            };
            if tracer.bsdf(&mut surface, &ray, lambda).is_some() {
                break surface.surface;
            }
            ray = pass_through(&ray, &surface, t);
        };
        let u = tracer.sampler.get_2d();
        let (wi, pdf) = if self.settings.cos_sample {
            let wi = warp::sample_cosine_hemisphere(u);
            (wi, warp::cosine_hemisphere_pdf(wi.z))
        } else {
            (warp::sample_uniform_hemisphere(u), warp::uniform_hemisphere_pdf())
        };
        let n = if surface.n.dot(surface.wo) < 0.0 { -surface.n } else { surface.n };
        let outward = surface.spawn_ray(Frame::from_z(n).from_local(wi));
        if pdf == 0.0 || tracer.occluded(&outward, self.settings.max_distance, Interfaces::Stop) {
            return SampledSpectrum::ZERO;
        }
        self.white.sample(lambda) * (self.white_scale * wi.z / (PI * pdf))
    }
}
