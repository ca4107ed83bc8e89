//! Random numbers of lanes.
//!
//! They are computed by a kernel of their own, not as a part of those that use them: samplers are
//! much code, which each of these kernels would have again for every instruction set. A call of it
//! computes all numbers that are known to be needed. Those that nothing depends on, such as a
//! position on the lens of a pinhole camera, are not computed, and are 0; dimensions are counted as
//! if they were.

use lanes::{Each, Int, Kernel, MAX_LANES, Mask, Real};
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
        let (scene, camera) = (pass.pixels.scene, &pass.pixels.view.camera);
        let mut draw = Draw::new(pass, address);
        draw.push(Coordinates::One, address);
        draw.push(Coordinates::TwoOfPixel, address);
        draw.push_if(scene.traits().is_moving || camera.is_moving(), Coordinates::One, address);
        draw.push_if(camera.has_lens(), Coordinates::Two, address);
        draw.compute(pass);
        Self { wavelength: draw.one(0), place: draw.two(1), time: draw.one(2), lens: draw.two(3) }
    }
}

/// The numbers of a sample, one for each lane.
#[derive(Clone, Copy)]
pub(super) struct SampleNumbers<R> {
    /// Chooses a light, or a lobe of the BSDF.
    pub uc: R,
    /// Choose a point on the light, or a direction.
    pub u: Vec2<R>,
}

/// The numbers of a vertex, one for each lane.
pub(super) struct VertexNumbers<R: Real> {
    /// Of a sample of a light; any numbers where there is none.
    pub light: SampleNumbers<R>,
    /// The dimension of the numbers of a shadow ray in media, the first of two.
    pub passage: R::Int,
    /// Of a sample of the BSDF.
    pub bsdf: SampleNumbers<R>,
}

impl<R: Real> VertexNumbers<R> {
    /// The next coordinates of each lane, of vertices in media, which have no choice of lobes.
    #[inline(always)]
    pub fn draw_in_media(pass: &Pass, address: &mut Address<R::Int>) -> Self {
        let mut draw = Draw::new(pass, address);
        draw.push_if(pass.has_several_lights(), Coordinates::One, address);
        draw.push(Coordinates::Two, address);
        let passage = address.dimension;
        address.skip(2);
        draw.push(Coordinates::Two, address);
        draw.compute(pass);
        Self { light: draw.sample(0), passage, bsdf: SampleNumbers { uc: R::zero(), u: draw.two(2) } }
    }

    /// The next coordinates of each lane; only some lanes sample a light, and not all BSDFs choose
    /// among lobes.
    #[inline(always)]
    pub fn draw(
        pass: &Pass,
        address: &mut Address<R::Int>,
        samples_light: R::Mask,
        chooses_lobes: bool,
        with_media: bool,
    ) -> Self {
        let mut draw = Draw::new(pass, address);
        let mut before = *address;
        let mut passage = address.dimension;
        if samples_light.any() {
            draw.push_if(pass.has_several_lights(), Coordinates::One, address);
            draw.push(Coordinates::Two, address);
            passage = address.dimension;
            if with_media {
                address.skip(2);
            }
            before.dimension = R::Int::select(samples_light, address.dimension, before.dimension);
            *address = before;
        }
        let first = draw.count;
        draw.push_if(chooses_lobes, Coordinates::One, address);
        draw.push(Coordinates::Two, address);
        draw.compute(pass);
        Self { light: draw.sample(0), passage, bsdf: draw.sample(first) }
    }
}

/// The next coordinates of each lane, for two samples of a BSDF, which may have no choice of lobes.
#[inline(always)]
pub(super) fn draw_two<R: Real>(
    pass: &Pass,
    address: &mut Address<R::Int>,
    chooses_lobes: bool,
) -> [SampleNumbers<R>; 2] {
    let mut draw = Draw::new(pass, address);
    for _ in 0..2 {
        draw.push_if(chooses_lobes, Coordinates::One, address);
        draw.push(Coordinates::Two, address);
    }
    draw.compute(pass);
    [draw.sample(0), draw.sample(2)]
}

