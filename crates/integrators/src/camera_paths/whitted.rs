//! Whitted's ray tracing: shadows, perfect reflection and refraction.
//!
//! At each surface, L = L_e + Σ_lights f L_i V |cos θ_i| / p + k_r L(reflected) + k_t L(refracted):
//! a shadow ray to one point of every light (point lights need no more, area lights show soft
//! shadows as samples grow), and both directions of a smooth mirror, metal or glass. Rough surfaces
//! scatter direct light only, so that indirect light and caustics are missing. The tree of rays
//! grows as 2^depth in glass.
//!
//! The light of a sky of one colour may be taken as ambient, as in the original: it reaches all
//! surfaces, without shadow rays. So the sun alone casts shadows, and a diffuse surface of
//! reflectance ρ has ρ L of a sky of radiance L, without noise.
//!
//! With a `max_depth` of 1, mirrors are black. Source: [Whitted 1980].
//!
//! The light of reflections may be looked up instead of traced, as film studios do: in a picture of
//! what surrounds the reflecting object (`transport/surroundings.rs`), which costs no rays; or in a
//! hybrid, where rays are traced and what they find is blended into the picture with its distance,
//! from half of a given distance to the whole: L = (1 − w) L_traced + w L_picture. So an object
//! shows itself and what is near, and the picture stands for what is far away [Christensen 2006].
//! The picture of a hybrid has nothing that is nearer than half of the distance.

use std::sync::Arc;

use description::{ReflectionsDesc, WhittedDesc};
use geometry::Hit;
use math::{RayDifferential, Vector3};
use sampling::Sampler;
use scattering::{Bsdf, Bxdf, Directions, TransportMode};
use scene::medium::MediumId;
use scene::{Scene, SurfaceInteraction, View};
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::transport::ShadowRay;
use crate::transport::direct::connect_all;
use crate::transport::path_state::{pass_through, throughput};
use crate::transport::single_scattering::Scattering;
use crate::transport::surroundings::{AllSurroundings, Surroundings};
use crate::transport::vertex::SurfaceVertex;
use crate::{Cancelled, Control, RayIntegrator, Tracer};

/// Whitted's ray tracing.
#[derive(Clone, Debug, Default)]
pub struct Whitted {
    settings: WhittedDesc,
    surroundings: Arc<Surroundings>,
}

impl Whitted {
    /// With these settings.
    pub fn new(settings: WhittedDesc) -> Self {
        Self { settings, surroundings: Arc::default() }
    }

    /// Maximum number of scattering events of a path.
    pub(crate) fn max_depth(&self) -> u32 {
        self.settings.max_depth
    }

    /// Whether the light of skies of one colour is ambient.
    pub(crate) fn is_ambient(&self) -> bool {
        self.settings.ambient
    }

    /// The light that the object which was hit reflects from direction `w`, of the picture of its
    /// surroundings.
    fn surroundings(
        &self,
        hit: &Hit,
        w: Vector3,
        lambda: &SampledWavelengths,
        tracer: &mut Tracer,
    ) -> SampledSpectrum {
        let traced = || Self::new(WhittedDesc { reflections: ReflectionsDesc::Traced, ..self.settings });
        let beyond = match self.settings.reflections {
            ReflectionsDesc::Hybrid => 0.5 * self.distance(tracer),
            _ => 0.0,
        };
        self.surroundings.radiance(hit, w, lambda, traced, beyond, tracer)
    }

    /// From where on reflected rays of a hybrid see the picture alone.
    fn distance(&self, tracer: &Tracer) -> f32 {
        self.settings.reflection_distance.unwrap_or_else(|| 0.25 * tracer.scene.sphere().radius)
    }

    /// The share of the picture in the light of a reflected ray that travels a distance.
    fn share_of_picture(&self, t: f32, tracer: &Tracer) -> f32 {
        (2.0 * t / self.distance(tracer) - 1.0).clamp(0.0, 1.0)
    }
}

/// A ray to be traced: a node of the tree.
pub(crate) struct Node {
    pub ray: RayDifferential,
    /// The medium of the ray.
    pub medium: Option<MediumId>,
    /// Path throughput.
    pub beta: SampledSpectrum,
    /// Scattering events so far.
    pub depth: u32,
    /// The hit at which it was reflected, if it blends into a picture of the surroundings.
    pub reflected_at: Option<Hit>,
}

