//! The perspective camera: every ray passes through one point, the eye (or through a thin lens
//! around it).
//!
//! The observer. An eye at Eye looks along w, with u to its right and v upwards, all three of unit
//! length and at right angles. At the near distance N along w stands the film: n_c × n_r pixels
//! that fill the rectangle −W ≤ u ≤ W, −H ≤ v ≤ H, where the vertical angle θ of the view and the
//! aspect give
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
//! and is seen along the ray Eye + t·Dir: points with t < 0 lie behind the observer, those with 0 <
//! t < 1 in front of the near plane, and t = 1 is on it.
//!
//! What differs here: (u, v, w) are the axes (x, y, z) of camera space, which pbrt makes
//! left-handed. Film rows are counted downwards, so that the corner above is the film position (c,
//! n_r − r). Dir is normalized, so that t measures distance and N cancels. The field of view is
//! given over the shorter side: it is θ where the picture is at least as wide as high, and tan(θ/2)
//! = tan(fov/2)/aspect where it is not. A screen window other than the default cuts a part out of
//! the same plane.
//!
//! Sources: [Hill & Kelley 2007 ch. 12] for the observer; [Pharr 2023 §5.2.2] for field of view and
//! screen window.

use super::{Screen, ThinLens};
use lanes::Real;
use math::{Bounds2, Point2, Point3, Vec2, Vec3, Vector3};

/// The projection through one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Perspective {
    /// On the plane z = 1.
    screen: Screen,
    lens: ThinLens,
}

impl Perspective {
    /// A view of `fov` degrees over [−1, 1] of the screen, whose part `window` is mapped to
    /// `resolution` pixels.
    pub fn new(fov: f32, window: Bounds2, lens: ThinLens, resolution: [u32; 2]) -> Self {
        let tan_half = libm::tan(f64::from(fov).to_radians() * 0.5) as f32;
        let window = Bounds2 { min: window.min * tan_half, max: window.max * tan_half };
        Self { screen: Screen::new(window, resolution), lens }
    }

    /// Origin and unit direction, in camera space.
    #[inline(always)]
    pub(super) fn ray<R: Real>(&self, film: Point2<R>, lens: Vec2<R>) -> (Point3<R>, Vector3<R>) {
        let Vec2 { x, y } = self.screen.at(film);
        self.lens.refract(Vec3::splat(R::zero()), Vec3::new(x, y, R::one()), lens)
    }

    /// The same view in pixels `n` times as wide and high.
    pub(super) fn coarser(&self, n: u32) -> Self {
        Self { screen: self.screen.coarser(n), ..*self }
    }

    /// The screen on the plane z = 1.
    pub fn screen(&self) -> &Screen {
        &self.screen
    }

    /// The lens.
    pub fn lens(&self) -> ThinLens {
        self.lens
    }

    /// The inverse of [`Self::ray`] from the ray's point on the lens, and film area per solid
    /// angle: a pixel of the area A at z = 1 subtends A·cos³θ at the angle θ.
    #[inline]
    pub(super) fn film(&self, o: Point3, d: Vector3) -> Option<(Point2, f32)> {
        (d.z > 0.0).then(|| {
            let focus = self.lens.focus(o, d);
            (self.screen.film(focus.truncate() / focus.z), 1.0 / (self.screen.pixel_area() * d.z.powi(3)))
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::camera::{Camera, CameraSample, CameraTransform, Projection, Screen};
    use description::{LensDesc, ScreenDesc, TransformDesc};
    use math::{DMat4, DVec3, Vec2};

    /// The observer's formulas, as they stand at the head of this file.
    #[test]
    fn pixel_corners_follow_the_observer_model() {
        let eye = DVec3::new(3.0, -1.5, 7.0);
        let w = DVec3::new(0.48, -0.6, 0.64);
        let u = w.cross(DVec3::new(0.2, 1.0, -0.3)).normalize();
        let v = u.cross(w);
        let frame = DMat4::from_cols(u.extend(0.0), v.extend(0.0), w.extend(0.0), eye.extend(1.0));
        for (resolution, fov) in [([64u32, 48u32], 50.0f64), ([30, 90], 35.0), ([8, 8], 120.0)] {
            let [n_c, n_r] = resolution.map(f64::from);
            let aspect = n_c / n_r;
            // The field of view is that of the shorter side, θ is vertical.
            let tan_half = (fov / 2.0).to_radians().tan();
            let theta = 2.0 * if aspect >= 1.0 { tan_half } else { tan_half / aspect }.atan();
            let window = Screen::window(&ScreenDesc::default(), resolution);
            let projection =
                super::Perspective::new(fov as f32, window, LensDesc::default().into(), resolution);
            let place = TransformDesc::fixed(frame).inverse();
            let transform = CameraTransform::new(&place, DMat4::IDENTITY).unwrap();
            let camera = Camera::new(Projection::Perspective(projection), transform, [0.0, 1.0], resolution);

            let near = 0.37;
            let (h, aspect) = (near * (theta / 2.0).tan(), aspect);
            let width = h * aspect;
            for (c, r) in [(0.0, 0.0), (n_c, n_r), (3.0, 5.0), (n_c / 2.0, n_r / 2.0), (1.0, n_r - 1.0)] {
                let u_c = -width + width * 2.0 * c / n_c;
                let v_r = -h + h * 2.0 * r / n_r;
                let dir = near * w + u_c * u + v_r * v;

                let film = Vec2::new(c as f32, (n_r - r) as f32);
                let sample = CameraSample { film, lens: Vec2::ZERO, time: 0.5, filter_weight: 1.0 };
                let ray = camera.generate_ray(&sample).unwrap().ray;
                assert!((ray.o.as_dvec3() - eye).length() < 1e-6);
                assert!((ray.d.as_dvec3() - dir.normalize()).length() < 1e-6, "{resolution:?} ({c}, {r})");
                // t = 1 of the unnormalized ray is on the near plane, 0 < t < 1 in front of it, t <
                // 0 behind the eye.
                let t = dir.length();
                for (t, depth) in [(t, near), (0.5 * t, 0.5 * near), (-t, -near)] {
                    let ahead = (ray.at(t as f32).as_dvec3() - eye).dot(w);
                    assert!((ahead - depth).abs() < 1e-5);
                }
            }
        }
    }
}
