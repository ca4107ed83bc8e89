// Samplers that few scenes have, and words of 64 bits as pairs of a low and a high one.

const MURMUR = vec2u(0x5bd1e995u, 0xc6a4a793u);

// The lower 64 bits of a product.
fn wide_product(a: vec2u, b: vec2u) -> vec2u {
    let al = a.x & 0xffff;
    let ah = a.x >> 16;
    let bl = b.x & 0xffff;
    let bh = b.x >> 16;
    let low = al * bl;
    let middle = (low >> 16) + ((al * bh) & 0xffff) + ((ah * bl) & 0xffff);
    let high = ah * bh + ((al * bh) >> 16) + ((ah * bl) >> 16) + (middle >> 16);
    return vec2u((middle << 16) | (low & 0xffff), high + a.x * b.y + a.y * b.x);
}

fn wide_sum(a: vec2u, b: vec2u) -> vec2u {
    let low = a.x + b.x;
    return vec2u(low, a.y + b.y + select(0u, 1u, low < a.x));
}

fn wide_difference(a: vec2u, b: vec2u) -> vec2u {
    return vec2u(a.x - b.x, a.y - b.y - select(0u, 1u, a.x < b.x));
}

// A word and what its bits from 47 on are.
fn folded(a: vec2u) -> vec2u {
    return vec2u(a.x ^ (a.y >> 15), a.y);
}

// The steps of `hash` of `sampling/src/hash.rs`: the first of so many words, one of two words, and
// the last.
fn hash_begin(words: u32) -> vec2u {
    return wide_product(vec2u(4 * words, 0), MURMUR);
}

fn hash_step(h: vec2u, words: vec2u) -> vec2u {
    let k = folded(wide_product(words, MURMUR));
    return wide_product(h ^ wide_product(k, MURMUR), MURMUR);
}

fn hash_end(h: vec2u) -> vec2u {
    return folded(wide_product(folded(h), MURMUR));
}

// `permutation_element` of the same file.
fn permuted_index(index: u32, length: u32, seed: u32) -> u32 {
    var mask = 0u;
    if (length > 1) {
        mask = 0xffffffffu >> (31 - firstLeadingBit(length - 1));
    }
    var i = index;
    loop {
        i = (i ^ seed) * 0xe170893du;
        i ^= seed >> 16;
        i ^= (i & mask) >> 4;
        i = (i ^ (seed >> 8)) * 0x0929eb3fu;
        i ^= seed >> 23;
        i ^= (i & mask) >> 1;
        i = i * (1 | (seed >> 27)) * 0x6935fa69u;
        i ^= (i & mask) >> 11;
        i *= 0x74dcb303u;
        i ^= (i & mask) >> 2;
        i *= 0x9e501cc3u;
        i ^= (i & mask) >> 2;
        i = (i * 0xc860a3dfu) & mask;
        i ^= i >> 5;
        if (i < length) {
            break;
        }
    }
    return (i + seed % length) % length;
}

// A hash of one dimension of one pixel.
fn pixel_hash(address: Address, seed: u32) -> vec2u {
    let pixel = hash_step(hash_begin(4), vec2u(address.pixel[0], address.pixel[1]));
    return hash_end(hash_step(pixel, vec2u(address.dimension, seed)));
}

// The position of a sample in a shuffled set of `count` samples, of which each has a seed of its
// own.
fn shuffled(index: u32, count: u32, seed: u32) -> u32 {
    let round = index / count;
    var own = seed;
    if (round > 0) {
        own = hash_end(hash_step(hash_begin(2), vec2u(seed, round))).x;
    }
    return permuted_index(index % count, count, own);
}

// The functions below make one or two coordinates at an address.

fn padded_sobol(address: Address, seed: u32, samples: u32, randomize: u32, is_pair: bool) -> vec2f {
    let hash = pixel_hash(address, seed);
    let index = address.index / samples * samples + shuffled(address.index, samples, hash.x);
    if (!is_pair) {
        return vec2f(Randomize_digits(randomize, index, hash.y), 0);
    }
    return vec2f(
        Randomize_digits(randomize, index, hash.x),
        Randomize_digits(randomize, pascal_digits(index, 0), hash.y),
    );
}

