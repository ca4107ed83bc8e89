//! Photons and their gathering.

use super::record;

record! {
    /// The work of a kernel: a rectangle of pixels, or as many light paths.
    pub struct Batch {
        low: [u32; 2],
        size: [u32; 2],
        pass_number: u32,
        makes_photons: u32,
        /// The light paths of this batch, and the most photons of each.
        first: u32,
        count: u32,
        most: u32,
        /// The radius, and the grid: cells per length, buckets, and the word where their starts
        /// are.
        radius: f32,
        cells_per_length: f32,
        buckets: u32,
        starts: u32,
        /// n π r² for n light paths.
        merging: f32,
        rays: u32 as "atomic<u32>",
        unused: u32,
        /// The wavelengths of the pass, and their densities.
        lambda: [f32; 4],
        pdf: [f32; 4],
    }
    "words: array<vec4u>"
}
