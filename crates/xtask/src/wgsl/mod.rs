//! `cargo xtask wgsl`: translates the laws that all engines share from Rust to WGSL.
//!
//! A law is written once, for numbers with lanes (`R: Real`); a GPU has one lane in each of its
//! threads. So `R` becomes `f32`, `R::Mask` `bool`, `R::Int` `u32`, a spectrum `vec4f`, a method a
//! function `Type_method`, and a tuple that a function returns a struct. Tuples, arrays of values,
//! closures and functions that take some are resolved by the translation.
//!
//! [`SOURCES`] lists the roots. What they use is translated, too, so that all of it must be in the
//! files listed; nothing else is. What is not worth a translation is [`BY_HAND`] in the prelude of
//! the shaders.
//!
//! The subset: structs, enums without data, constants; `let` with patterns, assignments, `if`,
//! `match` on enums and literals, `for` over ranges and arrays, `while`; operators, calls, methods
//! of the types in [`intrinsics`] and of the library. Anything else is an error.

mod body;
mod call;
mod expression;
mod intrinsics;
mod library;
mod names;
mod translator;
mod types;
mod value;
mod vectors;

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::path::Path;

use body::Body;
use library::Library;
use translator::{Request, Translator};

/// The files that hold laws, and the functions and methods of each that are wanted.
const SOURCES: &[(&str, &[&str])] = &[
    ("crates/lanes/src/function/mod.rs", &[]),
    ("crates/lanes/src/function/arc.rs", &["acos", "asin", "atan", "atan2"]),
    ("crates/lanes/src/function/circular.rs", &["sin_cos"]),
    ("crates/lanes/src/function/exponential.rs", &["exp"]),
    ("crates/lanes/src/function/logarithm.rs", &["ln"]),
    ("crates/lanes/src/function/power.rs", &["coarse_inverse_sqrt", "powi"]),
    ("crates/math/src/vector.rs", &[]),
    ("crates/math/src/error.rs", &["offset_ray_origin"]),
    ("crates/math/src/ray.rs", &["Ray::at", "Ray::spawn", "Ray::between"]),
    ("crates/math/src/float.rs", &["difference_of_products", "sum_of_products", "smooth_step"]),
    (
        "crates/math/src/frame.rs",
        &["Frame::from_z", "Frame::from_z_and_x", "Frame::to_local", "Frame::from_local"],
    ),
    (
        "crates/math/src/octahedral.rs",
        &["equal_area_square_to_sphere", "equal_area_sphere_to_square", "wrap_equal_area_square"],
    ),
    ("crates/math/src/spherical.rs", &["spherical_direction", "spherical_phi", "face_forward"]),
    ("crates/spectrum/src/sampled.rs", &[]),
    (
        "crates/spectrum/src/wavelengths.rs",
        &[
            "SampledWavelengths::sample_uniform_in",
            "SampledWavelengths::sample_visible",
            "SampledWavelengths::terminate_secondary",
        ],
    ),
    ("crates/spectrum/src/uplift.rs", &[]),
    ("crates/spectrum/src/rgb_spectrum.rs", &["RgbAlbedoSpectrum::at", "RgbUnboundedSpectrum::at"]),
    ("crates/sampling/src/hash.rs", &[]),
    ("crates/sampling/src/hash_sequence.rs", &["HashSequence::get_1d", "HashSequence::get_2d"]),
    ("crates/sampling/src/sampler/address.rs", &["Address::skip", "interleaved"]),
    ("crates/sampling/src/sampler/independent.rs", &["Independent::at_1d", "Independent::at_2d"]),
    ("crates/sampling/src/sampler/randomize.rs", &[]),
    ("crates/sampling/src/low_discrepancy/sobol.rs", &[]),
    ("crates/sampling/src/sampler/zsobol.rs", &["ZSobol::at_1d", "ZSobol::at_2d", "permuted", "hash_above"]),
    ("crates/sampling/src/warp/disk.rs", &["sample_uniform_disk_polar", "sample_uniform_disk_concentric"]),
    ("crates/sampling/src/warp/interval.rs", &["sample_linear", "linear_pdf", "sample_tent"]),
    (
        "crates/sampling/src/warp/sphere.rs",
        &[
            "sample_uniform_sphere",
            "sample_uniform_hemisphere",
            "sample_cosine_hemisphere",
            "cosine_hemisphere_pdf",
            "sample_uniform_cone",
            "uniform_cone_pdf",
        ],
    ),
    ("crates/sampling/src/warp/square.rs", &["sample_bilinear", "bilinear_pdf"]),
    (
        "crates/sampling/src/warp/triangle.rs",
        &[
            "sample_uniform_triangle",
            "SphericalTriangle::new",
            "SphericalTriangle::is_valid",
            "SphericalTriangle::solid_angle",
            "SphericalTriangle::sample",
            "SphericalTriangle::pdf",
            "SphericalTriangle::invert",
        ],
    ),
    (
        "crates/sampling/src/warp/rectangle.rs",
        &[
            "SphericalRectangle::new",
            "SphericalRectangle::is_valid",
            "SphericalRectangle::pdf",
            "SphericalRectangle::sample",
            "SphericalRectangle::invert",
        ],
    ),
    ("crates/scattering/src/flags.rs", &[]),
    (
        "crates/scattering/src/fresnel.rs",
        &["reflect", "refract", "fr_dielectric", "fr_complex", "fr_conductor"],
    ),
    (
        "crates/scattering/src/microfacet.rs",
        &[
            "TrowbridgeReitz::roughness_to_alpha",
            "TrowbridgeReitz::regularize",
            "TrowbridgeReitz::new",
            "TrowbridgeReitz::g",
            "TrowbridgeReitz::sample_wm",
            "TrowbridgeReitz::pdf",
        ],
    ),
    ("crates/scattering/src/phase.rs", &["HenyeyGreenstein::p", "HenyeyGreenstein::sample_p"]),
    ("crates/scattering/src/bxdf/scatter.rs", &[]),
    ("crates/scattering/src/bxdf/diffuse.rs", &["Diffuse::f", "Diffuse::sample_f", "Diffuse::pdf"]),
    (
        "crates/scattering/src/bxdf/diffuse_transmission.rs",
        &["DiffuseTransmission::f", "DiffuseTransmission::sample_f", "DiffuseTransmission::pdf"],
    ),
    ("crates/scattering/src/bxdf/conductor.rs", &["Conductor::f", "Conductor::sample_f", "Conductor::pdf"]),
    (
        "crates/scattering/src/bxdf/dielectric.rs",
        &["Dielectric::f", "Dielectric::sample_f", "Dielectric::pdf"],
    ),
    ("crates/scattering/src/bxdf/thin_dielectric.rs", &["ThinDielectric::sample_f"]),
    ("crates/scattering/src/bxdf/layered/closed.rs", &[]),
    ("crates/scattering/src/bxdf/layered/walk.rs", &[]),
    (
        "crates/scattering/src/bxdf/layered/mod.rs",
        &[
            "Layered<Diffuse>::flags",
            "Layered<Diffuse>::f",
            "Layered<Diffuse>::sample_f",
            "Layered<Diffuse>::pdf",
            "Layered<Conductor>::flags",
            "Layered<Conductor>::f",
            "Layered<Conductor>::sample_f",
            "Layered<Conductor>::pdf",
        ],
    ),
    (
        "crates/scattering/src/bxdf/hair.rs",
        &["Hair::new", "Hair::sigma_a_from_reflectance", "Hair::f", "Hair::sample_f", "Hair::pdf"],
    ),
    ("crates/sampling/src/piecewise_bilinear.rs", &[]),
    ("crates/scattering/src/bxdf/measured/table.rs", &[]),
    (
        "crates/scattering/src/bxdf/measured/mod.rs",
        &["Measured::new", "Measured::f", "Measured::sample_f", "Measured::pdf"],
    ),
    ("crates/scattering/src/interior.rs", &[]),
    ("crates/scattering/src/bxdf/openpbr/parameters.rs", &[]),
    ("crates/scattering/src/bxdf/openpbr/film.rs", &[]),
    ("crates/scattering/src/bxdf/openpbr/stack.rs", &[]),
    ("crates/scattering/src/bxdf/openpbr/table.rs", &[]),
    ("crates/scattering/src/bxdf/openpbr/fuzz.rs", &[]),
    ("crates/scattering/src/bxdf/openpbr/mirror.rs", &[]),
    ("crates/scattering/src/bxdf/openpbr/oren_nayar.rs", &[]),
    ("crates/scattering/src/bxdf/openpbr/shares.rs", &[]),
    ("crates/scattering/src/bxdf/openpbr/chances.rs", &[]),
    ("crates/scattering/src/bxdf/openpbr/coat.rs", &[]),
    ("crates/scattering/src/bxdf/openpbr/facets.rs", &[]),
    ("crates/scattering/src/bxdf/openpbr/glass.rs", &[]),
    ("crates/scattering/src/bxdf/openpbr/thin.rs", &[]),
    ("crates/scattering/src/bxdf/openpbr/under.rs", &[]),
    ("crates/scattering/src/bxdf/openpbr/value.rs", &[]),
    (
        "crates/scattering/src/bxdf/openpbr/mod.rs",
        &[
            "OpenPbr::new",
            "OpenPbr::flags",
            "OpenPbr::f",
            "OpenPbr::sample_f",
            "OpenPbr::pdf",
            "OpenPbr::regularize",
        ],
    ),
    ("crates/geometry/src/shape/sample.rs", &["ShapeSampleContext::spawn_ray"]),
    ("crates/geometry/src/flat_shape.rs", &["FlatShape::sample_from", "FlatShape::pdf_from"]),
    ("crates/scene/src/light_sampler/cluster.rs", &["Cluster::importance"]),
    ("crates/scene/src/camera/screen.rs", &[]),
    ("crates/scene/src/camera/perspective.rs", &["Perspective::ray"]),
    ("crates/scene/src/camera/orthographic.rs", &["Orthographic::ray"]),
    ("crates/scene/src/camera/minimum_differentials.rs", &["MinimumDifferentials::dp_dxy"]),
    ("crates/scene/src/footprint.rs", &["Footprint::new", "on_plane"]),
    ("crates/scene/src/material/dispersion.rs", &["cauchy"]),
    ("crates/scene/src/texture/mapping.rs", &[]),
    ("crates/scene/src/texture/checkerboard.rs", &["squares", "cubes"]),
    ("crates/scene/src/texture/bilerp.rs", &["weights"]),
    ("crates/scene/src/texture/noise.rs", &[]),
    ("crates/scene/src/texture/dots.rs", &["coverage"]),
    ("crates/scene/src/texture/fractal.rs", &["fbm", "turbulence", "windy"]),
    ("crates/scene/src/texture/marble.rs", &["Marble::place"]),
    ("crates/integrators/src/transport/direct.rs", &["power_heuristic", "sample_ambient"]),
];

