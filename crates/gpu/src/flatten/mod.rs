//! A scene and a view of it as buffers for kernels.
//!
//! All tables are in one buffer of words. A record refers to another by its offset, that of its
//! first word; offset 0 is nothing. Each file has the records of one closed set, which the shader
//! of the same name reads.
//!
//! What kernels do not draw is a [`Refusal`], with its place in the scene's file: the whole scene
//! is then drawn by the CPU.

mod algorithms;
pub(crate) mod cameras;
mod distributions;
mod filters;
mod geometries;
mod images;
mod lenses;
mod light_choices;
mod light_paths;
mod lights;
mod materials;
mod measured;
mod media;
mod openpbr;
mod portals;
mod samplers;
mod sensors;
mod slab;
mod spectra;
mod subsurface;
mod textures;

use std::collections::HashMap;

use description::{Diagnostic, Span};
use film::{Film, LayerSet};
use geometry::{GeometryId, InstanceId, InstancePath, Shape};
use sampling::Sampler;
use scene::light::Light;
use scene::light_sampler::LightSampler;
use scene::material::Material;
use scene::{GeometryEntry, Scene, View, ViewOptions};

use crate::algorithm::{Algorithm, Traits};
use crate::bvh::{Bvh, BvhError, Top};
use crate::parts::Parts;
use crate::records::record;
pub use openpbr::openpbr_table;
use slab::Slab;

/// Something that kernels do not draw.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// What it is, as a plural or with an article.
    pub what: String,
    /// Its place in the scene's file.
    pub span: Span,
}

impl From<Refusal> for Diagnostic {
    fn from(Refusal { what, span }: Refusal) -> Self {
        Self::warning("not-on-gpu", format!("the engine for GPUs does not draw {what}"), span)
    }
}

/// A scene for kernels.
#[derive(Clone, Debug)]
pub struct Flat {
    /// What rays are traced through.
    pub(crate) bvh: Bvh,
    /// Where the tables are, and the numbers of the algorithm.
    pub(crate) head: Head,
    /// The tables.
    pub(crate) tables: Vec<u32>,
    /// The texels of images.
    pub(crate) texels: Vec<u32>,
    /// What kernels need for it.
    pub(crate) parts: Parts,
    /// The radius of the scene's sphere.
    pub(crate) radius: f32,
    /// The kinds of materials that rays hit, a bit for each.
    pub(crate) kinds: u32,
    /// The number of passes that are planned.
    pub(crate) passes: u32,
}

record! {
    /// The first buffer of a scene, `world` of shaders.
    pub(crate) struct Head {
        /// Where rays begin.
        top: Top,
        /// The offsets of camera, filter, geometries, materials, offsets of lights, offsets of
        /// infinite lights, and choice of lights.
        camera: u32,
        pixel_filter: u32,
        geometries: u32,
        materials: u32,
        lights: u32,
        infinite: u32,
        choice: u32,
        /// The numbers of lights, and of infinite ones.
        light_count: u32,
        infinite_count: u32,
        /// The offset of the source of random numbers.
        random_numbers: u32,
        /// Whether all samples of a pixel go through its centre, and have the same wavelengths.
        is_centered: u32,
        has_one_wavelength: u32,
        /// The most scattering events, and a [`SettingBit`] for each setting.
        max_depth: u32,
        settings: u32,
        /// Of `ambient-occlusion`: the offset of the white, its scale, the distance from which on
        /// surfaces do not occlude, and whether directions follow the cosine.
        white: u32,
        white_scale: f32,
        max_distance: f32,
        cos_sample: u32,
        /// Whether anything depends on the size of a pixel on surfaces.
        has_footprints: u32,
        /// The offset of the sensor.
        sensor: u32,
        /// The offset of what light paths need, if there are any.
        light_paths: u32,
        /// The offset of media, if there are any or interfaces between them.
        media: u32,
    }
}

impl Flat {
    /// What kernels need for it.
    pub fn parts(&self) -> Parts {
        self.parts
    }

    /// Has kernels take these parts, so that scenes that need different ones can share kernels.
    /// They must have all parts that it needs, and no others of those that replace something:
    /// bodies, a system of lenses, diffuse surfaces instead of all, or ray queries.
    pub fn set_parts(&mut self, parts: Parts) {
        self.parts = parts;
    }

    /// The bytes of its buffers.
    pub fn bytes(&self) -> usize {
        let Bvh { nodes, triangles, items, .. } = &self.bvh;
        let quadruples = nodes.len() + triangles.len() + items.len();
        size_of::<Head>() + 16 * quadruples + 4 * (self.tables.len() + self.texels.len())
    }
}

