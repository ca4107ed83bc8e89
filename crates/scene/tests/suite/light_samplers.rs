//! The contract of all light samplers.

use crate::common::*;
use alhazen_scene::Scene;
use alhazen_scene::light::{LightId, LightSampleContext};
use alhazen_scene::light_sampler::LightSampler;
use description::{
    AreaLightDesc, InfiniteRadiance, LightKind, LightSamplerDesc, SceneDesc, ShapeDesc, ShapeKind,
    TransformDesc,
};
use math::{DMat4, DVec3, Vec3};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use testkit::{Chi2, Moments, Random, welch_test};

const KINDS: [LightSamplerDesc; 4] =
    [LightSamplerDesc::Uniform, LightSamplerDesc::Power, LightSamplerDesc::Bvh, LightSamplerDesc::Exhaustive];

fn sampler(scene: &Scene, desc: LightSamplerDesc) -> Arc<LightSampler> {
    scene.light_sampler(desc, &AtomicBool::new(false)).expect("nobody cancels it")
}

fn point(p: Vec3, intensity: f32) -> LightKind {
    LightKind::Point { intensity: intensity.into(), power: None, from: p }
}

fn sky() -> LightKind {
    let radiance = InfiniteRadiance::Constant(0.1.into());
    LightKind::Infinite { radiance, illuminance: None, portal: None }
}

fn add_area(desc: &mut SceneDesc, shape: ShapeKind, p: Vec3, turn: f64, two_sided: bool, scale: f32) {
    let light = AreaLightDesc { two_sided, scale, ..AreaLightDesc::new(1.0.into()) };
    let area_light = Some(desc.area_lights.push(light));
    let placed = DMat4::from_translation(p.as_dvec3())
        * DMat4::from_axis_angle(DVec3::new(1.0, 1.0, 0.3).normalize(), turn);
    desc.shapes.push(ShapeDesc {
        area_light,
        world_from_object: TransformDesc::fixed(placed),
        ..shape.into()
    });
}

/// Bounded lights of every kind, some of them black.
fn mixed() -> SceneDesc {
    let mut desc = SceneDesc::default();
    let mut random = Random::new(11);
    for i in 0..12 {
        let p = point_in_cube(&mut random, 3.0);
        let turn = 6.0 * random.get_1d() as f64;
        let scale = if i == 4 { 0.0 } else { 1.0 + i as f32 };
        let shape = match i % 4 {
            0 => disk(0.0, 0.3),
            1 => sphere(0.2),
            2 => rectangle([0.0, 0.0], [0.5, 0.3]),
            _ => triangles(
                &[[0.0; 3], [0.6, 0.0, 0.0], [0.0, 0.5, 0.1], [0.7, 0.4, 0.0]],
                &[[0, 1, 2], [1, 3, 2]],
            ),
        };
        add_area(&mut desc, shape, p, turn, i % 3 == 0, scale);
        desc.lights.push(point(point_in_cube(&mut random, 3.0), if i == 2 { 0.0 } else { 0.3 }).into());
        let from = point_in_cube(&mut random, 3.0);
        desc.lights.push(
            LightKind::Spot {
                intensity: 1.0.into(),
                power: None,
                from,
                to: from + uniform_direction(&mut random),
                cone_angle: 20.0 + 5.0 * i as f32,
                cone_delta_angle: if i % 2 == 0 { 0.0 } else { 10.0 },
            }
            .into(),
        );
    }
    desc
}

fn with_infinite(mut desc: SceneDesc) -> SceneDesc {
    desc.lights.push(sky().into());
    desc.lights.push(
        LightKind::Distant { radiance: 0.2.into(), illuminance: None, from: Vec3::ONE, to: Vec3::ZERO }
            .into(),
    );
    desc
}

