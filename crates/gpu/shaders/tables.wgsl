// How the tables of a scene are read: words one by one, and four at once.

// The word at an index, and the four from a multiple of four on.
fn word(at: u32) -> u32 {
    return tables[at >> 2][at & 3];
}

fn words_at(at: u32) -> vec4u {
    return tables[at >> 2];
}

// The same as numbers, and the first three of four as a vector.
fn number(at: u32) -> f32 {
    return bitcast<f32>(word(at));
}

fn numbers_at(at: u32) -> vec4f {
    return bitcast<vec4f>(words_at(at));
}

fn vector(at: u32) -> vec3f {
    return numbers_at(at).xyz;
}

// The three rows of a matrix, each with the number after it.
fn rows_at(at: u32) -> array<vec4f, 3> {
    return array(numbers_at(at), numbers_at(at + 4), numbers_at(at + 8));
}
