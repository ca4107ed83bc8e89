// Camera rays: the records of `src/flatten/cameras.rs` and `filters.rs`.

// The offset from the centre of a pixel that a filter draws, and the weight of the sample: its sign
// where the filter is tabulated, which leaves a pixel as it is.
fn filter_sample(u: vec2f) -> vec3f {
    let at = world.pixel_filter;
    let head = words_at(at);
    let radius = bitcast<vec2f>(head.yz);
    switch (head.x) {
        case FilterTag_Box: { return vec3f(-radius + (radius - -radius) * u, 1); }
        case FilterTag_Triangle: { return vec3f(sample_tent(u.x, radius.x), sample_tent(u.y, radius.y), 1); }
        default: {}
    }
    let table = head.w;
    let offset = draw_2d(table, u).xy;
    let count = words_at(table).xy;
    let cell = min(vec2u((offset / radius + 1) * 0.5 * vec2f(count)), count - 1);
    let index = cell.y * count.x + cell.x;
    let is_negative = ((word(word(at + 4) + index / 32) >> (index & 31)) & 1) == 1;
    return vec3f(offset, select(1.0, -1.0, is_negative));
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
    let sides = numbers_at(at + 16);
    let screen = Screen(sides.xy, sides.zw);
    let opening = numbers_at(at + 20);
    let lens = ThinLens(opening.x, opening.y);
    if (word(at + 1) == 1) {
        let placement = placement_at(kept_motion(at + 44), shutter_time);
        return PlacedCamera(placement.linear, placement.translation, screen, lens);
    }
    let placement = kept_placement(at + 4);
    return PlacedCamera(placement.linear, placement.translation, screen, lens);
}

// The direction of a position on the square of a spherical camera.
fn spherical_ray(st: vec2f) -> vec3f {
    var z_up: vec3f;
    if (word(world.camera) == CameraTag_EquiRectangular) {
        let theta = sin_cos(3.1415927 * st.y);
        z_up = spherical_direction(theta.v0, theta.v1, 6.2831855 * st.x);
    } else {
        z_up = equal_area_square_to_sphere(wrap_equal_area_square(st));
    }
    return z_up.xzy;
}

// The ray of a film position and a position on the lens, of any length.
fn unscaled_ray(camera: PlacedCamera, film: vec2f, lens: vec2f) -> Ray {
    var ray: Tuple_Vec3_Vec3;
    switch (word(world.camera)) {
        case CameraTag_Perspective: { ray = Perspective_ray(Perspective(camera.screen, camera.lens), film, lens); }
        case CameraTag_Orthographic: { ray = Orthographic_ray(Orthographic(camera.screen, camera.lens), film, lens); }
        default: { ray = Tuple_Vec3_Vec3(vec3f(), spherical_ray(film / camera.screen.top_left)); }
    }
    return placed_ray(camera, ray.v0, ray.v1);
}

fn placed_ray(camera: PlacedCamera, o: vec3f, d: vec3f) -> Ray {
    return Ray_new(times(camera.rotation, o) + camera.translation, times(camera.rotation, d), 0);
}

// The camera ray along a ray of any length.
fn from_camera(ray: Ray) -> Ray {
    return Ray(ray.o, Vec3_normalize(ray.d), shutter_time, CameraEnd_Origin);
}

fn set_shutter_time(u: f32) {
    if (HAS_MOTION || word(world.camera + 1) == 1) {
        let shutter = numbers_at(world.camera + 24).xy;
        shutter_time = lerp(u, shutter.x, shutter.y);
    }
}

// A camera ray of unit direction, its neighbours, and the share of its light that reaches the film.
struct CameraRay {
    ray: Ray,
    near: Differentials,
    share: f32,
}

// The ray of a film position; if anything depends on them, also those of the pixels to the right
// and below, through the same point of the lens, brought as near as other samples of the pixel are.
fn camera_ray(film: vec2f, lens: vec2f) -> CameraRay {
    let camera = placed_camera();
    let has_neighbours = world.has_footprints == 1;
    // Of a sphere, on which lines of pixels bend, by rays nearer than a pixel.
    let kind = word(world.camera);
    let step = select(1.0, 0.05, kind == CameraTag_EquiRectangular || kind == CameraTag_EqualArea);
    var rays_of_film: array<Ray, 3>;
    var share = 1.0;
    var seen: array<LensRay, 3>;
    if (HAS_LENSES) {
        seen = lens_rays(film, lens, has_neighbours);
        share = seen[0].share;
    }
    for (var i = 0u; i < select(1u, 3u, has_neighbours); i++) {
        if (HAS_LENSES) {
            rays_of_film[i] = placed_ray(camera, seen[i].o, seen[i].d);
        } else {
            rays_of_film[i] = unscaled_ray(camera, film + step * vec2f(f32(i == 1), f32(i == 2)), lens);
        }
    }
    let ray = rays_of_film[0];
    if (!has_neighbours) {
        return CameraRay(from_camera(ray), no_differentials(), share);
    }
    let rx = rays_of_film[1];
    let ry = rays_of_film[2];
    let factor = 1 / length(ray.d);
    let d = ray.d * factor;
    let scale = number(world.camera + 22) / step;
    let near = Differentials(
        ray.o + (rx.o - ray.o) * scale, d + (rx.d * factor - d) * scale,
        ray.o + (ry.o - ray.o) * scale, d + (ry.d * factor - d) * scale, true,
    );
    return CameraRay(from_camera(ray), near, share);
}

// A sample of a pixel: the camera ray, its wavelengths, and its weight in the pixel.
struct CameraSample {
    ray: Ray,
    near: Differentials,
    lambda: SampledWavelengths,
    // The random number of the wavelengths.
    wavelength: f32,
    position: vec2f,
    weight: f32,
    // The share of the light along the ray that reaches the film.
    share: f32,
}

// The wavelengths of a random number: uniform over the range that a spectral film wants. Where the
// view fixes them, they are the format's.
fn sampled_wavelengths(u: f32) -> SampledWavelengths {
    let range = numbers_at(world.camera + 24).zw;
    let is_uniform = range.y > range.x;
    if (world.has_one_wavelength == 1) {
        if (is_uniform) {
            return SampledWavelengths_fixed_uniform_in(range.x, range.y);
        }
        return SampledWavelengths_fixed_visible();
    }
    if (is_uniform) {
        return SampledWavelengths_sample_uniform_in(u, range.x, range.y);
    }
    return SampledWavelengths_sample_visible(u);
}

// The sample of an index. Dimensions are used as on the CPU: wavelengths, position in the pixel's
// filter, time, position on the lens, and then those of the algorithm.
fn camera_sample(pixel: vec2u, index: u32) -> CameraSample {
    place = Address(array(pixel.x, pixel.y), index, 0);
    var u: array<vec2f, 4>;
    for (var i = 0u; i < 4; i++) {
        u[i] = next_numbers((i & 1) == 1);
    }
    let is_centered = world.is_centered == 1;
    let drawn = select(filter_sample(u[1]), vec3f(0, 0, 1), is_centered);
    let position = vec2f(pixel) + 0.5 + drawn.xy;
    set_shutter_time(select(u[2].x, 0.5, is_centered));
    let camera = camera_ray(position, select(u[3], vec2f(0.5), is_centered));
    let wavelength = u[0].x;
    return CameraSample(
        camera.ray,
        camera.near,
        sampled_wavelengths(wavelength),
        wavelength,
        position,
        drawn.z,
        camera.share,
    );
}
