//! Noise, and the textures that are made of it.

use super::*;
use crate::texture::noise::noise;
use std::f32::consts::{FRAC_PI_2, PI};
use testkit::Random;

/// Points in a box about the origin, with coordinates up to `size` in magnitude.
fn points(count: usize, size: f32) -> impl Iterator<Item = Vec3> {
    let mut random = Random::new(7);
    let mut coordinate = move || (2.0 * random.get_1d() - 1.0) * size;
    std::iter::repeat_with(move || Vec3::new(coordinate(), coordinate(), coordinate())).take(count)
}

fn corners(cell: Vec3) -> [Vec3; 8] {
    std::array::from_fn(|i| cell + Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32))
}

/// The gradient of the noise at a lattice point, by differences.
fn gradient(c: Vec3) -> Vec3 {
    let along = |h: Vec3| (noise(c + h) - noise(c - h)) / 0.25;
    // So near a lattice point the fade leaves little of its neighbours' ramps, which is rounded
    // away.
    let g = Vec3::new(along(Vec3::X * 0.125), along(Vec3::Y * 0.125), along(Vec3::Z * 0.125));
    g.map(f32::round)
}

#[test]
fn noise_is_zero_at_lattice_points_where_its_gradient_is_a_diagonal_of_a_face() {
    let mut seen = std::collections::HashSet::new();
    for p in points(400, 300.0) {
        let c = p.map(f32::floor);
        assert_eq!(noise(c), 0.0, "{c}");
        let g = gradient(c);
        assert_eq!(g.abs().x + g.abs().y + g.abs().z, 2.0, "{g}");
        assert_eq!(g.length_squared(), 2.0, "{g}");
        seen.insert(g.to_array().map(|x| x as i8));
    }
    assert_eq!(seen.len(), 12);
}

#[test]
fn noise_interpolates_the_ramps_of_the_corners() {
    let fade = |t: f64| ((6.0 * t - 15.0) * t + 10.0) * t.powi(3);
    for p in points(300, 100.0) {
        let sum: f64 = corners(p.map(f32::floor))
            .map(|c| {
                let d = (p - c).as_dvec3();
                let w = (DVec3::ONE - d.abs()).to_array().map(fade).iter().product::<f64>();
                w * gradient(c).as_dvec3().dot(d)
            })
            .iter()
            .sum();
        assert!((f64::from(noise(p)) - sum).abs() < 1e-5, "{p}: {} {sum}", noise(p));
    }
}

/// The value that the reference implementation of [Perlin 2002] gives.
#[test]
fn noise_has_the_published_permutation() {
    let found = noise(Vec3::new(314.0, 4200.0, 700.0) / 100.0);
    assert!((found - 0.136_919_96).abs() < 1e-6, "{found}");
}

#[test]
fn noise_repeats_after_256_units_and_stays_finite() {
    for p in points(100, 100.0) {
        // Multiples of 2⁻¹⁰ stay exact when they are moved.
        let p = p.map(|x| (x * 1024.0).round() / 1024.0);
        for period in [Vec3::X, -Vec3::Y, Vec3::Z * 3.0] {
            assert_eq!(noise(p), noise(p + period * 256.0), "{p}");
        }
    }
    assert_eq!(noise(Vec3::new(1e30, -3e38, 1e20)), 0.0);
    assert!(noise(Vec3::new(f32::INFINITY, f32::NAN, 0.5)).is_nan());
}

#[test]
fn noise_is_balanced() {
    let n = 40_000;
    let [mut sum, mut magnitude, mut largest] = [0.0_f64; 3];
    for p in points(n, 128.0) {
        let value = f64::from(noise(p));
        (sum, magnitude, largest) = (sum + value, magnitude + value.abs(), largest.max(value.abs()));
    }
    let n = n as f64;
    assert!((sum / n).abs() < 6e-3, "{}", sum / n);
    assert!((magnitude / n - 0.2).abs() < 0.03, "{}", magnitude / n);
    assert!(largest > 0.7 && largest < 1.0, "{largest}");
}

fn here(p: Vec3) -> TextureContext {
    TextureContext { p, ..TextureContext::default() }
}

/// A point with a footprint of this length.
fn under(p: Vec3, length: f32) -> TextureContext {
    let [dpdx, dpdy] = [Vec3::new(0.0, 0.6, 0.8) * length, Vec3::X * (0.3 * length)];
    TextureContext { footprint: Footprint { dpdx, dpdy, ..Footprint::default() }, ..here(p) }
}

const ROUGHNESS: f32 = 0.6;

/// The octaves of a texture at a point: the noise at each, with its amplitude.
fn octaves(p: Vec3, count: i32) -> Vec<[f32; 2]> {
    (0..count).map(|i| [ROUGHNESS.powi(i), noise(p * 1.99_f32.powi(i))]).collect()
}

