//! The definition of the command line: every command, option, unit and default.

mod render;

use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, Parser, Subcommand, ValueEnum};
use compare::Contender;

pub use render::{Changes, DisplayOptions, LiveOptions, Render, Resume};

#[cfg(feature = "gpu")]
use crate::device::{DeviceChoice, Restir};
use crate::help;
use crate::values::{pixel, share, time};

/// A physically based renderer.
#[derive(Debug, Parser)]
#[command(name = "alhazen", version = env!("ALHAZEN_VERSION"), subcommand_required = true)]
#[command(after_help = EXIT_CODES)]
pub struct Cli {
    /// The command.
    #[command(subcommand)]
    pub command: Command,
}

/// Ends the help of every command.
pub const EXIT_CODES: &str = concat!(
    "Exit codes: 0 done, 1 the input is invalid or the output cannot be written, ",
    "2 the command line is invalid, 130 interrupted."
);

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a scene file to pictures.
    ///
    /// Pictures are written when they are done, and intermediate pictures before that: first a
    /// sketch in larger pixels, if there are more than 65536 pixels, then one after about a second,
    /// then one whenever the time has doubled, but at least every minute. Ctrl-C ends the render
    /// after the current samples, or with --checkpoint after the current pass if passes are not
    /// saved yet, and writes the picture so far; a second Ctrl-C ends the program at once, with the
    /// picture that was written last.
    Render(Box<Render>),
    /// Resume a render that was saved by --checkpoint.
    ///
    /// The film file stores the path of the scene and the options; the files of the scene must not
    /// have changed. The picture has the same bits as that of a render that was not interrupted.
    /// The film file is saved again as by --checkpoint.
    Resume(Resume),
    /// Merge the film files of all shards of a render, and write the picture: it has the same bits
    /// as that of a render that was not split.
    Merge(Merge),
    /// Render a scene by several algorithms, and report how far each is from a reference.
    ///
    /// All get the same time, or the same number of samples. The report has the pictures beside the
    /// reference, maps of their errors, error over time, bias and noise apart, efficiency and rays.
    /// Ctrl-C ends with a report of what has been done.
    Compare(Box<Compare>),
    /// Show what happens along the paths of a pixel: in words, and as a drawing.
    ///
    /// Each sample's rays, what they hit, how it scatters light, shadow rays, and the light that
    /// arrives, of the algorithms that estimate pixels one by one. The picture adds the same
    /// samples.
    TracePixel(Box<TracePixel>),
    /// Walk through a scene in a window, or measure how fast that is without one.
    ///
    /// While the camera moves, pictures are coarse enough to be quick; when it rests, they become
    /// the picture of `render`, sample by sample. Lights and materials can be changed, and the
    /// paths of a pixel be seen. Programs built from source have the window with the cargo feature
    /// `view`.
    View(Box<View>),
    /// Check and convert scene files.
    #[command(subcommand)]
    Scene(Scene),
    /// Inspect, compare and convert pictures.
    #[command(subcommand)]
    Image(Image),
    /// Show what the program finds on this machine: processor, memory, limits, folder.
    ///
    /// Problems are shown with what they mean for a render, and what still works. The exit code is
    /// 0 in any case.
    Doctor(Doctor),
    /// Write a script that completes commands and options in a shell.
    Completions(Completions),
    /// Write the manual as man pages.
    Man(Man),
}

impl Command {
    /// Whether the result, and errors too, are one JSON object on standard output.
    pub fn json(&self) -> bool {
        match self {
            Self::Render(render) => render.json,
            Self::Resume(resume) => resume.json,
            Self::Merge(merge) => merge.json,
            Self::Compare(compare) => compare.json,
            Self::Scene(Scene::Check(check)) => check.json,
            Self::Scene(Scene::Convert(convert)) => convert.json,
            Self::Scene(Scene::Pack(pack)) => pack.json,
            Self::Image(Image::Info(info)) => info.json,
            Self::Image(Image::Diff(diff)) => diff.json,
            Self::Image(Image::Convert(convert)) => convert.json,
            Self::TracePixel(trace) => trace.json,
            Self::View(view) => view.json,
            Self::Doctor(doctor) => doctor.json,
            Self::Completions(_) | Self::Man(_) => false,
        }
    }
}

