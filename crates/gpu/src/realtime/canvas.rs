//! The buffers of a picture of some size.

use math::Bounds2i;

use super::frame::FrameParameters;
use super::reservoirs::{PARTS, RESERVOIR};
use crate::commands::Timer;
use crate::device::{Buffer, Device, GpuError};

/// Bytes of the head of a film, and of what there is for a pixel: the structures of
/// `shaders/realtime/frame.wgsl`.
pub const HEAD: u64 = 16;
pub const LIGHT: u64 = 48;
const SEEN: u64 = 48;
const HISTORY: u64 = 32;
const ESTIMATE: u64 = 16;

/// The buffers of a picture.
pub struct Canvas {
    /// The pixels of the film.
    pub pixels: Bounds2i,
    /// The light of the pixels.
    pub film: Buffer,
    /// What is seen there, and what is known of it: of this frame and of the one before.
    pub seen: Buffer,
    pub history: Buffer,
    /// What is filtered, and what that gives, in turns.
    pub estimates: [Buffer; 2],
    /// Samples of direct light, where these are shared.
    pub reservoirs: Option<Buffer>,
    /// The number of rays, and the colours that are shown.
    pub shown: Buffer,
    /// What reads them back.
    pub timer: Timer,
}

impl Canvas {
    /// For these pixels of the film.
    pub fn new(device: &Device, pixels: Bounds2i, has_reservoirs: bool) -> Result<Self, GpuError> {
        let count = pixels.area() as u64;
        let shown = 4 + 12 * count;
        Ok(Self {
            pixels,
            film: device.zeros("pixels", HEAD + LIGHT * count)?,
            seen: device.zeros("points that are seen", 2 * SEEN * count)?,
            history: device.zeros("earlier frames", 2 * HISTORY * count)?,
            estimates: [
                device.zeros("estimates", ESTIMATE * count)?,
                device.zeros("estimates", ESTIMATE * count)?,
            ],
            reservoirs: match has_reservoirs {
                true => Some(device.zeros("reservoirs", PARTS * RESERVOIR * count)?),
                false => None,
            },
            shown: device.zeros("colours", shown)?,
            timer: Timer::new(device, shown)?,
        })
    }

    /// A frame of it.
    pub fn frame(&self) -> FrameParameters {
        let low = self.pixels.min.map(|x| x as u32);
        FrameParameters {
            low,
            size: [self.pixels.width() as u32, self.pixels.height() as u32],
            ..FrameParameters::default()
        }
    }
}
