//! Media: their properties at points, and majorants that bound them.

use std::sync::Arc;

use alhazen_scene::medium::{CloudMedium, Medium, MediumId, MediumInterface, MediumKind as MediumRow};
use alhazen_scene::{Scene, compile};
use description::{
    CoefficientsDesc, ColorSpaceDesc, GridDesc, MediumDesc, MediumKind, MediumType, SceneDesc, SpectrumDesc,
    TemperatureDesc, TransformDesc, VoxelsDesc,
};
use lanes::InstructionSet;
use math::{DMat4, DVec3, Point3, Ray, Vec3};
use spectrum::{SampledSpectrum, SampledWavelengths};
use testkit::{Random, assert_complete};

fn lambda() -> SampledWavelengths {
    SampledWavelengths::sample_visible(0.4)
}

/// A scene of one medium, which is moved, turned and scaled.
fn scene(kind: MediumKind) -> Scene {
    let place = DMat4::from_translation(DVec3::new(0.5, -1.0, 2.0))
        * DMat4::from_rotation_y(0.7)
        * DMat4::from_scale(DVec3::new(2.0, 1.0, 0.5));
    let world_from_medium = TransformDesc { start: place, end: place, ..TransformDesc::default() };
    let mut desc = SceneDesc::default();
    let medium = MediumDesc { name: "m".into(), kind, world_from_medium, g: 0.0 };
    desc.media.push(medium);
    compile(desc).expect("a scene").scene
}

/// The point of a scene's render space at coordinates of its medium.
fn at(scene: &Scene, p: [f64; 3]) -> Point3 {
    let place = DMat4::from_translation(DVec3::new(0.5, -1.0, 2.0))
        * DMat4::from_rotation_y(0.7)
        * DMat4::from_scale(DVec3::new(2.0, 1.0, 0.5));
    let p = scene.world_from_render().inverse() * place * DVec3::from_array(p).extend(1.0);
    p.truncate().as_vec3().into()
}

const BOUNDS: [Point3; 2] = [Point3::new(0.0, 0.0, 0.0), Point3::new(1.0, 2.0, 1.0)];

fn grey() -> CoefficientsDesc {
    CoefficientsDesc::Given { sigma_a: 1.0.into(), sigma_s: 3.0.into(), scale: 0.5 }
}

fn grid(resolution: [i32; 3], seed: u64) -> GridDesc<f32> {
    let mut random = Random::new(seed);
    let count = resolution.iter().product::<i32>();
    // Empty and full parts, as clouds have.
    let values = (0..count).map(|_| (random.get_1d() * 4.0 - 2.0).max(0.0));
    GridDesc { resolution, values: values.collect() }
}

fn uniform_grid(density: GridDesc<f32>, temperature: Option<GridDesc<f32>>) -> MediumKind {
    MediumKind::UniformGrid {
        bounds: BOUNDS,
        coefficients: grey(),
        density,
        temperature,
        temperature_scale: TemperatureDesc { offset: 100.0, scale: 2.0 },
        le: None,
        le_scale: None,
        emission_scale: 3.0,
    }
}

fn rgb_grid() -> MediumKind {
    let colours = grid([27, 1, 5], 3).values.iter().map(|&v| [v, 0.5 * v, 0.1]).collect();
    MediumKind::RgbGrid {
        bounds: BOUNDS,
        sigma_a: Some(GridDesc { resolution: [9, 3, 5], values: colours }),
        sigma_s: None,
        scale: 2.0,
        le: None,
        le_scale: 1.0,
        space: ColorSpaceDesc::Srgb,
    }
}

fn cloud() -> MediumKind {
    MediumKind::Cloud {
        bounds: [Point3::ZERO, Point3::ONE],
        coefficients: grey(),
        density: 3.0,
        wispiness: 1.0,
        frequency: 5.0,
    }
}

/// Two bricks side by side, the second of which is empty but for one voxel.
fn voxels() -> VoxelsDesc {
    let mut values = vec![0.0; 3 * 512];
    let mut random = Random::new(9);
    values[512..1024].iter_mut().for_each(|value| *value = random.get_1d());
    values[1024 + 3 * 64 + 2 * 8 + 5] = 7.0;
    VoxelsDesc {
        origin: [-8, 0, 8],
        bricks: [2, 1, 1],
        table: Arc::from([1, 2]),
        values: values.into(),
        active: [[-8, 0, 8], [7, 7, 15]],
        world_from_index: [[0.1, 0.0, 0.0, 0.0], [0.0, 0.2, 0.0, 0.0], [0.0, 0.0, 0.1, -1.0]],
    }
}

fn nano_vdb() -> MediumKind {
    MediumKind::NanoVdb {
        density: voxels(),
        temperature: None,
        coefficients: grey(),
        temperature_scale: TemperatureDesc::default(),
        le_scale: 1.0,
    }
}

fn all() -> Vec<(&'static str, MediumKind)> {
    vec![
        ("grid", uniform_grid(grid([13, 7, 30], 1), None)),
        ("small grid", uniform_grid(grid([1, 2, 3], 2), None)),
        ("colours", rgb_grid()),
        ("cloud", cloud()),
        ("voxels", nano_vdb()),
        ("fog", MediumKind::Homogeneous { coefficients: grey(), le: None, le_scale: 1.0 }),
    ]
}

