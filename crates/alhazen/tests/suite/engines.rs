//! The engines: the wavefront gives the same bits on every instruction set and with every number of
//! threads, and the estimates of the scalar engine.

use std::path::Path;
use std::sync::Arc;

use alhazen::assets::{AssetSource, Files, MemoryAssets};
use alhazen::description::{AmbientOcclusionDesc, IntegratorDesc, PathDesc, SceneDesc};
use alhazen::geometry::InstructionSet;
use alhazen::import::import;
use alhazen::integrators::{
    self, AmbientOcclusion, Control, Integrator, Limits, PixelLoop, RayCasting, Session, SessionState,
    WaveIntegrator, Wavefront, Whitted,
};
use alhazen::sampling::Randomize;
use alhazen::sampling::sampler::{Independent, Sampler, ZSobol};
use alhazen::scene::{Interfaces, Scene, View};
use alhazen::spectrum::RgbColorSpace;
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

/// Surfaces that are not shaded in lanes, or that more than one ray leaves: interfaces, mixes with
/// them, alpha, backs that the camera does not see, panes and blocks of glass, dispersion, mirrors,
/// instances. Textures are not filtered, so that each point has one of two values.
const SURFACES: &str = r#"
Option "disabletexturefiltering" true
LookAt 0 1.5 5 0 0.8 0 0 1 0
Camera "perspective" "float fov" 50
Film "rgb"
Integrator "whitted" "bool ambient" true
WorldBegin
LightSource "point" "point3 from" [ 1 3 2 ] "rgb I" [ 9 9 9 ]
LightSource "distant" "point3 from" [ -1 2 1 ] "point3 to" [ 0 0 0 ] "rgb L" [ 1 1 1 ]
LightSource "infinite" "rgb L" [ 0.2 0.3 0.4 ]
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 4 4 3 ]
    Shape "bilinearmesh" "point3 P" [ -1 3 -1  -1 3 1  1 3 -1  1 3 1 ]
AttributeEnd
Texture "squares" "float" "checkerboard" "float uscale" 5 "float vscale" 5 "float tex1" 0 "float tex2" 1
MakeNamedMaterial "nothing" "string type" "interface"
MakeNamedMaterial "clay" "string type" "diffuse" "rgb reflectance" [ 0.7 0.4 0.3 ]
MakeNamedMaterial "holes" "string type" "mix" "string materials" [ "nothing" "clay" ] "texture amount" "squares"
NamedMaterial "clay"
Shape "bilinearmesh" "point3 P" [ -4 0 -4  -4 0 4  4 0 -4  4 0 4 ]
NamedMaterial "nothing"
Shape "sphere" "float radius" 0.9
Shape "bilinearmesh" "point3 P" [ -2 0.2 1.5  -1 0.2 1.5  -2 1.2 1.5  -1 1.2 1.5 ]
NamedMaterial "holes"
Shape "bilinearmesh" "point3 P" [ -2 0 -1.5  0 0 -1.5  -2 2 -1.5  0 2 -1.5 ]
NamedMaterial "clay"
Shape "bilinearmesh" "point3 P" [ 0 0 -2  2 0 -2  0 2 -2  2 2 -2 ] "texture alpha" "squares"
Shape "bilinearmesh" "point3 P" [ 0.5 0.5 2  0.5 1.2 2  1.2 0.5 2  1.2 1.2 2 ] "bool singlesided" true
Shape "trianglemesh" "point3 P" [ -1.2 0.5 2  -0.5 0.5 2  -0.5 1.2 2 ] "integer indices" [ 0 2 1 ] "bool singlesided" true
Material "thindielectric"
Shape "bilinearmesh" "point3 P" [ 0.8 0 1  1.8 0 1  0.8 1 1  1.8 1 1 ]
Material "dielectric" "spectrum eta" "glass-F11"
Shape "sphere" "float radius" 0.5
Material "conductor" "float roughness" 0.3
Shape "sphere" "float radius" 0.3 "float zmin" -0.1
Material "conductor"
Shape "bilinearmesh" "point3 P" [ -3 0 -3  3 0 -3.5  -3 3 -3  3 3 -3.5 ]
Material "dielectric"
ObjectBegin "slab"
    Shape "bilinearmesh" "point3 P" [ -1.6 0 0.6  -0.6 0 0.6  -1.6 1 0.6  -0.6 1 0.6 ]
    Shape "bilinearmesh" "point3 P" [ -1.6 0 0.2  -1.6 1 0.2  -0.6 0 0.2  -0.6 1 0.2 ]
