// The sensor: the record of `src/flatten/sensors.rs`.

// The three responses of the sensor to light.
fn response(l: vec4f, lambda: SampledWavelengths) -> vec3f {
    let known = lambda.pdf > vec4f();
    let seen = select(vec4f(), l / select(vec4f(1), lambda.pdf, known), known);
    var sum = vec3f();
    for (var i = 0; i < 4; i++) {
        for (var c = 0u; c < 3; c++) {
            sum[c] += seen[i] * dense_spectrum(tables[world.sensor + c], lambda.lambda[i]);
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
    let limit = number(at + 3);
    if (largest > limit) {
        seen *= limit / largest;
    }
    if (!all(abs(seen) < vec3f(1e30))) {
        return vec4f();
    }
    let color = times(Rows(vector(at + 4), vector(at + 7), vector(at + 10)), seen);
    return vec4f(color, 1) * weight;
}
