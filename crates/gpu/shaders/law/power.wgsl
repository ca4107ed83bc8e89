// Translated from crates/lanes/src/function/power.rs
// by `cargo xtask wgsl`, which translates it again.

// xʸ, with an error below 2 ulp. A negative number has powers with integers only, others are NaN.
fn power_pow(x: f32, y: f32) -> f32 {
    let infinity = infinity();
    let base = abs(x);
    let log_1 = log2_parts(base);
    let product_1 = y * log_1.v0;
    let rest = product_rest(y, log_1.v0, product_1) + (y * log_1.v1);
    let rest_1 = select(0.0f, rest, abs(product_1) < 200.0f);
    let product_2 = real_min(200.0f, real_max(-200.0f, product_1));
    let parts = function_round(product_2);
    let n = parts.v0;
    let integer = parts.v1;
    let r = (product_2 - n) + rest_1;
    let power = scale(1.0f + (r * (((((1.5244995e-4f * r + 1.3391684e-3f) * r + 9.618826e-3f) * r + 5.550358e-2f) * r + 0.24022645f) * r + 0.6931472f)), integer);
    let grows = (base > 1.0f) != (y < 0.0f);
    let has_limit = ((base == 0.0f) | (base == infinity)) | (abs(y) == infinity);
    let power_1 = select(power, select(0.0f, infinity, grows), has_limit);
    let power_2 = select(power_1, 1.0f, base == 1.0f);
    let half = y * 0.5f;
    let is_integer = floor(y) == y;
    let is_odd = is_integer & (floor(half) != half);
    let power_3 = copysign(power_2, select(1.0f, x, is_odd));
    let is_undefined = ((((x < 0.0f) & (x != (-infinity))) & !is_integer) | (x != x)) | (y != y);
    let power_4 = select(power_3, not_a_number(), is_undefined);
    return select(power_4, 1.0f, (x == 1.0f) | (y == 0.0f));
}

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

// log₂ of a positive number in two parts, with a relative error of about 2⁻³².
fn log2_parts(x: f32) -> Tuple_f32_f32 {
    let parts = logarithmic_parts(x);
    let f = parts.v0;
    let n = parts.v1;
    let mantissa = 1.0f + f;
    let is_low = mantissa < 0.8908987f;
    let is_high = mantissa > 1.122462f;
    let centre = select(select(1.0f, 1.2599211f, is_high), 0.7937005f, is_low);
    let start = n + select(select(0.0f, 0.333313f, is_high), -0.333313f, is_low);
    let start_rest = select(select(0.0f, 2.0372556e-5f, is_high), -2.0362793e-5f, is_low);
    let difference = mantissa - centre;
    let sum = mantissa + centre;
    let sum_rest = mantissa - (sum - centre);
    let reciprocal = 1.0f / sum;
    let s = difference * reciprocal;
    let product_1 = s * sum;
    let s_rest = (((difference - product_1) - product_rest(s, sum, product_1)) - (s * sum_rest)) * reciprocal;
    let z = s * s;
    let terms = (s * z) * ((0.1451185f * z + 0.19999082f) * z + 0.33333334f);
    let artanh = s + terms;
    let artanh_rest = ((s - artanh) + terms) + s_rest;
    let product_2 = artanh * 2.88539f;
    let rest = (product_rest(artanh, 2.88539f, product_2) + ((artanh * 3.851926e-8f) + (artanh_rest * 2.88539f))) + start_rest;
    let log_1 = start + product_2;
    return Tuple_f32_f32(log_1, ((start - log_1) + product_2) + rest);
}

// a·b minus its rounded value, from products of halves, which are exact ([Dekker 1971]).
fn product_rest(a: f32, b: f32, product_1: f32) -> f32 {
    let high = bitcast<f32>(bitcast<u32>(a) & 0xfffff000u);
    let high_1 = bitcast<f32>(bitcast<u32>(b) & 0xfffff000u);
    let a_low = a - high;
    let b_low = b - high_1;
    return ((((high * high_1) - product_1) + (high * b_low)) + (a_low * high_1)) + (a_low * b_low);
}
