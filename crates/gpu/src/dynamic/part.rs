//! The items or the triangles of a world's top group, and the tree over them.

use std::sync::Arc;

use math::{Bounds3, Vec3};

use super::tree::{Place, Tree};
use super::{Plan, Start, THREADS, Update};
use crate::device::{Buffer, Device, GpuError, Kernel};
use crate::renderer::Kernels;

/// What has no points that may move.
pub const AT_REST: u32 = u32::MAX;

/// Items or triangles.
pub struct Part {
    /// What moves those with points.
    kernel: Arc<Kernel>,
    plan: Buffer,
    count: u32,
    /// The tree, unless there are fewer than two, and whether it was built.
    tree: Option<Tree>,
    is_built: bool,
    /// What is to be done before the next picture.
    update: Option<Update>,
    /// The points of each, as the kernel has them.
    points: Buffer,
    /// The boxes, and the ends of their middles along the axes.
    boxes: Buffer,
    ends: Buffer,
}

impl Part {
    /// With a kernel that moves them by points, and with boxes.
    pub fn new(
        kernels: &Kernels,
        kernel: Arc<Kernel>,
        place: Place,
        points: &[u32],
        boxes: &[Bounds3],
    ) -> Result<Self, GpuError> {
        let device = kernels.device();
        let Place { count, first_item, .. } = place;
        let corners = |bounds: &Bounds3| [bounds.min, bounds.max].map(|Vec3 { x, y, z }| [x, y, z, 0.0]);
        let boxes: Vec<_> = boxes.iter().map(corners).collect();
        Ok(Self {
            kernel,
            plan: device.parameters(&Plan { count, first_item, ..Plan::default() })?,
            count,
            tree: if count < 2 { None } else { Some(Tree::new(kernels, place)?) },
            is_built: false,
            update: None,
            points: device.buffer("points of primitives", points)?,
            boxes: device.buffer("boxes of primitives", &boxes)?,
            ends: device.zeros("ends of boxes", 24)?,
        })
    }

    /// Has the tree updated before the next picture: built, if it never was or is to be anyway.
    pub fn plan(&mut self, update: Update) {
        let is_refitted = self.is_built && self.update != Some(Update::Rebuild);
        self.update = Some(if is_refitted { update } else { Update::Rebuild });
    }

    /// What is to be done.
    pub fn update(&self) -> Option<Update> {
        self.update.filter(|_| self.count > 0)
    }

    /// After it is done.
    pub fn settle(&mut self) {
        self.is_built |= self.update.is_some();
        self.update = None;
    }

    pub fn boxes(&self) -> &Buffer {
        &self.boxes
    }

    /// Moves primitives to where their points are, and does with the tree what is to be done.
    pub fn run(
        &self,
        device: &Device,
        [primitives, points, nodes]: [&Buffer; 3],
        start: &mut Start,
    ) -> Result<(), GpuError> {
        let Some(update) = self.update() else { return Ok(()) };
        let Self { kernel, plan, boxes, ends, .. } = self;
        device.write(ends, &[0u32; 6])?;
        start(kernel, &[plan, primitives, points, &self.points, boxes, ends], self.count.div_ceil(THREADS));
        match &self.tree {
            Some(tree) => tree.run(device, update, [boxes, ends, nodes], start),
            None => Ok(()),
        }
    }
}
