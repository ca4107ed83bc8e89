//! What is written is read back.

use std::{fs, path::PathBuf};

use alhazen_image::{
    Attribute, Chromaticities, ColorEncoding, Format, Image, ImageError, Pixels, ReadOptions, SampleDepth,
    Window, WriteOptions, encode, open, read, write,
};
use proptest::{prelude::*, test_runner::RngSeed};

fn gradient(channels: usize) -> Image {
    let names = ["R", "G", "B", "A"];
    let values = (0..13 * 7 * channels).map(|i| (i % 97) as f32 / 96.0).collect();
    let names = if channels == 1 { &["Y"][..] } else { &names[..channels] };
    Image::new(13, 7, names.iter().copied(), Pixels::F32(values)).unwrap()
}

fn again(image: &Image, format: Format, depth: SampleDepth) -> Image {
    let bytes = encode(image, format, &WriteOptions { depth }).unwrap();
    read(&bytes, &format!("x.{}", format.extensions()[0]), &ReadOptions::default()).unwrap()
}

#[test]
fn the_same_picture_is_the_same_bytes() {
    let mut image = gradient(3);
    for name in ["camera", "integrator", "sampler", "samplesPerPixel", "seed", "a", "b", "software"] {
        image.metadata.set(name, Attribute::Text(format!("the {name}")));
    }
    for format in Format::ALL {
        let bytes = || encode(&image, format, &WriteOptions::default()).unwrap();
        let first = bytes();
        assert!((0..4).all(|_| bytes() == first), "{format:?}");
    }
    assert_eq!(
        again(&image, Format::Exr, SampleDepth::Natural).metadata.attributes,
        image.metadata.attributes
    );
}

#[track_caller]
fn assert_near(a: &Image, b: &Image, tolerance: f32) {
    assert_eq!((a.width(), a.height()), (b.width(), b.height()));
    for y in 0..a.height() {
        for x in 0..a.width() {
            for (a, b) in a.rgb(x, y).into_iter().zip(b.rgb(x, y)) {
                assert!((a - b).abs() <= tolerance, "({x}, {y}): {a} {b}");
            }
        }
    }
}

#[test]
fn eight_bits_are_kept_by_every_lossless_integer_format() {
    for format in [Format::Png, Format::Tga, Format::Bmp, Format::Qoi, Format::Webp, Format::Tiff] {
        for channels in [1, 3, 4] {
            let image = gradient(channels).to_u8(ColorEncoding::Srgb);
            let read = again(&image, format, SampleDepth::U8);
            assert!(matches!(read.pixels(), Pixels::U8(_, ColorEncoding::Srgb)), "{format:?}");
            assert_near(&image, &read, 0.0);
            if let (Some(a), Some(b)) = (image.alpha_index(), read.alpha_index()) {
                assert_eq!(image.channel(5, 3, a), read.channel(5, 3, b), "{format:?}");
            }
        }
    }
}

#[test]
fn sixteen_bits_and_floats_are_kept() {
    for channels in [1, 3, 4] {
        let image = gradient(channels);
        for format in [Format::Png, Format::Tiff] {
            assert_near(&image, &again(&image, format, SampleDepth::U16), 2e-5);
        }
        assert_near(&image, &again(&image, Format::Tiff, SampleDepth::F32), 0.0);
        assert_near(&image, &again(&image, Format::Pfm, SampleDepth::Natural), 0.0);
        assert_near(&image, &again(&image, Format::Exr, SampleDepth::Natural), 0.0);
        assert_near(&image, &again(&image, Format::Exr, SampleDepth::F16), 5e-4);
        assert_near(&image, &again(&image, Format::Hdr, SampleDepth::Natural), 0.01);
    }
}

#[test]
fn jpeg_loses_little() {
    let image = Image::from_fn(32, 16, ["R", "G", "B"], |x, y| [x as f32 / 31.0, y as f32 / 15.0, 0.3]);
    assert_near(&image, &again(&image, Format::Jpeg, SampleDepth::Natural), 0.06);
}

#[test]
fn a_depth_that_a_format_lacks_is_refused() {
    for (format, depth) in [
        (Format::Exr, SampleDepth::U8),
        (Format::Png, SampleDepth::F32),
        (Format::Bmp, SampleDepth::U16),
        (Format::Pfm, SampleDepth::F16),
    ] {
        assert!(matches!(
            encode(&gradient(3), format, &WriteOptions { depth }),
            Err(ImageError::Unsupported(_))
        ));
    }
}

