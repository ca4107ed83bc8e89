//! The light table: the light of a hit, warnings of scenes without light, errors of invalid
//! emission.

use crate::common::*;
use alhazen_scene::compile;
use description::{
    AreaLightDesc, Diagnostic, FileId, InstanceDesc, LightDesc, LightKind, ObjectDesc, Origin, SceneDesc,
    ShapeDesc, Span, Stated, TransformDesc,
};
use math::{DMat4, DVec3, Vec3};

/// A scene with one change, whose return value is ignored.
fn with<T>(change: impl FnOnce(&mut SceneDesc) -> T) -> SceneDesc {
    let mut desc = SceneDesc::default();
    change(&mut desc);
    desc
}

fn diagnostics(desc: &SceneDesc) -> Vec<Diagnostic> {
    compile(desc.clone()).map_or_else(|errors| errors, |scene| scene.warnings)
}

#[test]
fn hits_of_instances_map_to_the_sampled_light() {
    // An object of two triangles and a ball that emit, twice within another, which has a light of
    // its own and is shown twice, one of them moving; and a light before them all.
    let desc = with(|desc| {
        let area_light = Some(desc.area_lights.push(AreaLightDesc::new(1.0.into())));
        let quad = triangles(
            &[[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]],
            &[[0, 1, 2], [0, 2, 3]],
        );
        let at = |x, y| TransformDesc::translation(x, y, 0.0);
        let ball = |x, y| ShapeDesc { area_light, world_from_object: at(x, y), ..sphere(0.5).into() };
        desc.shapes.push(ball(0.0, -5.0));
        let mut inner = ObjectDesc::default();
        inner.shapes.push(ShapeDesc { area_light, ..quad.into() });
        inner.shapes.push(ball(2.0, 0.0));
        let inner = desc.objects.push(inner);
        let mut outer = ObjectDesc::default();
        outer.instances.push(InstanceDesc { object: inner, world_from_object: at(0.0, 0.0) });
        outer.instances.push(InstanceDesc { object: inner, world_from_object: at(4.0, 0.0) });
        outer.shapes.push(ball(8.0, 0.0));
        let object = desc.objects.push(outer);
        desc.instances.push(InstanceDesc { object, world_from_object: at(0.0, 0.0) });
        let up = DMat4::from_translation(DVec3::Y * 10.0);
        let world_from_object = TransformDesc { end: up, ..at(0.0, 5.0) };
        desc.instances.push(InstanceDesc { object, world_from_object });
    });
    let scene = scene(&desc);
    assert_eq!(scene.lights().len(), 15);
    let from = |p: Vec3| context(p, Vec3::ZERO);
    let mut ids = std::collections::HashSet::new();
    for x in [-0.5, 0.5, 2.0, 3.5, 4.5, 6.0, 8.0, 0.0] {
        for y in if x == 0.0 { vec![-5.0] } else { vec![0.0, 5.0 + 5.0 * TIME] } {
            // Near the diagonals, off which the triangles differ.
            let o = Vec3::new(x, y - 0.1 * x.signum(), 9.0);
            let id = hit(&scene, &ray(o, -Vec3::Z)).and_then(|s| s.area_light).expect("a light");
            assert!(ids.insert(id), "a light of its own at ({x}, {y})");
            assert!(scene.light(id).pdf_li(&from(o), -Vec3::Z, None, false) > 0.0);
            for u in [[0.2, 0.3], [0.8, 0.6]] {
                let sample = scene.sample_light(id, &from(o), u.into(), &lambda(), false).expect("light");
                assert_eq!(hit(&scene, &ray(o, sample.wi)).and_then(|s| s.area_light), Some(id));
            }
        }
    }
    assert_eq!(ids.len(), 15);
}

#[test]
fn scenes_without_light_give_a_warning() {
    let codes = |desc: &SceneDesc| diagnostics(desc).iter().map(|d| d.code).collect::<Vec<_>>();
    assert_eq!(codes(&SceneDesc::default()), ["empty-scene"]);
    assert_eq!(codes(&with(|desc| desc.shapes.push(sphere(1.0).into()))), ["no-light"]);
    let point = LightKind::Point { intensity: 1.0.into(), power: None, from: Vec3::ZERO };
    assert_eq!(codes(&with(|desc| desc.lights.push(point.clone().into()))), ["empty-scene"]);
    let lit = with(|desc| {
        desc.shapes.push(sphere(1.0).into());
        desc.lights.push(point.into());
    });
    assert_eq!(codes(&lit), [""; 0]);
}

#[test]
fn lights_that_emit_nothing_give_a_warning() {
    let point = |intensity: f32, scale, power| {
        with(|desc| {
            desc.shapes.push(sphere(1.0).into());
            let kind = LightKind::Point { intensity: intensity.into(), power, from: Vec3::ZERO };
            desc.lights.push(LightDesc { scale, ..kind.into() });
        })
    };
    let area = |radiance: f32, scale| {
        with(|desc| {
            let light = desc.area_lights.push(AreaLightDesc { scale, ..AreaLightDesc::new(radiance.into()) });
            desc.shapes.push(ShapeDesc { area_light: Some(light), ..sphere(1.0).into() });
        })
    };
    for (lit, black) in [
        (
            point(1.0, 1.0, Some(5.0)),
            [point(0.0, 1.0, None), point(1.0, 0.0, None), point(1.0, 1.0, Some(0.0))],
        ),
        (area(1.0, 1.0), [area(0.0, 1.0), area(1.0, 0.0), area(0.0, 2.0)]),
    ] {
        assert_eq!(diagnostics(&lit), []);
        for desc in black {
            let [warning] = &diagnostics(&desc)[..] else { panic!("one warning") };
            assert!(warning.code == "black-light" && !warning.is_error(), "{}", warning.message);
        }
    }
}

#[test]
fn invalid_emission_is_an_error() {
    let span = Span::new(FileId(0), 7, 8);
    let light = |scale, power| {
        with(|desc| {
            let kind = LightKind::Point { intensity: 1.0.into(), power, from: Vec3::ZERO };
            let light = LightDesc { scale, ..kind.into() };
            desc.lights.push_stated(Stated::new(light, Origin::new(span)));
        })
    };
    let [refused] = &diagnostics(&light(-2.0, None))[..] else { panic!("one error") };
    assert_eq!(refused.message, "`scale` of a light is -2; it must be finite and not negative");
    assert!(refused.is_error() && refused.span() == span);
    let codes = |desc: &SceneDesc| diagnostics(desc).iter().map(|d| d.code).collect::<Vec<_>>();
    assert_eq!(codes(&light(1.0, Some(-1.0))), ["invalid-value"]);
    let glaring = with(|desc| {
        let light = AreaLightDesc { scale: f32::MAX, ..AreaLightDesc::new(1e-20.into()) };
        desc.area_lights.push(light);
    });
    assert_eq!(codes(&glaring)[0], "invalid-value");
}
