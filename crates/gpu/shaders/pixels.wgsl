// A sample of each pixel of a batch: the camera ray, and the radiance along it.
//
// Dimensions are used as on the CPU: wavelengths, position in the pixel's filter, time, position on
// the lens, and then those of the algorithm.

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if (any(id.xy >= batch.size)) {
        return;
    }
    let pixel = batch.low + id.xy;
    place = Address(array(pixel.x, pixel.y), batch.index, 0);
    rays = 0;
    let wavelength = get_1d();
    let film = get_2d();
    let time = get_1d();
    let lens = get_2d();
    let center = vec2f(pixel) + 0.5;
    var lambda = SampledWavelengths_sample_visible(select(wavelength, 0.5, world.has_one_wavelength == 1));
    let is_centered = world.is_centered == 1;
    let position = center + select(filter_offset(film), vec2f(), is_centered);
    let on_lens = select(lens, vec2f(0.5), is_centered);
    let near = camera_differentials(position, on_lens);
    let l = radiance(camera_ray(position, on_lens), near, &lambda);
    let is_terminated = u32(SampledWavelengths_secondary_terminated(lambda));
    samples[id.y * batch.size.x + id.x] = Sample(l, rays, is_terminated, vec2u());
}
