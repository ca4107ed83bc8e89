// Materials: the records of `src/flatten/materials.rs`, and what they scatter at a point.

const DIFFUSE = 0u;
const DIFFUSE_TRANSMISSION = 1u;
const CONDUCTOR = 2u;
const DIELECTRIC = 3u;
const THIN_DIELECTRIC = 4u;

// A BxDF in the frame of a point: `a` and `b` are reflectance and transmittance, or η and k.
struct Bsdf {
    kind: u32,
    frame: Frame,
    a: vec4f,
    b: vec4f,
    eta: f32,
    facets: TrowbridgeReitz,
}

// The BSDF of a point. Dispersive materials terminate the secondary wavelengths.
fn bsdf_at(s: Surface, context: TextureContext, lambda: ptr<function, SampledWavelengths>) -> Bsdf {
    let at = world.materials + 7 * s.material;
    var bsdf = Bsdf(tables[at], Frame_from_z_and_x(s.ns, s.ss), vec4f(), vec4f(), 1, TrowbridgeReitz(0, 0));
    switch (bsdf.kind) {
        case DIFFUSE: {
            bsdf.a = clamp(texture(tables[at + 1], context, *lambda), vec4f(), vec4f(1));
        }
        case DIFFUSE_TRANSMISSION: {
            let scale = number(at + 3);
            bsdf.a = clamp(texture(tables[at + 1], context, *lambda) * scale, vec4f(), vec4f(1));
            bsdf.b = clamp(texture(tables[at + 2], context, *lambda) * scale, vec4f(), vec4f(1));
        }
        case CONDUCTOR: {
            bsdf.b = texture(tables[at + 2], context, *lambda);
            if (tables[at + 1] != 0) {
                bsdf.a = texture(tables[at + 1], context, *lambda);
            } else {
                let r = clamp(bsdf.b, vec4f(), vec4f(0.9999));
                bsdf.a = vec4f(1);
                bsdf.b = 2 * sqrt(r) / sqrt(1 - r);
            }
            bsdf.facets = roughness(at + 4, context, *lambda);
        }
        default: {
            let eta = spectrum_at(tables[at + 1], (*lambda).lambda.x);
            // A spectrum is zero outside of its table, where the index is unknown.
            bsdf.eta = select(eta, 1, eta == 0);
            if (tables[at + 2] != 0) {
                SampledWavelengths_terminate_secondary(lambda);
            }
            if (bsdf.kind == DIELECTRIC) {
                bsdf.facets = roughness(at + 4, context, *lambda);
            }
        }
    }
    return bsdf;
}

fn roughness(at: u32, context: TextureContext, lambda: SampledWavelengths) -> TrowbridgeReitz {
    let given = vec2f(texture(tables[at], context, lambda).x, texture(tables[at + 1], context, lambda).x);
    let alpha = select(given, sqrt(given), tables[at + 2] != 0);
    return TrowbridgeReitz_new(alpha.x, alpha.y);
}

fn bsdf_flags(bsdf: Bsdf) -> u32 {
    let is_smooth = TrowbridgeReitz_effectively_smooth(bsdf.facets);
    switch (bsdf.kind) {
        case DIFFUSE: {
            return select(BxdfFlags_DIFFUSE_REFLECTION, 0, is_black(bsdf.a));
        }
        case DIFFUSE_TRANSMISSION: {
            return select(BxdfFlags_DIFFUSE_REFLECTION, 0, is_black(bsdf.a))
                | select(BxdfFlags_DIFFUSE_TRANSMISSION, 0, is_black(bsdf.b));
        }
        case CONDUCTOR: {
            return select(BxdfFlags_GLOSSY_REFLECTION, BxdfFlags_SPECULAR_REFLECTION, is_smooth);
        }
        case DIELECTRIC: {
            let is_specular = bsdf.eta == 1 || is_smooth;
            return select(BxdfFlags_GLOSSY_TRANSMISSION, BxdfFlags_SPECULAR_TRANSMISSION, is_specular)
                | select(BxdfFlags_REFLECTION, 0, bsdf.eta == 1);
        }
        default: {
            return BxdfFlags_SPECULAR_REFLECTION | BxdfFlags_SPECULAR_TRANSMISSION;
        }
    }
}

