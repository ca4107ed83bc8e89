//! Brow, eyes, nose and mouth.

use math::Vec3;

use super::blend::{Tube, carve, ellipsoid, join, turned};

/// The middle of the eye at positive x.
pub const EYE: [f32; 3] = [31.5, 65.0, 0.0];
/// Radius of the eyeball.
pub const EYEBALL: f32 = 13.0;

/// The cornea: how far its middle is before that of the eye, and its radius.
pub const CORNEA: [f32; 2] = [6.7, 7.7];

/// What is drawn as tubes.
pub struct Face {
    brow: Tube,
    bridge: Tube,
    wing: Tube,
    upper_lip: Tube,
    lower_lip: Tube,
    mouth: Tube,
    philtrum: Tube,
    fold: Tube,
    crease: Tube,
}

impl Face {
    pub fn new() -> Self {
        Self {
            brow: Tube::new(&[
                [5.0, 80.0, 20.0, 5.5],
                [20.0, 79.5, 22.0, 5.2],
                [36.0, 73.0, 23.0, 4.8],
                [50.0, 53.0, 14.0, 2.5],
            ]),
            bridge: Tube::new(&[
                [0.0, 82.0, 16.0, 8.0],
                [0.0, 82.5, 4.0, 6.0],
                [0.0, 90.0, -12.0, 6.2],
                [0.0, 97.0, -27.0, 7.0],
                [0.0, 101.5, -40.0, 8.6],
            ]),
            wing: Tube::new(&[
                [7.0, 99.5, -39.5, 5.0],
                [12.0, 94.0, -42.5, 5.0],
                [14.4, 87.0, -46.6, 4.3],
                [12.5, 82.5, -50.0, 2.4],
            ]),
            upper_lip: Tube::new(&[
                [0.0, 91.2, -68.8, 4.2],
                [5.0, 91.0, -67.6, 4.5],
                [13.0, 87.0, -69.2, 3.9],
                [20.0, 81.0, -71.6, 2.6],
                [25.0, 75.0, -72.6, 1.4],
            ]),
            lower_lip: Tube::new(&[
                [0.0, 88.6, -78.0, 5.2],
                [8.0, 87.6, -77.6, 5.0],
                [16.0, 83.0, -76.0, 3.8],
                [24.0, 75.5, -73.0, 1.4],
            ]),
            mouth: Tube::new(&[
                [0.0, 96.0, -73.6, 0.9],
                [4.0, 95.6, -73.0, 0.9],
                [12.0, 91.2, -73.4, 0.9],
                [20.0, 84.0, -73.2, 0.9],
                [26.2, 77.0, -72.8, 1.1],
            ]),
            philtrum: Tube::new(&[[0.0, 97.5, -53.0, 1.6], [0.0, 98.6, -60.0, 2.2], [0.0, 99.8, -65.5, 2.8]]),
            fold: Tube::new(&[[18.0, 92.0, -43.0, 1.6], [24.0, 88.0, -56.0, 2.0], [31.0, 81.0, -70.0, 1.6]]),
            crease: Tube::new(&[
                [17.5, 82.0, 3.0, 0.7],
                [23.0, 82.0, 8.0, 0.9],
                [32.0, 80.0, 9.8, 1.0],
                [40.0, 75.0, 8.4, 0.9],
                [47.0, 66.0, 3.0, 0.7],
            ]),
        }
    }

    /// The face on a head; x is not negative.
    pub fn on(&self, p: Vec3, head: f32) -> f32 {
        if p.y < 20.0 || p.z > 60.0 || p.z < -125.0 || p.x > 75.0 {
            return head;
        }
        let d = self.eyes(p, self.brow_and_sockets(p, head));
        self.mouth(p, self.nose(p, d))
    }

