//! The principled surface: energy, and limits in which it is another member.

use alhazen_scattering::{
    Bxdf, Dielectric, Directions, OpenPbr, OpenPbrParameters, OpenPbrTable, Scatter, TransportMode,
    TrowbridgeReitz, fr_dielectric,
};
use lanes::Real;
use math::{Vec2, Vec3, spherical_direction};
use sampling::warp::sample_uniform_sphere;
use spectrum::{SampledSpectrum, SampledWavelengths};
use testkit::{LaneFunction, Random, lanes_agree};

const WHITE: SampledSpectrum = SampledSpectrum::ONE;

fn surface(parameters: OpenPbrParameters) -> Bxdf<'static> {
    let table = Box::leak(Box::new(OpenPbrTable::new(&parameters, &parameters)));
    OpenPbr::new(table, &parameters, &SampledWavelengths::sample_uniform(0.3)).into()
}

/// White parameters, which absorb nothing.
fn lossless() -> OpenPbrParameters {
    OpenPbrParameters { base_color: WHITE, subsurface_color: WHITE, ..OpenPbrParameters::default() }
}

/// Parameters with all layers and colours.
fn everything() -> OpenPbrParameters {
    let color = |r, g, b, a| SampledSpectrum::new([r, g, b, a]);
    OpenPbrParameters {
        base_color: color(0.9, 0.5, 0.2, 0.1),
        base_diffuse_roughness: 0.5,
        base_metalness: 0.3,
        specular_color: color(1.0, 0.8, 0.9, 0.7),
        specular_roughness: 0.4,
        transmission_weight: 0.5,
        transmission_color: color(0.9, 1.0, 0.8, 0.7),
        coat_weight: 0.8,
        coat_color: color(0.9, 0.6, 0.7, 0.8),
        coat_roughness: 0.3,
        fuzz_weight: 0.6,
        fuzz_color: color(0.8, 0.9, 0.4, 0.5),
        thin_film_weight: 0.5,
        ..OpenPbrParameters::default()
    }
}

/// A thin wall, half of whose opaque part scatters inside, most of it forwards.
fn thin(parameters: OpenPbrParameters) -> OpenPbrParameters {
    OpenPbrParameters {
        geometry_thin_walled: true,
        subsurface_weight: 0.5,
        subsurface_scatter_anisotropy: 0.4,
        ..parameters
    }
}

/// Under coats with normals of their own.
pub fn tilted_members() -> Vec<Bxdf<'static>> {
    let coated = OpenPbrParameters { coat_weight: 0.7, ..tilted(OpenPbrParameters::default()) };
    vec![
        surface(OpenPbrParameters { coat_roughness: 0.4, base_metalness: 1.0, ..coated }),
        surface(coated),
        surface(tilted(everything())),
        surface(thin(tilted(everything()))),
    ]
}

/// A coat whose normal is turned by about 20°.
fn tilted(parameters: OpenPbrParameters) -> OpenPbrParameters {
    OpenPbrParameters { geometry_coat_normal: Vec3::new(0.3, -0.2, 1.0).normalize(), ..parameters }
}

/// Opaque and transparent surfaces, smooth and rough, with and without layers.
pub fn members() -> Vec<Bxdf<'static>> {
    let base = OpenPbrParameters::default();
    let metal = OpenPbrParameters { base_metalness: 1.0, ..base };
    let glass = OpenPbrParameters { transmission_weight: 1.0, ..base };
    vec![
        surface(base),
        surface(OpenPbrParameters { coat_weight: 1.0, specular_roughness: 0.7, ..metal }),
        surface(OpenPbrParameters { specular_roughness: 0.0, ..metal }),
        surface(OpenPbrParameters { specular_roughness: 0.6, specular_roughness_anisotropy: 0.5, ..metal }),
        surface(OpenPbrParameters { specular_roughness: 0.6, ..glass }),
        surface(OpenPbrParameters { specular_roughness: 0.0, ..glass }),
        surface(OpenPbrParameters { fuzz_weight: 1.0, ..base }),
        surface(everything()),
        surface(OpenPbrParameters { specular_roughness: 1.0, specular_roughness_anisotropy: 0.8, ..glass }),
        surface(thin(base)),
        surface(thin(OpenPbrParameters { specular_roughness: 0.7, ..glass })),
        surface(thin(OpenPbrParameters { specular_roughness: 0.0, ..glass })),
        surface(thin(everything())),
    ]
}

