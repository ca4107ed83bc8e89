//! Lights and cameras, and what scenes without them get.

use std::f64::consts::PI;

use super::{QUAD, error, read_as, scene, shapes, text, warnings, without_errors};
use alhazen_import::import;
use assets::MemoryAssets;
use description::{
    AreaLightDesc, CameraKind, InfiniteRadiance, LightDesc, LightKind, SceneDesc, ShapeKind, SpectrumDesc,
};
use math::DVec3;

/// A light before a mesh.
fn lit(kind: &str, properties: &str) -> SceneDesc {
    scene(&format!("def Mesh \"m\" {{ {QUAD} }} def {kind} \"lamp\" {{ {properties} }}"))
}

fn only(desc: &SceneDesc) -> &LightDesc {
    assert_eq!(desc.lights.len(), 1);
    desc.lights.iter().next().unwrap().1
}

fn area(desc: &SceneDesc) -> (&ShapeKind, &AreaLightDesc) {
    let shape = shapes(desc).into_iter().find(|shape| shape.area_light.is_some()).expect("a light");
    (&shape.kind, &desc.area_lights[shape.area_light.unwrap()])
}

fn near(found: f32, expected: f64) {
    assert!((f64::from(found) - expected).abs() < 1e-4 * expected.abs().max(1e-3), "{found}, not {expected}");
}

