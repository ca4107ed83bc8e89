// Lookups in pyramids of images: the records of `src/flatten/images.rs`, and the filters of
// `image/src/pyramid.rs`.

// A level of a pyramid: its first word among the texels, and its size.
struct Level {
    first: u32,
    size: vec2u,
}

fn level_of(pyramid: u32, index: u32) -> Level {
    let found = words_at(pyramid + 8 + 4 * index);
    return Level(found.x, found.yz);
}

// The value at an index of a level, given how values are stored, and what bytes stand for.
fn stored_value(format: u32, decoded: u32, first: u32, index: u32) -> f32 {
    switch (format) {
        case StorageTag_Bytes: {
            let code = (texels[first + index / 4] >> (8 * (index & 3))) & 255;
            return number(decoded + code);
        }
        case StorageTag_Halves: {
            return from_half((texels[first + index / 2] >> (16 * (index & 1))) & 0xffff);
        }
        default: { return bitcast<f32>(texels[first + index]); }
    }
}

// The number of a half float. What unpacks these in WGSL, not all devices have.
fn from_half(bits: u32) -> f32 {
    let magnitude = bits & 0x7fff;
    var x = f32(magnitude) * 5.9604645e-8;
    if (magnitude >= 0x400) {
        // Infinite and not a number stay so.
        let exponent = select(0x38000000u, 0x70000000u, magnitude >= 0x7c00);
        x = bitcast<f32>((magnitude << 13) + exponent);
    }
    return select(x, -x, (bits & 0x8000) != 0);
}

// The remainder that is not below 0.
fn remainder(p: vec2i, size: vec2i) -> vec2i {
    return (p % size + size) % size;
}

// The wrap modes of columns and of rows.
fn wraps(wrap: u32) -> vec2u {
    return select(vec2u(wrap), vec2u(wrap >> 4, wrap >> 6) & vec2u(3), (wrap & 15) == WrapTag_Axes);
}

// The pixel that a lookup anywhere reads.
fn wrapped(p: vec2i, size: vec2i, wrap: u32) -> vec2i {
    switch (wrap & 15) {
        case WrapTag_Repeat, WrapTag_Black, WrapTag_Clamp, WrapTag_Axes: {
            let is_repeated = wraps(wrap) == vec2u(WrapTag_Repeat);
            return select(clamp(p, vec2i(), size - 1), remainder(p, size), is_repeated);
        }
        case WrapTag_Sphere: {
            let q = remainder(p, size);
            let tile = (p - q) / size;
            return select(q, size - 1 - q, ((tile.x + tile.y) & 1) == 1);
        }
        default: {
            let y = remainder(p, 2 * size).y;
            let is_beyond = y >= size.y;
            let x = p.x + select(0, size.x / 2, is_beyond);
            return vec2i(remainder(vec2i(x, 0), size).x, select(y, 2 * size.y - 1 - y, is_beyond));
        }
    }
}

// The colour at any column and row of a level.
fn texel(pyramid: u32, level: Level, p: vec2i) -> vec3f {
    let size = vec2i(level.size);
    let is_beyond = (p < vec2i()) | (p >= size);
    let head = words_at(pyramid);
    let more = words_at(pyramid + 4);
    let wrap = more.z;
    if (any(is_beyond & (wraps(wrap) == vec2u(WrapTag_Black)))) {
        return vec3f();
    }
    var q = p;
    if (any(is_beyond)) {
        q = wrapped(p, size, wrap);
    }
    let pixel = (u32(q.y) * level.size.x + u32(q.x)) * head.z;
    // Of grey images all channels are the same one.
    var channels = vec3u(head.w, more.xy);
    let count = select(3u, 1u, channels.x == channels.y);
    var color: vec3f;
    for (var i = 0u; i < count; i++) {
        color[i] = stored_value(head.y, more.w, level.first, pixel + channels[i]);
    }
    return select(color, color.xxx, count == 1);
}

// The four texels around a position, interpolated, or one of them: the nearest, or of the last
// level its only one.
fn few_texels(pyramid: u32, level: Level, st: vec2f, is_nearest: bool, is_last: bool) -> vec3f {
    let position = st * vec2f(level.size) - 0.5;
    var low = floor(position);
    let fraction = position - low;
    var count = 4u;
    if (is_nearest || is_last) {
        let magnitude = abs(position);
        let below = floor(magnitude);
        let nearest = sign(position) * select(below, below + 1, magnitude - below >= vec2f(0.5));
        low = select(nearest, vec2f(), is_last);
        count = 1;
    }
    let first = vec2i(clamp(low, vec2f(-1e9), vec2f(1e9)));
    var sum = vec3f();
    for (var corner = 0u; corner < count; corner++) {
        let offset = vec2u(corner & 1, corner >> 1);
        let weights = select(1 - fraction, fraction, offset == vec2u(1));
        let weight = select(weights.x * weights.y, 1, count == 1);
        sum += weight * texel(pyramid, level, first + vec2i(offset));
    }
    return sum;
}

