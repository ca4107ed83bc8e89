//! Direct light on a floor of reflectance ρ: L = ρ/π · E with a known E.

use std::f64::consts::PI;
use std::sync::Arc;

use alhazen_integrators::{RayCasting, RayIntegrator, Whitted};
use description::{
    LightKind, MaterialDesc, MaterialKind, PatchMeshDesc, SceneDesc, ShapeDesc, ShapeKind, SpectrumDesc,
    WhittedDesc,
};
use scene::Scene;

use crate::support::{
    Unbiased, assert_mean, at, compile, diffuse, emission, quad, radiance, sphere, v, white_sky,
};

const RHO: f32 = 0.8;

/// A small floor at z = 0 that faces up, with the objects of `add`.
fn over_a_floor(add: impl FnOnce(&mut SceneDesc)) -> Scene {
    let mut desc = SceneDesc::default();
    let material = diffuse(&mut desc, RHO);
    let floor = quad(v(-0.1, -0.1, 0.0), v(0.2, 0.0, 0.0), v(0.0, 0.2, 0.0));
    desc.shapes.push(ShapeDesc { material, ..floor.into() });
    add(&mut desc);
    compile(&desc)
}

fn lamp(desc: &mut SceneDesc, shape: ShapeDesc) {
    let area_light = emission(desc, 3.0);
    let material = diffuse(desc, 0.0);
    desc.shapes.push(ShapeDesc { area_light, material, ..shape });
}

/// E / (π L) of a rectangle of half sides a and b at height 1 above the point.
fn rectangle_form_factor(a: f64, b: f64) -> f64 {
    let part = |a: f64, b: f64| a / (1.0 + a * a).sqrt() * (b / (1.0 + a * a).sqrt()).atan();
    4.0 / (2.0 * PI) * (part(a, b) + part(b, a))
}

/// Lamps of radiance 3 with E / (π L) at the floor's centre.
fn lamps() -> Vec<(&'static str, Scene, f64)> {
    let disk = ShapeKind::Disk { height: 1.0, radius: 0.5, inner_radius: 0.0, phi_max: 360.0 };
    let disk = ShapeDesc { reverse_orientation: true, ..disk.into() };
    let rectangle = quad(v(-0.3, -0.5, 1.0), v(0.0, 1.0, 0.0), v(0.6, 0.0, 0.0));
    let patch = ShapeKind::Patches(PatchMeshDesc {
        indices: Arc::new([[0, 1, 2, 3]]),
        positions: Arc::new([v(-0.3, -0.5, 1.0), v(-0.3, 0.5, 1.0), v(0.3, -0.5, 1.0), v(0.3, 0.5, 1.0)]),
        ..PatchMeshDesc::default()
    });
    let veil = |desc: &mut SceneDesc| {
        let material = Some(desc.materials.push(MaterialKind::Interface.into()));
        desc.shapes.push(ShapeDesc { material, ..sphere(0.4).into() });
    };
    vec![
        ("disk", over_a_floor(|desc| lamp(desc, disk.clone())), 0.25 / 1.25),
        ("sphere", over_a_floor(|desc| lamp(desc, at(sphere(0.5), v(0.0, 0.0, 1.5)))), 1.0 / 9.0),
        ("rectangle", over_a_floor(|desc| lamp(desc, rectangle.into())), rectangle_form_factor(0.3, 0.5)),
        ("patch", over_a_floor(|desc| lamp(desc, patch.into())), rectangle_form_factor(0.3, 0.5)),
        (
            "disk through an interface",
            over_a_floor(|desc| {
                veil(desc);
                lamp(desc, disk);
            }),
            0.25 / 1.25,
        ),
    ]
}

/// The radiance of the floor's centre, seen from the side, past the lamp.
fn look(rays: &mut impl RayIntegrator, scene: &Scene, count: usize) -> testkit::Moments {
    radiance(rays, scene, v(1.0, 0.2, 0.5), v(-1.0, -0.2, -0.5), count)
}

#[test]
fn irradiance_of_area_lights_equals_the_form_factor() {
    let lamps = lamps();
    let tests = lamps.len() * (Unbiased::all(0).len() + 2);
    for (lamp, scene, form_factor) in &lamps {
        let expected = 3.0 * f64::from(RHO) * form_factor;
        for (name, mut rays) in Unbiased::all(2) {
            assert_mean(&look(&mut rays, scene, 20_000), expected, tests, &format!("{lamp}, {name}"));
        }
        assert_mean(&look(&mut RayCasting, scene, 20_000), expected, tests, &format!("{lamp}, ray casting"));
        let found = look(&mut Whitted::default(), scene, 20_000);
        assert_mean(&found, expected, tests, &format!("{lamp}, Whitted"));
    }
}

