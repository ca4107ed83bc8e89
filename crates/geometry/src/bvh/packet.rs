//! Packets of rays, in columns, and intervals around them ([Reshetov et al. 2005]).
//!
//! What is prepared for all rays of a packet is computed by vectors: it would take as long as the
//! traversal if each ray were prepared alone.

#![allow(unsafe_code)]

use super::node::{MARGIN, PLANE, RaySlabs, WIDTH, WideNode, is_moderate, size};
use lanes::Vector;
use math::{Bounds3, Vec3};

/// The largest difference between directions of a packet, relative to their length, and between
/// origins, relative to the size of what is traversed.
const SPREAD: f32 = 0.1;

/// Rays, and their ends.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Packet {
    pub o: [[f32; WIDTH]; 3],
    pub d: [[f32; WIDTH]; 3],
    pub t_max: [f32; WIDTH],
}

impl Packet {
    /// Rays without a direction, which are not valid.
    pub const NONE: Self = Self { o: [[0.0; WIDTH]; 3], d: [[0.0; WIDTH]; 3], t_max: [0.0; WIDTH] };

    /// Whether rays are worth tracing as a packet through something of a size: they are valid and
    /// have similar origins, and similar directions with the same signs and the same main axis.
    ///
    /// # Safety
    /// The processor must have the instruction set of `V`.
    #[inline(always)]
    pub unsafe fn is_coherent<V: Vector<WIDTH>>(&self, size: f32) -> bool {
        // SAFETY: as the caller promises.
        let (splat, load) = unsafe { (|x| V::splat(x), |from| V::load(from)) };
        let (zero, most) = (splat(0.0), splat(f32::MAX));
        let mut of_origins = zero;
        let mut of_directions = zero;
        let mut all = load(&self.t_max).le(splat(f32::INFINITY)) & zero.le(load(&self.t_max));
        for axis in 0..3 {
            let (o, d) = (load(&self.o[axis]), load(&self.d[axis]));
            all &= o.abs().le(most) & d.abs().le(most);
            let (between, turned) = (o.sub(splat(self.o[axis][0])), d.sub(splat(self.d[axis][0])));
            of_origins = of_origins.add(between.mul(between));
            of_directions = of_directions.add(turned.mul(turned));
        }
        let length2 = Vec3::new(self.d[0][0], self.d[1][0], self.d[2][0]).length_squared();
        all &= of_origins.le(splat(SPREAD * SPREAD * size * size));
        all &= of_directions.lt(splat(SPREAD * SPREAD * length2));
        let [x, y, z] = [load(&self.d[0]).abs(), load(&self.d[1]).abs(), load(&self.d[2]).abs()];
        // A direction too short to have an inverse is none.
        all &= splat(1.0).div(x.max(y).max(z)).le(most);
        let x_leads = y.lt(x) & z.lt(x);
        let y_leads = z.lt(y) & !x_leads;
        let is_one = |lanes: u32| lanes & ALL == 0 || lanes & ALL == ALL;
        let mut signs = 0;
        for d in &self.d {
            let lead = d[0].to_bits();
            signs |= d.iter().fold(0, |signs, d| signs | (d.to_bits() ^ lead));
        }
        all & ALL == ALL && is_one(x_leads) && is_one(y_leads) && signs >> 31 == 0
    }
}

/// The bits of all rays.
const ALL: u32 = (1 << WIDTH) - 1;

/// A packet prepared for slab tests.
#[derive(Clone, Copy)]
pub(crate) struct PacketSlabs<V> {
    /// One ray in each lane.
    pub rays: RaySlabs<V>,
    /// The intervals as two rays, each in all lanes: their inverse directions have the least and
    /// the greatest magnitude along each axis. They cross first planes from the foremost origin
    /// and last planes from the rearmost one, so that one of both does before and one after all
    /// rays.
    pub least: RaySlabs<V>,
    pub greatest: RaySlabs<V>,
}

