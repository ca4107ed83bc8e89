//! Values on a regular grid, interpolated linearly in each axis.
//!
//! The value number i of n along an axis lies at (i + ½)/n of the unit cube. Beyond the outermost
//! values there are zeros, so that near the boundary the grid falls off over half a cell to half
//! the value.

use math::{Bounds3, Point3, lerp};
use std::sync::Arc;

/// Values on a regular grid over the unit cube.
#[derive(Clone, Debug)]
pub struct Grid<T> {
    /// Number of values in x, y and z, at least 1 each.
    resolution: [usize; 3],
    /// The values, x fastest.
    values: Arc<[T]>,
}

impl<T: Copy> Grid<T> {
    /// # Panics
    /// Unless there are as many values as cells.
    pub fn new(resolution: [usize; 3], values: Arc<[T]>) -> Self {
        assert_eq!(values.len(), resolution.iter().product::<usize>(), "one value for each cell");
        Self { resolution, values }
    }

    /// The number of values in x, y and z.
    pub fn resolution(&self) -> [usize; 3] {
        self.resolution
    }

    /// The values, x fastest.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// The interpolation of `value_of` the values at a point of the unit cube.
    #[inline]
    pub(super) fn lookup<V>(&self, p: Point3, zero: V, value_of: impl Fn(T) -> V) -> V
    where
        V: Copy + Mix,
    {
        let scaled: [f32; 3] = std::array::from_fn(|axis| p[axis] * self.resolution[axis] as f32 - 0.5);
        let low = scaled.map(f32::floor);
        let [fx, fy, fz]: [f32; 3] = std::array::from_fn(|axis| scaled[axis] - low[axis]);
        let [x, y, z] = low.map(|low| low as i64);
        let value = |x: i64, y: i64, z: i64| {
            let [nx, ny, nz] = self.resolution;
            let is_inside = |i: i64, n: usize| (0..n as i64).contains(&i);
            if is_inside(x, nx) && is_inside(y, ny) && is_inside(z, nz) {
                value_of(self.values[(z as usize * ny + y as usize) * nx + x as usize])
            } else {
                zero
            }
        };
        let line = |y, z| V::mix(fx, value(x, y, z), value(x + 1, y, z));
        let plane = |z| V::mix(fy, line(y, z), line(y + 1, z));
        V::mix(fz, plane(z), plane(z + 1))
    }

    /// The largest of `value_of` the values that interpolation within a box in the unit cube uses;
    /// at least 0, the value outside.
    pub(crate) fn largest(&self, bounds: Bounds3, value_of: impl Fn(T) -> f32) -> f32 {
        let range = |axis: usize| {
            let n = self.resolution[axis];
            // One more value on each side, because points are rounded.
            let first = (bounds.min[axis] * n as f32 - 0.5).floor() as i64 - 1;
            let last = (bounds.max[axis] * n as f32 - 0.5).floor() as i64 + 2;
            first.clamp(0, n as i64) as usize..(last + 1).clamp(0, n as i64) as usize
        };
        let [_, ny, _] = self.resolution;
        let nx = self.resolution[0];
        let mut largest = 0f32;
        for z in range(2) {
            for y in range(1) {
                let row = (z * ny + y) * nx;
                let values = &self.values[row + range(0).start..row + range(0).end];
                largest = values.iter().fold(largest, |largest, &value| largest.max(value_of(value)));
            }
        }
        largest
    }
}

/// Values that can be interpolated.
pub(super) trait Mix {
    /// `a` for t = 0, `b` for t = 1, and linear between.
    fn mix(t: f32, a: Self, b: Self) -> Self;
}

impl Mix for f32 {
    #[inline]
    fn mix(t: f32, a: Self, b: Self) -> Self {
        lerp(t, a, b)
    }
}

impl Mix for spectrum::SampledSpectrum {
    #[inline]
    fn mix(t: f32, a: Self, b: Self) -> Self {
        a.lerp(b, t)
    }
}

impl Grid<f32> {
    /// The interpolated value at a point of the unit cube.
    #[inline]
    pub(super) fn value(&self, p: Point3) -> f32 {
        self.lookup(p, 0.0, |value| value)
    }
}
