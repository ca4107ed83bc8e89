//! Every warp has its density, and its inverse returns the input.

use alhazen_sampling::warp::*;
use math::{Point3, Vec2, Vec3};
use std::f32::consts::PI;
use testkit::{Chi2, Random};

/// An upper bound of the number of tests in this file, for the Šidák correction.
const CHI2: Chi2 = Chi2 { bins: [16, 32], samples: 100_000, min_expected: 5.0, tests: 40, seed: 17 };

/// Asserts that `invert(sample(u))` is u for many u.
fn round_trip<T>(sample: impl Fn(Vec2) -> T, invert: impl Fn(T) -> Vec2, tolerance: f32) {
    let mut random = Random::new(1);
    for _ in 0..5000 {
        let u = Vec2::from(random.get_2d());
        let back = invert(sample(u));
        assert!((back - u).abs().max_element() < tolerance, "{u} became {back}");
    }
}

fn interval(
    range: [f32; 2],
    sample: impl Fn(f32) -> f32,
    pdf: impl Fn(f32) -> f32,
    invert: impl Fn(f32) -> f32,
) {
    CHI2.interval(range, |u| Some(sample(u)).filter(|x| *x <= range[1]), |x| pdf(x) as f64)
        .unwrap_or_else(|table| panic!("{table}"));
    let mut random = Random::new(2);
    for _ in 0..5000 {
        let u = random.get_1d();
        assert!((invert(sample(u)) - u).abs() < 1e-4, "u = {u}");
    }
}

fn sphere(sample: impl Fn(Vec2) -> Vec3, pdf: impl Fn(Vec3) -> f32, invert: impl Fn(Vec3) -> Vec2) {
    let direction = |u| Some(sample(Vec2::from(u)).to_array());
    CHI2.sphere(direction, |w| pdf(Vec3::from(w)) as f64).unwrap_or_else(|table| panic!("{table}"));
    round_trip(sample, invert, 1e-3);
}

#[test]
fn linear() {
    for (a, b) in [(0.0, 1.0), (1.0, 0.0), (2.0, 3.0), (1.0, 1.0), (0.0, 0.0)] {
        interval([0.0, 1.0], |u| sample_linear(u, a, b), |x| linear_pdf(x, a, b), |x| invert_linear(x, a, b));
    }
}

#[test]
fn tent() {
    interval([-2.5, 2.5], |u| sample_tent(u, 2.5), |x| tent_pdf(x, 2.5), |x| invert_tent(x, 2.5));
}

#[test]
fn smooth_step() {
    let (a, b) = (-0.3, 1.2);
    interval(
        [a, b],
        |u| sample_smooth_step(u, a, b),
        |x| smooth_step_pdf(x, a, b),
        |x| invert_smooth_step(x, a, b),
    );
}

#[test]
fn exponential() {
    interval(
        [0.0, 5.0],
        |u| sample_exponential(u, 1.5),
        |x| exponential_pdf(x, 1.5),
        |x| invert_exponential(x, 1.5),
    );
}

#[test]
fn normal_pair() {
    let sample = |u| {
        let p = sample_two_normal(Vec2::from(u), 0.5, 0.3);
        Some(p.to_array()).filter(|p| p.iter().all(|x| (-1.0..=2.0).contains(x)))
    };
    let pdf = |p: [f32; 2]| (normal_pdf(p[0], 0.5, 0.3) * normal_pdf(p[1], 0.5, 0.3)) as f64;
    CHI2.rectangle([[-1.0, 2.0]; 2], sample, pdf).unwrap();
}

#[test]
fn bilinear() {
    for w in [[1.0, 2.0, 3.0, 0.5], [0.0, 0.0, 1.0, 4.0], [0.0, 1.0, 0.0, 0.0], [0.0; 4]] {
        CHI2.rectangle(
            [[0.0, 1.0]; 2],
            |u| Some(sample_bilinear(Vec2::from(u), w).to_array()),
            |p| bilinear_pdf(Vec2::from(p), w) as f64,
        )
        .unwrap();
        round_trip(|u| sample_bilinear(u, w), |p| invert_bilinear(p, w), 1e-3);
    }
}

#[test]
fn disk() {
    let pdf = |p: [f32; 2]| if p[0] * p[0] + p[1] * p[1] <= 1.0 { uniform_disk_pdf() as f64 } else { 0.0 };
    for sample in [sample_uniform_disk_polar, sample_uniform_disk_concentric] {
        let test = Chi2 { bins: [20, 20], ..CHI2 };
        test.rectangle([[-1.0, 1.0]; 2], |u| Some(sample(Vec2::from(u)).to_array()), pdf).unwrap();
    }
    round_trip(sample_uniform_disk_polar, invert_uniform_disk_polar, 1e-4);
    round_trip(sample_uniform_disk_concentric, invert_uniform_disk_concentric, 1e-4);
}

