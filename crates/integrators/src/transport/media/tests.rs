//! Flights and shadow rays against Beer's law and the integral of the extinction.

use std::sync::Arc;

use super::{FlightEnd, Heroes, SpectralMis, Throughput};
use crate::transport::ShadowRay;
use crate::transport::path_state::PathState;
use crate::{Control, Tracer};
use description::{
    CoefficientsDesc, ColorSpaceDesc, GridDesc, MediumDesc, MediumKind, SceneDesc, SpectrumDesc, Stated,
};
use geometry::RayStats;
use math::{Point3, Ray, Vec3};
use sampling::Sampler;
use sampling::sampler::Independent;
use scene::medium::MediumId;
use scene::{Scene, View};
use spectrum::{SampledSpectrum, SampledWavelengths};
use testkit::{Moments, t_test};

const FOG: MediumId = MediumId(0);
const SMOKE: MediumId = MediumId(1);
const COLOURS: MediumId = MediumId(2);

const ALL: [(&str, MediumId); 3] = [("fog", FOG), ("smoke", SMOKE), ("colours", COLOURS)];

fn coefficients(sigma_a: [f32; 3], sigma_s: [f32; 3]) -> CoefficientsDesc {
    let [sigma_a, sigma_s] = [sigma_a, sigma_s].map(|[r, g, b]| SpectrumDesc::rgb(r, g, b));
    CoefficientsDesc::Given { sigma_a, sigma_s, scale: 1.0 }
}

/// Media with extinctions of different colours, over the box [−1, 1]³ where they have one.
fn media() -> (Scene, View) {
    let mut desc = SceneDesc::default();
    let bounds = [Point3::splat(-1.0), Point3::splat(1.0)];
    let homogeneous = MediumKind::Homogeneous {
        coefficients: coefficients([0.1, 0.5, 1.5], [0.6, 0.3, 0.0]),
        le: Some(SpectrumDesc::Constant(1.0)),
        le_scale: 1.0,
    };
    let densities = [0.0, 2.0, 1.0, 4.0, 0.5, 0.0, 3.0, 1.0, 0.0, 1.0, 2.0, 0.0];
    let smoke = MediumKind::UniformGrid {
        bounds,
        coefficients: coefficients([0.1, 0.4, 1.0], [0.5, 0.2, 0.2]),
        density: GridDesc { resolution: [2, 3, 2], values: Arc::from(densities) },
        temperature: None,
        temperature_scale: Default::default(),
        le: Some(SpectrumDesc::Constant(1.0)),
        le_scale: None,
        emission_scale: 1.0,
    };
    let colours = [[0.2, 1.0, 3.0], [1.0, 0.2, 0.1], [0.0, 0.0, 0.0], [2.0, 0.3, 0.7]];
    let colours = MediumKind::RgbGrid {
        bounds,
        sigma_a: Some(GridDesc { resolution: [4, 1, 1], values: Arc::from(colours) }),
        sigma_s: Some(GridDesc { resolution: [1, 1, 1], values: Arc::from([[0.5, 0.5, 0.5]]) }),
        scale: 1.0,
        le: Some(GridDesc { resolution: [1, 1, 1], values: Arc::from([[1.0, 1.0, 1.0]]) }),
        le_scale: 1.0,
        space: ColorSpaceDesc::Srgb,
    };
    for kind in [homogeneous, smoke, colours] {
        let medium = MediumDesc { name: String::new(), kind, world_from_medium: Default::default(), g: 0.3 };
        desc.media.push_stated(Stated::new(medium, Default::default()));
    }
    let scene = scene::compile(desc.clone()).expect("a scene").scene;
    let view = View::compile(&desc, scene.world_from_render()).expect("a view").view;
    (scene, view)
}

const LENGTH: f32 = 2.5;

fn ray() -> Ray {
    Ray::new(Point3::new(-1.3, -0.4, 0.2), Vec3::new(0.9, 0.3, 0.1).normalize(), 0.0)
}

