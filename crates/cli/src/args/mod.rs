//! The definition of the command line: every command, option, unit and default.

#[cfg(all(test, feature = "gpu"))]
mod reference;
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

/// The scene argument of all commands.
const SCENE: &str = "Scene file: pbrt-v4 (also gzipped), glTF (.gltf, .glb), USD (.usd, .usda, .usdc, .usdz), \
                     PLY, OBJ, STL, or an archive (.zip) of `scene pack`; `-` reads pbrt-v4 from standard input";

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a scene and write its pictures.
    ///
    /// Intermediate pictures are written while rendering: a low-resolution preview, if there are
    /// more than 65536 pixels, the picture after about one second, and then whenever the elapsed
    /// time has doubled, at least once a minute. Ctrl-C finishes the current samples, or with
    /// --checkpoint the current pass if none is saved yet, and writes the picture; a second Ctrl-C
    /// quits at once and keeps the last picture written.
    Render(Box<Render>),
    /// Continue a render from the film file of --checkpoint.
    ///
    /// The film file holds the path of the scene and the options; the scene's files must not have
    /// changed. The picture has the same bits as that of an uninterrupted render. The film file is
    /// saved again as by --checkpoint.
    Resume(Resume),
    /// Merge the film files of all shards of a render and write the picture.
    ///
    /// It has the same bits as that of a render without shards.
    Merge(Merge),
    /// Compare integrators on one scene by their error against a reference.
    ///
    /// All get the same rendering time, or the same number of samples. The report has the pictures
    /// beside the reference, error maps, error over time, bias and noise apart, efficiency and ray
    /// counts. Ctrl-C ends with a report of what is done.
    Compare(Box<Compare>),
    /// Trace the paths of one pixel, as text and as a drawing.
    ///
    /// Of each sample: rays, intersections, scattering, shadow rays and contributions to the pixel,
    /// for integrators that estimate pixels one by one. The sum is that of the rendered picture.
    TracePixel(Box<TracePixel>),
    /// Explore a scene in a window, or measure frame times without one.
    ///
    /// While the camera moves, the resolution adapts to the frame time; when it stops, the picture
    /// converges to that of `render`. Lights and materials can be edited, and the paths of a pixel
    /// shown. Programs built from source have the window with the cargo feature `view`.
    View(Box<View>),
    /// Check, convert and pack scene files.
    #[command(subcommand)]
    Scene(Scene),
    /// Inspect, compare and convert image files.
    #[command(subcommand)]
    Image(Image),
    /// Report what affects a render on this machine: processor, memory, limits, folder.
    ///
    /// Each problem is shown with its effect on a render and what still works. The exit code is 0
    /// in any case.
    Doctor(Doctor),
    /// Write a completion script for a shell.
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
    /// Film files of the shards, in any order.
    #[arg(value_name = "FILM", required = true)]
    pub films: Vec<PathBuf>,
    /// Output picture, in the format of its extension. Can be given several times. [default: the
    /// first film file's name with .exr, in the current folder]
    #[arg(short, long = "output", value_name = "FILE")]
    pub output: Vec<PathBuf>,
    /// How pictures for displays show the light.
    #[command(flatten)]
    pub display: DisplayOptions,
    /// Print errors only; with --json, the JSON object too.
    #[arg(long)]
    pub quiet: bool,
    /// Print one JSON object to standard output instead of text, errors included.
    #[arg(long)]
    pub json: bool,
}