/// Functions that the shaders have by hand. Drivers simplify sums as if they were exact, so that
/// rounding by adding and subtracting a large number is lost; tables are packed; loops are others
/// in vectors.
const BY_HAND: [&str; 18] = [
    "circular_reduce",
    "function_round",
    "MeasuredTable_between",
    "MeasuredTable_invert_normal",
    "MeasuredTable_is_isotropic",
    "MeasuredTable_luminance_pdf",
    "MeasuredTable_ndf",
    "MeasuredTable_sample_luminance",
    "MeasuredTable_sample_normal",
    "MeasuredTable_sigma",
    "MeasuredTable_values",
    "noise_permuted",
    "OpenPbrTable_has_film",
    "OpenPbrTable_inside",
    "OpenPbrTable_locate",
    "OpenPbrTable_means",
    "OpenPbrTable_taken",
    "ZSobol_point",
];

/// Types that are records among the tables of a scene, of which shaders have the offsets.
const RECORDS: [&str; 2] = ["MeasuredTable", "OpenPbrTable"];

/// Where the translations are.
pub const FOLDER: &str = "crates/gpu/shaders/law";

/// Translates everything and writes the files into the workspace at `root`.
pub fn run(root: &Path) -> Result<(), String> {
    let read =
        |path: &str| std::fs::read_to_string(root.join(path)).map_err(|error| format!("{path}: {error}"));
    let files = generate(read)?;
    let folder = root.join(FOLDER);
    let write = || {
        std::fs::remove_dir_all(&folder)?;
        std::fs::create_dir_all(&folder)?;
        files.iter().try_for_each(|(path, text)| std::fs::write(root.join(path), text))
    };
    write().map_err(|error: std::io::Error| format!("{}: {error}", folder.display()))?;
    println!("{} files in {FOLDER}", files.len());
    Ok(())
}

