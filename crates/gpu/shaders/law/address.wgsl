// Translated from crates/sampling/src/sampler/address.rs
// by `cargo xtask wgsl`, which translates it again.

// Which coordinate of which sample, in each lane.
struct Address {
    pixel: array<u32, 2>,
    index: u32,
    dimension: u32,
}

// Continues after `dimensions` more.
fn Address_skip(this_: ptr<function, Address>, dimensions: u32) {
    (*this_).dimension = (*this_).dimension + u32(dimensions);
}

// The lower 16 bits of `x` at the even places and those of `y` at the odd ones: a Morton code.
fn interleaved(x: u32, y: u32) -> u32 {
    return spread(x) | (spread(y) << 1);
}

// The lower 16 bits at the even places.
fn spread(x: u32) -> u32 {
    var spread_1 = x & 0xffffu;
    {
        spread_1 = (spread_1 | (spread_1 << 8)) & 0x00ff00ffu;
    }
    {
        spread_1 = (spread_1 | (spread_1 << 4)) & 0x0f0f0f0fu;
    }
    {
        spread_1 = (spread_1 | (spread_1 << 2)) & 0x33333333u;
    }
    {
        spread_1 = (spread_1 | (spread_1 << 1)) & 0x55555555u;
    }
    return spread_1;
}
