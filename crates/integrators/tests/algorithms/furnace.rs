//! Furnace tests: scenes with the same known radiance everywhere.

use alhazen_integrators::{Path, RayCasting, Whitted};
use description::{MaterialKind, PathDesc, SceneDesc, ShapeDesc, ShapeKind, SpectrumDesc, WhittedDesc};
use scene::{Interfaces, Scene};
use testkit::Moments;

use crate::support::{
    Unbiased, assert_mean, at, compile, diffuse, emission, glass, mirror, radiance, sphere, v, walls,
    white_sky,
};

/// Surfaces of reflectance ρ that emit 1 and enclose everything: L = Σ ρᵏ = 1/(1 − ρ).
fn closed(shapes: impl IntoIterator<Item = ShapeDesc>, rho: f32) -> Scene {
    let mut desc = SceneDesc::default();
    let (material, area_light) = (diffuse(&mut desc, rho), emission(&mut desc, 1.0));
    for shape in shapes {
        desc.shapes.push(ShapeDesc { material, area_light, ..shape });
    }
    compile(&desc)
}

fn closed_sphere(rho: f32) -> Scene {
    closed([ShapeDesc { reverse_orientation: true, ..at(sphere(1.0), v(0.2, 0.1, 0.3)) }], rho)
}

fn closed_box(rho: f32) -> Scene {
    closed(walls(1.0).map(ShapeDesc::from), rho)
}

#[test]
fn radiance_in_a_furnace_is_emission_over_absorption() {
    let tests = 2 * Unbiased::all(0).len();
    for (shape, scene) in [("sphere", closed_sphere(0.5)), ("box", closed_box(0.5))] {
        for (name, mut rays) in Unbiased::all(24) {
            let found = radiance(&mut rays, &scene, v(0.0, 0.0, 0.0), v(0.3, -0.5, 0.7), 6_000);
            assert_mean(&found, 2.0, tests, &format!("{name} in a {shape}"));
        }
    }
}

#[test]
fn direct_light_algorithms_show_one_reflection_in_a_furnace() {
    let scene = closed_box(0.5);
    let (o, d) = (v(0.0, 0.0, 0.0), v(0.3, -0.5, 0.7));
    assert_mean(&radiance(&mut RayCasting, &scene, o, d, 20_000), 1.5, 2, "ray casting");
    assert_mean(
        &radiance(
            &mut Whitted::new(WhittedDesc { max_depth: 9, ..Default::default() }),
            &scene,
            o,
            d,
            20_000,
        ),
        1.5,
        2,
        "Whitted",
    );
}

/// The mean radiance of rays from all directions to an object at the origin, under a sky of
/// radiance 1.
fn under_white_sky(
    thing: ShapeKind,
    rays: &mut impl alhazen_integrators::RayIntegrator,
    make: Make,
) -> Moments {
    let mut desc = SceneDesc::default();
    white_sky(&mut desc);
    let material = make(&mut desc);
    desc.shapes.push(ShapeDesc { material, ..thing.into() });
    let scene = compile(&desc);
    let means = (0..200).map(|i| {
        let angle = i as f32;
        let from = v(angle.cos(), angle.sin(), (angle * 0.37).sin()) * 3.0;
        let target = v((angle * 1.7).cos(), (angle * 2.3).sin(), 0.1) * 0.7;
        radiance(rays, &scene, from, target - from, 20).mean
    });
    means.collect()
}

type Make = fn(&mut SceneDesc) -> Option<description::Handle<description::MaterialDesc>>;

#[test]
fn objects_without_absorption_are_invisible_under_a_white_sky() {
    let materials: [(&str, Make); 4] = [
        ("glass", glass),
        ("metal", |desc| mirror(desc, 0.0)),
        ("white", |desc| diffuse(desc, 1.0)),
        ("pane", |desc| {
            Some(
                desc.materials.push(MaterialKind::ThinDielectric { eta: SpectrumDesc::Constant(1.5) }.into()),
            )
        }),
    ];
    for (name, make) in materials {
        let mut path = Path::new(PathDesc { max_depth: 200, ..PathDesc::default() }, Interfaces::Stop);
        let found = under_white_sky(sphere(1.0), &mut path, make);
        assert!((found.mean - 1.0).abs() < 1e-4, "path, {name}: {}", found.mean);
        assert!(found.variance() < 1e-6, "path, {name}: variance {}", found.variance());
    }
}

#[test]
fn whitted_traces_all_rays_in_glass() {
    let found = under_white_sky(
        sphere(1.0),
        &mut Whitted::new(WhittedDesc { max_depth: 12, ..Default::default() }),
        glass,
    );
    assert!((found.mean - 1.0).abs() < 2e-3 && found.variance() < 1e-4, "{found:?}");
}
