//! Form factors: the share of the light that leaves one surface and reaches another.
//!
//! F_ij = (1/A_i) ∫∫ cosθ_i cosθ_j / (π r²) · V dA_j dA_i is the share of the light leaving surface
//! i, of area A_i and uniform exitance, that arrives at surface j; V is the visibility of the two
//! points. Reciprocity: A_i F_ij = A_j F_ji.
//!
//! **Unoccluded**, the inner integral over a polygon has a closed form (Lambert, 1760): from a
//! point x with normal n,
//!
//! F_xj = 1/2π Σ_k Γ_k · n,
//!
//! where Γ_k is perpendicular to the plane through x and the polygon's k-th edge, and as long as
//! the angle that the edge subtends at x. The polygon is clipped to the horizon of x first. The
//! outer integral is the mean over four points of the receiver, the centres of its quarters. As the
//! factor of a polygon is exact at each point, the factors of all polygons visible from there sum
//! to one.
//!
//! **Occluded**, the closed form is multiplied by the visible share, Σ G V / Σ G over rays to
//! points of the emitter, with G = cosθ_i cosθ_j / r². One ray is traced for each of the four
//! points; if their visibilities differ, four are traced for each, one to each quarter of the
//! emitter. G is weighted by the light of its quarter, which differs on a floor half below a block.
//!
//! For faint light a single ray is traced, with each shot to another point. A curved cell emits
//! like the flat polygon of its corners, with the light of its whole area, and not to itself.
//! Sources: [Baum 1989], [Cohen 1993].

use geometry::{RayStats, SurfacePoint};
use math::{Normal3, Point3, Point3Error, Ray, Vector3, balance};
use scene::{Interfaces, Scene};
use std::f32::consts::TAU;

use super::domain::Domain;
use super::element::{Element, Patch, SamplePoint};
use super::mesh::Mesh;

/// The form factor from a point with unit normal `n` at the origin to a polygon that is
/// counter-clockwise seen from its emitting side, without occlusion. The part below the horizon is
/// clipped.
pub(crate) fn point_to_polygon(n: Normal3, polygon: &[Vector3]) -> f32 {
    // Clipping adds one corner at most, and polygons have four.
    let mut above = [Vector3::ZERO; 8];
    let mut len = 0;
    let mut push = |v: Vector3| {
        above[len] = v;
        len += 1;
    };
    let mut previous = polygon[polygon.len() - 1];
    let mut height = n.dot(previous);
    for &next in polygon {
        let next_height = n.dot(next);
        if (height < 0.0) != (next_height < 0.0) {
            push(previous.lerp(next, height / (height - next_height)));
        }
        if next_height >= 0.0 {
            push(next);
        }
        (previous, height) = (next, next_height);
    }
    let above = &above[..len];
    let side = |i: usize| {
        let (a, b) = (above[i].balanced(), above[(i + 1) % len].balanced());
        let cross = a.cross(b);
        let sin = cross.length();
        // An edge that is seen end-on, or has no length, contributes 0.
        if sin == 0.0 { 0.0 } else { n.dot(cross) / sin * lanes::atan2(sin, a.dot(b)) }
    };
    // A polygon that is counter-clockwise seen from its emitting side is clockwise about n.
    (0..len).map(side).sum::<f32>() / -TAU
}

/// Quarters with less than this share of the mean light count as black.
const DARK: f32 = 1e-3;

/// A cell that emits or reflects light.
#[derive(Clone)]
pub(crate) struct Emitter {
    /// Counter-clockwise seen from the emitting side.
    corners: Vec<Point3>,
    center: Point3,
    /// The mean normal of the emitting side.
    n: Normal3,
    /// The centres of the quarters of its quarters.
    points: [[(Point3Error, Normal3); 4]; 4],
    /// The light of each quarter, relative to the mean.
    light: [f32; 4],
    /// Its area over that of the flat polygon.
    bulge: f32,
    /// For at most this irradiance a single ray is traced, to a point of the receiver chosen by
    /// `turn`.
    faint: f32,
    turn: usize,
}

