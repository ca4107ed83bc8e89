//! Materials.

use std::collections::BTreeSet;

use description::{
    CoatedConductorDesc, CoatedDiffuseDesc, ConductorDesc, ConductorReflectance, FloatParameter, HairColor,
    LayersDesc, MaterialDesc, MaterialKind, OpenPbrDesc, Parameter, RoughnessDesc, SceneDesc,
    SubsurfaceScattering, UvImageDesc, WrapMode,
};
use image::ColorEncoding;
use scattering::SubsurfaceMethod;

use crate::files::Files;
use crate::names::Names;
use crate::statement::Statement;
use crate::text::Text;
use crate::textures::uv_lookup;

/// All materials, each with a name.
pub(crate) fn materials(
    desc: &SceneDesc,
    names: &Names,
    files: &mut Files,
    text: &mut Text,
    extensions: &mut BTreeSet<String>,
) {
    for (handle, material) in desc.materials.iter() {
        let MaterialDesc { name: _, kind, normal_map, displacement } = &material.value;
        let mut statement =
            Statement::named("MakeNamedMaterial", names.material(handle), kind.name()).target("material");
        write(&mut statement, kind, names, files, extensions);
        if !matches!(kind, MaterialKind::Mix { .. } | MaterialKind::Interface) {
            if let Some(map) = normal_map {
                let names = ["normalmap", "normalmap_wrap", "normalmap_filter", "normalmap_columns"];
                write_normal_map(&mut statement, names, map, desc, files, extensions);
            } else {
                statement.optional_float_parameter("displacement", displacement.as_ref(), names);
            }
            if let MaterialKind::OpenPbr(surface) = kind
                && let Some(map) = &surface.geometry_coat_normal
            {
                let names = [
                    "geometry_coat_normal",
                    "geometry_coat_normal_wrap",
                    "geometry_coat_normal_filter",
                    "geometry_coat_normal_columns",
                ];
                write_normal_map(&mut statement, names, map, desc, files, extensions);
            }
        }
        text.statement(statement);
    }
}

fn write_normal_map(
    to: &mut Statement,
    [file, wrap, filter, columns]: [&str; 4],
    map: &UvImageDesc,
    desc: &SceneDesc,
    files: &mut Files,
    extensions: &mut BTreeSet<String>,
) {
    to.text(file, &files.image(&desc.images[map.image].image, ColorEncoding::Linear));
    uv_lookup(to, map, [wrap, filter, columns], WrapMode::Repeat, extensions);
}

fn write(
    to: &mut Statement,
    kind: &MaterialKind,
    names: &Names,
    files: &mut Files,
    extensions: &mut BTreeSet<String>,
) {
    match kind {
        MaterialKind::Diffuse { reflectance } => {
            to.spectrum_parameter("reflectance", reflectance, Some(0.5), names);
        }
        MaterialKind::DiffuseTransmission { reflectance, transmittance, scale } => {
            to.spectrum_parameter("reflectance", reflectance, Some(0.25), names);
            to.spectrum_parameter("transmittance", transmittance, Some(0.25), names);
            to.float("scale", *scale, 1.0);
        }
        MaterialKind::Conductor(conductor) => {
            reflectance(to, "", &conductor.reflectance, names);
            roughness(to, "", &conductor.roughness, names);
            remap(to, &[&conductor.roughness]);
        }
        MaterialKind::Dielectric { eta, roughness: rough } => {
            to.index_of_refraction("eta", eta, 1.5);
            roughness(to, "", rough, names);
            remap(to, &[rough]);
        }
        MaterialKind::ThinDielectric { eta } => to.index_of_refraction("eta", eta, 1.5),
        MaterialKind::CoatedDiffuse(CoatedDiffuseDesc {
            reflectance,
            eta,
            roughness: rough,
            layers: coat,
        }) => {
            to.spectrum_parameter("reflectance", reflectance, Some(0.5), names);
            to.index_of_refraction("eta", eta, 1.5);
            roughness(to, "", rough, names);
            remap(to, &[rough]);
            layers(to, coat, names);
        }
        MaterialKind::CoatedConductor(CoatedConductorDesc {
            conductor: ConductorDesc { reflectance: metal, roughness: rough },
            eta,
            roughness: coat,
            layers: inside,
        }) => {
            reflectance(to, "conductor.", metal, names);
            roughness(to, "conductor.", rough, names);
            to.index_of_refraction("interface.eta", eta, 1.5);
            roughness(to, "interface.", coat, names);
            remap(to, &[rough, coat]);
            layers(to, inside, names);
        }
        MaterialKind::Hair { color, eta, beta_m, beta_n, alpha } => {
            match color {
                HairColor::SigmaA(sigma_a) => to.spectrum_parameter("sigma_a", sigma_a, None, names),
                HairColor::Reflectance(color) => to.spectrum_parameter("reflectance", color, None, names),
                HairColor::Melanin { eumelanin, pheomelanin } => {
                    to.optional_float_parameter("eumelanin", Some(eumelanin), names);
                    to.optional_float_parameter("pheomelanin", Some(pheomelanin), names);
                }
            }
            to.float_parameter("eta", eta, 1.55, names);
            to.float_parameter("beta_m", beta_m, 0.3, names);
            to.float_parameter("beta_n", beta_n, 0.3, names);
            to.float_parameter("alpha", alpha, 2.0, names);
        }
        MaterialKind::Subsurface { scattering, scale, eta, g, roughness: rough, method } => {
            match scattering {
                SubsurfaceScattering::Named(name) => to.text("name", name),
                SubsurfaceScattering::Coefficients { sigma_a, sigma_s } => {
                    to.spectrum_parameter("sigma_a", sigma_a, None, names);
                    to.spectrum_parameter("sigma_s", sigma_s, None, names);
                }
                SubsurfaceScattering::Reflectance { reflectance, mfp } => {
                    to.spectrum_parameter("reflectance", reflectance, None, names);
                    to.spectrum_parameter("mfp", mfp, Some(1.0), names);
                }
            }
            to.float("scale", *scale, 1.0);
            to.float("eta", *eta, 1.33);
            to.float("g", *g, 0.0);
            roughness(to, "", rough, names);
            remap(to, &[rough]);
            match method {
                SubsurfaceMethod::Diffusion => (),
                SubsurfaceMethod::RandomWalk => {
                    extensions.insert("material subsurface method".into());
                    to.text("method", "random-walk");
                }
            }
        }
        MaterialKind::Measured { table } => {
            if table.data().wavelengths.is_none() {
                extensions.insert("material measured in red, green and blue".into());
            }
            to.text("filename", &files.measured(table));
        }
        MaterialKind::OpenPbr(surface) => {
            extensions.insert("material openpbr".into());
            openpbr(to, surface, names);
        }
        MaterialKind::Mix { materials, amount } => {
            to.texts("materials", materials.iter().map(|&material| names.material(material)));
            to.float_parameter("amount", amount, 0.5, names);
        }
        MaterialKind::Interface => (),
    }
}

