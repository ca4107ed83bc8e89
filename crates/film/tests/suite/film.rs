//! The film as a whole: order, merging, refusal, bounds and development.

use std::collections::BTreeSet;

use alhazen_film::{Film, FilmTile, Layer, compile};
use description::{ColorSpaceDesc, FilmKind, FilterDesc, GBufferSpace, SceneDesc, Severity, Span, Spanned};
use image::Pixels;
use lanes::{InstructionSet, Kernel, Real};
use spectrum::{SampledSpectrum, SampledWavelengths};
use testkit::Random;

/// A scene with a small film of single floats and a box filter.
fn scene(resolution: [i32; 2]) -> SceneDesc {
    let mut desc = SceneDesc::default();
    desc.film.resolution = resolution;
    desc.film.save_fp16 = false;
    desc
}

fn film_of(desc: &SceneDesc) -> Film {
    compile(desc).expect("a film").film
}

#[derive(Clone, Copy, Debug)]
struct Sample {
    pixel: [i32; 2],
    l: SampledSpectrum,
    u: f32,
    weight: f32,
}

fn samples(count: usize, [width, height]: [i32; 2], seed: u64) -> Vec<Sample> {
    let mut random = Random::new(seed);
    let mut coordinate = |size: i32| (random.get_1d() * size as f32) as i32;
    let pixels: Vec<_> = (0..count).map(|_| [coordinate(width), coordinate(height)]).collect();
    pixels
        .into_iter()
        .map(|pixel| {
            // Magnitudes over sixty powers of two, where sums of floats would depend on their
            // order.
            let magnitude = 2f32.powf(60.0 * random.get_1d() - 30.0);
            let l = SampledSpectrum::new([(); 4].map(|()| magnitude * random.get_1d()));
            Sample { pixel, l, u: random.get_1d(), weight: 2.0 * random.get_1d() - 0.5 }
        })
        .collect()
}

fn add(film: &mut Film, sample: &Sample) {
    film.add_sample(sample.pixel, &sample.l, &SampledWavelengths::sample_visible(sample.u), sample.weight);
}

fn floats(film: &Film) -> Vec<u32> {
    film.develop().expect("memory").values().map(f32::to_bits).collect()
}

#[test]
fn order_and_merging_do_not_change_a_bit() {
    let resolution = [19, 35];
    let desc = scene(resolution);
    let samples = samples(2000, resolution, 9);
    let mut whole = film_of(&desc);
    samples.iter().for_each(|sample| add(&mut whole, sample));
    for seed in 0..10 {
        let mut random = Random::new(seed);
        let mut order: Vec<(u64, &Sample)> = samples.iter().map(|sample| (random.bits(), sample)).collect();
        order.sort_by_key(|&(key, _)| key);
        let split = (random.get_1d() * samples.len() as f32) as usize;
        let mut parts = [film_of(&desc), film_of(&desc)];
        for (place, (_, sample)) in order.into_iter().enumerate() {
            add(&mut parts[usize::from(place < split)], sample);
        }
        let [mut merged, other] = parts;
        merged.merge(&other).unwrap();
        assert_eq!(merged.sample_count(), 2000);
        assert!(floats(&merged) == floats(&whole));
    }
}

#[test]
fn tiles_hold_every_pixel_once_and_fill_the_same_film() {
    let resolution = [37, 50];
    let mut desc = scene(resolution);
    desc.film.pixel_bounds = Some([3, 36, 1, 50]);
    let bounds = film_of(&desc).pixel_bounds();
    let samples: Vec<_> =
        samples(5000, resolution, 4).into_iter().filter(|sample| bounds.contains(sample.pixel)).collect();
    let mut whole = film_of(&desc);
    samples.iter().for_each(|sample| add(&mut whole, sample));
    let mut tiled = film_of(&desc);
    let mut seen = 0;
    for mut tile in tiled.tiles_mut().unwrap() {
        let tile_bounds = tile.bounds();
        seen += tile_bounds.area();
        for sample in samples.iter().filter(|sample| tile_bounds.contains(sample.pixel)) {
            let lambda = SampledWavelengths::sample_visible(sample.u);
            tile.add_sample(sample.pixel, &sample.l, &lambda, sample.weight);
        }
    }
    assert_eq!(seen, bounds.area());
    assert_eq!(tiled.sample_count(), samples.len() as u64);
    assert!(floats(&tiled) == floats(&whole));
    let pixel = samples[0].pixel;
    let count = samples.iter().filter(|sample| sample.pixel == pixel).count() as u64;
    assert_eq!(tiled.pixel_sample_count(pixel), count);
}

