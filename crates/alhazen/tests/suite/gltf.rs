//! Pictures of glTF scenes against closed forms, and of the samples of other authors.

use std::f32::consts::{FRAC_1_SQRT_2, PI};

use crate::common::{data, files_below};
use alhazen::assets::{Files, MemoryAssets};
use alhazen::import::import;
use alhazen::integrators::Control;
use alhazen::{Job, Overrides, render_file};

/// The mean red, green and blue of what an orthographic camera at z = 5 sees of 1/50 × 1/50 units
/// around the origin. `nodes` place the quadrilateral (±1, ±1, 0), whose tangent is along x. It is
/// mesh 0, 1, … with the material 0, 1, ….
pub fn seen(materials: &[&str], lights: &str, nodes: &str) -> [f32; 3] {
    let vertices = [[-1.0_f32, -1.0, 0.0], [1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    let coordinates = [[0.0_f32, 1.0], [1.0, 1.0], [0.0, 0.0], [1.0, 0.0]];
    let numbers = vertices.as_flattened().iter().chain(coordinates.as_flattened());
    let bytes: Vec<u8> = numbers.flat_map(|v| v.to_le_bytes()).collect();
    let meshes: Vec<_> = (0..materials.len())
        .map(|index| {
            format!(
                r#"{{"primitives": [{{
                    "attributes": {{"POSITION": 0, "TEXCOORD_0": 1}}, "mode": 5, "material": {index}
                }}]}}"#
            )
        })
        .collect();
    let count = nodes.matches("\"at\"").count();
    let roots: Vec<_> = (0..=count).map(|root| root.to_string()).collect();
    let text = format!(
        r#"{{
        "asset": {{"version": "2.0"}},
        "extensions": {{"KHR_lights_punctual": {{"lights": [{lights}]}}}},
        "buffers": [{{"uri": "a.bin", "byteLength": 80}}],
        "bufferViews": [
            {{"buffer": 0, "byteLength": 48}}, {{"buffer": 0, "byteOffset": 48, "byteLength": 32}}
        ],
        "accessors": [
            {{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}},
            {{"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"}}
        ],
        "materials": [{}],
        "meshes": [{}],
        "cameras": [{{"type": "orthographic", "orthographic": {{"xmag": 0.01, "ymag": 0.01}}}}],
        "nodes": [{{"camera": 0, "translation": [0, 0, 5]}}, {}],
        "scenes": [{{"nodes": [{}]}}]
        }}"#,
        materials.join(", "),
        meshes.join(", "),
        nodes,
        roots.join(", ")
    );
    let assets = MemoryAssets::default().with("a.gltf", text).with("a.bin", bytes);
    let small = Overrides { resolution: Some([16, 16]), samples_per_pixel: Some(64), ..Overrides::default() };
    let image = render_file("a.gltf", &assets, &small, &Control::default()).expect("a picture");
    let mut sum = [0.0; 3];
    for (x, y) in (0..16).flat_map(|y| (0..16).map(move |x| (x, y))) {
        for (sum, value) in sum.iter_mut().zip(image.rgb(x, y)) {
            *sum += value / 256.0;
        }
    }
    sum
}

pub fn close(found: [f32; 3], expected: [f32; 3]) {
    for (found_one, expected_one) in found.into_iter().zip(expected) {
        assert!((found_one - expected_one).abs() < 0.02 * expected_one + 1e-4, "{found:?}, not {expected:?}");
    }
}

/// A white surface that only scatters diffusely.
const WHITE: &str = r#"{
    "pbrMetallicRoughness": {"metallicFactor": 0},
    "extensions": {"KHR_materials_specular": {"specularFactor": 0}}
}"#;

#[test]
fn a_lamp_of_some_candela_gives_its_illuminance() {
    let point = r#"{"type": "point", "intensity": 10, "color": [1, 0.5, 0.25]}"#;
    let nodes = r#"{"name": "at", "mesh": 0}, {"name": "at", "translation": [0, 0, 2],
        "extensions": {"KHR_lights_punctual": {"light": 0}}}"#;
    // E = I/d², and L = E/π.
    let radiance = 10.0 / 4.0 / PI;
    close(seen(&[WHITE], point, nodes), [radiance, radiance / 2.0, radiance / 4.0]);
    let spot = r#"{"type": "spot", "intensity": 10, "spot": {"outerConeAngle": 0.5}}"#;
    close(seen(&[WHITE], spot, nodes), [radiance; 3]);
    let directional = r#"{"type": "directional", "intensity": 3}"#;
    close(seen(&[WHITE], directional, nodes), [3.0 / PI; 3]);
}

