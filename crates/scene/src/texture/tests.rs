//! Textures: single ones, and compiled from a scene.

mod lanes;
mod noise;
mod programs;

use super::*;
use crate::footprint::Footprint;
use ::image::{ColorEncoding, Image};
use description::{
    ColorSpaceDesc, Diagnostic, EncodingDesc, FloatTextureDesc, Handle, ImageChannel, ImageDesc,
    ImageTextureDesc, MappingDesc, Parameter, SceneDesc, Span, SpectrumDesc, SpectrumTextureDesc, Stated,
    TextureFilter, TextureKind, WrapMode,
};
use math::{DMat4, DVec3, Transform, Vec2, Vec3};
use spectrum::{RgbColorSpace, SampledSpectrum, SampledWavelengths};
use std::sync::Arc;

const FILTERS: [TextureFilter; 4] =
    [TextureFilter::Point, TextureFilter::Bilinear, TextureFilter::Trilinear, TextureFilter::Ewa];

fn at(u: f32, v: f32) -> TextureContext {
    TextureContext { uv: Vec2::new(u, v), ..TextureContext::default() }
}

/// The point under a footprint of ∂u/∂x, ∂u/∂y, ∂v/∂x and ∂v/∂y.
fn seen(at: TextureContext, [dudx, dudy, dvdx, dvdy]: [f32; 4]) -> TextureContext {
    TextureContext { footprint: Footprint { dudx, dudy, dvdx, dvdy, ..Footprint::default() }, ..at }
}

fn lambda() -> SampledWavelengths {
    SampledWavelengths::sample_visible(0.37)
}

fn push_image(scene: &mut SceneDesc, image: Image) -> Handle<ImageDesc> {
    scene.images.push(ImageDesc { name: "test.png".into(), image: Arc::new(image) })
}

/// The compiled textures of a scene, in its order.
struct Compiled {
    textures: Textures,
    floats: Vec<FloatTextureId>,
    /// One for each spectrum type.
    spectra: Vec<[SpectrumTextureId; 3]>,
    diagnostics: Vec<Diagnostic>,
}

impl Compiled {
    /// The value of the first texture of numbers.
    fn float(&self, ctx: &TextureContext) -> f32 {
        self.textures.float(self.floats[0], ctx)
    }

    /// The values of the first texture of spectra, one for each spectrum type.
    fn spectra(&self, ctx: &TextureContext) -> [SampledSpectrum; 3] {
        self.spectra[0].map(|id| self.textures.spectrum(id, ctx, &lambda()))
    }

    fn codes(&self) -> Vec<&'static str> {
        self.diagnostics.iter().map(|diagnostic| diagnostic.code).collect()
    }
}

fn compiled_at(scene: &SceneDesc, render_from_world: &DMat4) -> Compiled {
    let mut diagnostics = Vec::new();
    let mut compiler = TextureCompiler::new(scene, render_from_world, &mut diagnostics);
    let floats = scene
        .float_textures
        .iter()
        .map(|(handle, _)| compiler.float_parameter(&handle.into(), Span::NONE, &mut diagnostics))
        .collect();
    let spectra = scene
        .spectrum_textures
        .iter()
        .map(|(handle, _)| {
            SpectrumType::ALL.map(|spectrum_type| {
                compiler.spectrum_parameter(&handle.into(), spectrum_type, Span::NONE, &mut diagnostics)
            })
        })
        .collect();
    Compiled { textures: compiler.finish(), floats, spectra, diagnostics }
}

fn compiled(scene: &SceneDesc) -> Compiled {
    compiled_at(scene, &DMat4::IDENTITY)
}

fn sound(scene: &SceneDesc) -> Compiled {
    let compiled = compiled(scene);
    assert!(compiled.diagnostics.is_empty(), "{:?}", compiled.diagnostics);
    compiled
}

/// A scene of one texture of numbers.
fn float_texture(kind: TextureKind<f32>) -> Compiled {
    let mut scene = SceneDesc::default();
    scene.float_textures.push(FloatTextureDesc::new(kind));
    sound(&scene)
}

