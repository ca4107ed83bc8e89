//! Lights: the kind, the offset of the spectrum, its scale, 1 where both sides emit plus 2 where no
//! ray hits the surface plus four times the offset of what else a surface has, and numbers. A light
//! without a surface has there four times the offset of its motion, or 0 where it is at rest; one
//! that moves has its position and direction in its own space. A vector is four words, of which the
//! last is the number that follows it in brackets, or 0.
//!
//! | kind | numbers |
//! |---|---|
//! | point | position |
//! | spot | position, axis, cosines of the start and of the end of the falloff |
//! | distant | direction |
//! | triangle, rectangle | corner, sides, normal, and of a triangle with an image or holes the texture coordinates at its corners |
//! | sphere | centre (radius), the rows of the rotation from object to render space (the first: 1 or −1 where the outside is inside) |
//! | uniform infinite | none |
//! | disk, cylinder, part of a sphere | the rows of the matrix from object to render space (translation), the numbers of the shape, 1 or −1 where the outside is inside, area in object space |
//! | image infinite | width, height, projection, offset of the distribution of positions, the rows of the rotation to the light and of its inverse, offset of pixels, offset of the distribution where sampling may be incomplete |
//! | goniometric | position, the rows of the matrix to the light's space and of its inverse, offset of the distribution of directions |
//! | projection | the same with the distribution of positions, width, height, offset of pixels, least and largest coordinates of the screen |
//! | infinite behind a portal | those that `portals.rs` describes |
//! | patch | corner, sides, twist, area elements at the corners, 1 or −1 where the outside is inside, offset of the distribution of its points or 0 |
//! | surface in an instance | the offset of its record in the instance's space, the item of the instance |
//!
//! Of the record of a surface that is in an instance only kind and numbers count. What else a
//! surface has is the image of its emission, the colour space of that, and the texture of its
//! alpha, each an offset or 0. The spectrum of an image is its illuminant; a pixel is the scale and
//! the coefficients of an RGB spectrum. The image of a surface is one over (u, v).

use std::f32::consts::TAU;

use description::Span;
use geometry::{PlainShape, RevolvedKind, Shape};
use image::{Image, Projection};
use math::{AnimatedTransform, DVec3};
use scene::light::{
    AreaEmission, AreaLight, DistantLight, Emission, EmissionImage, ImageInfiniteLight, Light, LightRef,
    PointLight, ProjectionLight, SpotLight, UniformInfiniteLight,
};
use spectrum::{RgbColorSpace, RgbUnboundedSpectrum};

use super::Flattener;
use super::cameras::interpolated;
use super::slab::padded;
use crate::tags::{LightTag, ProjectionTag};

