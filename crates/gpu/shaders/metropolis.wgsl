// Multiplexed Metropolis light transport: `integrators/src/metropolis/`.
//
// A thread is a chain. What it keeps is a column of a table, a word in each row, so that threads
// beside each other read words beside each other. Of primary sample space that is the current point
// alone: each coordinate of a proposed point is a function of chain, step and dimension, which is
// computed wherever the path asks for it, and once more for all coordinates if the point is
// accepted. A point has all coordinates that any path could ask for, so that a small step moves
// them all and a large one draws them all anew.
//
// A chain of no steps is a candidate for starts.

// Coordinates of a point: those of the choice of a strategy and of the camera, of the camera's
// subpath, of the light's, of the connection.
const CAMERA_DIMENSIONS = 8u;
const LIGHT_DIMENSIONS = 5u;
const VERTEX_DIMENSIONS = 3u;
const CONNECTION_DIMENSIONS = 3u;

@group(0) @binding(5) var<storage, read_write> batch: Batch;
@group(0) @binding(6) var<storage, read_write> table: array<u32>;

// The chain, its step, and whether that is a large one.
var<private> chain: u32;
var<private> step_: u32;
var<private> is_large: bool;

fn place_in(row: u32) -> u32 {
    return row * batch.count + chain;
}

fn kept(row: u32) -> f32 {
    return bitcast<f32>(table[place_in(row)]);
}

fn keep(row: u32, x: f32) {
    table[place_in(row)] = bitcast<u32>(x);
}

fn light_dimensions_begin() -> u32 {
    return CAMERA_DIMENSIONS + VERTEX_DIMENSIONS * world.max_depth;
}

fn connection_dimensions_begin() -> u32 {
    return light_dimensions_begin() + LIGHT_DIMENSIONS + VERTEX_DIMENSIONS * (world.max_depth - 1);
}

fn dimensions() -> u32 {
    return connection_dimensions_begin() + CONNECTION_DIMENSIONS;
}

// Two random numbers of the step.
fn step_numbers(dimension: u32) -> vec2f {
    var words = array(chain, step_, batch.key, dimension);
    if (step_ == 0) {
        words = array(table[place_in(ChainRow_Start)], 0u, batch.candidate_key, dimension);
    }
    let mixed = mix_quadruple(words);
    return vec2f(unit_interval(mixed[0]), unit_interval(mixed[1]));
}

// A coordinate of the proposed point.
fn coordinate(dimension: u32) -> f32 {
    let u = step_numbers(dimension);
    if (is_large) {
        return u.x;
    }
    let deviate = sqrt(max(-2 * ln(1 - u.x), 0)) * circular_sin(6.2831855 * u.y);
    let x = kept(ChainRow_Point + dimension) + batch.sigma * deviate;
    return min(x - floor(x), float_ONE_MINUS_EPSILON);
}

fn coordinates(is_pair: bool) -> vec2f {
    var u: vec2f;
    for (var i = 0u; i < select(1u, 2u, is_pair); i++) {
        u[i] = coordinate(place.dimension + i);
    }
    return u;
}

// A path's contribution to the film, and the scalar that chains are in proportion to.
struct Contribution {
    film: vec2f,
    wavelength: f32,
    l: vec4f,
    scalar: f32,
}

// The probability of `depth` or more scattering events, were there no most.
fn at_least(depth: f32) -> f32 {
    let root = 8 / (7 + depth);
    return root * root;
}

// A number of scattering events, and one over its probability.
fn choose_depth(u: f32) -> vec2f {
    let most = f32(world.max_depth);
    let all = 1 - at_least(most + 1);
    let depth = clamp(floor(8 / sqrt(1 - u * all) - 7), 1, most);
    return vec2f(depth, all / (at_least(depth) - at_least(depth + 1)));
}

// The camera's end of a path: any film position that reaches a pixel.
fn camera_end() -> CameraSample {
    var u: array<vec2f, 4>;
    for (var i = 0u; i < 4; i++) {
        u[i] = next_numbers((i & 1) == 1);
    }
    let at = world.light_paths + 8;
    let low = vec2f(number(at), number(at + 1));
    let high = vec2f(number(at + 2), number(at + 3));
    let position = low + (high - low) * u[1];
    let camera = camera_ray(position, u[3]);
    let lambda = sampled_wavelengths(u[0].x);
    return CameraSample(camera.ray, camera.near, lambda, u[0].x, position, 1, 1);
}

