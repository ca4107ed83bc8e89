//! The contract of sessions: the same bits on any number of threads and for any split of passes,
//! limits, valid pictures when cancelled, fixed samples.

use std::collections::HashSet;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use alhazen_integrators::{
    Control, Limits, PassError, PixelLoop, RayIntegrator, Session, Stop, Tracer, build,
};
use description::{
    AmbientOcclusionDesc, BdptDesc, Engine, IntegratorDesc, LightSamplerDesc, LightTracingDesc, MltDesc,
    PathDesc, PhotonMappingDesc, PhotonMappingShow, RandomWalkDesc, SamplerDesc, SamplerKind, SceneDesc,
    ShapeDesc, SimplePathDesc, SppmDesc, VcmDesc, WhittedDesc,
};
use film::{Film, PassSet};
use geometry::RayStats;
use math::RayDifferential;
use sampling::Sampler;
use sampling::sampler::Independent;
use spectrum::{RgbColorSpace, SampledSpectrum, SampledWavelengths, xyz_from};

use crate::support::{at, diffuse, emission, finished, glass, session, sphere, v, white_sky};

/// 40 × 24 pixels of two balls and a lamp, 4 samples each.
fn balls() -> SceneDesc {
    let mut desc = SceneDesc::default();
    desc.film.resolution = [40, 24];
    desc.film.save_fp16 = false;
    desc.sampler.value = SamplerDesc { kind: SamplerKind::Independent { pixel_samples: 4 }, seed: Some(1) };
    desc.integrator.value = IntegratorDesc::Path(PathDesc {
        max_depth: 5,
        regularize: false,
        light_sampler: LightSamplerDesc::Bvh,
    });
    white_sky(&mut desc);
    let material = diffuse(&mut desc, 0.5);
    desc.shapes.push(ShapeDesc { material, ..at(sphere(1.0), v(-1.0, 0.0, 3.0)) });
    let material = glass(&mut desc);
    desc.shapes.push(ShapeDesc { material, ..at(sphere(0.8), v(1.0, 0.0, 2.5)) });
    let area_light = emission(&mut desc, 4.0);
    desc.shapes.push(ShapeDesc { area_light, ..at(sphere(0.3), v(0.0, 1.5, 2.5)) });
    desc
}

fn bits(film: &Film) -> Vec<u32> {
    film.develop().unwrap().values().map(f32::to_bits).collect()
}

fn begun(desc: &SceneDesc) -> Session {
    session(desc, build(desc).unwrap().integrator)
}

/// The film of all passes, rendered on `threads` threads, and the number of rays.
pub fn picture(desc: &SceneDesc, threads: usize) -> (Film, RayStats) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let session = pool.install(|| finished(desc, build(desc).unwrap().integrator));
    let stats = session.progress().stats;
    (session.into_state().film, stats)
}

#[test]
fn the_picture_does_not_depend_on_threads() {
    let photons = PhotonMappingDesc { photons: 9000, caustic_photons: 9000, ..PhotonMappingDesc::default() };
    let integrators = [
        balls().integrator.value,
        IntegratorDesc::RayCasting,
        IntegratorDesc::Whitted(WhittedDesc { max_depth: 5, ..Default::default() }),
        IntegratorDesc::AmbientOcclusion(AmbientOcclusionDesc {
            cos_sample: true,
            max_distance: f32::INFINITY,
        }),
        IntegratorDesc::RandomWalk(RandomWalkDesc { max_depth: 5 }),
        IntegratorDesc::SimplePath(SimplePathDesc { max_depth: 5, sample_lights: true, sample_bsdf: true }),
        IntegratorDesc::PhotonMapping(photons),
        IntegratorDesc::PhotonMapping(PhotonMappingDesc { gather: 2, ..photons }),
        IntegratorDesc::PhotonMapping(PhotonMappingDesc { show: PhotonMappingShow::Photons, ..photons }),
        IntegratorDesc::Sppm(SppmDesc { radius: Some(0.3), ..SppmDesc::default() }),
        IntegratorDesc::Vcm(VcmDesc { radius: Some(0.3), ..VcmDesc::default() }),
    ];
    for integrator in integrators {
        let desc = SceneDesc { integrator: integrator.into(), ..balls() };
        let (one, stats) = picture(&desc, 1);
        let (many, same_stats) = picture(&desc, 5);
        assert_eq!(stats, same_stats);
        assert!(bits(&one) == bits(&many), "{:?}", desc.integrator.value);
        assert_eq!(one.rejected().count, 0);
        assert!(one.develop().unwrap().values().any(|value| value > 0.1));
    }
}

