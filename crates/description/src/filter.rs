//! Pixel reconstruction filters.

use crate::schema::{above, settings};

settings! {
    /// A filter.
    #[derive(Clone, Debug, PartialEq)]
    pub enum FilterDesc = Gaussian {
        /// Constant.
        Box = "box" {
            /// Half of the filter's width or height.
            radius: [f32; 2] = [0.5, 0.5] => [
                "xradius"[0] | "filterradius": above(0.0).unit("pixels"),
                "yradius"[1] | "filterradius": above(0.0).unit("pixels")
            ];
        },
        /// Linear to zero at the edge.
        Triangle = "triangle" {
            /// Half of the filter's width or height.
            radius: [f32; 2] = [2.0, 2.0] => [
                "xradius"[0] | "filterradius": above(0.0).unit("pixels"),
                "yradius"[1] | "filterradius": above(0.0).unit("pixels")
            ];
        },
        /// A Gaussian, lowered to zero at the edge.
        Gaussian = "gaussian" {
            /// Half of the filter's width or height.
            radius: [f32; 2] = [1.5, 1.5] => [
                "xradius"[0] | "filterradius": above(0.0).unit("pixels"),
                "yradius"[1] | "filterradius": above(0.0).unit("pixels")
            ];
            /// Standard deviation.
            sigma: f32 = 0.5 => ["sigma": above(0.0).unit("pixels")];
        },
        /// The family of piecewise cubics of Mitchell and Netravali.
        Mitchell = "mitchell" {
            /// Half of the filter's width or height.
            radius: [f32; 2] = [2.0, 2.0] => [
                "xradius"[0] | "filterradius": above(0.0).unit("pixels"),
                "yradius"[1] | "filterradius": above(0.0).unit("pixels")
            ];
            /// Parameter B of the family.
            b: f32 = 1.0 / 3.0 => ["B"];
            /// Parameter C of the family.
            c: f32 = 1.0 / 3.0 => ["C"];
        },
        /// A windowed sinc.
        LanczosSinc = "sinc" {
            /// Half of the filter's width or height.
            radius: [f32; 2] = [4.0, 4.0] => [
                "xradius"[0] | "filterradius": above(0.0).unit("pixels"),
                "yradius"[1] | "filterradius": above(0.0).unit("pixels")
            ];
            /// Cycles of the sinc under the window.
            tau: f32 = 3.0 => ["tau": above(0.0)];
        },
    }
}
