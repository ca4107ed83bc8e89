//! The list of configured lights.

use super::*;
use alhazen_scene::Scene;
use alhazen_scene::light::{Light, LightId, LightRef, LightSampleContext};
use description::{
    AreaLightDesc, Handle, ImageDesc, InfiniteRadiance, InstanceDesc, LightDesc, LightKind, MeshKey,
    ObjectDesc, SceneDesc, ShapeDesc, ShapeKind, SpectrumDesc, TransformDesc, UvImageDesc, WrapMode,
};
use math::{DMat4, DVec3, DVec4, Vec3};

/// A scene of one light.
pub struct Case {
    pub name: &'static str,
    pub scene: Scene,
}

impl Case {
    pub fn light(&self) -> LightRef<'_> {
        self.scene.light(LightId(0))
    }
}

pub fn white() -> SpectrumDesc {
    SpectrumDesc::Constant(100.0)
}

/// An emissive shape, rotated and translated into general position.
pub fn area(shape: ShapeKind, change: impl Fn(&mut AreaLightDesc, &mut ShapeDesc)) -> SceneDesc {
    let mut light = AreaLightDesc::new(white());
    let mut shape = ShapeDesc::from(shape);
    let turn = DMat4::from_axis_angle(DVec3::new(1.0, 2.0, -1.0).normalize(), 0.3);
    shape.world_from_object =
        TransformDesc::fixed(DMat4::from_translation(DVec3::new(0.1, -0.2, 0.3)) * turn);
    change(&mut light, &mut shape);
    let mut desc = SceneDesc::default();
    shape.area_light = Some(desc.area_lights.push(light));
    desc.shapes.push(shape);
    desc
}

pub fn both_sides(light: &mut AreaLightDesc, _: &mut ShapeDesc) {
    light.two_sided = true;
}

pub fn one_side(_: &mut AreaLightDesc, _: &mut ShapeDesc) {}

pub fn colours(x: u32, y: u32) -> [f32; 3] {
    [0.2 + x as f32, 0.4 + (x * y % 5) as f32, 1.0 + 0.5 * y as f32]
}

/// An emissive shape with an image over (u, v).
pub fn with_image(shape: ShapeKind) -> SceneDesc {
    let mut desc = area(shape, both_sides);
    let image = desc.images.push(rgb_image(6, 4, colours));
    for (_, light) in desc.area_lights.iter_mut() {
        light.image = Some(UvImageDesc::new(image, WrapMode::Clamp));
    }
    desc
}

pub fn triangle() -> ShapeKind {
    triangles(&[[-1.0, -0.7, 0.0], [1.3, -0.4, 0.2], [0.1, 1.2, -0.1]], &[[0, 1, 2]])
}

pub fn placement() -> DMat4 {
    DMat4::from_translation(DVec3::new(0.1, 0.2, 0.3)) * DMat4::from_rotation_x(0.8)
}

/// A light without a surface, and a distant sphere that gives the scene its bounds.
pub fn free(kind: LightKind) -> SceneDesc {
    let mut desc = SceneDesc::default();
    let far_away = TransformDesc::translation(0.0, 0.0, -1e3);
    desc.shapes.push(ShapeDesc { world_from_object: far_away, ..sphere(10.0).into() });
    let world_from_light = TransformDesc::fixed(placement());
    desc.lights.push(LightDesc { world_from_light, ..kind.into() });
    desc
}

pub fn spot(cone_angle: f32, cone_delta_angle: f32, power: Option<f32>) -> LightKind {
    LightKind::Spot {
        intensity: white(),
        power,
        from: Vec3::ZERO,
        to: Vec3::new(0.1, 0.2, 1.0),
        cone_angle,
        cone_delta_angle,
    }
}

pub fn point(power: Option<f32>) -> LightKind {
    LightKind::Point { intensity: white(), power, from: Vec3::new(0.0, 0.5, 0.0) }
}

pub fn distant(illuminance: Option<f32>) -> LightKind {
    LightKind::Distant { radiance: white(), illuminance, from: Vec3::new(1.0, 0.3, 2.0), to: Vec3::ZERO }
}

pub fn sky(illuminance: Option<f32>) -> LightKind {
    LightKind::Infinite { radiance: InfiniteRadiance::Constant(white()), illuminance, portal: None }
}

/// A sky given by an equal-area image of `size` × `size` pixels.
pub fn image_sky(size: u32, illuminance: Option<f32>, pixel: impl FnMut(u32, u32) -> [f32; 3]) -> SceneDesc {
    image_sky_of([size, size], illuminance, pixel)
}

pub fn image_sky_of(
    [width, height]: [u32; 2],
    illuminance: Option<f32>,
    pixel: impl FnMut(u32, u32) -> [f32; 3],
) -> SceneDesc {
    let mut desc = free(sky(illuminance));
    let image = desc.images.push(rgb_image(width, height, pixel));
    for (_, light) in desc.lights.iter_mut() {
        let LightKind::Infinite { radiance, .. } = &mut light.kind else { continue };
        *radiance = InfiniteRadiance::Image(image);
    }
    desc
}

