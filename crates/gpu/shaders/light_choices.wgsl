// The choice of a light: the records of `src/flatten/light_choices.rs`.

const CHOICE_UNIFORM = 0u;
const CHOICE_POWER = 1u;

// The bit of a leaf's kind.
const TREE_LEAF = 0x80000000u;

struct Choice {
    light: u32,
    pmf: f32,
    valid: bool,
}

// A light for a point.
fn choose_light(context: ShapeSampleContext, u: f32) -> Choice {
    let at = world.choice;
    if (world.light_count == 0) {
        return Choice(0, 0, false);
    }
    if (tables[at] == CHOICE_UNIFORM) {
        let light = min(u32(u * f32(world.light_count)), world.light_count - 1);
        return Choice(light, 1 / f32(world.light_count), true);
    }
    if (tables[at] == CHOICE_POWER) {
        return choose_by_power(at + 1, u);
    }
    let probability = number(at + 6);
    let infinite_count = tables[at + 4];
    if (u < probability) {
        let index = min(u32(u / probability * f32(infinite_count)), infinite_count - 1);
        return Choice(tables[tables[at + 3] + index], probability / f32(infinite_count), true);
    }
    if (tables[at + 5] == 0) {
        return Choice(0, 0, false);
    }
    let rest = real_min((u - probability) / (1 - probability), float_ONE_MINUS_EPSILON);
    return descend(tables[at + 1], context, rest, 1 - probability);
}

// The probability with which a light is chosen.
fn light_pmf(context: ShapeSampleContext, light: u32) -> f32 {
    let at = world.choice;
    if (tables[at] == CHOICE_UNIFORM) {
        return 1 / f32(world.light_count);
    }
    if (tables[at] == CHOICE_POWER) {
        return number(at + 1 + 3 * light + 1);
    }
    let trail = vec2u(tables[tables[at + 2] + 2 * light], tables[tables[at + 2] + 2 * light + 1]);
    let probability = number(at + 6);
    if (trail.y == 0xffffffffu) {
        return select(0, probability / f32(tables[at + 4]), trail.x == 1);
    }
    return follow(tables[at + 1], context, trail, 1 - probability);
}

// By an alias table. The product of u with the number of bins is computed with its rounding error,
// which decides within a bin.
fn choose_by_power(bins: u32, u: f32) -> Choice {
    let count = f32(world.light_count);
    let product = u * count;
    let error = fma(u, count, -product);
    let below = floor(product) - select(0.0, 1.0, product == floor(product) && error < 0);
    let bin = min(u32(max(below, 0)), world.light_count - 1);
    let within = (product - f32(bin)) + error;
    let at = bins + 3 * bin;
    let light = select(tables[at + 2], bin, within < number(at));
    let pmf = number(bins + 3 * light + 1);
    return Choice(light, pmf, pmf > 0);
}

// The importance of the two nodes below another one, of which the second is given.
fn importances(nodes: u32, node: u32, second: u32, context: ShapeSampleContext) -> vec2f {
    var both: vec2f;
    for (var i = 0u; i < 2; i++) {
        let at = nodes + 13 * select(node + 1, second, i == 1);
        let cluster = Cluster(
            vector(at), number(at + 3), vector(at + 4), number(at + 7), number(at + 8), number(at + 9),
            number(at + 10), number(at + 11) > 0,
        );
        both[i] = Cluster_importance(cluster, context.p.p, context.ns);
    }
    return both;
}

// A light of the tree.
fn descend(nodes: u32, context: ShapeSampleContext, start: f32, probability: f32) -> Choice {
    var u = start;
    var pmf = probability;
    var node = 0u;
    var kind = tables[nodes + 12];
    while (kind < TREE_LEAF) {
        let both = importances(nodes, node, kind, context);
        if (all(both == vec2f())) {
            return Choice(0, 0, false);
        }
        let p = both.x / (both.x + both.y);
        let goes_left = u < p;
        let chosen = select(both.y / (both.x + both.y), p, goes_left);
        u = clamp(select(u - p, u, goes_left) / chosen, 0, float_ONE_MINUS_EPSILON);
        pmf *= chosen;
        node = select(kind, node + 1, goes_left);
        kind = tables[nodes + 13 * node + 12];
    }
    return Choice(kind & ~TREE_LEAF, pmf, pmf > 0);
}

// The probability of the light at the end of a trail.
fn follow(nodes: u32, context: ShapeSampleContext, trail: vec2u, probability: f32) -> f32 {
    var pmf = probability;
    var node = 0u;
    for (var depth = 0u; depth < 64; depth++) {
        let kind = tables[nodes + 13 * node + 12];
        if (kind >= TREE_LEAF || pmf == 0) {
            break;
        }
        let both = importances(nodes, node, kind, context);
        let word = select(trail.y, trail.x, depth < 32);
        let goes_left = ((word >> (depth & 31)) & 1) == 0;
        let chosen = select(both.y, both.x, goes_left);
        pmf = select(pmf * (chosen / (both.x + both.y)), 0, chosen == 0);
        node = select(kind, node + 1, goes_left);
    }
    return pmf;
}
