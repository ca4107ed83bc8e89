//! Pictures of bodies under whose surface light is scattered, behind lenses, and on spectral films,
//! by both engines.

use std::path::Path;

use alhazen_gpu::Algorithm;
use assets::MemoryAssets;
use description::{LightTracingDesc, PathDesc, SimplePathDesc};
use film::Development;
use image::PixelSource;

use crate::pictures::{Case, SAMPLES};

/// Bodies by diffusion and by random walks, given by coefficients, by a substance and by what
/// leaves, behind smooth, rough and brushed boundaries; before a curved wall that probes meet, too.
const BODIES: &str = r#"
LookAt 0 -6 2.2  0 0 0.5  0 0 1
Camera "perspective" "float fov" 36
Film "rgb"
WorldBegin
LightSource "infinite" "rgb L" [ 0.5 0.6 0.8 ]
LightSource "point" "point3 from" [ 2 -4 4 ] "float scale" 90
Texture "squares" "spectrum" "checkerboard" "float uscale" 8 "float vscale" 8
    "rgb tex1" [ 0.7 0.6 0.5 ] "rgb tex2" [ 0.2 0.3 0.4 ]
Texture "metal" "float" "checkerboard" "float uscale" 8 "float vscale" 8 "float tex1" 1 "float tex2" 0
Material "diffuse" "texture reflectance" "squares"
Shape "bilinearmesh" "point3 P" [ -4 -4 0  4 -4 0  -4 4 0  4 4 0 ]
Translate -1.6 0 0.5
Material "subsurface" "rgb sigma_a" [ 0.4 0.1 1.6 ] "rgb sigma_s" [ 6 9 7 ]
Shape "sphere" "float radius" 0.5
Translate 1.1 0 0
Material "subsurface" "string name" "Ketchup" "float scale" 20 "float roughness" 0.4 "float eta" 2.1 "float g" 0.3
Shape "sphere" "float radius" 0.5
Translate 1.1 0 0
Material "subsurface" "texture reflectance" "squares" "rgb mfp" [ 0.3 0.1 0.05 ] "float eta" 1.4
Shape "cylinder" "float radius" 0.4 "float zmin" -0.5 "float zmax" 0.4
Translate 1.1 0 0
Material "subsurface" "string method" "random-walk" "rgb sigma_a" [ 1 2 5 ] "rgb sigma_s" [ 6 9 7 ] "float g" -0.4
Shape "sphere" "float radius" 0.5
Translate -2 -1.1 0
Material "subsurface" "string method" "random-walk" "rgb reflectance" [ 0.7 0.4 0.3 ] "rgb mfp" [ 0.1 0.1 0.1 ]
    "float roughness" 0.3
Shape "sphere" "float radius" 0.4
Translate 0.9 -0.1 -0.1
Material "subsurface" "string method" "random-walk" "rgb reflectance" [ 0.4 0.7 0.3 ] "rgb mfp" [ 0.1 0.1 0.1 ]
    "float uroughness" 0.4 "float vroughness" 0.05
Shape "sphere" "float radius" 0.3
"#;

/// Principled bodies beside them, of which one has a coat and metal beside it.
const PRINCIPLED_BODIES: &str = r#"
Translate 0.8 0 0
Material "openpbr" "float subsurface_weight" 1 "rgb subsurface_color" [ 0.8 0.5 0.3 ] "float subsurface_radius" 0.2
Shape "sphere" "float radius" 0.3
Translate -2.6 0 0
Material "openpbr" "float subsurface_weight" 0.7 "rgb subsurface_color" [ 0.3 0.8 0.4 ] "float subsurface_radius" 0.1
    "rgb subsurface_radius_scale" [ 1 0.3 0.1 ] "float subsurface_scatter_anisotropy" 0.4 "float coat_weight" 0.8
    "rgb coat_color" [ 0.9 0.5 0.4 ] "texture base_metalness" "metal"
Shape "sphere" "float radius" 0.3
"#;

/// A photograph through four elements and a square stop, out of focus, of squares that are filtered
/// over pixels.
const LENS: &str = "46 5.5 1.62 26\n-210 1.5 1 26\n30 3.2 1.7 20\n22.5 7 1 17\n0 6 0 13\n-24 1.8 1.72 16\n\
    140 5 1.6 19\n-27.5 0.8 1 21\n110 4.5 1.63 24\n-64 40 1 24\n";
const PHOTOGRAPH: &str = r#"
LookAt 0 -6 1.6  0 0 0.5  0 0 1
Camera "realistic" "string lensfile" "lens.dat" "float aperturediameter" 9 "float focusdistance" 2 "string aperture" "STOP"
Film "rgb" "float diagonal" 24
WorldBegin
LightSource "infinite" "rgb L" [ 0.5 0.6 0.8 ]
LightSource "point" "point3 from" [ 2 -4 4 ] "float scale" 90
Texture "squares" "spectrum" "checkerboard" "float uscale" 4 "float vscale" 4
    "rgb tex1" [ 0.7 0.6 0.5 ] "rgb tex2" [ 0.2 0.3 0.4 ]
