//! Implicit surfaces and solids: hits, and diagnostics of invalid ones.

use crate::common::*;
use alhazen_scene::{RayStats, compile};
use description::{
    AreaLightDesc, Diagnostic, FileId, Handle, ObjectDesc, Origin, SceneDesc, ShapeDesc, ShapeKind,
    SolidOperation, Span, Spanned, SpectrumDesc, Stated, TransformDesc,
};
use math::{DMat4, DVec3, Ray, Vec3};

fn span(start: u32, end: u32) -> Span {
    Span::new(FileId(0), start, end)
}

/// A formula whose opening quote is byte 100.
fn implicit(text: &str) -> ShapeKind {
    let formula = Spanned::new(text.to_owned(), span(100, 102 + text.len() as u32));
    ShapeKind::Implicit { formula, bounds: [Vec3::splat(-2.0), Vec3::splat(2.0)] }
}

fn object(desc: &mut SceneDesc, shapes: impl IntoIterator<Item = ShapeDesc>) -> Spanned<Handle<ObjectDesc>> {
    let shapes = shapes.into_iter().map(|shape| Stated::new(shape, Origin::new(span(40, 50)))).collect();
    Spanned::new(
        desc.objects.push(ObjectDesc { name: "part".into(), shapes, ..ObjectDesc::default() }),
        span(20, 30),
    )
}

fn solid(operation: SolidOperation, operands: Vec<Spanned<Handle<ObjectDesc>>>) -> ShapeDesc {
    ShapeKind::Solid { operation, operands }.into()
}

/// The only diagnostic of a shape.
fn message(mut desc: SceneDesc, shape: ShapeDesc) -> Diagnostic {
    desc.shapes.push_stated(Stated::new(shape, Origin::new(span(0, 10))));
    let mut all = match compile(desc) {
        Ok(compiled) => compiled.warnings,
        Err(errors) => errors,
    };
    all.retain(|diagnostic| diagnostic.code != "no-light");
    assert_eq!(all.len(), 1, "{all:?}");
    all.remove(0)
}

/// The distance along z at which a scene of one shape is hit from below.
fn met(mut desc: SceneDesc, shape: ShapeDesc) -> Option<f32> {
    desc.shapes.push(shape);
    let compiled = compile(desc).expect("a scene");
    assert!(compiled.warnings.iter().all(|warning| warning.code == "no-light"), "{:?}", compiled.warnings);
    let ray = Ray::new(Vec3::new(0.0, 0.0, -5.0), Vec3::Z, 0.0);
    let (hit, _) = compiled.scene.intersect(&ray, f32::INFINITY, &mut RayStats::default())?;
    Some(hit.surface.p.p.z)
}

#[test]
fn implicit_surfaces_and_solids_are_hit() {
    assert_eq!(met(SceneDesc::default(), implicit("x^2 + y^2 + z^2 - 1").into()), Some(-1.0));
    let mut desc = SceneDesc::default();
    let ball = object(&mut desc, [sphere(1.0).into()]);
    let moved = TransformDesc::fixed(DMat4::from_translation(DVec3::new(0.0, 0.0, -1.0)));
    let bite = object(&mut desc, [ShapeDesc { world_from_object: moved, ..sphere(0.5).into() }]);
    let bitten = solid(SolidOperation::Difference, vec![ball, bite]);
    assert_eq!(met(desc.clone(), bitten.clone()), Some(-0.5));
    // A nested solid, scaled by two.
    let part = object(&mut desc, [bitten]);
    let shape = solid(SolidOperation::Intersection, vec![part, ball]);
    let world_from_object = TransformDesc::fixed(DMat4::from_scale(DVec3::splat(2.0)));
    assert_eq!(met(desc, ShapeDesc { world_from_object, ..shape }), Some(-1.0));
}