/// The one texture of numbers that `image` makes.
fn float_image(image: Image, change: impl FnOnce(&mut ImageTextureDesc)) -> Compiled {
    let mut scene = SceneDesc::default();
    let mut desc = ImageTextureDesc::new(push_image(&mut scene, image));
    change(&mut desc);
    scene.float_textures.push(FloatTextureDesc::new(TextureKind::Image(desc)));
    sound(&scene)
}

/// The one texture of spectra that `image` makes.
fn spectrum_image(image: Image, change: impl FnOnce(&mut ImageTextureDesc)) -> Compiled {
    let mut scene = SceneDesc::default();
    let mut desc = ImageTextureDesc::new(push_image(&mut scene, image));
    change(&mut desc);
    scene.spectrum_textures.push(SpectrumTextureDesc::new(TextureKind::Image(desc)));
    sound(&scene)
}

fn assert_spectrum(found: SampledSpectrum, expected: SampledSpectrum, tolerance: f32) {
    let worst = (found - expected).map(f32::abs).max_component();
    assert!(worst <= tolerance, "{found:?} is not {expected:?}");
}

#[test]
fn scale_and_mix_follow_their_formulas() {
    let ramp = Image::from_fn(2, 1, ["Y"], |x, _| [[0.25, 0.75][x as usize]]);
    let mut scene = SceneDesc::default();
    let image = ImageTextureDesc::new(push_image(&mut scene, ramp));
    let a = scene.float_textures.push(FloatTextureDesc::new(TextureKind::Image(image)));
    let b = scene.float_textures.push(FloatTextureDesc::new(TextureKind::Constant { value: 0.8 }));
    for kind in [
        TextureKind::Scale { texture: b.into(), scale: a.into() },
        TextureKind::Mix { textures: [0.2.into(), b.into()], amount: a.into() },
    ] {
        scene.float_textures.push(FloatTextureDesc::new(kind));
    }
    let [red, blue] = [SpectrumDesc::rgb(0.9, 0.1, 0.1), SpectrumDesc::rgb(0.1, 0.2, 0.8)];
    let mixed = TextureKind::Mix { textures: [red.clone().into(), blue.clone().into()], amount: a.into() };
    let mixed = scene.spectrum_textures.push(SpectrumTextureDesc::new(mixed));
    let scaled = TextureKind::Scale { texture: mixed.into(), scale: a.into() };
    scene.spectrum_textures.push(SpectrumTextureDesc::new(scaled));
    let t = sound(&scene);
    let [red, blue] = [red, blue]
        .map(|s| compile_spectrum(&s, SpectrumType::Albedo, Span::NONE, &mut Vec::new()).sample(&lambda()));
    for (u, amount) in [(0.25, 0.25_f32), (0.75, 0.75)] {
        assert_eq!(t.textures.float(t.floats[2], &at(u, 0.5)), 0.8 * amount);
        let mixed = 0.2 * (1.0 - amount) + 0.8 * amount;
        assert_eq!(t.textures.float(t.floats[3], &at(u, 0.5)), mixed);
        let expected = (red * (1.0 - amount) + blue * amount) * amount;
        assert_eq!(t.textures.spectrum(t.spectra[1][0], &at(u, 0.5), &lambda()), expected);
    }
}

/// A checkerboard of the numbers 0 and 1, on squares or in cubes.
fn checkerboard(mapping: Option<MappingDesc>) -> Compiled {
    float_texture(TextureKind::Checkerboard { textures: [0.0.into(), 1.0.into()], mapping })
}

#[test]
fn a_sharp_checkerboard_alternates() {
    let squares = checkerboard(Some(MappingDesc::default()));
    for (u, v, second) in [
        (0.5, 0.5, 0.0),
        (1.5, 0.5, 1.0),
        (1.5, 1.5, 0.0),
        (-0.5, 0.5, 1.0),
        (-0.5, -0.5, 0.0),
        (2.0, 0.3, 0.0),
        (1.0, 0.3, 1.0),
    ] {
        assert_eq!(squares.float(&at(u, v)), second, "({u}, {v})");
    }
    let cubes = checkerboard(None);
    for (p, second) in [(Vec3::splat(0.4), 0.0), (Vec3::new(1.4, 0.4, 0.4), 1.0), (Vec3::splat(-0.4), 1.0)] {
        assert_eq!(cubes.float(&TextureContext { p, ..TextureContext::default() }), second, "{p}");
    }
}