/// The irradiance of an element by one shot of unit radiosity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Received {
    /// Irradiance on the outer and the inner side of each quarter.
    pub quarters: [[f32; 2]; 4],
}

impl Received {
    /// Irradiance on the two sides of an element.
    pub fn sides(&self, element: &Element) -> [f32; 2] {
        let pairs = self.quarters.iter().zip(&element.points);
        pairs.fold([0.0; 2], |sum, (sides, point)| [0, 1].map(|i| sum[i] + sides[i] * point.weight))
    }
}

impl Emitter {
    /// One side of a patch: that of its normal (0), or the other one (1).
    pub fn new(scene: &Scene, mesh: &Mesh, patch: &Patch, side: usize) -> Self {
        let world = scene.world();
        let cell = mesh.cell(patch.cell);
        let mut corners: Vec<Point3> =
            cell.corners().iter().map(|corner| mesh.vertices()[corner.vertex as usize].p).collect();
        let turn = if side == 0 { 1.0 } else { -1.0 };
        let center = corners.iter().copied().sum::<Point3>() / corners.len() as f32;
        let point = |domain: &Domain| {
            let surface = mesh.surface(world, cell.primitive, domain.center());
            surface.map_or((Point3Error::exact(center), Normal3::ZERO), |s: SurfacePoint| (s.p, s.n * turn))
        };
        let n = point(&cell.domain()).1;
        let points = cell.domain().quarters().map(|quarter| quarter.quarters().each_ref().map(point));
        let area: Vector3 = (0..corners.len())
            .map(|i| (corners[i] - center).cross(corners[(i + 1) % corners.len()] - center))
            .sum();
        if area.dot(n) < 0.0 {
            corners.reverse();
        }
        let scale = balance(area.abs().max_element());
        let flat = 0.5 * (area * scale).length() * balance(scale);
        let bulge = if flat > 0.0 { patch.area / flat } else { 0.0 };
        Self { corners, center, n, points, light: patch.quarter_factors(side), bulge, faint: 0.0, turn: 0 }
    }

    /// Traces one ray instead of four or more for at most the irradiance `faint` from unit
    /// radiosity; `turn` chooses the ray.
    pub fn with_single_rays(self, faint: f32, turn: u32) -> Self {
        Self { faint, turn: turn as usize % 4, ..self }
    }

    /// The form factors from the two sides of a point with unit normal `n` to the emitter, without
    /// occlusion.
    fn seen_from(&self, p: Point3, n: Normal3) -> [f32; 2] {
        let mut polygon = [Vector3::ZERO; 4];
        let polygon = &mut polygon[..self.corners.len()];
        polygon.iter_mut().zip(&self.corners).for_each(|(to, corner)| *to = *corner - p);
        [n, -n].map(|n| {
            let is_above = polygon.iter().any(|corner| n.dot(*corner) > 0.0);
            if is_above { point_to_polygon(n, polygon).max(0.0) * self.bulge } else { 0.0 }
        })
    }

    /// Whether a point lies on its emitting side.
    fn faces(&self, p: Point3) -> bool {
        self.n.dot(p - self.center) > 0.0
    }

    /// cosθ cosθ / r² between a point and the `i`th point of a quarter, the side of the receiver,
    /// and the ray between them; `None` if they do not face each other.
    fn ray(&self, from: &SamplePoint, quarter: usize, i: usize, time: f32) -> Option<(f32, usize, Ray)> {
        let (to, to_n) = self.points[quarter][i];
        let way = to.p - from.p.p;
        let cos = way.dot(from.n);
        let scale = balance(way.abs().max_element());
        let unit = way * scale;
        let g = unit.dot(from.n).abs() * -unit.dot(to_n) / unit.length_squared().powi(2) * scale * scale;
        let ray = || Ray::between(from.p, from.n, to, to_n, time);
        (g > 0.0 && g.is_finite()).then(|| (g, usize::from(cos < 0.0), ray()))
    }

