//! A table of diffusion profiles over albedo and radius.

use super::boundary::Boundary;
use super::diffusion::HalfSpace;
use super::spline::{self, Weights};
use super::{SubsurfaceMethod, walks};
use crate::TrowbridgeReitz;
use crate::grid::Place;
use math::{Vector3, lerp};
use std::f32::consts::TAU;
use std::fmt;
use std::sync::OnceLock;

/// Albedos, more closely spaced towards 1, where the profile changes fast.
const ALBEDOS: usize = 100;
/// Radii in a geometric progression, after 0.
const RADII: usize = 64;

/// The radial profiles of all media of one asymmetry and index of refraction, in mean free paths.
#[derive(Clone)]
#[doc(alias = "BSSRDFTable")]
pub struct BssrdfTable {
    g: f32,
    eta: f32,
    exit_norm: f32,
    albedos: Vec<f32>,
    radii: Vec<f32>,
    /// 2πr times the profile, which is its density over r; a row for each albedo.
    profile: Vec<f32>,
    /// The running integrals of the rows.
    cdf: Vec<f32>,
    /// The integrals of the rows.
    effective_albedos: Vec<f32>,
    /// Rough boundaries, once they are asked for.
    boundary: OnceLock<Boundary>,
    /// What random walks return for each roughness and albedo, once it is asked for.
    of_walks: OnceLock<Vec<Vec<f32>>>,
}

/// The numbers of a table, for engines that look them up elsewhere. Profiles are cubic splines
/// over both albedo and radius.
#[derive(Clone, Copy, Debug)]
pub struct PlainBssrdfTable<'a> {
    /// One over the share of uniform light from outside that the surface lets in.
    pub exit_norm: f32,
    /// Ascending albedos.
    pub albedos: &'a [f32],
    /// Ascending radii, in mean free paths.
    pub radii: &'a [f32],
    /// 2πr times the profile; a row for each albedo.
    pub profile: &'a [f32],
    /// The running integrals of the rows.
    pub cdf: &'a [f32],
    /// The integrals of the rows.
    pub effective_albedos: &'a [f32],
}

