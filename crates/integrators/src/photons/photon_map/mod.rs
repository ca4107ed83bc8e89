//! The photon map, and the density of photons around a point.
//!
//! The photons of n subpaths estimate the flux that arrives at a surface: its density at a point is
//!
//! ```text
//! 1/n Σ K(dᵢ/r)/r² · βᵢ
//! ```
//!
//! (in a medium, of the volume: K(dᵢ/r)/r³) over the photons i at the distances dᵢ < r, K being a
//! [`PhotonKernel`]. The radius r is the distance of the photon after the `nearest` nearest ones,
//! so that the blur is small where photons are dense; it is at most `radius`.
//!
//! The estimate is biased: it is exact for a linear density on a plane, and elsewhere the bias is
//! proportional to r². At edges the disk extends beyond the surface, which darkens corners within
//! r. The photon that determines the radius does not count: for independent photons of uniform
//! density, (k − 1)/πr² with the k-th photon's distance is unbiased, while k/πr² is too large by
//! 1/(k − 1); the largest radius does not change this.
//!
//! Sources: [Jensen 2001a ch. 6, 7]; [Silverman 1986 §5.2].

mod kd_tree;
mod kernel;

use description::PhotonKernel;
use math::Point3;
use rayon::prelude::*;
use spectrum::SampledSpectrum;

use crate::photons::photon::Photon;
use crate::{Cancelled, Control};
use kd_tree::{KdTree, Neighbour};
pub(crate) use kernel::Space;

/// Photons of one kind.
#[derive(Debug, Default)]
pub(crate) struct PhotonMap {
    tree: KdTree,
    /// In the order of the tree's points.
    photons: Vec<Photon>,
    /// The number of light subpaths.
    paths: u32,
}

/// The parameters of an estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Neighbourhood {
    /// Maximum number of photons.
    pub nearest: usize,
    /// Maximum distance.
    pub radius: f32,
    /// Their weights by distance.
    pub kernel: PhotonKernel,
}

impl PhotonMap {
    /// Builds the map of the photons of `paths` subpaths; photons that are not finite are left out.
    pub fn build(photons: Vec<Photon>, paths: u32, control: &Control) -> Result<Self, Cancelled> {
        let places = photons.iter().map(|photon| if photon.is_finite() { photon.p } else { Point3::NAN });
        let (tree, order) = KdTree::build(places, control)?;
        let photons = order.into_par_iter().map(|i| photons[i as usize]).collect();
        Ok(Self { tree, photons, paths })
    }

    /// The number of photons.
    pub fn len(&self) -> usize {
        self.photons.len()
    }

    /// Memory taken, in bytes.
    pub fn memory(&self) -> usize {
        self.tree.memory() + size_of_val(&*self.photons)
    }

