//! Filters of hits.

use super::geometry::GeometryId;
use super::hit::Hit;
use math::Ray;

/// Accepts or rejects hits, always in the same way. A closure is a filter that may reject any.
pub trait Filter {
    /// Whether rays with this filter are traced by [every set](lanes::Task::EVERY_SET): what tests
    /// compare.
    const EVERY_SET: bool = false;

    /// Whether a hit counts.
    fn accepts(&self, hit: &Hit, ray: &Ray) -> bool;

    /// Whether any hit of a geometry may be rejected; hits of others need not be asked for.
    fn concerns(&self, geometry: GeometryId) -> bool;
}

impl<F: Fn(&Hit, &Ray) -> bool> Filter for F {
    #[inline(always)]
    fn accepts(&self, hit: &Hit, ray: &Ray) -> bool {
        self(hit, ray)
    }

    #[inline(always)]
    fn concerns(&self, _: GeometryId) -> bool {
        true
    }
}
