//! Sets of spheres.

use super::Compiler;
use description::{ShapeDesc, SpheresDesc, Stated};
use geometry::{Geometry, Shape, Sphere, SphereSet, SphereSetError};
use math::Transform;

impl Compiler<'_> {
    /// A sphere set; under a transform that is not a similarity, one ellipsoid per sphere.
    pub(super) fn spheres(
        &mut self,
        spheres: &SpheresDesc,
        shape: &Stated<ShapeDesc>,
        transform: &Transform,
    ) -> Option<Geometry> {
        let SpheresDesc { centers, radii } = spheres;
        let reverse = shape.reverse_orientation;
        match SphereSet::new(centers.clone(), radii.clone(), transform, reverse) {
            Ok(set) => Some(set.into()),
            Err(SphereSetError::NotSimilar) => {
                let ellipsoids = centers.iter().zip(radii.iter().cycle()).map(|(&center, &radius)| {
                    let placed = transform.after(&Transform::translate(center));
                    Shape::from(Sphere::whole(&placed, reverse, radius))
                });
                Some(Geometry::Shapes(ellipsoids.collect()))
            }
            Err(error) => {
                let parameter = if matches!(error, SphereSetError::Center { .. }) { "P" } else { "radius" };
                self.error("invalid-spheres", error.to_string(), shape.origin.parameter(parameter));
                None
            }
        }
    }
}