/// What is scattered from a direction, by stratified samples.
fn albedo(bxdf: &Bxdf, cosine: f32) -> SampledSpectrum {
    albedo_from(bxdf, cosine, 0.4)
}

/// The same from an azimuth.
fn albedo_from(bxdf: &Bxdf, cosine: f32, phi: f32) -> SampledSpectrum {
    albedo_in(bxdf, cosine, phi, TransportMode::Importance)
}

/// The same of radiance or importance.
fn albedo_in(bxdf: &Bxdf, cosine: f32, phi: f32, mode: TransportMode) -> SampledSpectrum {
    const COUNT: usize = 4000;
    let wo = spherical_direction((1.0 - cosine * cosine).sqrt(), cosine, phi);
    let mut random = Random::new(7);
    let samples = (0..COUNT).map(|i| {
        let u = Vec2::new((i as f32 + random.get_1d()) / COUNT as f32, random.get_1d());
        let uc = ((i * 1471) % COUNT) as f32 / COUNT as f32;
        let sample = bxdf.sample_f(wo, uc, u, mode, Directions::All).into_option();
        sample.map_or(SampledSpectrum::ZERO, |sample| sample.f * (sample.wi.z.abs() / sample.pdf))
    });
    samples.sum::<SampledSpectrum>() / COUNT as f32
}

const COSINES: [f32; 7] = [1.0, 0.6, 0.2, 0.05, -0.3, -0.7, -1.0];

#[test]
fn what_absorbs_nothing_loses_nothing() {
    let metal = OpenPbrParameters { base_metalness: 1.0, ..lossless() };
    let glass = OpenPbrParameters { transmission_weight: 1.0, ..lossless() };
    let cases = [
        ("diffuse", lossless(), 0.012),
        ("rough diffuse", OpenPbrParameters { base_diffuse_roughness: 1.0, ..lossless() }, 0.025),
        ("metal", metal, 0.012),
        ("glass", glass, 0.015),
        ("dense glass", OpenPbrParameters { specular_ior: 2.2, ..glass }, 0.015),
        ("clear coat", OpenPbrParameters { coat_weight: 1.0, ..lossless() }, 0.012),
        ("rough coat", OpenPbrParameters { coat_weight: 1.0, coat_roughness: 0.5, ..lossless() }, 0.012),
        ("coated metal", OpenPbrParameters { coat_weight: 1.0, ..metal }, 0.012),
        ("half coated metal", OpenPbrParameters { coat_weight: 0.5, coat_roughness: 0.4, ..metal }, 0.012),
        ("coated glass", OpenPbrParameters { coat_weight: 1.0, ..glass }, 0.015),
        ("coated dense glass", OpenPbrParameters { coat_weight: 1.0, specular_ior: 2.2, ..glass }, 0.015),
        ("rough coat on glass", OpenPbrParameters { coat_weight: 1.0, coat_roughness: 0.5, ..glass }, 0.015),
        ("fuzz", OpenPbrParameters { fuzz_weight: 1.0, ..lossless() }, 0.012),
        ("fuzzy glass", OpenPbrParameters { fuzz_weight: 1.0, ..glass }, 0.012),
        ("finely fuzzy glass", OpenPbrParameters { fuzz_weight: 1.0, fuzz_roughness: 0.2, ..glass }, 0.02),
        ("fuzzy metal", OpenPbrParameters { fuzz_weight: 1.0, fuzz_roughness: 0.2, ..metal }, 0.02),
        ("film", OpenPbrParameters { thin_film_weight: 1.0, ..lossless() }, 0.012),
        ("film on metal", OpenPbrParameters { thin_film_weight: 1.0, ..metal }, 0.012),
        ("film on glass", OpenPbrParameters { thin_film_weight: 1.0, ..glass }, 0.015),
        ("leaf", thin(lossless()), 0.012),
        ("rough leaf", thin(OpenPbrParameters { base_diffuse_roughness: 1.0, ..lossless() }), 0.035),
        ("coated leaf", thin(OpenPbrParameters { coat_weight: 1.0, ..lossless() }), 0.012),
        ("window", thin(glass), 0.035),
        ("coated window", thin(OpenPbrParameters { coat_weight: 1.0, coat_roughness: 0.3, ..glass }), 0.025),
        ("fuzzy window", thin(OpenPbrParameters { fuzz_weight: 1.0, ..glass }), 0.02),
        ("film on a window", thin(OpenPbrParameters { thin_film_weight: 1.0, ..glass }), 0.06),
        ("half metal, half window", thin(OpenPbrParameters { base_metalness: 0.5, ..glass }), 0.035),
    ];
    for (name, parameters, tolerance) in cases {
        for specular_roughness in [0.0, 0.25, 0.5, 1.0] {
            let bxdf = surface(OpenPbrParameters { specular_roughness, ..parameters });
            for cosine in COSINES {
                let albedo = albedo(&bxdf, cosine);
                for share in albedo.0 {
                    let message = format!("{name} of roughness {specular_roughness} at {cosine}: {albedo:?}");
                    assert!((share - 1.0).abs() < tolerance, "{message}");
                }
            }
        }
    }
}