ObjectEnd
ObjectInstance "slab"
Translate 0.2 0.1 0.1
ObjectInstance "slab"
"#;

/// Media that differ and vary, bounded by interfaces and by surfaces that scatter, one in another,
/// some that emit; the camera is in one of them. Glass disperses, and skin lets light go under it.
const MEDIA: &str = r#"
LookAt 0 1.5 5 0 0.8 0 0 1 0
MakeNamedMedium "haze" "string type" "homogeneous" "rgb sigma_s" [ 0.05 0.06 0.08 ] "rgb sigma_a" [ 0.01 0.01 0 ]
MakeNamedMedium "wine" "string type" "homogeneous" "rgb sigma_a" [ 0.2 2 2 ] "rgb sigma_s" [ 0.1 0.1 0.1 ]
MakeNamedMedium "smoke" "string type" "uniformgrid" "point3 p0" [ -1 0 -1 ] "point3 p1" [ 1 1 1 ]
    "integer nx" 2 "integer ny" 2 "integer nz" 2 "float density" [ 0 1 2 0.5 3 0 0.2 1 ]
    "rgb sigma_s" [ 2 1.5 1 ] "rgb sigma_a" [ 0.1 0.5 0.5 ]
MakeNamedMedium "fire" "string type" "rgbgrid" "point3 p0" [ -2 0 -2 ] "point3 p1" [ -1 2 -1 ]
    "integer nx" 1 "integer ny" 2 "integer nz" 1 "rgb sigma_a" [ 1 1 1  0.1 0.2 0.3 ]
    "rgb Le" [ 3 1 0.2  1 0.3 0 ]
MediumInterface "" "haze"
Camera "perspective" "float fov" 50
Film "rgb"
Integrator "volpath" "integer maxdepth" 6
WorldBegin
LightSource "point" "point3 from" [ 1 3 2 ] "rgb I" [ 9 9 9 ]
LightSource "infinite" "rgb L" [ 0.2 0.3 0.4 ]
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 4 4 3 ]
    Shape "bilinearmesh" "point3 P" [ -1 3 -1  -1 3 1  1 3 -1  1 3 1 ]
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.7 0.4 0.3 ]
Shape "bilinearmesh" "point3 P" [ -4 0 -4  -4 0 4  4 0 -4  4 0 4 ]
AttributeBegin
    Material "interface"
    MediumInterface "smoke" "haze"
    Shape "sphere" "float radius" 0.9
    MediumInterface "fire" "haze"
    Translate -1.5 1 -1.5
    Shape "sphere" "float radius" 0.8
AttributeEnd
AttributeBegin
    Translate 1.5 0.6 1
    MediumInterface "wine" "haze"
    Material "dielectric" "spectrum eta" "glass-F11"
    Shape "sphere" "float radius" 0.5
    Translate -0.5 -0.2 -2.5
    Material "dielectric" "float roughness" 0.3
    Shape "sphere" "float radius" 0.5
    Translate -2.6 0 2
    Material "subsurface" "rgb mfp" [ 0.1 0.05 0.02 ] "rgb reflectance" [ 0.8 0.5 0.4 ] "float roughness" 0.2
    Shape "sphere" "float radius" 0.4
    Translate 1 0 0.8
    Material "hair"
    Shape "sphere" "float radius" 0.2
AttributeEnd
"#;

