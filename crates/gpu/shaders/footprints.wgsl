// The footprints of pixels on surfaces, over which textures are averaged ([Igehy 1999];
// [Pharr 2023 §10.1]).

// The rays of the neighbouring pixels of a ray, if these are known.
struct Differentials {
    rx_origin: vec3f,
    rx_direction: vec3f,
    ry_origin: vec3f,
    ry_direction: vec3f,
    are_known: bool,
}

fn no_differentials() -> Differentials {
    return Differentials(vec3f(), vec3f(), vec3f(), vec3f(), false);
}

// The texture context of a point that a ray has hit.
fn texture_context(s: Surface, d: Differentials) -> TextureContext {
    var across = array(vec3f(), vec3f());
    if (world.has_footprints == 1) {
        across = pixel_on_plane(s, d);
    }
    return TextureContext(s.p.p, s.n, s.uv, Footprint_new(across, array(s.dpdu, s.dpdv)));
}

// ∂p/∂x and ∂p/∂y of the plane of a point: of its own rays or, where these are not known, as if the
// camera saw it directly.
fn pixel_on_plane(s: Surface, d: Differentials) -> array<vec3f, 2> {
    let p = s.p.p;
    if (d.are_known) {
        let x = on_plane(d.rx_origin, d.rx_direction, p, s.n);
        let y = on_plane(d.ry_origin, d.ry_direction, p, s.n);
        if (x.v1 && y.v1) {
            return array(x.v0, y.v0);
        }
    }
    let camera = placed_camera();
    let in_camera = times(inverse(camera.rotation), p - camera.translation);
    var way = Vec3_normalize_masked(in_camera);
    var distance = length(in_camera);
    let is_parallel = word(world.camera) == CameraTag_Orthographic && camera.lens.radius <= 0;
    if (is_parallel || !way.v1) {
        way.v0 = vec3f(0, 0, 1);
        distance = select(distance, in_camera.z, is_parallel);
    }
    let at = world.camera + 28;
    let least =
        MinimumDifferentials(array(vector(at), vector(at + 4)), array(vector(at + 8), vector(at + 12)));
    let n = transposed(camera.rotation, s.n);
    let across = MinimumDifferentials_dp_dxy(least, way.v0, distance, n);
    let scale = number(world.camera + 23);
    return array(times(camera.rotation, across[0] * scale), times(camera.rotation, across[1] * scale));
}

// The neighbours of a ray that leaves a smooth surface along a sample.
fn scattered_differentials(s: Surface, context: TextureContext, from_: Differentials, sample: BsdfSample) -> Differentials {
    if (!from_.are_known || (sample.flags & BxdfFlags_SPECULAR) == 0) {
        return no_differentials();
    }
    let f = context.footprint;
    let wo = s.wo;
    let wi = sample.wi;
    var n = s.ns;
    var dndx = s.dndu * f.dudx + s.dndv * f.dvdx;
    var dndy = s.dndu * f.dudy + s.dndv * f.dvdy;
    let dwodx = -from_.rx_direction - wo;
    let dwody = -from_.ry_direction - wo;
    var d = Differentials(s.p.p + f.dpdx, vec3f(), s.p.p + f.dpdy, vec3f(), true);
    if ((sample.flags & BxdfFlags_REFLECTION) != 0) {
        d.rx_direction = wi - dwodx + 2 * (dndx * dot(wo, n) + n * (dot(dwodx, n) + dot(wo, dndx)));
        d.ry_direction = wi - dwody + 2 * (dndy * dot(wo, n) + n * (dot(dwody, n) + dot(wo, dndy)));
    } else {
        if (dot(wo, n) < 0) {
            n = -n;
            dndx = -dndx;
            dndy = -dndy;
        }
        let eta = 1 / sample.eta;
        let cosine = dot(wo, n);
        let mu = eta * cosine - abs(dot(wi, n));
        let slope = eta + eta * eta * cosine / dot(wi, n);
        d.rx_direction = wi - dwodx * eta + n * ((dot(dwodx, n) + dot(wo, dndx)) * slope) + dndx * mu;
        d.ry_direction = wi - dwody * eta + n * ((dot(dwody, n) + dot(wo, dndy)) * slope) + dndy * mu;
    }
    // Differentials too large for filtering are dropped; NaN is, too.
    let place = abs(s.p.p);
    let far = 1e8 * max(max(place.x, place.y), max(place.z, 1));
    let directions = max(dot(d.rx_direction, d.rx_direction), dot(d.ry_direction, d.ry_direction));
    let origins = max(dot(d.rx_origin, d.rx_origin), dot(d.ry_origin, d.ry_origin));
    d.are_known = directions < 1e16 && origins < far * far;
    return d;
}
