//! Prefiltered images (mip maps) and filtered lookups in them.
//!
//! Level 0 is the image, enlarged to powers of two where its sides are not; each further level is
//! the 2 × 2 box average of the one before; the last is one texel. A lookup at `st` ∈ [0, 1]² (t
//! runs down) takes two vectors `dst0`, `dst1` by which `st` differs between neighbouring pixels.
//! With L levels:
//!
//! - point, bilinear, trilinear: the level is ℓ = L − 1 + log₂(2 max |dst|), taken as ⌊ℓ⌋, or
//!   between ⌊ℓ⌋ and ⌊ℓ⌋ + 1;
//! - EWA: an elliptical Gaussian exp(−2r²) − exp(−2), r < 1, whose axes are the two vectors, the
//!   shorter lengthened to at least 1/`max_anisotropy` of the longer, each side grown by one texel;
//!   between the levels about ℓ = L − 1 + log₂(shorter).
//!
//! Numbers of levels, widths and the quantised weight table are those of pbrt-v4, so that pictures
//! agree. Sources: [Williams 1983], [Heckbert 1989 §3], [Pharr 2023 §10.4.3].

use std::sync::{Arc, LazyLock};

use lanes::{Each, Int, MAX_LANES, Mask, Real, log2};
use math::Vec2;
use rayon::prelude::*;

use crate::{
    error::ImageError,
    image::{Image, Pixels},
    memory::filled,
    source::PixelSource,
    texels::nearest,
    wrap::WrapMode,
};

/// How texels are weighted in a lookup.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TextureFilter {
    /// The nearest texel of one level.
    Point,
    /// Four texels of one level.
    Bilinear,
    /// Four texels of each of two levels.
    Trilinear,
    /// The elliptically weighted average of two levels.
    Ewa {
        /// The greatest ratio of the ellipse's axes; larger is sharper and slower. Usually 8.
        max_anisotropy: f32,
    },
}

impl TextureFilter {
    /// The filter of a name as scene files write it; `max_anisotropy` matters to `ewa` alone.
    pub fn from_name(name: &str, max_anisotropy: f32) -> Option<Self> {
        match name.to_ascii_lowercase().as_str() {
            "point" => Some(Self::Point),
            "bilinear" => Some(Self::Bilinear),
            "trilinear" => Some(Self::Trilinear),
            "ewa" => Some(Self::Ewa { max_anisotropy }),
            _ => None,
        }
    }
}

/// An image and its ever smaller averages. Levels are stored as the image is.
#[derive(Clone, Debug)]
pub struct Pyramid {
    levels: Vec<Arc<Image>>,
    wrap: WrapMode,
}

impl Pyramid {
    /// Builds all levels; an image whose sides are powers of two is shared, not copied.
    /// Refused where there is no memory for them.
    pub fn new(image: impl Into<Arc<Image>>, wrap: WrapMode) -> Result<Self, ImageError> {
        let image: Arc<Image> = image.into();
        let (width, height) = (image.width().next_power_of_two(), image.height().next_power_of_two());
        // Averages are taken of unrounded values, whatever the levels are stored as.
        let (first, mut exact) = if (width, height) == (image.width(), image.height()) {
            (image.clone(), image.clone())
        } else {
            let resized = Arc::new(image.resize(width, height, wrap)?);
            (stored_as(&image, &resized)?, resized)
        };
        let mut levels = vec![first];
        while exact.width() > 1 || exact.height() > 1 {
            exact = Arc::new(halved(&exact)?);
            levels.push(stored_as(&image, &exact)?);
        }
        Ok(Self { levels, wrap })
    }

    /// The levels, the largest first.
    pub fn levels(&self) -> &[Arc<Image>] {
        &self.levels
    }

    /// The wrap mode of lookups outside [0, 1]².
    pub fn wrap(&self) -> WrapMode {
        self.wrap
    }

