//! Lights in proportion to their importance to the shading point, which is evaluated for each of
//! them: the bound on its contribution by which the [tree](super::BvhLightSampler) chooses between
//! clusters, here of single lights.
//!
//! A choice costs as much as all lights together, twice for the sum and for the light where it
//! exceeds a random share. That is for few lights, and to judge the tree. Source:
//! [Pharr 2023 §12.6].

use super::cluster::{Cluster, NUMBERS};
use super::infinite::{InfiniteLights, separated};
use crate::light::{LightId, LightSampleContext, Lights};
use lanes::{Int, Mask, Real};
use std::sync::atomic::AtomicBool;

/// Lights in proportion to importance.
#[derive(Clone, Debug)]
pub struct ExhaustiveLightSampler {
    /// By row: a light with bounds.
    clusters: Vec<[f32; NUMBERS]>,
    /// By row: the id of its light.
    ids: Vec<u32>,
    infinite: InfiniteLights,
    /// By light: its row, [`INFINITE`] or [`NOWHERE`].
    rows: Vec<u32>,
}

/// The row of a light whose power is zero, which is never chosen.
const NOWHERE: u32 = u32::MAX;
/// The row of a light infinitely far away.
const INFINITE: u32 = u32::MAX - 1;

impl ExhaustiveLightSampler {
    /// Of these lights; `None` if `cancel` is set meanwhile.
    pub fn new(lights: Lights, cancel: &AtomicBool) -> Option<Self> {
        let (infinite, bounded) = separated(lights, cancel)?;
        let mut rows = vec![NOWHERE; lights.len()];
        infinite.ids().iter().for_each(|&id| rows[id as usize] = INFINITE);
        bounded.iter().zip(0..).for_each(|((id, _), row)| rows[id.0 as usize] = row);
        let ids = bounded.iter().map(|(id, _)| id.0).collect();
        let clusters = bounded.iter().map(|(_, bounds)| Cluster::row(bounds)).collect();
        Some(Self { clusters, ids, infinite, rows })
    }

    /// Importances so small that their sum is finite, at the position of point lights, too.
    #[inline(always)]
    fn importance<R: Real>(&self, rows: R::Int, context: &LightSampleContext<R>) -> R {
        let cluster = Cluster::<R>::gather(self.clusters.as_flattened(), rows);
        let most = f32::MAX / (2 * self.clusters.len()) as f32;
        cluster.importance(context.p.p, context.ns).min(R::splat(most))
    }

    /// The sum of all importances.
    #[inline(always)]
    fn total<R: Real>(&self, context: &LightSampleContext<R>) -> R {
        let mut total = R::zero();
        for row in 0..self.clusters.len() {
            total = total + self.importance(R::Int::splat(row as u32), context);
        }
        total
    }

    /// See [`LightSampler::sample_lanes`](super::LightSampler::sample_lanes).
    #[inline(always)]
    pub(super) fn sample_lanes<R: Real>(
        &self,
        context: &LightSampleContext<R>,
        u: R,
        active: R::Mask,
    ) -> (R::Int, R, R::Mask) {
        let is_infinite = u.lt(R::splat(self.infinite.probability())) & active;
        let (mut lights, mut pmf, mut valid) = (R::Int::splat(0), R::zero(), is_infinite);
        if is_infinite.any() {
            (lights, pmf) = (self.infinite.choose(u), R::splat(self.infinite.pmf()));
        }
        let is_bounded = active & !is_infinite;
        if !is_bounded.any() {
            return (lights, pmf, valid);
        }
        let zero = R::zero();
        let total = self.total(context);
        let threshold = self.infinite.rest(u) * total;
        let (mut sum, mut importance, mut row) = (zero, zero, R::Int::splat(0));
        let mut searches = is_bounded & total.gt(zero);
        valid = valid | searches;
        for candidate in 0..self.clusters.len() {
            if !searches.any() {
                break;
            }
            let candidate = R::Int::splat(candidate as u32);
            let of_candidate = self.importance(candidate, context);
            sum = sum + of_candidate;
            // If rounding puts the threshold at the total, the last one is chosen.
            let is_possible = searches & of_candidate.gt(zero);
            importance = R::select(is_possible, of_candidate, importance);
            row = R::Int::select(is_possible, candidate, row);
            searches = searches & !threshold.lt(sum);
        }
        if !self.ids.is_empty() {
            lights = R::Int::select(is_bounded, R::Int::gather(&self.ids, row), lights);
        }
        pmf = R::select(is_bounded, self.share(importance, total), pmf);
        (lights, pmf, valid)
    }

    /// The probability of a light of this importance.
    #[inline(always)]
    fn share<R: Real>(&self, importance: R, total: R) -> R {
        let share = R::splat(1.0 - self.infinite.probability()) * (importance / total);
        R::select(total.gt(R::zero()), share, R::zero())
    }

    pub(super) fn sample(&self, context: &LightSampleContext, u: f32) -> Option<(LightId, f32)> {
        let (light, pmf, valid) = self.sample_lanes::<f32>(context, u, true);
        valid.then_some((LightId(light), pmf))
    }

    /// See [`LightSampler::pmf_lanes`](super::LightSampler::pmf_lanes).
    #[inline(always)]
    pub(super) fn pmf_lanes<R: Real>(
        &self,
        context: &LightSampleContext<R>,
        lights: R::Int,
        active: R::Mask,
    ) -> R {
        let zero = R::zero();
        if !active.any() {
            return zero;
        }
        let rows = R::Int::gather(&self.rows, R::Int::select(active, lights, R::Int::splat(0)));
        let is_infinite = rows.eq(R::Int::splat(INFINITE));
        let pmf = R::select(is_infinite, R::splat(self.infinite.pmf()), zero);
        let is_bounded = active & rows.lt(R::Int::splat(INFINITE));
        if !is_bounded.any() {
            return pmf;
        }
        let importance = self.importance(R::Int::select(is_bounded, rows, R::Int::splat(0)), context);
        R::select(is_bounded, self.share(importance, self.total(context)), pmf)
    }
}
