//! Rays through the facets of a world: a ray against facets in lanes, or facets against rays in
//! lanes.

#![allow(unsafe_code)]

use super::columns::{HitColumns, RayColumns};
use super::facets::{Facets, MOST, Spread};
use super::filter::Filter;
use super::geometry::{Geometry, GeometryId};
use super::hit::Hit;
use super::instance::InstancePath;
use super::query::Query;
use super::tables::Tables;
use super::trace::is_valid;
use crate::facet::{Meeting, RayLanes, parameters};
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
    const EVERY_SET: bool = Q::EVERY_SET;

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
                let nearest = R::splat(query.t_max());
                let met = match &twist {
                    None => rays.meet(&facet, nearest),
                    Some(twist) => rays.meet_patch(&facet, twist, nearest),
                };
                let used = u32::MAX >> (32 - indices.len());
                let certain = met.certain.bits();
                let mut hits = (certain | met.uncertain.bits()) & used;
                if hits == 0 {
                    continue;
                }
                let (t, [x, y]) = (met.t.to_array(), [met.at[0].to_array(), met.at[1].to_array()]);
                while hits != 0 {
                    let lane = hits.trailing_zeros() as usize;
                    hits &= hits - 1;
                    let facet = indices[lane] as usize;
                    let found = if certain >> lane & 1 != 0 {
                        Some((t[lane], facets.uv(facet, [x[lane], y[lane]])))
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
/// is below zero where there is nothing more to be found. `at` is where a [`Meeting`] has it, at
/// last u and v.
#[derive(Clone, Copy)]
struct Found<R: Real> {
    t: R,
    at: [R; 2],
    facet: R::Int,
}

/// The lanes of each facet whose hits are uncertain, and those of any.
struct Doubts {
    lanes: [u32; MOST],
    any: u32,
}

impl Doubts {
    #[inline(always)]
    fn add<M: Mask>(&mut self, facet: usize, lanes: M) {
        let lanes = lanes.bits();
        self.lanes[facet % MOST] = lanes;
        self.any |= lanes;
    }
}

/// The distance where nothing more is to be found.
#[inline(always)]
fn done<R: Real>() -> R {
    R::splat(-1.0)
}

/// The same in arrays, for one lane after another.
struct FoundArrays {
    t: [f32; MAX_LANES],
    at: [[f32; MAX_LANES]; 2],
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
    fn find<R: Real, const ANY: bool>(&self, first: usize, spread: &Spread<R>, concerned: u64) -> Found<R> {
        let Self { facets, .. } = *self;
        let (o, d, t_max) = self.rays.lanes::<R>(first);
        let (rays, valid) = RayLanes::new(o, d, t_max, self.rays.t_max.is_some());
        let mut found = Found {
            t: R::select(valid, t_max, done()),
            at: [R::zero(); 2],
            facet: R::Int::splat(facets.len() as u32),
        };
        // Uncertain hits are resolved after all others, so that a loop without branches is left.
        let mut doubts = Doubts { lanes: [0; MOST], any: 0 };
        for (turn, (index, facet)) in spread.plane.iter().enumerate() {
            let met = rays.meet(facet, found.t);
            let hits = met.certain & met.t.lt(found.t);
            doubts.add(*index, met.uncertain & found.t.gt(R::zero()));
            self.take::<R, ANY>(first, *index, &met, hits, concerned, &mut found);
            if ANY && turn % 8 == 7 && !found.t.gt(R::zero()).any() {
                return found;
            }
        }
        for (index, facet, twist) in &spread.patches {
            let met = rays.meet_patch(facet, twist, found.t);
            let is_first = met.t.eq(found.t) & R::Int::splat(*index as u32).lt(found.facet);
            let hits = met.certain & (met.t.lt(found.t) | is_first);
            doubts.add(*index, met.uncertain & found.t.gt(R::zero()));
            self.take::<R, ANY>(first, *index, &met, hits, concerned, &mut found);
        }
        if !ANY && facets.is_skewed {
            let [a, b] = &facets.skews;
            found.at = parameters([R::gather(a, found.facet), R::gather(b, found.facet)], found.at);
        }
        if doubts.any != 0 {
            let mut arrays = FoundArrays::of(&found);
            for (index, &lanes) in doubts.lanes[..facets.len()].iter().enumerate() {
                if lanes != 0 {
                    self.settle::<ANY>(first, index, lanes, None, &mut arrays);
                }
            }
            found = arrays.lanes();
        }
        found
    }

    /// Takes the hits of rays from `first` on, at the facet `index`; with `ANY`, no more than that
    /// there are some. The filter is asked about those that it concerns.
    #[inline(always)]
    fn take<R: Real, const ANY: bool>(
        &self,
        first: usize,
        index: usize,
        met: &Meeting<R>,
        hits: R::Mask,
        concerned: u64,
        found: &mut Found<R>,
    ) {
        if concerned >> index & 1 != 0 {
            if hits.any() {
                let mut arrays = FoundArrays::of(found);
                self.settle::<ANY>(first, index, hits.bits(), Some(&MetArrays::of(met)), &mut arrays);
                *found = arrays.lanes();
            }
            return;
        }
        found.t = R::select(hits, if ANY { done() } else { met.t }, found.t);
        found.facet = R::Int::select(hits, R::Int::splat(index as u32), found.facet);
        if !ANY {
            found.at[0] = R::select(hits, met.at[0], found.at[0]);
            found.at[1] = R::select(hits, met.at[1], found.at[1]);
        }
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
            let (t, at, uv) = match met {
                Some(met) => {
                    let at = [met.at[0][lane], met.at[1][lane]];
                    (met.t[lane], at, self.facets.uv(facet, at))
                }
                None => {
                    let t_max = self.rays.t_max(place);
                    let hit = self.facets.resolve(facet, self.geometries, &ray, t_max);
                    let Some((t, uv)) = hit else { continue };
                    (t, [uv.x, uv.y], uv)
                }
            };
            // Of hits at the same distance the first facet's counts.
            let is_nearest = (t, facet as u32) < (found.t[lane], found.facet[lane]);
            if !is_nearest
                || self.filter.concerns(geometry)
                    && !self.filter.accepts(&self.facets.hit(facet, t, uv), &ray)
            {
                continue;
            }
            found.t[lane] = if ANY { -1.0 } else { t };
            found.at[0][lane] = at[0];
            found.at[1][lane] = at[1];
            found.facet[lane] = facet as u32;
        }
    }
}

/// A [`Meeting`] in arrays.
struct MetArrays {
    t: [f32; MAX_LANES],
    at: [[f32; MAX_LANES]; 2],
}

impl MetArrays {
    #[inline(always)]
    fn of<R: Real>(met: &Meeting<R>) -> Self {
        let at = [met.at[0].to_array(), met.at[1].to_array()];
        Self { t: met.t.to_array(), at }
    }
}

impl FoundArrays {
    #[inline(always)]
    fn of<R: Real>(found: &Found<R>) -> Self {
        let at = [found.at[0].to_array(), found.at[1].to_array()];
        Self { t: found.t.to_array(), at, facet: found.facet.to_array() }
    }

    #[inline(always)]
    fn lanes<R: Real>(&self) -> Found<R> {
        let at = [R::load(&self.at[0]), R::load(&self.at[1])];
        Found { t: R::load(&self.t), at, facet: R::Int::load(&self.facet) }
    }
}

/// Finds the nearest hits.
pub(super) struct NearestHits<'a, 'b, F>(pub FacetRays<'a, F>, pub &'b mut HitColumns);

impl<F: Filter> Task for NearestHits<'_, '_, F> {
    const EVERY_SET: bool = F::EVERY_SET;

    type Output = ();

    #[inline(always)]
    unsafe fn run<S: Simd>(self) {
        nearest::<S::Real, F>(&self.0, self.1);
    }
}

#[inline(always)]
fn nearest<R: Real, F: Filter>(rays: &FacetRays<F>, hits: &mut HitColumns) {
    let (spread, concerned) = (Spread::of(rays.facets), rays.concerned());
    let mut first = 0;
    while first < rays.rays.len() {
        let found = rays.find::<R, false>(first, &spread, concerned);
        let geometry = R::Int::gather(&rays.facets.geometries, found.facet);
        let primitive = R::Int::gather(&rays.facets.primitives, found.facet);
        hits.set_lanes(first, found.t, found.at, geometry, primitive);
        first += R::LANES;
    }
}

/// Finds whether there is any hit.
pub(super) struct AnyHits<'a, 'b, F>(pub FacetRays<'a, F>, pub &'b mut [bool]);

impl<F: Filter> Task for AnyHits<'_, '_, F> {
    const EVERY_SET: bool = F::EVERY_SET;

    type Output = ();

    #[inline(always)]
    unsafe fn run<S: Simd>(self) {
        any::<S::Real, F>(&self.0, self.1);
    }
}

#[inline(always)]
fn any<R: Real, F: Filter>(rays: &FacetRays<F>, occluded: &mut [bool]) {
    let (spread, concerned) = (Spread::of(rays.facets), rays.concerned());
    for (part, occluded) in occluded.chunks_mut(R::LANES).enumerate() {
        let found = rays.find::<R, true>(part * R::LANES, &spread, concerned);
        let hits = found.facet.lt(R::Int::splat(rays.facets.len() as u32)).bits();
        for (lane, occluded) in occluded.iter_mut().enumerate() {
            *occluded = hits >> lane & 1 != 0;
        }
    }
}

impl Facets {
    /// The parameters of a hit that a [`Meeting`] has at x and y.
    #[inline(always)]
    fn uv(&self, facet: usize, at: [f32; 2]) -> Vec2 {
        let [u, v] = parameters([self.skews[0][facet], self.skews[1][facet]], at);
        Vec2::new(u, v)
    }

    /// The hit on a facet.
    #[inline(always)]
    fn hit(&self, facet: usize, t: f32, uv: Vec2) -> Hit {
        let geometry = GeometryId(self.geometries[facet]);
        Hit { t, uv, geometry, primitive: self.primitives[facet], instance: InstancePath::TOP }
    }
}
