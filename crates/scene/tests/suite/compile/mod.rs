//! Compilation of scenes: transforms, times, ids, and diagnostics.

mod materials;
mod traits;

use crate::common::*;
use alhazen_scene::light::LightId;
use alhazen_scene::{RayStats, View, compile, world_from_render};
use description::{
    AreaLightDesc, CurveBasis, CurveDesc, CurveProfile, Diagnostic, FileId, ImageDesc, InfiniteRadiance,
    InstanceDesc, LightDesc, LightKind, MaterialDesc, MaterialKind, MeshDesc, ObjectDesc, Origin,
    PatchMeshDesc, SceneDesc, Severity, ShapeDesc, ShapeKind, Span, SpectrumDesc, Stated, TransformDesc,
    UvImageDesc, WrapMode,
};
use geometry::GeometryId;
use image::Image;
use math::{DMat4, DVec3, Ray, Vec2, Vec3};
use std::sync::Arc;

fn span(start: u32) -> Span {
    Span::new(FileId(0), start, start + 1)
}

fn stated<T>(value: T, start: u32) -> Stated<T> {
    Stated::new(value, Origin::new(span(start)))
}

fn with_parameter<T>(value: T, name: &'static str, start: u32) -> Stated<T> {
    Stated::new(value, Origin { span: span(1000), parameters: vec![(name, span(start))] })
}

fn all_diagnostics(desc: &SceneDesc) -> Vec<Diagnostic> {
    let errors = |diagnostics: Vec<Diagnostic>| {
        assert!(diagnostics.iter().any(Diagnostic::is_error));
        diagnostics
    };
    let view = View::compile(desc, world_from_render(desc));
    [
        view.map_or_else(errors, |view| view.warnings),
        compile(desc.clone()).map_or_else(errors, |scene| scene.warnings),
    ]
    .concat()
}

/// The diagnostics, except those of scenes without light, which have a test of their own.
fn diagnostics(desc: &SceneDesc) -> Vec<Diagnostic> {
    let mut all = all_diagnostics(desc);
    all.retain(|diagnostic| !matches!(diagnostic.code, "empty-scene" | "no-light"));
    all
}

/// The only diagnostic of a scene.
fn check(desc: &SceneDesc, severity: Severity, code: &str, message: &str, start: u32) {
    let all = diagnostics(desc);
    let [only] = &all[..] else { panic!("expected only `{message}`: {all:?}") };
    assert_eq!((only.severity, only.code, &only.message[..]), (severity, code, message));
    assert_eq!(only.span(), span(start), "{message}");
}

fn warns(desc: &SceneDesc, message: &str, start: u32) {
    check(desc, Severity::Warning, "not-drawn", message, start);
}

/// A scene with one change, whose return value is ignored.
fn with<T>(change: impl FnOnce(&mut SceneDesc) -> T) -> SceneDesc {
    let mut desc = SceneDesc::default();
    change(&mut desc);
    desc
}

fn flat() -> TransformDesc {
    TransformDesc::fixed(DMat4::from_scale(DVec3::new(1.0, 0.0, 1.0)))
}

fn gray_image() -> ImageDesc {
    ImageDesc { name: "gray.png".into(), image: Arc::new(Image::from_fn(4, 4, ["Y"], |_, _| [0.5])) }
}

fn image_sky(image: ImageDesc, illuminance: Option<f32>) -> SceneDesc {
    with(|desc| {
        let radiance = InfiniteRadiance::Image(desc.images.push(image));
        let kind = LightKind::Infinite { radiance, illuminance, portal: None };
        desc.lights.push_stated(with_parameter(kind.into(), "filename", 5));
    })
}

#[test]
fn transforms_without_an_inverse_are_errors() {
    let check = |desc: &SceneDesc, what: &str, start| {
        let message = format!("the transform of the {what} has no inverse");
        check(desc, Severity::Error, "singular-transform", &message, start);
    };
    let squashed = || ShapeDesc { world_from_object: flat(), ..sphere(1.0).into() };
    check(&with(|desc| desc.shapes.push_stated(stated(squashed(), 3))), "shape", 3);
    let in_object = with(|desc| {
        let mut object = ObjectDesc::default();
        object.shapes.push_stated(stated(squashed(), 4));
        let object = desc.objects.push(object);
        desc.instances.push(InstanceDesc { object, world_from_object: TransformDesc::default() });
    });
    check(&in_object, "shape", 4);
    let instance = with(|desc| {
        let object = desc.objects.push(ObjectDesc::default());
        desc.instances.push_stated(stated(InstanceDesc { object, world_from_object: flat() }, 5));
    });
    check(&instance, "instance", 5);
    let light = with(|desc| {
        let kind = LightKind::Point { intensity: 1.0.into(), power: None, from: Vec3::ZERO };
        desc.lights.push_stated(stated(LightDesc { world_from_light: flat(), ..kind.into() }, 6));
    });
    check(&light, "light", 6);
}

