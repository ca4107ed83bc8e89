//! Hair and fur: a fibre of dielectric with an absorbing inside and a surface of tilted scales.
//!
//! The local frame has x along the fibre. With the angle θ to the plane across the fibre and φ
//! around it, light is scattered in lobes p = 0, 1, 2, … by the number of segments that it goes
//! inside of the fibre (reflection, transmission twice, one inner reflection, …):
//!
//! ```text
//! f |cos| = Σ_p M_p(θo, θi) A_p(ωo) N_p(φi − φo)
//! M_p = I₀(cos θi cos θo/v) exp(−sin θi sin θo/v) / (2v sinh(1/v))        v = v(β_m, p)
//! A_0 = F      A_p = (1 − F)² Tᵖ Fᵖ⁻¹      T = exp(−2 σ_a cos γt / cos θt)
//! N_p = the logistic distribution of scale s(β_n) around Φ = 2 p γt − 2 γo + p π, within ±π
//! ```
//!
//! The last lobe is the sum over all p ≥ 3 and uniform around the fibre. γo is the angle of
//! incidence across the fibre, by the offset h in [−1, 1] from its middle, γt that of the
//! refraction. The scales turn θo by multiples of their angle α. The albedo is at most 1, and 1
//! without absorption. As only θo is turned, the model is not reciprocal: importance is scattered
//! by its adjoint.
//!
//! A lobe is sampled by its share A_p, then the angles, all exactly. Sources: [Chiang 2016],
//! [Marschner 2003], [dEon 2011], [Pharr 2023 §9.9].

use super::{BsdfSample, Scatter};
use crate::{BxdfFlags, Directions, TransportMode, fr_dielectric};
use lanes::{Mask, Real, asin, atan2, exp, ln, powi, sin_cos};
use math::{Vec2, Vec3, Vector3, safe_sqrt, same_hemisphere, sqr};
use spectrum::SampledSpectrum;
use std::f32::consts::{PI, TAU};

/// The lobes before the last one.
const P_MAX: usize = 3;

/// √(π/8): the scale of the logistic distribution with the maximum of a normal one, over its
/// deviation.
const SQRT_PI_OVER_8: f32 = 0.626_657_07;

/// Scattering by a fibre.
#[derive(Clone, Copy, Debug)]
pub struct Hair<R = f32> {
    /// The offset of the ray from the middle of the fibre over its radius, in [−1, 1].
    h: R,
    /// Index of refraction of the fibre.
    eta: R,
    /// Absorption per radius of the fibre.
    sigma_a: SampledSpectrum<R>,
    /// Variance of each longitudinal lobe.
    v: [R; 4],
    /// Scale of the azimuthal lobes.
    s: R,
    /// Sine and cosine of α, 2α and 4α.
    tilts: [(R, R); 3],
}

impl<R: Real> Hair<R> {
    /// A fibre at the offset `h` in [−1, 1] from its middle, of index `eta` and absorption
    /// `sigma_a` per radius. Its longitudinal and azimuthal roughness `beta_m` and `beta_n` lie in
    /// (0, 1]; its scales have the angle `alpha` in degrees.
    #[inline(always)]
    pub fn new(h: R, eta: R, sigma_a: SampledSpectrum<R>, [beta_m, beta_n]: [R; 2], alpha: R) -> Self {
        let c = R::splat;
        let root = c(0.726) * beta_m + c(0.812) * sqr(beta_m) + c(3.7) * powi(beta_m, 20);
        let v = sqr(root);
        let wide = c(4.0) * v;
        let s = c(0.265) * beta_n + c(1.194) * sqr(beta_n) + c(5.372) * powi(beta_n, 22);
        let (s1, c1) = sin_cos(alpha * c(PI / 180.0));
        let (s2, c2) = double_angle(s1, c1);
        let tilts = [(s1, c1), (s2, c2), double_angle(s2, c2)];
        let h = h.clamp(c(-1.0), R::one());
        Self { h, eta, sigma_a, v: [v, c(0.25) * v, wide, wide], s: c(SQRT_PI_OVER_8) * s, tilts }
    }

