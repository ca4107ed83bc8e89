//! What surfaces do with light, as numbers of vertices.

use geometry::{GeometryId, Hit, InstancePath, SurfacePoint};
use math::{RayDifferential, Vec2, Vec3};
use sampling::{Sampler, sampler::Independent, warp};
use scattering::{Bsdf, Bxdf, Directions, TransportMode};
use scene::material::Material;
use scene::{Scene, View};
use spectrum::SampledSpectrum;

use super::colors::Colors;

/// How a surface is shaded, as in `shaders/raster_surfaces.wgsl`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shading {
    /// By the light of the sky on its two sides.
    #[default]
    Diffuse,
    /// As a mirror of the sky.
    Mirror,
    /// As glass before the sky; the red of its transmittance is a quarter of its index of
    /// refraction.
    Glass,
}

/// The shares of light that a surface reflects and transmits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Paint {
    /// Reflected, by red, green and blue.
    pub reflectance: Vec3,
    /// Transmitted.
    pub transmittance: Vec3,
    /// How it is shaded.
    pub shading: Shading,
}

/// Evaluates materials.
pub struct Painter<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The view for which textures are filtered.
    pub view: &'a View,
    /// The colours.
    pub colors: &'a Colors,
}

impl Painter<'_> {
    /// Whether the surfaces of a geometry have no paint: interfaces between media.
    pub fn is_nothing(&self, geometry: GeometryId) -> bool {
        self.scene.is_all_interface(geometry)
    }

    /// Whether the paint of a geometry is evaluated at each vertex. What is not diffuse has the
    /// same one everywhere.
    pub fn varies(&self, geometry: GeometryId) -> bool {
        let (scene, textures) = (self.scene, self.scene.textures());
        let material = scene.geometries()[geometry.0 as usize].material;
        match &scene.materials()[material.0 as usize].material {
            Material::Diffuse(m) => !textures.is_constant(m.reflectance),
            Material::DiffuseTransmission(m) => {
                !(textures.is_constant(m.reflectance) && textures.is_constant(m.transmittance))
            }
            Material::Mix(_) => true,
            Material::Conductor(_)
            | Material::Dielectric(_)
            | Material::ThinDielectric(_)
            | Material::CoatedDiffuse(_)
            | Material::CoatedConductor(_)
            | Material::OpenPbr(_)
            | Material::Interface
            | Material::Hair(_)
            | Material::Measured(_)
            | Material::Subsurface(_) => false,
        }
    }

    /// The paint at a point of a primitive, given by its parameters.
    pub fn at(&self, geometry: GeometryId, primitive: u32, uv: Vec2) -> Paint {
        let world = self.scene.world();
        let time = self.view.camera.sample_time(0.5);
        let surface = world.surface_at(geometry, primitive, InstancePath::TOP, uv, time);
        surface.map_or_else(Paint::default, |surface| {
            let hit = Hit { t: 1.0, uv, geometry, primitive, instance: InstancePath::TOP };
            self.of(&hit, surface)
        })
    }

    /// The paint of a hit.
    pub fn of(&self, hit: &Hit, surface: SurfacePoint) -> Paint {
        let ray = RayDifferential::from(surface.spawn_ray(surface.n));
        let mut interaction = self.scene.interaction(hit, surface);
        let mut shading = Shading::Diffuse;
        let mut index = 1.0;
        // Only used by scenes that force diffuse surfaces.
        let mut sampler = Sampler::Independent(Independent::new(1, 0));
        let mut shares = |i: usize| {
            self.colors.factor(|lambda| {
                let bsdf = self.scene.bsdf(self.view, &mut interaction, &ray, lambda, &mut sampler);
                let Some(bsdf) = bsdf else { return SampledSpectrum::ZERO };
                match &bsdf.bxdf {
                    Bxdf::Diffuse(bxdf) => [bxdf.reflectance, SampledSpectrum::ZERO][i],
                    Bxdf::DiffuseTransmission(bxdf) => [bxdf.reflectance, bxdf.transmittance][i],
                    Bxdf::Dielectric(bxdf) => {
                        (shading, index) = (Shading::Glass, bxdf.eta);
                        SampledSpectrum::splat(1.0)
                    }
                    Bxdf::ThinDielectric(_) => {
                        shading = Shading::Glass;
                        SampledSpectrum::splat(1.0)
                    }
                    Bxdf::Conductor(_) | Bxdf::CoatedConductor(_) => {
                        shading = Shading::Mirror;
                        albedo(&bsdf)[i]
                    }
                    Bxdf::CoatedDiffuse(_)
                    | Bxdf::OpenPbr(_)
                    | Bxdf::Hair(_)
                    | Bxdf::Measured(_)
                    | Bxdf::Subsurface(_)
                    | Bxdf::NormalizedFresnel(_) => albedo(&bsdf)[i],
                }
            })
        };
        let (reflectance, transmittance) = (shares(0), shares(1));
        let transmittance = if shading == Shading::Glass { Vec3::splat(0.25 * index) } else { transmittance };
        Paint { reflectance, transmittance, shading }
    }
}

/// The mean shares that are reflected and transmitted, by fixed samples.
fn albedo(bsdf: &Bsdf<Bxdf>) -> [SampledSpectrum; 2] {
    const STRATA: usize = 4;
    let mut shares = [SampledSpectrum::ZERO; 2];
    for i in 0..STRATA * STRATA {
        let place = |i: usize| ((i % STRATA) as f32 + 0.5) / STRATA as f32;
        let (x, y) = (i % STRATA, i / STRATA);
        let wo = bsdf.frame.from_local(warp::sample_cosine_hemisphere(Vec2::new(place(x), place(y))));
        let (uc, u) = (place(x + y), Vec2::new(place(x + 2 * y), place(2 * x + y)));
        let Some(sample) = bsdf.sample_f(wo, uc, u, TransportMode::Radiance, Directions::All) else {
            continue;
        };
        let cos_theta = bsdf.render_to_local(sample.wi).z;
        shares[usize::from(cos_theta < 0.0)] += sample.f * (cos_theta.abs() / sample.pdf);
    }
    shares.map(|share| share.map(|x| (x / (STRATA * STRATA) as f32).min(1.0)))
}
