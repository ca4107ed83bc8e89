//! Pictures of scenes by both engines, from the same random numbers.

use std::path::Path;
use std::sync::Arc;

use alhazen_gpu::{Algorithm, FindFirstHit, Flat, Refusal, Renderer, Subject, flatten, lacking_stages};
use assets::{AssetSource, Files, MemoryAssets};
use description::{
    AmbientOcclusionDesc, BdptDesc, IntegratorDesc, LightSamplerDesc, LightTracingDesc, PathDesc, SceneDesc,
    Schedule, SimplePathDesc, WhittedDesc,
};
use film::Film;
use image::Image;
use import::import;
use integrators::{
    AmbientOcclusion, Bdpt, Control, FirstHits, Integrator, LightTracing, Limits, Mlt, PixelLoop, RandomWalk,
    RayCasting, RayIntegrator, Session, SessionState, SimplePath, Sppm, Whitted,
};
use sampling::sampler::{Halton, Independent, PaddedSobol, Pmj02Bn, Sobol, Stratified};
use sampling::{Randomize, Sampler};
use scene::{Interfaces, Scene, View};
use spectrum::RgbColorSpace;

use crate::kernels::{kernels, shared};
use crate::motion::LANTERNS;
use crate::texts::{AROUND, HAIR, HOLES, LAMPS, MEDLEY, PANELS, PRINCIPLED, PROJECTOR, STRETCHED};

/// The samples of each pixel.
pub const SAMPLES: u32 = 2;

pub fn imported(path: &Path, assets: &dyn AssetSource) -> SceneDesc {
    let imported = import(path, assets);
    let errors: Vec<_> = imported.diagnostics.iter().filter(|d| d.is_error()).collect();
    assert!(errors.is_empty(), "{errors:?}");
    imported.desc
}

/// A small picture of a scene.
pub struct Case {
    pub scene: Arc<Scene>,
    pub view: View,
    pub desc: SceneDesc,
    pub sampler: Sampler,
    pub light_sampler: Sampler,
}

impl Case {
    fn new(path: &Path, assets: &dyn AssetSource) -> Self {
        Self::sized(path, assets, [64, 48])
    }

    /// A picture of this size.
    pub fn sized(path: &Path, assets: &dyn AssetSource, resolution: [u32; 2]) -> Self {
        Self::described(imported(path, assets), resolution)
    }

    pub fn described(mut desc: SceneDesc, resolution: [u32; 2]) -> Self {
        desc.film.resolution = resolution.map(|n| n as i32);
        desc.film.save_fp16 = false;
        let scene = scene::compile(desc.clone()).expect("a scene").scene;
        let view = View::compile(&desc, scene.world_from_render()).expect("a view").view;
        let [sampler, light_sampler] =
            [7, 8].map(|seed| Sampler::Independent(Independent::new(SAMPLES, seed)));
        Self { scene: Arc::new(scene), view, desc, sampler, light_sampler }
    }

    pub fn of_text(text: &str) -> Self {
        let path = Path::new("scene.pbrt");
        Self::new(path, &MemoryAssets::default().with(path, text))
    }

    /// Lights in instances at rest.
    pub fn of_lanterns() -> Self {
        Self::of_text(&LANTERNS.replace("EndTime", "All"))
    }

    /// A slide of four colours, thrown through a stretched space at a wall and a sphere.
    fn projector() -> Self {
        let slide = [0.9, 0.2, 0.1, 0.1, 0.8, 0.2, 0.3, 0.3, 0.9, 0.8, 0.8, 0.7];
        Self::with_image(PROJECTOR, "slide.pfm", slide)
    }

    /// Principled surfaces, of which one has a coat with four normals of its own.
    fn principled() -> Self {
        let normals = [0.6, 0.5, 0.95, 0.4, 0.4, 0.9, 0.5, 0.65, 0.9, 0.5, 0.5, 1.0];
        Self::with_image(PRINCIPLED, "normals.pfm", normals)
    }

