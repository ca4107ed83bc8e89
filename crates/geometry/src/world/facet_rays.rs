//! Rays through the facets of a world: a ray against facets in lanes, or facets against rays in
//! lanes.

#![allow(unsafe_code)]

use super::columns::{HitColumns, RayColumns};
use super::facets::{Facets, MOST};
use super::filter::Filter;
use super::geometry::{Geometry, GeometryId};
use super::hit::Hit;
use super::instance::InstancePath;
use super::query::Query;
use super::tables::Tables;
use super::trace::is_valid;
use crate::facet::{Meeting, RayLanes};
use lanes::{Int, MAX_LANES, Mask, Real, Simd, Task};
use math::{Ray, Vec2, Vec3};

/// One ray, whose hits are offered to a query.
pub(super) struct FacetRay<'a, Q> {
    pub tables: &'a Tables,
    pub facets: &'a Facets,
    pub ray: &'a Ray,
    pub query: &'a mut Q,
}

impl<Q: Query> Task for FacetRay<'_, Q> {
    type Output = ();

    #[inline(always)]
    unsafe fn run<S: Simd>(self) {
        self.in_lanes::<S::Real>();
    }
}

impl<Q: Query> FacetRay<'_, Q> {
    /// Offers the hits of all facets to the query, until it is finished.
    #[inline]
    pub fn trace(self) {
        let set = self.tables.instruction_set;
        // SAFETY: the processor has the instruction set of a world.
        unsafe { set.run(self) }
    }

    #[inline(always)]
    fn in_lanes<R: Real>(self) {
        let Self { tables, facets, ray, query } = self;
        let t_max = query.t_max();
        if !is_valid(ray) || t_max.is_nan() || t_max <= 0.0 {
            return;
        }
        let (rays, _) =
            RayLanes::<R>::new(Vec3::broadcast(ray.o), Vec3::broadcast(ray.d), R::splat(t_max), true);
        for block in &facets.blocks {
            for (part, indices) in block.facets.chunks(R::LANES).enumerate() {
                let (facet, twist) = block.facets::<R>(part * R::LANES);
                let met = rays.meet(&facet, twist.as_ref(), R::splat(query.t_max()));
                let used = u32::MAX >> (32 - indices.len());
                let certain = met.certain.bits();
                let mut hits = (certain | met.uncertain.bits()) & used;
                if hits == 0 {
                    continue;
                }
                let (t, [u, v]) = (met.t.to_array(), [met.uv[0].to_array(), met.uv[1].to_array()]);
                while hits != 0 {
                    let lane = hits.trailing_zeros() as usize;
                    hits &= hits - 1;
                    let facet = indices[lane] as usize;
                    let found = if certain >> lane & 1 != 0 {
                        Some((t[lane], Vec2::new(u[lane], v[lane])))
                    } else {
                        facets.resolve(facet, &tables.geometries, ray, t_max)
                    };
                    let Some((t, uv)) = found else { continue };
                    if query.offer(facets.hit(facet, t, uv)) {
                        return;
                    }
                }
            }
        }
    }
}

/// Rays of a batch.
pub(super) struct FacetRays<'a, F> {
    pub geometries: &'a [Geometry],
    pub facets: &'a Facets,
    pub rays: RayColumns<'a>,
    pub filter: &'a F,
}

/// What rays have hit, one in each lane: their ends, or the distances of their nearest hits; that
/// is below zero where there is nothing more to be found.
#[derive(Clone, Copy)]
struct Found<R: Real> {
    t: R,
    uv: [R; 2],
    facet: R::Int,
}

/// The same in arrays, for one lane after another.
struct FoundArrays {
    t: [f32; MAX_LANES],
    uv: [[f32; MAX_LANES]; 2],
    facet: [u32; MAX_LANES],
}

