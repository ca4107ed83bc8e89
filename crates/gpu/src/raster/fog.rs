//! The medium around the camera as fog: what it takes from light on its way, and what it scatters
//! towards the camera of a sky that nothing hides.

use geometry::{Geometry, GeometryId, PlainShape, RevolvedKind};
use math::Vec3;
use scene::{Scene, View};

use super::colors::Colors;
use super::sky::Sky;

/// A homogeneous fog.
#[derive(Clone, Copy, Debug, Default)]
pub struct Fog {
    /// Extinction by red, green and blue per unit of length; zero where there is none.
    pub extinction: Vec3,
    /// The harmonics of what it adds to a ray that does not end.
    pub glow: [Vec3; 9],
    /// The ball that it fills, if its surface is one.
    pub ball: Option<(Vec3, f32)>,
}

impl Fog {
    /// That around the camera; `None` if it is not the same everywhere.
    pub fn new(scene: &Scene, view: &View, sky: &Sky, colors: &Colors) -> Option<Self> {
        let Some(id) = view.medium else { return Some(Self::default()) };
        let medium = &scene.media()[id.0 as usize];
        let lambda = &mut spectrum::SampledWavelengths::sample_visible(0.5);
        medium.homogeneous(lambda)?;
        let of = |lambda: &_| medium.homogeneous(lambda).unwrap_or_default();
        let extinction = colors.factor(|lambda| of(lambda).sigma_t());
        let albedo = colors.factor(|lambda| of(lambda).sigma_s.safe_div(of(lambda).sigma_t()));
        let ball = (0..scene.geometries().len() as u32).map(GeometryId).find_map(|geometry| {
            let media = scene.geometries()[geometry.0 as usize].media?;
            if media.inside != view.medium || !scene.is_all_interface(geometry) {
                return None;
            }
            let shape = match scene.world().geometry(geometry) {
                Geometry::Shapes(shapes) => shapes.first()?.plain()?,
                _ => return None,
            };
            let PlainShape::Revolved { kind: RevolvedKind::Sphere, render_from_object, numbers, .. } = shape
            else {
                return None;
            };
            let scale = render_from_object.x_axis.truncate().length() as f32;
            Some((render_from_object.w_axis.truncate().as_vec3().into(), numbers[0] * scale))
        });
        Some(Self { extinction, glow: sky.scattered(medium.phase.g).map(|light| light * albedo), ball })
    }
}