#[test]
fn emission_is_its_strength_in_candela_per_square_metre() {
    let lamp = r#"{
        "emissiveFactor": [1, 0.5, 0.25], "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]},
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4}}
    }"#;
    let front = r#"{"name": "at", "mesh": 0}"#;
    close(seen(&[lamp], "", front), [4.0, 2.0, 1.0]);
    let back = r#"{"name": "at", "mesh": 0, "rotation": [0, 1, 0, 0]}"#;
    assert!(seen(&[lamp], "", back)[0] < 0.1, "only the front emits");
    let unlit = r#"{
        "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 1]}, "extensions": {"KHR_materials_unlit": {}}
    }"#;
    close(seen(&[unlit], "", front), [0.5, 0.25, 1.0]);
}

/// A surface that reflects nothing.
fn black(is_double_sided: bool) -> String {
    format!(
        r#"{{
        "pbrMetallicRoughness": {{"metallicFactor": 0, "baseColorFactor": [0, 0, 0, 1]}},
        "extensions": {{"KHR_materials_specular": {{"specularFactor": 0}}}}, "doubleSided": {is_double_sided}
    }}"#
    )
}

const LAMP: &str = r#"{
    "emissiveFactor": [1, 1, 1], "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]},
    "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 2}}
}"#;

#[test]
fn the_camera_sees_through_the_backs_of_single_sided_surfaces() {
    // Before a lamp, by how the surface is turned and mirrored.
    for (placed, shows_front) in [
        (r#""scale": [1, 1, 1]"#, true),
        (r#""rotation": [0, 1, 0, 0]"#, false),
        // Mirrored surfaces turn their front to where the mirror has it.
        (r#""scale": [-1, 1, 1]"#, true),
        (r#""scale": [1, 1, -1]"#, false),
        (r#""scale": [-1, 1, 1], "rotation": [0, 1, 0, 0]"#, false),
    ] {
        let nodes = format!(
            r#"{{"name": "at", "mesh": 0}}, {{"name": "at", "mesh": 1, "translation": [0, 0, 1], {placed}}}"#
        );
        let found = seen(&[LAMP, &black(false)], "", &nodes);
        close(found, [if shows_front { 0.0 } else { 2.0 }; 3]);
        close(seen(&[LAMP, &black(true)], "", &nodes), [0.0; 3]);
    }
    // An emitter on its front is as invisible from behind.
    let nodes = r#"{"name": "at", "mesh": 0}, {"name": "at", "mesh": 0, "translation": [0, 0, 1],
        "rotation": [0, 1, 0, 0]}"#;
    close(seen(&[LAMP], "", nodes), [2.0; 3]);
}

#[test]
fn a_camera_in_a_closed_box_sees_what_is_outside_of_it() {
    // A box around the camera at z = 5, whose outside is its front, above a lit surface.
    let half = FRAC_1_SQRT_2;
    let turns = [
        [0.0, 0.0, 0.0, 1.0],
        [0.0, 1.0, 0.0, 0.0],
        [half, 0.0, 0.0, half],
        [-half, 0.0, 0.0, half],
        [0.0, half, 0.0, half],
        [0.0, -half, 0.0, half],
    ];
    let faces = turns.into_iter().map(|[x, y, z, w]| {
        // Where the turn takes +z.
        let n = [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)];
        let [a, b, c] = [n[0], n[1], 5.0 + n[2]];
        format!(
            r#", {{"name": "at", "mesh": 1, "translation": [{a}, {b}, {c}], "rotation": [{x}, {y}, {z}, {w}]}}"#
        )
    });
    let lit = r#"{"name": "at", "mesh": 0}, {"name": "at", "translation": [0, 0, 2],
        "extensions": {"KHR_lights_punctual": {"light": 0}}}"#;
    let nodes = lit.to_owned() + &faces.collect::<String>();
    let point = r#"{"type": "point", "intensity": 10}"#;
    close(seen(&[WHITE, &black(false)], point, &nodes), [10.0 / 4.0 / PI; 3]);
    close(seen(&[WHITE, &black(true)], point, &nodes), [0.0; 3]);
}

#[test]
fn what_the_camera_does_not_see_casts_shadows() {
    let nodes = |turn: &str| {
        format!(
            r#"{{"name": "at", "mesh": 0}}, {{"name": "at", "extensions": {{"KHR_lights_punctual": {{"light": 0}}}}}},
            {{"name": "at", "mesh": 1, "translation": [0, 0, 1] {turn}}}"#
        )
    };
    let sun = r#"{"type": "directional", "intensity": 3}"#;
    let turned = nodes(r#", "rotation": [0, 1, 0, 0]"#);
    close(seen(&[WHITE, &black(false)], sun, &turned), [0.0; 3]);
    // The sun is seen by the surface again where the other one is beside it.
    let aside = turned.replace("[0, 0, 1]", "[5, 0, 1]");
    close(seen(&[WHITE, &black(false)], sun, &aside), [3.0 / PI; 3]);
    close(seen(&[WHITE, &black(false)], sun, &nodes("")), [0.0; 3]);
}

#[test]
fn volumes_absorb_by_beers_law() {
    let lamp = r#"{
        "emissiveFactor": [1, 1, 1], "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]},
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 2}}
    }"#;
    // A slab of index 1, 1.5 units thick: half of the light is left after each unit.
    let glass = r#"{
        "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
        "extensions": {
            "KHR_materials_transmission": {"transmissionFactor": 1},
            "KHR_materials_ior": {"ior": 1},
            "KHR_materials_volume": {
                "thicknessFactor": 1, "attenuationDistance": 1, "attenuationColor": [0.5, 0.5, 0.5]
            }
        }
    }"#;
    let nodes = r#"{"name": "at", "mesh": 0, "translation": [0, 0, -2]},
        {"name": "at", "mesh": 1, "translation": [0, 0, 1.5]},
        {"name": "at", "mesh": 1, "rotation": [0, 1, 0, 0]}"#;
    close(seen(&[lamp, glass], "", nodes), [2.0 * 0.5_f32.powf(1.5); 3]);
}