#[test]
fn lights_with_a_surface_have_its_luminance() {
    let desc =
        lit("SphereLight", "float inputs:radius = 2 float inputs:intensity = 3 float inputs:exposure = 2");
    let (kind, light) = area(&desc);
    assert!(matches!(kind, ShapeKind::Sphere { radius: 2.0, .. }));
    near(light.scale, 12.0);
    assert_eq!(light.group.as_deref(), Some("lamp"));
    let normalized = "float inputs:radius = 2 float inputs:intensity = 3 bool inputs:normalize = 1";
    near(area(&lit("SphereLight", normalized)).1.scale, 3.0 / (4.0 * PI * 4.0));
    let normalized = "float inputs:width = 2 float inputs:height = 3 bool inputs:normalize = 1
        float3 xformOp:scale = (5, 2, 1) uniform token[] xformOpOrder = [\"xformOp:scale\"]";
    near(area(&lit("RectLight", normalized)).1.scale, 1.0 / 60.0);
    near(
        area(&lit("DiskLight", "float inputs:radius = 2 bool inputs:normalize = 1")).1.scale,
        1.0 / (4.0 * PI),
    );
    let tube = "float inputs:radius = 2 float inputs:length = 3 bool inputs:normalize = 1";
    near(area(&lit("CylinderLight", tube)).1.scale, 1.0 / (12.0 * PI));
    let old = lit("SphereLight", "float intensity = 3 float radius = 2");
    near(area(&old).1.scale, 3.0);
}

#[test]
fn flat_lights_shine_towards_negative_z() {
    let desc = lit("RectLight", "float inputs:width = 2");
    let ShapeKind::Triangles(mesh) = area(&desc).0 else { panic!("no triangles") };
    for triangle in mesh.indices.iter() {
        let [a, b, c] = triangle.map(|vertex| mesh.positions[vertex as usize]);
        assert!((b - a).cross(c - a).z < 0.0);
    }
    // Who looks at it along +z has x to the left.
    let right = mesh.positions.iter().zip(mesh.uvs.iter()).find(|(point, _)| point.x < 0.0).unwrap();
    assert_eq!(right.1.x, 1.0);
    let desc = lit("DiskLight", "");
    let disk = shapes(&desc).into_iter().find(|shape| shape.area_light.is_some()).unwrap();
    assert!(disk.reverse_orientation && matches!(disk.kind, ShapeKind::Disk { radius: 0.5, .. }));
}

#[test]
fn lights_without_size_have_an_intensity() {
    let desc =
        lit("SphereLight", "float inputs:radius = 0 bool inputs:normalize = 1 float inputs:intensity = 100");
    assert!(matches!(only(&desc).kind, LightKind::Point { .. }));
    near(only(&desc).scale, 25.0);
    let desc = lit("SphereLight", "float inputs:radius = 2 bool treatAsPoint = 1 float inputs:intensity = 5");
    near(only(&desc).scale, 5.0 * PI * 4.0);
    let cone = "float inputs:radius = 0 bool inputs:normalize = 1 float inputs:shaping:cone:angle = 30
        float inputs:shaping:cone:softness = 0.5";
    let desc = lit("SphereLight", cone);
    let LightKind::Spot { cone_angle, cone_delta_angle, to, .. } = only(&desc).kind else {
        panic!("no spot")
    };
    assert_eq!((cone_angle, cone_delta_angle, to.z), (30.0, 15.0, -1.0));
}

#[test]
fn distant_lights_have_an_illuminance() {
    let desc = lit("DistantLight", "float inputs:intensity = 3 bool inputs:normalize = 1");
    assert!(matches!(only(&desc).kind, LightKind::Distant { illuminance: None, .. }));
    near(only(&desc).scale, 3.0);
    let desc = lit("DistantLight", "float inputs:intensity = 3 float inputs:angle = 60");
    near(only(&desc).scale, 3.0 * PI / 4.0);
    near(only(&lit("DistantLight", "float inputs:intensity = 3 float inputs:angle = 0")).scale, 3.0);
}

#[test]
fn colours_and_temperatures_multiply() {
    let color = |properties: &str| {
        let desc = lit("SphereLight", properties);
        let (_, light) = area(&desc);
        let SpectrumDesc::Rgb { rgb, .. } = &light.radiance else { panic!("{light:?}") };
        rgb.map(|v| v * light.scale)
    };
    assert_eq!(color("color3f inputs:color = (0.5, 2, 1)"), [0.5, 2.0, 1.0]);
    let warm = color("bool inputs:enableColorTemperature = 1 float inputs:colorTemperature = 3000");
    assert!(warm[0] > warm[1] && warm[1] > warm[2]);
    let luminance = 0.2126 * warm[0] + 0.7152 * warm[1] + 0.0722 * warm[2];
    assert!((luminance - 1.0).abs() < 0.01, "{luminance}");
    let white = color("bool inputs:enableColorTemperature = 1");
    assert!(white.iter().all(|v| (v - 1.0).abs() < 0.06), "{white:?}");
    assert_eq!(color("float inputs:colorTemperature = 3000"), [1.0; 3]);
}

#[test]
fn domes_turn_as_they_are_placed() {
    let desc = lit("DomeLight", "float inputs:intensity = 2 color3f inputs:color = (1, 0.5, 0)");
    let light = only(&desc);
    let LightKind::Infinite { radiance: InfiniteRadiance::Constant(SpectrumDesc::Rgb { rgb, .. }), .. } =
        &light.kind
    else {
        panic!("{light:?}")
    };
    assert_eq!((light.scale, *rgb), (2.0, [1.0, 0.5, 0.0]));
    // In images of scenes +z is the pole, and the middle −x.
    let world = light.world_from_light.start;
    assert_eq!(world.transform_vector3(DVec3::Z), DVec3::Y);
    assert_eq!(world.transform_vector3(DVec3::NEG_X), DVec3::Z);
    let picture = image::Image::from_fn(4, 2, ["R", "G", "B"], |x, _| [x as f32, 1.0, 2.0]);
    let exr = image::encode(&picture, image::Format::Exr, &image::WriteOptions::default()).unwrap();
    let prims = format!(
        "def Mesh \"m\" {{ {QUAD} }} def DomeLight \"d\" {{ asset inputs:texture:file = @./sky.exr@
        color3f inputs:color = (1, 0.5, 1) }}"
    );
    let assets = MemoryAssets::default().with("s/a.usda", text(&prims)).with("s/sky.exr", exr);
    let desc = without_errors(import("s/a.usda", &assets));
    let LightKind::Infinite { radiance: InfiniteRadiance::Image(image), .. } = &only(&desc).kind else {
        panic!("no image")
    };
    let image = &desc.images[*image].image;
    assert_eq!((image.width(), image.height(), image.rgb(3, 0)), (4, 2, [3.0, 0.5, 2.0]));
}

