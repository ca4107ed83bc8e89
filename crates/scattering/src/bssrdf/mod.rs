//! Scattering under a surface: light that enters a body at one point leaves it at another.
//!
//! The light that leaves at po along ωo, for light from ωi at pi, is taken as separable,
//!
//! ```text
//! S(po, ωo, pi, ωi) = (1 − Fr(ωo)) Sp(|po − pi|) Sw(ωi)       Sw = (1 − Fr(ωi))/(c π)
//! ```
//!
//! with the Fresnel reflectance Fr, a radial profile Sp of the distance alone, tabulated by photon
//! beam diffusion in a half space ([`BssrdfTable`]), and c, by which Sw cos θ has the integral 1. A
//! path that is transmitted at po therefore goes on from pi by a [`NormalizedFresnel`] lobe.
//!
//! pi is found by a probe: a ray parallel to one of the three axes of a frame about po, at a
//! distance with the density of the profile, that crosses the sphere which has all but 0.1 % of the
//! profile. Any of its intersections with the body is a pi; of all the ways to find it, by each
//! axis, the density is the sum. The profile differs between wavelengths; one of them, the hero,
//! chooses the distance.
//!
//! Sources: [Jensen 2001], [Habel 2013], [King 2013], [Pharr 2016 §11.4, §15.4, §15.5].

mod boundary;
mod diffusion;
mod method;
mod spline;
mod table;
mod walks;

pub use method::SubsurfaceMethod;
use table::Profile;
pub use table::{BssrdfTable, PlainBssrdfTable};

use crate::{HenyeyGreenstein, Interior, NormalizedFresnel, TrowbridgeReitz};
use math::{Frame, Normal3, Vec2, Vector3, safe_sqrt, sqr};
use spectrum::{N, SampledSpectrum};
use std::f32::consts::TAU;

/// Probabilities of probes along the axes of the frame, of which the last is the normal.
const AXES: [f32; 3] = [0.25, 0.25, 0.5];

/// The share of the profile that probes reach.
const REACHED: f32 = 0.999;

/// Scattering under the surface of a body at a point.
#[derive(Clone, Copy, Debug)]
#[doc(alias = "TabulatedBSSRDF")]
pub struct Bssrdf<'a> {
    table: &'a BssrdfTable,
    /// Extinction per unit of length.
    sigma_t: SampledSpectrum,
    albedo: SampledSpectrum,
}

/// A segment that may meet the body where light leaves it, relative to the point of entry.
#[derive(Clone, Copy, Debug)]
pub struct Probe {
    /// Its start.
    pub start: Vector3,
    /// Unit direction.
    pub direction: Vector3,
    /// Its length.
    pub length: f32,
}

impl<'a> Bssrdf<'a> {
    /// Of a medium with coefficients ≥ 0 per unit of length.
    pub fn new(table: &'a BssrdfTable, sigma_a: SampledSpectrum, sigma_s: SampledSpectrum) -> Self {
        let sigma_t = sigma_a + sigma_s;
        Self { table, sigma_t, albedo: sigma_s.safe_div(sigma_t) }
    }

    /// Of a medium of a mean free path that has an effective albedo by a method, under a boundary
    /// of facets.
    pub fn from_reflectance(
        table: &'a BssrdfTable,
        method: SubsurfaceMethod,
        facets: &TrowbridgeReitz,
        effective_albedo: SampledSpectrum,
        mean_free_path: SampledSpectrum,
    ) -> Self {
        let albedo = effective_albedo.map(|share| table.albedo(method, facets, share));
        // At no distance at all the profile has no value.
        Self { table, sigma_t: mean_free_path.map(|l| 1.0 / l.max(1e-6)), albedo }
    }

    /// The relative index of refraction, below over above.
    pub fn eta(&self) -> f32 {
        self.table.eta()
    }

    /// The medium.
    pub fn interior(&self) -> Interior {
        Interior {
            sigma_s: self.albedo * self.sigma_t,
            sigma_t: self.sigma_t,
            phase: HenyeyGreenstein { g: self.table.g() },
            eta: self.eta(),
        }
    }

