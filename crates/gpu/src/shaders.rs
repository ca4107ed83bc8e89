//! The sources of the shaders. WGSL has no modules: a shader is the concatenation of texts, in any
//! order.

use std::borrow::Cow;

use crate::Algorithm;
use crate::bvh::Top;
use crate::bxdfs;
use crate::dynamic::{Placement, Plan};
use crate::flatten::Head;
pub use crate::parts::Parts;
pub use crate::pruning::parsed;
use crate::raster::Eye;
use crate::realtime::frame::{self, FrameParameters, Level, Reuse};
use crate::records::pixels::{Batch, PixelSample, Splat};
use crate::records::{chains, photons, wavefront};
use crate::tags;

/// What translated laws use and WGSL has not, and what computes with wide words.
const BY_HAND: [&str; 2] =
    [include_str!("../shaders/prelude.wgsl"), include_str!("../shaders/samplers.wgsl")];

/// Tags, and where rays begin: what [`TRACE`] and [`RAY_QUERY`] need of Rust.
pub fn tags() -> String {
    tags::text() + Top::TEXT
}

/// Rays through the buffers of a [`Bvh`](crate::Bvh), for kernels that declare these and have
/// [`tags`].
pub const TRACE: &str = concat!(
    include_str!("../shaders/hits.wgsl"),
    include_str!("../shaders/trace.wgsl"),
    include_str!("../shaders/shapes.wgsl")
);

/// The same by ray queries, for kernels that begin with [`ENABLE_RAY_QUERIES`].
pub const RAY_QUERY: &str = concat!(
    include_str!("../shaders/hits.wgsl"),
    include_str!("../shaders/ray_query.wgsl"),
    include_str!("../shaders/shapes.wgsl")
);

/// What is first in a shader with ray queries.
pub const ENABLE_RAY_QUERIES: &str = "enable wgpu_ray_query;\n";

/// What rays are traced through.
const NODES: &str = "@group(0) @binding(1) var<storage, read_write> nodes: array<vec4u>;\n";
const STRUCTURE: &str = "@group(0) @binding(1) var structure: acceleration_structure;\n";

/// The laws, translated from Rust by `cargo xtask wgsl`.
macro_rules! laws {
    ($($name:literal)*) => { [$(include_str!(concat!("../shaders/law/", $name, ".wgsl"))),*] };
}

const LAWS: [&str; 64] = laws! {
    "address" "arc" "balance" "bilerp" "checkerboard" "circular" "closed" "cluster" "conductor" "dielectric"
    "diffuse" "diffuse_transmission" "direct" "disk" "dispersion" "dots" "error" "exponential" "flags"
    "flat_shape" "float" "footprint" "fractal" "frame" "fresnel" "function" "hair" "hash"
    "hash_sequence" "independent" "interval" "layered" "logarithm" "mapping" "marble" "microfacet"
    "minimum_differentials" "noise" "octahedral" "orthographic" "perspective" "phase" "power"
    "randomize" "ray" "rectangle" "rgb_spectrum" "roulette" "sample" "sampled" "scatter" "screen" "sobol"
    "sphere" "spherical" "square" "thin_dielectric" "triangle" "tuples" "uplift" "vector" "walk"
    "wavelengths" "zsobol"
};

/// The laws of principled surfaces, which need their tables.
const PRINCIPLED_LAWS: [&str; 16] = laws! {
    "chances" "coat" "facets" "film" "fuzz" "glass" "interior" "mirror" "openpbr" "oren_nayar"
    "parameters" "shares" "stack" "thin" "under" "value"
};

/// Plumbing that all algorithms share.
macro_rules! plumbing {
    ($($name:literal)*) => { [$(include_str!(concat!("../shaders/", $name, ".wgsl"))),*] };
}

const PLUMBING: [&str; 23] = plumbing! {
    "tables" "scene" "motion" "distributions" "spectra" "images" "textures" "surfaces" "footprints"
    "bumps" "materials" "interfaces" "hair_material" "subsurface_material" "emission_images" "lights"
    "surface_lights" "placed_lights" "portals" "light_choices" "direct" "cameras" "lens"
};