#[test]
fn invalid_samples_are_counted_and_left_out() {
    let mut film = film_of(&scene([4, 4]));
    let lambda = SampledWavelengths::sample_visible(0.5);
    let good = SampledSpectrum::splat(0.5);
    film.add_sample([1, 1], &good, &lambda, 1.0);
    let before = floats(&film);
    for (i, bad) in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30].into_iter().enumerate() {
        let mut l = good;
        l[i] = bad;
        film.add_sample([1, 1], &l, &lambda, 1.0);
    }
    film.add_sample([3, 0], &good, &lambda, f32::NAN);
    assert_eq!(floats(&film), before);
    assert_eq!(film.sample_count(), 1);
    assert_eq!(film.rejected().count, 5);
    assert_eq!(film.rejected().pixels().collect::<Vec<_>>(), [[3, 0], [1, 1]], "in reading order");
}

#[test]
fn the_pixels_of_refused_samples_do_not_depend_on_order() {
    let lambda = SampledWavelengths::sample_visible(0.5);
    let bad = SampledSpectrum::splat(f32::NAN);
    let pixels: Vec<_> = (0..100).map(|i| [i % 10, i / 10]).collect();
    let (mut film, mut other) = (film_of(&scene([10, 10])), film_of(&scene([10, 10])));
    pixels.iter().rev().for_each(|&pixel| film.add_sample(pixel, &bad, &lambda, 1.0));
    pixels.iter().for_each(|&pixel| other.add_sample(pixel, &bad, &lambda, 1.0));
    assert_eq!(film.rejected(), other.rejected());
    film.merge(&other).unwrap();
    assert_eq!(film.rejected().count, 200);
    assert_eq!(film.rejected().pixels().collect::<Vec<_>>(), pixels[..alhazen_film::MAX_REJECTED_PIXELS]);
}

#[test]
fn small_values_next_to_large_ones_are_kept() {
    let mut film = film_of(&scene([1, 1]));
    let lambda = SampledWavelengths::sample_uniform(0.3);
    let develop = |film: &Film| film.develop().unwrap().rgb(0, 0);
    film.add_sample([0, 0], &SampledSpectrum::splat(1e-9), &lambda, 1.0);
    let small = develop(&film);
    assert!(small.iter().any(|c| *c != 0.0));
    film.add_sample([0, 0], &SampledSpectrum::splat(1e6), &lambda, 1.0);
    film.add_sample([0, 0], &SampledSpectrum::splat(1e6), &lambda, -1.0);
    assert_eq!(develop(&film), small);
}

#[test]
fn half_floats_do_not_overflow() {
    let mut desc = scene([1, 1]);
    desc.film.save_fp16 = true;
    let mut film = film_of(&desc);
    film.add_sample([0, 0], &SampledSpectrum::splat(1e9), &SampledWavelengths::sample_uniform(0.3), 1.0);
    let image = film.develop().unwrap();
    assert!(matches!(image.pixels(), Pixels::F16(_)));
    assert!(image.values().all(|value| value.abs() <= 65504.0));
}

#[test]
fn a_sample_is_scaled_down_to_the_largest_allowed_component() {
    let mut desc = scene([1, 1]);
    let lambda = SampledWavelengths::sample_uniform(0.3);
    let l = SampledSpectrum::new([5.0, 3.0, 2.0, 9.0]);
    let picture = |desc: &SceneDesc| {
        let mut film = film_of(desc);
        film.add_sample([0, 0], &l, &lambda, 1.0);
        film.develop().unwrap().rgb(0, 0)
    };
    let free = picture(&desc);
    desc.film.max_component_value = 1.0;
    let limited = picture(&desc);
    let factor = limited[0] / free[0];
    assert!(factor > 0.0 && factor < 0.1);
    assert!(
        (0..3).all(|c| (limited[c] / free[c] / factor - 1.0).abs() < 1e-5),
        "one factor for all: {limited:?} {free:?}"
    );
}

#[test]
fn the_picture_has_its_window_and_colour_space() {
    let mut desc = scene([40, 30]);
    desc.film.pixel_bounds = Some([10, 99, -5, 20]);
    desc.film.color_space = ColorSpaceDesc::Rec2020;
    let image = film_of(&desc).develop().unwrap();
    assert_eq!((image.width(), image.height()), (30, 20));
    assert_eq!((image.data_window().min, image.data_window().max), ([10, 0], [40, 20]));
    assert_eq!(image.display_window().max, [40, 30]);
    assert_eq!(image.metadata.chromaticities.unwrap().green, [0.17, 0.797]);
    assert!(image.values().all(|value| value == 0.0), "no light yet");
}

