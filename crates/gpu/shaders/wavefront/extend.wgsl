// Finds what the rays of paths hit, and sorts that by kinds of materials.

// The queue of a hit: of those that hit nothing, and then of each kind that is hit; one for all
// where there is one kind.
fn queue_of(hit: Hit) -> u32 {
    if (batch.sorts == 1 || !hit.found) {
        return HITS;
    }
    let kind = word(material_record(word(world.geometries + 8 * hit.geometry)));
    return HITS + 1 + countOneBits(batch.kinds & ((1u << kind) - 1));
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) local: u32) {
    let path = path_in(PATHS, id.x, batch.going_on + batch.beginning);
    var queue = HITS;
    if (path != NO_PATH) {
        let o = numbers(RAY_O, path);
        shutter_time = o.w;
        if (HAS_SINGLE_SIDED) {
            end_at_camera = row(NS, path).w;
        }
        let hit = trace(o.xyz, numbers(RAY_D, path).xyz, infinity(), false);
        let bits = select(0u, FOUND, hit.found) | select(0u, IS_TRIANGLE, hit.is_triangle);
        keep(HIT, path, vec4u(bitcast<u32>(hit.t), bitcast<vec2u>(hit.uv), hit.geometry));
        keep(HIT_IDS, path, vec4u(hit.primitive, hit.place, hit.instance, bits));
        queue = queue_of(hit);
    }
    append(queue, path, path != NO_PATH, local);
}