Material "diffuse" "texture reflectance" "squares"
Shape "bilinearmesh" "point3 P" [ -4 -4 0  4 -4 0  -4 4 0  4 4 0 ]
Translate 0 0 0.6
Shape "sphere" "float radius" 0.6
"#;

#[test]
fn bodies_have_the_picture_of_the_cpu() {
    let case = Case::of_text(&(BODIES.to_owned() + PRINCIPLED_BODIES));
    let path = Algorithm::Path(PathDesc { max_depth: 2, ..PathDesc::default() });
    assert_eq!(case.compare("bodies", &path), None);
    let refusals = case.flatten(&Algorithm::LightTracing(LightTracingDesc::default())).err();
    let refusals = refusals.expect("refusals").into_iter().map(|refusal| refusal.what);
    let under = |material| format!("light paths under the surface of `{material}`");
    assert_eq!(refusals.collect::<Vec<_>>(), ["subsurface", "openpbr"].map(under));
}

/// Paths that fly through fog to bodies, and leave them into it.
#[test]
fn bodies_in_fog_have_the_picture_of_the_cpu() {
    let fog = r#"
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ 0.02 0.03 0.05 ] "rgb sigma_s" [ 0.06 0.05 0.04 ]
MediumInterface "" "fog"
"#;
    let inside = "WorldBegin\nMediumInterface \"fog\" \"fog\"";
    let case = Case::of_text(&(fog.to_owned() + &BODIES.replace("WorldBegin", inside)));
    let path = Algorithm::VolPath(PathDesc { max_depth: 2, ..PathDesc::default() });
    assert_eq!(case.compare("bodies in fog", &path), None);
}

/// Algorithms that do not follow paths under surfaces take light to leave where it has entered.
#[test]
fn bodies_of_algorithms_without_paths_under_surfaces_have_the_picture_of_the_cpu() {
    let simple = Algorithm::SimplePath(SimplePathDesc { max_depth: 3, ..Default::default() });
    assert_eq!(Case::of_text(BODIES).compare("opaque bodies", &simple), None);
}

#[test]
fn lenses_have_the_picture_of_the_cpu() {
    for stop in ["circular", "square"] {
        let name = Path::new("scene.pbrt");
        let assets =
            MemoryAssets::default().with(name, PHOTOGRAPH.replace("STOP", stop)).with("lens.dat", LENS);
        let case = Case::sized(name, &assets, [64, 48]);
        assert_eq!(case.compare(stop, &Algorithm::RayCasting), None);
        let refusals = case.flatten(&Algorithm::LightTracing(LightTracingDesc::default())).err();
        assert_eq!(refusals.expect("a refusal")[0].what, "light paths to camera `realistic`");
    }
}

/// All values of a picture.
fn values(picture: &Development) -> Vec<f32> {
    let mut row = vec![0.0; picture.width() as usize * picture.channels().len()];
    let rows = (0..picture.height()).flat_map(|y| {
        picture.row(y, &mut row);
        row.clone()
    });
    rows.collect()
}

/// The buckets of a film whose range is smaller than that of all wavelengths.
#[test]
fn spectral_films_have_the_picture_of_the_cpu() {
    let text = r#"
LookAt 0 -6 1.6  0 0 0.5  0 0 1
Camera "perspective" "float fov" 40
Film "spectral" "integer nbuckets" 8 "float lambdamin" 400 "float lambdamax" 720
WorldBegin
LightSource "infinite" "rgb L" [ 0.5 0.6 0.8 ]
LightSource "point" "point3 from" [ 2 -4 4 ] "float scale" 90
Material "diffuse" "rgb reflectance" [ 0.7 0.5 0.2 ]
Shape "bilinearmesh" "point3 P" [ -4 -4 0  4 -4 0  -4 4 0  4 4 0 ]
Translate 0 0 0.6
Shape "sphere" "float radius" 0.6
"#;
    let mut case = Case::of_text(text);
    let path = Algorithm::Path(PathDesc { max_depth: 3, ..PathDesc::default() });
    for algorithm in [path, Algorithm::LightTracing(LightTracingDesc { max_depth: 3 })] {
        if algorithm.splats() {
            case.take_sobol();
        }
        let Some(renderer) = case.renderer(&algorithm) else { return };
        let (gpu, session) = (case.exposed(&renderer), case.session(&algorithm, SAMPLES));
        let [gpu, cpu] = [gpu.development(), session.state().development()].map(|it| values(&it));
        assert!(cpu.len() == gpu.len() && cpu.len() >= 64 * 48 * 11);
        let mean = cpu.iter().copied().map(f64::from).sum::<f64>() / cpu.len() as f64;
        let is_apart =
            |(a, b): &(&f32, &f32)| f64::from(*a - *b).abs() > 1e-3 * f64::from(b.abs()).max(0.1 * mean);
        let share = gpu.iter().zip(&cpu).filter(is_apart).count() as f64 / cpu.len() as f64;
        println!("mean {mean:.4}, {share:.1e} apart");
        assert!(mean > 0.0 && share <= 0.005, "{algorithm:?}: {share}");
    }
}