/// In uniform light, from all sides, where a coat is seen along its slope and across it. Radiance
/// that glass refracts is less by the square of its index.
#[test]
fn tilted_coats_lose_nothing_that_is_seen() {
    let coated = OpenPbrParameters { coat_weight: 1.0, ..tilted(lossless()) };
    let glass = OpenPbrParameters { transmission_weight: 1.0, ..coated };
    let cases = [
        ("diffuse", coated, 0.012),
        ("metal", OpenPbrParameters { base_metalness: 1.0, ..coated }, 0.012),
        ("half coated", OpenPbrParameters { coat_weight: 0.5, ..coated }, 0.012),
        ("fuzzy", OpenPbrParameters { fuzz_weight: 1.0, ..coated }, 0.012),
        ("window", thin(glass), 0.012),
        ("steep", OpenPbrParameters { geometry_coat_normal: Vec3::new(0.6, 0.0, 0.8), ..coated }, 0.012),
    ];
    for (name, parameters, bound) in cases {
        for coat_roughness in [0.0, 0.3, 0.6] {
            let bxdf = surface(OpenPbrParameters { coat_roughness, ..parameters });
            for cosine in [0.05, 0.15, 0.4, 0.7, 1.0] {
                for phi in [0.0, 1.0, 2.5, 4.0, 5.5] {
                    let albedo = albedo_in(&bxdf, cosine, phi, TransportMode::Radiance)[0];
                    let message = format!("{name} {coat_roughness} from {cosine} {phi}: {albedo}");
                    assert!((albedo - 1.0).abs() < bound, "{message}");
                }
            }
        }
    }
}

/// A smooth coat mirrors a direction about its own normal.
#[test]
fn tilted_coats_mirror_about_their_normal() {
    let parameters = tilted(OpenPbrParameters { coat_weight: 1.0, base_weight: 0.0, ..Default::default() });
    let (bxdf, normal) = (surface(parameters), parameters.geometry_coat_normal);
    let wo = spherical_direction(0.6, 0.8, 0.5);
    let mut mirrored = 0;
    for i in 0..1000 {
        let u = Vec2::splat(0.5);
        let (mode, uc) = (TransportMode::Radiance, (i as f32 + 0.5) / 1000.0);
        let sample = bxdf.sample_f(wo, uc, u, mode, Directions::All);
        if sample.valid && sample.flags.is_specular() {
            let expected = fr_dielectric(wo.dot(normal), 1.6);
            assert!((sample.wi - (normal * (2.0 * wo.dot(normal)) - wo)).length() < 1e-5);
            // It is mirrored far above the base, so that all of it is reflected.
            assert!((sample.f[0] * sample.wi.z - expected).abs() < 1e-3 * expected);
            mirrored += 1;
        }
    }
    assert!(mirrored > 10, "{mirrored}");
}