    /// Bytes that all levels take.
    pub fn byte_size(&self) -> usize {
        self.levels.iter().map(|level| level.byte_size()).sum()
    }

    /// The filtered value of the first channel.
    #[inline(always)]
    pub fn lookup<R: Real>(&self, st: Vec2<R>, dst0: Vec2<R>, dst1: Vec2<R>, filter: TextureFilter) -> R {
        let [value] = self.filtered(st, [dst0, dst1], filter, [0]);
        value
    }

    /// The filtered colour.
    #[inline(always)]
    pub fn lookup_rgb<R: Real>(
        &self,
        st: Vec2<R>,
        dst0: Vec2<R>,
        dst1: Vec2<R>,
        filter: TextureFilter,
    ) -> [R; 3] {
        self.filtered(st, [dst0, dst1], filter, self.levels[0].color_channels())
    }

    #[inline(always)]
    fn filtered<R: Real, const C: usize>(
        &self,
        st: Vec2<R>,
        dst: [Vec2<R>; 2],
        filter: TextureFilter,
        channels: [usize; C],
    ) -> [R; C] {
        if let TextureFilter::Ewa { max_anisotropy } = filter {
            return self.ewa_lanes(st, dst, max_anisotropy, channels);
        }
        let top = self.levels.len() - 1;
        let [a, b] = dst.each(|dst| dst.abs().max_element());
        let width = R::splat(2.0) * a.max(b);
        let level = R::splat(top as f32) + log2(width.max(R::splat(1e-8)));
        let level = level.clamp(R::zero(), R::splat(top as f32));
        let index = level.to_int();
        let t = level - index.to_real();
        let is_blended = if let TextureFilter::Trilinear = filter {
            !index.eq(R::Int::splat(0)) & !index.eq(R::Int::splat(top as u32))
        } else {
            R::Mask::splat(false)
        };

        let mut values = [R::zero(); C];
        let mut is_coarse = R::Mask::splat(false);
        let (indices, mut levels) = (index.to_array(), 0_u64);
        for &index in &indices[..R::LANES] {
            levels |= 1 << index;
        }
        let mut next = levels.trailing_zeros() as usize;
        // Levels ascend, so that the finer of two comes first.
        while next <= top {
            let level = next;
            let is_fine = index.eq(R::Int::splat(level as u32));
            let found = self.texels_at(level, st, filter, channels, is_fine);
            for (value, found) in values.iter_mut().zip(found) {
                let fine = R::select(is_blended, (R::one() - t) * found, found);
                let sum = R::select(is_coarse, *value + t * found, *value);
                *value = R::select(is_fine, fine, sum);
            }
            is_coarse = is_fine & is_blended;
            levels &= !(1 << level);
            next = if is_coarse.any() { level + 1 } else { levels.trailing_zeros() as usize };
        }
        values
    }

    /// The values in one level, unfiltered by others. The last level is one texel, which is the
    /// value in the lanes of `is_fine`; where it is blended with the level before, it is wrapped as
    /// all levels are.
    #[inline(always)]
    fn texels_at<R: Real, const C: usize>(
        &self,
        level: usize,
        st: Vec2<R>,
        filter: TextureFilter,
        channels: [usize; C],
        is_fine: R::Mask,
    ) -> [R; C] {
        let (image, is_point) = (&self.levels[level], matches!(filter, TextureFilter::Point));
        let is_top = if level + 1 == self.levels.len() { is_fine } else { R::Mask::splat(false) };
        let is_single = is_top | R::Mask::splat(is_point);
        let mut values = [R::zero(); C];
        if !is_single.all() {
            values = image.bilinear(st, channels, self.wrap);
        }
        if is_single.any() {
            let (x, y) = (nearest(st.x, image.width()), nearest(st.y, image.height()));
            let zero = R::Int::splat(0);
            let position = [R::Int::select(is_top, zero, x), R::Int::select(is_top, zero, y)];
            let texel = image.texels::<R, C>(position, channels, self.wrap);
            for (value, texel) in values.iter_mut().zip(texel) {
                *value = R::select(is_single, texel, *value);
            }
        }
        values
    }