#[test]
fn a_filtered_checkerboard_is_the_average_under_a_triangle() {
    let squares = checkerboard(Some(MappingDesc::default()));
    let wave = |x: f64| if (x.floor() as i64) % 2 == 0 { 1.0 } else { -1.0 };
    for r in [0.02f32, 0.3, 0.49, 0.51, 0.8, 1.7, 6.3] {
        for x in [-3.9f32, -0.2, 0.01, 0.45, 0.5, 0.99, 4.3] {
            let n = 20_000;
            let average: f64 = (0..n)
                .map(|i| {
                    let e = (f64::from(i) + 0.5) / f64::from(n) * 2.0 - 1.0;
                    wave(f64::from(x) + e * f64::from(r)) * (1.0 - e.abs()) * 2.0 / f64::from(n)
                })
                .sum();
            // v is far from an edge, so that only u is averaged.
            let ctx = seen(at(x, 0.5), [r / 1.5, -0.1 * r, 0.0, 0.0]);
            let found = f64::from(squares.float(&ctx));
            assert!((found - (0.5 - 0.5 * average)).abs() < 2e-4, "x {x} r {r}: {found} {average}");
        }
    }
}

#[test]
fn a_checkerboard_under_a_wide_footprint_is_grey() {
    let squares = checkerboard(Some(MappingDesc::default()));
    for wide in [1e3, 1e30, f32::INFINITY] {
        let amount = squares.float(&seen(at(0.3, 0.4), [wide, 0.0, 0.0, wide]));
        assert!((amount - 0.5).abs() < 1e-3, "{wide}: {amount}");
    }
    squares.float(&seen(at(f32::NAN, 0.4), [f32::NAN, 0.0, 0.0, 0.0]));
}

fn mappings() -> Vec<Mapping2d> {
    let texture_from_render = Transform::rotate(0.7, Vec3::new(1.0, -2.0, 0.4))
        .after(&Transform::translate(Vec3::new(0.2, -0.1, 0.3)));
    vec![
        Mapping2d::Uv { scale: Vec2::new(3.0, -2.0), delta: Vec2::new(0.5, 0.1) },
        Mapping2d::Spherical { texture_from_render },
        Mapping2d::Cylindrical { texture_from_render },
        Mapping2d::Planar {
            texture_from_render,
            axes: [Vec3::new(0.4, 0.3, 1.0), Vec3::new(-1.0, 2.0, 0.0)],
            delta: Vec2::new(0.3, -0.4),
        },
    ]
}

#[test]
fn derivatives_of_mappings_are_finite_differences() {
    let ctx = TextureContext {
        p: Vec3::new(1.2, -0.8, 0.6),
        n: Vec3::Z,
        uv: Vec2::new(0.3, 0.8),
        footprint: Footprint {
            dpdx: Vec3::new(0.5, 0.2, -0.3),
            dpdy: Vec3::new(-0.1, 0.7, 0.4),
            dudx: 0.2,
            dudy: -0.3,
            dvdx: 0.7,
            dvdy: 0.1,
        },
    };
    let Footprint { dpdx, dpdy, dudx, dudy, dvdx, dvdy } = ctx.footprint;
    let h = 2e-3;
    let moved = |x: f32, y: f32| TextureContext {
        p: ctx.p + dpdx * x + dpdy * y,
        uv: ctx.uv + Vec2::new(dudx * x + dudy * y, dvdx * x + dvdy * y),
        ..ctx
    };
    for mapping in mappings() {
        let st = |x, y| mapping.map(&moved(x, y)).st;
        let c = mapping.map(&ctx);
        let (dx, dy) = ((st(h, 0.0) - st(-h, 0.0)) / (2.0 * h), (st(0.0, h) - st(0.0, -h)) / (2.0 * h));
        assert!(
            (c.dstdx - dx).length() < 1e-3 && (c.dstdy - dy).length() < 1e-3,
            "{mapping:?} {c:?} {dx} {dy}"
        );
    }
}

