//! Connects subpaths to complete paths: one function for each kind of strategy.

use film::{FirstEvent, Parts, Splatter};
use math::{Bounds2, CameraEnd, Normal3, Point2, Point3Error, Ray};
use scene::Scene;
use scene::camera::{CameraWiSample, FilmPositions};
use scene::light::{LightId, LightPoint};
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::{Bidirectional, Interaction, LightVertex, Merges, Vertex, Walk, hero_only};
use crate::transport::parts::group_of;
use crate::transport::{ShadowRay, Tracer};

/// The contribution of a strategy.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    /// The unweighted estimate.
    pub l: SampledSpectrum,
    /// The MIS weight of the strategy.
    pub weight: f32,
    /// Vertices of the light subpath.
    pub s: u32,
    /// Vertices of the camera subpath.
    pub t: u32,
    /// The light; `None` for media that emit.
    pub light: Option<LightId>,
    /// The event next to the camera, where somebody takes parts of the light.
    pub first: FirstEvent,
}

impl Found {
    /// The weighted estimate.
    pub fn weighted(&self) -> SampledSpectrum {
        self.l * self.weight
    }

    /// The number of scattering events of the path.
    pub fn events(&self) -> u32 {
        self.s + self.t - 2
    }
}

/// The contribution of a light subpath, and its film positions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnFilm {
    /// Positions in pixels.
    pub places: FilmPositions,
    /// The contribution.
    pub found: Found,
}

impl OnFilm {
    /// Splats light at all of these positions.
    pub fn splat(&self, splatter: &Splatter, l: &SampledSpectrum, lambda: &SampledWavelengths) {
        self.splat_with(splatter, l, lambda, None);
    }

    /// Splats the weighted contribution, and its parts where the film has layers of them.
    pub fn splat_parts(&self, splatter: &Splatter, lambda: &SampledWavelengths, scene: &Scene) {
        let (found, l) = (&self.found, self.found.weighted());
        let mut parts = splatter.new_parts();
        if let Some(parts) = &mut parts {
            parts.add(l, group_of(scene, found.light), &found.first, found.events());
        }
        self.splat_with(splatter, &l, lambda, parts.as_ref());
    }

    fn splat_with(
        &self,
        splatter: &Splatter,
        l: &SampledSpectrum,
        lambda: &SampledWavelengths,
        parts: Option<&Parts>,
    ) {
        let places = self.places.within(splatter.reach());
        places.for_each(|film| splatter.add_with(film, l, lambda, parts));
    }
}

