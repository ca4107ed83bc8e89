//! The contract of all integrators.

use std::f64::consts::PI;

use alhazen::image::Image;
use alhazen::{Overrides, integrator_names};
use testkit::{Moments, t_test, welch_test};

use super::scenes::SCENES;
use crate::common::{means, render_text};

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
    for integrator in integrator_names() {
        let one = picture(&text, integrator, 0, 1);
        assert!(one == picture(&text, integrator, 0, 3), "{integrator}: threads changed the picture");
        let is_random = !["radiosity"].contains(&integrator);
        assert!(
            !is_random || one != picture(&text, integrator, 1, 1),
            "{integrator}: the seed changed nothing"
        );
    }
}

/// All surfaces emit and reflect one half: of emission 1 come Σ 2⁻ᵏ over the numbers k of
/// scattering events.
const FURNACE: &str = r#"Option "disablewavelengthjitter" true
    Camera "perspective" "float fov" 90
    Film "rgb" "integer xresolution" 8 "integer yresolution" 8 "bool savefp16" false
    PixelFilter "box" "float xradius" 0.5 "float yradius" 0.5
    Sampler "zsobol" "integer pixelsamples" 16
    WorldBegin
    Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
    AreaLightSource "diffuse" "rgb L" [0.5 0.5 0.5] "bool twosided" true
    Shape "bilinearmesh" "point3 P" [-1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1  -1 -1 1  1 -1 1  -1 1 1  1 1 1]
    "integer indices" [0 1 2 3  4 5 6 7  0 1 4 5  2 3 6 7  0 2 4 6  1 3 5 7]"#;

/// Samples of each pixel.
const PASSES: i32 = 16;

/// The radius of photon lookups; a wall has the side 2.
const RADIUS: f64 = 0.3;

/// The share of their light that photon maps miss: at edges, where the disk around a point reaches
/// beyond the wall. Of a disk that is moved by (x, y) against a square of side 2, (1 − |x|/2)(1 −
/// |y|/2) remain in the mean; Epanechnikov's kernel has the means E|x| = 16r/15π and E|xy| = r²/3π.
fn beyond_kernel() -> f64 {
    16.0 * RADIUS / (15.0 * PI) - RADIUS * RADIUS / (12.0 * PI)
}

/// The same for merging, whose radius shrinks from pass to pass. The even kernel has the means
/// 4r/3π and r²/2π. But photons on the adjoining walls are merged, too: along each of four edges
/// those within r of a wall's points fill a quarter of a ball, of the volume πr³/3 and with the
/// mean 3r/8 of |y|; half of their light comes from the front of the wall.
fn beyond_disks(alpha: f64) -> f64 {
    let mut square = RADIUS * RADIUS;
    let passes = (1..=PASSES).map(|pass| {
        let r = square.sqrt();
        square *= (f64::from(pass) + alpha) / (f64::from(pass) + 1.0);
        4.0 * r / (3.0 * PI) - r * r / (8.0 * PI) - r / 3.0 * (1.0 - 3.0 * r / 16.0)
    });
    passes.sum::<f64>() / f64::from(PASSES)
}

/// An algorithm in the furnace.
struct Member {
    integrator: &'static str,
    settings: &'static [(&'static str, &'static str)],
    /// The least and the most of the light scattered twice or more often that is lost.
    lost: [f64; 2],
}

impl Member {
    const fn exact(integrator: &'static str, settings: &'static [(&'static str, &'static str)]) -> Self {
        Self { integrator, settings, lost: [0.0; 2] }
    }

