//! From the numbers of a picture to the codes of a display.

use std::num::NonZero;
use std::thread::available_parallelism;

use alhazen::film::{Layer, Quantity};
use alhazen::image::{ColorEncoding, Display, DisplaySettings};

use crate::Frame;

/// Distances from here on are those of nothing.
const FAR: f32 = 1e9;

/// The red, green, blue and alpha codes of a picture, row by row. Colours are shown as `display`
/// says, directions and coordinates by their components, other numbers as greys between the least
/// and the greatest.
///
/// It has threads of its own, so that it need not wait for those that render.
pub fn develop(frame: &Frame, display: &DisplaySettings) -> Vec<u8> {
    let display = Display::new(display, frame.color_space);
    let show = Shown::of(frame);
    let mut codes = vec![255; 4 * frame.pixels.len()];
    let threads = available_parallelism().map_or(1, NonZero::get);
    let part = frame.pixels.len().div_ceil(threads).max(1);
    std::thread::scope(|scope| {
        for (codes, pixels) in codes.chunks_mut(4 * part).zip(frame.pixels.chunks(part)) {
            let (show, display) = (&show, &display);
            scope.spawn(move || {
                for (code, pixel) in codes.chunks_exact_mut(4).zip(pixels) {
                    code[..3].copy_from_slice(&show.codes(*pixel, display));
                }
            });
        }
    });
    codes
}

/// How numbers are shown.
enum Shown {
    /// As light.
    Light,
    /// From −1 to 1.
    Direction,
    /// As the part beyond the last whole number.
    Coordinates,
    /// From black, the first number, to white.
    Range([f32; 2]),
}

impl Shown {
    fn of(frame: &Frame) -> Self {
        match frame.layer.map_or(Quantity::Light, Layer::quantity) {
            Quantity::Light => Self::Light,
            Quantity::Direction => Self::Direction,
            Quantity::Coordinates => Self::Coordinates,
            Quantity::Opacity | Quantity::Distance | Quantity::Magnitude | Quantity::Number => {
                let values = frame.pixels.iter().flatten().filter(|value| value.abs() < FAR);
                let range = |[low, high]: [f32; 2], value: &f32| [low.min(*value), high.max(*value)];
                Self::Range(values.fold([f32::INFINITY, f32::NEG_INFINITY], range))
            }
        }
    }

    fn codes(&self, pixel: [f32; 3], display: &Display) -> [u8; 3] {
        let grey = |share: f32| (share.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
        match self {
            Self::Light => display.show(pixel).map(|light| ColorEncoding::Srgb.quantize(light)),
            Self::Direction if pixel == [0.0; 3] => [0; 3],
            Self::Direction => pixel.map(|x| grey(0.5 + 0.5 * x)),
            Self::Coordinates => pixel.map(|x| grey(x - x.floor())),
            Self::Range([low, high]) => pixel.map(|x| grey((x - low) / (high - low).max(f32::MIN_POSITIVE))),
        }
    }
}

/// The layers that can be shown: those with one to three numbers.
pub fn layers() -> impl Iterator<Item = Layer> {
    Layer::ALL.into_iter().filter(|layer| (1..=3).contains(&layer.channels(None).len()))
}