#[test]
fn progress_is_updated_after_each_pass() {
    // Each reading of the clock takes a second.
    let now = AtomicU32::new(0);
    let clock = Arc::new(move || Duration::from_secs(now.fetch_add(1, Ordering::Relaxed).into()));
    let control = Control::new(Arc::default(), clock);
    let (mut session, mut heard) = (begun(&balls()), Vec::new());
    let mut sink = |session: &Session| heard.push(session.progress());
    assert_eq!(session.run(0..4, &Limits::default(), &control, &mut sink), Ok(Stop::Passes));
    let passes: Vec<_> = heard.iter().map(|p| (p.pass, p.passes)).collect();
    assert_eq!(passes, [(1, 4), (2, 4), (3, 4), (4, 4)]);
    assert_eq!(heard[3].samples, 4 * 40 * 24);
    assert!(heard.is_sorted_by(|a, b| a.elapsed < b.elapsed && a.stats.rays < b.stats.rays));
    assert_eq!(heard[3].stats, picture(&balls(), 2).1);
}

#[test]
fn passes_that_would_exceed_the_time_limit_are_not_started() {
    let seconds = Arc::new(AtomicU32::new(0));
    let clock = {
        let seconds = Arc::clone(&seconds);
        Arc::new(move || Duration::from_secs(seconds.load(Ordering::Relaxed).into()))
    };
    let control = Control::new(Arc::default(), clock);
    let passes_within = |time: u64| {
        seconds.store(0, Ordering::Relaxed);
        // A pass takes ten seconds.
        let slow = Slow { seconds: Arc::clone(&seconds), rays: AtomicU32::new(0) };
        let sampler = Sampler::Independent(Independent::new(4, 0));
        let mut session = session(&balls(), Box::new(PixelLoop::new(slow, sampler)));
        let limits = Limits { time: Some(Duration::from_secs(time)), noise: None };
        let stop = session.run(0..4, &limits, &control, &mut |_| ()).unwrap();
        (session.state().done.count(), stop)
    };
    assert_eq!(passes_within(1), (1, Stop::Time), "at least one pass");
    assert_eq!(passes_within(19), (1, Stop::Time));
    assert_eq!(passes_within(35), (3, Stop::Time));
    assert_eq!(passes_within(100), (4, Stop::Passes));
}

/// An integrator that takes ten seconds of its own clock for 40 × 24 rays.
struct Slow {
    seconds: Arc<AtomicU32>,
    rays: AtomicU32,
}

impl RayIntegrator for Slow {
    fn li(&self, _: &mut Tracer, _: RayDifferential, _: &mut SampledWavelengths) -> SampledSpectrum {
        if self.rays.fetch_add(1, Ordering::Relaxed) % 96 == 95 {
            self.seconds.fetch_add(1, Ordering::Relaxed);
        }
        SampledSpectrum::ONE
    }
}

