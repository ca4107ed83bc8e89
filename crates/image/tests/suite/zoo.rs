//! Pictures of other programs, some against their means by OpenEXR's own library.

use alhazen_image::{Format, Image, ImageError, Pixels, ReadOptions, Window, read};

#[test]
fn every_valid_picture_loads() {
    let Some(data) = testkit::data("") else { return };
    let mut count = 0;
    for folder in ["images", "envmaps"] {
        for path in crate::common::files_below(&data.join(folder)) {
            let bytes = std::fs::read(&path).unwrap();
            if Format::from_content(&bytes).or_else(|| Format::from_name(&path.to_string_lossy())).is_none() {
                continue;
            }
            count += 1;
            match read(&bytes, &path.to_string_lossy(), &ReadOptions::default()) {
                Ok(image) => assert!(image.width() > 0),
                Err(error @ ImageError::Unsupported(_)) => eprintln!("{}: {error}", path.display()),
                Err(error) => panic!("{}: {error}", path.display()),
            }
        }
    }
    assert!(count > 130, "{count}");
}

/// The mean colour.
fn mean(image: &Image) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for y in 0..image.height() {
        for x in 0..image.width() {
            image.rgb(x, y).into_iter().zip(&mut sum).for_each(|(value, sum)| *sum += f64::from(value));
        }
    }
    sum.map(|sum| sum / f64::from(image.width() * image.height()))
}

#[test]
fn every_compression_means_the_same_picture() {
    let Some(data) = testkit::data("") else { return };
    const EXACT: [f64; 3] = [118.9307, 144.0682, 207.8686];
    const HALVES: [f64; 3] = [118.9378, 144.0852, 207.8640];
    for (file, expected) in [
        ("f32/rle", EXACT),
        ("f32/zip", EXACT),
        ("f32/piz", EXACT),
        ("f32/b44", EXACT),
        ("f32/dwaa", [118.9865, 144.0988, 207.5756]),
        ("f16/rle", HALVES),
        ("f16/zip", HALVES),
        ("f16/piz", HALVES),
        ("f16/b44", [125.0085, 151.2103, 216.6967]),
    ] {
        let image = alhazen_image::open(data.join(format!("images/exr-methods/{file}.exr"))).unwrap();
        assert_eq!(matches!(image.pixels(), Pixels::F16(_)), file.starts_with("f16"), "{file}");
        for (found, expected) in mean(&image).into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-3 * expected, "{file}: {found} is not {expected}");
        }
    }
}

#[test]
fn windows_are_kept_apart() {
    let Some(data) = testkit::data("") else { return };
    let image = alhazen_image::open(data.join("images/exr/t05.exr")).unwrap();
    assert_eq!(image.data_window(), Window { min: [0, 0], max: [400, 300] });
    assert_eq!(image.display_window(), Window { min: [30, 20], max: [370, 280] });
}
