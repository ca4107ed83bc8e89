//! What is tested alone: an instance, or a shape, as five quadruples of words.
//!
//! | kind | quadruples |
//! |---|---|
//! | instance | the rows of the matrix that takes rays inside; the references of its triangles and of its items, the size of its group, its id |
//! | key of a motion | the translation with the time; the unit quaternion of the rotation; the rows of the stretch, the first with the angle between both quaternions |
//! | patch | its corner, its sides and its twist |
//! | curve | its control points, with the widths and the u of its ends |
//! | ball | its centre and its radius |
//! | others | the rows of the matrix that takes vectors to object space, each with a coordinate of its origin; its numbers |
//!
//! The last quadruple is the tag, the geometry and the primitive, and bits. That of an instance
//! has, after the tag, the index of its first key, the number of its motions, which is 0 at rest,
//! and the first light of its shapes. Two keys are a motion; an instance within others has several,
//! the outermost first. Keys follow all that rays hit in the group.

use std::f32::consts::TAU;

use geometry::{CurveKind, GeometryId, InstancePath, PlainItem, PlainShape, RevolvedKind, World};
use math::{AnimatedTransform, Bounds3, DMat3, DMat4, DQuat, DVec3, MotionKeys, Vec3};

use super::{BvhError, Group, Words};
use crate::tags::{ItemBit, ItemTag, bit};

/// Quadruples of an item.
pub const QUADRUPLES: usize = 5;

/// What is tested alone.
#[derive(Clone, Copy, Debug)]
pub enum Item {
    /// A primitive of a geometry.
    Shape(GeometryId, u32),
    /// A group seen through instances.
    Instance(InstancePath),
}

impl From<&PlainItem> for Item {
    fn from(item: &PlainItem) -> Self {
        match *item {
            PlainItem::Shape(geometry, primitive) => Self::Shape(geometry, primitive),
            PlainItem::Instance(id) => Self::Instance(InstancePath::TOP.into(id)),
        }
    }
}

impl Item {
    /// The box of a shape.
    pub fn bounds(&self, world: &World) -> Option<Bounds3> {
        match *self {
            Self::Shape(geometry, primitive) => world.geometry(geometry).bounds(primitive),
            Self::Instance(_) => None,
        }
    }
}

/// The group at the end of a path; `motions` are the index of its first key and the number of its
/// motions.
pub fn instance(
    world: &World,
    path: &InstancePath,
    groups: &[Group],
    motions: [u32; 2],
) -> [Words; QUADRUPLES] {
    let steps = path.ids().iter().map(|&id| world.render_from_instance(id).start().in_doubles());
    let [x, y, z] = rows(steps.product());
    let last = path.ids().last().map_or(u32::MAX, |id| id.0);
    let group = path.ids().last().map_or(0, |&id| world.group_of_instance(id).0);
    let group = &groups[group as usize];
    let inside = [group.roots[0], group.roots[1], group.size.to_bits(), last];
    [x, y, z, inside, [ItemTag::Instance as u32, motions[0], motions[1], 0]]
}

/// The rows of the matrix that takes rays inside, given the one that takes points outside.
pub fn rows(outward: DMat4) -> [Words; 3] {
    let inverse = outward.inverse();
    [0, 1, 2].map(|row| inverse.row(row).as_vec4().to_array().map(f32::to_bits))
}

/// The motions of a path, the outermost first; none where nothing moves. An instance at rest among
/// others that move is a stretch that stays.
pub fn motions(world: &World, path: &InstancePath) -> Vec<MotionKeys> {
    let steps = || path.ids().iter().map(|&id| world.render_from_instance(id));
    if !steps().any(AnimatedTransform::is_moving) {
        return Vec::new();
    }
    let at_rest = |step: &AnimatedTransform| {
        let matrix = step.start().in_doubles();
        MotionKeys {
            times: [0.0, 1.0],
            translations: [matrix.w_axis.truncate(); 2],
            rotations: [DQuat::IDENTITY; 2],
            stretches: [DMat3::from_mat4(matrix); 2],
        }
    };
    steps().map(|step| step.keys().unwrap_or_else(|| at_rest(step))).collect()
}

