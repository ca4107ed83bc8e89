//! The options of `alhazen render` and `alhazen resume`, and those that other commands share with
//! them.

use std::path::PathBuf;
use std::time::Duration;

use alhazen::description::IntegratorDesc;
use alhazen::film::Layer;
use alhazen::image::{DisplaySettings, DisplayView, DisplayWhite};
use alhazen::{Overrides, Shard};
use clap::Args;

use super::{EXIT_CODES, render_long_help};
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
    /// The scene: a pbrt-v4 file (also packed by gzip), glTF (.gltf, .glb), USD, PLY, OBJ, STL, or
    /// an archive (.zip) of `scene pack`; `-` reads pbrt-v4 from standard input.
    pub scene: PathBuf,
    /// Write the picture here, in the format of the extension: .exr (linear, all metadata), .png,
    /// .jpg, .hdr, .tga, .pfm, .bmp, .qoi, .webp, .tif. Can be given several times. [default: the
    /// name in the scene's film, else the scene's with .exr, in the current folder]
    #[arg(short, long = "output", value_name = "FILE")]
    pub output: Vec<PathBuf>,
    /// The algorithm; see the list below. [default: the scene's]
    #[arg(long, value_name = "NAME")]
    pub integrator: Option<String>,
    /// Samples per pixel. [default: the scene's, or no limit where there is one of time or noise]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i32::MAX as i64))]
    pub spp: Option<u32>,
    /// Further limits of the render.
    #[command(flatten)]
    pub limits: RenderLimits,
    /// Save the render here while it runs, so that `alhazen resume` can continue it: the film, the
    /// passes that it holds, the scene's path and the options. The file is replaced atomically, so
    /// that it is always valid.
    #[arg(long, value_name = "FILE.film", value_parser = film_file)]
    pub checkpoint: Option<PathBuf>,
    /// How often --checkpoint saves, unless a pass takes longer.
    #[arg(long, value_name = "TIME", value_parser = time, default_value = "30s")]
    pub every: Duration,
    /// Render one of N equal parts of the samples per pixel, counted from 1, into the film file of
    /// --checkpoint; `alhazen merge` makes the picture of all. A picture of the part alone is
    /// written to --output only.
    #[arg(long, value_name = "K/N", value_parser = shard, requires = "checkpoint", conflicts_with = "noise")]
    pub shard: Option<Shard>,
    /// What renders: cpu; gpu, which leaves scenes that it does not draw to the CPU and says why;
    /// ray-query, the same with rays by the GPU's hardware, if it has ray queries and nothing
    /// moves; or auto, the GPU unless it is one in software.
    #[cfg(feature = "gpu")]
    #[arg(long, value_name = "NAME", value_enum, default_value = "cpu", hide_possible_values = true)]
    pub device: DeviceChoice,
    /// Other changes to the scene.
    #[command(flatten)]
    pub changes: Changes,
    /// How pictures for displays show the light.
    #[command(flatten)]
    pub display: DisplayOptions,
    /// Who watches the render.
    #[command(flatten)]
    pub live: LiveOptions,
    /// Print nothing but errors; with --json, the JSON object too.
    #[arg(long)]
    pub quiet: bool,
    /// Write one JSON object to standard output instead of text, errors too.
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
    /// The view of .png, .jpg, .tga, .bmp, .qoi and .webp: standard (sRGB), agx, aces (ACES 2.0),
    /// khronos-neutral or filmic. PNG files name it; other formats stay linear.
    #[arg(long, value_name = "NAME", default_value = "standard", value_parser = view)]
    pub view: DisplayView,
    /// Exposure of the same files in stops: 1 doubles the light.
    #[arg(long, value_name = "EV", default_value = "0", allow_negative_numbers = true, value_parser = stops)]
    pub exposure: f32,
    /// The light that becomes white in them: kelvin, or a CIE xy chromaticity. [default: as it is]
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
    /// Show the picture with all layers in the image viewer tev while it is rendered. Without an
    /// address it is the tev of this machine, at 127.0.0.1:14158. A viewer that is not there, or
    /// does not read, costs a warning only.
    #[arg(
        long, value_name = "HOST:PORT", num_args = 0..=1, require_equals = true,
        default_missing_value = "127.0.0.1:14158", value_parser = address
    )]
    pub tev: Option<String>,
    /// Show the picture in a browser while it is rendered, by a server at this address, by default
    /// 127.0.0.1:8642, which only this machine reaches. The page can also end the render and have
    /// its files written. The server ends with the render, or with `,stay` at Ctrl-C.
    #[arg(
        long, value_name = "ADDR:PORT[,stay]", num_args = 0..=1, require_equals = true,
        default_missing_value = "127.0.0.1:8642", value_parser = serve
    )]
    pub serve: Option<ServeAt>,
    /// Who opens the page of --serve must know this text, which is part of its address. [default:
    /// a random one if other machines reach the address, else none]
    #[arg(long, value_name = "TOKEN", value_parser = token, requires = "serve")]
    pub serve_token: Option<String>,
}

