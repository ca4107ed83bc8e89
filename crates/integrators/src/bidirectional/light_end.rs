//! The light's end of a path: the densities with which the strategies sample it.
//!
//! Next-event estimation at a surface chooses the point on the light with the density `direct`;
//! emission from the light chooses the ray from there to the surface with the density `emission`.
//! The first is per solid angle at the surface, the second per area and solid angle at the light. A
//! light at a point is chosen with a delta per area, which is d² per solid angle; deltas cancel in
//! all ratios, and count as 1.

use math::{Normal3, Ray, Vector3};
use scene::light::{LightId, LightPoint, LightSampleContext};

use super::Bidirectional;
use super::partial::LightEnd;

impl Bidirectional<'_> {
    /// The end at a light in the unit direction `wi` from a surface, which next-event estimation
    /// chooses with the density `direct`.
    pub fn light_end(
        &self,
        light: LightId,
        context: &LightSampleContext,
        wi: Vector3,
        point: LightPoint,
        direct: f32,
    ) -> LightEnd {
        let source = self.scene.light(light);
        let (pdf_position, pdf_direction) = match point {
            Some((p, n)) => {
                let (position, direction) = source.pdf_le(p, n, -wi, context.time);
                (if n == Normal3::ZERO { 1.0 } else { position }, direction)
            }
            None => {
                let ray = Ray::new(context.p.p, wi, context.time);
                let (position, direction) = source.pdf_le_infinite(&ray);
                (position, if source.is_delta() { 1.0 } else { direction })
            }
        };
        let emission = self.lights.emitting.pmf(light) * pdf_position * pdf_direction;
        let cos_theta = point.map_or(1.0, |(_, n)| if n == Normal3::ZERO { 1.0 } else { n.dot(wi).abs() });
        LightEnd { direct, emission, cos_theta, is_delta: source.is_delta() }
    }

    /// The density with which a surface chooses the light and the point or direction on it.
    pub fn direct_pdf(
        &self,
        light: LightId,
        context: &LightSampleContext,
        wi: Vector3,
        point: LightPoint,
    ) -> f32 {
        let source = self.scene.light(light);
        let pdf = match point {
            Some((p, Normal3::ZERO)) => context.p.p.distance_squared(p),
            None if source.is_delta() => 1.0,
            _ => source.pdf_li(context, wi, point, false),
        };
        self.lights.seen_from.pmf(context, light) * pdf
    }
}
