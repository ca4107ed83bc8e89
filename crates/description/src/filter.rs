//! Pixel reconstruction filters; radii are in pixels.

/// A filter.
#[derive(Clone, Debug, PartialEq)]
pub enum FilterDesc {
    /// Constant.
    Box {
        /// Half width and half height.
        radius: [f32; 2],
    },
    /// Linear to zero at the edge.
    Triangle {
        /// Half width and half height.
        radius: [f32; 2],
    },
    /// A Gaussian, moved down to zero at the edge.
    Gaussian {
        /// Half width and half height.
        radius: [f32; 2],
        /// Standard deviation.
        sigma: f32,
    },
    /// The family of piecewise cubics of Mitchell and Netravali.
    Mitchell {
        /// Half width and half height.
        radius: [f32; 2],
        /// Their B.
        b: f32,
        /// Their C.
        c: f32,
    },
    /// A windowed sinc.
    LanczosSinc {
        /// Half width and half height.
        radius: [f32; 2],
        /// Cycles of the sinc under the window.
        tau: f32,
    },
}

impl Default for FilterDesc {
    fn default() -> Self {
        Self::Gaussian { radius: [1.5, 1.5], sigma: 0.5 }
    }
}
