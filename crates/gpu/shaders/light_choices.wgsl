// The choice of a light: the records of `src/flatten/light_choices.rs`.

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
    let head = words_at(at);
    if (world.light_count == 0) {
        return Choice(0, 0, false);
    }
    if (head.x == ChoiceTag_Uniform) {
        let light = min(u32(u * f32(world.light_count)), world.light_count - 1);
        return Choice(light, 1 / f32(world.light_count), true);
    }
    if (head.x == ChoiceTag_Power) {
        return choose_by_power(at + 4, u);
    }
    let counts = words_at(at + 4);
    let probability = bitcast<f32>(counts.z);
    let infinite_count = counts.x;
    if (u < probability) {
        let index = min(u32(u / probability * f32(infinite_count)), infinite_count - 1);
        return Choice(word(head.w + index), probability / f32(infinite_count), true);
    }
    if (counts.y == 0) {
        return Choice(0, 0, false);
    }
    let rest = real_min((u - probability) / (1 - probability), float_ONE_MINUS_EPSILON);
    return descend(head.y, context, rest, 1 - probability);
}

// The probability with which a light is chosen.
fn light_pmf(context: ShapeSampleContext, light: u32) -> f32 {
    let at = world.choice;
    let head = words_at(at);
    if (head.x == ChoiceTag_Uniform) {
        return 1 / f32(world.light_count);
    }
    if (head.x == ChoiceTag_Power) {
        return number(at + 4 + 4 * light + 1);
    }
    let trail = vec2u(word(head.z + 2 * light), word(head.z + 2 * light + 1));
    let counts = words_at(at + 4);
    let probability = bitcast<f32>(counts.z);
    if (trail.y == 0xffffffffu) {
        return select(0, probability / f32(counts.x), trail.x == 1);
    }
    return follow(head.y, context, trail, 1 - probability);
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
    let own = words_at(bins + 4 * bin);
    let light = select(own.z, bin, within < bitcast<f32>(own.x));
    let pmf = number(bins + 4 * light + 1);
    return Choice(light, pmf, pmf > 0);
}

// The importance of the two nodes below another one, of which the second is given.
fn importances(nodes: u32, node: u32, second: u32, context: ShapeSampleContext) -> vec2f {
    var both: vec2f;
    for (var i = 0u; i < 2; i++) {
        let row = rows_at(nodes + 16 * select(node + 1, second, i == 1));
        let cluster = Cluster(
            row[0].xyz, row[0].w, row[1].xyz, row[1].w, row[2].x, row[2].y, row[2].z, row[2].w > 0,
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
    var kind = word(nodes + 12);
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
        kind = word(nodes + 16 * node + 12);
    }
    return Choice(kind & ~TREE_LEAF, pmf, pmf > 0);
}

// The probability of the light at the end of a trail.
fn follow(nodes: u32, context: ShapeSampleContext, trail: vec2u, probability: f32) -> f32 {
    var pmf = probability;
    var node = 0u;
    for (var depth = 0u; depth < 64; depth++) {
        let kind = word(nodes + 16 * node + 12);
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
