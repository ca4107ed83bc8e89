//! Dispatch over BxDFs: the functions of shaders that choose one by the tag of the material.

use crate::parts::Parts;
use crate::tags::MaterialTag;

/// Whether kernels with some parts have what scatters at a material, the name of that, whose
/// functions are those of a law, and the expression of it for a `bsdf`.
fn bxdf(tag: MaterialTag, parts: Parts) -> Option<(bool, &'static str, &'static str)> {
    let Parts { facets, coats, principled, hair, measured, subsurface, .. } = parts;
    Some(match tag {
        MaterialTag::Diffuse => (true, "Diffuse", "bsdf.diffuse"),
        MaterialTag::DiffuseTransmission => (true, "DiffuseTransmission", "bsdf.translucent"),
        MaterialTag::Conductor => (facets, "Conductor", "bsdf.metal"),
        // One function, because drivers inline all calls.
        MaterialTag::Dielectric | MaterialTag::Boundary => (facets, "Boundary", "bsdf"),
        MaterialTag::ThinDielectric => (facets, "ThinDielectric", "ThinDielectric(bsdf.eta)"),
        MaterialTag::CoatedDiffuse => (coats, "Layered_Diffuse", "coated_diffuse(bsdf)"),
        MaterialTag::CoatedConductor => (coats, "Layered_Conductor", "coated_conductor(bsdf)"),
        MaterialTag::Principled => (principled, "OpenPbr", "bsdf.surface"),
        MaterialTag::Hair => (hair, "Hair", "bsdf.fibre"),
        MaterialTag::Measured => (measured, "Measured", "bsdf.measured"),
        MaterialTag::Subsurface => (subsurface, "Body", "bsdf"),
        MaterialTag::Exit => (subsurface, "Exit", "bsdf"),
        // One of two others is chosen before, and paths go on.
        MaterialTag::Mix | MaterialTag::Interface => return None,
    })
}

/// The functions of a `bsdf`, in its frame, for kernels with these parts.
pub fn text(parts: Parts) -> String {
    // Of what one thing scatters, the condition is that of all tags together.
    let mut arms: Vec<(String, &str, &str)> = Vec::new();
    for tag in MaterialTag::ALL {
        let Some((true, name, value)) = bxdf(*tag, parts) else { continue };
        let condition = format!("bsdf.kind == MaterialTag_{tag:?}");
        match arms.iter_mut().find(|(_, known, _)| *known == name) {
            Some((conditions, ..)) => *conditions += &format!(" || {condition}"),
            None => arms.push((condition, name, value)),
        }
    }
    let function = |name: &str, parameters: &str, result: &str, arguments: &str| {
        let arm = |(condition, law, value): &(String, &str, &str)| {
            format!("if ({condition}) {{ found = {law}_{name}({value}{arguments}); }}\n")
        };
        let arms: Vec<String> = arms.iter().map(arm).collect();
        let body = arms.join("else ");
        format!(
            "fn bxdf_{name}(bsdf: Bsdf{parameters}) -> {result} {{\nvar found: {result};\n{body}return found;\n}}\n"
        )
    };
    [
        function("flags", "", "u32", ""),
        function("f", ", wo: vec3f, wi: vec3f", "vec4f", ", wo, wi, bsdf.mode"),
        function("pdf", ", wo: vec3f, wi: vec3f", "f32", ", wo, wi, bsdf.mode, Directions_All"),
        function(
            "sample_f",
            ", wo: vec3f, uc: f32, u: vec2f, directions: u32",
            "BsdfSample",
            ", wo, uc, u, bsdf.mode, directions",
        ),
    ]
    .concat()
}
