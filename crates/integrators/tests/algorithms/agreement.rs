//! Algorithms that estimate the same radiance, against each other.

use alhazen_integrators::{Path, SimplePath};
use description::{LightKind, PathDesc, SceneDesc, ShapeDesc, SimplePathDesc, SpectrumDesc};
use scene::{Interfaces, Scene};
use testkit::welch_test;

use crate::support::{
    LIGHT_SAMPLERS, Unbiased, at, compile, diffuse, emission, glass, mirror, quad, radiance, sphere, v,
    walls, white_sky,
};

/// A box of grey walls of different brightness with a lamp below its ceiling and a block on its
/// floor.
pub fn room() -> SceneDesc {
    let mut desc = SceneDesc::default();
    for (wall, rho) in walls(1.0).into_iter().zip([0.7, 0.3, 0.5, 0.8, 0.2, 0.6]) {
        let material = diffuse(&mut desc, rho);
        desc.shapes.push(ShapeDesc { material, ..wall.into() });
    }
    let area_light = emission(&mut desc, 5.0);
    let lamp = quad(v(-0.5, -0.5, 0.9), v(0.0, 1.0, 0.0), v(1.0, 0.0, 0.0));
    desc.shapes.push(ShapeDesc { area_light, ..lamp.into() });
    let material = diffuse(&mut desc, 0.4);
    desc.shapes.push(ShapeDesc { material, ..at(sphere(0.3), v(0.3, 0.2, -0.6)) });
    desc
}

#[test]
fn path_algorithms_agree_in_a_room_of_rough_walls() {
    let scene = compile(&room());
    let (o, d) = (v(-0.7, -0.3, 0.0), v(0.7, 0.45, -0.95));
    let mut reference = Path::new(PathDesc { max_depth: 3, ..PathDesc::default() }, Interfaces::Stop);
    let reference = radiance(&mut reference, &scene, o, d, 30_000);
    let all = Unbiased::all(3);
    let tests = all.len();
    for (name, mut rays) in all.into_iter().skip(1) {
        let found = radiance(&mut rays, &scene, o, d, 30_000);
        welch_test(&found, &reference, tests).unwrap_or_else(|difference| panic!("{name}: {difference}"));
    }
}

/// Many lamps of all kinds over a rough mirror, a glass ball and a floor.
fn bazaar() -> Scene {
    let mut desc = SceneDesc::default();
    white_sky(&mut desc);
    let floor = quad(v(-2.0, -2.0, -1.0), v(4.0, 0.0, 0.0), v(0.0, 4.0, 0.0));
    let material = diffuse(&mut desc, 0.5);
    desc.shapes.push(ShapeDesc { material, ..floor.into() });
    let material = mirror(&mut desc, 0.3);
    let mirror = quad(v(-2.0, 2.0, -1.0), v(4.0, 0.0, 0.0), v(0.0, 0.5, 4.0));
    desc.shapes.push(ShapeDesc { material, ..mirror.into() });
    let material = glass(&mut desc);
    desc.shapes.push(ShapeDesc { material, ..at(sphere(0.4), v(0.0, 0.3, -0.5)) });
    for i in 0..9 {
        let angle = i as f32 * 0.7;
        let area_light = emission(&mut desc, 1.0 + i as f32);
        let p = v(angle.cos(), 1.0 + angle.sin(), 0.3 + 0.1 * angle);
        desc.shapes.push(ShapeDesc { area_light, ..at(sphere(0.1), p) });
    }
    let white = || SpectrumDesc::Constant(1.0);
    let point = LightKind::Point { intensity: white(), power: None, from: v(0.5, 0.0, 2.0) };
    desc.lights.push(point.into());
    let (from, to) = (v(-1.0, 0.0, 2.0), v(0.0, 0.5, -1.0));
    let spot = LightKind::Spot {
        intensity: white(),
        power: None,
        from,
        to,
        cone_angle: 40.0,
        cone_delta_angle: 10.0,
    };
    desc.lights.push(spot.into());
    let distant = LightKind::Distant { radiance: white(), illuminance: None, from, to };
    desc.lights.push(distant.into());
    compile(&desc)
}

#[test]
fn light_samplers_agree() {
    let scene = bazaar();
    let views = [v(0.2, 1.0, -0.6), v(0.0, 1.2, 0.3), v(0.05, 0.9, -0.35)];
    for d in views {
        let mut simple = SimplePath(SimplePathDesc { max_depth: 3, ..SimplePathDesc::default() });
        let reference = radiance(&mut simple, &scene, v(0.0, -1.5, 0.0), d, 30_000);
        for light_sampler in LIGHT_SAMPLERS {
            let mut path =
                Path::new(PathDesc { max_depth: 3, regularize: false, light_sampler }, Interfaces::Stop);
            let found = radiance(&mut path, &scene, v(0.0, -1.5, 0.0), d, 40_000);
            welch_test(&found, &reference, views.len() * LIGHT_SAMPLERS.len())
                .unwrap_or_else(|difference| panic!("{light_sampler:?} along {d}: {difference}"));
        }
    }
}
