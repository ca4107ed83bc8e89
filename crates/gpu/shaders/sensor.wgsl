// The sensor: the record of `src/flatten/sensors.rs`.

// Light of a sample as the film takes it: the colour of the picture, weighted, and the weight. None
// for light that is not finite.
fn exposed(l: vec4f, lambda: SampledWavelengths, weight: f32) -> vec4f {
    let at = world.sensor;
    let known = lambda.pdf > vec4f();
    let seen = select(vec4f(), l / select(vec4f(1), lambda.pdf, known), known);
    var response = vec3f();
    for (var i = 0; i < 4; i++) {
        for (var c = 0u; c < 3; c++) {
            response[c] += seen[i] * dense_spectrum(tables[at + c], lambda.lambda[i]);
        }
    }
    response *= 0.25;
    let largest = max(response.x, max(response.y, response.z));
    let limit = number(at + 3);
    if (largest > limit) {
        response *= limit / largest;
    }
    if (!all(abs(response) < vec3f(1e30))) {
        return vec4f();
    }
    let color = times(Rows(vector(at + 4), vector(at + 7), vector(at + 10)), response);
    return vec4f(color, 1) * weight;
}
