//! The pictures of a page and their error maps, as data URIs.

use alhazen::data_uri;
use alhazen::image::false_color::signed_false_color;
use alhazen::image::metrics::RELATIVE_EPSILON;
use alhazen::image::{Image, ImageError, require_memory};

use crate::Comparison;

/// Width of the blocks over which errors are averaged, in pixels.
const BLOCK: u32 = 8;

/// The fraction of a map's values that its colour scale covers.
const WITHIN_SCALE: f64 = 0.98;

/// The most bytes of a pixel that a run's pictures take: two maps of floats, three PNGs of three
/// channels in base64, each in [`Maps`], in the gallery and in the page.
const RUN_BYTES: usize = 2 * 4 + 3 * 3 * 4;

/// The most bytes of a pixel for the other pictures: the reference's, and one picture while it is
/// converted to sRGB, encoded as PNG and as base64.
const OTHER_BYTES: usize = 3 * 4 + 3 * 4 + 2 * 3 + 4;

/// Every picture of a page as a data URI.
pub struct Maps {
    pub reference: String,
    pub runs: Vec<RunMaps>,
    /// The relative error at the end of the colour scale.
    pub scale: f32,
    /// The same for errors over blocks.
    pub block_scale: f32,
}

/// The pictures of one run.
pub struct RunMaps {
    pub picture: String,
    pub error: String,
    pub blocks: String,
}

impl Maps {
    /// Refused where there is no memory for a page of these pictures.
    pub fn new(comparison: &Comparison) -> Result<Self, ImageError> {
        let reference = &comparison.reference.picture;
        let bytes = RUN_BYTES * comparison.runs.len() + OTHER_BYTES;
        require_memory(bytes * reference.width() as usize * reference.height() as usize)?;
        let errors: Vec<Image> =
            comparison.runs.iter().map(|run| error_map(reference, &run.pictures[..1])).collect();
        let blocks: Vec<Image> =
            comparison.runs.iter().map(|run| block_means(&error_map(reference, &run.pictures))).collect();
        let (scale, block_scale) = (scale(&errors), scale(&blocks));
        let runs =
            comparison.runs.iter().zip(errors.iter().zip(&blocks)).map(|(run, (error, blocks))| RunMaps {
                picture: data_uri(&run.pictures[0]),
                error: colored(error, scale),
                blocks: colored(blocks, block_scale),
            });
        Ok(Self { reference: data_uri(reference), runs: runs.collect(), scale, block_scale })
    }
}

/// The mean relative error of some pictures at each pixel: the mean over channels of
/// (x − r) / √(r² + 0.01).
fn error_map(reference: &Image, pictures: &[Image]) -> Image {
    Image::from_fn(reference.width(), reference.height(), ["Y"], |x, y| {
        let r = reference.rgb(x, y);
        let error = |picture: &Image| {
            let value = picture.rgb(x, y);
            (0..3).map(|c| (value[c] - r[c]) / r[c].hypot(RELATIVE_EPSILON.sqrt() as f32)).sum::<f32>() / 3.0
        };
        [pictures.iter().map(error).sum::<f32>() / pictures.len() as f32]
    })
}

/// Replaces each pixel by the mean of its block.
fn block_means(map: &Image) -> Image {
    let [width, height] = [map.width(), map.height()].map(|side| side.div_ceil(BLOCK));
    let means = Image::from_fn(width, height, ["Y"], |x, y| {
        let columns = x * BLOCK..((x + 1) * BLOCK).min(map.width());
        let rows = y * BLOCK..((y + 1) * BLOCK).min(map.height());
        let count = (columns.len() * rows.len()) as f32;
        [rows.map(|y| columns.clone().map(|x| map.channel(x, y, 0)).sum::<f32>()).sum::<f32>() / count]
    });
    Image::from_fn(map.width(), map.height(), ["Y"], |x, y| [means.channel(x / BLOCK, y / BLOCK, 0)])
}

/// The error at the end of the colour scale: 1, 2 or 5 times a power of ten, which nearly all
/// values of the median map do not exceed, so that one map with large errors does not darken the
/// others.
fn scale(maps: &[Image]) -> f32 {
    let mut sizes: Vec<f32> = maps.iter().map(quantile).collect();
    sizes.sort_by(f32::total_cmp);
    let size = sizes[(sizes.len() - 1) / 2].max(1e-6);
    let decade = 10f32.powf(size.log10().floor());
    [1.0, 2.0, 5.0]
        .map(|step| step * decade)
        .into_iter()
        .find(|&round| round >= size)
        .unwrap_or(10.0 * decade)
}

/// The magnitude that nearly all finite values of a map do not exceed; 1 where none is finite.
fn quantile(map: &Image) -> f32 {
    let mut sizes: Vec<f32> = map.values().map(f32::abs).filter(|size| size.is_finite()).collect();
    if sizes.is_empty() {
        return 1.0;
    }
    let place = ((sizes.len() - 1) as f64 * WITHIN_SCALE) as usize;
    *sizes.select_nth_unstable_by(place, f32::total_cmp).1
}

fn colored(map: &Image, scale: f32) -> String {
    data_uri(&signed_false_color(map, scale).expect("invariant: a map is not empty"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_signed_and_scales_round() {
        let flat = |value: f32| Image::from_fn(10, 9, ["R", "G", "B"], |_, _| [value; 3]);
        let map = error_map(&flat(2.0), &[flat(1.0), flat(2.2)]);
        assert!((map.channel(3, 4, 0) + 0.2).abs() < 1e-3);
        assert_eq!(scale(&[flat(100.0), map]), 0.2, "of the map with smaller errors");
        assert_eq!(scale(&[flat(0.0)]), 1e-6);
    }

    #[test]
    fn blocks_have_the_mean_of_their_pixels() {
        let map = Image::from_fn(10, 9, ["Y"], |x, y| [if x < 8 && y < 8 { (x % 2) as f32 } else { 3.0 }]);
        let blocks = block_means(&map);
        assert_eq!(
            (blocks.channel(7, 7, 0), blocks.channel(9, 2, 0), blocks.channel(2, 8, 0)),
            (0.5, 3.0, 3.0)
        );
    }
}
