//! Triangulation of planar polygons with holes.
//!
//! Each hole is joined to the outer contour by a *bridge*, an edge that is traversed in both
//! directions, so that one contour is left for the ear clipping of [`super::polygon`]. Holes are
//! taken from the right to the left. Of each, the rightmost corner M is bridged: the ray from M to
//! the right meets the contour first on some edge, whose right end V is visible from M if no corner
//! is in the triangle between them; of the corners in it, the one nearest in angle to the ray is
//! visible ([Eberly 2002]).
//!
//! Contours that touch or cross, or that are not nested as they should be, are refused first.

use std::fmt;

use math::{DVec3, Point3};

use super::polygon::{MOST_CORNERS, axes, cross, normal, triangulate};

/// Greatest distance of a corner from the plane, relative to the size of the polygon.
const FLATNESS: f64 = 1e-4;

/// Why contours are not a valid polygon. Points are counted from 0.
#[derive(Clone, Debug, PartialEq)]
pub enum ContourError {
    /// A contour has fewer than three points.
    TooShort {
        /// Its number.
        contour: usize,
    },
    /// There are more points than can be cut in reasonable time.
    TooMany,
    /// The outer contour has no area.
    Flat,
    /// A point lies outside of the plane of the outer contour.
    OffPlane {
        /// Its number.
        point: usize,
    },
    /// Two edges have a point in common.
    Touch {
        /// Their first points.
        edges: [usize; 2],
    },
    /// A hole is not within the outer contour, or is within another hole.
    Misplaced {
        /// Its number.
        contour: usize,
    },
}

impl fmt::Display for ContourError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooShort { contour } => write!(f, "contour {contour} has fewer than three points"),
            Self::TooMany => write!(f, "a polygon has at most {MOST_CORNERS} points; use a mesh"),
            Self::Flat => write!(f, "the outer contour has no area"),
            Self::OffPlane { point } => write!(f, "point {point} is not in the plane of the others"),
            Self::Touch { edges: [a, b] } => {
                write!(f, "the edges that begin with the points {a} and {b} touch or cross")
            }
            Self::Misplaced { contour } => {
                write!(f, "contour {contour} is not a hole: it must be within the first and no other")
            }
        }
    }
}

/// Triangles that cover the inside of the first contour without that of the others, all with the
/// winding of the first. Each of the contours takes the next `lengths[i]` of the points.
pub fn triangulate_contours(points: &[Point3], lengths: &[usize]) -> Result<Vec<[u32; 3]>, ContourError> {
    if let Some(contour) = lengths.iter().position(|&length| length < 3) {
        return Err(ContourError::TooShort { contour });
    }
    if points.len() + 2 * lengths.len() > MOST_CORNERS {
        return Err(ContourError::TooMany);
    }
    let mut contours = Vec::with_capacity(lengths.len());
    let mut next = 0;
    for &length in lengths {
        contours.push((next as u32..(next + length) as u32).collect::<Vec<u32>>());
        next += length;
    }
    let plane = Plane::new(points, &contours[0])?;
    if let Some(point) = points.iter().position(|&point| !plane.contains(point)) {
        return Err(ContourError::OffPlane { point });
    }
    let flat: Vec<[f64; 2]> = points.iter().map(|&point| plane.project(point)).collect();
    check_edges(&flat, &contours)?;
    for contour in 1..contours.len() {
        let inside = |other: usize| encloses(&flat, &contours[other], flat[contours[contour][0] as usize]);
        if !inside(0) || (1..contours.len()).any(|other| other != contour && inside(other)) {
            return Err(ContourError::Misplaced { contour });
        }
    }
    let mut merged = contours.remove(0);
    for hole in &mut contours {
        if area(&flat, hole) > 0.0 {
            hole.reverse();
        }
        let rightmost =
            (0..hole.len()).max_by(|&i, &j| flat[hole[i] as usize][0].total_cmp(&flat[hole[j] as usize][0]));
        hole.rotate_left(rightmost.unwrap_or(0));
    }
    contours.sort_by(|a, b| flat[b[0] as usize][0].total_cmp(&flat[a[0] as usize][0]));
    for hole in &contours {
        let at = bridge(&flat, &merged, flat[hole[0] as usize]);
        let way = hole.iter().chain([&hole[0], &merged[at]]).copied().collect::<Vec<u32>>();
        merged.splice(at + 1..at + 1, way);
    }
    Ok(triangulate(points, &merged))
}