impl Flattener<'_> {
    /// The table of the lights' offsets, and that of infinite lights' ids; their offsets.
    pub fn lights(&mut self) -> (u32, u32) {
        let mut offsets = Vec::new();
        // All primitives of a geometry have the same spectrum, image and alpha.
        let mut shared = None;
        for light in self.scene.lights().iter() {
            offsets.push(self.light(&light, &mut shared));
        }
        let infinite: Vec<u32> = self.scene.infinite_lights().iter().map(|id| id.0).collect();
        (self.slab.add(offsets), self.slab.add(infinite))
    }

    fn light(&mut self, light: &LightRef, shared: &mut Option<[u32; 2]>) -> u32 {
        let span = light.span();
        match light.row() {
            Light::Point(PointLight { p, motion, intensity }) => {
                self.parts.point_lights = true;
                let motion = self.motion(motion.as_deref(), span);
                self.emitter(LightTag::Point, intensity, motion, &padded([p.to_array()]))
            }
            Light::Spot(SpotLight { p, axis, motion, intensity, cos_falloff_start, cos_falloff_end }) => {
                self.parts.point_lights = true;
                let motion = self.motion(motion.as_deref(), span);
                let vectors = padded([p, axis].map(|v| v.to_array()));
                let numbers = [&vectors[..], &[*cos_falloff_start, *cos_falloff_end]];
                self.emitter(LightTag::Spot, intensity, motion, &numbers.concat())
            }
            Light::Distant(DistantLight { w, motion, radiance, scene: _ }) => {
                let motion = self.motion(motion.as_deref(), span);
                self.emitter(LightTag::Distant, radiance, motion, &padded([w.to_array()]))
            }
            Light::UniformInfinite(UniformInfiniteLight { radiance, scene: _ }) => {
                self.emitter(LightTag::UniformInfinite, radiance, 0, &[])
            }
            Light::Area(area) => {
                if light.primitive() == 0 {
                    *shared = None;
                }
                self.area_light(area, light.primitive(), span, shared)
            }
            Light::ImageInfinite(l) => self.image_light(l, span),
            Light::PortalInfinite(l) => {
                if self.begins_at_lights {
                    self.refuse("light paths from infinite lights with portals", span);
                }
                self.portal(LightTag::PortalInfinite, l)
            }
            Light::Goniometric(l) => {
                self.parts.point_lights = true;
                let (transform, intensity, distribution) = l.parts();
                let (motion, distribution) =
                    (self.motion(Some(transform), span), self.distribution(distribution));
                let at = self.emitter(LightTag::Goniometric, intensity, motion, &placement(transform));
                self.slab.extend([distribution]);
                at
            }
            Light::Projection(l) => self.projection(l, span),
        }
    }

    fn no_light(&mut self, what: &str, span: Span) -> u32 {
        self.refuse(what, span);
        0
    }

    /// The offset of the motion of a light without a surface, or 0 where it is at rest.
    fn motion(&mut self, transform: Option<&AnimatedTransform>, span: Span) -> u32 {
        let Some(keys) = transform.and_then(AnimatedTransform::keys) else { return 0 };
        if self.begins_at_lights {
            self.refuse("light paths from moving lights", span);
        }
        self.parts.motion = true;
        self.slab.add_numbers(interpolated(&keys))
    }

    /// A light without a surface, with the offset of its motion.
    pub(super) fn emitter(
        &mut self,
        tag: LightTag,
        emission: &Emission,
        motion: u32,
        numbers: &[f32],
    ) -> u32 {
        let Emission { spectrum, scale } = emission;
        let at = [tag as u32, self.spectrum(spectrum), scale.to_bits(), 4 * motion];
        let at = self.slab.add(at);
        self.slab.extend_numbers(numbers.iter().copied());
        at
    }

    fn projection(&mut self, light: &ProjectionLight, span: Span) -> u32 {
        self.parts.point_lights = true;
        let (transform, slide, scale, distribution) = light.parts();
        let motion = self.motion(Some(transform), span);
        let EmissionImage { image, color_space, .. } = &slide.image;
        let pixels = self.pixels(image, color_space);
        let distribution = self.distribution(distribution);
        let spectrum = color_space.illuminant();
        let at =
            self.emitter(LightTag::Projection, &Emission { spectrum, scale }, motion, &placement(transform));
        let screen = slide.screen();
        self.slab.extend([distribution, image.width(), image.height(), pixels]);
        let corners = [screen.min, screen.max].map(|corner| corner.to_array());
        self.slab.extend_numbers(corners.into_iter().flatten());
        at
    }

    /// The pixels of an image of light, as unbounded spectra; their offset.
    fn pixels(&mut self, image: &Image, color_space: &'static RgbColorSpace) -> u32 {
        let (width, height) = (image.width(), image.height());
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| image.rgb(x, y)));
        self.slab.add_numbers(pixels.flat_map(|rgb| {
            let spectrum = RgbUnboundedSpectrum::new(color_space, rgb.map(|c| c.max(0.0)));
            let [a, b, c] = spectrum.polynomial().coefficients;
            [spectrum.scale(), a, b, c]
        }))
    }

    fn image_light(&mut self, light: &ImageInfiniteLight, span: Span) -> u32 {
        self.parts.sky_images = true;
        let motion = self.motion(Some(&light.render_from_light), span);
        let (width, height) = (light.image.width(), light.image.height());
        let pixels = self.pixels(&light.image, light.color_space);
        let [complete, incomplete] =
            [false, true].map(|allows| self.distribution(light.distribution(allows)));
        let illuminant = self.spectrum(&light.color_space.illuminant());
        let kind = match light.projection {
            Projection::EqualArea => ProjectionTag::EqualArea,
            Projection::LatitudeLongitude => ProjectionTag::LatitudeLongitude,
        };
        let scale = light.scale.to_bits();
        let words = [
            LightTag::ImageInfinite as u32,
            illuminant,
            scale,
            4 * motion,
            width,
            height,
            kind as u32,
            complete,
        ];
        let at = self.slab.add(words);
        self.slab.extend_numbers(placement(&light.render_from_light)[4..].iter().copied());
        self.slab.extend([pixels, incomplete]);
        at
    }

    fn area_light(
        &mut self,
        area: &AreaLight,
        primitive: u32,
        span: Span,
        shared: &mut Option<[u32; 2]>,
    ) -> u32 {
        self.parts.surface_lights = true;
        let AreaLight { geometry, instance, emission, alpha: _, invisible, scales } = area;
        let emission = &self.scene.emissions()[emission.0 as usize];
        let [spectrum, more] = *shared.get_or_insert_with(|| self.emission(area, emission, span));
        let scale = scales.as_ref().map_or(emission.radiance.scale, |scales| scales[primitive as usize]);
        let flags = u32::from(emission.two_sided) + 2 * u32::from(*invisible);
        let words = [spectrum, scale.to_bits(), flags + 4 * more];
        if instance.is_top() {
            return self.surface(area, primitive, words, span);
        }
        // Instances share the surface.
        let id = (geometry.0, primitive);
        let known = self.surfaces.get(&id).copied();
        let surface = known.unwrap_or_else(|| self.surface(area, primitive, [0; 3], span));
        self.surfaces.insert(id, surface);
        // There are no instances where the world is refused.
        let item = self.instances.get(instance).copied().unwrap_or(0);
        self.slab.add([LightTag::Placed as u32].into_iter().chain(words).chain([surface, item]))
    }

    /// A primitive that emits, with these words of its light; its offset.
    fn surface(&mut self, area: &AreaLight, primitive: u32, words: [u32; 3], span: Span) -> u32 {
        let shape = self.scene.world().geometry(area.geometry).shape(primitive);
        let Some(shape) = shape.as_deref() else {
            return self.no_light("area lights of this shape", span);
        };
        let (kind, mut numbers) = if let Some(flat) = shape.flat_shape() {
            let vectors = [flat.corner, flat.sides[0], flat.sides[1], flat.n];
            let kind = if flat.is_triangle { LightTag::Triangle } else { LightTag::Rectangle };
            (kind, padded(vectors.map(|v| v.to_array())))
        } else if let Some(numbers) = shape.plain().and_then(|plain| surface(&plain)) {
            self.parts.round_lights = true;
            numbers
        } else {
            return self.no_light("area lights of this shape", span);
        };
        let emission = &self.scene.emissions()[area.emission.0 as usize];
        if let Shape::Triangle(triangle) = shape
            && (emission.image.is_some() || area.alpha.is_some())
        {
            numbers.extend(triangle.uv.iter().flat_map(|uv| uv.to_array()));
        }
        let distribution = match shape {
            Shape::BilinearPatch(patch) => patch.image().map_or(0, |image| self.distribution(image)),
            _ => 0,
        };
        self.parts.emission_images |= distribution != 0;
        let at = self.slab.add([kind as u32].into_iter().chain(words));
        self.slab.extend_numbers(numbers);
        self.slab.extend([distribution]);
        at
    }

    /// The offset of the spectrum of a surface's emission, and of what else it has, or 0.
    fn emission(&mut self, area: &AreaLight, emission: &AreaEmission, span: Span) -> [u32; 2] {
        let alpha = match area.alpha.filter(|_| !area.invisible) {
            Some(alpha) => {
                self.parts.light_holes = true;
                self.number_texture(alpha, span)
            }
            None => 0,
        };
        let Some((EmissionImage { image, color_space, .. }, lookup)) = &emission.image else {
            let more = if alpha == 0 { 0 } else { self.slab.add([0, 0, alpha]) };
            return [self.spectrum(&emission.radiance.spectrum), more];
        };
        self.parts.emission_images = true;
        let image = self.uv_image(image, lookup, span);
        let space = self.color_space(color_space);
        [self.spectrum(&color_space.illuminant()), self.slab.add([image, space, alpha])]
    }
}