/// Facets that are not alike both ways, from directions along, across and between.
#[test]
fn strokes_lose_nothing() {
    let metal = OpenPbrParameters { base_metalness: 1.0, ..lossless() };
    let glass = OpenPbrParameters { transmission_weight: 1.0, ..lossless() };
    let coat = OpenPbrParameters { coat_weight: 1.0, coat_roughness: 0.7, ..lossless() };
    for (name, parameters, tolerance) in [
        ("metal", metal, 0.02),
        ("diffuse", lossless(), 0.012),
        ("glass", glass, 0.03),
        ("window", thin(glass), 0.04),
        ("coat", OpenPbrParameters { coat_roughness_anisotropy: 0.8, ..coat }, 0.012),
    ] {
        for specular_roughness in [0.25, 0.5, 0.8, 1.0] {
            for specular_roughness_anisotropy in [0.2, 0.5, 0.8, 1.0] {
                let strokes =
                    OpenPbrParameters { specular_roughness, specular_roughness_anisotropy, ..parameters };
                let bxdf = surface(strokes);
                for (i, cosine) in COSINES.into_iter().enumerate() {
                    // Neighbouring cosines have different azimuths.
                    for phi in [[0.0, 1.1], [0.5, 1.5]][i % 2] {
                        let albedo = albedo_from(&bxdf, cosine, phi)[0];
                        let case = format!("{name} {specular_roughness} {specular_roughness_anisotropy}");
                        assert!((albedo - 1.0).abs() < tolerance, "{case} from {cosine} {phi}: {albedo}");
                    }
                }
            }
        }
    }
}

/// Where numbers vary, the table has nodes between which it is linear.
#[test]
fn surfaces_of_numbers_that_vary_are_those_of_constant_ones() {
    let least = OpenPbrParameters { specular_roughness: 0.0, ..lossless() };
    let most = OpenPbrParameters { specular_roughness: 1.0, ..least };
    let coated = OpenPbrParameters { coat_weight: 1.0, ..most };
    let filmed = OpenPbrParameters { thin_film_weight: 1.0, thin_film_thickness: 2.0, ..most };
    let thin_film = OpenPbrParameters { thin_film_thickness: 0.1, ..least };
    let cases = [
        ("roughness", least, most, 0.012),
        ("coat", least, coated, 0.015),
        ("rough coat", least, OpenPbrParameters { coat_roughness: 1.0, ..coated }, 0.02),
        ("film", thin_film, filmed, 0.02),
        ("index of a film", thin_film, OpenPbrParameters { thin_film_ior: 2.0, ..filmed }, 0.03),
        (
            "all",
            thin_film,
            OpenPbrParameters {
                transmission_weight: 1.0,
                coat_weight: 1.0,
                fuzz_weight: 1.0,
                specular_ior: 2.0,
                ..filmed
            },
            0.03,
        ),
    ];
    let lambda = SampledWavelengths::sample_uniform(0.3);
    let mut random = Random::new(11);
    for (name, least, most, tolerance) in cases {
        let table = OpenPbrTable::new(&least, &most);
        for metalness in [0.0, 1.0] {
            for _ in 0..6 {
                let mut between = |number: fn(&OpenPbrParameters) -> f32| {
                    math::lerp(random.get_1d(), number(&least), number(&most))
                };
                let parameters = OpenPbrParameters {
                    base_metalness: metalness,
                    specular_roughness: between(|p| p.specular_roughness),
                    specular_ior: between(|p| p.specular_ior),
                    transmission_weight: between(|p| p.transmission_weight),
                    coat_weight: between(|p| p.coat_weight),
                    coat_roughness: between(|p| p.coat_roughness),
                    fuzz_weight: between(|p| p.fuzz_weight),
                    thin_film_weight: between(|p| p.thin_film_weight),
                    thin_film_thickness: between(|p| p.thin_film_thickness),
                    thin_film_ior: between(|p| p.thin_film_ior),
                    ..lossless()
                };
                let bxdf = Bxdf::from(OpenPbr::new(&table, &parameters, &lambda));
                for cosine in [1.0, 0.6, 0.2] {
                    let albedo = albedo(&bxdf, cosine);
                    for share in albedo.0 {
                        let message = format!("{name}: {parameters:?} at {cosine}: {albedo:?}");
                        assert!((share - 1.0).abs() < tolerance, "{message}");
                    }
                }
            }
        }
    }
}

