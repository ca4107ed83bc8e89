//! The tiles that a film's pixels are cut into.

use std::ops::Range;

use math::Bounds2i;

/// Side of a tile in pixels.
pub const TILE_SIZE: i32 = 16;

/// The pixels of a film in tiles. Tiles are numbered row by row, and so are the pixels of a tile;
/// arrays over the film hold tile after tile.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid(pub(crate) Bounds2i);

impl Grid {
    /// The number of tiles in a row.
    pub(crate) fn columns(self) -> usize {
        (self.0.width() as usize).div_ceil(TILE_SIZE as usize)
    }

    /// The number of rows of tiles.
    pub(crate) fn rows(self) -> usize {
        (self.0.height() as usize).div_ceil(TILE_SIZE as usize)
    }

    pub(crate) fn tile_count(self) -> usize {
        self.columns() * self.rows()
    }

    /// The tiles of a row.
    pub(crate) fn row(self, row: usize) -> Range<usize> {
        row * self.columns()..(row + 1) * self.columns()
    }

    /// The pixels of a tile.
    pub(crate) fn bounds(self, tile: usize) -> Bounds2i {
        let (row, column) = ((tile / self.columns()) as i32, (tile % self.columns()) as i32);
        let min = [self.0.min[0] + column * TILE_SIZE, self.0.min[1] + row * TILE_SIZE];
        Bounds2i::new(min, [0, 1].map(|axis: usize| self.0.max[axis].min(min[axis] + TILE_SIZE)))
    }

    /// Where the pixels of a tile are in an array over the film: whole rows of tiles, then whole
    /// tiles come before it.
    pub(crate) fn range(self, tile: usize) -> Range<usize> {
        let bounds = self.bounds(tile);
        let rows_above = (bounds.min[1] - self.0.min[1]) as usize;
        let columns_left = (bounds.min[0] - self.0.min[0]) as usize;
        let start = rows_above * self.0.width() as usize + columns_left * bounds.height() as usize;
        start..start + bounds.area()
    }

    /// The tile of a pixel, and the pixel's index in it.
    ///
    /// # Panics
    /// If the pixel is not one of the film's.
    pub(crate) fn find(self, pixel: [i32; 2]) -> (usize, usize) {
        assert!(self.0.contains(pixel), "{pixel:?} is not rendered");
        let (x, y) = ((pixel[0] - self.0.min[0]) as usize, (pixel[1] - self.0.min[1]) as usize);
        let side = TILE_SIZE as usize;
        let tile = y / side * self.columns() + x / side;
        (tile, index_in(&self.bounds(tile), pixel))
    }
}

/// The index of a pixel in its tile.
pub(crate) fn index_in(tile: &Bounds2i, [x, y]: [i32; 2]) -> usize {
    (y - tile.min[1]) as usize * tile.width() as usize + (x - tile.min[0]) as usize
}