#[test]
fn mappings_follow_their_formulas() {
    let texture_from_render = Transform::IDENTITY;
    let p = Vec3::new(0.0, 2.0, 2.0);
    let ctx = TextureContext { p, ..at(0.25, 0.5) };
    let [uv, planar] = [&mappings()[0], &mappings()[3]].map(|m| m.map(&ctx).st);
    assert_eq!(uv, Vec2::new(1.25, -0.9));
    let Mapping2d::Planar { texture_from_render: t, .. } = &mappings()[3] else { unreachable!() };
    let q = t.point(p);
    let expected = Vec2::new(q.dot(Vec3::new(0.4, 0.3, 1.0)) + 0.3, q.dot(Vec3::new(-1.0, 2.0, 0.0)) - 0.4);
    assert!((planar - expected).length() < 1e-6);
    let spherical = Mapping2d::Spherical { texture_from_render }.map(&ctx).st;
    assert!((spherical - Vec2::new(0.25, 0.25)).length() < 1e-6);
    let cylindrical = Mapping2d::Cylindrical { texture_from_render }.map(&ctx).st;
    assert!((cylindrical - Vec2::new(0.75, 2.0)).length() < 1e-6);
}

/// Values 0, 1 in the top row, 2, 3 in the bottom row.
fn four() -> Image {
    Image::from_fn(2, 2, ["Y"], |x, y| [(x + 2 * y) as f32])
}

#[test]
fn the_origin_of_an_image_is_its_lower_left_corner() {
    for filter in FILTERS {
        let t = float_image(four(), |desc| desc.filter = filter);
        for (u, v, value) in [(0.25, 0.75, 0.0), (0.75, 0.75, 1.0), (0.25, 0.25, 2.0), (0.75, 0.25, 3.0)] {
            assert_eq!(t.float(&at(u, v)), value, "{filter:?} ({u}, {v})");
        }
    }
    let middle = float_image(four(), |_| ()).float(&at(0.5, 0.25));
    assert_eq!(middle, 2.5);
}

#[test]
fn the_wrap_mode_determines_values_beyond_an_image() {
    for (wrap, value) in [(WrapMode::Repeat, 2.0), (WrapMode::Black, 0.0), (WrapMode::Clamp, 3.0)] {
        let t = float_image(four(), |desc| desc.wrap = wrap);
        assert_eq!(t.float(&at(1.25, 0.25)), value, "{wrap:?}");
    }
}

#[test]
fn images_are_scaled_and_then_inverted() {
    let t = float_image(four(), |desc| desc.scale = 0.25);
    assert_eq!(t.float(&at(0.75, 0.25)), 0.75);
    let t = float_image(four(), |desc| {
        desc.scale = 0.25;
        desc.invert = true;
    });
    assert_eq!([at(0.75, 0.25), at(0.25, 0.75)].map(|ctx| t.float(&ctx)), [0.25, 1.0]);
    let t = float_image(four(), |desc| desc.invert = true);
    assert_eq!(t.float(&at(0.75, 0.25)), 0.0, "clamped");

    let orange = Image::from_fn(1, 1, ["R", "G", "B"], |_, _| [0.9, 0.5, 2.5]);
    let t = spectrum_image(orange, |desc| {
        desc.scale = 0.5;
        desc.invert = true;
    });
    let expected = spectrum::Spectrum::rgb_albedo(RgbColorSpace::srgb(), [0.55, 0.75, 0.0].into());
    let found = t.spectra(&at(0.1, 0.1))[0];
    assert_spectrum(found, expected.sample(&lambda()), 1e-5);
}

