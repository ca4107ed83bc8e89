//! A comparison as JSON. Undefined values (the noise of a given reference, the slope of two points)
//! are null.

use serde_json::{Map, Value, json};

use super::{Budget, Checkpoint, Comparison, Measure, Run, settings};

impl Comparison {
    /// All numbers: the setup, the reference, and for each run its figures at the end and at every
    /// checkpoint.
    pub fn to_json(&self) -> Value {
        let setup = &self.setup;
        json!({
            "status": if self.interrupted() { "interrupted" } else { "done" },
            "program": concat!("alhazen ", env!("CARGO_PKG_VERSION")),
            "scene": setup.title,
            "resolution": setup.resolution,
            "pixel_bounds": setup.pixel_bounds,
            "budget": match setup.budget {
                Budget::Time(time) => json!({ "seconds": time.as_secs_f64() }),
                Budget::Samples(samples) => json!({ "samples_per_pixel": samples }),
            },
            "seed": setup.seed,
            "threads": setup.threads,
            "filter": settings::json(&setup.filter),
            "settings": setup.changes,
            "reference": {
                "source": self.reference.source,
                "mean": self.reference.mean(),
                "variance": self.reference.noise.map(|noise| noise.absolute),
                "relative_variance": self.reference.noise.map(|noise| noise.relative),
                "mean_deviation": self.reference.noise.map(|noise| noise.of_mean.sqrt()),
                "doubt": self.doubt(),
            },
            "common_relmse": self.common_error(),
            "integrators": self.runs.iter().map(|run| self.run_to_json(run)).collect::<Vec<_>>(),
            "missing": self.missing,
            "warnings": self.warnings,
        })
    }

    fn run_to_json(&self, run: &Run) -> Value {
        let mut value = checkpoint(run.last());
        let more = json!({
            "name": run.name,
            "settings": settings::json(&run.settings),
            "sampler": settings::json(&run.sampler),
            "notes": run.notes.iter().map(|(name, note)| ((*name).to_owned(), json!(note))).collect::<Map<_, _>>(),
            "status": if run.interrupted { "interrupted" } else { "done" },
            "flip": run.flip,
            "efficiency": run.efficiency(),
            "rays_per_second": run.rays_per_second(),
            "slope": self.slope(run),
            "seconds_to_common_relmse": self.seconds_to_common_error(run),
            "checkpoints": run.checkpoints.iter().map(checkpoint).collect::<Vec<_>>(),
        });
        if let (Value::Object(value), Value::Object(more)) = (&mut value, more) {
            value.extend(more);
        }
        value
    }
}

fn checkpoint(point: &Checkpoint) -> Value {
    let Measure { absolute, relative, mean_error, mean_error_deviation } = point.measure;
    json!({
        "passes": point.passes,
        "seconds": point.seconds,
        "rays": point.rays,
        "mse": absolute.error,
        "variance": absolute.variance,
        "bias_squared": absolute.bias_squared,
        "bias_squared_deviation": absolute.bias_squared_deviation,
        "relmse": relative.error,
        "relative_variance": relative.variance,
        "relative_bias_squared": relative.bias_squared,
        "relative_bias_squared_deviation": relative.bias_squared_deviation,
        "mean_error": mean_error,
        "mean_error_deviation": mean_error_deviation,
    })
}
