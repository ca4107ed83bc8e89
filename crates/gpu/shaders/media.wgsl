// Participating media: the records of `src/flatten/media.rs`, and how rays fly through them and
// are attenuated, as `integrators/src/transport/media/` has it. Random numbers after the first of
// a ray are other ones than there.

const GREATEST = 3.4028235e38;

// The random numbers of a ray: the first, and what the others follow from.
struct Collisions {
    u: f32,
    seeds: vec2u,
    count: u32,
}

var<private> collisions: Collisions;

fn begin_collisions(first: f32, seed: f32) {
    collisions = Collisions(first, bitcast<vec2u>(vec2f(first, seed)), 0);
}

fn next_of_collision() -> f32 {
    collisions.count++;
    return unit_interval(mix_quadruple(array(collisions.seeds.x, collisions.seeds.y, collisions.count, 0))[0]);
}

// β, and the densities of the path and of light sampling over that of the hero; of shadow rays
// their transmittance, and the densities of a flight and of ratio tracking.
struct Throughput {
    beta: vec4f,
    r_u: vec4f,
    r_l: vec4f,
}

// The medium towards which `w` leaves a geometry with the normal `n`.
fn medium_towards(geometry: u32, n: vec3f, w: vec3f, medium: u32) -> u32 {
    let sides = words_at(world.media + 4 + 4 * geometry);
    if (sides.x == 0) {
        return medium;
    }
    return select(sides.y, sides.z, dot(w, n) > 0);
}

// The index of a grid's value, and 1 if it has that one.
fn grid_index(grid: u32, cell: vec3i) -> vec2u {
    let size = words_at(grid).xyz;
    let c = bitcast<vec3u>(cell);
    return vec2u((c.z * size.y + c.y) * size.x + c.x, select(0u, 1u, all(c < size)));
}

// The position of a point of the unit cube among the values of a grid.
fn place_in_grid(grid: u32, p: vec3f) -> vec3f {
    return p * vec3f(words_at(grid).xyz) - 0.5;
}

// The weight of one of the eight values around a place.
fn corner_weight(fraction: vec3f, corner: vec3u) -> f32 {
    let weights = select(1 - fraction, fraction, corner == vec3u(1));
    return weights.x * weights.y * weights.z;
}

fn corner_of(i: u32) -> vec3u {
    return vec3u(i & 1, (i >> 1) & 1, i >> 2);
}

fn grid_value(grid: u32, p: vec3f) -> f32 {
    let place = place_in_grid(grid, p);
    let low = floor(place);
    var sum = 0.0;
    for (var i = 0u; i < 8; i++) {
        let index = grid_index(grid, vec3i(low) + vec3i(corner_of(i)));
        if (index.y == 1) {
            sum += corner_weight(place - low, corner_of(i)) * bitcast<f32>(texels[word(grid + 3) + index.x]);
        }
    }
    return sum;
}

// The spectrum of a grid of colours, or 1 without a grid.
fn colour_value(grid: u32, p: vec3f, lambda: SampledWavelengths) -> vec4f {
    if (grid == 0) {
        return vec4f(1);
    }
    let place = place_in_grid(grid, p);
    let low = floor(place);
    var sum = vec4f();
    for (var i = 0u; i < 8; i++) {
        let index = grid_index(grid, vec3i(low) + vec3i(corner_of(i)));
        let at = word(grid + 3) + 4 * index.x;
        if (index.y == 1) {
            let scale = corner_weight(place - low, corner_of(i)) * bitcast<f32>(texels[at]);
            let words = vec3u(texels[at + 1], texels[at + 2], texels[at + 3]);
            for (var j = 0; j < 4; j++) {
                let colour = RgbSigmoidPolynomial(bitcast<vec3f>(words));
                sum[j] += scale * RgbSigmoidPolynomial_at(colour, lambda.lambda[j]);
            }
        }
    }
    return sum;
}

// The value of sparse voxels at a point in render space.
fn voxel_value(voxels: u32, p: vec3f) -> f32 {
    let place = times_point(kept_placement(voxels), p);
    let low = floor(place);
    let first = words_at(voxels + 12);
    let second = words_at(voxels + 16);
    let origin = bitcast<vec3i>(first.xyz);
    let bricks = vec3u(first.w, second.xy);
    var sum = 0.0;
    for (var i = 0u; i < 8; i++) {
        // Beside all bricks there is the background, which the first one has.
        let offset = bitcast<vec3u>(vec3i(low) + vec3i(corner_of(i)) - origin);
        let brick = offset / 8;
        var at = second.w;
        if (all(brick < bricks)) {
            let index = (brick.z * bricks.y + brick.y) * bricks.x + brick.x;
            let within = offset % 8;
            at += 512 * texels[second.z + index] + (within.z * 8 + within.y) * 8 + within.x;
        }
        sum += corner_weight(place - low, corner_of(i)) * bitcast<f32>(texels[at]);
    }
    return sum;
}