#[test]
fn uniform_sphere() {
    sphere(sample_uniform_sphere, |_| uniform_sphere_pdf(), invert_uniform_sphere);
}

#[test]
fn uniform_hemisphere() {
    let pdf = |w: Vec3| if w.z >= 0.0 { uniform_hemisphere_pdf() } else { 0.0 };
    sphere(sample_uniform_hemisphere, pdf, invert_uniform_hemisphere);
}

#[test]
fn cosine_hemisphere() {
    sphere(sample_cosine_hemisphere, |w| cosine_hemisphere_pdf(w.z), invert_cosine_hemisphere);
}

#[test]
fn uniform_cone() {
    for cos_theta_max in [0.9f32, 0.1, -0.7] {
        let pdf = |w: Vec3| if w.z >= cos_theta_max { uniform_cone_pdf(cos_theta_max) } else { 0.0 };
        sphere(|u| sample_uniform_cone(u, cos_theta_max), pdf, |w| invert_uniform_cone(w, cos_theta_max));
    }
}

#[test]
fn uniform_triangle() {
    let pdf = |p: [f32; 2]| if p[0] + p[1] <= 1.0 { uniform_triangle_pdf() as f64 } else { 0.0 };
    let sample = |u| {
        let b = sample_uniform_triangle(Vec2::from(u));
        assert!(b.iter().all(|b| *b >= -1e-7) && (b.iter().sum::<f32>() - 1.0).abs() < 1e-6);
        Some([b[0], b[1]])
    };
    Chi2 { bins: [20, 20], ..CHI2 }.rectangle([[0.0, 1.0]; 2], sample, pdf).unwrap();
    round_trip(sample_uniform_triangle, invert_uniform_triangle, 1e-5);
}

const TRIANGLES: [[Point3; 3]; 4] = [
    [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 1.0)],
    [Vec3::new(0.3, -2.0, 1.0), Vec3::new(-1.0, 0.5, 0.2), Vec3::new(2.0, 2.0, 0.4)],
    [Vec3::new(-5.0, -5.0, 0.2), Vec3::new(5.0, -5.0, 0.2), Vec3::new(0.0, 5.0, 0.3)],
    [Vec3::new(0.0, 3.0, 1.0), Vec3::new(0.4, 3.0, 1.0), Vec3::new(0.2, 3.0, 1.3)],
];

/// Whether a direction from the origin meets a triangle.
fn meets(w: Vec3, [a, b, c]: [Point3; 3]) -> bool {
    let sides = [a.cross(b).dot(w), b.cross(c).dot(w), c.cross(a).dot(w)];
    let orientation = a.cross(b).dot(c);
    sides.iter().all(|s| s * orientation >= 0.0)
}

/// The point of a triangle with barycentric coordinates at corners 1 and 2.
fn point_of([a, b, c]: [Point3; 3], at: Vec2) -> Point3 {
    a + (b - a) * at.x + (c - a) * at.y
}

#[test]
fn spherical_triangle() {
    for vertices in TRIANGLES {
        for order in [[0, 1, 2], [1, 0, 2], [2, 0, 1]] {
            let vertices = order.map(|i| vertices[i]);
            let shift = Vec3::new(1.0, -2.0, 0.5);
            let triangle = SphericalTriangle::new(vertices.map(|v| v + shift), shift);
            assert!(triangle.is_valid());
            let pdf = |w: Vec3| if meets(w, vertices) { triangle.pdf() } else { 0.0 };
            let test = Chi2 { bins: [48, 96], ..CHI2 };
            let direction =
                |u| Some(point_of(vertices, triangle.sample(Vec2::from(u))).normalize().to_array());
            test.sphere(direction, |w| pdf(Vec3::from(w)) as f64).unwrap();
            round_trip(|u| triangle.sample(u), |p| triangle.invert(p), 1e-3);
        }
    }
}

#[test]
fn solid_angle_of_an_octant() {
    let octant = SphericalTriangle::new(TRIANGLES[0], Vec3::ZERO);
    assert!((octant.solid_angle() - 0.5 * PI).abs() < 1e-6);
}