/// A smooth sheet sums the reflections between its sides, and does not turn light.
#[test]
fn thin_walls_reflect_and_transmit_as_the_specification_says() {
    let clear = OpenPbrParameters { specular_roughness: 0.0, transmission_weight: 1.0, ..lossless() };
    let window = surface(OpenPbrParameters { geometry_thin_walled: true, ..clear });
    let absorbing = SampledSpectrum::splat(0.5);
    let tinted =
        surface(OpenPbrParameters { geometry_thin_walled: true, transmission_color: absorbing, ..clear });
    for cosine in [1.0f32, 0.4, -0.7] {
        let wo = spherical_direction((1.0 - cosine * cosine).sqrt(), cosine, 2.0);
        let share = |bxdf: &Bxdf, directions| {
            let sample = bxdf.sample_f(wo, 0.5, Vec2::ZERO, TransportMode::Radiance, directions);
            assert!(sample.valid && sample.eta == 1.0);
            (sample.f[0] * sample.wi.z.abs() / sample.pdf, sample.wi)
        };
        let f = fr_dielectric(cosine.abs(), 1.5);
        let (transmitted, wi) = share(&window, Directions::Transmission);
        assert!((wi + wo).length() < 1e-5 && (transmitted - (1.0 - f) / (1.0 + f)).abs() < 1e-5);
        let (reflected, _) = share(&window, Directions::Reflection);
        assert!((reflected - 2.0 * f / (1.0 + f)).abs() < 1e-5);
        let (through, back) =
            (share(&tinted, Directions::Transmission), share(&tinted, Directions::Reflection));
        // The sum of what crosses the sheet once, three times, …, and of what returns.
        let sum = |first: f32| (0..30).map(|n| first * (0.25 * f * f).powi(n)).sum::<f32>();
        assert!((through.0 - sum(0.5 * (1.0 - f) * (1.0 - f))).abs() < 1e-5);
        assert!((back.0 - f - sum(0.25 * f * (1.0 - f) * (1.0 - f))).abs() < 1e-5);
    }
    let leaf = |subsurface_scatter_anisotropy| {
        surface(OpenPbrParameters {
            geometry_thin_walled: true,
            subsurface_weight: 1.0,
            subsurface_scatter_anisotropy,
            specular_weight: 0.0,
            ..lossless()
        })
    };
    let wo = spherical_direction(0.6, 0.8, 0.0);
    for (g, above) in [(-1.0, 1.0), (0.0, 0.5), (0.6, 0.2), (1.0, 0.0)] {
        let value = |wi| leaf(g).f(wo, wi, TransportMode::Radiance)[0] * std::f32::consts::PI;
        assert!((value(spherical_direction(0.8, 0.6, 1.0)) - above).abs() < 1e-3, "{g}");
        assert!((value(spherical_direction(0.8, -0.6, 1.0)) - (1.0 - above)).abs() < 1e-3, "{g}");
    }
}

#[test]
fn nothing_gains_light() {
    let mut random = Random::new(3);
    for _ in 0..24 {
        let mut weight = || if random.get_1d() < 0.3 { 0.0 } else { random.get_1d() };
        let bxdf = surface(OpenPbrParameters {
            base_metalness: weight(),
            base_diffuse_roughness: weight(),
            specular_weight: weight(),
            specular_roughness: weight(),
            specular_roughness_anisotropy: weight(),
            specular_ior: 1.0 + weight(),
            transmission_weight: weight(),
            coat_weight: weight(),
            coat_roughness: weight(),
            coat_ior: 1.0 + weight(),
            fuzz_weight: weight(),
            fuzz_roughness: weight(),
            thin_film_weight: weight(),
            thin_film_thickness: weight(),
            subsurface_weight: weight(),
            geometry_thin_walled: weight() > 0.5,
            ..lossless()
        });
        for cosine in COSINES {
            let albedo = albedo(&bxdf, cosine).max_component();
            assert!(albedo < 1.04, "{bxdf:?} at {cosine}: {albedo}");
        }
    }
}

#[test]
fn colours_absorb() {
    for cosine in COSINES {
        let [white, colored] =
            [lossless(), everything()].map(|parameters| albedo(&surface(parameters), cosine));
        assert!(colored.max_component() < white.min_component(), "{cosine}: {colored:?}");
    }
}

/// Smooth and without layers, transparent bases are glass.
#[test]
fn smooth_glass_is_a_dielectric() {
    let parameters = OpenPbrParameters { specular_roughness: 0.0, transmission_weight: 1.0, ..lossless() };
    let surface = surface(parameters);
    let glass = Dielectric { eta: 1.5, distribution: TrowbridgeReitz::new(0.0, 0.0) };
    for cosine in [1.0f32, 0.6, 0.1, -0.3, -0.8, -1.0] {
        let wo = spherical_direction((1.0 - cosine * cosine).sqrt(), cosine, 2.0);
        for uc in [0.01, 0.3, 0.95] {
            for mode in [TransportMode::Radiance, TransportMode::Importance] {
                let sample = |bxdf: &dyn Fn() -> alhazen_scattering::BsdfSample| {
                    let sample = bxdf();
                    (sample.wi, sample.f[0] * sample.wi.z.abs() / sample.pdf, sample.eta)
                };
                let of_glass = sample(&|| glass.sample_f(wo, uc, Vec2::ZERO, mode, Directions::All));
                let found = sample(&|| surface.sample_f(wo, uc, Vec2::ZERO, mode, Directions::All));
                assert!((found.0 - of_glass.0).length() < 1e-3, "{cosine} {uc}: {found:?} {of_glass:?}");
                assert!((found.1 - of_glass.1).abs() < 1e-3, "{cosine} {uc}: {found:?} {of_glass:?}");
                assert_eq!(found.2, of_glass.2);
            }
        }
    }
}

