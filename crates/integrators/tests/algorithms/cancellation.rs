//! Renders are cancelled at once, also inside a path that would go on for hours.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

use alhazen_integrators::{
    Bdpt, BdptSettings, Cancelled, Control, Integrator, LightTracing, Mlt, MltSettings, Path, PathSettings,
    PhotonMapping, PhotonMappingSettings, PixelLoop, RayIntegrator, SimplePath, Sppm, SppmSettings, Tracer,
    Vcm, VcmSettings,
};
use description::{MltTechnique, SceneDesc, ShapeDesc};
use film::Film;
use math::RayDifferential;
use sampling::Sampler;
use sampling::sampler::Independent;
use scene::{Scene, View};
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::support::{at, diffuse, emission, sphere, v, viewed};

const MAX_DEPTH: u32 = 1_000_000_000;

/// The inside of a sphere that reflects all light: paths hardly ever end.
fn white_furnace() -> (Scene, View, Film) {
    let mut desc = SceneDesc::default();
    desc.film.resolution = [32, 32];
    let (material, area_light) = (diffuse(&mut desc, 1.0), emission(&mut desc, 1.0));
    let sphere = at(sphere(1.0), v(0.2, 0.1, 0.3));
    desc.shapes.push(ShapeDesc { material, area_light, reverse_orientation: true, ..sphere });
    let (scene, view) = viewed(&desc);
    (scene, view, film::compile(&desc).unwrap().film)
}

fn sampler() -> Sampler {
    Sampler::Independent(Independent::new(1, 5))
}

fn algorithms() -> [(&'static str, Box<dyn Integrator>); 9] {
    let path = PathSettings { max_depth: MAX_DEPTH, ..PathSettings::default() };
    let simple = |sample_lights| SimplePath { max_depth: MAX_DEPTH, sample_lights, sample_bsdf: true };
    let bdpt = BdptSettings { max_depth: MAX_DEPTH, ..BdptSettings::default() };
    let vcm = VcmSettings { max_depth: MAX_DEPTH, ..VcmSettings::default() };
    let sppm = SppmSettings { max_depth: MAX_DEPTH, ..SppmSettings::default() };
    let photons = PhotonMappingSettings { max_depth: MAX_DEPTH, ..PhotonMappingSettings::default() };
    let mlt = MltSettings {
        technique: MltTechnique::Path,
        max_depth: MAX_DEPTH,
        regularize: false,
        bootstrap_samples: 100,
        chains: 4,
        mutations_per_pixel: 1,
        large_step_probability: 0.3,
        sigma: 0.01,
    };
    [
        ("path", Box::new(PixelLoop::new(Path::new(path), sampler()))),
        ("simple-path", Box::new(PixelLoop::new(simple(true), sampler()))),
        ("simple-path by chance", Box::new(PixelLoop::new(simple(false), sampler()))),
        ("light-tracing", Box::new(LightTracing::new(MAX_DEPTH, sampler(), sampler()))),
        ("bdpt", Box::new(Bdpt::new(bdpt, sampler(), sampler()))),
        ("vcm", Box::new(Vcm::new(vcm, sampler(), sampler(), 3))),
        ("sppm", Box::new(Sppm::new(sppm, sampler(), 3))),
        ("photon-mapping", Box::new(PhotonMapping::new(photons, sampler(), 3))),
        ("mlt", Box::new(Mlt::new(mlt, sampler(), 3))),
    ]
}

/// If paths did not ask whether to go on, this test would not end.
#[test]
fn a_path_that_hardly_ends_is_cancelled() {
    let (scene, view, _) = white_furnace();
    for (name, mut integrator) in algorithms() {
        let (control, (_, _, mut film)) = (Control::default(), white_furnace());
        integrator.prepare(&scene, &view, &control).unwrap();
        let cancel = Arc::clone(&control.cancel);
        let outcome = std::thread::scope(|scope| {
            scope.spawn(move || {
                std::thread::sleep(Duration::from_millis(30));
                cancel.store(true, Ordering::Relaxed);
            });
            integrator.pass(0, &scene, &view, &mut film, &control)
        });
        assert_eq!(outcome, Err(Cancelled), "{name}");
        assert!(film.develop().values().all(f32::is_finite), "{name}");
    }
}

/// Traces a ray, and estimates 1; of sample 100 it cancels the render before.
struct CancelsSample {
    samples: AtomicU64,
    cancel: Arc<AtomicBool>,
}

impl RayIntegrator for CancelsSample {
    fn li(&self, tracer: &mut Tracer, ray: RayDifferential, _: &mut SampledWavelengths) -> SampledSpectrum {
        if self.samples.fetch_add(1, Ordering::Relaxed) == 100 {
            self.cancel.store(true, Ordering::Relaxed);
        }
        assert_eq!(tracer.intersect(&ray.ray).is_none(), self.cancel.load(Ordering::Relaxed));
        SampledSpectrum::ONE
    }
}

#[test]
fn a_sample_that_was_cancelled_is_not_added_to_the_film() {
    let (scene, view, mut film) = white_furnace();
    let control = Control::default();
    let rays = CancelsSample { samples: AtomicU64::new(0), cancel: Arc::clone(&control.cancel) };
    let mut integrator = PixelLoop::new(rays, sampler());
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let outcome = one_thread.install(|| integrator.pass(0, &scene, &view, &mut film, &control));
    assert_eq!((outcome, film.sample_count()), (Err(Cancelled), 100));
}