// `grid` has columns and rows; without jitter the middles of cells are taken.
fn stratified(address: Address, grid: vec2u, seed: u32, key: u32, jitters: bool, is_pair: bool) -> vec2f {
    let cell = shuffled(address.index, grid.x * grid.y, pixel_hash(address, seed).x);
    var place = vec2f(0.5);
    if (jitters) {
        place = Independent_at_2d(Independent(1, key, address), address);
    }
    if (!is_pair) {
        return vec2f(real_min((f32(cell) + place.x) / f32(grid.x * grid.y), ONE_MINUS_EPSILON), 0);
    }
    let corner = vec2f(f32(cell % grid.x), f32(cell / grid.x));
    return min((corner + place) / vec2f(grid), vec2f(ONE_MINUS_EPSILON));
}

const ONE_MINUS_EPSILON = 0.99999994;

fn pmj02bn(address: Address, log2_samples: u32, key: u32, is_pair: bool) -> vec2f {
    let log2_side = (32 - log2_samples) / 2;
    let kept = (1u << log2_side) - 1;
    let code = interleaved(address.pixel[0] & kept, address.pixel[1] & kept);
    let index = (code << log2_samples) | (address.index & ((1u << log2_samples) - 1));
    let round = mix_word(key ^ mix_word(address.index >> log2_samples));
    let tile = mix_word(mix_word((address.pixel[0] >> log2_side) ^ round) ^ (address.pixel[1] >> log2_side));
    let hash = mix_word(mix_word(address.dimension) ^ tile);
    let point = reverseBits(fast_owen_scramble(reverseBits(index), hash));
    let first = mix_word(hash + 0x9e3779b9u);
    if (!is_pair) {
        return vec2f(Randomize_digits(Randomize_FastOwen, point, first), 0);
    }
    let second = mix_word(first + 0x9e3779b9u);
    return vec2f(
        Randomize_digits(Randomize_FastOwen, point, first),
        Randomize_digits(Randomize_FastOwen, pascal_digits(point, 0), second),
    );
}

// The coordinate in the base of a prime number, from a hash of pixel and dimension. Sums of digits
// differ from those of the CPU, which has doubles, by rounding.
fn halton(index: u32, base: u32, randomize: u32, hash: u32) -> f32 {
    var a = index;
    var scale = 1.0;
    var sum = 0.0;
    if (randomize == Randomize_PermuteDigits) {
        var shifts = mix_word(hash);
        var multipliers = mix_word(~hash);
        while (a > 0) {
            let next = a / base;
            let multiplier = wide_product(vec2u(multipliers, 0), vec2u(base - 1, 0));
            let shift = wide_product(vec2u(shifts, 0), vec2u(base, 0));
            multipliers = multiplier.x;
            shifts = shift.x;
            scale /= f32(base);
            sum += scale * f32(((1 + multiplier.y) * (a - next * base) + shift.y) % base);
            a = next;
        }
        return real_min(sum + scale * unit_interval(shifts), ONE_MINUS_EPSILON);
    }
    // The permuted digits so far after a one, so that leading zeros count.
    var before = 1u;
    while (select(scale > 5.9604645e-8, a > 0, randomize == Randomize_None)) {
        let next = a / base;
        var digit = a - next * base;
        if (randomize != Randomize_None) {
            digit = permuted_index(digit, base, mix_word(hash ^ before));
            before = before * base + digit;
        }
        scale /= f32(base);
        sum += scale * f32(digit);
        a = next;
    }
    return real_min(sum, ONE_MINUS_EPSILON);
}

// The first of `count` dimensions where there are `total`: those beyond start again from the third.
fn wrapped_dimension(dimension: u32, count: u32, total: u32) -> u32 {
    return select(2 + (dimension - 2) % (total - 3), dimension, dimension + count <= total);
}
