//! Extensions of glTF materials against closed forms: what a surface shows of a lamp.

use std::f32::consts::PI;

use crate::gltf::{close, seen};

/// A lamp of 2 cd/m² behind the camera, which smooth surfaces mirror.
const BEHIND: &str = r#"{"name": "at", "mesh": 0, "translation": [0, 0, 6], "scale": [1000, 1000, 1],
    "rotation": [0, 1, 0, 0]}"#;
const LAMP: &str = r#"{
    "emissiveFactor": [1, 1, 1], "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]},
    "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 2}}
}"#;
/// No reflection but that of other extensions.
const NO_SPECULAR: &str = r#""KHR_materials_specular": {"specularFactor": 0}"#;

/// A dielectric of this grey, roughness and extensions.
fn plastic(grey: f32, roughness: f32, extensions: &str) -> String {
    format!(
        r#"{{
        "pbrMetallicRoughness": {{
            "metallicFactor": 0, "roughnessFactor": {roughness}, "baseColorFactor": [{grey}, {grey}, {grey}, 1]
        }},
        "extensions": {{{extensions}}}
    }}"#
    )
}

/// The share of the light of a lamp all around that a surface reflects towards its normal.
fn reflectance(material: &str) -> [f32; 3] {
    let nodes = format!(r#"{BEHIND}, {{"name": "at", "mesh": 1}}"#);
    seen(&[LAMP, material], "", &nodes).map(|radiance| radiance / 2.0)
}

#[test]
fn indices_give_the_reflectance_of_fresnel() {
    for ior in [1.33_f32, 1.5, 2.0] {
        let material = plastic(0.0, 0.0, &format!(r#""KHR_materials_ior": {{"ior": {ior}}}"#));
        close(reflectance(&material), [((ior - 1.0) / (ior + 1.0)).powi(2); 3]);
    }
}

#[test]
fn specular_factors_and_colors_scale_reflectance() {
    let extension =
        r#""KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [1, 0.5, 0.25]}"#;
    close(reflectance(&plastic(0.0, 0.0, extension)), [0.02, 0.01, 0.005]);
}

#[test]
fn clear_coats_reflect_as_glass_of_their_weight() {
    let coat = format!(r#""KHR_materials_clearcoat": {{"clearcoatFactor": 0.75}}, {NO_SPECULAR}"#);
    close(reflectance(&plastic(0.0, 0.5, &coat)), [0.75 * 0.04; 3]);
}

#[test]
fn sheen_has_its_color_and_loses_no_light() {
    let sheen = |color: &str| {
        let fuzz = r#""sheenRoughnessFactor": 0.5, "sheenColorFactor""#;
        format!(r#""KHR_materials_sheen": {{{fuzz}: {color}}}, {NO_SPECULAR}"#)
    };
    let over_black = |color: &str| reflectance(&plastic(0.0, 0.5, &sheen(color)));
    let white = over_black("[1, 1, 1]");
    assert!(white[0] > 0.02 && white[0] < 0.5, "{white:?}");
    close(over_black("[0.25, 0.25, 0.25]"), white.map(|value| 0.25 * value));
    // What fibres scatter again has their colour again; the square of a spectrum has about the
    // square of its colour.
    let tinted = over_black("[1, 0.5, 0.25]");
    for (c, color) in [1.0, 0.5, 0.25_f32].into_iter().enumerate() {
        let (least, most) = (0.9 * color * color * white[c], 1.02 * color * white[c]);
        assert!((least..most).contains(&tinted[c]), "{tinted:?} of {white:?}");
    }
    close(reflectance(&plastic(1.0, 0.5, &sheen("[1, 1, 1]"))), [1.0; 3]);
}

#[test]
fn iridescence_is_the_interference_of_a_film() {
    // The index of the film is the root of that below, so that both of its sides reflect alike.
    let film = |wavelengths: f32| {
        let (ior, nanometres) = (1.5_f32.sqrt(), wavelengths * 545.0 / 1.5_f32.sqrt());
        let extension = format!(
            r#""KHR_materials_iridescence": {{
                "iridescenceFactor": 1, "iridescenceIor": {ior}, "iridescenceThicknessMaximum": {nanometres}
            }}"#
        );
        reflectance(&plastic(0.0, 0.0, &extension))
    };
    // A quarter of green light: nothing is left of it. Half of it: as without the film.
    let quarter = film(0.25);
    assert!(quarter[1] < 0.002 && quarter[0] > 2.0 * quarter[1], "{quarter:?}");
    let half = film(0.5);
    assert!((half[1] - 0.04).abs() < 0.002, "{half:?}");
}

#[test]
fn anisotropic_highlights_are_those_of_both_widths() {
    let metal = r#"{
        "pbrMetallicRoughness": {"metallicFactor": 1, "roughnessFactor": 0.2},
        "extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": 0.3}}
    }"#;
    let light = r#"{"type": "directional", "intensity": 3}"#;
    let (along, across) = (0.04 + (1.0 - 0.04) * 0.09_f32, 0.04_f32);
    // Light from 0.12 radians beside the normal: facets are turned by half of it.
    let (sin, cos) = 0.06_f32.sin_cos();
    for (quaternion, width) in [([0.0, sin], along), ([-sin, 0.0], across)] {
        let [x, y] = quaternion;
        let nodes = format!(
            r#"{{"name": "at", "mesh": 0}}, {{"name": "at", "rotation": [{x}, {y}, 0, {cos}],
            "extensions": {{"KHR_lights_punctual": {{"light": 0}}}}}}"#
        );
        // D G/4 of GGX, with facets that shadow light alone as it is seen along the normal.
        let slope = 0.06_f32.tan() / width;
        let facets = 1.0 / (PI * along * across * cos.powi(4) * (1.0 + slope * slope).powi(2));
        let lit = 2.0 / (1.0 + (1.0 + (width * 0.12_f32.tan()).powi(2)).sqrt());
        close(seen(&[metal], light, &nodes), [3.0 * facets * lit / 4.0; 3]);
    }
}

