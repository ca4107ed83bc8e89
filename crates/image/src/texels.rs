//! Pixels for lookups in images, one lookup for each lane.

use half::slice::HalfFloatSliceExt;
use lanes::{Int, MAX_LANES, Mask, Real};
use math::Point2;

use crate::image::{Image, Pixels};
use crate::wrap::{EdgeMode, WrapMode};

/// Images of more values are read lane by lane: lanes have indices of 31 bits.
const MAX_VALUES: usize = 1 << 31;

impl Image {
    /// [`Image::rgb_wrapped`] in lanes: the colours at columns and rows, which are signed.
    #[inline(always)]
    pub fn colors<R: Real>(&self, pixels: [R::Int; 2], wrap: WrapMode) -> [R; 3] {
        self.texels(pixels, self.color_channels(), wrap)
    }

    /// The bilinearly interpolated values of channels at `st`, where [0, 1]² covers the image and t
    /// runs down.
    #[inline(always)]
    pub(crate) fn bilinear<R: Real, const C: usize>(
        &self,
        st: Point2<R>,
        channels: [usize; C],
        wrap: WrapMode,
    ) -> [R; C] {
        let ((x, dx), (y, dy)) = (position(st.x, self.width()), position(st.y, self.height()));
        // A loop, as the code of a texel is long.
        let mut corners = [[R::zero(); C]; 4];
        for (corner, values) in corners.iter_mut().enumerate() {
            let (right, below) = (corner as u32 & 1, corner as u32 >> 1);
            let at = [x.wrapping_add(R::Int::splat(right)), y.wrapping_add(R::Int::splat(below))];
            *values = self.texels::<R, C>(at, channels, wrap);
        }
        let [upper_left, upper_right, lower_left, lower_right] = corners;
        let mut values = [R::zero(); C];
        for (c, value) in values.iter_mut().enumerate() {
            *value = (R::one() - dy) * ((R::one() - dx) * upper_left[c] + dx * upper_right[c])
                + dy * ((R::one() - dx) * lower_left[c] + dx * lower_right[c]);
        }
        values
    }

    /// The colour of the texel whose centre is nearest to `st`.
    #[inline(always)]
    pub fn nearest_rgb<R: Real>(&self, st: Point2<R>, wrap: WrapMode) -> [R; 3] {
        self.texels([nearest(st.x, self.width()), nearest(st.y, self.height())], self.color_channels(), wrap)
    }

    /// The linear values of channels at any column and row.
    #[inline(always)]
    pub(crate) fn texels<R: Real, const C: usize>(
        &self,
        [x, y]: [R::Int; 2],
        channels: [usize; C],
        wrap: WrapMode,
    ) -> [R; C] {
        let ([x, y], is_inside) = wrap.apply_lanes([x, y], self.width(), self.height());
        let mut values = [R::zero(); C];
        if self.value_count() > MAX_VALUES {
            let (x, y) = (x.to_array(), y.to_array());
            for (value, c) in values.iter_mut().zip(channels) {
                *value = R::from_fn(|lane| self.channel(x[lane], y[lane], c));
            }
        } else {
            let count = self.channel_count() as u32;
            let texel = y.wrapping_mul(R::Int::splat(self.width())).wrapping_add(x);
            self.read(texel.wrapping_mul(R::Int::splat(count)), channels, &mut values);
        }
        if !is_inside.all() {
            for value in &mut values {
                *value = R::select(is_inside, *value, R::zero());
            }
        }
        values
    }

