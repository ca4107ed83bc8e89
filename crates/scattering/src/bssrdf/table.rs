//! A table of diffusion profiles over albedo and radius.

use super::boundary::Boundary;
use super::diffusion::HalfSpace;
use super::spline::{self, Nodes, Weights};
use super::{SubsurfaceMethod, walks};
use crate::TrowbridgeReitz;
use crate::grid::Place;
use lanes::Each;
use math::{Vector3, lerp};
use spectrum::{N, SampledSpectrum};
use std::f32::consts::TAU;
use std::fmt;
use std::sync::OnceLock;

/// Albedos, more closely spaced towards 1, where the profile changes fast.
const ALBEDOS: usize = 100;
/// Radii in a geometric progression, after 0.
const RADII: usize = 64;
const FIRST_RADIUS: f64 = 2.5e-3;
const RATIO: f64 = 1.2;

/// The radial profiles of all media of one asymmetry and index of refraction, in mean free paths.
#[derive(Clone)]
#[doc(alias = "BSSRDFTable")]
pub struct BssrdfTable {
    g: f32,
    eta: f32,
    exit_norm: f32,
    albedos: Nodes,
    radii: Nodes,
    /// 2πr times the profile, which is its density over r.
    profile: Surface,
    /// The running integrals over r.
    cdf: Surface,
    /// The integrals.
    effective_albedos: Nodes,
    /// Rough boundaries, once they are asked for.
    boundary: OnceLock<Boundary>,
    /// What random walks return for each roughness and albedo, once it is asked for.
    of_walks: OnceLock<Vec<Nodes>>,
}

/// Values for all albedos and radii. As of [`Nodes`] the first and the last are there twice.
#[derive(Clone)]
struct Surface {
    /// A row for each radius.
    values: Vec<f32>,
}

impl Surface {
    /// The values of a row.
    const ROW: usize = ALBEDOS + 2;

    /// From a row for each albedo.
    fn new(rows: &[Vec<f32>]) -> Self {
        let rows: Vec<Nodes> = rows.iter().map(|row| Nodes::new(row)).collect();
        let radius = |i: usize| Nodes::new(&rows.iter().map(|row| row.twice()[i]).collect::<Vec<f32>>());
        Self { values: (0..RADII + 2).flat_map(|i| radius(i).twice().to_vec()).collect() }
    }

    /// The values of four albedos at a radius, which are those of the nodes around it.
    #[inline]
    fn at(&self, albedo: usize, radius: usize) -> [f32; 4] {
        spline::four(&self.values, radius * Self::ROW + albedo)
    }

    /// A row for each albedo.
    fn rows(&self) -> impl Iterator<Item = f32> {
        let row =
            move |albedo: usize| (1..=RADII).map(move |radius| self.values[radius * Self::ROW + albedo]);
        (1..=ALBEDOS).flat_map(row)
    }
}

/// The profile of one albedo.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Profile {
    /// Albedos between which there is none have no weights.
    at: Weights,
    total: f32,
}

/// The numbers of a table, for engines that look them up elsewhere. Profiles are cubic splines
/// over both albedo and radius.
#[derive(Clone, Debug)]
pub struct PlainBssrdfTable<'a> {
    /// One over the share of uniform light from outside that the surface lets in.
    pub exit_norm: f32,
    /// Ascending albedos.
    pub albedos: &'a [f32],
    /// Ascending radii, in mean free paths.
    pub radii: &'a [f32],
    /// 2πr times the profile; a row for each albedo.
    pub profile: Vec<f32>,
    /// The running integrals of the rows.
    pub cdf: Vec<f32>,
    /// The integrals of the rows.
    pub effective_albedos: &'a [f32],
}

