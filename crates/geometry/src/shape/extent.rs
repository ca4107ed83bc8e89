//! Axis-aligned boxes with sides that may be at infinity, and clipping of rays to them.

use math::DVec3;

/// A crossing of a ray and the boundary of a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crossing {
    pub t: f64,
    /// The face, numbered over a whole solid.
    pub face: u32,
}

/// The part of a ray between two crossings, which are in order.
pub(crate) type Span = [Crossing; 2];

/// A box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extent {
    pub min: DVec3,
    pub max: DVec3,
}

impl Extent {
    /// The part of a span that is inside. The faces are numbered from `first`: the lower and the
    /// upper one across x, across y, across z.
    pub fn clip(&self, o: DVec3, d: DVec3, [mut enter, mut leave]: Span, first: u32) -> Option<Span> {
        for axis in 0..3 {
            if d[axis] == 0.0 {
                if o[axis] < self.min[axis] || o[axis] > self.max[axis] {
                    return None;
                }
                continue;
            }
            let face = first + 2 * axis as u32;
            let low = Crossing { t: (self.min[axis] - o[axis]) / d[axis], face };
            let high = Crossing { t: (self.max[axis] - o[axis]) / d[axis], face: face + 1 };
            let (near, far) = if d[axis] > 0.0 { (low, high) } else { (high, low) };
            if near.t > enter.t {
                enter = near;
            }
            if far.t < leave.t {
                leave = far;
            }
        }
        (enter.t < leave.t).then_some([enter, leave])
    }

    /// The centre; some point inside where there is none.
    pub fn center(&self) -> DVec3 {
        let middle = |min: f64, max: f64| match (min.is_finite(), max.is_finite()) {
            (true, true) => 0.5 * (min + max),
            (true, false) => min + 1.0,
            (false, true) => max - 1.0,
            (false, false) => 0.0,
        };
        DVec3::new(
            middle(self.min.x, self.max.x),
            middle(self.min.y, self.max.y),
            middle(self.min.z, self.max.z),
        )
    }
}
