//! What the server sends: text, or channels of a picture, encoded row by row while they are sent.

use std::convert::Infallible;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};

use alhazen::image::{PixelSource, SampleDepth};
use half::f16;
use hyper::body::{Body, Bytes, Frame, SizeHint};

use crate::live::snapshot::Snapshot;

/// The bytes that are encoded at a time, if they are more than a row.
const BAND: u64 = 1 << 16;

/// The body of a reply.
pub enum Content {
    /// All of it.
    Text(Option<Bytes>),
    /// Channels of a picture.
    Pixels(Pixels),
}

/// Channels of a picture: rows from the top, pixels from the left, channels; halves or single
/// floats, little-endian.
pub struct Pixels {
    snapshot: Arc<Snapshot>,
    channels: Vec<usize>,
    depth: SampleDepth,
    /// The next row.
    y: u32,
    /// A row of all channels.
    row: Vec<f32>,
}

impl Pixels {
    /// The channels with these indices, as halves if a file would have all of them as halves;
    /// `None` if there is no such channel.
    pub fn new(snapshot: Arc<Snapshot>, channels: Vec<usize>) -> Option<Self> {
        let known = snapshot.channels();
        let depths = channels.iter().map(|&channel| Some(known.get(channel)?.depth));
        let depths: Vec<SampleDepth> = depths.collect::<Option<_>>()?;
        let is_half = depths.iter().all(|&depth| depth == SampleDepth::F16);
        let depth = if is_half { SampleDepth::F16 } else { SampleDepth::F32 };
        let row = vec![0.0; snapshot.width() as usize * known.len()];
        Some(Self { snapshot, channels, depth, y: 0, row })
    }

    /// The name of the type of the values.
    pub fn kind(&self) -> &'static str {
        if self.depth == SampleDepth::F16 { "f16" } else { "f32" }
    }

    fn row_bytes(&self) -> u64 {
        let size = if self.depth == SampleDepth::F16 { 2 } else { 4 };
        size * self.channels.len() as u64 * u64::from(self.snapshot.width())
    }

    fn rest(&self) -> u64 {
        self.row_bytes() * u64::from(self.snapshot.height() - self.y)
    }

    fn next_band(&mut self) -> Bytes {
        let rows = (BAND / self.row_bytes()).max(1).min(u64::from(self.snapshot.height() - self.y));
        let mut bytes = Vec::with_capacity((rows * self.row_bytes()) as usize);
        let count = self.row.len() / self.snapshot.width() as usize;
        for _ in 0..rows {
            self.snapshot.row(self.y, &mut self.row);
            self.y += 1;
            let values =
                self.row.chunks_exact(count).flat_map(|pixel| self.channels.iter().map(|&c| pixel[c]));
            match self.depth {
                SampleDepth::F16 => values.for_each(|value| bytes.extend(f16::from_f32(value).to_le_bytes())),
                _ => values.for_each(|value| bytes.extend(value.to_le_bytes())),
            }
        }
        bytes.into()
    }
}

impl Body for Content {
    type Data = Bytes;
    type Error = Infallible;

    fn poll_frame(
        self: Pin<&mut Self>,
        _: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, Infallible>>> {
        let bytes = match self.get_mut() {
            Self::Text(text) => text.take(),
            Self::Pixels(pixels) => (pixels.rest() > 0).then(|| pixels.next_band()),
        };
        Poll::Ready(bytes.map(|bytes| Ok(Frame::data(bytes))))
    }

    fn is_end_stream(&self) -> bool {
        self.size_hint().exact() == Some(0)
    }

    fn size_hint(&self) -> SizeHint {
        SizeHint::with_exact(match self {
            Self::Text(text) => text.as_ref().map_or(0, |text| text.len() as u64),
            Self::Pixels(pixels) => pixels.rest(),
        })
    }
}
