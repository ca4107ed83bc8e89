//! Packets of sixteen coherent rays, such as those of a camera or towards the sun, that traverse
//! the triangles and the spheres of a group together ([Reshetov et al. 2005]).
//!
//! Intervals around origins and directions find the boxes that any of the rays may enter; these
//! boxes and the primitives in them are tested against all rays at once.

#![allow(unsafe_code)]

use super::group::Group;
use super::instance::InstancePath;
use super::query::Query;
use super::spheres::{ScaledRays, SphereBlock};
use super::stats::RayStats;
use super::trace::TriangleLeaves;
use super::triangle_block::TriangleBlock;
use crate::bvh::{Leaves, Packet, PacketLeaves, WIDTH};
use crate::shape::SphereRay;
use crate::watertight::{LaneHits, Sheared, ShearedLanes};
use lanes::{Simd, Task, Vector};
use math::Ray;
use std::ops::Range;

/// Coherent rays that traverse the triangles and the spheres of the top group together.
pub(super) struct TracePacket<'a, Q> {
    pub group: &'a Group,
    pub packet: &'a Packet,
    /// The same rays.
    pub rays: &'a [Ray; WIDTH],
    /// A query for each ray.
    pub queries: &'a mut [Q; WIDTH],
    pub stats: &'a mut RayStats,
}

/// Up to this many rays of a packet are tested against triangles individually.
const FEW: u32 = 4;

impl<Q: Query> Task for TracePacket<'_, Q> {
    type Output = ();

    #[inline(always)]
    unsafe fn run<S: Simd>(self) {
        let Self { group, packet, rays, queries, stats } = self;
        let mut t_max = packet.t_max;
        if !group.triangles.is_empty() {
            let sheared: [Sheared; WIDTH] = std::array::from_fn(|i| Sheared::new(&rays[i]));
            // SAFETY: the caller promises the instruction set.
            unsafe {
                let lanes = Sheared::each(&sheared);
                let mut leaves =
                    PacketTriangles::<S, Q> { group, sheared: &sheared, lanes, queries, primitives: 0 };
                stats.extents += group.triangles.tree.traverse_packet::<S>(packet, &mut t_max, &mut leaves);
                stats.primitives += leaves.primitives;
            }
        }
        if !group.spheres.blocks.is_empty() {
            // SAFETY: the caller promises the instruction set.
            unsafe {
                let lanes = ScaledRays::<S::F32x16>::each(packet);
                let blocks = &*group.spheres.blocks;
                let mut leaves = PacketSpheres::<S, Q> { blocks, lanes, rays, queries, primitives: 0 };
                stats.extents += group.spheres.tree.traverse_packet::<S>(packet, &mut t_max, &mut leaves);
                stats.primitives += leaves.primitives;
            }
        }
    }
}

/// The triangles of a group, tested against the rays of a packet.
struct PacketTriangles<'a, S: Simd, Q> {
    group: &'a Group,
    sheared: &'a [Sheared<'a>; WIDTH],
    lanes: ShearedLanes<S::F32x16>,
    queries: &'a mut [Q; WIDTH],
    /// How many were tested, each against one ray.
    primitives: u64,
}

impl<S: Simd, Q: Query> PacketLeaves for PacketTriangles<'_, S, Q> {
    type Block = TriangleBlock;

    #[inline(always)]
    fn blocks(&self) -> &[TriangleBlock] {
        &self.group.triangles.blocks
    }

    #[inline(always)]
    unsafe fn test(&mut self, blocks: Range<usize>, entering: u32, t_max: &mut [f32; WIDTH]) {
        if entering.count_ones() <= FEW {
            // SAFETY: as the caller promises.
            return unsafe { self.test_each(blocks, entering, t_max) };
        }
        let group = self.group;
        for block in &group.triangles.blocks[blocks] {
            for lane in 0..block.len() {
                self.primitives += WIDTH as u64;
                // SAFETY: the caller promises the instruction set.
                let ends = unsafe { S::F32x16::load(t_max) };
                if let Some(found) = block.intersect_rays(lane, &self.lanes, ends) {
                    self.offer(block, lane, &found, t_max);
                }
            }
        }
    }
}

