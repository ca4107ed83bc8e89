// Light paths that are connected to the camera and, with camera paths, bidirectional path tracing:
// `integrators/src/bidirectional/`.
//
// A thread makes a light path and then a camera path by one loop, so that drivers, which inline all
// calls, have each long function once. Contributions to the film of light paths go to a list.

@group(0) @binding(5) var<storage, read_write> batch: Batch;
@group(0) @binding(6) var<storage, read_write> samples: array<PixelSample>;

var<private> light_vertices: array<Vertex, MOST_VERTICES>;

// The weighted light of all connections of a vertex, the first of which `u` chooses and the point
// at its other end `u_point`; that of one to the camera is splatted.
fn connected(
    v: Vertex,
    context: ShapeSampleContext,
    lambda: SampledWavelengths,
    u: f32,
    u_point: vec2f,
    count: u32,
    path: u32,
) -> vec4f {
    var sum = vec4f();
    for (var i = 0u; i <= count; i++) {
        var c: Connection;
        var other: Vertex;
        let is_vertex = HAS_CAMERA_PATHS && i > 0;
        if (is_light_path) {
            c = connection_to_camera(v, u_point);
        } else if (!is_vertex) {
            c = connection_to_light(v, context, lambda, u, u_point);
        } else {
            other = light_vertices[i - 1];
            c = connection_to_vertex(v, other);
        }
        let l = light_along(c, v, is_vertex, other);
        if (!is_light_path) {
            sum += l;
        } else if (!is_black(l)) {
            let place = atomicAdd(&batch.count, 1u);
            if (place < batch.most) {
                batch.splats[place] = Splat(c.film, path, 0, l);
            }
        }
    }
    return sum;
}

// The light of the paths of a pixel, but for what they splat.
fn light_of(camera: CameraSample, path: u32) -> vec4f {
    var l = vec4f();
    let camera_place = place;
    place.dimension = 0;
    is_light_path = true;
    var walk = light_subpath(camera.lambda);
    var count = 0u;
    var before: ShapeSampleContext;
    loop {
        if (!walk.goes_on || (is_light_path && walk.depth == world.max_depth)) {
            if (!is_light_path) {
                break;
            }
            is_light_path = false;
            place = camera_place;
            walk = camera_subpath(camera);
        }
        let hit = nearest(walk.ray);
        if (looked_back(&walk, hit)) {
            continue;
        }
        var s: Surface;
        if (hit.found) {
            s = surface_at(hit, walk.ray);
        }
        if (!is_light_path) {
            l += lights_met(walk, before, hit, s);
        }
        walk.goes_on = hit.found && (is_light_path || (HAS_CAMERA_PATHS && walk.depth < world.max_depth));
        if (!walk.goes_on) {
            continue;
        }
        let arrival = arrive(&walk, &s, hit.t);
        // What chooses the light and its point, or the point of the lens, and the lobe and its
        // direction.
        var u: array<vec2f, 4>;
        let connects = is_non_specular(arrival.flags);
        for (var i = select(2u, u32(is_light_path), connects); i < 4; i++) {
            u[i] = next_numbers((i & 1) == 1);
        }
        if (connects) {
            let others = select(count, 0, is_light_path);
            l += connected(arrival.v, arrival.context, camera.lambda, u[0].x, u[1], others, path);
            if (HAS_CAMERA_PATHS && is_light_path && walk.depth < world.max_depth) {
                light_vertices[count] = arrival.v;
                count++;
            }
        }
        leave(&walk, arrival, s, u[2].x, u[3]);
        survive(&walk);
        before = arrival.context;
    }
    return l;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (any(id.xy >= batch.size)) {
        return;
    }
    let camera = camera_sample(batch.low + id.xy, batch.index);
    let path = id.y * batch.size.x + id.x;
    rays = 0;
    let l = light_of(camera, path);
    samples[path] = PixelSample(l, rays, 0, camera.wavelength, camera.weight);
}
