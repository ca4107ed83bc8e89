//! Curves of any basis are compiled to cubic Bézier segments. Hair scenes have a statement per
//! curve. Successive curves that differ only in points and widths become one geometry, so that
//! memory is needed for segments only.

use super::Compiler;
use description::{CurveBasis, CurveDesc, CurveProfile, ShapeDesc, ShapeKind, Stated};
use geometry::{CurveSegment, Curves, SplineBasis, bezier_segments};
use math::{Normal3, Transform, lerp};

/// Whether two shapes are curves that can share one geometry.
pub(super) fn are_strands(a: &ShapeDesc, b: &ShapeDesc) -> bool {
    let (ShapeKind::Curve(curve), ShapeKind::Curve(other)) = (&a.kind, &b.kind) else { return false };
    curve.profile == other.profile
        && curve.split_depth == other.split_depth
        && a.world_from_object == b.world_from_object
        && a.reverse_orientation == b.reverse_orientation
        && a.single_sided == b.single_sided
        && a.material == b.material
        && a.area_light == b.area_light
        && a.alpha == b.alpha
        && a.medium_interface == b.medium_interface
}

impl Compiler<'_> {
    /// Compiles one or more curves that are [strands](are_strands).
    pub(super) fn curves(&mut self, strands: &[&Stated<ShapeDesc>], transform: &Transform) -> Curves {
        let (mut segments, mut normals) = (Vec::new(), Vec::new());
        let (mut profile, mut split_depth) = (CurveProfile::Flat, 0);
        for shape in strands {
            let ShapeKind::Curve(curve) = &shape.kind else { continue };
            (profile, split_depth) = (curve.profile, curve.split_depth.max(0) as u32);
            self.strand(curve, shape, &mut segments, &mut normals);
        }
        let profile = match profile {
            CurveProfile::Flat => geometry::CurveProfile::Flat,
            CurveProfile::Cylinder => geometry::CurveProfile::Cylinder,
            CurveProfile::Ribbon => geometry::CurveProfile::Ribbon(normals),
        };
        let reverse_orientation = strands.first().is_some_and(|shape| shape.reverse_orientation);
        Curves::new(segments, profile, split_depth, transform, reverse_orientation)
    }

    /// Adds the segments of a curve, and for a ribbon the normals at their ends.
    fn strand(
        &mut self,
        curve: &CurveDesc,
        shape: &Stated<ShapeDesc>,
        segments: &mut Vec<CurveSegment>,
        normals: &mut Vec<[Normal3; 2]>,
    ) {
        if !(2..=3).contains(&curve.degree) {
            let message = format!("a curve of degree {}, not 2 or 3", curve.degree);
            return self.error("invalid-curve", message, shape.origin.parameter("degree"));
        }
        let basis = match curve.basis {
            CurveBasis::Bezier => SplineBasis::Bezier,
            CurveBasis::BSpline => SplineBasis::BSpline,
        };
        let cubics = bezier_segments(&curve.control_points, curve.degree as usize, basis);
        let count = cubics.len();
        if curve.profile == CurveProfile::Ribbon {
            if curve.normals.len() != count + 1 {
                let message = format!("a ribbon of {count} segments needs {} normals", count + 1);
                return self.error("invalid-curve", message, shape.origin.parameter("N"));
            }
            normals.extend(curve.normals.windows(2).map(|n| [n[0], n[1]]));
        }
        let width_at = |end: usize| lerp(end as f32 / count as f32, curve.width[0], curve.width[1]);
        let segment = |(i, points)| CurveSegment { points, width: [width_at(i), width_at(i + 1)] };
        segments.extend(cubics.into_iter().enumerate().map(segment));
    }
}
