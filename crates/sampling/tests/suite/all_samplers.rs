//! The contract of all samplers: values in [0, 1), replay, unbiased means, less variance than
//! independent samples, independent dimensions.

use alhazen_sampling::Sampler;
use alhazen_sampling::sampler::*;
use math::Vec2;
use std::collections::HashSet;
use std::f64::consts::TAU;
use testkit::{Chi2, Moments, assert_complete, t_test};

const SPP: u32 = 16;
const RESOLUTION: [i32; 2] = [20, 13];
const EACH_RANDOMIZE: [Randomize; 3] = [Randomize::PermuteDigits, Randomize::FastOwen, Randomize::Owen];

/// The sampler besides `independent` whose samples are independent.
const PRIMARY: &str = "primary sample";

/// Makes a sampler with a number of samples per pixel and a seed.
type Make = Box<dyn Fn(u32, u32) -> Sampler>;

/// Every sampler with every randomization.
fn makers() -> Vec<(String, Make)> {
    let mut makers: Vec<(String, Make)> = vec![
        ("independent".into(), Box::new(|spp, seed| Sampler::Independent(Independent::new(spp, seed)))),
        (
            "stratified".into(),
            Box::new(|spp, seed| {
                let side = spp.isqrt();
                Sampler::Stratified(Stratified::new([side, spp / side], true, seed))
            }),
        ),
    ];
    let primary: Make = Box::new(|spp, seed| Sampler::PrimarySample(PrimarySample::new(spp, 0.01, seed)));
    makers.push((PRIMARY.into(), primary));
    makers.push(("pmj02bn".into(), Box::new(|n, seed| Sampler::Pmj02Bn(Pmj02Bn::new(n, seed)))));
    let halton: Make = Box::new(|n, seed| Sampler::Halton(Halton::new(n, Randomize::None, seed)));
    makers.push(("halton None".into(), halton));
    for r in EACH_RANDOMIZE {
        let mut add = |name: &str, make: Make| makers.push((format!("{name} {r:?}"), make));
        add("halton", Box::new(move |n, seed| Sampler::Halton(Halton::new(n, r, seed))));
        add("padded sobol", Box::new(move |n, seed| Sampler::PaddedSobol(PaddedSobol::new(n, r, seed))));
        add("sobol", Box::new(move |n, seed| Sampler::Sobol(Sobol::new(n, RESOLUTION, r, seed))));
        add("zsobol", Box::new(move |n, seed| Sampler::ZSobol(ZSobol::new(n, RESOLUTION, r, seed))));
    }
    makers
}

fn random_samplers(spp: u32, seed: u32) -> Vec<(String, Sampler)> {
    makers().into_iter().map(|(name, make)| (name, make(spp, seed))).collect()
}

fn all_samplers(spp: u32, seed: u32) -> Vec<(String, Sampler)> {
    let mut samplers = random_samplers(spp, seed);
    let mut add = |name: &str, sampler| samplers.push((name.into(), sampler));
    add("stratified middles", Sampler::Stratified(Stratified::new([4, spp / 4], false, seed)));
    add("padded sobol None", Sampler::PaddedSobol(PaddedSobol::new(spp, Randomize::None, seed)));
    add("sobol None", Sampler::Sobol(Sobol::new(spp, RESOLUTION, Randomize::None, seed)));
    add("zsobol None", Sampler::ZSobol(ZSobol::new(spp, RESOLUTION, Randomize::None, seed)));
    samplers
}

#[test]
fn every_sampler_is_tested() {
    let samplers = all_samplers(SPP, 0);
    assert_complete(Sampler::MEMBERS, samplers.iter().map(|(_, sampler)| sampler.member()));
}

/// The dimensions that a path might use.
fn draw(sampler: &mut Sampler, pixel: [i32; 2], index: u32) -> Vec<f32> {
    sampler.start_pixel_sample(pixel, index, 0);
    let mut values = sampler.get_pixel_2d().to_array().to_vec();
    for _ in 0..5 {
        values.push(sampler.get_1d());
        values.extend(sampler.get_2d().to_array());
    }
    values
}

