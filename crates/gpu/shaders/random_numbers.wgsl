// The random numbers of samples: the records of `src/flatten/samplers.rs`.

// The coordinates at the current place, of which samplers make the second one if it is wanted.
fn coordinates(is_pair: bool) -> vec2f {
    var at = world.random_numbers;
    if (is_light_path) {
        at = word(world.light_paths);
    }
    let head = words_at(at);
    let key = head.y;
    if (HAS_ZSOBOL && head.x == SamplerTag_ZSobol) {
        return ZSobol_at_2d(ZSobol(1u << head.z, head.z, head.w, word(at + 4), key, place), place);
    }
    if (HAS_RARE_SAMPLERS) {
        switch (head.x) {
            case SamplerTag_PaddedSobol: { return padded_sobol(place, key, head.z, head.w, is_pair); }
            case SamplerTag_Sobol: { return sobol(at, is_pair); }
            case SamplerTag_Halton: { return halton_at(at, is_pair); }
            case SamplerTag_Stratified: {
                let more = words_at(at + 4);
                return stratified(place, vec2u(head.w, more.x), head.z, key, more.y == 1, is_pair);
            }
            case SamplerTag_Pmj02Bn: { return pmj02bn(place, head.z, key, is_pair); }
            default: {}
        }
    }
    return Independent_at_2d(Independent(1, key, place), place);
}

// The coordinates of `sobol`. On the CPU its first two dimensions are the position in the pixel,
// and others begin with the third; here camera paths have that position after their first number.
fn sobol(at: u32, is_pair: bool) -> vec2f {
    let m = word(at + 2);
    let kept = (1u << m) - 1;
    let bits = ((place.pixel[0] & kept) << m) | (place.pixel[1] & kept);
    let is_position = !is_light_path && place.dimension == 1;
    var first = place.dimension;
    if (is_light_path || first == 0) {
        first += 2;
    }
    first = select(wrapped_dimension(first, select(1u, 2u, is_pair), word(at + 3)), 0, is_position);
    var u: vec2f;
    for (var c = 0u; c < select(1u, 2u, is_pair); c++) {
        let matrix = word(at + 5) + 64 * (first + c);
        var digits = 0u;
        for (var bit = 0u; bit < 32; bit++) {
            digits ^= word(matrix + bit) & (0u - ((bits >> bit) & 1));
            digits ^= word(matrix + 32 + bit) & (0u - ((place.index >> bit) & 1));
        }
        digits >>= select(0u, m, is_position);
        u[c] = Randomize_digits(word(at + 1), digits, word(word(at + 4) + first + c));
    }
    return u;
}

// The coordinates of `halton`.
fn halton_at(at: u32, is_pair: bool) -> vec2f {
    let pixel = mix_word(mix_word(word(at + 1) ^ place.pixel[0]) ^ place.pixel[1]);
    let randomize = word(at + 2);
    let index = place.index + select(0u, pixel, randomize == Randomize_None);
    let first = wrapped_dimension(place.dimension, select(1u, 2u, is_pair), word(at + 3));
    var u: vec2f;
    for (var c = 0u; c < select(1u, 2u, is_pair); c++) {
        let base = word(word(at + 4) + first + c);
        u[c] = halton(index, base, randomize, mix_word(pixel ^ mix_word(first + c)));
    }
    return u;
}