    /// Surfaces of all shapes that emit an image of four colours.
    fn panels() -> Self {
        let panel = [0.9, 0.2, 0.1, 0.1, 0.8, 0.2, 0.3, 0.3, 0.9, 1.5, 1.2, 0.7];
        Self::with_image(PANELS, "panel.pfm", panel)
    }

    /// A scene that reads an image of 2 × 2 colours.
    pub fn with_image(text: &str, name: &str, colors: [f32; 12]) -> Self {
        let bytes = [b"PF\n2 2\n-1.0\n".as_slice(), &colors.map(f32::to_le_bytes).concat()].concat();
        let path = Path::new("scene.pbrt");
        Self::new(path, &MemoryAssets::default().with(path, text).with(name, bytes))
    }

    /// One of the repository's scenes.
    pub fn named(name: &str) -> Self {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes");
        Self::new(&Path::new(folder).join(name).with_extension("pbrt"), &Files)
    }

    /// Takes `sobol` for all paths.
    pub fn take_sobol(&mut self) {
        let size = self.desc.film.resolution;
        let [sampler, light_sampler] =
            [7, 8].map(|seed| Sampler::Sobol(Sobol::new(SAMPLES, size, Randomize::FastOwen, seed)));
        (self.sampler, self.light_sampler) = (sampler, light_sampler);
    }

    pub fn film(&self) -> Film {
        film::compile(&self.desc).expect("a film").film
    }

    /// The settings of `path` of the scene, or the default ones. Paths are short among many small
    /// bodies, whose curvature multiplies rounding from one to the next.
    pub fn path(&self) -> PathDesc {
        let settings = match self.desc.integrator.value {
            IntegratorDesc::Path(settings) => settings,
            _ => PathDesc::default(),
        };
        let is_crowded = self.scene.instances().len() > 100;
        PathDesc { max_depth: settings.max_depth.min(if is_crowded { 1 } else { 5 }), ..settings }
    }

    pub fn flatten(&self, algorithm: &Algorithm) -> Result<Flat, Vec<Refusal>> {
        self.flattened(algorithm, false)
    }

    /// The same, for rays by ray queries if these trace them.
    pub fn flattened(&self, algorithm: &Algorithm, ray_queries: bool) -> Result<Flat, Vec<Refusal>> {
        let Self { scene, view, sampler, light_sampler, .. } = self;
        let lights = scene.light_sampler(algorithm.light_sampler(), &Default::default()).expect("a choice");
        let film = &self.film();
        let subject = Subject {
            scene,
            view,
            film,
            algorithm,
            sampler,
            light_sampler,
            largest_buffer: 1 << 27,
            ray_queries,
        };
        flatten(subject, &lights)
    }

    /// Its picture by an algorithm, ready to be rendered by the GPU, if there is one.
    pub fn renderer(&self, algorithm: &Algorithm) -> Option<Renderer> {
        self.scheduled(algorithm, Schedule::Megakernel)
    }

    /// A renderer that is cut into kernels so.
    pub fn scheduled(&self, algorithm: &Algorithm, schedule: Schedule) -> Option<Renderer> {
        self.rendering(&self.flatten(algorithm), algorithm, schedule)
    }

    /// A renderer of what was flattened.
    pub fn rendering(
        &self,
        flat: &Result<Flat, Vec<Refusal>>,
        algorithm: &Algorithm,
        schedule: Schedule,
    ) -> Option<Renderer> {
        let mut flat = flat.as_ref().unwrap_or_else(|refusals| panic!("{refusals:?}")).clone();
        flat.set_parts(shared(algorithm, schedule, flat.parts()));
        if schedule == Schedule::Wavefront {
            assert_eq!(lacking_stages(algorithm, flat.parts()), None);
        }
        let kernels = kernels(algorithm, &flat)?;
        Some(Renderer::new(kernels, &flat, algorithm, &self.film(), schedule).expect("a renderer"))
    }

