//! Gradient noise: a smooth function of space without visible structure, which is zero on average
//! and never repeats within 256 units.
//!
//! Space is a lattice of unit cubes. A hash gives each lattice point one of twelve gradients, the
//! directions from the centre of a cube to the middles of its edges, so that g·(p − c) is a ramp
//! through zero at the lattice point c. At a point p the ramps of the eight corners of its cube are
//! mixed by weights that are products of one fade for each axis:
//!
//! ```text
//! noise(p) = Σ_c  g_c·(p − c)  ∏_axis fade(1 − |p − c|)        fade(t) = 6t⁵ − 15t⁴ + 10t³
//! ```
//!
//! The fade's first and second derivatives are zero at 0 and 1, hence those of the noise are
//! continuous, and a bump map of it shows no edges between cubes. The noise is zero at each lattice
//! point, and its gradient there is g. Its frequencies lie about one per unit, which makes it the
//! building block of patterns with prescribed frequencies.
//!
//! The hash is a permutation π of 0 to 255: h = π(π(π(x) + y) + z), of whose value the low four
//! bits choose the gradient. Of the sixteen choices four occur twice. π is the published one, but
//! choices 13 and 14 of [Pharr 2016] differ from those of [Perlin 2002]; as pictures of the format
//! depend on them, they are those of the former.
//!
//! Sources: [Perlin 2002]; [Pharr 2016 §10.6.1].

use lanes::{Each, Int, Real};
use math::{Point3, Vec3, Vector3, lerp};

/// The noise at a point, in (−1, 1).
#[inline(always)]
pub(crate) fn noise<R: Real>(p: Point3<R>) -> R {
    let cell = Vec3::new(p.x.floor(), p.y.floor(), p.z.floor());
    let from_low = p - cell;
    let from_high = from_low - Vec3::splat(R::one());
    let [x, y, z] = cell.to_array().each(lattice_index);
    let (dx, dy, dz) = ([from_low.x, from_high.x], [from_low.y, from_high.y], [from_low.z, from_high.z]);
    let (wx, wy, wz) = (fade(from_low.x), fade(from_low.y), fade(from_low.z));
    let mut planes = [R::zero(); 2];
    let next = R::Int::splat(1);
    for (i, plane) in planes.iter_mut().enumerate() {
        let hash = permuted(if i == 0 { x } else { x.wrapping_add(next) });
        let mut lines = [R::zero(); 2];
        for (j, line) in lines.iter_mut().enumerate() {
            let hash = permuted(hash.wrapping_add(if j == 0 { y } else { y.wrapping_add(next) }));
            let low = ramp(permuted(hash.wrapping_add(z)), Vec3::new(dx[i], dy[j], dz[0]));
            let z = z.wrapping_add(next);
            let high = ramp(permuted(hash.wrapping_add(z)), Vec3::new(dx[i], dy[j], dz[1]));
            *line = lerp(wz, low, high);
        }
        *plane = lerp(wy, lines[0], lines[1]);
    }
    lerp(wx, planes[0], planes[1])
}

/// A coordinate of a lattice point modulo 256. NaN gives 0.
#[inline(always)]
fn lattice_index<R: Real>(coordinate: R) -> R::Int {
    let period = R::splat(256.0);
    let within = coordinate - (coordinate / period).floor() * period;
    within.clamp(R::zero(), R::splat(255.0)).to_int()
}

/// 6t⁵ − 15t⁴ + 10t³.
#[inline(always)]
fn fade<R: Real>(t: R) -> R {
    let [six, ten, fifteen] = [6.0, 10.0, 15.0].each(R::splat);
    t * t * t * (t * (t * six - fifteen) + ten)
}

/// The scalar product of `d` with the gradient that the low four bits of a hash choose:
///
/// ```text
/// 0 to 3 ±x ± y    4 to 7 ±x ± z    8 to 11 ±y ± z    12, 13 ±x + y    14, 15 ±y − z
/// ```
///
/// Bit 0 is the sign of the first term and bit 1 that of the second.
#[inline(always)]
fn ramp<R: Real>(hash: R::Int, d: Vector3<R>) -> R {
    let choice = hash & R::Int::splat(15);
    let is_12_or_13 = (choice & R::Int::splat(14)).eq(R::Int::splat(12));
    let first = R::select(choice.lt(R::Int::splat(8)) | is_12_or_13, d.x, d.y);
    let second = R::select(choice.lt(R::Int::splat(4)) | is_12_or_13, d.y, d.z);
    let signs = [choice.shl(31), (choice & R::Int::splat(2)).shl(30)];
    R::from_bits(first.to_bits() ^ signs[0]) + R::from_bits(second.to_bits() ^ signs[1])
}

/// The permutation at an index below 512, of which the second half repeats the first.
#[inline(always)]
fn permuted<I: Int>(index: I) -> I {
    I::gather(&TWICE_PERMUTED, index)
}

static TWICE_PERMUTED: [u32; 512] = {
    let mut table = [0; 512];
    let mut i = 0;
    while i < 512 {
        table[i] = PERMUTATION[i % 256] as u32;
        i += 1;
    }
    table
};

/// The permutation of [Perlin 2002].
const PERMUTATION: [u8; 256] = [
    151, 160, 137, 91, 90, 15, 131, 13, 201, 95, 96, 53, 194, 233, 7, 225, 140, 36, 103, 30, 69, 142, 8, 99,
    37, 240, 21, 10, 23, 190, 6, 148, 247, 120, 234, 75, 0, 26, 197, 62, 94, 252, 219, 203, 117, 35, 11, 32,
    57, 177, 33, 88, 237, 149, 56, 87, 174, 20, 125, 136, 171, 168, 68, 175, 74, 165, 71, 134, 139, 48, 27,
    166, 77, 146, 158, 231, 83, 111, 229, 122, 60, 211, 133, 230, 220, 105, 92, 41, 55, 46, 245, 40, 244,
    102, 143, 54, 65, 25, 63, 161, 1, 216, 80, 73, 209, 76, 132, 187, 208, 89, 18, 169, 200, 196, 135, 130,
    116, 188, 159, 86, 164, 100, 109, 198, 173, 186, 3, 64, 52, 217, 226, 250, 124, 123, 5, 202, 38, 147,
    118, 126, 255, 82, 85, 212, 207, 206, 59, 227, 47, 16, 58, 17, 182, 189, 28, 42, 223, 183, 170, 213, 119,
    248, 152, 2, 44, 154, 163, 70, 221, 153, 101, 155, 167, 43, 172, 9, 129, 22, 39, 253, 19, 98, 108, 110,
    79, 113, 224, 232, 178, 185, 112, 104, 218, 246, 97, 228, 251, 34, 242, 193, 238, 210, 144, 12, 191, 179,
    162, 241, 81, 51, 145, 235, 249, 14, 239, 107, 49, 192, 214, 31, 181, 199, 106, 157, 184, 84, 204, 176,
    115, 121, 50, 45, 127, 4, 150, 254, 138, 236, 205, 93, 222, 114, 67, 29, 24, 72, 243, 141, 128, 195, 78,
    66, 215, 61, 156, 180,
];