/// A smooth boundary over black reflects its Fresnel reflectance, scaled at normal incidence by
/// the weight; smooth metal reflects its colour there, and its tint of it near grazing angles.
#[test]
fn smooth_boundaries_reflect_as_the_specification_says() {
    let black = OpenPbrParameters { base_weight: 0.0, specular_roughness: 0.0, ..lossless() };
    for cosine in [1.0f32, 0.5, 0.1] {
        let found = albedo(&surface(black), cosine)[0];
        assert!((found - fr_dielectric(cosine, 1.5)).abs() < 1e-3, "{cosine}: {found}");
    }
    let faint = surface(OpenPbrParameters { specular_weight: 0.25, ..black });
    assert!((albedo(&faint, 1.0)[0] - 0.01).abs() < 1e-4);
    let metal = OpenPbrParameters {
        base_color: SampledSpectrum::splat(0.6),
        specular_color: SampledSpectrum::splat(0.5),
        base_metalness: 1.0,
        specular_roughness: 0.0,
        ..OpenPbrParameters::default()
    };
    assert!((albedo(&surface(metal), 1.0)[0] - 0.6).abs() < 1e-4);
    let schlick = 0.6 + 0.4 * (6.0f32 / 7.0).powi(5);
    assert!((albedo(&surface(metal), 1.0 / 7.0)[0] - 0.5 * schlick).abs() < 1e-3);
}

/// Light that crosses a coat along the normal, on the way in and out, has its colour.
#[test]
fn coats_absorb_along_the_path_in_them() {
    let parameters = OpenPbrParameters {
        base_metalness: 1.0,
        specular_roughness: 0.0,
        coat_weight: 1.0,
        coat_color: SampledSpectrum::splat(0.5),
        ..lossless()
    };
    let bxdf = surface(parameters);
    let boundary = fr_dielectric(1.0, 1.6);
    assert!((albedo(&bxdf, 1.0)[0] - (boundary + 0.5 * (1.0 - boundary))).abs() < 1e-3);
    // The sine in the coat is that outside over the index.
    let (cosine, inner) = (0.6f32, (1.0f32 - 0.64 / 2.56).sqrt());
    let reflected = fr_dielectric(cosine, 1.6);
    let expected = reflected + (1.0 - reflected) * 0.5f32.powf(1.0 / inner);
    assert!((albedo(&bxdf, cosine)[0] - expected).abs() < 1e-3);
}

#[test]
fn what_is_not_diffuse_does_not_depend_on_what_lies_deep() {
    let base = OpenPbrParameters { specular_roughness: 0.6, coat_roughness: 0.4, ..Default::default() };
    let coated = OpenPbrParameters { coat_weight: 1.0, coat_darkening: 0.0, ..base };
    let fuzzy = OpenPbrParameters { fuzz_weight: 1.0, fuzz_color: SampledSpectrum::ZERO, ..base };
    let mut random = Random::new(5);
    for parameters in [base, coated, fuzzy, thin(base)] {
        let black = SampledSpectrum::ZERO;
        let [bright, dark] = [WHITE, black].map(|color| {
            surface(OpenPbrParameters { base_color: color, subsurface_color: color, ..parameters })
        });
        let metal = surface(OpenPbrParameters { base_metalness: 1.0, fuzz_weight: 0.0, ..parameters });
        for _ in 0..1000 {
            let [wo, wi] = [(); 2].map(|()| {
                let (cosine, phi) = (0.01 + 0.99 * random.get_1d(), 6.0 * random.get_1d());
                spherical_direction((1.0 - cosine * cosine).sqrt(), cosine, phi)
            });
            let share = bright.diffuse_share(wo, wi, TransportMode::Radiance);
            assert!(share.0.iter().all(|share| (0.0..=1.0).contains(share)), "{share:?}");
            assert_eq!(metal.diffuse_share(wo, wi, TransportMode::Radiance), black);
            let value = |bxdf: &Bxdf| bxdf.f(wo, wi, TransportMode::Radiance);
            let mirrored = (WHITE - share) * value(&bright);
            let error = (mirrored - value(&dark))[0].abs();
            assert!(error <= 1e-4 * value(&bright)[0], "{error} of {:?}", value(&dark));
        }
    }
}

