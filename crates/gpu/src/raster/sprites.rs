//! Sprites (impostors): pictures of groups from many directions, each made when it is first needed,
//! which are drawn instead of instances that are far away.
//!
//! The directions are the middles of the cells of a square that is mapped to the sphere with equal
//! areas, so that they are spread evenly. What is seen from a direction in between is the sprite of
//! the nearest one, turned as the instance is.

use std::collections::HashMap;

use math::{DMat4, Frame, Vec2, Vec3, equal_area_sphere_to_square, equal_area_square_to_sphere};

use super::models::Model;
use super::placements::Placement;

/// Texels of a side of a sprite.
pub const SIDE: u32 = 256;

/// The sprites that are kept at most.
pub const LAYERS: u32 = 256;

/// Directions along a side of the square.
const DIRECTIONS: u32 = 8;

/// A sprite: a group, and the cell of its direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Sprite {
    /// The group.
    pub group: u32,
    cell: [u32; 2],
}

impl Sprite {
    /// The one that shows a placement best to who is at `eye`.
    pub fn of(placement: &Placement, model: &Model, eye: Vec3) -> Self {
        let local = placement.group_from_render.transform_point3(eye.as_dvec3());
        let way = Vec3::from(local.as_vec3()) - model.center;
        let uv = equal_area_sphere_to_square(way.try_normalize().unwrap_or(Vec3::Z));
        let cell = [uv.x, uv.y].map(|x| ((x * DIRECTIONS as f32) as u32).min(DIRECTIONS - 1));
        Self { group: placement.group, cell }
    }

    /// The frame of the picture: to the right, up, and towards the viewer.
    pub fn frame(&self) -> Frame {
        let [u, v] = self.cell.map(|i| (i as f32 + 0.5) / DIRECTIONS as f32);
        Frame::from_z(equal_area_square_to_sphere(Vec2::new(u, v)))
    }

    /// From the space of the group to the clip space of the picture, whose depth is 1 at the
    /// nearest point of the ball around the group and 0 at the farthest.
    pub fn clip_from_group(&self, model: &Model) -> DMat4 {
        let (frame, center) = (self.frame(), model.center.as_dvec3());
        let r = f64::from(model.radius);
        let axis = |v: Vec3, factor: f64, add: f64| {
            let v = v.as_dvec3() * factor;
            v.extend(add - v.dot(center))
        };
        let rows = [axis(frame.x, 1.0 / r, 0.0), axis(frame.y, 1.0 / r, 0.0), axis(frame.z, 0.5 / r, 0.5)];
        DMat4::from_cols(rows[0], rows[1], rows[2], math::DVec4::W).transpose()
    }

    /// What the vertices of an instance of it need: the axes of its frame times its radius, and its
    /// middle with the layer.
    pub fn instance(&self, placement: &Placement, model: &Model, layer: u32) -> [[f32; 4]; 4] {
        let Frame { x, y, z } = self.frame();
        let axis = |v: Vec3| placement.vector(v * model.radius).extend(0.0).to_array();
        let center = placement.point(model.center).extend(layer as f32).to_array();
        [axis(x), axis(y), axis(z), center]
    }
}

/// Which sprites there are, and in which layers.
#[derive(Default)]
pub struct Album {
    layers: HashMap<Sprite, u32>,
    /// Those that are to be made.
    missing: Vec<(Sprite, u32)>,
}

impl Album {
    /// A sprite with its layer, which is to be made if there is none; where no layer is left, the
    /// one of that group from the nearest direction.
    pub fn layer(&mut self, sprite: Sprite) -> Option<(Sprite, u32)> {
        if let Some(layer) = self.layers.get(&sprite) {
            return Some((sprite, *layer));
        }
        let layer = self.layers.len() as u32;
        if layer >= LAYERS {
            let of_group = self.layers.iter().filter(|(known, _)| known.group == sprite.group);
            let nearness = |known: &Sprite| known.frame().z.dot(sprite.frame().z);
            let nearest = of_group.max_by(|a, b| nearness(a.0).total_cmp(&nearness(b.0)).then(b.1.cmp(a.1)));
            return nearest.map(|(sprite, layer)| (*sprite, *layer));
        }
        self.layers.insert(sprite, layer);
        self.missing.push((sprite, layer));
        Some((sprite, layer))
    }

    /// Those that are to be made, which is then taken as done.
    pub fn take_missing(&mut self) -> Vec<(Sprite, u32)> {
        std::mem::take(&mut self.missing)
    }
}
