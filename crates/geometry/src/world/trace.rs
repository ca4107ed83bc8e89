//! Traversal of a group by one ray: its triangles, then spheres, unbounded items, and the tree of
//! other shapes and instances. Instances are entered recursively.

#![allow(unsafe_code)]

use super::geometry::Geometry;
use super::group::{Group, Item};
use super::hit::Hit;
use super::instance::InstancePath;
use super::query::{Query, offer_all};
use super::spheres::{ScaledRays, SphereBlock, Spheres};
use super::stats::RayStats;
use super::tables::Tables;
use super::triangle_block::TriangleBlock;
use crate::bvh::{Bvh, Leaves, RaySlabs, WIDTH};
use crate::shape::SphereRay;
use crate::watertight::{LaneHits, Sheared, ShearedLanes};
use lanes::{Real, Simd, Task, Vector};
use math::Ray;
use std::mem::MaybeUninit;
use std::ops::Range;

/// A ray that traverses a group.
pub(super) struct Trace<'a> {
    pub tables: &'a Tables,
    /// In the space of the group.
    pub ray: &'a Ray,
    /// The instances that the ray has entered.
    pub instance: InstancePath,
    pub stats: &'a mut RayStats,
}

impl Trace<'_> {
    /// Offers all hits in a group to the query; returns whether it is finished.
    #[inline]
    pub fn group<Q: Query>(&mut self, group: &Group, query: &mut Q) -> bool {
        if !is_valid(self.ray) {
            return false;
        }
        if !group.triangles.is_empty() {
            let set = self.tables.instruction_set;
            // SAFETY: the processor has the instruction set of a world.
            let (extents, primitives, stop) =
                unsafe { set.run(TraceTriangles { group, trace: self, query }) };
            self.stats.extents += extents;
            self.stats.primitives += primitives;
            if stop {
                return true;
            }
        }
        !group.has_only_triangles() && self.all_but_triangles(group, query)
    }

    /// The same for everything but triangles.
    pub fn all_but_triangles<Q: Query>(&mut self, group: &Group, query: &mut Q) -> bool {
        self.spheres(&group.spheres, query) || self.items(group, query)
    }

    /// The same for everything but triangles and sets of spheres.
    pub fn items<Q: Query>(&mut self, group: &Group, query: &mut Q) -> bool {
        for &item in &group.unbounded {
            if self.item(item, query) {
                return true;
            }
        }
        if group.items.is_empty() {
            return false;
        }
        let set = self.tables.instruction_set;
        // SAFETY: the processor has the instruction set of a world.
        let (extents, stop) = unsafe { set.run(TraceItems { group, trace: self, query }) };
        self.stats.extents += extents;
        stop
    }

    fn spheres<Q: Query>(&mut self, spheres: &Spheres, query: &mut Q) -> bool {
        if spheres.blocks.is_empty() {
            return false;
        }
        let set = self.tables.instruction_set;
        // SAFETY: the processor has the instruction set of a world.
        let (extents, primitives, stop) = unsafe { set.run(TraceSpheres { spheres, trace: self, query }) };
        self.stats.extents += extents;
        self.stats.primitives += primitives;
        stop
    }

    #[inline(never)]
    fn item<Q: Query>(&mut self, item: Item, query: &mut Q) -> bool {
        match item {
            Item::Shape(geometry, primitive) => {
                self.stats.primitives += 1;
                let instance = self.instance;
                offer_all(query, |after, query| {
                    let end = query.end();
                    let hit = match self.tables.geometry(geometry) {
                        Geometry::Shapes(shapes) => {
                            shapes[primitive as usize].intersect_beyond(self.ray, after, end)
                        }
                        Geometry::Curves(curves) if after == 0.0 => {
                            curves.intersect(primitive, self.ray, end)
                        }
                        Geometry::Curves(_) | Geometry::Mesh(_) | Geometry::Spheres(_) => None,
                    }?;
                    Some(Hit { t: hit.t, uv: hit.uv, geometry, primitive, instance })
                })
            }
            Item::Instance(id) => {
                let prepared = &self.tables.instances[id.0 as usize];
                let ray = prepared.with_placement(self.ray.time, |placement| placement.ray(self.ray));
                let instance = self.instance.into(id);
                let mut inner = Trace { tables: self.tables, ray: &ray, instance, stats: &mut *self.stats };
                inner.group(&self.tables.groups[prepared.group as usize], query)
            }
        }
    }

    /// The range of all blocks, where rays are not tested against bounding volumes.
    fn all(&self, blocks: usize) -> Option<Range<usize>> {
        (!self.tables.extents).then_some(0..blocks)
    }
}

