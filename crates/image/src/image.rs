//! The pixel array.

use std::sync::Arc;

use half::f16;
use lanes::Real;
use math::Point2;
use rayon::prelude::*;

use crate::{
    depth::SampleDepth,
    encoding::{ColorEncoding, Quantizer},
    error::ImageError,
    memory::{collected, filled, reserved},
    metadata::{ImageMetadata, Window},
    source::{Channel, PixelSource, alpha_channel, color_channels},
    wrap::WrapMode,
};

/// The stored values of an image: rows from the top, pixels from the left, channels of a pixel side
/// by side.
#[derive(Clone, Debug, PartialEq)]
pub enum Pixels {
    /// 8-bit codes and their encoding.
    U8(Vec<u8>, ColorEncoding),
    /// Half floats, linear.
    F16(Vec<f16>),
    /// Single floats, linear.
    F32(Vec<f32>),
}

impl Pixels {
    fn len(&self) -> usize {
        match self {
            Self::U8(values, _) => values.len(),
            Self::F16(values) => values.len(),
            Self::F32(values) => values.len(),
        }
    }

    fn decoded(&self) -> Arc<[f32]> {
        match self {
            Self::U8(_, encoding) => encoding.table().into(),
            _ => Arc::new([]),
        }
    }
}

/// A rectangle of pixels with named channels. Both sides are at least one pixel.
#[derive(Clone, Debug)]
pub struct Image {
    width: u32,
    height: u32,
    channels: Vec<String>,
    pixels: Pixels,
    /// The linear values of 8-bit codes; empty where the pixels are floats.
    decoded: Arc<[f32]>,
    /// Which channels [`Image::rgb`] reads.
    color: [usize; 3],
    /// The channel of opacity, whose 8-bit codes are linear whatever the encoding of the others.
    alpha: Option<usize>,
    /// Its metadata.
    pub metadata: ImageMetadata,
}

impl Image {
    /// An image of the given pixels; refused where sizes contradict each other, or a side or the
    /// channel list is empty.
    pub fn new(
        width: u32,
        height: u32,
        channels: impl IntoIterator<Item = impl Into<String>>,
        pixels: Pixels,
    ) -> Result<Self, ImageError> {
        let channels: Vec<String> = channels.into_iter().map(Into::into).collect();
        let expected = u128::from(width) * u128::from(height) * channels.len() as u128;
        if expected == 0 || i32::try_from(width.max(height)).is_err() {
            return Err(ImageError::Invalid(format!(
                "{width} × {height} pixels of {} channels",
                channels.len()
            )));
        }
        if expected != pixels.len() as u128 {
            return Err(ImageError::Invalid(format!(
                "{width} × {height} pixels of {} channels cannot have {} values",
                channels.len(),
                pixels.len()
            )));
        }
        let (decoded, color, alpha) = (pixels.decoded(), color_channels(&channels), alpha_channel(&channels));
        let metadata = ImageMetadata::default();
        Ok(Self { width, height, channels, pixels, decoded, color, alpha, metadata })
    }

    /// An image of single floats, one pixel after another from a function of (x, y); `N` is the
    /// number of channels.
    ///
    /// # Panics
    /// If a side is zero, `channels` is empty, or there is no memory for the image.
    pub fn from_fn<const N: usize>(
        width: u32,
        height: u32,
        channels: [&str; N],
        pixel: impl FnMut(u32, u32) -> [f32; N],
    ) -> Self {
        Self::try_from_fn(width, height, channels, pixel).expect("the size is valid and fits memory")
    }

    /// [`Self::from_fn`], but refused where the size is not valid or there is no memory for it.
    pub fn try_from_fn<const N: usize>(
        width: u32,
        height: u32,
        channels: [&str; N],
        mut pixel: impl FnMut(u32, u32) -> [f32; N],
    ) -> Result<Self, ImageError> {
        let mut values = reserved((width as usize).saturating_mul(height as usize).saturating_mul(N))?;
        for y in 0..height {
            for x in 0..width {
                values.extend_from_slice(&pixel(x, y));
            }
        }
        Self::new(width, height, channels, Pixels::F32(values))
    }

