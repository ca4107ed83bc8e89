// The camera as seen from the scene: `scene/src/camera/importance.rs`.

// Film position and densities of a ray from the lens, both times per pixel, and the normal of the
// lens.
struct Seen {
    film: vec2f,
    n: vec3f,
    cos_theta: f32,
    pdf_position: f32,
    pdf_direction: f32,
    valid: bool,
}

// A point of the lens, as a point of the scene sees it.
struct LensSample {
    // Importance over the density, and the unit direction to the lens.
    we: f32,
    wi: vec3f,
    p: vec3f,
    seen: Seen,
}

// Whether all camera rays are parallel.
fn is_parallel() -> bool {
    return word(world.camera) == CameraTag_Orthographic && number(world.camera + 20) <= 0;
}

// The ray from a point of the lens along a unit direction, both in camera space.
fn seen_along(camera: PlacedCamera, o: vec3f, d: vec3f) -> Seen {
    var seen: Seen;
    if (!(d.z > 0)) {
        return seen;
    }
    let per_pixel = camera.screen.per_pixel;
    let per_area = 1 / abs(per_pixel.x * per_pixel.y);
    let radius = camera.lens.radius;
    let distance = camera.lens.focal_distance;
    var on_screen = o.xy;
    var density = per_area;
    if (!is_parallel()) {
        // The point in focus.
        var focus = vec3f(d.xy / d.z, 1);
        if (radius > 0) {
            focus = vec3f((o + d * (distance / d.z)).xy, distance);
        }
        let is_perspective = word(world.camera) == CameraTag_Perspective;
        on_screen = select(focus.xy, focus.xy / focus.z, is_perspective);
        density *= select(focus.z * focus.z, 1, is_perspective) / (d.z * d.z * d.z);
    }
    seen.film = (on_screen - camera.screen.top_left) / per_pixel;
    // The factors of the camera's transform on areas of the lens and on solid angles.
    let m = camera.rotation;
    let volume = abs(dot(m.x, cross(m.y, m.z)));
    let normal = inverse(m).z;
    let along = length(times(m, d));
    let area = volume * length(normal);
    if (is_parallel()) {
        seen.pdf_position = density / area;
        seen.pdf_direction = 1;
    } else {
        seen.pdf_position = select(1.0, 1 / (3.1415927 * radius * radius * area), radius > 0);
        seen.pdf_direction = density * (along * along * along) / volume;
    }
    seen.n = Vec3_normalize(normal);
    seen.cos_theta = d.z / (length(normal) * along);
    seen.valid = true;
    return seen;
}

// The densities of a camera ray.
fn seen_from_camera(ray: Ray) -> Seen {
    let camera = placed_camera();
    let inward = inverse(camera.rotation);
    let o = times(inward, ray.o - camera.translation);
    return seen_along(camera, o, Vec3_normalize(times(inward, ray.d)));
}

// A point of the lens that `u` chooses for a point of the scene.
fn sample_lens(p: vec3f, u: vec2f) -> LensSample {
    let camera = placed_camera();
    let from_ = times(inverse(camera.rotation), p - camera.translation);
    var on_lens = ThinLens_at(camera.lens, u);
    if (is_parallel()) {
        on_lens = vec3f(from_.xy, 0);
    }
    var sample: LensSample;
    sample.seen = seen_along(camera, on_lens, Vec3_normalize(from_ - on_lens));
    sample.p = times(camera.rotation, on_lens) + camera.translation;
    let way = sample.p - p;
    sample.wi = Vec3_normalize(way);
    let seen = sample.seen;
    let we = seen.pdf_position * seen.pdf_direction / seen.cos_theta;
    let pdf = select(seen.pdf_position * dot(way, way) / seen.cos_theta, 1, is_parallel());
    sample.we = we / pdf;
    return sample;
}