/// Whether a ray can hit anything: not where it has numbers that are not finite, or a direction too
/// short to have an inverse.
#[inline(always)]
pub(super) fn is_valid(ray: &Ray) -> bool {
    ray.o.is_finite() && ray.d.is_finite() && ray.d.abs().max_element().recip().is_finite()
}

/// Whether traversal in order of distance is faster.
#[inline(always)]
fn in_order<Q: Query>(t_max: f32) -> bool {
    !Q::ANY || t_max < f32::INFINITY
}

/// Passes `leaves` the blocks of a tree that the ray may meet, or `all` without traversal. Returns
/// the number of boxes tested, and whether `leaves` stopped.
///
/// # Safety
/// The blocks must be those of the tree, and the processor must have the instruction set.
#[inline(always)]
unsafe fn traverse<S: Simd, Q: Query>(
    tree: &Bvh,
    all: Option<Range<usize>>,
    ray: &RaySlabs<f32>,
    t_max: &mut f32,
    leaves: &mut impl Leaves,
) -> (u64, bool) {
    // SAFETY: the caller promises the blocks and the instruction set.
    unsafe {
        match all {
            Some(blocks) => (0, leaves.test(blocks, t_max)),
            None if in_order::<Q>(*t_max) => tree.traverse::<S, false>(ray, t_max, leaves),
            None => tree.traverse::<S, true>(ray, t_max, leaves),
        }
    }
}

/// A ray that traverses the triangles of a group.
struct TraceTriangles<'a, 'b, Q> {
    group: &'a Group,
    trace: &'a Trace<'b>,
    query: &'a mut Q,
}

impl<Q: Query> Task for TraceTriangles<'_, '_, Q> {
    const EVERY_SET: bool = Q::EVERY_SET;

    type Output = (u64, u64, bool);

    #[inline(always)]
    unsafe fn run<S: Simd>(self) -> Self::Output {
        let Self { group, trace, query } = self;
        let (ray, all) = (PreparedRay::new(trace.ray, group), trace.all(group.triangles.blocks.len()));
        // SAFETY: the caller promises the instruction set.
        unsafe { ray.trace::<S, Q>(group, trace.instance, all, query) }
    }
}

/// Rays that traverse the triangles of the top group one after another.
pub(super) struct TraceEach<'a, Q> {
    pub group: &'a Group,
    /// Those that are not valid are left out.
    pub rays: &'a [Ray; WIDTH],
    /// A query for each ray.
    pub queries: &'a mut [Q; WIDTH],
    pub stats: &'a mut RayStats,
}

impl<Q: Query> Task for TraceEach<'_, Q> {
    type Output = ();

    /// All rays are prepared before the first is traced: their divisions overlap, and what is
    /// written number by number has reached the cache when vectors of it are read.
    #[inline(always)]
    unsafe fn run<S: Simd>(self) {
        let Self { group, rays, queries, stats } = self;
        if group.triangles.is_empty() {
            return;
        }
        let mut prepared = [const { MaybeUninit::uninit() }; WIDTH];
        for (prepared, ray) in prepared.iter_mut().zip(rays) {
            prepared.write(PreparedRay::new(ray, group));
        }
        let (mut extents, mut primitives) = (0, 0);
        for ((prepared, ray), query) in prepared.iter().zip(rays).zip(queries) {
            if is_valid(ray) {
                // SAFETY: all were written; the caller promises the instruction set.
                let tested = unsafe {
                    prepared.assume_init_ref().trace::<S, Q>(group, InstancePath::TOP, None, query)
                };
                extents += tested.0;
                primitives += tested.1;
            }
        }
        stats.extents += extents;
        stats.primitives += primitives;
    }
}

