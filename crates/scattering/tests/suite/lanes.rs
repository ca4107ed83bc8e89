//! BxDFs in lanes give the bits of single numbers, also where lanes differ in kind.

use alhazen_scattering::{
    Bsdf, BxdfFlags, Conductor, Dielectric, Diffuse, DiffuseTransmission, Directions, Scatter,
    ThinDielectric, TransportMode, TrowbridgeReitz,
};
use lanes::Real;
use math::{Vec2, Vector3};
use sampling::warp::sample_uniform_sphere;
use spectrum::SampledSpectrum;
use testkit::{LaneFunction, lanes_agree};

/// All members with parameters that differ per lane: smooth and rough, from black to white, with
/// an index of refraction of one or another.
struct Bxdfs {
    mode: TransportMode,
    directions: Directions,
}

/// Uniform numbers for the results.
const NUMBERS: usize = 23;

impl LaneFunction for Bxdfs {
    #[inline(always)]
    fn results<R: Real>(&self, u: &[R]) -> Vec<R> {
        let spectrum = |from: usize| SampledSpectrum::new([u[from], u[from + 1], u[from + 2], u[from + 3]]);
        let quarter = R::splat(0.25);
        let black_or = |u: R, s| SampledSpectrum::select(u.gt(quarter), s, SampledSpectrum::zero());
        let (reflectance, transmittance) = (black_or(u[17], spectrum(0)), black_or(u[18], spectrum(4)));
        let alpha = |u: R| R::select(u.lt(quarter), R::zero(), u * u);
        let distribution = TrowbridgeReitz::new(alpha(u[8]), alpha(u[9]));
        let eta = u[10] * R::splat(2.0) + R::splat(0.5);
        let k = spectrum(4) * R::splat(4.0);

        let mut results = Vec::new();
        self.evaluate(&mut results, Diffuse { reflectance }, u);
        self.evaluate(&mut results, DiffuseTransmission { reflectance, transmittance }, u);
        self.evaluate(&mut results, Conductor { distribution, eta: reflectance, k }, u);
        self.evaluate(&mut results, Dielectric { eta, distribution }, u);
        self.evaluate(&mut results, ThinDielectric { eta }, u);
        results
    }
}

impl Bxdfs {
    /// Value, density and sample of a BxDF, which is regularized in some lanes.
    #[inline(always)]
    fn evaluate<R: Real>(&self, results: &mut Vec<R>, bxdf: impl Scatter<R>, u: &[R]) {
        let Self { mode, directions } = *self;
        let pair = |from: usize| Vec2::new(u[from], u[from + 1]);
        let (wo, wi) = (sample_uniform_sphere(pair(11)), sample_uniform_sphere(pair(13)));
        let n = sample_uniform_sphere(pair(15));
        let mut bsdf = Bsdf::new(n, wi, bxdf);
        bsdf.regularize(u[22].gt(R::splat(0.5)));

        results.extend(bsdf.f(wo, wi, mode).0);
        results.push(bsdf.pdf(wo, wi, mode, directions));
        let sample = bsdf.sample_lanes(wo, u[19], pair(20), mode, directions);
        let value = |x: R| R::select(sample.valid, x, R::zero());
        let yes = |mask: R::Mask| R::select(mask, R::one(), R::zero());
        results.extend(sample.f.0.map(value));
        results.extend(Vector3::to_array(sample.wi).map(value));
        results.extend([value(sample.pdf), value(sample.eta), yes(sample.valid)]);
        results.push(value(yes(sample.flags.is_specular())));
        results.push(value(yes(sample.flags.is_transmissive())));
        results.push(yes(bsdf.flags().contains(BxdfFlags::SPECULAR_TRANSMISSION)));
    }
}

#[test]
fn bxdfs_do_not_depend_on_the_number_of_lanes() {
    for mode in [TransportMode::Radiance, TransportMode::Importance] {
        for directions in [Directions::All, Directions::Reflection, Directions::Transmission] {
            lanes_agree(&Bxdfs { mode, directions }, NUMBERS, 100);
        }
    }
}
