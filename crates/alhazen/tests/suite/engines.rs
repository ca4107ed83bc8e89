//! The engines of path tracing: the wavefront gives the same bits on every instruction set and
//! with every number of threads, and the estimates of the scalar engine.

use std::path::Path;
use std::sync::Arc;

use alhazen::description::{IntegratorDesc, PathDesc, SceneDesc};
use alhazen::geometry::InstructionSet;
use alhazen::import::{AssetSource, Files, import};
use alhazen::integrators::{self, Control, Integrator, Limits, PixelLoop, Session, SessionState, Wavefront};
use alhazen::sampling::Randomize;
use alhazen::sampling::sampler::{Independent, Sampler, ZSobol};
use alhazen::scene::{Interfaces, Scene, View};
use alhazen::{Overrides, film, scene};

use crate::common::scene_text;
use crate::scenes::scenes;

const SPP: u32 = 2;
const RESOLUTION: [i32; 2] = [40, 30];

/// Lights of many kinds that a glossy and a smooth surface reflect: triangles of both orientations,
/// with normals and without, near and far, large and small, rectangles, and lights that are not
/// sampled in lanes.
const LIGHTS: &str = r#"
LookAt 0 1.5 5 0 1 0 0 1 0
Camera "perspective" "float fov" 55
Film "rgb"
WorldBegin
Material "diffuse"
Shape "bilinearmesh" "point3 P" [ -4 0 -4  4 0 -4  -4 0 4  4 0 4 ]
Material "conductor" "float roughness" 0.2
Shape "bilinearmesh" "point3 P" [ -4 0 -3  4 0 -3  -4 4 -3  4 4 -3 ]
Material "conductor"
Shape "bilinearmesh" "point3 P" [ -3 0 -3  -3 0 4  -3 4 -3  -3 4 4 ]
Material "dielectric"
Shape "sphere" "float radius" 0.4
Material "diffuse" "rgb reflectance" [ 0.2 0.6 0.4 ]
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 9 7 4 ]
    Shape "trianglemesh" "point3 P" [ -1 3 -1  1 3 -1  1 3 1  -1 3 1 ] "integer indices" [ 0 1 2  0 2 3 ]
    AreaLightSource "diffuse" "blackbody L" 4000 "float scale" 3 "bool twosided" true
    Shape "trianglemesh" "point3 P" [ 2 0.5 0  2.5 0.5 0  2.2 1.5 0.3 ] "integer indices" [ 0 1 2 ]
    AreaLightSource "diffuse" "float power" 20
    Shape "trianglemesh" "point3 P" [ -2 0.01 0  -1.9 0.01 0.1  -2 0.02 0.1 ] "integer indices" [ 0 2 1 ]
        "normal N" [ 0 1 0  0 1 0  0.1 1 0 ]
    AreaLightSource "diffuse" "rgb L" [ 300 300 900 ]
    ReverseOrientation
    Shape "trianglemesh" "point3 P" [ 40 60 30  44 60 30  44 60 34 ] "integer indices" [ 0 1 2 ]
    Shape "bilinearmesh" "point3 P" [ -20 50 9  -20.5 50 9  -20 50 10  -20.5 50 10 ]
    AreaLightSource "diffuse" "rgb L" [ 4 1 1 ]
    Shape "bilinearmesh" "point3 P" [ 1 0.1 2  1 0.6 2  1.5 0.1 2  1.5 0.6 2 ]
    Shape "trianglemesh" "point3 P" [ -1 0.2 1  -1 0.9 1  -0.5 0.2 1 ] "integer indices" [ 0 1 2 ]
        "float alpha" 0
    Translate 0.5 1 -1
    Shape "sphere" "float radius" 0.1
AttributeEnd
LightSource "point" "point3 from" [ 0 2 3 ] "rgb I" [ 2 2 2 ]
"#;