/// A ray prepared for the triangles of a group.
struct PreparedRay<'a> {
    sheared: Sheared<'a>,
    slabs: RaySlabs<f32>,
}

impl<'a> PreparedRay<'a> {
    #[inline(always)]
    fn new(ray: &'a Ray, group: &Group) -> Self {
        Self { sheared: Sheared::new(ray), slabs: group.triangles.tree.prepare(ray) }
    }

    /// Offers the hits on triangles of the group to the query, or those on `all` blocks without
    /// traversal. Returns the number of boxes and of triangles tested, and whether the query is
    /// finished. The ray must be valid.
    ///
    /// # Safety
    /// The processor must have the instruction set.
    #[inline(always)]
    unsafe fn trace<S: Simd, Q: Query>(
        &self,
        group: &Group,
        instance: InstancePath,
        all: Option<Range<usize>>,
        query: &mut Q,
    ) -> (u64, u64, bool) {
        // SAFETY: as the caller promises.
        unsafe {
            let lanes = self.sheared.lanes::<{ TriangleBlock::VERTICES }, S::F32x8>();
            let (sheared, mut t_max) = (&self.sheared, query.t_max());
            let mut leaves =
                TriangleLeaves::<S, Q> { group, instance, sheared, lanes: &lanes, query, primitives: 0 };
            let tree = &group.triangles.tree;
            let (extents, stop) = traverse::<S, Q>(tree, all, &self.slabs, &mut t_max, &mut leaves);
            (extents, leaves.primitives, stop)
        }
    }
}

/// The triangles of a group, tested against one ray.
pub(super) struct TriangleLeaves<'a, S: Simd, Q> {
    pub group: &'a Group,
    pub instance: InstancePath,
    pub sheared: &'a Sheared<'a>,
    pub lanes: &'a ShearedLanes<S::F32x8>,
    pub query: &'a mut Q,
    /// How many were tested.
    pub primitives: u64,
}

impl<S: Simd, Q: Query> Leaves for TriangleLeaves<'_, S, Q> {
    type Block = TriangleBlock;

    #[inline(always)]
    fn blocks(&self) -> &[TriangleBlock] {
        &self.group.triangles.blocks
    }

    #[inline(always)]
    unsafe fn test(&mut self, blocks: Range<usize>, t_max: &mut f32) -> bool {
        // SAFETY: the tree was built over these blocks.
        let blocks = unsafe { self.group.triangles.blocks.get_unchecked(blocks) };
        if <S::Real as Real>::LANES < 2 * TriangleBlock::WIDTH {
            for block in blocks {
                self.primitives += TriangleBlock::WIDTH as u64;
                let found = block.intersect::<S>(self.lanes, *t_max);
                let Some(found) = found else { continue };
                if self.offer([block; 2], &found, found.hits) {
                    return true;
                }
                *t_max = self.query.t_max();
            }
            return false;
        }
        for pair in blocks.chunks(2) {
            // A single block is tested twice, and its hits are taken once.
            let both = [&pair[0], &pair[pair.len() - 1]];
            self.primitives += (pair.len() * TriangleBlock::WIDTH) as u64;
            let found = TriangleBlock::intersect_both::<S>(both, self.lanes, *t_max);
            let Some(found) = found else { continue };
            let hits = found.hits & ((1 << (pair.len() * TriangleBlock::WIDTH)) - 1);
            if self.offer(both, &found, hits) {
                return true;
            }
            *t_max = self.query.t_max();
        }
        false
    }
}

impl<S: Simd, Q: Query> TriangleLeaves<'_, S, Q> {
    /// Offers hits of two blocks to the query; returns whether it is finished.
    #[inline(always)]
    fn offer<const N: usize, V: Vector<N>>(
        &mut self,
        blocks: [&TriangleBlock; 2],
        found: &LaneHits<V>,
        mut hits: u32,
    ) -> bool {
        while hits != 0 {
            let of = hits.trailing_zeros() as usize % N;
            hits &= hits - 1;
            let (lane, block) = (of % TriangleBlock::WIDTH, blocks[of / TriangleBlock::WIDTH]);
            let (numbering, instance) = (&self.group.triangles.numbering, self.instance);
            let hit = block.hit(lane, found, of, self.sheared, numbering, instance);
            if hit.is_some_and(|hit| self.query.offer(hit)) {
                return true;
            }
        }
        false
    }
}

