//! The laws that are compared. Most have the bits of Rust on Mesa's software renderer; bounds allow
//! for the errors that WGSL permits of division, square root and fused multiply-add.

use crate::twins::{INPUTS, Law, OUTPUTS};
use geometry::{FlatShape, ShapeSample, ShapeSampleContext};
use math::{Frame, Point3Error, Ray, Vec2, Vec3, Vector3};
use sampling::low_discrepancy::{
    owen_scrambled_radical_inverse, permuted_radical_inverse, prime, radical_inverse,
};
use sampling::sampler::{Address, Independent, PaddedSobol, Pmj02Bn, Randomize, Stratified, ZSobol};
use sampling::warp::*;
use sampling::{HashSequence, Sampler};
use scattering::*;
use spectrum::{RgbSigmoidPolynomial, SampledSpectrum, SampledWavelengths};

pub type Row = [f32; INPUTS];

fn wo(x: &Row) -> Vector3 {
    Vec3::new(x[0], x[1], x[2])
}

fn wi(x: &Row) -> Vector3 {
    Vec3::new(x[3], x[4], x[5])
}

fn u(x: &Row) -> Vec2 {
    Vec2::new(x[6], x[7])
}

pub fn spectrum(x: &Row, scale: f32) -> SampledSpectrum {
    SampledSpectrum::new([x[6], x[7], x[8], x[9]]) * scale
}

fn distribution(x: &Row) -> TrowbridgeReitz {
    TrowbridgeReitz::new(0.02 + x[9], 0.02 + x[10])
}

fn dielectric(x: &Row) -> Dielectric {
    Dielectric { eta: 0.5 + 2.0 * x[11], distribution: distribution(x) }
}

fn conductor(x: &Row) -> Conductor {
    Conductor { distribution: distribution(x), eta: spectrum(x, 3.0), k: spectrum(x, 5.0) }
}

/// A triangle or a rectangle, and a point that sees it.
fn flat_shape(x: &Row) -> (FlatShape, ShapeSampleContext) {
    let (wo, wi) = (wo(x), wi(x));
    let sides = [wi * 0.5, wi.cross(wo) * 0.7];
    let n = sides[0].cross(sides[1]).normalize();
    let p = Point3Error::exact(Vec3::ZERO);
    let from = ShapeSampleContext { p, n: Vec3::ZERO, ns: Vec3::Z, time: 0.0 };
    (FlatShape { corner: wo, sides, n, is_triangle: x[8] < 0.5 }, from)
}

/// A base under a coat with a medium.
fn layered<B>(base: B, x: &Row) -> Layered<B> {
    Layered {
        base,
        interface: Dielectric { eta: 1.2 + x[11], distribution: distribution(x) },
        thickness: 0.5 * x[8],
        albedo: SampledSpectrum::splat(0.5 * x[9]),
        phase: HenyeyGreenstein { g: 0.3 },
        inner: -1.0,
        max_depth: 6,
        samples: 2,
        seed: x[10].to_bits(),
    }
}

/// A fibre, seen at any offset from its middle.
fn hair(x: &Row) -> Hair {
    let roughness = [0.1 + 0.9 * x[10], 0.1 + 0.9 * x[11]];
    Hair::new(2.0 * x[8] - 1.0, 1.3 + 0.5 * x[9], spectrum(x, 2.0), roughness, 5.0 * x[7])
}

/// A matte surface under a smooth clear coat.
fn varnished(x: &Row) -> Layered<Diffuse> {
    let interface = Dielectric { eta: 1.2 + x[11], distribution: TrowbridgeReitz::new(0.0, 0.0) };
    let (base, albedo) = (Diffuse { reflectance: spectrum(x, 0.9) }, SampledSpectrum::ZERO);
    Layered { interface, albedo, inner: 0.6, ..layered(base, x) }
}

/// All numbers of a sample, if there is one.
fn sample(sample: BsdfSample) -> Vec<f32> {
    let BsdfSample { f, wi, pdf, eta, valid, .. } = sample;
    if !valid {
        return Vec::new();
    }
    vec![1.0, f[0] * wi.z, f[3] * wi.z, wi.x, wi.y, wi.z, pdf, eta]
}

/// A value for both directions of light, and the density.
pub fn value(bxdf: &impl Scatter, x: &Row) -> Vec<f32> {
    let (wo, wi) = (wo(x), wi(x));
    let f = bxdf.f(wo, wi, TransportMode::Radiance);
    let g = bxdf.f(wo, wi, TransportMode::Importance);
    vec![f[0], f[1], f[2], f[3], g[0], bxdf.pdf(wo, wi, TransportMode::Radiance, Directions::All)]
}