    /// All integrators of global illumination.
    ///
    /// A final gather looks up photons where its rays end, on the other walls: nowhere more than
    /// 2.5 times as often as on average. Connections lose nothing, so vcm loses less than merging
    /// alone. The rows of form factors sum to one to within a thousandth.
    fn all() -> Vec<Self> {
        let kernel = beyond_kernel();
        const MAP: [(&str, &str); 4] =
            [("radius", "0.3"), ("photons", "1000"), ("causticphotons", "0"), ("nearest", "1000000")];
        const GATHERED: [(&str, &str); 5] = [MAP[0], MAP[1], MAP[2], MAP[3], ("gather", "2")];
        const STARTS: (&str, &str) = ("bootstrapsamples", "10000");
        const MERGED: [(&str, &str); 2] = [("radius", "0.3"), ("photons", "2000")];
        const FLAT: [(&str, &str); 3] = [("patchsize", "1"), ("subdivision", "0"), ("tolerance", "0.0002")];
        const FLAT_GATHERED: [(&str, &str); 4] = [FLAT[0], FLAT[1], FLAT[2], ("gather", "1")];
        vec![
            Self::exact("random-walk", &[]),
            Self::exact("simple-path", &[]),
            Self::exact("path", &[]),
            Self::exact("vol-path", &[]),
            Self::exact("simple-vol-path", &[]),
            Self::exact("light-tracing", &[]),
            Self::exact("bdpt", &[]),
            Self::exact("mlt", &[("technique", "path"), ("mutationsperpixel", "64"), STARTS]),
            Self::exact("mlt", &[("technique", "bdpt"), ("mutationsperpixel", "128"), STARTS]),
            Self { lost: [kernel; 2], ..Self::exact("photon-mapping", &MAP) },
            Self { lost: [0.0, 2.5 * kernel], ..Self::exact("photon-mapping", &GATHERED) },
            Self { lost: [beyond_disks(2.0 / 3.0); 2], ..Self::exact("sppm", &MERGED) },
            Self { lost: [0.0, beyond_disks(0.75)], ..Self::exact("vcm", &MERGED[..1]) },
            Self { lost: [-0.001, 0.001], ..Self::exact("radiosity", &FLAT) },
            Self { lost: [-0.001, 0.001], ..Self::exact("radiosity", &FLAT_GATHERED) },
        ]
    }

    /// The mean of a picture.
    fn mean(&self, max_depth: i32, seed: i32) -> f64 {
        let depth = ("maxdepth".into(), max_depth.to_string());
        let settings = self.settings.iter().map(|&(name, value)| (name.into(), value.into()));
        let settings = settings.chain([depth]).collect();
        let overrides = Overrides {
            integrator: Some(self.integrator.into()),
            settings,
            seed: Some(seed),
            ..Overrides::default()
        };
        means(&render_text(FURNACE, &overrides))[1]
    }
}

#[test]
fn a_closed_furnace_has_every_path_up_to_a_depth_once() {
    let members = Member::all();
    // These have no interreflection.
    let others = ["ray-casting", "whitted", "ambient-occlusion", "function"];
    for integrator in integrator_names() {
        let is_member = members.iter().any(|member| member.integrator == integrator);
        assert!(is_member != others.contains(&integrator), "{integrator}");
    }
    let depths = [1, 2, 5];
    for member in &members {
        let Member { integrator, settings, lost } = member;
        let emission = member.mean(0, 0);
        for max_depth in depths {
            let found: Moments = (0..12).map(|seed| member.mean(max_depth, seed) / emission).collect();
            let scattered_twice = 0.5 - 0.5f64.powi(max_depth);
            let [most, least] = lost.map(|lost| 1.5 + scattered_twice * (1.0 - lost));
            let expected = found.mean.clamp(least, most);
            if (found.mean - expected).abs() > 3e-5 {
                t_test(&found, expected, members.len() * depths.len()).unwrap_or_else(|difference| {
                    panic!("{integrator} {settings:?} to depth {max_depth}: {difference}")
                });
            }
        }
    }
}

/// Small mirrors that reflect a light behind the camera.
const MIRRORS: &str = r#"Camera "perspective" "float fov" 40
    Film "rgb" "integer xresolution" 4 "integer yresolution" 4 "bool savefp16" false
    PixelFilter "mitchell"
    Sampler "independent" "integer pixelsamples" 64
    WorldBegin
    AttributeBegin AreaLightSource "diffuse" Translate 1 1 -3 Shape "sphere" "float radius" 1 AttributeEnd
    Material "conductor" "float roughness" 0
    AttributeBegin Translate -0.4 0.2 3 Shape "sphere" "float radius" 0.7 AttributeEnd
    AttributeBegin Translate 0.6 -0.1 3 Shape "sphere" "float radius" 0.5 AttributeEnd
    Material "diffuse" Translate 0 0 4 Shape "disk""#;

#[test]
fn vcm_finds_glints_at_mirror_edges_with_less_noise() {
    let found = |integrator: &str, first_seed: i32| -> Moments {
        let depth = vec![("maxdepth".into(), "1".into())];
        let mean = |seed| {
            let integrator = Some(integrator.into());
            let overrides =
                Overrides { integrator, settings: depth.clone(), seed: Some(seed), ..Overrides::default() };
            means(&render_text(MIRRORS, &overrides))[1]
        };
        (first_seed..first_seed + 200).map(mean).collect()
    };
    let (path, vcm) = (found("path", 0), found("vcm", 1000));
    welch_test(&vcm, &path, 1).unwrap();
    assert!(vcm.variance_of_mean() < path.variance_of_mean() / 2.0);
}
