//! Curves of any basis become cubic Bézier segments.

use super::Compiler;
use description::{CurveBasis, CurveDesc, CurveProfile, ShapeDesc, Stated};
use geometry::{CurveSegment, Curves, Geometry, SplineBasis, bezier_segments};
use math::{Transform, lerp};

impl Compiler<'_> {
    pub(super) fn curve(
        &mut self,
        curve: &CurveDesc,
        shape: &Stated<ShapeDesc>,
        transform: &Transform,
    ) -> Option<Geometry> {
        let span = shape.origin.span;
        if shape.area_light.is_some() {
            self.warn("light-ignored", "curves do not emit; drawn without light", span);
        }
        if !(2..=3).contains(&curve.degree) {
            self.error("invalid-curve", format!("a curve of degree {}, not 2 or 3", curve.degree), span);
            return None;
        }
        let basis = match curve.basis {
            CurveBasis::Bezier => SplineBasis::Bezier,
            CurveBasis::BSpline => SplineBasis::BSpline,
        };
        let cubics = bezier_segments(&curve.control_points, curve.degree as usize, basis);
        let count = cubics.len();
        let profile = match curve.profile {
            CurveProfile::Flat => geometry::CurveProfile::Flat,
            CurveProfile::Cylinder => geometry::CurveProfile::Cylinder,
            CurveProfile::Ribbon if curve.normals.len() == count + 1 => {
                geometry::CurveProfile::Ribbon(curve.normals.windows(2).map(|n| [n[0], n[1]]).collect())
            }
            CurveProfile::Ribbon => {
                let message = format!("a ribbon of {count} segments needs {} normals", count + 1);
                self.error("invalid-curve", message, shape.origin.parameter("N"));
                return None;
            }
        };
        let width_at = |end: usize| lerp(end as f32 / count as f32, curve.width[0], curve.width[1]);
        let segments = cubics.into_iter().enumerate();
        let segments =
            segments.map(|(i, points)| CurveSegment { points, width: [width_at(i), width_at(i + 1)] });
        let split_depth = curve.split_depth.max(0) as u32;
        Some(
            Curves::new(segments.collect(), profile, split_depth, transform, shape.reverse_orientation)
                .into(),
        )
    }
}
