// What paths do at what their rays have hit, those at materials of a kind after each other.

// The path of a thread in the queues of hits.
fn path_in_hits(i: u32) -> u32 {
    var rest = i;
    for (var queue = HITS; queue < HITS + batch.sorts; queue++) {
        let length = atomicLoad(&batch.lengths[queue]);
        if (rest < length) {
            return batch.queues[queue * batch.places + rest];
        }
        rest -= length;
    }
    return NO_PATH;
}

fn kept_hit(path: u32) -> Hit {
    let found = row(HIT, path);
    let ids = row(HIT_IDS, path);
    let uv = bitcast<vec2f>(found.yz);
    let is_triangle = (ids.w & IS_TRIANGLE) != 0;
    return Hit(bitcast<f32>(found.x), uv, found.w, ids.x, ids.y, is_triangle, ids.z, (ids.w & FOUND) != 0);
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) local: u32) {
    let index = path_in_hits(id.x);
    var goes_on = false;
    var has_shadow = false;
    if (index != NO_PATH) {
        let sample = sample_of(index);
        var path = kept_path(index, sample);
        var lambda = kept_wavelengths(index);
        var l = kept_light(sample);
        var direct: DirectLight;
        goes_on = shade(&path, kept_hit(index), &lambda, &direct, &l);
        has_shadow = !is_black(direct.l);
        if (has_shadow) {
            keep_numbers(SHADOW_O, index, vec4f(direct.shadow.ray.o, direct.shadow.t_max));
            keep_numbers(SHADOW_D, index, vec4f(direct.shadow.ray.d, 0));
            keep_numbers(DIRECT, index, direct.l);
        }
        // That which was followed here, and the shadow ray.
        rays += 1 + u32(has_shadow);
        keep_path(index, sample, path, lambda, l);
    }
    append(select(ENDED, PATHS, goes_on), index, index != NO_PATH, local);
    append(SHADOWS, index, has_shadow, local);
}
