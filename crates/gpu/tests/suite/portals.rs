//! Pictures of rooms with portals by both engines.

use std::path::Path;

use alhazen_gpu::Algorithm;
use assets::MemoryAssets;
use description::{LightSamplerDesc, LightTracingDesc, PathDesc};

use crate::pictures::Case;

/// A room with two openings, through which an image and a uniform sky are seen; a mirror sees the
/// image, too.
const ROOM: &str = r#"
LookAt -1.6 1.3 -5  0.4 0.9 0  0 1 0
Camera "perspective" "float fov" 60
Film "rgb"
WorldBegin
LightSource "infinite" "string filename" "sky.pfm" "float scale" 6
    "point3 portal" [ 2 0.8 -1.2  2 0.8 0.8  2 2.2 0.8  2 2.2 -1.2 ]
LightSource "infinite" "rgb L" [ 0.9 1.4 2 ] "point3 portal" [ -2 0.6 -2  -2 1.2 -2  -2 1.2 -4  -2 0.6 -4 ]
Material "diffuse" "rgb reflectance" [ 0.6 0.58 0.55 ]
Shape "bilinearmesh" "point3 P" [ -2 0 -6  2 0 -6  -2 0 2  2 0 2 ]
Shape "bilinearmesh" "point3 P" [ -2 0 2  2 0 2  -2 2.6 2  2 2.6 2 ]
Shape "bilinearmesh" "point3 P" [ 2 0 2  2 0 -6  2 0.8 2  2 0.8 -6 ]
Shape "bilinearmesh" "point3 P" [ 2 2.2 2  2 2.2 -6  2 2.6 2  2 2.6 -6 ]
Shape "bilinearmesh" "point3 P" [ 2 0.8 2  2 0.8 0.8  2 2.2 2  2 2.2 0.8 ]
Shape "bilinearmesh" "point3 P" [ 2 0.8 -1.2  2 0.8 -6  2 2.2 -1.2  2 2.2 -6 ]
Translate -0.6 0.5 0.2
Shape "sphere" "float radius" 0.5
Translate 1.2 0 -0.4
Material "conductor" "float roughness" 0
Shape "sphere" "float radius" 0.5
"#;

#[test]
fn portals_have_the_picture_of_the_cpu() {
    // A square of colours that become brighter and redder.
    const SIDE: usize = 16;
    let numbers =
        (0..3 * SIDE * SIDE).map(|i| ((i * 7 % 23) as f32 / 23.0 + (i % 3) as f32) * (i / 48) as f32 / 16.0);
    let bytes = [b"PF\n16 16\n-1.0\n".to_vec(), numbers.flat_map(f32::to_le_bytes).collect()].concat();
    let name = Path::new("scene.pbrt");
    let case = Case::sized(name, &MemoryAssets::default().with(name, ROOM).with("sky.pfm", bytes), [64, 48]);
    for light_sampler in [LightSamplerDesc::Power, LightSamplerDesc::Bvh] {
        let path = Algorithm::Path(PathDesc { max_depth: 3, light_sampler, regularize: false });
        assert_eq!(case.compare("portals", &path), None);
    }
    let refusals = case.flatten(&Algorithm::LightTracing(LightTracingDesc::default())).err();
    let what = "light paths from infinite lights with portals";
    assert_eq!(refusals.expect("a refusal")[0].what, what);
}