#[test]
fn passes_can_be_done_in_any_order_and_in_parts() {
    let photons = PhotonMappingDesc { photons: 900, caustic_photons: 900, ..PhotonMappingDesc::default() };
    for integrator in [
        balls().integrator.value,
        IntegratorDesc::LightTracing(LightTracingDesc { max_depth: 3 }),
        IntegratorDesc::Mlt(MltDesc { mutations_per_pixel: 4, ..MltDesc::default() }),
        IntegratorDesc::PhotonMapping(photons),
        IntegratorDesc::Sppm(SppmDesc::default()),
        IntegratorDesc::Vcm(VcmDesc::default()),
    ] {
        let desc = SceneDesc { integrator: integrator.into(), ..balls() };
        let control = Control::default();
        let mut parts = begun(&desc);
        for passes in [2..3, 3..4, 0..4] {
            parts.run(passes, &Limits::default(), &control, &mut |_| ()).unwrap();
        }
        assert_eq!(parts.state().done, PassSet::from(0..4));
        // Another session continues, with a second film for a noise estimate that never reaches its
        // limit.
        let mut first = begun(&desc);
        first.run(0..1, &Limits::default(), &control, &mut |_| ()).unwrap();
        let mut second = begun(&desc);
        second.resume(first.into_state(), Vec::new());
        let limits = Limits { noise: Some(1e-9), time: None };
        second.run(0..4, &limits, &control, &mut |_| ()).unwrap();
        assert_eq!(second.state().counts, [2, 2]);
        let whole = bits(&picture(&desc, 2).0);
        assert!(bits(&parts.state().film) == whole, "{desc:?}");
        let both = second.state().develop().unwrap();
        assert!(both.values().map(f32::to_bits).eq(whole), "{desc:?}");
    }
}

/// The noise estimate equals the error of the picture, for samples of pixels, for splats and for
/// chains.
#[test]
fn noise_is_the_relative_standard_error() {
    let mut desc = balls();
    desc.film.resolution = [24, 16];
    let error = |integrator: IntegratorDesc, reference: &Film| {
        let desc = SceneDesc { integrator: integrator.into(), ..desc.clone() };
        let mut session = begun(&desc);
        let limits = Limits { noise: Some(1e-9), time: None };
        session.run(0..64, &limits, &Control::default(), &mut |_| ()).unwrap();
        let (picture, truth) = (session.state().develop().unwrap(), reference.develop().unwrap());
        let mean = truth.values().sum::<f32>() / truth.values().count() as f32;
        let squares = picture.values().zip(truth.values()).map(|(value, truth)| {
            f64::from((value - truth).powi(2) / (truth.powi(2) + (mean / 10.0).powi(2)))
        });
        let error = (squares.sum::<f64>() / truth.values().count() as f64).sqrt();
        (session.state().noise().unwrap(), error)
    };
    let mut long = desc.clone();
    long.sampler.kind.set_samples_per_pixel(4096);
    long.sampler.seed = Some(7);
    let (reference, _) = picture(&long, 2);
    for integrator in [
        desc.integrator.value.clone(),
        IntegratorDesc::Bdpt(BdptDesc {
            max_depth: 5,
            regularize: false,
            visualize_strategies: false,
            visualize_weights: false,
        }),
        IntegratorDesc::Mlt(MltDesc::default()),
    ] {
        let (noise, error) = error(integrator.clone(), &reference);
        // Both are root mean squares over a thousand correlated values; the reference has an eighth
        // of the noise.
        assert!((noise / error).ln().abs() < 0.3, "{integrator:?}: {noise}, not {error}");
    }
}

#[test]
fn a_render_ends_at_the_first_noise_estimate_below_the_limit() {
    let mut session = begun(&balls());
    let limits = Limits { noise: Some(0.15), time: None };
    let mut estimates = Vec::new();
    let mut sink = |session: &Session| estimates.extend(session.progress().noise);
    assert_eq!(session.run(0..u32::MAX, &limits, &Control::default(), &mut sink), Ok(Stop::Noise));
    let last = session.progress();
    assert!(last.noise.is_some_and(|noise| noise <= 0.15) && last.pass >= 16, "{last:?}");
    assert!(estimates.iter().all(|&noise| noise > 0.15), "{estimates:?}");
    // Another run does nothing.
    assert_eq!(session.run(0..u32::MAX, &limits, &Control::default(), &mut |_| ()), Ok(Stop::Noise));
    assert_eq!(session.progress().pass, last.pass);
}

