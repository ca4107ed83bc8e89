//! Pictures as encoders see them: rows of numbers that may be computed while they are written.

use crate::{ImageMetadata, SampleDepth, Window};

/// A channel of a [`PixelSource`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Channel {
    /// Its name.
    pub name: String,
    /// How its values are best stored.
    pub depth: SampleDepth,
}

/// A picture that can be written: an [`Image`](crate::Image), or something that computes its rows
/// on demand, so that a large picture needs no copy in memory.
pub trait PixelSource: Sync {
    /// Number of columns.
    fn width(&self) -> u32;

    /// Number of rows.
    fn height(&self) -> u32;

    /// The channels, in the order of their values.
    fn channels(&self) -> Vec<Channel>;

    /// Its metadata.
    fn metadata(&self) -> &ImageMetadata;

    /// Writes the linear values of row `y` to `values`, pixel by pixel from the left, the channels
    /// of a pixel side by side.
    fn row(&self, y: u32, values: &mut [f32]);

    /// Where the pixels lie in the full frame.
    fn data_window(&self) -> Window {
        self.metadata().data_window.unwrap_or(Window::of_size(self.width(), self.height()))
    }

    /// The full frame, of which the pixels may be a part.
    fn display_window(&self) -> Window {
        self.metadata().display_window.unwrap_or_else(|| self.data_window())
    }
}

/// Which channels are red, green and blue: R, G, B by name, else those of the first layer that has
/// them ("layer.R"), else Y, else the first channel.
pub(crate) fn color_channels(channels: &[impl AsRef<str>]) -> [usize; 3] {
    let find = |name: &str| channels.iter().position(|channel| channel.as_ref() == name);
    let layers = channels.iter().filter_map(|c| c.as_ref().strip_suffix('R').filter(|l| l.ends_with('.')));
    for layer in std::iter::once("").chain(layers) {
        if let [Some(r), Some(g), Some(b)] = ["R", "G", "B"].map(|c| find(&format!("{layer}{c}"))) {
            return [r, g, b];
        }
    }
    [find("Y").unwrap_or(0); 3]
}

/// The channel of opacity: A by name, else that of the first layer that has one.
pub(crate) fn alpha_channel(channels: &[impl AsRef<str>]) -> Option<usize> {
    channels
        .iter()
        .position(|name| name.as_ref() == "A")
        .or_else(|| channels.iter().position(|name| name.as_ref().ends_with(".A")))
}

impl AsRef<str> for Channel {
    fn as_ref(&self) -> &str {
        &self.name
    }
}
