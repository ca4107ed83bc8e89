// Translated from crates/lanes/src/function/power.rs
// by `cargo xtask wgsl`, which translates it again.

// xⁿ by repeated multiplication, with an error below |n| ulp. For n < 0 it is the reciprocal of
// x⁻ⁿ, and zero where that is infinite.
fn powi(x: f32, n: i32) -> f32 {
    var square = x;
    var rest = u32(abs(n));
    var power = 1.0f;
    loop {
        if (!(rest > 0)) { break; }
        if ((rest & 1) == 1) {
            power *= square;
        }
        rest >>= 1;
        if (rest > 0) {
            square *= square;
        }
    }
    if (n < 0) {
        return 1.0f / power;
    } else {
        return power;
    }
}

// 1/√x of a positive normal number with a relative error below 5·10⁻⁶, in a fraction of the time
// of root and quotient; any finite numbers elsewhere.
fn coarse_inverse_sqrt(x: f32) -> f32 {
    let half = 0.5f * x;
    var root = bitcast<f32>(0x5f375a86u - (bitcast<u32>(x) >> 1));
    for (var i = 0u; i < 2; i++) {
        root = root * (1.5f - ((half * root) * root));
    }
    return root;
}
