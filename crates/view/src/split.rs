//! A camera path and a picture of a split view, without a window.

use std::f64::consts::TAU;
use std::time::{Duration, Instant};

use alhazen::image::{Image, PixelSource};
use alhazen::integrators::Control;
use serde_json::{Value, json};

use crate::rasterized::Rasterized;
use crate::{Flight, Renderer, Report, Shot, StepError};

/// The frame times of both sides.
#[derive(Clone, Debug)]
pub struct SplitReport {
    /// The ray traced side.
    pub traced: Report,
    /// The time of each frame of the rasterised side.
    pub rasterized: Vec<Duration>,
    /// How long it took to draw the first picture, with the sprites for it; a caller adds what it
    /// took to bring the scene to the GPU.
    pub prepared_in: Duration,
    /// The GPU.
    pub device: String,
    /// Triangles and sprites of the last frame.
    pub triangles: u64,
    /// Sprites of it.
    pub sprites: u64,
}

impl SplitReport {
    /// Renders a camera path as [`Report::of_orbit`] does, and draws the same one.
    pub fn of_orbit(
        renderer: &mut Renderer,
        rasterized: &mut Rasterized,
        flight: &mut Flight,
        frames: u32,
        begin: Instant,
        control: &Control,
    ) -> Result<Self, StepError> {
        let shot = renderer.shot().clone();
        let start = Instant::now();
        rasterized.draw(&Shot { camera: flight.camera().clone(), ..shot.clone() })?;
        let prepared_in = start.elapsed();
        let mut around = flight.clone();
        let (traced, _) = Report::of_orbit(renderer, flight, frames, begin, control)?;
        let device = rasterized.device().name().to_owned();
        let mut report =
            Self { traced, rasterized: Vec::new(), prepared_in, device, triangles: 0, sprites: 0 };
        for _ in 0..frames {
            around.orbit(TAU / f64::from(frames), 0.0);
            let picture = rasterized.draw(&Shot { camera: around.camera().clone(), ..shot.clone() })?;
            report.rasterized.push(picture.frame.time);
            (report.triangles, report.sprites) = (picture.triangles, picture.sprites);
        }
        Ok(report)
    }

    /// The time that this share of the rasterised frames does not exceed.
    pub fn quantile(&self, share: f64) -> Duration {
        crate::headless::quantile(&self.rasterized, share)
    }

    /// The report as JSON; times are in milliseconds.
    pub fn to_json(&self) -> Value {
        let ms = |time: Duration| time.as_secs_f64() * 1e3;
        let mut json = self.traced.to_json();
        json["rasterized"] = json!({
            "device": self.device,
            "frame_ms": {
                "median": ms(self.quantile(0.5)),
                "p95": ms(self.quantile(0.95)),
                "max": ms(self.quantile(1.0)),
            },
            "prepare_ms": ms(self.prepared_in),
            "triangles": self.triangles,
            "sprites": self.sprites,
        });
        json
    }
}

/// The whole picture of what the scene's author shows up to this share of its width, and the
/// rasterised one from there on.
pub fn picture(
    renderer: &mut Renderer,
    rasterized: &mut Rasterized,
    share: f32,
    control: &Control,
) -> Result<Image, StepError> {
    let shot = Shot { camera: renderer.world().shot().camera, ..renderer.shot().clone() };
    let mut image = rasterized.draw(&shot)?.image;
    let edge = (share.clamp(0.0, 1.0) * image.width() as f32).round() as u32;
    if edge == 0 {
        return Ok(image);
    }
    renderer.aim(shot);
    renderer.restart();
    while !renderer.is_at_rest() {
        renderer.step(control)?;
    }
    let Some(job) = renderer.job() else { return Ok(image) };
    let development = job.session.state().development();
    let channels = development.channels();
    let place = |name: &str| channels.iter().position(|channel| channel.name == name);
    let color = ["R", "G", "B"].map(place);
    let mut values = vec![0.0; image.width() as usize * channels.len()];
    for y in 0..image.height() {
        development.row(y, &mut values);
        for (pixel, x) in values.chunks_exact(channels.len()).zip(0..edge) {
            for (c, channel) in color.iter().enumerate() {
                image.set_channel(x, y, c, channel.map_or(0.0, |channel| pixel[channel]));
            }
        }
    }
    Ok(image)
}