/// Roughness, whose parameters have `prefix` before their names.
fn roughness(to: &mut Statement, prefix: &str, roughness: &RoughnessDesc, names: &Names) {
    let RoughnessDesc { u, v, remap: _ } = roughness;
    if u == v {
        to.float_parameter(&format!("{prefix}roughness"), u, 0.0, names);
    } else {
        to.float_parameter(&format!("{prefix}uroughness"), u, 0.0, names);
        to.float_parameter(&format!("{prefix}vroughness"), v, 0.0, names);
    }
}

/// Whether roughness is perceptual: one parameter for all interfaces. It does not matter for smooth
/// ones.
fn remap(to: &mut Statement, interfaces: &[&RoughnessDesc]) {
    let is_smooth = |value: &FloatParameter| *value == Parameter::Value(0.0);
    let mut rough = interfaces.iter().filter(|rough| !is_smooth(&rough.u) || !is_smooth(&rough.v));
    let chosen = rough.next().or(interfaces.first()).is_none_or(|rough| rough.remap);
    if rough.any(|other| other.remap != chosen) {
        to.fail("`remaproughness` differs between its interfaces");
    }
    to.flag("remaproughness", chosen, true);
}

fn reflectance(to: &mut Statement, prefix: &str, reflectance: &ConductorReflectance, names: &Names) {
    match reflectance {
        ConductorReflectance::Index { eta, k } => {
            to.spectrum_parameter(&format!("{prefix}eta"), eta, None, names);
            to.spectrum_parameter(&format!("{prefix}k"), k, None, names);
        }
        ConductorReflectance::Reflectance(color) => to.spectrum_parameter("reflectance", color, None, names),
    }
}

fn layers(to: &mut Statement, layers: &LayersDesc, names: &Names) {
    let LayersDesc { thickness, albedo, g, max_depth, samples } = layers;
    to.float_parameter("thickness", thickness, 0.01, names);
    to.spectrum_parameter("albedo", albedo, Some(0.0), names);
    to.float_parameter("g", g, 0.0, names);
    to.integer("maxdepth", *max_depth, 10);
    to.integer("nsamples", *samples, 1);
}

fn openpbr(to: &mut Statement, surface: &OpenPbrDesc, names: &Names) {
    let OpenPbrDesc {
        numbers,
        colors,
        emission_luminance,
        emission_color,
        subsurface_radius_scale,
        geometry_coat_normal: _,
        thin_walled,
    } = surface;
    for (value, number) in numbers.iter().zip(OpenPbrDesc::NUMBERS) {
        to.float_parameter(number.name, value, number.default, names);
    }
    for (value, (name, default)) in colors.iter().zip(OpenPbrDesc::COLORS) {
        to.spectrum_parameter(name, value, Some(default), names);
    }
    if surface.scatters_under() {
        to.spectrum_parameter("subsurface_radius_scale", subsurface_radius_scale, None, names);
    }
    to.float("emission_luminance", *emission_luminance, 0.0);
    to.white_or("emission_color", emission_color);
    to.flag("geometry_thin_walled", *thin_walled, false);
}
