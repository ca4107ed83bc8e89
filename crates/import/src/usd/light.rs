//! Lights. An intensity is a luminance in cd/m² (of distant lights that are normalized, an
//! illuminance in lx), which is the photometric scale of the scene's lights.

use std::f64::consts::PI;

use description::{
    AreaLightDesc, ImageDesc, InfiniteRadiance, LightDesc, LightKind, MeshDesc, SceneDesc, ShapeDesc,
    ShapeKind, SpectrumDesc, TransformDesc, UvImageDesc, WrapMode,
};
use image::Image;
use math::{DAffine2, DMat4, DVec3, DVec4, Point2, Vec3};
use spectrum::{RgbColorSpace, Spectrum};

use super::material::Materials;
use super::solid::{self, Solid};
use super::stage::Prim;
use super::texture::{Space, Texture};
use crate::log::{Log, Result};

/// What a light becomes.
pub(super) enum Light {
    Light(Box<LightDesc>),
    /// Shapes that shine, and about how bright they are from afar.
    Shapes(Vec<Solid>, f64),
}

/// What all lights have.
struct Emission {
    /// Whose largest component is one.
    color: [f64; 3],
    scale: f64,
    is_normalized: bool,
}

impl Emission {
    fn spectrum(&self) -> SpectrumDesc {
        let [r, g, b] = self.color.map(|v| v as f32);
        SpectrumDesc::rgb(r, g, b)
    }
}

/// The names of schemas that are read.
pub(super) const KINDS: [&str; 7] =
    ["DistantLight", "SphereLight", "RectLight", "DiskLight", "CylinderLight", "DomeLight", "DomeLight_1"];

/// A light at its place in a group; `None` if it is dark.
pub(super) fn read(
    prim: &Prim,
    kind: &str,
    placement: TransformDesc,
    materials: &mut Materials,
    desc: &mut SceneDesc,
    log: &mut Log,
) -> Result<Option<Light>> {
    let emission = emission(prim, kind)?;
    if emission.scale <= 0.0 {
        return Ok(None);
    }
    not_honoured(prim, kind, log)?;
    let image = texture(prim)?.filter(|_| matches!(kind, "RectLight" | "DomeLight" | "DomeLight_1"));
    let image = image.and_then(|texture| materials.light_image(&texture, desc, log));
    let color = emission.spectrum();
    let (light, scale, world_from_light) = match kind {
        "DistantLight" => {
            let (from, to) = (Vec3::ZERO, -Vec3::Z);
            let light = LightKind::Distant { radiance: color, illuminance: None, from, to };
            (light, illuminance(prim, &emission, log)?, placement)
        }
        "DomeLight" | "DomeLight_1" => {
            let radiance = match image {
                None => InfiniteRadiance::Constant(color),
                Some(handle) => {
                    let ImageDesc { name, image } = &desc.images[handle];
                    let tinted = dome_image(image, emission.color).into();
                    let tinted = ImageDesc { name: name.clone(), image: tinted };
                    InfiniteRadiance::Image(desc.images.push(tinted))
                }
            };
            let light = LightKind::Infinite { radiance, illuminance: None, portal: None };
            let dome = world_from_dome(prim, kind)?;
            let (start, end) = (placement.start * dome, placement.end * dome);
            (light, emission.scale, TransformDesc { start, end, ..placement })
        }
        "SphereLight" if is_point(prim)? => {
            let radius = input(prim, "radius")?.unwrap_or(0.5);
            // Of a sphere of luminance L the intensity is L π r²; normalized, L is divided by
            // 4 π r².
            let intensity = match emission.is_normalized {
                true => emission.scale / 4.0,
                false => emission.scale * PI * radius * radius,
            };
            (point(prim, color)?, intensity, placement)
        }
        _ => {
            let (solids, area) = shapes(prim, kind, &placement)?;
            let scale = if emission.is_normalized { emission.scale / area } else { emission.scale };
            if !scale.is_finite() {
                return Err(prim.fault("", "a normalized light has an area"));
            }
            let area_light = AreaLightDesc {
                image: image.map(|image| UvImageDesc::new(image, WrapMode::Clamp)),
                scale: scale as f32,
                group: Some(prim.name().to_owned()),
                ..AreaLightDesc::new(color)
            };
            let area_light = Some(desc.area_lights.push(area_light));
            let material = Some(materials.plain(Some([0.0; 3]), desc).material);
            let lit =
                |solid: Solid| Solid { shape: ShapeDesc { area_light, material, ..solid.shape }, ..solid };
            // A convex body shows a quarter of its surface.
            let is_flat = matches!(kind, "RectLight" | "DiskLight");
            let intensity = scale * area * if is_flat { 1.0 } else { 0.25 };
            return Ok(Some(Light::Shapes(solids.into_iter().map(lit).collect(), intensity)));
        }
    };
    let group = Some(prim.name().to_owned());
    let light = LightDesc { world_from_light, scale: scale as f32, group, ..LightDesc::from(light) };
    Ok((scale > 0.0).then(|| Light::Light(Box::new(light))))
}

