//! Pictures of participating media by both engines.

use std::sync::Arc;

use alhazen_gpu::Algorithm;
use description::{
    MediumKind, PathDesc, RandomWalkDesc, SimplePathDesc, SimpleVolPathDesc, TemperatureDesc, VoxelsDesc,
};
use image::Image;
use sampling::Sampler;
use sampling::sampler::Independent;

use crate::direct_light::{apart, means, moments};
use crate::frames::colors;
use crate::pictures::{Case, SAMPLES};

/// A camera in fog that glows, a lamp that an interface surrounds, and glass with a liquid in a
/// liquid: media that need no random numbers but the sampler's.
const FOG: &str = r#"
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ 0.02 0.03 0.05 ] "rgb sigma_s" [ 0.1 0.08 0.05 ]
    "float g" 0.4 "rgb Le" [ 0.1 0.05 0.2 ]
MakeNamedMedium "wine" "string type" "homogeneous" "rgb sigma_a" [ 0.2 1.5 2 ] "rgb sigma_s" [ 0.6 0.1 0.1 ]
MakeNamedMedium "milk" "string type" "homogeneous" "rgb sigma_a" [ 0 0 0 ] "rgb sigma_s" [ 2 2 1.5 ] "float g" -0.3
MediumInterface "" "fog"
LookAt 0 -6 2  0 0 0.6  0 0 1
Camera "perspective" "float fov" 42
Film "rgb"
WorldBegin
MediumInterface "fog" "fog"
LightSource "point" "point3 from" [ 2 -1 3 ] "rgb I" [ 20 18 16 ]
LightSource "infinite" "rgb L" [ 0.3 0.4 0.5 ]
Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.4 ]
Shape "bilinearmesh" "point3 P" [ -5 -5 0  5 -5 0  -5 5 0  5 5 0 ]
AttributeBegin
    Translate -1.5 0 2
    AttributeBegin
        AreaLightSource "diffuse" "rgb L" [ 12 8 4 ]
        MediumInterface "milk" "milk"
        Shape "sphere" "float radius" 0.2
    AttributeEnd
    Material "interface"
    MediumInterface "milk" "fog"
    Shape "sphere" "float radius" 0.7
AttributeEnd
AttributeBegin
    MediumInterface "wine" "fog"
    Material "dielectric"
    Translate 0.6 -0.5 0.8
    Shape "sphere" "float radius" 0.8
    MediumInterface "milk" "wine"
    Material "dielectric" "float eta" 1.2 "float roughness" 0.2
    Shape "cylinder" "float radius" 0.3 "float zmin" -0.4 "float zmax" 0.4
AttributeEnd
"#;

/// A fire of temperatures on a grid, colours, a cloud and sparse voxels, in front of each other in
/// pairs, and a lamp behind an interface.
const VARIED: &str = r#"
LookAt 0 -8 1.6  0 0 1.2  0 0 1
Camera "perspective" "float fov" 34
Film "rgb"
WorldBegin
LightSource "infinite" "rgb L" [ 0.3 0.4 0.5 ]
LightSource "distant" "point3 from" [ 1 -1 2 ] "rgb L" [ 1 0.9 0.8 ]
Material "diffuse" "rgb reflectance" [ 0.4 0.4 0.3 ]
Shape "bilinearmesh" "point3 P" [ -5 -5 0  5 -5 0  -5 5 0  5 5 0 ]
Material "interface"
AttributeBegin
    Translate -1.2 0 0.8
    MakeNamedMedium "fire" "string type" "uniformgrid" "integer nx" 2 "integer ny" 1 "integer nz" 3
        "float density" [ 1 2  3 0.5  0.3 2 ] "float temperature" [ 1500 2500  3000 1900  50 1700 ]
        "point3 p0" [ -1 -1 -1 ] "point3 p1" [ 1 1 1 ] "rgb sigma_a" [ 1 1 1 ] "rgb sigma_s" [ 1 0.5 0.2 ] "float Lescale" 0.7
    MediumInterface "fire" ""
    Shape "sphere" "float radius" 0.7
AttributeEnd
AttributeBegin
    Translate 1.2 0 0.8
    Rotate 30 0 0 1
    MakeNamedMedium "colours" "string type" "rgbgrid" "integer nx" 2 "integer ny" 2 "integer nz" 1
        "rgb sigma_s" [ 2 1 0.2  0.3 2 1  1 1 1  0 0.5 2 ] "rgb sigma_a" [ 0.1 0.2 1  0.2 0 0.1  0.5 0.5 0.5  0 0 0 ]
        "rgb Le" [ 1 0 0  0 1 0  0 0 1  1 1 1 ] "float scale" 1.5
        "point3 p0" [ -0.7 -0.7 -0.7 ] "point3 p1" [ 0.7 0.7 0.7 ] "float g" 0.3
    MediumInterface "colours" ""
    Shape "sphere" "float radius" 0.8
