//! Signed distances of solids, and smooth unions and differences of them.
//!
//! Distances are positive outside. Blends are cubic: the surface has a continuous curvature across
//! them, so that highlights have no kinks. A blend of width k changes nothing where the distances
//! differ by k or more, so that solids that are far away can be left out.

use math::Vec3;

/// The union of two solids with a fillet of a width.
pub fn join(a: f32, b: f32, width: f32) -> f32 {
    let h = (1.0 - (a - b).abs() / width).max(0.0);
    a.min(b) - h * h * h * width * (1.0 / 6.0)
}

/// The first solid without the second one.
pub fn carve(a: f32, b: f32, width: f32) -> f32 {
    -join(-a, b, width)
}

/// About the distance to an ellipsoid with a centre and radii.
pub fn ellipsoid(p: Vec3, centre: [f32; 3], radii: [f32; 3]) -> f32 {
    let (q, r) = (p - Vec3::from_array(centre), Vec3::from_array(radii));
    let (scaled, slope) = ((q / r).length(), (q / (r * r)).length());
    if slope < 1e-9 { -r.min_element() } else { scaled * (scaled - 1.0) / slope }
}

/// Turns a point about an axis through a centre that is parallel to x, y or z, in degrees; what is
/// then measured is turned the other way.
pub fn turned(p: Vec3, centre: [f32; 3], axis: usize, degrees: f32) -> Vec3 {
    let (sin, cos) = lanes::sin_cos(degrees.to_radians());
    let c = Vec3::from_array(centre);
    let mut q = (p - c).to_array();
    let [i, j] = [(axis + 1) % 3, (axis + 2) % 3];
    (q[i], q[j]) = (cos * q[i] - sin * q[j], sin * q[i] + cos * q[j]);
    Vec3::from_array(q) + c
}

/// A tube along a smooth curve through points with radii.
pub struct Tube {
    /// Pieces of the curve, polynomials of position and radius.
    pieces: Vec<[[f32; 4]; 4]>,
    /// Points of the curve, `STEPS` for each piece and the last one.
    points: Vec<Vec3>,
    centre: Vec3,
    /// All of the tube is within this distance of the centre.
    reach: f32,
}

const STEPS: usize = 4;

impl Tube {
    /// The curve is a Catmull–Rom spline.
    pub fn new(corners: &[[f32; 4]]) -> Self {
        let last = corners.len() - 1;
        let near = |i: usize| [i.saturating_sub(1), i, i + 1, (i + 2).min(last)].map(|i| corners[i]);
        let pieces: Vec<_> = (0..last).map(|i| polynomial(near(i))).collect();
        let at = |i: usize| {
            let piece = (i / STEPS).min(pieces.len() - 1);
            evaluate(&pieces[piece], i as f32 / STEPS as f32 - piece as f32)
        };
        let points: Vec<(Vec3, f32)> = (0..=last * STEPS).map(at).collect();
        let centre = points.iter().fold(Vec3::ZERO, |sum, (p, _)| sum + *p) / points.len() as f32;
        let reach = points.iter().map(|(p, r)| p.distance(centre) + r).fold(0.0, f32::max) + 0.5;
        Self { pieces, points: points.into_iter().map(|(p, _)| p).collect(), centre, reach }
    }

    /// The distance, or a number of at least `far` where it is larger than that.
    pub fn distance(&self, p: Vec3, far: f32) -> f32 {
        let bound = p.distance(self.centre) - self.reach;
        if bound >= far {
            return bound;
        }
        // The nearest point of the polyline, and from there the nearest one of the curve.
        let (mut least, mut u) = (f32::INFINITY, 0.0);
        for (i, ends) in self.points.windows(2).enumerate() {
            let along = ends[1] - ends[0];
            let t = ((p - ends[0]).dot(along) / along.length_squared()).clamp(0.0, 1.0);
            let distance = (p - ends[0] - along * t).length_squared();
            if distance < least {
                (least, u) = (distance, (i as f32 + t) / STEPS as f32);
            }
        }
        let end = self.pieces.len() as f32;
        for _ in 0..3 {
            let (centre, _, slope) = self.at(u);
            u = (u + (p - centre).dot(slope) / slope.length_squared().max(1e-6)).clamp(0.0, end);
        }
        let (centre, radius, _) = self.at(u);
        p.distance(centre) - radius
    }

    /// Point, radius and derivative of the point at a parameter, which counts the pieces.
    pub fn at(&self, u: f32) -> (Vec3, f32, Vec3) {
        let piece = (u as usize).min(self.pieces.len() - 1);
        let (t, [_, b, c, d]) = (u - piece as f32, self.pieces[piece]);
        let (point, radius) = evaluate(&self.pieces[piece], t);
        let [x, y, z] = [0, 1, 2].map(|i| b[i] + t * (2.0 * c[i] + 3.0 * t * d[i]));
        (point, radius, Vec3::new(x, y, z))
    }
}

/// The polynomial between the two points in the middle of four.
fn polynomial(p: [[f32; 4]; 4]) -> [[f32; 4]; 4] {
    let mut pieces = [[0.0; 4]; 4];
    for i in 0..4 {
        let [a, b, c, d] = p.map(|p| p[i]);
        let (u, v) = (0.5 * (c - a), 0.5 * (d - b));
        for (k, value) in [b, u, 3.0 * (c - b) - 2.0 * u - v, 2.0 * (b - c) + u + v].into_iter().enumerate() {
            pieces[k][i] = value;
        }
    }
    pieces
}

fn evaluate([a, b, c, d]: &[[f32; 4]; 4], t: f32) -> (Vec3, f32) {
    let [x, y, z, r] = [0, 1, 2, 3].map(|i| a[i] + t * (b[i] + t * (c[i] + t * d[i])));
    (Vec3::new(x, y, z), r)
}
