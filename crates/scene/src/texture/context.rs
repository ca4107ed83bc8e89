//! What textures depend on.

use crate::footprint::Footprint;
use lanes::{MAX_LANES, Real};
use math::{Normal3, Point2, Point3, Vec2, Vec3, Vector3};

/// A point of a surface, and the footprint of a pixel there, for each lane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TextureContext<R = f32> {
    /// The point, in render space.
    pub p: Point3<R>,
    /// Derivative of the point by film x.
    pub dpdx: Vector3<R>,
    /// Derivative of the point by film y.
    pub dpdy: Vector3<R>,
    /// The surface normal, in render space.
    pub n: Normal3<R>,
    /// The surface parameters (u, v).
    pub uv: Point2<R>,
    /// ∂u/∂x.
    pub dudx: R,
    /// ∂u/∂y.
    pub dudy: R,
    /// ∂v/∂x.
    pub dvdx: R,
    /// ∂v/∂y.
    pub dvdy: R,
    /// Index of the mesh face, for textures that are stored by face.
    pub face_index: u32,
}

impl<R: Real> TextureContext<R> {
    /// The context of a point with normal `n` and parameters `uv`.
    #[inline(always)]
    pub fn new(p: Point3<R>, n: Normal3<R>, uv: Point2<R>, footprint: &Footprint<R>) -> Self {
        let Footprint { dpdx, dpdy, dudx, dudy, dvdx, dvdy } = *footprint;
        Self { p, dpdx, dpdy, n, uv, dudx, dudy, dvdx, dvdy, face_index: 0 }
    }

    /// The context of a lane.
    #[inline(always)]
    pub(super) fn lane(&self, lane: usize) -> TextureContext {
        let mut numbers = [0.0; NUMBERS];
        for (one, number) in numbers.iter_mut().zip(self.numbers()) {
            *one = number.lane(lane);
        }
        TextureContext::from_numbers(numbers, self.face_index)
    }

    /// The numbers of the context.
    #[inline(always)]
    fn numbers(&self) -> [R; NUMBERS] {
        let Self { p, dpdx, dpdy, n, uv, dudx, dudy, dvdx, dvdy, face_index: _ } = *self;
        let [p, dpdx, dpdy, n] = [p.to_array(), dpdx.to_array(), dpdy.to_array(), n.to_array()];
        let ([px, py, pz], [xx, xy, xz], [yx, yy, yz], [nx, ny, nz]) = (p, dpdx, dpdy, n);
        [px, py, pz, xx, xy, xz, yx, yy, yz, nx, ny, nz, uv.x, uv.y, dudx, dudy, dvdx, dvdy]
    }

    #[inline(always)]
    fn from_numbers(numbers: [R; NUMBERS], face_index: u32) -> Self {
        let [px, py, pz, xx, xy, xz, yx, yy, yz, nx, ny, nz, u, v, dudx, dudy, dvdx, dvdy] = numbers;
        Self {
            p: Vec3::new(px, py, pz),
            dpdx: Vec3::new(xx, xy, xz),
            dpdy: Vec3::new(yx, yy, yz),
            n: Vec3::new(nx, ny, nz),
            uv: Vec2::new(u, v),
            dudx,
            dudy,
            dvdx,
            dvdy,
            face_index,
        }
    }
}

const NUMBERS: usize = 18;

/// The contexts of lanes in arrays.
pub(super) struct ContextArrays {
    numbers: [[f32; MAX_LANES]; NUMBERS],
    face_index: u32,
}

impl ContextArrays {
    #[inline(always)]
    pub fn new<R: Real>(context: &TextureContext<R>) -> Self {
        let mut numbers = [[0.0; MAX_LANES]; NUMBERS];
        for (array, number) in numbers.iter_mut().zip(context.numbers()) {
            number.store(array);
        }
        Self { numbers, face_index: context.face_index }
    }

    /// All lanes.
    #[inline(always)]
    pub fn load<R: Real>(&self) -> TextureContext<R> {
        let mut numbers = [R::zero(); NUMBERS];
        for (number, array) in numbers.iter_mut().zip(&self.numbers) {
            *number = R::load(array);
        }
        TextureContext::from_numbers(numbers, self.face_index)
    }

    /// One lane.
    pub fn lane(&self, lane: usize) -> TextureContext {
        TextureContext::from_numbers(self.numbers.each_ref().map(|array| array[lane]), self.face_index)
    }
}
