//! The contract of all BxDFs.

use alhazen_scattering::{
    Bsdf, BsdfSample, BxdfFlags, Conductor, Dielectric, Diffuse, DiffuseTransmission, Directions, Scatter,
    ThinDielectric, TransportMode, TrowbridgeReitz,
};
use math::{
    Frame, ONE_MINUS_EPSILON, Vec2, Vec3, Vector3, same_hemisphere, spherical_direction, spherical_phi,
    spherical_theta,
};
use proptest::prelude::*;
use spectrum::SampledSpectrum;
use std::f32::consts::{FRAC_PI_2, PI, TAU};
use testkit::{Chi2, Moments, Random, integrate};

type Bxdf = alhazen_scattering::Bxdf<'static>;

const MODES: [TransportMode; 2] = [TransportMode::Radiance, TransportMode::Importance];
const DIRECTIONS: [Directions; 3] = [Directions::All, Directions::Reflection, Directions::Transmission];

fn diffuse() -> Bxdf {
    Diffuse { reflectance: SampledSpectrum::new([0.2, 0.5, 0.9, 1.0]) }.into()
}

fn diffuse_transmission(reflectance: f32, transmittance: f32) -> Bxdf {
    let spectrum = |peak: f32| SampledSpectrum::new([0.1, 0.5, 0.8, 1.0]) * peak;
    DiffuseTransmission { reflectance: spectrum(reflectance), transmittance: spectrum(transmittance) }.into()
}

/// Approximately gold.
fn conductor(alpha_x: f32, alpha_y: f32) -> Bxdf {
    let eta = SampledSpectrum::new([1.5, 0.8, 0.3, 0.2]);
    let k = SampledSpectrum::new([1.9, 2.2, 3.0, 4.0]);
    Conductor { distribution: TrowbridgeReitz::new(alpha_x, alpha_y), eta, k }.into()
}

/// A lossless metal, with a purely imaginary index of refraction.
fn lossless_conductor(alpha: f32) -> Bxdf {
    let (eta, k) = (SampledSpectrum::ZERO, SampledSpectrum::splat(2.0));
    Conductor { distribution: TrowbridgeReitz::new(alpha, alpha), eta, k }.into()
}

fn dielectric(eta: f32, alpha_x: f32, alpha_y: f32) -> Bxdf {
    Dielectric { eta, distribution: TrowbridgeReitz::new(alpha_x, alpha_y) }.into()
}

fn thin_dielectric(eta: f32) -> Bxdf {
    ThinDielectric { eta }.into()
}

/// Every BxDF: smooth and rough, isotropic and anisotropic, from outside and from inside.
pub fn members() -> Vec<Bxdf> {
    let mut members = exact_members();
    members.extend(crate::layers::members());
    members
}

/// The BxDFs of known values and densities, which those of layers are only in the mean.
fn exact_members() -> Vec<Bxdf> {
    let mut members = reciprocal_members();
    members.extend(crate::openpbr::tilted_members());
    members
}

/// Those whose values are symmetric.
fn reciprocal_members() -> Vec<Bxdf> {
    let mut members = vec![
        diffuse(),
        Diffuse { reflectance: SampledSpectrum::ZERO }.into(),
        diffuse_transmission(0.6, 0.3),
        diffuse_transmission(0.0, 0.7),
        thin_dielectric(1.5),
        thin_dielectric(1.0 / 1.5),
    ];
    for (x, y) in [(0.0, 0.0), (0.05, 0.05), (0.1, 0.1), (0.4, 0.4), (1.0, 1.0), (0.1, 0.5), (0.9, 0.05)] {
        members.push(conductor(x, y));
        members.push(dielectric(1.5, x, y));
        members.push(dielectric(1.0 / 1.5, x, y));
    }
    members.extend([lossless_conductor(0.0), lossless_conductor(0.3), dielectric(1.0, 0.3, 0.3)]);
    members.extend(crate::layers::exact_members());
    members.extend(crate::subsurface::members());
    members.extend(crate::openpbr::members());
    members
}