#[test]
fn exr_keeps_windows_names_and_attributes() {
    let names = ["R", "G", "B", "A", "albedo.R", "N.X"];
    let mut image =
        Image::from_fn(5, 4, names, |x, y| std::array::from_fn(|c| (c as f32) * 100.0 + (y * 5 + x) as f32));
    let metadata = &mut image.metadata;
    metadata.chromaticities = Some(Chromaticities {
        red: [0.708, 0.292],
        green: [0.17, 0.797],
        blue: [0.131, 0.046],
        white: [0.3127, 0.329],
    });
    metadata.data_window = Some(Window { min: [3, 2], max: [8, 6] });
    metadata.display_window = Some(Window { min: [0, 0], max: [20, 10] });
    metadata.pixel_aspect = 2.0;
    metadata.set("software", Attribute::Text("alhazen".into()));
    metadata.set("samplesPerPixel", Attribute::Integer(64));
    metadata.set("renderTimeSeconds", Attribute::Float(1.5));
    metadata.set("layers", Attribute::TextList(vec!["a".into(), "b".into()]));
    metadata.set("up", Attribute::Vector(vec![0.0, 1.0, 0.0]));
    let matrix: Vec<f32> = (0..16).map(|i| i as f32).collect();
    for name in ["worldToCamera", "worldToNDC", "other"] {
        metadata.set(name, Attribute::Matrix(math::Mat4::from_cols_slice(&matrix)));
    }
    let read = again(&image, Format::Exr, SampleDepth::Natural);
    assert_eq!(read.channels()[..4], names[..4]);
    for (c, name) in names.iter().enumerate() {
        let index = read.channel_index(name).unwrap();
        assert_eq!(read.channel(4, 3, index), image.channel(4, 3, c), "{name}");
    }
    assert_eq!(read.metadata, image.metadata);
}

#[test]
fn texts_of_exr_are_utf_8() {
    let values = Pixels::F32(vec![0.5; 12]);
    let mut image = Image::new(2, 2, ["lights.木.R", "lights.木.G", "lights.木.B"], values).unwrap();
    image.metadata.set("names", Attribute::Text("gl#s, 木".into()));
    let bytes = encode(&image, Format::Exr, &WriteOptions::default()).unwrap();
    let place = |bytes: &[u8], text: &[u8]| bytes.windows(text.len()).position(|window| window == text);
    assert!(place(&bytes, "\0lights.木.R\0".as_bytes()).is_some());
    let read_back = read(&bytes, "x.exr", &ReadOptions::default()).unwrap();
    assert_eq!(read_back.channels(), image.channels());
    assert_eq!(read_back.metadata.attributes, image.metadata.attributes);
    // What some programs write is Latin-1.
    image.metadata.set("names", Attribute::Text("gl#s".into()));
    let mut bytes = encode(&image, Format::Exr, &WriteOptions::default()).unwrap();
    let start = place(&bytes, b"gl#s").unwrap();
    bytes[start + 2] = 0xe4;
    let read_back = read(&bytes, "x.exr", &ReadOptions::default()).unwrap();
    assert_eq!(read_back.metadata.get("names"), Some(&Attribute::Text("gläs".into())));
}

#[test]
fn a_window_of_the_wrong_size_is_refused() {
    let mut image = gradient(3);
    image.metadata.data_window = Some(Window { min: [0, 0], max: [3, 3] });
    assert!(encode(&image, Format::Exr, &WriteOptions::default()).is_err());
}

#[test]
fn a_crop_keeps_its_window() {
    let crop = gradient(3).crop(Window { min: [2, 1], max: [6, 4] }).unwrap();
    assert_eq!((crop.width(), crop.height()), (4, 3));
    assert_eq!(crop.rgb(0, 0), gradient(3).rgb(2, 1));
    let read = again(&crop, Format::Exr, SampleDepth::Natural);
    assert_eq!(read.data_window(), Window { min: [2, 1], max: [6, 4] });
    assert_eq!(read.display_window(), Window { min: [0, 0], max: [13, 7] });
    assert!(gradient(3).crop(Window { min: [0, 0], max: [14, 7] }).is_err());
    assert!(gradient(3).crop(Window { min: [4, 4], max: [4, 5] }).is_err());
}

/// A temporary folder, removed when it is dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("alhazen-image-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        fs::remove_dir_all(&self.0).unwrap();
    }
}