    /// The largest unoccluded irradiance of a quarter of an element.
    pub fn most_on(&self, element: &Element) -> f32 {
        let facing = element.points.iter().filter(|from| self.faces(from.p.p));
        facing.flat_map(|from| self.seen_from(from.p.p, from.n)).fold(0.0, f32::max)
    }

    /// The irradiance of an element.
    pub fn irradiate(&self, scene: &Scene, element: &Element, time: f32, stats: &mut RayStats) -> Received {
        let mut seen = [[0.0; 2]; 4];
        for (seen, from) in seen.iter_mut().zip(&element.points) {
            if self.faces(from.p.p) {
                *seen = self.seen_from(from.p.p, from.n);
            }
        }
        if seen == [[0.0; 2]; 4] {
            return Received::default();
        }
        let mut passes = |ray: &Ray| !scene.occluded(ray, Ray::SHADOW_END, Interfaces::Pass, stats);
        // One ray for each point of the receiver, to a quarter that is not black.
        let mut probes = [None; 4];
        let is_faint = seen.iter().flatten().all(|&factor| factor <= self.faint);
        let asked = if is_faint { self.turn..self.turn + 1 } else { 0..4 };
        for (k, from) in element.points.iter().enumerate().filter(|(k, _)| asked.contains(k)) {
            let quarter =
                (0..4).map(|i| (i + k) % 4).find(|&quarter| self.light[quarter] > DARK).unwrap_or(k);
            if let Some((_, _, ray)) = self.ray(from, quarter, (quarter + k) % 4, time) {
                probes[k] = Some((quarter, passes(&ray)));
            }
        }
        let mut answers = probes.iter().flatten().map(|&(_, visible)| visible);
        let first = answers.next();
        let all_alike = first.filter(|first| answers.all(|visible| visible == *first));
        let mut share = [Share::default(); 4];
        for (k, from) in element.points.iter().enumerate() {
            for quarter in 0..4 {
                if let Some((g, side, ray)) = self.ray(from, quarter, (quarter + k) % 4, time) {
                    let known =
                        all_alike.or(probes[k].filter(|probe| probe.0 == quarter).map(|probe| probe.1));
                    let shines = self.light[quarter] > DARK;
                    let visible = shines && known.unwrap_or_else(|| passes(&ray));
                    share[k].add(side, g, if visible { self.light[quarter] } else { 0.0 });
                }
            }
        }
        let mut all = Share::default();
        share.iter().for_each(|share| all.merge(share));
        let through = |k: usize, side: usize| share[k].of(side).or(all.of(side)).unwrap_or(1.0);
        Received { quarters: [0, 1, 2, 3].map(|k| [0, 1].map(|side| seen[k][side] * through(k, side))) }
    }
}

/// The visible share of an emitter's light, for each side of a receiver.
#[derive(Clone, Copy, Debug, Default)]
struct Share {
    passed: [f32; 2],
    sent: [f32; 2],
}

impl Share {
    fn add(&mut self, side: usize, g: f32, light: f32) {
        self.sent[side] += g;
        self.passed[side] += g * light;
    }

    fn merge(&mut self, other: &Self) {
        for side in 0..2 {
            self.sent[side] += other.sent[side];
            self.passed[side] += other.passed[side];
        }
    }