impl BssrdfTable {
    /// Its numbers.
    pub fn plain(&self) -> PlainBssrdfTable<'_> {
        let Self { exit_norm, albedos, radii, profile, cdf, effective_albedos, .. } = self;
        PlainBssrdfTable { exit_norm: *exit_norm, albedos, radii, profile, cdf, effective_albedos }
    }

    /// What random walks return, for evenly spaced roughnesses √α of the boundary from 0 to 1; each
    /// row for all albedos.
    pub fn of_walks(&self) -> &[Vec<f32>] {
        self.of_walks.get_or_init(|| walks::effective_albedos(self.g, self.boundary(), &self.albedos))
    }

    /// The gains of isotropic rough boundaries for random walks: rows for evenly spaced roughnesses
    /// √α from 0 to 1, each of 19 values for the cosines whose square roots are evenly spaced.
    pub fn gains(&self) -> &[f32] {
        self.boundary().gains()
    }

    /// For the asymmetry `g`, in (−1, 1), and the relative index of refraction `eta`, > 0.
    pub fn new(g: f32, eta: f32) -> Self {
        let medium = HalfSpace::new(f64::from(g), f64::from(eta));
        let spacing = |i: usize| 1.0 - libm::exp(-8.0 * i as f64 / (ALBEDOS - 1) as f64);
        let albedos: Vec<f32> = (0..ALBEDOS).map(|i| (spacing(i) / spacing(ALBEDOS - 1)) as f32).collect();
        let progression = (0..RADII - 1).map(|i| (2.5e-3 * 1.2f64.powi(i as i32)) as f32);
        let radii: Vec<f32> = std::iter::once(0.0).chain(progression).collect();
        let mut table = Self {
            g,
            eta,
            exit_norm: 1.0 / medium.transmitted_from_outside() as f32,
            profile: Vec::with_capacity(ALBEDOS * RADII),
            cdf: Vec::with_capacity(ALBEDOS * RADII),
            effective_albedos: Vec::with_capacity(ALBEDOS),
            boundary: OnceLock::new(),
            of_walks: OnceLock::new(),
            albedos,
            radii,
        };
        for &albedo in &table.albedos {
            let density = |&r: &f32| TAU * r * medium.profile(f64::from(albedo), f64::from(r)) as f32;
            let mut row: Vec<f32> = table.radii.iter().map(density).collect();
            let mut cdf = spline::integrate(&table.radii, &row);
            // Diffusion overestimates media that hardly absorb: no more light leaves than entered.
            let excess = cdf[RADII - 1].max(1.0);
            row.iter_mut().chain(&mut cdf).for_each(|value| *value /= excess);
            table.effective_albedos.push(cdf[RADII - 1]);
            table.profile.extend(row);
            table.cdf.extend(cdf);
        }
        table
    }

    /// The asymmetry.
    pub fn g(&self) -> f32 {
        self.g
    }

    /// The relative index of refraction, below over above.
    pub fn eta(&self) -> f32 {
        self.eta
    }

    /// One over the share of uniform light from outside that the surface lets in.
    pub(crate) fn exit_norm(&self) -> f32 {
        self.exit_norm
    }

    /// The share of the light that entered which leaves again, for an albedo in [0, 1], by the
    /// profile.
    pub fn effective_albedo(&self, albedo: f32) -> f32 {
        Weights::at(&self.albedos, albedo).map_or(0.0, |at| at.sum(|i| self.effective_albedos[i])).max(0.0)
    }

    /// The albedo of a medium that returns a share of the light that entered, or the nearest to it
    /// that there is: by the profile, or by random walks, of light from a uniform sky that the
    /// `facets` of the boundary let in.
    pub fn albedo(&self, method: SubsurfaceMethod, facets: &TrowbridgeReitz, effective_albedo: f32) -> f32 {
        let invert = |values: &[f32]| spline::invert(&self.albedos, values, effective_albedo);
        match method {
            SubsurfaceMethod::Diffusion => invert(&self.effective_albedos),
            SubsurfaceMethod::RandomWalk => {
                let rows = self.of_walks();
                let place = Place::new(facets.mean_alpha().sqrt(), rows.len());
                let first = place.index as usize;
                lerp(place.t, invert(&rows[first]), invert(&rows[first + 1]))
            }
        }
    }

    fn boundary(&self) -> &Boundary {
        self.boundary.get_or_init(|| Boundary::new(self.eta))
    }

    /// By how much more counts what `facets` refract between a direction above and the inside, so
    /// that all light enters which they do not reflect.
    pub(super) fn gain(&self, facets: &TrowbridgeReitz, w: Vector3) -> f32 {
        self.boundary().gain(facets, w)
    }

    /// The profile at a radius, per area, of a medium with an albedo in [0, 1], and its density,
    /// which has the integral 1 over the plane.
    pub(super) fn profile(&self, albedo: f32, r: f32) -> (f32, f32) {
        let at = (Weights::at(&self.albedos, albedo), Weights::at(&self.radii, r));
        let (Some(at_albedo), Some(at_radius)) = at else { return (0.0, 0.0) };
        let profile = at_albedo.sum(|row| at_radius.sum(|i| self.profile[row * RADII + i]));
        let profile = (profile / (TAU * if r > 0.0 { r } else { 1.0 })).max(0.0);
        let total = at_albedo.sum(|i| self.effective_albedos[i]);
        (profile, if total > 0.0 { profile / total } else { 0.0 })
    }

    /// A radius with the density of the profile; `None` if the profile is zero.
    pub(super) fn sample_radius(&self, albedo: f32, u: f32) -> Option<f32> {
        let at = Weights::at(&self.albedos, albedo)?;
        let column = |table: &[f32], i: usize| at.sum(|row| table[row * RADII + i]);
        spline::sample(&self.radii, |i| column(&self.profile, i), |i| column(&self.cdf, i), u)
    }
}

impl fmt::Debug for BssrdfTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("BssrdfTable").field("eta", &self.eta).finish_non_exhaustive()
    }
}