pub fn sampled(bxdf: &impl Scatter, x: &Row) -> Vec<f32> {
    sample(bxdf.sample_f(wo(x), x[8], u(x), TransportMode::Radiance, Directions::All))
}

/// A law by its name, bound, flips and both sides.
macro_rules! law {
    ($name:literal $bound:literal $flips:literal, $x:ident => $rust:expr, $wgsl:expr) => {
        Law { name: $name, bound: $bound, flips: $flips, rust: |$x| $rust.into(), wgsl: $wgsl }
    };
}

/// WGSL that compares value and density of a BxDF. The value is at one place of the program,
/// because it may be long.
macro_rules! value {
    ($name:literal, $bxdf:literal) => {
        concat!(
            "let b = ",
            $bxdf,
            ";
            var f: array<vec4f, 2>;
            for (var mode = TransportMode_Radiance; mode <= TransportMode_Importance; mode++) {
                f[mode] = ",
            $name,
            "_f(b, wo, wi, mode);
            }
            let p = ",
            $name,
            "_pdf(b, wo, wi, TransportMode_Radiance, Directions_All);
            y = array(f[0].x, f[0].y, f[0].z, f[0].w, f[1].x, p, 0, 0);"
        )
    };
}

/// WGSL that compares samples of a BxDF.
macro_rules! sampled {
    ($name:literal, $bxdf:literal) => {
        concat!(
            "let b = ",
            $bxdf,
            ";
            let s = ",
            $name,
            "_sample_f(b, wo, x[8], u, TransportMode_Radiance, Directions_All);
            if (s.valid) {
                y = array(1, s.f.x * s.wi.z, s.f.w * s.wi.z, s.wi.x, s.wi.y, s.wi.z, s.pdf, s.eta);
            }"
        )
    };
}