/// The transmittance of the ray, its expected emission, and the light it scatters if 1 arrives
/// everywhere; by the midpoint rule.
fn expected(scene: &Scene, medium: MediumId, lambda: &SampledWavelengths) -> [[f64; 4]; 3] {
    const STEPS: u32 = 20_000;
    let (medium, ray) = (&scene.media()[medium.0 as usize], ray());
    let step = f64::from(LENGTH) / f64::from(STEPS);
    let [mut depth, mut emitted, mut scattered] = [[0f64; 4]; 3];
    for i in 0..STEPS {
        let properties = medium.at(ray.at((f64::from(i) + 0.5) as f32 * step as f32), lambda);
        for k in 0..4 {
            let [sigma_t, sigma_a, sigma_s, le] =
                [properties.sigma_t(), properties.sigma_a, properties.sigma_s, properties.le]
                    .map(|value| f64::from(value[k]));
            let here = step * (-depth[k] - 0.5 * sigma_t * step).exp();
            depth[k] += sigma_t * step;
            emitted[k] += here * sigma_a * le;
            scattered[k] += here * sigma_s;
        }
    }
    [depth.map(|depth| (-depth).exp()), emitted, scattered]
}

/// Calls `sample` many times and tests the mean of each component.
fn assert_means<const N: usize>(
    what: &str,
    scene: &Scene,
    view: &View,
    expected: [[f64; 4]; N],
    sample: impl Fn(&mut Tracer) -> [SampledSpectrum; N],
) {
    let mut found = [[Moments::default(); 4]; N];
    let (control, mut stats) = (Control::default(), RayStats::default());
    let mut sampler = Sampler::Independent(Independent::new(1, 3));
    for i in 0..40_000 {
        sampler.start_pixel_sample([i, 0], 0, 0);
        let mut tracer = Tracer::new(scene, view, &control, &mut sampler, &mut stats);
        let values = sample(&mut tracer);
        for (moments, value) in found.as_flattened_mut().iter_mut().zip(values.map(|v| v.0).as_flattened()) {
            moments.push(f64::from(*value));
        }
    }
    for (k, (found, &expected)) in found.as_flattened().iter().zip(expected.as_flattened()).enumerate() {
        if (found.mean - expected).abs() > 1e-5 * expected {
            t_test(found, expected, 200).unwrap_or_else(|e| panic!("{what}, {k}: {e}"));
        }
    }
}

