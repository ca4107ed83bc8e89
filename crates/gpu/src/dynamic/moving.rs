//! The spheres of a world that move, on the device.

use std::fmt;
use std::sync::Arc;

use geometry::{Geometry, GeometryId, World};
use math::{Point3, Vec3};
use rayon::prelude::*;
use scene::MoveError;

use super::tree::{MOST_ITEMS, Place, Tree, most_nodes};
use super::{Plan, Start, THREADS, Update};
use crate::bvh::Bvh;
use crate::device::{Buffer, Device, GpuError, Kernel};
use crate::renderer::Kernels;
use crate::shaders;

/// The spheres of a geometry whose items stay where they are.
const AT_REST: u32 = u32::MAX;

/// Why spheres do not move on the device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MovingError {
    /// What is beside them, as a plural or with an article.
    Refused(&'static str),
    /// They are not those of a world.
    Move(MoveError),
    /// The device failed.
    Gpu(GpuError),
}

impl fmt::Display for MovingError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Refused(what) => write!(f, "the engine for GPUs does not move spheres beside {what}"),
            Self::Move(error) => error.fmt(f),
            Self::Gpu(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for MovingError {}

impl From<GpuError> for MovingError {
    fn from(error: GpuError) -> Self {
        Self::Gpu(error)
    }
}

/// The sets of spheres of a world's top group, whose spheres move, and the tree over all its items.
pub struct Moving {
    kernel: Arc<Kernel>,
    plan: Buffer,
    count: u32,
    /// The tree, unless there are fewer than two items.
    tree: Option<Tree>,
    /// By geometries, those that are sets of spheres.
    sets: Vec<Option<Set>>,
    /// The centres of all spheres, and the first sphere of each geometry.
    centers: Buffer,
    spheres: Buffer,
    /// The boxes of items, and the ends of their middles along the axes.
    boxes: Buffer,
    ends: Buffer,
}

/// A set of spheres.
struct Set {
    /// Its first sphere of those of all sets.
    first: usize,
    len: usize,
    largest_radius: f32,
}

impl Moving {
    /// For a world and its buffers, which get room for the tree: they are taken to the device after
    /// this, and before [`run`](Self::run) builds it.
    ///
    /// # Errors
    /// The top group has instances, or too many items; or the device fails.
    pub fn new(kernels: &Kernels, world: &World, bvh: &mut Bvh) -> Result<Self, MovingError> {
        let device = kernels.device();
        let items = bvh.bounded.clone();
        if items.len() > MOST_ITEMS as usize {
            return Err(MovingError::Refused("as many others"));
        }
        let (mut boxes, mut sets, mut centers) = (Vec::new(), Vec::new(), Vec::new());
        for item in items.clone() {
            let shape = bvh
                .shape(item)
                .and_then(|(id, primitive)| Some((id, world.geometry(id).shape(primitive)?.bounds()?)));
            let Some((id, bounds)) = shape else { return Err(MovingError::Refused("instances")) };
            boxes.push([bounds.min, bounds.max].map(|Vec3 { x, y, z }| [x, y, z, 0.0]));
            let index = id.0 as usize;
            sets.resize_with(sets.len().max(index + 1), || None);
            if let (Geometry::Spheres(set), None) = (world.geometry(id), &sets[index]) {
                let first = centers.len();
                centers.extend((0..set.len()).map(|sphere| set.center(sphere).to_array()));
                let largest_radius = (0..set.len()).map(|sphere| set.radius(sphere)).fold(0.0, f32::max);
                sets[index] = Some(Set { first, len: set.len(), largest_radius });
            }
        }
        let first = |set: &Option<Set>| set.as_ref().map_or(AT_REST, |set| set.first as u32);
        let spheres: Vec<u32> = sets.iter().map(first).collect();
        let (count, first_item) = (items.len() as u32, items.start as u32);
        let tree = if count < 2 {
            None
        } else {
            let first_node = bvh.make_room(most_nodes(count));
            Some(Tree::new(kernels, Place { count, first_item, first_node })?)
        };
        Ok(Self {
            kernel: kernels.get("place", shaders::place())?,
            plan: device.parameters(&Plan { count, first_item, ..Plan::default() })?,
            count,
            tree,
            sets,
            centers: device.buffer("centres of spheres", &centers)?,
            spheres: device.buffer("sets of spheres", &spheres)?,
            boxes: device.buffer("boxes of items", &boxes)?,
            ends: device.zeros("ends of boxes", 24)?,
        })
    }

    /// Tells the device where the spheres of some sets are, each given by its geometry and all its
    /// centres in render space. The largest coordinate of their boxes, up to rounding.
    ///
    /// # Errors
    /// A geometry is no set of spheres of the top group, or the centres do not fit; or the device
    /// fails. Sets before it have moved.
    pub fn place<'a>(
        &self,
        device: &Device,
        moved: impl IntoIterator<Item = (GeometryId, &'a [Point3])>,
    ) -> Result<f32, MovingError> {
        let mut size = 0.0f32;
        for (id, centers) in moved {
            let Some(Some(set)) = self.sets.get(id.0 as usize) else {
                return Err(MovingError::Move(MoveError::NoSpheres(id)));
            };
            let largest = |center: &Point3| center.abs().max_element();
            let is_finite = centers.par_iter().all(|center| center.is_finite());
            let reach = centers.par_iter().map(largest).reduce(|| 0.0, f32::max) + set.largest_radius;
            // So that no size of a box is infinite.
            if centers.len() != set.len || !is_finite || reach > f32::MAX / 4.0 {
                return Err(MovingError::Move(MoveError::Centers(id)));
            }
            let numbers: Vec<[f32; 3]> = centers.par_iter().map(|center| center.to_array()).collect();
            device.write_at(&self.centers, 12 * set.first as u64, &numbers)?;
            size = size.max(reach);
        }
        Ok(size)
    }

    /// Moves the items of spheres to where these are, and builds or refits the tree; one that was
    /// not built cannot be refitted.
    ///
    /// # Errors
    /// Those of the device.
    pub fn run(
        &self,
        device: &Device,
        update: Update,
        [items, nodes]: [&Buffer; 2],
        start: &mut Start,
    ) -> Result<(), GpuError> {
        if self.count == 0 {
            return Ok(());
        }
        let Self { plan, centers, spheres, boxes, ends, .. } = self;
        device.write(ends, &[0u32; 6])?;
        let groups = self.count.div_ceil(THREADS);
        start(&self.kernel, &[plan, items, centers, spheres, boxes, ends], groups);
        match &self.tree {
            Some(tree) => tree.run(device, update, [boxes, ends, nodes], start),
            None => Ok(()),
        }
    }
}