    /// The samples of each pixel by the GPU, if there is one.
    pub fn on_gpu(&self, algorithm: &Algorithm) -> Option<Image> {
        Some(self.drawn(&self.renderer(algorithm)?))
    }

    /// The samples of each pixel by a renderer.
    pub fn drawn(&self, renderer: &Renderer) -> Image {
        self.exposed(renderer).develop().expect("a picture")
    }

    /// The film with them.
    pub fn exposed(&self, renderer: &Renderer) -> Film {
        let mut film = self.film();
        let filter = film.filter().clone();
        for index in 0..SAMPLES {
            let hits = FirstHits::new(index, &self.scene, &self.view, &filter, &self.sampler);
            let find: &FindFirstHit = &|tile, pixel, lambda| hits.of(tile, pixel, lambda);
            let rays = renderer.pass(index, &self.view, &mut film, find, || false).expect("a pass");
            let [width, height] = self.desc.film.resolution;
            assert!(rays >= Some((width * height / 4) as u64), "{rays:?}");
        }
        film
    }

    /// The first samples of each pixel by the CPU.
    pub fn on_cpu(&self, algorithm: &Algorithm, samples: u32) -> Image {
        self.session(algorithm, samples).state().develop().expect("a picture")
    }

    /// The session that has made them.
    pub fn session(&self, algorithm: &Algorithm, samples: u32) -> Session {
        let [sampler, light_sampler] = [&self.sampler, &self.light_sampler].map(Clone::clone);
        let integrator: Box<dyn Integrator> = match algorithm {
            Algorithm::RayCasting => self.by_rays(RayCasting),
            Algorithm::Whitted(desc) => self.by_rays(Whitted::new(*desc)),
            Algorithm::AmbientOcclusion(desc, space) => self.by_rays(AmbientOcclusion::new(*desc, space)),
            Algorithm::Path(desc) => self.by_rays(integrators::Path::new(*desc, Interfaces::Stop)),
            Algorithm::VolPath(desc) => self.by_rays(integrators::Path::new(*desc, Interfaces::Pass)),
            Algorithm::SimpleVolPath(desc) => {
                self.by_rays(integrators::Path::without_light_sampling(desc.max_depth))
            }
            Algorithm::SimplePath(desc) => self.by_rays(SimplePath(*desc)),
            Algorithm::RandomWalk(desc) => self.by_rays(RandomWalk(*desc)),
            Algorithm::LightTracing(desc) => Box::new(LightTracing::new(*desc, sampler, light_sampler)),
            Algorithm::Bdpt(desc) => Box::new(Bdpt::new(*desc, sampler, light_sampler)),
            Algorithm::Mlt(desc, seed) => Box::new(Mlt::new(*desc, sampler, *seed)),
            Algorithm::Sppm(desc, seed) => Box::new(Sppm::new(*desc, sampler, *seed)),
        };
        let state = SessionState::new(self.film());
        let mut session = Session::new(self.scene.clone(), self.view.clone(), integrator, state);
        session.run(0..samples, &Limits::default(), &Control::default(), &mut |_| ()).expect("all passes");
        session
    }

    fn by_rays(&self, rays: impl RayIntegrator + 'static) -> Box<dyn Integrator> {
        Box::new(PixelLoop::new(rays, self.sampler.clone()))
    }

    /// Compares the pictures of both engines; what is wrong, if anything. Paths are the same but
    /// for rounding, which seldom decides where one goes.
    pub fn compare(&self, name: &str, algorithm: &Algorithm) -> Option<String> {
        self.differs(name, algorithm, &self.on_gpu(algorithm)?)
    }