#[test]
fn every_medium_is_tested() {
    let media = all();
    assert_complete(MediumType::NAMES, media.iter().map(|(_, kind)| kind.name()));
}

fn medium(scene: &Scene) -> &Medium {
    &scene.media()[0]
}

fn density(scene: &Scene, p: [f64; 3]) -> f32 {
    medium(scene).at(at(scene, p), &lambda()).sigma_s[0] / 1.5
}

#[test]
fn grids_interpolate_their_values_and_fall_off_to_half_of_them() {
    let values = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0];
    let scene = scene(uniform_grid(GridDesc { resolution: [2, 2, 2], values: Arc::from(values) }, None));
    let close = |p, expected: f32| {
        let found = density(&scene, p);
        assert!((found - expected).abs() < 1e-4, "{p:?}: {found} instead of {expected}");
    };
    close([0.25, 0.5, 0.25], 1.0);
    close([0.75, 0.5, 0.25], 2.0);
    close([0.25, 1.5, 0.25], 3.0);
    close([0.25, 0.5, 0.75], 5.0);
    close([0.5, 1.0, 0.5], 4.5);
    close([0.75, 1.5, 0.99], 4.16);
    close([0.25, 0.5, 1.01], 0.0);
    close([-0.01, 0.5, 0.25], 0.0);
}

#[test]
fn voxels_lie_at_integer_points_of_index_space() {
    let scene = scene(nano_vdb());
    let voxels = voxels();
    for index in [[-7, 1, 9], [-3, 4, 12], [5, 2, 11], [6, 2, 11], [7, 7, 15]] {
        let place = std::array::from_fn(|axis| {
            let row = voxels.world_from_index[axis];
            row[axis] * f64::from(index[axis]) + row[3]
        });
        let (found, expected) = (density(&scene, place), voxels.value(index));
        assert!((found - expected).abs() < 1e-4, "{index:?}: {found} instead of {expected}");
    }
    // Halfway between the voxel of 7 and an empty one.
    let found = density(&scene, [0.55, 0.4, 0.1]);
    assert!((found - 3.5).abs() < 1e-3, "{found}");
    assert_eq!(voxels.value([100, 0, 8]), 0.0);
}

#[test]
fn instruction_sets_give_the_same_cloud() {
    let (scene, mut random) = (scene(cloud()), Random::new(7));
    let Medium { kind: MediumRow::Cloud(cloud), phase } = medium(&scene) else { panic!("a cloud") };
    let with = |set| {
        let cloud = CloudMedium { instruction_set: set, ..(**cloud).clone() };
        Medium { kind: MediumRow::Cloud(Box::new(cloud)), phase: *phase }
    };
    let sets = InstructionSet::ALL.into_iter().filter(|set| set.is_available());
    let media: Vec<Medium> = sets.map(with).collect();
    let mut dense = 0;
    for _ in 0..1000 {
        let p = at(&scene, [(); 3].map(|()| f64::from(random.get_1d())));
        let density = |medium: &Medium| medium.at(p, &lambda()).sigma_s[0];
        let expected = density(&media[0]);
        dense += u32::from(expected > 0.0);
        assert!(media.iter().all(|medium| density(medium) == expected), "{p:?}");
    }
    assert!(dense > 100, "{dense}");
}

#[test]
fn majorants_bound_the_extinction_on_every_ray() {
    let mut random = Random::new(5);
    for (name, kind) in all() {
        let scene = scene(kind);
        let medium = medium(&scene);
        let (mut inside, mut bound) = (0, 0f32);
        for _ in 0..300 {
            let [from, to] = [0; 2].map(|_| {
                let p = std::array::from_fn(|_| f64::from(random.get_1d()) * 4.0 - 1.5);
                at(&scene, p)
            });
            let ray = Ray::new(from, (to - from).normalize(), 0.0);
            let t_max = from.distance(to);
            let segments: Vec<_> = medium.majorants(&ray, t_max, &lambda()).collect();
            assert!(segments.windows(2).all(|pair| pair[0].t[1] <= pair[1].t[0]), "{name}: {segments:?}");
            assert!(segments.iter().all(|s| s.t[0] >= 0.0 && s.t[1] <= t_max), "{name}: {segments:?}");
            for i in 0..200 {
                let t = (i as f32 + 0.5) / 200.0 * t_max;
                let sigma_t = medium.at(ray.at(t), &lambda()).sigma_t();
                let within = |slack: f32| {
                    let holds =
                        |s: &&alhazen_scene::medium::Segment| s.t[0] - slack <= t && t <= s.t[1] + slack;
                    segments.iter().filter(holds).fold(SampledSpectrum::ZERO, |m, s| m.max(s.majorant))
                };
                let majorant = within(1e-5);
                let excess = (sigma_t - majorant * 1.0001).max_component();
                assert!(excess <= 1e-4, "{name} at {t}: {sigma_t:?} above {majorant:?} in {segments:?}");
                if sigma_t[0] > 0.0 {
                    inside += 1;
                    bound += majorant[0] / sigma_t[0].max(0.1);
                }
            }
        }
        assert!(inside > 1000, "{name}: {inside}");
        // They are of the size of the extinction, not just large.
        assert!(bound / (inside as f32) < 40.0, "{name}: {}", bound / inside as f32);
    }
}

