//! Lookups in the finest level of an image by the parameters (u, v) of a surface: of emission and
//! of normal maps, which are not averaged over footprints.

use description::UvImageDesc;
use image::{Image, WrapMode};
use lanes::Real;
use math::{Point2, Vec2};

/// How an image is looked up at (u, v).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UvLookup {
    /// The factors on u, v and 1; (0, 0) is the lower left of the image.
    pub columns: [Vec2; 3],
    /// Value outside of the image.
    pub wrap: WrapMode,
    /// Whether it is the nearest texel, not an interpolation of four.
    pub is_nearest: bool,
}

impl UvLookup {
    /// The lookup of an image that is interpolated where (u, v) are.
    pub fn at_uv(wrap: WrapMode) -> Self {
        Self { columns: [Vec2::X, Vec2::Y, Vec2::ZERO], wrap, is_nearest: false }
    }

    /// The lookup that a description asks for.
    pub fn new(desc: &UvImageDesc) -> Self {
        let columns = desc.columns.map(Vec2::from_array);
        Self { columns, wrap: wrap_mode(desc.wrap), is_nearest: desc.is_nearest }
    }

    /// The colour of an image at (u, v).
    #[inline(always)]
    pub fn rgb<R: Real>(&self, image: &Image, uv: Point2<R>) -> [R; 3] {
        let [u, v, one] = self.columns;
        let at = |u: f32, v: f32, one: f32| R::splat(u) * uv.x + R::splat(v) * uv.y + R::splat(one);
        let st = Vec2::new(at(u.x, v.x, one.x), R::one() - at(u.y, v.y, one.y));
        match self.is_nearest {
            true => image.nearest_rgb(st, self.wrap),
            false => image.bilerp_rgb(st, self.wrap),
        }
    }
}

/// The wrap mode of a description.
pub(super) fn wrap_mode(wrap: description::WrapMode) -> WrapMode {
    match wrap {
        description::WrapMode::Repeat => WrapMode::Repeat,
        description::WrapMode::Black => WrapMode::Black,
        description::WrapMode::Clamp => WrapMode::Clamp,
        description::WrapMode::OctahedralSphere => WrapMode::OctahedralSphere,
        description::WrapMode::Axes(axes) => WrapMode::Axes(axes),
    }
}