// The density of a cloud at a point of the unit cube: two steps of noise's gradient move the point
// at which five octaves are summed. Noise is at one place of the program, because it is long.
fn cloud_density(cloud: u32, unit: vec3f) -> f32 {
    let low = numbers_at(cloud);
    let size = numbers_at(cloud + 4);
    let p = low.xyz + unit * size.xyz;
    let wispiness = size.w;
    var place = p * number(cloud + 8);
    var amount = 0.05 * wispiness;
    var frequency = 10.0;
    var gradient = vec3f();
    var here = 0.0;
    var sum = 0.0;
    var weight = 0.5;
    for (var i = select(8u, 0u, wispiness > 0); i < 13; i++) {
        if (i == 8) {
            frequency = 1;
        }
        var at = place * frequency;
        let axis = i & 3;
        if (i < 8 && axis > 0) {
            at[axis - 1] += 0.01;
        }
        let value = noise(at);
        if (i >= 8) {
            sum += weight * value;
            weight *= 0.5;
            frequency *= 1.99;
        } else if (axis == 0) {
            here = value;
        } else {
            gradient[axis - 1] = (value - here) / 0.01;
            if (axis == 3) {
                place += gradient * amount;
                amount *= 0.5;
                frequency *= 1.99;
            }
        }
    }
    let shape = clamp((1 - p.y) * 4.5 * low.w * sum, 0, 1);
    return clamp(shape + 2 * max(0.5 - p.y, 0), 0, 1);
}

// The radiance of a blackbody, relative to its largest over all wavelengths: Planck's law, from the
// wavelength of that by Wien's.
fn blackbody(kelvin: f32, lambda: SampledWavelengths) -> vec4f {
    var le: vec4f;
    for (var i = 0; kelvin > 100 && i < 4; i++) {
        let product = lambda.lambda[i] * kelvin;
        let ratio = 2897772.0 / product;
        let squared = ratio * ratio;
        // Below 10⁻³⁸ where the exponential is too large for a float.
        le[i] = squared * squared * ratio * 142.32492 / (exp(min(14387770.0 / product, 88)) - 1);
    }
    return le;
}

// The properties of a medium at a point.
struct Properties {
    sigma_a: vec4f,
    sigma_s: vec4f,
    le: vec4f,
}

// A medium along a ray: its record, and its coefficients where the density is 1; of colours σ_a is
// the factor on their spectra.
struct Matter {
    at: u32,
    sigma_a: vec4f,
    sigma_s: vec4f,
}

fn matter(at: u32, lambda: SampledWavelengths) -> Matter {
    let scale = number(at + 4);
    if (word(at) == MediumTag_Colours) {
        return Matter(at, vec4f(scale), vec4f());
    }
    var coefficients = array(vec4f(), vec4f());
    for (var i = 0u; i < 2; i++) {
        coefficients[i] = spectrum(word(at + 2 + i), lambda) * scale;
    }
    return Matter(at, coefficients[0], coefficients[1]);
}

// The emission of a medium, given a point and its place in the unit cube.
fn emission_of_medium(kind: u32, emission: u32, p: vec3f, unit: vec3f, lambda: SampledWavelengths) -> vec4f {
    if (emission == 0) {
        return vec4f();
    }
    var le: vec4f;
    let head = words_at(emission);
    let temperatures = head.w;
    if (temperatures == 0) {
        le = spectrum(head.z, lambda);
    } else {
        var value: f32;
        if (kind == MediumTag_Voxels) {
            value = voxel_value(temperatures, p);
        } else {
            value = grid_value(temperatures, unit);
        }
        le = blackbody((value - number(emission + 4)) * number(emission + 5), lambda);
    }
    if (kind == MediumTag_Densities) {
        le *= grid_value(head.x, unit);
    } else if (kind == MediumTag_Colours) {
        le *= colour_value(head.x, unit, lambda);
    }
    return le * bitcast<f32>(head.y);
}

