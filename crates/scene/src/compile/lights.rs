//! Lights without a surface.

use super::Compiler;
use super::emission::upward_illuminance;
use super::media::medium_id;
use crate::light::{
    DistantLight, Emission, EmissionImage, GoniometricLight, ImageInfiniteLight, Light, PointLight, Portal,
    PortalInfiniteLight, PortalRadiance, ProjectionLight, RectifiedImage, SceneSphere, Slide, SpotLight,
    UniformInfiniteLight,
};
use crate::medium::MediumId;
use description::{
    Handle, ImageDesc, InfiniteRadiance, LightDesc, LightKind, Origin, Span, SpectrumDesc, Stated,
};
use image::{Image, Projection, require_memory};
use math::{AnimatedTransform, DMat4, Point3, Transform, Vec3, Vector3};
use spectrum::Rgb;
use std::f32::consts::PI;

/// An image of the sphere, and the factor on its colours.
struct Sky {
    image: EmissionImage,
    projection: Projection,
    scale: f32,
}

fn seen_through(portal: Portal, radiance: PortalRadiance) -> Light {
    Light::PortalInfinite(Box::new(PortalInfiniteLight::new(portal, radiance)))
}

impl Compiler<'_> {
    /// Compiles all lights without a surface, each with its medium and the index of its group.
    /// `scene` bounds all surfaces.
    pub(super) fn lights(
        &mut self,
        scene: SceneSphere,
        group: impl Fn(&Option<String>) -> u32,
    ) -> Vec<(Light, Option<MediumId>, u32, Span)> {
        let desc = self.desc;
        let lights = desc.lights.iter();
        let compile = |(_, desc): (_, &Stated<LightDesc>)| {
            let light = self.light(&desc.value, &desc.origin, scene)?;
            Some((light, medium_id(desc.medium), group(&desc.group), desc.origin.span))
        };
        lights.filter_map(compile).collect()
    }

    fn light(&mut self, desc: &LightDesc, origin: &Origin, scene: SceneSphere) -> Option<Light> {
        self.traits.is_lit_from_infinity |= desc.kind.is_distant();
        self.check_factors(desc, origin);
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
                let cos_falloff_end = lanes::cos(cone_angle.to_radians());
                let cos_falloff_start =
                    lanes::cos((cone_angle - cone_delta_angle).to_radians()).max(cos_falloff_end);
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
                let portal = match portal {
                    Some(corners) => Some(self.portal(*corners, &render_from_light, origin)?),
                    None => None,
                };
                match radiance {
                    InfiniteRadiance::Constant(spectrum) => {
                        let mut radiance = self.emission(spectrum, desc.scale, origin.parameter("L"));
                        radiance.scale *= illuminance.map_or(1.0, |target| target / PI);
                        match portal {
                            None => Light::UniformInfinite(UniformInfiniteLight { radiance, scene }),
                            Some(portal) => seen_through(portal, PortalRadiance::Constant(radiance)),
                        }
                    }
                    InfiniteRadiance::Image(handle) => {
                        let sky = self.sky(*handle, desc.scale, *illuminance, origin)?;
                        self.environment(sky, portal, render_from_light, scene, origin)?
                    }
                }
            }
            LightKind::Goniometric { intensity, power, image: None } => {
                let intensity = self.intensity(intensity, desc.scale, *power, 4.0 * PI, origin);
                Light::Point(PointLight { p: place(Vec3::ZERO), motion, intensity })
            }
            LightKind::Goniometric { intensity, power, image: Some(handle) } => {
                let emission = self.intensity(intensity, desc.scale, *power, 4.0 * PI, origin);
                self.goniometric(emission, power.is_some(), *handle, render_from_light, origin)?
            }
            LightKind::Projection { image: None, .. } => return None,
            LightKind::Projection { image: Some(image), power, fov } => {
                self.projection(*image, *fov, desc.scale, *power, render_from_light, origin)?
            }
        })
    }

    /// Checks the factors on the brightness of a light.
    fn check_factors(&mut self, desc: &LightDesc, origin: &Origin) {
        let (power, illuminance) = match desc.kind {
            LightKind::Point { power, .. }
            | LightKind::Spot { power, .. }
            | LightKind::Goniometric { power, .. }
            | LightKind::Projection { power, .. } => (power, None),
            LightKind::Distant { illuminance, .. } | LightKind::Infinite { illuminance, .. } => {
                (None, illuminance)
            }
        };
        let factors = [("scale", Some(desc.scale)), ("power", power), ("illuminance", illuminance)];
        self.check_brightness(origin, &factors);
    }

    /// The light of a projector with an image, whose field of view is `fov` degrees.
    fn projection(
        &mut self,
        image: Handle<ImageDesc>,
        fov: f32,
        scale: f32,
        power: Option<f32>,
        render_from_light: AnimatedTransform,
        origin: &Origin,
    ) -> Option<Light> {
        let (image, mut scale) = self.emission_image(image, scale, origin.parameter("filename"))?;
        self.allow(&image.image, ProjectionLight::BYTES_PER_PIXEL, origin)?;
        let slide = Slide::new(image, fov);
        if let Some(power) = power {
            let luminance = slide.image.luminance(slide.total());
            scale *= power / self.nonzero(luminance, origin)?;
        }
        Some(Light::Projection(Box::new(ProjectionLight::new(render_from_light, slide, scale))))
    }

    /// The light of an image of the sphere, as far as a portal shows it.
    fn environment(
        &mut self,
        Sky { image, projection, scale }: Sky,
        portal: Option<Portal>,
        render_from_light: AnimatedTransform,
        scene: SceneSphere,
        origin: &Origin,
    ) -> Option<Light> {
        let Some(portal) = portal else {
            self.allow(&image.image, ImageInfiniteLight::BYTES_PER_PIXEL, origin)?;
            let EmissionImage { image, color_space, .. } = image;
            let light =
                ImageInfiniteLight::new(render_from_light, image, projection, color_space, scale, scene);
            return Some(Light::ImageInfinite(Box::new(light)));
        };
        self.allow(&image.image, RectifiedImage::BYTES_PER_PIXEL, origin)?;
        let light_from_render = render_from_light.start().inverse();
        let image = RectifiedImage::new(&portal, &image, projection, &light_from_render, scale);
        Some(seen_through(portal, PortalRadiance::Image(image)))
    }

    /// The portal of these corners in world space.
    fn portal(
        &mut self,
        corners: [Point3; 4],
        render_from_light: &AnimatedTransform,
        origin: &Origin,
    ) -> Option<Portal> {
        if render_from_light.is_moving() {
            let message = "the light behind a portal does not move; drawn as at the start of motion";
            self.warn("not-drawn", message, origin.span);
        }
        let to_render =
            |p: Point3| Vec3::from(self.render_from_world.transform_point3(p.as_dvec3()).as_vec3());
        let portal = Portal::new(corners.map(to_render));
        if portal.is_none() {
            let message = "the four points of `portal` must be the corners of a rectangle, in their order";
            self.error("invalid-value", message, origin.parameter("portal"));
        }
        portal
    }

    /// The light of an intensity that is scaled by an image. With a power, the mean intensity is
    /// given, else that of a pixel value of 1.
    fn goniometric(
        &mut self,
        mut intensity: Emission,
        has_power: bool,
        handle: Handle<ImageDesc>,
        render_from_light: AnimatedTransform,
        origin: &Origin,
    ) -> Option<Light> {
        let span = origin.parameter("filename");
        let image = self.finite_image(handle, span)?;
        let (width, height) = (image.width(), image.height());
        if width != height {
            let message = format!(
                "the image of a goniometric light is square (equal-area octahedral), not {width} × {height}"
            );
            self.error("image-shape", message, span);
            return None;
        }
        self.allow(&image, GoniometricLight::BYTES_PER_PIXEL, origin)?;
        let value = |i: u32| Rgb::from(image.rgb(i % width, i / width)).average().max(0.0);
        let pixels: Vec<f32> = (0..width * width).map(value).collect();
        let mean = pixels.iter().map(|&v| f64::from(v)).sum::<f64>() / pixels.len() as f64;
        if has_power {
            self.nonzero(mean as f32, origin)?;
        } else {
            intensity.scale *= mean as f32;
        }
        let light = GoniometricLight::new(render_from_light, intensity, &pixels, width as usize);
        Some(Light::Goniometric(Box::new(light)))
    }

    /// The brightness of an image that is scaled to a power; an error if it is black.
    fn nonzero(&mut self, brightness: f32, origin: &Origin) -> Option<f32> {
        if brightness <= 0.0 {
            let message = "a black image cannot be scaled to a power";
            self.error("image-values", message, origin.parameter("filename"));
        }
        (brightness > 0.0).then_some(brightness)
    }

    /// Reports a lack of memory for the tables of an image, so many bytes for each of its pixels.
    fn allow(&mut self, image: &Image, bytes: usize, origin: &Origin) -> Option<()> {
        let result = require_memory(image.width() as usize * image.height() as usize * bytes);
        if let Err(error) = &result {
            self.error("image-file", error.to_string(), origin.parameter("filename"));
        }
        result.ok()
    }

    fn sky(
        &mut self,
        handle: Handle<ImageDesc>,
        scale: f32,
        illuminance: Option<f32>,
        origin: &Origin,
    ) -> Option<Sky> {
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
        Some(Sky { image, projection, scale })
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