#[test]
fn values_are_in_the_unit_interval() {
    for (name, mut sampler) in all_samplers(SPP, 3) {
        let pixels = [[0, 0], [19, 12], [1919, 1079], [-3, -200], [i32::MAX, i32::MIN]];
        for pixel in pixels {
            for index in [0, 1, SPP - 1, SPP, 1000, u32::MAX] {
                let values = draw(&mut sampler, pixel, index);
                assert!(
                    values.iter().all(|v| (0.0..1.0).contains(v)),
                    "{name} {pixel:?} {index}: {values:?}"
                );
            }
        }
        sampler.start_pixel_sample([1, 1], 1, 0);
        for _ in 0..3000 {
            let p = sampler.get_2d();
            assert!((0.0..1.0).contains(&p.x) && (0.0..1.0).contains(&p.y), "{name}: {p}");
        }
    }
}

#[test]
fn samples_can_be_replayed_in_any_order() {
    for ((name, mut a), (_, mut b)) in all_samplers(SPP, 5).into_iter().zip(all_samplers(SPP, 5)) {
        let forward: Vec<_> = (0..40).map(|i| draw(&mut a, [i % 20, i / 20], i as u32)).collect();
        let mut c = a.clone();
        for i in (0..40).rev() {
            let expected = &forward[i as usize];
            assert_eq!(&draw(&mut b, [i % 20, i / 20], i as u32), expected, "{name}");
            assert_eq!(&draw(&mut c, [i % 20, i / 20], i as u32), expected, "{name}");
        }
    }
}

#[test]
fn seeds_and_pixels_differ() {
    for ((name, mut a), (_, mut b)) in random_samplers(SPP, 1).into_iter().zip(random_samplers(SPP, 2)) {
        let values = draw(&mut a, [4, 5], 3);
        assert_ne!(values, draw(&mut b, [4, 5], 3), "{name}: seed");
        assert_ne!(values, draw(&mut a, [5, 5], 3), "{name}: pixel");
        assert_ne!(values, draw(&mut a, [4, 5], 4), "{name}: index");
    }
}

/// Scrambles may be shared by all pixels, so that two seeds may be correlated; over pairs of seeds
/// the mean correlation, each of which lies in [−1, 1], is zero.
#[test]
fn positions_in_a_pixel_of_different_seeds_are_uncorrelated() {
    const PAIRS: u32 = 256;
    let mut sums = vec![0.0; random_samplers(SPP, 0).len()];
    for seed in 0..PAIRS {
        let pairs = random_samplers(SPP, 2 * seed).into_iter().zip(random_samplers(SPP, 2 * seed + 1));
        for (sum, ((_, mut a), (_, mut b))) in sums.iter_mut().zip(pairs) {
            let products = (0..SPP).map(|index| {
                let [p, q] = [&mut a, &mut b].map(|sampler| {
                    sampler.start_pixel_sample([3, 5], index, 0);
                    sampler.get_pixel_2d().as_dvec2() - 0.5
                });
                p.dot(q)
            });
            // The mean of p·q is 1/6 where positions are equal.
            *sum += 6.0 * products.sum::<f64>() / f64::from(SPP);
        }
    }
    for ((name, _), sum) in random_samplers(SPP, 0).into_iter().zip(sums) {
        let mean = sum / f64::from(PAIRS);
        assert!(mean.abs() < 5.0 / f64::from(PAIRS).sqrt(), "{name}: {mean}");
    }
}

#[test]
fn sample_counts_are_as_requested() {
    for (name, sampler) in random_samplers(12, 0) {
        assert_eq!(sampler.samples_per_pixel(), 12, "{name}");
    }
}

#[test]
fn a_number_that_is_no_power_of_two_begins_the_samples_of_the_next_one() {
    for ((name, mut few), (_, mut all)) in random_samplers(12, 3).into_iter().zip(random_samplers(16, 3)) {
        if ["sobol", "zsobol", "pmj02bn", "halton"].iter().any(|start| name.starts_with(start)) {
            for index in 0..40 {
                assert_eq!(draw(&mut few, [4, 5], index), draw(&mut all, [4, 5], index), "{name} {index}");
            }
        }
    }
}

/// A smooth function of a 2-d, a 1-d and a 2-d coordinate, with integral 1.
fn smooth(sampler: &mut Sampler) -> f64 {
    let p = sampler.get_2d().as_dvec2();
    let x = sampler.get_1d() as f64;
    let q = sampler.get_2d().as_dvec2();
    (4.0 * p.x * p.y) * (1.5 - x) * (1.0 + 0.5 * (TAU * q.x).sin() * q.y)
}

