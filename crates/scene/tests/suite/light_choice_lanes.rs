//! Choices of lights in lanes are those of each lane alone.

use crate::common::*;
use alhazen_scene::Scene;
use alhazen_scene::light::{LightId, LightSampleContext};
use alhazen_scene::light_sampler::LightSampler;
use description::{InfiniteRadiance, LightKind, LightSamplerDesc, SceneDesc};
use lanes::{InstructionSet, Int, Kernel, Mask, Real};
use math::{Point3Error, Vec3};
use std::sync::atomic::AtomicBool;
use testkit::Random;

/// Points and lamps, half of which emit to one side, and some lights infinitely far away.
fn lights(bounded: u32, infinite: u32) -> Scene {
    let mut desc = SceneDesc::default();
    desc.shapes.push(sphere(0.01).into());
    let mut random = Random::new(31);
    for i in 0..bounded {
        let from = point_in_cube(&mut random, 3.0);
        let light = if i % 2 == 0 {
            LightKind::Point { intensity: (0.1 + random.get_1d()).into(), power: None, from }
        } else {
            LightKind::Spot {
                intensity: 1.0.into(),
                power: None,
                from,
                to: from + uniform_direction(&mut random),
                cone_angle: 60.0,
                cone_delta_angle: 5.0,
            }
        };
        desc.lights.push(light.into());
    }
    for i in 0..infinite {
        let radiance = InfiniteRadiance::Constant((0.1 + i as f32).into());
        desc.lights.push(LightKind::Infinite { radiance, illuminance: None, portal: None }.into());
    }
    scene(&desc)
}

/// On surfaces, in the middle of nowhere, and at one light.
fn contexts(scene: &Scene, count: usize) -> Vec<LightSampleContext> {
    let mut random = Random::new(32);
    let mut contexts: Vec<_> = (0..count)
        .map(|i| {
            let n = if i % 5 == 0 { Vec3::ZERO } else { uniform_direction(&mut random) };
            context(point_in_cube(&mut random, 4.0), n)
        })
        .collect();
    if let Some(bounds) = scene.lights().iter().find_map(|light| light.bounds()) {
        contexts[0].p = Point3Error::exact(bounds.bounds.centroid());
    }
    contexts
}

/// A light, and the bits of the probability of its choice, and of that of a given light.
type Choice = Option<(LightId, u32, u32)>;

struct Choose<'a> {
    sampler: &'a LightSampler,
    contexts: &'a [LightSampleContext],
    u: &'a [f32],
    /// The lights whose probabilities are asked for.
    lights: &'a [u32],
    /// Bit i: whether each i-th of sixteen points chooses.
    active: u32,
}

impl Kernel for Choose<'_> {
    type Output = Vec<Choice>;

    #[inline(always)]
    fn run<R: Real>(self) -> Vec<Choice> {
        let mut choices = vec![None; self.u.len()];
        for first in (0..self.u.len()).step_by(R::LANES) {
            let of = &self.contexts[first..];
            let p = Vec3::new(
                R::from_fn(|i| of[i].p.p.x),
                R::from_fn(|i| of[i].p.p.y),
                R::from_fn(|i| of[i].p.p.z),
            );
            let n =
                Vec3::new(R::from_fn(|i| of[i].ns.x), R::from_fn(|i| of[i].ns.y), R::from_fn(|i| of[i].ns.z));
            let context = LightSampleContext { p: Point3Error::exact(p), n, ns: n, time: R::splat(TIME) };
            let active = R::Mask::from_bits(self.active >> (first % 16) & ((1 << R::LANES) - 1));
            let (lights, pmf, valid) = self.sampler.sample_lanes(&context, R::load(&self.u[first..]), active);
            let given = self.sampler.pmf_lanes(&context, R::Int::load(&self.lights[first..]), valid);
            let (lights, pmf, given) = (lights.to_array(), pmf.to_array(), given.to_array());
            for (lane, choice) in choices[first..first + R::LANES].iter_mut().enumerate() {
                if valid.bits() >> lane & 1 == 1 {
                    *choice = Some((LightId(lights[lane]), pmf[lane].to_bits(), given[lane].to_bits()));
                }
            }
        }
        choices
    }
}

#[test]
fn lanes_choose_as_each_alone() {
    let mut random = Random::new(33);
    for (bounded, infinite) in [(0, 0), (1, 0), (2, 0), (128, 0), (1024, 0), (0, 3), (1, 1), (128, 2)] {
        let scene = lights(bounded, infinite);
        let contexts = contexts(&scene, 1024);
        let mut u: Vec<f32> = contexts.iter().map(|_| random.get_1d()).collect();
        (u[1], u[2]) = (0.0, math::ONE_MINUS_EPSILON);
        let count = scene.lights().len() as f32;
        let given: Vec<u32> = contexts.iter().map(|_| (random.get_1d() * count) as u32).collect();
        use LightSamplerDesc::{Bvh, Exhaustive, Power, Uniform};
        for kind in [Uniform, Power, Bvh, Exhaustive] {
            let sampler = scene.light_sampler(kind, &AtomicBool::new(false)).expect("nobody cancels it");
            let active = 0xbe7f;
            let alone: Vec<Choice> = (0..u.len())
                .map(|i| sampler.sample(&contexts[i], u[i]).filter(|_| active >> (i % 16) & 1 == 1))
                .enumerate()
                .map(|(i, choice)| {
                    let (light, pmf) = choice?;
                    assert!((sampler.pmf(&contexts[i], light) / pmf - 1.0).abs() < 1e-5);
                    Some((light, pmf.to_bits(), sampler.pmf(&contexts[i], LightId(given[i])).to_bits()))
                })
                .collect();
            assert_eq!(alone.iter().any(Option::is_some), bounded + infinite > 0);
            for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
                let choose = Choose { sampler: &sampler, contexts: &contexts, u: &u, lights: &given, active };
                let chosen = set.dispatch(choose);
                assert!(chosen == alone, "{bounded} and {infinite} lights, {kind:?}, {set:?}");
            }
        }
    }
}