/// What is drawn, and how.
#[derive(Clone, Copy)]
pub struct Subject<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The view of it.
    pub view: &'a View,
    /// The film, of which nothing is changed.
    pub film: &'a Film,
    /// The algorithm.
    pub algorithm: &'a Algorithm,
    /// The source of random numbers.
    pub sampler: &'a Sampler,
    /// That of light paths, but for photons and chains, which have their own.
    pub light_sampler: &'a Sampler,
    /// The most bytes of a buffer.
    pub largest_buffer: usize,
    /// Whether ray queries trace rays if they can: if nothing moves, and there are not too many
    /// instances or primitives.
    pub ray_queries: bool,
}

/// The buffers of a scene; `lights` chooses among its lights. The error says what kernels do not
/// draw.
pub fn flatten(subject: Subject, lights: &LightSampler) -> Result<Flat, Vec<Refusal>> {
    let Subject { scene, view, film, algorithm, sampler, light_sampler, largest_buffer, ray_queries } =
        subject;
    // The camera's record has samples and wavelengths, and footprints know of filters.
    let View { camera: _, medium, samples_per_pixel: _, options, wavelengths: _ } = view;
    let ViewOptions {
        disable_pixel_jitter,
        disable_wavelength_jitter,
        disable_texture_filtering: _,
        force_diffuse,
    } = *options;
    let Traits { media: _, bodies, light_paths, splats: _ } = algorithm.traits();
    let mut flattener = Flattener {
        scene,
        slab: Slab::new(),
        spectra: Default::default(),
        textures: Default::default(),
        pyramids: Default::default(),
        texels: Default::default(),
        instances: Default::default(),
        surfaces: Default::default(),
        largest_buffer,
        follows_bodies: bodies && !force_diffuse,
        begins_at_lights: light_paths,
        parts: Parts { forced_diffuse: force_diffuse, ..Parts::default() },
        refusals: Vec::new(),
    };
    flattener.check(film, algorithm);
    let mut head = Head {
        is_centered: disable_pixel_jitter.into(),
        has_one_wavelength: disable_wavelength_jitter.into(),
        has_footprints: scene.needs_footprints(view).into(),
        light_count: scene.lights().len() as u32,
        infinite_count: scene.infinite_lights().len() as u32,
        random_numbers: flattener.sampler(sampler),
        camera: flattener.camera(view, algorithm),
        pixel_filter: flattener.filter(film.filter()),
        sensor: flattener.sensor(film),
        geometries: flattener.geometries(),
        ..Head::default()
    };
    let (materials, kinds) = flattener.materials();
    let bvh = flattener.bvh(algorithm, ray_queries);
    let (all_lights, infinite) = flattener.lights();
    head = Head {
        top: bvh.top,
        materials,
        lights: all_lights,
        infinite,
        choice: flattener.light_choice(lights),
        ..head
    };
    flattener.algorithm(algorithm, &mut head);
    if light_paths {
        head.light_paths = flattener.light_paths(algorithm, light_sampler, film);
    }
    if has_media(scene) || matches!(algorithm, Algorithm::SimpleVolPath(_)) {
        flattener.parts.media = true;
        head.media = flattener.media(*medium);
    }
    let Flattener { slab, texels, parts, refusals, .. } = flattener;
    let radius = scene.sphere().radius;
    let passes = algorithm.passes(sampler);
    let flat =
        Flat { bvh, head, tables: slab.into_words(), texels: texels.words, parts, radius, kinds, passes };
    if refusals.is_empty() { Ok(flat) } else { Err(refusals) }
}

/// Whether there are media, or interfaces that would be between them.
fn has_media(scene: &Scene) -> bool {
    !scene.media().is_empty() || scene.geometries().iter().any(|entry| is_interface(scene, entry))
}

fn is_interface(scene: &Scene, entry: &GeometryEntry) -> bool {
    matches!(scene.materials()[entry.material.0 as usize].material, Material::Interface)
}

/// Tables under construction.
struct Flattener<'a> {
    scene: &'a Scene,
    slab: Slab,
    spectra: spectra::Shared,
    /// The offsets of textures and of pyramids of images, by their ids.
    textures: HashMap<u32, u32>,
    pyramids: HashMap<u32, u32>,
    texels: images::Texels,
    /// The items of the instances, where lights are in any.
    instances: HashMap<InstancePath, u32>,
    /// The offsets of surfaces that emit in instances, by geometry and primitive.
    surfaces: HashMap<(u32, u32), u32>,
    largest_buffer: usize,
    /// Whether paths go on under the surface of bodies.
    follows_bodies: bool,
    /// Whether paths begin at lights.
    begins_at_lights: bool,
    parts: Parts,
    refusals: Vec<Refusal>,
}