/// Principled surfaces of all kinds, some with numbers that vary, on shapes in lanes and others.
const PRINCIPLED: &str = r#"
Option "disabletexturefiltering" true
LookAt 0 1.5 5 0 0.8 0 0 1 0
Camera "perspective" "float fov" 50
Film "rgb"
WorldBegin
LightSource "point" "point3 from" [ 1 3 2 ] "rgb I" [ 9 9 9 ]
LightSource "infinite" "rgb L" [ 0.4 0.5 0.6 ]
Texture "tiles" "float" "checkerboard" "float uscale" 5 "float vscale" 5 "float tex1" 0.2 "float tex2" 0.8
Texture "here" "float" "checkerboard" "float uscale" 3 "float vscale" 3 "float tex1" 0 "float tex2" 1
Material "openpbr" "texture specular_roughness" "tiles" "texture base_metalness" "here"
Shape "bilinearmesh" "point3 P" [ -4 0 -4  -4 0 4  4 0 -4  4 0 4 ]
Material "openpbr" "texture coat_weight" "here" "rgb coat_color" [ 0.9 0.5 0.4 ] "texture fuzz_weight" "tiles"
    "float specular_roughness_anisotropy" 0.5
Shape "bilinearmesh" "point3 P" [ -2 0 -1.5  0 0 -1.5  -2 2 -1.5  0 2 -1.5 ]
Material "openpbr" "texture thin_film_weight" "here" "texture transmission_weight" "tiles"
    "float specular_roughness" 0.4 "float transmission_dispersion_scale" 1
Shape "bilinearmesh" "point3 P" [ 0 0 -2  2 0 -2  0 2 -2  2 2 -2 ]
Translate -1 0.5 0.5
Shape "sphere" "float radius" 0.5
Material "openpbr" "float transmission_weight" 0.5 "bool geometry_thin_walled" true "float subsurface_weight" 0.5
Translate 1 0 0
Shape "sphere" "float radius" 0.4
Material "openpbr" "float subsurface_weight" 1 "float subsurface_radius" 0.1
Translate 1 0 0
Shape "sphere" "float radius" 0.4
"#;

/// Bodies whose paths a probe leads under the surface: smooth and rough ones, shapes and meshes,
/// one that is textured, one with bumps, one that shines, and one that is a part of a mix.
const BODIES: &str = r#"
LookAt 0 1.5 5 0 0.8 0 0 1 0
Camera "perspective" "float fov" 50
Film "rgb"
WorldBegin
LightSource "point" "point3 from" [ 1 3 2 ] "rgb I" [ 9 9 9 ]
LightSource "infinite" "rgb L" [ 0.2 0.3 0.4 ]
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 4 4 3 ]
    Shape "bilinearmesh" "point3 P" [ -1 3 -1  -1 3 1  1 3 -1  1 3 1 ]
AttributeEnd
Texture "tiles" "spectrum" "checkerboard" "float uscale" 5 "float vscale" 5
    "rgb tex1" [ 0.9 0.6 0.3 ] "rgb tex2" [ 0.3 0.6 0.8 ]
Texture "squares" "float" "checkerboard" "float uscale" 4 "float vscale" 4 "float tex1" 0 "float tex2" 1
Texture "bumps" "float" "fbm"
Texture "height" "float" "scale" "texture tex" "bumps" "float scale" 0.05
MakeNamedMaterial "skin" "string type" "subsurface" "string name" "Skin1" "float scale" 8
MakeNamedMaterial "clay" "string type" "diffuse"
MakeNamedMaterial "both" "string type" "mix" "string materials" [ "skin" "clay" ] "texture amount" "squares"
Material "subsurface" "texture reflectance" "tiles" "rgb mfp" [ 0.2 0.1 0.05 ]
Shape "bilinearmesh" "point3 P" [ -4 0 -4  -4 0 4  4 0 -4  4 0 4 ]
NamedMaterial "both"
Shape "bilinearmesh" "point3 P" [ -3 0 -2  3 0 -2  -3 2 -2  3 2 -2 ]
AttributeBegin
    Translate -1.4 0.5 0.5
    NamedMaterial "skin"
    Shape "sphere" "float radius" 0.5
    Translate 1 0 0
    Material "subsurface" "rgb mfp" [ 0.1 0.05 0.02 ] "rgb reflectance" [ 0.8 0.5 0.4 ] "float roughness" 0.3
    Shape "sphere" "float radius" 0.4
    Translate 1 0 0
    Material "subsurface" "rgb sigma_a" [ 0.5 1 2 ] "rgb sigma_s" [ 9 9 9 ] "texture displacement" "height"
    Shape "trianglemesh" "point3 P" [ -0.4 -0.5 0.3  0.4 -0.5 0.3  0 -0.5 -0.4  0 0.4 0 ]
        "integer indices" [ 0 1 3  1 2 3  2 0 3  0 2 1 ]
    AreaLightSource "diffuse" "rgb L" [ 0.5 0.1 0.1 ]
    Translate 0.9 0 0
    NamedMaterial "skin"
    Shape "sphere" "float radius" 0.3
