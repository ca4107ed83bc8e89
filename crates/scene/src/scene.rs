//! The compiled scene: geometry, materials and lights.

use crate::cache::SceneCache;
use crate::camera::{CameraRay, CameraSample};
use crate::footprint::Footprint;
use crate::interaction::SurfaceInteraction;
use crate::light::{
    AreaEmission, LightId, LightLeSample, LightLiSample, LightRef, LightSampleContext, LightTable, Lights,
    SceneSphere,
};
use crate::light_sampler::LightSampler;
use crate::material::{Material, MaterialEntry, MaterialId, resolve};
use crate::medium::{Medium, MediumInterface};
use crate::names::Names;
use crate::texture::{FloatTextureId, TextureContext, Textures};
use crate::traits::SceneTraits;
use crate::view::View;
use description::{LightSamplerDesc, Span};
use geometry::{
    Filter, Geometry, GeometryId, Hit, HitColumns, RayColumns, RayStats, SphereSet, SurfacePoint, World,
};
use math::{CameraEnd, DMat4, Differentials, Normal3, Point2, Ray, RayDifferential, Vec2, Vector3};
use sampling::{Sampler, hash_float};
use scattering::{Bsdf, BsdfSample, Bxdf, Diffuse};
use spectrum::{SampledSpectrum, SampledWavelengths};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, PoisonError};

/// Material, alpha and lights of one geometry of the world.
#[derive(Clone, Copy, Debug)]
pub struct GeometryEntry {
    /// Its material.
    pub material: MaterialId,
    /// Alpha texture, which cuts the surface out; `None` is opaque.
    pub alpha: Option<FloatTextureId>,
    /// Whether rays with the camera at an end pass through its back.
    pub single_sided: bool,
    /// The light of its first primitive, if it emits; those of the other primitives follow. It is
    /// an offset from the first light of the group that holds the geometry: the id is its sum with
    /// the [`InstanceEntry::first_light`] of all instances on the path to the geometry.
    pub first_light: Option<u32>,
    /// The media on its two sides, if its author said so.
    pub media: Option<MediumInterface>,
    /// Where its shape is described.
    pub span: Span,
}

/// Lights of one instance of the world.
#[derive(Clone, Copy, Debug)]
pub struct InstanceEntry {
    /// The first light of the instanced group, as an offset from the first light of the group that
    /// holds the instance.
    pub first_light: u32,
    /// Where it is described.
    pub span: Span,
}

/// Whether surfaces of material `interface` occlude shadow rays. All other rays pass through them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interfaces {
    /// Interfaces occlude.
    #[default]
    Stop,
    /// Interfaces are ignored.
    Pass,
}

/// Everything that is rendered, from any [`View`]. Immutable once compiled.
#[derive(Clone, Debug)]
pub struct Scene {
    pub(crate) world_from_render: DMat4,
    pub(crate) world: World,
    pub(crate) sphere: SceneSphere,
    pub(crate) entries: Vec<GeometryEntry>,
    pub(crate) materials: Vec<MaterialEntry>,
    pub(crate) media: Vec<Medium>,
    pub(crate) textures: Textures,
    pub(crate) instances: Vec<InstanceEntry>,
    pub(crate) lights: LightTable,
    pub(crate) uses_footprints: bool,
    pub(crate) names: Names,
    pub(crate) traits: SceneTraits,
    pub(crate) cache: SceneCache,
}

impl Scene {
    /// What algorithms have computed of the scene as it is, whatever the view.
    pub fn cache(&self) -> &SceneCache {
        &self.cache
    }

    /// The transform from render space, in which rays are traced, to world space.
    pub fn world_from_render(&self) -> DMat4 {
        self.world_from_render
    }

    /// Whether anything in a view depends on the size of a pixel on a surface, so that ray
    /// differentials are needed.
    #[inline]
    pub fn needs_footprints(&self, view: &View) -> bool {
        self.uses_footprints && !view.options.disable_texture_filtering
    }

    /// The entries of the geometries of the world, by [`GeometryId`].
    pub fn geometries(&self) -> &[GeometryEntry] {
        &self.entries
    }

    /// The entries of the instances of the world, by [`InstanceId`](geometry::InstanceId).
    pub fn instances(&self) -> &[InstanceEntry] {
        &self.instances
    }

