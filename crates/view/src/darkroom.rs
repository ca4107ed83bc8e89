//! From the numbers of a picture to the codes of a display.

use std::num::NonZero;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::available_parallelism;

use alhazen::film::Layer;
use alhazen::image::{ColorEncoding, Display, DisplaySettings};

use crate::Frame;

/// Pixels that a thread takes at a time.
const CHUNK: usize = 1 << 14;

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
    let parts: Vec<_> = codes.chunks_mut(4 * CHUNK).zip(frame.pixels.chunks(CHUNK)).map(Some).collect();
    let parts = std::sync::Mutex::new(parts);
    let next = AtomicUsize::new(0);
    let work = || {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let part = {
                let mut parts = parts.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                parts.get_mut(index).and_then(Option::take)
            };
            let Some((codes, pixels)) = part else { return };
            for (code, pixel) in codes.chunks_exact_mut(4).zip(pixels) {
                code[..3].copy_from_slice(&show.codes(*pixel, &display));
            }
        }
    };
    let threads = available_parallelism().map_or(1, NonZero::get).min(frame.pixels.len().div_ceil(CHUNK));
    std::thread::scope(|scope| {
        (1..threads).for_each(|_| drop(scope.spawn(work)));
        work();
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
        match frame.layer {
            None => Self::Light,
            Some(layer) if layer.is_part() || layer == Layer::Albedo => Self::Light,
            Some(
                Layer::Normal | Layer::GeometricNormal | Layer::CameraNormal | Layer::CameraGeometricNormal,
            ) => Self::Direction,
            Some(Layer::Uv | Layer::Position | Layer::CameraPosition) => Self::Coordinates,
            Some(_) => {
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
