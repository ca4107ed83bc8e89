//! Random numbers of lanes.
//!
//! They are computed by a kernel of their own, not as a part of those that use them: samplers are
//! much code, which each of these kernels would have again for every instruction set. A call of it
//! computes all numbers that are known to be needed.

use lanes::{Each, Int, Kernel, MAX_LANES, Real};
use math::Vec2;
use sampling::Sampler;
use sampling::sampler::Address;

use super::pass::Pass;

/// The numbers of a camera sample, one for each lane.
pub(super) struct CameraNumbers<R> {
    pub wavelength: R,
    /// Position in the pixel's filter.
    pub place: Vec2<R>,
    pub time: R,
    pub lens: Vec2<R>,
}

impl<R: Real> CameraNumbers<R> {
    /// The next coordinates of each lane, which are the first of a sample.
    #[inline(always)]
    pub fn draw(pass: &Pass, address: &mut Address<R::Int>) -> Self {
        use Coordinates::{One, Two, TwoOfPixel};
        let u = pass.draw(&[One, TwoOfPixel, One, Two], address);
        Self { wavelength: u.one(0), place: u.two(1), time: u.one(3), lens: u.two(4) }
    }
}

/// The next coordinate of each lane.
#[inline(always)]
pub(super) fn draw_1d<R: Real>(pass: &Pass, address: &mut Address<R::Int>) -> R {
    pass.draw(&[Coordinates::One], address).one(0)
}

/// The next two coordinates of each lane.
#[inline(always)]
pub(super) fn draw_2d<R: Real>(pass: &Pass, address: &mut Address<R::Int>) -> Vec2<R> {
    pass.draw(&[Coordinates::Two], address).two(0)
}

impl Pass<'_> {
    /// The next coordinates of each lane.
    #[inline(always)]
    fn draw<I: Int>(&self, coordinates: &[Coordinates], address: &mut Address<I>) -> Numbers {
        let Address { pixel, index, dimension } = *address;
        let (pixel, dimension) = (pixel.each(I::to_array), dimension.to_array());
        let sampler = self.pixels.sampler;
        for kind in coordinates {
            address.skip(kind.count() as u32);
        }
        self.instruction_set.dispatch(Draw { sampler, coordinates, pixel, index, dimension })
    }
}

/// Coordinates that a sampler gives at once.
#[derive(Clone, Copy)]
enum Coordinates {
    One,
    Two,
    TwoOfPixel,
}

impl Coordinates {
    #[inline(always)]
    fn count(self) -> usize {
        match self {
            Self::One => 1,
            Self::Two | Self::TwoOfPixel => 2,
        }
    }
}

/// Up to six coordinates for each lane.
struct Numbers([[f32; MAX_LANES]; 6]);

impl Numbers {
    #[inline(always)]
    fn one<R: Real>(&self, first: usize) -> R {
        R::load(&self.0[first])
    }

    #[inline(always)]
    fn two<R: Real>(&self, first: usize) -> Vec2<R> {
        Vec2::new(self.one(first), self.one(first + 1))
    }
}

/// Computes successive coordinates from addresses on.
struct Draw<'a> {
    sampler: &'a Sampler,
    coordinates: &'a [Coordinates],
    pixel: [[u32; MAX_LANES]; 2],
    index: u32,
    dimension: [u32; MAX_LANES],
}

impl Kernel for Draw<'_> {
    type Output = Numbers;

    #[inline(always)]
    fn run<R: Real>(self) -> Numbers {
        let Self { sampler, coordinates, pixel: [x, y], index, dimension } = self;
        let pixel = [R::Int::load(&x), R::Int::load(&y)];
        let mut address = Address { pixel, index, dimension: R::Int::load(&dimension) };
        let mut numbers = Numbers([[0.0; MAX_LANES]; 6]);
        let mut rest = &mut numbers.0[..];
        for kind in coordinates {
            let [u, v] = match kind {
                Coordinates::One => [sampler.at_1d::<R>(&address), R::zero()],
                Coordinates::Two => sampler.at_2d::<R>(&address),
                Coordinates::TwoOfPixel => sampler.at_pixel_2d::<R>(&address),
            };
            let (these, others) = rest.split_at_mut(kind.count());
            u.store(&mut these[0]);
            if let [_, second] = these {
                v.store(second);
            }
            rest = others;
            address.skip(kind.count() as u32);
        }
        numbers
    }
}
