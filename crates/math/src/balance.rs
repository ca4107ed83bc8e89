//! Powers of two that bring numbers near one, so that products of several neither overflow nor
//! vanish.

use lanes::{Int, Real};

/// A power of two whose product with `x` ≥ 0 is from one to two; less for denormal numbers, and up
/// to four for the largest ones. A product with it has the same digits.
#[inline(always)]
pub fn balance<R: Real>(x: R) -> R {
    // Its exponent is 254, twice that of one, without that of x, which is at most 253.
    let exponent = x.min(R::splat(1.7e38)).to_bits() & R::Int::splat(0x7f80_0000);
    R::from_bits(R::Int::splat(0x7f00_0000).wrapping_sub(exponent))
}

#[cfg(test)]
mod tests {
    use crate::Vec3;

    #[test]
    fn vectors_of_all_sizes_have_a_direction() {
        let v = Vec3::new(0.3, -2.0, 5.5);
        let n = v.normalize();
        for exponent in -120..=124 {
            let scaled = v * 2f32.powi(exponent);
            assert_eq!(scaled.normalize(), n, "2^{exponent}");
            assert_eq!(scaled.try_normalize(), Some(n), "2^{exponent}");
            let b = scaled.balanced();
            assert!((1.0..2.0).contains(&b.abs().max_element()) && b.normalize() == n, "{b:?}");
        }
        for v in [Vec3::new(1e-44, 0.0, -1e-44), Vec3::new(f32::MAX, 1.0, -f32::MAX)] {
            assert!((v.normalize() - Vec3::new(1.0, 0.0, -1.0).normalize()).length() < 1e-6, "{v:?}");
        }
        assert!(Vec3::new(f32::NAN, 1.0, 0.0).try_normalize().is_none());
    }
}