AttributeEnd
AttributeBegin
    Translate -0.8 1.8 1.4
    Scale 2 1.5 1.5
    MakeNamedMedium "cloud" "string type" "cloud" "rgb sigma_s" [ 4 4 4 ] "rgb sigma_a" [ 0 0 0 ] "float density" 3
        "float frequency" 2.5
    MediumInterface "cloud" ""
    Translate 0.5 0.5 0.5
    Shape "sphere" "float radius" 0.5
AttributeEnd
AttributeBegin
    Translate 0.6 -2 0.4
    MakeNamedMedium "voxels" "string type" "homogeneous"
    MediumInterface "voxels" ""
    Translate 0.4 0.5 0.4
    Shape "sphere" "float radius" 1
AttributeEnd
"#;

/// Two bricks side by side, of which the second is the background but for some voxels.
fn voxels() -> VoxelsDesc {
    let mut values = vec![0.0; 3 * 512];
    for (i, value) in values[512..1024].iter_mut().enumerate() {
        *value = (i * 7 % 5) as f32 / 4.0;
    }
    for x in 2..6 {
        values[1024 + 3 * 64 + 2 * 8 + x] = 4.0;
    }
    VoxelsDesc {
        origin: [-8, 0, 8],
        bricks: [2, 1, 1],
        table: Arc::from([1, 2]),
        values: values.into(),
        active: [[-8, 0, 8], [7, 7, 15]],
        world_from_index: [[0.06, 0.0, 0.0, 0.4], [0.0, 0.1, 0.0, 0.0], [0.0, 0.0, 0.1, -0.7]],
    }
}

const SIZE: [i32; 2] = [32, 24];

/// The case of [`VARIED`], which has no file for its voxels.
fn varied() -> Case {
    let mut case = Case::of_text(VARIED);
    let mut desc = case.desc.clone();
    desc.film.resolution = SIZE;
    for (_, medium) in desc.media.iter_mut() {
        if let MediumKind::Homogeneous { coefficients, .. } = &medium.value.kind {
            medium.value.kind = MediumKind::NanoVdb {
                density: voxels(),
                temperature: None,
                coefficients: coefficients.clone(),
                temperature_scale: TemperatureDesc::default(),
                le_scale: 1.0,
            };
        }
    }
    case.scene = Arc::new(scene::compile(desc.clone()).expect("a scene").scene);
    case.view = scene::View::compile(&desc, case.scene.world_from_render()).expect("a view").view;
    case.desc = desc;
    case
}

fn settings(max_depth: u32) -> Algorithm {
    Algorithm::VolPath(PathDesc { max_depth, ..PathDesc::default() })
}

#[test]
fn homogeneous_media_have_the_picture_of_the_cpu() {
    let case = Case::of_text(FOG);
    assert_eq!(case.compare("fog", &settings(5)), None);
    let simple = Algorithm::SimpleVolPath(SimpleVolPathDesc { max_depth: 5 });
    assert_eq!(case.compare("fog without light sampling", &simple), None);
}

/// Paths that do not know media pass interfaces, which occlude lights for some.
#[test]
fn paths_without_media_have_the_picture_of_the_cpu() {
    let case = Case::of_text(FOG);
    let path = Algorithm::Path(PathDesc { max_depth: 3, ..PathDesc::default() });
    assert_eq!(case.compare("path", &path), None);
    for (sample_lights, sample_bsdf) in [(true, true), (true, false), (false, true), (false, false)] {
        let desc = SimplePathDesc { max_depth: 3, sample_lights, sample_bsdf };
        assert_eq!(case.compare("simple path", &Algorithm::SimplePath(desc)), None);
    }
    let walk = Algorithm::RandomWalk(RandomWalkDesc { max_depth: 2 });
    assert_eq!(case.compare("random walk", &walk), None);
}

/// Collisions with media that vary follow from hashes that are other ones on both sides.
#[test]
fn media_that_vary_have_the_mean_of_the_cpu() {
    let mut case = varied();
    let algorithm = settings(4);
    if case.renderer(&algorithm).is_none() {
        return;
    }
    let mut pictures = |draw: &dyn Fn(&Case) -> Image| {
        moments((0..24).map(|seed| {
            case.sampler = Sampler::Independent(Independent::new(SAMPLES, 100 + seed));
            means(&colors(&draw(&case)), SIZE[0] as usize)
        }))
    };
    let gpu = pictures(&|case| case.on_gpu(&algorithm).expect("a picture"));
    let cpu = pictures(&|case| case.on_cpu(&algorithm, SAMPLES));
    let wrong = apart(&gpu, &cpu);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Others than paths from the camera do not pass interfaces.
#[test]
fn media_are_left_to_the_cpu_by_other_algorithms() {
    let refusals = Case::of_text(FOG).flatten(&Algorithm::RayCasting).err().unwrap_or_default();
    assert!(
        refusals.iter().any(|refusal| refusal.what == "participating media or interfaces"),
        "{refusals:?}"
    );
}