fn is_non_specular(flags: u32) -> bool {
    return (flags & (BxdfFlags_DIFFUSE | BxdfFlags_GLOSSY)) != 0;
}

// Roughens it.
fn regularize(bsdf: ptr<function, Bsdf>) {
    if ((*bsdf).kind == CONDUCTOR || (*bsdf).kind == DIELECTRIC) {
        var facets = (*bsdf).facets;
        TrowbridgeReitz_regularize(&facets, true);
        (*bsdf).facets = facets;
    }
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
    switch (bsdf.kind) {
        case DIFFUSE: { return Diffuse_f(Diffuse(bsdf.a), wo, wi, TransportMode_Radiance); }
        case DIFFUSE_TRANSMISSION: {
            return DiffuseTransmission_f(DiffuseTransmission(bsdf.a, bsdf.b), wo, wi, TransportMode_Radiance);
        }
        case CONDUCTOR: {
            return Conductor_f(Conductor(bsdf.facets, bsdf.a, bsdf.b), wo, wi, TransportMode_Radiance);
        }
        case DIELECTRIC: {
            return Dielectric_f(Dielectric(bsdf.eta, bsdf.facets), wo, wi, TransportMode_Radiance);
        }
        default: { return vec4f(); }
    }
}

fn bsdf_pdf(bsdf: Bsdf, outer_o: vec3f, outer_i: vec3f) -> f32 {
    let wo = Frame_to_local(bsdf.frame, outer_o);
    let wi = Frame_to_local(bsdf.frame, outer_i);
    if (!is_normal(wo.z)) {
        return 0;
    }
    let mode = TransportMode_Radiance;
    switch (bsdf.kind) {
        case DIFFUSE: { return Diffuse_pdf(Diffuse(bsdf.a), wo, wi, mode, Directions_All); }
        case DIFFUSE_TRANSMISSION: {
            let bxdf = DiffuseTransmission(bsdf.a, bsdf.b);
            return DiffuseTransmission_pdf(bxdf, wo, wi, mode, Directions_All);
        }
        case CONDUCTOR: {
            return Conductor_pdf(Conductor(bsdf.facets, bsdf.a, bsdf.b), wo, wi, mode, Directions_All);
        }
        case DIELECTRIC: {
            return Dielectric_pdf(Dielectric(bsdf.eta, bsdf.facets), wo, wi, mode, Directions_All);
        }
        default: { return 0; }
    }
}

// A direction in render space; not valid where it carries no light.
fn bsdf_sample(bsdf: Bsdf, outer_o: vec3f, uc: f32, u: vec2f) -> BsdfSample {
    let wo = Frame_to_local(bsdf.frame, outer_o);
    if (!is_normal(wo.z) || bsdf_flags(bsdf) == 0) {
        return BsdfSample_invalid();
    }
    let mode = TransportMode_Radiance;
    var sample: BsdfSample;
    switch (bsdf.kind) {
        case DIFFUSE: { sample = Diffuse_sample_f(Diffuse(bsdf.a), wo, uc, u, mode, Directions_All); }
        case DIFFUSE_TRANSMISSION: {
            let bxdf = DiffuseTransmission(bsdf.a, bsdf.b);
            sample = DiffuseTransmission_sample_f(bxdf, wo, uc, u, mode, Directions_All);
        }
        case CONDUCTOR: {
            let bxdf = Conductor(bsdf.facets, bsdf.a, bsdf.b);
            sample = Conductor_sample_f(bxdf, wo, uc, u, mode, Directions_All);
        }
        case DIELECTRIC: {
            sample = Dielectric_sample_f(Dielectric(bsdf.eta, bsdf.facets), wo, uc, u, mode, Directions_All);
        }
        default: {
            sample = ThinDielectric_sample_f(ThinDielectric(bsdf.eta), wo, uc, u, mode, Directions_All);
        }
    }
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
