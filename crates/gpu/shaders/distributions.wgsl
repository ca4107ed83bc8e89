// Distributions over rectangles: the records of `src/flatten/distributions.rs`.

// A position within [0, 1], its density, and its cell.
struct Drawn {
    t: f32,
    density: f32,
    cell: u32,
}

// A position by the densities of cells, and by the edges of their cumulative distribution.
fn draw(densities: u32, edges: u32, cells: u32, random: f32) -> Drawn {
    let u = clamp(random, 0, float_ONE_MINUS_EPSILON);
    // The first cell whose upper edge is above u.
    var low = 0u;
    var high = cells - 1;
    while (low < high) {
        let middle = (low + high) / 2;
        if (u >= number(edges + middle + 1)) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    let below = number(edges + low);
    let width = number(edges + low + 1) - below;
    let within = select(0.5, (u - below) / width, width > 0);
    return Drawn((f32(low) + within) / f32(cells), number(densities + low), low);
}

// A point of the rectangle of a distribution, and its density per area.
fn draw_2d(at: u32, u: vec2f) -> vec3f {
    let size = words_at(at);
    let columns = size.x;
    let rows = size.y;
    let marginal = at + 8;
    let densities = marginal + 2 * rows + 1;
    let edges = densities + columns * rows;
    let y = draw(marginal, marginal + rows, rows, u.y);
    let x = draw(densities + columns * y.cell, edges + (columns + 1) * y.cell, columns, u.x);
    let range = numbers_at(at + 4);
    return vec3f(lerp(x.t, range.x, range.y), lerp(y.t, range.z, range.w), x.density * y.density);
}

// The density of `draw_2d` at a point of a distribution over [0, 1]².
fn density_of(at: u32, p: vec2f) -> f32 {
    let size = words_at(at);
    let columns = size.x;
    let rows = size.y;
    let marginal = at + 8;
    let row = min(u32(clamp(p.y, 0, 1) * f32(rows)), rows - 1);
    let column = min(u32(clamp(p.x, 0, 1) * f32(columns)), columns - 1);
    return number(marginal + row) * number(marginal + 2 * rows + 1 + columns * row + column);
}
