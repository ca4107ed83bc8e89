//! What textures depend on.

use crate::footprint::Footprint;
use lanes::{MAX_LANES, Real};
use math::{Normal3, Point2, Point3, Vec2, Vec3};

/// A point of a surface, and the footprint of a pixel there, for each lane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TextureContext<R = f32> {
    /// The point, in render space.
    pub p: Point3<R>,
    /// The surface normal, in render space.
    pub n: Normal3<R>,
    /// The surface parameters (u, v).
    pub uv: Point2<R>,
    /// The footprint of the pixel.
    pub footprint: Footprint<R>,
}

impl<R: Real> TextureContext<R> {
    /// The context of a lane.
    #[inline(always)]
    pub(super) fn lane(&self, lane: usize) -> TextureContext {
        let mut numbers = [0.0; NUMBERS];
        for (i, number) in self.numbers().iter().enumerate() {
            numbers[i] = number.lane(lane);
        }
        TextureContext::from_numbers(numbers)
    }

    /// The numbers of the context.
    #[inline(always)]
    fn numbers(&self) -> [R; NUMBERS] {
        let Self { p, n, uv, footprint } = *self;
        let Footprint { dpdx, dpdy, dudx, dudy, dvdx, dvdy } = footprint;
        let [p, dpdx, dpdy, n] = [p.to_array(), dpdx.to_array(), dpdy.to_array(), n.to_array()];
        let ([px, py, pz], [xx, xy, xz], [yx, yy, yz], [nx, ny, nz]) = (p, dpdx, dpdy, n);
        [px, py, pz, xx, xy, xz, yx, yy, yz, nx, ny, nz, uv.x, uv.y, dudx, dudy, dvdx, dvdy]
    }

    #[inline(always)]
    fn from_numbers(numbers: [R; NUMBERS]) -> Self {
        let [px, py, pz, xx, xy, xz, yx, yy, yz, nx, ny, nz, u, v, dudx, dudy, dvdx, dvdy] = numbers;
        let (dpdx, dpdy) = (Vec3::new(xx, xy, xz), Vec3::new(yx, yy, yz));
        Self {
            p: Vec3::new(px, py, pz),
            n: Vec3::new(nx, ny, nz),
            uv: Vec2::new(u, v),
            footprint: Footprint { dpdx, dpdy, dudx, dudy, dvdx, dvdy },
        }
    }
}

const NUMBERS: usize = 18;

/// The contexts of lanes in arrays.
pub(super) struct ContextArrays([[f32; MAX_LANES]; NUMBERS]);

impl ContextArrays {
    #[inline(always)]
    pub fn new<R: Real>(context: &TextureContext<R>) -> Self {
        let mut numbers = [[0.0; MAX_LANES]; NUMBERS];
        for (i, number) in context.numbers().iter().enumerate() {
            number.store(&mut numbers[i]);
        }
        Self(numbers)
    }

    /// All lanes.
    #[inline(always)]
    pub fn load<R: Real>(&self) -> TextureContext<R> {
        let mut numbers = [R::zero(); NUMBERS];
        for (i, number) in numbers.iter_mut().enumerate() {
            *number = R::load(&self.0[i]);
        }
        TextureContext::from_numbers(numbers)
    }

    /// One lane.
    pub fn lane(&self, lane: usize) -> TextureContext {
        TextureContext::from_numbers(self.0.each_ref().map(|array| array[lane]))
    }
}
