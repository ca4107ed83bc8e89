// The first samples of a frame: of each pixel one of some candidates, by what they find.

const CANDIDATES = 8u;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (any(id.xy >= frame.size)) {
        return;
    }
    let at = id.y * frame.size.x + id.x;
    let camera = camera_sample(frame.low + id.xy, frame.index);
    rays = 0;
    let hit = nearest(camera.ray);
    var r: Reservoir;
    if (hit.found) {
        r.o = camera.ray.o;
        r.d = camera.ray.d;
        r.t = hit.t;
        r.uv = hit.uv;
        r.geometry = hit.geometry;
        r.primitive = hit.primitive;
        r.place = hit.place;
        r.instance = hit.instance;
        r.kind = select(SHAPE_RECEIVER, TRIANGLE_RECEIVER, hit.is_triangle);
        r.count = 1;
    }
    var lambda = common_wavelengths();
    let receiver = receiver_of(r, no_differentials(), &lambda);
    r.normal = packed_normal(seen_normal(receiver.s));
    place.dimension = FIRST_DIMENSION;
    var sum = 0.0;
    var aim = 0.0;
    var light = no_light();
    for (var i = 0u; i < CANDIDATES && receiver.receives; i++) {
        // What chooses the light and its point, and whether it is taken.
        var u: array<vec2f, 3>;
        for (var j = 0u; j < 3; j++) {
            u[j] = next_numbers(j == 1);
        }
        let choice = choose_light(receiver.context, u[0].x);
        if (!choice.valid) {
            continue;
        }
        let dimension = place.dimension;
        place.dimension = 0;
        let found = find(receiver, choice.light, u[1], lambda);
        let here = aim_of(found);
        place.dimension = dimension;
        let weight = here / choice.pmf;
        sum += weight;
        if (weight > 0 && u[2].x * sum < weight) {
            r.light = choice.light;
            r.u = u[1];
            aim = here;
            light = found.light;
        }
    }
    if (aim > 0 && is_visible(receiver, light)) {
        r.weight = sum / (f32(CANDIDATES) * aim);
    }
    reservoirs[reuse.target_part * frame.size.x * frame.size.y + at] = r;
    atomicAdd(&film.rays, rays);
}
