//! Kernels: the weight of a photon at a distance.
//!
//! On the disk of radius 1, at the distance d from its centre,
//!
//! ```text
//! cone          K(d) = 3/π · (1 − d)
//! Epanechnikov  K(d) = 2/π · (1 − d²)
//! ```
//!
//! both with the integral 1; K(d/r)/r² has it on the disk of radius r. Epanechnikov's kernel
//! minimizes the mean squared error of a density; the cone is sharper. [Silverman 1986 §3.3],
//! [Jensen 2001a §7.2]

use description::PhotonKernel;

/// The kernel on the disk of radius 1 at a distance whose square is given; zero outside.
#[inline]
pub fn evaluate(kernel: PhotonKernel, distance_squared: f32) -> f32 {
    use std::f32::consts::FRAC_1_PI;
    match kernel {
        PhotonKernel::Cone => 3.0 * FRAC_1_PI * (1.0 - distance_squared.sqrt()).max(0.0),
        PhotonKernel::Epanechnikov => 2.0 * FRAC_1_PI * (1.0 - distance_squared).max(0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::integrate;

    #[test]
    fn the_integral_over_the_disk_is_one() {
        for kernel in [PhotonKernel::Cone, PhotonKernel::Epanechnikov] {
            let ring =
                |r: f64, _: f64| 2.0 * std::f64::consts::PI * r * f64::from(evaluate(kernel, (r * r) as f32));
            let integral = integrate(&ring, [[0.0, 1.0], [0.0, 1.0]], 1e-7);
            assert!((integral - 1.0).abs() < 1e-5, "{kernel:?}: {integral}");
            assert_eq!(evaluate(kernel, 1.0), 0.0);
            assert_eq!(evaluate(kernel, 2.0), 0.0);
        }
    }
}