fn cases() -> Vec<(&'static str, Scene)> {
    let one = |light: LightKind| {
        let mut desc = SceneDesc::default();
        desc.shapes.push(sphere(0.1).into());
        desc.lights.push(light.into());
        desc
    };
    let mut lone_disk = SceneDesc::default();
    add_area(&mut lone_disk, disk(0.0, 0.5), Vec3::ZERO, 0.0, false, 1.0);
    let mut in_a_row = SceneDesc::default();
    for i in 0..50 {
        in_a_row.lights.push(point(Vec3::new(i as f32 * 0.2 - 5.0, 0.0, 1.0), 1.0).into());
    }
    [
        ("mixed", mixed()),
        ("mixed with infinite", with_infinite(mixed())),
        ("only infinite", with_infinite(one(sky()))),
        ("one point", one(point(Vec3::Z, 1.0))),
        ("one dark point", one(point(Vec3::Z, 0.0))),
        ("one disk", lone_disk),
        ("in a row", in_a_row),
    ]
    .map(|(name, desc)| (name, scene(&desc)))
    .into()
}

fn references() -> Vec<LightSampleContext> {
    let mut random = Random::new(12);
    let mut references: Vec<_> =
        (0..5).map(|_| context(point_in_cube(&mut random, 3.5), uniform_direction(&mut random))).collect();
    references.push(context(Vec3::new(0.2, 0.1, -2.0), Vec3::ZERO));
    references
}

fn pmfs(sampler: &LightSampler, scene: &Scene, from: &LightSampleContext) -> Vec<f64> {
    (0..scene.lights().len() as u32).map(|i| sampler.pmf(from, LightId(i)) as f64).collect()
}

#[test]
fn choices_have_their_probability() {
    let (cases, references) = (cases(), references());
    let tests = cases.len() * references.len() * KINDS.len();
    for (name, scene) in &cases {
        for kind in KINDS {
            let sampler = sampler(scene, kind);
            for from in &references {
                let pmfs = pmfs(&sampler, scene, from);
                let total: f64 = pmfs.iter().sum();
                assert!(total < 1.0 + 1e-5, "{name}, {kind:?}: {total}");
                if matches!(kind, LightSamplerDesc::Uniform | LightSamplerDesc::Power) {
                    assert!(total > 1.0 - 1e-5, "{name}, {kind:?}: {total}");
                }
                let count = 10_000;
                let mut observed = vec![0; pmfs.len() + 1];
                let mut random = Random::new(13);
                for _ in 0..count {
                    let Some((light, pmf)) = sampler.sample(from, random.get_1d()) else {
                        observed[pmfs.len()] += 1;
                        continue;
                    };
                    let claimed = pmfs[light.0 as usize];
                    assert!(pmf > 0.0 && (pmf as f64 / claimed - 1.0).abs() < 1e-4, "{name}, {kind:?}");
                    observed[light.0 as usize] += 1;
                }
                let none = if total > 1.0 - 1e-5 { 0.0 } else { 1.0 - total };
                let expected: Vec<f64> = pmfs.iter().chain([&none]).map(|p| p * count as f64).collect();
                Chi2 { tests, ..Chi2::default() }
                    .counts(&observed, &expected)
                    .unwrap_or_else(|e| panic!("{name}, {kind:?}: {e}"));
            }
        }
    }
}

/// The unoccluded contribution of a light to a surface, at the first wavelength.
fn sent(scene: &Scene, light: LightId, from: &LightSampleContext, u: [f32; 2]) -> f64 {
    let sample = scene.sample_light(light, from, u.into(), &lambda(), false);
    sample.map_or(0.0, |s| f64::from(s.l[0] * s.wi.dot(from.ns).abs() / s.pdf))
}

#[test]
fn every_contributing_light_can_be_chosen() {
    let mut random = Random::new(14);
    for (name, scene) in cases() {
        for kind in KINDS {
            let sampler = sampler(&scene, kind);
            for _ in 0..100 {
                let from = context(point_in_cube(&mut random, 4.0), uniform_direction(&mut random));
                for i in 0..scene.lights().len() as u32 {
                    let sends = (0..8).any(|_| sent(&scene, LightId(i), &from, random.get_2d()) > 0.0);
                    assert!(!sends || sampler.pmf(&from, LightId(i)) > 0.0, "{name}, {kind:?}, light {i}");
                }
            }
        }
    }
}

