//! Sphere sets in a scene: each sphere can emit, and equals a single sphere under any transform.

use crate::common::*;
use alhazen_scene::compile;
use description::{AreaLightDesc, SceneDesc, ShapeDesc, ShapeKind, SpectrumDesc, SpheresDesc, TransformDesc};
use math::{DMat4, DVec3, Vec3};

fn spheres(centers: &[Vec3], radii: &[f32]) -> ShapeKind {
    ShapeKind::Spheres(SpheresDesc { centers: centers.into(), radii: radii.into() })
}

fn desc(shapes: impl IntoIterator<Item = ShapeDesc>) -> SceneDesc {
    let mut desc = SceneDesc::default();
    for shape in shapes {
        desc.shapes.push(shape);
    }
    desc
}

#[test]
fn spheres_of_a_set_equal_single_spheres() {
    let centers = [Vec3::ZERO, Vec3::new(2.0, 0.5, 0.0), Vec3::new(-2.0, 0.0, 1.0)];
    let radii = [0.5, 0.8, 0.3];
    let turned = DMat4::from_axis_angle(DVec3::new(1.0, 2.0, 2.0) / 3.0, 0.7);
    for size in [DVec3::splat(2.0), DVec3::new(2.0, 2.0, -2.0), DVec3::new(0.5, 1.0, 3.0)] {
        let place = turned * DMat4::from_scale(size);
        let placed = |kind: ShapeKind, m: DMat4| ShapeDesc {
            world_from_object: TransformDesc::fixed(m),
            ..kind.into()
        };
        let set = scene(&desc([placed(spheres(&centers, &radii), place)]));
        let alone = scene(&desc(centers.iter().zip(radii).map(|(center, radius)| {
            placed(sphere(radius), place * DMat4::from_translation(center.as_dvec3()))
        })));
        let mut hits = 0;
        for i in 0..2000 {
            let angle = i as f32 * 0.1;
            let o = Vec3::new(9.0 * angle.cos(), 9.0 * angle.sin(), i as f32 * 0.01 - 10.0);
            let ray = ray(o, Vec3::new(angle.sin() - 0.2, -angle.cos() + 0.1, 0.3) - o);
            let [a, b] = [hit(&set, &ray), hit(&alone, &ray)];
            assert_eq!(a.is_some(), b.is_some(), "{ray:?}");
            if let (Some(a), Some(b)) = (a, b) {
                hits += 1;
                assert!(a.surface.p.p.distance(b.surface.p.p) < 1e-4, "{ray:?}");
                assert!(a.surface.n.distance(b.surface.n) < 1e-3, "{ray:?}");
            }
        }
        assert!(hits > 200, "{hits} rays met something");
    }
}

#[test]
fn each_emissive_sphere_is_a_light() {
    let centers = [Vec3::ZERO, Vec3::X * 3.0];
    let mut desc = desc([]);
    let light = desc.area_lights.push(AreaLightDesc::new(SpectrumDesc::rgb(1.0, 1.0, 1.0)));
    desc.shapes.push(ShapeDesc { area_light: Some(light), ..spheres(&centers, &[0.5]).into() });
    let scene = scene(&desc);
    assert_eq!(scene.lights().len(), 2);
    for center in centers {
        let from = context(center + Vec3::Y * 4.0, Vec3::ZERO);
        assert!(arriving(&scene, &from, -Vec3::Y) > 0.0);
        assert_eq!(arriving(&scene, &from, Vec3::Y), 0.0);
    }
}

#[test]
fn invalid_sphere_arrays_are_errors() {
    for (centers, radii, message) in [
        (&[Vec3::ZERO; 2][..], &[1.0; 3][..], "3 radii for 2 spheres: give one, or one for each"),
        (&[Vec3::ZERO; 2], &[1.0, 0.0], "radius 1 is 0; it must be finite and above zero"),
        (&[Vec3::NAN], &[1.0], "the centre of sphere 0 is not finite"),
    ] {
        let errors = compile(desc([spheres(centers, radii).into()])).expect_err("errors");
        assert!(errors.len() == 1 && errors[0].code == "invalid-spheres", "{errors:?}");
        assert_eq!(errors[0].message, message);
    }
}
