//! Backs of single-sided surfaces, which the camera does not see, by both engines.

use alhazen_gpu::Algorithm;
use description::{BdptDesc, LightTracingDesc, PathDesc, Schedule, SimplePathDesc, SppmDesc, WhittedDesc};
use spectrum::RgbColorSpace;

use crate::pictures::Case;

/// A camera in a tube, before a wall that both turn their backs to it, and beside shapes and
/// mirrored instances with normals of which it sees one side; light is on both sides of the wall.
const BACKS: &str = r#"
LookAt 0 -4 3  0 0 0.3  0 0 1
Camera "perspective" "float fov" 45
Film "rgb"
WorldBegin
Material "diffuse" "rgb reflectance" [ 0.6 0.6 0.5 ]
Shape "bilinearmesh" "point3 P" [ -3 -3 0  3 -3 0  -3 3 0  3 3 0 ]
Shape "trianglemesh" "point3 P" [ -1.6 -1.2 0  -1.6 -1.2 1.8  1.6 -1.2 1.8  1.6 -1.2 0 ]
    "integer indices" [ 0 1 2  0 2 3 ] "bool singlesided" true
AttributeBegin
    Translate 0 -4 3
    Rotate 60 1 0 0
    Shape "cylinder" "float radius" 0.7 "float zmin" -1 "float zmax" 1.2 "bool singlesided" true
AttributeEnd
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 9 8 8 ]
    Shape "bilinearmesh" "point3 P" [ 0.4 0.3 2.5  0.4 0.9 2.5  1.2 0.3 2.5  1.2 0.9 2.5 ]
    AreaLightSource "diffuse" "rgb L" [ 3 5 8 ]
    Shape "trianglemesh" "point3 P" [ -0.8 -2 0.7  -0.4 -2 0.7  -0.6 -2.2 1.1 ] "integer indices" [ 0 1 2 ]
    AreaLightSource "diffuse" "rgb L" [ 6 2 1 ] "bool twosided" true
    Shape "bilinearmesh" "point3 P" [ 0.3 0.4 0.1  0.3 0.4 0.7  0.9 0.4 0.1  0.9 0.4 0.7 ] "bool singlesided" true
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.2 0.5 0.7 ]
ObjectBegin "roof"
    Shape "trianglemesh" "point3 P" [ 0.3 0 1  1.3 0 1  1.3 0.8 1.2 ] "integer indices" [ 0 1 2 ]
        "normal N" [ 0 0 -1  0 0.1 -1  0 0 -1 ] "bool singlesided" true
    Shape "trianglemesh" "point3 P" [ 0.3 -0.7 0.5  1.3 -0.7 0.5  1.3 -0.2 0.7 ] "integer indices" [ 0 2 1 ]
        "normal N" [ 0 0 1  0 0.1 1  0 0 1 ] "bool singlesided" true
ObjectEnd
AttributeBegin
    Scale -1 1 1
    ObjectInstance "roof"
AttributeEnd
Translate -0.3 0.9 0.5
Shape "sphere" "float radius" 0.5 "bool singlesided" true
ReverseOrientation
Translate 0.9 0.4 0
Shape "sphere" "float radius" 0.4 "bool singlesided" true
"#;

fn path() -> Algorithm {
    Algorithm::Path(PathDesc { max_depth: 3, ..PathDesc::default() })
}

#[test]
fn backs_have_the_picture_of_the_cpu() {
    let case = Case::of_text(BACKS);
    for algorithm in [
        path(),
        Algorithm::VolPath(PathDesc { max_depth: 3, ..PathDesc::default() }),
        Algorithm::RayCasting,
        Algorithm::Whitted(WhittedDesc::default()),
        Algorithm::AmbientOcclusion(Default::default(), RgbColorSpace::srgb()),
        Algorithm::SimplePath(SimplePathDesc { max_depth: 2, ..Default::default() }),
    ] {
        assert_eq!(case.compare("backs", &algorithm), None, "{algorithm:?}");
    }
}

#[test]
fn light_paths_among_backs_have_the_picture_of_the_cpu() {
    let mut case = Case::of_text(BACKS);
    let sppm = SppmDesc { max_depth: 3, radius: Some(0.05), ..Default::default() };
    assert_eq!(case.compare("backs", &Algorithm::Sppm(sppm, 7)), None);
    let bdpt = BdptDesc { max_depth: 3, ..Default::default() };
    assert_eq!(case.compare("backs", &Algorithm::Bdpt(bdpt)), None);
    case.take_sobol();
    let light_tracing = LightTracingDesc { max_depth: 3 };
    assert_eq!(case.compare("backs", &Algorithm::LightTracing(light_tracing)), None);
}

#[test]
fn stages_and_ray_queries_meet_backs_as_the_cpu_does() {
    let case = Case::of_text(BACKS);
    for (schedule, ray_queries) in
        [(Schedule::Wavefront, false), (Schedule::Megakernel, true), (Schedule::Wavefront, true)]
    {
        let flat = case.flattened(&path(), ray_queries);
        assert!(flat.as_ref().is_ok_and(|flat| flat.parts().ray_queries == ray_queries));
        let Some(renderer) = case.rendering(&flat, &path(), schedule) else { continue };
        assert_eq!(case.differs("backs", &path(), &case.drawn(&renderer)), None, "{schedule:?}");
    }
}