/// The plane of the outer contour.
struct Plane {
    origin: DVec3,
    normal: DVec3,
    tolerance: f64,
    axes: [usize; 2],
}

impl Plane {
    fn new(points: &[Point3], outer: &[u32]) -> Result<Self, ContourError> {
        let origin = points[outer[0] as usize].as_dvec3();
        let size = points.iter().map(|p| (p.as_dvec3() - origin).length()).fold(0.0, f64::max);
        let normal = normal(points, outer);
        // With rounded coordinates, even a line has some area.
        if normal.length() <= 1e-7 * size * size {
            return Err(ContourError::Flat);
        }
        Ok(Self { origin, normal: normal.normalize(), tolerance: FLATNESS * size, axes: axes(normal) })
    }

    fn contains(&self, point: Point3) -> bool {
        (point.as_dvec3() - self.origin).dot(self.normal).abs() <= self.tolerance
    }

    fn project(&self, point: Point3) -> [f64; 2] {
        let p = point.as_dvec3() - self.origin;
        self.axes.map(|axis| p[axis])
    }
}

/// Checks that edges share no points but the ends of neighbours.
fn check_edges(flat: &[[f64; 2]], contours: &[Vec<u32>]) -> Result<(), ContourError> {
    let mut edges: Vec<[u32; 2]> =
        contours.iter().flat_map(|c| (0..c.len()).map(|i| [c[i], c[(i + 1) % c.len()]])).collect();
    let range = |edge: &[u32; 2]| {
        let [a, b] = edge.map(|i| flat[i as usize][0]);
        [a.min(b), a.max(b)]
    };
    edges.sort_by(|a, b| range(a)[0].total_cmp(&range(b)[0]));
    for (i, first) in edges.iter().enumerate() {
        let end = range(first)[1];
        for second in edges[i + 1..].iter().take_while(|edge| range(edge)[0] <= end) {
            let [[a, b], [c, d]] = [first, second].map(|edge| edge.map(|i| flat[i as usize]));
            let touch = match (first[1] == second[0], second[1] == first[0]) {
                // Neighbours overlap where one turns back on the other.
                (true, false) => folds(a, b, d),
                (false, true) => folds(c, d, b),
                _ => segments_meet([a, b], [c, d]),
            };
            if touch {
                let mut edges = [first[0] as usize, second[0] as usize];
                edges.sort_unstable();
                return Err(ContourError::Touch { edges });
            }
        }
    }
    Ok(())
}

/// Whether the path from `a` over `b` to `c` turns back on itself, or has no length.
fn folds(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> bool {
    let back = (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]);
    a == b || b == c || (cross(a, b, c) == 0.0 && back < 0.0)
}

