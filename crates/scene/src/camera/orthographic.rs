//! The orthographic camera: all rays are parallel to the viewing axis, so that objects have the
//! same size at any distance.
//!
//! The film position at screen point (x, y) sees along the ray (x, y, 0) + t·(0, 0, 1) of camera
//! space. With a thin lens, all rays leave the lens about the origin towards (x, y, focal
//! distance), as in pbrt-v4: such a picture is a perspective one, and the screen window lies on the
//! focal plane ([Pharr 2023 §5.2.1, §5.2.3]).

use super::{Screen, ThinLens};
use lanes::Real;
use math::{Bounds2, Point2, Point3, Vec2, Vec3, Vector3};

/// Parallel rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orthographic {
    screen: Screen,
    lens: ThinLens,
}

impl Orthographic {
    /// The view of the screen `window`, in units of camera space, on `resolution` pixels.
    pub fn new(window: Bounds2, lens: ThinLens, resolution: [u32; 2]) -> Self {
        Self { screen: Screen::new(window, resolution), lens }
    }

    /// Whether there is no lens, so that all rays are parallel.
    pub(super) fn is_parallel(&self) -> bool {
        self.lens.radius <= 0.0
    }

    /// Origin and unit direction, in camera space.
    #[inline(always)]
    pub(super) fn ray<R: Real>(&self, film: Point2<R>, lens: Vec2<R>) -> (Point3<R>, Vector3<R>) {
        let Vec2 { x, y } = self.screen.at(film);
        self.lens.refract(Vec3::new(x, y, R::zero()), Vec3::broadcast(Vec3::Z), lens)
    }

    /// The same view in pixels `n` times as wide and high.
    pub(super) fn coarser(&self, n: u32) -> Self {
        Self { screen: self.screen.coarser(n), ..*self }
    }

    /// The screen on the plane z = 0.
    pub fn screen(&self) -> &Screen {
        &self.screen
    }

    /// The lens.
    pub fn lens(&self) -> ThinLens {
        self.lens
    }

    /// The inverse of [`Self::ray`] from the ray's point on the lens, and film area per solid
    /// angle: a pixel of the area A on the focal plane z = f subtends A·cos³θ/f² at the angle θ.
    /// For parallel rays film area per area, 1/A.
    #[inline]
    pub(super) fn film(&self, o: Point3, d: Vector3) -> Option<(Point2, f32)> {
        let per_area = 1.0 / self.screen.pixel_area();
        (d.z > 0.0).then(|| {
            if self.is_parallel() {
                return (self.screen.film(o.truncate()), per_area);
            }
            let focus = self.lens.focus(o, d);
            (self.screen.film(focus.truncate()), per_area * focus.z * focus.z / d.z.powi(3))
        })
    }
}
