// The camera `realistic`: rays through the elements of a lens, as `scene/src/camera/realistic.rs`
// and `lens.rs` have them; the record of `src/flatten/lenses.rs`.

// The step of finite differences, in pixels.
const LENS_STEP = 0.05;

// A ray on its way to the scene, in camera space, and the share of its light that is not blocked.
struct LensRay {
    o: vec3f,
    d: vec3f,
    share: f32,
}

// The point of a film position.
fn film_point(film: vec2f) -> vec3f {
    let at = world.camera;
    let sides = numbers_at(at + 16);
    let p = film * sides.xy - sides.zw;
    return vec3f(-p.x, p.y, 0);
}

// The value of a stop's picture; black beyond it.
fn stop_texel(mask: u32, p: vec2i) -> f32 {
    let size = vec2i(vec2u(word(mask), word(mask + 1)));
    if (any(p < vec2i()) || any(p >= size)) {
        return 0;
    }
    return number(mask + 2 + u32(p.y * size.x + p.x));
}

// The share of light that passes a point of a stop, in units of its radius.
fn stop_share(mask: u32, p: vec2f) -> f32 {
    if (mask == 0) {
        return select(0.0, 1.0, dot(p, p) <= 1);
    }
    let size = vec2f(f32(word(mask)), f32(word(mask + 1)));
    let place = vec2f(0.5 + 0.5 * p.x, 0.5 - 0.5 * p.y) * size - 0.5;
    let low = floor(clamp(place, vec2f(-2), size + 2));
    let part = place - low;
    var rows: vec2f;
    for (var y = 0; y < 2; y++) {
        let left = vec2i(low) + vec2i(0, y);
        rows[y] = mix(stop_texel(mask, left), stop_texel(mask, left + vec2i(1, 0)), part.x);
    }
    return mix(rows.x, rows.y, part.y);
}

// The ray that leaves the front for a ray from the film; all pass if apertures are open.
fn through_lens(from_: vec3f, towards: vec3f, is_open: bool) -> LensRay {
    let lens = word(world.camera + 2);
    let blocked = LensRay(vec3f(), vec3f(0, 0, 1), 0);
    var o = from_;
    var d = towards;
    var share = 1.0;
    for (var i = 0u; i < word(lens); i++) {
        let interface_ = numbers_at(lens + 4 + 4 * i);
        let vertex = vec3f(0, 0, interface_.x);
        let radius = interface_.y;
        let eta = interface_.z;
        let aperture = interface_.w;
        let q = o - vertex;
        if (radius == 0) {
            if (q.z * d.z > 0 || abs(d.z) < 1e-12) {
                return blocked;
            }
            o -= d * (q.z / d.z);
            if (!is_open) {
                share *= stop_share(word(lens + 2), o.xy / aperture);
                if (!(share > 0)) {
                    return blocked;
                }
            }
            continue;
        }
        // |q + t·d + (0, 0, R)| = |R|, by numbers relative to the vertex, near which it is met; of
        // the two roots the smaller one comes from their product.
        let b = -(dot(q, d) + radius * d.z);
        let c = dot(q, q) + 2 * radius * q.z;
        let discriminant = b * b - c;
        if (!(discriminant >= 0)) {
            return blocked;
        }
        let larger = b + select(sqrt(discriminant), -sqrt(discriminant), b < 0);
        let other = select(c / larger, 0, larger == 0);
        let is_near = (d.z > 0) == (radius < 0);
        let t = select(max(larger, other), min(larger, other), is_near);
        let p = q + d * t;
        if (!(t >= 0) || (!is_open && dot(p.xy, p.xy) > aperture * aperture)) {
            return blocked;
        }
        o = p + vertex;
        var n = (p + vec3f(0, 0, radius)) / abs(radius);
        n = select(n, -n, dot(n, d) > 0);
        let cosine = -dot(d, n);
        let squared = 1 - eta * eta * (1 - cosine * cosine);
        if (!(squared > 0)) {
            return blocked;
        }
        d = Vec3_normalize(d * eta + n * (eta * cosine - sqrt(squared)));
    }
    return LensRay(o, d, share);
}

// The ray of a film position and a position on the exit pupil, and those of the pixels to the right
// and below, if these are wanted: by differences of a step, in a lens without apertures.
fn lens_rays(film: vec2f, u: vec2f, has_neighbours: bool) -> array<LensRay, 3> {
    let lens = word(world.camera + 2);
    let from_ = film_point(film);
    let distance = length(from_);
    let intervals = word(lens + 1);
    let interval = min(u32(distance / number(world.camera + 20) * f32(intervals)), intervals - 1);
    let pupil = numbers_at(lens + 4 + 4 * word(lens) + 4 * interval);
    let low = pupil.xy;
    let high = pupil.zw;
    let is_empty = any(low > high);
    let p = mix(low, high, u);
    let turn = select(vec2f(1, 0), from_.xy / distance, distance > 0);
    let rear_z = number(lens + 4);
    let rear = vec3f(turn.x * p.x - turn.y * p.y, turn.y * p.x + turn.x * p.y, rear_z);
    // Of the position, first through apertures, and to the right, below, left and above.
    var found: array<LensRay, 6>;
    for (var i = 0; i < select(1, 6, has_neighbours); i++) {
        let axis = vec2f(f32(i == 2) - f32(i == 4), f32(i == 3) - f32(i == 5));
        let o = film_point(film + axis * LENS_STEP);
        found[i] = through_lens(o, Vec3_normalize(rear - o), i != 0);
    }
    var rays_of_film = array(found[0], found[0], found[0]);
    let z = Vec3_normalize(rear - from_).z;
    let area = (high.x - low.x) * (high.y - low.y);
    rays_of_film[0].share *= select(z * z * z * z * area / (rear_z * rear_z), 0, is_empty);
    for (var axis = 0; axis < 2; axis++) {
        for (var side = 0; side < 2; side++) {
            let near = found[2 + axis + 2 * side];
            if (has_neighbours && found[1].share > 0 && near.share > 0) {
                let scale = select(1.0, -1.0, side == 1) / LENS_STEP;
                rays_of_film[1 + axis].o += (near.o - found[1].o) * scale;
                rays_of_film[1 + axis].d += (near.d - found[1].d) * scale;
                break;
            }
        }
    }
    return rays_of_film;
}