// Of a medium that is not homogeneous.
fn properties(m: Matter, p: vec3f, lambda: SampledWavelengths) -> Properties {
    let kind = word(m.at);
    var found: Properties;
    let unit = times_point(kept_placement(m.at + 8), p);
    if (any(unit < vec3f()) || any(unit > vec3f(1))) {
        return found;
    }
    let values = word(m.at + 6);
    var density = 1.0;
    switch (kind) {
        case MediumTag_Densities: { density = grid_value(values, unit); }
        case MediumTag_Cloud: { density = cloud_density(values, unit); }
        case MediumTag_Voxels: { density = voxel_value(values, p); }
        default: {}
    }
    found.sigma_a = m.sigma_a * density;
    found.sigma_s = m.sigma_s * density;
    if (kind == MediumTag_Colours) {
        found.sigma_s = colour_value(word(m.at + 3), unit, lambda) * m.sigma_a;
        found.sigma_a = colour_value(word(m.at + 2), unit, lambda) * m.sigma_a;
    }
    found.le = emission_of_medium(kind, word(m.at + 5), p, unit, lambda);
    return found;
}

// The cells of a medium's grid of majorants along a ray ([Amanatides 1987]). Of a homogeneous one
// the whole ray is a cell.
struct Cells {
    grid: u32,
    // Where the ray enters the cell and leaves the box.
    t: f32,
    t_end: f32,
    // Where it leaves the cell across each axis, and from one cell to the next.
    next: vec3f,
    delta: vec3f,
    cell: vec3i,
    goes_on: bool,
}

fn cells_along(m: Matter, ray: Ray, t_max: f32) -> Cells {
    var cells: Cells;
    cells.t_end = min(t_max, GREATEST);
    cells.next = vec3f(infinity());
    cells.goes_on = true;
    if (word(m.at) == MediumTag_Homogeneous) {
        return cells;
    }
    let inward = kept_placement(m.at + 8);
    let o = times_point(inward, ray.o);
    let d = times(inward.linear, ray.d);
    cells.grid = word(m.at + 7);
    let size = vec3i(words_at(cells.grid).xyz);
    for (var axis = 0; axis < 3; axis++) {
        if (d[axis] == 0) {
            cells.goes_on = cells.goes_on && o[axis] >= 0 && o[axis] <= 1;
            continue;
        }
        let near = -o[axis] / d[axis];
        let far = (1 - o[axis]) / d[axis];
        cells.t = max(cells.t, min(near, far));
        cells.t_end = min(cells.t_end, max(near, far));
    }
    cells.goes_on = cells.goes_on && cells.t <= cells.t_end;
    let entry = o + d * cells.t;
    for (var axis = 0; axis < 3; axis++) {
        let n = f32(size[axis]);
        let cell = min(i32(max(entry[axis] * n, 0)), size[axis] - 1);
        cells.cell[axis] = cell;
        // The sign of delta is that of the step.
        cells.delta[axis] = 1 / (d[axis] * n);
        let wall = f32(select(cell, cell + 1, d[axis] > 0)) / n;
        if (d[axis] != 0) {
            cells.next[axis] = cells.t + (wall - entry[axis]) / d[axis];
        }
    }
    return cells;
}

// A part of a ray, and the bound of the density on it.
struct Segment {
    t: f32,
    end: f32,
    density: f32,
}

fn next_segment(cells: ptr<function, Cells>) -> Segment {
    var segment = Segment((*cells).t, (*cells).t_end, 1);
    if ((*cells).grid == 0) {
        (*cells).goes_on = false;
        return segment;
    }
    let size = vec3i(words_at((*cells).grid).xyz);
    let c = (*cells).cell;
    segment.density = number((*cells).grid + 4 + u32((c.z * size.y + c.y) * size.x + c.x));
    let next = (*cells).next;
    var axis = select(2, 1, next.y <= next.z);
    axis = select(axis, 0, next.x <= next.y && next.x <= next.z);
    segment.end = clamp(next[axis], segment.t, segment.end);
    (*cells).t = segment.end;
    (*cells).goes_on = next[axis] < (*cells).t_end;
    (*cells).next[axis] += abs((*cells).delta[axis]);
    let cell = c[axis] + select(-1, 1, (*cells).delta[axis] > 0);
    (*cells).goes_on = (*cells).goes_on && cell >= 0 && cell < size[axis];
    (*cells).cell[axis] = cell;
    return segment;
}

// The optical depth of a collision: −ln(1 − u).
fn depth_of(u: f32) -> f32 {
    return select(-ln(1 - u), u * (1 + u * (0.5 + u / 3)), u < 0.01);
}

// How a flight ended.
const PASSED = 0u;
const SCATTERED = 1u;
const ABSORBED = 2u;

struct Flight {
    end: u32,
    // Where it was scattered.
    p: vec3f,
    // What the medium added on the way.
    emitted: vec4f,
}

// 1 − exp(−x).
fn lost(x: f32) -> f32 {
    return select(1 - exponential_exp(-x), x * (1 - x * (0.5 - x / 6)), x < 0.01);
}

