//! Infinite lights behind portals: as all lights the kind, the offset of the spectrum, its scale
//! and a zero; then a corner, and the axes along the edges and out of the scene, four words each;
//! the lengths of the edges, the cells of the density along each axis, the offset of pixels or 0,
//! that of the sums of cells, and the width and height of the image.
//!
//! Sums are of the cells before a column and a row, for each corner of cells, row by row, as
//! integers of two words, the lower one first. All cells together are about 2⁶⁰.

use scene::light::{Emission, PlainPortal, PortalInfiniteLight, PortalRadiance};
use spectrum::RgbUnboundedSpectrum;

use super::Flattener;
use super::slab::padded;
use crate::tags::LightTag;

/// The sum of all cells.
const WHOLE: f64 = (1u64 << 60) as f64;

impl Flattener<'_> {
    /// A light of a kind; its offset.
    pub(super) fn portal(&mut self, tag: LightTag, light: &PortalInfiniteLight) -> u32 {
        self.parts.portals = true;
        let PlainPortal { corner, frame, size, radiance, resolution, brightness } = light.plain();
        let (emission, pixels) = match radiance {
            PortalRadiance::Constant(emission) => (emission.clone(), 0),
            PortalRadiance::Image(image) => {
                let space = image.color_space();
                let pixels = image.pixels().iter().flat_map(|rgb| {
                    let spectrum = RgbUnboundedSpectrum::new(space, rgb.to_array());
                    let [a, b, c] = spectrum.polynomial().coefficients;
                    [spectrum.scale(), a, b, c]
                });
                let pixels = self.slab.add_numbers(pixels);
                (Emission { spectrum: space.illuminant(), scale: image.scale() }, pixels)
            }
        };
        let sums = sums(&brightness, resolution as usize);
        let sums = self.slab.add(sums.into_iter().flat_map(|sum| [sum as u32, (sum >> 32) as u32]));
        let vectors = padded([corner, frame.x, frame.y, frame.z].map(|v| v.to_array()));
        let numbers = [&vectors[..], &size.to_array()].concat();
        let at = self.emitter(tag, &emission, 0, &numbers);
        self.slab.extend([resolution, pixels, sums, resolution, resolution]);
        at
    }
}

/// The sums of cells before each corner. Values that are not finite or not above 0 count as 0.
fn sums(values: &[f32], columns: usize) -> Vec<u64> {
    let positive = |value: f32| if value.is_finite() { f64::from(value.max(0.0)) } else { 0.0 };
    let total: f64 = values.iter().copied().map(positive).sum();
    let scale = if total > 0.0 { WHOLE / total } else { 0.0 };
    let mut sums = vec![0; columns + 1];
    for row in values.chunks_exact(columns) {
        let above = sums.len() - columns - 1;
        let mut sum = 0;
        sums.push(0);
        for (x, &value) in row.iter().enumerate() {
            sum += (positive(value) * scale) as u64;
            sums.push(sums[above + x + 1] + sum);
        }
    }
    sums
}
