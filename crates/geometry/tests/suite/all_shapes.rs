//! The contract of all shapes: samples have their density, densities integrate to one, hits are on
//! the surface, and partial derivatives are those of the surface.

use crate::common::*;
use alhazen_geometry::*;
use math::*;
use sampling::Rng;
use testkit::{Chi2, assert_complete};

fn transforms() -> [Transform; 3] {
    let turn = Transform::rotate(0.7, Vec3::new(0.3, 1.0, -0.2));
    [
        Transform::IDENTITY,
        Transform::translate(Vec3::new(0.3, -0.2, 0.1)).after(&turn),
        Transform::translate(Vec3::new(0.1, 0.2, -0.3))
            .after(&turn)
            .after(&Transform::scale(Vec3::new(0.6, 1.3, -0.9))),
    ]
}

/// Reference points: outside, close by, inside a sphere, on a surface.
fn references() -> Vec<(&'static str, ShapeSampleContext)> {
    let at = |p| ShapeSampleContext { p: Point3Error::exact(p), n: Vec3::ZERO, ns: Vec3::ZERO, time: 0.0 };
    let lit = |p: Vec3, ns: Vec3| ShapeSampleContext { n: ns.normalize(), ns: ns.normalize(), ..at(p) };
    vec![
        ("outside", at(Vec3::new(0.4, 0.6, 2.5))),
        ("close by", at(Vec3::new(-0.3, 0.1, 0.9))),
        ("within", at(Vec3::new(0.2, -0.3, 0.1))),
        ("on a surface", lit(Vec3::new(1.5, -1.2, 0.9), Vec3::new(-1.0, 0.3, -0.4))),
    ]
}

#[test]
fn every_shape_is_tested() {
    // Shapes that are not sampled, and triangles that move, have tests of their own.
    let elsewhere = ["Plane", "Implicit", "Solid", "MovingTriangle"];
    let shapes = shapes(&Transform::IDENTITY);
    let table = shapes.iter().map(|(_, shape)| shape.member()).chain(elsewhere);
    assert_complete(Shape::MEMBERS, table);
}

fn each(mut f: impl FnMut(String, &Shape, &ShapeSampleContext)) {
    for (i, m) in transforms().iter().enumerate() {
        for (name, shape) in shapes(m) {
            for (place, reference) in references() {
                f(format!("{name} under transform {i}, seen from {place}"), &shape, &reference);
            }
        }
    }
}

/// Below this cosine, an area density converted to solid angle is too steep for the midpoint rule.
const EDGE_ON: f32 = 0.2;

/// The first hit along `w`, unless it is seen edge-on.
fn met(shape: &Shape, reference: &ShapeSampleContext, w: Vec3) -> Option<(ShapeHit, SurfacePoint)> {
    let ray = reference.spawn_ray(w);
    let hit = shape.intersect(&ray, f32::INFINITY)?;
    let surface = shape.surface(&ray, &hit);
    (surface.n.dot(surface.wo).abs() > EDGE_ON).then_some((hit, surface))
}

/// The direction of a sampled point, unless the shape occludes it, or it is seen edge-on.
fn visible(shape: &Shape, reference: &ShapeSampleContext, sample: &ShapeSample) -> Option<Vec3> {
    let toward = sample.p.p - reference.p.p;
    let (_, surface) = met(shape, reference, toward)?;
    (surface.p.p.distance(sample.p.p) < 2e-3).then(|| toward.normalize())
}

/// Equal cells (z, φ) of the cone that bounds the shape's box, and the integral of the density over
/// each, by a fine midpoint rule.
struct Cells {
    frame: Frame,
    z_min: f32,
}

impl Cells {
    const BINS: usize = 12;
    const STEPS: usize = 32;

    fn new(shape: &Shape, reference: &ShapeSampleContext) -> Self {
        let cone = bound_subtended_directions(&shape.bounds().expect("bounded"), reference.p.p);
        Self { frame: Frame::from_z(cone.w), z_min: cone.cos_theta }
    }

    fn cell(&self, w: Vec3) -> usize {
        let local = self.frame.to_local(w);
        let bin = |x: f32| ((x * Self::BINS as f32) as usize).min(Self::BINS - 1);
        let phi = spherical_phi(local) / std::f32::consts::TAU;
        bin((local.z - self.z_min) / (1.0 - self.z_min)) * Self::BINS + bin(phi)
    }