// The light of the path that the strategy of s vertices from the light and t from the camera makes,
// and where it is on the film.
fn light_of(s: u32, t: u32, camera: CameraSample) -> Contribution {
    var found: Contribution;
    found.film = camera.position;
    var walk: Subpath;
    is_light_path = s > 1;
    let camera_dimension = place.dimension;
    if (is_light_path) {
        place.dimension = light_dimensions_begin();
        walk = light_subpath(camera.lambda);
    } else {
        walk = camera_subpath(camera);
    }
    var before: ShapeSampleContext;
    var other: Vertex;
    while (walk.goes_on) {
        let hit = nearest(walk.ray);
        if (looked_back(&walk, hit)) {
            continue;
        }
        var surface: Surface;
        if (hit.found) {
            surface = surface_at(hit, walk.ray);
        }
        if (s == 0 && walk.depth + 2 == t) {
            found.l = lights_met(walk, before, hit, surface);
            break;
        }
        if (!hit.found) {
            break;
        }
        let arrival = arrive(&walk, &surface, hit.t);
        before = arrival.context;
        if (s == 0 || walk.depth + 1 < select(t, s, is_light_path)) {
            var u: array<vec2f, 2>;
            for (var i = 0u; i < 2; i++) {
                u[i] = next_numbers(i == 1);
            }
            leave(&walk, arrival, surface, u[0].x, u[1]);
            continue;
        }
        // The end of the subpath.
        if (!is_non_specular(arrival.flags)) {
            break;
        }
        if (is_light_path && t > 1) {
            other = arrival.v;
            is_light_path = false;
            place.dimension = camera_dimension;
            walk = camera_subpath(camera);
            continue;
        }
        place.dimension = connection_dimensions_begin();
        var c: Connection;
        if (t == 1) {
            c = connection_to_camera(arrival.v, get_2d());
            found.film = c.film;
        } else if (s == 1) {
            var u: array<vec2f, 2>;
            for (var i = 0u; i < 2; i++) {
                u[i] = next_numbers(i == 1);
            }
            c = connection_to_light(arrival.v, arrival.context, camera.lambda, u[0].x, u[1]);
        } else {
            c = connection_to_vertex(arrival.v, other);
        }
        found.l = light_along(c, arrival.v, s > 1 && t > 1, other);
        break;
    }
    if (t > 1) {
        found.l *= count_of_light_paths();
    }
    return found;
}

// The contribution of the proposed point.
fn contribution() -> Contribution {
    place.dimension = 0;
    let u = vec2f(get_1d(), get_1d());
    let depth = choose_depth(u.x);
    let strategies = u32(depth.x) + 2;
    let s = min(u32(u.y * f32(strategies)), strategies - 1);
    let camera = camera_end();
    var found = light_of(s, strategies - s, camera);
    found.l *= f32(strategies) * depth.y;
    found.wavelength = coordinate(2);
    let seen = response(found.l, camera.lambda);
    found.scalar = max((seen.x + seen.y + seen.z) / 3, 0);
    // Light that is no number would be there at each step.
    if (!(found.scalar < 1e30)) {
        found.l = vec4f();
        found.scalar = 0;
    }
    return found;
}

// The weight of a point that has a share of a step.
fn weight_of(share: f32, has_large_step: bool, scalar: f32) -> f32 {
    let density = scalar + batch.large * batch.b0;
    let weight = share * batch.b + select(0, batch.b0, has_large_step);
    return select(0, weight / density, density > 0);
}

fn current_splat(weight: f32) -> Splat {
    let l = vec4f(kept(ChainRow_Light), kept(ChainRow_Light + 1), kept(ChainRow_Light + 2), kept(ChainRow_Light + 3));
    return Splat(vec2f(kept(ChainRow_Film), kept(ChainRow_Film + 1)), kept(ChainRow_Wavelength), 0, l * weight);
}

// Makes the proposed point the current one.
fn accept(found: Contribution, weight: f32) {
    for (var i = 0u; i < dimensions(); i++) {
        keep(ChainRow_Point + i, coordinate(i));
    }
    keep(ChainRow_Scalar, found.scalar);
    keep(ChainRow_Weight, weight);
    keep(ChainRow_Film, found.film.x);
    keep(ChainRow_Film + 1, found.film.y);
    keep(ChainRow_Wavelength, found.wavelength);
    for (var i = 0u; i < 4; i++) {
        keep(ChainRow_Light + i, found.l[i]);
    }
}

// Takes a step: light of the one of the two points that the chain leaves.
fn leave_one() -> Splat {
    // Of these numbers no coordinate is made.
    let u = step_numbers(dimensions());
    is_large = step_ == 0 || u.x < batch.large;
    let found = contribution();
    if (step_ == 0) {
        accept(found, 0);
        return Splat();
    }
    let scalar = kept(ChainRow_Scalar);
    let a = select(1, found.scalar / scalar, found.scalar < scalar);
    let weight = kept(ChainRow_Weight) + weight_of(1 - a, false, scalar);
    let of_found = weight_of(a, is_large, found.scalar);
    if (u.y < a) {
        let left = current_splat(weight);
        accept(found, of_found);
        return left;
    }
    keep(ChainRow_Weight, weight);
    return Splat(found.film, found.wavelength, 0, found.l * of_found);
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    chain = id.x;
    if (chain >= batch.count) {
        return;
    }
    rays = 0;
    let last = batch.mutations + u32(chain < batch.longer);
    for (var i = 0u; i < batch.steps; i++) {
        step_ = batch.step + i;
        var splat: Splat;
        if (step_ <= last) {
            splat = leave_one();
        } else if (step_ == last + 1) {
            splat = current_splat(kept(ChainRow_Weight));
        }
        batch.splats[i * batch.count + chain] = splat;
    }
    table[place_in(ChainRow_Rays)] += rays;
}
