//! Whole pictures by `path`: passes of the GPU beside those of the CPU.

use std::sync::Arc;
use std::time::Instant;

use alhazen::Job;
use alhazen::assets::MemoryAssets;
use alhazen::description::Schedule;
use alhazen::device::Kernels;
use alhazen::integrators::{Control, Limits};
use serde_json::{Map, Value, json};

use crate::Size;
use crate::scenes::{Compiled, compile, messages, triangles};

const CORNELL_BOX: &str = include_str!("../../../../scenes/cornell-box.pbrt");

/// Samples in a second, for a simple and for a large scene.
pub fn measure(kernels: &Arc<Kernels>, size: &Size) -> Result<Value, String> {
    let mut report = Map::new();
    let (text, assets) = triangles();
    for (name, text, assets) in
        [("cornell-box", CORNELL_BOX, MemoryAssets::default()), ("two million triangles", text, assets)]
    {
        let Compiled { scene, desc } = compile(text, assets, size)?;
        let passes = |on_device: Option<Schedule>, passes: u32| {
            // Samples that are not asked for are not made with the others.
            let mut desc = desc.clone();
            desc.sampler.value.kind.set_samples_per_pixel(passes);
            desc.options.schedule = on_device.unwrap_or_default();
            let job = Job::of_scene(scene.clone(), &desc).map_err(|errors| messages(&errors))?;
            let mut job = job.job;
            if on_device.is_some() {
                job.move_to(kernels).map_err(|errors| messages(&errors))?;
            }
            let mut run =
                |passes| job.session.run(passes, &Limits::default(), &Control::default(), &mut |_| ());
            // A pass that is not planned warms up.
            run(passes..1 + passes).map_err(|error| format!("{error:?}"))?;
            let begin = Instant::now();
            run(0..passes).map_err(|error| format!("{error:?}"))?;
            Ok::<_, String>(f64::from(passes) / begin.elapsed().as_secs_f64())
        };
        let [gpu, wavefront] = [Schedule::Megakernel, Schedule::Wavefront]
            .map(|schedule| passes(Some(schedule), size.passes[0]));
        let (gpu, wavefront, cpu) = (gpu?, wavefront?, passes(None, size.passes[1])?);
        report.insert(
            name.into(),
            json!({
                "resolution": size.resolution,
                "passes_per_second": { "gpu": gpu, "gpu_by_stages": wavefront, "cpu": cpu },
                "speedup": gpu / cpu,
            }),
        );
    }
    Ok(report.into())
}