    /// Number of columns.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Number of rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The names of the channels, in the order of their values.
    pub fn channels(&self) -> &[String] {
        &self.channels
    }

    /// Number of channels.
    pub fn channel_count(&self) -> usize {
        self.channels.len()
    }

    /// The index of a channel of exactly this name.
    pub fn channel_index(&self, name: &str) -> Option<usize> {
        self.channels.iter().position(|channel| channel == name)
    }

    /// The stored values.
    pub fn pixels(&self) -> &Pixels {
        &self.pixels
    }

    /// Bytes that the pixels take.
    pub fn byte_size(&self) -> usize {
        match &self.pixels {
            Pixels::U8(values, _) => values.len(),
            Pixels::F16(values) => 2 * values.len(),
            Pixels::F32(values) => 4 * values.len(),
        }
    }

    /// Where the pixels lie in the full frame.
    pub fn data_window(&self) -> Window {
        self.metadata.data_window.unwrap_or(Window::of_size(self.width, self.height))
    }

    /// The full frame, of which the pixels may be a part.
    pub fn display_window(&self) -> Window {
        self.metadata.display_window.unwrap_or_else(|| self.data_window())
    }

    fn offset(&self, x: u32, y: u32) -> usize {
        (y as usize * self.width as usize + x as usize) * self.channels.len()
    }

    fn value(&self, index: usize, c: usize) -> f32 {
        match &self.pixels {
            Pixels::U8(values, _) if self.alpha == Some(c) => f32::from(values[index]) / 255.0,
            Pixels::U8(values, _) => self.decoded[values[index] as usize],
            Pixels::F16(values) => values[index].to_f32(),
            Pixels::F32(values) => values[index],
        }
    }

    /// Writes the linear values of all channels of pixel (x, y), which is in the image.
    #[inline]
    pub(crate) fn pixel(&self, x: u32, y: u32, values: &mut [f32]) {
        let offset = self.offset(x, y);
        for (c, value) in values.iter_mut().enumerate() {
            *value = self.value(offset + c, c);
        }
    }

    /// The linear value of channel `c` at pixel (x, y).
    ///
    /// # Panics
    /// If the pixel or the channel is not in the image.
    pub fn channel(&self, x: u32, y: u32, c: usize) -> f32 {
        assert!(x < self.width && y < self.height && c < self.channels.len());
        self.value(self.offset(x, y) + c, c)
    }

    /// Sets channel `c` of pixel (x, y) to a linear value, as near as the storage can.
    ///
    /// # Panics
    /// If the pixel or the channel is not in the image.
    pub fn set_channel(&mut self, x: u32, y: u32, c: usize, value: f32) {
        assert!(x < self.width && y < self.height && c < self.channels.len());
        let index = self.offset(x, y) + c;
        match &mut self.pixels {
            Pixels::U8(values, _) if self.alpha == Some(c) => {
                values[index] = ColorEncoding::Linear.quantize(value)
            }
            Pixels::U8(values, encoding) => values[index] = encoding.quantize(value),
            Pixels::F16(values) => values[index] = f16::from_f32(value),
            Pixels::F32(values) => values[index] = value,
        }
    }

    /// The linear colour of pixel (x, y): the R, G and B channels (of the first layer that has
    /// them), else Y or the first channel three times.
    ///
    /// # Panics
    /// If the pixel is not in the image.
    pub fn rgb(&self, x: u32, y: u32) -> [f32; 3] {
        assert!(x < self.width && y < self.height);
        let offset = self.offset(x, y);
        let at = self.color.map(|c| offset + c);
        match &self.pixels {
            Pixels::U8(values, _) => at.map(|index| self.decoded[values[index] as usize]),
            Pixels::F16(values) => at.map(|index| values[index].to_f32()),
            Pixels::F32(values) => at.map(|index| values[index]),
        }
    }

    /// [`Self::rgb`] at any (x, y).
    pub fn rgb_wrapped(&self, x: i32, y: i32, wrap: WrapMode) -> [f32; 3] {
        wrap.apply(x, y, self.width, self.height).map_or([0.0; 3], |(x, y)| self.rgb(x, y))
    }