/// A surface with a table that covers all that lanes have.
struct Lanes {
    table: OpenPbrTable,
    most: OpenPbrParameters,
}

impl Lanes {
    fn new(most: OpenPbrParameters) -> Self {
        let least = OpenPbrParameters {
            specular_roughness: 0.0,
            coat_weight: 0.0,
            fuzz_weight: 0.0,
            thin_film_weight: 0.0,
            base_metalness: 0.0,
            transmission_weight: 0.0,
            ..most
        };
        Self { table: OpenPbrTable::new(&least, &most), most }
    }
}

impl LaneFunction for Lanes {
    #[inline(always)]
    fn results<R: Real>(&self, u: &[R]) -> Vec<R> {
        let c = R::splat;
        // A third of the lanes has nothing, a third has all.
        let part = |u: R, most: f32| ((u * c(3.0) - c(1.0)).clamp(R::zero(), R::one())) * c(most);
        let spectrum = |s: SampledSpectrum| SampledSpectrum::<R>::broadcast(s);
        let most = &self.most;
        let normal = Vec3::<R>::broadcast(most.geometry_coat_normal);
        let is_tilted = u[10].lt(c(0.5));
        let p = OpenPbrParameters {
            base_color: spectrum(most.base_color),
            base_diffuse_roughness: part(u[11], 1.0),
            base_metalness: part(u[4], most.base_metalness),
            specular_color: spectrum(most.specular_color),
            specular_roughness: part(u[5], most.specular_roughness),
            transmission_weight: part(u[6], most.transmission_weight),
            transmission_color: spectrum(most.transmission_color),
            subsurface_weight: c(most.subsurface_weight),
            subsurface_scatter_anisotropy: c(most.subsurface_scatter_anisotropy),
            coat_weight: part(u[7], most.coat_weight),
            coat_color: spectrum(most.coat_color),
            coat_roughness: c(most.coat_roughness),
            geometry_coat_normal: Vec3::select(is_tilted, normal, Vec3::broadcast(Vec3::Z)),
            fuzz_weight: part(u[8], most.fuzz_weight),
            fuzz_color: spectrum(most.fuzz_color),
            thin_film_weight: part(u[9], most.thin_film_weight),
            geometry_thin_walled: most.geometry_thin_walled,
            ..OpenPbrParameters::default()
        };
        let surface = OpenPbr::new(&self.table, &p, &SampledWavelengths::sample_uniform(u[10]));
        let wo = sample_uniform_sphere(Vec2::new(u[0], u[1]));
        let wi = sample_uniform_sphere(Vec2::new(u[2], u[3]));
        let mut results = Vec::new();
        for mode in [TransportMode::Radiance, TransportMode::Importance] {
            results.extend(surface.f(wo, wi, mode).0);
            results.push(surface.pdf(wo, wi, mode, Directions::All));
            let sample = surface.sample_f(wo, u[11], Vec2::new(u[3], u[1]), mode, Directions::All);
            let valid = |x: R| R::select(sample.valid, x, R::zero());
            let wi = sample.wi;
            results.extend([sample.f[0], sample.f[3], wi.x, wi.y, wi.z, sample.pdf, sample.eta].map(valid));
        }
        results
    }
}

#[test]
fn lanes_have_the_bits_of_single_floats() {
    for most in [everything(), tilted(everything()), thin(everything()), thin(tilted(everything()))] {
        let opaque = OpenPbrParameters { base_metalness: 1.0, transmission_weight: 0.0, ..most };
        let plain = OpenPbrParameters { coat_weight: 0.0, fuzz_weight: 0.0, thin_film_weight: 0.0, ..most };
        let whole = OpenPbrParameters { base_metalness: 1.0, transmission_weight: 1.0, ..most };
        for most in [opaque, plain, whole] {
            lanes_agree(&Lanes::new(most), 12, 100);
        }
    }
}