#[test]
fn recursive_or_too_deeply_nested_objects_are_errors() {
    let place = |object| InstanceDesc { object, world_from_object: TransformDesc::default() };
    let endless = with(|desc| {
        let mut a = ObjectDesc { name: "a".into(), ..ObjectDesc::default() };
        a.instances.push(place(description::Handle::new(1)));
        let mut b = ObjectDesc { name: "b".into(), ..ObjectDesc::default() };
        b.instances.push_stated(stated(place(description::Handle::new(0)), 8));
        let a = desc.objects.push(a);
        desc.objects.push(b);
        desc.instances.push(place(a));
    });
    let message = "the object `a` contains itself";
    check(&endless, Severity::Error, "endless-instances", message, 8);
    let chain = |levels: u32| {
        with(|desc| {
            for level in 0..levels {
                let mut object = ObjectDesc::default();
                if level > 0 {
                    let inner = place(description::Handle::new(level - 1));
                    object.instances.push_stated(stated(inner, level));
                }
                desc.objects.push(object);
            }
            desc.instances.push_stated(stated(place(description::Handle::new(levels - 1)), 77));
        })
    };
    assert!(diagnostics(&chain(8)).is_empty());
    let message = "instances are nested more than 8 levels deep";
    check(&chain(9), Severity::Error, "nested-too-deep", message, 1);
    check(&chain(10_000), Severity::Error, "nested-too-deep", message, 9992);
    // The inner object was built before, at less depth.
    let twice = with(|desc| {
        *desc = chain(9);
        let mut instances = description::Arena::default();
        instances.push(place(description::Handle::new(7)));
        instances.push_stated(stated(place(description::Handle::new(8)), 78));
        desc.instances = instances;
    });
    check(&twice, Severity::Error, "nested-too-deep", message, 8);
}

#[test]
fn unusable_images_are_errors() {
    let error = |desc: &SceneDesc, code: &str, message: &str| check(desc, Severity::Error, code, message, 5);
    error(&image_sky(gray_image(), None), "image-channels", "the image of a light needs red, green and blue");
    error(
        &image_sky(rgb_image(4, 3, |_, _| [1.0; 3]), None),
        "image-shape",
        "the image of an infinite light is square (equal-area octahedral) or twice as wide as high (latitude–longitude), not 4 × 3",
    );
    error(
        &image_sky(rgb_image(4, 4, |x, _| [if x == 2 { f32::NAN } else { 1.0 }; 3]), None),
        "image-values",
        "the image of a light has infinite or NaN values",
    );
    error(
        &image_sky(rgb_image(4, 4, |_, _| [0.0; 3]), Some(100.0)),
        "image-values",
        "an image that is black above cannot be scaled to an illuminance",
    );
    let area = with(|desc| {
        let image = Some(UvImageDesc::new(desc.images.push(gray_image()), WrapMode::Clamp));
        let light = AreaLightDesc { image, ..AreaLightDesc::new(1.0.into()) };
        let area_light = Some(desc.area_lights.push_stated(with_parameter(light, "filename", 5)));
        // Reported once for any number of shapes.
        for _ in 0..3 {
            desc.shapes.push(ShapeDesc { area_light, ..sphere(1.0).into() });
        }
    });
    error(&area, "image-channels", "the image of a light needs red, green and blue");
    let normals = with(|desc| {
        let normal_map = Some(UvImageDesc::new(desc.images.push(gray_image()), WrapMode::Repeat));
        let material = MaterialDesc { normal_map, ..MaterialDesc::default() };
        desc.materials.push_stated(with_parameter(material, "normalmap", 5));
    });
    error(&normals, "image-channels", "a normal map needs red, green and blue");
}

