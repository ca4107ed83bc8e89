//! Materials.

use description::{
    Arena, CoatedConductorDesc, CoatedDiffuseDesc, ConductorDesc, ConductorReflectance, Diagnostic,
    FloatParameter, HairColor, Handle, LayersDesc, MaterialDesc, MaterialKind, MaterialType, OpenPbrDesc,
    RoughnessDesc, Spanned, SpectrumDesc, Substance, SubsurfaceScattering,
};
use scattering::SubsurfaceMethod;

use super::Builder;
use super::reader::Reader;
use crate::pbrt::statement::MaterialStatement;
use crate::suggest::did_you_mean;

impl Builder<'_> {
    /// Builds all materials; one that cannot be read is replaced by the format's default.
    pub(super) fn materials(&mut self, statements: Vec<MaterialStatement>) -> Arena<MaterialDesc> {
        let mut materials = Arena::default();
        for MaterialStatement { statement, name } in statements {
            let mut stated = self.read_or_default(statement, material);
            stated.name = name.map_or(String::new(), |name| name.value);
            materials.push_stated(stated);
        }
        self.break_cycles(&mut materials);
        materials
    }

    /// Reports mixes that contain themselves.
    fn break_cycles(&mut self, materials: &mut Arena<MaterialDesc>) {
        // 0: not visited; 1: on the current path of the search; 2: free of cycles.
        let mut states = vec![0_u8; materials.len()];
        for start in 0..materials.len() {
            let mut stack = vec![(Handle::<MaterialDesc>::new(start as u32), 0_usize)];
            while let Some(&mut (handle, ref mut next)) = stack.last_mut() {
                let children = match &materials[handle].kind {
                    MaterialKind::Mix { materials, .. } => *materials,
                    _ => {
                        states[handle.index()] = 2;
                        stack.pop();
                        continue;
                    }
                };
                states[handle.index()] = states[handle.index()].max(1);
                if *next == 2 || states[handle.index()] == 2 {
                    states[handle.index()] = 2;
                    stack.pop();
                    continue;
                }
                let child = children[*next];
                *next += 1;
                match states[child.index()] {
                    0 => stack.push((child, 0)),
                    1 => {
                        let message = "this mix of materials contains itself";
                        let span = materials.origin(handle).parameter("materials");
                        self.report.error("material-cycle", message, span);
                        materials[handle].kind = MaterialDesc::default().kind;
                    }
                    _ => (),
                }
            }
        }
    }
}

fn material(reader: &mut Reader) -> Option<MaterialDesc> {
    let mut surface = (None, None);
    if !matches!(reader.kind.value.as_str(), "mix" | "interface" | "" | "none") {
        let displacement = reader.optional_float_parameter("displacement");
        let names = ["normalmap", "normalmap_wrap", "normalmap_filter", "normalmap_columns"];
        surface = (displacement, reader.normal_map(names));
    }
    let mut desc = MaterialDesc::from(kind(reader)?);
    (desc.displacement, desc.normal_map) = surface;
    if desc.normal_map.is_some() && desc.displacement.is_some() {
        reader.ignored("displacement", "`displacement` has no effect beside `normalmap`");
        desc.displacement = None;
    }
    Some(desc)
}

fn kind(reader: &mut Reader) -> Option<MaterialKind> {
    if matches!(reader.kind.value.as_str(), "" | "none") {
        let span = reader.kind.span;
        reader.builder.report.warning("deprecated", "this material is now called `interface`", span);
        return Some(MaterialKind::Interface);
    }
    let Some(material) = MaterialType::named(&reader.kind.value) else {
        reader.unknown_type("material", "material", MaterialType::NAMES);
        return None;
    };
    Some(match material {
        MaterialType::Diffuse => {
            MaterialKind::Diffuse { reflectance: reader.spectrum_parameter("reflectance", 0.5) }
        }
        MaterialType::DiffuseTransmission => MaterialKind::DiffuseTransmission {
            reflectance: reader.spectrum_parameter("reflectance", 0.25),
            transmittance: reader.spectrum_parameter("transmittance", 0.25),
            scale: reader.float("scale", 1.0),
        },
        MaterialType::Conductor => MaterialKind::Conductor(ConductorDesc {
            reflectance: conductor_reflectance(reader, ["eta", "k"]),
            roughness: roughness(reader, ["roughness", "uroughness", "vroughness"]),
        }),
        MaterialType::Dielectric => MaterialKind::Dielectric {
            eta: reader.index_of_refraction("eta", 1.5),
            roughness: roughness(reader, ["roughness", "uroughness", "vroughness"]),
        },
        MaterialType::ThinDielectric => {
            MaterialKind::ThinDielectric { eta: reader.index_of_refraction("eta", 1.5) }
        }
        MaterialType::CoatedDiffuse => MaterialKind::CoatedDiffuse(CoatedDiffuseDesc {
            reflectance: reader.spectrum_parameter("reflectance", 0.5),
            eta: reader.index_of_refraction("eta", 1.5),
            roughness: roughness(reader, ["roughness", "uroughness", "vroughness"]),
            layers: layers(reader),
        }),
        MaterialType::CoatedConductor => coated_conductor(reader),
        MaterialType::Hair => hair(reader),
        MaterialType::Subsurface => subsurface(reader)?,
        MaterialType::Measured => {
            let Some(file) = reader.string("filename") else {
                reader.missing("filename");
                return None;
            };
            MaterialKind::Measured { table: reader.builder.measured_file(&file)? }
        }
        MaterialType::OpenPbr => MaterialKind::OpenPbr(Box::new(openpbr(reader))),
        MaterialType::Mix => mix(reader)?,
        MaterialType::Interface => MaterialKind::Interface,
    })
}