impl<V: Vector<WIDTH>> PacketSlabs<V> {
    /// All directions must have the same signs.
    ///
    /// # Safety
    /// The processor must have the instruction set of `V`.
    #[inline(always)]
    pub unsafe fn new(packet: &Packet, bounds: &Bounds3) -> Self {
        // SAFETY: as the caller promises. Without `map`, which would be called, and call each
        // intrinsic.
        unsafe {
            let d = [V::load(&packet.d[0]).abs(), V::load(&packet.d[1]).abs(), V::load(&packet.d[2]).abs()];
            let largest = d[0].max(d[1]).max(d[2]);
            let (mut low, mut high) = (Vec3::ZERO, Vec3::ZERO);
            let (mut least, mut greatest) = (Vec3::ZERO, Vec3::ZERO);
            // As in `inverse`.
            let parallel = largest.mul(V::splat(1e-12));
            let mut magnitudes = d;
            for axis in 0..3 {
                [low[axis], high[axis]] = extremes(&packet.o[axis]);
                magnitudes[axis] = d[axis].max(parallel);
                let [shortest, longest] = extremes(&magnitudes[axis].store());
                (least[axis], greatest[axis]) = (longest.recip(), shortest.recip());
            }
            let size = size(low.abs().max(high.abs()), bounds);
            let [shortest, longest] = extremes(&largest.store());
            if !is_moderate(size, shortest) || !is_moderate(size, longest) {
                let [rays, least, greatest] = [RaySlabs::everywhere().lanes(); 3];
                return Self { rays, least, greatest };
            }
            let margin = size * MARGIN;
            let d = Vec3::new(packet.d[0][0], packet.d[1][0], packet.d[2][0]);
            let (mut front, mut back) = (high, low);
            for axis in 0..3 {
                if d[axis].is_sign_negative() {
                    (front[axis], back[axis]) = (low[axis], high[axis]);
                }
            }
            let least = RaySlabs::along(&d, least.copysign(d), [front, back], margin).lanes();
            let greatest = RaySlabs::along(&d, greatest.copysign(d), [front, back], margin).lanes();
            let mut rays: RaySlabs<V> = greatest;
            for axis in 0..3 {
                let shift = V::splat(margin.copysign(d[axis]));
                let o = V::load(&packet.o[axis]);
                rays.inverse[axis] = V::splat(1f32.copysign(d[axis])).div(magnitudes[axis]);
                rays.near[axis] = rays.inverse[axis].mul(o.add(shift));
                rays.far[axis] = rays.inverse[axis].mul(o.sub(shift));
            }
            Self { rays, least, greatest }
        }
    }
}

impl WideNode {
    /// Where each ray of a packet enters the box of a child, and a bit for each that does before
    /// its `t_max`.
    #[inline(always)]
    pub fn intersect_rays<V: Vector<WIDTH>>(
        &self,
        lane: usize,
        packet: &PacketSlabs<V>,
        t_max: V,
        zero: V,
    ) -> (V, u32) {
        let rays = &packet.rays;
        let (mut near, mut far) = (zero, t_max);
        for axis in 0..3 {
            let first = rays.first[axis] / PLANE;
            // SAFETY: `first` is `axis` or `axis + 3`, and so is the other; lanes are below
            // [`WIDTH`]; `rays` is the proof of the instruction set.
            let [enter, leave] = unsafe {
                let first_plane = V::splat(*self.planes.get_unchecked(first).get_unchecked(lane));
                let last_plane =
                    V::splat(*self.planes.get_unchecked(2 * axis + 3 - first).get_unchecked(lane));
                [
                    first_plane.relaxed_mul_sub(rays.inverse[axis], rays.near[axis]),
                    last_plane.relaxed_mul_sub(rays.inverse[axis], rays.far[axis]),
                ]
            };
            near = enter.max(near);
            far = leave.min(far);
        }
        (near, near.le(far))
    }

    /// A lower bound of where rays of a packet enter each box, and a bit for each box that any may
    /// enter before `t_max`.
    #[inline(always)]
    pub fn intersect_packet<V: Vector<WIDTH>>(&self, packet: &PacketSlabs<V>, t_max: V, zero: V) -> (V, u32) {
        let PacketSlabs { least, greatest, .. } = packet;
        let (mut near, mut far) = (zero, t_max);
        for axis in 0..3 {
            let first = least.first[axis] / PLANE;
            // SAFETY: `first` is `axis` or `axis + 3`, and so is the other; `packet` is the proof
            // of the instruction set.
            let [first_plane, last_plane] = unsafe {
                [
                    V::load(self.planes.get_unchecked(first)),
                    V::load(self.planes.get_unchecked(2 * axis + 3 - first)),
                ]
            };
            let enter = first_plane
                .relaxed_mul_sub(least.inverse[axis], least.near[axis])
                .min(first_plane.relaxed_mul_sub(greatest.inverse[axis], greatest.near[axis]));
            let leave = last_plane
                .relaxed_mul_sub(least.inverse[axis], least.far[axis])
                .max(last_plane.relaxed_mul_sub(greatest.inverse[axis], greatest.far[axis]));
            near = enter.max(near);
            far = leave.min(far);
        }
        (near, near.le(far))
    }
}

/// The smallest and the largest of numbers.
#[inline(always)]
fn extremes(numbers: &[f32; WIDTH]) -> [f32; 2] {
    let (mut low, mut high) = (*numbers, *numbers);
    let mut half = WIDTH / 2;
    while half > 0 {
        for i in 0..half {
            low[i] = if low[i] < low[i + half] { low[i] } else { low[i + half] };
            high[i] = if high[i] > high[i + half] { high[i] } else { high[i + half] };
        }
        half /= 2;
    }
    [low[0], high[0]]
}
