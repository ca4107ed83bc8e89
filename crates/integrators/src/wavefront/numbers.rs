//! Random numbers of lanes.
//!
//! They are computed by kernels of their own, not as a part of those that use them: samplers are
//! much code, which each of these kernels would have again for every instruction set.

use lanes::{Each, Int, Kernel, MAX_LANES, Real};
use math::Vec2;
use sampling::Sampler;
use sampling::sampler::Address;

use super::pass::Pass;

/// The next coordinate of each lane.
#[inline(always)]
pub(super) fn draw_1d<R: Real>(pass: &Pass, address: &mut Address<R::Int>) -> R {
    let [u, _] = pass.instruction_set.dispatch(Draw::new(pass.pixels.sampler, 1, address));
    address.skip(1);
    R::load(&u)
}

/// The next two coordinates of each lane.
#[inline(always)]
pub(super) fn draw_2d<R: Real>(pass: &Pass, address: &mut Address<R::Int>) -> Vec2<R> {
    let [x, y] = pass.instruction_set.dispatch(Draw::new(pass.pixels.sampler, 2, address));
    address.skip(2);
    Vec2::new(R::load(&x), R::load(&y))
}

/// Computes coordinates at addresses.
struct Draw<'a> {
    sampler: &'a Sampler,
    count: u32,
    pixel: [[u32; MAX_LANES]; 2],
    index: u32,
    dimension: [u32; MAX_LANES],
}

impl<'a> Draw<'a> {
    #[inline(always)]
    fn new<I: Int>(sampler: &'a Sampler, count: u32, address: &Address<I>) -> Self {
        let Address { pixel, index, dimension } = *address;
        Self { sampler, count, pixel: pixel.each(I::to_array), index, dimension: dimension.to_array() }
    }
}

impl Kernel for Draw<'_> {
    type Output = [[f32; MAX_LANES]; 2];

    #[inline(always)]
    fn run<R: Real>(self) -> Self::Output {
        let Self { sampler, count, pixel: [x, y], index, dimension } = self;
        let pixel = [R::Int::load(&x), R::Int::load(&y)];
        let address = Address { pixel, index, dimension: R::Int::load(&dimension) };
        if count == 1 {
            [sampler.at_1d::<R>(&address).to_array(), [0.0; MAX_LANES]]
        } else {
            sampler.at_2d::<R>(&address).each(R::to_array)
        }
    }
}
