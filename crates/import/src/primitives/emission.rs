//! Where an image of emission is not black, so that only triangles that emit become lights.

use description::{EdgeMode, UvImageDesc, WrapMode};
use image::Image;
use math::{DVec2, Point2};

/// Which parts of an image emit.
pub(super) struct Emitting {
    size: [usize; 2],
    /// How many texels of the rectangle from the upper left corner to each texel emit.
    sums: Vec<u32>,
}

/// Images are divided into at most this many rows and columns.
const FINEST: u32 = 1024;

/// Lookups at larger coordinates may be anywhere, as floats are not exact there.
const LARGEST: f64 = 1e4;

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

    /// Whether a triangle of these texture coordinates, with v up, may emit anywhere by the image
    /// as it is mapped and goes on beyond its edges.
    pub fn is_met(&self, map: &UvImageDesc, corners: [Point2; 3]) -> bool {
        let [columns, rows] = self.size;
        let [across, down] = match map.wrap {
            WrapMode::Repeat => [EdgeMode::Repeat; 2],
            WrapMode::Black => [EdgeMode::Black; 2],
            WrapMode::Clamp => [EdgeMode::Clamp; 2],
            WrapMode::Axes(axes) => axes,
            WrapMode::OctahedralSphere => return self.counted([0, columns], [0, rows]) > 0,
        };
        let [u, v, one] = map.columns.map(|column| DVec2::from(column.map(f64::from)));
        let places = corners.map(|uv| u * f64::from(uv.x) + v * f64::from(uv.y) + one);
        let across = parts(places.map(|st| st.x), across, columns);
        let down = parts(places.map(|st| 1.0 - st.y), down, rows);
        across.iter().any(|&x| down.iter().any(|&y| self.counted(x, y) > 0))
    }

    /// How many texels of a range of columns and one of rows emit.
    fn counted(&self, [left, right]: [usize; 2], [top, bottom]: [usize; 2]) -> u32 {
        let at = |x: usize, y: usize| self.sums[y * (self.size[0] + 1) + x];
        at(right, bottom) + at(left, top) - at(left, bottom) - at(right, top)
    }
}

/// The texels, in up to two ranges, that lookups at coordinates between some may read.
fn parts(coordinates: [f64; 3], mode: EdgeMode, count: usize) -> [[usize; 2]; 2] {
    let least = coordinates.into_iter().fold(f64::INFINITY, f64::min);
    let most = coordinates.into_iter().fold(f64::NEG_INFINITY, f64::max);
    if least.abs().max(most.abs()) >= LARGEST {
        return [[0, count], [0, 0]];
    }
    // Lookups interpolate between neighbours.
    let texel = |v: f64, beyond: f64| (v * count as f64 + beyond).floor() as i64;
    let (first, last, size) = (texel(least, -1.5), texel(most, 2.5), count as i64);
    let inside = |texel: i64| texel.clamp(0, size) as usize;
    match mode {
        // At the edge, or beyond it, lookups read the last texel at least.
        EdgeMode::Black | EdgeMode::Clamp => [[inside(first.min(size - 1)), inside(last.max(1))], [0, 0]],
        EdgeMode::Repeat if last - first >= size => [[0, count], [0, 0]],
        EdgeMode::Repeat => {
            let start = first.rem_euclid(size);
            let end = start + last - first;
            [[inside(start), inside(end)], [0, inside(end - size)]]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use description::Handle;

    /// An image of 64 columns and 32 rows, of which one texel emits: that of column 30 and row 10
    /// from the top. Whether a small triangle at (u, v) does.
    fn lit(change: impl Fn(UvImageDesc) -> UvImageDesc) -> impl Fn(f32, f32) -> bool {
        let lit = |x, y| if (x, y) == (30, 10) { [0.0, 0.5, 0.0] } else { [0.0; 3] };
        let emitting = Emitting::of(&Image::from_fn(64, 32, ["R", "G", "B"], lit));
        let map = change(UvImageDesc::new(Handle::new(0), WrapMode::Clamp));
        move |u, v| emitting.is_met(&map, at(u, v))
    }

    fn at(u: f32, v: f32) -> [Point2; 3] {
        [[0.0, 0.0], [0.02, 0.0], [0.0, 0.02]].map(|[x, y]| Point2::new(u + x, v + y))
    }

    const U: f32 = 30.0 / 64.0;
    const V: f32 = 1.0 - 10.5 / 32.0;

    #[test]
    fn triangles_emit_where_the_image_does() {
        let emits = lit(|map| map);
        assert!(emits(U, V));
        assert!(!emits(U, 10.5 / 32.0), "v is up");
        assert!(!emits(0.1, 0.1));
        assert!(!emits(U + 1.0, V), "clamped");
        let emitting = Emitting::of(&Image::from_fn(4, 4, ["R", "G", "B"], |x, _| [x as f32 - 2.0; 3]));
        let large = [Point2::new(-5.0, -5.0), Point2::new(9.0, -5.0), Point2::new(0.0, 9.0)];
        let map = UvImageDesc::new(Handle::new(0), WrapMode::Clamp);
        assert!(emitting.is_met(&map, large));
        assert!(emitting.is_met(&map, at(40.0, 0.5)), "the last column goes on");
    }

    #[test]
    fn triangles_emit_on_all_tiles_of_a_repeated_image() {
        let emits = lit(|map| UvImageDesc { wrap: WrapMode::Repeat, ..map });
        for tile in [-7.0, -1.0, 0.0, 3.0] {
            assert!(emits(U + tile, V - tile), "{tile}");
            assert!(!emits(0.1 + tile, 0.1 - tile), "{tile}");
            assert!(!emits(0.99 + tile, V), "across the edge of {tile}");
        }
        assert!(emits(1e6, 1e6), "where floats are not exact");
        assert!(emits(f32::MAX, f32::MAX));
        let wrap = WrapMode::Axes([EdgeMode::Repeat, EdgeMode::Clamp]);
        let emits = lit(|map| UvImageDesc { wrap, ..map });
        assert!(emits(U - 2.0, V) && !emits(U, V - 2.0));
    }

    #[test]
    fn triangles_emit_where_the_moved_image_does() {
        // Turned by a quarter, and twice as large.
        let columns = [[0.0, 0.5], [-0.5, 0.0], [1.0, 0.25]];
        let emits = lit(|map| UvImageDesc { columns, ..map });
        let (u, v) = (2.0 * (V - 0.25), 2.0 * (1.0 - U));
        assert!(emits(u, v) && !emits(u + 0.5, v) && !emits(U, V));
    }
}
