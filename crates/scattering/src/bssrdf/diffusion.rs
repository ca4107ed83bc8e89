//! Photon beam diffusion: the light that leaves a half space around the point where a pencil of
//! light enters it along the normal.
//!
//! The beam is refracted into the medium and attenuated. At each depth t it is scattered once
//! straight to the surface (single scattering), or becomes a source of diffusion, to which a
//! mirrored negative one makes the boundary condition (multiple scattering). Both are integrated
//! over t with samples in proportion to the attenuation of the beam:
//!
//! ```text
//! Ess(r) = ∫ σs exp(−σt (t + d)) p(cos θ) (1 − Fr) cos θ/d² dt       d² = r² + t²
//! Ems(r) = ∫ σs' exp(−σt' t) α' κ (Cφ φ(r, t) + CE E(r, t)) dt
//! φ = (exp(−σtr dr)/dr − exp(−σtr dv)/dv)/(4π D)
//! E = (zr (1 + σtr dr) exp(−σtr dr)/dr³ − zv (1 + σtr dv) exp(−σtr dv)/dv³)/(4π)
//! ```
//!
//! with the reduced coefficients σs' = σs (1 − g), σt' = σa + σs' and α' = σs'/σt'; Grosjean's D =
//! (2σa + σs')/(3σt'²), σtr² = σa/D; the depths zr = t and zv = 2ze − t of both sources, whose
//! mirror lies at ze = −2D (1 + 3F₂)/(1 − 2F₁); Cφ = (1 − 2F₁)/4, CE = (1 − 3F₂)/2; and a
//! correction κ = 1 − exp(−2σt' (dr + zr)) close to the beam. F₁, F₂ are moments of the Fresnel
//! reflectance. All lengths are in mean free paths, σt = 1.
//!
//! Sources: [Habel 2013], [dEon 2011a], [Pharr 2016 §15.5].

use crate::{HenyeyGreenstein, fr_dielectric};
use std::f64::consts::PI;

/// Samples along the beam.
const SAMPLES: usize = 100;

/// The middle of the share number `i` of an exponential distribution.
fn free_path(i: usize) -> f64 {
    -libm::log(1.0 - (i as f64 + 0.5) / SAMPLES as f64)
}

/// ∫₀¹ Fr(μ) μⁿ dμ for light in the medium that meets its boundary, of relative index `eta` below
/// over above.
fn fresnel_moment(eta: f64, n: i32) -> f64 {
    const STEPS: usize = 1024;
    let step = |i: usize| {
        let mu = (i as f64 + 0.5) / STEPS as f64;
        f64::from(fr_dielectric(-mu as f32, eta as f32)) * mu.powi(n)
    };
    (0..STEPS).map(step).sum::<f64>() / STEPS as f64
}

/// A medium with a boundary, in which a mean free path has the length 1.
pub(super) struct HalfSpace {
    /// Asymmetry of scattering.
    g: f64,
    /// Index of refraction below over above.
    eta: f64,
    /// F₁ and F₂.
    moments: [f64; 2],
}

impl HalfSpace {
    /// Of asymmetry `g` and relative index `eta`.
    pub fn new(g: f64, eta: f64) -> Self {
        Self { g, eta, moments: [fresnel_moment(eta, 1), fresnel_moment(eta, 2)] }
    }

    /// The share of uniform light from outside that the boundary lets in.
    pub fn transmitted_from_outside(&self) -> f64 {
        1.0 - 2.0 * fresnel_moment(1.0 / self.eta, 1)
    }

    /// The light that leaves at the distance `r`, per area, if a share `albedo` of what is
    /// extinguished is scattered.
    pub fn profile(&self, albedo: f64, r: f64) -> f64 {
        self.single(albedo, r) + self.multiple(albedo, r)
    }

    fn single(&self, albedo: f64, r: f64) -> f64 {
        // Light from nearer to the surface is reflected back inside.
        let critical = r * (self.eta * self.eta - 1.0).max(0.0).sqrt();
        let phase = HenyeyGreenstein { g: self.g as f32 };
        let sample = |i| {
            let t = critical + free_path(i);
            let d = libm::hypot(r, t);
            let cosine = t / d;
            let turned = f64::from(phase.p_of_cos(cosine as f32));
            let passes = 1.0 - f64::from(fr_dielectric(-cosine as f32, self.eta as f32));
            albedo * libm::exp(-(d + critical)) / (d * d) * turned * passes * cosine
        };
        (0..SAMPLES).map(sample).sum::<f64>() / SAMPLES as f64
    }

    fn multiple(&self, albedo: f64, r: f64) -> f64 {
        let (absorbed, scattered) = (1.0 - albedo, albedo * (1.0 - self.g));
        let extinction = absorbed + scattered;
        let reduced = scattered / extinction;
        let diffusion = (2.0 * absorbed + scattered) / (3.0 * extinction * extinction);
        let decay = (absorbed / diffusion).sqrt();
        let [f1, f2] = self.moments;
        let mirror = -2.0 * diffusion * (1.0 + 3.0 * f2) / (1.0 - 2.0 * f1);
        let (by_fluence, by_flux) = (0.25 * (1.0 - 2.0 * f1), 0.5 * (1.0 - 3.0 * f2));
        let sample = |i| {
            let depth = free_path(i) / extinction;
            let near = libm::hypot(r, depth);
            let source = |z: f64| {
                let d = libm::hypot(r, z);
                let share = libm::exp(-decay * d) / (4.0 * PI * d);
                [share / diffusion, z * (1.0 + decay * d) * share / (d * d)]
            };
            let ([fluence, flux], [fluence_v, flux_v]) = (source(depth), source(2.0 * mirror - depth));
            let leaves = (fluence - fluence_v) * by_fluence + (flux - flux_v) * by_flux;
            let correction = 1.0 - libm::exp(-2.0 * extinction * (near + depth));
            correction * reduced * reduced * leaves
        };
        (0..SAMPLES).map(sample).sum::<f64>() / SAMPLES as f64
    }
}