    /// The linear values of channels of pixels whose values begin at these indices.
    #[inline(always)]
    fn read<R: Real, const C: usize>(&self, first: R::Int, channels: [usize; C], values: &mut [R; C]) {
        let at = |c: usize| first.wrapping_add(R::Int::splat(c as u32));
        match self.pixels() {
            Pixels::U8(codes, _) => {
                // Most images have four channels at most, which are read at once.
                let texel = R::Int::gather_bytes(codes, first);
                for (value, c) in values.iter_mut().zip(channels) {
                    let bytes =
                        if c < 4 { texel.shr(8 * c as u32) } else { R::Int::gather_bytes(codes, at(c)) };
                    let code = bytes & R::Int::splat(0xff);
                    *value = if self.alpha_index() == Some(c) {
                        code.to_real() / R::splat(255.0)
                    } else {
                        R::gather(self.decoded(), code)
                    };
                }
            }
            Pixels::F16(halves) => {
                for (value, c) in values.iter_mut().zip(channels) {
                    *value = from_half(R::Int::gather_halves(halves.reinterpret_cast(), at(c)));
                }
            }
            Pixels::F32(floats) => {
                for (value, c) in values.iter_mut().zip(channels) {
                    *value = R::gather(floats, at(c));
                }
            }
        }
    }
}

impl WrapMode {
    /// [`WrapMode::apply`] in lanes, and the lanes that are not zero.
    #[inline(always)]
    pub(crate) fn apply_lanes<I: Int>(self, [x, y]: [I; 2], width: u32, height: u32) -> ([I; 2], I::Mask) {
        let is_inside = x.lt(I::splat(width)) & y.lt(I::splat(height));
        if is_inside.all() {
            return ([x, y], is_inside);
        }
        match self {
            Self::Black => {
                let zero = I::splat(0);
                ([I::select(is_inside, x, zero), I::select(is_inside, y, zero)], is_inside)
            }
            Self::Repeat if width.is_power_of_two() && height.is_power_of_two() => {
                ([x & I::splat(width - 1), y & I::splat(height - 1)], I::Mask::splat(true))
            }
            _ => {
                let mut is_kept = I::Mask::splat(true);
                if let Self::Axes([across, down]) = self {
                    for (mode, at, count) in [(across, x, width), (down, y, height)] {
                        if mode == EdgeMode::Black {
                            is_kept = is_kept & at.lt(I::splat(count));
                        }
                    }
                }
                let (mut x, mut y) = (x.to_array(), y.to_array());
                self.apply_each(&mut x, &mut y, width, height);
                ([I::load(&x), I::load(&y)], is_kept)
            }
        }
    }

    /// [`WrapMode::apply`] of all pairs; the first pixel where that gives zero.
    #[inline(never)]
    fn apply_each(self, x: &mut [u32; MAX_LANES], y: &mut [u32; MAX_LANES], width: u32, height: u32) {
        for (x, y) in x.iter_mut().zip(y) {
            (*x, *y) = self.apply(*x as i32, *y as i32, width, height).unwrap_or_default();
        }
    }
}

/// The texel before a coordinate, whose centre it is nearest to from below, and the distance from
/// it.
#[inline(always)]
fn position<R: Real>(coordinate: R, size: u32) -> (R::Int, R) {
    let position = coordinate * R::splat(size as f32) - R::splat(0.5);
    let texel = position.floor().clamp(R::splat(-1e9), R::splat(1e9));
    (texel.to_int(), position - texel)
}

/// The texel whose centre is nearest to a coordinate; the one farther from zero of two that are as
/// near.
#[inline(always)]
pub(crate) fn nearest<R: Real>(coordinate: R, size: u32) -> R::Int {
    let position = coordinate * R::splat(size as f32) - R::splat(0.5);
    let magnitude = position.abs();
    let below = magnitude.floor();
    let is_nearer_above = (magnitude - below).ge(R::splat(0.5));
    let nearest = R::select(is_nearer_above, below + R::one(), below).copysign(position);
    nearest.clamp(R::splat(-1e9), R::splat(1e9)).to_int()
}

