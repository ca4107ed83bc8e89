//! The instances of a world's top group, whose transforms may change.

use std::sync::Arc;

use geometry::InstanceId;
use math::{Bounds3, Transform};
use scene::MoveError;

use super::points::MOST;
use super::{Placement, Plan, Start, THREADS};
use crate::bvh::{Placed, Words};
use crate::device::{Buffer, Device, GpuError, Kernel};
use crate::renderer::Kernels;
use crate::shaders;

/// Instances on the device.
pub struct Instances {
    kernel: Arc<Kernel>,
    plan: Buffer,
    first_item: u32,
    /// Their items, ordered by instances, and where each is.
    placed: Vec<Placed>,
    placements: Vec<Placement>,
    buffer: Buffer,
}

impl Instances {
    /// Those of a world that are where its boxes of items are, from the first item on.
    pub fn new(
        kernels: &Kernels,
        placed: Vec<Placed>,
        transform: impl Fn(InstanceId) -> Transform,
        first_item: u32,
        boxes: &[Bounds3],
    ) -> Result<Self, GpuError> {
        let device = kernels.device();
        let placement = |placed: &Placed| {
            let item = placed.item - first_item;
            Placement::new(item, placed.rows(&transform(placed.instance)), &boxes[item as usize])
        };
        let placements: Vec<Placement> = placed.iter().map(placement).collect();
        let plan = Plan { count: placed.len() as u32, first_item, ..Plan::default() };
        Ok(Self {
            kernel: kernels.get("place_instances", shaders::place_instances())?,
            plan: device.parameters(&plan)?,
            first_item,
            buffer: device.buffer("placements of instances", &placements)?,
            placed,
            placements,
        })
    }

    /// Gives instances other transforms. The largest coordinate of their boxes. On an error,
    /// nothing is changed.
    pub fn place(&mut self, moved: &[(InstanceId, Transform)]) -> Result<f32, MoveError> {
        let (mut changed, mut size) = (Vec::new(), 0.0f32);
        for &(id, transform) in moved {
            let first = self.placed.partition_point(|placed| placed.instance < id);
            let items = self.placed[first..].iter().take_while(|placed| placed.instance == id);
            let before = changed.len();
            for (index, placed) in (first..).zip(items) {
                if placed.is_moving {
                    return Err(MoveError::Instance(id));
                }
                let (rows, bounds) = (placed.rows(&transform), placed.bounds(&transform.into()));
                let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
                let is_finite = rows.as_flattened().iter().all(|&word| f32::from_bits(word).is_finite());
                // What is no number is not less than anything.
                let fits = reach <= MOST && bounds.min.is_finite() && bounds.max.is_finite();
                if !(is_finite && fits) {
                    return Err(MoveError::Transform(id));
                }
                size = size.max(reach);
                changed.push((index, Placement::new(placed.item - self.first_item, rows, &bounds)));
            }
            if changed.len() == before {
                return Err(MoveError::Instance(id));
            }
        }
        changed.into_iter().for_each(|(index, placement)| self.placements[index] = placement);
        Ok(size)
    }

    /// Tells the device where they are.
    pub fn load(&self, device: &Device) -> Result<(), GpuError> {
        device.write(&self.buffer, &self.placements)
    }

    /// Moves their items and boxes.
    pub fn run(&self, [items, boxes]: [&Buffer; 2], start: &mut Start) {
        let groups = (self.placed.len() as u32).div_ceil(THREADS);
        start(&self.kernel, &[&self.plan, items, &self.buffer, boxes], groups);
    }
}

impl Placement {
    fn new(item: u32, rows: [Words; 3], bounds: &Bounds3) -> Self {
        Self { rows, low: bounds.min.to_array(), item, high: bounds.max.to_array(), unused: 0 }
    }
}