#[test]
fn a_crop_window_is_rounded_up_on_both_sides() {
    let mut desc = scene([10, 10]);
    desc.film.crop_window = Some([0.25, 0.55, 0.0, 0.5]);
    let bounds = film_of(&desc).pixel_bounds();
    assert_eq!((bounds.min, bounds.max), ([3, 0], [6, 5]));
    desc.film.pixel_bounds = Some([0, 9, 0, 9]);
    assert_eq!(film_of(&desc).pixel_bounds(), bounds, "pixel bounds do not count beside it");
}

/// The codes and messages of [`compile`] for a scene.
fn said(desc: &SceneDesc) -> Vec<(Severity, &'static str, String)> {
    let diagnostics = match compile(desc) {
        Ok(compiled) => compiled.warnings,
        Err(errors) => errors,
    };
    diagnostics.into_iter().map(|d| (d.severity, d.code, d.message)).collect()
}

#[test]
fn invalid_films_are_errors() {
    let mut desc = scene([10, 10]);
    desc.film.pixel_bounds = Some([20, 30, 0, 10]);
    assert_eq!(said(&desc)[0].1, "invalid-film");
    desc = scene([1_000_000, 1_000_000]);
    let (_, code, message) = &said(&desc)[0];
    assert_eq!(*code, "invalid-film");
    assert!(message.contains("no memory"), "{message}");
    desc = scene([10, 10]);
    desc.film.sensor.white_balance = 20.0;
    assert_eq!(said(&desc)[0].1, "invalid-sensor");
    desc = scene([10, 10]);
    desc.camera.shutter_close = desc.camera.shutter_open;
    assert_eq!(said(&desc)[0].1, "invalid-sensor");
}

#[test]
fn settings_outside_their_domain_are_errors() {
    let mut desc = scene([0, 10]);
    desc.film.diagonal = -1.0;
    desc.film.max_component_value = f32::NAN;
    desc.film.sensor.iso = -100.0;
    desc.filter.value = FilterDesc::Gaussian { radius: [1.5, 1.5], sigma: 0.0 };
    let said = said(&desc);
    assert!(said.iter().all(|(severity, code, _)| (*severity, *code) == (Severity::Error, "invalid-value")));
    for name in ["xresolution", "diagonal", "maxcomponentvalue", "iso", "sigma"] {
        assert!(said.iter().any(|d| d.2.starts_with(&format!("`{name}` is "))), "{name}: {said:?}");
    }
    assert_eq!(said.len(), 5);
}

#[test]
fn impossible_buckets_and_unknown_sensors_are_errors() {
    let mut desc = scene([10, 10]);
    desc.film.kind = FilmKind::Spectral { buckets: 8, lambda_min: 700.0, lambda_max: 400.0 };
    assert_eq!(said(&desc)[0].2, "no 8 buckets go from 700 to 400 nm");
    desc.film.kind = FilmKind::Spectral { buckets: 5000, lambda_min: 300.0, lambda_max: 700.0 };
    let messages: Vec<_> = said(&desc).into_iter().map(|(.., message)| message).collect();
    assert!(messages[0].starts_with("`nbuckets` is "), "{messages:?}");
    assert!(messages[1].starts_with("`lambdamin` is "), "{messages:?}");
    desc = scene([10, 10]);
    desc.film.sensor.name = "canon_eos_10d".into();
    let (_, code, message) = said(&desc).remove(0);
    assert!(code == "invalid-value" && message.ends_with("sony_ilce_9, not canon_eos_10d"), "{message}");
}