/// Limits of a render beside its number of samples per pixel; the first one reached ends it.
#[derive(Args, Clone, Copy, Debug)]
pub struct RenderLimits {
    /// Render for this time: 30s, 1.5min, 2h; a number alone is seconds. Import and compilation do
    /// not count; the earlier time of a resumed render does. No pass (one sample of each pixel) is
    /// begun that would probably end later.
    #[arg(long, value_name = "TIME", value_parser = time)]
    pub time: Option<Duration>,
    /// Render until the noise of the picture, its estimated relative standard error, is not above
    /// this: 0.02 is 2 %. It is the root of the mean, over pixels and channels, of variance /
    /// (value² + (mean / 10)²), measured by the difference of two pictures of half the samples
    /// each, from 16 samples per pixel on. The second picture doubles the memory of the film.
    #[arg(long, value_name = "NOISE", value_parser = noise)]
    pub noise: Option<f64>,
}

/// Options that change a scene and its rendering, for `render` and `compare`.
#[derive(Args, Debug)]
pub struct Changes {
    /// The acceleration structure: bvh, or none, which tests every ray against every primitive. The
    /// picture is the same. [default: the scene's]
    #[arg(long, value_name = "NAME")]
    pub accelerator: Option<String>,
    /// How ray-casting, whitted, ambient-occlusion, path and vol-path trace rays: wavefront, many
    /// at once, or scalar, one after another. The picture is the same but for rounding.
    /// [default: wavefront]
    #[arg(long, value_name = "NAME", value_parser = ["wavefront", "scalar"])]
    pub engine: Option<String>,
    /// Change a setting; see the list below. Can be given several times.
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_value)]
    pub set: Vec<(String, String)>,
    /// Width and height of the whole image in pixels. [default: the scene's]
    #[arg(long, value_name = "WxH", value_parser = resolution)]
    pub resolution: Option<[i32; 2]>,
    /// Render a part of the image only, given in fractions of its width and height, from the upper
    /// left: 0,0.5,0,1 is the left half. [default: the scene's]
    #[arg(long, value_name = "X0,X1,Y0,Y1", value_parser = crop, conflicts_with = "pixel")]
    pub crop: Option<[f32; 4]>,
    /// Render one pixel only: its column and row, counted from 0 at the upper left.
    #[arg(long, value_name = "X,Y", value_parser = pixel)]
    pub pixel: Option<[i32; 2]>,
    /// Layers of the picture beside its colours.
    #[arg(long, value_name = "LAYER,LAYER,…", value_delimiter = ',', help = layers_help())]
    pub aov: Vec<String>,
    /// Seed of all random numbers: the same seed gives the same picture, bit for bit.
    /// [default: the scene's]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(i32).range(0..))]
    pub seed: Option<i32>,
    /// Threads to render with; their number never changes the picture. At most 256, or 4 for each
    /// core of a machine with more than 64. [default: one for each core]
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
    /// The film file.
    pub film: PathBuf,
    /// Write the picture here, in the format of the extension. Can be given several times.
    /// [default: the film file's name with .exr, in the current folder]
    #[arg(short, long = "output", value_name = "FILE")]
    pub output: Vec<PathBuf>,
    /// Samples per pixel of the whole render, those before included. [default: as begun]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i32::MAX as i64))]
    pub spp: Option<u32>,
    /// Further limits of the render. [default: as begun, unless there is --spp]
    #[command(flatten)]
    pub limits: RenderLimits,
    /// How often the film file is saved, unless a pass takes longer.
    #[arg(long, value_name = "TIME", value_parser = time, default_value = "30s")]
    pub every: Duration,
    /// Threads to render with; their number never changes the picture. [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// How pictures for displays show the light.
    #[command(flatten)]
    pub display: DisplayOptions,
    /// Who watches the render.
    #[command(flatten)]
    pub live: LiveOptions,
    /// Print nothing but errors; with --json, the JSON object too.
    #[arg(long)]
    pub quiet: bool,
    /// Write one JSON object to standard output instead of text, errors too.
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
        "Layers of the picture beside its colours, written to .exr files: {}; of {} parts of the light, too: \
         {}. [default: the scene's]",
        names(false),
        IntegratorDesc::names_with(|facts| facts.makes_parts),
        names(true)
    )
}
