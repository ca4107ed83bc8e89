//! Samples subpaths, vertex by vertex, from the camera or from a light.
//!
//! A walk traces its ray to a surface ([`Walk::intersect`]), which is a vertex ([`Walk::arrive`])
//! unless the ray passes it, and leaves the vertex along a direction of its BSDF ([`Walk::leave`]).
//! From the second vertex on it ends with probability 1 − q by Russian roulette, where q is the
//! throughput relative to the initial one, at most 1; the MIS weights ignore it, which costs a
//! little efficiency. A walk to a vertex of a given depth has no roulette ([`Walk::follow_to`]).

use math::RayDifferential;
use sampling::Sampler;
use scattering::{Directions, TransportMode};
use scene::camera::CameraRayDifferential;
use scene::light::LightId;
use scene::{Interfaces, SurfaceInteraction};
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::light_end::LightPoint;
use super::{Bidirectional, Partial, Vertex};
use crate::transport::path_state::pass_through;
use crate::transport::{Tracer, roulette};

/// A subpath between two surfaces.
#[derive(Clone)]
pub(crate) struct Walk<'a> {
    paths: &'a Bidirectional<'a>,
    /// The ray to the next surface.
    pub ray: RayDifferential,
    /// Path throughput: importance or power along the ray, over the density of the subpath.
    pub beta: SampledSpectrum,
    /// Partial MIS weights, without the factors of the next surface.
    pub partial: Partial,
    /// The wavelengths, of which dispersion may have terminated all but the first.
    pub lambda: SampledWavelengths,
    /// Scattering events so far.
    pub depth: u32,
    /// Throughput relative to the start of the subpath, without the η² of refractions.
    share: SampledSpectrum,
    /// Distance from the previous vertex.
    distance: f32,
    /// Alpha of the surface that was hit.
    alpha: f32,
    rough_before: bool,
    after_diffuse: bool,
    /// Whether it was ended by an interface.
    is_stopped: bool,
    origin: Origin,
    mode: TransportMode,
}

/// The origin of the ray.
#[derive(Clone, Copy, Debug)]
enum Origin {
    /// From a point.
    Point,
    /// From a direction without a point: a camera of parallel rays.
    Direction,
    /// From a light.
    Light(LightId, LightPoint),
}

impl<'a> Walk<'a> {
    /// Starts at the camera, along one of its rays.
    pub fn from_camera(
        paths: &'a Bidirectional,
        camera_ray: &CameraRayDifferential,
        lambda: SampledWavelengths,
    ) -> Self {
        let camera = &paths.view.camera;
        let (pdf_position, pdf_direction) = camera.pdf_we(&camera_ray.ray.ray);
        let parallel = camera.is_parallel();
        // The strategy t = 1 has no weight where light paths cannot be connected to the camera.
        let pdf = if camera.is_unseen() {
            f32::INFINITY
        } else if parallel {
            pdf_position
        } else {
            pdf_direction
        };
        let beta = SampledSpectrum::splat(camera_ray.weight);
        let origin = if parallel { Origin::Direction } else { Origin::Point };
        let partial = paths.balance.at_camera(pdf);
        Self::new(paths, camera_ray.ray, (beta, partial), lambda, (origin, TransportMode::Radiance))
    }

    /// Starts at a light, chosen by power; `None` if the sampled ray has no radiance.
    pub fn from_light(
        paths: &'a Bidirectional,
        time: f32,
        lambda: SampledWavelengths,
        tracer: &mut Tracer,
    ) -> Option<Self> {
        let sampler = &mut *tracer.sampler;
        let (u, u_position, u_direction) = (sampler.get_1d(), sampler.get_2d(), sampler.get_2d());
        let (light, pmf) = paths.lights.emitting.sample(u)?;
        let sample =
            paths.scene.sample_emission(light, u_position, u_direction, time, &lambda, tracer.stats)?;
        let start = (sample.beta() / pmf, Partial::default());
        let origin = (Origin::Light(light, sample.p.map(|p| (p.p, sample.n))), TransportMode::Importance);
        Some(Self::new(paths, sample.ray.into(), start, lambda, origin))
    }

    fn new(
        paths: &'a Bidirectional,
        ray: RayDifferential,
        (beta, partial): (SampledSpectrum, Partial),
        lambda: SampledWavelengths,
        (origin, mode): (Origin, TransportMode),
    ) -> Self {
        Self {
            paths,
            ray,
            beta,
            partial,
            lambda,
            depth: 0,
            share: SampledSpectrum::ONE,
            distance: 0.0,
            alpha: 1.0,
            rough_before: false,
            after_diffuse: false,
            is_stopped: false,
            origin,
            mode,
        }
    }

