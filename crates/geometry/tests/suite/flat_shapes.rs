//! Triangles and rectangles that are sampled in lanes.

use crate::common::{direction, point_in, uniform_2d};
use alhazen_geometry::*;
use lanes::Real;
use math::{Point3Error, Transform, Vec2, Vec3};
use sampling::Rng;
use testkit::{LaneFunction, lanes_agree};

/// Shapes that face all sides, some of them reversed.
fn shapes(rng: &mut Rng) -> Vec<Shape> {
    let random_triangle = |rng: &mut Rng| Triangle::new([(); 3].map(|_| point_in(rng, 1.0)));
    let plain = random_triangle(rng);
    let reversed = Triangle { flips: true, ..random_triangle(rng) };
    let smooth = random_triangle(rng);
    let normal = -(smooth.p[1] - smooth.p[0]).cross(smooth.p[2] - smooth.p[0]);
    let smooth = Triangle { n: Some([normal; 3]), ..smooth };
    let turned = Transform::rotate(rng.uniform_f32() * 6.0, direction(rng));
    let square = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X + Vec3::Y];
    let square = BilinearPatch::new(square, None, None, &turned, rng.uniform_f32() < 0.5);
    vec![plain.into(), reversed.into(), smooth.into(), square.into()]
}

/// Samples and densities are those of the shapes, at distances where they are sampled by solid
/// angle and where by area.
#[test]
fn flat_shapes_are_sampled_as_shapes() {
    let rng = &mut Rng::new(1, 0);
    for _ in 0..100 {
        for shape in shapes(rng) {
            let flat = shape.flat_shape().expect("a flat shape");
            for distance in [0.5, 3.0, 100.0] {
                let ns = direction(rng);
                let p = Point3Error::exact(direction(rng) * distance);
                let reference = ShapeSampleContext { p, n: ns, ns, time: 0.0 };
                let u = uniform_2d(rng);
                let (sample, valid) = flat.sample_from(&reference, u);
                let Some(expected) = shape.sample_from(&reference, u) else {
                    assert!(!valid);
                    continue;
                };
                let near = |a: f32, b: f32| (a / b - 1.0).abs() < 1e-3;
                assert!(valid && near(sample.pdf, expected.pdf), "{} and {}", sample.pdf, expected.pdf);
                assert!(sample.p.p.distance(expected.p.p) < 1e-4);
                assert!(sample.n.dot(expected.n) > 0.999);
                let pdf = flat.pdf_from(&reference, sample.uv);
                assert!(near(pdf, sample.pdf), "{pdf} and {} at {distance}", sample.pdf);
            }
        }
    }
}

#[test]
fn shapes_with_several_outsides_are_not_flat() {
    let p = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let normals = [Vec3::Z, Vec3::Z, -Vec3::Z];
    assert!(Shape::from(Triangle { n: Some(normals), ..Triangle::new(p) }).flat_shape().is_none());
    assert!(Shape::from(Triangle::new([p[0], p[1], p[1]])).flat_shape().is_none());
}

struct Samples;

impl LaneFunction for Samples {
    #[inline(always)]
    fn results<R: Real>(&self, u: &[R]) -> Vec<R> {
        let at = |i: usize| Vec3::new(u[i], u[i + 1], u[i + 2]);
        let n = at(9).normalize();
        let flat = FlatShape { corner: at(0), sides: [at(3), at(6)], n, is_triangle: u[15].lt(u[16]) };
        let p = Point3Error::exact(at(9) * R::splat(4.0));
        let reference = ShapeSampleContext { p, n, ns: at(12).normalize(), time: R::zero() };
        let u = Vec2::new(u[17], u[18]);
        let (sample, valid) = flat.sample_from(&reference, u);
        let number = |x: R| R::select(valid, x, R::zero());
        let [x, y, z] = sample.p.p.to_array();
        vec![
            number(x),
            number(y),
            number(z),
            number(sample.pdf),
            flat.pdf_from(&reference, u * R::splat(0.5)),
        ]
    }
}

#[test]
fn samples_do_not_depend_on_the_number_of_lanes() {
    lanes_agree(&Samples, 19, 500);
}