    /// The materials, by [`MaterialId`], in the order of the description; the default material
    /// comes last. The parts of a [`Mix`](Material::Mix) are rows of the same table, and no mix is
    /// a part of itself.
    pub fn materials(&self) -> &[MaterialEntry] {
        &self.materials
    }

    /// The participating media, by [`MediumId`](crate::medium::MediumId).
    pub fn media(&self) -> &[Medium] {
        &self.media
    }

    /// The names of objects and materials.
    pub fn names(&self) -> &Names {
        &self.names
    }

    /// Facts about the whole scene.
    pub fn traits(&self) -> &SceneTraits {
        &self.traits
    }

    /// The emissions of area lights, by [`EmissionId`](crate::light::EmissionId).
    pub fn emissions(&self) -> &[AreaEmission] {
        self.lights.emissions()
    }

    /// The lights.
    #[inline]
    pub fn lights(&self) -> Lights<'_> {
        Lights { table: &self.lights, world: &self.world, textures: &self.textures }
    }

    /// A light by its id.
    #[inline]
    pub fn light(&self, id: LightId) -> LightRef<'_> {
        self.lights().get(id)
    }

    /// The lights whose radiance rays that leave the scene receive.
    pub fn infinite_lights(&self) -> &[LightId] {
        self.lights.infinite()
    }

    /// A sampler of the lights, the same one for all views; `None` if `cancel` is set while it is
    /// built.
    pub fn light_sampler(&self, desc: LightSamplerDesc, cancel: &AtomicBool) -> Option<Arc<LightSampler>> {
        type Built = Mutex<Vec<(LightSamplerDesc, Arc<LightSampler>)>>;
        let built = self.cache.of::<Built>();
        let all = || built.lock().unwrap_or_else(PoisonError::into_inner);
        let known = all().iter().find(|(known, _)| *known == desc).map(|(_, sampler)| Arc::clone(sampler));
        known.or_else(|| {
            let sampler = Arc::new(LightSampler::new(desc, self.lights(), cancel)?);
            all().push((desc, Arc::clone(&sampler)));
            Some(sampler)
        })
    }

    /// The geometry, without materials.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The textures of materials and lights.
    pub fn textures(&self) -> &Textures {
        &self.textures
    }

    /// The sets of spheres, in the order of their description.
    pub fn sphere_sets(&self) -> impl Iterator<Item = (GeometryId, &SphereSet)> {
        (0..self.entries.len() as u32).filter_map(|id| match self.world.geometry(GeometryId(id)) {
            Geometry::Spheres(set) => Some((GeometryId(id), &**set)),
            Geometry::Mesh(_) | Geometry::Shapes(_) | Geometry::Curves(_) => None,
        })
    }

    /// The bounding sphere of all bounded shapes.
    pub fn sphere(&self) -> SceneSphere {
        self.sphere
    }

    /// The nearest intersection at 0 < t < `t_max`, and its t.
    pub fn intersect(
        &self,
        ray: &Ray,
        t_max: f32,
        stats: &mut RayStats,
    ) -> Option<(SurfaceInteraction, f32)> {
        let hit = self.hit(ray, t_max, stats)?;
        Some((self.interaction(&hit, self.world.surface(ray, &hit)), hit.t))
    }

    /// The nearest hit at 0 < t < `t_max`.
    pub fn hit(&self, ray: &Ray, t_max: f32, stats: &mut RayStats) -> Option<Hit> {
        self.world.intersect(ray, t_max, &self.visible(ray.camera), stats)
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

    /// The surface interaction of a hit, at a point of the primitive's surface.
    pub fn interaction(&self, hit: &Hit, surface: SurfacePoint) -> SurfaceInteraction {
        let entry = &self.entries[hit.geometry.0 as usize];
        SurfaceInteraction {
            front: if entry.single_sided { surface.front() } else { Normal3::ZERO },
            surface,
            material: entry.material,
            media: entry.media.filter(MediumInterface::is_transition),
            area_light: entry.first_light.map(|first| {
                let instances = hit.instance.ids().iter().map(|id| self.instances[id.0 as usize]);
                let offset: u32 = instances.map(|instance| instance.first_light).sum();
                LightId(offset + first + hit.primitive)
            }),
            footprint: Footprint::point(),
        }
    }

    /// Whether all of a geometry is an interface between media.
    pub fn is_all_interface(&self, geometry: GeometryId) -> bool {
        let entry = &self.entries[geometry.0 as usize];
        matches!(self.materials[entry.material.0 as usize].material, Material::Interface)
    }

    /// Whether `ray` has hit an interface between media.
    pub fn is_interface(&self, hit: &Hit, ray: &Ray) -> bool {
        let entry = &self.entries[hit.geometry.0 as usize];
        match self.materials[entry.material.0 as usize].material {
            Material::Interface => true,
            Material::Mix(_) => {
                let interaction = self.interaction(hit, self.world.surface(ray, hit));
                let MaterialId(id) = resolve(&self.materials, &interaction, &self.textures);
                matches!(self.materials[id as usize].material, Material::Interface)
            }
            _ => false,
        }
    }

    /// Whether an occluding surface lies at 0 < t < `t_max`.
    pub fn occluded(&self, ray: &Ray, t_max: f32, interfaces: Interfaces, stats: &mut RayStats) -> bool {
        self.world.occluded(ray, t_max, &self.stopping(interfaces, ray.camera), stats)
    }

    /// [`hit`](Self::hit) for each ray.
    pub fn hit_batch(&self, rays: RayColumns, hits: &mut HitColumns, stats: &mut RayStats) {
        self.world.intersect_batch(rays, &self.visible(rays.camera), hits, stats);
    }

    /// [`occluded`](Self::occluded) for each ray.
    ///
    /// # Panics
    /// If `occluded` and `rays` differ in length.
    pub fn occluded_batch(
        &self,
        rays: RayColumns,
        interfaces: Interfaces,
        occluded: &mut [bool],
        stats: &mut RayStats,
    ) {
        self.world.occluded_batch(rays, &self.stopping(interfaces, rays.camera), occluded, stats);
    }

    /// The hits that are visible.
    fn visible(&self, camera: CameraEnd) -> Surfaces<'_> {
        self.stopping(Interfaces::Stop, camera)
    }

    /// The hits that stop shadow rays.
    fn stopping(&self, interfaces: Interfaces, camera: CameraEnd) -> Surfaces<'_> {
        Surfaces { scene: self, interfaces, camera }
    }

    /// Whether a single-sided surface turns its back to the camera at an end of the ray.
    fn turns_its_back(&self, hit: &Hit, ray: &Ray) -> bool {
        if ray.camera == CameraEnd::Neither || !self.entries[hit.geometry.0 as usize].single_sided {
            return false;
        }
        let along = self.world.surface(ray, hit).front().dot(ray.d);
        if ray.camera == CameraEnd::Origin { along > 0.0 } else { along < 0.0 }
    }

    /// The stochastic alpha test: a hit counts with probability alpha, decided by a hash of the ray
    /// and the point.
    fn passes_alpha_test(&self, hit: &Hit, ray: &Ray) -> bool {
        let Some(texture) = self.entries[hit.geometry.0 as usize].alpha else { return true };
        let alpha = self.alpha(texture, &self.world.surface(ray, hit));
        if alpha >= 1.0 {
            return true;
        }
        let words = [ray.o.x, ray.o.y, ray.o.z, ray.d.x, ray.d.y, ray.d.z, hit.t].map(f32::to_bits);
        alpha > 0.0 && hash_float(&words) < alpha
    }

    /// The alpha, in [0, 1], at a point of the primitive of a hit.
    pub fn coverage(&self, hit: &Hit, surface: &SurfacePoint) -> f32 {
        let texture = self.entries[hit.geometry.0 as usize].alpha;
        texture.map_or(1.0, |texture| self.alpha(texture, surface).clamp(0.0, 1.0))
    }

    fn alpha(&self, texture: FloatTextureId, s: &SurfacePoint) -> f32 {
        let context = TextureContext { p: s.p.p, n: s.n, uv: s.uv, ..Default::default() };
        self.textures.float(texture, &context)
    }

    /// Radiance from the infinite lights along a ray that leaves the scene.
    pub fn escaped(&self, ray: &Ray, lambda: &SampledWavelengths) -> SampledSpectrum {
        self.infinite_lights()
            .iter()
            .fold(SampledSpectrum::ZERO, |sum, &id| sum + self.light(id).le(ray, lambda))
    }

    /// Radiance that a surface emits along `w`.
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
    #[inline]
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

    /// [`LightRef::sample_le`] of one of this scene's lights. Rays of distant lights start on the
    /// bounding sphere of all bounded shapes, or in a portal. Unbounded shapes, or shapes beyond
    /// the portal, may occlude them before: `None` if one does.
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
        if sample.p.is_none() && (self.world.is_unbounded() || light.emits_within_scene()) {
            let way_back = Ray { d: -sample.ray.d, ..sample.ray };
            if self.occluded(&way_back, f32::INFINITY, Interfaces::Pass, stats) {
                return None;
            }
        }
        Some(sample)
    }

    /// The material at a point that `ray` of a view has hit, after the choices of mixes.
    pub fn material_at(
        &self,
        view: &View,
        interaction: &mut SurfaceInteraction,
        ray: &RayDifferential,
    ) -> MaterialId {
        if self.needs_footprints(view) {
            interaction.compute_footprint(ray, view);
        }
        resolve(&self.materials, interaction, &self.textures)
    }

    /// Applies the normal or bump map of a material.
    fn perturb(&self, entry: &MaterialEntry, interaction: &mut SurfaceInteraction) {
        if let Some(map) = &entry.normal_map {
            interaction.surface.shading = map.perturb(&interaction.surface);
        } else if let Some(map) = &entry.bump_map {
            let context = interaction.texture_context();
            interaction.surface.shading = map.perturb(&interaction.surface.shading, &context, &self.textures);
        }
    }

    /// The differentials of the ray that leaves the hit of `ray` by a sample of specular
    /// scattering, if `ray` has differentials and they stay small enough for filtering.
    pub fn scattered_differentials(
        &self,
        view: &View,
        ray: &RayDifferential,
        hit: &Hit,
        sample: &BsdfSample,
    ) -> Option<Differentials> {
        let mut interaction = self.interaction(hit, self.world.surface(&ray.ray, hit));
        let MaterialId(id) = self.material_at(view, &mut interaction, ray);
        self.perturb(&self.materials[id as usize], &mut interaction);
        interaction.spawn_scattered(ray, sample).differentials
    }

    /// The BSDF at a point that `ray` of a view has hit. Also computes the footprint and applies
    /// the normal or bump map. `None` for an interface between media, which the ray passes.
    pub fn bsdf(
        &self,
        view: &View,
        interaction: &mut SurfaceInteraction,
        ray: &RayDifferential,
        lambda: &mut SampledWavelengths,
        sampler: &mut Sampler,
    ) -> Option<Bsdf<Bxdf<'_>>> {
        let MaterialId(id) = self.material_at(view, interaction, ray);
        let entry = &self.materials[id as usize];
        if matches!(entry.material, Material::Interface) {
            return None;
        }
        self.perturb(entry, interaction);
        let bxdf = entry.material.bxdf(&self.textures, &interaction.texture_context(), lambda)?;
        let s = &interaction.surface;
        let mut bsdf = Bsdf::new(s.shading.n, s.shading.dpdu, bxdf);
        bsdf.seed(lambda, sampler.dimension());
        if !view.options.force_diffuse {
            return Some(bsdf);
        }
        let reflectance = bsdf.rho(s.wo, [(sampler.get_1d(), sampler.get_2d())]);
        Some(Bsdf::new(s.shading.n, s.shading.dpdu, Diffuse { reflectance }.into()))
    }
}

/// The hits on surfaces that are not cut out by alpha, on interfaces where these stop rays, and, of
/// rays with the camera at an end, on the sides that it sees.
struct Surfaces<'a> {
    scene: &'a Scene,
    interfaces: Interfaces,
    camera: CameraEnd,
}

impl Filter for Surfaces<'_> {
    #[inline(always)]
    fn accepts(&self, hit: &Hit, ray: &Ray) -> bool {
        let passes = self.interfaces == Interfaces::Pass && self.scene.is_interface(hit, ray);
        !passes && !self.scene.turns_its_back(hit, ray) && self.scene.passes_alpha_test(hit, ray)
    }

    fn concerns(&self, geometry: GeometryId) -> bool {
        let entry = &self.scene.entries[geometry.0 as usize];
        let material = &self.scene.materials[entry.material.0 as usize].material;
        let may_pass =
            self.interfaces == Interfaces::Pass && matches!(material, Material::Interface | Material::Mix(_));
        may_pass || entry.alpha.is_some() || (entry.single_sided && self.camera != CameraEnd::Neither)
    }
}
