//! Lookups outside an image.

/// The value of a lookup outside the pixel rectangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WrapMode {
    /// The image again, as on tiles.
    #[default]
    Repeat,
    /// Zero.
    Black,
    /// The nearest edge pixel.
    Clamp,
    /// The neighbour on the sphere, for square images in the equal-area octahedral mapping
    /// [Clarberg 2008]: crossing an edge re-enters through the same edge, mirrored about its
    /// middle.
    OctahedralSphere,
    /// The neighbour on the sphere, for images of latitude and longitude: rows are closed, and
    /// beyond a pole lies the meridian on the other side.
    LatitudeLongitude,
    /// Columns and rows each by a rule of their own.
    Axes([EdgeMode; 2]),
}

/// The value of a lookup beyond the edges of one axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EdgeMode {
    /// The image again.
    Repeat,
    /// Zero.
    Black,
    /// The nearest edge pixel.
    Clamp,
}

impl EdgeMode {
    /// The pixel of `count` that a lookup at `at` reads; `None` means zero.
    fn apply(self, at: i64, count: i64) -> Option<i64> {
        match self {
            Self::Repeat => Some(at.rem_euclid(count)),
            Self::Black => (0..count).contains(&at).then_some(at),
            Self::Clamp => Some(at.clamp(0, count - 1)),
        }
    }
}

impl WrapMode {
    /// The wrap mode of a name as scene files write it.
    pub fn from_name(name: &str) -> Option<Self> {
        match name {
            "repeat" => Some(Self::Repeat),
            "black" => Some(Self::Black),
            "clamp" => Some(Self::Clamp),
            "octahedralsphere" => Some(Self::OctahedralSphere),
            _ => None,
        }
    }

    /// The pixel inside a `width` × `height` image that a lookup at (x, y) reads; `None` means
    /// zero.
    pub fn apply(self, x: i32, y: i32, width: u32, height: u32) -> Option<(u32, u32)> {
        if (x as u32) < width && (y as u32) < height {
            return Some((x as u32, y as u32));
        }
        let (w, h) = (i64::from(width), i64::from(height));
        let (x, y) = (i64::from(x), i64::from(y));
        let (x, y) = match self {
            Self::Black => return None,
            Self::Repeat => (x.rem_euclid(w), y.rem_euclid(h)),
            Self::Clamp => (x.clamp(0, w - 1), y.clamp(0, h - 1)),
            Self::OctahedralSphere => {
                // An even number of edges crossed in one direction is a whole turn; an odd one
                // mirrors both axes.
                let (tile_x, tile_y) = (x.div_euclid(w), y.div_euclid(h));
                let (x, y) = (x.rem_euclid(w), y.rem_euclid(h));
                if (tile_x + tile_y).rem_euclid(2) == 0 { (x, y) } else { (w - 1 - x, h - 1 - y) }
            }
            Self::LatitudeLongitude => {
                let y = y.rem_euclid(2 * h);
                let (x, y) = if y < h { (x, y) } else { (x + w / 2, 2 * h - 1 - y) };
                (x.rem_euclid(w), y)
            }
            Self::Axes([across, down]) => (across.apply(x, w)?, down.apply(y, h)?),
        };
        Some((x as u32, y as u32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inside_nothing_changes() {
        for wrap in [WrapMode::Repeat, WrapMode::Black, WrapMode::Clamp, WrapMode::OctahedralSphere] {
            assert_eq!(wrap.apply(2, 1, 4, 4), Some((2, 1)));
        }
    }

    #[test]
    fn outside_each_mode_has_its_rule() {
        assert_eq!(WrapMode::Repeat.apply(-1, 4, 4, 4), Some((3, 0)));
        assert_eq!(WrapMode::Clamp.apply(-5, 9, 4, 4), Some((0, 3)));
        assert_eq!(WrapMode::Black.apply(-1, 0, 4, 4), None);
        assert_eq!(WrapMode::Black.apply(0, 4, 4, 4), None);
    }

    #[test]
    fn each_axis_may_have_its_own_rule() {
        use EdgeMode::{Black, Clamp, Repeat};
        assert_eq!(WrapMode::Axes([Repeat, Clamp]).apply(-1, 9, 4, 4), Some((3, 3)));
        assert_eq!(WrapMode::Axes([Clamp, Repeat]).apply(-1, 9, 4, 4), Some((0, 1)));
        assert_eq!(WrapMode::Axes([Repeat, Black]).apply(-1, 2, 4, 4), Some((3, 2)));
        assert_eq!(WrapMode::Axes([Repeat, Black]).apply(2, 4, 4, 4), None);
    }

    #[test]
    fn meridians_go_on_beyond_the_poles() {
        let wrap = WrapMode::LatitudeLongitude;
        assert_eq!(wrap.apply(-1, 1, 8, 4), Some((7, 1)));
        assert_eq!(wrap.apply(9, 1, 8, 4), Some((1, 1)));
        assert_eq!(wrap.apply(1, -1, 8, 4), Some((5, 0)));
        assert_eq!(wrap.apply(6, 4, 8, 4), Some((2, 3)));
        assert_eq!(wrap.apply(0, i32::MIN, 1, 1), Some((0, 0)));
    }

    #[test]
    fn the_sphere_mirrors_the_edge_it_crosses() {
        let wrap = WrapMode::OctahedralSphere;
        assert_eq!(wrap.apply(-1, 0, 4, 4), Some((0, 3)));
        assert_eq!(wrap.apply(4, 1, 4, 4), Some((3, 2)));
        assert_eq!(wrap.apply(1, -1, 4, 4), Some((2, 0)));
        assert_eq!(wrap.apply(1, 4, 4, 4), Some((2, 3)));
        assert_eq!(wrap.apply(-1, -1, 4, 4), Some((3, 3)));
        assert_eq!(wrap.apply(i32::MIN, i32::MAX, 1, 1), Some((0, 0)));
    }
}
