//! The header of a grid.

use super::bytes::{Bytes, text};
use super::{MAGIC, check_version};

/// The number of bytes of a header. The tree follows.
pub(super) const SIZE: usize = 672;

/// What the header of a grid says.
pub(super) struct Header {
    /// The number of bytes of the grid with its header.
    pub(super) length: u64,
    pub(super) name: String,
    /// The number of the type of its values.
    pub(super) kind: u32,
    /// The number of the class, which tells what the values mean.
    pub(super) class: u32,
    /// From index coordinates to those of the volume: rows of an affine matrix.
    pub(super) world_from_index: [[f64; 4]; 3],
}

impl Header {
    pub(super) fn read(bytes: Bytes) -> Result<Self, String> {
        let magic = bytes.array(0)?;
        if &magic != MAGIC[0] && &magic != MAGIC[1] {
            return Err("it is damaged: a grid does not begin with `NanoVDB`".into());
        }
        check_version(bytes.u32(16)?)?;
        let mut world_from_index = [[0.0; 4]; 3];
        for (i, row) in world_from_index.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                // A matrix by rows, and a translation after it and its inverse.
                *entry = bytes.f64(if j < 3 { 384 + 24 * i + 8 * j } else { 528 + 8 * i })?;
            }
        }
        Ok(Self {
            length: bytes.u64(32)?,
            name: text(bytes.part(40, 256)?),
            class: bytes.u32(632)?,
            kind: bytes.u32(636)?,
            world_from_index,
        })
    }

    /// Refuses grids that are no volumes, and degenerate ones.
    pub(super) fn check(&self) -> Result<(), String> {
        const CLASSES: [&str; 10] = [
            "unknown",
            "level set",
            "fog volume",
            "staggered vector grid",
            "point index grid",
            "point data grid",
            "topology grid",
            "voxel volume",
            "index grid",
            "tensor grid",
        ];
        if !matches!(self.class, 0 | 2) {
            let class = CLASSES.get(self.class as usize).unwrap_or(&"grid of an unknown class");
            return Err(format!("it is a {class}, not a fog volume"));
        }
        let [x, y, z] = self.world_from_index;
        let determinant = x[0] * (y[1] * z[2] - y[2] * z[1]) - x[1] * (y[0] * z[2] - y[2] * z[0])
            + x[2] * (y[0] * z[1] - y[1] * z[0]);
        let is_finite = [x, y, z].as_flattened().iter().all(|entry| entry.is_finite());
        if !is_finite || determinant == 0.0 || !determinant.is_finite() {
            return Err("its voxels have no volume, or an infinite one".into());
        }
        Ok(())
    }
}
