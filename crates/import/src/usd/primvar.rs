//! Values on surfaces: texture coordinates, normals and colours, which are given for corners,
//! vertices, faces or all.

use super::stage::Prim;
use crate::log::Result;

/// What the values are of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Interpolation {
    /// The one value is of all.
    Constant,
    /// Of faces, or of curves.
    Uniform,
    /// Of points, between which they are linear.
    Varying,
    /// Of points, of which they follow the surface.
    Vertex,
    /// Of the corners of faces.
    FaceVarying,
}

/// The values of a property.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Primvar<const N: usize> {
    pub interpolation: Interpolation,
    /// One for each element, whose indices are resolved.
    pub values: Vec<[f64; N]>,
}

/// How many elements of each kind a shape has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Counts {
    pub faces: usize,
    pub points: usize,
    pub varying: usize,
    pub corners: usize,
}

impl<const N: usize> Primvar<N> {
    /// The values of `primvars:NAME` of a prim, or, if they are constant, of a prim above it.
    pub fn of(prim: &Prim, name: &str, counts: Counts) -> Result<Option<Self>> {
        let property = format!("primvars:{name}");
        if let Some(values) = Self::read(prim, &property, Interpolation::Constant, counts)? {
            return Ok(Some(values));
        }
        let mut above = prim.parent();
        while let Some(prim) = above {
            if let Some(values) = Self::read(&prim, &property, Interpolation::Constant, counts)
                .ok()
                .flatten()
                .filter(|values| values.interpolation == Interpolation::Constant)
            {
                return Ok(Some(values));
            }
            above = prim.parent();
        }
        Ok(None)
    }

    /// The values of an attribute, whose interpolation may not be said.
    pub fn read(
        prim: &Prim,
        property: &str,
        otherwise: Interpolation,
        counts: Counts,
    ) -> Result<Option<Self>> {
        let Some(values) = prim.array::<N>(property)? else { return Ok(None) };
        if values.is_empty() {
            return Ok(None);
        }
        let interpolation = match prim.described(property, "interpolation")?.as_deref() {
            None => otherwise,
            Some("constant") => Interpolation::Constant,
            Some("uniform") => Interpolation::Uniform,
            Some("varying") => Interpolation::Varying,
            Some("vertex") => Interpolation::Vertex,
            Some("faceVarying") => Interpolation::FaceVarying,
            Some(other) => return Err(prim.fault(property, format!("`{other}` is not an interpolation"))),
        };
        let values = match prim.integers(&format!("{property}:indices"))? {
            None => values,
            Some(indices) => {
                let value = |&index: &i64| usize::try_from(index).ok().and_then(|index| values.get(index));
                let found: Option<Vec<_>> = indices.iter().map(|index| value(index).copied()).collect();
                let message = format!("there is an index that none of the {} values has", values.len());
                found.ok_or_else(|| prim.fault(&format!("{property}:indices"), message))?
            }
        };
        let wanted = match interpolation {
            Interpolation::Constant => 1,
            Interpolation::Uniform => counts.faces,
            Interpolation::Varying => counts.varying,
            Interpolation::Vertex => counts.points,
            Interpolation::FaceVarying => counts.corners,
        };
        if values.is_empty() || (values.len() != wanted && interpolation != Interpolation::Constant) {
            let message = format!("there must be {wanted} values, not {}", values.len());
            return Err(prim.fault(property, message));
        }
        if let Some(index) = values.iter().position(|value| value.iter().any(|v| !v.is_finite())) {
            return Err(prim.fault(property, format!("the value {index} is not finite")));
        }
        Ok(Some(Self { interpolation, values }))
    }

    /// The value at a corner of a face.
    pub fn at(&self, corner: usize, point: usize, face: usize) -> [f64; N] {
        self.values[match self.interpolation {
            Interpolation::Constant => 0,
            Interpolation::Uniform => face,
            Interpolation::Varying | Interpolation::Vertex => point,
            Interpolation::FaceVarying => corner,
        }]
    }
}
