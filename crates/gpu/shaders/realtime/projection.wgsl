// Where the camera of the frame before saw something.

// The position on its film of a point, or of a direction: in pixels of the frame, with their
// centres at whole numbers. The last component is 0 where that is nowhere.
fn place_before(v: vec3f, is_point: bool) -> vec3f {
    let p = vec4f(v, select(0.0, 1.0, is_point));
    let q = vec3f(dot(frame.eye.rows[0], p), dot(frame.eye.rows[1], p), dot(frame.eye.rows[2], p));
    var screen = q.xy;
    if (frame.eye.is_orthographic == 0) {
        if (q.z <= 0) {
            return vec3f();
        }
        screen /= q.z;
    }
    return vec3f((screen - frame.eye.screen.xy) / frame.eye.screen.zw - 0.5 - vec2f(frame.low), 1);
}
