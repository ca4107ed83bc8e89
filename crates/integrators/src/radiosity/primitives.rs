//! The choice of the primitives that have patches.
//!
//! Memory grows with the number of patches, and time with its square. In a scene of a million small
//! triangles therefore only the most important ones have patches: lights, and large primitives. The
//! others receive light, but do not reflect it to other surfaces.

use std::cmp::Reverse;

use geometry::{Hit, SurfacePoint};
use math::Vec2;
use rayon::prelude::*;
use scene::Scene;

use super::domain::Domain;
use crate::{Cancelled, Control};

/// A primitive that can be subdivided.
struct Candidate {
    hit: Hit,
    shines: bool,
    area: f32,
    /// Its index among all candidates.
    order: usize,
}

/// Number of primitives between two checks for cancellation.
const BLOCK: u32 = 1 << 14;

/// The primitives that can be subdivided and are not interfaces, as hits without positions, and the
/// number of those left out because there are more than `most`: lights come first, then large
/// primitives.
pub(crate) fn choose(
    scene: &Scene,
    time: f32,
    most: usize,
    control: &Control,
) -> Result<(Vec<Hit>, usize), Cancelled> {
    let world = scene.world();
    let candidate = |hit: Hit, order: usize| {
        let at = |uv: Vec2| world.surface_at(hit.geometry, hit.primitive, hit.instance, uv, time);
        let domain = Domain::of(world, &hit);
        let center = at(domain.center()).filter(is_sound)?;
        let position = |uv: Vec2| at(uv).map_or(center.p.p, |surface| surface.p.p);
        let area = domain.quarters().iter().map(|quarter| quarter.area(position)).sum::<f32>();
        if !area.is_finite() {
            return None;
        }
        let shines = scene.interaction(&hit, center).area_light.is_some();
        Some(Candidate { hit, shines, area, order })
    };
    let mut chosen: Vec<Candidate> = Vec::new();
    let (mut seen, mut left_out) = (0, 0);
    for (geometry, instance) in world.placed_geometries() {
        let count = match scene.is_all_interface(geometry) {
            true => 0,
            false => world.geometry(geometry).len() as u32,
        };
        for first in (0..count).step_by(BLOCK as usize) {
            control.check()?;
            let block = first..count.min(first.saturating_add(BLOCK));
            let hit = |primitive| Hit { t: 0.0, uv: Vec2::ZERO, geometry, primitive, instance };
            let found = block.into_par_iter().filter_map(|i| candidate(hit(i), seen + i as usize));
            chosen.par_extend(found);
            if chosen.len() > 2 * most {
                left_out += keep_largest(&mut chosen, most);
            }
        }
        seen += count as usize;
    }
    left_out += keep_largest(&mut chosen, most);
    chosen.sort_unstable_by_key(|candidate| candidate.order);
    Ok((chosen.into_iter().map(|candidate| candidate.hit).collect(), left_out))
}

/// Keeps the first `most`, and returns the number of dropped ones.
fn keep_largest(candidates: &mut Vec<Candidate>, most: usize) -> usize {
    let dropped = candidates.len().saturating_sub(most);
    if dropped > 0 {
        // Areas are not negative, so that the order of their bits is that of their values.
        let rank = |c: &Candidate| (Reverse((c.shines, c.area.to_bits())), c.order);
        candidates.select_nth_unstable_by_key(most, rank);
        candidates.truncate(most);
    }
    dropped
}

/// Whether a surface point has a finite position and a normal.
pub(crate) fn is_sound(surface: &SurfacePoint) -> bool {
    surface.p.p.is_finite() && surface.n.is_normalized()
}
