//! Systems of lenses: the numbers of interfaces and of exit pupils, the offset of the picture of
//! stops or 0 of disks, and a zero. Then for each interface, from film to scene, the place of its
//! vertex, the radius of curvature or 0 of a stop, the index of refraction on the film's side over
//! that beyond, and the radius of the aperture; and for each pupil its least and largest
//! coordinates, of which these are the smaller ones where nothing passes. A picture is its width,
//! its height and shares of light, row by row.

use math::{Bounds2, Vec2};
use scene::camera::{PlainLens, Projection};

use super::Flattener;

impl Flattener<'_> {
    /// The lenses of a camera; their offset, or 0 of other cameras.
    pub(super) fn lenses(&mut self, projection: &Projection) -> u32 {
        let Projection::Realistic(camera) = projection else { return 0 };
        self.parts.lenses = true;
        let PlainLens { interfaces, pupils, mask, .. } = camera.plain();
        let mask = mask.map_or(0, |image| {
            let at = self.slab.add([image.width(), image.height()]);
            self.slab.extend_numbers(image.values());
            at
        });
        let at = self.slab.add([interfaces.len() as u32, pupils.len() as u32, mask, 0]);
        self.slab.extend_numbers(interfaces.into_iter().flatten());
        let nothing = Bounds2 { min: Vec2::splat(1.0), max: Vec2::splat(0.0) };
        let corners = pupils.iter().map(|pupil| pupil.unwrap_or(nothing));
        self.slab.extend_numbers(corners.flat_map(|it| [it.min.x, it.min.y, it.max.x, it.max.y]));
        at
    }
}