/// Roughness under the names of (both, u, v).
fn roughness(reader: &mut Reader, names: [&'static str; 3]) -> RoughnessDesc {
    let [u, v] = roughness_axes(reader, names);
    RoughnessDesc { u, v, remap: reader.boolean("remaproughness", true) }
}

fn roughness_axes(reader: &mut Reader, [both, u, v]: [&'static str; 3]) -> [FloatParameter; 2] {
    let both = reader.float_parameter(both, 0.0);
    [u, v].map(|name| reader.optional_float_parameter(name).unwrap_or(both.clone()))
}

/// One `remaproughness` is that of both surfaces.
fn coated_conductor(reader: &mut Reader) -> MaterialKind {
    let names = ["conductor.roughness", "conductor.uroughness", "conductor.vroughness"];
    let conductor = ConductorDesc {
        reflectance: conductor_reflectance(reader, ["conductor.eta", "conductor.k"]),
        roughness: roughness(reader, names),
    };
    let eta = reader.index_of_refraction("interface.eta", 1.5);
    let names = ["interface.roughness", "interface.uroughness", "interface.vroughness"];
    let [u, v] = roughness_axes(reader, names);
    let roughness = RoughnessDesc { u, v, remap: conductor.roughness.remap };
    MaterialKind::CoatedConductor(CoatedConductorDesc { conductor, eta, roughness, layers: layers(reader) })
}

fn conductor_reflectance(reader: &mut Reader, [eta, k]: [&'static str; 2]) -> ConductorReflectance {
    let index = [reader.optional_spectrum_parameter(eta), reader.optional_spectrum_parameter(k)];
    if let Some(reflectance) = reader.optional_spectrum_parameter("reflectance") {
        if index.iter().any(Option::is_some) {
            let message = format!("`reflectance` cannot be given together with `{eta}` and `{k}`");
            reader.refuse("reflectance", message);
        }
        return ConductorReflectance::Reflectance(reflectance);
    }
    let [eta, k] = index;
    let copper = |part: &str| SpectrumDesc::Named(format!("metal-Cu-{part}")).into();
    ConductorReflectance::Index {
        eta: eta.unwrap_or_else(|| copper("eta")),
        k: k.unwrap_or_else(|| copper("k")),
    }
}

fn layers(reader: &mut Reader) -> LayersDesc {
    let default = LayersDesc::default();
    LayersDesc {
        thickness: reader.float_parameter("thickness", 0.01),
        albedo: reader.spectrum_parameter("albedo", 0.0),
        g: reader.float_parameter("g", 0.0),
        max_depth: reader.integer("maxdepth", default.max_depth, 1..=i32::MAX),
        samples: reader.integer("nsamples", default.samples, 1..=i32::MAX),
    }
}

fn hair(reader: &mut Reader) -> MaterialKind {
    let sigma_a = reader.optional_spectrum_parameter("sigma_a");
    let mut reflectance = reader.optional_spectrum_parameter("reflectance");
    if reflectance.is_none() {
        reflectance = reader.optional_spectrum_parameter("color");
    }
    let eumelanin = reader.optional_float_parameter("eumelanin");
    let pheomelanin = reader.optional_float_parameter("pheomelanin");
    let melanin = eumelanin.is_some() || pheomelanin.is_some();
    let given = [sigma_a.is_some(), reflectance.is_some(), melanin];
    if given.into_iter().filter(|&given| given).count() > 1 {
        let message = "the colour of hair is given more than once: `sigma_a` takes precedence over `reflectance`, and that over melanin";
        let span = reader.span;
        reader.builder.report.warning("ignored", message, span);
    }
    let color = match (sigma_a, reflectance) {
        (Some(sigma_a), _) => HairColor::SigmaA(sigma_a),
        (None, Some(reflectance)) => HairColor::Reflectance(reflectance),
        (None, None) => HairColor::Melanin {
            eumelanin: eumelanin.unwrap_or(FloatParameter::Value(if melanin { 0.0 } else { 1.3 })),
            pheomelanin: pheomelanin.unwrap_or(FloatParameter::Value(0.0)),
        },
    };
    MaterialKind::Hair {
        color,
        eta: reader.float_parameter("eta", 1.55),
        beta_m: reader.float_parameter("beta_m", 0.3),
        beta_n: reader.float_parameter("beta_n", 0.3),
        alpha: reader.float_parameter("alpha", 2.0),
    }
}

fn subsurface(reader: &mut Reader) -> Option<MaterialKind> {
    use SubsurfaceMethod::{Diffusion, RandomWalk};
    let name = reader.string("name");
    let sigma_a = reader.optional_spectrum_parameter("sigma_a");
    let sigma_s = reader.optional_spectrum_parameter("sigma_s");
    let reflectance = reader.optional_spectrum_parameter("reflectance");
    let mfp = reader.optional_spectrum_parameter("mfp");
    let scattering = match (name, sigma_a, sigma_s, reflectance) {
        (Some(name), ..) => SubsurfaceScattering::Named(substance(reader, name)?),
        (None, Some(sigma_a), Some(sigma_s), _) => SubsurfaceScattering::Coefficients { sigma_a, sigma_s },
        (None, Some(_), None, _) => {
            reader.missing("sigma_s");
            return None;
        }
        (None, None, Some(_), _) => {
            reader.missing("sigma_a");
            return None;
        }
        (None, None, None, Some(reflectance)) => {
            SubsurfaceScattering::Reflectance { reflectance, mfp: mfp.unwrap_or(1.0.into()) }
        }
        // Whole milk [Jensen 2001].
        (None, None, None, None) => SubsurfaceScattering::Coefficients {
            sigma_a: SpectrumDesc::rgb(0.0011, 0.0024, 0.014).into(),
            sigma_s: SpectrumDesc::rgb(2.55, 3.21, 3.77).into(),
        },
    };
    Some(MaterialKind::Subsurface {
        scattering,
        scale: reader.float("scale", 1.0),
        eta: reader.float("eta", 1.33),
        g: reader.float("g", 0.0),
        roughness: roughness(reader, ["roughness", "uroughness", "vroughness"]),
        method: reader.choice("method", Diffusion, &[("diffusion", Diffusion), ("random-walk", RandomWalk)]),
    })
}

fn openpbr(reader: &mut Reader) -> OpenPbrDesc {
    let numbers = OpenPbrDesc::NUMBERS.map(|number| reader.float_parameter(number.name, number.default));
    let colors = OpenPbrDesc::COLORS.map(|(name, default)| reader.spectrum_parameter(name, default));
    let emission_luminance = reader.float("emission_luminance", 0.0);
    let emission_color = reader.spectrum("emission_color");
    reader.note("white", "");
    let radius_scale = reader.optional_spectrum_parameter("subsurface_radius_scale");
    OpenPbrDesc {
        numbers,
        colors,
        subsurface_radius_scale: radius_scale.unwrap_or_else(|| SpectrumDesc::rgb(1.0, 0.5, 0.25).into()),
        geometry_coat_normal: reader.normal_map([
            "geometry_coat_normal",
            "geometry_coat_normal_wrap",
            "geometry_coat_normal_filter",
            "geometry_coat_normal_columns",
        ]),
        thin_walled: reader.boolean("geometry_thin_walled", false),
        emission_luminance,
        emission_color: emission_color.unwrap_or(SpectrumDesc::Illuminant(reader.color_space)),
    }
}

/// The name of a substance, checked.
pub(super) fn substance(reader: &mut Reader, name: Spanned<String>) -> Option<String> {
    if Substance::named(&name.value).is_some() {
        return Some(name.value);
    }
    let message = format!("there is no measured substance `{}`", name.value);
    reader.builder.report.push(Diagnostic {
        help: did_you_mean(&name.value, Substance::names()),
        ..Diagnostic::error("unknown-choice", message, name.span)
    });
    None
}

fn mix(reader: &mut Reader) -> Option<MaterialKind> {
    let amount = reader.float_parameter("amount", 0.5);
    let Some(names) = reader.strings("materials") else {
        reader.missing("materials");
        return None;
    };
    let [first, second] = names.as_slice() else {
        reader.refuse("materials", format!("`materials` takes two names, not {}", names.len()));
        return None;
    };
    // Both are looked up before either failure counts, so that both are reported.
    let (first, second) = (reader.builder.named_material(first), reader.builder.named_material(second));
    Some(MaterialKind::Mix { materials: [first?, second?], amount })
}