    /// What is wrong with a picture of the GPU, if anything.
    pub fn differs(&self, name: &str, algorithm: &Algorithm, gpu: &Image) -> Option<String> {
        let cpu = self.on_cpu(algorithm, SAMPLES);
        let pairs: Vec<(f32, f32)> = gpu.values().zip(cpu.values()).collect();
        let mean = pairs.iter().map(|(_, b)| f64::from(*b)).sum::<f64>() / pairs.len() as f64;
        let mut values: Vec<f32> = cpu.values().collect();
        values.sort_by(f32::total_cmp);
        // Bright pixels do not hide the others.
        let floor = values[values.len() / 2] / 10.0;
        let sizes = sizes(&cpu, if algorithm.splats() { SPREAD } else { 0 });
        let is_apart = |((a, b), size): (&(f32, f32), &f32)| (a - b).abs() > 1e-3 * size.max(floor);
        let (apart, same): (Vec<_>, Vec<_>) = pairs.iter().zip(&sizes).partition(|pair| is_apart(*pair));
        let other = apart.len() as f64 / pairs.len() as f64;
        let sum: f64 = same.iter().map(|((a, b), _)| f64::from(a - b)).sum();
        let difference = sum / pairs.len() as f64 / mean;
        println!("{name:20} mean {mean:.4}, {other:.1e} apart, the rest {difference:+.1e}");
        // These scenes multiply rounding, by hashes of positions and by slopes of bumps. With the
        // CPU alone, moving the camera by 1e-7 changes 5 % of the values of `textures` and 0.7 %
        // of `noise`; by 1e-5, the rounding of the far water, 0.9 % of `bump-map`. Of
        // `cornell-box` and `mirror-room` none changes.
        let share = match name {
            "textures" => 0.03,
            "bump-map" => 0.02,
            "noise" => 0.01,
            _ => 0.005,
        };
        (!(mean > 0.0 && other <= share && difference.abs() < 1e-4))
            .then(|| format!("{name}: mean {mean}, {other} apart, the rest by {difference}"))
    }
}

/// How many pixels from the one where it falls a splat may reach, by the filters of these pictures.
const SPREAD: i32 = 2;

/// What the differences of values are compared with: the largest value of the same colour so many
/// pixels around.
///
/// A splat that falls beside its place by a part δ of a pixel changes a value by its weight's slope
/// there, which may be large beside that weight, near the filter's edge, but is less than 6.8 times
/// (of a Gaussian of standard deviation ½) the weight that it has in the pixel where it falls. So
/// rounding of places up to δ = 1.5e-4 changes no value by a thousandth of the largest around.
fn sizes(picture: &Image, spread: i32) -> Vec<f32> {
    let [width, height] = [picture.width() as i32, picture.height() as i32];
    let size = |x: i32, y: i32, channel: usize| {
        let [columns, rows] = [(x, width), (y, height)]
            .map(|(at, end)| (at - spread).max(0) as u32..(at + spread + 1).min(end) as u32);
        let value = |x, y| picture.channel(x, y, channel).abs();
        let around = rows.flat_map(|y| columns.clone().map(move |x| (x, y)));
        around.map(|(x, y)| value(x, y)).fold(0.0, f32::max)
    };
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    places.flat_map(|(x, y)| [0, 1, 2].map(|channel| size(x, y, channel))).collect()
}

/// Scenes of the repository that kernels draw.
pub const DRAWN: [&str; 24] = [
    "bump-map",
    "caustic-ball",
    "cornell-box",
    "depth-of-field",
    "door",
    "environment",
    "instances",
    "luminaires",
    "mesh",
    "mirror-room",
    "noise",
    "path-tracing",
    "polygon",
    "prism",
    "radiosity-room",
    "reflection",
    "refraction",
    "shadow-hard",
    "shadow-soft",
    "sphere-and-plane",
    "spheres",
    "spot-lights",
    "textures",
    "translucency",
];