/// Whether two segments have a point in common.
fn segments_meet([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> bool {
    let sides = [cross(a, b, c), cross(a, b, d), cross(c, d, a), cross(c, d, b)];
    let crosses = |s: f64, t: f64| (s < 0.0 && t > 0.0) || (s > 0.0 && t < 0.0);
    let between = |a: [f64; 2], b: [f64; 2], p: [f64; 2]| {
        (0..2).all(|i| a[i].min(b[i]) <= p[i] && p[i] <= a[i].max(b[i]))
    };
    (crosses(sides[0], sides[1]) && crosses(sides[2], sides[3]))
        || (sides[0] == 0.0 && between(a, b, c))
        || (sides[1] == 0.0 && between(a, b, d))
        || (sides[2] == 0.0 && between(c, d, a))
        || (sides[3] == 0.0 && between(c, d, b))
}

/// Whether a point that is on no edge is within a contour: an odd number of edges is to its right.
fn encloses(flat: &[[f64; 2]], contour: &[u32], p: [f64; 2]) -> bool {
    let at = |i: usize| flat[contour[i % contour.len()] as usize];
    (0..contour.len()).filter(|&i| right_of(p, at(i), at(i + 1)).is_some()).count() % 2 == 1
}

/// Where the ray from `p` to the right meets an edge. The upper end does not count, so that a
/// corner is met once.
fn right_of(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> Option<f64> {
    if (a[1] <= p[1]) == (b[1] <= p[1]) {
        return None;
    }
    let x = a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
    (x >= p[0]).then_some(x)
}

/// Twice the signed area.
fn area(flat: &[[f64; 2]], contour: &[u32]) -> f64 {
    let at = |i: usize| flat[contour[i] as usize];
    (1..contour.len() - 1).map(|i| cross(at(0), at(i), at(i + 1))).sum()
}

/// The index of the corner of a counter-clockwise contour to which a bridge leads from a point `m`
/// within it.
fn bridge(flat: &[[f64; 2]], contour: &[u32], m: [f64; 2]) -> usize {
    let n = contour.len();
    let at = |i: usize| flat[contour[i % n] as usize];
    // Edges that run upwards have the inside on their left, where m is.
    let edges = (0..n).filter(|&i| at(i)[1] <= m[1] && at(i + 1)[1] >= m[1] && at(i) != at(i + 1));
    let met = edges.filter_map(|i| {
        let (a, b) = (at(i), at(i + 1));
        let x =
            if a[1] == b[1] { a[0].min(b[0]) } else { a[0] + (m[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) };
        (x >= m[0]).then_some((x, i))
    });
    let Some((x, edge)) = met.min_by(|a, b| a.0.total_cmp(&b.0)) else { return 0 };
    let end = if at(edge)[0] > at(edge + 1)[0] { edge } else { (edge + 1) % n };
    let corner = |p: [f64; 2]| {
        // The triangle of m, the point met, and the end of its edge, either way round.
        let (i, v) = ([x, m[1]], at(end));
        let sides = [cross(m, i, p), cross(i, v, p), cross(v, m, p)];
        sides.iter().all(|&s| s >= 0.0) || sides.iter().all(|&s| s <= 0.0)
    };
    let opens = |i: usize| {
        let (before, here, after) = (at(i + n - 1), at(i), at(i + 1));
        let (left_of_out, left_of_in) = (cross(here, after, m) >= 0.0, cross(before, here, m) >= 0.0);
        if cross(before, here, after) > 0.0 { left_of_out && left_of_in } else { left_of_out || left_of_in }
    };
    let steepness = |i: usize| (at(i)[1] - m[1]).abs() / (at(i)[0] - m[0]);
    (0..n)
        .filter(|&i| at(i)[0] > m[0] && corner(at(i)) && opens(i))
        .min_by(|&i, &j| steepness(i).total_cmp(&steepness(j)).then(at(i)[0].total_cmp(&at(j)[0])))
        .unwrap_or(end)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    use super::*;

    fn cut(contours: &[&[[f32; 2]]]) -> Result<Vec<[u32; 3]>, ContourError> {
        let points: Vec<Point3> =
            contours.iter().flat_map(|c| c.iter().map(|&[x, y]| Point3::new(x, y, 0.5))).collect();
        triangulate_contours(&points, &contours.iter().map(|c| c.len()).collect::<Vec<_>>())
    }

    const SQUARE: [[f32; 2]; 4] = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];

    fn square(x: f32, y: f32, size: f32) -> [[f32; 2]; 4] {
        [[x, y], [x + size, y], [x + size, y + size], [x, y + size]]
    }

    #[test]
    fn contours_that_bound_no_polygon_are_refused() {
        use ContourError::*;
        let refused = |contours: &[&[[f32; 2]]]| cut(contours).expect_err("a fault");
        assert_eq!(refused(&[&SQUARE, &SQUARE[..2]]), TooShort { contour: 1 });
        assert_eq!(refused(&[&vec![[0.0, 0.0]; 5000]]), TooMany);
        assert_eq!(refused(&[&[[0.0, 0.0], [1.0, 1.0], [3.0, 3.0]]]), Flat);
        assert_eq!(refused(&[&SQUARE, &square(3.0, 1.0, 2.0)]), Touch { edges: [1, 4] });
        assert_eq!(refused(&[&SQUARE, &square(3.0, 1.0, 1.0)]), Touch { edges: [1, 4] });
        assert_eq!(
            refused(&[&SQUARE, &square(1.0, 1.0, 1.0), &square(2.0, 2.0, 1.0)]),
            Touch { edges: [6, 8] }
        );
        assert_eq!(refused(&[&[[0.0, 0.0], [4.0, 0.0], [4.0, 0.0], [0.0, 4.0]]]), Touch { edges: [0, 2] });
        assert_eq!(refused(&[&[[0.0, 0.0], [4.0, 0.0], [2.0, 0.0], [0.0, 4.0]]]), Touch { edges: [0, 2] });
        assert_eq!(refused(&[&SQUARE, &square(5.0, 1.0, 1.0)]), Misplaced { contour: 1 });
        assert_eq!(
            refused(&[&SQUARE, &square(1.5, 1.5, 1.0), &square(1.0, 1.0, 2.0)]),
            Misplaced { contour: 1 }
        );
        let bent = [Point3::ZERO, Point3::X, Point3::new(1.0, 1.0, 0.2), Point3::Y];
        assert_eq!(triangulate_contours(&bent, &[4]), Err(OffPlane { point: 1 }));
    }

    #[test]
    fn holes_side_by_side_and_one_above_another() {
        let holes =
            [square(0.5, 0.5, 1.0), square(2.0, 0.5, 1.0), square(0.5, 2.0, 1.0), square(2.0, 2.0, 1.0)];
        let contours: Vec<&[[f32; 2]]> =
            std::iter::once(&SQUARE[..]).chain(holes.iter().map(|hole| &hole[..])).collect();
        assert_eq!(cut(&contours).expect("a polygon").len(), 20 + 2 * 4 - 2);
    }

    proptest! {
        #![proptest_config(ProptestConfig { rng_seed: RngSeed::Fixed(2), failure_persistence: None, ..ProptestConfig::default() })]

        /// A square with a star, any way round, in some of its 5 × 5 fields, seen in a plane in
        /// space.
        #[test]
        fn triangles_cover_what_is_within_the_outer_contour_only(
            stars in prop::collection::vec((any::<bool>(), any::<bool>(), prop::collection::vec(0.05_f64..0.49, 3..9)), 25),
            tilt in (-2.0_f64..2.0, -2.0_f64..2.0),
            probes in prop::collection::vec((0.0_f64..5.0, 0.0_f64..5.0), 50),
        ) {
            let mut flat = vec![[0.0, 0.0], [5.0, 0.0], [5.0, 5.0], [0.0, 5.0]];
            let mut lengths = vec![4];
            for (field, (there, backwards, radii)) in stars.iter().enumerate() {
                if !there {
                    continue;
                }
                let n = radii.len();
                lengths.push(n);
                flat.extend(radii.iter().enumerate().map(|(i, radius)| {
                    let turn = if *backwards { -1.0 } else { 1.0 };
                    let phi = turn * i as f64 / n as f64 * std::f64::consts::TAU;
                    [(field % 5) as f64 + 0.5 + radius * phi.cos(), (field / 5) as f64 + 0.5 + radius * phi.sin()]
                }));
            }
            let place = |[x, y]: [f64; 2]| DVec3::new(x, x * tilt.0 + y * tilt.1, y);
            let points: Vec<Point3> = flat.iter().map(|&p| place(p).as_vec3().into()).collect();
            let triangles = triangulate_contours(&points, &lengths).expect("a polygon");
            prop_assert_eq!(triangles.len(), points.len() + 2 * (lengths.len() - 1) - 2);
            let mut contours = Vec::new();
            let mut next = 0;
            for &length in &lengths {
                contours.push((next..next + length as u32).collect::<Vec<u32>>());
                next += length as u32;
            }
            let total: f64 = triangles.iter().map(|t| area(&flat, t)).sum();
            let holes: f64 = contours[1..].iter().map(|hole| area(&flat, hole).abs()).sum();
            prop_assert!((total - (50.0 - holes)).abs() < 1e-4, "{} and {}", total, 50.0 - holes);
            for t in &triangles {
                prop_assert!(area(&flat, t) > -1e-4);
            }
            for (x, y) in probes {
                let edge = |t: &[u32; 3]| (0..3).map(|i| cross(flat[t[i] as usize], flat[t[(i + 1) % 3] as usize], [x, y])).fold(f64::MAX, f64::min);
                let covered = triangles.iter().filter(|t| edge(t) > 1e-4).count();
                let held = contours[1..].iter().any(|hole| encloses(&flat, hole, [x, y]));
                prop_assert!(covered <= usize::from(!held));
            }
        }
    }
}
