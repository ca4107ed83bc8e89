//! The lights infinitely far away, of samplers that bound the contribution of all others: each is
//! chosen with the same probability as all of the others together.

use crate::light::{LightBounds, LightId, Lights};
use lanes::{Int, Real};
use math::ONE_MINUS_EPSILON;
use std::sync::atomic::{AtomicBool, Ordering};

/// Lights infinitely far away.
#[derive(Clone, Debug)]
pub(super) struct InfiniteLights {
    ids: Vec<u32>,
    /// Probability of choosing among them.
    probability: f32,
}

/// The lights infinitely far away, and those with bounds and power; `None` if `cancel` is set
/// meanwhile.
pub(super) fn separated(
    lights: Lights,
    cancel: &AtomicBool,
) -> Option<(InfiniteLights, Vec<(LightId, LightBounds)>)> {
    let (mut ids, mut bounded) = (Vec::new(), Vec::new());
    for light in lights.iter() {
        if cancel.load(Ordering::Relaxed) {
            return None;
        }
        match light.bounds() {
            None => ids.push(light.id().0),
            Some(bounds) if bounds.phi > 0.0 => bounded.push((light.id(), bounds)),
            Some(_) => {}
        }
    }
    let infinite = ids.len() as f32;
    let others = if bounded.is_empty() { 0.0 } else { 1.0 };
    let probability = if infinite == 0.0 { 0.0 } else { infinite / (infinite + others) };
    Some((InfiniteLights { ids, probability }, bounded))
}

impl InfiniteLights {
    /// Their ids.
    pub fn ids(&self) -> &[u32] {
        &self.ids
    }

    /// Probability of choosing among them, by numbers u below it.
    #[inline(always)]
    pub fn probability(&self) -> f32 {
        self.probability
    }

    /// Probability of choosing one of them.
    #[inline(always)]
    pub fn pmf(&self) -> f32 {
        self.probability / self.ids.len().max(1) as f32
    }

    /// The light that a number below [`probability`](Self::probability) chooses, if there is one.
    #[inline(always)]
    pub fn choose<R: Real>(&self, u: R) -> R::Int {
        let count = self.ids.len();
        let place = (u / R::splat(self.probability) * R::splat(count as f32)).to_int();
        let last = R::Int::splat(count as u32 - 1);
        R::Int::gather(&self.ids, R::Int::select(place.lt(last), place, last))
    }

    /// A number in [0, 1) for the choice among the others.
    #[inline(always)]
    pub fn rest<R: Real>(&self, u: R) -> R {
        let rest = (u - R::splat(self.probability)) / R::splat(1.0 - self.probability);
        rest.min(R::splat(ONE_MINUS_EPSILON))
    }
}
