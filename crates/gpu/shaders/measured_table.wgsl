// Measured surfaces: the records of `src/flatten/measured.rs`, and the methods of `MeasuredTable`
// and of its `PiecewiseBilinear2d`. `Measured` is a law.

// The record of a table.
alias MeasuredTable = u32;

// Where the numbers of grids begin: of facets, their areas, visible normals, samples, reflectances.
const MEASURED_NDF = 8u;
const MEASURED_SIGMA = 11u;
const MEASURED_NORMALS = 14u;
const MEASURED_LUMINANCE = 19u;
const MEASURED_VALUES = 24u;

// The number before `x` in increasing ones, and how far `x` is towards the next, from 0 to 1.
struct Between {
    index: u32,
    t: f32,
}

fn place_between(numbers: u32, count: u32, x: f32) -> Between {
    var before = 0u;
    var after = count;
    while (after - before > 1) {
        let middle = (before + after) / 2;
        if (number(numbers + middle) <= x) {
            before = middle;
        } else {
            after = middle;
        }
    }
    let low = number(numbers + before);
    if (after == count || x <= low) {
        return Between(before, 0);
    }
    return Between(before, (x - low) / (number(numbers + after) - low));
}

fn MeasuredTable_is_isotropic(table: u32) -> bool {
    return word(table) <= 2;
}

fn MeasuredTable_between(table: u32, phi: f32, theta: f32) -> LayerWeights {
    let columns = word(table + 2);
    let around = place_between(word(table + 1), word(table), phi);
    let across = place_between(word(table + 3), columns, theta);
    let low = around.index * columns + across.index;
    let high = low + select(0u, columns, around.t > 0);
    let next = u32(across.t > 0);
    let s = vec2f(1 - around.t, around.t);
    let t = vec2f(1 - across.t, across.t);
    return LayerWeights(
        array(low, low + next, high, high + next), vec4f(s.x * t, s.y * t), select(2u, 4u, around.t > 0),
    );
}

// A cell of a grid: the index of its first point in a layer, and the position in it.
struct Cell {
    column: u32,
    row: u32,
    at: vec2f,
}

// The cell of a point of the unit square in a grid of `word(grid)` × `word(grid + 1)` points.
fn measured_cell(grid: u32, p: vec2f) -> Cell {
    let cells = vec2f(f32(word(grid) - 1), f32(word(grid + 1) - 1));
    let at = p * cells;
    let cell = clamp(floor(at), vec2f(), cells - 1);
    return Cell(u32(cell.x), u32(cell.y), at - cell);
}

// The interpolated value of a layer in a cell.
fn measured_value(grid: u32, layer: u32, cell: Cell) -> f32 {
    let width = word(grid);
    let first = word(grid + 2) + (layer * word(grid + 1) + cell.row) * width + cell.column;
    let low = lerp(cell.at.x, number(first), number(first + 1));
    let high = lerp(cell.at.x, number(first + width), number(first + width + 1));
    return lerp(cell.at.y, low, high);
}

fn MeasuredTable_ndf(table: u32, p: vec2f) -> f32 {
    let grid = table + MEASURED_NDF;
    return real_max(measured_value(grid, 0, measured_cell(grid, p)), 0);
}

fn MeasuredTable_sigma(table: u32, p: vec2f) -> f32 {
    let grid = table + MEASURED_SIGMA;
    return measured_value(grid, 0, measured_cell(grid, p));
}

// The reflectance of one of so many channels.
fn measured_channel(table: u32, channel: u32, channels: u32, cell: Cell, between: LayerWeights) -> f32 {
    var layers = between.layers;
    var sum = 0.0;
    for (var i = 0u; i < between.count; i++) {
        let value = measured_value(table + MEASURED_VALUES, layers[i] * channels + channel, cell);
        sum += between.weights[i] * value;
    }
    return sum;
}

fn MeasuredTable_values(table: u32, u: vec2f, between: LayerWeights, lambda: SampledWavelengths) -> vec4f {
    let cell = measured_cell(table + MEASURED_VALUES, u);
    let count = word(table + 4);
    if (count == 0) {
        var rgb: vec3f;
        for (var i = 0u; i < 3; i++) {
            rgb[i] = measured_channel(table, i, 3, cell, between);
        }
        return rgb_spectrum(word(table + 6), SpectrumTypeTag_Unbounded, rgb, lambda);
    }
    var values: vec4f;
    for (var i = 0u; i < 4; i++) {
        let place = place_between(word(table + 5), count, lambda.lambda[i]);
        let below = measured_channel(table, place.index, count, cell, between);
        let above = measured_channel(table, place.index + u32(place.t > 0), count, cell, between);
        values[i] = real_max(lerp(place.t, below, above), 0);
    }
    return values;
}

// A part of a whole, from 0 to 1; 0 of nothing.
fn fraction(part: f32, whole: f32) -> f32 {
    if (whole > 0) {
        return clamp(part / whole, 0, 1);
    }
    return 0;
}

