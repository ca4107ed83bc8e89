//! Pairs of integers give the bits of `u64`.

use crate::numbers::{available, integer};
use alhazen_lanes::*;

/// Two 64-bit integers per lane, as halves.
struct Operations<'a>(&'a [u32; 4 * MAX_LANES], u32);

impl Kernel for Operations<'_> {
    type Output = Vec<[u64; 6]>;

    #[inline(always)]
    fn run<R: Real>(self) -> Self::Output {
        let [a_low, a_high, b_low, b_high] = [0, 1, 2, 3].map(|i| R::Int::load(&self.0[i * MAX_LANES..]));
        let (a, b) = (Wide { low: a_low, high: a_high }, Wide { low: b_low, high: b_high });
        let shift = self.1;
        let results = [a.wrapping_add(b), a.wrapping_mul(b), a ^ b, a << shift, a >> shift, mix_bits(a)];
        let results = results.map(|wide| (wide.low.to_array(), wide.high.to_array()));
        let join =
            |lane: usize| results.map(|(low, high)| u64::from(low[lane]) | u64::from(high[lane]) << 32);
        (0..R::LANES).map(join).collect()
    }
}

/// One of Stafford's hash functions, as samplers use it.
#[inline(always)]
fn mix_bits<I: Int>(v: Wide<I>) -> Wide<I> {
    let v = (v ^ (v >> 31)).wrapping_mul(Wide::splat(0x7fb5_d329_728e_a185));
    let v = (v ^ (v >> 27)).wrapping_mul(Wide::splat(0x81da_def4_bc2d_d44d));
    v ^ (v >> 33)
}

fn mix_bits_u64(v: u64) -> u64 {
    let v = (v ^ (v >> 31)).wrapping_mul(0x7fb5_d329_728e_a185);
    let v = (v ^ (v >> 27)).wrapping_mul(0x81da_def4_bc2d_d44d);
    v ^ (v >> 33)
}

#[test]
fn pairs_give_the_bits_of_64_bit_integers() {
    for round in 0..20_000 {
        let halves = std::array::from_fn(|i| integer(64 * round + i as u32));
        let shift = round % 64;
        for set in available() {
            for (lane, found) in set.dispatch(Operations(&halves, shift)).into_iter().enumerate() {
                let half = |i| u64::from(halves[i * MAX_LANES + lane]);
                let (a, b) = (half(0) | half(1) << 32, half(2) | half(3) << 32);
                let expected =
                    [a.wrapping_add(b), a.wrapping_mul(b), a ^ b, a << shift, a >> shift, mix_bits_u64(a)];
                assert_eq!(found, expected, "{set:?}: {a:x}, {b:x}, {shift}");
            }
        }
    }
}