fn compare_all(scenes: &[&str], algorithm: impl Fn(&Case) -> Algorithm) {
    let compare = |name: &&str| {
        let case = Case::named(name);
        case.compare(name, &algorithm(&case))
    };
    let wrong: Vec<String> = scenes.iter().filter_map(compare).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn ray_casting_has_the_picture_of_the_cpu() {
    compare_all(&DRAWN[..8], |_| Algorithm::RayCasting);
}

#[test]
fn ambient_occlusion_has_the_picture_of_the_cpu() {
    let near = AmbientOcclusionDesc { max_distance: 3.0, ..Default::default() };
    compare_all(&DRAWN[4..8], |_| Algorithm::AmbientOcclusion(near, RgbColorSpace::srgb()));
}

/// The scenes as they come, with their sampler and its settings, and by kernels that have the parts
/// that they need alone: lights with surfaces, lights at points, or images.
#[test]
fn blue_noise_has_the_picture_of_the_cpu() {
    for name in ["cornell-box", "spot-lights", "textures"] {
        let mut case = Case::named(name);
        case.sampler = integrators::sampler(&case.desc);
        assert!(matches!(case.sampler, Sampler::ZSobol(_)), "{name}");
        assert_eq!(case.compare(name, &Algorithm::Path(case.path())), None);
    }
}

#[test]
fn whitted_has_the_picture_of_the_cpu() {
    compare_all(&["mirror-room", "refraction", "prism"], |_| Algorithm::Whitted(WhittedDesc::default()));
}

/// Compares pictures of scenes by an algorithm with light paths.
fn compare_splats(scenes: &[&str], algorithm: &Algorithm, has_sobol: bool) {
    let named = scenes.iter().map(|&name| (name, Case::named(name)));
    let others = [
        ("medley", Case::of_text(MEDLEY)),
        ("stretched", Case::of_text(STRETCHED)),
        ("projector", Case::projector()),
        ("lamps", Case::of_text(LAMPS)),
        ("lanterns", Case::of_lanterns()),
    ];
    for (name, mut case) in named.chain(others) {
        if has_sobol {
            case.take_sobol();
        }
        assert_eq!(case.compare(name, algorithm), None);
    }
}

#[test]
fn light_paths_have_the_picture_of_the_cpu() {
    let light_tracing = Algorithm::LightTracing(LightTracingDesc { max_depth: 4 });
    compare_splats(&["caustic-ball", "environment"], &light_tracing, true);
    // With room for so many splats, strips are a row of tiles.
    let long = Algorithm::LightTracing(LightTracingDesc { max_depth: 1000 });
    let mut case = Case::named("cornell-box");
    case.take_sobol();
    assert_eq!(case.compare("splats in strips", &long), None);
}

#[test]
fn bidirectional_paths_have_the_picture_of_the_cpu() {
    let settings = BdptDesc { max_depth: 4, regularize: true, ..BdptDesc::default() };
    let bdpt = Algorithm::Bdpt(settings);
    let scenes = ["cornell-box", "depth-of-field", "environment", "luminaires", "prism"];
    compare_splats(&scenes, &bdpt, false);
}

#[test]
fn a_projector_has_the_picture_of_the_cpu() {
    let path = PathDesc { max_depth: 3, ..PathDesc::default() };
    assert_eq!(Case::projector().compare("projector", &Algorithm::Path(path)), None);
}

/// Lights with images, which paths hit and choose.
#[test]
fn images_of_surfaces_have_the_picture_of_the_cpu() {
    let path = PathDesc { max_depth: 2, ..PathDesc::default() };
    assert_eq!(Case::panels().compare("panels", &Algorithm::Path(path)), None);
}

#[test]
fn points_of_all_samplers_have_the_picture_of_the_cpu() {
    let mut case = Case::named("depth-of-field");
    let occlusion = Algorithm::AmbientOcclusion(Default::default(), RgbColorSpace::srgb());
    let size = case.desc.film.resolution;
    let [none, digits, fast, owen] =
        [Randomize::None, Randomize::PermuteDigits, Randomize::FastOwen, Randomize::Owen];
    for sampler in [
        Sampler::PaddedSobol(PaddedSobol::new(SAMPLES, fast, 7)),
        Sampler::Sobol(Sobol::new(SAMPLES, size, none, 7)),
        Sampler::Sobol(Sobol::new(SAMPLES, size, owen, 7)),
        Sampler::Halton(Halton::new(SAMPLES, none, 7)),
        Sampler::Halton(Halton::new(SAMPLES, digits, 7)),
        Sampler::Halton(Halton::new(SAMPLES, owen, 7)),
        Sampler::Stratified(Stratified::new([1, 2], true, 7)),
        Sampler::Stratified(Stratified::new([2, 1], false, 7)),
        Sampler::Pmj02Bn(Pmj02Bn::new(SAMPLES, 7)),
    ] {
        let name = format!("{sampler:?}").chars().take(20).collect::<String>();
        case.sampler = sampler;
        assert_eq!(case.compare(&name, &occlusion), None);
    }
}

#[test]
fn paths_have_the_picture_of_the_cpu() {
    compare_all(&DRAWN, |case| Algorithm::Path(case.path()));
}

/// Other choices of lights than that of the scenes, and surfaces and lights that they do not have.
#[test]
fn lights_surfaces_and_cameras_of_all_kinds_have_the_picture_of_the_cpu() {
    let case = Case::of_text(MEDLEY);
    for light_sampler in [LightSamplerDesc::Uniform, LightSamplerDesc::Power, LightSamplerDesc::Bvh] {
        let settings = PathDesc { light_sampler, regularize: true, max_depth: 4 };
        let wrong = case.compare("medley", &Algorithm::Path(settings));
        assert_eq!(wrong, None, "{light_sampler:?}");
    }
    for algorithm in
        [Algorithm::RayCasting, Algorithm::AmbientOcclusion(Default::default(), RgbColorSpace::srgb())]
    {
        assert_eq!(case.compare("medley", &algorithm), None, "{algorithm:?}");
    }
    let path = PathDesc { max_depth: 3, ..PathDesc::default() };
    assert_eq!(Case::of_text(LAMPS).compare("lamps", &Algorithm::Path(path)), None);
}

/// A picture too large for one strip, and a part of the film alone.
#[test]
fn strips_make_up_the_picture() {
    let text =
        "LookAt 0 -5 1  0 0 0  0 0 1\nCamera \"perspective\"\nFilm \"rgb\"\nWorldBegin\nShape \"sphere\"\n";
    let mut case = Case::of_text(text);
    case.desc.film.resolution = [5000, 80];
    case.desc.film.pixel_bounds = Some([0, 4097, 3, 75]);
    case.view = View::compile(&case.desc, case.scene.world_from_render()).expect("a view").view;
    let occlusion = Algorithm::AmbientOcclusion(Default::default(), RgbColorSpace::srgb());
    assert_eq!(case.compare("strips", &occlusion), None);
}

#[test]
fn holes_have_the_picture_of_the_cpu() {
    let case = Case::of_text(HOLES);
    let path = PathDesc { max_depth: 3, ..PathDesc::default() };
    assert_eq!(case.compare("holes", &Algorithm::Path(path)), None);
    assert_eq!(case.compare("holes", &Algorithm::RayCasting), None);
}

/// Alphas and mixes between 0 and 1 are decided by hashes of what is rounded, so that pictures
/// have other noise.
#[test]
fn partial_holes_and_mixes_have_the_mean_of_the_cpu() {
    let text = r#"
LookAt 0 -3 1  0 0 0.4  0 0 1
Camera "perspective" "float fov" 50
Film "rgb"
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
Shape "sphere" "float radius" 0.5 "float alpha" 0.3
AttributeBegin
    AreaLightSource "diffuse"
    Translate 0.8 -0.2 0.3
    Shape "sphere" "float radius" 0.3 "float alpha" 0.4
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0 0 0 ]
Shape "disk" "float radius" 2 "float height" -0.5
MakeNamedMaterial "white" "string type" "diffuse" "rgb reflectance" [ 1 1 1 ]
MakeNamedMaterial "black" "string type" "diffuse" "rgb reflectance" [ 0 0 0 ]
Material "mix" "string materials" [ "white" "black" ] "float amount" 0.25
Translate 0 1 0.6
Shape "sphere" "float radius" 0.8
"#;
    let path = Algorithm::Path(PathDesc { max_depth: 2, ..PathDesc::default() });
    assert_mean(&Case::of_text(text), &path);
}

