//! Scenes of the Nori course, converted: direct light in closed form, and means by another
//! renderer.

use std::path::Path;

use crate::common::{Estimate, data, render_text, shape};

/// A right-handed camera; pbrt's is left-handed.
fn head(look_at: &str, fov: f32, size: [u32; 2], integrator: &str, samples: u32) -> String {
    let [width, height] = size;
    format!(
        "Scale -1 1 1 LookAt {look_at}\nCamera \"perspective\" \"float fov\" {fov}\n\
         Film \"rgb\" \"integer xresolution\" {width} \"integer yresolution\" {height}\n\
         PixelFilter \"box\" \"float xradius\" 0.5 \"float yradius\" 0.5\n\
         Sampler \"independent\" \"integer pixelsamples\" {samples}\nIntegrator {integrator}\nWorldBegin\n"
    )
}

/// The field of view of the shorter side of a 4:3 or 3:2 picture from that of the longer one, in
/// degrees.
fn smaller_fov(larger: f32, aspect: f32) -> f32 {
    2.0 * ((larger.to_radians() / 2.0).tan() / aspect).atan().to_degrees()
}

fn diffuse(reflectance: &str, path: &Path) -> String {
    format!("Material \"diffuse\" \"rgb reflectance\" [{reflectance}]\n{}", shape(path))
}

fn emitter(radiance: &str, shape: &str) -> String {
    format!(
        "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [{radiance}]\n\
         Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n{shape}AttributeEnd\n"
    )
}

/// One triangle as the only light over a floor: what a point of the floor reflects is known in
/// closed form. Light sampled by area, by the BSDF, and by both.
#[test]
fn direct_light_of_a_triangle() {
    let Some(folder) = data("nori/pa5/tests") else { return };
    let expected = [0.0898394, 0.02292, 0.0534198, 0.0205314, 0.26174];
    let integrators = [
        r#""simplepath" "bool samplelights" true "bool samplebsdf" false"#,
        r#""simplepath" "bool samplelights" false "bool samplebsdf" true"#,
        r#""path""#,
    ];
    for integrator in integrators {
        for (i, &expected) in expected.iter().enumerate() {
            let text = head("0 0.01 0  0 0 0  0 0 1", 1e-3, [16, 16], integrator, 64)
                + &diffuse("0.5 0.5 0.5", &folder.join("floor.obj"))
                + &emitter("1 1 1", &shape(&folder.join(format!("polylum{}.obj", i + 1))));
            let estimate = Estimate::new(8, |overrides| render_text(&text, &overrides));
            estimate.assert_mean([expected; 3], 1e-5, 15, &format!("{integrator}, triangle {}", i + 1));
        }
    }
}

/// Coloured walls, a mirror and a glass ball of triangles with normals.
#[test]
fn cornell_box_with_mirror_and_glass() {
    let Some(folder) = data("nori/pa5/cbox/meshes") else { return };
    let look_at = "0 0.919769 5.41159  0 0.893051 4.41198  0 1 0";
    let text = head(look_at, smaller_fov(27.7856, 4.0 / 3.0), [64, 48], r#""path" "integer maxdepth" 8"#, 16)
        + &diffuse("0.725 0.71 0.68", &folder.join("walls.obj"))
        + &diffuse("0.161 0.133 0.427", &folder.join("rightwall.obj"))
        + &diffuse("0.63 0.065 0.05", &folder.join("leftwall.obj"))
        + "Material \"conductor\" \"rgb reflectance\" [1 1 1] \"float roughness\" 0\n"
        + &shape(&folder.join("sphere1.obj"))
        + "Material \"dielectric\" \"float eta\" 1.5046\n"
        + &shape(&folder.join("sphere2.obj"))
        + "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5] AreaLightSource \"diffuse\" \"rgb L\" [40 40 40]\n"
        + &shape(&folder.join("light.obj"));
    let estimate = Estimate::new(8, |overrides| render_text(&text, &overrides));
    estimate.assert_mean([0.5421, 0.4283, 0.4598], 1.5e-3, 1, "cornell box");
}

/// Veach's plates, of conductors from nearly smooth to rough, under spheres from tiny to large.
#[test]
fn plates_under_spheres() {
    let Some(folder) = data("nori/pa5/veach_mi/meshes") else { return };
    let look_at = "0 6 27.5  0 -1.5 2.5  0 1 0";
    let mut text = head(look_at, smaller_fov(25.0, 1.5), [96, 64], r#""path" "integer maxdepth" 1"#, 16)
        + &diffuse("0.1 0.1 0.1", &folder.join("floor.obj"));
    for (i, alpha) in [0.005, 0.02, 0.05, 0.1].into_iter().enumerate() {
        text += &format!(
            "Material \"conductor\" \"float roughness\" {alpha} \"bool remaproughness\" false\n\
             \"spectrum eta\" [300 0.2 900 0.2] \"spectrum k\" [300 3.9 900 3.9]\n{}",
            shape(&folder.join(format!("plate{}.obj", i + 1)))
        );
    }
    for (radius, centre, radiance) in [
        (0.1, "-1.25 0 0", "100 100 100"),
        (0.03333, "-3.75 0 0", "901.803 901.803 901.803"),
        (0.3, "1.25 0 0", "11.1111 11.1111 11.1111"),
        (0.9, "3.75 0 0", "1.23457 1.23457 1.23457"),
        (1.0, "0 4 3", "100 100 100"),
    ] {
        text +=
            &emitter(radiance, &format!("Translate {centre} Shape \"sphere\" \"float radius\" {radius}\n"));
    }
    let estimate = Estimate::new(8, |overrides| render_text(&text, &overrides));
    estimate.assert_mean([0.4533; 3], 3e-3, 1, "plates");
}
