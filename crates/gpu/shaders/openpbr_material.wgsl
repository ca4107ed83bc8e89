// Principled surfaces at a point: the records of `src/flatten/openpbr.rs`.

// The most textures of a material.
const MOST_TEXTURES = 30u;

// The surface of a record, given what its textures are at the point.
fn openpbr_at(at: u32, textures: array<vec4f, MOST_TEXTURES>, lambda: SampledWavelengths) -> OpenPbr {
    var values = textures;
    var colors: array<vec4f, 6>;
    for (var i = 0u; i < 6; i++) {
        let texture = tables[at + 3 + i];
        colors[i] = vec4f(1);
        if (texture != 0xffffffffu) {
            colors[i] = clamp(values[texture], vec4f(), vec4f(1));
        }
    }
    var n: array<f32, 24>;
    for (var i = 0u; i < 24; i++) {
        n[i] = number(at + 9 + i);
    }
    for (var i = 0u; i < tables[at + 2]; i++) {
        let number_at = at + 33 + 3 * i;
        n[tables[number_at]] = clamp(values[i].x, number(number_at + 1), number(number_at + 2));
    }
    let is_thin = tables[at] == 1;
    if (!is_thin && n[8] > 0) {
        // The medium inside absorbs instead of the boundary.
        colors[2] = vec4f(1);
    }
    let p = OpenPbrParameters(
        n[0], colors[0], n[1], n[2], n[3], colors[1], n[4], n[5], n[6], n[7], colors[2],
        n[11], colors[3], vec4f(), n[13], n[14], colors[4], n[15], n[16], n[17], n[18], vec3f(0, 0, 1),
        n[19], colors[5], n[20], n[21], n[22], n[23], is_thin,
    );
    return OpenPbr_new(tables[at + 1], p, lambda);
}
