// Infinite lights behind portals, as `scene/src/light/portal_infinite.rs` has them: densities over
// what each point sees of the rectified square, by the sums of the values of all cells below and
// left of each corner (`sampling/src/windowed.rs`). Sums are integers of 64 bits, so that those
// over a small part of the square are exact.

// The window of the square in which a point sees a portal, and whether it does.
struct PortalWindow {
    low: vec2f,
    high: vec2f,
    valid: bool,
}

fn portal_frame(at: u32) -> Rows {
    return Rows(vector(at + 8), vector(at + 12), vector(at + 16));
}

// The position of a direction in the rectified square, and 1 if it leads out of the scene.
fn portal_position(at: u32, w: vec3f) -> vec3f {
    let local = times(portal_frame(at), w);
    var st: vec2f;
    for (var i = 0; i < 2; i++) {
        st[i] = arc_atan(local[i] / local.z) / 3.1415927 + 0.5;
    }
    return vec3f(st, select(0.0, 1.0, local.z > 0));
}

// The local direction of a position, and the solid angle per area there.
fn portal_direction(st: vec2f) -> vec4f {
    let x = sin_cos((st.x - 0.5) * 3.1415927);
    let y = sin_cos((st.y - 0.5) * 3.1415927);
    let w = Vec3_normalize(vec3f(x.v0 / x.v1, y.v0 / y.v1, 1));
    let squares = w * w;
    return vec4f(w, 9.869604 * (squares.x + squares.z) * (squares.y + squares.z) / w.z);
}

fn portal_window(at: u32, p: vec3f) -> PortalWindow {
    let corner = vector(at + 4);
    let far = corner + vector(at + 8) * number(at + 20) + vector(at + 12) * number(at + 21);
    var ends: array<vec3f, 2>;
    for (var i = 0; i < 2; i++) {
        ends[i] = portal_position(at, select(corner, far, i == 1) - p);
    }
    let low = min(ends[0].xy, ends[1].xy);
    let high = max(ends[0].xy, ends[1].xy);
    return PortalWindow(low, high, ends[0].z == 1 && ends[1].z == 1);
}

fn portal_sum(at: u32, corner: vec2u) -> vec2u {
    let index = word(at + 24) + 2 * (corner.y * (word(at + 22) + 1) + corner.x);
    return vec2u(word(index), word(index + 1));
}

// The sum of the cells between two corners.
fn portal_cells(at: u32, base: vec2u, corner: vec2u) -> f32 {
    let above = wide_difference(portal_sum(at, corner), portal_sum(at, vec2u(base.x, corner.y)));
    let below = wide_difference(portal_sum(at, vec2u(corner.x, base.y)), portal_sum(at, base));
    let sum = wide_difference(above, below);
    return f32(sum.y) * 4294967296.0 + f32(sum.x);
}

// The sum of the values between a corner and a position, where a cell that this divides counts by
// its part there.
fn portal_mass(at: u32, base: vec2u, p: vec2f) -> f32 {
    let count = word(at + 22);
    let place = clamp(p, vec2f(), vec2f(1)) * f32(count);
    let cell = max(min(vec2u(place), vec2u(count - 1)), base);
    let part = place - vec2f(cell);
    var rows: vec2f;
    for (var y = 0u; y < 2; y++) {
        let left = cell + vec2u(0, y);
        rows[y] = mix(portal_cells(at, base, left), portal_cells(at, base, left + vec2u(1, 0)), part.x);
    }
    return mix(rows.x, rows.y, part.y);
}

// The cell at the low corner of a window, from which sums are counted.
fn portal_base(at: u32, window: PortalWindow) -> vec2u {
    let count = word(at + 22);
    return min(vec2u(clamp(window.low, vec2f(), vec2f(1)) * f32(count)), vec2u(count - 1));
}

