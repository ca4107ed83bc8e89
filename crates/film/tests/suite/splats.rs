//! Light that arrives anywhere on the film.

use alhazen_film::{Development, Film, compile};
use description::{FilterDesc, SceneDesc};
use math::Vec2;
use spectrum::{SampledSpectrum, SampledWavelengths};
use testkit::Random;

const RESOLUTION: [i32; 2] = [35, 19];

fn film(filter: FilterDesc) -> Film {
    let mut desc = SceneDesc::default();
    desc.film.resolution = RESOLUTION;
    desc.film.save_fp16 = false;
    desc.filter.value = filter;
    compile(&desc).expect("a film").film
}

fn splat(film: &mut Film, at: Vec2, l: f32) {
    let lambda = SampledWavelengths::sample_visible(0.3);
    film.tiles_and_splatter().expect("memory").1.add(at, &SampledSpectrum::new([l; 4]), &lambda);
}

fn count(film: &mut Film, paths: u64) {
    film.tiles_and_splatter().expect("memory").1.add_paths(paths);
}

/// The green value of a pixel.
fn green(film: &Film, [x, y]: [i32; 2]) -> f64 {
    f64::from(film.develop().expect("memory").rgb(x as u32, y as u32)[1])
}

#[test]
fn a_splat_reaches_pixels_as_their_filter_says() {
    let gaussian = FilterDesc::Gaussian { radius: [2.0, 1.5], sigma: 0.6 };
    let mut film = film(gaussian);
    // A sample of weight 1 of the same light is the measure of all.
    let lambda = SampledWavelengths::sample_visible(0.3);
    let mut measure = film.blank().unwrap();
    measure.add_sample([0, 0], &SampledSpectrum::new([1.0; 4]), &lambda, 1.0);
    let unit = green(&measure, [0, 0]);

    let at = Vec2::new(16.2, 15.9);
    splat(&mut film, at, 8.0);
    count(&mut film, 4);
    let filter = film.filter().clone();
    for y in 0..RESOLUTION[1] {
        for x in 0..RESOLUTION[0] {
            let h = filter.evaluate(at - Vec2::new(x as f32 + 0.5, y as f32 + 0.5)) / filter.integral();
            let expected = f64::from(h) * 8.0 / 4.0 * unit;
            assert!((green(&film, [x, y]) - expected).abs() <= 1e-6 * unit, "{x} {y}");
        }
    }
}

#[test]
fn splats_and_samples_add_up() {
    let mut film = film(FilterDesc::Box { radius: [0.5, 0.5] });
    let lambda = SampledWavelengths::sample_visible(0.3);
    film.add_sample([3, 4], &SampledSpectrum::new([1.0; 4]), &lambda, 2.0);
    let sampled = green(&film, [3, 4]);
    splat(&mut film, Vec2::new(3.5, 4.5), 6.0);
    assert_eq!(green(&film, [3, 4]), sampled, "no paths were counted");
    count(&mut film, 3);
    assert!((green(&film, [3, 4]) / sampled - 3.0).abs() < 1e-6);
}

#[test]
fn a_film_for_splats_alone_has_their_picture() {
    let mut film = film(FilterDesc::Box { radius: [0.5, 0.5] });
    let mut alone = film.for_splats().expect("memory");
    for film in [&mut film, &mut alone] {
        splat(film, Vec2::new(3.5, 4.5), 6.0);
        count(film, 3);
    }
    assert!(green(&film, [3, 4]) > 0.0);
    for y in 0..RESOLUTION[1] {
        for x in 0..RESOLUTION[0] {
            assert_eq!(green(&alone, [x, y]), green(&film, [x, y]), "{x} {y}");
        }
    }
}

#[test]
fn the_largest_component_of_a_splat_is_that_of_a_sample() {
    let mut desc = SceneDesc::default();
    desc.film.resolution = RESOLUTION;
    desc.film.save_fp16 = false;
    desc.film.max_component_value = 3.0;
    desc.filter.value = FilterDesc::Box { radius: [0.5, 0.5] };
    let mut film = compile(&desc).expect("a film").film;
    let pixels = (RESOLUTION[0] * RESOLUTION[1]) as f32;
    let (below, above) = (Vec2::new(3.5, 4.5), Vec2::new(6.5, 4.5));
    splat(&mut film, below, 0.5 * pixels);
    splat(&mut film, above, 1e6 * pixels);
    count(&mut film, pixels as u64);
    let mut measure = film.blank().unwrap();
    let lambda = SampledWavelengths::sample_visible(0.3);
    measure.add_sample([0, 0], &SampledSpectrum::new([0.5; 4]), &lambda, 1.0);
    measure.add_sample([1, 0], &SampledSpectrum::new([1e6; 4]), &lambda, 1.0);
    for (splat, sample) in [([3, 4], [0, 0]), ([6, 4], [1, 0])] {
        assert!((green(&film, splat) / green(&measure, sample) - 1.0).abs() < 1e-5, "{splat:?}");
    }
}

#[test]
fn order_and_merging_do_not_change_a_bit() {
    let mut random = Random::new(5);
    let splats: Vec<_> = (0..500)
        .map(|_| {
            let at = Vec2::new(40.0 * random.get_1d() - 2.0, 22.0 * random.get_1d() - 2.0);
            (at, 2f32.powf(40.0 * random.get_1d() - 20.0))
        })
        .collect();
    let all = |order: &mut dyn Iterator<Item = &(Vec2, f32)>| {
        let mut film = film(FilterDesc::Triangle { radius: [2.0, 2.0] });
        order.for_each(|&(at, l)| splat(&mut film, at, l));
        count(&mut film, 250);
        film
    };
    let bits = |film: &Film| film.develop().unwrap().values().map(f32::to_bits).collect::<Vec<_>>();
    let (first, second) = splats.split_at(200);
    let mut backward = all(&mut splats.iter().rev());
    let mut merged = all(&mut second.iter());
    merged.merge(&all(&mut first.iter())).unwrap();
    let mut whole = all(&mut splats.iter());
    count(&mut whole, 250);
    assert_eq!(bits(&merged), bits(&whole), "paths are added, too");
    let parts = [&second, &first].map(|part| all(&mut part.iter()));
    let both = Development::of_colors(&parts[0], Some(&parts[1])).to_image().unwrap();
    assert!(both.values().map(f32::to_bits).eq(bits(&whole)), "without merging");
    count(&mut backward, 250);
    assert_eq!(bits(&backward), bits(&whole));
}

#[test]
fn invalid_light_and_positions_off_the_film_are_left_out() {
    let mut film = film(FilterDesc::Box { radius: [0.5, 0.5] });
    count(&mut film, 1);
    splat(&mut film, Vec2::new(5.0, 5.0), f32::NAN);
    splat(&mut film, Vec2::new(5.0, 5.0), f32::INFINITY);
    assert_eq!(film.rejected().count, 2);
    for at in [Vec2::NAN, Vec2::splat(f32::INFINITY), Vec2::splat(-1e30), Vec2::new(36.0, 5.0)] {
        splat(&mut film, at, 1.0);
        assert!(!film.tiles_and_splatter().unwrap().1.reach().contains(at));
    }
    assert_eq!(film.rejected().count, 2);
    assert!(film.develop().unwrap().values().all(|value| value == 0.0));
}