    /// [`Self::ewa`] lane by lane: ellipses have different numbers of texels.
    #[inline(always)]
    fn ewa_lanes<R: Real, const C: usize>(
        &self,
        st: Vec2<R>,
        [dst0, dst1]: [Vec2<R>; 2],
        max_anisotropy: f32,
        channels: [usize; C],
    ) -> [R; C] {
        let arrays = [st, dst0, dst1].each(|v| v.to_array().each(R::to_array));
        let mut values = [[0.0; MAX_LANES]; C];
        for lane in 0..R::LANES {
            let [st, dst0, dst1] = arrays.each(|[x, y]| Vec2::new(x[lane], y[lane]));
            let found = self.ewa(st, dst0, dst1, max_anisotropy, channels);
            for (values, found) in values.iter_mut().zip(found) {
                values[lane] = found;
            }
        }
        let mut loaded = [R::zero(); C];
        for (loaded, values) in loaded.iter_mut().zip(&values) {
            *loaded = R::load(values);
        }
        loaded
    }

    #[inline(never)]
    fn ewa<const C: usize>(
        &self,
        st: Vec2,
        dst0: Vec2,
        dst1: Vec2,
        max_anisotropy: f32,
        channels: [usize; C],
    ) -> [f32; C] {
        let (longer, mut shorter) =
            if dst0.length_squared() < dst1.length_squared() { (dst1, dst0) } else { (dst0, dst1) };
        if shorter.length() * max_anisotropy < longer.length() {
            shorter *= longer.length() / (shorter.length() * max_anisotropy);
        }
        let width = shorter.length();
        if !(width > 0.0 && width.is_finite()) {
            return self.levels[0].bilinear(st, channels, self.wrap);
        }
        let level = ((self.levels.len() - 1) as f32 + lanes::log2(width)).max(0.0);
        let index = level as usize;
        let mut values = self.ewa_at(index, st, longer, shorter, channels);
        let coarse = self.ewa_at(index + 1, st, longer, shorter, channels);
        let t = level - index as f32;
        for (value, coarse) in values.iter_mut().zip(coarse) {
            *value = (1.0 - t) * *value + t * coarse;
        }
        values
    }

    /// The elliptical average in one level: texels with A s² + B s t + C t² < 1, (s, t) from the
    /// centre.
    fn ewa_at<const C: usize>(
        &self,
        level: usize,
        st: Vec2,
        dst0: Vec2,
        dst1: Vec2,
        channels: [usize; C],
    ) -> [f32; C] {
        let Some(image) = self.levels.get(level) else {
            return self.levels[self.levels.len() - 1].texels([0, 0], channels, self.wrap);
        };
        let center = st * size(image) - 0.5;
        let (axis0, axis1) = (dst0 * size(image), dst1 * size(image));
        let a = axis0.y * axis0.y + axis1.y * axis1.y + 1.0;
        let b = -2.0 * (axis0.x * axis0.y + axis1.x * axis1.y);
        let c = axis0.x * axis0.x + axis1.x * axis1.x + 1.0;
        let f = a * c - 0.25 * b * b;
        let (a, b, c) = (a / f, b / f, c / f);

        // The ellipse's bounding box.
        let determinant = 4.0 * a * c - b * b;
        let reach = 2.0 / determinant
            * Vec2::new((determinant * c).max(0.0).sqrt(), (determinant * a).max(0.0).sqrt());
        let (first, last) = ((center - reach).map(f32::ceil), (center + reach).map(f32::floor));
        let (mut sum, mut weight_sum) = ([0.0; C], 0.0);
        for y in first.y as i32..=last.y as i32 {
            let t = y as f32 - center.y;
            for x in first.x as i32..=last.x as i32 {
                let s = x as f32 - center.x;
                let r2 = a * s * s + b * s * t + c * t * t;
                if r2 < 1.0 {
                    let weight =
                        EWA_WEIGHTS[((r2 * EWA_WEIGHTS.len() as f32) as usize).min(EWA_WEIGHTS.len() - 1)];
                    let texel: [f32; C] = image.texels([x as u32, y as u32], channels, self.wrap);
                    sum.iter_mut().zip(texel).for_each(|(sum, value)| *sum += weight * value);
                    weight_sum += weight;
                }
            }
        }
        // Every ellipse holds a texel's centre unless the numbers have overflowed.
        if weight_sum > 0.0 {
            let inverse = 1.0 / weight_sum;
            sum.map(|sum| inverse * sum)
        } else {
            image.bilinear(st, channels, self.wrap)
        }
    }
}