/// How `tables` are read, for kernels that declare them.
pub const TABLES: &str = include_str!("../shaders/tables.wgsl");

/// The law of measured surfaces, and the look-ups in their tables, for kernels that have
/// [`TABLES`].
pub const MEASURED: &str = concat!(
    include_str!("../shaders/law/piecewise_bilinear.wgsl"),
    include_str!("../shaders/law/measured.wgsl"),
    include_str!("../shaders/measured_table.wgsl")
);

/// What kernels of real-time frames share.
const FRAME: [&str; 3] =
    [frame::Eye::TEXT, FrameParameters::TEXT, include_str!("../shaders/realtime/frame.wgsl")];

/// What is found of camera rays once, by the kernel of surfaces for that of light.
const CAMERA_HIT: &str = include_str!("../shaders/realtime/camera_hit.wgsl");

/// From light to colours.
const SENSOR: &str = include_str!("../shaders/sensor.wgsl");

/// The random numbers of samples, instead of which chains have their own.
const RANDOM_NUMBERS: &str = include_str!("../shaders/random_numbers.wgsl");

/// Subpaths from both ends: the camera's and the lights' ends, and what is between.
const SUBPATHS: [&str; 3] = plumbing! { "importance" "light_paths" "subpaths" };

/// Steps of all paths, and of those in empty space, or those through media.
const PATH: [&str; 4] = plumbing! { "heroes" "generator" "under_surface" "path_hits" };
const IN_VACUUM: [&str; 2] = plumbing! { "path" "path_loop" };
const IN_MEDIA: [&str; 2] = plumbing! { "media" "vol_path" };

/// A path finds all light itself.
const NO_RESERVOIRS: &str = "const HAS_RESERVOIRS = false;\n";

/// A shader: the laws, and what uses them.
pub fn with_laws(parts: &[&str]) -> String {
    let all = BY_HAND.iter().chain(&LAWS).chain(parts);
    all.copied().collect::<Vec<_>>().join("\n")
}

/// The laws of principled surfaces, and the look-ups in their tables, for kernels that have
/// [`TABLES`].
pub fn principled() -> String {
    let table = include_str!("../shaders/openpbr_table.wgsl");
    let all = PRINCIPLED_LAWS.iter().chain([&table]);
    all.copied().collect::<Vec<_>>().join("\n")
}

/// The kernel that renders a sample of each pixel by an algorithm; of Metropolis light transport,
/// what its chains leave out.
pub fn pixels(algorithm: &Algorithm, parts: Parts) -> String {
    let constants = match algorithm {
        Algorithm::LightTracing(_) => subpaths(false, true, 1),
        Algorithm::Bdpt(desc) => subpaths(true, true, desc.max_depth.saturating_sub(1).max(1)),
        Algorithm::Sppm(..) => subpaths(true, false, 1),
        Algorithm::RayCasting
        | Algorithm::Whitted(_)
        | Algorithm::AmbientOcclusion(..)
        | Algorithm::Path(_)
        | Algorithm::VolPath(_)
        | Algorithm::SimpleVolPath(_)
        | Algorithm::SimplePath(_)
        | Algorithm::RandomWalk(_)
        | Algorithm::Mlt(..) => {
            let pixels = include_str!("../shaders/pixels.wgsl");
            let own = [RANDOM_NUMBERS, NO_RESERVOIRS, &radiance(algorithm, parts), pixels];
            return traced(parts, &[&[Batch::TEXT, Splat::TEXT], &own[..]].concat());
        }
    };
    let batch = match algorithm {
        Algorithm::Sppm(..) => [photons::Batch::TEXT, ""],
        _ => [Batch::TEXT, Splat::TEXT],
    };
    let own = [RANDOM_NUMBERS, &constants, &radiance(algorithm, parts)];
    traced(parts, &[&SUBPATHS[..], &batch, &own].concat())
}

