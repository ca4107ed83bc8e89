//! Samples subpaths, vertex by vertex, from the camera or from a light.
//!
//! A walk traces its ray to a surface or to a collision in a medium ([`Walk::intersect`]), which is
//! a vertex ([`Walk::arrive`]) unless the ray passes it, and leaves the vertex along a direction of
//! its BSDF or phase function ([`Walk::leave`]). From the second vertex on it ends with probability
//! 1 − q by Russian roulette, where q is the throughput relative to the initial one, at most 1; the
//! MIS weights ignore it, which costs a little efficiency. A walk to a vertex of a given depth has
//! no roulette ([`Walk::follow_to`]).
//!
//! A camera subpath that is transmitted into a body goes on under its
//! surface (`under_surface.rs`): the next vertex is where it leaves, and has the same
//! depth.

use film::FirstEvent;
use math::{Normal3, ONE_MINUS_EPSILON, Point3Error, Ray, RayDifferential, Vector3};
use sampling::Sampler;
use scattering::{Body, Bsdf, BsdfSample, Bxdf, Directions, TransportMode};
use scene::SurfaceInteraction;
use scene::camera::CameraRayDifferential;
use scene::light::{LightId, LightPoint};
use scene::medium::MediumId;
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::under_surface::LightWay;
use super::{Bidirectional, Interaction, Law, MediumInteraction, Partial, Vertex};
use crate::transport::media::{FlightEnd, Heroes};
use crate::transport::path_state::pass_through;
use crate::transport::subsurface::Exit;
use crate::transport::{ShadowRay, Tracer, roulette};

/// A subpath between two vertices.
pub(crate) struct Walk<'a> {
    paths: &'a Bidirectional<'a>,
    /// The ray to the next vertex.
    pub ray: RayDifferential,
    /// Path throughput: importance or power along the ray, over the density of the subpath.
    pub beta: SampledSpectrum,
    /// Partial MIS weights, without the factors of the next vertex.
    pub partial: Partial,
    /// The wavelengths, of which dispersion may have terminated all but the first.
    pub lambda: SampledWavelengths,
    /// Scattering events so far.
    pub depth: u32,
    /// Throughput relative to the start of the subpath, without the η² of refractions.
    share: SampledSpectrum,
    /// The medium of the ray.
    medium: Option<MediumId>,
    /// Light that media emitted along the rays so far, not yet taken.
    pub emitted: SampledSpectrum,
    /// The light where it began, if it did at one.
    light: Option<LightId>,
    /// The event by which a camera subpath left its first vertex, where somebody takes parts of the
    /// light.
    pub first: FirstEvent,
    /// Whether it is a light subpath that began in a medium.
    begins_in_medium: bool,
    /// Distance from the previous vertex.
    distance: f32,
    /// Alpha of the surface that was hit.
    alpha: f32,
    rough_before: bool,
    after_diffuse: bool,
    /// Where it leaves a body, if it is under its surface.
    exit: Option<Box<Exit<'a>>>,
    origin: Origin,
    mode: TransportMode,
}