#[test]
fn one_light_estimates_agree_with_the_sum_over_lights() {
    let (cases, references) = (cases(), references());
    let tests = cases.len() * references.len() * KINDS.len();
    let mut random = Random::new(15);
    for (name, scene) in &cases {
        for from in references.iter().filter(|from| from.ns != Vec3::ZERO) {
            let sum: Moments = (0..3000)
                .map(|_| {
                    (0..scene.lights().len() as u32)
                        .map(|i| sent(scene, LightId(i), from, random.get_2d()))
                        .sum()
                })
                .collect();
            for kind in KINDS {
                let sampler = sampler(scene, kind);
                let chosen: Moments = (0..20_000)
                    .map(|_| match sampler.sample(from, random.get_1d()) {
                        Some((light, pmf)) => sent(scene, light, from, random.get_2d()) / pmf as f64,
                        None => 0.0,
                    })
                    .collect();
                if (chosen.mean - sum.mean).abs() < 1e-5 * sum.mean {
                    continue;
                }
                welch_test(&chosen, &sum, tests).unwrap_or_else(|e| panic!("{name}, {kind:?}: {e}"));
            }
        }
    }
}

#[test]
fn coincident_lights_are_distinguished() {
    let mut desc = SceneDesc::default();
    desc.shapes.push(sphere(0.1).into());
    for _ in 0..10_000 {
        desc.lights.push(point(Vec3::new(0.3, 0.2, 1.0), 1.0).into());
    }
    let scene = scene(&desc);
    let from = context(Vec3::ZERO, Vec3::Z);
    let mut random = Random::new(16);
    // Each choice of the exhaustive sampler takes as long as ten thousand of the others.
    for kind in KINDS.into_iter().filter(|&kind| kind != LightSamplerDesc::Exhaustive) {
        let sampler = sampler(&scene, kind);
        let pmfs = pmfs(&sampler, &scene, &from);
        assert!(pmfs.iter().all(|&pmf| pmf > 0.3e-4 && pmf < 3e-4), "{kind:?}");
        assert!((pmfs.iter().sum::<f64>() - 1.0).abs() < 1e-4, "{kind:?}");
        let mut reached = vec![false; pmfs.len()];
        for _ in 0..200_000 {
            let (light, pmf) = sampler.sample(&from, random.get_1d()).unwrap();
            assert!((pmf as f64 / pmfs[light.0 as usize] - 1.0).abs() < 1e-4, "{kind:?}");
            reached[light.0 as usize] = true;
        }
        assert!(reached.iter().all(|&reached| reached), "{kind:?}");
    }
    // At the position of the coincident lights, other lights are still chosen.
    desc.lights.push(point(Vec3::ZERO, 1.0).into());
    let scene = crate::common::scene(&desc);
    let sampler = sampler(&scene, LightSamplerDesc::Bvh);
    let inside = context(Vec3::new(0.3, 0.2, 1.0), Vec3::ZERO);
    assert!(pmfs(&sampler, &scene, &inside).iter().all(|pmf| pmf.is_finite()));
    assert!(sampler.sample(&inside, 0.5).is_some());
    let exhaustive = crate::light_samplers::sampler(&scene, LightSamplerDesc::Exhaustive);
    let (_, pmf) = exhaustive.sample(&inside, 0.5).unwrap();
    assert!((pmf - 1e-4).abs() < 1e-6, "{pmf}");
}

#[test]
fn the_light_bvh_prefers_near_and_facing_lights() {
    let mut desc = SceneDesc::default();
    // One faces the origin, one faces away, one is far.
    add_area(&mut desc, disk(0.0, 0.1), Vec3::new(0.0, 0.0, -1.0), 0.0, false, 1.0);
    add_area(&mut desc, disk(0.0, 0.1), Vec3::new(0.0, 0.0, 1.0), 0.0, false, 1.0);
    add_area(&mut desc, disk(0.0, 0.1), Vec3::new(0.0, 0.0, -4.0), 0.0, false, 1.0);
    let scene = scene(&desc);
    let pmfs = pmfs(&sampler(&scene, LightSamplerDesc::Bvh), &scene, &context(Vec3::ZERO, Vec3::Z));
    assert!(pmfs[0] > 4.0 * pmfs[2] && pmfs[2] > 0.0, "{pmfs:?}");
    assert_eq!(pmfs[1], 0.0);
}

