// Materials: the records of `src/flatten/materials.rs`, and what they scatter at a point.

// Where the offsets of a material's textures begin, and how many of them a coat has.
const MATERIAL_TEXTURES = 12u;
const COAT_TEXTURES = 5u;

// A BxDF in the frame of a point: what its kind has of the following.
struct Bsdf {
    kind: u32,
    frame: Frame,
    // Of what is diffuse, coated or not, and of metals.
    diffuse: Diffuse,
    translucent: DiffuseTransmission,
    metal: Conductor,
    // Of glass and of the boundary of a body, of coats the index alone.
    eta: f32,
    facets: TrowbridgeReitz,
    coat: Coat,
    surface: OpenPbr,
    fibre: Hair,
    measured: Measured,
    // Of a body the record of its material, and extinction and albedo under its surface.
    record: u32,
    sigma_t: vec4f,
    albedo: vec4f,
    // What it carries: radiance, unless it is a vertex of a light path.
    mode: u32,
}

// What lies above a base: the numbers of a `Layered` but for the base.
struct Coat {
    surface: Dielectric,
    thickness: f32,
    albedo: vec4f,
    phase: HenyeyGreenstein,
    inner: f32,
    max_depth: u32,
    samples: u32,
    seed: u32,
}

// The record of a material.
fn material_record(material: u32) -> u32 {
    return word(world.materials + material);
}

// The BSDF of a point, whose shading geometry gets the material's normals. Dispersive materials
// terminate the secondary wavelengths. Where that is forced, it is a diffuse one of the reflectance
// of its material, estimated by one sample.
fn bsdf_at(s: ptr<function, Surface>, context: TextureContext, lambda: ptr<function, SampledWavelengths>) -> Bsdf {
    let bsdf = material_at(s, context, lambda);
    if (!HAS_FORCED_DIFFUSE) {
        return bsdf;
    }
    var u: array<vec2f, 2>;
    for (var i = 0u; i < 2; i++) {
        u[i] = next_numbers(i == 1);
    }
    let sample = bsdf_sample(bsdf, (*s).wo, u[0].x, u[1]);
    var forced: Bsdf;
    forced.kind = MaterialTag_Diffuse;
    forced.frame = bsdf.frame;
    forced.eta = 1;
    if (sample.valid) {
        forced.diffuse.reflectance = sample.f * (abs(dot(sample.wi, (*s).ns)) / sample.pdf);
    }
    return forced;
}