/// The end of a ray of a subpath.
#[expect(clippy::large_enum_variant, reason = "it lives for one vertex, and a box is an allocation")]
pub(crate) enum Arrival<'a> {
    /// It interacts with the scene.
    At(Interaction<'a>),
    /// It leaves the scene.
    Escaped,
    /// A medium absorbed it.
    Lost,
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
        Self {
            beta: SampledSpectrum::splat(camera_ray.weight),
            partial: paths.balance.at_camera(pdf),
            medium: paths.view.medium,
            origin: if parallel { Origin::Direction } else { Origin::Point },
            ..Self::new(paths, camera_ray.ray, lambda, TransportMode::Radiance)
        }
    }

    /// Starts at a light, chosen by power; `None` if the sampled ray has no radiance.
    pub fn from_light(
        paths: &'a Bidirectional,
        time: f32,
        lambda: SampledWavelengths,
        tracer: &mut Tracer,
    ) -> Option<Self> {
        let sampler = &mut *tracer.sampler;
        let mut u = sampler.get_1d();
        let mut of_lights = 1.0;
        if let Some(media) = &paths.lights.media {
            if u < media.share {
                return Self::from_medium(paths, u / media.share, time, lambda, tracer);
            }
            of_lights -= media.share;
            u = ((u - media.share) / of_lights).min(ONE_MINUS_EPSILON);
        }
        let (u_position, u_direction) = (sampler.get_2d(), sampler.get_2d());
        let (light, pmf) = paths.lights.emitting.sample(u)?;
        let sample =
            paths.scene.sample_emission(light, u_position, u_direction, time, &lambda, tracer.stats)?;
        let source = paths.scene.light(light);
        let medium = source.medium_towards(sample.ray.d, sample.n);
        let mut beta = sample.beta() / (pmf * of_lights);
        if sample.p.is_none() && medium.is_some() {
            // The medium that the light comes through before it reaches the scene.
            let ray = Ray { d: -sample.ray.d, ..sample.ray };
            let way_back = ShadowRay { ray, t_max: f32::INFINITY };
            beta *= tracer.transmittance(&way_back, medium, &beta, &lambda)?;
        }
        Some(Self {
            beta,
            medium,
            light: Some(light),
            origin: Origin::Light(light, sample.p.map(|p| (p.p, sample.n))),
            ..Self::new(paths, sample.ray.into(), lambda, TransportMode::Importance)
        })
    }

    /// Starts in a medium that emits; `u` chooses where.
    fn from_medium(
        paths: &'a Bidirectional,
        u: f32,
        time: f32,
        lambda: SampledWavelengths,
        tracer: &mut Tracer,
    ) -> Option<Self> {
        let media = paths.lights.media.as_ref()?;
        let (place, direction) =
            (tracer.sampler.get_2d().extend(tracer.sampler.get_1d()), tracer.sampler.get_2d());
        let start = media.sample(paths.scene, u, place, direction, time, &lambda)?;
        Some(Self {
            beta: start.beta / media.share,
            medium: Some(start.medium),
            begins_in_medium: true,
            ..Self::new(paths, start.ray.into(), lambda, TransportMode::Importance)
        })
    }

    /// Starts in empty space, at a point without weights.
    fn new(
        paths: &'a Bidirectional,
        ray: RayDifferential,
        lambda: SampledWavelengths,
        mode: TransportMode,
    ) -> Self {
        Self {
            paths,
            ray,
            beta: SampledSpectrum::ONE,
            partial: Partial::default(),
            lambda,
            depth: 0,
            share: SampledSpectrum::ONE,
            medium: None,
            emitted: SampledSpectrum::ZERO,
            light: None,
            first: FirstEvent::None,
            begins_in_medium: false,
            distance: 0.0,
            alpha: 1.0,
            rough_before: false,
            after_diffuse: false,
            exit: None,
            origin: Origin::Point,
            mode,
        }
    }

    /// Where the ray interacts next, or how it ends.
    pub fn intersect(&mut self, tracer: &mut Tracer) -> Arrival<'a> {
        if let Some(exit) = self.exit.take() {
            return Arrival::At(Interaction::Exit(exit));
        }
        let scene = self.paths.scene;
        let hit = tracer.hit(&self.ray.ray);
        let t_max = hit.as_ref().map_or(f32::INFINITY, |hit| hit.t);
        match self.fly(t_max, tracer) {
            FlightEnd::Passed => (),
            FlightEnd::Absorbed => return Arrival::Lost,
            FlightEnd::Scattered { p, sigma_s, sigma_t, phase } => {
                self.distance += self.ray.ray.o.distance(p);
                let length = self.paths.balance.merging_length();
                self.alpha = if length > 0.0 { sigma_t.average() * length } else { 1.0 };
                return Arrival::At(Interaction::Medium(MediumInteraction { p, sigma_s, phase }));
            }
        }
        let Some(hit) = hit else { return Arrival::Escaped };
        let surface = scene.world().surface(&self.ray.ray, &hit);
        self.distance += hit.t;
        self.alpha = scene.coverage(&hit, &surface);
        Arrival::At(Interaction::Surface(scene.interaction(&hit, surface)))
    }

    /// Flies through the medium of the ray up to the surface at `t_max`.
    fn fly(&mut self, t_max: f32, tracer: &mut Tracer) -> FlightEnd {
        let Some(medium) = self.medium else { return FlightEnd::Passed };
        let before = self.beta;
        let flight = tracer.fly_alone(medium, &self.ray.ray, t_max, &self.lambda, &mut self.beta);
        self.emitted += flight.emitted;
        self.share *= self.beta.safe_div(before);
        flight.end
    }

    /// The vertex of an interaction; `None` if the ray passes the surface and has to be traced
    /// further.
    pub fn arrive(&mut self, interaction: &mut Interaction<'a>, tracer: &mut Tracer) -> Option<Vertex<'a>> {
        let (scene, view) = (self.paths.scene, self.paths.view);
        let mut vertex = match interaction {
            Interaction::Surface(surface) => {
                let Some(mut bsdf) = scene.bsdf(view, surface, &self.ray, &mut self.lambda, tracer.sampler)
                else {
                    let t = self.ray.ray.o.distance(surface.p());
                    self.medium = surface.medium_towards(self.ray.ray.d, self.medium);
                    self.ray = pass_through(&self.ray, surface, t);
                    return None;
                };
                bsdf.bxdf.keep_boundary();
                bsdf.regularize(self.paths.regularize && self.rough_before);
                self.surface_vertex(surface, bsdf)
            }
            Interaction::Medium(MediumInteraction { p, sigma_s, phase }) => {
                let (p, n, wo) = (Point3Error::exact(*p), Normal3::ZERO, -self.ray.ray.d);
                Vertex { presence: *sigma_s, ..self.vertex(p, n, wo, Law::Medium(*phase)) }
            }
            Interaction::Exit(exit) => {
                (self.depth, self.alpha) = (self.depth - 1, 1.0);
                // Its partial weights are zero, as if the subpath began there.
                return Some(Vertex { is_exit: true, ..self.surface_vertex(&exit.surface, exit.bsdf) });
            }
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

    /// The next vertex, on a surface, without its weights.
    fn surface_vertex(&mut self, surface: &SurfaceInteraction, bsdf: Bsdf<Bxdf<'a>>) -> Vertex<'a> {
        let (s, presence) = (&surface.surface, SampledSpectrum::splat(self.alpha));
        let &SurfaceInteraction { media, front, .. } = surface;
        Vertex { presence, media, front, ..self.vertex(s.p, s.n, s.wo, Law::Surface(bsdf)) }
    }

    /// The next vertex, without its weights.
    fn vertex(&mut self, p: Point3Error, n: Normal3, wo: Vector3, law: Law<'a>) -> Vertex<'a> {
        self.depth += 1;
        Vertex {
            p,
            n,
            wo,
            time: self.ray.ray.time,
            law,
            medium: self.medium,
            media: None,
            front: Normal3::ZERO,
            alpha: self.alpha,
            presence: SampledSpectrum::ONE,
            beta: self.beta,
            hero_only: self.lambda.secondary_terminated(),
            partial: Partial::default(),
            depth: self.depth,
            after_diffuse: self.after_diffuse,
            light: self.light,
            first: self.first,
            begins_in_medium: self.begins_in_medium,
            is_exit: false,
            mode: self.mode,
        }
    }

    /// Leaves a vertex along a direction that it scatters to; `false` if the subpath ends there,
    /// perhaps by Russian roulette.
    pub fn leave(&mut self, vertex: &Vertex<'a>, interaction: &Interaction, tracer: &mut Tracer) -> bool {
        self.scatter(vertex, interaction, tracer) && self.survive(tracer.sampler)
    }

    /// Samples up to the first vertex of a depth, without Russian roulette; `None` if the subpath
    /// ends before.
    pub fn follow_to(&mut self, depth: u32, tracer: &mut Tracer) -> Option<(Vertex<'a>, Interaction<'a>)> {
        loop {
            let (vertex, interaction) = self.next(tracer)?;
            if vertex.depth == depth {
                return Some((vertex, interaction));
            }
            if !self.scatter(&vertex, &interaction, tracer) {
                return None;
            }
        }
    }

    /// The next vertex, if the subpath has one.
    pub fn next(&mut self, tracer: &mut Tracer) -> Option<(Vertex<'a>, Interaction<'a>)> {
        loop {
            let Arrival::At(mut interaction) = self.intersect(tracer) else { return None };
            if let Some(vertex) = self.arrive(&mut interaction, tracer) {
                return Some((vertex, interaction));
            }
        }
    }

    /// Whether the next vertex is where the subpath leaves a body.
    pub fn is_under_surface(&self) -> bool {
        self.exit.is_some()
    }

    /// Leaves a vertex along a direction that it scatters to; `false` if it has none.
    pub fn scatter(&mut self, vertex: &Vertex<'a>, interaction: &Interaction, tracer: &mut Tracer) -> bool {
        let (uc, u) = (tracer.sampler.get_1d(), tracer.sampler.get_2d());
        let body = vertex.body();
        let way = match (body, &vertex.law) {
            (Some(body), Law::Surface(bsdf))
                if self.paths.light_goes_under && vertex.mode == TransportMode::Importance =>
            {
                LightWay::choose(body, bsdf.frame.to_local(vertex.wo), uc)
            }
            _ => LightWay { directions: Some(Directions::All), probability: 1.0, uc },
        };
        let Some(directions) = way.directions else {
            self.scale(SampledSpectrum::splat(1.0 / way.probability));
            return self.go_under(body, None, interaction, tracer);
        };
        let Some(sample) = vertex.law.sample_f(vertex.wo, way.uc, u, vertex.mode, directions) else {
            return false;
        };
        let scale = sample.f * (vertex.cosine(sample.wi) / (sample.pdf * way.probability));
        if vertex.mode == TransportMode::Radiance {
            self.first = vertex.first_event_of(&sample, tracer);
        }
        if vertex.mode == TransportMode::Radiance
            && let Some(body) = body.filter(|body| body.is_entered_by(&sample))
        {
            self.scale(scale);
            return self.go_under(Some(body), Some(&sample), interaction, tracer);
        }
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
        self.scale(scale);
        if vertex.mode == TransportMode::Radiance && sample.flags.is_transmissive() {
            self.share *= sample.eta * sample.eta;
        }
        self.origin = Origin::Point;
        self.distance = 0.0;
        self.medium = vertex.medium_towards(sample.wi);
        self.ray = interaction.spawn_scattered(&self.ray, &sample);
        !self.beta.is_black()
    }

    /// Goes on under the surface of a body: a camera subpath by a sample of its boundary, a light
    /// subpath without. `false` if the subpath ends there.
    fn go_under(
        &mut self,
        body: Option<Body<'_, 'a>>,
        sample: Option<&BsdfSample>,
        interaction: &Interaction,
        tracer: &mut Tracer,
    ) -> bool {
        let (Some(body), Interaction::Surface(entry)) = (body, interaction) else { return false };
        let u = tracer.sampler.get_1d();
        let heroes = Heroes::by_throughput(self.beta, self.lambda.secondary_terminated(), u);
        let exit = match sample {
            Some(sample) => tracer.exit(&entry.into(), body, sample.wi, &heroes),
            None => tracer.emerge(self.paths.scene, entry, body, &self.lambda, &heroes),
        };
        let Some(exit) = exit else { return false };
        self.scale(exit.value / heroes.mean(exit.density));
        self.exit = Some(Box::new(exit));
        !self.beta.is_black()
    }

    /// Multiplies the throughput.
    fn scale(&mut self, scale: SampledSpectrum) {
        self.beta *= scale;
        self.share *= scale;
    }

    /// Russian roulette.
    fn survive(&mut self, sampler: &mut Sampler) -> bool {
        let survival = roulette::survival(self.depth, self.share.max_component(), sampler);
        let Some(survival) = survival else { return false };
        self.beta /= survival;
        self.share /= survival;
        true
    }
}
