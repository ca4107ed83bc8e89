//! Lights without a surface.

use super::Compiler;
use super::emission::upward_illuminance;
use crate::light::{
    DistantLight, Emission, ImageInfiniteLight, Light, PointLight, SceneSphere, SpotLight,
    UniformInfiniteLight,
};
use description::{Handle, ImageDesc, InfiniteRadiance, LightDesc, LightKind, Origin, SpectrumDesc};
use image::{Projection, require_memory};
use math::{AnimatedTransform, DMat4, Point3, Transform, Vec3, Vector3};
use std::f32::consts::PI;

impl Compiler<'_> {
    /// Compiles all lights without a surface. `scene` bounds all surfaces.
    pub(super) fn lights(&mut self, scene: SceneSphere) -> Vec<Light> {
        let desc = self.desc;
        let lights = desc.lights.iter();
        lights.filter_map(|(_, light)| self.light(&light.value, &light.origin, scene)).collect()
    }

    fn light(&mut self, desc: &LightDesc, origin: &Origin, scene: SceneSphere) -> Option<Light> {
        let (power, illuminance) = match desc.kind {
            LightKind::Point { power, .. }
            | LightKind::Spot { power, .. }
            | LightKind::Goniometric { power, .. }
            | LightKind::Projection { power, .. } => (power, None),
            LightKind::Distant { illuminance, .. } | LightKind::Infinite { illuminance, .. } => {
                (None, illuminance)
            }
        };
        self.traits.is_lit_from_infinity |= desc.kind.is_distant();
        let factors = [("scale", Some(desc.scale)), ("power", power), ("illuminance", illuminance)];
        self.check_brightness(origin, &factors);
        let Some(render_from_light) = self.motion(&desc.world_from_light) else {
            self.singular("light", origin);
            return None;
        };
        // Moving lights keep their own space; they are transformed to render space at each shutter
        // time.
        let motion = render_from_light.is_moving().then(|| Box::new(render_from_light.clone()));
        let at_rest = match motion {
            Some(_) => DMat4::IDENTITY,
            None => self.render_from_world * desc.world_from_light.start,
        };
        let placement = Transform::from_f64(at_rest)?;
        let place = |p: Point3| at_rest.transform_point3(p.as_dvec3()).as_vec3().into();
        Some(match &desc.kind {
            LightKind::Point { intensity, power, from } => {
                let intensity = self.intensity(intensity, desc.scale, *power, 4.0 * PI, origin);
                Light::Point(PointLight { p: place(*from), motion, intensity })
            }
            LightKind::Spot { intensity, power, from, to, cone_angle, cone_delta_angle } => {
                let cos_falloff_end = cone_angle.to_radians().cos();
                let cos_falloff_start =
                    (cone_angle - cone_delta_angle).to_radians().cos().max(cos_falloff_end);
                let unit = SpotLight::effective_solid_angle(cos_falloff_start, cos_falloff_end);
                let intensity = self.intensity(intensity, desc.scale, *power, unit, origin);
                let axis = self.direction(&placement, *to - *from, origin)?;
                Light::Spot(SpotLight {
                    p: place(*from),
                    axis,
                    motion,
                    intensity,
                    cos_falloff_start,
                    cos_falloff_end,
                })
            }
            LightKind::Distant { radiance, illuminance, from, to } => {
                let mut radiance = self.emission(radiance, desc.scale, origin.parameter("L"));
                radiance.scale *= illuminance.unwrap_or(1.0);
                let w = self.direction(&placement, *from - *to, origin)?;
                Light::Distant(DistantLight { w, motion, radiance, scene })
            }
            LightKind::Infinite { radiance, illuminance, portal } => {
                if portal.is_some() {
                    let message = "portals are not drawn yet; light comes from everywhere";
                    self.warn("not-drawn", message, origin.parameter("portal"));
                }
                match radiance {
                    InfiniteRadiance::Constant(spectrum) => {
                        let mut radiance = self.emission(spectrum, desc.scale, origin.parameter("L"));
                        radiance.scale *= illuminance.map_or(1.0, |target| target / PI);
                        Light::UniformInfinite(UniformInfiniteLight { radiance, scene })
                    }
                    InfiniteRadiance::Image(handle) => {
                        self.sky(*handle, desc.scale, *illuminance, render_from_light, scene, origin)?
                    }
                }
            }
            LightKind::Goniometric { intensity, power, .. } => {
                self.warn("not-drawn", "light `goniometric` is not drawn yet; drawn as `point`", origin.span);
                let intensity = self.intensity(intensity, desc.scale, *power, 4.0 * PI, origin);
                Light::Point(PointLight { p: place(Vec3::ZERO), motion, intensity })
            }
            LightKind::Projection { .. } => {
                self.warn("not-drawn", "light `projection` is not drawn yet; left out", origin.span);
                return None;
            }
        })
    }

    fn sky(
        &mut self,
        handle: Handle<ImageDesc>,
        scale: f32,
        illuminance: Option<f32>,
        render_from_light: AnimatedTransform,
        scene: SceneSphere,
        origin: &Origin,
    ) -> Option<Light> {
        let span = origin.parameter("filename");
        let (image, mut scale) = self.emission_image(handle, scale, span)?;
        let (width, height) = (image.image.width(), image.image.height());
        let Some(projection) = Projection::of_size(width, height) else {
            let message = format!(
                "the image of an infinite light is square (equal-area octahedral) or twice as wide as high (latitude–longitude), not {width} × {height}"
            );
            self.error("image-shape", message, span);
            return None;
        };
        if let Some(target) = illuminance {
            let illuminance = upward_illuminance(&image, projection);
            if illuminance <= 0.0 {
                let message = "an image that is black above cannot be scaled to an illuminance";
                self.error("image-values", message, span);
                return None;
            }
            scale *= target / illuminance;
        }
        let bytes = ImageInfiniteLight::BYTES_PER_PIXEL * width as usize * height as usize;
        if let Err(error) = require_memory(bytes) {
            self.error("image-file", error.to_string(), span);
            return None;
        }
        let pixels = (image.image, projection);
        let light = ImageInfiniteLight::new(render_from_light, pixels, image.color_space, scale, scene);
        Some(Light::ImageInfinite(Box::new(light)))
    }

    /// Radiant intensity. `power`, if given, is emitted into `unit` steradians.
    fn intensity(
        &mut self,
        spectrum: &SpectrumDesc,
        scale: f32,
        power: Option<f32>,
        unit: f32,
        origin: &Origin,
    ) -> Emission {
        let mut intensity = self.emission(spectrum, scale, origin.parameter("I"));
        intensity.scale *= power.map_or(1.0, |power| power / unit);
        intensity
    }

    fn direction(&mut self, placement: &Transform, v: Vector3, origin: &Origin) -> Option<Vector3> {
        let direction = placement.vector(v).try_normalize();
        if direction.is_none() {
            let message = "`from` and `to` must differ: they give the direction";
            self.error("invalid-value", message, origin.parameter("to"));
        }
        direction
    }
}