// Of bilinear densities, which have the offsets of values, of integrals over rows and of those over
// columns: the integral over all rows below one.
fn densities_below(grid: u32, row: u32, between: LayerWeights) -> f32 {
    var layers = between.layers;
    var sum = 0.0;
    for (var i = 0u; i < between.count; i++) {
        sum += between.weights[i] * number(word(grid + 4) + layers[i] * word(grid + 1) + row);
    }
    return sum;
}

// Numbers of a column in a row and in the next one.
fn densities_pair(grid: u32, numbers: u32, column: u32, row: u32, between: LayerWeights) -> vec2f {
    let width = word(grid);
    var layers = between.layers;
    var pair = vec2f();
    for (var i = 0u; i < between.count; i++) {
        let at = numbers + (layers[i] * word(grid + 1) + row) * width + column;
        pair += between.weights[i] * vec2f(number(at), number(at + width));
    }
    return pair;
}

// The integral left of a column over the line at `y` between two rows.
fn densities_left_of(grid: u32, column: u32, row: u32, y: f32, between: LayerWeights) -> f32 {
    let pair = densities_pair(grid, word(grid + 3), column, row, between);
    return lerp(y, pair.x, pair.y);
}

// The densities at both sides of a cell, between its rows.
fn densities_across(grid: u32, column: u32, row: u32, y: f32, between: LayerWeights) -> vec2f {
    let left = densities_pair(grid, word(grid + 2), column, row, between);
    let right = densities_pair(grid, word(grid + 2), column + 1, row, between);
    return vec2f(lerp(y, left.x, left.y), lerp(y, right.x, right.y));
}

fn densities_sample(grid: u32, u: vec2f, between: LayerWeights) -> vec2f {
    let cells = vec2u(word(grid), word(grid + 1)) - 1;
    var row = 0u;
    var end = cells.y;
    while (end - row > 1) {
        let middle = (row + end) / 2;
        if (densities_below(grid, middle, between) <= u.y) {
            row = middle;
        } else {
            end = middle;
        }
    }
    let ends = densities_pair(grid, word(grid + 3), cells.x, row, between);
    let above = u.y - densities_below(grid, row, between);
    let y = sample_linear(fraction(above, 0.5 * (ends.x + ends.y)), ends.x, ends.y);
    let wanted = u.x * lerp(y, ends.x, ends.y);
    var column = 0u;
    end = cells.x;
    while (end - column > 1) {
        let middle = (column + end) / 2;
        if (densities_left_of(grid, middle, row, y, between) <= wanted) {
            column = middle;
        } else {
            end = middle;
        }
    }
    let sides = densities_across(grid, column, row, y, between);
    let left = wanted - densities_left_of(grid, column, row, y, between);
    let x = sample_linear(fraction(left, 0.5 * (sides.x + sides.y)), sides.x, sides.y);
    return vec2f(f32(column) + x, f32(row) + y) / vec2f(cells);
}

fn densities_pdf(grid: u32, p: vec2f, between: LayerWeights) -> f32 {
    let cell = measured_cell(grid, p);
    let sides = densities_across(grid, cell.column, cell.row, cell.at.y, between);
    return lerp(cell.at.x, sides.x, sides.y) * f32((word(grid) - 1) * (word(grid + 1) - 1));
}

// The inverse of `sample_linear`.
fn invert_linear(x: f32, a: f32, b: f32) -> f32 {
    if (a + b <= 0) {
        return x;
    }
    return x * (a * (2 - x) + b * x) / (a + b);
}

fn MeasuredTable_sample_luminance(table: u32, u: vec2f, between: LayerWeights) -> vec2f {
    return densities_sample(table + MEASURED_LUMINANCE, u, between);
}

fn MeasuredTable_luminance_pdf(table: u32, u: vec2f, between: LayerWeights) -> f32 {
    return densities_pdf(table + MEASURED_LUMINANCE, u, between);
}

fn MeasuredTable_sample_normal(table: u32, u: vec2f, between: LayerWeights) -> vec2f {
    return densities_sample(table + MEASURED_NORMALS, u, between);
}

fn MeasuredTable_invert_normal(table: u32, p: vec2f, between: LayerWeights) -> Tuple_Vec2_f32 {
    let grid = table + MEASURED_NORMALS;
    let cell = measured_cell(grid, p);
    let sides = densities_across(grid, cell.column, cell.row, cell.at.y, between);
    let ends = densities_pair(grid, word(grid + 3), word(grid) - 1, cell.row, between);
    let left = densities_left_of(grid, cell.column, cell.row, cell.at.y, between)
        + 0.5 * (sides.x + sides.y) * invert_linear(cell.at.x, sides.x, sides.y);
    let below = densities_below(grid, cell.row, between)
        + 0.5 * (ends.x + ends.y) * invert_linear(cell.at.y, ends.x, ends.y);
    let u = vec2f(fraction(left, lerp(cell.at.y, ends.x, ends.y)), clamp(below, 0, 1));
    let density = lerp(cell.at.x, sides.x, sides.y) * f32((word(grid) - 1) * (word(grid + 1) - 1));
    return Tuple_Vec2_f32(u, density);
}