/// Options of `alhazen merge`.
#[derive(Args, Debug)]
#[command(after_help = EXIT_CODES)]
pub struct Merge {
    /// The film files, in any order.
    #[arg(value_name = "FILM", required = true)]
    pub films: Vec<PathBuf>,
    /// Write the picture here, in the format of the extension. Can be given several times.
    /// [default: the first film file's name with .exr, in the current folder]
    #[arg(short, long = "output", value_name = "FILE")]
    pub output: Vec<PathBuf>,
    /// How pictures for displays show the light.
    #[command(flatten)]
    pub display: DisplayOptions,
    /// Print nothing but errors; with --json, the JSON object too.
    #[arg(long)]
    pub quiet: bool,
    /// Write one JSON object to standard output instead of text, errors too.
    #[arg(long)]
    pub json: bool,
}

/// Options of `alhazen compare`.
#[derive(Args, Debug)]
#[command(after_help = EXIT_CODES, after_long_help = render_long_help())]
#[command(group = clap::ArgGroup::new("budget").required(true).args(["time", "spp"]))]
pub struct Compare {
    /// The scene: a pbrt-v4 file (also packed by gzip), glTF (.gltf, .glb), USD, PLY, OBJ, STL, or
    /// an archive (.zip) of `scene pack`; `-` reads pbrt-v4 from standard input.
    pub scene: PathBuf,
    /// The algorithms, see the list below, separated by commas. Each may have settings of its own:
    /// path,path:maxdepth=8.
    #[arg(long, value_name = "NAME,NAME,…", required = true, value_delimiter = ',')]
    pub integrators: Vec<Contender>,
    /// How long each picture is rendered: 30s, 1.5min, 2h; a number alone is seconds. Each
    /// algorithm renders two pictures, from different seeds, so that noise and bias can be
    /// separated.
    #[arg(long, value_name = "TIME", value_parser = time)]
    pub time: Option<Duration>,
    /// Samples per pixel of each picture.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i32::MAX as i64))]
    pub spp: Option<u32>,
    /// The picture to measure errors against. [default: one is rendered]
    #[arg(long, value_name = "FILE", conflicts_with_all = ["reference_with", "reference_spp"])]
    pub reference: Option<PathBuf>,
    /// The algorithm that renders the reference. [default: the first one listed]
    #[arg(long, value_name = "NAME")]
    pub reference_with: Option<Contender>,
    /// Samples per pixel of the reference. [default: 16 times the time or samples of one picture]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i32::MAX as i64))]
    pub reference_spp: Option<u32>,
    /// Write the report here: a page that opens without a network; the same in numbers goes beside
    /// it, as .json. [default: the scene's name with .html, in the current folder]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Changes to the scene, for all.
    #[command(flatten)]
    pub changes: Changes,
    /// Print nothing but errors; with --json, the JSON object too.
    #[arg(long)]
    pub quiet: bool,
    /// Write the report's numbers to standard output, as one JSON object instead of text, errors
    /// too.
    #[arg(long)]
    pub json: bool,
}