/// A sheet of glass over a lamp of 2 cd/m².
fn sheet(roughness: f32, color: [f32; 3], nodes: &str) -> [f32; 3] {
    let lamp = r#"{
        "emissiveFactor": [1, 1, 1], "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]},
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 2}}
    }"#;
    let [r, g, b] = color;
    let glass = format!(
        r#"{{
        "pbrMetallicRoughness": {{
            "metallicFactor": 0, "roughnessFactor": {roughness}, "baseColorFactor": [{r}, {g}, {b}, 1]
        }},
        "extensions": {{"KHR_materials_transmission": {{"transmissionFactor": 1}}}}
    }}"#
    );
    seen(&[lamp, &glass], "", &format!(r#"{nodes}, {{"name": "at", "mesh": 1}}"#))
}

#[test]
fn thin_glass_transmits_what_its_sides_do_not_reflect() {
    // With the reflectance F of a side and the factor a of the crossing, a (1 − F)²/(1 − a² F²).
    let f = 0.04_f32;
    let color = [1.0, 0.5, 0.25];
    let expected = color.map(|a| 2.0 * a * (1.0 - f) * (1.0 - f) / (1.0 - a * a * f * f));
    close(sheet(0.0, color, r#"{"name": "at", "mesh": 0, "translation": [0, 0, -2]}"#), expected);
}

#[test]
fn rough_thin_glass_spreads_light_and_loses_none() {
    // In light that is the same from everywhere it is not to be seen.
    let around = r#"{"name": "at", "mesh": 0, "translation": [0, 0, -2], "scale": [1000, 1000, 1]},
        {"name": "at", "mesh": 0, "translation": [0, 0, 6], "scale": [1000, 1000, 1], "rotation": [0, 1, 0, 0]}"#;
    close(sheet(0.7, [1.0; 3], around), [2.0; 3]);
    // A lamp of a half-angle of 1° is spread wider than that.
    let far = r#"{"name": "at", "mesh": 0, "translation": [0, 0, -2], "scale": [0.035, 0.035, 1]}"#;
    let [smooth, rough] = [0.0, 0.7].map(|roughness| sheet(roughness, [1.0; 3], far)[0]);
    assert!(smooth > 1.8 && rough > 1e-4 && rough < 0.05 * smooth, "{smooth} {rough}");
}

#[test]
fn samples_render() {
    let Some(folder) = data("gltf") else { return };
    let small = Overrides { resolution: Some([24, 16]), samples_per_pixel: Some(4), ..Overrides::default() };
    let is_scene = |path: &std::path::PathBuf| path.extension().is_some_and(|e| e == "glb" || e == "gltf");
    for path in files_below(&folder).into_iter().filter(is_scene) {
        let mut imported = import(&path, &Files);
        if imported.has_errors() {
            continue;
        }
        small.apply(&mut imported.desc).expect("changes that every scene can take");
        let compiled = Job::compile(imported.desc);
        let mut job = compiled.unwrap_or_else(|errors| panic!("{}: {errors:?}", path.display())).job;
        job.render(&Control::default()).expect("not cancelled");
        let values: Vec<f32> = job.picture().expect("a picture").values().collect();
        assert!(values.iter().all(|value| value.is_finite()), "{}", path.display());
        assert!(values.iter().any(|&value| value > 0.01), "{} is black", path.display());
    }
}