/// The position of a light, the rows of the matrix to its space, and those of the inverse, before
/// it moves.
fn placement(motion: &AnimatedTransform) -> Vec<f32> {
    let render_from_light = motion.start().matrix().as_dmat4();
    let rows = [render_from_light.inverse(), render_from_light]
        .map(|matrix| [0, 1, 2].map(|row| matrix.row(row).truncate().as_vec3().to_array()));
    let position = render_from_light.transform_point3(DVec3::ZERO).as_vec3().to_array();
    padded([position].into_iter().chain(rows.into_iter().flatten()))
}

/// The kind and the numbers of a patch, a sphere, a disk or a cylinder, or of a part of one; `None`
/// of other shapes.
fn surface(shape: &PlainShape) -> Option<(LightTag, Vec<f32>)> {
    let (kind, render_from_object, flips, numbers) = match *shape {
        PlainShape::Patch { corner, sides: [right, up], twist, flips } => {
            let element = |u: f32, v: f32| (right + twist * v).cross(up + twist * u).length();
            let elements = [element(0.0, 0.0), element(1.0, 0.0), element(0.0, 1.0), element(1.0, 1.0)];
            let vectors = [corner, right, up, twist].map(|vector| vector.to_array());
            let side = if flips { -1.0 } else { 1.0 };
            return Some((LightTag::Patch, [&padded(vectors)[..], &elements, &[side]].concat()));
        }
        PlainShape::Revolved { kind, render_from_object, flips, numbers } => {
            (kind, render_from_object, flips, numbers)
        }
        PlainShape::Curve { .. } => return None,
    };
    let [first, second, third, phi] = numbers;
    let side = if flips { -1.0 } else { 1.0 };
    let placed = |area: f32| {
        let rows = [0, 1, 2].map(|row| render_from_object.row(row).as_vec4().to_array());
        [rows.as_flattened(), &numbers, &[side, area]].concat()
    };
    match kind {
        RevolvedKind::Sphere => {
            let axes = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| render_from_object.transform_vector3(axis));
            let scale = axes[0].length();
            let is_similar = (0..3).all(|i| {
                (axes[i].length() - scale).abs() <= 1e-6 * scale
                    && axes[i].dot(axes[(i + 1) % 3]).abs() <= 1e-6 * scale * scale
            });
            if !is_similar || second != -first || third != first || phi < TAU {
                return Some((LightTag::SpherePart, placed(phi * first * (third - second))));
            }
            let center = render_from_object.transform_point3(DVec3::ZERO).as_vec3();
            let rotation =
                [0, 1, 2].map(|row| (render_from_object.row(row).truncate() / scale).as_vec3().to_array());
            let mut numbers = padded([center.to_array()].into_iter().chain(rotation));
            (numbers[3], numbers[7]) = (first * scale as f32, side);
            Some((LightTag::Sphere, numbers))
        }
        RevolvedKind::Disk => Some((LightTag::Disk, placed(0.5 * phi * (second * second - third * third)))),
        RevolvedKind::Cylinder => Some((LightTag::Cylinder, placed(phi * first * (third - second)))),
        RevolvedKind::Plane => None,
    }
}