impl Node {
    /// The reflected and the refracted ray, as far as they exist, of the surface that the ray has
    /// hit.
    pub fn children(
        &self,
        surface: &SurfaceInteraction,
        bsdf: &Bsdf<Bxdf>,
        sampler: &mut Sampler,
    ) -> [Option<Self>; 2] {
        if !bsdf.flags().is_specular() {
            return [None, None];
        }
        [Directions::Reflection, Directions::Transmission].map(|directions| {
            let (uc, u) = (sampler.get_1d(), sampler.get_2d());
            let sample = bsdf.sample_f(surface.surface.wo, uc, u, TransportMode::Radiance, directions)?;
            sample.flags.is_specular().then(|| Self {
                ray: surface.spawn_scattered(&self.ray, &sample),
                medium: surface.medium_towards(sample.wi, self.medium),
                beta: self.beta * throughput(surface.surface.shading.n, &sample),
                depth: self.depth + 1,
                reflected_at: None,
            })
        })
    }
}

impl RayIntegrator for Whitted {
    fn prepare(&mut self, scene: &Scene, view: &View, _: &Control) -> Result<(), Cancelled> {
        let all = scene.cache().of::<AllSurroundings>();
        self.surroundings = all.of((self.settings, view.medium, view.options));
        Ok(())
    }

    fn li(
        &self,
        tracer: &mut Tracer,
        ray: RayDifferential,
        lambda: &mut SampledWavelengths,
    ) -> SampledSpectrum {
        let mut l = SampledSpectrum::ZERO;
        let medium = tracer.view.medium;
        let mut next = Some(Node { ray, medium, beta: SampledSpectrum::ONE, depth: 0, reflected_at: None });
        let (mut rest, mut connections) = (Vec::new(), Vec::new());
        while let Some(mut node) = next.take().or_else(|| rest.pop()) {
            let hit = tracer.surface(&node.ray.ray);
            let t_max = hit.as_ref().map_or(f32::INFINITY, |(hit, _)| hit.t);
            if let Some(at) = node.reflected_at.take() {
                let share = self.share_of_picture(t_max, tracer);
                if share > 0.0 {
                    let w = node.ray.ray.d.normalize();
                    l += node.beta * self.surroundings(&at, w, lambda, tracer) * share;
                    node.beta *= 1.0 - share;
                }
                if share == 1.0 {
                    continue;
                }
            }
            if let Some(medium) = node.medium {
                let is_last = node.depth == self.settings.max_depth;
                let scattering = if is_last { Scattering::None } else { Scattering::Shadowed };
                l += node.beta * tracer.single_scattering(medium, &node.ray.ray, t_max, scattering, lambda);
                let way = ShadowRay { ray: node.ray.ray, t_max };
                let Some(passed) = tracer.transmittance_within(&way, medium, &node.beta, lambda) else {
                    continue;
                };
                node.beta *= passed;
            }
            let Node { ray, medium, beta, depth, .. } = node;
            let Some((hit, mut surface)) = hit else {
                l += beta * tracer.scene.escaped(&ray.ray, lambda);
                continue;
            };
            l += beta * tracer.scene.emitted(&surface, surface.surface.wo, lambda);
            let Some(bsdf) = tracer.bsdf(&mut surface, &ray, lambda) else {
                let medium = surface.medium_towards(ray.ray.d, medium);
                next = Some(Node { ray: pass_through(&ray, &surface, hit.t), medium, ..node });
                continue;
            };
            if depth == self.settings.max_depth {
                continue;
            }
            let (scene, sampler) = (tracer.scene, &mut *tracer.sampler);
            let (vertex, ambient) = (SurfaceVertex::new(&surface, &bsdf), self.settings.ambient);
            let push = |light| connections.push(light);
            let mut sum = connect_all(scene, sampler, &vertex, ambient, lambda, push);
            for light in connections.drain(..) {
                let medium = surface.medium_towards(light.shadow.ray.d, medium);
                sum += light.arriving(medium, lambda, tracer);
            }
            l += beta * sum;
            let [reflected, refracted] = node.children(&surface, &bsdf, tracer.sampler);
            rest.extend(refracted);
            next = match (self.settings.reflections, reflected) {
                (ReflectionsDesc::Environment, Some(reflected)) => {
                    let w = reflected.ray.ray.d.normalize();
                    l += reflected.beta * self.surroundings(&hit, w, lambda, tracer);
                    None
                }
                (ReflectionsDesc::Hybrid, Some(reflected)) => {
                    Some(Node { reflected_at: Some(hit), ..reflected })
                }
                (_, reflected) => reflected,
            };
        }
        l
    }
}
