// What the layers of principled surfaces do with light: the records of `src/flatten/openpbr.rs`,
// and the methods of `OpenPbrTable`.

// The record of a table.
alias OpenPbrTable = u32;

const OPENPBR_COSINES = 37u;
// Where the axes of a table begin, and the words of each.
const OPENPBR_AXES = 8u;
const OPENPBR_AXIS = 8u;

struct Means {
    fuzz: f32,
    metal: f32,
    diffuse: f32,
    white: f32,
    glass_above: f32,
    glass_below: f32,
}

// A node, and its weight.
struct Node {
    index: u32,
    weight: f32,
}

// The first or the second node of the interval at `x`, which is in nodes, of which there are `len`.
fn node_among(x: f32, len: u32, second: u32) -> Node {
    let lower = min(floor(x), f32(len - 2));
    let t = x - lower;
    return Node(u32(lower) + second, select(1 - t, t, second == 1));
}

// The same for `x` from 0 to 1.
fn node_of(x: f32, len: u32, second: u32) -> Node {
    return node_among(real_min(real_max(x, 0), 1) * f32(len - 1), len, second);
}

fn OpenPbrTable_has_film(table: u32) -> bool {
    return word(table + 2) > 1;
}

fn OpenPbrTable_locate(table: u32, p: OpenPbrParameters) -> array<f32, 12> {
    var numbers = array(
        p.specular_roughness, p.specular_weight, p.specular_ior, p.specular_roughness_anisotropy,
        p.coat_weight, p.coat_roughness, p.coat_ior, p.coat_roughness_anisotropy,
        p.fuzz_weight, p.fuzz_roughness, p.thin_film_weight, p.thin_film_ior,
    );
    var places: array<f32, 12>;
    for (var i = 0u; i < word(table); i++) {
        let at = table + OPENPBR_AXES + i * OPENPBR_AXIS;
        let axis = words_at(at);
        let range = numbers_at(at + 4).xy;
        var unit = numbers[axis.x];
        switch (axis.y) {
            case 1: { unit = sqrt(unit) / (1 + sqrt(unit)); }
            case 2: { unit = (unit - 1) / (unit + 1); }
            case 3: { unit = sqrt(unit); }
            default: {}
        }
        let part = (unit - range.x) / (range.y - range.x);
        places[i] = real_min(real_max(part, 0), 1) * f32(axis.z - 1);
    }
    return places;
}

// The number of nodes around a place.
fn openpbr_corners(table: u32) -> u32 {
    return select(1u, 2u, OpenPbrTable_has_film(table)) << word(table);
}

// One of them, under a film of the optical thickness of so many wavelengths.
fn openpbr_corner(table: u32, location: array<f32, 12>, waves: f32, corner: u32) -> Node {
    var places = location;
    var node = Node(0, 1);
    var left = corner;
    let films = word(table + 2);
    if (films > 1) {
        let least = number(table + 3);
        node = node_of((waves - least) / (number(table + 4) - least), films, left & 1);
        left >>= 1u;
    }
    var stride = films;
    for (var i = 0u; i < word(table); i++) {
        let len = word(table + OPENPBR_AXES + i * OPENPBR_AXIS + 2);
        let next = node_among(places[i], len, (left >> i) & 1);
        node = Node(node.index + next.index * stride, node.weight * next.weight);
        stride *= len;
    }
    return node;
}

// The number of rows around a direction.
fn openpbr_rows(table: u32) -> u32 {
    return select(2u, 4u, word(table + 1) > 1);
}

// One of them.
fn openpbr_row(table: u32, w: vec3f, i: u32) -> Node {
    let across = node_of(sqrt(abs(w.z)), OPENPBR_COSINES, i & 1);
    let azimuths = word(table + 1);
    if (azimuths == 1) {
        return across;
    }
    let cos_phi = abs(w.x) / real_max(length(w.xy), 1.1754944e-38);
    let around = node_of(cos_phi, azimuths, i >> 1);
    return Node(around.index * OPENPBR_COSINES + across.index, across.weight * around.weight);
}

fn OpenPbrTable_taken(table: u32, location: array<f32, 12>, waves: f32, w: vec3f) -> Taken {
    var low = vec4f();
    var high = vec4f();
    let rows = word(table + 1) * OPENPBR_COSINES;
    for (var corner = 0u; corner < openpbr_corners(table); corner++) {
        let node = openpbr_corner(table, location, waves, corner);
        for (var i = 0u; i < openpbr_rows(table); i++) {
            let row = openpbr_row(table, w, i);
            let weight = node.weight * row.weight;
            let at = word(table + 5) + 8 * (node.index * rows + row.index);
            low += weight * numbers_at(at);
            high += weight * numbers_at(at + 4);
        }
    }
    return Taken(low.x, low.y, low.z, low.w, high.x, high.y, high.z, high.w);
}

fn OpenPbrTable_inside(table: u32, location: array<f32, 12>, waves: vec4f, w: vec3f) -> Inside {
    var sum = vec3f();
    let rows = word(table + 1) * OPENPBR_COSINES;
    let count = select(1u, 4u, OpenPbrTable_has_film(table));
    for (var wave = 0u; wave < count; wave++) {
        for (var corner = 0u; corner < openpbr_corners(table); corner++) {
            let node = openpbr_corner(table, location, waves[wave], corner);
            for (var i = 0u; i < openpbr_rows(table); i++) {
                let row = openpbr_row(table, w, i);
                let at = word(table + 6) + 4 * (node.index * rows + row.index);
                sum += node.weight * row.weight / f32(count) * vector(at);
            }
        }
    }
    return Inside(sum.x, sum.y, real_max(sum.z, 0));
}

fn OpenPbrTable_means(table: u32, location: array<f32, 12>, waves: f32) -> Means {
    var low = vec4f();
    var high = vec4f();
    for (var corner = 0u; corner < openpbr_corners(table); corner++) {
        let node = openpbr_corner(table, location, waves, corner);
        let at = word(table + 7) + 8 * node.index;
        low += node.weight * numbers_at(at);
        high += node.weight * numbers_at(at + 4);
    }
    return Means(low.x, low.y, low.z, low.w, high.x, high.y);
}
