//! Materials.

use description::{
    Arena, Diagnostic, HairColor, Handle, MaterialDesc, MaterialKind, MaterialType, Spanned, SpectrumDesc,
    Substance, SubsurfaceScattering, UvImageDesc,
};

use super::Builder;
use super::reader::Reader;
use crate::read::statement::MaterialStatement;
use description::did_you_mean;

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
        surface = (displacement, reader.normal_map(&UvImageDesc::NORMALS));
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
    let material = MaterialType::named(&reader.kind.value);
    if material == Some(MaterialType::Measured) {
        return measured(reader);
    }
    let Some(mut kind) = material.and_then(MaterialKind::new) else {
        reader.unknown_type("material", "material", MaterialType::NAMES);
        return None;
    };
    reader.settings(&mut kind);
    match &mut kind {
        MaterialKind::Conductor(_) => refuse_both(reader, ["eta", "k"]),
        MaterialKind::CoatedConductor(_) => refuse_both(reader, ["conductor.eta", "conductor.k"]),
        MaterialKind::Hair { color, .. } => hair(reader, color),
        MaterialKind::Subsurface { scattering, .. } => subsurface(reader, scattering)?,
        MaterialKind::OpenPbr(surface) => {
            let color = reader.spectrum("emission_color");
            reader.note("white", "");
            surface.emission_color = color.unwrap_or(SpectrumDesc::Illuminant(reader.color_space));
            surface.geometry_coat_normal = reader.normal_map(&UvImageDesc::COAT_NORMALS);
        }
        MaterialKind::Mix { materials, .. } => *materials = mixed(reader)?,
        MaterialKind::Diffuse { .. }
        | MaterialKind::CoatedDiffuse(_)
        | MaterialKind::Dielectric { .. }
        | MaterialKind::ThinDielectric { .. }
        | MaterialKind::DiffuseTransmission { .. }
        | MaterialKind::Measured { .. }
        | MaterialKind::Interface => (),
    }
    Some(kind)
}

/// Reports a metal that has two reflectances.
fn refuse_both(reader: &mut Reader, [eta, k]: [&str; 2]) {
    if reader.has("reflectance") && (reader.has(eta) || reader.has(k)) {
        let message = format!("`reflectance` cannot be given together with `{eta}` and `{k}`");
        reader.refuse("reflectance", message);
    }
}

/// The older name of the reflectance, and hair of more than one colour.
fn hair(reader: &mut Reader, color: &mut HairColor) {
    if !reader.has("reflectance")
        && let Some(reflectance) = reader.optional_spectrum_parameter("color")
        && !matches!(color, HairColor::SigmaA(_))
    {
        *color = HairColor::Reflectance(reflectance);
    }
    let is_any = |names: [&str; 2]| names.into_iter().any(|name| reader.has(name));
    let given =
        [reader.has("sigma_a"), is_any(["reflectance", "color"]), is_any(["eumelanin", "pheomelanin"])];
    if given.into_iter().filter(|&given| given).count() > 1 {
        let message = "the colour of hair is given more than once: `sigma_a` takes precedence over `reflectance`, and that over melanin";
        let span = reader.span;
        reader.builder.report.warning("ignored", message, span);
    }
}

/// Checks that a substance exists, and that coefficients are complete.
fn subsurface(reader: &mut Reader, scattering: &SubsurfaceScattering) -> Option<()> {
    if let SubsurfaceScattering::Named(name) = scattering {
        let span = reader.place("name");
        return substance(reader, Spanned::new(name.clone(), span)).map(|_| ());
    }
    for [given, needed] in [["sigma_a", "sigma_s"], ["sigma_s", "sigma_a"]] {
        if reader.has(given) && !reader.has(needed) {
            reader.missing(needed);
            return None;
        }
    }
    Some(())
}

fn measured(reader: &mut Reader) -> Option<MaterialKind> {
    let file = reader.needed("filename", Reader::string)?;
    Some(MaterialKind::Measured { table: reader.builder.measured_file(&file)? })
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

/// The materials of a mix.
fn mixed(reader: &mut Reader) -> Option<[Handle<MaterialDesc>; 2]> {
    let names = reader.needed("materials", Reader::strings)?;
    let [first, second] = names.as_slice() else {
        reader.refuse("materials", format!("`materials` takes two names, not {}", names.len()));
        return None;
    };
    // Both are looked up before either failure counts, so that both are reported.
    let (first, second) = (reader.builder.named_material(first), reader.builder.named_material(second));
    Some([first?, second?])
}
