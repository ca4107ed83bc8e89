// The sensor: the record of `src/flatten/sensors.rs`.

// The three responses of the sensor to light.
fn response(l: vec4f, lambda: SampledWavelengths) -> vec3f {
    let known = lambda.pdf > vec4f();
    let seen = select(vec4f(), l / select(vec4f(1), lambda.pdf, known), known);
    var sum = vec3f();
    for (var i = 0; i < 4; i++) {
        let nanometre = lambda.lambda[i] - 359.5;
        if (nanometre >= 0 && nanometre < 471) {
            sum += seen[i] * vector(world.sensor + 12 + 4 * u32(nanometre));
        }
    }
    return sum * 0.25;
}

// Light of a sample as the film takes it: the colour of the picture, weighted, and the weight. None
// for light that is not finite.
fn exposed(l: vec4f, lambda: SampledWavelengths, weight: f32) -> vec4f {
    let at = world.sensor;
    var seen = response(l, lambda);
    let largest = max(seen.x, max(seen.y, seen.z));
    let row = rows_at(at);
    let limit = row[0].w;
    if (largest > limit) {
        seen *= limit / largest;
    }
    if (!all(abs(seen) < vec3f(1e30))) {
        return vec4f();
    }
    let color = times(Rows(row[0].xyz, row[1].xyz, row[2].xyz), seen);
    return vec4f(color, 1) * weight;
}