/// The illuminance by a distant light.
fn illuminance(prim: &Prim, emission: &Emission, log: &mut Log) -> Result<f64> {
    let angle = input(prim, "angle")?.unwrap_or(0.53).clamp(0.0, 360.0).to_radians() / 2.0;
    if angle > 0.0 {
        let message = "the size of a distant light is not drawn: its shadows are sharp";
        log.warn("not-drawn", prim.path(), message);
    }
    let share = match angle {
        _ if emission.is_normalized => 1.0,
        0.0 => 1.0,
        angle if angle <= PI / 2.0 => PI * libm::sin(angle).powi(2),
        angle => PI * (2.0 - libm::sin(angle).powi(2)),
    };
    Ok(emission.scale * share)
}

/// The place of a dome, whose pole is +y for a light, and +z for the images of the scene, whose
/// middle is −x; that of the light's is +z.
fn world_from_dome(prim: &Prim, kind: &str) -> Result<DMat4> {
    let [x, y, z] = [-DVec3::Z, DVec3::X, DVec3::Y].map(|axis| axis.extend(0.0));
    let dome = DMat4::from_cols(x, y, z, DVec4::W);
    let has_pole = kind == "DomeLight_1" && {
        let axis = prim.word("poleAxis")?.unwrap_or_else(|| "scene".to_owned());
        axis == "Z" || (axis == "scene" && prim.stage.is_z_up())
    };
    Ok(if has_pole { DMat4::from_rotation_x(PI / 2.0) * dome } else { dome })
}

/// A light without size, which may have a cone.
fn point(prim: &Prim, intensity: SpectrumDesc) -> Result<LightKind> {
    let (from, to, power) = (Vec3::ZERO, -Vec3::Z, None);
    let cone = input(prim, "shaping:cone:angle")?.filter(|_| has_cone(prim).unwrap_or(false));
    let Some(angle) = cone.map(|angle| angle.clamp(0.0, 180.0)) else {
        return Ok(LightKind::Point { intensity, power, from });
    };
    let softness = input(prim, "shaping:cone:softness")?.unwrap_or(0.0).clamp(0.0, 1.0);
    let (cone_angle, cone_delta_angle) = (angle as f32, (angle * softness) as f32);
    Ok(LightKind::Spot { intensity, power, from, to, cone_angle, cone_delta_angle })
}

/// The name of an input, which older files have without the prefix.
fn name(prim: &Prim, input: &str) -> Result<String> {
    let name = format!("inputs:{input}");
    let known = prim.properties()?;
    Ok(if known.contains(&name) || !known.iter().any(|other| other == input) {
        name
    } else {
        input.to_owned()
    })
}

fn input(prim: &Prim, input: &str) -> Result<Option<f64>> {
    prim.number(&name(prim, input)?)
}

fn emission(prim: &Prim, kind: &str) -> Result<Emission> {
    let intensity = if kind == "DistantLight" { 50000.0 } else { 1.0 };
    let intensity = input(prim, "intensity")?.unwrap_or(intensity);
    let exposure = input(prim, "exposure")?.unwrap_or(0.0);
    let mut color = prim.numbers::<3>(&name(prim, "color")?)?.unwrap_or([1.0; 3]);
    if input(prim, "enableColorTemperature")?.is_some_and(|value| value != 0.0) {
        let temperature = input(prim, "colorTemperature")?.unwrap_or(6500.0).clamp(1000.0, 10000.0);
        let xyz = Spectrum::blackbody(temperature as f32).to_xyz();
        let rgb = RgbColorSpace::srgb().to_rgb(xyz);
        let tint = [rgb.r, rgb.g, rgb.b].map(|v| f64::from((v / xyz.y).max(0.0)));
        color = std::array::from_fn(|i| color[i] * tint[i]);
    }
    let color = color.map(|v| v.max(0.0));
    let most = color.into_iter().fold(0.0, f64::max);
    let scale = intensity * libm::exp2(exposure) * most;
    if !scale.is_finite() {
        return Err(prim.fault("inputs:exposure", "the light has no finite intensity"));
    }
    let color = color.map(|v| if most > 0.0 { v / most } else { 0.0 });
    let is_normalized = input(prim, "normalize")?.is_some_and(|value| value != 0.0);
    Ok(Emission { color, scale, is_normalized })
}

fn is_point(prim: &Prim) -> Result<bool> {
    Ok(prim.flag("treatAsPoint")? || input(prim, "radius")?.unwrap_or(0.5) <= 0.0 || has_cone(prim)?)
}

/// Whether its light is a cone.
fn has_cone(prim: &Prim) -> Result<bool> {
    Ok(input(prim, "shaping:cone:angle")?.is_some_and(|angle| angle < 90.0))
}

