//! The scene as a whole.

use std::collections::HashSet;

use crate::{
    AcceleratorDesc, AreaLightDesc, Arena, CameraDesc, FilmDesc, FilterDesc, FloatTextureDesc, ImageDesc,
    InstanceDesc, IntegratorDesc, LightDesc, MaterialDesc, MediumDesc, ObjectDesc, OptionsDesc, SamplerDesc,
    ShapeDesc, SpectrumTextureDesc, Stated,
};

/// The complete description of a scene. The default is a valid empty scene with the format's
/// default camera, film and algorithm.
///
/// ```
/// use alhazen_description::{InfiniteRadiance, LightKind, MaterialKind, SceneDesc, ShapeDesc};
/// use alhazen_description::{ShapeKind, SpectrumDesc};
///
/// let mut desc = SceneDesc::default();
/// let reflectance = SpectrumDesc::rgb(0.6, 0.1, 0.1).into();
/// let red = desc.materials.push(MaterialKind::Diffuse { reflectance }.into());
/// let sphere = ShapeKind::Sphere { radius: 1.0, z_min: -1.0, z_max: 1.0, phi_max: 360.0 };
/// desc.shapes.push(ShapeDesc { material: Some(red), ..sphere.into() });
/// let radiance = InfiniteRadiance::Constant(SpectrumDesc::Constant(1.0));
/// desc.lights.push(LightKind::Infinite { radiance, illuminance: None, portal: None }.into());
/// ```
#[derive(Clone, Debug, Default)]
pub struct SceneDesc {
    /// Options of the renderer.
    pub options: Stated<OptionsDesc>,
    /// The film.
    pub film: Stated<FilmDesc>,
    /// The camera.
    pub camera: Stated<CameraDesc>,
    /// The pixel filter.
    pub filter: Stated<FilterDesc>,
    /// The sampler.
    pub sampler: Stated<SamplerDesc>,
    /// The light transport algorithm.
    pub integrator: Stated<IntegratorDesc>,
    /// The acceleration structure.
    pub accelerator: Stated<AcceleratorDesc>,
    /// Decoded images, each file once.
    pub images: Arena<ImageDesc>,
    /// Textures of numbers. A texture refers only to textures before it.
    pub float_textures: Arena<FloatTextureDesc>,
    /// Textures of spectra. A texture refers only to textures before it.
    pub spectrum_textures: Arena<SpectrumTextureDesc>,
    /// Materials. A `Mix` may refer to any other material, but not to itself, directly or
    /// indirectly.
    pub materials: Arena<MaterialDesc>,
    /// Participating media.
    pub media: Arena<MediumDesc>,
    /// Lights that are not surfaces.
    pub lights: Arena<LightDesc>,
    /// Emission of surfaces.
    pub area_lights: Arena<AreaLightDesc>,
    /// Shapes of the world.
    pub shapes: Arena<ShapeDesc>,
    /// Objects for instances.
    pub objects: Arena<ObjectDesc>,
    /// Instances of objects.
    pub instances: Arena<InstanceDesc>,
}

impl SceneDesc {
    /// The group of lights without one, and of all other light.
    pub const DEFAULT_LIGHT_GROUP: &str = "default";

    /// The names of the groups of lights: first [`Self::DEFAULT_LIGHT_GROUP`], then the others in
    /// their order.
    pub fn light_groups(&self) -> Vec<&str> {
        let lights = self.lights.iter().map(|(_, light)| &light.group);
        let groups = lights.chain(self.area_lights.iter().map(|(_, light)| &light.group));
        let (mut names, mut known) = (vec![Self::DEFAULT_LIGHT_GROUP], HashSet::new());
        known.insert(Self::DEFAULT_LIGHT_GROUP);
        names.extend(groups.flatten().map(String::as_str).filter(|name| known.insert(name)));
        names
    }

    /// Samples per pixel, those for which the sampler arranges its points or the algorithm's own.
    pub fn samples_per_pixel(&self) -> u32 {
        self.integrator.samples_per_pixel(&self.sampler.kind)
    }

    /// Sets the samples per pixel of the sampler and of an algorithm with samples of its own.
    pub fn set_samples_per_pixel(&mut self, samples: u32) {
        self.sampler.kind.set_samples_per_pixel(samples);
        self.integrator.set_samples_per_pixel(samples);
    }

    /// Whether the picture of the scene without light is black.
    pub fn needs_light(&self) -> bool {
        !self.integrator.facts().needs_no_light
    }

    /// The same settings, with nothing in the world.
    pub fn settings(&self) -> Self {
        Self {
            options: self.options.clone(),
            film: self.film.clone(),
            camera: self.camera.clone(),
            filter: self.filter.clone(),
            sampler: self.sampler.clone(),
            integrator: self.integrator.clone(),
            accelerator: self.accelerator.clone(),
            ..Self::default()
        }
    }

    /// The same without shapes, objects and instances: all that film, camera and algorithm depend
    /// on.
    pub fn without_geometry(&self) -> Self {
        Self {
            images: self.images.clone(),
            float_textures: self.float_textures.clone(),
            spectrum_textures: self.spectrum_textures.clone(),
            materials: self.materials.clone(),
            media: self.media.clone(),
            lights: self.lights.clone(),
            area_lights: self.area_lights.clone(),
            ..self.settings()
        }
    }
}