/// The ways to choose the wavelength that samples collisions: its name, the throughput, and the
/// choice by a random number.
type Choice = (&'static str, SampledSpectrum, fn(f32) -> Heroes);

const UNEVEN: SampledSpectrum = SampledSpectrum([0.2, 1.0, 3.0, 0.0]);

const CHOICES: [Choice; 2] = [
    ("any", SampledSpectrum::ONE, Heroes::any),
    ("by throughput", UNEVEN, |u| Heroes::by_throughput(UNEVEN, false, u)),
];

fn wavelengths() -> SampledWavelengths {
    SampledWavelengths::new([450.0, 520.0, 580.0, 640.0], [1.0; 4])
}

/// What passed, was emitted, and was scattered in a flight.
fn fly(
    tracer: &mut Tracer,
    medium: MediumId,
    lambda: &SampledWavelengths,
    beta: SampledSpectrum,
    heroes: Heroes,
) -> [SampledSpectrum; 3] {
    let mut path = Throughput { beta, ..Throughput::ONE };
    let flight = tracer.fly(medium, &ray(), LENGTH, lambda, &heroes, &mut path);
    let (l, zero) = (path.estimate(SampledSpectrum::ONE, &heroes), SampledSpectrum::ZERO);
    match flight.end {
        FlightEnd::Passed => [l, flight.emitted, zero],
        FlightEnd::Scattered { .. } => [zero, flight.emitted, l],
        FlightEnd::Absorbed => [zero, flight.emitted, zero],
    }
}

#[test]
fn flights_pass_scatter_and_emit_as_integrals_say() {
    let (scene, lambda) = (media(), wavelengths());
    for (name, medium) in ALL {
        for (choice, beta, heroes) in CHOICES {
            let mut expected = expected(&scene.0, medium, &lambda);
            for value in &mut expected {
                value.iter_mut().zip(beta.0).for_each(|(value, beta)| *value *= f64::from(beta));
            }
            assert_means(&format!("{name}, {choice}"), &scene.0, &scene.1, expected, |tracer| {
                let heroes = heroes(tracer.sampler.get_1d());
                fly(tracer, medium, &lambda, beta, heroes)
            });
        }
    }
}

#[test]
fn throughputs_stay_below_the_sum_of_all_wavelengths() {
    let (scene, view) = media();
    let (control, mut stats) = (Control::default(), RayStats::default());
    let mut sampler = Sampler::Independent(Independent::new(1, 3));
    let lambda = wavelengths();
    for (name, medium) in ALL {
        for i in 0..2000 {
            sampler.start_pixel_sample([i, 0], 0, 0);
            let mut tracer = Tracer::new(&scene, &view, &control, &mut sampler, &mut stats);
            let mut beta = SampledSpectrum([1.0, 0.5, 2.0, 0.5]);
            for _ in 0..20 {
                let heroes = Heroes::by_throughput(beta, false, tracer.sampler.get_1d());
                let mut path = Throughput { beta, ..Throughput::ONE };
                let flight = tracer.fly(medium, &ray(), f32::INFINITY, &lambda, &heroes, &mut path);
                if !matches!(flight.end, FlightEnd::Scattered { .. }) {
                    break;
                }
                beta = path.beta / heroes.mean(path.r_u);
                assert!(beta.average() * 4.0 <= 4.001, "{name}: {beta:?}");
            }
        }
    }
}

#[test]
fn shadow_rays_have_the_transmittance_of_the_ray() {
    let (scene, lambda) = (media(), wavelengths());
    for (name, medium) in ALL {
        for (choice, beta, heroes) in CHOICES {
            let [mut transmittance, ..] = expected(&scene.0, medium, &lambda);
            // Of a wavelength that cannot be the hero nothing is known.
            transmittance.iter_mut().zip(beta.0).for_each(|(value, beta)| *value *= f64::from(beta));
            assert_means(&format!("{name}, {choice}"), &scene.0, &scene.1, [transmittance], |tracer| {
                let heroes = heroes(tracer.sampler.get_1d());
                // A direction that is not of unit length, as to points on lights.
                let ray = Ray { d: ray().d * LENGTH, ..ray() };
                let numbers = tracer.two_numbers();
                let passage =
                    tracer.passage(&ShadowRay { ray, t_max: 1.0 }, Some(medium), &lambda, &heroes, numbers);
                [passage.map_or(SampledSpectrum::ZERO, |passage| passage.estimate(&heroes)) * beta]
            });
        }
    }
}

#[test]
fn the_first_wavelength_goes_on_alone() {
    let (scene, lambda) = (media(), wavelengths());
    for (name, medium) in ALL {
        let [transmittance, ..] = expected(&scene.0, medium, &lambda);
        let twice = [transmittance[0] * transmittance[0]; 4];
        assert_means(name, &scene.0, &scene.1, [twice], |tracer| {
            let spectral = Some(SpectralMis::new(Heroes::any(tracer.sampler.get_1d())));
            let path = PathState::new(ray().into(), 0);
            let mut path = PathState { medium: Some(medium), spectral, ..path };
            for flights in 0..2 {
                if flights == 1 {
                    path.keep_first();
                }
                let flight = path.fly(tracer, LENGTH, &lambda).unwrap();
                if !matches!(flight.end, FlightEnd::Passed) {
                    return [SampledSpectrum::ZERO];
                }
            }
            [SampledSpectrum::splat(path.beta[0])]
        });
    }
}