    fn integrals(&self, pdf: impl Fn(Vec3) -> f32) -> Vec<f64> {
        let n = Self::BINS * Self::STEPS;
        let place = |i: usize| (i as f32 + 0.5) / n as f32;
        let mut integrals = vec![0.0; Self::BINS * Self::BINS];
        for i in 0..n * n {
            let z = lerp(place(i / n), self.z_min, 1.0);
            let w = spherical_direction(safe_sqrt(1.0 - z * z), z, place(i % n) * std::f32::consts::TAU);
            let cell = i / n / Self::STEPS * Self::BINS + i % n / Self::STEPS;
            integrals[cell] += pdf(self.frame.from_local(w)) as f64;
        }
        let size = (1.0 - self.z_min as f64) * std::f64::consts::TAU / (n * n) as f64;
        integrals.iter().map(|sum| sum * size).collect()
    }
}

/// Tests visible samples against the density: their number and their distribution.
fn check(
    what: &str,
    shape: &Shape,
    reference: &ShapeSampleContext,
    sample: impl Fn(Vec2) -> Option<ShapeSample>,
    pdf: impl Fn(Vec3) -> f32,
) {
    const SAMPLES: usize = 20_000;
    let cells = Cells::new(shape, reference);
    let mut observed = vec![0u64; Cells::BINS * Cells::BINS];
    let rng = &mut Rng::new(7, 0);
    for _ in 0..SAMPLES {
        let sample = sample(uniform_2d(rng)).and_then(|s| visible(shape, reference, &s));
        if let Some(w) = sample {
            observed[cells.cell(w)] += 1;
        }
    }
    let integrals = cells.integrals(pdf);
    let seen = observed.iter().sum::<u64>() as f64;
    let total: f64 = integrals.iter().sum();
    assert!((seen / SAMPLES as f64 - total).abs() < 0.02, "{what}: {seen} visible, density of {total}");
    let expected: Vec<f64> = integrals.iter().map(|i| (i / total * seen).max(1e-3)).collect();
    let chi2 = Chi2 { tests: 192, min_expected: 300.0, ..Chi2::default() };
    chi2.counts(&observed, &expected).unwrap_or_else(|e| panic!("{what}: {e}"));
}

#[test]
fn samples_by_solid_angle_have_their_density() {
    each(|what, shape, reference| {
        check(
            &what,
            shape,
            reference,
            |u| shape.sample_from(reference, u),
            |w| met(shape, reference, w).map_or(0.0, |_| shape.pdf_from(reference, w)),
        );
    });
}

#[test]
fn samples_by_area_have_their_density() {
    each(|what, shape, reference| {
        let pdf = |w: Vec3| {
            met(shape, reference, w).map_or(0.0, |(_, surface)| {
                let distance2 = surface.p.p.distance_squared(reference.p.p);
                shape.pdf_area(surface.p.p, surface.n) * distance2 / surface.n.dot(surface.wo).abs()
            })
        };
        check(&what, shape, reference, |u| shape.sample(u), pdf);
    });
}

#[test]
fn patch_densities_do_not_depend_on_texture_coordinates() {
    let p = [[-1.0, -1.0, 0.0], [1.0, -0.8, 0.5], [-0.9, 1.0, 0.4], [1.1, 1.2, -0.3]].map(Vec3::from);
    let patch = BilinearPatch::new(p, None, Some([Vec2::splat(0.5); 4]), &Transform::IDENTITY, false);
    let (shape, rng) = (Shape::from(patch), &mut Rng::new(2, 0));
    for _ in 0..500 {
        let s = shape.sample(uniform_2d(rng)).unwrap();
        assert!((shape.pdf_area(s.p.p, s.n) / s.pdf - 1.0).abs() < 1e-4);
    }
}

#[test]
fn patches_are_sampled_by_an_image() {
    let image = sampling::PiecewiseConstant2d::new(&[0.1, 2.0, 1.0, 0.0, 0.5, 3.0], 3, Bounds2::UNIT);
    let p = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.3, 1.2, 0.6)];
    let patch = BilinearPatch::new(p, None, None, &Transform::IDENTITY, false).with_image(image.into());
    let shape = Shape::from(patch);
    let sample = |u: [f32; 2]| Some(shape.sample(u.into())?.uv.to_array());
    // Per parameter area: the density per area times the area element.
    let pdf = |uv: [f32; 2]| {
        let [u, v] = uv;
        let d_du = (p[1] - p[0]).lerp(p[3] - p[2], v);
        let d_dv = (p[2] - p[0]).lerp(p[3] - p[1], u);
        let cross = d_du.cross(d_dv);
        let place = p[0].lerp(p[1], u).lerp(p[2].lerp(p[3], u), v);
        (shape.pdf_area(place, cross.normalize()) * cross.length()) as f64
    };
    Chi2 { tests: 1, ..Chi2::default() }.rectangle([[0.0, 1.0], [0.0, 1.0]], sample, pdf).unwrap();
}