    /// The absorption that gives a volume of hair of azimuthal roughness `beta_n` about the
    /// `color`, in (0, 1]: a fit of [Chiang 2016 §4.2].
    #[inline(always)]
    pub fn sigma_a_from_reflectance(color: SampledSpectrum<R>, beta_n: R) -> SampledSpectrum<R> {
        let c = R::splat;
        let divisor = c(5.574) + beta_n * c(0.245);
        let divisor = c(2.532) + beta_n * (c(-10.73) + beta_n * divisor);
        let divisor = c(5.969) + beta_n * (c(-0.215) + beta_n * divisor);
        let mut sigma_a = color;
        for value in &mut sigma_a.0 {
            *value = sqr(ln(value.max(R::splat(1e-4))) / divisor);
        }
        sigma_a
    }

    /// Everything that depends on `wo` alone.
    #[inline(always)]
    fn outgoing(&self, wo: Vector3<R>) -> Outgoing<R> {
        let sin_theta = wo.x;
        let cos_theta = safe_sqrt(R::one() - sqr(sin_theta));
        let gamma_o = asin(self.h);
        // The index of refraction of the projection across the fibre (Bravais).
        let index = safe_sqrt(sqr(self.eta) - sqr(sin_theta)) / cos_theta;
        let sin_gamma_t = (self.h / index).clamp(R::splat(-1.0), R::one());
        let cos_gamma_t = safe_sqrt(R::one() - sqr(sin_gamma_t));
        let gamma_t = asin(sin_gamma_t);
        let cos_theta_t = safe_sqrt(R::one() - sqr(sin_theta / self.eta));
        let length = R::splat(2.0) * cos_gamma_t / cos_theta_t;
        let mut transmittance = self.sigma_a;
        for value in &mut transmittance.0 {
            *value = exp(-(*value * length));
        }
        let cos_gamma_o = safe_sqrt(R::one() - sqr(self.h));
        let fresnel = fr_dielectric(cos_theta * cos_gamma_o, self.eta);
        let once = transmittance * sqr(R::one() - fresnel);
        let again = transmittance * fresnel;
        let twice = once * again;
        let rest = (twice * again).safe_div(SampledSpectrum::splat(R::one()) - again);
        let attenuations = [SampledSpectrum::splat(fresnel), once, twice, rest];
        let [a, b, c, d] = [fresnel, once.average(), twice.average(), rest.average()];
        let sum = a + b + c + d;
        let probabilities = [a / sum, b / sum, c / sum, d / sum];
        let phi = atan2(wo.z, wo.y);
        Outgoing { sin_theta, cos_theta, phi, gamma_o, gamma_t, attenuations, probabilities }
    }

    /// Sine and cosine of θo turned by the scales, as lobe `p` meets them.
    #[inline(always)]
    fn tilted(&self, o: &Outgoing<R>, p: usize) -> (R, R) {
        let (sin, cos) = (o.sin_theta, o.cos_theta);
        let [(s1, c1), (s2, c2), (s4, c4)] = self.tilts;
        let (sin, cos) = match p {
            0 => (sin * c2 - cos * s2, cos * c2 + sin * s2),
            1 => (sin * c1 + cos * s1, cos * c1 - sin * s1),
            2 => (sin * c4 + cos * s4, cos * c4 - sin * s4),
            _ => (sin, cos),
        };
        (sin, cos.abs())
    }

    /// M·N of lobe `p` for a direction.
    #[inline(always)]
    fn lobe(&self, o: &Outgoing<R>, p: usize, wi: Vector3<R>, phi: R) -> R {
        let (sin_i, cos_i) = (wi.x, safe_sqrt(R::one() - sqr(wi.x)));
        let (sin_o, cos_o) = self.tilted(o, p);
        let m = longitudinal([sin_i, cos_i], [sin_o, cos_o], self.v[p]);
        let n = if p < P_MAX { logistic_pdf(wrap(phi - o.center(p)), self.s) } else { R::splat(1.0 / TAU) };
        m * n
    }
}