    fn brow_and_sockets(&self, p: Vec3, head: f32) -> f32 {
        let mut d = head;
        let tilted = turned(p, [33.0, 86.0, 0.0], 1, -8.0);
        d = carve(d, ellipsoid(tilted, [33.5, 88.0, 1.0], [20.0, 16.5, 13.5]), 15.0);
        d = carve(d, ellipsoid(p, [15.0, 89.0, -1.0], [7.0, 12.0, 8.0]), 8.0);
        join(d, self.brow.distance(p, d + 18.0), 18.0)
    }

    /// Lids around the eyeball, and the slit between them.
    fn eyes(&self, p: Vec3, d: f32) -> f32 {
        let eye = Vec3::from_array(EYE);
        if p.distance(eye) > 40.0 {
            return d;
        }
        let q = p - eye;
        let ball = q.length() - EYEBALL;
        let mut d = join(d, ball - 2.0, 7.0);
        d = carve(d, self.crease.distance(p, -d + 3.0), 3.0);
        d = carve(d, slit(q), 1.2);
        // The eyeball is behind the lids, and the corner of the eye before it.
        d = carve(d, ball - 0.05, 0.4);
        let cornea = q.distance(Vec3::new(0.0, CORNEA[0], 0.0)) - CORNEA[1];
        d = carve(d, cornea - 0.05, 0.4);
        join(d, ellipsoid(q, [-12.2, 5.2, -1.4], [2.2, 2.6, 2.2]), 1.2)
    }

    fn nose(&self, p: Vec3, head: f32) -> f32 {
        if p.y < 60.0 || p.z < -66.0 || p.x > 36.0 {
            return head;
        }
        let mut d = head;
        // The sides from the bridge down to the cheeks.
        let tilted = turned(p, [0.0, 84.0, -20.0], 0, -24.0);
        d = join(d, ellipsoid(tilted, [0.0, 80.0, -26.0], [14.0, 14.0, 30.0]), 10.0);
        let mut nose = self.bridge.distance(p, f32::INFINITY);
        nose = join(nose, ellipsoid(p, [3.6, 103.0, -41.5], [6.0, 6.5, 6.6]), 5.0);
        nose = join(nose, self.wing.distance(p, nose + 5.0), 5.0);
        // The bridge between the nostrils.
        nose = join(nose, ellipsoid(p, [0.0, 95.0, -49.5], [4.2, 11.0, 4.2]), 5.0);
        d = join(d, nose, 8.0);
        let way = turned(p, [7.4, 93.0, -50.0], 2, 18.0);
        carve(d, ellipsoid(way, [7.2, 93.0, -51.5], [2.5, 5.6, 4.6]), 2.0)
    }

    fn mouth(&self, p: Vec3, head: f32) -> f32 {
        if p.y < 60.0 || p.z > -36.0 || p.x > 45.0 {
            return head;
        }
        let mut d = carve(head, self.fold.distance(p, -head + 7.0), 7.0);
        d = carve(d, self.philtrum.distance(p, -d + 4.5), 4.5);
        let lips =
            join(self.upper_lip.distance(p, f32::INFINITY), self.lower_lip.distance(p, f32::INFINITY), 1.0);
        d = join(d, lips, 6.0);
        carve(d, self.mouth.distance(p, -d + 2.6), 2.6)
    }
}

/// The distance to the slit between the lids, from the middle of the eye.
fn slit(q: Vec3) -> f32 {
    if q.y < 0.0 {
        return 20.0;
    }
    let [lower, upper] = lids(q.x);
    // Heights over slopes are about distances.
    -0.8 * join(upper - q.z, q.z - lower, 1.0)
}

/// The heights of the lower and the upper lid at a distance from the middle of the eye, away from
/// the nose.
pub fn lids(x: f32) -> [f32; 2] {
    let arc = |height: f32, top: f32| {
        const HALF: f32 = 13.2;
        let t = (x - top) / if x < top { HALF + top } else { HALF - top };
        height * (1.0 - t * t)
    };
    // The outer corner is a little higher, and the upper lid highest towards the nose.
    let axis = 0.07 * x - 0.6;
    [axis - arc(4.6, 1.5), axis + arc(5.4, -1.5)]
}