/// The translations by their paths, given what reads a source.
pub fn generate(read: impl Fn(&str) -> Result<String, String>) -> Result<BTreeMap<String, String>, String> {
    let mut library = Library::default();
    for (path, _) in SOURCES {
        library.add(stem(path), &read(path)?).map_err(|error| format!("{path}: {error}"))?;
    }
    let mut translator = Translator::new(&library);
    for (source, (_, roots)) in SOURCES.iter().enumerate() {
        roots.iter().try_for_each(|root| translator.root(source, root))?;
    }
    translate(&mut translator)?;
    let mut files = BTreeMap::new();
    let mut add = |name: &str, origin: &str, items: Vec<&str>| {
        if !items.is_empty() {
            let text = format!(
                "// {origin}\n// by `cargo xtask wgsl`, which translates it again.\n\n{}",
                items.join("\n")
            );
            files.insert(format!("{FOLDER}/{name}.wgsl"), text);
        }
    };
    add("tuples", "Made", translator.tuples().collect());
    for (source, (path, _)) in SOURCES.iter().enumerate() {
        add(stem(path), &format!("Translated from {path}"), translator.items(source).collect());
    }
    Ok(files)
}

/// Translates all that is requested, and what that requests.
fn translate(translator: &mut Translator) -> Result<(), String> {
    let library = translator.library;
    while let Some(request) = translator.next() {
        let (source, order, name, text) = match request {
            Request::Function { index, owner, name } => {
                let function = &library.functions[index];
                let text = Body::function(translator, function, owner, &name);
                (function.source, function.order, name, text)
            }
            Request::Constant { index, owner, name, ty } => {
                let constant = &library.constants[index];
                let text = Body::constant(translator, constant, owner, &name, &ty);
                (constant.source, constant.order, name, text)
            }
        };
        let text = text.map_err(|error| format!("{}: {name}: {error}", library.stems[source]))?;
        translator.add(source, order, name, text);
    }
    Ok(())
}

/// The name of a file without folder and ending; that of its folder where it is the folder's.
fn stem(path: &str) -> &str {
    let path = path.strip_suffix("/mod.rs").unwrap_or(path.trim_end_matches(".rs"));
    path.rsplit('/').next().unwrap_or(path)
}
