//! Frames in a second of a planet of moving spheres, whose tree the GPU builds for each.

use std::sync::Arc;
use std::time::Duration;

use alhazen::Overrides;
use alhazen::device::Kernels;
use alhazen::integrators::Control;
use serde_json::{Value, json};
use view::StepError;
use view::planet::{Outing, PlanetReport, Spent};

use crate::Size;
use crate::scenes::messages;

/// A walk over the planet by the GPU, and then by the CPU.
pub fn measure(kernels: &Arc<Kernels>, size: &Size) -> Result<Value, String> {
    let [width, height] = size.resolution;
    let settings = [("film.xresolution", width), ("film.yresolution", height)];
    let overrides = Overrides {
        settings: settings.map(|(name, value)| (name.into(), value.to_string())).into(),
        ..Overrides::default()
    };
    let walk = |kernels: Option<&Arc<Kernels>>, frames: u32| {
        let mut outing = Outing::new(size.spheres, &overrides, 1)?;
        if let Some(kernels) = kernels {
            outing.move_to(kernels).map_err(|errors| messages(&errors))?;
        }
        let report = PlanetReport::of_walk(&mut outing, frames, &Control::default());
        let report = report.map_err(|error| match error {
            StepError::Problem(problem) => problem,
            StepError::Cancelled => "cancelled".into(),
        })?;
        let ms = |part: fn(&Spent) -> Duration| 1e3 * report.quantile(0.5, part).as_secs_f64();
        let shown = ms(|spent| spent.moving + spent.rendering);
        let mut json = report.to_json();
        // What the GPU does, whoever computes where the spheres are.
        json["without_simulation"] = json!({ "ms": shown, "fps": 1e3 / shown });
        Ok::<_, String>(json)
    };
    Ok(json!({ "gpu": walk(Some(kernels), size.frames)?, "cpu": walk(None, size.frames.min(5))? }))
}