#[test]
fn pdf_from_agrees_with_sample_from_at_any_distance() {
    let rng = &mut Rng::new(1, 0);
    for distance in [1.5, 10.0, 300.0, 1e4] {
        for (name, shape) in transforms().iter().flat_map(shapes) {
            for i in 0..300 {
                let p = Point3Error::exact(direction(rng) * distance);
                let ns = if i % 2 == 0 { Vec3::ZERO } else { direction(rng) };
                let reference = ShapeSampleContext { p, n: ns, ns, time: 0.0 };
                let Some(sample) = shape.sample_from(&reference, uniform_2d(rng)) else { continue };
                let Some(wi) = visible(&shape, &reference, &sample) else { continue };
                let pdf = shape.pdf_from(&reference, wi);
                // A rounded direction may miss a shape at grazing angles.
                let tolerance = 0.01 + 1e-5 * distance;
                let agrees = (pdf / sample.pdf - 1.0).abs() < tolerance || (pdf == 0.0 && distance > 100.0);
                assert!(agrees, "{name} from {distance}: {pdf} and {}", sample.pdf);
            }
        }
    }
}

#[test]
fn the_density_of_a_convex_shape_integrates_to_one() {
    let reference = &references()[0].1;
    for (name, shape) in transforms()[..2].iter().flat_map(shapes) {
        if !matches!(name, "sphere" | "disk" | "ring" | "rectangle" | "triangle") {
            continue;
        }
        let cells = Cells::new(&shape, reference);
        let total: f64 = cells.integrals(|w| shape.pdf_from(reference, w)).iter().sum();
        assert!((total - 1.0).abs() < 0.01, "{name}: {total}");
    }
}

/// Rays towards random points of the surface hit those points.
#[test]
fn hits_are_on_the_surface_with_its_derivatives() {
    let rng = &mut Rng::new(2, 0);
    for (name, shape) in transforms().iter().flat_map(shapes) {
        let bounds = shape.bounds().expect("bounded");
        let cone = shape.normal_bounds();
        for _ in 0..300 {
            let sample = shape.sample(uniform_2d(rng)).expect("a sample");
            assert!(bounds.expand(1e-6).contains(sample.p.p), "{name}");
            assert!(cone.contains(sample.n) || cone.w.dot(sample.n) > cone.cos_theta - 1e-4, "{name}");
            let o = point_in(rng, 4.0);
            let ray = Ray::new(o, sample.p.p - o, 0.5);
            let Some(hit) = shape.intersect(&ray, f32::INFINITY) else { continue };
            let surface = shape.surface(&ray, &hit);
            assert!(surface.p.p.distance(ray.at(hit.t)) < 1e-4 * (1.0 + ray.d.length()), "{name}");
            assert!((surface.n.length() - 1.0).abs() < 1e-5 && (surface.wo.length() - 1.0).abs() < 1e-5);
            assert_eq!(surface.time, 0.5);
            let cos = surface.dpdu.cross(surface.dpdv).normalize().dot(surface.n);
            assert!((cos.abs() - 1.0).abs() < 1e-3, "{name}: tangents lie in the surface");
            let again = shape.surface_at(hit.uv, 0.5).expect("parameters");
            assert!(again.p.p.distance(surface.p.p) < 1e-4, "{name}: the point with these parameters");
            assert!(again.n.dot(surface.n) > 0.999 && again.wo == again.n && again.time == 0.5, "{name}");
            if surface.p.p.distance(sample.p.p) < 1e-5 {
                assert!(surface.n.dot(sample.n) > 0.99, "{name}: one outside");
                assert!((surface.uv - sample.uv).length() < 2e-3 || name.contains("sphere"), "{name}");
            }
            check_derivatives(name, &shape, &surface);
        }
    }
}

/// Finite differences of position, normal and (u, v) along each tangent.
fn check_derivatives(name: &str, shape: &Shape, surface: &SurfacePoint) {
    let h = 1e-2;
    for (dp, dn, axis) in [(surface.dpdu, surface.dndu, Vec2::X), (surface.dpdv, surface.dndv, Vec2::Y)] {
        let reach = h / dp.length();
        let above = surface.p.p + dp * reach + surface.n * 0.1;
        let Some(hit) = shape.intersect(&Ray::new(above, -surface.n, 0.0), 0.2) else { continue };
        let other = shape.surface(&Ray::new(above, -surface.n, 0.0), &hit);
        let change = (other.uv - surface.uv) / reach;
        // Near a pole u changes too fast for the step.
        if surface.dpdu.length() < 0.5 || change.length() > 2.0 {
            continue;
        }
        assert!((change - axis).length() < 0.15, "{name}: {change} for {axis}");
        let turned = (other.n - surface.n) / reach;
        assert!(
            (turned - dn).length() < 0.1 * (1.0 + dn.length() + dp.length()),
            "{name}: {turned} and {dn}"
        );
    }
}