// ∫ σ_a L_e exp(−σ_t t) dt over a distance in a homogeneous medium.
fn emitted_along(m: Matter, le: vec4f, distance: f32) -> vec4f {
    let sigma_t = m.sigma_a + m.sigma_s;
    var sum = m.sigma_a * le;
    for (var i = 0; i < 4; i++) {
        sum[i] *= select(lost(sigma_t[i] * distance) / sigma_t[i], 0, sigma_t[i] == 0);
    }
    return sum;
}

// The transmittance below which ratio tracking ends at random.
const FAINT = 0.05;

// Flies through a medium along a ray of unit direction; shadow rays are attenuated instead, exactly
// in homogeneous media and by ratio tracking in others.
fn fly(
    medium: u32,
    ray: Ray,
    t_max: f32,
    is_shadow: bool,
    heroes: Heroes,
    lambda: SampledWavelengths,
    path: ptr<function, Throughput>,
) -> Flight {
    var flight: Flight;
    let m = matter(medium, lambda);
    let hero = heroes.hero;
    let is_exact = word(medium) == MediumTag_Homogeneous;
    let per_density = m.sigma_a + m.sigma_s;
    if (is_exact && is_shadow) {
        let passed = attenuation(per_density, min(t_max, GREATEST));
        (*path).beta *= passed;
        (*path).r_u *= passed;
        flight.end = select(PASSED, ABSORBED, is_black((*path).beta));
        return flight;
    }
    let emission = word(medium + 5);
    if (is_exact && emission != 0) {
        // Along the whole ray at once.
        let le = spectrum(word(emission + 2), lambda) * number(emission + 1);
        let seen = emitted_along(m, le, min(t_max, GREATEST));
        flight.emitted = (*path).beta * seen / mean_of(heroes, (*path).r_u);
    }
    var cells = cells_along(m, ray, t_max);
    while (cells.goes_on) {
        let segment = next_segment(&cells);
        if (!(segment.density > 0 && segment.end > segment.t)) {
            continue;
        }
        let majorant = per_density * segment.density;
        var t = segment.t;
        loop {
            var next = infinity();
            if (majorant[hero] > 0) {
                next = t + depth_of(collisions.u) / majorant[hero];
                collisions.u = next_of_collision();
            }
            let is_collision = next < segment.end;
            let passed = attenuation(majorant, select(segment.end, next, is_collision) - t);
            if (!is_collision) {
                let factor = passed / passed[hero];
                (*path).beta *= factor;
                (*path).r_u *= factor;
                (*path).r_l *= select(passed, vec4f(1), is_exact) / passed[hero];
            }
            if (!is_collision) {
                break;
            }
            t = next;
            let p = ray.o + ray.d * t;
            var found = Properties(m.sigma_a, m.sigma_s, vec4f());
            if (!is_exact) {
                found = properties(m, p, lambda);
            }
            let sigma_t = found.sigma_a + found.sigma_s;
            let pdf = majorant[hero] * passed[hero];
            let null_ = max(majorant - sigma_t, vec4f());
            if (is_shadow) {
                let scale = passed / pdf;
                (*path).beta *= null_ * scale;
                (*path).r_u *= null_ * scale;
                (*path).r_l *= majorant * scale;
                let left = SampledSpectrum_max_component((*path).beta) / mean_of(heroes, (*path).r_l);
                if (left < FAINT) {
                    // An end at random that keeps the mean.
                    if (left == 0 || next_of_collision() < 0.75) {
                        flight.end = ABSORBED;
                        return flight;
                    }
                    (*path).beta *= 4;
                }
                continue;
            }
            if (!is_black(found.le)) {
                let density = mean_of(heroes, (*path).r_u * majorant * passed / pdf);
                flight.emitted += (*path).beta * passed * found.sigma_a * found.le / (pdf * density);
            }
            let real = select(min(sigma_t[hero] / majorant[hero], 1), 1, is_exact);
            if (real == 1 || next_of_collision() < real) {
                let scale = passed / (pdf * real);
                (*path).beta *= found.sigma_s * scale;
                (*path).r_u *= sigma_t * scale;
                let is_left = !is_black((*path).beta) && mean_of(heroes, (*path).r_u) > 0;
                flight.end = select(ABSORBED, SCATTERED, is_left);
                flight.p = p;
                return flight;
            }
            let scale = passed / (pdf * (1 - real));
            (*path).beta *= null_ * scale;
            (*path).r_u *= null_ * scale;
            (*path).r_l *= majorant * scale;
            if (is_black((*path).beta) || mean_of(heroes, (*path).r_u) == 0) {
                flight.end = ABSORBED;
                return flight;
            }
        }
    }
    return flight;
}