    /// The surface that the ray hits; `None` if it leaves the scene, or an interface ended the
    /// subpath.
    pub fn intersect(&mut self, tracer: &mut Tracer) -> Option<SurfaceInteraction> {
        if self.is_stopped {
            return None;
        }
        let scene = self.paths.scene;
        let hit = tracer.hit(&self.ray.ray)?;
        let surface = scene.world().surface(&self.ray.ray, &hit);
        self.distance += hit.t;
        self.alpha = scene.coverage(&hit, &surface);
        Some(scene.interaction(&hit, surface))
    }

    /// The vertex at a surface that was hit; `None` if the ray passes it and has to be traced
    /// further.
    pub fn arrive(&mut self, surface: &mut SurfaceInteraction, tracer: &mut Tracer) -> Option<Vertex<'a>> {
        let (scene, view) = (self.paths.scene, self.paths.view);
        let Some(mut bsdf) = scene.bsdf(view, surface, &self.ray, &mut self.lambda, tracer.sampler) else {
            let t = self.ray.ray.o.distance(surface.p());
            self.ray = pass_through(&self.ray, surface, t);
            if let Origin::Light(light, _) = self.origin
                && Interfaces::before(self.paths.scene.light(light)) == Interfaces::Stop
            {
                self.is_stopped = true;
            }
            return None;
        };
        bsdf.regularize(self.paths.regularize && self.rough_before);
        self.depth += 1;
        let s = &surface.surface;
        let mut vertex = Vertex {
            p: s.p,
            n: s.n,
            wo: s.wo,
            time: s.time,
            bsdf,
            alpha: self.alpha,
            beta: self.beta,
            hero_only: self.lambda.secondary_terminated(),
            partial: Partial::default(),
            depth: self.depth,
            after_diffuse: self.after_diffuse,
            mode: self.mode,
        };
        let cos_theta = vertex.cos_theta(vertex.wo);
        vertex.partial = match &self.origin {
            Origin::Point => self.partial.arrive(self.distance * self.distance, cos_theta),
            Origin::Direction => self.partial.arrive(1.0, cos_theta),
            &Origin::Light(light, point) => {
                let context = vertex.light_context();
                let direct = self.paths.direct_pdf(light, &context, vertex.wo, point);
                let end = self.paths.light_end(light, &context, vertex.wo, point, direct);
                self.paths.balance.at_light(&end, cos_theta)
            }
        };
        Some(vertex)
    }

    /// Leaves a vertex along a direction of its BSDF; `false` if the subpath ends there, perhaps by
    /// Russian roulette.
    pub fn leave(&mut self, vertex: &Vertex, surface: &SurfaceInteraction, sampler: &mut Sampler) -> bool {
        self.scatter(vertex, surface, sampler) && self.survive(sampler)
    }

    /// Samples up to the vertex of a depth, without Russian roulette; `None` if the subpath ends
    /// before.
    pub fn follow_to(&mut self, depth: u32, tracer: &mut Tracer) -> Option<(Vertex<'a>, SurfaceInteraction)> {
        loop {
            let mut surface = self.intersect(tracer)?;
            let Some(vertex) = self.arrive(&mut surface, tracer) else { continue };
            if vertex.depth == depth {
                return Some((vertex, surface));
            }
            if !self.scatter(&vertex, &surface, tracer.sampler) {
                return None;
            }
        }
    }

    /// Leaves a vertex along a direction of its BSDF; `false` if it has none.
    pub fn scatter(&mut self, vertex: &Vertex, surface: &SurfaceInteraction, sampler: &mut Sampler) -> bool {
        let (uc, u) = (sampler.get_1d(), sampler.get_2d());
        let Some(sample) = vertex.bsdf.sample_f(vertex.wo, uc, u, vertex.mode, Directions::All) else {
            return false;
        };
        let scale = sample.f * (vertex.cosine(sample.wi) / sample.pdf);
        let cos_theta = vertex.cos_theta(sample.wi);
        let balance = self.paths.balance;
        self.partial = if sample.flags.is_specular() {
            vertex.partial.leave_specular(cos_theta)
        } else {
            let pdf = if sample.pdf_is_proportional { vertex.pdf(sample.wi) } else { sample.pdf };
            balance.leave(&vertex.partial, pdf, vertex.pdf_back(sample.wi), cos_theta, vertex.merges())
        };
        self.rough_before |= !sample.flags.is_specular();
        self.after_diffuse |= vertex.is_diffuse();
        self.beta *= scale;
        self.share *= scale;
        if vertex.mode == TransportMode::Radiance && sample.flags.is_transmissive() {
            self.share *= sample.eta * sample.eta;
        }
        self.origin = Origin::Point;
        self.distance = 0.0;
        self.ray = surface.spawn_scattered(&self.ray, &sample);
        !self.beta.is_black()
    }

    /// Russian roulette.
    fn survive(&mut self, sampler: &mut Sampler) -> bool {
        let Some(survival) = roulette::survival(self.depth, self.share, sampler) else { return false };
        self.beta /= survival;
        self.share /= survival;
        true
    }
}
