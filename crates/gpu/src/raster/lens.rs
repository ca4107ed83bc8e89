//! Cameras as the matrices of the raster pipeline.
//!
//! Depth is 1 at the near plane and 0 at infinity, which spends the precision of floats where it is
//! needed.

use math::{Bounds2i, DMat4, DVec3, DVec4, Vec3};
use scene::View;
use scene::camera::Projection;

/// A camera that sees all through one point.
#[derive(Clone, Copy, Debug)]
pub struct Lens {
    /// From render space to clip space.
    pub clip_from_render: DMat4,
    /// The point.
    pub eye: Vec3,
    /// Pixels of a unit of length that faces the camera at distance 1.
    pub scale: f32,
    /// The plane of the mirror, behind which nothing is drawn; zero where there is none.
    pub cut: [f32; 4],
}

impl Lens {
    /// The camera of a view while its shutter is half open, for pictures of these pixels, without
    /// what is nearer than `near`. `None` unless it is a perspective one.
    pub fn new(view: &View, bounds: Bounds2i, near: f32) -> Option<Self> {
        let Projection::Perspective(perspective) = view.camera.projection() else { return None };
        let screen = perspective.screen();
        let render_from_camera =
            view.camera.transform().render_from_camera(view.camera.sample_time(0.5)).matrix().as_dmat4();
        // ndc = z·(a·(x/z) + b) along each axis, where film coordinates grow downwards.
        let along = |axis: usize, turn: f64| {
            let (size, first) = ([bounds.width(), bounds.height()][axis], bounds.min[axis]);
            let (origin, pixel) = (f64::from(screen.top_left[axis]), f64::from(screen.per_pixel[axis]));
            let factor = 2.0 * turn / f64::from(size);
            (factor / pixel, -factor * (origin / pixel + f64::from(first)) - turn)
        };
        let ((ax, bx), (ay, by)) = (along(0, 1.0), along(1, -1.0));
        let clip_from_camera = DMat4::from_cols(
            DVec4::new(ax, 0.0, 0.0, 0.0),
            DVec4::new(0.0, ay, 0.0, 0.0),
            DVec4::new(bx, by, 0.0, 1.0),
            DVec4::new(0.0, 0.0, f64::from(near), 0.0),
        );
        Some(Self {
            clip_from_render: clip_from_camera * render_from_camera.inverse(),
            eye: render_from_camera.transform_point3(DVec3::ZERO).as_vec3().into(),
            scale: 1.0 / screen.per_pixel.y.abs(),
            cut: [0.0; 4],
        })
    }

    /// The same camera in the mirror of a plane, n·p + w = 0.
    pub fn mirrored(&self, plane: [f32; 4]) -> Self {
        let [nx, ny, nz, w] = plane;
        let n = Vec3::new(nx, ny, nz);
        let wide = n.as_dvec3();
        let column = |v: DVec3| (v - 2.0 * wide.dot(v) * wide).extend(0.0);
        let mirror = DMat4::from_cols(
            column(DVec3::X),
            column(DVec3::Y),
            column(DVec3::Z),
            (-2.0 * f64::from(w) * wide).extend(1.0),
        );
        Self {
            clip_from_render: self.clip_from_render * mirror,
            eye: self.eye - n * (2.0 * (n.dot(self.eye) + w)),
            scale: self.scale,
            cut: plane,
        }
    }

    /// Whether a ball may be seen.
    pub fn sees(&self, center: Vec3, radius: f32) -> bool {
        let [nx, ny, nz, shift] = self.cut;
        if Vec3::new(nx, ny, nz).dot(center) + shift < -radius {
            return false;
        }
        let m = self.clip_from_render;
        let (w, p) = (m.row(3), center.as_dvec3().extend(1.0));
        // The planes of the picture's edges, and that of the eye.
        let planes = [w + m.row(0), w - m.row(0), w + m.row(1), w - m.row(1), w];
        planes.iter().all(|plane| plane.dot(p) >= -f64::from(radius) * plane.truncate().length())
    }

    /// The pixels across a ball as it is seen.
    pub fn pixels_across(&self, center: Vec3, radius: f32) -> f32 {
        let distance = (center - self.eye).length();
        2.0 * radius * self.scale / (distance - radius).max(f32::MIN_POSITIVE)
    }
}