#[test]
fn a_render_stopped_between_passes_equals_one_of_fewer_passes() {
    let control = Control::default();
    let mut session = begun(&balls());
    let mut sink = |session: &Session| control.cancel.store(session.progress().pass == 2, Ordering::Relaxed);
    assert_eq!(session.run(0..4, &Limits::default(), &control, &mut sink), Err(PassError::Cancelled));
    let mut short = balls();
    short.sampler.kind.set_samples_per_pixel(2);
    // Differentials depend on the number of samples; without textures they have no effect.
    assert!(bits(&session.state().film) == bits(&picture(&short, 2).0));
}

/// Estimates 1 everywhere, and cancels the render at the 700th ray.
struct Brake {
    rays: AtomicU32,
    control: Arc<AtomicBool>,
}

impl RayIntegrator for Brake {
    fn li(&self, tracer: &mut Tracer, _: RayDifferential, _: &mut SampledWavelengths) -> SampledSpectrum {
        tracer.stats.rays += 1;
        if self.rays.fetch_add(1, Ordering::Relaxed) == 700 {
            self.control.store(true, Ordering::Relaxed);
        }
        SampledSpectrum::ONE
    }
}

#[test]
fn a_render_stopped_within_a_pass_is_valid() {
    let mut desc = balls();
    desc.options.disable_wavelength_jitter = true;
    let control = Control::default();
    let brake = Brake { rays: AtomicU32::new(0), control: Arc::clone(&control.cancel) };
    let integrator = PixelLoop::new(brake, Sampler::Independent(Independent::new(100, 0)));
    let mut session = session(&desc, Box::new(integrator));
    assert_eq!(session.run(0..100, &Limits::default(), &control, &mut |_| ()), Err(PassError::Cancelled));
    let film = &session.state().film;
    let taken = film.sample_count();
    assert!((700..2 * 40 * 24).contains(&taken), "{taken}");
    assert_eq!(session.progress().stats.rays, taken, "rays of a cancelled pass count");
    let image = film.develop().unwrap();
    let white = image.values().fold(0.0, f32::max);
    assert!(white > 0.0);
    for y in 0..24 {
        for x in 0..40 {
            let seen = film.pixel_sample_count([x, y]) > 0;
            assert_eq!(image.rgb(x as u32, y as u32)[0] > 0.0, seen);
            assert!(image.values().all(f32::is_finite));
        }
    }
}

#[test]
fn a_session_without_passes_has_no_summary() {
    let mut desc = balls();
    for integrator in [
        IntegratorDesc::Sppm(SppmDesc::default()),
        IntegratorDesc::Vcm(VcmDesc::default()),
        IntegratorDesc::Mlt(MltDesc::default()),
        IntegratorDesc::PhotonMapping(PhotonMappingDesc::default()),
    ] {
        desc.integrator = integrator.into();
        assert_eq!(build(&desc).unwrap().integrator.summary(), []);
    }
}

#[test]
fn light_tracing_reports_the_share_of_rays_that_contribute() {
    let mut desc = balls();
    desc.integrator = IntegratorDesc::LightTracing(LightTracingDesc { max_depth: 3 }).into();
    let session = finished(&desc, build(&desc).unwrap().integrator);
    let (_, note) = session.integrator().summary().remove(0);
    let rays: u64 = note.rsplit(' ').next().unwrap().parse().unwrap();
    let of_camera = session.state().film.sample_count();
    assert_eq!(rays, session.progress().stats.rays - of_camera, "all but the camera's rays: {note}");
}

/// Records the directions and wavelengths of its rays.
#[derive(Default)]
struct Recorder(Mutex<Vec<[u32; 4]>>);