// The mass before `x` along an axis, between two positions along the other one.
fn portal_mass_before(at: u32, base: vec2u, along_y: bool, across: vec2f, x: f32) -> f32 {
    let low = select(vec2f(x, across.x), vec2f(across.x, x), along_y);
    let high = select(vec2f(x, across.y), vec2f(across.y, x), along_y);
    return portal_mass(at, base, high) - portal_mass(at, base, low);
}

// The mean of the values in a window, times the area of that.
fn portal_integral(at: u32, window: PortalWindow) -> f32 {
    let base = portal_base(at, window);
    let across = vec2f(window.low.y, window.high.y);
    let after = portal_mass_before(at, base, false, across, window.high.x);
    let count = f32(word(at + 22));
    return (after - portal_mass_before(at, base, false, across, window.low.x)) / (count * count);
}

// The density per solid angle of a position within a window.
fn portal_density(at: u32, st: vec2f, window: PortalWindow) -> f32 {
    let integral = portal_integral(at, window);
    let count = word(at + 22);
    let cell = min(vec2u(st * f32(count)), vec2u(count - 1));
    let value = portal_cells(at, cell, cell + 1);
    return select(0, value / integral / portal_direction(st).w, integral > 0);
}

// The radiance at a position, over the emission.
fn portal_share(at: u32, st: vec2f, lambda: SampledWavelengths) -> vec4f {
    if (word(at + 23) == 0) {
        return vec4f(1);
    }
    return image_pixel(vec2u(word(at + 25), word(at + 26)), word(at + 23), st, lambda);
}

// What multiplies the emission along a ray that leaves the scene, and the density of sampling it.
fn portal_seen(at: u32, o: vec3f, d: vec3f, lambda: SampledWavelengths) -> Sky {
    let st = portal_position(at, d);
    let window = portal_window(at, o);
    if (st.z == 0 || !window.valid || any(st.xy < window.low) || any(st.xy > window.high)) {
        return Sky(vec4f(), 0);
    }
    return Sky(portal_share(at, st.xy, lambda), portal_density(at, st.xy, window));
}

fn sample_portal(at: u32, p: vec3f, u: vec2f, lambda: SampledWavelengths, sample: ptr<function, LightSample>) {
    let window = portal_window(at, p);
    (*sample).valid = false;
    if (!window.valid || !(portal_integral(at, window) > 0)) {
        return;
    }
    let count = word(at + 22);
    let base = portal_base(at, window);
    let last_cell = min(vec2u(clamp(window.high, vec2f(), vec2f(1)) * f32(count)), vec2u(count - 1));
    var st: vec2f;
    // Across x the window, and then the column that is chosen.
    var across = vec2f(window.low.y, window.high.y);
    for (var axis = 0; axis < 2; axis++) {
        let along_y = axis == 1;
        let low = window.low[axis];
        let high = window.high[axis];
        let before = portal_mass_before(at, base, along_y, across, low);
        let after = portal_mass_before(at, base, along_y, across, high);
        let goal = before + u[axis] * (after - before);
        var first = base[axis];
        var last = last_cell[axis];
        while (first < last) {
            let middle = (first + last) / 2;
            let edge = clamp(f32(middle + 1) / f32(count), low, high);
            if (portal_mass_before(at, base, along_y, across, edge) > goal) {
                last = middle;
            } else {
                first = middle + 1;
            }
        }
        let left = clamp(f32(first) / f32(count), low, high);
        let right = clamp(f32(first + 1) / f32(count), low, high);
        let below = portal_mass_before(at, base, along_y, across, left);
        let above = portal_mass_before(at, base, along_y, across, right);
        if (!(above > below)) {
            return;
        }
        st[axis] = clamp(left + (right - left) * clamp((goal - below) / (above - below), 0, 1), low, high);
        across = vec2f(f32(first), f32(first + 1)) / f32(count);
    }
    let w = portal_direction(st);
    (*sample).wi = transposed(portal_frame(at), w.xyz);
    (*sample).l = portal_share(at, st, lambda);
    (*sample).pdf = portal_density(at, st, window);
    (*sample).valid = (*sample).pdf > 0;
}
