//! The irradiance of a floor by lights that several techniques find, by each algorithm, beside an
//! integral over the hemisphere.

use std::f64::consts::{PI, TAU};

use alhazen::Overrides;
use alhazen::image::{Image, WriteOptions};

use crate::common::{Estimate, render_text};

/// The reflectance of the floor.
const RHO: f64 = 0.5;

/// Directions per axis that the hemisphere is integrated over.
const STRATA: u32 = 500;

type Vector = [f64; 3];

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The mean of a function of the direction over the hemisphere around +y, weighted by the cosine:
/// irradiance over π.
fn mean_over_hemisphere<const N: usize>(radiance: impl Fn(Vector) -> [f64; N]) -> [f64; N] {
    let mut sum = [0.0; N];
    for i in 0..STRATA * STRATA {
        let [u, v] = [i % STRATA, i / STRATA].map(|k| (f64::from(k) + 0.5) / f64::from(STRATA));
        let (r, phi) = (u.sqrt(), TAU * v);
        let l = radiance([r * phi.cos(), (1.0 - u).sqrt(), r * phi.sin()]);
        (0..N).for_each(|k| sum[k] += l[k] / f64::from(STRATA * STRATA));
    }
    sum
}

/// A view from above of a part of a floor of reflectance ρ at y = 0, by direct light alone.
fn over_a_floor(window: [f64; 4], samples: u32, lights: &str) -> String {
    let [x0, x1, y0, y1] = window;
    format!(
        "LookAt 0 8 0  0 0 0  0 0 1\n\
         Camera \"orthographic\" \"float screenwindow\" [{x0} {x1} {y0} {y1}]\n\
         Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4 \"bool savefp16\" false\n\
         PixelFilter \"box\" Sampler \"independent\" \"integer pixelsamples\" {samples}\n\
         Integrator \"path\" \"integer maxdepth\" 1\nWorldBegin\n\
         AttributeBegin {lights} AttributeEnd\n\
         Material \"diffuse\" \"rgb reflectance\" [{RHO} {RHO} {RHO}]\n\
         Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3]\n\
         \"point3 P\" [-3 0 -3  -3 0 3  3 0 3  3 0 -3]\n"
    )
}

/// Asserts the mean of the floor's radiance by each of the algorithms.
fn assert_radiance(text: &str, expected: [f64; 3], algorithms: &[(&str, &[(&str, &str)])], name: &str) {
    for (integrator, settings) in algorithms {
        let pictures = Estimate::new(4, |overrides| {
            let settings = settings.iter().map(|&(name, value)| (name.into(), value.into())).collect();
            render_text(text, &Overrides { integrator: Some((*integrator).into()), settings, ..overrides })
        });
        pictures.assert_mean(expected, 1e-3, algorithms.len(), &format!("{name}, {integrator} {settings:?}"));
    }
}

/// The part of the surface x² + y² + c·z² + d·z + e = 0 with z in a range, in a space with these
/// axes and this origin.
struct Quadric {
    coefficients: [f64; 3],
    z: [f64; 2],
    origin: Vector,
    axes: [Vector; 3],
}

/// Axes of which z points up.
const UPRIGHT: [Vector; 3] = [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]];

impl Quadric {
    /// Where the ray from `o` along `d` crosses it, and whether from outside.
    fn crossings(&self, o: Vector, d: Vector) -> Vec<(f64, bool)> {
        let [c, linear, e] = self.coefficients;
        let o = [0, 1, 2].map(|k| o[k] - self.origin[k]);
        let inward = |v| self.axes.map(|axis| dot(v, axis) / dot(axis, axis));
        let (o, d) = (inward(o), inward(d));
        let a = d[0] * d[0] + d[1] * d[1] + c * d[2] * d[2];
        let b = o[0] * d[0] + o[1] * d[1] + c * o[2] * d[2] + 0.5 * linear * d[2];
        let k = o[0] * o[0] + o[1] * o[1] + c * o[2] * o[2] + linear * o[2] + e;
        let root = (b * b - a * k).sqrt();
        let met = [(-b - root) / a, (-b + root) / a].into_iter().filter_map(|t| {
            let p = [0, 1, 2].map(|k| o[k] + t * d[k]);
            let gradient = [p[0], p[1], c * p[2] + 0.5 * linear];
            let is_met = t > 0.0 && (self.z[0]..=self.z[1]).contains(&p[2]);
            is_met.then(|| (t, dot(gradient, d) < 0.0))
        });
        met.collect()
    }

    fn sphere(radius: f64, z: [f64; 2], origin: Vector, axes: [Vector; 3]) -> Self {
        Self { coefficients: [1.0, 0.0, -radius * radius], z, origin, axes }
    }
}

/// A round light whose surface is there with a probability, above the floor's centre.
struct RoundLight {
    name: &'static str,
    text: &'static str,
    surfaces: Vec<Quadric>,
    alpha: f64,
    /// Whether it emits to the outside, and to the inside.
    emits: [bool; 2],
}