// The BSDF of the material of a point.
//
// All textures are evaluated at one place of the program, because they are long: what mixes choose
// by, what raises the surface, and the numbers of the material.
fn material_at(s: ptr<function, Surface>, context: TextureContext, lambda: ptr<function, SampledWavelengths>) -> Bsdf {
    var at = material_record((*s).material);
    // The heights here, along u and along v.
    var heights: array<f32, 3>;
    var height = 0u;
    var values: array<vec4f, MOST_TEXTURES>;
    var value = 0u;
    // Kind, image of normals, texture of the height, number of textures; and numbers.
    var head: vec4u;
    loop {
        head = words_at(at);
        let is_mix = head.x == MaterialTag_Mix;
        let is_raised = HAS_BUMPS && head.z != 0 && height < 3;
        if (!is_mix && !is_raised && value == head.w) {
            break;
        }
        var place = context;
        var next = word(at + MATERIAL_TEXTURES + value);
        if (!is_mix && is_raised) {
            place = raised_context(*s, context, height);
            next = head.z;
        }
        let found = texture(next, place, *lambda);
        if (is_mix) {
            at = material_record(chosen_material(at, *s, found.x));
        } else if (is_raised) {
            heights[height] = found.x;
            height++;
        } else {
            values[value] = found;
            value++;
        }
    }
    let given = words_at(at + 4);
    let more = words_at(at + 8);
    if (HAS_BUMPS && head.y != 0) {
        map_normal(s, head.y);
    } else if (HAS_BUMPS && height == 3) {
        raise(s, context, heights);
    }
    var bsdf: Bsdf;
    bsdf.kind = head.x;
    bsdf.frame = Frame_from_z_and_x((*s).ns, (*s).ss);
    bsdf.eta = 1;
    let is_coated = HAS_COATS && (bsdf.kind == MaterialTag_CoatedDiffuse || bsdf.kind == MaterialTag_CoatedConductor);
    let is_glass = HAS_FACETS && (bsdf.kind == MaterialTag_Dielectric || bsdf.kind == MaterialTag_ThinDielectric);
    if (is_coated || is_glass) {
        let eta = spectrum_at(given.y, (*lambda).lambda.x);
        // A spectrum is zero outside of its table, where the index is unknown.
        bsdf.eta = select(eta, 1, eta == 0);
        if (given.z == 1) {
            SampledWavelengths_terminate_secondary(lambda);
        }
    }
    // The textures of a base come after those of its coat.
    let first = select(0u, COAT_TEXTURES, is_coated);
    switch (bsdf.kind) {
        case MaterialTag_Diffuse, MaterialTag_CoatedDiffuse: {
            bsdf.diffuse.reflectance = clamp(values[first], vec4f(), vec4f(1));
        }
        case MaterialTag_DiffuseTransmission: {
            let scale = bitcast<f32>(given.x);
            bsdf.translucent.reflectance = clamp(values[0] * scale, vec4f(), vec4f(1));
            bsdf.translucent.transmittance = clamp(values[1] * scale, vec4f(), vec4f(1));
        }
        case MaterialTag_Principled: { bsdf.surface = openpbr_at(given.x, values, context.uv, lambda); }
        default: {}
    }
    if (HAS_FACETS && (bsdf.kind == MaterialTag_Conductor || bsdf.kind == MaterialTag_CoatedConductor)) {
        bsdf.metal.distribution = facets_of(values[first].x, values[first + 1].x, given.x);
        bsdf.metal.k = values[first + 2];
        bsdf.metal.eta = values[first + 3];
        if (given.w == 1) {
            let r = clamp(bsdf.metal.k, vec4f(), vec4f(0.9999));
            bsdf.metal.eta = vec4f(1);
            bsdf.metal.k = 2 * sqrt(r) / sqrt(1 - r);
        }
        // Seen from within the coat, whose index is that of the BSDF.
        bsdf.metal.eta /= bsdf.eta;
        bsdf.metal.k /= bsdf.eta;
    }
    if (HAS_FACETS && bsdf.kind == MaterialTag_Dielectric) {
        bsdf.facets = facets_of(values[0].x, values[1].x, given.x);
    }
    if (HAS_HAIR && bsdf.kind == MaterialTag_Hair) {
        bsdf.fibre = hair_at(given.xy, values, context.uv.y, *lambda);
    }
    if (HAS_MEASURED && bsdf.kind == MaterialTag_Measured) {
        bsdf.measured = Measured_new(given.x, *lambda);
    }
    if (HAS_SUBSURFACE && bsdf.kind == MaterialTag_Subsurface) {
        bsdf.record = at;
        bsdf.eta = bitcast<f32>(more.y);
        bsdf.facets = facets_of(values[0].x, values[1].x, given.x);
        let medium = medium_under(at, bsdf.facets, values[2], values[3]);
        bsdf.sigma_t = medium[0];
        bsdf.albedo = medium[1];
    }
    if (is_coated) {
        let facets = facets_of(values[0].x, values[1].x, more.x);
        bsdf.coat = Coat(
            Dielectric(bsdf.eta, facets), max(values[2].x, 0), clamp(values[4], vec4f(), vec4f(1)),
            HenyeyGreenstein(clamp(values[3].x, -0.999, 0.999)),
            bitcast<f32>(more.y), more.z, more.w, walk_seed((*lambda).lambda.x),
        );
    }
    return bsdf;
}

// What the walks of a vertex depend on: `Bsdf::seed` of `scattering/src/bsdf.rs`.
fn walk_seed(lambda: f32) -> u32 {
    let state = mix_word(0x6a09e667u ^ bitcast<u32>(lambda)) + 0x3c6ef372u;
    var sequence = HashSequence(mix_word(state ^ place.dimension) + 0x3c6ef372u);
    return HashSequence_word(&sequence);
}

fn coated_diffuse(bsdf: Bsdf) -> Layered_Diffuse {
    let c = bsdf.coat;
    return Layered_Diffuse(
        bsdf.diffuse, c.surface, c.thickness, c.albedo, c.phase, c.inner, c.max_depth, c.samples, c.seed,
    );
}

fn coated_conductor(bsdf: Bsdf) -> Layered_Conductor {
    let c = bsdf.coat;
    return Layered_Conductor(
        bsdf.metal, c.surface, c.thickness, c.albedo, c.phase, c.inner, c.max_depth, c.samples, c.seed,
    );
}

// The material that a mix has at a point, given the probability of the second one.
fn chosen_material(at: u32, s: Surface, amount: f32) -> u32 {
    let pair = words_at(at + 4).xy;
    let u = hashed(s.p.p, s.wo, pair.x ^ mix_word(pair.y));
    return select(pair.x, pair.y, amount >= 1 || (amount > 0 && u < amount));
}

fn facets_of(u: f32, v: f32, remap: u32) -> TrowbridgeReitz {
    let given = vec2f(u, v);
    let alpha = select(given, sqrt(max(given, vec2f())), remap == 1);
    return TrowbridgeReitz_new(alpha.x, alpha.y);
}