/// [`free`] of a kind that refers to an image.
pub fn free_with_image(image: ImageDesc, kind: impl FnOnce(Handle<ImageDesc>) -> LightKind) -> SceneDesc {
    let mut images = SceneDesc::default().images;
    let handle = images.push(image);
    SceneDesc { images, ..free(kind(handle)) }
}

pub fn goniometric(power: Option<f32>) -> SceneDesc {
    free_with_image(rgb_image(8, 8, colours), |image| LightKind::Goniometric {
        intensity: white(),
        power,
        image: Some(image),
    })
}

pub fn projection(power: Option<f32>) -> SceneDesc {
    let pixel = |x, y| if (x, y) == (2, 1) { [0.0; 3] } else { colours(x, y) };
    free_with_image(rgb_image(6, 4, pixel), |image| LightKind::Projection {
        image: Some(image),
        power,
        fov: 70.0,
    })
}

/// A tilted portal above the reference points.
pub fn portal(radiance: InfiniteRadiance) -> LightKind {
    let (corner, right, up) =
        (Vec3::new(-1.5, -1.0, 3.0), Vec3::new(3.0, 0.0, 0.3), Vec3::new(0.0, 2.5, 0.0));
    let corners = [corner, corner + up, corner + up + right, corner + right];
    LightKind::Infinite { radiance, illuminance: None, portal: Some(corners) }
}

pub fn portal_lights() -> Vec<Case> {
    let seen_through = |width, height| {
        let image = rgb_image(width, height, |x, y| if (x, y) == (4, 4) { [40.0; 3] } else { colours(x, y) });
        free_with_image(image, |image| portal(InfiniteRadiance::Image(image)))
    };
    let cases = [
        ("portal", free(portal(InfiniteRadiance::Constant(white())))),
        ("portal, image", seen_through(8, 8)),
        ("portal, panorama", seen_through(16, 8)),
    ];
    cases.map(|(name, desc)| Case { name, scene: scene(&desc) }).into()
}

/// The place of a light at a point, and a direction in which it emits.
pub fn place(light: LightRef) -> (Vec3, Vec3) {
    match light.row() {
        Light::Point(light) => (light.p, Vec3::Z),
        Light::Spot(light) => (light.p, light.axis),
        Light::Goniometric(light) => (light.position(TIME), Vec3::Z),
        Light::Projection(light) => {
            let (p, axis) = light.placement(TIME);
            // Off the axis, which is an edge of pixels.
            (p, (axis + Vec3::new(0.03, 0.05, 0.02)).normalize())
        }
        _ => panic!("not a light at a point"),
    }
}

pub fn delta_lights() -> Vec<Case> {
    let cases = [
        ("point", free(point(None))),
        ("spot", free(spot(40.0, 15.0, None))),
        ("spot, hard edge", free(spot(60.0, 0.0, None))),
        ("distant", free(distant(None))),
        ("goniometric", goniometric(None)),
        ("projection", projection(None)),
    ];
    cases.map(|(name, desc)| Case { name, scene: scene(&desc) }).into()
}

pub fn area_lights() -> Vec<Case> {
    let flat = rectangle([-1.0, -0.5], [0.8, 0.7]);
    let bent = patch([[-1.0, -1.0, 0.0], [1.0, -0.8, 0.5], [-0.9, 1.0, 0.4], [1.1, 1.2, -0.3]]);
    let cases = [
        ("sphere", area(sphere(0.8), one_side)),
        ("sphere, both sides", area(sphere(0.8), both_sides)),
        ("cylinder", area(cylinder(0.5, -0.6, 0.9), one_side)),
        ("cylinder, both sides", area(cylinder(0.5, -0.6, 0.9), both_sides)),
        ("cone", area(ShapeKind::Cone { radius: 0.9, height: 0.4, phi_max: 360.0 }, both_sides)),
        ("disk", area(disk(0.2, 0.9), one_side)),
        ("disk, both sides", area(disk(0.2, 0.9), both_sides)),
        ("disk, reversed", area(disk(0.2, 0.9), |_, shape| shape.reverse_orientation = true)),
        ("triangle", area(triangle(), one_side)),
        ("triangle, both sides", area(triangle(), both_sides)),
        ("rectangle", area(flat.clone(), one_side)),
        ("rectangle, both sides", area(flat.clone(), both_sides)),
        ("rectangle, image", with_image(flat)),
        ("bent patch", area(bent, both_sides)),
        ("disk, image", with_image(disk(0.0, 0.9))),
    ];
    cases
        .into_iter()
        .chain(placed_area_lights())
        .map(|(name, desc)| Case { name, scene: scene(&desc) })
        .collect()
}