    /// The channels that [`Self::rgb`] reads.
    pub fn color_channels(&self) -> [usize; 3] {
        self.color
    }

    /// The linear values of 8-bit codes.
    pub(crate) fn decoded(&self) -> &[f32] {
        &self.decoded
    }

    /// The number of values of all pixels and channels.
    pub(crate) fn value_count(&self) -> usize {
        self.pixels.len()
    }

    /// Whether the image has colour: R, G and B channels.
    pub fn is_color(&self) -> bool {
        self.color[0] != self.color[1]
    }

    /// The channel of opacity, A, if there is one; of several layers the first.
    pub fn alpha_index(&self) -> Option<usize> {
        self.alpha
    }

    /// The bilinearly interpolated value of a channel at `st`, where [0, 1]² covers the image and t
    /// runs down.
    pub fn bilerp(&self, st: Point2, c: usize, wrap: WrapMode) -> f32 {
        let [value] = self.bilinear(st, [c], wrap);
        value
    }

    /// [`Self::bilerp`] of the colour.
    #[inline(always)]
    pub fn bilerp_rgb<R: Real>(&self, st: Point2<R>, wrap: WrapMode) -> [R; 3] {
        self.bilinear(st, self.color, wrap)
    }

    /// The channels of these names, in this order; `None` if one is absent.
    pub fn select(&self, names: &[&str]) -> Option<Self> {
        let indices = names.iter().map(|name| self.channel_index(name)).collect::<Option<Vec<_>>>()?;
        self.gather(self.width, self.height, &indices, names, |x, y| (x, y)).ok()
    }

    /// The pixels inside `window`, in pixel indices of this image; refused if it is empty or
    /// reaches outside.
    pub fn crop(&self, window: Window) -> Result<Self, ImageError> {
        let [x0, y0] = window.min;
        let whole = Window::of_size(self.width, self.height);
        if x0 < 0 || y0 < 0 || window.max[0] > whole.max[0] || window.max[1] > whole.max[1] {
            return Err(ImageError::Invalid(format!("{window:?} reaches outside {whole:?}")));
        }
        let indices: Vec<usize> = (0..self.channels.len()).collect();
        let mut image = self.gather(window.width(), window.height(), &indices, &self.channels, |x, y| {
            (x + x0 as u32, y + y0 as u32)
        })?;
        let origin = self.data_window().min;
        image.metadata.display_window = Some(self.display_window());
        image.metadata.data_window = Some(Window {
            min: [origin[0] + x0, origin[1] + y0],
            max: [origin[0] + window.max[0], origin[1] + window.max[1]],
        });
        Ok(image)
    }

    /// The same image stored as single floats.
    pub fn to_f32(&self) -> Self {
        self.with_pixels(Pixels::F32(self.values().collect()))
    }

    /// The same image stored as half floats; what is too large for them becomes infinite.
    pub fn to_f16(&self) -> Self {
        self.with_pixels(Pixels::F16(self.values().map(f16::from_f32).collect()))
    }

    /// The same image stored as 8-bit codes; values are clamped to [0, 1].
    ///
    /// # Panics
    /// If there is no memory for it.
    pub fn to_u8(&self, encoding: ColorEncoding) -> Self {
        let codes = self.codes(encoding).expect("there is memory for a quarter of what there is already");
        self.with_pixels(Pixels::U8(codes, encoding))
    }

    /// The same image stored as `other` is; refused where there is no memory for it.
    pub(crate) fn stored_as(&self, other: &Pixels) -> Result<Self, ImageError> {
        let count = self.pixels.len();
        Ok(self.with_pixels(match other {
            Pixels::U8(_, encoding) => Pixels::U8(self.codes(*encoding)?, *encoding),
            Pixels::F16(_) => Pixels::F16(collected(count, self.values().map(f16::from_f32))?),
            Pixels::F32(_) => Pixels::F32(collected(count, self.values())?),
        }))
    }