impl RoundLight {
    /// The radiance of the floor at `x`.
    fn radiance(&self, x: f64) -> f64 {
        let [l] = mean_over_hemisphere(|d| {
            let mut crossings: Vec<_> =
                self.surfaces.iter().flat_map(|surface| surface.crossings([x, 0.0, 0.0], d)).collect();
            crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
            let (mut l, mut left) = (0.0, 4.0);
            for (_, is_outside) in crossings {
                l += if self.emits[usize::from(!is_outside)] { left * self.alpha } else { 0.0 };
                left *= 1.0 - self.alpha;
            }
            [l]
        });
        RHO * l
    }

    fn all() -> Vec<Self> {
        const WHOLE: [f64; 2] = [-9.0, 9.0];
        let both = [true; 2];
        let high = [0.0, 1.7, 0.0];
        let stretched = [[1.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 0.6]];
        vec![
            Self {
                name: "a sphere",
                text: "Shape \"sphere\" \"float radius\" .8 \"float alpha\" .5",
                surfaces: vec![Quadric::sphere(0.8, WHOLE, high, UPRIGHT)],
                alpha: 0.5,
                emits: both,
            },
            Self {
                name: "a sphere that emits inwards",
                text: "ReverseOrientation Shape \"sphere\" \"float radius\" .8 \"float alpha\" .5",
                surfaces: vec![Quadric::sphere(0.8, WHOLE, high, UPRIGHT)],
                alpha: 0.5,
                emits: [false, true],
            },
            Self {
                name: "a sphere that emits outwards",
                text: "Shape \"sphere\" \"float radius\" .8 \"float alpha\" .7",
                surfaces: vec![Quadric::sphere(0.8, WHOLE, high, UPRIGHT)],
                alpha: 0.7,
                emits: [true, false],
            },
            Self {
                name: "a part of a sphere",
                text: "Shape \"sphere\" \"float radius\" .8 \"float zmin\" -.6 \"float zmax\" .3 \"float alpha\" .4",
                surfaces: vec![Quadric::sphere(0.8, [-0.6, 0.3], high, UPRIGHT)],
                alpha: 0.4,
                emits: both,
            },
            Self {
                name: "a stretched sphere in an object",
                text: "ObjectBegin \"o\" Identity Shape \"sphere\" \"float radius\" .8 \"float alpha\" .5 ObjectEnd\n\
                    Scale 1.5 .5 .6 ObjectInstance \"o\"",
                surfaces: vec![Quadric::sphere(0.8, WHOLE, high, stretched)],
                alpha: 0.5,
                emits: both,
            },
            Self {
                name: "a set of spheres",
                text: "Shape \"spheres\" \"point3 P\" [.5 0 0  -.5 0 0] \"float radius\" .4 \"float alpha\" .5",
                surfaces: [0.5, -0.5].map(|x| Quadric::sphere(0.4, WHOLE, [x, 1.7, 0.0], UPRIGHT)).into(),
                alpha: 0.5,
                emits: both,
            },
            Self {
                name: "a cylinder",
                text: "Shape \"cylinder\" \"float radius\" .6 \"float zmin\" -.7 \"float zmax\" .5 \"float alpha\" .5",
                surfaces: vec![Quadric {
                    coefficients: [0.0, 0.0, -0.36],
                    z: [-0.7, 0.5],
                    origin: high,
                    axes: UPRIGHT,
                }],
                alpha: 0.5,
                emits: both,
            },
            Self {
                name: "a cone",
                text: "Shape \"cone\" \"float radius\" .6 \"float height\" 1.2 \"float alpha\" .5",
                surfaces: vec![Quadric {
                    coefficients: [-0.25, 0.6, -0.36],
                    z: [0.0, 1.2],
                    origin: high,
                    axes: UPRIGHT,
                }],
                alpha: 0.5,
                emits: both,
            },
            Self {
                name: "a paraboloid",
                text: "Shape \"paraboloid\" \"float radius\" .6 \"float zmax\" .9 \"float alpha\" .5",
                surfaces: vec![Quadric {
                    coefficients: [0.0, -0.4, 0.0],
                    z: [0.0, 0.9],
                    origin: high,
                    axes: UPRIGHT,
                }],
                alpha: 0.5,
                emits: both,
            },
            Self {
                name: "a hyperboloid",
                text: "Shape \"hyperboloid\" \"point3 p1\" [.5 0 -.6] \"point3 p2\" [.3 .4 .6] \"float alpha\" .5",
                surfaces: vec![Quadric {
                    coefficients: [-0.05 / 0.36, 0.0, -0.2],
                    z: [-0.6, 0.6],
                    origin: high,
                    axes: UPRIGHT,
                }],
                alpha: 0.5,
                emits: both,
            },
        ]
    }
}

const NEXT_EVENT_ALONE: &[(&str, &str)] = &[("samplebsdf", "false")];
const BSDF_ALONE: &[(&str, &str)] = &[("samplelights", "false")];
const SMALL_RADIUS: &[(&str, &str)] = &[("radius", "0.03")];

