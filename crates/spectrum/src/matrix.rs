//! 3 × 3 matrices in double precision, for conversions between colour spaces.

use lanes::Each;
use std::ops::Mul;

/// A matrix that maps colours to colours, stored by rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matrix3(pub [[f64; 3]; 3]);

impl Matrix3 {
    /// The identity.
    pub const IDENTITY: Self = Self::diagonal([1.0; 3]);

    /// Scales each component.
    pub const fn diagonal([a, b, c]: [f64; 3]) -> Self {
        Self([[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]])
    }

    /// The matrix with these columns.
    pub fn from_columns(columns: [[f64; 3]; 3]) -> Self {
        Self(std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i])))
    }

    /// The image of `v`.
    #[inline]
    pub fn apply(&self, v: [f64; 3]) -> [f64; 3] {
        self.0.each(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
    }

    /// The image of the colour `v`.
    #[inline]
    pub fn apply_f32(&self, v: [f32; 3]) -> [f32; 3] {
        self.apply(v.each(f64::from)).each(|x| x as f32)
    }

    /// The inverse, or `None` where the determinant is zero.
    pub fn inverse(&self) -> Option<Self> {
        let m = &self.0;
        let cofactor = |i: usize, j: usize| {
            let (a, b, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
            m[a][c] * m[b][d] - m[a][d] * m[b][c]
        };
        let determinant: f64 = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum();
        (determinant != 0.0)
            .then(|| Self(std::array::from_fn(|i| std::array::from_fn(|j| cofactor(j, i) / determinant))))
    }
}

impl Mul for Matrix3 {
    type Output = Self;

    /// The product: first `other`, then `self`.
    fn mul(self, other: Self) -> Self {
        let column = |j: usize| self.apply(other.0.map(|row| row[j]));
        Self::from_columns([column(0), column(1), column(2)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_times_its_inverse_is_the_identity() {
        let m = Matrix3([[2.0, -1.0, 0.5], [0.25, 3.0, 1.0], [-1.0, 0.5, 4.0]]);
        let product = m * m.inverse().unwrap();
        for i in 0..3 {
            for j in 0..3 {
                assert!((product.0[i][j] - Matrix3::IDENTITY.0[i][j]).abs() < 1e-12);
            }
        }
        assert!(Matrix3([[1.0, 2.0, 3.0], [2.0, 4.0, 6.0], [0.0, 1.0, 1.0]]).inverse().is_none());
    }
}
