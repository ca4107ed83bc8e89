//! What every algorithm promises, whatever it is.

use alhazen::image::Image;
use alhazen::{INTEGRATORS, Overrides};

use crate::common::{Estimate, render_text};
use crate::scenes::SCENES;

fn overrides(integrator: &str, seed: i32) -> Overrides {
    Overrides {
        integrator: Some(integrator.into()),
        samples_per_pixel: Some(2),
        seed: Some(seed),
        ..Overrides::default()
    }
}

fn picture(text: &str, integrator: &str, seed: i32, threads: usize) -> Vec<u32> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let picture: Image = pool.install(|| render_text(text, &overrides(integrator, seed)));
    picture.values().map(f32::to_bits).collect()
}

#[test]
fn threads_never_change_a_bit() {
    let scene = SCENES.iter().find(|scene| scene.name == "a sky and a sun");
    let text = scene.unwrap().text();
    for integrator in INTEGRATORS {
        let one = picture(&text, integrator, 0, 1);
        assert!(one == picture(&text, integrator, 0, 3), "{integrator}: threads changed the picture");
        let is_random = !["radiosity"].contains(&integrator);
        assert!(
            !is_random || one != picture(&text, integrator, 1, 1),
            "{integrator}: the seed changed nothing"
        );
    }
}

/// All surfaces emit one half and reflect one half: L = ½/(1 − ½) = 1.
const FURNACE: &str = r#"Camera "perspective" "float fov" 90
    Film "rgb" "integer xresolution" 16 "integer yresolution" 16 "bool savefp16" false
    PixelFilter "box" "float xradius" 0.5 "float yradius" 0.5
    Sampler "independent" "integer pixelsamples" 1
    WorldBegin
    Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
    AreaLightSource "diffuse" "rgb L" [0.5 0.5 0.5] "bool twosided" true
    Shape "bilinearmesh" "point3 P" [-1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1  -1 -1 1  1 -1 1  -1 1 1  1 1 1]
    "integer indices" [0 1 2 3  4 5 6 7  0 1 4 5  2 3 6 7  0 2 4 6  1 3 5 7]"#;

#[test]
fn a_closed_furnace_shows_emission_over_absorption() {
    // How far kernels may be off where surfaces meet, which they do not know.
    for (integrator, bias) in [("path", 1e-5), ("bdpt", 1e-5), ("light-tracing", 1e-5)] {
        let estimate = Estimate::new(24, |seed| {
            let settings = vec![("maxdepth".into(), "20".into())];
            let overrides = overrides(integrator, seed.seed.unwrap_or(0));
            render_text(FURNACE, &Overrides { settings, samples_per_pixel: Some(16), ..overrides })
        });
        estimate.assert_mean([1.0; 3], bias, 3, integrator);
    }
}