/// The next coordinate of each lane.
#[inline(always)]
pub(super) fn draw_1d<R: Real>(pass: &Pass, address: &mut Address<R::Int>) -> R {
    let mut draw = Draw::new(pass, address);
    draw.push(Coordinates::One, address);
    draw.compute(pass);
    draw.one(0)
}

/// The next two coordinates of each lane.
#[inline(always)]
pub(super) fn draw_2d<R: Real>(pass: &Pass, address: &mut Address<R::Int>) -> Vec2<R> {
    let mut draw = Draw::new(pass, address);
    draw.push(Coordinates::Two, address);
    draw.compute(pass);
    draw.two(0)
}

/// Coordinates that a sampler gives at once.
#[derive(Clone, Copy)]
enum Coordinates {
    /// None, in their place zeros.
    Zero,
    One,
    Two,
    TwoOfPixel,
}

/// The most coordinates, singly or by two, that are drawn at once.
const MAX_DRAWS: usize = 4;

/// Computes coordinates.
struct Draw<'a> {
    sampler: &'a Sampler,
    pixel: [[u32; MAX_LANES]; 2],
    index: u32,
    count: usize,
    coordinates: [Coordinates; MAX_DRAWS],
    /// The dimensions of each.
    dimension: [[u32; MAX_LANES]; MAX_DRAWS],
    /// The numbers of each, once they are computed.
    numbers: [[[f32; MAX_LANES]; 2]; MAX_DRAWS],
}

impl<'a> Draw<'a> {
    #[inline(always)]
    fn new<I: Int>(pass: &Pass<'a>, address: &Address<I>) -> Self {
        Self {
            sampler: pass.pixels.sampler,
            pixel: address.pixel.each(I::to_array),
            index: address.index,
            count: 0,
            coordinates: [Coordinates::One; MAX_DRAWS],
            dimension: [[0; MAX_LANES]; MAX_DRAWS],
            numbers: [[[0.0; MAX_LANES]; 2]; MAX_DRAWS],
        }
    }

    /// Adds the coordinates at an address, which continues after them.
    #[inline(always)]
    fn push<I: Int>(&mut self, coordinates: Coordinates, address: &mut Address<I>) {
        self.coordinates[self.count] = coordinates;
        address.dimension.store(&mut self.dimension[self.count]);
        self.count += 1;
        address.skip(if let Coordinates::One = coordinates { 1 } else { 2 });
    }

    /// The same, with zeros for coordinates that are not needed.
    #[inline(always)]
    fn push_if<I: Int>(&mut self, is_needed: bool, coordinates: Coordinates, address: &mut Address<I>) {
        self.push(coordinates, address);
        if !is_needed {
            self.coordinates[self.count - 1] = Coordinates::Zero;
        }
    }

    #[inline(always)]
    fn compute(&mut self, pass: &Pass) {
        pass.instruction_set.dispatch_large(self);
    }

    #[inline(always)]
    fn one<R: Real>(&self, draw: usize) -> R {
        R::load(&self.numbers[draw][0])
    }

    #[inline(always)]
    fn sample<R: Real>(&self, draw: usize) -> SampleNumbers<R> {
        SampleNumbers { uc: self.one(draw), u: self.two(draw + 1) }
    }

    #[inline(always)]
    fn two<R: Real>(&self, draw: usize) -> Vec2<R> {
        Vec2::new(R::load(&self.numbers[draw][0]), R::load(&self.numbers[draw][1]))
    }
}

/// By reference, as its arrays would be copied for each call.
impl Kernel for &mut Draw<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let Draw { sampler, pixel: [x, y], index, count, .. } = *self;
        let pixel = [R::Int::load(&x), R::Int::load(&y)];
        for draw in 0..count {
            let address = Address { pixel, index, dimension: R::Int::load(&self.dimension[draw]) };
            let [u, v] = match self.coordinates[draw] {
                Coordinates::Zero => continue,
                Coordinates::One => [sampler.at_1d::<R>(&address), R::zero()],
                Coordinates::Two => sampler.at_2d::<R>(&address),
                Coordinates::TwoOfPixel => sampler.at_pixel_2d::<R>(&address),
            };
            u.store(&mut self.numbers[draw][0]);
            v.store(&mut self.numbers[draw][1]);
        }
    }
}