impl<F: Filter> FacetRays<'_, F> {
    /// The bits of the facets whose hits may be rejected.
    fn concerned(&self) -> u64 {
        let concerned = |&geometry: &u32| self.filter.concerns(GeometryId(geometry)) as u64;
        let facets = &self.facets.geometries[..self.facets.len()];
        facets.iter().enumerate().map(|(facet, geometry)| concerned(geometry) << facet).sum()
    }

    /// The hits of the rays from `first` on; with `ANY`, only whether there is one.
    #[inline(always)]
    fn find<R: Real, const ANY: bool>(&self, first: usize, concerned: u64) -> Found<R> {
        let Self { facets, .. } = *self;
        let (o, d, t_max) = self.rays.lanes::<R>(first);
        let (rays, valid) = RayLanes::new(o, d, t_max, self.rays.t_max.is_some());
        let done = R::splat(-1.0);
        let mut found = Found {
            t: R::select(valid, t_max, done),
            uv: [R::zero(); 2],
            facet: R::Int::splat(facets.len() as u32),
        };
        // Uncertain hits are resolved after all others, so that a loop without branches is left.
        let mut doubts = [0; MOST];
        let mut any_doubts = 0;
        for (index, (&(block, lane), doubts)) in facets.places.iter().zip(&mut doubts).enumerate() {
            let (facet, twist) = facets.blocks[block as usize].facet::<R>(lane.into());
            let met = rays.meet(&facet, twist.as_ref(), found.t);
            let hits = met.certain & met.t.lt(found.t);
            *doubts = (met.uncertain & found.t.gt(R::zero())).bits();
            any_doubts |= *doubts;
            if concerned >> index & 1 != 0 {
                if hits.any() {
                    let mut arrays = FoundArrays::of(&found);
                    let met = MetArrays::of(&met);
                    self.settle::<ANY>(first, index, hits.bits(), Some(&met), &mut arrays);
                    found = arrays.lanes();
                }
                continue;
            }
            found.t = R::select(hits, if ANY { done } else { met.t }, found.t);
            found.uv[0] = R::select(hits, met.uv[0], found.uv[0]);
            found.uv[1] = R::select(hits, met.uv[1], found.uv[1]);
            found.facet = R::Int::select(hits, R::Int::splat(index as u32), found.facet);
            if ANY && index % 8 == 7 && !found.t.gt(R::zero()).any() {
                break;
            }
        }
        if any_doubts != 0 {
            let mut arrays = FoundArrays::of(&found);
            for (index, &doubts) in doubts[..facets.len()].iter().enumerate() {
                if doubts != 0 {
                    self.settle::<ANY>(first, index, doubts, None, &mut arrays);
                }
            }
            found = arrays.lanes();
        }
        found
    }

    /// Tests rays one by one against a facet: takes the hits `met`, or finds them by the shape's
    /// own test.
    #[cold]
    #[inline(never)]
    fn settle<const ANY: bool>(
        &self,
        first: usize,
        facet: usize,
        mut lanes: u32,
        met: Option<&MetArrays>,
        found: &mut FoundArrays,
    ) {
        let geometry = GeometryId(self.facets.geometries[facet]);
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize % MAX_LANES;
            lanes &= lanes - 1;
            let place = (first + lane).min(self.rays.len() - 1);
            let ray = self.rays.ray(place);
            let hit = match met {
                Some(met) => Some((met.t[lane], Vec2::new(met.uv[0][lane], met.uv[1][lane]))),
                None => self.facets.resolve(facet, self.geometries, &ray, self.rays.t_max(place)),
            };
            let Some((t, uv)) = hit else { continue };
            // Of hits at the same distance the first facet's counts.
            let is_nearest = (t, facet as u32) < (found.t[lane], found.facet[lane]);
            if !is_nearest
                || self.filter.concerns(geometry)
                    && !self.filter.accepts(&self.facets.hit(facet, t, uv), &ray)
            {
                continue;
            }
            found.t[lane] = if ANY { -1.0 } else { t };
            found.uv[0][lane] = uv.x;
            found.uv[1][lane] = uv.y;
            found.facet[lane] = facet as u32;
        }
    }
}

/// A [`Meeting`] in arrays.
struct MetArrays {
    t: [f32; MAX_LANES],
    uv: [[f32; MAX_LANES]; 2],
}

impl MetArrays {
    #[inline(always)]
    fn of<R: Real>(met: &Meeting<R>) -> Self {
        let uv = [met.uv[0].to_array(), met.uv[1].to_array()];
        Self { t: met.t.to_array(), uv }
    }
}

impl FoundArrays {
    #[inline(always)]
    fn of<R: Real>(found: &Found<R>) -> Self {
        let uv = [found.uv[0].to_array(), found.uv[1].to_array()];
        Self { t: found.t.to_array(), uv, facet: found.facet.to_array() }
    }

    #[inline(always)]
    fn lanes<R: Real>(&self) -> Found<R> {
        let uv = [R::load(&self.uv[0]), R::load(&self.uv[1])];
        Found { t: R::load(&self.t), uv, facet: R::Int::load(&self.facet) }
    }
}

/// Finds the nearest hits.
pub(super) struct NearestHits<'a, 'b, F>(pub FacetRays<'a, F>, pub &'b mut HitColumns);

impl<F: Filter> Task for NearestHits<'_, '_, F> {
    type Output = ();

    #[inline(always)]
    unsafe fn run<S: Simd>(self) {
        nearest::<S::Real, F>(&self.0, self.1);
    }
}

#[inline(always)]
fn nearest<R: Real, F: Filter>(rays: &FacetRays<F>, hits: &mut HitColumns) {
    let concerned = rays.concerned();
    let mut first = 0;
    while first < rays.rays.len() {
        let found = rays.find::<R, false>(first, concerned);
        let geometry = R::Int::gather(&rays.facets.geometries, found.facet);
        let primitive = R::Int::gather(&rays.facets.primitives, found.facet);
        hits.set_lanes(first, found.t, found.uv, geometry, primitive);
        first += R::LANES;
    }
}

/// Finds whether there is any hit.
pub(super) struct AnyHits<'a, 'b, F>(pub FacetRays<'a, F>, pub &'b mut [bool]);

impl<F: Filter> Task for AnyHits<'_, '_, F> {
    type Output = ();

    #[inline(always)]
    unsafe fn run<S: Simd>(self) {
        any::<S::Real, F>(&self.0, self.1);
    }
}

#[inline(always)]
fn any<R: Real, F: Filter>(rays: &FacetRays<F>, occluded: &mut [bool]) {
    let concerned = rays.concerned();
    for (part, occluded) in occluded.chunks_mut(R::LANES).enumerate() {
        let found = rays.find::<R, true>(part * R::LANES, concerned);
        let hits = found.facet.lt(R::Int::splat(rays.facets.len() as u32)).bits();
        for (lane, occluded) in occluded.iter_mut().enumerate() {
            *occluded = hits >> lane & 1 != 0;
        }
    }
}

impl Facets {
    /// The hit on a facet.
    #[inline(always)]
    fn hit(&self, facet: usize, t: f32, uv: Vec2) -> Hit {
        let geometry = GeometryId(self.geometries[facet]);
        Hit { t, uv, geometry, primitive: self.primitives[facet], instance: InstancePath::TOP }
    }
}
