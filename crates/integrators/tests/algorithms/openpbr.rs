//! The principled surface by algorithms from the camera, from the lights and from both.

use alhazen_integrators::{Path, build};
use description::{
    BdptDesc, IntegratorDesc, LightTracingDesc, MaterialKind, OpenPbrDesc, PathDesc, SamplerDesc,
    SamplerKind, SceneDesc, ShapeDesc, SpectrumDesc, TransformDesc,
};
use math::{DMat4, DVec3};
use scene::Interfaces;
use testkit::welch_test;

use crate::support::{
    Unbiased, at, compile, diffuse, emission, finished, quad, radiance, sphere, v, walls, white_sky,
};

/// A material of some numbers by name, coloured.
fn material(numbers: &[(&str, f32)]) -> MaterialKind {
    let mut desc = OpenPbrDesc::default();
    for (number, value) in OpenPbrDesc::NUMBERS.iter().zip(&mut desc.numbers) {
        if let Some((_, given)) = numbers.iter().find(|(name, _)| *name == number.field.name) {
            *value = (*given).into();
        }
    }
    desc.colors[0] = SpectrumDesc::rgb(0.8, 0.5, 0.3).into();
    MaterialKind::OpenPbr(Box::new(desc))
}

/// A box with a lamp, in which two balls and the floor are principled: a coated one with fuzz, a
/// rough glass, and metal under a film.
fn room() -> SceneDesc {
    let mut desc = SceneDesc::default();
    let floor = material(&[
        ("base_metalness", 0.5),
        ("specular_roughness", 0.5),
        ("thin_film_weight", 1.0),
        ("base_diffuse_roughness", 0.7),
    ]);
    let floor = Some(desc.materials.push(floor.into()));
    for (i, wall) in walls(1.0).into_iter().enumerate() {
        let material = if i == 0 { floor } else { diffuse(&mut desc, 0.5) };
        desc.shapes.push(ShapeDesc { material, ..wall.into() });
    }
    let area_light = emission(&mut desc, 5.0);
    let lamp = quad(v(-0.5, -0.5, 0.9), v(0.0, 1.0, 0.0), v(1.0, 0.0, 0.0));
    desc.shapes.push(ShapeDesc { area_light, ..lamp.into() });
    let layers =
        [("coat_weight", 1.0), ("coat_roughness", 0.4), ("fuzz_weight", 0.5), ("specular_roughness", 0.6)];
    let glass = [("transmission_weight", 1.0), ("specular_roughness", 0.6)];
    for (numbers, x) in [(&layers[..], 0.35), (&glass[..], -0.35)] {
        let material = Some(desc.materials.push(material(numbers).into()));
        desc.shapes.push(ShapeDesc { material, ..at(sphere(0.33), v(x, 0.2, -0.6)) });
    }
    desc
}

/// Light that is followed under a surface returns with the colour that the material has, whatever
/// its mean free path and the layers over it; with layers as where it leaves at once.
#[test]
fn half_spaces_show_their_colour() {
    let found = |color: f32, numbers: &[(&str, f32)]| {
        let mut desc = SceneDesc::default();
        white_sky(&mut desc);
        let MaterialKind::OpenPbr(mut surface) = material(numbers) else { unreachable!() };
        let position = OpenPbrDesc::color("subsurface_color");
        surface.colors[position.unwrap()] = color.into();
        let plane = quad(v(-1e3, -1e3, 0.0), v(2e3, 0.0, 0.0), v(0.0, 2e3, 0.0));
        let material = Some(desc.materials.push(MaterialKind::OpenPbr(surface).into()));
        desc.shapes.push(ShapeDesc { material, ..plane.into() });
        let mut path = Path::new(PathDesc { max_depth: 1, ..PathDesc::default() }, Interfaces::Pass);
        radiance(&mut path, &compile(&desc), v(0.0, 0.0, 1.0), v(0.3, 0.0, -1.0), 40_000)
    };
    let bare = [("subsurface_weight", 1.0), ("specular_weight", 0.0)];
    for (color, radius, g) in [(0.2, 1.0, 0.0), (0.5, 0.1, 0.6), (0.8, 2.0, 0.0), (0.95, 0.5, -0.3)] {
        let more = [("subsurface_radius", radius), ("subsurface_scatter_anisotropy", g)];
        let found = found(color, &[&bare[..], &more].concat());
        let difference = found.mean - f64::from(color);
        assert!(difference.abs() < 4.0 * found.variance_of_mean().sqrt() + 0.01, "{color}: {found:?}");
    }
    let layers = [
        ("subsurface_weight", 0.7),
        ("coat_weight", 1.0),
        ("coat_roughness", 0.3),
        ("fuzz_weight", 0.3),
        ("base_metalness", 0.2),
    ];
    let at_once = found(0.8, &[&layers[..], &[("subsurface_radius", 0.0)]].concat());
    let walked = found(0.8, &[&layers[..], &[("subsurface_radius", 0.3)]].concat());
    let error = (at_once.variance_of_mean() + walked.variance_of_mean()).sqrt();
    assert!((at_once.mean - walked.mean).abs() < 4.0 * error + 0.01, "{at_once:?} {walked:?}");
}