static EWA_WEIGHTS: LazyLock<[f32; 128]> = LazyLock::new(|| {
    std::array::from_fn(|index| {
        let r2 = index as f32 / 127.0;
        lanes::exp(-2.0 * r2) - lanes::exp(-2.0f32)
    })
});

fn size(image: &Image) -> Vec2 {
    Vec2::new(image.width() as f32, image.height() as f32)
}

/// A level, stored as `image` is.
fn stored_as(image: &Image, exact: &Arc<Image>) -> Result<Arc<Image>, ImageError> {
    match (image.pixels(), exact.pixels()) {
        (Pixels::F32(_), Pixels::F32(_)) => Ok(exact.clone()),
        (pixels, _) => exact.stored_as(pixels).map(Arc::new),
    }
}

/// The next level: averages of 2 × 2 texels, or of two where one side is a single texel already.
fn halved(image: &Image) -> Result<Image, ImageError> {
    let (width, height) = ((image.width() / 2).max(1), (image.height() / 2).max(1));
    let count = image.channel_count();
    let mut values = filled(width as usize * height as usize * count, 0.0)?;
    let old_row = image.width() as usize * count;
    let average = |[upper, lower]: &mut [Vec<f32>; 2], (row, y): (&mut [f32], u32)| {
        image.row(2 * y, upper);
        image.row((2 * y + 1).min(image.height() - 1), lower);
        for (x, texel) in row.chunks_exact_mut(count).enumerate() {
            let left = 2 * x * count;
            let right = (left + count).min(old_row - count);
            for (c, value) in texel.iter_mut().enumerate() {
                *value = 0.25 * (upper[left + c] + upper[right + c] + lower[left + c] + lower[right + c]);
            }
        }
    };
    let rows = values.par_chunks_mut(width as usize * count).zip(0..height);
    rows.for_each_init(|| [vec![0.0; old_row], vec![0.0; old_row]], average);
    Image::new(width, height, image.channels(), Pixels::F32(values))
}

#[cfg(test)]
mod tests {
    use proptest::{prelude::*, test_runner::RngSeed};

    use super::*;
    use crate::encoding::ColorEncoding;

    const FILTERS: [TextureFilter; 4] = [
        TextureFilter::Point,
        TextureFilter::Bilinear,
        TextureFilter::Trilinear,
        TextureFilter::Ewa { max_anisotropy: 8.0 },
    ];

    fn checkerboard(width: u32, height: u32) -> Image {
        Image::from_fn(width, height, ["R", "G", "B"], |x, y| [((x + y) % 2) as f32, 0.5, x as f32])
    }

    #[test]
    fn levels_halve_down_to_the_mean() {
        let pyramid = Pyramid::new(checkerboard(16, 4), WrapMode::Repeat).unwrap();
        let sizes: Vec<_> = pyramid.levels().iter().map(|level| (level.width(), level.height())).collect();
        assert_eq!(sizes, [(16, 4), (8, 2), (4, 1), (2, 1), (1, 1)]);
        assert_eq!(pyramid.levels()[4].rgb(0, 0), [0.5, 0.5, 7.5]);
    }