AttributeEnd
"#;

/// Normal maps on meshes with tangents and without, on a sphere and on an instance, under a coat
/// with other normals; bump maps; a mirror and glass. Textures are filtered.
const MAPS: &str = r#"
LookAt 0 1.5 5 0 0.8 0 0 1 0
Camera "perspective" "float fov" 50
Film "rgb"
WorldBegin
LightSource "point" "point3 from" [ 1 3 2 ] "rgb I" [ 9 9 9 ]
LightSource "infinite" "rgb L" [ 0.4 0.5 0.6 ]
Texture "rough" "float" "fbm"
Texture "height" "float" "scale" "texture tex" "rough" "float scale" 0.1
Texture "here" "spectrum" "imagemap" "string filename" "waves.pfm"
MakeNamedMaterial "waves" "string type" "diffuse" "texture reflectance" "here" "string normalmap" "waves.pfm"
MakeNamedMaterial "hills" "string type" "conductor" "float roughness" 0.4 "texture displacement" "height"
NamedMaterial "waves"
Shape "trianglemesh" "point3 P" [ -4 0 -4  -4 0 4  4 0 -4  4 0 4 ] "integer indices" [ 0 1 2  1 3 2 ]
    "point2 uv" [ 0 0  0 2  2 0  2 2 ] "normal N" [ 0 1 0  0.1 1 0  0 1 0.1  0 1 0 ]
    "vector3 S" [ 1 0 0  1 0 1  1 0 0  0 0 1 ]
NamedMaterial "hills"
Shape "bilinearmesh" "point3 P" [ -3 0 -2  0 0 -2  -3 2 -2  0 2 -2 ]
Shape "sphere" "float radius" 0.5
Material "openpbr" "float coat_weight" 1 "float specular_roughness" 0.4 "string normalmap" "waves.pfm"
Shape "trianglemesh" "point3 P" [ 0 0 -2  3 0 -2  0 2 -2  3 2 -2 ] "integer indices" [ 0 1 2  1 3 2 ]
    "point2 uv" [ 0 0  2 0  0 2  2 2 ]
Material "conductor"
Translate -1 0.5 0.5
Shape "sphere" "float radius" 0.5
Material "dielectric" "float eta" 1.2
Translate 1 0 0.5
Shape "sphere" "float radius" 0.4
NamedMaterial "waves"
ObjectBegin "ball"
    Shape "sphere" "float radius" 0.4
ObjectEnd
Translate 1 0 0
ObjectInstance "ball"
"#;

/// The scene with normal maps, and their image.
fn maps() -> (SceneDesc, String) {
    let mut waves = b"PF\n8 8\n-1\n".to_vec();
    for pixel in 0..64u8 {
        let [x, y] = [pixel % 8, pixel / 8].map(|i| (f32::from(i) * 0.8).sin());
        let colors = [0.5 + 0.2 * x, 0.5 + 0.2 * y, 0.9];
        waves.extend(colors.into_iter().flat_map(f32::to_le_bytes));
    }
    let assets = MemoryAssets::default().with("maps.pbrt", MAPS).with("waves.pfm", waves);
    (small(Path::new("maps.pbrt"), &assets), "maps".to_string())
}

