//! Direct light of a thousand lights: samples that pixels and frames share, beside those of `path`,
//! at equal error.
//!
//! The error of independent samples falls with their number, so that `path` needs as many times the
//! time of one sample as its error is that of shared ones.

use std::sync::Arc;

use alhazen::assets::MemoryAssets;
use alhazen::device::Kernels;
use alhazen::realtime::{Realtime, Weights};
use serde_json::{Value, json};

use crate::scenes::{Compiled, compile, lights, messages};
use crate::{Size, median};

/// Samples of a pixel in a frame of the reference.
const SAMPLES: u32 = 8;

/// Light before it is filtered, and the time of tracing a frame on the device.
struct Frame {
    light: Vec<[f32; 3]>,
    seconds: f64,
}

/// Errors and times of frames by both.
pub fn measure(kernels: &Arc<Kernels>, size: &Size) -> Result<Value, String> {
    let size = &Size { resolution: size.resolution.map(|side| side / 2), ..*size };
    let Compiled { scene, desc } = compile(&lights(), MemoryAssets::default(), size)?;
    let engine = |shared| {
        let realtime = Realtime::new(&scene, &desc, kernels, shared);
        let mut realtime = realtime.map_err(|errors| messages(&errors))?;
        realtime.aim(&desc, 1).map_err(|errors| messages(&errors))?;
        Ok::<_, String>(realtime)
    };
    let frame = |realtime: &mut Realtime, samples: u32| {
        let picture = realtime.moving(samples).map_err(|error| error.to_string())?;
        let light = realtime.unfiltered().map_err(|error| error.to_string())?;
        Ok::<_, String>(Frame { light, seconds: picture.stages.trace.as_secs_f64() })
    };
    let mut path = engine(None)?;
    let mut sum: Vec<[f64; 3]> = Vec::new();
    for _ in 0..size.reference {
        let Frame { light, .. } = frame(&mut path, SAMPLES)?;
        sum.resize(light.len(), [0.0; 3]);
        for (sum, light) in sum.iter_mut().zip(light) {
            *sum = [0, 1, 2].map(|i| sum[i] + f64::from(light[i]) / f64::from(size.reference));
        }
    }
    let measured = |realtime: &mut Realtime| {
        let (mut errors, mut seconds) = (Vec::new(), Vec::new());
        for index in 0..(size.frames / 2).max(12) {
            let Frame { light, seconds: time } = frame(realtime, 1)?;
            // Frames before share their samples.
            if index >= 8 {
                errors.push(relative_error(&light, &sum));
                seconds.push(time);
            }
        }
        Ok::<_, String>((median(errors), median(seconds)))
    };
    let (error_of_path, seconds_of_path) = measured(&mut path)?;
    let mut report = json!({
        "lights": scene.lights().len(),
        "resolution": size.resolution,
        "samples_of_reference": size.reference * SAMPLES,
        "path": { "relmse": error_of_path, "trace_ms": 1e3 * seconds_of_path },
    });
    for (name, weights) in [("unbiased", Weights::Unbiased), ("biased", Weights::Biased)] {
        let (error, seconds) = measured(&mut engine(Some(weights))?)?;
        let equal = seconds_of_path * error_of_path / error;
        report[name] = json!({
            "relmse": error,
            "trace_ms": 1e3 * seconds,
            "path_ms_at_equal_error": 1e3 * equal,
            "speedup_at_equal_error": equal / seconds,
        });
    }
    Ok(report)
}

/// The mean of squared errors relative to the reference.
fn relative_error(light: &[[f32; 3]], reference: &[[f64; 3]]) -> f64 {
    let pairs = light.as_flattened().iter().zip(reference.as_flattened());
    let errors = pairs.map(|(a, b)| (f64::from(*a) - b).powi(2) / (b * b + 1e-4));
    errors.sum::<f64>() / reference.as_flattened().len().max(1) as f64
}