#[test]
fn invalid_lights_are_errors() {
    let plane = with(|desc| {
        let area_light = Some(desc.area_lights.push(AreaLightDesc::new(1.0.into())));
        desc.shapes.push_stated(stated(ShapeDesc { area_light, ..ShapeKind::Plane.into() }, 8));
    });
    let message = "an infinite plane cannot emit: its power would be infinite";
    check(&plane, Severity::Error, "infinite-light", message, 8);
    let nowhere = with(|desc| {
        let kind =
            LightKind::Distant { radiance: 1.0.into(), illuminance: None, from: Vec3::ONE, to: Vec3::ONE };
        desc.lights.push_stated(with_parameter(kind.into(), "to", 9));
    });
    let message = "`from` and `to` must differ: they give the direction";
    check(&nowhere, Severity::Error, "invalid-value", message, 9);
    let unnamed = with(|desc| {
        let intensity = SpectrumDesc::Named("no-such".into());
        let kind = LightKind::Point { intensity, power: None, from: Vec3::ZERO };
        desc.lights.push_stated(with_parameter(kind.into(), "I", 10));
    });
    check(&unnamed, Severity::Error, "invalid-value", "there is no spectrum named `no-such`", 10);
}

#[test]
fn inconsistent_meshes_are_errors() {
    let shape = |kind: ShapeKind| with(|desc| desc.shapes.push_stated(stated(kind.into(), 3)));
    let message = "a patch refers to a vertex that does not exist";
    let patches = |indices, normals: usize| {
        ShapeKind::Patches(PatchMeshDesc {
            indices: [indices].into(),
            positions: [Vec3::ZERO; 4].into(),
            normals: vec![Vec3::Z; normals].into(),
            ..PatchMeshDesc::default()
        })
    };
    check(&shape(patches([0, 1, 2, 4], 0)), Severity::Error, "invalid-mesh", message, 3);
    let message = "a patch mesh needs as many normals and texture coordinates as vertices, or none";
    check(&shape(patches([0, 1, 2, 3], 3)), Severity::Error, "invalid-mesh", message, 3);
    let all = diagnostics(&shape(triangles(&[[0.0; 3]; 3], &[[0, 1, 3]])));
    assert!(all.len() == 1 && all[0].code == "invalid-mesh" && all[0].span() == span(3), "{all:?}");
}

#[test]
fn all_errors_are_reported_at_once() {
    let desc = with(|desc| {
        desc.shapes.push_stated(stated(ShapeDesc { world_from_object: flat(), ..sphere(1.0).into() }, 1));
        let eta = SpectrumDesc::Named("no-glass".into());
        desc.materials.push_stated(stated(MaterialKind::ThinDielectric { eta }.into(), 2));
        let kind = LightKind::Point { intensity: f32::NAN.into(), power: None, from: Vec3::ZERO };
        desc.lights.push_stated(stated(kind.into(), 3));
        desc.camera.camera_from_world = flat();
    });
    let all = diagnostics(&desc);
    let places: Vec<_> = all.iter().map(|d| d.span().start).collect();
    assert!([1, 2, 3].iter().all(|start| places.contains(start)) && all.len() == 4, "{all:?}");
}

fn curve() -> CurveDesc {
    CurveDesc {
        control_points: [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ONE].into(),
        degree: 3,
        basis: CurveBasis::Bezier,
        profile: CurveProfile::Flat,
        normals: [].into(),
        width: [0.1; 2],
        split_depth: 3,
    }
}

fn invalid(kind: ShapeKind, parameter: &'static str, code: &str, message: &str) {
    let shape = with_parameter(kind.into(), parameter, 5);
    check(&with(|desc| desc.shapes.push_stated(shape)), Severity::Error, code, message, 5);
}

#[test]
fn curves_are_checked() {
    let desc = with(|desc| {
        let light = desc.area_lights.push(AreaLightDesc::new(SpectrumDesc::rgb(1.0, 1.0, 1.0)));
        let shape = ShapeDesc { area_light: Some(light), ..ShapeKind::Curve(curve()).into() };
        desc.shapes.push_stated(stated(shape, 4));
    });
    check(&desc, Severity::Warning, "light-ignored", "curves do not emit; drawn without light", 4);
    assert_eq!(compile(desc).unwrap().scene.lights().len(), 0);
    let bare = CurveDesc { profile: CurveProfile::Ribbon, ..curve() };
    invalid(ShapeKind::Curve(bare), "N", "invalid-curve", "a ribbon of 1 segments needs 2 normals");
    let linear = CurveDesc { degree: 1, ..curve() };
    invalid(ShapeKind::Curve(linear), "degree", "invalid-curve", "a curve of degree 1, not 2 or 3");
}