/// Asserts that the means of both engines agree within five standard deviations of some 3000
/// values that are about as large as they vary.
fn assert_mean(case: &Case, algorithm: &Algorithm) {
    let mean = |image: Image| image.values().map(f64::from).sum::<f64>() / image.values().count() as f64;
    let Some(gpu) = case.on_gpu(algorithm).map(mean) else { return };
    let cpu = mean(case.on_cpu(algorithm, SAMPLES));
    assert!((gpu / cpu - 1.0).abs() < 0.05, "{gpu} {cpu}");
}

/// Smooth clear coats over matte surfaces have a closed form. Others are walked through, by random
/// numbers from the bits of the wavelengths, so that pictures have other noise.
#[test]
fn coats_have_the_picture_of_the_cpu() {
    let text = r#"
LookAt 0 -3 1  0 0 0.2  0 0 1
Camera "perspective" "float fov" 50
Film "rgb"
WorldBegin
LightSource "infinite" "rgb L" [ 0.6 0.8 1 ]
LightSource "point" "point3 from" [ 2 -3 3 ] "float scale" 60
Material "coateddiffuse" "rgb reflectance" [ 0.7 0.3 0.2 ] "float roughness" 0 "float thickness" 0.1
Shape "sphere" "float radius" 0.7
Material "coateddiffuse" "rgb reflectance" [ 0.2 0.5 0.7 ] "float roughness" 0
Shape "disk" "float radius" 3 "float height" -0.7
"#;
    let path = Algorithm::Path(PathDesc { max_depth: 3, ..PathDesc::default() });
    assert_eq!(Case::of_text(text).compare("varnish", &path), None);
    assert_mean(&Case::named("coats"), &path);
}

