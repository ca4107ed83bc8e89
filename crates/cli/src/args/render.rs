//! The options of `alhazen render` and `alhazen resume`, and those that other commands share with
//! them.

use std::path::PathBuf;
use std::time::Duration;

use alhazen::description::IntegratorDesc;
use alhazen::film::Layer;
use alhazen::image::{DisplaySettings, DisplayView, DisplayWhite};
use alhazen::{Overrides, Shard};
use clap::Args;

use super::{EXIT_CODES, SCENE, render_long_help};
#[cfg(feature = "gpu")]
use crate::device::DeviceChoice;
use crate::values::{
    ServeAt, address, crop, film_file, key_value, noise, pixel, resolution, serve, shard, stops, time, token,
    view, white,
};

/// Options of `alhazen render`.
#[derive(Args, Debug)]
#[command(after_help = EXIT_CODES, after_long_help = render_long_help())]
pub struct Render {
    /// The scene.
    #[arg(help = SCENE)]
    pub scene: PathBuf,
    /// Output picture, in the format of its extension: .exr (linear, with all layers and metadata),
    /// .png, .jpg, .hdr, .tga, .pfm, .bmp, .qoi, .webp, .tif. Can be given several times. [default:
    /// the name in the scene's film, else the scene's with .exr, in the current folder]
    #[arg(short, long = "output", value_name = "FILE")]
    pub output: Vec<PathBuf>,
    /// Integrator (listed below). [default: the scene's]
    #[arg(long, value_name = "NAME")]
    pub integrator: Option<String>,
    /// Samples per pixel. [default: the scene's, or no limit where there is one of time or noise]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i32::MAX as i64))]
    pub spp: Option<u32>,
    /// Further limits of the render.
    #[command(flatten)]
    pub limits: RenderLimits,
    /// Film file to save while rendering, from which `alhazen resume` continues: the accumulated
    /// film, the passes that it holds, the scene's path and the options. It is replaced atomically,
    /// so that it is always valid.
    #[arg(long, value_name = "FILE.film", value_parser = film_file)]
    pub checkpoint: Option<PathBuf>,
    /// Interval between saves of --checkpoint, unless a pass takes longer.
    #[arg(long, value_name = "TIME", value_parser = time, default_value = "30s")]
    pub every: Duration,
    /// Render shard K of N, each with an equal part of the samples per pixel, into the film file of
    /// --checkpoint; `alhazen merge` makes the picture of all. A picture of the shard alone is
    /// written to --output only.
    #[arg(long, value_name = "K/N", value_parser = shard, requires = "checkpoint", conflicts_with = "noise")]
    pub shard: Option<Shard>,
    /// Device that renders: cpu; gpu, which leaves scenes that it does not support to the CPU and
    /// says why; ray-query, the same with the ray tracing hardware of a GPU, if nothing moves; or
    /// auto, the GPU unless it is a software one.
    #[cfg(feature = "gpu")]
    #[arg(long, value_name = "NAME", value_enum, default_value = "cpu", hide_possible_values = true)]
    pub device: DeviceChoice,
    /// Overrides of the scene.
    #[command(flatten)]
    pub changes: Changes,
    /// Display settings.
    #[command(flatten)]
    pub display: DisplayOptions,
    /// Live previews.
    #[command(flatten)]
    pub live: LiveOptions,
    /// Print errors only; with --json, the JSON object too.
    #[arg(long)]
    pub quiet: bool,
    /// Print one JSON object to standard output instead of text, errors included.
    #[arg(long)]
    pub json: bool,
}

impl Render {
    /// The changes to the scene by these options.
    pub fn overrides(&self) -> Overrides {
        Overrides {
            integrator: self.integrator.clone(),
            samples_per_pixel: self.spp,
            ..self.changes.overrides()
        }
    }
}

/// How pictures for displays show the light.
#[derive(Args, Clone, Debug)]
pub struct DisplayOptions {
    /// View transform of .png, .jpg, .tga, .bmp, .qoi and .webp: standard (sRGB), agx, aces (ACES
    /// 2.0), khronos-neutral or filmic. PNG files name it; other formats stay linear.
    #[arg(long, value_name = "NAME", default_value = "standard", value_parser = view)]
    pub view: DisplayView,
    /// Exposure of these formats in stops: 1 doubles the radiance.
    #[arg(long, value_name = "EV", default_value = "0", allow_negative_numbers = true, value_parser = stops)]
    pub exposure: f32,
    /// White point of these formats: a colour temperature in kelvin, or a CIE xy chromaticity.
    /// [default: as it is]
    #[arg(long, value_name = "K|X,Y", value_parser = white)]
    pub white_balance: Option<DisplayWhite>,
}

impl DisplayOptions {
    /// The settings by these options.
    pub fn settings(&self) -> DisplaySettings {
        DisplaySettings { view: self.view, exposure: self.exposure, white: self.white_balance }
    }
}

/// Who watches a render while it runs.
#[derive(Args, Clone, Debug)]
pub struct LiveOptions {
    /// Live preview with all layers in the image viewer tev. Without an address it is the tev of
    /// this machine, at 127.0.0.1:14158. A viewer that is not there, or does not read, costs a
    /// warning only.
    #[arg(
        long, value_name = "HOST:PORT", num_args = 0..=1, require_equals = true,
        default_missing_value = "127.0.0.1:14158", value_parser = address
    )]
    pub tev: Option<String>,
    /// Live preview in a browser, by a server at this address, by default 127.0.0.1:8642, which
    /// only this machine reaches. The page can also end the render and have its files written. The
    /// server ends with the render, or with `,stay` at Ctrl-C.
    #[arg(
        long, value_name = "ADDR:PORT[,stay]", num_args = 0..=1, require_equals = true,
        default_missing_value = "127.0.0.1:8642", value_parser = serve
    )]
    pub serve: Option<ServeAt>,
    /// Access token of the page of --serve, part of its address. [default: a random one if other
    /// machines reach the address, else none]
    #[arg(long, value_name = "TOKEN", value_parser = token, requires = "serve")]
    pub serve_token: Option<String>,
}