/// Instanced and moving emissive shapes.
fn placed_area_lights() -> Vec<(&'static str, SceneDesc)> {
    let stretch = DMat4::from_rotation_z(0.4) * DMat4::from_scale(DVec3::new(-0.8, 1.3, 1.1));
    let turn = DMat4::from_translation(DVec3::new(0.2, -0.1, 0.1)) * DMat4::from_rotation_y(0.5);
    let [stretch, turn] = [stretch, turn].map(TransformDesc::fixed);
    let to = DMat4::from_translation(DVec3::new(0.3, 0.2, -0.2)) * DMat4::from_rotation_x(0.7);
    let moving = TransformDesc { start: DMat4::IDENTITY, end: to, times: [-1.0, 1.0] };
    let mut mesh = triangle();
    if let ShapeKind::Triangles(mesh) = &mut mesh {
        let positions: Arc<[Point3]> =
            mesh.positions.iter().map(|p| *p + Vec3::new(0.3, -0.2, 0.4)).collect();
        mesh.later.push(MeshKey { positions, ..MeshKey::default() });
    }
    vec![
        ("stretched sphere", instanced(area(sphere(0.8), both_sides), &[stretch])),
        ("disk in an object", instanced(area(disk(0.2, 0.9), one_side), &[turn, stretch])),
        ("triangle in an object", instanced(area(triangle(), one_side), &[stretch])),
        ("patch in an object, image", instanced(with_image(rectangle([-1.0, -0.5], [0.8, 0.7])), &[stretch])),
        ("moving disk", area(disk(0.2, 0.9), |_, shape| shape.world_from_object = moving)),
        ("disk in a moving object", instanced(area(disk(0.2, 0.9), one_side), &[turn, moving])),
        ("triangle with moving corners", area(mesh, both_sides)),
    ]
}

/// Turns the shapes of a scene into an object in nested instances with these transforms, the last
/// innermost.
fn instanced(mut desc: SceneDesc, transforms: &[TransformDesc]) -> SceneDesc {
    let shapes = std::mem::take(&mut desc.shapes);
    let mut object = ObjectDesc { shapes, ..ObjectDesc::default() };
    for (i, &world_from_object) in transforms.iter().rev().enumerate() {
        let object_handle = desc.objects.push(std::mem::take(&mut object));
        let instance = InstanceDesc { object: object_handle, world_from_object };
        if i + 1 < transforms.len() {
            object.instances.push(instance);
        } else {
            desc.instances.push(instance);
        }
    }
    desc
}

pub fn infinite_lights() -> Vec<Case> {
    // One bright pixel, as a sun.
    let sun = |x, y| if (x, y) == (5, 2) { [40.0, 35.0, 30.0] } else { colours(x, y) };
    let mut moving = image_sky_of([16, 8], None, sun);
    for (_, light) in moving.lights.iter_mut() {
        light.world_from_light.end = placement() * DMat4::from_rotation_z(2.0);
    }
    let cases = [
        ("sky", free(sky(None))),
        ("image sky", image_sky(8, None, colours)),
        ("image sky with a sun", image_sky(8, None, sun)),
        ("image sky of one colour", image_sky(8, None, |_, _| [0.5; 3])),
        ("panorama", image_sky_of([16, 8], None, colours)),
        ("panorama with a sun", image_sky_of([16, 8], None, sun)),
        ("moving panorama with a sun", moving),
        ("panorama of one colour", image_sky_of([16, 8], None, |_, _| [0.5; 3])),
    ];
    cases.map(|(name, desc)| Case { name, scene: scene(&desc) }).into()
}

/// Environments whose transforms are no similarities.
pub fn stretched_environments() -> Vec<Case> {
    let colours = |x, y| if (x, y) == (5, 2) { [4.0, 3.5, 3.0] } else { colours(x, y) };
    let placed = |size, start: DMat4, end: DMat4| {
        let mut desc = image_sky_of(size, None, colours);
        for (_, light) in desc.lights.iter_mut() {
            light.world_from_light.start = start;
            light.world_from_light.end = end;
        }
        desc
    };
    let stretch = placement() * DMat4::from_scale(DVec3::new(1.0, 2.0, 0.5)) * DMat4::from_rotation_y(0.9);
    let shear = placement() * DMat4::from_cols(DVec4::X, DVec4::new(0.7, -1.0, 0.0, 0.0), DVec4::Z, DVec4::W);
    let cases = [
        ("stretched image sky", placed([8, 8], stretch, stretch)),
        ("stretched panorama", placed([16, 8], stretch, stretch)),
        ("sheared panorama", placed([16, 8], shear, shear)),
        ("panorama that is being stretched", placed([16, 8], placement(), stretch)),
    ];
    cases.map(|(name, desc)| Case { name, scene: scene(&desc) }).into()
}

pub fn hittable_lights() -> Vec<Case> {
    let mut lights = area_lights();
    lights.extend(infinite_lights());
    lights.extend(stretched_environments());
    lights.extend(portal_lights());
    lights
}

/// Reference points in front of, behind, beside and near the lights; on surfaces and in space.
pub fn references() -> Vec<LightSampleContext> {
    vec![
        context(Vec3::new(0.3, 0.2, 2.0), Vec3::ZERO),
        context(Vec3::new(-0.5, 0.4, -1.9), Vec3::new(0.3, 0.0, 1.0).normalize()),
        context(Vec3::new(1.1, -0.9, 1.0), Vec3::new(-0.5, 0.4, -0.9).normalize()),
        context(Vec3::new(0.1, -0.1, 0.6), Vec3::ZERO),
    ]
}