fn close(found: f32, expected: f32) {
    assert!((found - expected).abs() < 2e-4, "{found} {expected}");
}

#[test]
fn fbm_sums_the_octaves_that_a_pixel_can_show() {
    let t = float_texture(TextureKind::Fbm { octaves: 5, roughness: ROUGHNESS });
    let (mut sum, n) = (0.0, 4000);
    for p in points(n, 20.0) {
        let octaves = octaves(p, 5);
        let first = |count: usize| octaves[..count].iter().map(|[a, value]| a * value).sum::<f32>();
        close(t.float(&here(p)), first(5));
        // A footprint of 2^(−n − 1) shows n octaves, to a tenth of the next or of the last.
        for (length, expected) in [
            (0.25_f32, first(1)),
            (0.125, first(2)),
            (2.0_f32.powf(-3.2), first(2)),
            (2.0_f32.powf(-3.5), first(2) + 0.5 * (first(3) - first(2))),
            (2.0_f32.powf(-3.8), first(3)),
            (0.5, 0.0),
            (9.0, 0.0),
        ] {
            close(t.float(&under(p, length)), expected);
        }
        sum += t.float(&here(p)) / n as f32;
    }
    assert!(sum.abs() < 0.02, "{sum}");
    assert_eq!(float_texture(TextureKind::Fbm { octaves: 0, roughness: 0.5 }).float(&here(Vec3::ONE)), 0.0);
}

#[test]
fn turbulence_replaces_octaves_by_their_mean() {
    let t = float_texture(TextureKind::Wrinkled { octaves: 4, roughness: ROUGHNESS });
    for p in points(300, 20.0) {
        let octaves = octaves(p, 4);
        // The octave after the last one visible counts once more.
        let first = |count: usize| {
            let value = |(i, [a, v]): (usize, &[f32; 2])| a * if i < count { v.abs() } else { 0.2 };
            octaves.iter().enumerate().map(value).sum::<f32>() + 0.2 * ROUGHNESS.powi(count as i32)
        };
        close(t.float(&here(p)), first(4));
        close(t.float(&under(p, 0.125)), first(2));
        close(t.float(&under(p, 3.0)), first(0));
    }
}

#[test]
fn waves_are_as_strong_as_the_wind() {
    let t = float_texture(TextureKind::Windy);
    let fbm = |octaves| float_texture(TextureKind::Fbm { octaves, roughness: 0.5 });
    let (wind, waves) = (fbm(3), fbm(6));
    for p in points(100, 50.0) {
        for ctx in [here(p), under(p, 0.1), under(p, 0.6), under(p, 9.0)] {
            let Footprint { dpdx, dpdy, .. } = ctx.footprint;
            let footprint = Footprint { dpdx: dpdx * 0.1, dpdy: dpdy * 0.1, ..ctx.footprint };
            let strength = wind.float(&TextureContext { p: p * 0.1, footprint, ..ctx }).abs();
            assert_eq!(t.float(&ctx), strength * waves.float(&ctx));
        }
    }
}

/// The spectra of marble, the same for each spectrum type.
fn marble(scale: f32, variation: f32, ctx: &TextureContext) -> SampledSpectrum {
    let mut scene = SceneDesc::default();
    let kind = TextureKind::Marble { octaves: 3, roughness: 0.5, scale, variation };
    scene.spectrum_textures.push(SpectrumTextureDesc::new(kind));
    let [albedo, unbounded, illuminant] = sound(&scene).spectra(ctx);
    assert_eq!([albedo, albedo], [unbounded, illuminant]);
    albedo
}

#[test]
fn marble_runs_through_its_colours() {
    let of = |r: f32, g: f32, b: f32| {
        spectrum::Spectrum::rgb_albedo(RgbColorSpace::srgb(), [1.5 * r, 1.5 * g, 1.5 * b].into())
            .sample(&lambda())
    };
    // Halfway at y = 0, at the ends where the sine is ±1; every sixth starts with a colour.
    let sixth = |i: f32| (i / 3.0 - 1.0).asin();
    for (y, expected) in [
        (1e-6, of(0.5, 0.5, 0.5)),
        (FRAC_PI_2, of(0.58, 0.58, 0.6)),
        (-FRAC_PI_2, of(0.58, 0.58, 0.6)),
        (sixth(4.0) + 1e-5, of(0.6, 0.59, 0.58)),
        // The middle of the fifth sixth: a Bézier curve at ½ has the weights 1, 3, 3, 1.
        (sixth(4.5), of(0.535, 0.53375, 0.56375)),
    ] {
        for scale in [1.0, 4.0] {
            let found = marble(scale, 0.0, &here(Vec3::new(0.3, y / scale, -7.0)));
            assert_spectrum(found, expected, 2e-3);
        }
    }
    let fbm = float_texture(TextureKind::Fbm { octaves: 3, roughness: 0.5 });
    for p in points(50, 3.0) {
        let moved = 2.0 * p + Vec3::Y * (0.7 * fbm.float(&here(2.0 * p)));
        assert_spectrum(marble(2.0, 0.7, &here(p)), marble(1.0, 0.0, &here(moved)), 1e-2);
    }
}