impl RayIntegrator for &'static Recorder {
    fn li(&self, _: &mut Tracer, ray: RayDifferential, lambda: &mut SampledWavelengths) -> SampledSpectrum {
        let d = ray.ray.d;
        self.0.lock().unwrap().push([d.x, d.y, d.z, lambda[0]].map(f32::to_bits));
        SampledSpectrum::ZERO
    }
}

#[test]
fn without_jitter_a_sky_has_the_colour_of_the_formats_wavelengths() {
    let places = [0.5, 0.75, 1.0, 0.25];
    let lambda = places.map(|u| 538.0 - 138.888_889 * libm::atanh(0.856_910_62 - 1.827_501_97 * u));
    let pdf = lambda.map(|lambda| 0.003_939_804_2 / libm::cosh(0.0072 * (lambda - 538.0)).powi(2));
    let lambda = SampledWavelengths::new(lambda.map(|lambda| lambda as f32), pdf.map(|pdf| pdf as f32));
    let xyz = xyz_from(&SampledSpectrum::ONE, &lambda);
    let expected = RgbColorSpace::srgb().rgb_from_xyz().apply_f32([xyz.x, xyz.y, xyz.z]);
    assert!(expected[0] > 1.3 && expected[2] < 0.6, "far from white: {expected:?}");
    let algorithms: [IntegratorDesc; 8] = [
        IntegratorDesc::RayCasting,
        IntegratorDesc::Whitted(WhittedDesc::default()),
        IntegratorDesc::Path(PathDesc::default()),
        IntegratorDesc::SimplePath(SimplePathDesc::default()),
        IntegratorDesc::Bdpt(BdptDesc::default()),
        IntegratorDesc::Sppm(SppmDesc::default()),
        IntegratorDesc::Mlt(MltDesc::default()),
        IntegratorDesc::PhotonMapping(PhotonMappingDesc::default()),
    ];
    for (algorithm, engine) in
        algorithms.into_iter().flat_map(|a| [(a.clone(), Engine::Wavefront), (a, Engine::Scalar)])
    {
        let mut desc = SceneDesc::default();
        white_sky(&mut desc);
        desc.film.resolution = [4, 4];
        desc.film.save_fp16 = false;
        desc.sampler.value = SamplerDesc { kind: SamplerKind::Independent { pixel_samples: 2 }, seed: None };
        desc.options.disable_wavelength_jitter = true;
        desc.options.engine = engine;
        desc.integrator.value = algorithm;
        let picture = finished(&desc, build(&desc).unwrap().integrator).state().develop().unwrap();
        for (found, expected) in picture.rgb(1, 2).into_iter().zip(expected) {
            let algorithm = &desc.integrator.value;
            let is_near = (found / expected - 1.0).abs() < 2e-3;
            assert!(is_near, "{algorithm:?}, {engine:?}: {found}, not {expected}");
        }
    }
}

#[test]
fn jitter_can_be_disabled() {
    let distinct = |pixel: bool, wavelength: bool| {
        let mut desc = SceneDesc::default();
        desc.film.resolution = [1, 1];
        desc.options.disable_pixel_jitter = pixel;
        desc.options.disable_wavelength_jitter = wavelength;
        let recorder: &'static Recorder = Box::leak(Box::default());
        let sampler = Sampler::Independent(Independent::new(8, 0));
        finished(&desc, Box::new(PixelLoop::new(recorder, sampler)));
        let seen = recorder.0.lock().unwrap();
        assert_eq!(seen.len(), 8);
        let directions: HashSet<_> = seen.iter().map(|sample| &sample[..3]).collect();
        let wavelengths: HashSet<_> = seen.iter().map(|sample| sample[3]).collect();
        (directions.len(), wavelengths.len())
    };
    assert_eq!(distinct(false, false), (8, 8));
    assert_eq!(distinct(true, false), (1, 8));
    assert_eq!(distinct(false, true), (8, 1));
}