/// The mean of [`smooth`] over `count` samples of a pixel from `first` on.
fn estimate(sampler: &mut Sampler, pixel: [i32; 2], first: u32, count: u32) -> f64 {
    let value = |index| {
        sampler.start_pixel_sample(pixel, index, 0);
        sampler.get_pixel_2d();
        smooth(sampler)
    };
    (first..first + count).map(value).sum::<f64>() / f64::from(count)
}

/// An [`estimate`] for each of many pixels and seeds.
fn estimates(make: &Make, spp: u32, first: u32, count: u32) -> Moments {
    let mut moments = Moments::default();
    for seed in 0..60 {
        let mut sampler = make(spp, seed);
        for pixel in [[0, 0], [3, 1], [19, 12], [7, 7], [200, 90]] {
            moments.push(estimate(&mut sampler, pixel, first, count));
        }
    }
    moments
}

#[test]
fn means_are_right_within_and_beyond_the_count() {
    let makers = makers();
    for (name, make) in &makers {
        for (first, count) in [(0, SPP), (0, 5), (SPP, SPP), (3 * SPP + 1, 20)] {
            let moments = estimates(make, SPP, first, count);
            t_test(&moments, 1.0, 4 * makers.len()).unwrap_or_else(|e| panic!("{name} {first} {count}: {e}"));
        }
    }
}

#[test]
fn stratified_and_low_discrepancy_samples_have_less_variance() {
    let makers = makers();
    for spp in [16, 64] {
        let independent = estimates(&makers[0].1, spp, 0, spp).variance();
        for (name, make) in makers[1..].iter().filter(|(name, _)| name != PRIMARY) {
            let variance = estimates(make, spp, 0, spp).variance();
            assert!(variance < 0.5 * independent, "{name}, {spp} samples: {variance} and {independent}");
        }
    }
}

/// Pixels that share points or scrambles err alike, so that the mean square error of a picture
/// varies more from seed to seed than that of independent pixels. [`Sobol`], [`ZSobol`] and
/// [`Pmj02Bn`] distribute their points over all pixels.
#[test]
fn errors_of_pixels_are_independent() {
    const SEEDS: u32 = 400;
    const PIXELS: i32 = 64;
    let shares_points =
        |name: &str| ["sobol", "zsobol", "pmj02bn"].iter().any(|start| name.starts_with(start));
    for (name, make) in makers().iter().filter(|(name, _)| !shares_points(name)) {
        let (mut of_pixels, mut of_pictures) = (Moments::default(), Moments::default());
        for seed in 0..SEEDS {
            let mut sampler = make(SPP, seed);
            let mut picture = Moments::default();
            for pixel in (0..PIXELS).map(|i| [i % 8, i / 8]) {
                let square = (estimate(&mut sampler, pixel, 0, SPP) - 1.0).powi(2);
                of_pixels.push(square);
                picture.push(square);
            }
            of_pictures.push(picture.mean);
        }
        let ratio = of_pictures.variance() * f64::from(PIXELS) / of_pixels.variance();
        assert!((0.6..1.5).contains(&ratio), "{name}: {ratio} times the variance of independent pixels");
    }
}

#[test]
fn variance_decreases_beyond_the_planned_count() {
    for (name, make) in makers() {
        let one = estimates(&make, SPP, 0, SPP).variance();
        let eight = estimates(&make, SPP, 0, 8 * SPP).variance();
        assert!(eight < one / 4.0, "{name}: {one} and {eight}");
    }
}

#[test]
fn dimensions_are_independent() {
    let makers = makers();
    for (name, make) in &makers {
        // Pairs of dimensions of different calls, one pair per seed, so that they are independent.
        let mut pairs = Vec::new();
        for seed in 0..6000 {
            let mut sampler = make(SPP, seed);
            let values = draw(&mut sampler, [seed as i32 % 20, 3], seed % SPP);
            pairs.push([values[2], values[5]]);
        }
        let test = Chi2 { bins: [8, 8], samples: pairs.len(), tests: makers.len(), ..Chi2::default() };
        test.rectangle([[0.0, 1.0]; 2], |_| pairs.pop(), |_| 1.0).unwrap_or_else(|e| panic!("{name}: {e}"));
    }
}