impl BssrdfTable {
    /// Its numbers.
    pub fn plain(&self) -> PlainBssrdfTable<'_> {
        PlainBssrdfTable {
            exit_norm: self.exit_norm,
            albedos: self.albedos.all(),
            radii: self.radii.all(),
            profile: self.profile.rows().collect(),
            cdf: self.cdf.rows().collect(),
            effective_albedos: self.effective_albedos.all(),
        }
    }

    /// What random walks return, for evenly spaced roughnesses √α of the boundary from 0 to 1; each
    /// row for all albedos.
    pub fn of_walks(&self) -> Vec<&[f32]> {
        self.walks().iter().map(Nodes::all).collect()
    }

    fn walks(&self) -> &[Nodes] {
        self.of_walks.get_or_init(|| {
            let rows = walks::effective_albedos(self.g, self.boundary(), self.albedos.all());
            rows.iter().map(|row| Nodes::new(row)).collect()
        })
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
        let progression = (0..RADII - 1).map(|i| (FIRST_RADIUS * RATIO.powi(i as i32)) as f32);
        let radii: Vec<f32> = std::iter::once(0.0).chain(progression).collect();
        let (albedos, radii) = (Nodes::new(&albedos), Nodes::new(&radii));
        let [mut profile, mut cdf] = [const { Vec::new() }; 2];
        let mut effective_albedos = Vec::with_capacity(ALBEDOS);
        for &albedo in albedos.all() {
            let density = |&r: &f32| TAU * r * medium.profile(f64::from(albedo), f64::from(r)) as f32;
            let mut row: Vec<f32> = radii.all().iter().map(density).collect();
            let mut sums = spline::integrate(&radii, &Nodes::new(&row));
            // Diffusion overestimates media that hardly absorb: no more light leaves than entered.
            let excess = sums[RADII - 1].max(1.0);
            row.iter_mut().chain(&mut sums).for_each(|value| *value /= excess);
            effective_albedos.push(sums[RADII - 1]);
            profile.push(row);
            cdf.push(sums);
        }
        Self {
            g,
            eta,
            exit_norm: 1.0 / medium.transmitted_from_outside() as f32,
            profile: Surface::new(&profile),
            cdf: Surface::new(&cdf),
            effective_albedos: Nodes::new(&effective_albedos),
            boundary: OnceLock::new(),
            of_walks: OnceLock::new(),
            albedos,
            radii,
        }
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
        let at = Weights::at(&self.albedos, albedo).unwrap_or_default();
        at.sum(self.effective_albedos.around(at.first)).max(0.0)
    }

    /// The albedo of a medium that returns a share of the light that entered, or the nearest to it
    /// that there is: by the profile, or by random walks, of light from a uniform sky that the
    /// `facets` of the boundary let in.
    pub fn albedo(&self, method: SubsurfaceMethod, facets: &TrowbridgeReitz, effective_albedo: f32) -> f32 {
        let invert = |values: &Nodes| spline::invert(&self.albedos, values, effective_albedo);
        match method {
            SubsurfaceMethod::Diffusion => invert(&self.effective_albedos),
            SubsurfaceMethod::RandomWalk => {
                let rows = self.walks();
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

    /// The profiles of media with albedos in [0, 1].
    pub(super) fn profiles(&self, albedos: SampledSpectrum) -> [Profile; N] {
        let first = albedos.0.each(|albedo| self.albedos.interval(albedo));
        let weights = spline::weights(self.albedos.around_each(first), albedos);
        let mut profiles = [Profile::default(); N];
        for i in 0..N {
            if self.albedos.has_between(albedos[i]) {
                let at = Weights { first: first[i], weights: weights.each(|weights| weights[i]) };
                profiles[i] = Profile { at, total: at.sum(self.effective_albedos.around(at.first)) };
            }
        }
        profiles
    }

    /// The profile of each wavelength at a radius, per area, and its density, which has the
    /// integral 1 over the plane.
    pub(super) fn at_radii(
        &self,
        profiles: &[Profile; N],
        r: SampledSpectrum,
    ) -> (SampledSpectrum, SampledSpectrum) {
        let first = r.0.each(|r| self.interval(r));
        let weights = spline::weights(self.radii.around_each(first), r);
        let [mut value, mut total] = [SampledSpectrum::ZERO; 2];
        for i in 0..N {
            let Profile { at: albedo, total: of } = &profiles[i];
            // The sums over radii, of four albedos at once.
            let mut sums = [0.0; 4];
            for (node, weight) in weights.iter().enumerate() {
                let values = self.profile.at(albedo.first, first[i] + node);
                for k in 0..4 {
                    sums[k] += weight[i] * values[k];
                }
            }
            (value[i], total[i]) = (albedo.sum(sums), *of);
        }
        let around = r.map(|r| TAU * if r > 0.0 { r } else { 1.0 });
        let value = (value / around).clamp_zero();
        let density = value / total;
        let mut found = (SampledSpectrum::ZERO, SampledSpectrum::ZERO);
        for i in 0..N {
            if self.radii.has_between(r[i]) {
                found.0[i] = value[i];
                found.1[i] = if total[i] > 0.0 { density[i] } else { 0.0 };
            }
        }
        found
    }

    /// The interval of a radius. The bits of a float grow with its logarithm, but for a third of an
    /// interval.
    #[inline]
    fn interval(&self, r: f32) -> usize {
        const FIRST: i32 = (FIRST_RADIUS as f32).to_bits() as i32;
        /// Intervals for a bit of the mantissa: 1 over the logarithm of the ratio, to base 2.
        const STEPS: f32 = (3.801_784_016_923_93 / (1 << 23) as f64) as f32;
        let steps = (r.to_bits() as i32).saturating_sub(FIRST) as f32 * STEPS;
        // The interval before the one that is found by it.
        let before = (steps.max(0.0) as usize).min(RADII - 4);
        let radii = &self.radii.all()[before..];
        before + usize::from(radii[1] <= r) + usize::from(radii[2] <= r)
    }

    /// A radius with the density of a profile; `None` if it is zero.
    pub(super) fn sample_radius(&self, profile: &Profile, u: f32) -> Option<f32> {
        let at = &profile.at;
        let values = |i: usize| [0, 1, 2, 3].each(|node| at.sum(self.profile.at(at.first, i + node)));
        let cdf = |i: usize| at.sum(self.cdf.at(at.first, i + 1));
        spline::sample(&self.radii, values, cdf, u)
    }
}

impl fmt::Debug for BssrdfTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("BssrdfTable").field("eta", &self.eta).finish_non_exhaustive()
    }
}