/// Options of `alhazen trace-pixel`.
#[derive(Args, Debug)]
#[command(after_help = EXIT_CODES, after_long_help = render_long_help())]
pub struct TracePixel {
    /// The scene: a pbrt-v4 file (also packed by gzip), glTF (.gltf, .glb), USD, PLY, OBJ, or an
    /// archive (.zip) of `scene pack`; `-` reads pbrt-v4 from standard input.
    pub scene: PathBuf,
    /// Column of the pixel, counted from 0 at the left.
    #[arg(value_parser = clap::value_parser!(i32).range(0..), allow_negative_numbers = true)]
    pub x: i32,
    /// Row of the pixel, counted from 0 at the top.
    #[arg(value_parser = clap::value_parser!(i32).range(0..), allow_negative_numbers = true)]
    pub y: i32,
    /// The number of samples to trace.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub samples: u32,
    /// The index of the first of them.
    #[arg(long, value_name = "I", default_value_t = 0, value_parser = clap::value_parser!(u32).range(..1 << 30))]
    pub first: u32,
    /// Draw the rays over a view of the scene that is cut open (.svg), or write them as coloured
    /// edges for programs that show meshes (.ply). Can be given several times.
    #[arg(short, long = "output", value_name = "FILE")]
    pub output: Vec<PathBuf>,
    /// From where to draw: side, from the right of the camera; top; or front, as the camera looks.
    /// [default: where the rays take the most space]
    #[arg(long, value_name = "SIDE", value_parser = ["side", "top", "front"])]
    pub from: Option<String>,
    /// The algorithm, see the list below. [default: the scene's]
    #[arg(long, value_name = "NAME")]
    pub integrator: Option<String>,
    /// Changes to the scene.
    #[command(flatten)]
    pub changes: Changes,
    /// Write one JSON object to standard output instead of text.
    #[arg(long)]
    pub json: bool,
}

/// Options of `alhazen view`.
#[derive(Args, Debug)]
#[command(after_help = EXIT_CODES, after_long_help = render_long_help())]
pub struct View {
    /// The scene: a pbrt-v4 file (also packed by gzip), glTF (.gltf, .glb), PLY, OBJ, STL, or an
    /// archive (.zip) of `scene pack`; `-` reads pbrt-v4 from standard input.
    #[arg(required_unless_present = "planet")]
    pub scene: Option<PathBuf>,
    /// Instead of a scene, a small planet made of N spheres, which move: to be walked on, with
    /// gravity, collisions, mirrors and glass. --spp are the samples per pixel of each frame then.
    /// [N: 64 to 4000000]
    #[arg(long, value_name = "N", conflicts_with = "scene", value_parser = clap::value_parser!(u32).range(64..=4_000_000))]
    pub planet: Option<u32>,
    /// The algorithm to begin with, see the list below. [default: the scene's]
    #[arg(long, value_name = "NAME")]
    pub integrator: Option<String>,
    /// Samples per pixel of the finished picture. [default: the scene's]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i32::MAX as i64))]
    pub spp: Option<u32>,
    /// What renders: cpu; gpu or ray-query, as in `alhazen render`; or auto, the GPU unless it is
    /// one in software.
    #[cfg(feature = "gpu")]
    #[arg(long, value_name = "NAME", value_enum, default_value = "cpu", hide_possible_values = true)]
    pub device: DeviceChoice,
    /// With --device, pixels and frames share samples of direct light while the camera moves
    /// (ReSTIR): unbiased, or biased, which is faster, and too dark where surfaces and shadows
    /// differ.
    #[cfg(feature = "gpu")]
    #[arg(long, value_name = "WEIGHTS", value_enum, hide_possible_values = true)]
    pub restir: Option<Restir>,
    /// Changes to the scene.
    #[command(flatten)]
    pub changes: Changes,
    /// How the light is shown to begin with.
    #[command(flatten)]
    pub display: DisplayOptions,
    /// The time that a picture in motion is to take, in milliseconds: its pixels are as large as
    /// that needs.
    #[arg(long, value_name = "MS", default_value_t = 33, conflicts_with = "planet", value_parser = clap::value_parser!(u32).range(1..=60_000))]
    pub frame_time: u32,
    /// Samples per pixel of a picture in motion: 4 make its edges smoother than 1, and its pixels
    /// larger, or frames longer.
    #[arg(long, value_name = "N", default_value_t = 1, conflicts_with = "planet", value_parser = clap::value_parser!(u32).range(1..=64))]
    pub moving_spp: u32,
    /// Open no window, but render a camera path, once around what the camera looks at, or a walk
    /// over the planet, and report the times of its frames.
    #[arg(long)]
    pub headless: bool,
    /// The number of frames of that path.
    #[arg(long, value_name = "N", default_value_t = 60, requires = "headless", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub frames: u32,
    /// Draw the scene twice with one camera: ray traced on the left of a slider, and rasterised by
    /// the GPU on its right. SHARE is where the slider is, from 0 to 1. [without SHARE: 0.5]
    #[arg(long, value_name = "SHARE", num_args = 0..=1, require_equals = true, default_missing_value = "0.5", conflicts_with = "planet", value_parser = share)]
    pub split: Option<f32>,
    /// Write the last frame of that path, which is the scene's own view; with --split the whole
    /// picture of it, with all samples per pixel on the left of the slider.
    #[arg(short, long, value_name = "FILE", requires = "headless", conflicts_with = "planet")]
    pub output: Option<PathBuf>,
    /// Write one JSON object to standard output instead of text.
    #[arg(long, requires = "headless")]
    pub json: bool,
}