#[test]
fn curves_are_at_their_control_points() {
    let desc = with(|desc| {
        let curve = CurveDesc {
            control_points: [-3.0, -1.0, 1.0, 3.0].map(|x| Vec3::new(x, 0.0, 0.0)).into(),
            width: [0.4, 0.2],
            split_depth: 1,
            ..curve()
        };
        let to = DMat4::from_translation(DVec3::new(0.0, 1.0, 5.0));
        let world_from_object = TransformDesc::fixed(to);
        desc.shapes.push(ShapeDesc { world_from_object, ..ShapeKind::Curve(curve).into() });
    });
    let scene = compile(desc).unwrap().scene;
    let hits = |y: f32, x: f32| {
        let ray = Ray::new(Vec3::new(x, y, 0.0), Vec3::Z, 0.0);
        scene.intersect(&ray, f32::INFINITY, &mut RayStats::default()).map(|hit| hit.1)
    };
    assert!((hits(1.0, 0.1).unwrap() - 5.0).abs() < 1e-5);
    // Half as wide at the end as at the start.
    assert!(hits(1.19, -2.99).is_some() && hits(1.19, 2.9).is_none() && hits(1.09, 2.9).is_some());
    assert!(hits(1.0, -3.01).is_none() && hits(1.21, -2.9).is_none());
}

#[test]
fn successive_curves_become_one_geometry() {
    let shape = |curve: CurveDesc| ShapeDesc::from(ShapeKind::Curve(curve));
    let ribbon = || CurveDesc { profile: CurveProfile::Ribbon, normals: [Vec3::Z; 2].into(), ..curve() };
    let desc = with(|desc| {
        desc.shapes.push(shape(curve()));
        desc.shapes.push(shape(CurveDesc { width: [0.3; 2], degree: 2, ..curve() }));
        desc.shapes.push(shape(CurveDesc { basis: CurveBasis::BSpline, ..curve() }));
        desc.shapes.push(ShapeDesc { reverse_orientation: true, ..shape(curve()) });
        desc.shapes.push(ShapeDesc { alpha: Some(0.5.into()), ..shape(curve()) });
        desc.shapes.push(ShapeDesc { world_from_object: moving(), ..shape(curve()) });
        desc.shapes.push(ShapeDesc { world_from_object: moving(), ..shape(curve()) });
        desc.shapes.push(shape(ribbon()));
        desc.shapes.push(shape(ribbon()));
        desc.shapes.push(shape(CurveDesc { split_depth: 0, ..ribbon() }));
    });
    let scene = compile(desc).unwrap().scene;
    // The four points are one segment of degree 3, or one of degree 2 and a leftover point.
    let parts: Vec<_> = (0..6).map(|id| scene.world().geometry(GeometryId(id)).len()).collect();
    assert_eq!(parts, [24, 8, 8, 16, 16, 1]);
}

fn square() -> MeshDesc {
    MeshDesc {
        indices: [[0, 1, 2], [0, 2, 3]].into(),
        positions: [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y].map(|p| p + Vec3::Z).into(),
        uvs: [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y].into(),
        ..MeshDesc::default()
    }
}

#[test]
fn subdivision_is_checked_and_bounded() {
    let of = |indices: &[[u32; 3]], levels| {
        let mesh = MeshDesc { indices: indices.into(), uvs: [].into(), ..square() };
        ShapeKind::LoopSubdivision { mesh, levels }
    };
    let message = "triangle 0 has vertex index 4, which does not exist";
    invalid(of(&[[0, 1, 4]], 1), "indices", "invalid-mesh", message);
    let message = "the edge from vertex 1 to vertex 2 is not shared by two triangles of the same orientation";
    invalid(of(&[[0, 1, 2], [1, 2, 3]], 1), "indices", "invalid-mesh", message);
    invalid(of(&[[0, 1, 2]], 13), "levels", "invalid-mesh", "too many triangles");
    let scene = compile(with(|desc| desc.shapes.push(of(&[[0, 1, 2], [0, 2, 3]], 2).into()))).unwrap().scene;
    assert_eq!(scene.world().geometry(GeometryId(0)).len(), 32);
}

