//! A hit on each kind of surface: the BSDF and its density for a direction of light, and a sample,
//! for one path and in the lanes of the processor's vectors.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use lanes::{InstructionSet, Kernel, Real};
use math::{Vec2, Vec3, Vector3};
use sampling::HashSequence;
use sampling::warp::sample_cosine_hemisphere;
use scattering::{
    Conductor, Dielectric, Diffuse, DiffuseTransmission, Directions, Hair, HenyeyGreenstein, Layered,
    Measured, MeasuredData, MeasuredGrid, MeasuredTable, OpenPbr, OpenPbrParameters, OpenPbrTable, Scatter,
    ThinDielectric, TransportMode, TrowbridgeReitz, inner_reflectance,
};
use spectrum::{SampledSpectrum, SampledWavelengths};
use std::f32::consts::FRAC_PI_2;
use std::hint::black_box;

const HITS: usize = 1024;

/// A surface that can be made for any number of lanes.
trait Surface {
    type Bxdf<'a, R: Real>: Scatter<R>
    where
        Self: 'a;

    fn bxdf<R: Real>(&self, seed: R::Int) -> Self::Bxdf<'_, R>;
}

fn grey<R: Real>(value: f32) -> SampledSpectrum<R> {
    SampledSpectrum::splat(R::splat(value))
}

#[inline(always)]
fn facets<R: Real>(alpha: f32) -> TrowbridgeReitz<R> {
    TrowbridgeReitz::new(R::splat(alpha), R::splat(alpha))
}

#[inline(always)]
fn coat<B, R: Real>(base: B, alpha: f32, inner: f32, seed: R::Int) -> Layered<B, R> {
    Layered {
        base,
        interface: Dielectric { eta: R::splat(1.5), distribution: facets(alpha) },
        thickness: R::splat(0.01),
        albedo: SampledSpectrum::zero(),
        phase: HenyeyGreenstein { g: R::zero() },
        inner: R::splat(inner),
        max_depth: 10,
        samples: 1,
        seed,
    }
}

macro_rules! surfaces {
    ($($name:ident($seed:ident, $real:ident) -> $bxdf:ty = $value:expr;)*) => {$(
        struct $name;

        impl Surface for $name {
            type Bxdf<'a, $real: Real> = $bxdf;

            #[inline(always)]
            fn bxdf<$real: Real>(&self, $seed: $real::Int) -> Self::Bxdf<'_, $real> {
                $value
            }
        }
    )*};
}

surfaces! {
    Matte(_seed, R) -> Diffuse<R> = Diffuse { reflectance: grey(0.5) };
    Metal(_seed, R) -> Conductor<R> = metal();
    Leaf(_seed, R) -> DiffuseTransmission<R> =
        DiffuseTransmission { reflectance: grey(0.4), transmittance: grey(0.3) };
    Pane(_seed, R) -> ThinDielectric<R> = ThinDielectric { eta: R::splat(1.5) };
    Glass(_seed, R) -> Dielectric<R> = Dielectric { eta: R::splat(1.5), distribution: facets(0.2) };
    Satin(seed, R) -> Layered<Diffuse<R>, R> = coat(Diffuse { reflectance: grey(0.5) }, 0.2, -1.0, seed);
    Lacquered(seed, R) -> Layered<Conductor<R>, R> = coat(metal(), 0.1, -1.0, seed);
    Fibre(_seed, R) -> Hair<R> =
        Hair::new(R::splat(0.3), R::splat(1.55), grey(0.3), [R::splat(0.3); 2], R::splat(2.0));
}

/// A smooth coat, with its mean inner reflectance.
struct Glazed(f32);

impl Surface for Glazed {
    type Bxdf<'a, R: Real> = Layered<Diffuse<R>, R>;

    #[inline(always)]
    fn bxdf<R: Real>(&self, seed: R::Int) -> Self::Bxdf<'_, R> {
        coat(Diffuse { reflectance: grey(0.5) }, 0.0, self.0, seed)
    }
}

#[inline(always)]
fn wavelengths<R: Real>() -> SampledWavelengths<R> {
    SampledWavelengths::new([450.0, 520.0, 580.0, 640.0].map(R::splat), [R::one(); 4])
}

/// A measured surface, as large as files of spectra are.
impl Surface for MeasuredTable {
    type Bxdf<'a, R: Real> = Measured<'a, R>;

    #[inline(always)]
    fn bxdf<R: Real>(&self, _: R::Int) -> Measured<'_, R> {
        Measured::new(self, &wavelengths())
    }
}