#[test]
fn files_are_written_atomically() {
    let folder = Folder::new("write");
    for format in Format::ALL {
        let path = folder.0.join(format!("picture.{}", format.extensions()[0]));
        for _ in 0..2 {
            write(&gradient(3), &path, &WriteOptions::default()).unwrap();
        }
        assert_eq!(open(&path).unwrap().width(), gradient(3).width());
    }
    assert_eq!(fs::read_dir(&folder.0).unwrap().count(), Format::ALL.len());
}

#[test]
fn a_failed_write_leaves_the_old_file() {
    let folder = Folder::new("fail");
    let path = folder.0.join("picture.exr");
    write(&gradient(3), &path, &WriteOptions::default()).unwrap();
    let old = fs::read(&path).unwrap();
    assert!(write(&gradient(1), &path, &WriteOptions { depth: SampleDepth::U8 }).is_err());
    assert_eq!(fs::read(&path).unwrap(), old);
    assert!(matches!(
        write(&gradient(1), folder.0.join("absent/x.png"), &WriteOptions::default()),
        Err(ImageError::Io(_))
    ));
    let unknown = write(&gradient(1), folder.0.join("x.avif"), &WriteOptions::default()).unwrap_err();
    assert!(unknown.to_string().contains("known are exr, png"), "{unknown}");
    assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 1);
}

#[cfg(unix)]
#[test]
fn symbolic_links_are_followed_and_kept() {
    let folder = Folder::new("link");
    fs::create_dir(folder.0.join("target")).unwrap();
    let [link, second, file] = ["link.exr", "second.exr", "target/file.exr"].map(|name| folder.0.join(name));
    std::os::unix::fs::symlink("target/file.exr", &link).unwrap();
    std::os::unix::fs::symlink(&link, &second).unwrap();
    for path in [&link, &second] {
        write(&gradient(3), path, &WriteOptions::default()).unwrap();
        assert!(fs::symlink_metadata(path).unwrap().is_symlink());
        assert_eq!(fs::read(path).unwrap(), fs::read(&file).unwrap());
        fs::remove_file(&file).unwrap();
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_named() {
    // Not a regular file, so it is written in place.
    let error = std::fs::write("/dev/full", [0; 64]).unwrap_err();
    assert_eq!(ImageError::from(error).to_string(), "the disk is full");
}

#[test]
fn the_encoding_asked_for_is_used() {
    let image = Image::new(1, 1, ["R", "G", "B"], Pixels::U8(vec![128; 3], ColorEncoding::Srgb)).unwrap();
    let bytes = encode(&image, Format::Png, &WriteOptions::default()).unwrap();
    for (encoding, expected) in [
        (None, 0.215_860_5),
        (Some(ColorEncoding::Linear), 128.0 / 255.0),
        (Some(ColorEncoding::Gamma(2.2)), 0.219_520_2),
    ] {
        let read = read(&bytes, "", &ReadOptions { encoding, ..ReadOptions::default() }).unwrap();
        assert!((read.rgb(0, 0)[0] - expected).abs() < 1e-5);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, rng_seed: RngSeed::Fixed(7), ..ProptestConfig::default() })]

    #[test]
    fn any_floats_survive_exr_and_pfm(
        width in 1u32..40, height in 1u32..40, seed in prop::collection::vec(any::<f32>(), 1..50),
    ) {
        let values = |count: usize| (0..count).map(|i| seed[i % seed.len()]).collect::<Vec<_>>();
        let image = Image::new(width, height, ["R", "G", "B"], Pixels::F32(values((width * height * 3) as usize))).unwrap();
        for format in [Format::Exr, Format::Pfm] {
            let read = again(&image, format, SampleDepth::F32);
            for (a, b) in image.values().zip(read.values()) {
                prop_assert!(a == b || a.is_nan() && b.is_nan(), "{} {}", a, b);
            }
        }
    }

    #[test]
    fn any_codes_survive_png(width in 1u32..40, height in 1u32..40, seed in prop::collection::vec(any::<u8>(), 1..50)) {
        let codes: Vec<u8> = (0..(width * height * 4) as usize).map(|i| seed[i % seed.len()]).collect();
        let image = Image::new(width, height, ["R", "G", "B", "A"], Pixels::U8(codes, ColorEncoding::Srgb)).unwrap();
        let read = again(&image, Format::Png, SampleDepth::Natural);
        prop_assert_eq!(image.pixels(), read.pixels());
    }
}