/// Options of `alhazen compare`.
#[derive(Args, Debug)]
#[command(after_help = EXIT_CODES, after_long_help = render_long_help())]
#[command(group = clap::ArgGroup::new("budget").required(true).args(["time", "spp"]))]
pub struct Compare {
    /// The scene.
    #[arg(help = SCENE)]
    pub scene: PathBuf,
    /// Integrators to compare (listed below), separated by commas, each with settings of its own if
    /// needed: path,path:maxdepth=8.
    #[arg(long, value_name = "NAME,NAME,…", required = true, value_delimiter = ',')]
    pub integrators: Vec<Contender>,
    /// Rendering time of each picture: 30s, 1.5min, 2h; a number alone is seconds. Each integrator
    /// renders two pictures from different seeds, which separates noise from bias.
    #[arg(long, value_name = "TIME", value_parser = time)]
    pub time: Option<Duration>,
    /// Samples per pixel of each picture.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i32::MAX as i64))]
    pub spp: Option<u32>,
    /// Reference picture. [default: one is rendered]
    #[arg(long, value_name = "FILE", conflicts_with_all = ["reference_with", "reference_spp"])]
    pub reference: Option<PathBuf>,
    /// Integrator of the rendered reference. [default: the first one listed]
    #[arg(long, value_name = "NAME")]
    pub reference_with: Option<Contender>,
    /// Samples per pixel of the rendered reference. [default: 16 times the time or samples of one
    /// picture]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i32::MAX as i64))]
    pub reference_spp: Option<u32>,
    /// Device that renders: cpu; gpu or ray-query, as in `alhazen render`; or auto, the GPU unless
    /// it is a software one.
    #[cfg(feature = "gpu")]
    #[arg(long, value_name = "NAME", value_enum, default_value = "cpu", hide_possible_values = true)]
    pub device: DeviceChoice,
    /// Report: a self-contained HTML page, and the same figures as .json beside it. [default: the
    /// scene's name with .html, in the current folder]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Overrides of the scene, for all integrators.
    #[command(flatten)]
    pub changes: Changes,
    /// Print errors only; with --json, the JSON object too.
    #[arg(long)]
    pub quiet: bool,
    /// Print one JSON object to standard output instead of text, errors included.
    #[arg(long)]
    pub json: bool,
}

/// Options of `alhazen trace-pixel`.
#[derive(Args, Debug)]
#[command(after_help = EXIT_CODES, after_long_help = render_long_help())]
pub struct TracePixel {
    /// The scene.
    #[arg(help = SCENE)]
    pub scene: PathBuf,
    /// Column of the pixel, from 0 at the left.
    #[arg(value_parser = clap::value_parser!(i32).range(0..), allow_negative_numbers = true)]
    pub x: i32,
    /// Row of the pixel, from 0 at the top.
    #[arg(value_parser = clap::value_parser!(i32).range(0..), allow_negative_numbers = true)]
    pub y: i32,
    /// Number of samples to trace.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub samples: u32,
    /// Index of the first sample.
    #[arg(long, value_name = "I", default_value_t = 0, value_parser = clap::value_parser!(u32).range(..1 << 30))]
    pub first: u32,
    /// Drawing of the rays: over a cutaway view of the scene (.svg), or as coloured edges for mesh
    /// viewers (.ply). Can be given several times.
    #[arg(short, long = "output", value_name = "FILE")]
    pub output: Vec<PathBuf>,
    /// View of the drawing: side, from the camera's right; top; or front, along the view direction.
    /// [default: the one in which the rays take the most space]
    #[arg(long, value_name = "SIDE", value_parser = ["side", "top", "front"])]
    pub from: Option<String>,
    /// Integrator (listed below). [default: the scene's]
    #[arg(long, value_name = "NAME")]
    pub integrator: Option<String>,
    /// Overrides of the scene.
    #[command(flatten)]
    pub changes: Changes,
    /// Print one JSON object to standard output instead of text, errors included.
    #[arg(long)]
    pub json: bool,
}