/// Whether 2^bits points have one in each cell of every grid of 2^i × 2^(bits − i) cells.
fn fill_elementary_intervals(points: &[Vec2]) -> bool {
    let bits = points.len().ilog2();
    (0..=bits).all(|i| {
        let [columns, rows] = [1u32 << i, 1 << (bits - i)];
        let cells: HashSet<[u32; 2]> =
            points.iter().map(|p| [(p.x * columns as f32) as u32, (p.y * rows as f32) as u32]).collect();
        cells.len() == points.len()
    })
}

fn points(sampler: &mut Sampler, indices: std::ops::Range<u32>, skipped: usize) -> Vec<Vec2> {
    let draw = |index| {
        sampler.start_pixel_sample([7, 11], index, 0);
        (0..skipped).for_each(|_| {
            sampler.get_1d();
        });
        sampler.get_2d()
    };
    indices.map(draw).collect()
}

#[test]
fn sobol_points_stratify_elementary_intervals() {
    for (name, mut sampler) in all_samplers(64, 9) {
        if ["padded", "zsobol", "pmj02bn"].iter().any(|start| name.starts_with(start)) {
            for skipped in [0, 1, 4] {
                assert!(fill_elementary_intervals(&points(&mut sampler, 0..64, skipped)), "{name}");
                assert!(
                    fill_elementary_intervals(&points(&mut sampler, 64..128, skipped)),
                    "{name}, second round"
                );
            }
        }
        if name == "independent" {
            assert!(!fill_elementary_intervals(&points(&mut sampler, 0..64, 0)));
        }
    }
}

#[test]
fn every_prefix_of_pmj02bn_stratifies_elementary_intervals() {
    for (seed, spp) in [(0, 256), (1, 64), (2, 1 << 20)] {
        let mut sampler = Sampler::Pmj02Bn(Pmj02Bn::new(spp, seed));
        for (skipped, k) in [0, 1, 4].into_iter().flat_map(|skipped| (0..=8).map(move |k| (skipped, k))) {
            // Each aligned block of samples, too.
            for block in (0..4).filter(|block| (block + 1) << k <= spp) {
                let indices = block << k..(block + 1) << k;
                assert!(
                    fill_elementary_intervals(&points(&mut sampler, indices.clone(), skipped)),
                    "{indices:?}"
                );
            }
        }
    }
}

/// The first samples of the pixels of squares along a Z-order curve.
#[test]
fn squares_of_pixels_of_pmj02bn_stratify_elementary_intervals() {
    let mut sampler = Sampler::Pmj02Bn(Pmj02Bn::new(16, 4));
    for (corner, side) in [([6, 4], 2), ([-8, 16], 4)] {
        let pixels = (0..side * side).map(|i| [corner[0] + i % side, corner[1] + i / side]);
        let samples = pixels.flat_map(|pixel| (0..16).map(move |index| (pixel, index)));
        let draw = |(pixel, index)| {
            sampler.start_pixel_sample(pixel, index, 3);
            sampler.get_2d()
        };
        assert!(fill_elementary_intervals(&samples.map(draw).collect::<Vec<_>>()));
    }
}

/// The mean over `spp` samples of a pixel of functions of the unit square: a smooth one, and one
/// with an edge. Both integrals are 1.
fn plane_estimates(sampler: &mut Sampler, pixel: [i32; 2], spp: u32) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for index in 0..spp {
        sampler.start_pixel_sample(pixel, index, 0);
        let p = sampler.get_pixel_2d().as_dvec2();
        let is_in_disk = (p - 0.5).length_squared() < 0.25;
        sums[0] += 4.0 * p.x * p.y;
        sums[1] += if is_in_disk { 8.0 / TAU } else { 0.0 };
    }
    sums.map(|sum| sum / f64::from(spp))
}

