//! The distribution of microfacet normals: its integrals, and the density of its samples.

use alhazen_scattering::TrowbridgeReitz;
use math::{Vector3, spherical_direction};
use std::f64::consts::{FRAC_PI_2, TAU};
use testkit::{Chi2, integrate};

const ROUGHNESSES: [(f32, f32); 7] =
    [(0.02, 0.02), (0.05, 0.05), (0.2, 0.2), (0.5, 0.5), (1.0, 1.0), (0.1, 0.4), (0.8, 0.15)];

fn views() -> [Vector3; 5] {
    [(0f32, 0f32), (0.5, 1.0), (1.2, -2.0), (1.5, 0.3), (2.5, 4.0)]
        .map(|(theta, phi)| spherical_direction(theta.sin(), theta.cos(), phi))
}

/// ∫ f over the upper hemisphere.
fn over_normals(f: impl Fn(Vector3) -> f32) -> f64 {
    let integrand = |theta: f64, phi: f64| {
        let (sin, cos) = (theta.sin() as f32, theta.cos() as f32);
        f(spherical_direction(sin, cos, phi as f32)) as f64 * theta.sin()
    };
    integrate(&integrand, [[0.0, FRAC_PI_2], [0.0, TAU]], 1e-5)
}

#[test]
fn projected_microfacet_area_is_that_of_the_surface() {
    for (x, y) in ROUGHNESSES {
        let distribution = TrowbridgeReitz::new(x, y);
        let area = over_normals(|wm| distribution.d(wm) * wm.z);
        assert!((area - 1.0).abs() < 2e-3, "{x} {y}: {area}");
    }
}

#[test]
fn visible_microfacet_area_is_the_projected_area() {
    for (x, y) in ROUGHNESSES {
        let distribution = TrowbridgeReitz::new(x, y);
        for w in views().into_iter().filter(|w| w.z > 0.0) {
            let seen = over_normals(|wm| distribution.g1(w) * w.dot(wm).max(0.0) * distribution.d(wm));
            assert!((seen - w.z as f64).abs() < 3e-3, "{x} {y} from {w}: {seen}");
        }
    }
}

#[test]
fn visible_normals_have_their_density() {
    let test = Chi2 { samples: 100_000, tests: ROUGHNESSES.len() * views().len(), ..Chi2::default() };
    for (x, y) in ROUGHNESSES {
        let distribution = TrowbridgeReitz::new(x, y);
        for w in views() {
            let side = w.z.signum();
            let pdf = |wm: [f32; 3]| {
                let wm = Vector3::from(wm);
                let front = wm.z > 0.0 && side * w.dot(wm) > 0.0;
                if front { distribution.pdf(w, wm) as f64 } else { 0.0 }
            };
            test.sphere(|u| Some(distribution.sample_wm(w, u.into()).to_array()), pdf)
                .unwrap_or_else(|table| panic!("{x} {y} from {w}: {table}"));
        }
    }
}

#[test]
fn joint_masking_is_at_least_the_product() {
    let distribution = TrowbridgeReitz::new(0.4, 0.7);
    for wo in views() {
        for wi in views() {
            let (g, product) = (distribution.g(wo, wi), distribution.g1(wo) * distribution.g1(wi));
            assert!(g >= product - 1e-6 && g <= distribution.g1(wo).min(distribution.g1(wi)) + 1e-6);
        }
    }
}

#[test]
fn parameters() {
    assert_eq!(TrowbridgeReitz::roughness_to_alpha(0.25), 0.5);
    assert!(TrowbridgeReitz::new(0.0, 0.0).effectively_smooth());
    assert!(TrowbridgeReitz::new(0.0009, 0.0009).effectively_smooth());
    assert!(!TrowbridgeReitz::new(0.0, 0.001).effectively_smooth());
    assert_eq!(
        TrowbridgeReitz::new(0.0, 0.5),
        TrowbridgeReitz::new(1e-4, 0.5),
        "no roughness of zero beside a real one"
    );
    for (alpha, expected) in [(0.0, 0.1), (0.04, 0.1), (0.1, 0.2), (0.2, 0.3), (0.5, 0.5)] {
        let mut distribution = TrowbridgeReitz::new(alpha, alpha);
        distribution.regularize(true);
        assert_eq!(distribution, TrowbridgeReitz::new(expected, expected));
    }
}