// A dielectric, of bodies without what is under it.
fn Boundary_flags(bsdf: Bsdf) -> u32 {
    return Dielectric_flags(Dielectric(bsdf.eta, bsdf.facets));
}

fn Boundary_f(bsdf: Bsdf, wo: vec3f, wi: vec3f, mode: u32) -> vec4f {
    var factor = 1.0;
    if (HAS_SUBSURFACE && bsdf.kind == MaterialTag_Boundary) {
        factor = boundary_factor(bsdf, wo, wi, false);
    }
    return Dielectric_f(Dielectric(bsdf.eta, bsdf.facets), wo, wi, mode) * factor;
}

fn Boundary_pdf(bsdf: Bsdf, wo: vec3f, wi: vec3f, mode: u32, directions: u32) -> f32 {
    return Dielectric_pdf(Dielectric(bsdf.eta, bsdf.facets), wo, wi, mode, directions);
}

fn Boundary_sample_f(bsdf: Bsdf, wo: vec3f, uc: f32, u: vec2f, mode: u32, directions: u32) -> BsdfSample {
    var sample = Dielectric_sample_f(Dielectric(bsdf.eta, bsdf.facets), wo, uc, u, mode, directions);
    if (HAS_SUBSURFACE && bsdf.kind == MaterialTag_Boundary) {
        sample.f *= boundary_factor(bsdf, wo, sample.wi, true);
    }
    return sample;
}

// `src/bxdfs.rs` makes the functions `bxdf_…` of a BSDF in its frame.

fn is_non_specular(flags: u32) -> bool {
    return (flags & (BxdfFlags_DIFFUSE | BxdfFlags_GLOSSY)) != 0;
}

// Roughens it.
fn regularize(bsdf: ptr<function, Bsdf>) {
    var facets = (*bsdf).facets;
    TrowbridgeReitz_regularize(&facets, true);
    (*bsdf).facets = facets;
    facets = (*bsdf).metal.distribution;
    TrowbridgeReitz_regularize(&facets, true);
    (*bsdf).metal.distribution = facets;
    facets = (*bsdf).coat.surface.distribution;
    TrowbridgeReitz_regularize(&facets, true);
    (*bsdf).coat.surface.distribution = facets;
    var surface = (*bsdf).surface;
    OpenPbr_regularize(&surface, true);
    (*bsdf).surface = surface;
}

// Neither zero, subnormal, infinite nor NaN.
fn is_normal(x: f32) -> bool {
    return abs(x) >= 1.1754944e-38 && abs(x) < infinity();
}

fn bsdf_f(bsdf: Bsdf, outer_o: vec3f, outer_i: vec3f) -> vec4f {
    let wo = Frame_to_local(bsdf.frame, outer_o);
    let wi = Frame_to_local(bsdf.frame, outer_i);
    if (!is_normal(wo.z)) {
        return vec4f();
    }
    return bxdf_f(bsdf, wo, wi);
}

fn bsdf_pdf(bsdf: Bsdf, outer_o: vec3f, outer_i: vec3f) -> f32 {
    let wo = Frame_to_local(bsdf.frame, outer_o);
    let wi = Frame_to_local(bsdf.frame, outer_i);
    if (!is_normal(wo.z)) {
        return 0;
    }
    return bxdf_pdf(bsdf, wo, wi);
}

// A direction in render space; not valid where it carries no light.
fn bsdf_sample(bsdf: Bsdf, outer_o: vec3f, uc: f32, u: vec2f) -> BsdfSample {
    return bsdf_sample_of(bsdf, outer_o, uc, u, Directions_All);
}

// The same, of one side.
fn bsdf_sample_of(bsdf: Bsdf, outer_o: vec3f, uc: f32, u: vec2f, directions: u32) -> BsdfSample {
    let wo = Frame_to_local(bsdf.frame, outer_o);
    if (!is_normal(wo.z) || bxdf_flags(bsdf) == 0) {
        return BsdfSample_invalid();
    }
    var sample = bxdf_sample_f(bsdf, wo, uc, u, directions);
    sample.valid = sample.valid && !is_black(sample.f) && sample.pdf != 0 && is_normal(sample.wi.z);
    sample.wi = Frame_from_local(bsdf.frame, sample.wi);
    return sample;
}

// Where lights are sampled from: offset to the side of `wo` on surfaces that scatter to one side
// only, so that a light that intersects the surface is not sampled from behind.
fn light_context(s: Surface, flags: u32) -> ShapeSampleContext {
    var context = context_of(s);
    let reflects = (flags & BxdfFlags_REFLECTION) != 0;
    let transmits = (flags & BxdfFlags_TRANSMISSION) != 0;
    if (reflects != transmits) {
        let side = select(-s.wo, s.wo, reflects);
        context.p = Point3Error(offset_ray_origin(s.p, s.n, side), vec3f());
    }
    return context;
}