    /// The share on a side; `None` if no ray was traced there.
    fn of(&self, side: usize) -> Option<f32> {
        (self.sent[side] > 0.0).then(|| self.passed[side] / self.sent[side])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn v(x: f32, y: f32, z: f32) -> Vector3 {
        Vector3::new(x, y, z)
    }

    /// The mean over an n × n grid of points origin + s·x + t·y.
    fn to_rectangle(n: usize, point: impl Fn(f32, f32) -> (Vector3, Normal3), polygon: &[Vector3]) -> f64 {
        let place = |i: usize| (i as f32 + 0.5) / n as f32;
        let factor = |i: usize| {
            let (p, normal) = point(place(i % n), place(i / n));
            let seen: Vec<_> = polygon.iter().map(|&corner| corner - p).collect();
            f64::from(point_to_polygon(normal, &seen))
        };
        (0..n * n).map(factor).sum::<f64>() / (n * n) as f64
    }

    #[test]
    fn parallel_unit_squares() {
        // Howell's catalogue, C-11, for X = Y = 1.
        let root = 2f64.sqrt();
        let exact =
            2.0 / PI * ((4.0f64 / 3.0).sqrt().ln() + 2.0 * root * (1.0 / root).atan() - 2.0 * (PI / 4.0));
        let square = [v(0.0, 0.0, 1.0), v(0.0, 1.0, 1.0), v(1.0, 1.0, 1.0), v(1.0, 0.0, 1.0)];
        let found = to_rectangle(24, |s, t| (v(s, t, 0.0), Normal3::Z), &square);
        assert!((found / exact - 1.0).abs() < 1e-3, "{found}, not {exact}");
    }

    #[test]
    fn perpendicular_unit_squares() {
        // Howell's catalogue, C-14, for H = W = 1.
        let root = 2f64.sqrt();
        let logs = 0.25 * (4.0f64 / 3.0 * (3.0f64 / 4.0) * (3.0f64 / 4.0)).ln();
        let exact = (2.0 * (PI / 4.0) - root * (1.0 / root).atan() + logs) / PI;
        let wall = [v(0.0, 0.0, 0.0), v(0.0, 1.0, 0.0), v(0.0, 1.0, 1.0), v(0.0, 0.0, 1.0)];
        let found = to_rectangle(64, |s, t| (v(s, t, 0.0), Normal3::Z), &wall);
        assert!((found / exact - 1.0).abs() < 1e-3, "{found}, not {exact}");
        let from_behind = to_rectangle(4, |s, t| (v(-s, t, 0.0), Normal3::Z), &wall);
        assert!(from_behind <= 0.0);
    }

    #[test]
    fn coaxial_disks() {
        // Howell's catalogue, C-41, radii 1 and 2, one unit apart.
        let (r1, r2) = (1.0f64, 2.0f64);
        let s = 1.0 + (1.0 + r2 * r2) / (r1 * r1);
        let exact = 0.5 * (s - (s * s - 4.0 * (r2 / r1).powi(2)).sqrt());
        const SIDES: usize = 256;
        let disk: Vec<_> = (0..SIDES)
            .map(|i| -TAU * i as f32 / SIDES as f32)
            .map(|angle| v(2.0 * angle.cos(), 2.0 * angle.sin(), 1.0))
            .collect();
        // Rings of equal area; a polygon of many corners is one of many triangles around its
        // centre.
        let ring = |i: usize| {
            let p = v(((i as f32 + 0.5) / 64.0).sqrt(), 0.0, 0.0);
            let triangle = |k: usize| [v(0.0, 0.0, 1.0) - p, disk[k] - p, disk[(k + 1) % SIDES] - p];
            (0..SIDES).map(|k| f64::from(point_to_polygon(Normal3::Z, &triangle(k)))).sum::<f64>()
        };
        let found = (0..64).map(ring).sum::<f64>() / 64.0;
        assert!((found / exact - 1.0).abs() < 1e-3, "{found}, not {exact}");
    }

    #[test]
    fn polygons_are_clipped_to_the_horizon() {
        // A wall that extends below the horizon equals one that ends there.
        let wall = |low: f32| [v(1.0, -1.0, low), v(1.0, -1.0, 2.0), v(1.0, 1.0, 2.0), v(1.0, 1.0, low)];
        let (cut, whole) =
            (point_to_polygon(Normal3::Z, &wall(-3.0)), point_to_polygon(Normal3::Z, &wall(0.0)));
        assert!(cut > 0.05 && (cut - whole).abs() < 1e-6, "{cut}, {whole}");
        assert_eq!(point_to_polygon(-Normal3::Z, &wall(0.5)), 0.0);
    }
}
