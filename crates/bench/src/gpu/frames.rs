//! Frames in a second of two million triangles by `path`, while the camera moves.

use std::sync::Arc;
use std::time::Instant;

use alhazen::description::{SceneDesc, TransformDesc};
use alhazen::device::Kernels;
use alhazen::math::{DMat4, DVec3};
use alhazen::realtime::Realtime;
use serde_json::{Value, json};

use crate::scenes::{Compiled, compile, messages, triangles};
use crate::{Size, median};

/// Frames of one sample of each pixel.
pub fn measure(kernels: &Arc<Kernels>, size: &Size) -> Result<Value, String> {
    let (text, assets) = triangles();
    let Compiled { scene, desc } = compile(text, assets, size)?;
    let made = Instant::now();
    let mut realtime = Realtime::new(&scene, &desc, kernels, None).map_err(|errors| messages(&errors))?;
    let made = made.elapsed().as_secs_f64();
    let (mut frames, mut trace, mut filter, mut rays) = (Vec::new(), Vec::new(), Vec::new(), 0);
    for frame in 0..=size.frames {
        realtime.aim(&moved(&desc, frame), 1).map_err(|errors| messages(&errors))?;
        let begin = Instant::now();
        let picture = realtime.moving(1).map_err(|error| error.to_string())?;
        let seconds = begin.elapsed().as_secs_f64();
        // The first frame warms up.
        if frame > 0 {
            frames.push(seconds);
            trace.push(picture.stages.trace.as_secs_f64());
            filter.push(picture.stages.filter.as_secs_f64());
            rays += picture.rays;
        }
    }
    let seconds: f64 = frames.iter().sum();
    let frame = median(frames);
    Ok(json!({
        "triangles": scene.world().triangle_tree(alhazen::geometry::GroupId::TOP).1.len(),
        "resolution": size.resolution,
        "algorithm": "path, maxdepth 4, one sample per pixel",
        "frames": size.frames,
        "fps": 1.0 / frame,
        "frame_ms": 1e3 * frame,
        "trace_ms": 1e3 * median(trace),
        "filter_ms": 1e3 * median(filter),
        "million_rays_per_second": rays as f64 / seconds / 1e6,
        "to_device_ms": 1e3 * made,
    }))
}

/// A description whose camera has moved to the right, frame by frame.
fn moved(desc: &SceneDesc, frame: u32) -> SceneDesc {
    let by = DMat4::from_translation(DVec3::new(-0.005 * f64::from(frame), 0.0, 0.0));
    let mut desc = desc.clone();
    let home = desc.camera.value.camera_from_world.start;
    desc.camera.value.camera_from_world = TransformDesc::fixed(by * home);
    desc
}