/// Says what of a light is not drawn.
fn not_honoured(prim: &Prim, kind: &str, log: &mut Log) -> Result<()> {
    let mut warn = |message: &str| log.warn("not-drawn", prim.path(), message);
    if has_cone(prim)? {
        match kind {
            "SphereLight" if prim.flag("treatAsPoint")? || input(prim, "radius")?.unwrap_or(0.5) <= 0.0 => {}
            "SphereLight" => warn("a light whose cone is limited is drawn as one without size"),
            _ => warn("the cone of a light other than a sphere is not drawn"),
        }
    }
    if input(prim, "shaping:focus")?.unwrap_or(0.0) != 0.0 {
        warn("the focus of a light is not drawn");
    }
    if prim.file(&name(prim, "shaping:ies:file")?)?.is_some() {
        warn("the measured distribution of a light is not drawn");
    }
    if input(prim, "shadow:enable")?.is_some_and(|value| value == 0.0) {
        warn("a light without shadows is drawn with them");
    }
    for name in ["light:filters", "collection:lightLink:includes", "collection:lightLink:excludes"] {
        if !prim.targets(name)?.is_empty() {
            warn("filters of a light, and what it shines on, are not drawn");
        }
    }
    if prim.file(&name(prim, "texture:file")?)?.is_some()
        && !matches!(kind, "RectLight" | "DomeLight" | "DomeLight_1")
    {
        warn("the image of a light of this shape is not drawn");
    }
    Ok(())
}

/// The image that a light shows.
fn texture(prim: &Prim) -> Result<Option<Texture>> {
    let Some((found, named)) = prim.file(&name(prim, "texture:file")?)? else { return Ok(None) };
    Ok(Some(Texture {
        file: found.ok_or(named),
        space: Space::Auto,
        scale: [1.0; 4],
        bias: [0.0; 4],
        fallback: [0.0; 4],
        channel: None,
        set: String::new(),
        transform: DAffine2::IDENTITY,
        mirrored: [false; 2],
        wrap: description::WrapMode::Clamp,
        place: prim.path().to_owned(),
    }))
}

/// An image of the sphere by latitude and longitude, times a colour. One of another shape is
/// stretched.
fn dome_image(image: &Image, color: [f64; 3]) -> Image {
    let (width, height) = (image.width(), image.height());
    let rows = width.div_ceil(2).max(1);
    let tint = |rgb: [f32; 3]| std::array::from_fn(|i| rgb[i] * color[i] as f32);
    Image::from_fn(2 * rows, rows, ["R", "G", "B"], |x, y| {
        let row = (u64::from(y) * u64::from(height) / u64::from(rows)) as u32;
        tint(image.rgb(x.min(width - 1), row))
    })
}

/// The shapes of a light that shine on their outside, and their area in the world.
fn shapes(prim: &Prim, kind: &str, placement: &TransformDesc) -> Result<(Vec<Solid>, f64)> {
    let size = |input_name: &str, otherwise: f64| match input(prim, input_name)?.unwrap_or(otherwise) {
        value if value > 0.0 => Ok(value),
        value => Err(prim.fault(&name(prim, input_name)?, format!("this must be above 0, not {value}"))),
    };
    let matrix = placement.start;
    let scales = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|axis| axis.truncate().length());
    Ok(match kind {
        "RectLight" => {
            let (width, height) = (size("width", 1.0)?, size("height", 1.0)?);
            let across = matrix.x_axis.truncate().cross(matrix.y_axis.truncate()).length();
            (vec![rectangle(width, height)], width * height * across)
        }
        "DiskLight" => {
            let radius = size("radius", 0.5)?;
            let across = matrix.x_axis.truncate().cross(matrix.y_axis.truncate()).length();
            let disk = Solid {
                shape: ShapeDesc { reverse_orientation: true, ..solid::disk(radius, 0.0).shape },
                ..solid::disk(radius, 0.0)
            };
            (vec![disk], PI * radius * radius * across)
        }
        "CylinderLight" => {
            let (radius, length) = (size("radius", 0.5)?, size("length", 1.0)?);
            let around = (scales[1] * scales[2]).sqrt();
            let side = solid::cylinder(radius, length).turned(solid::axis_from_z("X"));
            (vec![side], 2.0 * PI * radius * length * around * scales[0])
        }
        _ => {
            let radius = size("radius", 0.5)?;
            let scale = libm::pow(scales[0] * scales[1] * scales[2], 2.0 / 3.0);
            (vec![solid::sphere(radius)], 4.0 * PI * radius * radius * scale)
        }
    })
}

/// A rectangle about the origin that faces −z, whose image is upright for who looks at it.
fn rectangle(width: f64, height: f64) -> Solid {
    let (x, y) = ((width / 2.0) as f32, (height / 2.0) as f32);
    let positions = [[-x, -y], [x, -y], [x, y], [-x, y]].map(|[x, y]| Vec3::new(x, y, 0.0));
    let uvs = [[1.0, 0.0], [0.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(|[u, v]| Point2::new(u, v));
    let mesh = MeshDesc {
        indices: [[0, 2, 1], [0, 3, 2]].into(),
        positions: positions.into(),
        uvs: uvs.into(),
        ..MeshDesc::default()
    };
    let bounds = [DVec3::new(-width, -height, 0.0) / 2.0, DVec3::new(width, height, 0.0) / 2.0];
    Solid { shape: ShapeKind::Triangles(mesh).into(), bounds }
}