impl<S: Simd, Q: Query> PacketTriangles<'_, S, Q> {
    /// Tests blocks against one ray after another.
    ///
    /// # Safety
    /// As for [`PacketLeaves::test`].
    #[inline(always)]
    unsafe fn test_each(&mut self, blocks: Range<usize>, mut entering: u32, t_max: &mut [f32; WIDTH]) {
        while entering != 0 {
            let i = entering.trailing_zeros() as usize % WIDTH;
            entering &= entering - 1;
            if t_max[i] < 0.0 {
                continue;
            }
            let sheared = &self.sheared[i];
            // SAFETY: as the caller promises.
            unsafe {
                let lanes = sheared.lanes::<{ TriangleBlock::VERTICES }, S::F32x8>();
                let mut leaves = TriangleLeaves::<S, Q> {
                    group: self.group,
                    instance: InstancePath::TOP,
                    sheared,
                    lanes: &lanes,
                    query: &mut self.queries[i],
                    primitives: 0,
                };
                if leaves.test(blocks.clone(), &mut t_max[i]) {
                    t_max[i] = -1.0;
                }
                self.primitives += leaves.primitives;
            }
        }
    }

    /// Offers the hits of a triangle to the queries.
    #[inline(always)]
    fn offer(
        &mut self,
        block: &TriangleBlock,
        lane: usize,
        found: &LaneHits<S::F32x16>,
        t_max: &mut [f32; WIDTH],
    ) {
        let mut hits = found.hits;
        while hits != 0 {
            let i = hits.trailing_zeros() as usize % WIDTH;
            hits &= hits - 1;
            if t_max[i] < 0.0 {
                continue;
            }
            let (sheared, numbering) = (&self.sheared[i], &self.group.triangles.numbering);
            let hit = block.hit(lane, found, i, sheared, numbering, InstancePath::TOP);
            let Some(hit) = hit else { continue };
            let query = &mut self.queries[i];
            t_max[i] = if query.offer(hit) { -1.0 } else { query.t_max() };
        }
    }
}

/// The spheres of a group, tested against the rays of a packet.
struct PacketSpheres<'a, S: Simd, Q> {
    blocks: &'a [SphereBlock],
    lanes: ScaledRays<S::F32x16>,
    rays: &'a [Ray; WIDTH],
    queries: &'a mut [Q; WIDTH],
    /// How many were tested, each against one ray.
    primitives: u64,
}

impl<S: Simd, Q: Query> PacketLeaves for PacketSpheres<'_, S, Q> {
    type Block = SphereBlock;

    #[inline(always)]
    fn blocks(&self) -> &[SphereBlock] {
        self.blocks
    }

    #[inline(always)]
    unsafe fn test(&mut self, blocks: Range<usize>, _: u32, t_max: &mut [f32; WIDTH]) {
        for block in &self.blocks[blocks] {
            for lane in 0..block.len() {
                self.primitives += WIDTH as u64;
                // SAFETY: the caller promises the instruction set.
                let ends = unsafe { S::F32x16::load(t_max) };
                let mut meeting = block.meeting(lane, &self.lanes, ends);
                while meeting != 0 {
                    let i = meeting.trailing_zeros() as usize % WIDTH;
                    meeting &= meeting - 1;
                    if t_max[i] < 0.0 {
                        continue;
                    }
                    let (ray, query) = (SphereRay::new(&self.rays[i]), &mut self.queries[i]);
                    let is_answered = block.offer(lane, &ray, InstancePath::TOP, query);
                    t_max[i] = if is_answered { -1.0 } else { query.t_max() };
                }
            }
        }
    }
}
