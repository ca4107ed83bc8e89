//! Facts about whole scenes.

use super::*;
use alhazen_scene::{Occurrence, SceneTraits};
use description::{ConductorDesc, Handle, RoughnessDesc, SolidOperation, Spanned};

fn traits(desc: &SceneDesc) -> SceneTraits {
    compile(desc.clone()).expect("a scene").scene.traits().clone()
}

fn object(desc: &mut SceneDesc, shapes: impl IntoIterator<Item = (ShapeDesc, u32)>) -> Handle<ObjectDesc> {
    let shapes = shapes.into_iter().map(|(shape, start)| stated(shape, start)).collect();
    desc.objects.push(ObjectDesc { shapes, ..ObjectDesc::default() })
}

#[test]
fn shapes_without_bounds_or_patches_are_counted() {
    let mut desc = SceneDesc::default();
    let plane = || ShapeDesc::from(ShapeKind::Plane);
    let solid = |operation, operands: [Handle<ObjectDesc>; 2]| {
        let operands = operands.map(|operand| Spanned { value: operand, span: Span::NONE }).to_vec();
        ShapeDesc::from(ShapeKind::Solid { operation, operands })
    };
    let below = object(&mut desc, [(plane(), 1)]);
    let ball = object(&mut desc, [(sphere(1.0).into(), 2)]);
    let dome = solid(SolidOperation::Intersection, [ball, below]);
    let pit = solid(SolidOperation::Difference, [below, ball]);
    let shown = object(&mut desc, [(plane(), 3), (pit, 4), (sphere(1.0).into(), 5)]);
    for (shape, start) in [(plane(), 8), (dome, 7), (plane(), 6)] {
        desc.shapes.push_stated(stated(shape, start));
    }
    let kind = |kind, first, count| Occurrence { kind, first: span(first), count };
    let found = traits(&desc);
    assert_eq!(found.unbounded_shapes, [kind("plane", 6, 2)]);
    assert_eq!(found.shapes_without_patches, [kind("plane", 6, 2), kind("csg", 7, 1)]);
    for _ in 0..2 {
        desc.instances.push(InstanceDesc { object: shown, world_from_object: TransformDesc::default() });
    }
    let found = traits(&desc);
    assert_eq!(found.unbounded_shapes, [kind("plane", 3, 3), kind("csg", 4, 1)]);
    assert_eq!(found.shapes_without_patches, [kind("plane", 3, 3), kind("csg", 4, 2)]);
}

#[test]
fn materials_in_use_that_are_not_diffuse_are_counted() {
    let mut desc = SceneDesc::default();
    let mut material = |kind: MaterialKind, start| desc.materials.push_stated(stated(kind.into(), start));
    let glass =
        || MaterialKind::Dielectric { eta: SpectrumDesc::Constant(1.5), roughness: RoughnessDesc::default() };
    let paper = material(MaterialKind::Diffuse { reflectance: 0.5.into() }, 1);
    let metal = material(MaterialKind::Conductor(ConductorDesc::default()), 2);
    let _unused = material(glass(), 3);
    let mixed = material(glass(), 4);
    let mix = material(MaterialKind::Mix { materials: [metal, mixed], amount: 0.5.into() }, 5);
    for material in [paper, mix, mix] {
        desc.shapes.push(ShapeDesc { material: Some(material), ..sphere(1.0).into() });
    }
    let kind = |kind, first| Occurrence { kind, first: span(first), count: 1 };
    assert_eq!(traits(&desc).materials_not_diffuse, [kind("conductor", 2), kind("dielectric", 4)]);
}

#[test]
fn light_from_infinity_is_recorded() {
    let mut desc = SceneDesc::default();
    let point = LightKind::Point { intensity: 1.0.into(), power: None, from: Vec3::ZERO };
    desc.lights.push(point.into());
    assert!(!traits(&desc).is_lit_from_infinity);
    let (from, to) = (Vec3::ZERO, Vec3::Z);
    desc.lights.push(LightKind::Distant { radiance: 1.0.into(), illuminance: None, from, to }.into());
    assert!(traits(&desc).is_lit_from_infinity);
}