    #[test]
    fn storage_stays_and_powers_of_two_are_shared() {
        let image = Arc::new(checkerboard(8, 8).to_u8(ColorEncoding::Srgb));
        let pyramid = Pyramid::new(image.clone(), WrapMode::Repeat).unwrap();
        assert!(Arc::ptr_eq(&image, &pyramid.levels()[0]));
        assert_eq!(pyramid.byte_size(), 3 * (64 + 16 + 4 + 1));
        let odd = Pyramid::new(checkerboard(5, 3).to_f16(), WrapMode::Clamp).unwrap();
        assert_eq!((odd.levels()[0].width(), odd.levels()[0].height()), (8, 4));
        assert!(matches!(odd.levels()[0].pixels(), Pixels::F16(_)));
    }

    #[test]
    fn sharp_lookups_see_texels_and_wide_ones_the_mean() {
        let pyramid = Pyramid::new(checkerboard(8, 8), WrapMode::Repeat).unwrap();
        for filter in FILTERS {
            let at = Vec2::new(3.5 / 8.0, 2.5 / 8.0);
            assert_eq!(pyramid.lookup(at, Vec2::ZERO, Vec2::ZERO, filter), 1.0, "{filter:?}");
            let wide = pyramid.lookup(at, Vec2::new(2.0, 0.0), Vec2::new(0.0, 2.0), filter);
            assert_eq!(wide, 0.5, "{filter:?}");
        }
    }

    #[test]
    fn an_ellipse_averages_along_its_longer_axis() {
        let stripes = Image::from_fn(64, 64, ["Y"], |x, _| [(x / 4 % 2) as f32]);
        let pyramid = Pyramid::new(stripes, WrapMode::Repeat).unwrap();
        let filter = TextureFilter::Ewa { max_anisotropy: 16.0 };
        let (long, short) = (16.0 / 64.0, 1.0 / 64.0);
        let at = Vec2::new(6.0 / 64.0, 0.5);
        let across = pyramid.lookup(at, Vec2::new(long, 0.0), Vec2::new(0.0, short), filter);
        let along = pyramid.lookup(at, Vec2::new(short, 0.0), Vec2::new(0.0, long), filter);
        assert!((across - 0.5).abs() < 0.1, "{across}");
        assert!(along > 0.9, "{along}");
    }

    #[test]
    fn numbers_without_sense_still_give_an_answer() {
        let pyramid = Pyramid::new(checkerboard(8, 8), WrapMode::Repeat).unwrap();
        for filter in FILTERS {
            for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e38, f32::MIN_POSITIVE] {
                let v = Vec2::new(bad, 0.1);
                pyramid.lookup(Vec2::new(0.5, 0.5), v, Vec2::new(0.01, 0.02), filter);
                pyramid.lookup(v, Vec2::new(0.01, 0.0), Vec2::new(0.0, 0.02), filter);
                pyramid.lookup_rgb(v, v, v, filter);
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 64, rng_seed: RngSeed::Fixed(7), ..ProptestConfig::default() })]

        #[test]
        fn a_constant_image_is_constant_everywhere(
            width in 1u32..20, height in 1u32..20, value in 0.0f32..10.0,
            st in prop::array::uniform2(-2.0f32..2.0), d in prop::array::uniform4(-0.5f32..0.5),
        ) {
            let image = Image::from_fn(width, height, ["Y"], |_, _| [value]);
            for wrap in [WrapMode::Repeat, WrapMode::Clamp, WrapMode::OctahedralSphere] {
                let pyramid = Pyramid::new(image.clone(), wrap).unwrap();
                for filter in FILTERS {
                    let found = pyramid.lookup(st.into(), Vec2::new(d[0], d[1]), Vec2::new(d[2], d[3]), filter);
                    prop_assert!((found - value).abs() <= 1e-5 * value, "{filter:?} {found} {value}");
                }
            }
        }
    }
}
