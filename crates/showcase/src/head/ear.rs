//! The ear.

use math::Vec3;

use super::blend::{Tube, carve, ellipsoid, join};

/// What is drawn as tubes, in the plane of the ear: x backwards, y up, z away from the head.
pub struct Ear {
    helix: Tube,
    antihelix: Tube,
    fork: Tube,
    tragus: Tube,
    antitragus: Tube,
}

impl Ear {
    pub fn new() -> Self {
        Self {
            helix: Tube::new(&[
                [-2.0, -4.0, -1.0, 2.0],
                [-8.0, 4.0, 2.5, 2.6],
                [-10.5, 15.0, 5.0, 2.9],
                [-4.0, 26.0, 6.5, 3.0],
                [7.0, 29.0, 7.0, 3.1],
                [16.5, 22.0, 7.0, 3.1],
                [19.0, 9.0, 6.5, 2.9],
                [15.5, -6.0, 5.5, 2.6],
                [9.0, -19.0, 4.0, 2.6],
                [3.0, -27.0, 2.0, 3.0],
            ]),
            antihelix: Tube::new(&[
                [0.5, -13.5, 5.0, 2.2],
                [7.0, -9.0, 6.5, 2.6],
                [10.0, 1.0, 7.0, 2.8],
                [8.0, 11.0, 6.0, 2.7],
                [4.0, 20.0, 4.0, 2.4],
            ]),
            fork: Tube::new(&[[8.0, 10.0, 5.8, 2.4], [1.0, 13.5, 3.0, 2.2], [-6.0, 14.0, 1.0, 1.8]]),
            tragus: Tube::new(&[[-10.5, 0.0, 2.0, 2.4], [-8.5, -6.0, 5.0, 2.8], [-8.5, -10.0, 3.5, 2.4]]),
            antitragus: Tube::new(&[[-3.0, -14.5, 3.5, 2.0], [1.5, -14.0, 5.0, 2.4]]),
        }
    }

    /// The ear on a head; x is not negative.
    pub fn on(&self, p: Vec3, head: f32) -> f32 {
        let middle = Vec3::new(70.0, -10.0, -19.0);
        if p.distance(middle) > 52.0 {
            return head;
        }
        // The plane of the ear leans back, and stands off from the head behind.
        let back = Vec3::new(0.42, -0.88, 0.0).normalize();
        let out = Vec3::new(0.88, 0.42, 0.0).normalize();
        let (sin, cos) = lanes::sin_cos(0.16);
        let up = Vec3::Z * cos + back * sin;
        let back = back * cos - Vec3::Z * sin;
        let r = p - middle;
        let q = Vec3::new(r.dot(back), r.dot(up), r.dot(out));
        let mut d = ellipsoid(q, [3.5, 4.0, 2.5], [14.5, 24.0, 3.4]);
        d = join(d, ellipsoid(q, [-1.5, -23.0, 2.5], [8.0, 9.0, 3.6]), 6.0);
        d = join(d, self.helix.distance(q, f32::INFINITY), 2.5);
        d = join(d, self.antihelix.distance(q, f32::INFINITY), 3.0);
        d = join(d, self.fork.distance(q, f32::INFINITY), 3.0);
        // What is behind the bowl.
        d = join(d, ellipsoid(q, [-1.0, -3.0, -4.0], [11.0, 14.0, 8.0]), 5.0);
        d = carve(d, ellipsoid(q, [-1.5, -3.0, 5.0], [8.6, 10.5, 8.0]), 2.0);
        d = join(d, self.tragus.distance(q, f32::INFINITY), 2.5);
        d = join(d, self.antitragus.distance(q, f32::INFINITY), 2.5);
        let ear = carve(d, ellipsoid(q, [-6.5, -4.0, -2.0], [3.0, 4.0, 8.0]), 2.0);
        join(head, ear, 4.5)
    }
}
