//! Triangulation of polygons by ear clipping [Meisters 1975].
//!
//! A polygon is projected along the largest component of its normal (after Newell: the sum of cross
//! products over its edges), so that it has positive area in the plane. An ear is a corner whose
//! triangle turns the right way and holds no other corner; ears are cut off until a triangle is
//! left. Polygons that touch or cross themselves may have no ear: then the most convex corner is
//! cut, so that n corners always give n − 2 triangles.

use math::{DVec3, Point3};

/// Polygons with more corners than this are cut as fans: the search for ears takes quadratic time,
/// and modellers do not make such polygons.
pub(super) const MOST_CORNERS: usize = 4096;

/// Whether a face is convex: whether it turns the same way at every corner (seen along its normal).
pub fn is_convex(positions: &[Point3], corners: &[u32]) -> bool {
    let points = project(positions, corners);
    let n = points.len();
    (0..n).all(|i| cross(points[i], points[(i + 1) % n], points[(i + 2) % n]) >= 0.0)
}

/// Triangles that cover a polygon, all with its winding.
pub fn triangulate(positions: &[Point3], corners: &[u32]) -> Vec<[u32; 3]> {
    if corners.len() > MOST_CORNERS {
        return (1..corners.len() - 1).map(|i| [corners[0], corners[i], corners[i + 1]]).collect();
    }
    let points = project(positions, corners);
    let mut left: Vec<usize> = (0..corners.len()).collect();
    let mut triangles = Vec::with_capacity(corners.len() - 2);
    while left.len() > 3 {
        let ear = find_ear(&points, &left);
        let n = left.len();
        triangles
            .push([left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]].map(|corner| corners[corner]));
        left.remove(ear);
    }
    triangles.push([left[0], left[1], left[2]].map(|corner| corners[corner]));
    triangles
}

/// The index of an ear among the corners that are left; without one, of the most convex corner.
fn find_ear(points: &[[f64; 2]], left: &[usize]) -> usize {
    let n = left.len();
    let triangle =
        |i: usize| [left[(i + n - 1) % n], left[i], left[(i + 1) % n]].map(|corner| points[corner]);
    let mut best = (f64::NEG_INFINITY, 0);
    for i in 0..n {
        let [a, b, c] = triangle(i);
        let turn = cross(a, b, c);
        if turn > best.0 {
            best = (turn, i);
        }
        let holds = |&corner: &usize| {
            let p = points[corner];
            p != a
                && p != b
                && p != c
                && cross(a, b, p) >= 0.0
                && cross(b, c, p) >= 0.0
                && cross(c, a, p) >= 0.0
        };
        if turn > 0.0 && !left.iter().any(holds) {
            return i;
        }
    }
    best.1
}

/// The corners in the plane in which the polygon has most area, counter-clockwise.
fn project(positions: &[Point3], corners: &[u32]) -> Vec<[f64; 2]> {
    let [u, v] = axes(normal(positions, corners));
    let origin = positions[corners[0] as usize].as_dvec3();
    let point = |&corner: &u32| positions[corner as usize].as_dvec3() - origin;
    corners.iter().map(point).map(|p| [p[u], p[v]]).collect()
}

/// The polygon's normal after Newell; twice the area long.
pub(super) fn normal(positions: &[Point3], corners: &[u32]) -> DVec3 {
    let origin = positions[corners[0] as usize].as_dvec3();
    let point = |i: usize| positions[corners[i % corners.len()] as usize].as_dvec3() - origin;
    (0..corners.len()).map(|i| point(i).cross(point(i + 1))).sum()
}

/// The axes of the coordinate plane in which a polygon with this normal has the most area, ordered
/// so that it is counter-clockwise.
pub(super) fn axes(normal: DVec3) -> [usize; 2] {
    let size = normal.abs();
    let (axes, along) = if size.z >= size.x && size.z >= size.y {
        ([0, 1], normal.z)
    } else if size.x >= size.y {
        ([1, 2], normal.x)
    } else {
        ([2, 0], normal.y)
    };
    if along >= 0.0 { axes } else { [axes[1], axes[0]] }
}

/// Twice the signed area of a triangle.
pub(super) fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

#[cfg(test)]
mod tests {
    use math::Vec3;
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    use super::*;

    fn area(positions: &[Vec3], triangle: [u32; 3]) -> Vec3 {
        let [a, b, c] = triangle.map(|corner| positions[corner as usize]);
        (b - a).cross(c - a) / 2.0
    }

    #[test]
    fn a_concave_polygon_is_cut_along_its_inside() {
        // An arrow head, in all three planes and both directions.
        let flat = [[0.0, 0.0], [2.0, -1.0], [0.5, 0.0], [2.0, 1.0]];
        for axis in 0..3 {
            for order in [[0, 1, 2, 3], [3, 2, 1, 0]] {
                let positions = flat.map(|[u, v]| {
                    let mut point = Vec3::splat(0.3);
                    point[axis] = u;
                    point[(axis + 1) % 3] = v;
                    point
                });
                assert!(!is_convex(&positions, &order));
                let triangles = triangulate(&positions, &order);
                let total: f32 = triangles.iter().map(|&triangle| area(&positions, triangle).length()).sum();
                assert!((total - 0.5).abs() < 1e-6, "{total}");
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { rng_seed: RngSeed::Fixed(1), failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn star_polygons_keep_area_and_direction(radii in prop::collection::vec(0.1_f32..1.0, 5..40)) {
            let n = radii.len();
            let positions: Vec<Vec3> = radii.iter().enumerate().map(|(i, &radius)| {
                let phi = i as f32 / n as f32 * std::f32::consts::TAU;
                radius * Vec3::new(phi.cos(), phi.sin(), 0.2 * phi.cos())
            }).collect();
            let corners: Vec<u32> = (0..n as u32).collect();
            let triangles = triangulate(&positions, &corners);
            prop_assert_eq!(triangles.len(), n - 2);
            let expected: f32 = (0..n).map(|i| positions[i].cross(positions[(i + 1) % n]).z / 2.0).sum();
            let areas: Vec<f32> = triangles.iter().map(|&triangle| area(&positions, triangle).z).collect();
            prop_assert!(areas.iter().all(|&area| area > -1e-6));
            prop_assert!((areas.iter().sum::<f32>() - expected).abs() < 1e-4);
        }

        #[test]
        fn any_corners_give_two_triangles_fewer(points in prop::collection::vec((-2_i8..3, -2_i8..3, -1_i8..2), 3..20)) {
            let positions: Vec<Vec3> = points.iter().map(|&(x, y, z)| Vec3::new(x.into(), y.into(), z.into())).collect();
            let corners: Vec<u32> = (0..positions.len() as u32).collect();
            prop_assert_eq!(triangulate(&positions, &corners).len(), positions.len() - 2);
        }
    }
}
