//! Decoders on damaged, unusual and malicious files: an image or an error, in bounded time and
//! memory.

use std::time::{Duration, Instant};

use alhazen_image::{Format, Image, ImageError, Pixels, ReadOptions, WriteOptions, encode, read};
use proptest::{prelude::*, test_runner::RngSeed};

/// Reads a file within two seconds.
fn read_in_time(path: &std::path::Path) -> Result<Image, ImageError> {
    let bytes = std::fs::read(path).unwrap();
    let start = Instant::now();
    let result = read(&bytes, &path.to_string_lossy(), &ReadOptions::default());
    assert!(start.elapsed() < Duration::from_secs(2), "{} took {:?}", path.display(), start.elapsed());
    result
}

#[test]
fn malformed_files_end_in_an_image_or_an_error() {
    let Some(data) = testkit::data("") else { return };
    for folder in ["exr", "png", "tga", "bmp"] {
        for path in crate::common::files_below(&data.join("malformed").join(folder)) {
            let result = read_in_time(&path);
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            assert!(!(name.starts_with("invalid") && result.is_ok()), "{name} must be refused");
        }
    }
    // The peak of all these tests together, where the system reports it.
    if let Some(peak) = peak_memory() {
        assert!(peak < 1 << 30, "{peak} bytes");
    }
}

fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM"))?;
    line.split_whitespace().nth(1)?.parse::<u64>().ok().map(|kilobytes| kilobytes << 10)
}

#[test]
fn a_header_that_claims_too_much_is_refused_before_memory_is_taken() {
    let mut png = encode(&small(), Format::Png, &WriteOptions::default()).unwrap();
    png[16..24].copy_from_slice(&[0, 0, 0xff, 0xff, 0, 0, 0xff, 0xff]);
    assert!(read(&png, "", &ReadOptions::default()).is_err());
    let pfm = b"PF\n60000 60000\n-1\n1234";
    assert!(matches!(read(pfm, "", &ReadOptions::default()), Err(ImageError::Limits(_))));
    let options = ReadOptions { max_bytes: 100, ..ReadOptions::default() };
    for format in Format::ALL {
        let bytes = encode(&small(), format, &WriteOptions::default()).unwrap();
        let name = format!("x.{}", format.extensions()[0]);
        assert!(matches!(read(&bytes, &name, &options), Err(ImageError::Limits(_))), "{format:?}");
    }
}

#[test]
fn pictures_that_end_early_are_refused() {
    let color = small();
    let grey = color.select(&["R"]).unwrap();
    for format in Format::ALL {
        for image in [&color, &grey] {
            let bytes = encode(image, format, &WriteOptions::default()).unwrap();
            // A PNG ends with a mark, and a WebP with a byte that makes its length even. Pixels
            // that a JPEG lacks are grey.
            let needed = match format {
                Format::Png => bytes.len() - 12,
                Format::Jpeg => 300,
                Format::Webp => bytes.len() - 2,
                _ => bytes.len(),
            };
            for length in 0..needed {
                let name = format!("x.{}", format.extensions()[0]);
                let result = read(&bytes[..length], &name, &ReadOptions::default());
                assert!(result.is_err(), "{format:?} {length}");
            }
        }
    }
}

#[test]
fn files_without_a_format_are_refused() {
    for bytes in [&b""[..], b"hello", &[0; 100]] {
        assert!(matches!(read(bytes, "x.txt", &ReadOptions::default()), Err(ImageError::Unsupported(_))));
    }
}

fn small() -> Image {
    let values = (0..24 * 18 * 3).map(|i| ((i * 37) % 101) as f32 / 50.0).collect();
    Image::new(24, 18, ["R", "G", "B"], Pixels::F32(values)).unwrap()
}

/// Reads any bytes as a format: an image or an error, within two seconds.
fn assert_is_read_or_refused(bytes: &[u8], format: Format) {
    let start = Instant::now();
    if let Ok(image) = read(bytes, &format!("x.{}", format.extensions()[0]), &ReadOptions::default()) {
        assert!(image.values().count() > 0);
    }
    assert!(start.elapsed() < Duration::from_secs(2), "{format:?}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, rng_seed: RngSeed::Fixed(7), ..ProptestConfig::default() })]

    #[test]
    fn truncated_files_do_not_panic(part in 0.0f64..1.0) {
        for format in Format::ALL {
            let bytes = encode(&small(), format, &WriteOptions::default()).unwrap();
            assert_is_read_or_refused(&bytes[..(part * bytes.len() as f64) as usize], format);
        }
    }

    #[test]
    fn damaged_files_do_not_panic(damage in prop::collection::vec((0.0f64..1.0, any::<u8>()), 1..8)) {
        for format in Format::ALL {
            let mut bytes = encode(&small(), format, &WriteOptions::default()).unwrap();
            for &(at, value) in &damage {
                // Squared, so that headers are hit more often.
                let index = (at * at * bytes.len() as f64) as usize;
                bytes[index] = value;
            }
            assert_is_read_or_refused(&bytes, format);
        }
    }

    #[test]
    fn random_bytes_after_a_signature_do_not_panic(noise in prop::collection::vec(any::<u8>(), 0..400)) {
        for format in Format::ALL {
            let mut bytes = encode(&small(), format, &WriteOptions::default()).unwrap();
            bytes.truncate(8);
            bytes.extend(&noise);
            assert_is_read_or_refused(&bytes, format);
        }
    }
}
