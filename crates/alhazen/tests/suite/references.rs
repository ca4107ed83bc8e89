//! Scenes of Bitterli's collection against their reference pictures.
//!
//! Those were rendered in RGB, ours are spectral, which shifts the colour of multiply scattered
//! light in the Cornell box by some percent. So the box is rendered once per channel with
//! reflectances and emission as greys, where both must agree; and once as it is, against a mean by
//! spectral Mitsuba.

use std::path::PathBuf;

use crate::common::{Estimate, data, means, render_scene, render_text, shrunk};
use alhazen::Overrides;
use alhazen::image::{self, Image};

/// The scene's text and reference.
fn cornell_box() -> Option<(PathBuf, String, Image)> {
    let folder = data("pbrt-bitterli/cornell-box")?;
    let path = folder.join("scene-v4.pbrt");
    let text = std::fs::read_to_string(&path).expect("the scene is readable");
    let reference = image::open(folder.join("TungstenRender.exr")).expect("the reference is readable");
    Some((path, text, reference))
}

/// The text with each colour `"rgb name" [r g b]` replaced by the grey of one of its channels.
fn grey(text: &str, channel: usize) -> String {
    let mut parts = text.split("\"rgb ");
    let mut grey = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (name, rest) = part.split_once("[").expect("a list of numbers");
        let (colour, rest) = rest.split_once("]").expect("an end of the list");
        let value = colour.split_whitespace().nth(channel).expect("three numbers");
        grey += &format!("\"rgb {name}[{value} {value} {value}]{rest}");
    }
    grey
}

/// Settings for a picture with independent pixels.
fn settings(side: i32, samples: u32, seed: Option<i32>) -> Overrides {
    Overrides {
        resolution: Some([side, side]),
        samples_per_pixel: Some(samples),
        settings: vec![("sampler".into(), "independent".into())],
        seed,
        ..Overrides::default()
    }
}

#[test]
fn cornell_box_in_grey_per_channel() {
    let Some((_, text, reference)) = cornell_box() else { return };
    let small = shrunk(&reference, 16);
    for channel in 0..3 {
        let text = grey(&text, channel);
        let estimate = Estimate::new(4, |overrides| render_text(&text, &settings(64, 16, overrides.seed)));
        let expected = Image::from_fn(64, 64, ["R", "G", "B"], |x, y| [small.rgb(x, y)[channel]; 3]);
        let name = format!("channel {channel}");
        estimate.assert_mean([means(&expected)[0]; 3], 5e-4, 3, &name);
        // Near the light's edge, squares of pixels differ by the pixel filter.
        estimate.assert_parts(&expected, 16, 1e-2, 3, &name);
    }
}

/// By Mitsuba, with the same paths and colours as spectra.
const SPECTRAL_MEAN: [f64; 3] = [0.19498, 0.12675, 0.03487];

#[test]
fn cornell_box_with_spectra() {
    let Some((path, ..)) = cornell_box() else { return };
    let estimate = Estimate::new(4, |overrides| render_scene(&path, &settings(64, 16, overrides.seed)));
    estimate.assert_mean(SPECTRAL_MEAN, 2e-3, 1, "cornell box");
}

#[test]
#[ignore = "slow: 1024 samples for each of a million pixels, four times"]
fn cornell_box_at_full_size() {
    let Some((path, text, reference)) = cornell_box() else { return };
    let overrides = Overrides { samples_per_pixel: Some(1024), ..Overrides::default() };
    let assert_close = |found: f64, expected: f64| {
        assert!((found / expected - 1.0).abs() < 5e-3, "{found}, not {expected}");
    };
    for (channel, expected) in means(&reference).into_iter().enumerate() {
        assert_close(means(&render_text(&grey(&text, channel), &overrides))[channel], expected);
    }
    let found = means(&render_scene(&path, &overrides));
    found.into_iter().zip(SPECTRAL_MEAN).for_each(|(found, expected)| assert_close(found, expected));
}