#[test]
fn rays_parallel_to_axes_and_on_walls_of_cells_are_bounded_too() {
    let mut desc = SceneDesc::default();
    let kind = uniform_grid(grid([16, 16, 16], 4), None);
    desc.media.push(MediumDesc { name: "m".into(), kind, world_from_medium: Default::default(), g: 0.0 });
    let scene = compile(desc).expect("a scene").scene;
    let medium = &scene.media()[0];
    for axis in 0..3 {
        for cell in 0..=4 {
            for sign in [1.0, -1.0] {
                let mut o = [cell as f32 / 4.0; 3];
                o[1] *= 2.0;
                let mut d = [0.0; 3];
                d[axis] = sign;
                o[axis] = -sign * 3.0;
                let ray = Ray::new(o.into(), Vec3::from(d), 0.0);
                let segments: Vec<_> = medium.majorants(&ray, 10.0, &lambda()).collect();
                for i in 0..1000 {
                    let t = i as f32 * 0.01 + 0.005;
                    let sigma_t = medium.at(ray.at(t), &lambda()).sigma_t()[0];
                    let near = segments.iter().filter(|s| s.t[0] - 1e-5 <= t && t <= s.t[1] + 1e-5);
                    let majorant = near.fold(0f32, |m, s| m.max(s.majorant[0]));
                    assert!(sigma_t <= majorant + 1e-4, "{o:?} {d:?} at {t}: {sigma_t} > {majorant}");
                }
            }
        }
    }
}

#[test]
fn temperatures_are_converted_and_glow_like_blackbodies() {
    let temperature = GridDesc { resolution: [1, 1, 1], values: Arc::from([1600.0]) };
    let density = GridDesc { resolution: [1, 1, 1], values: Arc::from([1.0]) };
    let scene = scene(uniform_grid(density.clone(), Some(temperature)));
    assert!(medium(&scene).is_emissive());
    let le = medium(&scene).at(at(&scene, [0.5, 1.0, 0.5]), &lambda()).le;
    let expected = spectrum::Spectrum::blackbody(3000.0).sample(&lambda()) * 3.0;
    assert!((le - expected).max_component().abs() < 1e-4 * expected.max_component(), "{le:?} {expected:?}");
    let cold = GridDesc { resolution: [1, 1, 1], values: Arc::from([149.0]) };
    let scene = self::scene(uniform_grid(density, Some(cold)));
    assert_eq!(medium(&scene).at(at(&scene, [0.5, 1.0, 0.5]), &lambda()).le, SampledSpectrum::ZERO);
}

#[test]
fn interfaces_have_a_side_for_each_direction() {
    let (water, air) = (Some(MediumId(0)), None);
    let media = MediumInterface { inside: water, outside: air };
    assert!(media.is_transition());
    assert!(!MediumInterface { inside: water, outside: water }.is_transition());
    let n = Vec3::new(0.0, 0.0, 1.0);
    assert_eq!(media.towards(Vec3::new(1.0, 0.0, 0.1), n), air);
    assert_eq!(media.towards(Vec3::new(1.0, 0.0, -0.1), n), water);
}

/// The codes of the errors of a medium.
fn errors(kind: MediumKind, g: f32) -> Vec<&'static str> {
    let mut desc = SceneDesc::default();
    desc.media.push(MediumDesc { name: "m".into(), kind, world_from_medium: Default::default(), g });
    compile(desc).err().into_iter().flatten().map(|diagnostic| diagnostic.code).collect()
}

#[test]
fn impossible_media_are_refused() {
    let fog = |sigma_a: SpectrumDesc, scale| {
        let coefficients = CoefficientsDesc::Given { sigma_a, sigma_s: 1.0.into(), scale };
        MediumKind::Homogeneous { coefficients, le: None, le_scale: 1.0 }
    };
    assert!(errors(fog(1.0.into(), 1.0), 0.9).is_empty());
    for (kind, g) in [
        (fog(1.0.into(), 1.0), 1.5),
        (fog(1.0.into(), f32::NAN), 0.0),
        (fog((-1.0).into(), 1.0), 0.0),
        (fog(1.0.into(), -1.0), 0.0),
        (uniform_grid(GridDesc { resolution: [1; 3], values: Arc::from([f32::NAN]) }, None), 0.0),
        (uniform_grid(GridDesc { resolution: [1; 3], values: Arc::from([-1.0]) }, None), 0.0),
        (
            MediumKind::Cloud {
                bounds: [Point3::ZERO, Point3::new(1.0, 0.0, 1.0)],
                coefficients: grey(),
                density: 1.0,
                wispiness: 1.0,
                frequency: 1.0,
            },
            0.0,
        ),
    ] {
        assert_eq!(errors(kind, g), ["invalid-value"]);
    }
}
