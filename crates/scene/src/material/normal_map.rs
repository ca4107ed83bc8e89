//! Normals from an image in tangent space: red, green and blue in [0, 1] encode x, y and z in [−1,
//! 1].
//!
//! The shading frame is rotated to the new normal; its tangents keep their lengths. Sources: [Pharr
//! 2023 §10.5.2].

use crate::texture::UvLookup;
use geometry::{Shading, SurfacePoint};
use image::Image;
use lanes::Real;
use math::{Frame, Point2, Vec3, Vector3, face_forward};
use std::sync::Arc;

/// A tangent-space normal map.
#[derive(Clone, Debug)]
pub struct NormalMap {
    /// The image, in linear encoding.
    pub image: Arc<Image>,
    /// Where it is looked up.
    pub lookup: UvLookup,
}

impl NormalMap {
    /// The normal at (u, v), in the frame of the surface.
    #[inline(always)]
    pub fn normal<R: Real>(&self, uv: Point2<R>) -> Vector3<R> {
        let (one, two) = (R::one(), R::splat(2.0));
        let [r, g, b] = self.lookup.rgb(&self.image, uv);
        let (n, is_regular) = Vec3::new(two * r - one, two * g - one, two * b - one).normalize_masked();
        Vec3::select(is_regular, n, Vec3::broadcast(Vec3::Z))
    }

    /// The shading frame at (u, v), rotated to the normal of the map.
    #[inline(always)]
    pub fn rotate<R: Real>(&self, frame: &Frame<R>, uv: Point2<R>) -> Frame<R> {
        Frame::from_z_and_x(frame.from_local(self.normal(uv)), frame.x)
    }

    /// The shading geometry at a point, with the normal of the map.
    pub fn perturb(&self, s: &SurfacePoint) -> Shading {
        let Shading { n, dpdu, dpdv, .. } = s.shading;
        let frame = self.rotate(&Frame::from_z_and_x(n, dpdu), s.uv);
        let (dpdu, dpdv) = (frame.x * dpdu.length(), frame.y * dpdv.length());
        Shading { n: face_forward(frame.z, s.n), dpdu, dpdv, ..s.shading }
    }
}
