//! The flat screen and the thin lens that perspective and orthographic cameras share.
//!
//! The screen is a rectangle of the plane z = 1 (perspective, scaled by the field of view) or z = 0
//! (orthographic), which spans [−1, 1] over its shorter side unless a window is given. A thin lens
//! of radius r at the origin sends every ray that a pinhole would send through p_focus, its point
//! on the plane z = focal distance, through that same point from another point of the lens: points
//! on the plane are in focus ([Pharr 2023 §5.2.3]).

use description::{LensDesc, ScreenDesc};
use lanes::Real;
use math::{Bounds2, Point2, Point3, Vec2, Vec3, Vector3};
use sampling::warp::sample_uniform_disk_concentric;
use std::f32::consts::PI;

/// The mapping from film positions to positions on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Screen {
    /// The point of the screen at film position (0, 0).
    pub top_left: Vec2,
    /// The size of a pixel on the screen; downwards is negative.
    pub per_pixel: Vec2,
}

impl Screen {
    /// The screen `window` (y up), filled by `resolution` pixels (width, height).
    pub fn new(window: Bounds2, resolution: [u32; 2]) -> Self {
        let size = window.diagonal();
        Self {
            top_left: Vec2::new(window.min.x, window.max.y),
            per_pixel: Vec2::new(size.x / resolution[0] as f32, -size.y / resolution[1] as f32),
        }
    }

    /// The same screen, filled by pixels `n` times as wide and high.
    pub fn coarser(&self, n: u32) -> Self {
        Self { per_pixel: self.per_pixel * n as f32, ..*self }
    }

    /// The part of the screen plane that a picture of `resolution` pixels shows.
    pub fn window(desc: &ScreenDesc, resolution: [u32; 2]) -> Bounds2 {
        if let Some([x0, x1, y0, y1]) = desc.window {
            return Bounds2 { min: Vec2::new(x0, y0), max: Vec2::new(x1, y1) };
        }
        let aspect = desc.frame_aspect_ratio.unwrap_or(resolution[0] as f32 / resolution[1] as f32);
        let half = if aspect > 1.0 { Vec2::new(aspect, 1.0) } else { Vec2::new(1.0, 1.0 / aspect) };
        Bounds2 { min: -half, max: half }
    }

    /// The point of the screen at a film position in pixels.
    #[inline(always)]
    pub fn at<R: Real>(&self, film: Point2<R>) -> Vec2<R> {
        Vec2::broadcast(self.top_left) + film * Vec2::broadcast(self.per_pixel)
    }

    /// The film position in pixels of a point of the screen: the inverse of [`Self::at`].
    #[inline]
    pub fn film(&self, p: Vec2) -> Point2 {
        (p - self.top_left) / self.per_pixel
    }

    /// The area of a pixel on the screen.
    #[inline]
    pub fn pixel_area(&self) -> f32 {
        (self.per_pixel.x * self.per_pixel.y).abs()
    }
}

/// A lens without thickness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinLens {
    /// Radius; 0 is a pinhole.
    pub radius: f32,
    /// Distance along z to the plane of focus.
    pub focal_distance: f32,
}

impl From<LensDesc> for ThinLens {
    fn from(desc: LensDesc) -> Self {
        Self { radius: desc.radius, focal_distance: desc.focal_distance }
    }
}

impl ThinLens {
    /// Refracts the pinhole ray (`o`, `d`) at the point of the lens that `u` in [0, 1)² selects.
    #[inline(always)]
    pub fn refract<R: Real>(&self, o: Point3<R>, d: Vector3<R>, u: Vec2<R>) -> (Point3<R>, Vector3<R>) {
        if self.radius <= 0.0 {
            return (o, d.normalize());
        }
        let focus = o + d * (R::splat(self.focal_distance) / d.z);
        let on_lens = self.at(u);
        (on_lens, (focus - on_lens).normalize())
    }

    /// The point of the lens that `u` in [0, 1)² selects.
    #[inline(always)]
    pub fn at<R: Real>(&self, u: Vec2<R>) -> Point3<R> {
        let p = sample_uniform_disk_concentric(u) * R::splat(self.radius.max(0.0));
        Vec3::new(p.x, p.y, R::zero())
    }

    /// The area; `None` for a pinhole.
    #[inline]
    pub fn area(&self) -> Option<f32> {
        (self.radius > 0.0).then_some(PI * self.radius * self.radius)
    }

    /// The intersection of a ray from the lens with the plane of focus; for a pinhole that is z =
    /// 1.
    #[inline]
    pub fn focus(&self, o: Point3, d: Vector3) -> Point3 {
        if self.radius <= 0.0 {
            return d / d.z;
        }
        (o + d * (self.focal_distance / d.z)).truncate().extend(self.focal_distance)
    }
}
