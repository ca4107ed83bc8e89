//! Spectral films: radiance by wavelength beside the colours.

use alhazen_film::{Development, Film, FilmFile, FilmHeader, FilmWriter, PassSet, ReadLimits, compile};
use description::{FilmKind, FilterDesc, SceneDesc};
use image::{Attribute, Format, Image, ReadOptions, WriteOptions, encode, read};
use math::Vec2;
use spectrum::{CIE_Y_INTEGRAL, SampledSpectrum, SampledWavelengths, Spectrum};
use testkit::Random;

const RESOLUTION: [i32; 2] = [21, 18];

fn film(buckets: i32, lambda_min: f32, lambda_max: f32) -> Film {
    let mut desc = SceneDesc::default();
    desc.film.resolution = RESOLUTION;
    desc.film.save_fp16 = false;
    desc.film.kind = FilmKind::Spectral { buckets, lambda_min, lambda_max };
    desc.filter.value = FilterDesc::Box { radius: [0.5, 0.5] };
    compile(&desc).expect("a film").film
}

/// The picture as a reader of its file sees it.
fn through_file(picture: &Development) -> Image {
    let bytes = encode(picture, Format::Exr, &WriteOptions::default()).unwrap();
    read(&bytes, "", &ReadOptions::default()).unwrap()
}

/// The values of a pixel's buckets.
fn buckets(film: &Film, [x, y]: [u32; 2]) -> Vec<f32> {
    let image = through_file(&film.development());
    let spectral = |name: &&String| name.starts_with("S0.");
    let names = image.channels().iter().filter(spectral);
    names.map(|name| image.channel(x, y, image.channel_index(name).unwrap())).collect()
}

fn light() -> Spectrum {
    Spectrum::from_pairs(&[(400.0, 1.0), (500.0, 3.0), (520.0, 0.5), (700.0, 2.0)]).unwrap()
}

/// The mean of [`light`] over each of eight buckets of 400 to 700 nm, in the scene's units.
fn means() -> Vec<f32> {
    let mean = |bucket: u32| {
        let at = |i: u32| light().at(400.0 + 37.5 * (bucket as f32 + (i as f32 + 0.5) / 1000.0));
        (0..1000).map(at).sum::<f32>() / 1000.0 * CIE_Y_INTEGRAL
    };
    (0..8).map(mean).collect()
}

fn assert_close(found: &[f32], expected: &[f32], tolerance: f32) {
    assert_eq!(found.len(), expected.len());
    let close = |(a, b): (&f32, &f32)| (a / b - 1.0).abs() < tolerance;
    assert!(found.iter().zip(expected).all(close), "{found:?} is not {expected:?}");
}

#[test]
fn buckets_are_the_means_of_a_known_spectrum() {
    const COUNT: u32 = 4000;
    for kind in 0..3 {
        let mut film = film(8, 400.0, 700.0);
        for i in 0..COUNT {
            let u = (i as f32 + 0.5) / COUNT as f32;
            let mut lambda = match kind {
                0 => SampledWavelengths::sample_uniform_in(u, 400.0, 700.0),
                _ => SampledWavelengths::sample_visible(u),
            };
            // Some paths give up all wavelengths but one.
            if kind == 2 && i % 3 == 0 {
                lambda.terminate_secondary();
            }
            film.add_sample([3, 4], &light().sample(&lambda), &lambda, 1.0);
        }
        assert_close(&buckets(&film, [3, 4]), &means(), 0.01);
        assert_eq!(buckets(&film, [4, 4]), [0.0; 8], "nothing arrived");
    }
}

#[test]
fn constant_light_has_no_noise_in_any_bucket() {
    let mut film = film(3, 450.0, 600.0);
    let mut random = Random::new(4);
    for _ in 0..64 {
        let lambda = SampledWavelengths::sample_uniform_in(random.get_1d(), 450.0, 600.0);
        film.add_sample([0, 0], &SampledSpectrum::splat(0.25), &lambda, 2.0 * random.get_1d());
    }
    assert_close(&buckets(&film, [0, 0]), &[0.25 * CIE_Y_INTEGRAL; 3], 1e-6);
}

#[test]
fn splats_fill_buckets_as_samples_do() {
    const COUNT: u32 = 16_000;
    let mut film = film(8, 400.0, 700.0);
    let (_, splatter) = film.tiles_and_splatter().unwrap();
    for i in 0..COUNT {
        let lambda = SampledWavelengths::sample_visible((i as f32 + 0.5) / COUNT as f32);
        splatter.add(Vec2::new(3.5, 4.5), &light().sample(&lambda), &lambda);
    }
    splatter.add_paths(COUNT.into());
    assert_close(&buckets(&film, [3, 4]), &means(), 0.01);
}