#[test]
fn dispersion_parts_the_edge_of_a_lamp() {
    let glass = |dispersion: f32| {
        let extensions = format!(
            r#""KHR_materials_transmission": {{"transmissionFactor": 1}},
            "KHR_materials_volume": {{"thicknessFactor": 1}},
            "KHR_materials_dispersion": {{"dispersion": {dispersion}}}"#
        );
        plastic(1.0, 0.0, &extensions)
    };
    // A slab 2 units thick, turned by 45° about y, displaces what is seen through it by 0.658 units
    // along −x for an index of 1.5. An Abbe number of 5 makes it 0.70 for blue and 0.64 for red.
    let (sin, cos) = (PI / 8.0).sin_cos();
    let half = 0.5_f32.sqrt();
    let through = |dispersion: f32, lamp_at: f32| {
        let nodes = format!(
            r#"{{"name": "at", "mesh": 0, "translation": [{lamp_at}, 0, -9], "scale": [10, 10, 1]}},
            {{"name": "at", "mesh": 1, "translation": [{half}, 0, {half}], "scale": [5, 5, 1],
                "rotation": [0, {sin}, 0, {cos}]}},
            {{"name": "at", "mesh": 1, "translation": [-{half}, 0, -{half}], "scale": [5, 5, 1],
                "rotation": [0, {cos}, 0, -{sin}]}}"#
        );
        seen(&[LAMP, &glass(dispersion)], "", &nodes)
    };
    let displaced = 2.0 * half * (1.0 - half / 1.75_f32.sqrt());
    let [red, _, blue] = through(4.0, -10.0 - displaced);
    assert!(blue > 1.2 && red < 0.2 * blue, "{red} {blue}");
    let [red, _, blue] = through(4.0, 10.0 - displaced);
    assert!(red > 1.2 && blue < 0.2 * red, "{red} {blue}");
    // Without it the edge is where it is for all colours.
    let [red, _, blue] = through(0.0, -10.0 - displaced);
    assert!((red - blue).abs() < 0.02 * blue && blue > 0.7 && blue < 1.1, "{red} {blue}");
}

#[test]
fn diffuse_transmission_shares_light_between_both_sides() {
    let leaf = plastic(
        0.8,
        1.0,
        &format!(
            r#""KHR_materials_diffuse_transmission": {{
                "diffuseTransmissionFactor": 0.5, "diffuseTransmissionColorFactor": [0.6, 0.6, 0.6]
            }}, {NO_SPECULAR}"#
        ),
    );
    let light = r#"{"type": "directional", "intensity": 3}"#;
    let lit = |rotation: &str| {
        let nodes = format!(
            r#"{{"name": "at", "mesh": 0}}, {{"name": "at", "rotation": {rotation},
            "extensions": {{"KHR_lights_punctual": {{"light": 0}}}}}}"#
        );
        seen(&[&leaf], light, &nodes)
    };
    close(lit("[0, 0, 0, 1]"), [0.5 * 0.8 * 3.0 / PI; 3]);
    close(lit("[0, 1, 0, 0]"), [0.5 * 0.6 * 3.0 / PI; 3]);
}