/// What scattering to `wo` depends on.
struct Outgoing<R: Real> {
    sin_theta: R,
    cos_theta: R,
    phi: R,
    gamma_o: R,
    gamma_t: R,
    /// A_p.
    attenuations: [SampledSpectrum<R>; 4],
    /// The probability of each lobe.
    probabilities: [R; 4],
}

impl<R: Real> Outgoing<R> {
    /// Φ(p): the angle around the fibre by which lobe `p` turns light.
    #[inline(always)]
    fn center(&self, p: usize) -> R {
        let p = R::splat(p as f32);
        R::splat(2.0) * (p * self.gamma_t - self.gamma_o) + p * R::splat(PI)
    }
}

#[inline(always)]
fn double_angle<R: Real>(sin: R, cos: R) -> (R, R) {
    (R::splat(2.0) * sin * cos, sqr(cos) - sqr(sin))
}

/// An angle as the equal one within ±π.
#[inline(always)]
fn wrap<R: Real>(angle: R) -> R {
    let turns = (angle * R::splat(1.0 / TAU) + R::splat(0.5)).floor();
    angle - turns * R::splat(TAU)
}

/// M: the longitudinal distribution of variance `v`, for sine and cosine of θi and θo.
#[inline(always)]
fn longitudinal<R: Real>([sin_i, cos_i]: [R; 2], [sin_o, cos_o]: [R; 2], v: R) -> R {
    let inverse = R::one() / v;
    let (a, b) = (cos_i * cos_o * inverse, sin_i * sin_o * inverse);
    // 1/(2v sinh(1/v)) = e^{−1/v} / (v (1 − e^{−2/v})), so that no exponential overflows.
    let scale = inverse / (R::one() - exp(R::splat(-2.0) * inverse));
    exp(ln_bessel_i0(a) - b - inverse) * scale
}

/// The logarithm of the modified Bessel function I₀ of x ≥ 0.
#[inline(always)]
fn ln_bessel_i0<R: Real>(x: R) -> R {
    let c = R::splat;
    // The asymptotic series for large numbers, for others the power series. Its ten terms, those of
    // [Pharr 2023], are up to 2 % too small from 9 to 12.
    let y = R::one() / (c(8.0) * x);
    let series = R::one() + y * (R::one() + y * (c(4.5) + y * c(37.5)));
    let large = x - c(0.5) * ln(c(TAU) * x) + ln(series);
    let quarter = sqr(x) * c(0.25);
    let (mut sum, mut term) = (R::one(), R::one());
    for i in 1..10 {
        term = term * quarter * c(1.0 / (i * i) as f32);
        sum += term;
    }
    R::select(x.gt(c(12.0)), large, ln(sum))
}

/// The logistic distribution of scale `s`, trimmed to ±π.
#[inline(always)]
fn logistic_pdf<R: Real>(x: R, s: R) -> R {
    let e = exp(-(x.abs() / s));
    let pdf = e / (s * sqr(R::one() + e));
    pdf / (R::one() - R::splat(2.0) * logistic_tail(s))
}

/// The logistic distribution function at −π.
#[inline(always)]
fn logistic_tail<R: Real>(s: R) -> R {
    let e = exp(R::splat(-PI) / s);
    e / (R::one() + e)
}

/// A number of [`logistic_pdf`].
#[inline(always)]
fn sample_logistic<R: Real>(u: R, s: R) -> R {
    let tail = logistic_tail(s);
    let at = tail + u * (R::one() - R::splat(2.0) * tail);
    let x = s * ln(at / (R::one() - at));
    x.clamp(R::splat(-PI), R::splat(PI))
}

impl<R: Real> Scatter<R> for Hair<R> {
    #[inline(always)]
    fn flags(&self) -> BxdfFlags<R> {
        BxdfFlags::splat(BxdfFlags::GLOSSY_REFLECTION | BxdfFlags::TRANSMISSION)
    }

