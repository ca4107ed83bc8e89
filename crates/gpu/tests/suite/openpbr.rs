//! Principled surfaces beside their translations.

use std::sync::LazyLock;

use alhazen_gpu::openpbr_table;
use math::Vec3;
use scattering::{OpenPbr, OpenPbrParameters, OpenPbrTable};
use spectrum::SampledWavelengths;

use crate::laws::{Row, sampled, spectrum, value};
use crate::twins::{Law, agree};

/// Of surfaces with all layers, some of which are absent.
static TABLE: LazyLock<OpenPbrTable> = LazyLock::new(|| {
    let least = OpenPbrParameters {
        specular_roughness: 0.2,
        thin_film_weight: 0.5,
        transmission_weight: 1.0,
        ..OpenPbrParameters::default()
    };
    let most = OpenPbrParameters { specular_roughness: 1.0, coat_weight: 1.0, fuzz_weight: 1.0, ..least };
    OpenPbrTable::new(&least, &most)
});

/// The table as a kernel has it; its record begins at the first word.
fn words() -> Vec<u32> {
    let len = openpbr_table(&TABLE, |_| 0).len();
    let mut rows = Vec::new();
    let mut words = openpbr_table(&TABLE, |numbers| {
        let at = len + rows.len();
        rows.extend(numbers.iter().map(|number| number.to_bits()));
        assert!(at.is_multiple_of(4) && rows.len().is_multiple_of(4));
        at as u32
    });
    words.append(&mut rows);
    words
}

/// The normal of the coat of half of the surfaces.
const TILTED: Vec3 = Vec3::new(0.36, -0.48, 0.8);

fn surface(x: &Row) -> OpenPbr<'static> {
    let parameters = OpenPbrParameters {
        base_color: spectrum(x, 0.9),
        base_diffuse_roughness: 0.4,
        base_metalness: 0.5 * x[9],
        specular_roughness: 0.2 + 0.8 * x[10],
        transmission_weight: x[11],
        coat_weight: x[6],
        coat_color: spectrum(x, 1.0),
        coat_roughness: 0.3,
        geometry_coat_normal: if x[7] < 0.5 { TILTED } else { Vec3::Z },
        fuzz_weight: x[7],
        thin_film_weight: 0.5,
        ..OpenPbrParameters::default()
    };
    OpenPbr::new(&TABLE, &parameters, &SampledWavelengths::sample_visible(0.3))
}

/// The same surface in WGSL.
macro_rules! surface {
    ($rest:literal) => {
        concat!(
            "let s = vec4f(x[6], x[7], x[8], x[9]);
            let white = vec4f(1);
            let p = OpenPbrParameters(1.0, s * 0.9, 0.4, 0.5 * x[9], 1.0, white, 0.2 + 0.8 * x[10], 0.0, 1.5,
                x[11], white, 0.0, vec4f(0.8), vec4f(), 0.0, x[6], s, 0.3, 0.0, 1.6, 1.0,
                select(vec3f(0, 0, 1), vec3f(0.36, -0.48, 0.8), x[7] < 0.5),
                x[7], white, 0.5, 0.5, 0.5, 1.4, false);
            let b = OpenPbr_new(0, p, SampledWavelengths_sample_visible(0.3));",
            $rest
        )
    };
}

const LAWS: [Law; 2] = [
    Law {
        name: "OpenPbr",
        bound: 1e-3,
        flips: 1e-3,
        rust: |x| value(&surface(x), x),
        wgsl: surface!(
            "var f: array<vec4f, 2>;
            for (var mode = TransportMode_Radiance; mode <= TransportMode_Importance; mode++) {
                f[mode] = OpenPbr_f(b, wo, wi, mode);
            }
            let d = OpenPbr_pdf(b, wo, wi, TransportMode_Radiance, Directions_All);
            y = array(f[0].x, f[0].y, f[0].z, f[0].w, f[1].x, d, 0, 0);"
        ),
    },
    Law {
        name: "OpenPbr, sampled",
        bound: 1e-3,
        flips: 1e-3,
        rust: |x| sampled(&surface(x), x),
        wgsl: surface!(
            "let t = OpenPbr_sample_f(b, wo, x[8], u, TransportMode_Radiance, Directions_All);
            if (t.valid) {
                y = array(1, t.f.x * t.wi.z, t.f.w * t.wi.z, t.wi.x, t.wi.y, t.wi.z, t.pdf, t.eta);
            }"
        ),
    },
];

#[test]
fn principled_surfaces_agree_with_their_translations() {
    agree(&LAWS, Some(&words()));
}
