// Resampling: one sample of those of this pixel and of others, and the light that it finds.
//
// The weight of a sample divides by what all receivers could have chosen it with, visibility
// included, which leaves the light unbiased. The biased form leaves that out, and darkens where
// receivers differ.

// The samples of a pixel and others.
const MOST = 5u;

// As many samples the frame before stands for at most.
const MOST_BEFORE = 20.0;

// The light of the chosen sample is found for as many sets of wavelengths, evenly spaced: they make
// more noise in a frame than anything else, and need no rays.
const SETS = 4u;

// Neighbours are within this part of the picture's longer side [Bitterli 2020 §5], but not so near
// that most are the pixel itself.
const RADIUS = 30.0 / 1920.0;
const LEAST_RADIUS = 3.0;

// Samples are of little use to other surfaces: at a distance that differs by more than this part,
// or with normals whose angle has a smaller cosine (25°).
const LIKE_DISTANCE = 0.1;
const LIKE_NORMAL = 0.9063078;

fn part(index: u32) -> u32 {
    return index * frame.size.x * frame.size.y;
}

// Another pixel that has samples; the last component is 0 where there is none.
fn other_pixel(id: vec2u, here: Reservoir) -> vec3u {
    let u = get_2d();
    if (reuse.neighbours > 0) {
        let angle = sin_cos(6.2831855 * u.x);
        let radius = max(RADIUS * f32(max(frame.size.x, frame.size.y)), LEAST_RADIUS);
        let offset = vec2f(angle.v1, angle.v0) * sqrt(u.y) * radius;
        let pixel = vec2i(round(vec2f(id) + offset));
        let is_valid = all(pixel >= vec2i()) && all(pixel < vec2i(frame.size)) && any(pixel != vec2i(id));
        return vec3u(vec2u(max(pixel, vec2i())), u32(is_valid));
    }
    let place = place_before(here.o + here.d * here.t, true);
    // Between pixels it is one or the other.
    let pixel = vec2i(floor(place.xy + u));
    let is_known = (reuse.flags & ReuseBit_HasBefore) != 0 && place.z == 1;
    let is_valid = is_known && all(pixel >= vec2i()) && all(pixel < vec2i(frame.size));
    return vec3u(vec2u(max(pixel, vec2i())), u32(is_valid));
}

fn is_like(here: Reservoir, other: Reservoir) -> bool {
    let cosine = dot(unpacked_normal(here.normal), unpacked_normal(other.normal));
    return abs(other.t - here.t) < LIKE_DISTANCE * here.t && cosine > LIKE_NORMAL;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (any(id.xy >= frame.size)) {
        return;
    }
    let at = id.y * frame.size.x + id.x;
    let camera = camera_sample(frame.low + id.xy, frame.index);
    let is_last = reuse.neighbours > 0;
    rays = 0;
    var inputs: array<u32, MOST>;
    inputs[0] = part(select(2u, 3u, is_last)) + at;
    var count = 1u;
    let here = reservoirs[inputs[0]];
    place.dimension = FIRST_DIMENSION + select(0x1000u, 0x2000u, is_last);
    for (var i = 0u; i < max(reuse.neighbours, 1) && here.kind != 0; i++) {
        let pixel = other_pixel(id.xy, here);
        if (pixel.z == 0) {
            continue;
        }
        let index = part(reuse.source) + pixel.y * frame.size.x + pixel.x;
        let other = reservoirs[index];
        if (other.kind != 0 && is_like(here, other)) {
            inputs[count] = index;
            count++;
        }
    }
    let dimension = place.dimension;
    var next = here;
    next.count = 0;
    next.weight = 0;
    var sum = 0.0;
    var aim = 0.0;
    var chosen = 0u;
    // What all receivers, and the one of the chosen sample, could have chosen it with.
    var all_aims = 0.0;
    var own_aim = 0.0;
    var is_lit = false;
    // The light of the chosen sample, which counts for all samples of the pixel.
    let weight_in_pixel = film.pixels[at].now.w;
    var seen = vec3f();
    var receiver: Receiver;
    // One place of the program for all that is found, because it is long: what the samples find
    // here, what the chosen one finds for their receivers, and its light at the path's wavelengths.
    let others = select(count, 1, (reuse.flags & ReuseBit_IsBiased) != 0);
    let sets = select(0u, select(SETS, 1u, world.has_one_wavelength == 1), is_last);
    let steps = count + others + sets;
    for (var step = 0u; step < steps; step++) {
        let is_choice = step < count;
        let is_shading = step >= count + others;
        let i = select(select(step - count, step, is_choice), 0, is_shading);
        let other = reservoirs[inputs[i]];
        let samples = min(other.count, MOST_BEFORE);
        var lambda = common_wavelengths();
        if (is_shading) {
            let offset = f32(step - count - others) / f32(4 * SETS);
            lambda = sampled_wavelengths(fract(camera.wavelength + offset));
        }
        if (step == 0 || !is_choice) {
            var near = camera.near;
            near.are_known = near.are_known && is_shading;
            receiver = receiver_of(other, near, &lambda);
        }
        var light = next.light;
        var u = next.u;
        if (is_choice) {
            light = other.light;
            u = other.u;
            next.count += samples;
        }
        if ((is_choice && other.weight == 0) || (!is_choice && aim == 0) || (is_shading && next.weight == 0)) {
            continue;
        }
        place.dimension = 0;
        let found = find(receiver, light, u, lambda);
        let value = aim_of(found);
        if (is_choice) {
            let weight = samples * value * other.weight;
            sum += weight;
            place.dimension = dimension + step;
            if (weight > 0 && get_1d() * sum < weight) {
                next.light = other.light;
                next.u = other.u;
                aim = value;
                chosen = i;
            }
        } else if (is_shading) {
            seen += exposed(found.l * next.weight, lambda, weight_in_pixel / f32(sets)).xyz;
        } else if (value > 0 && is_visible(receiver, found.light)) {
            all_aims += samples * value;
            own_aim = select(own_aim, value, i == chosen);
            is_lit = is_lit || i == 0;
        }
        if (step + 1 == count + others && is_lit) {
            next.weight = sum / (next.count * aim);
            if ((reuse.flags & ReuseBit_IsBiased) == 0) {
                next.weight = sum * own_aim / (all_aims * aim);
            }
        }
    }
    reservoirs[part(reuse.target_part) + at] = next;
    film.pixels[at].now += vec4f(seen, 0);
    atomicAdd(&film.rays, rays);
}