#[test]
fn dots_are_disks_in_squares_of_positive_noise() {
    let kind = TextureKind::Dots { inside: 0.25.into(), outside: 0.75.into(), mapping: Default::default() };
    let (t, mut dots, cells, n) = (float_texture(kind), 0, 40, 24);
    for cell in 0..cells * cells {
        let center = Vec2::new((cell % cells) as f32 - 20.0, (cell / cells) as f32 - 20.0);
        let (mut inside, mut sum) = (0, Vec2::ZERO);
        for i in 0..n * n {
            let offset = Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32 - Vec2::splat(0.5);
            let value = t.float(&at(center.x + offset.x, center.y + offset.y));
            assert!(value == 0.75 || value == 0.25);
            if value == 0.75 {
                (inside, sum) = (inside + 1, sum + offset);
            }
        }
        if inside > 0 {
            dots += 1;
            let share = inside as f32 / (n * n) as f32;
            assert!((share - PI * 0.35 * 0.35).abs() < 0.02, "{share}");
            assert!((sum / inside as f32).abs().max_element() < 0.15, "within its square");
        }
    }
    // Where all gradients of the corners cancel, which they often do, the noise is zero.
    let share = dots as f32 / (cells * cells) as f32;
    assert!((share - 0.38).abs() < 0.04, "{share}");
}

#[test]
fn a_direction_mixes_by_its_cosine_with_the_normal() {
    let mut scene = SceneDesc::default();
    let kind =
        TextureKind::DirectionMix { textures: [0.9.into(), 0.1.into()], direction: Vec3::new(2.0, 0.0, 0.0) };
    let mut desc = FloatTextureDesc::new(kind);
    // To the y axis.
    desc.world_from_texture =
        DMat4::from_rotation_z(std::f64::consts::FRAC_PI_2) * DMat4::from_scale(DVec3::splat(3.0));
    scene.float_textures.push(desc);
    let t = sound(&scene);
    for p in points(50, 1.0) {
        let n = p.normalize();
        let found = t.float(&TextureContext { n, ..TextureContext::default() });
        let expected = n.y.abs() * 0.9 + (1.0 - n.y.abs()) * 0.1;
        assert!((found - expected).abs() < 1e-6, "{n}: {found}");
    }
    let along = |n| t.float(&TextureContext { n, ..TextureContext::default() });
    close(along(-Vec3::Y), 0.9);
    close(along(Vec3::X), 0.1);
}

#[test]
fn parameters_of_noise_are_checked() {
    use TextureKind::{DirectionMix, Fbm, Marble, Wrinkled};
    let colour = || Parameter::Value(SpectrumDesc::Constant(0.2));
    let (octaves, roughness) = (8, 0.5);
    for (kind, parameter, message) in [
        (
            Fbm { octaves: -1, roughness },
            "octaves",
            "the number of octaves must lie between 0 and 64, not -1",
        ),
        (
            Wrinkled { octaves: 65, roughness },
            "octaves",
            "the number of octaves must lie between 0 and 64, not 65",
        ),
        (Wrinkled { octaves, roughness: f32::NAN }, "roughness", "`roughness` cannot be NaN"),
        (
            Marble { octaves, roughness, scale: f32::INFINITY, variation: 0.2 },
            "scale",
            "`scale` cannot be inf",
        ),
        (
            Marble { octaves, roughness, scale: 1.0, variation: f32::NAN },
            "variation",
            "`variation` cannot be NaN",
        ),
        (
            DirectionMix { textures: [colour(), colour()], direction: Vec3::ZERO },
            "dir",
            "the direction must not be zero or infinite",
        ),
    ] {
        let mut sources = description::SourceMap::default();
        let span = Span { file: sources.add("a.pbrt", *b"0123456789"), start: 3, end: 6 };
        let mut desc = Stated::from(SpectrumTextureDesc::new(kind));
        desc.origin.parameters.push((parameter, span));
        let mut scene = SceneDesc::default();
        scene.spectrum_textures.push_stated(desc);
        let t = compiled(&scene);
        let [error] = &t.diagnostics[..] else { panic!("{:?}", t.diagnostics) };
        assert_eq!((error.code, error.span()), ("invalid-value", span));
        assert_eq!(error.message, message);
        assert!(error.is_error());
    }
}