/// Those with lobes that are not specular.
fn rough_members() -> impl Iterator<Item = Bxdf> {
    exact_members().into_iter().filter(|bxdf| bxdf.flags().is_non_specular())
}

fn from_degrees(theta: f32, phi: f32) -> Vector3 {
    let theta = theta.to_radians();
    spherical_direction(theta.sin(), theta.cos(), phi.to_radians())
}

/// Along the normal, oblique, grazing; above and below.
fn views() -> [Vector3; 6] {
    [(0.0, 0.0), (35.0, 20.0), (70.0, -110.0), (86.0, 60.0), (150.0, 45.0), (100.0, 200.0)]
        .map(|(t, p)| from_degrees(t, p))
}

fn random_direction(random: &mut Random) -> Vector3 {
    let [u, v] = random.get_2d();
    let z = 1.0 - 2.0 * u;
    spherical_direction((1.0 - z * z).sqrt(), z, TAU * v)
}

fn random_sample(
    bxdf: &Bxdf,
    wo: Vector3,
    random: &mut Random,
    mode: TransportMode,
    directions: Directions,
) -> Option<BsdfSample> {
    bxdf.sample_f(wo, random.get_1d(), random.get_2d().into(), mode, directions).into_option()
}

/// The throughput weight of a sample.
fn weight(sample: &BsdfSample) -> SampledSpectrum {
    sample.f * (sample.wi.z.abs() / sample.pdf)
}

fn close(a: f32, b: f32, relative: f32) -> bool {
    (a - b).abs() <= relative * a.abs().max(b.abs()) + 1e-6
}

fn spectra_close(a: SampledSpectrum, b: SampledSpectrum, relative: f32) -> bool {
    a.0.iter().zip(b.0).all(|(&a, b)| close(a, b, relative))
}

#[test]
fn samples_have_their_density() {
    let others = rough_members().filter(|bxdf| !matches!(bxdf, Bxdf::OpenPbr(_)));
    test_density(others, TransportMode::Radiance);
}

#[test]
fn samples_of_principled_surfaces_have_their_density() {
    let principled = rough_members().filter(|bxdf| matches!(bxdf, Bxdf::OpenPbr(_)));
    test_density(principled, TransportMode::Radiance);
}

/// Those whose samples for importance have another density.
#[test]
fn samples_for_importance_have_their_density() {
    test_density(crate::openpbr::tilted_members(), TransportMode::Importance);
}

/// Samples to one side are tested at every other view: other chances of the same lobes.
fn test_density(members: impl IntoIterator<Item = Bxdf>, mode: TransportMode) {
    let mut cases = Vec::new();
    for bxdf in members {
        let sides = bxdf.flags().contains(BxdfFlags::REFLECTION | BxdfFlags::TRANSMISSION);
        for (wo, i) in views().into_iter().zip(0..) {
            let count = if sides && i % 2 == 0 { DIRECTIONS.len() } else { 1 };
            cases.extend(DIRECTIONS[..count].iter().map(|&directions| (bxdf, wo, directions)));
        }
    }
    let test = Chi2 { bins: [18, 32], samples: 40_000, tests: cases.len(), ..Chi2::default() };
    for (i, (bxdf, wo, directions)) in cases.into_iter().enumerate() {
        let mut random = Random::new(1000 + i as u64);
        let strips = Strips::new(&bxdf, wo);
        let sample = |u: [f32; 2]| {
            let uc = random.get_1d();
            let sample = bxdf.sample_f(wo, uc, u.into(), mode, directions).into_option()?;
            if sample.flags.is_specular() {
                return None;
            }
            Some([strips.coordinate(spherical_theta(sample.wi)), spherical_phi(sample.wi)])
        };
        let pdf = |[x, phi]: [f32; 2]| {
            let (theta, width) = strips.theta(x);
            let wi = spherical_direction(theta.sin(), theta.cos(), phi);
            (bxdf.pdf(wo, wi, mode, directions) * theta.sin() * width) as f64
        };
        if let Err(table) = test.rectangle([[0.0, 3.0], [0.0, TAU]], sample, pdf) {
            panic!("{bxdf:?} seen from {wo} to {directions:?}: {table}");
        }
    }
}