impl Bidirectional<'_> {
    /// s = 0: the camera subpath, whose last vertex is `before`, has hit a surface that may emit.
    pub fn emitted(&self, walk: &Walk, interaction: &Interaction, before: Option<&Vertex>) -> Option<Found> {
        let Interaction::Surface(surface) = interaction else { return None };
        let light = surface.area_light?;
        let l = walk.beta * self.scene.emitted(surface, surface.surface.wo, &walk.lambda);
        let s = &surface.surface;
        (!l.is_black()).then(|| self.met(walk, l, light, before, Some((s.p.p, s.n))))
    }

    /// s = 0: media have emitted light along the last ray of the camera subpath. No other strategy
    /// finds it.
    pub fn emitted_on_the_way(&self, walk: &mut Walk) -> Option<Found> {
        let l = std::mem::replace(&mut walk.emitted, SampledSpectrum::ZERO);
        let is_hero_only = walk.lambda.secondary_terminated();
        (!l.is_black()).then(|| Found {
            l: hero_only(l, is_hero_only),
            weight: 1.0,
            s: 0,
            t: walk.depth + 2,
            light: None,
            first: walk.first,
        })
    }

    /// s = 0: the camera subpath has left the scene.
    pub fn escaped<'a>(
        &'a self,
        walk: &'a Walk,
        before: Option<&'a Vertex>,
    ) -> impl Iterator<Item = Found> + 'a {
        self.scene.infinite_lights().iter().filter_map(move |&light| {
            let l = walk.beta * self.scene.light(light).le(&walk.ray.ray, &walk.lambda);
            (!l.is_black()).then(|| self.met(walk, l, light, before, None))
        })
    }

    fn met(
        &self,
        walk: &Walk,
        l: SampledSpectrum,
        light: LightId,
        before: Option<&Vertex>,
        point: LightPoint,
    ) -> Found {
        let weight = before.map_or(1.0, |before| {
            let (context, wi) = (before.light_context(), walk.ray.ray.d);
            let partial = &walk.partial;
            let direct = if partial.vcm == 0.0 { 0.0 } else { self.direct_pdf(light, &context, wi, point) };
            let end = self.light_end(light, &context, wi, point, direct);
            let by_light = self.balance.connecting_from_light(partial, before.cos_theta(wi), before.merges());
            weight(end.direct * partial.vcm, end.emission / end.cos_theta * by_light)
        });
        let l = hero_only(l, walk.lambda.secondary_terminated());
        Found { l, weight, s: 0, t: walk.depth + 2, light: Some(light), first: walk.first }
    }

    /// s = 1: next-event estimation at the vertex.
    pub fn direct(&self, vertex: &Vertex, lambda: &SampledWavelengths, tracer: &mut Tracer) -> Option<Found> {
        let (u, u_light) = (tracer.sampler.get_1d(), tracer.sampler.get_2d());
        let context = vertex.light_context();
        let (light, pmf) = self.lights.seen_from.sample(&context, u)?;
        let sample = self.scene.sample_light(light, &context, u_light, lambda, false)?;
        let wi = sample.wi;
        let l = vertex.scattered(wi) * sample.l / (pmf * sample.pdf);
        if l.is_black() {
            return None;
        }
        let shadow = match sample.p {
            Some(p) => vertex.shadow_ray_to(p, sample.n),
            None => {
                let ray = Ray::spawn(vertex.p, vertex.n, wi, vertex.time);
                ShadowRay { ray, t_max: f32::INFINITY }
            }
        };
        let l = l * tracer.transmittance(&shadow, vertex.medium_towards(shadow.ray.d), &l, lambda)?;
        let point = sample.p.map(|p| (p.p, sample.n));
        let direct = match point {
            Some((p, Normal3::ZERO)) => pmf * vertex.p.p.distance_squared(p),
            _ => pmf * sample.pdf,
        };
        let end = self.light_end(light, &context, wi, point, direct);
        let by_chance = if end.is_delta { 0.0 } else { vertex.pdf(wi) / direct };
        let from_light = end.emission * vertex.cos_theta(wi) / (direct * end.cos_theta);
        let back = self.balance.connecting_back(
            &vertex.partial,
            vertex.pdf_back(wi),
            Merges { here: 0.0, ..vertex.merges() },
        );
        let (weight, first) = (weight(by_chance, from_light * back), vertex.first_event(wi, tracer));
        let l = hero_only(l, vertex.hero_only);
        Some(Found { l, weight, s: 1, t: vertex.depth + 1, light: Some(light), first })
    }

    /// s, t ≥ 2: two vertices are connected.
    pub fn connect(
        &self,
        camera: &Vertex,
        light: &Vertex,
        lambda: &SampledWavelengths,
        tracer: &mut Tracer,
    ) -> Option<Found> {
        let way = light.p.p - camera.p.p;
        let distance_squared = way.length_squared();
        let wi = way / distance_squared.sqrt();
        let l = camera.scattered(wi) * light.scattered(-wi) / distance_squared;
        if l.is_black() || !l.is_finite() {
            return None;
        }
        let way = camera.shadow_ray_to(light.p, light.n);
        let l = l * tracer.transmittance(&way, camera.medium_towards(way.ray.d), &l, lambda)?;
        let to_light = camera.pdf(wi) * light.cos_theta(wi) / distance_squared;
        let to_camera = light.pdf(-wi) * camera.cos_theta(wi) / distance_squared;
        let of_light = light.merges().only_if(camera.can_merge() && !camera.is_diffuse());
        let weight = weight(
            to_light * self.balance.connecting_back(&light.partial, light.pdf_back(-wi), of_light),
            to_camera * self.balance.connecting_back(&camera.partial, camera.pdf_back(wi), camera.merges()),
        );
        Some(Found {
            l: hero_only(l, camera.hero_only || light.hero_only),
            weight,
            s: light.depth + 1,
            t: camera.depth + 1,
            light: light.light,
            first: camera.first_event(wi, tracer),
        })
    }

    /// s ≥ 1, t ≥ 2: next-event estimation at a vertex of a camera subpath, and its connections to
    /// the vertices of a light subpath, up to the maximum length of a path.
    pub fn connect_each<'v>(
        &self,
        camera: &Vertex,
        lights: impl Iterator<Item = &'v Vertex<'v>>,
        lambda: &SampledWavelengths,
        tracer: &mut Tracer,
        mut add: impl FnMut(&Found, &mut Tracer),
    ) {
        if let Some(found) = self.direct(camera, lambda, tracer) {
            add(&found, tracer);
        }
        for light in lights.filter(|light| camera.depth + light.depth <= self.max_depth) {
            if let Some(found) = self.connect(camera, light, lambda, tracer) {
                add(&found, tracer);
            }
        }
    }

    /// t = 1: the vertex of a light subpath is connected to the point of the lens that `u` chooses;
    /// `None` unless a film position lies within `reach`.
    pub fn connect_to_camera(
        &self,
        vertex: &Vertex,
        u: Point2,
        reach: Bounds2,
        lambda: &SampledWavelengths,
        tracer: &mut Tracer,
    ) -> Option<OnFilm> {
        let camera = &self.view.camera;
        let sample = camera.sample_wi(vertex.p.p, vertex.time, u)?;
        let CameraWiSample { we, wi, pdf, film, p, n } = sample;
        let places = camera.film_positions(film);
        places.within(reach).next()?;
        if vertex.front.dot(wi) < 0.0 {
            return None;
        }
        let l = vertex.scattered(wi) * (we / pdf);
        if l.is_black() {
            return None;
        }
        let mut way = vertex.shadow_ray_to(Point3Error::exact(p), n);
        way.ray.camera = CameraEnd::Target;
        let l = l * tracer.transmittance(&way, vertex.medium_towards(way.ray.d), &l, lambda)?;
        let (pdf_position, pdf_direction) = camera.pdf_we(&Ray::new(p, -wi, vertex.time));
        let pdf_area =
            if camera.is_parallel() { pdf_position } else { pdf_direction / vertex.p.p.distance_squared(p) }
                * vertex.cos_theta(wi);
        let back = self.balance.connecting_back(&vertex.partial, vertex.pdf_back(wi), vertex.merges());
        let weight = weight(pdf_area / self.balance.light_paths * back, 0.0);
        let (l, first) = (hero_only(l, vertex.hero_only), vertex.first_event(wi, tracer));
        let found = Found { l, weight, s: vertex.depth + 1, t: 1, light: vertex.light, first };
        Some(OnFilm { places, found })
    }

    /// Whether a photon near the vertex may be merged with it: both lie on surfaces or both in
    /// media, and the path is not too long.
    #[inline]
    pub fn may_merge(&self, camera: &Vertex, photon: &LightVertex) -> bool {
        let depth = camera.depth + u32::from(photon.depth) - 1;
        depth <= self.max_depth && camera.is_in_medium() == photon.is_in_medium
    }

    /// s, t ≥ 2: a photon near the vertex, on a surface like it or in a medium like it, is merged
    /// with it, as if it had arrived there.
    pub fn merge(&self, camera: &Vertex, photon: &LightVertex, tracer: &Tracer) -> Found {
        let wi = photon.wo;
        let l = self.merged(camera, photon);
        let of_camera = camera.merges();
        let of_light = Merges { before: !camera.is_diffuse(), ..of_camera };
        let weight = weight(
            self.balance.merging_back(&photon.partial, camera.pdf(wi), of_light),
            self.balance.merging_back(&camera.partial, camera.pdf_back(wi), of_camera),
        );
        let (light, first) = (photon.light(), camera.first_event(wi, tracer));
        Found { l, weight, s: photon.depth.into(), t: camera.depth + 1, light, first }
    }

    /// The unweighted contribution of [`Self::merge`].
    pub fn merged(&self, camera: &Vertex, photon: &LightVertex) -> SampledSpectrum {
        let wi = photon.wo;
        // Power includes the cosine to the geometric normal; scattering has that to the shading
        // normal. Photons of another face, as of a neighbour in a smooth mesh, are not rare where
        // they graze the camera's, so that the quotient is bounded by their own cosine.
        let cosine = camera.cosine(wi);
        let cos_theta = camera.cos_theta(wi).max(photon.cos_theta.min(cosine));
        let cosines = if cos_theta == 0.0 { 0.0 } else { cosine / cos_theta };
        let f = camera.law.f(camera.wo, wi, camera.mode);
        let length = if photon.is_in_medium { self.balance.merging_length() } else { 1.0 };
        let l = camera.beta * photon.beta * f * (cosines / (self.balance.merging * length));
        hero_only(l, camera.hero_only || photon.hero_only)
    }
}

/// The balance heuristic from the sums of the other strategies' density ratios. Infinite or NaN
/// ratios give the weight 0.
fn weight(of_light: f32, of_camera: f32) -> f32 {
    let sum = 1.0 + of_light + of_camera;
    if sum.is_nan() { 0.0 } else { 1.0 / sum }
}