/// Options of `alhazen view`.
#[derive(Args, Debug)]
#[command(after_help = EXIT_CODES, after_long_help = render_long_help())]
pub struct View {
    /// The scene.
    #[arg(help = SCENE, required_unless_present = "planet")]
    pub scene: Option<PathBuf>,
    /// Walk on a small planet of N moving spheres instead of in a scene, with gravity, collisions,
    /// mirrors and glass; --spp is samples per pixel of each frame then. [N: 64 to 4000000]
    #[arg(long, value_name = "N", conflicts_with = "scene", value_parser = clap::value_parser!(u32).range(64..=4_000_000))]
    pub planet: Option<u32>,
    /// Initial integrator (listed below). [default: the scene's]
    #[arg(long, value_name = "NAME")]
    pub integrator: Option<String>,
    /// Samples per pixel of the converged picture. [default: the scene's]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i32::MAX as i64))]
    pub spp: Option<u32>,
    /// Device that renders: cpu; gpu or ray-query, as in `alhazen render`; or auto, the GPU unless
    /// it is a software one.
    #[cfg(feature = "gpu")]
    #[arg(long, value_name = "NAME", value_enum, default_value = "cpu", hide_possible_values = true)]
    pub device: DeviceChoice,
    /// ReSTIR with --device gpu: pixels and frames share samples of direct light while the camera
    /// moves; unbiased, or biased, which is faster, and too dark where surfaces and shadows differ.
    #[cfg(feature = "gpu")]
    #[arg(long, value_name = "WEIGHTS", value_enum, hide_possible_values = true)]
    pub restir: Option<Restir>,
    /// Overrides of the scene.
    #[command(flatten)]
    pub changes: Changes,
    /// Initial display settings.
    #[command(flatten)]
    pub display: DisplayOptions,
    /// Target frame time in motion, in milliseconds: the resolution adapts to it.
    #[arg(long, value_name = "MS", default_value_t = 33, conflicts_with = "planet", value_parser = clap::value_parser!(u32).range(1..=60_000))]
    pub frame_time: u32,
    /// Samples per pixel of frames in motion: more of them smooth edges at a lower resolution or
    /// frame rate.
    #[arg(long, value_name = "N", default_value_t = 1, conflicts_with = "planet", value_parser = clap::value_parser!(u32).range(1..=64))]
    pub moving_spp: u32,
    /// Render a camera path without a window, once around the point looked at, or a walk over the
    /// planet, and report frame times.
    #[arg(long)]
    pub headless: bool,
    /// Number of frames of the camera path.
    #[arg(long, value_name = "N", default_value_t = 60, requires = "headless", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub frames: u32,
    /// Split view with one camera: ray traced left of a slider, rasterised by the GPU right of it.
    /// SHARE is the slider's position from 0 to 1. [without SHARE: 0.5]
    #[arg(long, value_name = "SHARE", num_args = 0..=1, require_equals = true, default_missing_value = "0.5", conflicts_with = "planet", value_parser = share)]
    pub split: Option<f32>,
    /// Last frame of the camera path, which is the scene's own view; with --split the whole
    /// picture, with all samples per pixel left of the slider.
    #[arg(short, long, value_name = "FILE", requires = "headless", conflicts_with = "planet")]
    pub output: Option<PathBuf>,
    /// Print one JSON object to standard output instead of text, errors included.
    #[arg(long, requires = "headless")]
    pub json: bool,
}

/// Commands about scene files.
#[derive(Debug, Subcommand)]
pub enum Scene {
    /// Report all errors and warnings of a scene without rendering it.
    Check(Check),
    /// Convert a scene to pbrt-v4; it renders to the same picture.
    ///
    /// Meshes, images and tables go to the folder OUT.assets beside the output OUT.pbrt. The output
    /// and files in that folder are replaced if they exist, each when it is complete, the output
    /// last; other files in the folder stay.
    Convert(ConvertScene),
    /// Pack a scene and all files that it reads into one ZIP archive.
    ///
    /// All commands take the archive as a scene; unpacked, it can be rendered, too. The same files
    /// give the same archive.
    Pack(Pack),
}

/// Options of `alhazen scene check`.
#[derive(Args, Debug)]
#[command(after_help = EXIT_CODES)]
pub struct Check {
    /// The scene.
    #[arg(help = SCENE)]
    pub scene: PathBuf,
    /// Print one JSON object to standard output instead of text, errors included.
    #[arg(long)]
    pub json: bool,
}

/// Options of `alhazen scene convert`.
#[derive(Args, Debug)]
#[command(after_help = EXIT_CODES)]
pub struct ConvertScene {
    /// The scene.
    #[arg(help = SCENE)]
    pub scene: PathBuf,
    /// Scene to write, with the extension .pbrt.
    pub output: PathBuf,
    /// Print one JSON object to standard output instead of text, errors included.
    #[arg(long)]
    pub json: bool,
}