/// Commands about scene files.
#[derive(Debug, Subcommand)]
pub enum Scene {
    /// Report all errors and warnings of a scene without rendering it.
    Check(Check),
    /// Write a scene as pbrt-v4, which renders to the same picture.
    ///
    /// Meshes, images and tables are written to a folder beside it, of the output's name with
    /// .assets for .pbrt. The output and files in that folder are replaced if they exist, each when
    /// it is complete, the output last; other files in the folder stay.
    Convert(ConvertScene),
    /// Pack a scene with its includes, meshes, images and all other files that it reads into one
    /// ZIP archive, which all commands take as a scene.
    ///
    /// It can be unpacked and rendered, too. The same files give the same archive.
    Pack(Pack),
}

/// Options of `alhazen scene check`.
#[derive(Args, Debug)]
#[command(after_help = EXIT_CODES)]
pub struct Check {
    /// The scene: a pbrt-v4 file (also packed by gzip), glTF (.gltf, .glb), USD, PLY, OBJ, STL, or
    /// an archive (.zip) of `scene pack`; `-` reads pbrt-v4 from standard input.
    pub scene: PathBuf,
    /// Write one JSON object to standard output instead of text.
    #[arg(long)]
    pub json: bool,
}

/// Options of `alhazen scene convert`.
#[derive(Args, Debug)]
#[command(after_help = EXIT_CODES)]
pub struct ConvertScene {
    /// The scene: a pbrt-v4 file (also packed by gzip), glTF (.gltf, .glb), USD, PLY, OBJ, STL, or
    /// an archive (.zip) of `scene pack`; `-` reads pbrt-v4 from standard input.
    pub scene: PathBuf,
    /// The scene to write, with the extension .pbrt.
    pub output: PathBuf,
    /// Write one JSON object to standard output instead of text.
    #[arg(long)]
    pub json: bool,
}

/// Options of `alhazen scene pack`.
#[derive(Args, Debug)]
#[command(after_help = EXIT_CODES)]
pub struct Pack {
    /// The scene file.
    pub scene: PathBuf,
    /// The archive. [default: the scene's name with .zip, in the current folder]
    #[arg(short, long, value_name = "FILE.zip")]
    pub output: Option<PathBuf>,
    /// Write one JSON object to standard output instead of text.
    #[arg(long)]
    pub json: bool,
}

/// Commands about pictures.
#[derive(Debug, Subcommand)]
pub enum Image {
    /// Show the size, layers, channels, storage and header of a picture file.
    Info(Info),
    /// Measure the difference of a picture to a reference: MSE, relative MSE, FLIP.
    ///
    /// MSE is the mean of (b - a)² over pixels and channels; relMSE the mean of (b - a)² / (a² +
    /// 0.01); FLIP the mean of the visible difference, from 0 to 1, over the exposures that show
    /// the reference's range. The exit code is 0 however large the difference is.
    Diff(Diff),
    /// Write a picture in another format: that of the new name's extension.
    Convert(Convert),
}