    #[inline(always)]
    fn f(&self, wo: Vector3<R>, wi: Vector3<R>, mode: TransportMode) -> SampledSpectrum<R> {
        let (wo, wi) = match mode {
            TransportMode::Radiance => (wo, wi),
            TransportMode::Importance => (wi, wo),
        };
        let o = self.outgoing(wo);
        let phi = atan2(wi.z, wi.y) - o.phi;
        let mut sum = SampledSpectrum::zero();
        for p in 0..=P_MAX {
            sum += o.attenuations[p] * self.lobe(&o, p, wi, phi);
        }
        // A light that is sampled from a point on it may lie exactly along the surface.
        sum.safe_div(SampledSpectrum::splat(wi.z.abs()))
    }

    #[inline(always)]
    fn sample_f(
        &self,
        wo: Vector3<R>,
        uc: R,
        u: Vec2<R>,
        mode: TransportMode,
        directions: Directions,
    ) -> BsdfSample<R> {
        let o = self.outgoing(wo);
        // The lobe, and what is left of `uc`.
        let (mut sin_o, mut cos_o) = self.tilted(&o, 0);
        let (mut v, mut center, mut left) = (self.v[0], o.center(0), uc / o.probabilities[0]);
        let (mut below, mut is_last) = (o.probabilities[0], R::Mask::splat(false));
        for p in 1..=P_MAX {
            let (here, probability) = (uc.ge(below), o.probabilities[p]);
            let (sin, cos) = self.tilted(&o, p);
            sin_o = R::select(here, sin, sin_o);
            cos_o = R::select(here, cos, cos_o);
            v = R::select(here, self.v[p], v);
            center = R::select(here, o.center(p), center);
            left = R::select(here, (uc - below) / probability, left);
            below += probability;
            is_last = here;
        }
        let left = left.clamp(R::zero(), R::splat(math::ONE_MINUS_EPSILON));
        let y = u.x.max(R::splat(1e-5));
        let cos_theta = R::one() + v * ln(y + (R::one() - y) * exp(R::splat(-2.0) / v));
        let sin_theta = safe_sqrt(R::one() - sqr(cos_theta));
        let cos_phi = sin_cos(u.y * R::splat(TAU)).1;
        let sin_i = (sin_theta * cos_phi * cos_o - cos_theta * sin_o).clamp(R::splat(-1.0), R::one());
        let cos_i = safe_sqrt(R::one() - sqr(sin_i));
        let around = R::select(is_last, left * R::splat(TAU), center + sample_logistic(left, self.s));
        let (sin_phi, cos_phi) = sin_cos(wrap(o.phi + around));
        let wi = Vec3::new(sin_i, cos_i * cos_phi, cos_i * sin_phi);
        let pdf = self.pdf(wo, wi, mode, directions);
        let reflects = same_hemisphere(wo, wi);
        let lobe = BxdfFlags::choose(reflects, BxdfFlags::GLOSSY_REFLECTION, BxdfFlags::GLOSSY_TRANSMISSION);
        let valid = directions.meet(lobe) & pdf.gt(R::zero()) & wi.z.ne(R::zero());
        BsdfSample { valid, ..BsdfSample::new(self.f(wo, wi, mode), wi, pdf, lobe) }
    }

    #[inline(always)]
    fn pdf(&self, wo: Vector3<R>, wi: Vector3<R>, _: TransportMode, directions: Directions) -> R {
        let reflects = same_hemisphere(wo, wi);
        let lobe: BxdfFlags<R> = BxdfFlags::choose(reflects, BxdfFlags::REFLECTION, BxdfFlags::TRANSMISSION);
        let o = self.outgoing(wo);
        let phi = atan2(wi.z, wi.y) - o.phi;
        let mut pdf = R::zero();
        for p in 0..=P_MAX {
            pdf += o.probabilities[p] * self.lobe(&o, p, wi, phi);
        }
        R::select(directions.meet(lobe), pdf, R::zero())
    }
}
