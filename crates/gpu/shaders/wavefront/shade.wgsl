// What paths do at what their rays have hit.

fn kept_hit(path: u32) -> Hit {
    let found = row(HIT, path);
    let ids = row(HIT_IDS, path);
    let uv = bitcast<vec2f>(found.yz);
    let is_triangle = (ids.w & IS_TRIANGLE) != 0;
    return Hit(bitcast<f32>(found.x), uv, found.w, ids.x, ids.y, is_triangle, ids.z, (ids.w & FOUND) != 0);
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) local: u32) {
    let index = path_in(batch.turn, id.x);
    var goes_on = false;
    var has_shadow = false;
    if (index != NO_PATH) {
        var path = kept_path(index);
        var lambda = kept_wavelengths(index);
        var l = numbers(L, index);
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
        keep_path(index, path, lambda, l);
    }
    append(1 - batch.turn, index, goes_on, local);
    append(SHADOWS, index, has_shadow, local);
}