/// The floor under a point light at height 2 and a distant one at 60° from the normal.
fn under_delta_lights(add: impl FnOnce(&mut SceneDesc)) -> Scene {
    over_a_floor(|desc| {
        let white = || SpectrumDesc::Constant(1.0);
        let point = LightKind::Point { intensity: white(), power: None, from: v(0.0, 0.0, 2.0) };
        desc.lights.push(point.into());
        let from = v(3f32.sqrt(), 0.0, 1.0);
        let distant = LightKind::Distant { radiance: white(), illuminance: None, from, to: v(0.0, 0.0, 0.0) };
        desc.lights.push(distant.into());
        add(desc);
    })
}

#[test]
fn irradiance_of_point_and_distant_lights_is_exact() {
    let scene = under_delta_lights(|_| ());
    let expected = f64::from(RHO) / PI * (0.25 + 0.5);
    // Algorithms that sample all lights have no noise.
    assert_mean(&look(&mut RayCasting, &scene, 10), expected, 1, "ray casting");
    assert_mean(&look(&mut Whitted::default(), &scene, 10), expected, 1, "Whitted");
    for (name, mut rays) in Unbiased::all(2).into_iter().take(5) {
        assert_mean(&look(&mut rays, &scene, 20_000), expected, 5, &name);
    }
}

#[test]
fn whitted_counts_scattering_events_like_path_tracing() {
    let scene = under_delta_lights(|_| ());
    assert_eq!(
        look(&mut Whitted::new(WhittedDesc { max_depth: 0, ..Default::default() }), &scene, 10).mean,
        0.0,
        "direct light is scattered once"
    );
    let expected = f64::from(RHO) / PI * (0.25 + 0.5);
    assert_mean(
        &look(&mut Whitted::new(WhittedDesc { max_depth: 1, ..Default::default() }), &scene, 10),
        expected,
        1,
        "Whitted",
    );
}

#[test]
fn ambient_light_of_the_sky_casts_no_shadows() {
    let roof = |desc: &mut SceneDesc| {
        white_sky(desc);
        let material = diffuse(desc, 0.5);
        let roof = quad(v(-5.0, -5.0, 2.0), v(10.0, 0.0, 0.0), v(0.0, 10.0, 0.0));
        desc.shapes.push(ShapeDesc { material, ..roof.into() });
    };
    let scene = over_a_floor(roof);
    let mut ambient = Whitted::new(WhittedDesc { ambient: true, ..Default::default() });
    let found = look(&mut ambient, &scene, 100);
    assert!((found.mean - f64::from(RHO)).abs() < 1e-5 && found.variance() < 1e-10, "{found:?}");
    assert!(look(&mut Whitted::default(), &scene, 1000).mean < 0.5 * f64::from(RHO));

    // Leaves scatter the light of both sides.
    let mut desc = SceneDesc::default();
    let (reflectance, transmittance) = (0.3.into(), 0.5.into());
    let leaf = MaterialKind::DiffuseTransmission { reflectance, transmittance, scale: 1.0 };
    let material = Some(desc.materials.push(leaf.into()));
    let floor = quad(v(-0.1, -0.1, 0.0), v(0.2, 0.0, 0.0), v(0.0, 0.2, 0.0));
    desc.shapes.push(ShapeDesc { material, ..floor.into() });
    roof(&mut desc);
    assert_mean(&look(&mut ambient, &compile(&desc), 20_000), 0.8, 1, "a leaf");
}

#[test]
fn only_ray_casting_ignores_shadows() {
    let (lit, shadowed) = (f64::from(RHO) / PI * 0.75, f64::from(RHO) / PI * 0.5);
    // Interfaces do not occlude; but path tracing without media takes them for surfaces where it
    // looks for delta lights.
    for (screen, by_whitted) in [(MaterialDesc::default(), shadowed), (MaterialKind::Interface.into(), lit)] {
        let scene = under_delta_lights(|desc| {
            let material = Some(desc.materials.push(screen));
            let screen = quad(v(-0.5, -0.5, 1.5), v(1.0, 0.0, 0.0), v(0.0, 1.0, 0.0));
            desc.shapes.push(ShapeDesc { material, ..screen.into() });
        });
        assert_mean(&look(&mut RayCasting, &scene, 10), lit, 1, "ray casting");
        assert_mean(&look(&mut Whitted::default(), &scene, 10), by_whitted, 1, "Whitted");
        for (name, mut rays) in Unbiased::all(1).into_iter().take(5) {
            assert_mean(&look(&mut rays, &scene, 20_000), shadowed, 10, &name);
        }
    }
}
