// In place of lenses in kernels of other cameras.

struct LensRay {
    o: vec3f,
    d: vec3f,
    share: f32,
}

fn lens_rays(film: vec2f, u: vec2f, has_neighbours: bool) -> array<LensRay, 3> {
    return array<LensRay, 3>();
}