/// The sphere in three strips of θ, each one unit high: rough glass has a discontinuity where its
/// facets are vertical, and every surface one at the horizon; both have to be between cells of the
/// quadrature.
struct Strips([f32; 4]);

impl Strips {
    fn new(bxdf: &Bxdf, wo: Vector3) -> Strips {
        let edge = (-wo.z / met(bxdf, wo)).clamp(-0.8, 0.8).acos();
        Strips([0.0, edge.min(FRAC_PI_2), edge.max(FRAC_PI_2), PI])
    }

    fn coordinate(&self, theta: f32) -> f32 {
        let i = (1..3).filter(|&i| theta >= self.0[i]).count();
        i as f32 + (theta - self.0[i]) / (self.0[i + 1] - self.0[i])
    }

    /// θ and dθ/dx.
    fn theta(&self, x: f32) -> (f32, f32) {
        let i = (x as usize).min(2);
        let width = self.0[i + 1] - self.0[i];
        (self.0[i] + (x - i as f32) * width, width)
    }
}

/// The relative index of refraction for light from `wo`.
fn met(bxdf: &Bxdf, wo: Vector3) -> f32 {
    let eta = match bxdf {
        Bxdf::Dielectric(glass) => glass.eta,
        Bxdf::OpenPbr(surface) => surface.eta(),
        _ => 1.0,
    };
    if wo.z > 0.0 { eta } else { 1.0 / eta }
}

