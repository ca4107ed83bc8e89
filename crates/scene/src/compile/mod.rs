//! Compiles a description to a [`Scene`]. Scenes are assembled only here.
//!
//! All errors are reported at once, with their spans. A feature that is not supported yet is a
//! warning that names its replacement.

mod area_lights;
mod curves;
mod emission;
mod lights;
mod materials;
pub(crate) mod media;
mod objects;
mod shapes;
mod solids;
mod spheres;
mod subsurface;
mod tessellation;

use crate::cache::SceneCache;
use crate::light::{AreaEmission, EmissionId, LightTable, SceneSphere};
use crate::material::MaterialEntry;
use crate::medium::Medium;
use crate::names::Names;
use crate::scene::{GeometryEntry, InstanceEntry, Scene};
use crate::texture::{FloatTextureId, SpectrumTextureId, SpectrumType, TextureCompiler};
use crate::traits::SceneTraits;
use crate::view::world_from_render;
use area_lights::Emitters;
use description::{
    AcceleratorDesc, Arena, BuildQualityDesc, Diagnostic, FloatParameter, InstanceDesc, ObjectDesc,
    SceneDesc, ShapeDesc, Span, SpectrumDesc, SpectrumParameter,
};
use geometry::{BuildQuality, GeometryId, World, WorldBuilder};
use math::DMat4;
use scattering::BssrdfTable;
use spectrum::Spectrum;
use std::mem::take;
use std::sync::Arc;

/// A scene, and the warnings of its compilation.
#[derive(Debug)]
pub struct Compiled {
    /// The scene.
    pub scene: Scene,
    /// Warnings about what is rendered differently than described.
    pub warnings: Vec<Diagnostic>,
}

/// Compiles a description, apart from camera, film, sampler and integrator. Its camera determines
/// render space ([`world_from_render`]). Returns all errors and warnings if there is an error.
///
/// The scene reuses arrays of shapes that are unchanged. The others are dropped before BVHs are
/// built, unless the caller keeps another reference to them.
pub fn compile(mut desc: SceneDesc) -> Result<Compiled, Vec<Diagnostic>> {
    let mut diagnostics = Vec::new();
    let world_from_render = world_from_render(&desc);
    let render_from_world = world_from_render.inverse();
    let textures = TextureCompiler::new(&desc, &render_from_world, &mut diagnostics);
    let names = Names::new(&desc);
    let traits = SceneTraits { is_moving: is_moving(&desc), ..SceneTraits::default() };
    let (shapes, instances) = (take(&mut desc.shapes), take(&mut desc.instances));
    let objects = Arc::new(take(&mut desc.objects));
    let mut compiler = Compiler {
        desc: &desc,
        objects,
        render_from_world,
        diagnostics,
        textures,
        world: World::builder()
            .quality(match desc.accelerator.quality() {
                BuildQualityDesc::Fast => BuildQuality::Fast,
                BuildQualityDesc::Balanced => BuildQuality::Balanced,
                BuildQualityDesc::High => BuildQuality::High,
            })
            .extents(*desc.accelerator != AcceleratorDesc::None),
        primitives: 0,
        entries: Vec::new(),
        names,
        instances: Vec::new(),
        materials: Vec::new(),
        bssrdf_tables: Vec::new(),
        media: Vec::new(),
        area_emissions: Vec::new(),
        material_emissions: Vec::new(),
        last_spectrum: None,
        emitters: vec![Emitters::default()],
        traits,
    };
    compiler.materials();
    compiler.media();
    compiler.area_emissions();
    compiler.shapes(&shapes);
    compiler.instances(&instances);
    compiler.material_traits();
    drop((shapes, instances, take(&mut compiler.objects)));
    let world = take(&mut compiler.world).build();
    let sphere = SceneSphere::around(&world.bounds());
    let lights = compiler.light_table(&world, sphere);
    if !compiler.diagnostics.iter().any(Diagnostic::is_error) {
        compiler.warn_of_darkness(&lights);
    }
    let Compiler { diagnostics, textures, entries, names, instances, materials, media, mut traits, .. } =
        compiler;
    if diagnostics.iter().any(Diagnostic::is_error) {
        return Err(diagnostics);
    }
    traits.is_moving |= (0..entries.len() as u32).any(|id| world.geometry(GeometryId(id)).is_moving());
    let textures = textures.finish();
    let has_bump_maps = materials.iter().any(|entry| entry.bump_map.is_some());
    let uses_footprints = textures.are_filtered() || has_bump_maps;
    let scene = Scene {
        world_from_render,
        world,
        sphere,
        entries,
        instances,
        materials,
        media,
        textures,
        lights,
        uses_footprints,
        names,
        traits,
        cache: SceneCache::default(),
    };
    Ok(Compiled { scene, warnings: diagnostics })
}

