// Translated from crates/sampling/src/sampler/independent.rs
// by `cargo xtask wgsl`, which translates it again.

// Uniform random numbers, any number of them.
struct Independent {
    samples_per_pixel: u32,
    key: u32,
    address: Address,
}

// The number at an address.
fn Independent_at_1d(this_: Independent, address: Address) -> f32 {
    return Independent_at_2d(this_, address).x;
}

// Two numbers at an address.
fn Independent_at_2d(this_: Independent, address: Address) -> vec2f {
    let parts = address.pixel;
    let x = parts[0];
    let y = parts[1];
    let index = address.index;
    let dimension = address.dimension;
    let parts_1 = mix_quadruple(array<u32, 4>(x, y, u32(index ^ this_.key), dimension));
    let a = parts_1[0];
    let b = parts_1[1];
    return vec2f(unit_interval(a), unit_interval(b));
}