/// Options of `alhazen image info`.
#[derive(Args, Debug)]
#[command(after_help = EXIT_CODES)]
pub struct Info {
    /// The picture: EXR, PNG, JPEG, HDR, TGA, PFM, BMP, QOI or TIFF.
    pub file: PathBuf,
    /// Print the linear values of all channels at this pixel instead: its column and row in the
    /// whole frame, counted from 0 at the upper left.
    #[arg(long, value_name = "X,Y", value_parser = pixel)]
    pub pixel: Option<[i32; 2]>,
    /// Write one JSON object to standard output instead of text.
    #[arg(long)]
    pub json: bool,
}

/// Options of `alhazen image diff`.
#[derive(Args, Debug)]
#[command(after_help = EXIT_CODES)]
pub struct Diff {
    /// The reference.
    pub a: PathBuf,
    /// The picture to measure; of the same size.
    pub b: PathBuf,
    /// Write a picture of the error here, from black (none) to pale yellow.
    #[arg(short, long = "output", value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Which error the picture shows.
    #[arg(long, value_enum, default_value_t = Metric::Flip)]
    pub metric: Metric,
    /// Write one JSON object to standard output instead of text.
    #[arg(long)]
    pub json: bool,
}

/// The error that an error picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Metric {
    /// Squared error; the brightest colour is the largest.
    Mse,
    /// Relative squared error; the brightest colour is the largest.
    Relmse,
    /// FLIP; the brightest colour is 1.
    Flip,
}

/// Options of `alhazen image convert`.
#[derive(Args, Debug)]
#[command(after_help = EXIT_CODES)]
pub struct Convert {
    /// The picture to read: EXR, PNG, JPEG, HDR, TGA, PFM, BMP, QOI or TIFF.
    pub input: PathBuf,
    /// The picture to write.
    pub output: PathBuf,
    /// How values are stored: `natural` keeps the depth of the picture if the format can.
    #[arg(long, value_enum, default_value_t = Depth::Natural)]
    pub depth: Depth,
    /// Convert an image of the sphere of directions, such as an environment map, to another
    /// projection. Its own projection is determined by its aspect ratio.
    #[arg(long, value_enum)]
    pub projection: Option<Projection>,
    /// How pictures for displays show the light.
    #[command(flatten)]
    pub display: DisplayOptions,
    /// Write one JSON object to standard output instead of text.
    #[arg(long)]
    pub json: bool,
}

/// How an image shows the sphere of directions; +z is up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Projection {
    /// The square octahedral mapping of the pbrt-v4 format.
    EqualArea,
    /// Longitude along the rows, from +x towards +y; twice as wide as high.
    LatitudeLongitude,
}

/// How values are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Depth {
    /// What suits the format.
    Natural,
    /// 8-bit integers.
    U8,
    /// 16-bit integers.
    U16,
    /// Half floats.
    F16,
    /// Single floats.
    F32,
}

/// Options of `alhazen doctor`.
#[derive(Args, Debug)]
#[command(after_help = EXIT_CODES)]
pub struct Doctor {
    /// Write one JSON object to standard output instead of text.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `alhazen completions`.
#[derive(Args, Debug)]
pub struct Completions {
    /// The shell that the script is for.
    #[arg(value_enum)]
    pub shell: clap_complete::Shell,
}

/// Arguments of `alhazen man`.
#[derive(Args, Debug)]
pub struct Man {
    /// Write alhazen.1 and a page for each command into this folder, which is created if it does
    /// not exist. [default: alhazen.1 alone, to standard output]
    pub folder: Option<PathBuf>,
}

fn render_long_help() -> String {
    help::settings() + "\n" + EXIT_CODES
}

#[cfg(test)]
mod tests;