#[test]
fn filters_of_constant_images_are_constant() {
    let wide = TextureContext {
        p: Vec3::new(1.2, -0.8, 0.6),
        footprint: Footprint {
            dpdx: Vec3::new(0.05, 0.02, -0.03),
            dpdy: Vec3::new(-0.01, 0.07, 0.04),
            dudx: 0.11,
            dudy: -0.02,
            dvdx: 0.03,
            dvdy: 0.2,
        },
        ..at(0.3, 0.9)
    };
    let axes = [Vec3::X, Vec3::new(0.2, 1.0, 0.0)];
    for mapping in [
        MappingDesc::default(),
        MappingDesc::Spherical,
        MappingDesc::Cylindrical,
        MappingDesc::Planar { axes, delta: [0.1, 0.2] },
        MappingDesc::Affine { columns: [[0.8, -0.6], [0.6, 0.8], [0.1, 0.2]] },
    ] {
        for filter in FILTERS {
            let t = float_image(Image::from_fn(13, 8, ["Y"], |_, _| [0.625]), |desc| {
                desc.filter = filter;
                desc.mapping = mapping;
            });
            let pole = TextureContext { p: Vec3::Z, ..wide };
            for ctx in [wide, at(0.2, 0.3), pole] {
                let found = t.float(&ctx);
                assert!((found - 0.625).abs() < 1e-5, "{filter:?} {mapping:?}: {found}");
            }
        }
    }
}

#[test]
fn numbers_come_from_opacity_or_the_mean_of_colours() {
    let rgba = |alpha: f32| Image::from_fn(1, 1, ["R", "G", "B", "A"], move |_, _| [0.3, 0.6, 0.9, alpha]);
    assert_eq!(float_image(rgba(0.25), |_| ()).float(&at(0.5, 0.5)), 0.25);
    assert!((float_image(rgba(1.0), |_| ()).float(&at(0.5, 0.5)) - 0.6).abs() < 1e-6);
    let grey = Image::from_fn(1, 1, ["Y", "A"], |_, _| [0.3, 0.25]);
    assert_eq!(float_image(grey, |_| ()).float(&at(0.5, 0.5)), 0.3);
}

#[test]
fn filters_that_take_single_texels_take_the_first_channel() {
    for filter in [TextureFilter::Point, TextureFilter::Ewa] {
        let image = Image::from_fn(1, 1, ["R", "G", "B", "A"], |_, _| [0.3, 0.6, 0.9, 0.25]);
        let found = float_image(image, |desc| desc.filter = filter).float(&at(0.5, 0.5));
        assert!((found - 0.3).abs() < 1e-6, "{filter:?}: {found}");
    }
}

#[test]
fn a_channel_can_be_chosen() {
    use ImageChannel::{Alpha, Blue, Green, Red};
    for filter in FILTERS {
        for (channel, value) in [(Red, 0.3), (Green, 0.6), (Blue, 0.9), (Alpha, 0.25)] {
            let image = Image::from_fn(1, 1, ["R", "G", "B", "A"], |_, _| [0.3, 0.6, 0.9, 0.25]);
            let t = float_image(image, |desc| (desc.filter, desc.channel) = (filter, Some(channel)));
            assert!((t.float(&at(0.5, 0.5)) - value).abs() < 1e-6, "{filter:?} {channel:?}");
            let grey = Image::from_fn(1, 1, ["Y", "A"], |_, _| [0.5, 0.25]);
            let t = float_image(grey, |desc| (desc.filter, desc.channel) = (filter, Some(channel)));
            assert_eq!(t.float(&at(0.5, 0.5)), if channel == Alpha { 0.25 } else { 0.5 });
        }
    }
    let mut scene = SceneDesc::default();
    let mut desc = ImageTextureDesc::new(push_image(&mut scene, four()));
    desc.channel = Some(Alpha);
    scene.float_textures.push(FloatTextureDesc::new(TextureKind::Image(desc)));
    assert_eq!(compiled(&scene).codes(), ["image"], "there is no opacity");
}