// The colour of an image over (u, v).
fn uv_color(at: u32, uv: vec2f) -> vec3f {
    let head = words_at(at);
    let columns = numbers_at(at + 4);
    let st = columns.xy * uv.x + columns.zw * uv.y + numbers_at(at + 8).xy;
    // Rows of images go down.
    return few_texels(head.x, level_of(head.x, 0), vec2f(st.x, 1 - st.y), head.y == 1, false);
}

// Texels of a level within an ellipse around a position, by a Gaussian, and the sum of the weights.
fn ellipse(pyramid: u32, level: Level, st: vec2f, longer: vec2f, shorter: vec2f) -> vec4f {
    let size = vec2f(level.size);
    let center = st * size - 0.5;
    let axis = array(longer * size, shorter * size);
    let a = axis[0].y * axis[0].y + axis[1].y * axis[1].y + 1;
    let b = -2 * (axis[0].x * axis[0].y + axis[1].x * axis[1].y);
    let c = axis[0].x * axis[0].x + axis[1].x * axis[1].x + 1;
    let form = vec3f(a, b, c) / (a * c - 0.25 * b * b);
    let determinant = 4 * form.x * form.z - form.y * form.y;
    let reach = 2 / determinant * sqrt(max(determinant * vec2f(form.z, form.x), vec2f()));
    let low = vec2i(ceil(center - reach));
    let high = vec2i(floor(center + reach));
    var sum = vec4f();
    for (var y = low.y; y <= high.y; y++) {
        for (var x = low.x; x <= high.x; x++) {
            let d = vec2f(vec2i(x, y)) - center;
            let squared = form.x * d.x * d.x + form.y * d.x * d.y + form.z * d.y * d.y;
            if (squared < 1) {
                let quantised = floor(squared * 128) / 127;
                let weight = exp(-2 * quantised) - 0.13533528;
                sum += vec4f(weight * texel(pyramid, level, vec2i(x, y)), weight);
            }
        }
    }
    return sum;
}

// The filtered colour of a lookup, given its pyramid, its mapping, its filter and its largest
// anisotropy. `dst0` and `dst1` are what its position changes by from pixel to pixel.
fn filtered_color(lookup: vec4u, st: vec2f, dst0: vec2f, dst1: vec2f) -> vec3f {
    let pyramid = lookup.x;
    let method = lookup.z;
    let last = word(pyramid) - 1;
    var longer = dst0;
    var shorter = dst1;
    if (dot(dst0, dst0) < dot(dst1, dst1)) {
        longer = dst1;
        shorter = dst0;
    }
    // The level, whether the next one is blended in, and whether texels are those of an ellipse.
    var level = 0.0;
    var is_blended = false;
    var is_elliptic = false;
    if (method == LookupTag_Ewa) {
        let slimmest = length(shorter) * bitcast<f32>(lookup.w);
        if (slimmest > 0 && slimmest < length(longer)) {
            shorter *= length(longer) / slimmest;
        }
        let width = length(shorter);
        is_elliptic = width > 0 && width < 1e30;
        is_blended = is_elliptic;
        level = select(0, clamp(f32(last) + log2(width), 0, 100), is_elliptic);
    } else {
        let changes = max(abs(dst0), abs(dst1));
        let width = 2 * max(changes.x, changes.y);
        level = clamp(f32(last) + log2(max(width, 1e-8)), 0, f32(last));
        is_blended = method == LookupTag_Trilinear && u32(level) != 0 && u32(level) != last;
    }
    let index = u32(level);
    let t = level - f32(index);
    var sum = vec3f();
    for (var i = 0u; i < select(1u, 2u, is_blended); i++) {
        let weight = select(1, select(1 - t, t, i == 1), is_blended);
        let found = level_of(pyramid, min(index + i, last));
        let is_last = select(i == 0 && index == last && method != LookupTag_Ewa, index + i > last, is_elliptic);
        var color = vec4f();
        if (is_elliptic && !is_last) {
            color = ellipse(pyramid, found, st, longer, shorter);
        }
        if (color.w > 0) {
            sum += weight / color.w * color.xyz;
        } else {
            sum += weight * few_texels(pyramid, found, st, method == LookupTag_Point, is_last);
        }
    }
    return sum;
}
