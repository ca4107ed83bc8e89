// Translated from crates/scene/src/texture/checkerboard.rs
// by `cargo xtask wgsl`, which translates it again.

// The share of the second texture on squares of the plane, in [0, 1].
fn squares(c: TexCoord2d) -> f32 {
    let product_1 = filtered_wave(c.st.x, radius(c.dstdx.x, c.dstdy.x)) * filtered_wave(c.st.y, radius(c.dstdx.y, c.dstdy.y));
    return 0.5f - (0.5f * product_1);
}

// The share of the second texture in cubes of space, in [0, 1].
fn cubes(c: TexCoord3d) -> f32 {
    var product_1 = 1.0f;
    for (var axis = 0u; axis < 3; axis++) {
        product_1 *= filtered_wave(c.p[axis], radius(c.dpdx[axis], c.dpdy[axis]));
    }
    return 0.5f - (0.5f * product_1);
}

// The filter's radius along a coordinate with these derivatives by film position.
fn radius(dx: f32, dy: f32) -> f32 {
    return 1.5f * real_max(abs(dx), abs(dy));
}

// The wave averaged with a triangle of radius `r` about `x`.
fn filtered_wave(x: f32, r: f32) -> f32 {
    let is_sharp = r <= 0.5f;
    var wave = 0.0f;
    if (is_sharp) {
        let below = floor(x);
        let edge = select(below, below + 1.0f, (x - below) >= 0.5f);
        let pairs = edge * 0.5f;
        let right_of_edge = select(-1.0f, 1.0f, pairs == floor(pairs));
        let side = select(-right_of_edge, right_of_edge, x >= edge);
        let a = real_min(abs(x - edge) / r, 1.0f);
        wave = side * (1.0f - sqr(1.0f - a));
    }
    if (!is_sharp) {
        let blurred = (second_integral(x + r) - (2.0f * second_integral(x))) + second_integral(x - r);
        let blurred_1 = select(0.0f, blurred / sqr(r), r < infinity());
        wave = select(blurred_1, wave, is_sharp);
    }
    return wave;
}

// A function of period 2 whose second derivative is the wave.
fn second_integral(x: f32) -> f32 {
    let y = ((0.5f * x) - floor(0.5f * x)) - 0.5f;
    return y * (1.0f - (2.0f * abs(y)));
}