fn displaced(triangles: MeshDesc, edge_length: f32) -> ShapeKind {
    let patches = PatchMeshDesc {
        indices: [].into(),
        positions: triangles.positions.clone(),
        uvs: triangles.uvs.clone(),
        ..PatchMeshDesc::default()
    };
    ShapeKind::PlyMesh { triangles, patches, displacement: Some(0.25.into()), edge_length }
}

#[test]
fn displacement_is_checked_and_bounded() {
    let bare = displaced(MeshDesc { uvs: [].into(), ..square() }, 1.0);
    invalid(bare, "displacement", "invalid-mesh", "0 texture coordinates for 4 vertices");
    invalid(displaced(square(), 1e-5), "edgelength", "invalid-mesh", "too many triangles");
}

#[test]
fn displaced_meshes_move_by_their_texture() {
    // The square is wound to face +z, and moves that way by a quarter; the option doubles the
    // edges.
    for (scale, triangles) in [(1.0, 16), (2.0, 4)] {
        let mut desc = with(|desc| desc.shapes.push(displaced(square(), 0.7).into()));
        desc.options.displacement_edge_scale = scale;
        let scene = compile(desc).unwrap().scene;
        assert_eq!(scene.world().geometry(GeometryId(0)).len(), triangles);
        let ray = Ray::new(Vec3::new(0.3, 0.4, 0.0), Vec3::Z, 0.0);
        let (hit, t) = scene.intersect(&ray, f32::INFINITY, &mut RayStats::default()).unwrap();
        assert!((t - 1.25).abs() < 1e-6 && hit.surface.shading.n == Vec3::Z);
        assert!(hit.surface.uv.distance(Vec2::new(0.3, 0.4)) < 1e-6);
    }
    // The same as a quadrilateral.
    let square = square();
    let patches = PatchMeshDesc {
        indices: [[0, 1, 3, 2]].into(),
        positions: square.positions.clone(),
        uvs: square.uvs.clone(),
        ..PatchMeshDesc::default()
    };
    let triangles = MeshDesc { indices: [].into(), ..square };
    let kind = ShapeKind::PlyMesh { triangles, patches, displacement: Some(0.5.into()), edge_length: 0.7 };
    let scene = compile(with(|desc| desc.shapes.push(kind.into()))).unwrap().scene;
    assert_eq!(scene.world().geometry(GeometryId(0)).len(), 16);
    let ray = Ray::new(Vec3::new(0.6, 0.4, 0.0), Vec3::Z, 0.0);
    assert!((scene.intersect(&ray, 9.0, &mut RayStats::default()).unwrap().1 - 1.5).abs() < 1e-6);
}

fn moving() -> TransformDesc {
    let at = |x| DMat4::from_translation(DVec3::new(x, 0.0, 5.0));
    TransformDesc { start: at(-2.0), end: at(2.0), times: [0.0, 1.0] }
}

#[test]
fn portals_are_rectangles() {
    let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z];
    let light = |corners| {
        let radiance = InfiniteRadiance::Constant(1.0.into());
        let portal = LightKind::Infinite { radiance, illuminance: None, portal: Some(corners) };
        with(|desc| desc.lights.push_stated(with_parameter(portal.into(), "portal", 7)))
    };
    let message = "the four points of `portal` must be the corners of a rectangle, in their order";
    for corners in [
        [Vec3::ZERO; 4],
        [Vec3::ZERO, x, y, x + y],
        [Vec3::ZERO, x, x + y + 0.1 * z, y],
        [Vec3::ZERO, x, x + y, y + 0.1 * x],
        [Vec3::ZERO, x, 2.0 * x + y, x + y],
    ] {
        check(&light(corners), Severity::Error, "invalid-value", message, 7);
    }
    let mut moving = light([Vec3::ZERO, 3.0 * x, 3.0 * x + y, y]);
    assert!(compile(moving.clone()).is_ok());
    for (_, light) in moving.lights.iter_mut() {
        light.world_from_light.end = DMat4::from_rotation_x(1.0);
    }
    let message = "the light behind a portal does not move; drawn as at the start of motion";
    warns(&moving, message, 1000);
}

