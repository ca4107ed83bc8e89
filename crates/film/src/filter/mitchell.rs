//! The piecewise cubics of [Mitchell 1988], scaled so that they end at the radius. They sharpen by
//! negative lobes. Good values of the two parameters lie on the line B + 2C = 1.

use math::Vec2;

/// A filter of Mitchell and Netravali's family.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MitchellFilter {
    /// Half width and half height in pixels.
    pub radius: Vec2,
    /// Their B: blur.
    pub b: f32,
    /// Their C: ringing.
    pub c: f32,
}

impl MitchellFilter {
    pub(super) fn evaluate(&self, p: Vec2) -> f32 {
        let t = 2.0 * p / self.radius;
        self.cubic(t.x.abs()) * self.cubic(t.y.abs())
    }

    /// The cubics on [0, 1] and [1, 2].
    fn cubic(&self, x: f32) -> f32 {
        let (b, c) = (self.b, self.c);
        let polynomial = |c3: f32, c2: f32, c1: f32, c0: f32| (((c3 * x + c2) * x + c1) * x + c0) / 6.0;
        if x <= 1.0 {
            polynomial(12.0 - 9.0 * b - 6.0 * c, -18.0 + 12.0 * b + 6.0 * c, 0.0, 6.0 - 2.0 * b)
        } else if x <= 2.0 {
            polynomial(-b - 6.0 * c, 6.0 * b + 30.0 * c, -12.0 * b - 48.0 * c, 8.0 * b + 24.0 * c)
        } else {
            0.0
        }
    }

    /// Along each axis the cubics integrate to r/2, whatever B and C.
    pub(super) fn integral(&self) -> f32 {
        self.radius.element_product() / 4.0
    }
}
