//! A planet by a GPU: its spheres move there, where their tree is built for each picture.

use std::sync::Arc;
use std::time::{Duration, Instant};

use alhazen::description::Diagnostic;
use alhazen::device::Kernels;
use alhazen::geometry::GeometryId;
use alhazen::math::Point3;
use alhazen::realtime::{Realtime, Update};

use crate::on_device::frame;
use crate::step::StepError;
use crate::world::messages;
use crate::{Frame, Shot, World};

/// The scene on a device. Its pictures are those of the CPU, with the same random numbers.
pub struct OnDevice {
    realtime: Realtime,
}

impl OnDevice {
    /// The error says what the device does not draw or move.
    pub fn new(world: &World, shot: &Shot, kernels: &Arc<Kernels>) -> Result<Self, Vec<Diagnostic>> {
        let mut desc = world.settings(shot).map_err(|error| vec![refusal(error)])?;
        desc.sampler.kind.set_samples_per_pixel(shot.samples);
        Ok(Self { realtime: Realtime::animated(world.scene(), &desc, kernels)? })
    }

    /// The name of the device.
    pub fn name(&self) -> &str {
        self.realtime.device()
    }

    /// A picture of spheres that have moved, and the time that moving them took.
    pub fn frame(
        &mut self,
        world: &World,
        shot: &Shot,
        moved: &[(GeometryId, Arc<[Point3]>)],
    ) -> Result<(Frame, Duration), StepError> {
        let begin = Instant::now();
        let moved = moved.iter().map(|(id, centers)| (*id, &**centers));
        let done = self.realtime.move_points(moved, Update::Rebuild);
        done.map_err(|error| StepError::Problem(error.to_string()))?;
        let moving = begin.elapsed();
        let desc = world.settings(shot)?;
        let aim = self.realtime.aim(&desc, 1).map_err(|errors| StepError::Problem(messages(&errors)))?;
        let Some(picture) = self.realtime.resting(shot.samples, true)? else {
            return Err(StepError::Problem("the GPU has no picture".into()));
        };
        let moving = moving + picture.stages.build;
        Ok((frame(&self.realtime, aim, 1, picture, begin.elapsed()), moving))
    }
}

fn refusal(message: String) -> Diagnostic {
    Diagnostic::warning("not-on-gpu", message, alhazen::description::Span::NONE)
}
