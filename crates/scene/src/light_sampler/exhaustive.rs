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
use lanes::{Callee, Int, Mask, Real};
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

    /// Importances so small that their sum is finite, at the position of point lights, too. As in a
    /// tree of one light, a single light is chosen without asking whether it matters.
    #[inline(always)]
    fn importance<R: Real>(&self, rows: R::Int, context: &LightSampleContext<R>) -> R {
        if self.clusters.len() == 1 {
            return R::one();
        }
        let cluster = Cluster::<R>::gather(self.clusters.as_flattened(), rows);
        let most = f32::MAX / (2 * self.clusters.len()) as f32;
        cluster.importance(context.p.p, context.ns).min(R::splat(most))
    }

    /// The sum of all importances.
    #[inline(always)]
    fn total<R: Real>(&self, context: &LightSampleContext<R>) -> R {
        let mut total = R::zero();
        for row in 0..self.clusters.len() {
            total += self.importance(R::Int::splat(row as u32), context);
        }
        total
    }

    /// The probability of a light of this importance.
    #[inline(always)]
    fn share<R: Real>(&self, importance: R, total: R) -> R {
        let share = R::splat(1.0 - self.infinite.probability()) * (importance / total);
        R::select(total.gt(R::zero()), share, R::zero())
    }

    /// See [`LightSampler::sample_lanes`](super::LightSampler::sample_lanes).
    #[inline(always)]
    pub(super) fn sample_lanes<R: Real>(
        &self,
        context: &LightSampleContext<R>,
        u: R,
        active: R::Mask,
    ) -> (R::Int, R, R::Mask) {
        R::call(Choose { sampler: self, context, u, active })
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
        R::call(Probability { sampler: self, context, lights, active })
    }
}

/// The choice of lights for the lanes of `active`. It is called, as loops over lights would make
/// every caller long.
struct Choose<'a, R: Real> {
    sampler: &'a ExhaustiveLightSampler,
    context: &'a LightSampleContext<R>,
    u: R,
    active: R::Mask,
}

impl<R: Real> Callee<R> for Choose<'_, R> {
    type Output = (R::Int, R, R::Mask);

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Self { sampler, context, u, active } = self;
        let infinite = &sampler.infinite;
        let is_infinite = u.lt(R::splat(infinite.probability())) & active;
        let (mut lights, mut pmf, mut valid) = (R::Int::splat(0), R::zero(), is_infinite);
        if is_infinite.any() {
            (lights, pmf) = (infinite.choose(u), R::splat(infinite.pmf()));
        }
        let is_bounded = active & !is_infinite;
        if !is_bounded.any() || sampler.ids.is_empty() {
            return (lights, pmf, valid);
        }
        let total = sampler.total(context);
        let threshold = infinite.rest(u) * total;
        let (mut sum, mut importance, mut row) = (R::zero(), R::zero(), R::Int::splat(0));
        let mut searches = is_bounded & total.gt(R::zero());
        valid = valid | searches;
        for candidate in 0..sampler.ids.len() {
            if !searches.any() {
                break;
            }
            let candidate = R::Int::splat(candidate as u32);
            let of_candidate = sampler.importance(candidate, context);
            sum += of_candidate;
            // If rounding puts the threshold at the total, the last one is chosen.
            let is_possible = searches & of_candidate.gt(R::zero());
            importance = R::select(is_possible, of_candidate, importance);
            row = R::Int::select(is_possible, candidate, row);
            searches = searches & !threshold.lt(sum);
        }
        lights = R::Int::select(is_bounded, R::Int::gather(&sampler.ids, row), lights);
        pmf = R::select(is_bounded, sampler.share(importance, total), pmf);
        (lights, pmf, valid)
    }
}

/// The probabilities of `lights` for the lanes of `active`.
struct Probability<'a, R: Real> {
    sampler: &'a ExhaustiveLightSampler,
    context: &'a LightSampleContext<R>,
    lights: R::Int,
    active: R::Mask,
}

impl<R: Real> Callee<R> for Probability<'_, R> {
    type Output = R;

    #[inline(always)]
    fn run(self) -> R {
        let Self { sampler, context, lights, active } = self;
        let (zero, first) = (R::zero(), R::Int::splat(0));
        if !active.any() {
            return zero;
        }
        let rows = R::Int::gather(&sampler.rows, R::Int::select(active, lights, first));
        let is_infinite = rows.eq(R::Int::splat(INFINITE));
        let pmf = R::select(is_infinite, R::splat(sampler.infinite.pmf()), zero);
        let is_bounded = active & rows.lt(R::Int::splat(INFINITE));
        if !is_bounded.any() {
            return pmf;
        }
        let importance = sampler.importance(R::Int::select(is_bounded, rows, first), context);
        R::select(is_bounded, sampler.share(importance, sampler.total(context)), pmf)
    }
}
