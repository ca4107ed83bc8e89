//! Where an image of emission is not black, so that only triangles that emit become lights.

use image::Image;
use math::Point2;

/// Which parts of an image emit.
pub(super) struct Emitting {
    size: [usize; 2],
    /// How many texels of the rectangle from the upper left corner to each texel emit.
    sums: Vec<u32>,
}

/// Images are divided into at most this many rows and columns.
const FINEST: u32 = 1024;

impl Emitting {
    pub fn of(image: &Image) -> Self {
        let step = image.width().max(image.height()).div_ceil(FINEST);
        let [columns, rows] = [image.width(), image.height()].map(|side| side.div_ceil(step) as usize);
        let mut counts = vec![0; columns * rows];
        for (x, y) in (0..image.height()).flat_map(|y| (0..image.width()).map(move |x| (x, y))) {
            if image.rgb(x, y).iter().any(|&v| v > 0.0) {
                counts[(y / step) as usize * columns + (x / step) as usize] = 1;
            }
        }
        let mut sums = vec![0; (columns + 1) * (rows + 1)];
        for (x, y) in (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))) {
            let at = |x: usize, y: usize| y * (columns + 1) + x;
            sums[at(x + 1, y + 1)] =
                counts[y * columns + x] + sums[at(x, y + 1)] + sums[at(x + 1, y)] - sums[at(x, y)];
        }
        Self { size: [columns, rows], sums }
    }

    /// Whether a triangle of these texture coordinates, with v up, may emit anywhere.
    pub fn is_met(&self, corners: [Point2; 3]) -> bool {
        let [columns, rows] = self.size;
        let range = |values: [f32; 3], count: usize| {
            let least = values.into_iter().fold(f32::INFINITY, f32::min);
            let most = values.into_iter().fold(f32::NEG_INFINITY, f32::max);
            // Lookups interpolate between neighbours, and end at the edge.
            let texel = |v: f32, beyond: f32| {
                (v.clamp(0.0, 1.0) * count as f32 + beyond).clamp(0.0, count as f32) as usize
            };
            [texel(least, -1.5), texel(most, 2.5)]
        };
        let [left, right] = range(corners.map(|uv| uv.x), columns);
        let [top, bottom] = range(corners.map(|uv| 1.0 - uv.y), rows);
        let at = |x: usize, y: usize| self.sums[y * (columns + 1) + x];
        at(right, bottom) + at(left, top) > at(left, bottom) + at(right, top)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_emit_where_the_image_does() {
        // One texel, of column 30 and row 10 from the top.
        let lit = |x, y| if (x, y) == (30, 10) { [0.0, 0.5, 0.0] } else { [0.0; 3] };
        let emitting = Emitting::of(&Image::from_fn(64, 32, ["R", "G", "B"], lit));
        let at =
            |u: f32, v: f32| [[0.0, 0.0], [0.02, 0.0], [0.0, 0.02]].map(|[x, y]| Point2::new(u + x, v + y));
        assert!(emitting.is_met(at(30.0 / 64.0, 1.0 - 10.5 / 32.0)));
        assert!(!emitting.is_met(at(30.0 / 64.0, 10.5 / 32.0)), "v is up");
        assert!(!emitting.is_met(at(0.1, 0.1)));
        assert!(emitting.is_met([Point2::new(-5.0, -5.0), Point2::new(9.0, -5.0), Point2::new(0.0, 9.0)]));
    }
}