/// Limits of a render beside its number of samples per pixel; the first one reached ends it.
#[derive(Args, Clone, Copy, Debug)]
pub struct RenderLimits {
    /// Time limit: 30s, 1.5min, 2h; a number alone is seconds. Import and compilation do not count;
    /// the earlier time of a resumed render does. No pass (one sample of each pixel) begins that
    /// would probably end later.
    #[arg(long, value_name = "TIME", value_parser = time)]
    pub time: Option<Duration>,
    /// Noise limit: the estimated relative standard error of the picture at which the render ends;
    /// 0.02 is 2 %. It is the root of the mean, over pixels and channels, of variance / (value² +
    /// (mean / 10)²), measured by the difference of two half films, from 16 samples per pixel on.
    /// The second film doubles the memory.
    #[arg(long, value_name = "NOISE", value_parser = noise)]
    pub noise: Option<f64>,
}

/// Options that change a scene and its rendering, for `render` and `compare`.
#[derive(Args, Debug)]
pub struct Changes {
    /// Acceleration structure: bvh, or none, which tests every ray against every primitive for the
    /// same picture. [default: the scene's]
    #[arg(long, value_name = "NAME")]
    pub accelerator: Option<String>,
    /// Ray scheduling of ray-casting, whitted, ambient-occlusion, path and vol-path: wavefront,
    /// batches of rays in SIMD lanes, or scalar, one ray after another, for the same picture but
    /// for rounding. [default: wavefront]
    #[arg(long, value_name = "NAME", value_parser = ["wavefront", "scalar"])]
    pub engine: Option<String>,
    /// Override of a setting (listed below). Can be given several times.
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_value)]
    pub set: Vec<(String, String)>,
    /// Width and height of the full image in pixels. [default: the scene's]
    #[arg(long, value_name = "WxH", value_parser = resolution)]
    pub resolution: Option<[i32; 2]>,
    /// Crop window, in fractions of width and height from the upper left: 0,0.5,0,1 is the left
    /// half. [default: the scene's]
    #[arg(long, value_name = "X0,X1,Y0,Y1", value_parser = crop, conflicts_with = "pixel")]
    pub crop: Option<[f32; 4]>,
    /// Single pixel to render: column and row, from 0 at the upper left.
    #[arg(long, value_name = "X,Y", value_parser = pixel)]
    pub pixel: Option<[i32; 2]>,
    /// Layers beside the colours.
    #[arg(long, value_name = "LAYER,LAYER,…", value_delimiter = ',', help = layers_help())]
    pub aov: Vec<String>,
    /// Seed of all random numbers; the same seed gives the same picture, bit for bit. [default: the
    /// scene's]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(i32).range(0..))]
    pub seed: Option<i32>,
    /// Number of rendering threads; it never changes the picture. At most 256, or 4 for each core
    /// of a machine with more than 64. [default: one for each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
}

impl Changes {
    /// The changes to the scene by these options.
    pub fn overrides(&self) -> Overrides {
        let engine = self.engine.iter().map(|name| ("engine".to_owned(), name.clone()));
        Overrides {
            accelerator: self.accelerator.clone(),
            settings: self.set.iter().cloned().chain(engine).collect(),
            resolution: self.resolution,
            crop: self.crop,
            pixel: self.pixel,
            seed: self.seed,
            layers: self.aov.clone(),
            ..Overrides::default()
        }
    }
}

/// Options of `alhazen resume`.
#[derive(Args, Debug)]
#[command(after_help = EXIT_CODES)]
pub struct Resume {
    /// Film file of --checkpoint.
    pub film: PathBuf,
    /// Output picture, in the format of its extension. Can be given several times. [default: the
    /// film file's name with .exr, in the current folder]
    #[arg(short, long = "output", value_name = "FILE")]
    pub output: Vec<PathBuf>,
    /// Samples per pixel of the whole render, earlier ones included. [default: as begun]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i32::MAX as i64))]
    pub spp: Option<u32>,
    /// Further limits of the render. [default: as begun, unless there is --spp]
    #[command(flatten)]
    pub limits: RenderLimits,
    /// Interval between saves of the film file, unless a pass takes longer.
    #[arg(long, value_name = "TIME", value_parser = time, default_value = "30s")]
    pub every: Duration,
    /// Number of rendering threads; it never changes the picture. [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// Display settings.
    #[command(flatten)]
    pub display: DisplayOptions,
    /// Live previews.
    #[command(flatten)]
    pub live: LiveOptions,
    /// Print errors only; with --json, the JSON object too.
    #[arg(long)]
    pub quiet: bool,
    /// Print one JSON object to standard output instead of text, errors included.
    #[arg(long)]
    pub json: bool,
}

/// The help of `--aov`, with the names of all layers.
fn layers_help() -> String {
    let names = |of_parts| {
        let layers = Layer::ALL.into_iter().filter(|layer| layer.is_part() == of_parts);
        layers.map(Layer::name).collect::<Vec<_>>().join(", ")
    };
    format!(
        "Layers (AOVs) beside the colours, written to .exr files: {}; of {} also parts of the light: \
         {}. [default: the scene's]",
        names(false),
        IntegratorDesc::names_with(|facts| facts.makes_parts),
        names(true)
    )
}
