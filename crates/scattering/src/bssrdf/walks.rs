//! What random walks in a half space return of the light that has entered it from a uniform sky.
//!
//! Let a walk that nothing absorbs leave after n events of scattering with the probability p_n. A
//! medium with the albedo α of single scattering then returns
//!
//! ```text
//! R(α) = Σ p_n αⁿ
//! ```
//!
//! so that one set of walks serves all albedos. As p_n falls by n^(−3/2) only, long walks are
//! thinned out: each time that n doubles half of them end, and the others count twice.

use crate::{HenyeyGreenstein, fr_dielectric};
use math::{Vec2, Vec3, Vector3, safe_sqrt, sqr};
use sampling::Rng;
use sampling::warp::sample_exponential;
use std::collections::BTreeMap;

/// Walks; the shares have standard errors of about 0.002, which all albedos have in common.
const WALKS: usize = 1 << 16;
/// Events before walks are thinned out.
const ALL: u32 = 256;

/// The shares R that leave again, for the asymmetry `g`, the relative index `eta` of the medium,
/// and each of some albedos of single scattering.
pub(super) fn effective_albedos(g: f32, eta: f32, albedos: &[f32]) -> Vec<f32> {
    let phase = HenyeyGreenstein { g };
    let mut rng = Rng::from_sequence(0);
    let mut leaving: BTreeMap<u32, f64> = BTreeMap::new();
    let mut entered = 0.0;
    for i in 0..WALKS {
        // Under a uniform sky the squares of cosines are uniform.
        let cosine = ((i as f32 + rng.uniform_f32()) / WALKS as f32).sqrt();
        let sine = safe_sqrt(1.0 - sqr(cosine)) / eta;
        let entering = 1.0 - fr_dielectric(cosine, eta);
        entered += f64::from(entering);
        let inwards = Vec3::new(sine, 0.0, safe_sqrt(1.0 - sqr(sine)));
        if let Some((events, weight)) = walk(&phase, eta, inwards, &mut rng) {
            *leaving.entry(events).or_default() += f64::from(entering * weight);
        }
    }
    let share = |&albedo: &f32| {
        // What nothing absorbs leaves; walks that count for many say so only on average.
        if albedo >= 1.0 {
            return 1.0;
        }
        let left = |(&n, &share): (&u32, &f64)| share * f64::from(albedo).powi(n as i32);
        (leaving.iter().map(left).sum::<f64>() / entered).min(1.0) as f32
    };
    albedos.iter().map(share).collect()
}

/// The events after which a walk leaves that begins at the boundary in a direction, of which z
/// points inside, and for how many walks it counts; `None` if it was thinned out.
fn walk(phase: &HenyeyGreenstein, eta: f32, mut w: Vector3, rng: &mut Rng) -> Option<(u32, f32)> {
    let (mut depth, mut events, mut weight) = (0.0, 0, 1.0);
    let mut limit = ALL;
    loop {
        depth += w.z * sample_exponential(rng.uniform_f32(), 1.0);
        if depth <= 0.0 {
            if rng.uniform_f32() >= fr_dielectric(-w.z.abs(), eta) {
                return Some((events, weight));
            }
            depth = 0.0;
            w.z = w.z.abs();
            continue;
        }
        events += 1;
        if events == limit {
            if rng.uniform_f32() < 0.5 {
                return None;
            }
            limit = limit.saturating_mul(2);
            weight *= 2.0;
        }
        w = phase.sample_p(-w, Vec2::new(rng.uniform_f32(), rng.uniform_f32())).0;
    }
}