/// Options of `alhazen scene pack`.
#[derive(Args, Debug)]
#[command(after_help = EXIT_CODES)]
pub struct Pack {
    /// The scene.
    #[arg(help = SCENE)]
    pub scene: PathBuf,
    /// Archive to write. [default: the scene's name with .zip, in the current folder]
    #[arg(short, long, value_name = "FILE.zip")]
    pub output: Option<PathBuf>,
    /// Print one JSON object to standard output instead of text, errors included.
    #[arg(long)]
    pub json: bool,
}

/// Commands about pictures.
#[derive(Debug, Subcommand)]
pub enum Image {
    /// Print the size, layers, channels, storage and header of an image file.
    Info(Info),
    /// Measure the error of an image against a reference: MSE, relative MSE, FLIP.
    ///
    /// MSE is the mean of (b - a)² over pixels and channels; relMSE the mean of (b - a)² / (a² +
    /// 0.01); FLIP the mean perceived difference, from 0 to 1, over exposures that cover the
    /// reference's range. The exit code is 0 however large the error is.
    Diff(Diff),
    /// Convert an image to the format of the output's extension.
    Convert(Convert),
}

/// Options of `alhazen image info`.
#[derive(Args, Debug)]
#[command(after_help = EXIT_CODES)]
pub struct Info {
    /// Image file: EXR, PNG, JPEG, HDR, TGA, PFM, BMP, QOI, WebP or TIFF.
    pub file: PathBuf,
    /// Print the linear values of all channels at one pixel instead: column and row of the whole
    /// frame, from 0 at the upper left.
    #[arg(long, value_name = "X,Y", value_parser = pixel)]
    pub pixel: Option<[i32; 2]>,
    /// Print one JSON object to standard output instead of text, errors included.
    #[arg(long)]
    pub json: bool,
}

/// Options of `alhazen image diff`.
#[derive(Args, Debug)]
#[command(after_help = EXIT_CODES)]
pub struct Diff {
    /// Reference image.
    pub a: PathBuf,
    /// Image to measure, of the same size.
    pub b: PathBuf,
    /// Error map to write, from black (no error) to pale yellow.
    #[arg(short, long = "output", value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Error metric of the map.
    #[arg(long, value_enum, default_value_t = Metric::Flip)]
    pub metric: Metric,
    /// Print one JSON object to standard output instead of text, errors included.
    #[arg(long)]
    pub json: bool,
}

/// The error that an error picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Metric {
    /// Squared error; the colour scale ends at this image's largest error.
    Mse,
    /// Relative squared error; the colour scale ends at this image's largest error.
    Relmse,
    /// FLIP; the colour scale ends at 1.
    Flip,
}

/// Options of `alhazen image convert`.
#[derive(Args, Debug)]
#[command(after_help = EXIT_CODES)]
pub struct Convert {
    /// Image to read: EXR, PNG, JPEG, HDR, TGA, PFM, BMP, QOI, WebP or TIFF.
    pub input: PathBuf,
    /// Image to write, in the format of its extension.
    pub output: PathBuf,
    /// Storage of values; `natural` keeps the image's depth if the format can.
    #[arg(long, value_enum, default_value_t = Depth::Natural)]
    pub depth: Depth,
    /// Reproject an image of the sphere of directions, such as an environment map. Its own
    /// projection follows from its aspect ratio.
    #[arg(long, value_enum)]
    pub projection: Option<Projection>,
    /// How pictures for displays show the light.
    #[command(flatten)]
    pub display: DisplayOptions,
    /// Print one JSON object to standard output instead of text, errors included.
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
    /// Print one JSON object to standard output instead of text, errors included.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `alhazen completions`.
#[derive(Args, Debug)]
pub struct Completions {
    /// Shell that reads the script.
    #[arg(value_enum)]
    pub shell: clap_complete::Shell,
}

/// Arguments of `alhazen man`.
#[derive(Args, Debug)]
pub struct Man {
    /// Folder for alhazen.1 and a page for each command; created if it does not exist. [default:
    /// alhazen.1 alone, to standard output]
    pub folder: Option<PathBuf>,
}

fn render_long_help() -> String {
    help::settings() + "\n" + EXIT_CODES
}

#[cfg(test)]
mod tests;