/// The mean square error of a picture of [`plane_estimates`], and the mean power of the error at up
/// to four periods along a side of 64 pixels, as a share of that of white noise.
fn plane_errors(make: &Make, spp: u32) -> [[f64; 2]; 2] {
    const SIDE: i32 = 64;
    let frequencies: Vec<_> =
        (-4..=4).flat_map(|u| (-4..=4).map(move |v| [u, v])).filter(|&f| f != [0, 0]).collect();
    let (mut squares, mut powers) = ([0.0; 2], [0.0; 2]);
    for seed in 0..4 {
        let mut sampler = make(spp, seed);
        let mut waves = vec![[[0.0; 2]; 2]; frequencies.len()];
        for [x, y] in (0..SIDE * SIDE).map(|i| [i % SIDE, i / SIDE]) {
            // Off the corners of the squares that share points.
            let errors = plane_estimates(&mut sampler, [x + 5, y + 3], spp).map(|estimate| estimate - 1.0);
            for (function, error) in errors.into_iter().enumerate() {
                squares[function] += error * error;
                for ([u, v], wave) in frequencies.iter().zip(&mut waves) {
                    let (sin, cos) = (TAU * f64::from(u * x + v * y) / f64::from(SIDE)).sin_cos();
                    wave[function][0] += error * cos;
                    wave[function][1] += error * sin;
                }
            }
        }
        for (wave, function) in waves.iter().flat_map(|wave| [(wave[0], 0), (wave[1], 1)]) {
            powers[function] += (wave[0] * wave[0] + wave[1] * wave[1]) / frequencies.len() as f64;
        }
    }
    [0, 1].map(|function| {
        [squares[function] / f64::from(4 * SIDE * SIDE), powers[function] / squares[function]]
    })
}

/// The shares are 0.1 and 0.3 to 0.4.
#[test]
fn low_frequencies_of_the_error_of_pmj02bn_are_weak() {
    let makers = makers();
    let errors = |name: &str, spp: u32| {
        let (_, make) = makers.iter().find(|(member, _)| member == name).expect("a member");
        plane_errors(make, spp)
    };
    for spp in [1, 4, 16, 64] {
        let [smooth, edge] = errors("pmj02bn", spp);
        assert!(smooth[1] < 0.15 && edge[1] < 0.5, "{spp} samples: {smooth:?}, {edge:?}");
        let [other_smooth, other_edge] = errors("stratified", spp);
        assert!(other_smooth[1] > 0.75 && other_edge[1] > 0.75, "{spp} samples, stratified");
        if spp > 1 {
            assert!(smooth[0] < 0.7 * other_smooth[0] && edge[0] < 0.9 * other_edge[0], "{spp} samples");
        }
        if spp > 4 {
            assert!(smooth[0] < 0.25 * other_smooth[0], "{spp} samples");
        }
    }
}

#[test]
fn sobol_pixel_samples_stratify_elementary_intervals() {
    let mut sampler = Sampler::Sobol(Sobol::new(64, RESOLUTION, Randomize::None, 0));
    let points: Vec<Vec2> = (0..64)
        .map(|index| {
            sampler.start_pixel_sample([7, 11], index, 0);
            sampler.get_pixel_2d()
        })
        .collect();
    assert!(fill_elementary_intervals(&points));
}

#[test]
fn stratified_samples_have_one_sample_per_cell() {
    for jitter in [true, false] {
        let mut sampler = Sampler::Stratified(Stratified::new([5, 3], jitter, 4));
        for round in 0..3 {
            let points = points(&mut sampler, 15 * round..15 * (round + 1), 2);
            let cells: HashSet<[u32; 2]> =
                points.iter().map(|p| [(p.x * 5.0) as u32, (p.y * 3.0) as u32]).collect();
            assert_eq!(cells.len(), 15);
        }
        let mut line = HashSet::new();
        for index in 0..15 {
            sampler.start_pixel_sample([2, 2], index, 6);
            line.insert((sampler.get_1d() * 15.0) as u32);
        }
        assert_eq!(line.len(), 15);
    }
}

#[test]
fn addresses_give_what_draws_give() {
    for (name, mut sampler) in all_samplers(SPP, 7) {
        if name == PRIMARY {
            continue;
        }
        let again = sampler.clone();
        for (pixel, index) in [([0, 0], 0), ([19, 12], 5), ([-3, 700], SPP + 2)] {
            sampler.start_pixel_sample(pixel, index, 0);
            let mut dimension = 0_u32;
            let mut address = |count| {
                dimension += count;
                Address { pixel: pixel.map(|x| x as u32), index, dimension: dimension - count }
            };
            assert_eq!(sampler.get_1d(), again.at_1d::<f32>(&address(1)), "{name}");
            assert_eq!(sampler.get_pixel_2d().to_array(), again.at_pixel_2d::<f32>(&address(2)), "{name}");
            // More than any sampler has.
            for _ in 0..700 {
                assert_eq!(sampler.get_1d(), again.at_1d::<f32>(&address(1)), "{name}");
                assert_eq!(sampler.get_2d().to_array(), again.at_2d::<f32>(&address(2)), "{name}");
            }
        }
    }
}