#[test]
fn images_of_lights_are_checked() {
    let image = |width, height, value| rgb_image(width, height, move |_, _| [value; 3]);
    let goniometric = |image, power| {
        with(|desc| {
            let image = Some(desc.images.push(image));
            let kind = LightKind::Goniometric { intensity: 1.0.into(), power, image };
            desc.lights.push_stated(with_parameter(kind.into(), "filename", 4));
        })
    };
    let projection = |image, power| {
        with(|desc| {
            let image = desc.images.push(image);
            let kind = LightKind::Projection { image: Some(image), power, fov: 60.0 };
            desc.lights.push_stated(with_parameter(kind.into(), "filename", 4));
        })
    };
    let square = "the image of a goniometric light is square (equal-area octahedral), not 2 × 3";
    let fails = |desc: &SceneDesc, code: &str, message: &str| check(desc, Severity::Error, code, message, 4);
    fails(&goniometric(image(2, 3, 1.0), None), "image-shape", square);
    let finite = "the image of a light has infinite or NaN values";
    fails(&goniometric(image(2, 2, f32::NAN), None), "image-values", finite);
    fails(&projection(image(2, 3, f32::INFINITY), None), "image-values", finite);
    let black = "a black image cannot be scaled to a power";
    fails(&goniometric(image(2, 2, 0.0), Some(1.0)), "image-values", black);
    fails(&projection(image(2, 3, 0.0), Some(1.0)), "image-values", black);
    let channels = "the image of a light needs red, green and blue";
    fails(&projection(gray_image(), None), "image-channels", channels);
    assert!(compile(goniometric(gray_image(), None)).is_ok());
}

#[test]
fn emissive_primitives_map_to_their_lights() {
    let desc = with(|desc| {
        let light = |desc: &mut SceneDesc| Some(desc.area_lights.push(AreaLightDesc::new(1.0.into())));
        // Dark, two triangles, dark, one ball, then lights that are no surfaces.
        desc.shapes.push(ShapeDesc {
            world_from_object: TransformDesc::translation(20.0, 0.0, 5.0),
            ..sphere(1.0).into()
        });
        let area_light = light(desc);
        let quad = triangles(
            &[[-1.0, -1.0, 5.0], [1.0, -1.0, 5.0], [1.0, 1.0, 5.0], [-1.0, 1.0, 5.0]],
            &[[0, 1, 2], [0, 2, 3]],
        );
        desc.shapes.push(ShapeDesc { area_light, ..quad.into() });
        desc.shapes.push(ShapeDesc {
            world_from_object: TransformDesc::translation(-20.0, 0.0, 5.0),
            ..sphere(1.0).into()
        });
        let area_light = light(desc);
        desc.shapes.push(ShapeDesc {
            area_light,
            world_from_object: TransformDesc::translation(5.0, 0.0, 5.0),
            ..sphere(1.0).into()
        });
        desc.lights.push(LightKind::Point { intensity: 1.0.into(), power: None, from: Vec3::ZERO }.into());
        let radiance = InfiniteRadiance::Constant(1.0.into());
        desc.lights.push(LightKind::Infinite { radiance, illuminance: None, portal: None }.into());
    });
    let scene = scene(&desc);
    let light =
        |x, y| hit(&scene, &ray(Vec3::new(x, y, 0.0), Vec3::Z)).and_then(|surface| surface.area_light);
    assert_eq!(light(20.0, 0.0), None);
    assert_eq!(light(-20.0, 0.0), None);
    assert_eq!(light(0.5, -0.5), Some(LightId(0)));
    assert_eq!(light(-0.5, 0.5), Some(LightId(1)));
    assert_eq!(light(5.0, 0.0), Some(LightId(2)));
    assert_eq!(scene.lights().len(), 5);
    assert_eq!(scene.infinite_lights(), [LightId(4)]);
    // Light samples lie on the primitive that the id names.
    for (id, x, y) in [(0, 0.5, -0.5), (1, -0.5, 0.5)] {
        let from = context(Vec3::new(0.0, 0.0, 8.0), Vec3::ZERO);
        let sample = scene.sample_light(LightId(id), &from, math::Vec2::splat(0.3), &lambda(), false);
        let p = sample.expect("the lit side").p.expect("a surface").p;
        assert_eq!(light(p.x, p.y), light(x, y));
    }
}
