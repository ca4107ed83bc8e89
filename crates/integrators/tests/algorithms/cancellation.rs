//! Renders are cancelled at once, also within very long paths.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

use alhazen_integrators::{
    Bdpt, Control, Integrator, LightTracing, MAX_PHOTON_PATHS, Mlt, PassError, Path, PhotonMapping,
    PixelLoop, RayIntegrator, SimplePath, Sppm, Tracer, Vcm,
};
use description::{
    BdptDesc, LightTracingDesc, MltDesc, MltTechnique, PathDesc, PhotonMappingDesc, SceneDesc, ShapeDesc,
    SimplePathDesc, SppmDesc, VcmDesc,
};
use film::Film;
use math::RayDifferential;
use sampling::Sampler;
use sampling::sampler::Independent;
use scene::{Interfaces, Scene, View};
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::support::{at, diffuse, emission, sphere, v, viewed};

const MAX_DEPTH: u32 = 1_000_000_000;

/// The inside of a sphere of albedo 1: paths hardly ever end.
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
    let path = PathDesc { max_depth: MAX_DEPTH, ..PathDesc::default() };
    let simple =
        |sample_lights| SimplePath(SimplePathDesc { max_depth: MAX_DEPTH, sample_lights, sample_bsdf: true });
    let light_tracing = LightTracingDesc { max_depth: MAX_DEPTH };
    let bdpt = BdptDesc { max_depth: MAX_DEPTH, ..BdptDesc::default() };
    let vcm = VcmDesc { max_depth: MAX_DEPTH, ..VcmDesc::default() };
    let sppm = SppmDesc { max_depth: MAX_DEPTH, ..SppmDesc::default() };
    let photons = PhotonMappingDesc { max_depth: MAX_DEPTH, ..PhotonMappingDesc::default() };
    let mlt = MltDesc {
        technique: MltTechnique::Path,
        max_depth: MAX_DEPTH,
        bootstrap_samples: 100,
        chains: 4,
        mutations_per_pixel: 1,
        ..MltDesc::default()
    };
    [
        ("path", Box::new(PixelLoop::new(Path::new(path, Interfaces::Stop), sampler()))),
        ("simple-path", Box::new(PixelLoop::new(simple(true), sampler()))),
        ("simple-path by chance", Box::new(PixelLoop::new(simple(false), sampler()))),
        ("light-tracing", Box::new(LightTracing::new(light_tracing, sampler(), sampler()))),
        ("bdpt", Box::new(Bdpt::new(bdpt, sampler(), sampler()))),
        ("vcm", Box::new(Vcm::new(vcm, sampler(), sampler(), 3, MAX_PHOTON_PATHS))),
        ("sppm", Box::new(Sppm::new(sppm, sampler(), 3))),
        ("photon-mapping", Box::new(PhotonMapping::new(photons, sampler(), 3))),
        ("mlt", Box::new(Mlt::new(mlt, sampler(), 3))),
    ]
}

/// If paths did not check for cancellation, this test would not end.
#[test]
fn a_very_long_path_is_cancelled() {
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
        assert_eq!(outcome, Err(PassError::Cancelled), "{name}");
        assert!(film.develop().unwrap().values().all(f32::is_finite), "{name}");
    }
}

/// Traces a ray, and estimates 1; it cancels the render before sample 100.
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
fn a_cancelled_sample_is_not_added_to_the_film() {
    let (scene, view, mut film) = white_furnace();
    let control = Control::default();
    let rays = CancelsSample { samples: AtomicU64::new(0), cancel: Arc::clone(&control.cancel) };
    let mut integrator = PixelLoop::new(rays, sampler());
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let outcome = one_thread.install(|| integrator.pass(0, &scene, &view, &mut film, &control));
    assert_eq!((outcome, film.sample_count()), (Err(PassError::Cancelled), 100));
}