#[test]
fn samples_agree_with_f_and_pdf() {
    let mut random = Random::new(2);
    for bxdf in rough_members() {
        for wo in views() {
            for mode in MODES {
                for directions in DIRECTIONS {
                    for _ in 0..60 {
                        let Some(sample) = random_sample(&bxdf, wo, &mut random, mode, directions) else {
                            continue;
                        };
                        if sample.wi.z.abs() < 1e-3 || sample.flags.is_specular() {
                            continue;
                        }
                        let f = bxdf.f(wo, sample.wi, mode);
                        let pdf = bxdf.pdf(wo, sample.wi, mode, directions);
                        assert!(!sample.pdf_is_proportional);
                        assert!(spectra_close(f, sample.f, 0.01), "{bxdf:?} from {wo}: {f:?}, {sample:?}");
                        assert!(close(pdf, sample.pdf, 0.01), "{bxdf:?} from {wo}: {pdf}, {sample:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn sample_directions_match_their_flags() {
    let mut random = Random::new(3);
    for bxdf in members() {
        let flags = bxdf.flags();
        for wo in views() {
            for directions in DIRECTIONS {
                for _ in 0..40 {
                    let Some(sample) =
                        random_sample(&bxdf, wo, &mut random, TransportMode::Radiance, directions)
                    else {
                        continue;
                    };
                    assert!(sample.f.is_black() || flags.contains(sample.flags), "{bxdf:?}: {sample:?}");
                    assert!(directions.meet(sample.flags), "{bxdf:?}: {sample:?}");
                    assert_eq!(
                        sample.flags.is_reflective(),
                        same_hemisphere(wo, sample.wi),
                        "{bxdf:?}: {sample:?}"
                    );
                    assert_eq!(sample.flags.is_transmissive(), !sample.flags.is_reflective());
                    assert!((sample.wi.length() - 1.0).abs() < 1e-4, "{bxdf:?}: {sample:?}");
                    let met = if sample.flags.is_transmissive() { met(&bxdf, wo) } else { 1.0 };
                    assert_eq!(sample.eta, met, "{bxdf:?}: {sample:?}");
                }
            }
        }
    }
}

#[test]
fn f_and_pdf_of_specular_lobes_are_zero() {
    let only_specular = |bxdf: &Bxdf| bxdf.flags().is_specular() && !bxdf.flags().is_non_specular();
    for bxdf in members().into_iter().filter(only_specular) {
        for wo in views() {
            for wi in [Vec3::new(-wo.x, -wo.y, wo.z), -wo] {
                assert!(bxdf.f(wo, wi, TransportMode::Radiance).is_black());
                assert_eq!(bxdf.pdf(wo, wi, TransportMode::Radiance, Directions::All), 0.0);
            }
        }
    }
}

/// Near total internal reflection f is sensitive to the last digits of an angle; hence the wide
/// tolerance.
#[test]
fn radiance_and_importance_are_reciprocal() {
    let mut random = Random::new(4);
    for bxdf in rough_members() {
        for _ in 0..3000 {
            let (wo, wi) = (random_direction(&mut random), random_direction(&mut random));
            if wo.z.abs().min(wi.z.abs()) < 1e-3 {
                continue;
            }
            let radiance = bxdf.f(wo, wi, TransportMode::Radiance);
            let importance = bxdf.f(wi, wo, TransportMode::Importance);
            assert!(
                spectra_close(radiance, importance, 0.05),
                "{bxdf:?} {wo} {wi}: {radiance:?} {importance:?}"
            );
        }
    }
}

#[test]
fn values_are_symmetric() {
    let mut random = Random::new(5);
    for bxdf in reciprocal_members().into_iter().filter(|bxdf| bxdf.flags().is_non_specular()) {
        for _ in 0..3000 {
            let (wo, wi) = (random_direction(&mut random), random_direction(&mut random));
            if wo.z.abs().min(wi.z.abs()) < 1e-3 {
                continue;
            }
            let radiance = bxdf.f(wo, wi, TransportMode::Radiance);
            let eta = if same_hemisphere(wo, wi) { 1.0 } else { met(&bxdf, wo) };
            let reverse = bxdf.f(wi, wo, TransportMode::Radiance);
            assert!(
                spectra_close(radiance * (eta * eta), reverse, 0.05),
                "{bxdf:?} {wo} {wi}: {radiance:?} {reverse:?}"
            );
        }
    }
}

/// Refraction is reversible with the same transmittance, times η² for the solid angle.
#[test]
fn specular_refraction_is_reversible() {
    for bxdf in [dielectric(1.5, 0.0, 0.0), dielectric(1.0 / 1.5, 0.0, 0.0), thin_dielectric(1.5)] {
        for wo in views() {
            let transmit =
                |wo, mode| bxdf.sample_f(wo, 0.5, Vec2::ZERO, mode, Directions::Transmission).into_option();
            let Some(there) = transmit(wo, TransportMode::Radiance) else { continue };
            let back = transmit(there.wi, TransportMode::Importance).expect("refraction is reversible");
            assert!((back.wi - wo).length() < 1e-3, "{bxdf:?} {wo}");
            let (there_share, back_share) = (weight(&there)[0], weight(&back)[0]);
            assert!(close(there_share * there.eta * there.eta, back_share, 1e-3), "{bxdf:?} {wo}");
        }
    }
}

#[test]
fn no_sample_gains_energy() {
    let mut random = Random::new(5);
    // The samples of bodies and principled surfaces have one albedo only in the mean.
    let is_exact = |bxdf: &Bxdf| !matches!(bxdf, Bxdf::Subsurface(_) | Bxdf::OpenPbr(_));
    for bxdf in members().into_iter().filter(is_exact) {
        for wo in views() {
            for _ in 0..500 {
                if let Some(sample) =
                    random_sample(&bxdf, wo, &mut random, TransportMode::Importance, Directions::All)
                {
                    let weight = weight(&sample).max_component();
                    assert!(weight <= 1.002, "{bxdf:?} from {wo}: {weight} by {sample:?}");
                }
            }
        }
    }
}

#[test]
fn smooth_lossless_surfaces_conserve_energy() {
    let mut random = Random::new(6);
    for bxdf in [
        dielectric(1.5, 0.0, 0.0),
        dielectric(1.0 / 1.5, 0.0, 0.0),
        thin_dielectric(1.5),
        lossless_conductor(0.0),
    ] {
        for wo in views() {
            for _ in 0..50 {
                let sample =
                    random_sample(&bxdf, wo, &mut random, TransportMode::Importance, Directions::All);
                let sample = sample.expect("each sample finds a lobe");
                assert!((weight(&sample).average() - 1.0).abs() < 1e-5, "{bxdf:?}: {sample:?}");
            }
        }
    }
}

#[test]
fn slightly_rough_lossless_surfaces_lose_little_energy() {
    let mut random = Random::new(7);
    for bxdf in [dielectric(1.5, 0.05, 0.05), dielectric(1.0 / 1.5, 0.05, 0.05), lossless_conductor(0.05)] {
        for wo in [views()[0], views()[1], -views()[1]] {
            let kept: Moments = (0..4000)
                .map(|_| random_sample(&bxdf, wo, &mut random, TransportMode::Importance, Directions::All))
                .map(|sample| sample.map_or(0.0, |sample| weight(&sample)[0] as f64))
                .collect();
            assert!((0.98..=1.0).contains(&kept.mean), "{bxdf:?} from {wo} keeps {}", kept.mean);
        }
    }
}

/// The albedo of lobes that are not specular, by sampling and by quadrature of f over all
/// directions.
#[test]
fn samples_integrate_f() {
    let mut random = Random::new(8);
    for bxdf in rough_members() {
        for wo in views() {
            let density = |theta: f64, phi: f64| {
                let (sin, cos) = (theta.sin() as f32, theta.cos() as f32);
                let wi = spherical_direction(sin, cos, phi as f32);
                (bxdf.f(wo, wi, TransportMode::Radiance)[1] * cos.abs() * sin) as f64
            };
            let exact: f64 = (0..64)
                .map(|i| {
                    let (row, column) = ((i / 8) as f64, (i % 8) as f64);
                    let (theta, phi) = (std::f64::consts::PI / 8.0, std::f64::consts::TAU / 8.0);
                    let cell = [[row * theta, (row + 1.0) * theta], [column * phi, (column + 1.0) * phi]];
                    integrate(&density, cell, 1e-5)
                })
                .sum();
            let albedo: Moments = (0..10_000)
                .map(|_| random_sample(&bxdf, wo, &mut random, TransportMode::Radiance, Directions::All))
                .map(|sample| sample.filter(|sample| !sample.flags.is_specular()))
                .map(|sample| sample.map_or(0.0, |sample| weight(&sample)[1] as f64))
                .collect();
            let tolerance = 5.0 * albedo.variance_of_mean().sqrt() + 0.004;
            assert!((albedo.mean - exact).abs() < tolerance, "{bxdf:?} from {wo}: {albedo:?} for {exact}");
        }
    }
}

#[test]
fn albedos_of_diffuse_surfaces_are_their_reflectance() {
    let Bxdf::Diffuse(Diffuse { reflectance }) = diffuse() else { unreachable!() };
    let pairs = [(0.1, Vec2::new(0.3, 0.8)), (0.9, Vec2::new(0.6, 0.1))];
    assert!(spectra_close(diffuse().rho_hd(views()[1], pairs), reflectance, 1e-5));
    assert!(diffuse().rho_hd(views()[1], []).is_black());
}

/// BxDFs of very low roughness behave as smooth ones.
#[test]
fn low_roughness_converges_to_specular() {
    let mut random = Random::new(10);
    for (rough, smooth) in [
        (conductor(0.0011, 0.0011), conductor(0.0, 0.0)),
        (dielectric(1.5, 0.0011, 0.0011), dielectric(1.5, 0.0, 0.0)),
        (dielectric(1.0 / 1.5, 0.0011, 0.0011), dielectric(1.0 / 1.5, 0.0, 0.0)),
    ] {
        assert!(rough.flags().is_glossy() && smooth.flags().is_specular());
        for wo in [views()[0], views()[1], views()[2], views()[4]] {
            let (mut nearby, mut count) = (0, 0);
            for _ in 0..500 {
                let (uc, u) = (random.get_1d(), Vec2::from(random.get_2d()));
                let sample = |bxdf: Bxdf| {
                    bxdf.sample_f(wo, uc, u, TransportMode::Radiance, Directions::All).into_option()
                };
                let (Some(a), Some(b)) = (sample(rough), sample(smooth)) else { continue };
                count += 1;
                let alike = (a.wi - b.wi).length() < 0.03 && spectra_close(weight(&a), weight(&b), 0.02);
                nearby += alike as i32;
            }
            assert!(
                count > 490 && nearby as f32 > 0.97 * count as f32,
                "{rough:?} from {wo}: {nearby} of {count}"
            );
        }
    }
}

#[test]
fn regularization_roughens_narrow_lobes() {
    for mut bxdf in [conductor(0.0, 0.0), dielectric(1.5, 0.0, 0.0)] {
        assert!(bxdf.flags().is_specular());
        bxdf.regularize(true);
        assert!(bxdf.flags().is_glossy() && !bxdf.flags().is_specular());
    }
    let mut glass = dielectric(1.5, 0.2, 0.6);
    glass.regularize(true);
    let Bxdf::Dielectric(glass) = glass else { unreachable!() };
    assert_eq!(glass.distribution, TrowbridgeReitz::new(0.3, 0.6));
}

/// The sum of the internal reflections of a pane.
#[test]
fn thin_glass_sums_internal_reflections() {
    for theta in [0.0f32, 30.0, 75.0, 120.0] {
        let wo = from_degrees(theta, 10.0);
        let fresnel = alhazen_scattering::fr_dielectric(wo.z.abs(), 1.5);
        let inner = (1.0 - fresnel).powi(2);
        let reflected = fresnel + (0..40).map(|n| inner * fresnel.powi(2 * n + 1)).sum::<f32>();
        let sample =
            thin_dielectric(1.5).sample_f(wo, 0.0, Vec2::ZERO, TransportMode::Radiance, Directions::All);
        assert!(sample.valid && close(sample.pdf, reflected, 1e-5));
    }
}

/// Samples, f and pdf are finite and not negative.
fn check_sane(bxdf: Bxdf, wo: Vector3, uc: f32, u: Vec2) -> Result<(), String> {
    let bsdf = Bsdf { bxdf, frame: Frame { x: Vec3::X, y: Vec3::Y, z: Vec3::Z } };
    for mode in MODES {
        for directions in DIRECTIONS {
            let Some(sample) = bsdf.sample_f(wo, uc, u, mode, directions) else { continue };
            let weight = weight(&sample);
            let f = bsdf.f(wo, sample.wi, mode);
            let pdf = bsdf.pdf(wo, sample.wi, mode, directions);
            let sane = weight.is_finite()
                && weight.min_component() >= 0.0
                && sample.pdf > 0.0
                && f.0.iter().all(|f| *f >= 0.0)
                && pdf >= 0.0
                && sample.wi.is_finite();
            if !sane {
                return Err(format!("{bxdf:?} from {wo:?} with {uc} {u}: {sample:?}, f {f:?}, pdf {pdf}"));
            }
        }
    }
    Ok(())
}

#[test]
fn degenerate_input_gives_finite_values() {
    let mut views = views().to_vec();
    views.extend([Vec3::Z, -Vec3::Z]);
    for z in [0.0f32, 1e-42, 1.2e-38, 1e-30, 1e-20, 1e-12, 1e-7, 1e-4] {
        let flat = Vec3::new(0.6, -0.8, 0.0);
        views.extend([
            flat + z * Vec3::Z,
            flat - z * Vec3::Z,
            Vec3::new(1.0, 0.0, z),
            Vec3::new(0.0, 1.0, -z),
        ]);
    }
    let ends = [0.0, 1e-30, 0.25, 0.5, 0.75, ONE_MINUS_EPSILON];
    for bxdf in members() {
        for &wo in &views {
            for uc in [0.0, 0.5, ONE_MINUS_EPSILON] {
                for x in ends {
                    for y in ends {
                        check_sane(bxdf, wo, uc, Vec2::new(x, y)).unwrap();
                    }
                }
            }
        }
    }
}

#[test]
fn horizon_and_invalid_directions_scatter_nothing() {
    for bxdf in members() {
        let bsdf = Bsdf::new(Vec3::Z, Vec3::X, bxdf);
        for wo in [Vec3::X, Vec3::new(0.0, -1.0, -0.0), Vec3::splat(f32::NAN)] {
            assert!(bsdf.f(wo, Vec3::Z, TransportMode::Radiance).is_black());
            assert_eq!(bsdf.pdf(wo, Vec3::Z, TransportMode::Radiance, Directions::All), 0.0);
            let sample = bsdf.sample_f(wo, 0.5, Vec2::splat(0.5), TransportMode::Radiance, Directions::All);
            assert!(sample.is_none());
        }
    }
}

#[test]
fn a_bsdf_is_its_bxdf_in_the_shading_frame() {
    let mut random = Random::new(11);
    let ns = Vec3::new(0.3, -0.5, 0.7).normalize();
    for bxdf in members() {
        let bsdf = Bsdf::new(ns, Vec3::new(1.0, 2.0, 0.5), bxdf);
        assert!((bsdf.local_to_render(Vec3::Z) - ns).length() < 1e-6);
        for _ in 0..50 {
            let wo = random_direction(&mut random);
            let (uc, u) = (random.get_1d(), Vec2::from(random.get_2d()));
            let local = bxdf
                .sample_f(bsdf.render_to_local(wo), uc, u, TransportMode::Radiance, Directions::All)
                .into_option();
            let render = bsdf.sample_f(wo, uc, u, TransportMode::Radiance, Directions::All);
            let Some(render) = render else {
                assert!(local.is_none_or(|local| local.f.is_black()));
                continue;
            };
            let local = local.expect("the BxDF has each sample of the BSDF");
            assert!((bsdf.local_to_render(local.wi) - render.wi).length() < 1e-5);
            assert_eq!((local.pdf, local.f), (render.pdf, render.f));
        }
    }
}

proptest! {
    #[test]
    fn any_glass_and_metal_is_sane(
        (eta, k) in (0.1f32..4.0, 0f32..10.0),
        (x, y) in (0f32..1.0, 0f32..1.0),
        (cos, phi) in (-1f32..1.0, 0f32..6.3),
        (uc, u, v) in (0f32..1.0, 0f32..1.0, 0f32..1.0),
    ) {
        let wo = spherical_direction((1.0 - cos * cos).sqrt(), cos, phi);
        let distribution = TrowbridgeReitz::new(x * x, y * y);
        let metal = Conductor { distribution, eta: SampledSpectrum::splat(eta), k: SampledSpectrum::splat(k) };
        for bxdf in [Dielectric { eta, distribution }.into(), ThinDielectric { eta }.into(), metal.into()] {
            prop_assert_eq!(check_sane(bxdf, wo, uc, Vec2::new(u, v)), Ok(()));
        }
    }
}