impl Flattener<'_> {
    /// Refuses something; each kind of thing once.
    fn refuse(&mut self, what: impl Into<String>, span: Span) {
        let what = what.into();
        if self.refusals.iter().all(|known| known.what != what) {
            self.refusals.push(Refusal { what, span });
        }
    }

    /// Refuses what concerns the whole picture.
    fn check(&mut self, film: &Film, algorithm: &Algorithm) {
        let Traits { media, bodies: _, light_paths, splats: _ } = algorithm.traits();
        let whole = [
            (!media && has_media(self.scene), "participating media or interfaces"),
            (film.layers().has_parts(), "layers of parts of the light"),
            (film.layers() != LayerSet::NONE && light_paths, "layers beside the colour with light paths"),
        ];
        for (is, what) in whole {
            if is {
                self.refuse(what, Span::NONE);
            }
        }
    }

    fn bvh(&mut self, algorithm: &Algorithm, ray_queries: bool) -> Bvh {
        // Shadow rays of paths that do not know media pass interfaces as they pass holes.
        let has_open_interfaces = matches!(algorithm, Algorithm::Path(_));
        let is_open = |entry: &GeometryEntry| has_open_interfaces && is_interface(self.scene, entry);
        self.parts.holes |= self.scene.geometries().iter().any(is_open);
        let is_marked = |id: GeometryId| {
            let entry = &self.scene.geometries()[id.0 as usize];
            entry.alpha.is_some() || entry.single_sided || is_open(entry)
        };
        let world = self.scene.world();
        let for_queries = if ray_queries { Bvh::for_ray_queries(world, &is_marked) } else { None };
        self.parts.ray_queries = for_queries.is_some();
        let error = match for_queries.map_or_else(|| Bvh::new(world, &is_marked), Ok) {
            Ok(mut bvh) => {
                self.place_lights(&mut bvh);
                self.parts.motion = bvh.has_motion;
                if bvh.has_motion && algorithm.begins_at_lights() {
                    self.refuse("light paths among shapes that move", Span::NONE);
                }
                return bvh;
            }
            Err(error) => error,
        };
        let (what, span) = match error {
            BvhError::Shape(id) => (self.name_of_shape(id), self.span_of_geometry(id)),
            BvhError::Nested(id) => ("as many instances within instances", self.span_of_instance(id)),
            BvhError::Unbounded(id) => ("instances of infinite planes", self.span_of_geometry(id)),
            BvhError::TooLarge => ("as many primitives", Span::NONE),
        };
        self.refuse(what, span);
        Bvh::default()
    }

    /// Tells instances the first light of their shapes, and lights their instances.
    fn place_lights(&mut self, bvh: &mut Bvh) {
        let is_placed = |light: &Light| matches!(light, Light::Area(area) if !area.instance.is_top());
        if self.scene.lights().rows().any(|(_, light)| is_placed(light)) {
            self.parts.placed_lights = true;
            let instances = bvh.instances.clone();
            for (path, item) in &instances {
                let firsts = path.ids().iter().map(|id| self.scene.instances()[id.0 as usize].first_light);
                bvh.set_first_light(*item, firsts.sum());
            }
            self.instances = instances.into_iter().collect();
        }
    }

    /// The name of a geometry that kernels do not intersect.
    fn name_of_shape(&self, id: GeometryId) -> &'static str {
        let shape = self.scene.world().geometry(id).shape(0);
        match shape.as_deref() {
            None => "curves whose widths are stretched",
            Some(Shape::Sphere(_)) => "shape `sphere`",
            Some(Shape::Cylinder(_)) => "shape `cylinder`",
            Some(Shape::Cone(_)) => "shape `cone`",
            Some(Shape::Paraboloid(_)) => "shape `paraboloid`",
            Some(Shape::Hyperboloid(_)) => "shape `hyperboloid`",
            Some(Shape::Disk(_)) => "shape `disk`",
            Some(Shape::Plane(_)) => "shape `plane`",
            Some(Shape::Implicit(_)) => "shape `implicit`",
            Some(Shape::Solid(_)) => "shape `csg`",
            Some(Shape::BilinearPatch(_)) => "bilinear patches with normals or texture coordinates",
            Some(Shape::Triangle(_)) => "shape `trianglemesh`",
            Some(Shape::MovingTriangle(_)) => "meshes that change their form",
        }
    }

    fn span_of_geometry(&self, id: GeometryId) -> Span {
        self.scene.geometries()[id.0 as usize].span
    }

    fn span_of_instance(&self, id: InstanceId) -> Span {
        self.scene.instances()[id.0 as usize].span
    }
}
