//! Samplers: the coordinates of each sample of each pixel.
//!
//! [`Sampler::start_pixel_sample`] selects a sample; each further call returns its next one or two
//! coordinates. Values are in [0, 1) and depend on the sampler's settings, pixel, sample index,
//! dimension and seed alone, so that any sample can be replayed, from any clone, in any order.
//!
//! [`Sampler::samples_per_pixel`] is the number of samples that were requested, for which a sampler
//! arranges them; some arrange the next power of two, of which these are the first. Indices beyond
//! it are valid: the sequence continues, or a new set of samples, randomised anew, begins. The mean
//! over pixels and seeds is unbiased at any number, except with [`Randomize::None`] in
//! [`PaddedSobol`], [`Sobol`] and [`ZSobol`], where nothing is random.

mod address;
mod halton;
mod independent;
mod padded_sobol;
mod pmj02bn;
mod primary_sample;
mod randomize;
mod sobol;
mod stratified;
mod zsobol;

pub use address::Address;
pub use halton::Halton;
pub use independent::Independent;
pub use padded_sobol::PaddedSobol;
pub use pmj02bn::Pmj02Bn;
pub use primary_sample::PrimarySample;
pub use randomize::Randomize;
pub use sobol::Sobol;
pub use stratified::Stratified;
pub use zsobol::ZSobol;

use address::AddressArrays;
use lanes::{Each, MAX_LANES, Real};
use math::{Vec2, closed_set};

closed_set! {
    /// The source of a pixel sample's coordinates.
    #[derive(Clone, Debug)]
    pub enum Sampler {
        /// Uniform random numbers.
        Independent(Independent),
        /// One sample in each cell of a grid.
        Stratified(Stratified),
        /// Radical inverses in prime bases, randomised for each pixel.
        Halton(Halton),
        /// Two-dimensional Sobol' points, randomised for each pair of dimensions of each pixel.
        PaddedSobol(PaddedSobol),
        /// Sobol' points of all dimensions, one sequence over the picture.
        Sobol(Sobol),
        /// Two-dimensional Sobol' points, distributed over pixels along a Z-order curve, which
        /// gives blue-noise error.
        ZSobol(ZSobol),
        /// Progressive multi-jittered (0, 2) points, distributed over pixels in the order of a
        /// Z-order curve, which gives blue-noise error.
        Pmj02Bn(Pmj02Bn),
        /// Uniform random numbers that can be mutated: primary sample space.
        PrimarySample(PrimarySample),
    }
    each each_sampler $
}

impl Sampler {
    /// The number of samples per pixel that were requested.
    pub fn samples_per_pixel(&self) -> u32 {
        each_sampler!(self, sampler => sampler.samples_per_pixel())
    }

    /// Selects sample `index` of a pixel, from coordinate `dimension` on. Dimension 0 begins a
    /// sample, whose first coordinates must be [`get_pixel_2d`](Self::get_pixel_2d).
    #[inline]
    pub fn start_pixel_sample(&mut self, pixel: [i32; 2], index: u32, dimension: u32) {
        each_sampler!(self, sampler => sampler.start_pixel_sample(pixel, index, dimension));
    }

    /// The dimension of the next coordinate.
    #[inline]
    pub fn dimension(&self) -> u32 {
        each_sampler!(self, sampler => sampler.dimension())
    }

    /// The next coordinate.
    #[inline]
    pub fn get_1d(&mut self) -> f32 {
        each_sampler!(self, sampler => sampler.get_1d())
    }

    /// The next two coordinates.
    #[inline]
    pub fn get_2d(&mut self) -> Vec2 {
        each_sampler!(self, sampler => sampler.get_2d())
    }

    /// The coordinate at an address, which [`get_1d`](Self::get_1d) gives there.
    #[inline(always)]
    pub fn at_1d<R: Real>(&self, address: &Address<R::Int>) -> R {
        match self {
            Self::Independent(sampler) => sampler.at_1d(address),
            Self::Sobol(sampler) => sampler.at_1d(address),
            Self::ZSobol(sampler) => sampler.at_1d(address),
            Self::Pmj02Bn(sampler) => sampler.at_1d(address),
            _ => R::load(&self.each_lane(&address.to_arrays(), R::LANES, Self::next_1d)[0]),
        }
    }

    /// The two coordinates at an address, which [`get_2d`](Self::get_2d) gives there.
    #[inline(always)]
    pub fn at_2d<R: Real>(&self, address: &Address<R::Int>) -> [R; 2] {
        match self {
            Self::Independent(sampler) => sampler.at_2d(address),
            Self::Sobol(sampler) => sampler.at_2d(address),
            Self::ZSobol(sampler) => sampler.at_2d(address),
            Self::Pmj02Bn(sampler) => sampler.at_2d(address),
            _ => self.each_lane(&address.to_arrays(), R::LANES, Self::get_2d).each(|u| R::load(&u)),
        }
    }

    /// The position in the pixel of the sample at an address, which
    /// [`get_pixel_2d`](Self::get_pixel_2d) gives there.
    #[inline(always)]
    pub fn at_pixel_2d<R: Real>(&self, address: &Address<R::Int>) -> [R; 2] {
        match self {
            Self::Sobol(sampler) => sampler.at_pixel_2d(address),
            Self::Halton(_) => {
                self.each_lane(&address.to_arrays(), R::LANES, Self::get_pixel_2d).each(|u| R::load(&u))
            }
            _ => self.at_2d(address),
        }
    }

    /// The next coordinate, in the first place.
    fn next_1d(&mut self) -> Vec2 {
        Vec2::new(self.get_1d(), 0.0)
    }

    /// The coordinates at the addresses of the lanes, one after another.
    #[inline(never)]
    fn each_lane(
        &self,
        addresses: &AddressArrays,
        lanes: usize,
        draw: fn(&mut Self) -> Vec2,
    ) -> [[f32; MAX_LANES]; 2] {
        let mut sampler = self.clone();
        let mut values = [[0.0; MAX_LANES]; 2];
        let AddressArrays { pixel: [x, y], index, dimension } = addresses;
        for lane in 0..lanes {
            sampler.start_pixel_sample([x[lane] as i32, y[lane] as i32], *index, dimension[lane]);
            let u = draw(&mut sampler);
            (values[0][lane], values[1][lane]) = (u.x, u.y);
        }
        values
    }

    /// The coordinates of the sample within its pixel.
    #[inline]
    pub fn get_pixel_2d(&mut self) -> Vec2 {
        each_sampler!(self, sampler => sampler.get_pixel_2d())
    }
}