#[test]
fn what_is_not_drawn_of_lights_is_named() {
    let of = |kind: &str, properties: &str| {
        warnings(&format!("def Mesh \"m\" {{ {QUAD} }} def {kind} \"l\" {{ {properties} }}"))
    };
    assert_eq!(
        of("DistantLight", "float inputs:intensity = 3 bool inputs:normalize = 1"),
        ["/l: the size of a distant light is not drawn: its shadows are sharp"]
    );
    assert!(
        of("RectLight", "float inputs:shaping:cone:angle = 20")[0].starts_with("/l: the cone of a light")
    );
    assert!(of("SphereLight", "float inputs:shaping:focus = 2")[0].starts_with("/l: the focus"));
    assert!(of("PortalLight", "")[0].starts_with("/l: prims of the schema `PortalLight`"));
    assert!(of("SphereLight", "float inputs:radius = 1").is_empty());
    assert!(error("def SphereLight \"l\" { float inputs:exposure = 1e9 }").starts_with("/l.inputs:exposure"));
}

#[test]
fn cameras_have_their_lens_and_picture() {
    let camera = |properties: &str| {
        let desc = scene(&format!(
            "def Mesh \"m\" {{ {QUAD} }} def Camera \"c\" {{
                double3 xformOp:translate = (0, 0, 5) uniform token[] xformOpOrder = [\"xformOp:translate\"]
                {properties} }}"
        ));
        (desc.camera.clone(), desc.film.resolution)
    };
    let wide = "float horizontalAperture = 36 float verticalAperture = 18 float focalLength = 9";
    let (desc, resolution) = camera(wide);
    let CameraKind::Perspective { fov, screen, lens } = &desc.kind else { panic!("{desc:?}") };
    assert_eq!((fov.round(), screen.window, lens.radius, resolution), (90.0, None, 0.0, [1280, 640]));
    let eye = desc.camera_from_world.start.inverse();
    assert_eq!(eye.w_axis.truncate(), DVec3::new(0.0, 0.0, 5.0));
    assert_eq!(eye.z_axis.truncate(), DVec3::NEG_Z);
    let (desc, _) =
        camera(&format!("{wide} float fStop = 0.5 float focusDistance = 4 float verticalApertureOffset = 9"));
    let CameraKind::Perspective { screen, lens, .. } = &desc.kind else { panic!("{desc:?}") };
    // 0.9 units of focal length, over twice the stop.
    assert_eq!((lens.radius, lens.focal_distance), (0.9, 4.0));
    assert_eq!(screen.window, Some([-2.0, 2.0, 0.0, 2.0]));
    let (desc, _) = camera(
        "token projection = \"orthographic\" float horizontalAperture = 40 float verticalAperture = 20",
    );
    let CameraKind::Orthographic { screen, .. } = &desc.kind else { panic!("{desc:?}") };
    assert_eq!(screen.window, Some([-2.0, 2.0, -1.0, 1.0]), "in tenths of a unit");
    assert!(
        error("def Camera \"c\" { float focalLength = 0 }")
            .starts_with("/c.focalLength: this must be above 0")
    );
}

#[test]
fn a_camera_may_be_chosen() {
    let at = |name: &str, x: f64| {
        format!(
            "def Camera \"{name}\" {{ double3 xformOp:translate = ({x}, 0, 5)
            uniform token[] xformOpOrder = [\"xformOp:translate\"] }}"
        )
    };
    let prims = format!("def Mesh \"m\" {{ {QUAD} }} {} {}", at("left", -1.0), at("right", 1.0));
    let x = |path: &str| {
        let desc = without_errors(read_as(path, &prims));
        desc.camera.camera_from_world.start.inverse().w_axis.x
    };
    assert_eq!((x("a.usda"), x("a.usda#camera=right"), x("a.usda#camera=1")), (-1.0, 1.0, 1.0));
    assert!(read_as("a.usda#camera=top", &prims).has_errors());
}

#[test]
fn bare_scenes_are_shown_in_a_studio() {
    let desc = scene(&format!("def Mesh \"m\" {{ {QUAD} }}"));
    assert_eq!(desc.lights.len(), 1);
    assert_eq!(desc.shapes.len(), 2, "with a ground");
    assert!(
        super::messages("", description::Severity::Warning).iter().any(|text| text.contains("no surfaces"))
    );
}
