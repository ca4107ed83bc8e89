//! Copies of prototypes at many points.

use std::collections::HashSet;

use math::{DMat4, DVec3};

use super::stage::Prim;
use super::xform::rotation;
use crate::log::Result;

/// The visible copies of an instancer at one of the two times: the number of the prototype, and the
/// transform.
pub(super) fn copies(prim: &Prim, prototypes: usize, time: usize) -> Result<Vec<(usize, DMat4)>> {
    const INDICES: &str = "protoIndices";
    let indices = prim.integers(INDICES)?.unwrap_or_default();
    let positions = prim.array_at::<3>("positions", time)?.unwrap_or_default();
    let scales = prim.array_at::<3>("scales", time)?.unwrap_or_default();
    let mut turns = prim.array_at::<4>("orientationsf", time)?.unwrap_or_default();
    if turns.is_empty() {
        turns = prim.array_at::<4>("orientations", time)?.unwrap_or_default();
    }
    if positions.len() != indices.len() {
        let message = format!("there must be {} positions, not {}", indices.len(), positions.len());
        return Err(prim.fault("positions", message));
    }
    for (name, count) in [("scales", scales.len()), ("orientations", turns.len())] {
        if count != 0 && count != indices.len() {
            return Err(prim.fault(name, format!("there must be {} values, not {count}", indices.len())));
        }
    }
    let ids = prim.integers("ids")?.filter(|ids| ids.len() == indices.len());
    let mut hidden: HashSet<i64> = prim.integers("invisibleIds")?.unwrap_or_default().into_iter().collect();
    hidden.extend(prim.inactive_ids());
    let mut copies = Vec::with_capacity(indices.len());
    for (number, &index) in indices.iter().enumerate() {
        let id = ids.as_ref().map_or(number as i64, |ids| ids[number]);
        let prototype = usize::try_from(index).ok().filter(|&index| index < prototypes);
        let prototype =
            prototype.ok_or_else(|| prim.fault(INDICES, format!("there is no prototype {index}")))?;
        if hidden.contains(&id) {
            continue;
        }
        let scale = scales.get(number).map_or(DVec3::ONE, |&scale| DVec3::from(scale));
        let turn = rotation(turns.get(number).copied().unwrap_or([1.0, 0.0, 0.0, 0.0]));
        let position = DVec3::from(positions[number]);
        copies.push((prototype, DMat4::from_scale_rotation_translation(scale, turn, position)));
    }
    Ok(copies)
}