/// Whether any shape, instance, medium or light moves as a whole.
fn is_moving(desc: &SceneDesc) -> bool {
    let moves_in = |shapes: &Arena<ShapeDesc>, instances: &Arena<InstanceDesc>| {
        shapes.iter().any(|(_, shape)| shape.world_from_object.is_animated())
            || instances.iter().any(|(_, instance)| instance.world_from_object.is_animated())
    };
    moves_in(&desc.shapes, &desc.instances)
        || desc.objects.iter().any(|(_, object)| moves_in(&object.shapes, &object.instances))
        || desc.media.iter().any(|(_, medium)| medium.world_from_medium.is_animated())
        || desc.lights.iter().any(|(_, light)| light.world_from_light.is_animated())
}

/// A scene under construction.
struct Compiler<'a> {
    /// The description without shapes, objects and instances.
    desc: &'a SceneDesc,
    objects: Arc<Arena<ObjectDesc>>,
    render_from_world: DMat4,
    diagnostics: Vec<Diagnostic>,
    textures: TextureCompiler,
    world: WorldBuilder,
    /// The number of primitives in `world`.
    primitives: usize,
    entries: Vec<GeometryEntry>,
    names: Names,
    materials: Vec<MaterialEntry>,
    /// By asymmetry and index of refraction.
    bssrdf_tables: Vec<([f32; 2], Arc<BssrdfTable>)>,
    media: Vec<Medium>,
    instances: Vec<InstanceEntry>,
    area_emissions: Vec<Option<AreaEmission>>,
    /// What shapes emit by their material.
    material_emissions: Vec<Option<EmissionId>>,
    /// The last light's spectrum, which lights of the same description share.
    last_spectrum: Option<(SpectrumDesc, Spectrum, f32)>,
    /// Indexed by group of the world.
    emitters: Vec<Emitters>,
    traits: SceneTraits,
}

impl Compiler<'_> {
    fn error(&mut self, code: &'static str, message: impl Into<String>, span: Span) {
        self.diagnostics.push(Diagnostic::error(code, message, span));
    }

    fn warn(&mut self, code: &'static str, message: impl Into<String>, span: Span) {
        self.diagnostics.push(Diagnostic::warning(code, message, span));
    }

    /// Warns if the picture will be black.
    fn warn_of_darkness(&mut self, lights: &LightTable) {
        if self.entries.is_empty() && lights.infinite().is_empty() {
            let message = "the scene has neither shapes nor an infinite light; the picture is black";
            self.warn("empty-scene", message, Span::NONE);
        } else if lights.is_empty() && self.desc.needs_light() {
            self.warn("no-light", "the scene has no light; the picture is black", Span::NONE);
        }
    }

    fn float_texture(&mut self, parameter: &FloatParameter, span: Span) -> FloatTextureId {
        self.textures.float_parameter(parameter, span, &mut self.diagnostics)
    }

    fn spectrum_texture(
        &mut self,
        parameter: &SpectrumParameter,
        spectrum_type: SpectrumType,
        span: Span,
    ) -> SpectrumTextureId {
        self.textures.spectrum_parameter(parameter, spectrum_type, span, &mut self.diagnostics)
    }
}
