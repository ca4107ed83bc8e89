//! A hit on each kind of surface: the BSDF and its density for a direction of light, and a sample,
//! for one path and in the lanes of the processor's vectors.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use lanes::{InstructionSet, Kernel, Real};
use math::{Vec2, Vec3, Vector3};
use sampling::HashSequence;
use sampling::warp::sample_cosine_hemisphere;
use scattering::{
    Conductor, Dielectric, Diffuse, Directions, Hair, HenyeyGreenstein, Layered, Scatter, TransportMode,
    TrowbridgeReitz, inner_reflectance,
};
use spectrum::SampledSpectrum;
use std::hint::black_box;

const HITS: usize = 1024;

/// A surface that can be made for any number of lanes.
trait Surface {
    type Bxdf<R: Real>: Scatter<R>;

    fn bxdf<R: Real>(&self, seed: R::Int) -> Self::Bxdf<R>;
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
            type Bxdf<$real: Real> = $bxdf;

            #[inline(always)]
            fn bxdf<$real: Real>(&self, $seed: $real::Int) -> Self::Bxdf<$real> {
                $value
            }
        }
    )*};
}

surfaces! {
    Matte(_seed, R) -> Diffuse<R> = Diffuse { reflectance: grey(0.5) };
    Metal(_seed, R) -> Conductor<R> = metal();
    Glass(_seed, R) -> Dielectric<R> = Dielectric { eta: R::splat(1.5), distribution: facets(0.2) };
    Satin(seed, R) -> Layered<Diffuse<R>, R> = coat(Diffuse { reflectance: grey(0.5) }, 0.2, -1.0, seed);
    Lacquered(seed, R) -> Layered<Conductor<R>, R> = coat(metal(), 0.1, -1.0, seed);
    Fibre(_seed, R) -> Hair<R> =
        Hair::new(R::splat(0.3), R::splat(1.55), grey(0.3), [R::splat(0.3); 2], R::splat(2.0));
}

/// A smooth coat, with its mean inner reflectance.
struct Glazed(f32);

impl Surface for Glazed {
    type Bxdf<R: Real> = Layered<Diffuse<R>, R>;

    #[inline(always)]
    fn bxdf<R: Real>(&self, seed: R::Int) -> Self::Bxdf<R> {
        coat(Diffuse { reflectance: grey(0.5) }, 0.0, self.0, seed)
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
    measure(c, "hair", Fibre);
}

criterion_group!(scattering_hits, hits);
criterion_main!(scattering_hits);