#[test]
fn the_file_has_the_spectral_layout_and_the_colours_of_an_rgb_film() {
    let mut spectral = film(16, 360.0, 830.0);
    let mut desc = SceneDesc::default();
    desc.film.resolution = RESOLUTION;
    desc.film.save_fp16 = false;
    desc.filter.value = FilterDesc::Box { radius: [0.5, 0.5] };
    let mut plain = compile(&desc).unwrap().film;
    for film in [&mut spectral, &mut plain] {
        (0..3).for_each(|pass| add_pass(film, pass));
    }
    let image = through_file(&spectral.development());
    let channels = image.channels();
    assert_eq!(channels[..3], ["R", "G", "B"]);
    assert_eq!((channels[3].as_str(), channels[18].as_str()), ("S0.374,688nm", "S0.815,312nm"));
    assert_eq!(channels.len(), 3 + 16);
    let text = |name: &str| image.metadata.get(name).cloned();
    assert_eq!(text("spectralLayoutVersion"), Some(Attribute::Text("1.0".into())));
    assert_eq!(text("emissiveUnits"), Some(Attribute::Text("W.m^-2.sr^-1".into())));
    let colors = |film: &Film| film.develop().unwrap().values().map(f32::to_bits).collect::<Vec<_>>();
    assert!(colors(&spectral) == colors(&plain));
}

#[test]
fn limited_samples_are_limited_in_all_buckets() {
    let mut desc = SceneDesc::default();
    desc.film.resolution = RESOLUTION;
    desc.film.save_fp16 = false;
    desc.film.kind = FilmKind::Spectral { buckets: 4, lambda_min: 400.0, lambda_max: 700.0 };
    let lambda = SampledWavelengths::sample_uniform_in(0.1, 400.0, 700.0);
    let seen = |desc: &SceneDesc| {
        let mut film = compile(desc).unwrap().film;
        film.add_sample([0, 0], &SampledSpectrum::splat(5.0), &lambda, 1.0);
        (film.develop().unwrap().rgb(0, 0)[1], buckets(&film, [0, 0])[2])
    };
    let (color, bucket) = seen(&desc);
    desc.film.max_component_value = 1.0;
    let (limited, limited_bucket) = seen(&desc);
    assert!(limited < 0.1 * color);
    assert!((limited_bucket / bucket / (limited / color) - 1.0).abs() < 1e-5);
}

/// Adds samples and splats of this pass, some of which are refused.
fn add_pass(film: &mut Film, pass: u32) {
    let mut random = Random::new(u64::from(pass));
    for _ in 0..100 {
        let pixel = RESOLUTION.map(|size| (random.get_1d() * size as f32) as i32);
        let magnitude = 2f32.powf(50.0 * random.get_1d() - 25.0);
        let l = SampledSpectrum::new([(); 4].map(|()| magnitude * random.get_1d()));
        let l = if random.get_1d() < 0.02 { SampledSpectrum::splat(f32::NAN) } else { l };
        let lambda = SampledWavelengths::sample_uniform(random.get_1d());
        film.add_sample(pixel, &l, &lambda, 2.0 * random.get_1d() - 0.5);
        let at = Vec2::new(pixel[0] as f32 + random.get_1d(), pixel[1] as f32 + random.get_1d());
        film.tiles_and_splatter().expect("memory").1.add(at, &l, &lambda);
    }
    film.tiles_and_splatter().expect("memory").1.add_paths(100);
}

fn bits(picture: &Development) -> Vec<u32> {
    through_file(picture).values().map(f32::to_bits).collect()
}

#[test]
fn order_merging_and_files_do_not_change_a_bit() {
    // More sums in a tile than 16 bits count.
    let blank = || film(300, 360.0, 830.0);
    let of = |passes: &[u32]| {
        passes.iter().fold(blank(), |mut film, &pass| {
            add_pass(&mut film, pass);
            film
        })
    };
    let whole = of(&[0, 1, 2, 3, 4, 5]);
    let expected = bits(&whole.development());
    let parts = [of(&[2, 0, 1]), of(&[5, 3, 4])];
    let mut merged = whole.blank().unwrap();
    parts.iter().for_each(|part| merged.merge(part).unwrap());
    assert!(bits(&merged.development()) == expected);
    assert!(bits(&Development::of_all(&parts[0], Some(&parts[1]))) == expected, "without merging");

    let files = [0, 1].map(|part| {
        let done = PassSet::from(3 * part..3 * part + 3);
        let header = FilmHeader { scene_hash: [0; 32], settings: String::new(), seed: 0, planned: 6, done };
        FilmWriter::new(Vec::new(), &header, &parts[part as usize]).unwrap().finish().unwrap()
    });
    let limits = ReadLimits::for_file(files[1].len() as u64);
    let mut file = FilmFile::read(&files[1][..], &limits).unwrap();
    file.merge(&files[0][..], &limits).unwrap();
    assert!(bits(&file.picture.development()) == expected);
    // A film of 300 buckets of 24 bytes, and 12 for splats.
    let needed = 21 * 18 * (52 + 36 + 300 * 36);
    let (less, enough) = (ReadLimits { max_bytes: needed - 1 }, ReadLimits { max_bytes: needed });
    assert!(FilmFile::read(&files[0][..], &less).is_err());
    assert!(FilmFile::read(&files[0][..], &enough).is_ok());
}