#[test]
fn opacity_in_8_bits_is_decoded_as_colours_are() {
    let image = |encoding| {
        let image = Image::from_fn(1, 1, ["R", "G", "B", "A"], |_, _| [0.3, 0.6, 0.9, 0.6]).to_u8(encoding);
        float_image(image, |_| ()).float(&at(0.5, 0.5))
    };
    assert!((image(ColorEncoding::Linear) - 0.6).abs() < 1e-6);
    assert!((image(ColorEncoding::Gamma(2.0)) - 0.36).abs() < 1e-6);
}

#[test]
fn colours_become_spectra_of_the_requested_type() {
    let t = spectrum_image(Image::from_fn(1, 1, ["R", "G", "B"], |_, _| [2.0; 3]), |desc| desc.scale = 0.25);
    let [albedo, unbounded, illuminant] = t.spectra(&at(0.5, 0.5));
    let half = SampledSpectrum::splat(0.5);
    assert_spectrum(albedo, half, 2e-3);
    assert_spectrum(unbounded, half, 2e-3);
    let white = RgbColorSpace::srgb().illuminant().sample(&lambda());
    assert_spectrum(illuminant, white * 0.5, 5e-3 * white.max_component());
}

#[test]
fn pyramids_are_shared() {
    let mut scene = SceneDesc::default();
    let image = push_image(&mut scene, four());
    let picture = SpectrumTextureDesc::new(TextureKind::Image(ImageTextureDesc::new(image)));
    scene.spectrum_textures.push(picture.clone());
    scene.spectrum_textures.push(picture);
    let t = sound(&scene);
    assert_eq!(t.textures.pyramids().len(), 1);
    assert_eq!(t.textures.spectrum_images().len(), 3, "one for each spectrum type");
    assert_eq!(t.spectra[0], t.spectra[1]);
}

#[test]
fn texture_space_follows_the_texture_transform() {
    let mut scene = SceneDesc::default();
    let mut desc = FloatTextureDesc::new(TextureKind::Checkerboard {
        textures: [1.0.into(), 0.0.into()],
        mapping: None,
    });
    desc.world_from_texture = DMat4::from_translation(DVec3::X * 5.0) * DMat4::from_scale(DVec3::splat(2.0));
    scene.float_textures.push(desc);
    let render_from_world = DMat4::from_translation(DVec3::new(-100.0, 0.0, 0.0));
    let t = compiled_at(&scene, &render_from_world);
    // World x = 5..7 is the first cube.
    for (world_x, value) in [(4.0, 0.0), (6.0, 1.0), (8.0, 0.0)] {
        let p = Vec3::new(world_x - 100.0, 1.0, 1.0);
        assert_eq!(t.float(&TextureContext { p, ..TextureContext::default() }), value, "{world_x}");
    }
}

#[test]
fn bilerp_interpolates_its_corners() {
    let mapping = MappingDesc::Uv { scale: [2.0, 1.0], delta: [0.0, 0.5] };
    let t = float_texture(TextureKind::Bilerp { corners: [0.1, 0.2, 0.4, 0.8], mapping });
    for (u, v, value) in
        [(0.0, -0.5, 0.1), (0.0, 0.5, 0.2), (0.5, -0.5, 0.4), (0.5, 0.5, 0.8), (0.25, 0.0, 0.375)]
    {
        assert!((t.float(&at(u, v)) - value).abs() < 1e-6, "({u}, {v})");
    }
}

#[test]
fn an_unsupported_texture_is_replaced_with_one_warning() {
    let kind = TextureKind::Ptex { filename: "a.ptx".into(), encoding: EncodingDesc::Linear, scale: 1.0 };
    let mut scene = SceneDesc::default();
    scene.spectrum_textures.push(SpectrumTextureDesc::new(kind));
    let t = compiled(&scene);
    let found: Vec<_> = t.diagnostics.iter().map(|d| (d.code, d.is_error())).collect();
    assert_eq!(found, [("not-drawn", false)]);
    for found in t.spectra(&at(0.1, 0.1)) {
        assert_spectrum(found, SampledSpectrum::splat(0.5), 1e-6);
    }
}

