//! The promises of the loop: the same bits on any number of threads, valid pictures when stopped,
//! fixed samples.

use std::collections::HashSet;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex};

use alhazen_integrators::{Cancelled, Control, PixelLoop, Progress, RayIntegrator, Tracer, build, render};
use description::{
    AmbientOcclusionDesc, IntegratorDesc, LightSamplerDesc, LightTracingDesc, MltDesc, PathDesc,
    PhotonMappingDesc, PhotonMappingShow, RandomWalkDesc, SamplerDesc, SamplerKind, SceneDesc, ShapeDesc,
    SimplePathDesc, SppmDesc, VcmDesc, WhittedDesc,
};
use film::Film;
use geometry::RayStats;
use math::RayDifferential;
use sampling::Sampler;
use sampling::sampler::Independent;
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::support::{at, diffuse, emission, glass, sphere, v, viewed, white_sky};

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

fn empty_film(desc: &SceneDesc) -> Film {
    film::compile(desc).unwrap().film
}

fn bits(film: &Film) -> Vec<u32> {
    film.develop().values().map(f32::to_bits).collect()
}

pub fn picture(desc: &SceneDesc, threads: usize, control: &Control) -> (Film, Result<RayStats, Cancelled>) {
    let ((scene, view), mut film) = (viewed(desc), empty_film(desc));
    let mut integrator = build(desc).unwrap().integrator;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let report = pool.install(|| render(&mut *integrator, &scene, &view, &mut film, control));
    (film, report.map(|report| report.stats))
}

#[test]
fn threads_never_change_a_bit() {
    let photons = PhotonMappingDesc { photons: 9000, caustic_photons: 9000, ..PhotonMappingDesc::default() };
    let integrators = [
        balls().integrator.value,
        IntegratorDesc::RayCasting,
        IntegratorDesc::Whitted(WhittedDesc { max_depth: 5 }),
        IntegratorDesc::AmbientOcclusion(AmbientOcclusionDesc {
            cos_sample: true,
            max_distance: f32::INFINITY,
        }),
        IntegratorDesc::RandomWalk(RandomWalkDesc { max_depth: 5 }),
        IntegratorDesc::SimplePath(SimplePathDesc { max_depth: 5, sample_lights: true, sample_bsdf: true }),
        IntegratorDesc::PhotonMapping(photons.clone()),
        IntegratorDesc::PhotonMapping(PhotonMappingDesc { gather: 2, ..photons.clone() }),
        IntegratorDesc::PhotonMapping(PhotonMappingDesc { show: PhotonMappingShow::Photons, ..photons }),
        IntegratorDesc::Sppm(SppmDesc { radius: Some(0.3), ..SppmDesc::default() }),
        IntegratorDesc::Vcm(VcmDesc { radius: Some(0.3), ..VcmDesc::default() }),
    ];
    for integrator in integrators {
        let desc = SceneDesc { integrator: integrator.into(), ..balls() };
        let (one, stats) = picture(&desc, 1, &Control::default());
        let (many, same_stats) = picture(&desc, 5, &Control::default());
        assert_eq!(stats, same_stats);
        assert!(bits(&one) == bits(&many), "{:?}", desc.integrator.value);
        assert_eq!(one.rejected().count, 0);
        assert!(one.develop().values().any(|value| value > 0.1));
    }
}

#[test]
fn progress_is_told_after_each_pass() {
    let heard = Arc::new(Mutex::new(Vec::new()));
    let sink = Arc::clone(&heard);
    let progress = move |progress: &Progress| sink.lock().unwrap().push(*progress);
    let control = Control { progress: Some(Box::new(progress)), ..Control::default() };
    let (_, stats) = picture(&balls(), 2, &control);
    let heard = heard.lock().unwrap();
    assert_eq!(
        heard.iter().map(|p| (p.pass, p.passes)).collect::<Vec<_>>(),
        [(1, 4), (2, 4), (3, 4), (4, 4)]
    );
    assert_eq!(heard[3].samples, 4 * 40 * 24);
    assert!(heard.is_sorted_by(|a, b| a.elapsed <= b.elapsed && a.stats.rays < b.stats.rays));
    assert_eq!(heard[3].stats, stats.unwrap());
}

#[test]
fn a_render_stopped_between_passes_is_one_of_fewer_passes() {
    let mut control = Control::default();
    let cancel = Arc::clone(&control.cancel);
    control.progress = Some(Box::new(move |p| cancel.store(p.pass == 2, Ordering::Relaxed)));
    let (stopped, result) = picture(&balls(), 2, &control);
    assert_eq!(result, Err(Cancelled));
    let mut short = balls();
    short.sampler.kind.set_samples_per_pixel(2);
    // Differentials follow the number of samples; without textures they do not matter.
    assert!(bits(&stopped) == bits(&picture(&short, 2, &Control::default()).0));
}

/// Answers 1 for everything, and pulls the brake at the 700th ray.
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
    let ((scene, view), mut film) = (viewed(&desc), empty_film(&desc));
    let mut control = Control::default();
    let told = Arc::new(Mutex::new(Progress::default()));
    let sink = Arc::clone(&told);
    control.progress = Some(Box::new(move |progress| *sink.lock().unwrap() = *progress));
    let brake = Brake { rays: AtomicU32::new(0), control: Arc::clone(&control.cancel) };
    let mut integrator = PixelLoop::new(brake, Sampler::Independent(Independent::new(100, 0)));
    assert_eq!(render(&mut integrator, &scene, &view, &mut film, &control), Err(Cancelled));
    let taken = film.sample_count();
    assert!((700..2 * 40 * 24).contains(&taken), "{taken}");
    assert_eq!(told.lock().unwrap().stats.rays, taken, "rays of a pass that was stopped are told");
    let image = film.develop();
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
fn what_has_not_begun_has_nothing_to_tell() {
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
fn light_tracing_tells_which_share_of_its_own_rays_was_of_use() {
    let mut desc = balls();
    desc.integrator = IntegratorDesc::LightTracing(LightTracingDesc { max_depth: 3 }).into();
    let ((scene, view), mut film) = (viewed(&desc), empty_film(&desc));
    let mut integrator = build(&desc).unwrap().integrator;
    let report = render(&mut *integrator, &scene, &view, &mut film, &Control::default()).unwrap();
    let (_, told) = integrator.summary().remove(0);
    let rays: u64 = told.rsplit(' ').next().unwrap().parse().unwrap();
    assert_eq!(rays, report.stats.rays - film.sample_count(), "all but the camera's rays: {told}");
}

/// Remembers the directions and wavelengths that it is asked about.
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
fn jitter_can_be_switched_off() {
    let distinct = |pixel: bool, wavelength: bool| {
        let mut desc = SceneDesc::default();
        desc.film.resolution = [1, 1];
        desc.options.disable_pixel_jitter = pixel;
        desc.options.disable_wavelength_jitter = wavelength;
        let recorder: &'static Recorder = Box::leak(Box::default());
        let mut integrator = PixelLoop::new(recorder, Sampler::Independent(Independent::new(8, 0)));
        let (scene, view) = viewed(&desc);
        render(&mut integrator, &scene, &view, &mut empty_film(&desc), &Control::default()).unwrap();
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