/// The numbers that are stored as half floats in the low 16 bits.
#[inline(always)]
fn from_half<R: Real>(bits: R::Int) -> R {
    let sign = (bits & R::Int::splat(0x8000)).shl(16);
    let magnitude = bits & R::Int::splat(0x7fff);
    // The product is exact, of subnormal numbers too. It changes the bias of the exponent.
    let finite = R::from_bits(magnitude.shl(13)) * R::splat(f32::from_bits((254 - 15) << 23));
    let is_finite = magnitude.lt(R::Int::splat(0x7c00));
    let limit = R::from_bits(magnitude.shl(13) | R::Int::splat(0x7f80_0000));
    R::from_bits(R::select(is_finite, finite, limit).to_bits() | sign)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ColorEncoding, Pyramid, TextureFilter};
    use half::f16;
    use math::Vec2;
    use testkit::{LaneFunction, lanes_agree};

    struct Lookups<'a>(&'a Pyramid, TextureFilter);

    impl LaneFunction for Lookups<'_> {
        #[inline(always)]
        fn results<R: Real>(&self, u: &[R]) -> Vec<R> {
            let [half, four] = [0.5, 4.0].map(R::splat);
            let st = Vec2::new((u[0] - half) * four, (u[1] - half) * four);
            // From sharp to as wide as the image.
            let size = u[2] * u[2] * u[2] * u[2];
            let dst = [u[3], u[4]].map(|x| Vec2::new((x - half) * size, (R::one() - x) * size));
            let rgb = self.0.lookup_rgb(st, dst[0], dst[1], self.1);
            [vec![self.0.lookup(st, dst[0], dst[1], self.1)], rgb.to_vec()].concat()
        }
    }

    #[test]
    fn lookups_do_not_depend_on_the_number_of_lanes() {
        let noise = |x: u32, y: u32| (x * 7919 + y * 104_729) % 257;
        let rgba = Image::from_fn(37, 21, ["R", "G", "B", "A"], |x, y| {
            [1, 2, 3, 4].map(|c| noise(c * x, y + c) as f32 / 256.0)
        });
        let many = Image::from_fn(8, 4, ["a", "b", "c", "d", "R", "G", "B"], |x, y| {
            [1, 2, 3, 4, 5, 6, 7].map(|c| noise(c * x, y + c) as f32 / 256.0)
        });
        let square = Image::from_fn(16, 16, ["Y"], |x, y| [noise(x, y) as f32]);
        let images = [
            (rgba.to_u8(ColorEncoding::Srgb), WrapMode::Repeat),
            (rgba.to_f16(), WrapMode::Clamp),
            (rgba, WrapMode::Black),
            (many.to_u8(ColorEncoding::Linear), WrapMode::Repeat),
            (square.clone(), WrapMode::OctahedralSphere),
            (square.clone(), WrapMode::Axes([EdgeMode::Repeat, EdgeMode::Clamp])),
            (square, WrapMode::Axes([EdgeMode::Clamp, EdgeMode::Black])),
        ];
        for (image, wrap) in images {
            let pyramid = Pyramid::new(image, wrap).unwrap();
            for filter in [
                TextureFilter::Point,
                TextureFilter::Bilinear,
                TextureFilter::Trilinear,
                TextureFilter::Ewa { max_anisotropy: 8.0 },
            ] {
                lanes_agree(&Lookups(&pyramid, filter), 5, 40);
            }
        }
    }

    #[test]
    fn texels_are_the_values_of_channels() {
        let image =
            Image::from_fn(5, 3, ["R", "G", "B", "A"], |x, y| [x as f32 / 5.0, y as f32 / 3.0, 0.25, 0.125]);
        for image in [image.to_u8(ColorEncoding::Srgb), image.to_f16(), image] {
            for (x, y) in (0..3).flat_map(|y| (0..5).map(move |x| (x, y))) {
                let expected = [3, 0, 2, 1].map(|c| image.channel(x, y, c));
                assert_eq!(image.texels::<f32, 4>([x, y], [3, 0, 2, 1], WrapMode::Black), expected);
            }
        }
    }

    #[test]
    fn half_floats_are_exact() {
        for bits in 0..=u16::MAX {
            let (found, expected) = (from_half::<f32>(bits.into()), f16::from_bits(bits).to_f32());
            assert!(found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan(), "{bits}");
        }
    }
}