/// Curves of all profiles, and strands whose absorption is given in all ways. Each strand
/// multiplies rounding by the distance over its radius, so that paths are short.
#[test]
fn curves_and_hair_have_the_picture_of_the_cpu() {
    let path = Algorithm::Path(PathDesc { max_depth: 2, ..PathDesc::default() });
    assert_eq!(Case::named("curves").compare("curves", &path), None);
    assert_eq!(Case::of_text(HAIR).compare("hair", &path), None);
}

#[test]
fn spherical_cameras_have_the_picture_of_the_cpu() {
    let path = Algorithm::Path(PathDesc { max_depth: 3, ..PathDesc::default() });
    for mapping in ["equirectangular", "equalarea"] {
        let case = Case::of_text(&AROUND.replace("MAPPING", mapping));
        assert_eq!(case.compare(mapping, &path), None);
        let refusals = case.flatten(&Algorithm::LightTracing(LightTracingDesc::default())).err();
        assert_eq!(refusals.expect("a refusal")[0].what, "light paths to camera `spherical`");
    }
}

#[test]
fn forced_diffuse_surfaces_and_simple_paths_have_the_picture_of_the_cpu() {
    let text = format!("Option \"forcediffuse\" true\n{MEDLEY}");
    assert_eq!(Case::of_text(&text).compare("forced diffuse", &Algorithm::RayCasting), None);
    let simple = Algorithm::SimplePath(SimplePathDesc { max_depth: 3, ..Default::default() });
    assert_eq!(Case::of_text(MEDLEY).compare("simple path", &simple), None);
}

#[test]
fn principled_surfaces_have_the_picture_of_the_cpu() {
    let path = Algorithm::Path(PathDesc { max_depth: 3, ..PathDesc::default() });
    assert_eq!(Case::principled().compare("principled", &path), None);
}
