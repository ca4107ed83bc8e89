//! What random walks in a half space return of the light that has entered it from a uniform sky.
//!
//! Let a walk that nothing absorbs leave after n events of scattering with the probability p_n. A
//! medium with the albedo α of single scattering then returns
//!
//! ```text
//! R(α) = Σ p_n αⁿ
//! ```
//!
//! so that one set of walks serves all albedos; walks from strata of directions serve boundaries of
//! all roughnesses, which let light into each by another share. From inside the boundary reflects
//! as a smooth one, as in the walks of paths. As p_n falls by n^(−3/2) only, long walks are
//! thinned out: each time that n doubles half of them end, and the others count twice.

use super::boundary::{Boundary, STRATA};
use crate::{HenyeyGreenstein, fr_dielectric};
use math::{Vec2, Vec3, Vector3, lerp, safe_sqrt, sqr};
use sampling::Rng;
use sampling::warp::sample_exponential;
use std::collections::BTreeMap;

/// Roughnesses √α of boundaries, evenly from 0 to 1.
const ROUGHNESSES: usize = 9;
/// Walks from each stratum within the critical angle and beyond it; the shares have standard errors
/// of about 0.002, which all albedos have in common.
const WALKS: usize = 4096;
const WALKS_BEYOND: usize = 1024;
/// Events before walks are thinned out.
const ALL: u32 = 256;

/// The shares R that leave again, for the asymmetry `g`, a boundary of each roughness, and each of
/// some albedos of single scattering.
pub(super) fn effective_albedos(g: f32, boundary: &Boundary, albedos: &[f32]) -> Vec<Vec<f32>> {
    let mut rng = Rng::from_sequence(0);
    let by_stratum: Vec<_> =
        (0..2 * STRATA).map(|stratum| from_stratum(g, boundary, stratum, albedos, &mut rng)).collect();
    let row = |i: usize| {
        let entering = boundary.entering(i as f32 / (ROUGHNESSES - 1) as f32);
        let share = |k: usize| entering.iter().zip(&by_stratum).map(|(share, left)| share * left[k]).sum();
        (0..albedos.len()).map(|k| f64::min(share(k), 1.0) as f32).collect()
    };
    (0..ROUGHNESSES).map(row).collect()
}

/// The same for light that enters in the directions of a stratum.
fn from_stratum(g: f32, boundary: &Boundary, stratum: usize, albedos: &[f32], rng: &mut Rng) -> Vec<f64> {
    let (phase, eta, critical) = (HenyeyGreenstein { g }, boundary.eta(), boundary.critical());
    if stratum < STRATA && critical == 0.0 {
        return vec![0.0; albedos.len()];
    }
    let (walks, range) = match stratum < STRATA {
        true => (WALKS_BEYOND, [0.0, critical]),
        false => (WALKS, [critical, 1.0]),
    };
    let mut leaving: BTreeMap<u32, f64> = BTreeMap::new();
    let mut entered = 0.0;
    for i in 0..walks {
        let part = (i as f32 + rng.uniform_f32()) / walks as f32;
        let part = ((stratum % STRATA) as f32 + part) / STRATA as f32;
        let cosine = lerp(part, range[0], range[1]).sqrt().max(1e-4);
        // As through a smooth boundary; beyond the critical angle evenly.
        let entering = if stratum < STRATA { 1.0 } else { 1.0 - fr_dielectric(-cosine, eta) };
        entered += f64::from(entering);
        let inwards = Vec3::new(safe_sqrt(1.0 - sqr(cosine)), 0.0, cosine);
        if let Some((events, weight)) = walk(&phase, eta, inwards, rng) {
            *leaving.entry(events).or_default() += f64::from(entering * weight);
        }
    }
    let share = |&albedo: &f32| {
        // What nothing absorbs leaves; walks that count for many say so only on average.
        if albedo >= 1.0 {
            return 1.0;
        }
        let left = |(&n, &share): (&u32, &f64)| share * f64::from(albedo).powi(n as i32);
        leaving.iter().map(left).sum::<f64>() / entered
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
