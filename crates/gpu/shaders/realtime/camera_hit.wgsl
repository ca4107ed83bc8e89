// The hits of the camera rays of a frame in motion. They are found once, and kept where the light of
// their pixels will be.

// Indices are kept as the bits of numbers that are neither denormal nor infinite.
const INDEX = 0x40000000u;

fn kept_index(index: u32) -> f32 {
    return bitcast<f32>(INDEX | index);
}

fn index_of(kept: f32) -> u32 {
    return bitcast<u32>(kept) & ~INDEX;
}

fn keep_hit(at: u32, hit: Hit) {
    let kind = select(0u, select(1u, 2u, hit.is_triangle), hit.found);
    film.pixels[at].now = vec4f(hit.t, hit.uv, kept_index(hit.place));
    // Outside of instances the index is that before 0.
    film.pixels[at].sum = vec4f(f32(kind), kept_index(hit.instance + 1), 0, 0);
}

fn kept_hit(at: u32) -> Hit {
    let first = film.pixels[at].now;
    let second = film.pixels[at].sum;
    var hit: Hit;
    hit.t = first.x;
    hit.uv = first.yz;
    hit.place = index_of(first.w);
    hit.instance = index_of(second.y) - 1;
    hit.found = second.x != 0;
    hit.is_triangle = second.x == 2;
    if (hit.is_triangle) {
        hit.geometry = triangles[3 * hit.place].w;
        hit.primitive = triangles[3 * hit.place + 1].w;
    } else if (hit.found) {
        let ids = items[5 * hit.place + 4];
        hit.geometry = ids.y;
        hit.primitive = ids.z;
    }
    return hit;
}