/// A ray that traverses the items of a group.
struct TraceItems<'a, 'b, Q> {
    group: &'a Group,
    trace: &'a mut Trace<'b>,
    query: &'a mut Q,
}

impl<Q: Query> Task for TraceItems<'_, '_, Q> {
    const EVERY_SET: bool = Q::EVERY_SET;

    type Output = (u64, bool);

    #[inline(always)]
    unsafe fn run<S: Simd>(self) -> Self::Output {
        let Self { group, trace, query } = self;
        let (ray, all) = (trace.ray, trace.all(group.items.len()));
        let mut t_max = query.t_max();
        let mut leaves = ItemLeaves { items: &group.items, trace, query };
        // SAFETY: the caller promises the instruction set.
        unsafe {
            let slabs = group.item_tree.prepare(ray);
            traverse::<S, Q>(&group.item_tree, all, &slabs, &mut t_max, &mut leaves)
        }
    }
}

/// The items of a group, tested against one ray.
struct ItemLeaves<'a, 'b, Q> {
    items: &'a [Item],
    trace: &'a mut Trace<'b>,
    query: &'a mut Q,
}

impl<Q: Query> Leaves for ItemLeaves<'_, '_, Q> {
    type Block = Item;

    #[inline(always)]
    fn blocks(&self) -> &[Item] {
        self.items
    }

    #[inline(always)]
    unsafe fn test(&mut self, blocks: Range<usize>, t_max: &mut f32) -> bool {
        for &item in &self.items[blocks] {
            if self.trace.item(item, self.query) {
                return true;
            }
        }
        *t_max = self.query.t_max();
        false
    }
}

/// A ray that traverses the spheres of a group.
struct TraceSpheres<'a, 'b, Q> {
    spheres: &'a Spheres,
    trace: &'a Trace<'b>,
    query: &'a mut Q,
}

impl<Q: Query> Task for TraceSpheres<'_, '_, Q> {
    const EVERY_SET: bool = Q::EVERY_SET;

    type Output = (u64, u64, bool);

    #[inline(always)]
    unsafe fn run<S: Simd>(self) -> Self::Output {
        let Self { spheres, trace, query } = self;
        let mut t_max = query.t_max();
        // SAFETY: the caller promises the instruction set.
        unsafe {
            let lanes = ScaledRays::<S::F32x8>::of(trace.ray);
            let mut leaves = SphereLeaves {
                blocks: &spheres.blocks,
                trace,
                lanes,
                exact: SphereRay::new(trace.ray),
                query,
                primitives: 0,
            };
            let all = trace.all(spheres.blocks.len());
            let slabs = spheres.tree.prepare(trace.ray);
            let (extents, stop) = traverse::<S, Q>(&spheres.tree, all, &slabs, &mut t_max, &mut leaves);
            (extents, leaves.primitives, stop)
        }
    }
}

/// The spheres of a group, tested against one ray.
struct SphereLeaves<'a, 'b, V, Q> {
    blocks: &'a [SphereBlock],
    trace: &'a Trace<'b>,
    lanes: ScaledRays<V>,
    exact: SphereRay,
    query: &'a mut Q,
    /// How many were tested.
    primitives: u64,
}

impl<V: Vector<{ SphereBlock::WIDTH }>, Q: Query> Leaves for SphereLeaves<'_, '_, V, Q> {
    type Block = SphereBlock;

    #[inline(always)]
    fn blocks(&self) -> &[SphereBlock] {
        self.blocks
    }

    #[inline(always)]
    unsafe fn test(&mut self, blocks: Range<usize>, t_max: &mut f32) -> bool {
        for block in &self.blocks[blocks] {
            self.primitives += block.len() as u64;
            let mut candidates = block.met_by(&self.lanes, *t_max);
            while candidates != 0 {
                let lane = candidates.trailing_zeros() as usize % SphereBlock::WIDTH;
                candidates &= candidates - 1;
                if block.offer(lane, &self.exact, self.trace.instance, self.query) {
                    return true;
                }
            }
            *t_max = self.query.t_max();
        }
        false
    }
}