#[test]
fn round_lights_with_holes_give_the_irradiance_of_all_crossings() {
    let algorithms = [
        ("path", &[][..]),
        ("vol-path", &[]),
        ("simple-path", NEXT_EVENT_ALONE),
        ("simple-path", BSDF_ALONE),
        ("bdpt", &[]),
        ("vcm", SMALL_RADIUS),
        ("sppm", &[]),
    ];
    for light in RoundLight::all() {
        let turn =
            if light.name.contains("object") || light.name.contains("set") { "" } else { "Rotate -90 1 0 0" };
        let sides = if light.emits == [true; 2] { "true" } else { "false" };
        let lamp = format!(
            "Translate 0 1.7 0 {turn} AreaLightSource \"diffuse\" \"rgb L\" [4 4 4] \"bool twosided\" {sides}\n{}",
            light.text
        );
        let expected = [1.25, 1.35, 1.45, 1.55].map(|x| light.radiance(x)).iter().sum::<f64>() / 4.0;
        let text = over_a_floor([1.2, 1.6, -0.2, 0.2], 512, &lamp);
        assert_radiance(&text, [expected; 3], &algorithms, light.name);
    }
}

/// A smooth picture of the sphere, by latitude and longitude: the radiance of a direction.
fn sky([x, y, z]: Vector) -> Vector {
    [1.0 + 0.9 * x, 1.0 + 0.8 * y * z, (0.3 + 0.7 * z).powi(2)]
}

/// Rows of a matrix times a vector.
fn times(m: [Vector; 3], v: Vector) -> Vector {
    m.map(|row| dot(row, v))
}

fn product(a: [Vector; 3], b: [Vector; 3]) -> [Vector; 3] {
    a.map(|row| [0, 1, 2].map(|k| (0..3).map(|i| row[i] * b[i][k]).sum()))
}

fn inverse([x, y, z]: [Vector; 3]) -> [Vector; 3] {
    let cross =
        |a: Vector, b: Vector| [1, 2, 0].map(|i| (i, (i + 1) % 3)).map(|(i, j)| a[i] * b[j] - a[j] * b[i]);
    let columns = [cross(y, z), cross(z, x), cross(x, y)];
    let determinant = dot(x, columns[0]);
    [0, 1, 2].map(|row| [0, 1, 2].map(|column| columns[column][row] / determinant))
}

#[test]
fn stretched_skies_give_the_irradiance_of_their_directions() {
    let side = 256;
    let picture = Image::from_fn(2 * side, side, ["R", "G", "B"], |x, y| {
        let (theta, phi) =
            (PI * (f64::from(y) + 0.5) / f64::from(side), PI * (f64::from(x) + 0.5) / f64::from(side));
        sky([theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()]).map(|l| l as f32)
    });
    let path = std::env::temp_dir().join(format!("alhazen-sky-{}.exr", std::process::id()));
    alhazen::image::write(&picture, &path, &WriteOptions::default()).unwrap();
    let (sin, cos) = 0.6_f64.sin_cos();
    let turn = [[1.0, 0.0, 0.0], [0.0, cos, -sin], [0.0, sin, cos]];
    let scaled = |x, y, z| [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]];
    let maps = [
        ("a rotation", turn),
        ("a uniform scale", product(turn, scaled(7.0, 7.0, 7.0))),
        ("a mirror", product(turn, scaled(1.0, -1.0, 1.0))),
        ("a stretch", product(turn, scaled(1.0, 2.0, 0.5))),
        ("a shear", product(turn, [[1.0, 0.7, 0.0], [0.0, 1.0, -0.4], [0.0, 0.0, 1.0]])),
    ];
    let algorithms = [
        ("path", &[][..]),
        ("simple-path", NEXT_EVENT_ALONE),
        ("simple-path", BSDF_ALONE),
        ("bdpt", &[]),
        ("light-tracing", &[]),
        ("sppm", &[]),
    ];
    for (name, m) in maps {
        let inward = inverse(m);
        let expected = mean_over_hemisphere(|d| {
            let w = times(inward, d);
            let length = dot(w, w).sqrt();
            sky(w.map(|x| x / length))
        });
        // Columns of the matrix follow each other in the format.
        let columns = [0, 1, 2].map(|k| format!("{} {} {} 0", m[0][k], m[1][k], m[2][k])).join(" ");
        let light = format!(
            "ConcatTransform [{columns} 0 0 0 1]\nLightSource \"infinite\" \"string filename\" \"{}\"",
            path.display()
        );
        let text = over_a_floor([-3.0, 3.0, -3.0, 3.0], 1024, &light);
        // The last map is the most general one; how a map acts does not depend on the algorithm.
        let algorithms = if name == "a shear" { &algorithms } else { &algorithms[..1] };
        assert_radiance(&text, expected.map(|l| RHO * l), algorithms, name);
    }
    std::fs::remove_file(path).unwrap();
}
