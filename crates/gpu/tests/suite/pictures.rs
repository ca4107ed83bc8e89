//! Pictures of scenes by both engines, from the same random numbers.

use std::path::Path;
use std::sync::{Arc, OnceLock};

use alhazen_gpu::{Algorithm, Flat, Kernels, Refusal, Renderer, Subject, flatten};
use description::{AmbientOcclusionDesc, IntegratorDesc, LightSamplerDesc, PathDesc, SceneDesc};
use film::Film;
use image::Image;
use import::{AssetSource, Files, MemoryAssets, import};
use integrators::{
    AmbientOcclusion, Control, Limits, PixelLoop, RayCasting, RayIntegrator, Session, SessionState,
};
use sampling::Sampler;
use sampling::sampler::Independent;
use scene::{Interfaces, Scene, View};
use spectrum::RgbColorSpace;

const SAMPLES: u32 = 2;

/// The kernels of the first device, which are compiled once.
fn kernels() -> Option<Arc<Kernels>> {
    static KERNELS: OnceLock<Option<Arc<Kernels>>> = OnceLock::new();
    KERNELS.get_or_init(|| crate::device().map(|device| Arc::new(Kernels::new(device)))).clone()
}

/// A small picture of a scene.
struct Case {
    scene: Arc<Scene>,
    view: View,
    desc: SceneDesc,
}

impl Case {
    fn new(path: &Path, assets: &dyn AssetSource) -> Self {
        let mut desc = import(path, assets).desc;
        desc.film.resolution = [64, 48];
        desc.film.save_fp16 = false;
        let scene = scene::compile(desc.clone()).expect("a scene").scene;
        let view = View::compile(&desc, scene.world_from_render()).expect("a view").view;
        Self { scene: Arc::new(scene), view, desc }
    }

    fn of_text(text: &str) -> Self {
        let path = Path::new("scene.pbrt");
        Self::new(path, &MemoryAssets::default().with(path, text))
    }

    /// One of the repository's scenes.
    fn named(name: &str) -> Self {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes");
        Self::new(&Path::new(folder).join(name).with_extension("pbrt"), &Files)
    }

    fn film(&self) -> Film {
        film::compile(&self.desc).expect("a film").film
    }

    /// The settings of `path` of the scene, or the default ones.
    fn path(&self) -> PathDesc {
        match self.desc.integrator.value {
            IntegratorDesc::Path(settings) => settings,
            _ => PathDesc::default(),
        }
    }

    fn flatten(&self, algorithm: &Algorithm) -> Result<Flat, Vec<Refusal>> {
        let Self { scene, view, .. } = self;
        let lights = scene.light_sampler(algorithm.light_sampler(), &Default::default()).expect("a choice");
        let (film, sampler) = (&self.film(), &sampler());
        flatten(Subject { scene, view, film, algorithm, sampler }, &lights)
    }

    fn on_gpu(&self, kernels: &Arc<Kernels>, algorithm: &Algorithm) -> Image {
        let flat = self.flatten(algorithm).unwrap_or_else(|refusals| panic!("{refusals:?}"));
        let mut film = self.film();
        let renderer = Renderer::new(kernels.clone(), &flat, algorithm, &film).expect("a renderer");
        for index in 0..SAMPLES {
            let rays = renderer.pass(index, &self.view, &sampler(), &mut film, || false).expect("a pass");
            assert!(rays >= Some(64 * 48));
        }
        film.develop().expect("a picture")
    }

    fn on_cpu(&self, algorithm: &Algorithm) -> Image {
        match algorithm {
            Algorithm::RayCasting => self.by(RayCasting),
            Algorithm::AmbientOcclusion(desc, space) => self.by(AmbientOcclusion::new(*desc, space)),
            Algorithm::Path(desc) => self.by(integrators::Path::new(*desc, Interfaces::Stop)),
        }
    }

    fn by(&self, rays: impl RayIntegrator + 'static) -> Image {
        let integrator = Box::new(PixelLoop::new(rays, sampler()));
        let state = SessionState::new(self.film());
        let mut session = Session::new(self.scene.clone(), self.view.clone(), integrator, state);
        session.run(0..SAMPLES, &Limits::default(), &Control::default(), &mut |_| ()).expect("all passes");
        session.state().develop().expect("a picture")
    }

    /// Compares the pictures of both engines; what is wrong, if anything. Paths are the same but for
    /// rounding, which seldom decides where one goes.
    fn compare(&self, name: &str, kernels: &Arc<Kernels>, algorithm: &Algorithm) -> Option<String> {
        let (gpu, cpu) = (self.on_gpu(kernels, algorithm), self.on_cpu(algorithm));
        let pairs: Vec<(f32, f32)> = gpu.values().zip(cpu.values()).collect();
        let mean = pairs.iter().map(|(_, b)| f64::from(*b)).sum::<f64>() / pairs.len() as f64;
        let apart = |(a, b): &&(f32, f32)| (a - b).abs() > 1e-3 * b.abs().max(mean as f32 / 10.0);
        let other = pairs.iter().filter(apart).count() as f64 / pairs.len() as f64;
        let same = pairs.iter().filter(|pair| !apart(pair));
        let difference = same.map(|(a, b)| f64::from(a - b)).sum::<f64>() / pairs.len() as f64 / mean;
        println!("{name:20} mean {mean:.4}, {other:.1e} apart, the rest {difference:+.1e}");
        (!(mean > 0.0 && other <= 0.005 && difference.abs() < 1e-4))
            .then(|| format!("{name}: mean {mean}, {other} apart, the rest by {difference}"))
    }
}

fn sampler() -> Sampler {
    Sampler::Independent(Independent::new(SAMPLES, 7))
}

const DRAWN: &[&str] = &["cornell-box"];

fn compare_all(algorithm: impl Fn(&Case) -> Algorithm) {
    let Some(kernels) = kernels() else { return };
    let wrong: Vec<String> = DRAWN
        .iter()
        .filter_map(|name| {
            let case = Case::named(name);
            case.compare(name, &kernels, &algorithm(&case))
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn ray_casting_has_the_picture_of_the_cpu() {
    compare_all(|_| Algorithm::RayCasting);
}

#[test]
fn ambient_occlusion_has_the_picture_of_the_cpu() {
    let near = AmbientOcclusionDesc { max_distance: 3.0, ..Default::default() };
    compare_all(|_| Algorithm::AmbientOcclusion(near, RgbColorSpace::srgb()));
}

#[test]
fn paths_have_the_picture_of_the_cpu() {
    compare_all(|case| Algorithm::Path(case.path()));
}
