//! Transforms of prims. A matrix of a file has its translation in the last row, and transforms rows
//! from the left; here it is transposed.

use math::{DMat4, DQuat, DVec3};

use super::stage::Prim;
use crate::log::Result;

/// The transform of a prim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Local {
    pub parent_from_prim: DMat4,
    /// Whether it is from the world, whatever the transforms of the prims above.
    pub is_reset: bool,
}

/// The transform of a prim at one of the two times.
pub(super) fn local(prim: &Prim, time: usize) -> Result<Local> {
    const ORDER: &str = "xformOpOrder";
    const RESET: &str = "!resetXformStack!";
    const INVERT: &str = "!invert!";
    let operations = prim.words(ORDER)?.unwrap_or_default();
    // What is before a reset does not count.
    let first = operations.iter().rposition(|operation| operation == RESET);
    let mut matrix = DMat4::IDENTITY;
    for operation in &operations[first.map_or(0, |index| index + 1)..] {
        let (name, is_inverse) = match operation.strip_prefix(INVERT) {
            Some(name) => (name, true),
            None => (operation.as_str(), false),
        };
        let step = one(prim, name, time)?;
        let step = if is_inverse { step.inverse() } else { step };
        if !step.is_finite() {
            return Err(prim.fault(ORDER, format!("`{operation}` has no inverse")));
        }
        matrix *= step;
    }
    Ok(Local { parent_from_prim: matrix, is_reset: first.is_some() })
}

/// The transform of an operation, of which the name says the kind: `xformOp:rotateX:door`.
fn one(prim: &Prim, name: &str, time: usize) -> Result<DMat4> {
    let kind = name.strip_prefix("xformOp:").and_then(|rest| rest.split(':').next());
    let unknown = || prim.fault("xformOpOrder", format!("`{name}` is not an operation"));
    let kind = kind.ok_or_else(unknown)?;
    let missing = || prim.fault(name, "this has no value");
    let one = || prim.numbers_at::<1>(name, time)?.map(|[v]| v).ok_or_else(missing);
    let three = || prim.numbers_at::<3>(name, time)?.map(DVec3::from).ok_or_else(missing);
    Ok(match kind {
        "translate" => DMat4::from_translation(three()?),
        "translateX" => DMat4::from_translation(DVec3::X * one()?),
        "translateY" => DMat4::from_translation(DVec3::Y * one()?),
        "translateZ" => DMat4::from_translation(DVec3::Z * one()?),
        "scale" => DMat4::from_scale(three()?),
        "scaleX" => DMat4::from_scale(DVec3::new(one()?, 1.0, 1.0)),
        "scaleY" => DMat4::from_scale(DVec3::new(1.0, one()?, 1.0)),
        "scaleZ" => DMat4::from_scale(DVec3::new(1.0, 1.0, one()?)),
        "rotateX" => DMat4::from_rotation_x(one()?.to_radians()),
        "rotateY" => DMat4::from_rotation_y(one()?.to_radians()),
        "rotateZ" => DMat4::from_rotation_z(one()?.to_radians()),
        "rotateXYZ" | "rotateXZY" | "rotateYXZ" | "rotateYZX" | "rotateZXY" | "rotateZYX" => {
            let angles = three()?;
            // The first axis of the name turns first.
            kind.trim_start_matches("rotate").bytes().fold(DMat4::IDENTITY, |matrix, axis| {
                let angle = |index: usize| angles[index].to_radians();
                let turn = match axis {
                    b'X' => DMat4::from_rotation_x(angle(0)),
                    b'Y' => DMat4::from_rotation_y(angle(1)),
                    _ => DMat4::from_rotation_z(angle(2)),
                };
                turn * matrix
            })
        }
        "orient" => {
            let value = prim.numbers_at::<4>(name, time)?.ok_or_else(missing)?;
            DMat4::from_quat(rotation(value))
        }
        "transform" => {
            let value = prim.numbers_at::<16>(name, time)?.ok_or_else(missing)?;
            DMat4::from_cols_array(&value)
        }
        _ => return Err(unknown()),
    })
}

/// A rotation of a quaternion whose real part is first.
pub(super) fn rotation([w, x, y, z]: [f64; 4]) -> DQuat {
    let quaternion = DQuat::from_xyzw(x, y, z, w);
    if quaternion.length_squared() > 1e-12 { quaternion.normalize() } else { DQuat::IDENTITY }
}