    /// The lobe by which light that leaves the body has entered it.
    pub fn exit(&self) -> NormalizedFresnel {
        NormalizedFresnel::new(self.table)
    }

    /// By how much more counts what `facets` of a boundary refract between a direction above and
    /// the inside, so that all light enters which they do not reflect.
    pub(crate) fn gain(&self, facets: &TrowbridgeReitz, w: Vector3) -> f32 {
        self.table.gain(facets, w)
    }

    /// The share of the light that entered which leaves again, by the profile.
    pub fn effective_albedo(&self) -> SampledSpectrum {
        self.albedo.map(|albedo| self.table.effective_albedo(albedo))
    }

    /// The profiles of the wavelengths.
    pub fn profiles(&self) -> Profiles<'a> {
        let Self { table, sigma_t, albedo } = *self;
        Profiles { table, sigma_t, profiles: table.profiles(albedo) }
    }
}

/// The profiles of four wavelengths, found in the table once for all distances.
#[derive(Clone, Copy, Debug)]
pub struct Profiles<'a> {
    table: &'a BssrdfTable,
    /// Extinction per unit of length.
    sigma_t: SampledSpectrum,
    profiles: [Profile; N],
}

impl Profiles<'_> {
    /// The profile Sp at a distance, per area.
    pub fn at(&self, r: f32) -> SampledSpectrum {
        self.at_radius(r).0
    }

    /// The profile at a distance and its density over a plane, of each wavelength.
    fn at_radius(&self, r: f32) -> (SampledSpectrum, SampledSpectrum) {
        let per_area = self.sigma_t * self.sigma_t;
        let (profile, density) = self.table.at_radii(&self.profiles, self.sigma_t * r);
        (profile * per_area, density * per_area)
    }

    /// A distance with the density of the profile of wavelength number `hero`; `None` without a
    /// profile.
    pub fn sample_radius(&self, hero: usize, u: f32) -> Option<f32> {
        let sigma_t = self.sigma_t[hero];
        let radius = self.table.sample_radius(&self.profiles[hero], u)? / sigma_t;
        radius.is_finite().then_some(radius)
    }

    /// A probe about a point with normal `n`, by the profile of wavelength number `hero`: `uc`
    /// chooses its axis, `u` its place. `None` where no light leaves.
    #[doc(alias = "Sample_Sp")]
    pub fn sample_probe(&self, n: Normal3, hero: usize, uc: f32, u: Vec2) -> Option<Probe> {
        let Frame { x, y, z } = Frame::from_z(n);
        let (across, along) = if uc < AXES[0] {
            ([y, z], x)
        } else if uc < AXES[0] + AXES[1] {
            ([z, x], y)
        } else {
            ([x, y], z)
        };
        let (r, reach) = (self.sample_radius(hero, u.x)?, self.sample_radius(hero, REACHED)?);
        if r >= reach {
            return None;
        }
        let half = safe_sqrt(sqr(reach) - sqr(r));
        let (sin, cos) = lanes::sin_cos(TAU * u.y);
        let start = across[0] * (r * cos) + across[1] * (r * sin) - along * half;
        Some(Probe { start, direction: along, length: 2.0 * half })
    }

    /// The density per area, for each wavelength as the hero, with which probes about a point with
    /// normal `n` meet a surface with normal `n_met` at the offset `d` from it.
    #[doc(alias = "PDF_Sp")]
    pub fn probe_pdf(&self, n: Normal3, d: Vector3, n_met: Normal3) -> SampledSpectrum {
        let frame = Frame::from_z(n);
        let (d, n_met) = (frame.to_local(d), frame.to_local(n_met));
        let distances = [lanes::hypot(d.y, d.z), lanes::hypot(d.z, d.x), lanes::hypot(d.x, d.y)];
        let cosines = [n_met.x, n_met.y, n_met.z];
        (0..3).map(|i| self.at_radius(distances[i]).1 * (AXES[i] * cosines[i].abs())).sum()
    }
}