/// The scenes of the folder and those above, made small, with their names.
fn cases() -> impl Iterator<Item = (SceneDesc, String)> {
    let texts = [
        (LIGHTS, "lights"),
        (SURFACES, "surfaces"),
        (MEDIA, "media"),
        (PRINCIPLED, "principled surfaces"),
        (BODIES, "bodies"),
    ];
    let texts = texts.map(|(text, name)| {
        let (path, assets) = scene_text(text);
        (small(path, &assets), name.to_string())
    });
    let scenes = scenes().into_iter().map(|(path, name)| (small(&path, &Files), name));
    scenes.chain(texts).chain([maps()])
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

    /// The algorithms of both engines, by the wavefront with an instruction set and scalar.
    fn algorithms(&self, sampler: &Sampler, set: InstructionSet) -> Vec<Engines> {
        let settings = match self.desc.integrator.value {
            IntegratorDesc::Path(settings) | IntegratorDesc::VolPath(settings) => settings,
            _ => PathDesc::default(),
        };
        let path = integrators::Path::new(settings, Interfaces::Stop);
        if !self.scene.media().is_empty() {
            // The others know media in the scalar engine only.
            let vol_path = integrators::Path::new(settings, Interfaces::Pass);
            return vec![
                Engines::new("path", path, sampler, set),
                Engines::new("vol-path", vol_path, sampler, set),
            ];
        }
        let near = AmbientOcclusionDesc { max_distance: 3.0, ..AmbientOcclusionDesc::default() };
        let occlusion = AmbientOcclusion::new(near, RgbColorSpace::srgb());
        let whitted = match self.desc.integrator.value {
            IntegratorDesc::Whitted(settings) => Whitted::new(settings),
            _ => Whitted::default(),
        };
        vec![
            Engines::new("path", path, sampler, set),
            Engines::new("ambient occlusion", occlusion, sampler, set),
            Engines::new("ray casting", RayCasting, sampler, set),
            Engines::new("whitted", whitted, sampler, set),
        ]
    }
}

/// An algorithm by both engines.
struct Engines {
    name: &'static str,
    wavefront: Box<dyn Integrator>,
    scalar: Box<dyn Integrator>,
}

impl Engines {
    fn new(
        name: &'static str,
        rays: impl WaveIntegrator + Clone + 'static,
        sampler: &Sampler,
        set: InstructionSet,
    ) -> Self {
        let wavefront = Wavefront::new(rays.clone(), sampler.clone()).with_instruction_set(set);
        let scalar = PixelLoop::new(rays, sampler.clone());
        Self { name, wavefront: Box::new(wavefront), scalar: Box::new(scalar) }
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
        let pictures = |set, threads| {
            let algorithms = compiled.algorithms(&sampler, set);
            let pictures = algorithms
                .into_iter()
                .map(|engines| (engines.name, compiled.picture(engines.wavefront, threads)));
            pictures.collect::<Vec<_>>()
        };
        let expected = pictures(InstructionSet::detect(), 1);
        for &set in InstructionSet::CHOSEN.iter().filter(|set| set.is_available()) {
            for ((algorithm, found), (_, expected)) in pictures(set, 2).iter().zip(&expected) {
                assert!(found == expected, "{name}, {algorithm} with {set:?}");
            }
        }
    }
}

/// Paths are the same but for rounding. It decides where a hash of a position does (alpha, mixes).
/// Each strand of hair multiplies it by the distance over the strand's radius, about 200, so that
/// paths through hair are short here.
#[test]
fn the_wavefront_agrees_with_the_scalar_engine() {
    for (mut desc, name) in cases() {
        if let ("hair", IntegratorDesc::Path(path)) = (name.as_str(), &mut desc.integrator.value) {
            path.max_depth = 2;
        }
        let compiled = Compiled::new(desc);
        for sampler in samplers() {
            for engines in compiled.algorithms(&sampler, InstructionSet::detect()) {
                let wavefront = compiled.picture(engines.wavefront, 2);
                let scalar = compiled.picture(engines.scalar, 2);
                let differs = |(a, b): (&f32, &f32)| (a - b).abs() > 1e-3 * (a.abs() + b.abs()).max(1e-2);
                let different = wavefront.iter().zip(&scalar).filter(|&pair| differs(pair)).count();
                let allowed = wavefront.len()
                    / match name.as_str() {
                        "textures" | "hair" => 20,
                        "bodies" => 100,
                        _ => 500,
                    };
                assert!(
                    different <= allowed,
                    "{name}, {}: {different} of {} values differ",
                    engines.name,
                    wavefront.len()
                );
            }
        }
    }
}
