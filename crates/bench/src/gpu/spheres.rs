//! Frames in a second of a planet of moving spheres, whose tree the GPU builds for each.

use std::sync::Arc;

use alhazen::Overrides;
use alhazen::device::Kernels;
use alhazen::integrators::Control;
use serde_json::{Value, json};
use view::StepError;
use view::planet::{Outing, PlanetReport};

use crate::Size;
use crate::scenes::messages;

/// The frames that are simulated before others show them again.
const SIMULATED: u32 = 8;

/// A walk over the planet by the GPU, also without the simulation, and by the CPU.
pub fn measure(kernels: &Arc<Kernels>, size: &Size) -> Result<Value, String> {
    let [width, height] = size.resolution;
    let settings = [("film.xresolution", width), ("film.yresolution", height)];
    let overrides = Overrides {
        settings: settings.map(|(name, value)| (name.into(), value.to_string())).into(),
        ..Overrides::default()
    };
    let measured = |kernels: Option<&Arc<Kernels>>, simulated: Option<u32>, frames: u32| {
        let mut outing = Outing::new(size.spheres, &overrides, 1)?;
        if let Some(kernels) = kernels {
            outing.move_to(kernels).map_err(|errors| messages(&errors))?;
        }
        let control = Control::default();
        let report = match simulated {
            Some(simulated) => PlanetReport::of_moments(&mut outing, simulated, frames, &control),
            None => PlanetReport::of_walk(&mut outing, frames, &control),
        };
        let report = report.map_err(|error| match error {
            StepError::Problem(problem) => problem,
            StepError::Cancelled => "cancelled".into(),
        })?;
        Ok::<_, String>(report.to_json())
    };
    // Many frames, because the clock of a GPU rises for some of them.
    let moments = measured(Some(kernels), Some(SIMULATED), 4 * size.frames)?;
    let walk = measured(Some(kernels), None, size.frames / 3)?;
    let cpu = measured(None, None, size.frames.min(5))?;
    Ok(json!({ "gpu": walk, "gpu_without_simulation": moments, "cpu": cpu }))
}
