//! The compiled world: what rays meet, what it is made of, and what shines.

use crate::camera::{CameraRay, CameraSample};
use crate::interaction::{Footprint, SurfaceInteraction};
use crate::light::{
    AreaEmission, LightId, LightLeSample, LightLiSample, LightRef, LightSampleContext, LightTable, Lights,
    SceneSphere,
};
use crate::light_sampler::LightSampler;
use crate::material::{Material, MaterialEntry, MaterialId, resolve};
use crate::names::Names;
use crate::texture::{FloatTextureId, TextureContext, Textures};
use crate::traits::SceneTraits;
use crate::view::View;
use description::LightSamplerDesc;
use geometry::{GeometryId, Hit, RayStats, SurfacePoint, World};
use math::{DMat4, Point2, Ray, RayDifferential, Vec2, Vector3};
use sampling::{Sampler, hash_float};
use scattering::{Bsdf, Diffuse};
use spectrum::{SampledSpectrum, SampledWavelengths};
use std::sync::atomic::AtomicBool;

/// What belongs to one geometry of the world.
#[derive(Clone, Copy, Debug)]
pub struct GeometryEntry {
    /// What it is made of.
    pub material: MaterialId,
    /// Where it is there, unless everywhere.
    pub alpha: Option<FloatTextureId>,
    /// The light of its first primitive, if it emits; those of the others follow. Counted from the
    /// first light of the group that it stands in: the id is the sum with the
    /// [`InstanceEntry::first_light`] of all instances through which it is seen.
    pub first_light: Option<u32>,
}

/// What belongs to one instance of the world.
#[derive(Clone, Copy, Debug)]
pub struct InstanceEntry {
    /// The first light of what it shows, counted from the first light of the group that it stands
    /// in.
    pub first_light: u32,
}

/// What surfaces of material `interface` do to shadow rays. Rays that look for surfaces always pass
/// them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interfaces {
    /// They stop them.
    #[default]
    Stop,
    /// They let them pass.
    Pass,
}

impl Interfaces {
    /// What they do to the light of `light` where media are not known. The path tracer of the
    /// pbrt-v4 format, which draws them as surfaces that a path goes through, finds lights behind
    /// them by chance alone: so delta lights throw their shadow, and others do not.
    pub fn before(light: LightRef) -> Self {
        if light.is_delta() { Self::Stop } else { Self::Pass }
    }
}

/// Everything that is rendered, from any [`View`]. Never changes once compiled.
#[derive(Clone, Debug)]
pub struct Scene {
    pub(crate) world_from_render: DMat4,
    pub(crate) world: World,
    pub(crate) sphere: SceneSphere,
    pub(crate) entries: Vec<GeometryEntry>,
    pub(crate) materials: Vec<MaterialEntry>,
    pub(crate) textures: Textures,
    pub(crate) instances: Vec<InstanceEntry>,
    pub(crate) lights: LightTable,
    pub(crate) has_filtered_textures: bool,
    pub(crate) names: Names,
    pub(crate) traits: SceneTraits,
}

impl Scene {
    /// The transform from render space, in which rays are traced, to world space.
    pub fn world_from_render(&self) -> DMat4 {
        self.world_from_render
    }

    /// Whether anything in a view depends on the size of a pixel on a surface, so that ray
    /// differentials are needed.
    #[inline]
    pub fn needs_footprints(&self, view: &View) -> bool {
        self.has_filtered_textures && !view.options.disable_texture_filtering
    }

    /// What belongs to the geometries of the world, by [`GeometryId`].
    pub fn geometries(&self) -> &[GeometryEntry] {
        &self.entries
    }

    /// What belongs to the instances of the world, by [`InstanceId`](geometry::InstanceId).
    pub fn instances(&self) -> &[InstanceEntry] {
        &self.instances
    }

    /// What surfaces are made of, by [`MaterialId`]: the materials in the order of the description,
    /// and last the default one. The parts of a [`Mix`](Material::Mix) are rows of the same table,
    /// and no mix is a part of itself.
    pub fn materials(&self) -> &[MaterialEntry] {
        &self.materials
    }

    /// The names of its objects and materials.
    pub fn names(&self) -> &Names {
        &self.names
    }

    /// What holds of all of it.
    pub fn traits(&self) -> &SceneTraits {
        &self.traits
    }

    /// What area lights emit, by [`EmissionId`](crate::light::EmissionId).
    pub fn emissions(&self) -> &[AreaEmission] {
        self.lights.emissions()
    }