#[test]
fn invalid_values_are_reported() {
    let codes = |change: &dyn Fn(&mut SceneDesc)| {
        let mut scene = SceneDesc::default();
        change(&mut scene);
        compiled(&scene).codes()
    };
    let constant = |value: SpectrumDesc| {
        move |scene: &mut SceneDesc| {
            scene
                .spectrum_textures
                .push(SpectrumTextureDesc::new(TextureKind::Constant { value: value.clone() }));
        }
    };
    assert_eq!(codes(&constant(SpectrumDesc::Named("metal-Unobtainium-eta".into()))), ["invalid-value"]);
    assert_eq!(codes(&constant(SpectrumDesc::Blackbody(-3.0))), ["invalid-value"]);
    assert_eq!(
        codes(&constant(SpectrumDesc::Samples([(500.0, 1.0), (400.0, 1.0)].into()))),
        ["invalid-value"]
    );
    assert!(codes(&constant(SpectrumDesc::rgb(2.0, 0.0, 0.0))).is_empty(), "valid as an illuminant");
    let image = |change: fn(&mut FloatTextureDesc, &mut ImageTextureDesc)| {
        move |scene: &mut SceneDesc| {
            let mut desc = FloatTextureDesc::new(TextureKind::Constant { value: 0.0 });
            let mut image = ImageTextureDesc::new(push_image(scene, four()));
            change(&mut desc, &mut image);
            desc.kind = TextureKind::Image(image);
            scene.float_textures.push(desc);
        }
    };
    assert_eq!(codes(&image(|_, image| image.scale = f32::NAN)), ["invalid-value"]);
    let anisotropic = image(|_, image| (image.filter, image.max_anisotropy) = (TextureFilter::Ewa, 0.0));
    assert_eq!(codes(&anisotropic), ["invalid-value"]);
    let flat = image(|texture, image| {
        image.mapping = MappingDesc::Spherical;
        texture.world_from_texture = DMat4::from_scale(DVec3::new(1.0, 0.0, 1.0));
    });
    assert_eq!(codes(&flat), ["singular-transform"]);
}

#[test]
fn spectra_depend_on_the_spectrum_type() {
    let make = |desc: &SpectrumDesc, spectrum_type| {
        let mut diagnostics = Vec::new();
        let spectrum = compile_spectrum(desc, spectrum_type, Span::NONE, &mut diagnostics);
        (spectrum, diagnostics.iter().map(|d| (d.code, d.is_error())).collect::<Vec<_>>())
    };
    let bright = SpectrumDesc::Rgb { rgb: [2.0, 2.0, 2.0], space: ColorSpaceDesc::Rec2020 };
    let (albedo, warned) = make(&bright, SpectrumType::Albedo);
    assert_eq!(warned, [("color-out-of-range", false)]);
    assert!((albedo.at(550.0) - 1.0).abs() < 2e-3);
    let (light, warned) = make(&bright, SpectrumType::Illuminant);
    assert!(warned.is_empty());
    let white = RgbColorSpace::rec2020().illuminant();
    assert!((light.at(550.0) / white.at(550.0) - 2.0).abs() < 1e-2);
    assert_eq!(make(&SpectrumDesc::Illuminant(ColorSpaceDesc::Rec2020), SpectrumType::Illuminant).0, white);
    assert_eq!(
        make(&SpectrumDesc::rgb(-1.0, 0.0, 0.0), SpectrumType::Unbounded).1[0].0,
        "color-out-of-range"
    );
    assert!(make(&SpectrumDesc::rgb(f32::NAN, 0.0, 0.0), SpectrumType::Albedo).1[0].1);
    assert!(make(&SpectrumDesc::Constant(f32::INFINITY), SpectrumType::Unbounded).1[0].1);
    assert!(make(&SpectrumDesc::Constant(1e31), SpectrumType::Illuminant).1[0].1);
    assert!(make(&SpectrumDesc::rgb(3e38, 3e38, 3e38), SpectrumType::Illuminant).1[0].1);
    assert!(make(&SpectrumDesc::Named("glass-BK7".into()), SpectrumType::Unbounded).1.is_empty());
}