#[test]
fn hits_in_closed_form() {
    let m = &Transform::IDENTITY;
    let meet = |shape: Shape, o: Vec3, d: Vec3| {
        shape.intersect(&Ray::new(o, d, 0.0), 1e9).map(|hit| (hit.t, hit.uv))
    };
    let high = Vec3::new(0.0, 0.0, 5.0);
    let sphere = || Shape::from(Sphere::whole(m, false, 1.0));
    assert_eq!(meet(sphere(), high, -Vec3::Z), Some((4.0, Vec2::new(0.0, 1.0))));
    assert_eq!(meet(sphere(), Vec3::ZERO, Vec3::Y * 0.5), Some((2.0, Vec2::new(0.25, 0.5))));
    assert_eq!(meet(sphere(), high + Vec3::X, -Vec3::Z).map(|hit| hit.0), Some(5.0), "touched");
    assert_eq!(meet(sphere(), high + Vec3::X * 1.001, -Vec3::Z), None);
    assert_eq!(meet(sphere(), high, Vec3::Z), None);
    let dome = Sphere::new(m, false, 1.0, [-1.0, 0.0], 360.0).into();
    assert_eq!(meet(dome, high, -Vec3::Z).map(|hit| hit.0), Some(6.0), "through the open top");
    let tube = || Shape::from(Cylinder::new(m, false, 2.0, [0.0, 4.0], 360.0));
    assert_eq!(meet(tube(), Vec3::new(5.0, 0.0, 1.0), -Vec3::X), Some((3.0, Vec2::new(0.0, 0.25))));
    assert_eq!(meet(tube(), Vec3::new(0.0, 0.0, 9.0), -Vec3::Z), None, "no caps");
    let cone = || Shape::from(Cone::new(m, false, 2.0, 4.0, 360.0));
    assert_eq!(meet(cone(), Vec3::new(5.0, 0.0, 2.0), -Vec3::X), Some((4.0, Vec2::new(0.0, 0.5))));
    assert_eq!(meet(cone(), Vec3::new(0.0, 0.0, 9.0), -Vec3::Z), Some((5.0, Vec2::new(0.0, 1.0))), "the tip");
    assert_eq!(meet(cone(), Vec3::new(0.0, 2.0, 5.0), -Vec3::Y), None, "no second nappe");
    assert_eq!(
        meet(cone(), Vec3::new(-1.0, 0.0, -3.0), Vec3::Z),
        Some((5.0, Vec2::new(0.5, 0.5))),
        "no base"
    );
    let bowl = || Shape::from(Paraboloid::new(m, false, 2.0, [0.0, 4.0], 360.0));
    assert_eq!(meet(bowl(), Vec3::new(0.0, -5.0, 1.0), Vec3::Y), Some((4.0, Vec2::new(0.75, 0.25))));
    assert_eq!(
        meet(bowl(), Vec3::ZERO + Vec3::Y, Vec3::Z),
        Some((1.0, Vec2::new(0.25, 0.25))),
        "along its axis"
    );
    assert_eq!(meet(bowl(), Vec3::new(3.0, 0.0, 4.5), -Vec3::X), None, "above the rim");
    // x² + y² = 1 + z².
    let hyperboloid = Shape::from(Hyperboloid::new(m, false, [Vec3::new(1.0, -1.0, -1.0), Vec3::ONE], 360.0));
    assert_eq!(
        meet(hyperboloid.clone(), Vec3::new(3.0, 0.0, 0.0), -Vec3::X),
        Some((2.0, Vec2::new(0.0, 0.5)))
    );
    assert_eq!(meet(hyperboloid, Vec3::new(0.5, 0.0, 5.0), -Vec3::Z), None, "through the waist");
    let ring = || Shape::from(Disk::new(m, false, 1.0, 2.0, 1.0, 360.0));
    assert_eq!(meet(ring(), high + Vec3::Y * 1.5, -Vec3::Z), Some((4.0, Vec2::new(0.25, 0.5))));
    assert_eq!(meet(ring(), high + Vec3::Y * 0.5, -Vec3::Z), None);
    let plane = || Shape::from(Plane::new(m, false));
    assert_eq!(meet(plane(), Vec3::new(3.0, 4.0, -8.0), Vec3::Z * 4.0), Some((2.0, Vec2::new(3.0, 4.0))));
    assert_eq!(meet(plane(), Vec3::Z, Vec3::X), None, "d_z = 0");
    assert_eq!(meet(plane(), Vec3::ZERO, Vec3::X), None, "within the plane");
    // z = uv over the unit square.
    let saddle = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ONE];
    let saddle = BilinearPatch::new(saddle, None, None, m, false).into();
    assert_eq!(meet(saddle, Vec3::new(0.5, 0.25, 1.0), -Vec3::Z), Some((0.875, Vec2::new(0.5, 0.25))));
}