pub const LAWS: [Law; 50] = [
    law!("sin_cos" 1e-6 0.0, x => { let (a, b) = lanes::sin_cos(x[6] * 200.0 - 100.0); vec![a, b] },
        "let t = sin_cos(x[6] * 200.0 - 100.0); y[0] = t.v0; y[1] = t.v1;"),
    law!("exp ln" 1e-6 0.0, x => vec![lanes::exp(x[6] * 20.0 - 10.0), lanes::ln(x[7])],
        "y[0] = exponential_exp(x[6] * 20.0 - 10.0); y[1] = ln(x[7]);"),
    law!("arcs" 1e-6 0.0,
        x => vec![lanes::asin(x[0]), lanes::acos(x[1]), lanes::atan(x[6] * 9.0), lanes::atan2(x[0], x[1])],
        "y[0] = arc_asin(x[0]); y[1] = arc_acos(x[1]); y[2] = arc_atan(x[6] * 9.0); y[3] = arc_atan2(x[0], x[1]);"),
    law!("difference_of_products" 3e-5 0.0,
        x => vec![math::difference_of_products(x[0], x[1], x[2], x[3]), math::sum_of_products(x[0], x[1], x[2], x[3])],
        "y[0] = difference_of_products(x[0], x[1], x[2], x[3]); y[1] = sum_of_products(x[0], x[1], x[2], x[3]);"),
    law!("Frame" 1e-5 0.0,
        x => {
            let (a, b) = (Frame::from_z(wo(x)).from_local(wi(x)), Frame::from_z_and_x(wo(x), wi(x)));
            let b = b.to_local(Vec3::new(x[8], x[9], x[10]));
            vec![a.x, a.y, a.z, b.x, b.y, b.z]
        },
        "let a = Frame_from_local(Frame_from_z(wo), wi);
        let b = Frame_to_local(Frame_from_z_and_x(wo, wi), vec3f(x[8], x[9], x[10]));
        y = array(a.x, a.y, a.z, b.x, b.y, b.z, 0, 0);"),
    law!("equal-area sphere" 1e-5 0.0,
        x => {
            let (a, b) = (math::equal_area_square_to_sphere(u(x)), math::equal_area_sphere_to_square(wo(x)));
            vec![a.x, a.y, a.z, b.x, b.y]
        },
        "let a = equal_area_square_to_sphere(u); let b = equal_area_sphere_to_square(wo);
        y = array(a.x, a.y, a.z, b.x, b.y, 0, 0, 0);"),
    law!("spherical" 1e-5 0.0,
        x => { let w = math::face_forward(wo(x), wi(x)); vec![math::spherical_phi(wo(x)), w.x, w.y, w.z] },
        "let w = face_forward(wo, wi); y = array(spherical_phi(wo), w.x, w.y, w.z, 0, 0, 0, 0);"),
    law!("SampledWavelengths" 1e-5 0.0,
        x => {
            let mut lambda = SampledWavelengths::sample_visible(x[6]);
            if x[7] < 0.5 {
                lambda.terminate_secondary();
            }
            [*lambda.lambda(), lambda.pdf().0].concat()
        },
        "var w = SampledWavelengths_sample_visible(x[6]);
        if (x[7] < 0.5) { SampledWavelengths_terminate_secondary(&w); }
        y = array(w.lambda.x, w.lambda.y, w.lambda.z, w.lambda.w, w.pdf.x, w.pdf.y, w.pdf.z, w.pdf.w);"),
    law!("uniform SampledWavelengths" 1e-5 0.0,
        x => {
            let lambda = SampledWavelengths::sample_uniform_in(x[6], 300.0 + 100.0 * x[7], 900.0);
            [*lambda.lambda(), lambda.pdf().0].concat()
        },
        "let w = SampledWavelengths_sample_uniform_in(x[6], 300 + 100 * x[7], 900);
        y = array(w.lambda.x, w.lambda.y, w.lambda.z, w.lambda.w, w.pdf.x, w.pdf.y, w.pdf.z, w.pdf.w);"),
    law!("disk" 1e-5 0.0,
        x => [sample_uniform_disk_polar(u(x)).to_array(), sample_uniform_disk_concentric(u(x)).to_array()].concat(),
        "let a = sample_uniform_disk_polar(u); let b = sample_uniform_disk_concentric(u);
        y = array(a.x, a.y, b.x, b.y, 0, 0, 0, 0);"),
    law!("linear and tent" 1e-5 0.0,
        x => vec![sample_linear(x[6], x[7], x[8]), linear_pdf(x[6], x[7], x[8]), sample_tent(x[6], 2.0)],
        "y[0] = sample_linear(x[6], x[7], x[8]); y[1] = linear_pdf(x[6], x[7], x[8]); y[2] = sample_tent(x[6], 2.0);"),
    law!("sphere" 1e-5 0.0,
        x => [sample_uniform_sphere(u(x)).to_array(), sample_uniform_hemisphere(u(x)).to_array()].concat(),
        "let a = sample_uniform_sphere(u); let b = sample_uniform_hemisphere(u);
        y = array(a.x, a.y, a.z, b.x, b.y, b.z, 0, 0);"),
    law!("cosine hemisphere" 1e-5 0.0,
        x => { let w = sample_cosine_hemisphere(u(x)); vec![w.x, w.y, w.z, cosine_hemisphere_pdf(w.z)] },
        "let w = sample_cosine_hemisphere(u); y = array(w.x, w.y, w.z, cosine_hemisphere_pdf(w.z), 0, 0, 0, 0);"),
    law!("cone" 1e-5 0.0,
        x => { let w = sample_uniform_cone(u(x), x[8]); vec![w.x, w.y, w.z, uniform_cone_pdf(x[8])] },
        "let w = sample_uniform_cone(u, x[8]); y = array(w.x, w.y, w.z, uniform_cone_pdf(x[8]), 0, 0, 0, 0);"),
    law!("bilinear" 1e-5 0.0,
        x => {
            let w = [x[8], x[9], x[10], x[11]];
            let p = sample_bilinear(u(x), w);
            vec![p.x, p.y, bilinear_pdf(p, w)]
        },
        "let w = vec4f(x[8], x[9], x[10], x[11]); let p = sample_bilinear(u, w);
        y = array(p.x, p.y, bilinear_pdf(p, w), 0, 0, 0, 0, 0);"),
    law!("FlatShape" 2e-3 1e-3,
        x => {
            let (shape, from) = flat_shape(x);
            let (sample, valid) = shape.sample_from(&from, u(x));
            let ShapeSample { uv, pdf, .. } = sample;
            if valid { vec![uv.x, uv.y, pdf, shape.pdf_from(&from, uv)] } else { Vec::new() }
        },
        "let sides = array(wi * 0.5, cross(wi, wo) * 0.7);
        let n = normalize(cross(sides[0], sides[1]));
        let shape = FlatShape(wo, sides, n, x[8] < 0.5);
        let from_ = ShapeSampleContext(Point3Error(vec3f(), vec3f()), vec3f(), vec3f(0, 0, 1), 0);
        let sample = FlatShape_sample_from(shape, from_, u);
        if (sample.v1) {
            let pdf = FlatShape_pdf_from(shape, from_, sample.v0.uv);
            y = array(sample.v0.uv.x, sample.v0.uv.y, sample.v0.pdf, pdf, 0, 0, 0, 0);
        }"),
    law!("uniform triangle" 1e-6 0.0, x => sample_uniform_triangle(u(x)).to_vec(),
        "let b = sample_uniform_triangle(u); y[0] = b.x; y[1] = b.y; y[2] = b.z;"),
    law!("SphericalTriangle" 1e-4 1e-3,
        x => {
            let t = SphericalTriangle::new([wo(x), wi(x), Vec3::new(x[8], x[9], x[10])], Vec3::new(0.0, 0.0, 2.0));
            let p = t.sample(u(x));
            if t.is_valid() { vec![p.x, p.y, t.solid_angle()] } else { Vec::new() }
        },
        "let t = SphericalTriangle_new(array(wo, wi, vec3f(x[8], x[9], x[10])), vec3f(0, 0, 2));
        let p = SphericalTriangle_sample(t, u);
        if (SphericalTriangle_is_valid(t)) { y[0] = p.x; y[1] = p.y; y[2] = SphericalTriangle_solid_angle(t); }"),
    law!("SphericalRectangle" 3e-4 1e-3,
        x => {
            let side = Vec3::new(-wo(x).y, wo(x).x, 0.0);
            let r = SphericalRectangle::new(Vec3::ZERO, wi(x) * 2.0, wo(x), side);
            let p = r.sample(u(x));
            if r.is_valid() { vec![p.x, p.y, r.pdf()] } else { Vec::new() }
        },
        "let r = SphericalRectangle_new(vec3f(0), wi * 2.0, wo, vec3f(-wo.y, wo.x, 0.0));
        let p = SphericalRectangle_sample(r, u);
        if (SphericalRectangle_is_valid(r)) { y[0] = p.x; y[1] = p.y; y[2] = SphericalRectangle_pdf(r); }"),
    law!("HashSequence" 0.0 0.0,
        x => {
            let mut random = HashSequence::new([x[6].to_bits(), x[7].to_bits()]);
            let a = random.get_1d();
            let b = random.get_2d();
            vec![a, b.x, b.y]
        },
        "let first = mix_word(0x6a09e667u ^ bitcast<u32>(x[6])) + 0x3c6ef372u;
        var random = HashSequence(mix_word(first ^ bitcast<u32>(x[7])) + 0x3c6ef372u);
        y[0] = HashSequence_get_1d(&random);
        let b = HashSequence_get_2d(&random); y[1] = b.x; y[2] = b.y;"),
    law!("Independent" 0.0 0.0,
        x => {
            let sampler = Sampler::Independent(Independent::new(1, 7));
            let pixel = [(x[6] * 1000.0) as u32, (x[7] * 1000.0) as u32];
            let mut address = Address { pixel, index: (x[8] * 9.0) as u32, dimension: (x[9] * 99.0) as u32 };
            let mut u = sampler.at_2d::<f32>(&address).to_vec();
            address.skip(2);
            u.push(sampler.at_1d::<f32>(&address));
            u
        },
        "var address = Address(array(u32(u.x * 1000.0), u32(u.y * 1000.0)), u32(x[8] * 9.0), u32(x[9] * 99.0));
        let sampler_ = Independent(1, mix_word(7), address);
        let a = Independent_at_2d(sampler_, address);
        Address_skip(&address, 2);
        y[0] = a.x; y[1] = a.y; y[2] = Independent_at_1d(sampler_, address);"),
    law!("ZSobol" 0.0 0.0,
        x => {
            // Codes of one word and of two, with a binary digit and without.
            let (samples, side, randomize) = [
                (1, 1 << 5, Randomize::None),
                (8, 1 << 14, Randomize::PermuteDigits),
                (64, 1 << 4, Randomize::FastOwen),
                (4096, 1 << 20, Randomize::Owen),
            ][(4.0 * x[10]) as usize % 4];
            let sampler = Sampler::ZSobol(ZSobol::new(samples, [side, 1], randomize, 7));
            let pixel = [(x[6] * 1000.0) as u32, (x[7] * 1000.0) as u32];
            let address = Address { pixel, index: (x[8] * 5000.0) as u32, dimension: (x[9] * 99.0) as u32 };
            let [u, v] = sampler.at_2d::<f32>(&address);
            vec![u, v, sampler.at_1d::<f32>(&address)]
        },
        "let kind = u32(4.0 * x[10]) % 4;
        var samples = array(0u, 3u, 6u, 12u);
        var sides = array(5u, 14u, 4u, 20u);
        let address = Address(array(u32(x[6] * 1000.0), u32(x[7] * 1000.0)), u32(x[8] * 5000.0), u32(x[9] * 99.0));
        let sampler_ = ZSobol(1u << samples[kind], samples[kind], sides[kind], kind, mix_word(7), address);
        let a = ZSobol_at_2d(sampler_, address);
        y[0] = a.x; y[1] = a.y; y[2] = ZSobol_at_1d(sampler_, address);"),
    law!("PaddedSobol" 0.0 0.0,
        x => {
            let (samples, randomize) = [
                (1, Randomize::None),
                (6, Randomize::PermuteDigits),
                (64, Randomize::FastOwen),
                (4096, Randomize::Owen),
            ][(4.0 * x[10]) as usize % 4];
            let mut sampler = Sampler::PaddedSobol(PaddedSobol::new(samples, randomize, x[11].to_bits()));
            let pixel = [(x[6] * 1000.0) as i32, (x[7] * 1000.0) as i32];
            let (index, dimension) = ((x[8] * 5000.0) as u32, (x[9] * 99.0) as u32);
            sampler.start_pixel_sample(pixel, index, dimension);
            let p = sampler.get_2d();
            sampler.start_pixel_sample(pixel, index, dimension);
            vec![p.x, p.y, sampler.get_1d()]
        },
        "let kind = u32(4.0 * x[10]) % 4;
        var samples = array(1u, 6u, 64u, 4096u);
        let address = Address(array(u32(x[6] * 1000.0), u32(x[7] * 1000.0)), u32(x[8] * 5000.0), u32(x[9] * 99.0));
        let seed = bitcast<u32>(x[11]);
        let a = padded_sobol(address, seed, samples[kind], kind, true);
        y[0] = a.x; y[1] = a.y; y[2] = padded_sobol(address, seed, samples[kind], kind, false).x;"),
    law!("Halton" 1e-6 0.0,
        x => {
            let dimension = [0, 1, 2, 5, 24, 167, 500, 999][(8.0 * x[9]) as usize % 8];
            let index = (x[8] * 5000.0) as u32;
            let hash = x[11].to_bits();
            let numbers = [
                radical_inverse(dimension, index.into()),
                permuted_radical_inverse(dimension, index, hash),
                owen_scrambled_radical_inverse(dimension, index.into(), hash),
                prime(dimension) as f32,
            ];
            numbers.to_vec()
        },
        "var bases = array(2u, 3u, 5u, 13u, 97u, 997u, 3581u, 7919u);
        let base = bases[u32(8.0 * x[9]) % 8];
        let index = u32(x[8] * 5000.0);
        let hash = bitcast<u32>(x[11]);
        y[0] = halton(index, base, 0, hash); y[1] = halton(index, base, Randomize_PermuteDigits, hash);
        y[2] = halton(index, base, Randomize_FastOwen, hash); y[3] = f32(base);"),
    law!("Pmj02Bn" 0.0 0.0,
        x => {
            let samples = [1, 6, 64, 4096][(4.0 * x[10]) as usize % 4];
            let pixel = [(x[6] * 100_000.0) as i32, (x[7] * 1000.0) as i32];
            let (index, dimension) = ((x[8] * 5000.0) as u32, (x[9] * 99.0) as u32);
            let pmj = Pmj02Bn::new(samples, x[11].to_bits());
            let (log2_samples, key) = pmj.parts();
            let mut sampler = Sampler::Pmj02Bn(pmj);
            sampler.start_pixel_sample(pixel, index, dimension);
            let p = sampler.get_2d();
            sampler.start_pixel_sample(pixel, index, dimension);
            vec![p.x, p.y, sampler.get_1d(), log2_samples as f32, (key % 1024) as f32]
        },
        "var log2_samples = array(0u, 3u, 6u, 12u);
        let log2 = log2_samples[u32(4.0 * x[10]) % 4];
        let pixel = array(u32(x[6] * 100000.0), u32(x[7] * 1000.0));
        let address = Address(pixel, u32(x[8] * 5000.0), u32(x[9] * 99.0));
        let key = mix_word(bitcast<u32>(x[11]));
        let a = pmj02bn(address, log2, key, true);
        y[0] = a.x; y[1] = a.y; y[2] = pmj02bn(address, log2, key, false).x;
        y[3] = f32(log2); y[4] = f32(key % 1024);"),
    law!("Stratified" 0.0 1e-7,
        x => {
            let grid = [[1, 1], [2, 3], [8, 8], [64, 16]][(4.0 * x[10]) as usize % 4];
            let pixel = [(x[6] * 1000.0) as i32, (x[7] * 1000.0) as i32];
            let (index, dimension) = ((x[8] * 5000.0) as u32, (x[9] * 99.0) as u32);
            let mut sampler = Sampler::Stratified(Stratified::new(grid, x[9] < 0.5, x[11].to_bits()));
            sampler.start_pixel_sample(pixel, index, dimension);
            let p = sampler.get_2d();
            sampler.start_pixel_sample(pixel, index, dimension);
            vec![p.x, p.y, sampler.get_1d()]
        },
        "var grids = array(vec2u(1, 1), vec2u(2, 3), vec2u(8, 8), vec2u(64, 16));
        let grid = grids[u32(4.0 * x[10]) % 4];
        let address = Address(array(u32(x[6] * 1000.0), u32(x[7] * 1000.0)), u32(x[8] * 5000.0), u32(x[9] * 99.0));
        let seed = bitcast<u32>(x[11]);
        let key = mix_word(seed);
        let a = stratified(address, grid, seed, key, x[9] < 0.5, true);
        y[0] = a.x; y[1] = a.y; y[2] = stratified(address, grid, seed, key, x[9] < 0.5, false).x;"),
    law!("Ray" 1e-6 0.0,
        x => {
            let p = Point3Error::new(Vec3::new(x[6], x[7], x[8]), Vec3::new(x[9], x[10], x[11]) * 1e-4);
            let ray = Ray::between(p, wo(x), Point3Error::exact(wi(x)), wi(x), 0.5);
            let o = Ray::spawn(p, wo(x), wi(x), 0.5).o;
            [ray.o.to_array(), ray.d.to_array(), [o.x, o.z, 0.0]].concat()[..OUTPUTS].to_vec()
        },
        "let p = Point3Error(vec3f(x[6], x[7], x[8]), vec3f(x[9], x[10], x[11]) * 1e-4);
        let ray = Ray_between(p, wo, Point3Error(wi, vec3f()), wi, 0.5);
        let o = Ray_spawn(p, wo, wi, 0.5).o;
        y = array(ray.o.x, ray.o.y, ray.o.z, ray.d.x, ray.d.y, ray.d.z, o.x, o.z);"),
    law!("RgbSigmoidPolynomial" 3e-5 0.0,
        x => {
            let coefficients = [x[6] - 0.5, x[7] - 0.5, 4.0 * x[8] - 2.0];
            vec![RgbSigmoidPolynomial { coefficients }.at(360.0 + 470.0 * x[9])]
        },
        "let c = vec3f(x[6] - 0.5, x[7] - 0.5, 4.0 * x[8] - 2.0);
        y[0] = RgbSigmoidPolynomial_at(RgbSigmoidPolynomial(c), 360.0 + 470.0 * x[9]);"),
    law!("reflect and refract" 1e-5 0.0,
        x => {
            let (r, (t, eta, valid)) = (reflect(wo(x), wi(x)), refract(wo(x), wi(x), 0.5 + x[8]));
            if valid { vec![r.x, r.y, r.z, t.x, t.y, t.z, eta] } else { vec![r.x, r.y, r.z] }
        },
        "let r = fresnel_reflect(wo, wi); let t = fresnel_refract(wo, wi, 0.5 + x[8]);
        y = array(r.x, r.y, r.z, 0, 0, 0, 0, 0);
        if (t.v2) { y = array(r.x, r.y, r.z, t.v0.x, t.v0.y, t.v0.z, t.v1, 0); }"),
    law!("Fresnel, dielectric" 1e-5 0.0, x => vec![fr_dielectric(x[0], 0.5 + 2.0 * x[6])],
        "y[0] = fr_dielectric(x[0], 0.5 + 2.0 * x[6]);"),
    law!("Fresnel, conductor" 1e-5 0.0,
        x => fr_conductor(x[11], spectrum(x, 3.0), spectrum(x, 5.0)).0.to_vec(),
        "let s = vec4f(x[6], x[7], x[8], x[9]); let f = fr_conductor(x[11], s * 3.0, s * 5.0);
        y = array(f.x, f.y, f.z, f.w, 0, 0, 0, 0);"),
    law!("TrowbridgeReitz" 1e-4 1e-4,
        x => {
            let (d, w) = (distribution(x), wo(x));
            if w.z == 0.0 {
                return Vec::new();
            }
            let wm = d.sample_wm(w, u(x));
            vec![wm.x, wm.y, wm.z, d.pdf(w, wm), d.g(w, wi(x))]
        },
        "let d = TrowbridgeReitz_new(0.02 + x[9], 0.02 + x[10]);
        if (wo.z != 0.0) {
            let wm = TrowbridgeReitz_sample_wm(d, wo, u);
            y = array(wm.x, wm.y, wm.z, TrowbridgeReitz_pdf(d, wo, wm), TrowbridgeReitz_g(d, wo, wi), 0, 0, 0);
        }"),
    law!("HenyeyGreenstein" 1e-3 0.0,
        x => {
            let phase = HenyeyGreenstein { g: 1.8 * x[8] - 0.9 };
            let (w, pdf) = phase.sample_p(wo(x), u(x));
            // At the poles the direction has few digits.
            let cos = w.dot(wo(x));
            let w = w * (1.0 - cos * cos);
            vec![w.x, w.y, w.z, pdf, phase.p(wo(x), wi(x)), cos]
        },
        "let phase = HenyeyGreenstein(1.8 * x[8] - 0.9); let s = HenyeyGreenstein_sample_p(phase, wo, u);
        let cos = dot(s.v0, wo); let w = s.v0 * (1.0 - cos * cos);
        y = array(w.x, w.y, w.z, s.v1, HenyeyGreenstein_p(phase, wo, wi), cos, 0, 0);"),
    law!("Diffuse" 3e-6 0.0, x => value(&Diffuse { reflectance: spectrum(x, 1.0) }, x),
        value!("Diffuse", "Diffuse(vec4f(x[6], x[7], x[8], x[9]))")),
    law!("Diffuse, sampled" 3e-6 0.0, x => sampled(&Diffuse { reflectance: spectrum(x, 1.0) }, x),
        sampled!("Diffuse", "Diffuse(vec4f(x[6], x[7], x[8], x[9]))")),
    law!("DiffuseTransmission" 3e-6 0.0,
        x => value(&DiffuseTransmission { reflectance: spectrum(x, 0.4), transmittance: spectrum(x, 0.5) }, x),
        value!("DiffuseTransmission",
            "DiffuseTransmission(vec4f(x[6], x[7], x[8], x[9]) * 0.4, vec4f(x[6], x[7], x[8], x[9]) * 0.5)")),
    law!("DiffuseTransmission, sampled" 3e-6 1e-4,
        x => sampled(&DiffuseTransmission { reflectance: spectrum(x, 0.4), transmittance: spectrum(x, 0.5) }, x),
        sampled!("DiffuseTransmission",
            "DiffuseTransmission(vec4f(x[6], x[7], x[8], x[9]) * 0.4, vec4f(x[6], x[7], x[8], x[9]) * 0.5)")),
    law!("Conductor" 1e-4 1e-4, x => value(&conductor(x), x),
        value!("Conductor", "Conductor(TrowbridgeReitz_new(0.02 + x[9], 0.02 + x[10]),
            vec4f(x[6], x[7], x[8], x[9]) * 3.0, vec4f(x[6], x[7], x[8], x[9]) * 5.0)")),
    law!("Conductor, sampled" 1e-4 1e-4, x => sampled(&conductor(x), x),
        sampled!("Conductor", "Conductor(TrowbridgeReitz_new(0.02 + x[9], 0.02 + x[10]),
            vec4f(x[6], x[7], x[8], x[9]) * 3.0, vec4f(x[6], x[7], x[8], x[9]) * 5.0)")),
    law!("Dielectric" 1e-4 1e-4, x => value(&dielectric(x), x),
        value!("Dielectric", "Dielectric(0.5 + 2.0 * x[11], TrowbridgeReitz_new(0.02 + x[9], 0.02 + x[10]))")),
    law!("Dielectric, sampled" 1e-4 1e-4, x => sampled(&dielectric(x), x),
        sampled!("Dielectric", "Dielectric(0.5 + 2.0 * x[11], TrowbridgeReitz_new(0.02 + x[9], 0.02 + x[10]))")),
    law!("Dielectric, smooth" 1e-5 1e-4,
        x => sampled(&Dielectric { eta: 0.5 + 2.0 * x[11], distribution: TrowbridgeReitz::new(0.0, 0.0) }, x),
        sampled!("Dielectric", "Dielectric(0.5 + 2.0 * x[11], TrowbridgeReitz_new(0.0, 0.0))")),
    law!("ThinDielectric" 1e-5 1e-4, x => sampled(&ThinDielectric { eta: 0.5 + 2.0 * x[11] }, x),
        sampled!("ThinDielectric", "ThinDielectric(0.5 + 2.0 * x[11])")),
    law!("Hair" 1e-4 1e-4, x => value(&hair(x), x),
        value!("Hair", "Hair_new(2.0 * x[8] - 1.0, 1.3 + 0.5 * x[9], vec4f(x[6], x[7], x[8], x[9]) * 2.0,
            0.1 + 0.9 * vec2f(x[10], x[11]), 5.0 * x[7])")),
    law!("Hair, sampled" 3e-3 1e-3, x => sampled(&hair(x), x),
        sampled!("Hair", "Hair_new(2.0 * x[8] - 1.0, 1.3 + 0.5 * x[9], vec4f(x[6], x[7], x[8], x[9]) * 2.0,
            0.1 + 0.9 * vec2f(x[10], x[11]), 5.0 * x[7])")),
    law!("Layered, closed form" 1e-4 1e-4, x => value(&varnished(x), x),
        value!("Layered_Diffuse", "Layered_Diffuse(Diffuse(vec4f(x[6], x[7], x[8], x[9]) * 0.9),
            Dielectric(1.2 + x[11], TrowbridgeReitz_new(0.0, 0.0)), 0.5 * x[8], vec4f(),
            HenyeyGreenstein(0.3), 0.6, 6, 2, bitcast<u32>(x[10]))")),
    law!("Layered, closed form, sampled" 1e-4 1e-4, x => sampled(&varnished(x), x),
        sampled!("Layered_Diffuse", "Layered_Diffuse(Diffuse(vec4f(x[6], x[7], x[8], x[9]) * 0.9),
            Dielectric(1.2 + x[11], TrowbridgeReitz_new(0.0, 0.0)), 0.5 * x[8], vec4f(),
            HenyeyGreenstein(0.3), 0.6, 6, 2, bitcast<u32>(x[10]))")),
    law!("Layered over Diffuse" 1e-3 1e-2,
        x => value(&layered(Diffuse { reflectance: spectrum(x, 0.9) }, x), x),
        value!("Layered_Diffuse", "Layered_Diffuse(Diffuse(vec4f(x[6], x[7], x[8], x[9]) * 0.9),
            Dielectric(1.2 + x[11], TrowbridgeReitz_new(0.02 + x[9], 0.02 + x[10])), 0.5 * x[8], vec4f(0.5 * x[9]),
            HenyeyGreenstein(0.3), -1.0, 6, 2, bitcast<u32>(x[10]))")),
    law!("Layered over Conductor" 1e-3 1e-2, x => value(&layered(conductor(x), x), x),
        value!("Layered_Conductor", "Layered_Conductor(Conductor(TrowbridgeReitz_new(0.02 + x[9], 0.02 + x[10]),
            vec4f(x[6], x[7], x[8], x[9]) * 3.0, vec4f(x[6], x[7], x[8], x[9]) * 5.0),
            Dielectric(1.2 + x[11], TrowbridgeReitz_new(0.02 + x[9], 0.02 + x[10])), 0.5 * x[8], vec4f(0.5 * x[9]),
            HenyeyGreenstein(0.3), -1.0, 6, 2, bitcast<u32>(x[10]))")),
    law!("Layered over Conductor, sampled" 1e-3 1e-2, x => sampled(&layered(conductor(x), x), x),
        sampled!("Layered_Conductor", "Layered_Conductor(Conductor(TrowbridgeReitz_new(0.02 + x[9], 0.02 + x[10]),
            vec4f(x[6], x[7], x[8], x[9]) * 3.0, vec4f(x[6], x[7], x[8], x[9]) * 5.0),
            Dielectric(1.2 + x[11], TrowbridgeReitz_new(0.02 + x[9], 0.02 + x[10])), 0.5 * x[8], vec4f(0.5 * x[9]),
            HenyeyGreenstein(0.3), -1.0, 6, 2, bitcast<u32>(x[10]))")),
];
