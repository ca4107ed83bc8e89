//! Kernels: the weight of a photon at a distance.
//!
//! On the disk of radius 1, at the distance d from its centre,
//!
//! ```text
//! cone          K(d) = 3/π · (1 − d)
//! Epanechnikov  K(d) = 2/π · (1 − d²)
//! ```
//!
//! both with the integral 1; K(d/r)/r² has it on the disk of radius r. In a ball the factors are
//! 3/π and 15/8π, and K(d/r)/r³ has the integral 1. Epanechnikov's kernel minimizes the mean
//! squared error of a density; the cone is sharper. [Silverman 1986 §3.3], [Jensen 2001a §7.2]

use description::PhotonKernel;

/// The kernel on the disk or in the ball of radius 1, at a distance whose square is given; zero
/// outside.
#[inline]
pub fn evaluate(kernel: PhotonKernel, space: Space, distance_squared: f32) -> f32 {
    use std::f32::consts::FRAC_1_PI;
    let shape = match kernel {
        PhotonKernel::Cone => (1.0 - distance_squared.sqrt()).max(0.0),
        PhotonKernel::Epanechnikov => (1.0 - distance_squared).max(0.0),
    };
    let peak = match (kernel, space) {
        (PhotonKernel::Cone, Space::Disk | Space::Ball) => 3.0,
        (PhotonKernel::Epanechnikov, Space::Disk) => 2.0,
        (PhotonKernel::Epanechnikov, Space::Ball) => 15.0 / 8.0,
    };
    peak * FRAC_1_PI * shape
}

/// What photons are spread over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Space {
    /// A surface, which is a disk nearby.
    Disk,
    /// A medium.
    Ball,
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;
    use testkit::integrate;

    #[test]
    fn integrals_are_one() {
        for kernel in [PhotonKernel::Cone, PhotonKernel::Epanechnikov] {
            for space in [Space::Disk, Space::Ball] {
                let shell = |r: f64, _: f64| {
                    let size = if space == Space::Disk { 2.0 * PI * r } else { 4.0 * PI * r * r };
                    size * f64::from(evaluate(kernel, space, (r * r) as f32))
                };
                let integral = integrate(&shell, [[0.0, 1.0], [0.0, 1.0]], 1e-7);
                assert!((integral - 1.0).abs() < 1e-5, "{kernel:?} {space:?}: {integral}");
                assert_eq!(evaluate(kernel, space, 1.0), 0.0);
                assert_eq!(evaluate(kernel, space, 2.0), 0.0);
            }
        }
    }
}