    /// The lights.
    #[inline]
    pub fn lights(&self) -> Lights<'_> {
        Lights { table: &self.lights, world: &self.world, textures: &self.textures }
    }

    /// The light of an id.
    #[inline]
    pub fn light(&self, id: LightId) -> LightRef<'_> {
        self.lights().get(id)
    }

    /// The lights that rays leaving the scene meet.
    pub fn infinite_lights(&self) -> &[LightId] {
        self.lights.infinite()
    }

    /// A way of choosing among the lights; `None` if `cancel` is set while it is made.
    pub fn light_sampler(&self, desc: LightSamplerDesc, cancel: &AtomicBool) -> Option<LightSampler> {
        LightSampler::new(desc, self.lights(), cancel)
    }

    /// The geometry, for what wants to look at it without materials.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The textures, which materials and lights refer to.
    pub fn textures(&self) -> &Textures {
        &self.textures
    }

    /// The sphere around everything that has an end.
    pub fn sphere(&self) -> SceneSphere {
        self.sphere
    }

    /// The nearest surface at 0 < t < `t_max`, and its t.
    pub fn intersect(
        &self,
        ray: &Ray,
        t_max: f32,
        stats: &mut RayStats,
    ) -> Option<(SurfaceInteraction, f32)> {
        let hit = self.hit(ray, t_max, stats)?;
        Some((self.interaction(&hit, self.world.surface(ray, &hit)), hit.t))
    }

    /// Where the nearest surface at 0 < t < `t_max` is met.
    pub fn hit(&self, ray: &Ray, t_max: f32, stats: &mut RayStats) -> Option<Hit> {
        self.world.intersect(ray, t_max, &|hit, ray| self.is_there(hit, ray), stats)
    }

    /// Whether one of 64 × 64 camera rays, spread over a view of the given resolution, hits a
    /// surface.
    pub fn has_surface_in(&self, view: &View, resolution: [i32; 2]) -> bool {
        const SIDE: u32 = 64;
        let position = |i: u32, axis: usize| (i as f32 + 0.5) / SIDE as f32 * resolution[axis] as f32;
        (0..SIDE * SIDE).any(|i| {
            let film = Vec2::new(position(i % SIDE, 0), position(i / SIDE, 1));
            let sample = CameraSample { film, lens: Vec2::splat(0.5), time: 0.5, filter_weight: 1.0 };
            let hit = |ray: CameraRay| self.hit(&ray.ray, f32::INFINITY, &mut RayStats::default());
            view.camera.generate_ray(&sample).and_then(hit).is_some()
        })
    }

    /// What belongs to the primitive of a hit, at a point of its surface.
    pub fn interaction(&self, hit: &Hit, surface: SurfacePoint) -> SurfaceInteraction {
        let entry = &self.entries[hit.geometry.0 as usize];
        SurfaceInteraction {
            surface,
            material: entry.material,
            area_light: entry.first_light.map(|first| {
                let instances = hit.instance.ids().iter().map(|id| self.instances[id.0 as usize]);
                let offset: u32 = instances.map(|instance| instance.first_light).sum();
                LightId(offset + first + hit.primitive)
            }),
            footprint: Footprint::default(),
        }
    }

    /// Whether all of a geometry is nothing but a change of medium.
    pub fn is_all_interface(&self, geometry: GeometryId) -> bool {
        let entry = &self.entries[geometry.0 as usize];
        matches!(self.materials[entry.material.0 as usize].material, Material::Interface)
    }

    /// Whether `ray` has hit nothing but a change of medium.
    pub fn is_interface(&self, hit: &Hit, ray: &Ray) -> bool {
        let entry = &self.entries[hit.geometry.0 as usize];
        match self.materials[entry.material.0 as usize].material {
            Material::Interface => true,
            Material::Mix(_) => {
                let interaction = self.interaction(hit, self.world.surface(ray, hit));
                matches!(resolve(&self.materials, &interaction, &self.textures).material, Material::Interface)
            }
            _ => false,
        }
    }

    /// Whether a surface that stops light lies at 0 < t < `t_max`.
    pub fn occluded(&self, ray: &Ray, t_max: f32, interfaces: Interfaces, stats: &mut RayStats) -> bool {
        let stops = |hit: &Hit, ray: &Ray| {
            let passes = interfaces == Interfaces::Pass && self.is_interface(hit, ray);
            !passes && self.is_there(hit, ray)
        };
        self.world.occluded(ray, t_max, &stops, stats)
    }

    /// Whether the point or direction of a light sample is visible from a surface.
    pub fn unoccluded(
        &self,
        from: &SurfacePoint,
        sample: &LightLiSample,
        interfaces: Interfaces,
        stats: &mut RayStats,
    ) -> bool {
        let (ray, t_max) = match sample.p {
            Some(p) => (Ray::between(from.p, from.n, p, sample.n, from.time), Ray::SHADOW_END),
            None => (from.spawn_ray(sample.wi), f32::INFINITY),
        };
        !self.occluded(&ray, t_max, interfaces, stats)
    }

    /// Whether a surface is there, where its alpha makes it come and go: it is with the probability
    /// alpha, decided by a hash of the ray and the place.
    fn is_there(&self, hit: &Hit, ray: &Ray) -> bool {
        let Some(texture) = self.entries[hit.geometry.0 as usize].alpha else { return true };
        let alpha = self.alpha(texture, &self.world.surface(ray, hit));
        if alpha >= 1.0 {
            return true;
        }
        let words = [ray.o.x, ray.o.y, ray.o.z, ray.d.x, ray.d.y, ray.d.z, hit.t].map(f32::to_bits);
        alpha > 0.0 && hash_float(&words) < alpha
    }

    /// How much of the surface is there, around a point of the primitive of a hit: from 0 to 1.
    pub fn coverage(&self, hit: &Hit, surface: &SurfacePoint) -> f32 {
        let texture = self.entries[hit.geometry.0 as usize].alpha;
        texture.map_or(1.0, |texture| self.alpha(texture, surface).clamp(0.0, 1.0))
    }

    fn alpha(&self, texture: FloatTextureId, s: &SurfacePoint) -> f32 {
        let context = TextureContext { p: s.p.p, n: s.n, uv: s.uv, ..Default::default() };
        self.textures.float(texture, &context)
    }

    /// Radiance that arrives along a ray which leaves the scene.
    pub fn escaped(&self, ray: &Ray, lambda: &SampledWavelengths) -> SampledSpectrum {
        self.infinite_lights()
            .iter()
            .fold(SampledSpectrum::ZERO, |sum, &id| sum + self.light(id).le(ray, lambda))
    }

    /// Radiance that a surface itself sends along `w`.
    pub fn emitted(
        &self,
        from: &SurfaceInteraction,
        w: Vector3,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        from.area_light.map_or(SampledSpectrum::ZERO, |id| {
            self.light(id).radiance(from.surface.n, from.surface.uv, w, lambda)
        })
    }

    /// [`LightRef::sample_li`] of one of this scene's lights.
    pub fn sample_light(
        &self,
        light: LightId,
        context: &LightSampleContext,
        u: Point2,
        lambda: &SampledWavelengths,
        allow_incomplete: bool,
    ) -> Option<LightLiSample> {
        self.light(light).sample_li(context, u, lambda, allow_incomplete)
    }

    /// [`LightRef::sample_le`] of one of this scene's lights. Light from infinity starts at the
    /// sphere around all that has an end; what has none may keep it from there: `None` if it does.
    pub fn sample_emission(
        &self,
        light: LightId,
        u_position: Point2,
        u_direction: Point2,
        time: f32,
        lambda: &SampledWavelengths,
        stats: &mut RayStats,
    ) -> Option<LightLeSample> {
        let light = self.light(light);
        let sample = light.sample_le(u_position, u_direction, time, lambda)?;
        if sample.p.is_none() && self.world.is_unbounded() {
            let way_back = Ray { d: -sample.ray.d, ..sample.ray };
            if self.occluded(&way_back, f32::INFINITY, Interfaces::before(light), stats) {
                return None;
            }
        }
        Some(sample)
    }

    /// How the surface scatters at a point that `ray` of a view has hit. Computes the footprint and
    /// perturbs the shading normal on the way. `None` for a mere interface between media, which the
    /// ray passes.
    pub fn bsdf(
        &self,
        view: &View,
        interaction: &mut SurfaceInteraction,
        ray: &RayDifferential,
        lambda: &mut SampledWavelengths,
        sampler: &mut Sampler,
    ) -> Option<Bsdf> {
        if self.needs_footprints(view) {
            interaction.compute_footprint(ray, view);
        }
        let entry = resolve(&self.materials, interaction, &self.textures);
        if matches!(entry.material, Material::Interface) {
            return None;
        }
        if let Some(map) = &entry.normal_map {
            interaction.surface.shading = map.bend(&interaction.surface);
        }
        let bxdf = entry.material.bxdf(&self.textures, &interaction.texture_context(), lambda)?;
        let s = &interaction.surface;
        let bsdf = Bsdf::new(s.shading.n, s.shading.dpdu, bxdf);
        if !view.options.force_diffuse {
            return Some(bsdf);
        }
        let reflectance = bsdf.rho(s.wo, [(sampler.get_1d(), sampler.get_2d())]);
        Some(Bsdf::new(s.shading.n, s.shading.dpdu, Diffuse { reflectance }.into()))
    }
}
