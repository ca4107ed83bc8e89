//! The samples of pixels, one for each.

use super::record;

record! {
    /// The work of a kernel: a sample of each pixel of a rectangle.
    pub struct Batch {
        low: [u32; 2],
        size: [u32; 2],
        /// The index of the sample of each pixel.
        index: u32,
        /// The splats for which there is room, and their number.
        most: u32,
        count: u32 as "atomic<u32>",
        unused: u32,
    }
    "splats: array<Splat>"
}

record! {
    /// Light on the film from the light path of a pixel of the batch.
    pub struct Splat {
        film: [f32; 2],
        path: u32,
        unused: u32,
        l: [f32; 4],
    }
}

record! {
    /// The result of a pixel.
    pub struct PixelSample {
        /// The radiance.
        l: [f32; 4],
        /// The number of rays.
        rays: u32,
        /// Whether only the first wavelength is left, the lowest bit.
        flags: u32,
        /// The random number of the wavelengths.
        wavelength: f32,
        /// The weight in the pixel.
        weight: f32,
    }
}
