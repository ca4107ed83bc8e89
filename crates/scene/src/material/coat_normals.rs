//! The normal of a coat over a surface, each of which has a normal map or follows the mesh.

use super::NormalMap;
use lanes::{MAX_LANES, Mask, Real};
use math::{Frame, Point2, Vec3, Vector3};
use std::sync::Arc;

/// The normal maps of a coat and of the base below it, which differ.
#[derive(Clone, Debug)]
pub struct CoatNormals {
    coat: Option<NormalMap>,
    base: Option<NormalMap>,
}

impl CoatNormals {
    /// `None` if both have the same normals.
    pub fn new(coat: Option<NormalMap>, base: Option<NormalMap>) -> Option<Self> {
        let image = |map: &Option<NormalMap>| map.as_ref().map(|map| (Arc::as_ptr(&map.image), map.lookup));
        (image(&coat) != image(&base)).then_some(Self { coat, base })
    }

    /// The maps of the coat and of the base.
    pub fn maps(&self) -> [Option<&NormalMap>; 2] {
        [self.coat.as_ref(), self.base.as_ref()]
    }

    /// The normals of the coat in the shading frame of the base, where the mask is true; that of
    /// the base where it would be below, and elsewhere.
    #[inline(always)]
    pub fn at<R: Real>(&self, uv: Point2<R>, mask: R::Mask) -> Vector3<R> {
        let [mut x, mut y, mut z] = [[0.0; MAX_LANES], [0.0; MAX_LANES], [1.0; MAX_LANES]];
        let (u, v) = (uv.x.to_array(), uv.y.to_array());
        for lane in 0..R::LANES {
            if mask.bits() >> lane & 1 == 1 {
                let normal = self.normal(Point2::new(u[lane], v[lane]));
                (x[lane], y[lane], z[lane]) = (normal.x, normal.y, normal.z);
            }
        }
        Vec3::new(R::load(&x), R::load(&y), R::load(&z))
    }

    fn normal(&self, uv: Point2) -> Vector3 {
        let [coat, base] =
            [&self.coat, &self.base].map(|map| map.as_ref().map_or(Vec3::Z, |map| map.normal(uv)));
        let normal = Frame::from_z_and_x(base, Vec3::X).to_local(coat);
        if normal.z > 0.0 { normal } else { Vec3::Z }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::UvLookup;
    use image::{Image, WrapMode};

    /// A map of one normal.
    fn map(normal: Vec3) -> Option<NormalMap> {
        let pixel = normal.to_array().map(|v| 0.5 * v + 0.5);
        let image = Image::from_fn(1, 1, ["R", "G", "B"], |_, _| pixel);
        Some(NormalMap { image: Arc::new(image), lookup: UvLookup::at_uv(WrapMode::Repeat) })
    }

    #[test]
    fn a_coat_without_a_map_keeps_the_normal_of_the_mesh() {
        let base = Vec3::new(0.3, 0.4, 0.8).normalize();
        let coat = CoatNormals::new(None, map(base)).unwrap().normal(Point2::ZERO);
        let in_mesh = Frame::from_z_and_x(base, Vec3::X).from_local(coat);
        assert!((in_mesh - Vec3::Z).length() < 1e-6, "{in_mesh}");
    }

    #[test]
    fn a_map_of_the_coat_alone_is_its_normal() {
        let normal = Vec3::new(-0.2, 0.1, 0.9).normalize();
        let coat = CoatNormals::new(map(normal), None).unwrap().normal(Point2::ZERO);
        assert!((coat - normal).length() < 1e-6, "{coat}");
        let both = map(normal);
        assert!(CoatNormals::new(both.clone(), both).is_none());
        assert!(CoatNormals::new(None, None).is_none());
    }
}
