//! The perspective camera: every ray passes through one point, the eye (or through a thin lens around it).
//!
//! The observer. An eye at Eye looks along w, with u to its right and v upwards, all three of unit length and at right
//! angles. At the near distance N along w stands the film: n_c × n_r pixels that fill the rectangle −W ≤ u ≤ W,
//! −H ≤ v ≤ H, where the vertical angle θ of the view and the aspect give
//!
//! ```text
//! H = N·tan(θ/2)        W = H·aspect
//! ```
//!
//! The lower left corner of pixel (c, r), rows counted upwards, lies at
//!
//! ```text
//! u_c = −W + W·2c/n_c        v_r = −H + H·2r/n_r        Dir = N·w + u_c·u + v_r·v
//! ```
//!
//! and is seen along the ray Eye + t·Dir: points with t < 0 lie behind the observer, those with 0 < t < 1 in front of the near
//! plane, and t = 1 is on it.
//!
//! What differs here: (u, v, w) are the axes (x, y, z) of camera space, which pbrt makes left-handed. Film rows are counted
//! downwards, so that the corner above is the film position (c, n_r − r). Dir is normalized, so that t measures distance and N
//! cancels. The field of view is given over the shorter side: it is θ where the picture is at least as wide as high,
//! and tan(θ/2) = tan(fov/2)/aspect where it is not. A screen window other than the default cuts a part out of the same plane.
//!
//! Sources: [Hill 1990 ch. 12] for the observer; [Pharr 2023 §5.2.2] for field of view and screen window.

use super::{Screen, ThinLens};
use math::{Bounds2, Point2, Point3, Vec2, Vec3, Vector3};

/// Rays through one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Perspective {
    /// On the plane z = 1.
    screen: Screen,
    lens: ThinLens,
}

impl Perspective {
    /// A view of `fov` degrees over [−1, 1] of the screen, of which `window` is shown on `resolution` pixels.
    pub fn new(fov: f32, window: Bounds2, lens: ThinLens, resolution: [u32; 2]) -> Self {
        let tan_half = (f64::from(fov).to_radians() * 0.5).tan() as f32;
        let window = Bounds2 { min: window.min * tan_half, max: window.max * tan_half };
        Self { screen: Screen::new(window, resolution), lens }
    }

    /// Origin and unit direction, in camera space.
    #[inline]
    pub(super) fn ray(&self, film: Point2, lens: Vec2) -> (Point3, Vector3) {
        self.lens.refract(Vec3::ZERO, self.screen.at(film).extend(1.0), lens)
    }
}
