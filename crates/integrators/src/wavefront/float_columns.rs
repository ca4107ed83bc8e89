//! Columns of floats: structures of arrays, of which each element is of a path.

use lanes::Real;
use math::{Vec3, Vector3};

use super::indices::Indices;

/// A number for each path.
pub(super) type FloatColumn = Vec<f32>;

/// Changes a column to `count` times the same number.
pub(super) fn fill<T: Clone>(column: &mut Vec<T>, count: usize, value: T) {
    column.clear();
    column.resize(count, value);
}

/// Makes place for `count` elements, whatever they are.
pub(super) fn grow<T: Clone + Default>(column: &mut Vec<T>, count: usize) {
    if column.len() < count {
        column.resize(count, T::default());
    }
}

/// Numbers for each path, in several columns.
pub(super) struct FloatColumns<const C: usize>([FloatColumn; C]);

impl<const C: usize> Default for FloatColumns<C> {
    fn default() -> Self {
        Self(std::array::from_fn(|_| Vec::new()))
    }
}

impl<const C: usize> FloatColumns<C> {
    /// Makes place for `count` rows, of any numbers.
    pub fn grow(&mut self, count: usize) {
        self.0.iter_mut().for_each(|column| grow(column, count));
    }

    /// A row.
    #[inline]
    pub fn row(&self, row: usize) -> [f32; C] {
        let mut values = [0.0; C];
        for (c, value) in values.iter_mut().enumerate() {
            *value = self.0[c][row];
        }
        values
    }

    /// Changes a row.
    #[inline]
    pub fn set_row(&mut self, row: usize, values: [f32; C]) {
        for (c, value) in values.into_iter().enumerate() {
            self.0[c][row] = value;
        }
    }

    /// Changes successive rows.
    #[inline(always)]
    pub fn store<R: Real>(&mut self, first: usize, values: [R; C]) {
        for (c, value) in values.iter().enumerate() {
            value.store(&mut self.0[c][first..]);
        }
    }

    /// Changes successive rows to the lanes of a mask; rows after them may be overwritten.
    #[inline(always)]
    pub fn compress<R: Real>(&mut self, first: usize, mask: R::Mask, values: [R; C]) {
        for (c, value) in values.iter().enumerate() {
            value.compress(mask, &mut self.0[c][first..]);
        }
    }

    /// Rows in lanes.
    #[inline(always)]
    pub fn get<R: Real>(&self, rows: Indices<R>) -> [R; C] {
        let mut values = [R::zero(); C];
        for (c, value) in values.iter_mut().enumerate() {
            *value = R::gather(&self.0[c], rows.indices);
        }
        values
    }
}

impl FloatColumns<3> {
    /// The columns.
    #[inline]
    pub fn slices(&self) -> [&[f32]; 3] {
        let [x, y, z] = &self.0;
        [x, y, z]
    }

    /// Vectors in lanes.
    #[inline(always)]
    pub fn vector<R: Real>(&self, rows: Indices<R>) -> Vector3<R> {
        Vec3::from_array(self.get(rows))
    }
}