/// Among all, two lights are chosen in the proportion in which the tree of these two alone, whose
/// leaves are their bounds, chooses them.
#[test]
fn exhaustive_choices_are_in_proportion_to_importance() {
    let mut desc = mixed();
    desc.shapes = Default::default();
    desc.shapes.push(sphere(0.01).into());
    let of = |lights: &[usize]| {
        let mut part = desc.clone();
        part.lights = Default::default();
        for (i, (_, light)) in desc.lights.iter().enumerate() {
            if lights.contains(&i) {
                part.lights.push(light.value.clone());
            }
        }
        scene(&with_infinite(part))
    };
    let count = 10;
    let all = of(&Vec::from_iter(0..count));
    let exhaustive = sampler(&all, LightSamplerDesc::Exhaustive);
    let references = references();
    let of_all: Vec<_> = references.iter().map(|from| pmfs(&exhaustive, &all, from)).collect();
    let mut compared = 0;
    for (i, j) in (0..count).flat_map(|i| (0..i).map(move |j| (j, i))) {
        let pair = of(&[i, j]);
        let samplers = [LightSamplerDesc::Bvh, LightSamplerDesc::Exhaustive].map(|kind| sampler(&pair, kind));
        for (from, of_all) in references.iter().zip(&of_all) {
            let [by_tree, alone] = samplers.each_ref().map(|sampler| pmfs(sampler, &pair, from));
            let same = |a: f64, b: f64| (a - b).abs() <= 1e-5 * b;
            assert!(by_tree.iter().zip(&alone).all(|(&a, &b)| same(a, b)), "{by_tree:?}, {alone:?}");
            let proportion = |of: &[f64], i: usize, j: usize| of[i] / (of[i] + of[j]);
            let [few, many] = [proportion(&by_tree, 0, 1), proportion(of_all, i, j)];
            // A single light is chosen where it does not matter, too.
            let in_vain = many.is_nan() && (few.is_nan() || few == 0.0 || few == 1.0);
            assert!(same(few, many) || in_vain, "lights {i} and {j}: {few}, {many}");
            compared += u32::from(few > 0.0 && few < 1.0);
        }
    }
    assert!(compared > 30, "{compared}");
}

#[test]
fn scenes_without_lights_choose_none() {
    let mut desc = SceneDesc::default();
    desc.shapes.push(sphere(1.0).into());
    let scene = scene(&desc);
    for kind in KINDS {
        assert!(sampler(&scene, kind).sample(&context(Vec3::ZERO, Vec3::Z), 0.5).is_none());
    }
}

/// More lights than one thread builds the tree for.
fn many_lights() -> Scene {
    let mut desc = SceneDesc::default();
    desc.shapes.push(sphere(0.1).into());
    let mut random = Random::new(21);
    for _ in 0..20_000 {
        let [x, y] = random.get_2d();
        desc.lights.push(point(Vec3::new(x, y, random.get_1d()), random.get_1d()).into());
    }
    scene(&desc)
}

#[test]
fn the_light_bvh_does_not_depend_on_threads() {
    let by = |threads| {
        let scene = many_lights();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| format!("{:?}", sampler(&scene, LightSamplerDesc::Bvh)))
    };
    assert!(by(1) == by(4));
}

#[test]
fn building_the_light_bvh_can_be_cancelled() {
    let scene = many_lights();
    assert!(scene.light_sampler(LightSamplerDesc::Bvh, &AtomicBool::new(true)).is_none());
}

#[test]
fn a_sampler_is_built_once_for_a_scene() {
    let scene = many_lights();
    for kind in KINDS {
        let built = sampler(&scene, kind);
        assert!(Arc::ptr_eq(&built, &sampler(&scene.clone(), kind)), "{kind:?}");
        assert!(!Arc::ptr_eq(&built, &sampler(&many_lights(), kind)), "{kind:?}");
    }
}
