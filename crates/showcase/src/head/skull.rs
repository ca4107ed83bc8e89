//! The large forms: skull, jaw, neck and shoulders.

use math::Vec3;

use super::blend::{Tube, carve, ellipsoid, join, turned};

/// What is drawn as tubes.
pub struct Skull {
    jaw: Tube,
    cheekbone: Tube,
    nodder: Tube,
    trapezius: Tube,
    collarbone: Tube,
    shoulder: Tube,
}

impl Skull {
    pub fn new() -> Self {
        Self {
            jaw: Tube::new(&[
                [58.0, -4.0, -20.0, 9.0],
                [53.0, 0.0, -52.0, 9.5],
                [43.0, 16.0, -79.0, 10.0],
                [28.0, 48.0, -96.0, 10.0],
                [13.0, 70.0, -104.5, 9.5],
                [0.0, 76.0, -106.0, 9.5],
            ]),
            cheekbone: Tube::new(&[
                [30.0, 71.0, -26.0, 8.0],
                [43.0, 63.0, -21.0, 9.5],
                [55.0, 44.0, -15.0, 8.5],
                [62.0, 10.0, -10.0, 6.5],
            ]),
            nodder: Tube::new(&[
                [55.0, -26.0, -40.0, 9.0],
                [45.0, -10.0, -100.0, 10.0],
                [29.0, 8.0, -155.0, 9.5],
                [11.0, 20.0, -205.0, 7.0],
            ]),
            trapezius: Tube::new(&[
                [14.0, -72.0, -20.0, 14.0],
                [24.0, -60.0, -90.0, 22.0],
                [52.0, -58.0, -156.0, 26.0],
                [110.0, -50.0, -204.0, 24.0],
                [178.0, -40.0, -232.0, 18.0],
            ]),
            collarbone: Tube::new(&[
                [14.0, 19.0, -210.0, 8.5],
                [50.0, 20.0, -206.0, 7.0],
                [95.0, 6.0, -204.0, 6.0],
                [150.0, -24.0, -210.0, 7.0],
            ]),
            shoulder: Tube::new(&[
                [90.0, -34.0, -258.0, 46.0],
                [150.0, -40.0, -258.0, 44.0],
                [184.0, -40.0, -276.0, 40.0],
            ]),
        }
    }

    /// The head without face and ears; x is not negative.
    pub fn head(&self, p: Vec3) -> f32 {
        let back = ellipsoid(p, [0.0, -32.0, 42.0], [74.0, 73.0, 73.0]);
        let front = ellipsoid(p, [0.0, 20.0, 40.0], [60.0, 67.0, 68.0]);
        let mut d = join(back, front, 45.0);
        // The back of the skull goes down to the neck.
        d = join(d, ellipsoid(p, [0.0, -40.0, -6.0], [56.0, 56.0, 46.0]), 40.0);
        // The face from the brow to the chin, narrower below.
        let tilted = turned(p, [0.0, 30.0, -30.0], 0, -6.0);
        d = join(d, ellipsoid(tilted, [0.0, 28.0, -26.0], [58.0, 54.0, 78.0]), 30.0);
        d = join(d, ellipsoid(p, [0.0, 50.0, -62.0], [34.0, 37.0, 36.0]), 24.0);
        d = join(d, self.cheekbone.distance(p, d + 26.0), 26.0);
        d = join(d, self.jaw.distance(p, d + 30.0), 30.0);
        d = join(d, ellipsoid(p, [0.0, 76.5, -102.0], [13.0, 13.0, 12.0]), 16.0);
        // The floor of the mouth, and the cheeks.
        d = join(d, ellipsoid(p, [0.0, 36.0, -90.0], [38.0, 38.0, 18.0]), 24.0);
        d = join(d, ellipsoid(p, [37.0, 52.0, -50.0], [22.0, 22.0, 27.0]), 28.0);
        carve(d, ellipsoid(p, [84.0, 46.0, 26.0], [16.0, 32.0, 28.0]), 20.0)
    }

    /// Neck and shoulders.
    pub fn bust(&self, p: Vec3) -> f32 {
        let column = |a: Vec3, b: Vec3, from: f32, to: f32| {
            let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            p.distance(a.lerp(b, t)) - math::lerp(t, from, to)
        };
        let mut d = column(Vec3::new(0.0, -16.0, -60.0), Vec3::new(0.0, -32.0, -215.0), 46.0, 51.0);
        d = join(d, self.nodder.distance(p, d + 18.0), 18.0);
        d = join(d, ellipsoid(p, [0.0, 22.0, -150.0], [11.0, 10.0, 20.0]), 14.0);
        let mut low = ellipsoid(p, [0.0, -36.0, -300.0], [150.0, 76.0, 104.0]);
        low = join(low, self.shoulder.distance(p, low + 30.0), 30.0);
        low = join(low, self.trapezius.distance(p, low + 24.0), 24.0);
        d = join(d, low, 28.0);
        d = join(d, self.collarbone.distance(p, d + 12.0), 12.0);
        // The pit between the collarbones.
        carve(d, ellipsoid(p, [0.0, 32.0, -203.0], [9.0, 10.0, 10.0]), 12.0)
    }
}