/// Uniform directions find too little of what rough glass focuses, so that no ray begins there.
#[test]
fn ways_to_sample_agree() {
    let scene = compile(&room());
    for target in [v(0.3, 0.1, -0.5), v(0.0, -0.3, -1.0)] {
        let o = v(0.1, -0.9, 0.2);
        let mut all = Unbiased::all(4).into_iter();
        let tests = 3 * all.len();
        let of = |rays: &mut Unbiased| radiance(rays, &scene, o, target - o, 20_000);
        let reference = all.next().map(|(_, mut rays)| of(&mut rays)).unwrap();
        for (name, mut rays) in all {
            let found = of(&mut rays);
            welch_test(&found, &reference, tests)
                .unwrap_or_else(|difference| panic!("{name} to {target}: {difference}"));
        }
    }
}

#[test]
fn light_paths_and_camera_paths_make_the_same_picture() {
    let picture = |integrator: IntegratorDesc, pixel_samples: u32| {
        let mut desc = room();
        let (eye, forward) = (DVec3::new(0.1, -0.9, 0.2), DVec3::new(-0.1, 1.1, -0.8).normalize());
        let right = DVec3::Z.cross(forward).normalize();
        let axes = [(right, 0.0), (forward.cross(right), 0.0), (forward, 0.0), (eye, 1.0)];
        let [x, y, z, p] = axes.map(|(axis, w)| axis.extend(w));
        desc.camera.camera_from_world = TransformDesc::fixed(DMat4::from_cols(x, y, z, p).inverse());
        desc.film.resolution = [8, 8];
        desc.sampler.value = SamplerDesc { kind: SamplerKind::Independent { pixel_samples }, seed: Some(1) };
        desc.integrator.value = integrator;
        let film = finished(&desc, build(&desc).unwrap().integrator).into_state().film;
        let image = film.develop().unwrap();
        // Colours of the upper and the lower half.
        let values: Vec<f32> = image.values().collect();
        let means = values.chunks(values.len() / 2).map(|half| half.iter().sum::<f32>() / half.len() as f32);
        means.collect::<Vec<_>>()
    };
    let depth = 4;
    let expected = picture(IntegratorDesc::Path(PathDesc { max_depth: depth, ..PathDesc::default() }), 1024);
    let bdpt = BdptDesc { max_depth: depth, ..BdptDesc::default() };
    for (integrator, samples) in [
        (IntegratorDesc::Bdpt(bdpt), 512),
        (IntegratorDesc::LightTracing(LightTracingDesc { max_depth: depth }), 4096),
    ] {
        let name = format!("{integrator:?}");
        for (found, expected) in picture(integrator, samples).into_iter().zip(&expected) {
            assert!((found / expected - 1.0).abs() < 0.03, "{name}: {found} for {expected}");
        }
    }
}