#[test]
fn areas() {
    use std::f32::consts::PI;
    let m = Transform::rotate(1.0, Vec3::ONE).after(&Transform::scale(Vec3::splat(2.0)));
    let close = |shape: Shape, area: f32| assert!((shape.area() / area - 1.0).abs() < 1e-3, "{shape:?}");
    close(Sphere::whole(&m, false, 0.5).into(), 4.0 * PI);
    close(Sphere::new(&m, false, 0.5, [0.0, 0.5], 180.0).into(), PI);
    close(Cylinder::new(&m, false, 0.5, [-1.0, 1.0], 360.0).into(), 8.0 * PI);
    close(Cone::new(&m, false, 1.5, 2.0, 90.0).into(), 4.0 * 0.25 * PI * 1.5 * 2.5);
    // A paraboloid z = x² + y² up to z = 2: (π/6)·(9^(3/2) − 1).
    close(Paraboloid::new(&m, false, 2f32.sqrt(), [0.0, 2.0], 360.0).into(), 4.0 * PI / 6.0 * 26.0);
    // x² + y² = 1 + z² for |z| < 1: 2π·(√3 + asinh(√2)/√2).
    let line = [Vec3::new(1.0, -1.0, -1.0), Vec3::ONE];
    let bent = 2.0 * PI * (3f32.sqrt() + 2f32.sqrt().asinh() / 2f32.sqrt());
    close(Hyperboloid::new(&m, false, line, 360.0).into(), 4.0 * bent);
    let tube = [Vec3::new(0.5, 0.0, -1.0), Vec3::new(0.5, 0.0, 1.0)];
    close(Hyperboloid::new(&m, false, tube, 360.0).into(), 8.0 * PI);
    close(Disk::new(&m, false, 3.0, 1.0, 0.5, 90.0).into(), 0.75 * PI);
    let square = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 0.0)];
    close(BilinearPatch::new(square, None, None, &m, false).into(), 4.0);
    close(Triangle::new([Vec3::ZERO, Vec3::X, Vec3::Y * 3.0]).into(), 1.5);
    // An ellipsoid with half axes 1, 1, 2: 2π(1 + 2/e·asin e), e = √(3/4).
    let stretched = Transform::scale(Vec3::new(1.0, 1.0, 2.0));
    let e = 0.75f32.sqrt();
    close(Sphere::whole(&stretched, false, 1.0).into(), 2.0 * PI * (1.0 + 2.0 / e * e.asin()));
    assert_eq!(Shape::from(Plane::new(&m, false)).area(), f32::INFINITY);
}

#[test]
fn reverse_orientation_flips_normals() {
    let mirror = Transform::scale(Vec3::new(-1.0, 1.0, 1.0));
    let down = Ray::new(Vec3::new(0.2, 0.1, 5.0), -Vec3::Z, 0.0);
    for (m, reverse, up) in [
        (Transform::IDENTITY, false, true),
        (Transform::IDENTITY, true, false),
        (mirror, false, false),
        (mirror, true, true),
    ] {
        for shape in [
            Shape::from(Sphere::whole(&m, reverse, 1.0)),
            Disk::new(&m, reverse, 0.0, 1.0, 0.0, 360.0).into(),
            Plane::new(&m, reverse).into(),
        ] {
            let hit = shape.intersect(&down, 9.0).expect("hit");
            assert_eq!(shape.surface(&down, &hit).n.z > 0.0, up, "{shape:?}");
        }
        // Vertices are transformed themselves, so that only the reversal is left.
        let corners = [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
        let mesh = TriangleMesh::new(
            corners.to_vec().into(),
            vec![[0, 1, 2]].into(),
            MeshAttributes::default(),
            &m,
            reverse,
        );
        let triangle = mesh.expect("a mesh").triangle(0);
        assert_eq!(Shape::from(triangle).sample(Vec2::splat(0.3)).expect("a sample").n.z > 0.0, !reverse);
    }
}