#[test]
fn tiny_spherical_triangles_are_sampled_uniformly() {
    let vertices = [Vec3::new(1.0, 0.0, 0.0), Vec3::new(1.0, 1e-3, 0.0), Vec3::new(1.0, 0.0, 2e-3)];
    let triangle = SphericalTriangle::new(vertices, Vec3::ZERO);
    assert!((triangle.solid_angle() / 1e-6 - 1.0).abs() < 1e-5);
    let pdf = |p: [f32; 2]| if p[0] + p[1] <= 1.0 { 2.0 } else { 0.0 };
    let sample = |u| Some(triangle.sample(Vec2::from(u)).to_array());
    Chi2 { bins: [20, 20], ..CHI2 }.rectangle([[0.0, 1.0]; 2], sample, pdf).unwrap();
}

#[test]
fn samples_of_thin_and_near_triangles_are_inside() {
    let mut random = Random::new(5);
    for _ in 0..50_000 {
        let squeeze = Vec3::new(1.0, 1.0, random.get_1d().powi(12));
        let mut coordinate = || 2.0 * random.get_1d() - 1.0;
        let vertices = [(); 3].map(|_| Vec3::new(coordinate(), coordinate(), coordinate()) * squeeze);
        let triangle = SphericalTriangle::new(vertices, Vec3::ZERO);
        if !triangle.is_valid() {
            continue;
        }
        let p = triangle.sample(Vec2::from(random.get_2d()));
        let b = [1.0 - p.x - p.y, p.x, p.y];
        assert!(b.iter().all(|b| (-1e-6..=1.0).contains(b)), "{b:?} of {vertices:?}");
        assert!(triangle.pdf() > 0.0 && triangle.invert(p).is_finite(), "{vertices:?}");
    }
}

#[test]
fn degenerate_triangles_are_rejected() {
    let [a, b, _] = TRIANGLES[0];
    let thin = SphericalTriangle::new([a, b, 0.5 * (a + b)], Vec3::new(0.2, 0.7, -1.0));
    assert!(!thin.is_valid() || thin.solid_angle() < 1e-6);
    assert!(!SphericalTriangle::new([a, a, b], Vec3::ZERO).is_valid());
    assert!(!SphericalTriangle::new(TRIANGLES[0], a).is_valid());
}

#[test]
fn spherical_rectangle() {
    let rectangles = [
        (Vec3::new(-1.0, -1.0, 1.0), Vec3::new(2.0, 0.0, 0.0), Vec3::new(0.0, 2.0, 0.0)),
        (Vec3::new(0.5, 0.2, -1.0), Vec3::new(0.0, 3.0, 0.0), Vec3::new(1.5, 0.0, 0.0)),
        (Vec3::new(-4.0, 1.0, -3.0), Vec3::new(1.0, 1.0, 0.0), Vec3::new(-2.0, 2.0, 1.0)),
        (Vec3::new(-9.0, -9.0, 0.1), Vec3::new(18.0, 0.0, 0.0), Vec3::new(0.0, 11.0, 0.0)),
    ];
    for (corner, x, y) in rectangles {
        let shift = Vec3::new(-0.3, 0.1, 2.0);
        let rectangle = SphericalRectangle::new(shift, corner + shift, x, y);
        assert!(rectangle.is_valid());
        let n = x.cross(y);
        let pdf = |w: [f32; 3]| {
            let w = Vec3::from(w);
            let t = corner.dot(n) / w.dot(n);
            let p = t * w - corner;
            let (a, b) = (p.dot(x) / x.length_squared(), p.dot(y) / y.length_squared());
            let inside = t > 0.0 && (0.0..=1.0).contains(&a) && (0.0..=1.0).contains(&b);
            if inside { rectangle.pdf() as f64 } else { 0.0 }
        };
        let point = |u| {
            let parts = rectangle.sample(u);
            corner + shift + x * parts.x + y * parts.y
        };
        let direction = |u| Some((point(Vec2::from(u)) - shift).normalize().to_array());
        Chi2 { bins: [48, 96], ..CHI2 }.sphere(direction, pdf).unwrap();
        round_trip(point, |p| rectangle.invert(p), 2e-3);
    }
    let cube_side = SphericalRectangle::new(Vec3::ZERO, rectangles[0].0, rectangles[0].1, rectangles[0].2);
    assert!((cube_side.solid_angle() - 4.0 * PI / 6.0).abs() < 1e-6);
}

#[test]
fn degenerate_rectangles_are_rejected() {
    let corner = Vec3::new(1.0, 1.0, 0.0);
    assert!(!SphericalRectangle::new(Vec3::ZERO, corner, Vec3::X, Vec3::Y).is_valid());
    assert!(!SphericalRectangle::new(Vec3::Z, corner, Vec3::ZERO, Vec3::Y).is_valid());
}
