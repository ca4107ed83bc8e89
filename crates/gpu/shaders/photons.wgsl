// Stochastic progressive photon mapping: `integrators/src/photons/sppm.rs`.
//
// The kernel first makes light paths, a thread each, which writes photons to places of its own.
// The CPU sorts them into a grid. Then the kernel makes camera paths, a thread each, which adds the
// photons around its end. Sums have the order of the grid, whatever that of threads was.

// A little more than 1, to cover rounding errors.
const MARGIN = 1.000001;

// The words of a photon, in quadruples: position and cosine to the normal; direction to the
// previous vertex, depth and whether only the first wavelength is left; power.
const PHOTON = 3u;
const HERO_ONLY = 0x10000u;

@group(0) @binding(5) var<storage, read_write> batch: Batch;
@group(0) @binding(6) var<storage, read_write> samples: array<PixelSample>;

// Whether camera paths end at a surface of these lobes, and photons are stored.
fn is_diffuse(flags: u32) -> bool {
    return (flags & BxdfFlags_DIFFUSE) != 0 && (flags & BxdfFlags_SPECULAR) == 0;
}

fn keep_photon(at: u32, v: Vertex, alpha: f32) {
    let hero_only = select(0, HERO_ONLY, v.hero_only);
    batch.words[at] = bitcast<vec4u>(vec4f(v.p.p, cos_theta(v, v.wo)));
    batch.words[at + 1] = vec4u(bitcast<vec3u>(v.wo), v.depth | hero_only);
    batch.words[at + 2] = bitcast<vec4u>(v.beta / alpha);
}

fn cell_of(p: vec3f) -> vec3i {
    return vec3i(floor(p * batch.cells_per_length));
}

fn bucket_of(cell: vec3i) -> u32 {
    let words = vec3u(cell) * vec3u(0x8da6b343u, 0xd8163841u, 0xcb1ab31fu);
    var mixed = words.x ^ words.y ^ words.z;
    mixed = (mixed ^ (mixed >> 15)) * 0x2c1b3c6du;
    return (mixed ^ (mixed >> 16)) & (batch.buckets - 1);
}

fn start_of(bucket: u32) -> u32 {
    let word = batch.starts + bucket;
    return batch.words[word / 4][word % 4];
}

// The light of a photon that is merged with the end of a camera path, as if it had arrived there.
fn merged(v: Vertex, wi: vec3f, photon_cosine: f32, beta: vec4f, hero_only: bool) -> vec4f {
    let cosine = scattering_cosine(v, wi);
    let over = max(cos_theta(v, wi), min(photon_cosine, cosine));
    let cosines = select(cosine / over, 0, over == 0);
    let l = v.beta * beta * bsdf_f(v.bsdf, v.wo, wi) * (cosines / batch.merging);
    return hero_of(l, v.hero_only || hero_only);
}

// The light of the photons around a vertex. Other cells may have the same bucket.
fn gathered(v: Vertex) -> vec4f {
    var sum = vec4f();
    let reach = batch.radius * MARGIN;
    let low = cell_of(v.p.p - reach);
    let high = cell_of(v.p.p + reach);
    for (var z = low.z; z <= high.z; z++) {
        for (var y = low.y; y <= high.y; y++) {
            for (var x = low.x; x <= high.x; x++) {
                let cell = vec3i(x, y, z);
                let bucket = bucket_of(cell);
                let end = start_of(bucket + 1);
                for (var i = start_of(bucket); i < end; i++) {
                    let at = bitcast<vec4f>(batch.words[PHOTON * i]);
                    let way = at.xyz - v.p.p;
                    if (dot(way, way) > batch.radius * batch.radius || any(cell_of(at.xyz) != cell)) {
                        continue;
                    }
                    let from_ = batch.words[PHOTON * i + 1];
                    if (v.depth + (from_.w & (HERO_ONLY - 1)) - 1 > world.max_depth) {
                        continue;
                    }
                    let beta = bitcast<vec4f>(batch.words[PHOTON * i + 2]);
                    sum += merged(v, bitcast<vec3f>(from_.xyz), at.w, beta, (from_.w & HERO_ONLY) != 0);
                }
            }
        }
    }
    return sum;
}

// The light along a subpath from the camera; the photons of one from a light go to places from
// `photons` on.
fn light_of(start: Subpath, lambda: SampledWavelengths, photons: u32) -> vec4f {
    var l = vec4f();
    var walk = start;
    var count = 0u;
    var before: ShapeSampleContext;
    while (walk.goes_on) {
        let hit = nearest(walk.ray);
        if (looked_back(&walk, hit)) {
            continue;
        }
        var s: Surface;
        if (hit.found) {
            s = surface_at(hit, walk.ray);
        }
        if (!is_light_path) {
            l += lights_met(walk, before, hit, s);
        }
        if (!hit.found || walk.depth == world.max_depth) {
            break;
        }
        let arrival = arrive(&walk, &s, hit.t);
        let is_end = !is_light_path && is_diffuse(arrival.flags);
        // What chooses the light and its point, and the lobe and its direction.
        var u: array<vec2f, 4>;
        let connects = !is_light_path && is_non_specular(arrival.flags);
        for (var i = select(2u, 0u, connects); i < select(4u, 2u, is_end); i++) {
            u[i] = next_numbers((i & 1) == 1);
        }
        if (connects) {
            var c = connection_to_light(arrival.v, arrival.context, lambda, u[0].x, u[1]);
            c.is_only = is_end;
            l += light_along(c, arrival.v, false, arrival.v);
        }
        if (is_end) {
            l += gathered(arrival.v);
            break;
        }
        if (is_light_path && walk.depth > 1 && is_diffuse(arrival.flags)) {
            keep_photon(photons + PHOTON * count, arrival.v, alpha_at(hit, s));
            count++;
        }
        if (is_light_path && walk.depth == world.max_depth) {
            break;
        }
        leave(&walk, arrival, s, u[2].x, u[3]);
        survive(&walk);
        before = arrival.context;
    }
    if (is_light_path) {
        for (; count < batch.most; count++) {
            batch.words[photons + PHOTON * count + 1] = vec4u();
        }
    }
    return l;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let index = id.y * batch.size.x + id.x;
    if (any(id.xy >= batch.size) || (batch.makes_photons == 1 && index >= batch.count)) {
        return;
    }
    rays = 0;
    var camera: CameraSample;
    is_light_path = batch.makes_photons == 1;
    if (!is_light_path) {
        camera = camera_sample(batch.low + id.xy, batch.pass_number);
    } else {
        place = Address(array(batch.pass_number, 0u), batch.first + index, 0);
    }
    camera.lambda = SampledWavelengths(batch.lambda, batch.pdf);
    var walk: Subpath;
    if (is_light_path) {
        walk = light_subpath(camera.lambda);
    } else {
        walk = camera_subpath(camera);
    }
    let l = light_of(walk, camera.lambda, PHOTON * batch.most * index);
    if (is_light_path) {
        atomicAdd(&batch.rays, rays);
    } else {
        samples[index] = PixelSample(l, rays, 0, camera.wavelength, camera.weight);
    }
}