fn measured() -> MeasuredTable {
    let theta: Vec<f32> = (0..8).map(|i| FRAC_PI_2 * i as f32 / 7.0).collect();
    let wavelengths: Vec<f32> = (0..195).map(|i| 360.0 + 3.2 * i as f32).collect();
    let grid = |layers: usize| MeasuredGrid { size: [32, 32], values: vec![0.7; layers * 32 * 32] };
    let data = MeasuredData {
        ndf: grid(1),
        sigma: grid(1),
        vndf: grid(theta.len()),
        luminance: grid(theta.len()),
        values: grid(theta.len() * wavelengths.len()),
        phi: vec![0.0],
        wavelengths: Some(wavelengths),
        theta,
    };
    MeasuredTable::new(data).expect("tables that fit")
}

/// A principled surface by its shares of metal, glass, coat, fuzz and film, with its table.
struct Principled([f32; 5], OpenPbrTable);

impl Principled {
    fn new(shares: [f32; 5]) -> Self {
        let parameters = principled(shares);
        Self(shares, OpenPbrTable::new(&parameters, &parameters))
    }
}

#[inline(always)]
fn principled<R: Real>([metal, glass, coat, fuzz, film]: [f32; 5]) -> OpenPbrParameters<R> {
    OpenPbrParameters {
        base_metalness: R::splat(metal),
        transmission_weight: R::splat(glass),
        coat_weight: R::splat(coat),
        fuzz_weight: R::splat(fuzz),
        thin_film_weight: R::splat(film),
        ..OpenPbrParameters::default()
    }
}

impl Surface for Principled {
    type Bxdf<'a, R: Real> = OpenPbr<'a, R>;

    #[inline(always)]
    fn bxdf<R: Real>(&self, _: R::Int) -> OpenPbr<'_, R> {
        OpenPbr::new(&self.1, &principled(self.0), &wavelengths())
    }
}

#[inline(always)]
fn metal<R: Real>() -> Conductor<R> {
    Conductor { distribution: facets(0.2), eta: grey(0.3), k: grey(3.0) }
}

/// All hits of a surface, as many at once as there are lanes.
struct Hits<'a, S>(&'a S);

impl<S: Surface> Kernel for Hits<'_, S> {
    type Output = f32;

    #[inline(always)]
    fn run<R: Real>(self) -> f32 {
        let mut sum = R::zero();
        for first in (0..HITS).step_by(R::LANES) {
            let index = R::from_fn(|lane| (first + lane) as f32).to_bits();
            let mut random = HashSequence::new([index]);
            let wo = sample_cosine_hemisphere(random.get_2d());
            let wi = sample_cosine_hemisphere(random.get_2d());
            let (uc, u) = (random.get_1d(), random.get_2d());
            sum += hit(&self.0.bxdf::<R>(index), wo, wi, uc, u);
        }
        sum.lane(0)
    }
}

#[inline(always)]
fn hit<R: Real>(bxdf: &impl Scatter<R>, wo: Vector3<R>, wi: Vector3<R>, uc: R, u: Vec2<R>) -> R {
    let mode = TransportMode::Radiance;
    let f = bxdf.f(wo, wi, mode)[0] + bxdf.pdf(wo, wi, mode, Directions::All);
    let sample = bxdf.sample_f(wo, uc, u, mode, Directions::All);
    let found = sample.f[0] + Vec3::dot(sample.wi, wi) + sample.pdf;
    f + R::select(sample.valid, found, R::zero())
}

fn measure<S: Surface>(c: &mut Criterion, name: &str, surface: S) {
    let mut group = c.benchmark_group(name);
    group.throughput(Throughput::Elements(HITS as u64));
    group.bench_function("one", |b| b.iter(|| black_box(Hits(black_box(&surface)).run::<f32>())));
    let set = InstructionSet::detect();
    group.bench_function("lanes", |b| b.iter(|| black_box(set.dispatch(Hits(black_box(&surface))))));
}

fn hits(c: &mut Criterion) {
    measure(c, "diffuse", Matte);
    measure(c, "conductor", Metal);
    measure(c, "dielectric", Glass);
    measure(c, "coated diffuse, smooth", Glazed(inner_reflectance(1.5, 0.01)));
    measure(c, "coated diffuse, rough", Satin);
    measure(c, "coated conductor", Lacquered);
    measure(c, "diffuse transmission", Leaf);
    measure(c, "thin dielectric", Pane);
    measure(c, "hair", Fibre);
    measure(c, "measured", measured());
    measure(c, "openpbr", Principled::new([0.0; 5]));
    measure(c, "openpbr, half metal, coated", Principled::new([0.5, 0.0, 1.0, 0.0, 0.0]));
    measure(c, "openpbr, fuzz", Principled::new([0.0, 0.0, 0.0, 1.0, 0.0]));
    measure(c, "openpbr, glass", Principled::new([0.0, 1.0, 0.0, 0.0, 0.0]));
    measure(c, "openpbr, film", Principled::new([0.0, 0.0, 0.0, 0.0, 1.0]));
}

criterion_group!(scattering_hits, hits);
criterion_main!(scattering_hits);
