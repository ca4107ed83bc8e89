//! Direct lighting: next-event estimation, and emission that scattered rays hit.
//!
//! At a vertex one ray goes to a sampled point on a light and one along a direction of the BSDF.
//! Light that both can find, with densities p_l (of the choice of the light times that of its
//! point) and p_b (of the BSDF) per solid angle, is counted by both with the weights of the power
//! heuristic, w_l = p_l²/(p_l² + p_b²) and w_b = 1 − w_l [Veach 1997 §9.2]. Light that only one can
//! find (delta lights, specular scattering) counts fully. Lights may leave directions to the BSDF
//! (`allow_incomplete`): their density is then zero there.

use std::sync::Arc;

use description::LightSamplerDesc;
use geometry::SurfacePoint;
use lanes::Real;
use math::{Frame, Normal3, RayDifferential, Vec2, Vec3, Vector3};
use sampling::{Sampler, warp};
use scattering::BxdfFlags;
use scene::light::{Light, LightId, LightLiSample, LightPoint, LightRef};
use scene::light_sampler::LightSampler;
use scene::medium::MediumId;
use scene::{Interfaces, Scene, SurfaceInteraction};
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::path_state::Origin;
use super::vertex::{MediumVertex, SurfaceVertex, Vertex};
use super::{ShadowRay, Tracer};
use crate::{Cancelled, Control};

/// Direct lighting by one sample of one light, weighted against BSDF sampling.
#[derive(Clone, Debug)]
pub(crate) struct DirectLighting {
    lights: Arc<LightSampler>,
    interfaces: Interfaces,
}

impl DirectLighting {
    /// For the lights of a scene. `interfaces` says whether surfaces of material `interface`
    /// occlude delta lights; they do not occlude other lights. pbrt-v4's path tracer, which does
    /// not know media, treats interfaces as surfaces that shadow rays hit, and finds lights behind
    /// them by BSDF sampling alone: delta lights therefore cast the shadows of interfaces.
    pub fn new(
        scene: &Scene,
        desc: LightSamplerDesc,
        interfaces: Interfaces,
        control: &Control,
    ) -> Result<Self, Cancelled> {
        let lights = scene.light_sampler(desc, &control.cancel).ok_or(Cancelled)?;
        Ok(Self { lights, interfaces })
    }

    /// For no lights.
    pub fn none(interfaces: Interfaces) -> Self {
        Self { lights: Arc::default(), interfaces }
    }

    /// The choice of lights.
    pub fn lights(&self) -> &LightSampler {
        &self.lights
    }

    /// Whether interfaces occlude a light.
    pub fn interfaces(&self, light: LightRef) -> Interfaces {
        match self.interfaces {
            Interfaces::Stop if light.is_delta() => Interfaces::Stop,
            Interfaces::Stop | Interfaces::Pass => Interfaces::Pass,
        }
    }

    /// The MIS weight of light from `light` that a ray along `wi` hits at `point`; 1 without an
    /// `origin`, where no light sample could have found it.
    fn weight(&self, light: LightRef, origin: Option<&Origin>, wi: Vector3, point: LightPoint) -> f32 {
        let Some(Origin { context, pdf }) = origin else { return 1.0 };
        let pmf = self.lights.pmf(context, light.id());
        power_heuristic(*pdf, pmf * light.pdf_li(context, wi, point, true))
    }

    /// The weighted radiance along a ray that leaves the scene.
    pub fn escaped(
        &self,
        scene: &Scene,
        ray: &RayDifferential,
        origin: Option<&Origin>,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        self.escaped_from_each(scene, ray, origin, lambda).map(|(_, l)| l).sum()
    }

    /// [`escaped`](Self::escaped) light by light.
    pub fn escaped_from_each(
        &self,
        scene: &Scene,
        ray: &RayDifferential,
        origin: Option<&Origin>,
        lambda: &SampledWavelengths,
    ) -> impl Iterator<Item = (LightId, SampledSpectrum)> {
        let lights = scene.infinite_lights().iter();
        lights.map(move |&id| {
            let light = scene.light(id);
            (id, light.le(&ray.ray, lambda) * self.weight(light, origin, ray.ray.d, None))
        })
    }

    /// The weighted emission of a surface back along a ray.
    pub fn emitted(
        &self,
        scene: &Scene,
        surface: &SurfaceInteraction,
        origin: Option<&Origin>,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        let Some(light) = surface.area_light else { return SampledSpectrum::ZERO };
        let SurfacePoint { p, n, wo, .. } = surface.surface;
        let l = scene.emitted(surface, wo, lambda);
        if l.is_black() {
            return l;
        }
        l * self.weight(scene.light(light), origin, -wo, Some((p.p, n)))
    }

    /// Next-event estimation, before its shadow ray is traced; `None` if no light arrives.
    #[doc(alias = "SampleLd")]
    pub fn connect(
        &self,
        tracer: &mut Tracer,
        vertex: &Vertex,
        lambda: &SampledWavelengths,
    ) -> Option<Connection> {
        let Tracer { scene, sampler, .. } = tracer;
        let (u, u_light) = (sampler.get_1d(), sampler.get_2d());
        let (light, pmf) = self.lights.sample(vertex.context(), u)?;
        let sample = scene.sample_light(light, vertex.context(), u_light, lambda, true)?;
        let l = vertex.scattered(&sample);
        if l.is_black() {
            return None;
        }
        let (wi, p_l, light) = (sample.wi, pmf * sample.pdf, scene.light(light));
        let ratio = if light.is_delta() { 0.0 } else { vertex.pdf(wi) / p_l };
        let (shadow, interfaces) = (vertex.shadow_ray(&sample), self.interfaces(light));
        Some(Connection { light: light.id(), wi, shadow, interfaces, l: l / p_l, ratio })
    }
}