/// The kernels of the stages of path tracing by a wavefront: paths begin, are extended and shaded,
/// the next turn is planned, and paths are connected to lights.
pub fn wavefront(parts: Parts) -> [String; 5] {
    let [queues, plan, vertices, paths] =
        plumbing! { "wavefront/queues" "wavefront/plan" "path" "wavefront/paths" };
    let batch = wavefront::Batch::TEXT;
    let own = [RANDOM_NUMBERS, NO_RESERVOIRS, batch, queues, vertices, paths];
    let stages = plumbing! { "wavefront/begin" "wavefront/extend" "wavefront/shade" "wavefront/connect" };
    let [begin, extend, shade, connect] =
        stages.map(|stage| traced(parts, &[&PATH[..], &own, &[stage]].concat()));
    [begin, extend, shade, [batch, queues, plan].concat(), connect]
}

/// The kernel of the chains of Metropolis light transport.
pub fn chains(parts: Parts) -> String {
    let constants = subpaths(true, true, 1);
    let records = [chains::Batch::TEXT, chains::Splat::TEXT];
    let own = [&constants, SENSOR, include_str!("../shaders/metropolis.wgsl")];
    traced(parts, &[&SUBPATHS[..], &records, &own].concat())
}

/// What subpaths are made for: whether there are camera paths, whether light paths are connected to
/// anything, and how many vertices of them are kept.
fn subpaths(has_camera_paths: bool, are_connected: bool, most_vertices: u32) -> String {
    format!(
        "const HAS_CAMERA_PATHS = {has_camera_paths};\nconst ARE_CONNECTED = {are_connected};\n\
        const MOST_VERTICES = {most_vertices}u;\n"
    )
}

/// The kernel that finds the light of a real-time frame by an algorithm; but for direct light at
/// the first surface where reservoirs have that.
pub fn light(algorithm: &Algorithm, parts: Parts, has_reservoirs: bool) -> String {
    let reservoirs = if has_reservoirs { "const HAS_RESERVOIRS = true;\n" } else { NO_RESERVOIRS };
    let light = include_str!("../shaders/realtime/light.wgsl");
    let radiance = radiance(algorithm, parts);
    let own = [RANDOM_NUMBERS, reservoirs, &radiance, CAMERA_HIT, SENSOR, light];
    traced(parts, &[&FRAME[..], &own].concat())
}

/// The kernels of reservoirs: the first samples of a frame, and their reuse.
pub fn reservoirs(parts: Parts) -> [String; 2] {
    let own = [RANDOM_NUMBERS, SENSOR, Reuse::TEXT, include_str!("../shaders/realtime/reservoirs.wgsl")];
    let texts = plumbing! { "realtime/candidates" "realtime/reuse" };
    texts.map(|text| traced(parts, &[&FRAME[..], &own, &[text]].concat()))
}

/// The kernel that finds what is seen in a real-time frame by an algorithm.
pub fn surfaces(algorithm: &Algorithm, parts: Parts) -> String {
    // Of ambient occlusion light does not depend on the reflectance.
    let is_reflected = !matches!(algorithm, Algorithm::AmbientOcclusion(..));
    let constant = format!("const IS_REFLECTED = {is_reflected};\n");
    let surfaces = include_str!("../shaders/realtime/surfaces.wgsl");
    traced(parts, &[&FRAME[..], &[RANDOM_NUMBERS, &constant, CAMERA_HIT, surfaces]].concat())
}

/// The kernels that make a picture of the light of a real-time frame, in the order in which they
/// run: they reproject the frames before, find variances, filter, and develop.
pub fn filters() -> [String; 4] {
    let texts = plumbing! { "realtime/temporal" "realtime/variance" "realtime/wavelet" "realtime/develop" };
    texts.map(|text| [&FRAME[..], &[Level::TEXT, text]].concat().concat())
}