    /// All values as 8-bit codes; refused where there is no memory for them.
    fn codes(&self, encoding: ColorEncoding) -> Result<Vec<u8>, ImageError> {
        /// Fewer values than this take less time than the table.
        const FEW: usize = 1 << 13;
        let row_length = self.channels.len() * self.width as usize;
        let mut codes = filled(self.pixels.len(), 0)?;
        let quantizer = (codes.len() > FEW).then(|| Quantizer::new(encoding));
        let row_of_codes = |values: &mut Vec<f32>, (row, y): (&mut [u8], u32)| {
            self.row(y, values);
            for (code, &value) in row.iter_mut().zip(&*values) {
                *code =
                    quantizer.as_ref().map_or_else(|| encoding.quantize(value), |table| table.code(value));
            }
            for index in self.opacities(row.len()) {
                row[index] = ColorEncoding::Linear.quantize(values[index]);
            }
        };
        let rows = codes.par_chunks_mut(row_length).zip(0..self.height);
        rows.for_each_init(|| vec![0.0; row_length], row_of_codes);
        Ok(codes)
    }

    /// Which values of a row of `length` values are opacities.
    fn opacities(&self, length: usize) -> impl Iterator<Item = usize> + use<> {
        let count = self.channels.len();
        self.alpha.into_iter().flat_map(move |first| (first..length).step_by(count))
    }

    /// All linear values, as stored: row by row, pixel by pixel, channel by channel.
    pub fn values(&self) -> impl Iterator<Item = f32> + '_ {
        let count = self.channels.len();
        (0..self.pixels.len()).map(move |index| self.value(index, index % count))
    }

    fn with_pixels(&self, pixels: Pixels) -> Self {
        let (channels, metadata) = (self.channels.clone(), self.metadata.clone());
        Self { decoded: pixels.decoded(), pixels, channels, metadata, ..*self }
    }

    /// A new image of `indices` of the channels, whose pixel (x, y) is pixel `source(x, y)` of this
    /// one.
    fn gather(
        &self,
        width: u32,
        height: u32,
        indices: &[usize],
        names: &[impl AsRef<str>],
        source: impl Fn(u32, u32) -> (u32, u32),
    ) -> Result<Self, ImageError> {
        let offsets = || {
            (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).flat_map(|(x, y)| {
                let (x, y) = source(x, y);
                let offset = self.offset(x, y);
                indices.iter().map(move |c| offset + c)
            })
        };
        let count = width as usize * height as usize * indices.len();
        let pixels = match &self.pixels {
            Pixels::U8(values, encoding) => {
                Pixels::U8(collected(count, offsets().map(|i| values[i]))?, *encoding)
            }
            Pixels::F16(values) => Pixels::F16(collected(count, offsets().map(|i| values[i]))?),
            Pixels::F32(values) => Pixels::F32(collected(count, offsets().map(|i| values[i]))?),
        };
        let mut image = Self::new(width, height, names.iter().map(AsRef::as_ref), pixels)?;
        image.metadata = self.metadata.clone();
        Ok(image)
    }
}

impl PixelSource for Image {
    fn width(&self) -> u32 {
        self.width
    }

    fn height(&self) -> u32 {
        self.height
    }

    fn channels(&self) -> Vec<Channel> {
        let depth = match self.pixels {
            Pixels::U8(..) => SampleDepth::U8,
            Pixels::F16(_) => SampleDepth::F16,
            Pixels::F32(_) => SampleDepth::F32,
        };
        self.channels.iter().map(|name| Channel { name: name.clone(), depth }).collect()
    }

    fn metadata(&self) -> &ImageMetadata {
        &self.metadata
    }

    fn row(&self, y: u32, values: &mut [f32]) {
        let (start, count) = (self.offset(0, y), self.channels.len());
        let range = start..start + self.width as usize * count;
        match &self.pixels {
            Pixels::F32(pixels) => values.copy_from_slice(&pixels[range]),
            Pixels::F16(pixels) => {
                values.iter_mut().zip(&pixels[range]).for_each(|(value, pixel)| *value = pixel.to_f32());
            }
            Pixels::U8(pixels, _) => {
                for (value, code) in values.iter_mut().zip(&pixels[range]) {
                    *value = self.decoded[usize::from(*code)];
                }
                for index in self.opacities(values.len()) {
                    values[index] = self.value(start + index, index % count);
                }
            }
        }
    }
}
