// Camera rays: the records of `src/flatten/cameras.rs` and `filters.rs`.

const FILTER_BOX = 0u;
const FILTER_TRIANGLE = 1u;
const PERSPECTIVE = 0u;
const ORTHOGRAPHIC = 1u;

// The offset from the centre of a pixel that a filter draws.
fn filter_offset(u: vec2f) -> vec2f {
    let at = world.pixel_filter;
    let radius = vec2f(number(at + 1), number(at + 2));
    switch (tables[at]) {
        case FILTER_BOX: { return -radius + (radius - -radius) * u; }
        case FILTER_TRIANGLE: { return vec2f(sample_tent(u.x, radius.x), sample_tent(u.y, radius.y)); }
        default: { return draw_2d(tables[at + 3], u).xy; }
    }
}

// A camera in render space.
struct PlacedCamera {
    rotation: Rows,
    translation: vec3f,
    screen: Screen,
    lens: ThinLens,
}

fn placed_camera() -> PlacedCamera {
    let at = world.camera;
    let row = at + 1;
    let screen = Screen(vec2f(number(at + 13), number(at + 14)), vec2f(number(at + 15), number(at + 16)));
    return PlacedCamera(
        Rows(vector(row), vector(row + 4), vector(row + 8)),
        vec3f(number(row + 3), number(row + 7), number(row + 11)),
        screen,
        ThinLens(number(at + 17), number(at + 18)),
    );
}

// The ray of a film position and a position on the lens, of any length.
fn unscaled_ray(camera: PlacedCamera, film: vec2f, lens: vec2f) -> Ray {
    var ray: Tuple_Vec3_Vec3;
    if (tables[world.camera] == PERSPECTIVE) {
        ray = Perspective_ray(Perspective(camera.screen, camera.lens), film, lens);
    } else {
        ray = Orthographic_ray(Orthographic(camera.screen, camera.lens), film, lens);
    }
    return Ray(times(camera.rotation, ray.v0) + camera.translation, times(camera.rotation, ray.v1), 0);
}

// A camera ray of unit direction.
fn camera_ray(film: vec2f, lens: vec2f) -> Ray {
    let ray = unscaled_ray(placed_camera(), film, lens);
    return Ray(ray.o, Vec3_normalize(ray.d), 0);
}

// The rays of the pixels to the right and below, through the same point of the lens, brought as
// near to the camera ray as other samples of the pixel are.
fn camera_differentials(film: vec2f, lens: vec2f) -> Differentials {
    if (world.has_footprints == 0) {
        return no_differentials();
    }
    let camera = placed_camera();
    let ray = unscaled_ray(camera, film, lens);
    let rx = unscaled_ray(camera, film + vec2f(1, 0), lens);
    let ry = unscaled_ray(camera, film + vec2f(0, 1), lens);
    let factor = 1 / length(ray.d);
    let d = ray.d * factor;
    let scale = number(world.camera + 19);
    return Differentials(
        ray.o + (rx.o - ray.o) * scale, d + (rx.d * factor - d) * scale,
        ray.o + (ry.o - ray.o) * scale, d + (ry.d * factor - d) * scale, true,
    );
}