#[test]
fn errors_in_formulas_are_located() {
    let wrong = message(SceneDesc::default(), implicit("x^2 + siin(y)").into());
    assert_eq!((wrong.code, &wrong.message[..]), ("invalid-formula", "there is no `siin` in formulas"));
    assert_eq!(wrong.span(), span(107, 111));
    assert!(wrong.help.is_some_and(|help| help.contains("sin")));
    let ends = message(SceneDesc::default(), implicit("x +").into());
    assert_eq!(ends.span(), span(104, 104), "at the closing quote");
    let nowhere = message(SceneDesc::default(), implicit("x^2 + 1").into());
    assert_eq!(nowhere.message, "the formula has no zero within its bounds");
    assert!(!nowhere.is_error());
}

#[test]
fn huge_bounds_work_or_are_an_error() {
    let within = |half: f32| {
        let text = "x^2 + y^2 + z^2 - 1".to_owned();
        let formula = Spanned { value: text, span: span(103, 124) };
        ShapeKind::Implicit { formula, bounds: [Vec3::splat(-half), Vec3::splat(half)] }
    };
    for half in [1e6, 1e9, 1e12, 1e18] {
        assert_eq!(met(SceneDesc::default(), within(half).into()), Some(-1.0), "{half}");
    }
    let wrong = message(SceneDesc::default(), within(3e38).into());
    assert_eq!((wrong.code, wrong.span()), ("invalid-bounds", span(103, 124)));
    assert!(wrong.is_error());
}

#[test]
fn open_shapes_are_not_operands_of_solids() {
    let disk = ShapeKind::Disk { height: 0.0, radius: 1.0, inner_radius: 0.0, phi_max: 360.0 };
    let half = ShapeKind::Sphere { radius: 1.0, z_min: -1.0, z_max: 1.0, phi_max: 180.0 };
    for (kind, what) in [(disk, "a disk"), (half, "a shape whose `phimax` is below 360")] {
        let mut desc = SceneDesc::default();
        let operands = vec![object(&mut desc, [sphere(1.0).into()]), object(&mut desc, [kind.into()])];
        let wrong = message(desc, solid(SolidOperation::Union, operands));
        assert_eq!(wrong.message, format!("{what} cannot be part of a solid"));
        assert_eq!((wrong.code, wrong.span(), wrong.labels[1].0), ("not-closed", span(40, 50), span(0, 10)));
    }
    let mut desc = SceneDesc::default();
    let operands = vec![object(&mut desc, [sphere(1.0).into()]), object(&mut desc, [])];
    let empty = message(desc, solid(SolidOperation::Union, operands));
    assert_eq!((&empty.message[..], empty.span()), ("the object `part` has no shapes", span(20, 30)));
}

#[test]
fn size_and_depth_of_solids_are_limited() {
    // Twice as many parts with every object; one more level with every object.
    for (copies, depth, text) in [(2, 12, "1024 parts"), (1, 40, "32 levels deep")] {
        let mut desc = SceneDesc::default();
        let ball = object(&mut desc, [sphere(1.0).into()]);
        let mut last = ball;
        for _ in 0..depth {
            let mut operands = vec![last; copies];
            operands.push(ball);
            let shape = solid(SolidOperation::Union, operands);
            last = object(&mut desc, [shape]);
        }
        let large = message(desc, solid(SolidOperation::Union, vec![last, ball]));
        assert_eq!((large.code, large.span()), ("too-large", span(0, 10)));
        assert!(large.message.contains(text), "{}", large.message);
    }
}

#[test]
fn implicit_surfaces_and_solids_do_not_emit() {
    let mut desc = SceneDesc::default();
    let area_light = Some(desc.area_lights.push(AreaLightDesc::new(SpectrumDesc::Constant(1.0))));
    let dark = message(desc, ShapeDesc { area_light, ..implicit("x").into() });
    assert_eq!(dark.message, "solids and surfaces given by formulas do not emit; drawn without light");
    assert_eq!((dark.span(), dark.is_error()), (span(0, 10), false));
}
