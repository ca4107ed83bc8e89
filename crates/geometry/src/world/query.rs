//! Queries of a ray: its nearest hit, or whether there is any hit.
//!
//! The answer does not depend on the order in which hits are offered: of hits at the same distance,
//! the one with the first instance, geometry and primitive is the nearest.

use super::filter::Filter;
use super::hit::Hit;
use math::Ray;

/// A query, which considers hits one after another.
pub(super) trait Query {
    /// Whether any hit answers the query, not only the nearest.
    const ANY: bool;

    /// [`Filter::EVERY_SET`].
    const EVERY_SET: bool;

    /// Whether the query is finished.
    fn is_answered(&self) -> bool;

    /// The result.
    type Answer;

    /// The answer, once all hits were offered.
    fn answer(&self) -> Self::Answer;

    /// Hits beyond this distance are ignored.
    fn t_max(&self) -> f32;

    /// Hits at or beyond this distance are ignored.
    fn end(&self) -> f32;

    /// Considers a hit; returns whether the query is finished.
    fn offer(&mut self, hit: Hit) -> bool;
}

/// Offers the hits of a primitive one after another, until one counts: a filter may reject the
/// nearest one. `next` gives the first beyond a distance. Returns whether the query is finished.
#[inline(always)]
pub(super) fn offer_all<Q: Query>(query: &mut Q, next: impl Fn(f32, &Q) -> Option<Hit>) -> bool {
    let mut after = 0.0;
    while let Some(hit) = next(after, query) {
        after = hit.t;
        if query.offer(hit) {
            return true;
        }
        if query.t_max() <= after {
            break;
        }
    }
    false
}

/// The nearest hit that the filter accepts.
pub(super) struct Nearest<'a, F> {
    ray: &'a Ray,
    filter: &'a F,
    t_max: f32,
    hit: Option<Hit>,
}

impl<'a, F: Filter> Nearest<'a, F> {
    pub fn new(ray: &'a Ray, t_max: f32, filter: &'a F) -> Self {
        Self { ray, filter, t_max, hit: None }
    }
}

impl<F: Filter> Query for Nearest<'_, F> {
    const ANY: bool = false;

    const EVERY_SET: bool = F::EVERY_SET;

    type Answer = Option<Hit>;

    fn is_answered(&self) -> bool {
        false
    }

    #[inline(always)]
    fn answer(&self) -> Option<Hit> {
        self.hit
    }

    #[inline(always)]
    fn t_max(&self) -> f32 {
        self.t_max
    }

    fn end(&self) -> f32 {
        if self.hit.is_some() { self.t_max.next_up() } else { self.t_max }
    }

    #[inline(always)]
    fn offer(&mut self, hit: Hit) -> bool {
        let is_nearer = hit.t < self.t_max
            || hit.t == self.t_max && self.hit.as_ref().is_some_and(|other| precedes(hit, other));
        if is_nearer && self.filter.accepts(&hit, self.ray) {
            self.t_max = hit.t;
            self.hit = Some(hit);
        }
        false
    }
}

/// Whether a hit comes before another one at the same distance. A call with a copy, so that the
/// hit itself stays in registers.
#[cold]
#[inline(never)]
fn precedes(hit: Hit, other: &Hit) -> bool {
    (hit.instance, hit.geometry, hit.primitive) < (other.instance, other.geometry, other.primitive)
}

/// Whether there is a hit that the filter accepts.
pub(super) struct Any<'a, F> {
    ray: &'a Ray,
    filter: &'a F,
    t_max: f32,
    found: bool,
}

impl<'a, F: Filter> Any<'a, F> {
    pub fn new(ray: &'a Ray, t_max: f32, filter: &'a F) -> Self {
        Self { ray, filter, t_max, found: false }
    }
}

impl<F: Filter> Query for Any<'_, F> {
    const ANY: bool = true;

    const EVERY_SET: bool = F::EVERY_SET;

    type Answer = bool;

    fn is_answered(&self) -> bool {
        self.found
    }

    #[inline(always)]
    fn answer(&self) -> bool {
        self.found
    }

    #[inline(always)]
    fn t_max(&self) -> f32 {
        self.t_max
    }

    fn end(&self) -> f32 {
        self.t_max
    }

    #[inline(always)]
    fn offer(&mut self, hit: Hit) -> bool {
        self.found = hit.t < self.t_max && self.filter.accepts(&hit, self.ray);
        self.found
    }
}
