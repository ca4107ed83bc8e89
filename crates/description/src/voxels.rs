//! Values on the voxels of a sparse grid.

use std::sync::Arc;

/// Values on the voxels of a sparse grid: bricks of 8³ voxels in a dense table.
#[derive(Clone, Debug, PartialEq)]
pub struct VoxelsDesc {
    /// Index coordinates of the first voxel of the first brick; multiples of 8.
    pub origin: [i32; 3],
    /// Number of bricks in x, y and z.
    pub bricks: [u32; 3],
    /// The brick at each place, x fastest: an index into `values` in units of 512.
    pub table: Arc<[u32]>,
    /// 512 values for each brick, x fastest. Brick 0 has the background value only.
    pub values: Arc<[f32]>,
    /// First and last index coordinates of voxels that are active. The bricks cover one voxel more
    /// on each side, which interpolation between voxels reaches.
    pub active: [[i32; 3]; 2],
    /// From index coordinates (voxel (i,j,k) centred at the integer point) to the medium's space:
    /// rows of an affine 3×4 matrix.
    pub world_from_index: [[f64; 4]; 3],
}

impl Default for VoxelsDesc {
    /// A grid without active voxels, of the value 0.
    fn default() -> Self {
        Self {
            origin: [0; 3],
            bricks: [0; 3],
            table: Arc::new([]),
            values: Arc::new([0.0; 512]),
            active: [[0; 3], [-1; 3]],
            world_from_index: [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]],
        }
    }
}

impl VoxelsDesc {
    /// The value of a voxel; outside of all bricks, of the background.
    pub fn value(&self, index: [i32; 3]) -> f32 {
        let mut brick = 0;
        let mut within = 0;
        for axis in (0..3).rev() {
            let offset = i64::from(index[axis]) - i64::from(self.origin[axis]);
            let count = self.bricks[axis] as usize;
            if offset < 0 || offset / 8 >= count as i64 {
                return self.values[0];
            }
            brick = brick * count + offset as usize / 8;
            within = within * 8 + offset as usize % 8;
        }
        self.values[512 * self.table[brick] as usize + within]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_found_by_their_index_coordinates() {
        let mut values = vec![0.5; 512];
        values.extend((0..512).map(|i| i as f32));
        let voxels = VoxelsDesc {
            origin: [-8, 0, 16],
            bricks: [2, 1, 2],
            table: Arc::from([0, 0, 1, 0]),
            values: Arc::from(values),
            active: [[-8, 0, 24], [-1, 7, 31]],
            world_from_index: [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]],
        };
        assert_eq!(voxels.value([-8, 0, 24]), 0.0);
        assert_eq!(voxels.value([-7, 0, 24]), 1.0);
        assert_eq!(voxels.value([-6, 3, 25]), 2.0 + 24.0 + 64.0);
        assert_eq!(voxels.value([-1, 7, 31]), 511.0);
        for outside in
            [[0, 0, 24], [-1, 7, 23], [-9, 0, 24], [-8, -1, 24], [-8, 8, 24], [i32::MIN; 3], [i32::MAX; 3]]
        {
            assert_eq!(voxels.value(outside), 0.5, "{outside:?}");
        }
    }
}