#[test]
fn layers_are_asked_for_by_name_or_as_a_gbuffer() {
    let layer = |name: &str| Spanned::new(name.to_owned(), Span::NONE);
    let mut desc = scene([10, 10]);
    desc.film.layers = ["samples", "depth"].map(layer).into();
    let layers = |desc: &SceneDesc| film_of(desc).layers().iter().map(Layer::name).collect::<BTreeSet<_>>();
    assert_eq!(layers(&desc), BTreeSet::from(["depth", "samples"]));
    desc.film.kind = FilmKind::GBuffer { space: GBufferSpace::World };
    assert_eq!(said(&desc), []);
    let both = ["albedo", "uv", "color-variance", "depth", "samples"];
    let of = |space: [&'static str; 4]| both.into_iter().chain(space).collect::<BTreeSet<_>>();
    let gbuffer = of(["normal", "position", "geometric-normal", "slope"]);
    assert_eq!(layers(&desc), gbuffer);
    desc.film.kind = FilmKind::GBuffer { space: GBufferSpace::Camera };
    assert_eq!(said(&desc), []);
    let gbuffer = of(["camera-position", "camera-normal", "camera-geometric-normal", "camera-slope"]);
    assert_eq!(layers(&desc), gbuffer);
    desc.film.layers = vec![layer("depht")];
    let (severity, _, message) = said(&desc).remove(0);
    assert_eq!(severity, Severity::Error);
    assert!(message.starts_with("no layer is called `depht`; known are alpha, depth, "), "{message}");
}

#[test]
fn the_imaging_ratio_is_exposure_time_times_iso_over_100() {
    let lambda = SampledWavelengths::sample_uniform(0.3);
    let mut desc = scene([1, 1]);
    let picture = |desc: &SceneDesc| {
        let mut film = film_of(desc);
        film.add_sample([0, 0], &SampledSpectrum::splat(1.0), &lambda, 1.0);
        film.develop().unwrap().rgb(0, 0)
    };
    let plain = picture(&desc);
    desc.camera.shutter_open = 1.0;
    desc.camera.shutter_close = 1.5;
    desc.film.sensor.iso = 800.0;
    let brighter = picture(&desc);
    assert!((0..3).all(|c| (brighter[c] / plain[c] - 4.0).abs() < 1e-5), "{brighter:?} {plain:?}");
    desc.film.sensor.name = "nikon_d810".into();
    let bright = picture(&desc);
    desc.film.sensor.iso = 100.0;
    let dark = picture(&desc);
    assert!((0..3).all(|c| (bright[c] / dark[c] - 8.0).abs() < 1e-5), "{bright:?} {dark:?}");
}

/// Adds the samples of all pixels of a tile, in lanes.
struct AddLanes<'a, 'film>(&'a mut FilmTile<'film>, &'a [Sample]);

impl Kernel for AddLanes<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let Self(tile, samples) = self;
        for (first, samples) in samples.chunks(R::LANES).enumerate() {
            let at = |lane: usize| &samples[lane.min(samples.len() - 1)];
            let l = SampledSpectrum([0, 1, 2, 3].map(|i: usize| R::from_fn(|lane| at(lane).l[i])));
            let lambda = SampledWavelengths::sample_visible(R::from_fn(|lane| at(lane).u));
            let weight = R::from_fn(|lane| at(lane).weight);
            tile.add_lanes(first * R::LANES, samples.len(), &l, &lambda, weight);
        }
    }
}

#[test]
fn samples_in_lanes_are_added_like_single_ones() {
    let resolution = [19, 21];
    let mut with_layers = scene(resolution);
    with_layers.film.kind = FilmKind::GBuffer { space: GBufferSpace::World };
    let mut of_camera = scene(resolution);
    of_camera.film.sensor.name = "sony_ilce_9".into();
    let mut spectral = scene(resolution);
    spectral.film.kind = FilmKind::Spectral { buckets: 5, lambda_min: 400.0, lambda_max: 700.0 };
    for desc in [scene(resolution), with_layers, of_camera, spectral] {
        for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
            let [mut single, mut lanes] = [film_of(&desc), film_of(&desc)];
            for seed in 0..4 {
                let mut all = samples(19 * 21, resolution, seed);
                // Refused, and near the limits of the sums.
                all[3].l = SampledSpectrum::splat(f32::NAN);
                all[40].l = SampledSpectrum::splat(f32::INFINITY);
                all[77].weight = f32::NAN;
                all[90].weight = 1e13;
                all[100].l = SampledSpectrum::splat(3e8);
                all[101].l = SampledSpectrum::ZERO;
                let mut rest = &mut all[..];
                for tile in lanes.tiles_mut().expect("memory") {
                    let mut tile = tile;
                    let bounds = tile.bounds();
                    let (these, others) = rest.split_at_mut(bounds.area());
                    let rows = bounds.min[1]..bounds.max[1];
                    let pixels = rows.flat_map(|y| (bounds.min[0]..bounds.max[0]).map(move |x| [x, y]));
                    these.iter_mut().zip(pixels).for_each(|(sample, pixel)| sample.pixel = pixel);
                    set.dispatch(AddLanes(&mut tile, these));
                    rest = others;
                }
                all.iter().for_each(|sample| add(&mut single, sample));
            }
            assert_eq!(floats(&lanes), floats(&single), "{set:?}");
            assert_eq!(lanes.sample_count(), single.sample_count());
            assert_eq!(lanes.rejected(), single.rejected());
        }
    }
}
