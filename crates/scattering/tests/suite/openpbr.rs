//! The principled surface: energy, limits of its parameters.

use alhazen_scattering::{Bxdf, Directions, OpenPbr, OpenPbrParameters, Scatter, TransportMode};
use math::{Vec2, spherical_direction};
use spectrum::{SampledSpectrum, SampledWavelengths};
use testkit::Random;

const WHITE: SampledSpectrum = SampledSpectrum::ONE;

fn surface(parameters: OpenPbrParameters) -> Bxdf<'static> {
    OpenPbr::new(&parameters, &SampledWavelengths::sample_uniform(0.3)).into()
}

/// White parameters, which absorb nothing.
fn lossless() -> OpenPbrParameters {
    OpenPbrParameters { base_color: WHITE, subsurface_color: WHITE, ..OpenPbrParameters::default() }
}

/// What is scattered from a direction, by samples.
fn albedo(bxdf: &Bxdf, cosine: f32, phi: f32) -> f64 {
    let wo = spherical_direction((1.0 - cosine * cosine).sqrt(), cosine, phi);
    let mut random = Random::new(7);
    const COUNT: usize = 10_000;
    let mut sum = 0.0;
    for i in 0..COUNT {
        let u = Vec2::new((i as f32 + random.get_1d()) / COUNT as f32, random.get_1d());
        let uc = ((i * 7919) % COUNT) as f32 / COUNT as f32;
        let s = bxdf.sample_f(wo, uc, u, TransportMode::Importance, Directions::All);
        if s.valid && s.pdf > 0.0 {
            sum += f64::from((s.f * (s.wi.z.abs() / s.pdf)).average());
        }
    }
    sum / COUNT as f64
}

#[test]
fn explore() {
    println!("size {} openpbr {}", std::mem::size_of::<Bxdf>(), std::mem::size_of::<OpenPbr>());
    let cases: Vec<(&str, OpenPbrParameters)> = vec![
        ("diffuse", lossless()),
        ("eon", OpenPbrParameters { base_diffuse_roughness: 1.0, ..lossless() }),
        ("metal", OpenPbrParameters { base_metalness: 1.0, ..lossless() }),
        ("glass", OpenPbrParameters { transmission_weight: 1.0, ..lossless() }),
        ("glass2", OpenPbrParameters { transmission_weight: 1.0, specular_ior: 2.2, ..lossless() }),
        ("coat diffuse", OpenPbrParameters { coat_weight: 1.0, ..lossless() }),
        ("rough coat diffuse", OpenPbrParameters { coat_weight: 1.0, coat_roughness: 0.5, ..lossless() }),
        ("coat metal", OpenPbrParameters { coat_weight: 1.0, base_metalness: 1.0, ..lossless() }),
        (
            "rough coat metal",
            OpenPbrParameters { coat_weight: 1.0, coat_roughness: 0.4, base_metalness: 1.0, ..lossless() },
        ),
        ("coat glass", OpenPbrParameters { coat_weight: 1.0, transmission_weight: 1.0, ..lossless() }),
        ("fuzz diffuse", OpenPbrParameters { fuzz_weight: 1.0, ..lossless() }),
        ("fuzz metal", OpenPbrParameters { fuzz_weight: 1.0, base_metalness: 1.0, ..lossless() }),
        ("film diffuse", OpenPbrParameters { thin_film_weight: 1.0, ..lossless() }),
        ("film metal", OpenPbrParameters { thin_film_weight: 1.0, base_metalness: 1.0, ..lossless() }),
        ("film glass", OpenPbrParameters { thin_film_weight: 1.0, transmission_weight: 1.0, ..lossless() }),
        (
            "fuzz coat mix",
            OpenPbrParameters {
                fuzz_weight: 0.7,
                coat_weight: 0.5,
                coat_roughness: 0.2,
                base_metalness: 0.4,
                transmission_weight: 0.3,
                ..lossless()
            },
        ),
        (
            "aniso metal",
            OpenPbrParameters { specular_roughness_anisotropy: 0.7, base_metalness: 1.0, ..lossless() },
        ),
    ];
    for (name, p) in cases {
        println!("{name}");
        for phi in if name.contains("aniso") { vec![0.0, 0.8, 1.57] } else { vec![0.4] } {
            for roughness in [0.0, 0.1, 0.25, 0.5, 0.75, 1.0] {
                let b = surface(OpenPbrParameters { specular_roughness: roughness, ..p });
                print!("  {roughness:4} ");
                for c in [1.0f32, 0.7, 0.4, 0.2, 0.05, -0.05, -0.2, -0.5, -0.75, -1.0] {
                    print!(" {:.4}", albedo(&b, c, phi));
                }
                println!();
            }
        }
    }
}