/// A vertex connected to a point on a light.
pub(crate) struct Connection {
    /// The light.
    pub light: LightId,
    /// Unit direction to it.
    pub wi: Vector3,
    /// The shadow ray.
    pub shadow: ShadowRay,
    /// Whether interfaces occlude it.
    pub interfaces: Interfaces,
    /// The light that the vertex scatters if nothing occludes the ray, over its density.
    pub l: SampledSpectrum,
    /// The density with which scattering finds the light, over the same; 0 where it cannot.
    pub ratio: f32,
}

impl Connection {
    /// To a light that scattering does not look for; interfaces let its shadow ray pass.
    fn unweighted(light: LightId, wi: Vector3, shadow: ShadowRay, l: SampledSpectrum) -> Self {
        Self { light, wi, shadow, interfaces: Interfaces::Pass, l, ratio: 0.0 }
    }

    /// The light that the vertex scatters, weighted against what scattering finds.
    pub fn weighted(&self) -> SampledSpectrum {
        self.l * power_heuristic(1.0, self.ratio)
    }

    /// The weighted light that arrives through media, if the shadow ray starts in `medium`.
    pub fn arriving(
        self,
        medium: Option<MediumId>,
        lambda: &SampledWavelengths,
        tracer: &mut Tracer,
    ) -> SampledSpectrum {
        let l = self.weighted();
        let passed = tracer.transmittance(&self.shadow, medium, &l, lambda);
        passed.map_or(SampledSpectrum::ZERO, |passed| l * passed)
    }
}

/// Connects a point in a medium to one point of every light, and calls `connect` where light
/// arrives there. It is not weighted against sampling of the phase function.
pub(crate) fn connect_all_in_medium(
    scene: &Scene,
    sampler: &mut Sampler,
    vertex: &MediumVertex,
    lambda: &SampledWavelengths,
    mut connect: impl FnMut(Connection),
) {
    for light in (0..scene.lights().len() as u32).map(LightId) {
        let u = sampler.get_2d();
        let Some(sample) = scene.sample_light(light, &vertex.context, u, lambda, false) else { continue };
        let l = sample.l * (vertex.phase.p(vertex.wo, sample.wi) / sample.pdf);
        if !l.is_black() {
            let shadow = ShadowRay::to_light(&vertex.context, &sample);
            connect(Connection::unweighted(light, sample.wi, shadow, l));
        }
    }
}

/// Connects a surface to one point of every light, and calls `connect` where light arrives there.
/// It is not weighted against BSDF sampling. Skies of one colour are left out where they are
/// `ambient`; what the surface scatters of them is returned.
pub(crate) fn connect_all(
    scene: &Scene,
    sampler: &mut Sampler,
    vertex: &SurfaceVertex,
    ambient: bool,
    lambda: &SampledWavelengths,
    mut connect: impl FnMut(Connection),
) -> SampledSpectrum {
    let mut around = SampledSpectrum::ZERO;
    let flags = vertex.bsdf.flags();
    if !flags.is_non_specular() {
        return around;
    }
    for light in (0..scene.lights().len() as u32).map(LightId) {
        let u = sampler.get_2d();
        if let (true, Light::UniformInfinite(sky)) = (ambient, scene.light(light).row()) {
            let surface = &vertex.surface.surface;
            let (wi, pdf) = sample_ambient(surface.wo, surface.shading.n, flags, u);
            let l = sky.radiance.sample(lambda);
            let l = vertex.scattered(&LightLiSample { l, wi, pdf, p: None, n: Vec3::ZERO });
            around += l.safe_div(SampledSpectrum::splat(pdf));
            continue;
        }
        let Some(sample) = scene.sample_light(light, &vertex.context, u, lambda, false) else { continue };
        let l = vertex.scattered(&sample);
        if !l.is_black() {
            let shadow = vertex.shadow_ray(&sample);
            connect(Connection::unweighted(light, sample.wi, shadow, l / sample.pdf));
        }
    }
    around
}

/// A direction from which the sky lights a surface, distributed by the cosine over the sides that
/// scatter to `wo`, and its density.
#[inline(always)]
pub(crate) fn sample_ambient<R: Real>(
    wo: Vector3<R>,
    ns: Normal3<R>,
    flags: BxdfFlags<R>,
    u: Vec2<R>,
) -> (Vector3<R>, R) {
    let (reflects, transmits) = (flags.is_reflective(), flags.is_transmissive());
    let (has_both, is_second) = (reflects & transmits, u.x.ge(R::splat(0.5)));
    // The first half of the numbers is for the side of `wo`, if both sides scatter.
    let of_half = R::select(is_second, u.x + u.x - R::one(), u.x + u.x);
    let u = Vec2::new(R::select(has_both, of_half, u.x), u.y);
    let is_across = transmits & (!reflects | is_second);
    let is_below = wo.dot(ns).lt(R::zero());
    let axis = Vec3::select(is_across ^ is_below, -ns, ns);
    let w = warp::sample_cosine_hemisphere(u);
    let pdf = warp::cosine_hemisphere_pdf(w.z);
    (Frame::from_z(axis).from_local(w), R::select(has_both, pdf * R::splat(0.5), pdf))
}

/// The power heuristic for a sample of density `p` that another technique finds with density
/// `other`.
#[inline(always)]
pub(crate) fn power_heuristic<R: Real>(p: R, other: R) -> R {
    // Computed from the ratio, because squares of large densities overflow.
    let ratio = other / p;
    R::select(p.eq(R::zero()), R::zero(), R::one() / (R::one() + ratio * ratio))
}