/// The angle between the quaternions of a motion, at most π/2.
pub(crate) fn angle(keys: &MotionKeys) -> f32 {
    keys.rotations[0].dot(keys.rotations[1]).clamp(-1.0, 1.0).acos() as f32
}

/// Both keys of a motion, an item each.
pub fn keys(keys: &MotionKeys) -> [[Words; QUADRUPLES]; 2] {
    let angle = angle(keys);
    [0, 1].map(|i| {
        let [translation, rotation] =
            [keys.translations[i].extend(keys.times[i].into()), keys.rotations[i].into()];
        let [x, y, z] = [0, 1, 2].map(|row| keys.stretches[i].row(row).extend(0.0));
        [translation, rotation, x.with_w(f64::from(angle)), y, z]
            .map(|v| v.as_vec4().to_array().map(f32::to_bits))
    })
}

/// The geometry and the primitive of the first of some items; `None` for an instance.
pub fn ids(items: &[Words]) -> Option<(GeometryId, u32)> {
    let [kind, geometry, primitive, _] = items[QUADRUPLES - 1];
    (kind != ItemTag::Instance as u32).then_some((GeometryId(geometry), primitive))
}

/// A shape of a geometry.
pub fn shape(
    world: &World,
    geometry: GeometryId,
    primitive: u32,
    is_marked: bool,
) -> Result<[Words; QUADRUPLES], BvhError> {
    let shape = world.geometry(geometry).plain(primitive);
    let ids = |tag: ItemTag, flips| {
        let bits = bit(flips, ItemBit::Flips) | bit(is_marked, ItemBit::Marked);
        [tag as u32, geometry.0, primitive, bits]
    };
    match shape.ok_or(BvhError::Shape(geometry))? {
        PlainShape::Patch { corner, sides: [right, up], twist, flips } => {
            let words = |v: Vec3| [v.x.to_bits(), v.y.to_bits(), v.z.to_bits(), 0];
            Ok([words(corner), words(right), words(up), words(twist), ids(ItemTag::Patch, flips)])
        }
        PlainShape::Revolved { kind, render_from_object, flips, numbers } => {
            let kind = match kind {
                RevolvedKind::Sphere => ItemTag::Sphere,
                RevolvedKind::Cylinder => ItemTag::Cylinder,
                RevolvedKind::Disk => ItemTag::Disk,
                RevolvedKind::Plane => ItemTag::Plane,
            };
            let (inverse, origin) =
                (render_from_object.inverse(), render_from_object.transform_point3(DVec3::ZERO));
            let row = |i: usize| {
                let vector = inverse.row(i).truncate();
                [vector.x, vector.y, vector.z, origin[i]].map(|x| (x as f32).to_bits())
            };
            let [x, y, z] = [0, 1, 2].map(row);
            let [radius, low, high, angle] = numbers;
            let is_whole = [low, high] == [-radius, radius] && angle >= TAU;
            if kind == ItemTag::Sphere && is_whole && DMat3::from_mat4(render_from_object) == DMat3::IDENTITY
            {
                let ball = [x[3], y[3], z[3], radius.to_bits()];
                return Ok([ball, [0; 4], [0; 4], [0; 4], ids(ItemTag::Ball, flips)]);
            }
            Ok([x, y, z, numbers.map(f32::to_bits), ids(kind, flips)])
        }
        PlainShape::Curve { kind, points: [a, b, c, d], widths, range, normals: _, flips } => {
            let kind = match kind {
                CurveKind::Flat => ItemTag::FlatCurve,
                CurveKind::Cylinder => ItemTag::Tube,
                CurveKind::Ribbon => ItemTag::Ribbon,
            };
            let row = |p: Vec3, number: f32| [p.x, p.y, p.z, number].map(f32::to_bits);
            let [[first, last], [begin, end]] = [widths, range];
            Ok([row(a, first), row(b, last), row(c, begin), row(d, end), ids(kind, flips)])
        }
    }
}