/// The scenes of the folder and that of many lights, made small, with their names.
fn cases() -> impl Iterator<Item = (SceneDesc, String)> {
    let (path, assets) = scene_text(LIGHTS);
    let lights = (small(path, &assets), "lights".to_string());
    scenes().into_iter().map(|(path, name)| (small(&path, &Files), name)).chain([lights])
}

fn small(path: &Path, assets: &dyn AssetSource) -> SceneDesc {
    let mut desc = import(path, assets).desc;
    let overrides =
        Overrides { resolution: Some(RESOLUTION), samples_per_pixel: Some(SPP), ..Overrides::default() };
    overrides.apply(&mut desc).expect("changes that every scene can take");
    desc.film.save_fp16 = false;
    desc
}

/// A compiled scene, from which every engine starts.
struct Compiled {
    desc: SceneDesc,
    scene: Arc<Scene>,
    view: View,
}

impl Compiled {
    fn new(desc: SceneDesc) -> Self {
        let scene = scene::compile(desc.clone()).expect("a scene").scene;
        let view = View::compile(&desc, scene.world_from_render()).expect("a view").view;
        Self { desc, scene: Arc::new(scene), view }
    }

    /// The values of the picture of an integrator.
    fn picture(&self, integrator: Box<dyn Integrator>, threads: usize) -> Vec<f32> {
        let film = film::compile(&self.desc).expect("a film").film;
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let (scene, view) = (self.scene.clone(), self.view.clone());
        let mut session = Session::new(scene, view, integrator, SessionState::new(film));
        let limits = Limits::default();
        pool.install(|| session.run(0..SPP, &limits, &Control::default(), &mut |_| ())).unwrap();
        session.state().film.develop().unwrap().values().collect()
    }

    fn settings(&self) -> PathDesc {
        match self.desc.integrator.value {
            IntegratorDesc::Path(settings) => settings,
            _ => PathDesc::default(),
        }
    }

    fn path(&self) -> integrators::Path {
        integrators::Path::new(self.settings(), Interfaces::Stop)
    }

    fn wavefront(&self, sampler: &Sampler) -> Wavefront<integrators::Path> {
        Wavefront::new(self.path(), sampler.clone())
    }

    fn scalar(&self, sampler: &Sampler) -> Box<dyn Integrator> {
        Box::new(PixelLoop::new(self.path(), sampler.clone()))
    }
}

fn samplers() -> [Sampler; 2] {
    [
        Sampler::ZSobol(ZSobol::new(SPP, RESOLUTION, Randomize::FastOwen, 0)),
        Sampler::Independent(Independent::new(SPP, 0)),
    ]
}

#[test]
fn instruction_sets_and_threads_never_change_a_bit() {
    for (desc, name) in cases() {
        let compiled = Compiled::new(desc);
        let [sampler, _] = samplers();
        let expected = compiled.picture(Box::new(compiled.wavefront(&sampler)), 1);
        for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
            let integrator = compiled.wavefront(&sampler).with_instruction_set(set);
            let found = compiled.picture(Box::new(integrator), 2);
            assert!(found == expected, "{name} with {set:?}");
        }
    }
}

/// Paths are the same but for rounding. It decides where a hash of a position does (alpha, mixes).
#[test]
fn the_wavefront_agrees_with_the_scalar_engine() {
    for (desc, name) in cases() {
        let compiled = Compiled::new(desc);
        for sampler in samplers() {
            let wavefront = compiled.picture(Box::new(compiled.wavefront(&sampler)), 2);
            let scalar = compiled.picture(compiled.scalar(&sampler), 2);
            let differs = |(a, b): (&f32, &f32)| (a - b).abs() > 1e-3 * (a.abs() + b.abs()).max(1e-2);
            let different = wavefront.iter().zip(&scalar).filter(|&pair| differs(pair)).count();
            let allowed = if name == "textures" { wavefront.len() / 20 } else { wavefront.len() / 500 };
            assert!(different <= allowed, "{name}: {different} of {} values differ", wavefront.len());
        }
    }
}
