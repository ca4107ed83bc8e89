//! Normals from an image in tangent space: red, green and blue in [0, 1] encode x, y and z in [−1,
//! 1].
//!
//! The shading frame is rotated to the new normal; its tangents keep their lengths. Sources: [Pharr
//! 2023 §10.5.2].

use geometry::{Shading, SurfacePoint};
use image::{Image, WrapMode};
use math::{Frame, Point2, Vec2, Vec3, Vector3, face_forward};
use std::sync::Arc;

/// A tangent-space normal map.
#[derive(Clone, Debug)]
pub struct NormalMap {
    /// The image, in linear encoding; v = 0 is its bottom row.
    pub image: Arc<Image>,
}

impl NormalMap {
    /// The normal at (u, v), in the frame of the surface.
    pub fn normal(&self, uv: Point2) -> Vector3 {
        let st = Vec2::new(uv.x, 1.0 - uv.y);
        let [r, g, b] = self.image.bilerp_rgb(st, WrapMode::Repeat);
        Vec3::new(2.0 * r - 1.0, 2.0 * g - 1.0, 2.0 * b - 1.0).normalize_or(Vec3::Z)
    }

    /// The shading geometry at a point, with the normal of the map.
    pub fn perturb(&self, s: &SurfacePoint) -> Shading {
        let frame = Frame::from_z_and_x(s.shading.n, s.shading.dpdu);
        let ns = frame.from_local(self.normal(s.uv));
        let (u_length, v_length) = (s.shading.dpdu.length(), s.shading.dpdv.length());
        let bent = Frame::from_z_and_x(ns, s.shading.dpdu);
        Shading { n: face_forward(ns, s.n), dpdu: bent.x * u_length, dpdv: bent.y * v_length, ..s.shading }
    }
}