    /// The density per area or volume at `p` of the values `weigh` of the photons for which
    /// `accept` is true, and the radius of the estimate; `None` if there are none, or all of them
    /// are at one point.
    pub fn density(
        &self,
        p: Point3,
        neighbourhood: &Neighbourhood,
        space: Space,
        accept: impl Fn(&Photon) -> bool,
        weigh: impl Fn(&Photon) -> SampledSpectrum,
    ) -> Option<(SampledSpectrum, f32)> {
        let &Neighbourhood { nearest, radius, kernel } = neighbourhood;
        let found = self.tree.nearest(p, nearest + 1, radius, |i| accept(&self.photons[i as usize]));
        let farthest = found.iter().fold(0.0, |farthest: f32, found| farthest.max(found.distance_squared));
        let radius_squared = if found.len() > nearest { farthest } else { radius * radius };
        if found.is_empty() || radius_squared == 0.0 {
            return None;
        }
        let sum: SampledSpectrum = found
            .iter()
            .map(|&Neighbour { distance_squared, index }| {
                weigh(&self.photons[index as usize])
                    * kernel::evaluate(kernel, space, distance_squared / radius_squared)
            })
            .sum();
        let radius = radius_squared.sqrt();
        let size = if space == Space::Disk { radius_squared } else { radius_squared * radius };
        Some((sum / (size * self.paths as f32), radius))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use math::Vec3;
    use testkit::{Moments, Random, t_test};

    /// `count` photons of power 1 on the square [-1, 1]² from two paths, of which those with
    /// `stays` are kept.
    fn photons(count: usize, seed: u64, stays: impl Fn(Point3, f32) -> bool) -> PhotonMap {
        let mut random = Random::new(seed);
        let photons = (0..count).filter_map(|_| {
            let p = Point3::new(2.0 * random.get_1d() - 1.0, 2.0 * random.get_1d() - 1.0, 0.0);
            let photon =
                Photon { p, n: Vec3::Z, wi: Vec3::Z, beta: SampledSpectrum::ONE, depth: 2, hero_only: false };
            stays(p, random.get_1d()).then_some(photon)
        });
        PhotonMap::build(photons.collect(), 2, &Control::default()).expect("nobody cancels it")
    }

    fn square(count: usize, seed: u64) -> PhotonMap {
        photons(count, seed, |_, _| true)
    }

    fn density(map: &PhotonMap, neighbourhood: &Neighbourhood) -> f64 {
        map.density(Point3::ZERO, neighbourhood, Space::Disk, |_| true, |photon| photon.beta)
            .map_or(0.0, |(density, _)| density[0].into())
    }

    #[test]
    fn estimates_of_a_uniform_density_are_unbiased() {
        for kernel in [PhotonKernel::Cone, PhotonKernel::Epanechnikov] {
            // Limited by the nearest k, by the radius, and by either.
            for (nearest, radius) in [(3, 0.9), (5, 0.9), (1000, 0.5), (12, 0.35)] {
                let neighbourhood = Neighbourhood { nearest, radius, kernel };
                let found: Moments =
                    (0..6000).map(|seed| density(&square(120, seed), &neighbourhood)).collect();
                t_test(&found, 120.0 / 4.0 / 2.0, 8)
                    .unwrap_or_else(|difference| panic!("{neighbourhood:?}: {difference}"));
            }
        }
    }

    #[test]
    fn the_bias_of_a_quadratic_density_is_proportional_to_the_squared_radius() {
        // Of (1 + x²)/2 the kernel finds (1 + r² E[x²])/2 at x = 0, E[x²] being its second moment.
        for (kernel, moment) in [(PhotonKernel::Cone, 0.15), (PhotonKernel::Epanechnikov, 1.0 / 6.0)] {
            for radius in [0.9f32, 0.45] {
                let neighbourhood = Neighbourhood { nearest: 1000, radius, kernel };
                let bent = |seed| photons(100, seed, |p, u| 2.0 * u < 1.0 + p.x * p.x);
                let found: Moments = (0..20_000).map(|seed| density(&bent(seed), &neighbourhood)).collect();
                let expected = 100.0 / 4.0 / 2.0 * 0.5 * (1.0 + f64::from(radius).powi(2) * moment);
                t_test(&found, expected, 4)
                    .unwrap_or_else(|difference| panic!("{neighbourhood:?}: {difference}"));
            }
        }
    }

    #[test]
    fn no_photons_or_coincident_photons_give_no_estimate() {
        let neighbourhood = Neighbourhood { nearest: 5, radius: 0.1, kernel: PhotonKernel::Epanechnikov };
        assert_eq!(density(&PhotonMap::default(), &neighbourhood), 0.0);
        let mut photon = square(1, 1).photons[0];
        photon.p = Point3::ZERO;
        let map = PhotonMap::build(vec![photon; 9], 1, &Control::default()).expect("nobody cancels it");
        assert_eq!(density(&map, &neighbourhood), 0.0);
    }

    #[test]
    fn photons_that_are_not_finite_are_left_out() {
        let mut photons = square(40, 2).photons;
        photons[3].p.y = f32::NAN;
        photons[8].beta[2] = f32::INFINITY;
        let map = PhotonMap::build(photons, 2, &Control::default()).expect("nobody cancels it");
        assert_eq!(map.len(), 38);
        assert!(map.memory() >= 38 * 68);
    }
}
