//! The information read without decoding the pixels is what was written.

use alhazen_image::{
    Attribute, Format, Image, Pixels, Sample, SampleDepth, Window, WriteOptions, encode, info,
};

fn picture(channels: &[&str]) -> Image {
    let values = (0..6 * 4 * channels.len()).map(|i| i as f32 / 100.0).collect();
    Image::new(6, 4, channels.iter().copied(), Pixels::F32(values)).unwrap()
}

#[test]
fn every_format_reports_its_size_and_depth() {
    use SampleDepth::{F16, F32, Natural, U8, U16};
    for (format, depth, sample) in [
        (Format::Exr, F16, Sample::Float(16)),
        (Format::Exr, F32, Sample::Float(32)),
        (Format::Png, U8, Sample::Integer(8)),
        (Format::Png, U16, Sample::Integer(16)),
        (Format::Jpeg, Natural, Sample::Integer(8)),
        (Format::Hdr, Natural, Sample::SharedExponent),
        (Format::Tga, U8, Sample::Integer(8)),
        (Format::Pfm, Natural, Sample::Float(32)),
        (Format::Bmp, U8, Sample::Integer(8)),
        (Format::Qoi, U8, Sample::Integer(8)),
        (Format::Webp, U8, Sample::Integer(8)),
        (Format::Tiff, U16, Sample::Integer(16)),
        (Format::Tiff, F32, Sample::Float(32)),
    ] {
        let bytes = encode(&picture(&["R", "G", "B"]), format, &WriteOptions { depth }).unwrap();
        let told = info(&bytes, &format!("a.{}", format.extensions()[0])).unwrap();
        assert_eq!((told.format, told.layers.len()), (format, 1));
        assert_eq!(told.layers[0].data_window, Window::of_size(6, 4), "{format:?}");
        let mut channels = told.layers[0].channels.clone();
        channels.sort_by(|a, b| a.0.cmp(&b.0));
        assert_eq!(channels, ["B", "G", "R"].map(|name| (name.to_owned(), sample)), "{format:?}");
    }
}

#[test]
fn layers_windows_and_attributes_of_exr_are_reported() {
    let mut picture = picture(&["R", "G", "B", "A", "albedo.R", "albedo.G", "albedo.B", "depth.Z"]);
    picture.metadata.data_window = Some(Window { min: [10, 20], max: [16, 24] });
    picture.metadata.display_window = Some(Window::of_size(64, 48));
    picture.metadata.set("camera", Attribute::Text("orthographic".into()));
    let told = info(&encode(&picture, Format::Exr, &WriteOptions::default()).unwrap(), "").unwrap();
    let layers: Vec<_> =
        told.layers.iter().map(|layer| (layer.name.as_str(), layer.channels.len())).collect();
    assert_eq!(layers, [("", 4), ("albedo", 3), ("depth", 1)]);
    assert_eq!(told.layers[0].compression, Some("ZIP"));
    assert_eq!(told.layers[0].data_window, Window { min: [10, 20], max: [16, 24] });
    assert_eq!(told.display_window, Window::of_size(64, 48));
    assert_eq!(told.attributes["camera"], Attribute::Text("orthographic".into()));
}

#[test]
fn damaged_headers_are_errors() {
    for format in Format::ALL {
        let name = format!("a.{}", format.extensions()[0]);
        let bytes = encode(&picture(&["R", "G", "B"]), format, &WriteOptions::default()).unwrap();
        for length in 0..12.min(bytes.len()) {
            assert!(info(&bytes[..length], &name).is_err(), "{format:?} {length}");
        }
        for at in 0..bytes.len().min(300) {
            let mut damaged = bytes.clone();
            damaged[at] ^= 0xff;
            // It may still be a valid picture, but must not panic.
            let _ = info(&damaged, &name).is_ok();
        }
    }
}

#[cfg(unix)]
#[test]
fn files_are_replaced_through_symbolic_links() {
    let folder = std::env::temp_dir().join(format!("alhazen-links-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("store")).unwrap();
    let [link, second, target] = ["link", "second", "store/target"].map(|name| folder.join(name));
    std::os::unix::fs::symlink("store/target", &link).unwrap();
    std::os::unix::fs::symlink(&link, &second).unwrap();
    // First the link dangles, then it leads to a file.
    for text in ["one", "two"] {
        alhazen_image::replace_file(&second, text.as_bytes()).unwrap();
        assert_eq!(std::fs::read_to_string(&target).unwrap(), text);
        assert!(link.is_symlink() && second.is_symlink() && !target.is_symlink());
    }
    std::fs::remove_dir_all(folder).unwrap();
}