/// The function `radiance` of an algorithm, or the whole of one whose paths begin at lights, which
/// is not for real-time frames.
fn radiance(algorithm: &Algorithm, parts: Parts) -> Cow<'static, str> {
    let text = match algorithm {
        Algorithm::RayCasting => include_str!("../shaders/ray_casting.wgsl"),
        Algorithm::Whitted(desc) => {
            let (rays, has_ambient) = (desc.max_depth + 1, desc.ambient);
            let constants = format!("const MAX_RAYS = {rays}u;\nconst HAS_AMBIENT = {has_ambient};\n");
            return (constants + include_str!("../shaders/whitted.wgsl")).into();
        }
        Algorithm::AmbientOcclusion(..) => include_str!("../shaders/ambient_occlusion.wgsl"),
        Algorithm::SimplePath(_) | Algorithm::RandomWalk(_) => include_str!("../shaders/simple_path.wgsl"),
        Algorithm::Path(_) | Algorithm::VolPath(_) | Algorithm::SimpleVolPath(_) => {
            let in_media = parts.media && !matches!(algorithm, Algorithm::Path(_));
            return [&PATH[..], if in_media { &IN_MEDIA } else { &IN_VACUUM }].concat().concat().into();
        }
        Algorithm::LightTracing(_) | Algorithm::Bdpt(_) => include_str!("../shaders/bidirectional.wgsl"),
        Algorithm::Mlt(..) => include_str!("../shaders/seen.wgsl"),
        Algorithm::Sppm(..) => include_str!("../shaders/photons.wgsl"),
    };
    text.into()
}

/// A kernel that traces rays through a scene.
fn traced(parts: Parts, texts: &[&str]) -> String {
    let surfaces = if parts.principled {
        self::principled() + include_str!("../shaders/openpbr_material.wgsl")
    } else {
        include_str!("../shaders/openpbr_none.wgsl").to_owned()
    };
    let (head, rays) =
        if parts.ray_queries { (ENABLE_RAY_QUERIES, [STRUCTURE, RAY_QUERY]) } else { ("", [NODES, TRACE]) };
    let declared = tags() + Head::TEXT + PixelSample::TEXT + &parts.text() + &bxdfs::text(parts);
    head.to_owned() + &with_laws(&[&[&*declared, MEASURED, &surfaces], &PLUMBING[..], &rays, texts].concat())
}

/// The text of files of `shaders/dynamic/`, after the plan that they share.
macro_rules! dynamic {
    ($($name:literal)*) => {
        [
            Plan::TEXT,
            "@group(0) @binding(0) var<uniform> plan: Plan;\n",
            $(include_str!(concat!("../shaders/dynamic/", $name, ".wgsl"))),*
        ]
        .concat()
    };
}

/// The kernels that sort keys by a digit, in the order in which they run.
pub fn sort() -> [String; 3] {
    [dynamic! { "digit" "count" }, dynamic! { "digit" "scan" "sum" }, dynamic! { "digit" "scan" "scatter" }]
}

/// The kernel that moves spheres.
pub fn place_spheres() -> String {
    tags() + &dynamic! { "box" "middles" "place_spheres" }
}

/// The kernel that moves triangles.
pub fn place_triangles() -> String {
    dynamic! { "box" "middles" "place_triangles" }
}

/// The kernel that moves instances.
pub fn place_instances() -> String {
    Placement::TEXT.to_owned() + &dynamic! { "box" "place_instances" }
}

/// The kernels that build a tree, but for the sort after the first, with their names.
pub fn tree() -> [(&'static str, String); 7] {
    [
        ("codes", dynamic! { "box" "codes" }),
        ("split", dynamic! { "binary" "split" }),
        ("leaves", dynamic! { "box" "leaves" }),
        ("pyramid", dynamic! { "box" "pyramid" }),
        ("bounds", dynamic! { "box" "binary" "bounds" }),
        ("collapse", dynamic! { "box" "binary" "children" "collapse" }),
        ("quantise", dynamic! { "box" "binary" "children" "quantise" }),
    ]
}

/// The shaders of the raster pipeline, one module.
pub fn raster() -> String {
    let texts = plumbing! { "raster" "raster_surfaces" "raster_sky" "raster_water" "raster_sprites" };
    Eye::TEXT.to_owned() + &texts.join("\n")
}
