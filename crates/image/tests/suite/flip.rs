//! FLIP against the values that the authors' evaluator (`flip-evaluator`) gives for the same
//! formulas.

use alhazen_image::{
    Image,
    flip::{PIXELS_PER_DEGREE, hdr_flip, ldr_flip},
    linear_from_srgb,
};

const SIZE: (u32, u32) = (48, 32);

/// sRGB codes of a reference (`damage` false) with waves, a ramp and tiles, and of a test with a
/// dimmed channel, a disk and dots.
fn codes(x: u32, y: u32, damage: bool) -> [f32; 3] {
    let (fx, fy) = (x as f32, y as f32);
    let mut red = 0.5 + 0.5 * (0.3 * fx + 0.1 * fy).sin();
    let mut green = fx / (SIZE.0 - 1) as f32;
    let mut blue = ((x / 6 + y / 6) % 2) as f32 * 0.6 + 0.2;
    if damage {
        red *= 0.9;
        if (fx - 24.0).powi(2) + (fy - 16.0).powi(2) < 36.0 {
            blue = 0.9;
        }
        if (x * 7 + y * 13) % 11 < 1 {
            green = 1.0 - green;
        }
    }
    [red, green, blue]
}

fn picture(damage: bool, convert: impl Fn(u32, f32) -> f32) -> Image {
    Image::from_fn(SIZE.0, SIZE.1, ["R", "G", "B"], |x, y| codes(x, y, damage).map(|code| convert(x, code)))
}

fn near(found: f32, expected: f32) {
    assert!((found - expected).abs() < 2e-4, "{found} is not {expected}");
}

#[test]
fn ldr_agrees_with_the_authors() {
    let [reference, test] = [false, true].map(|damage| picture(damage, |_, code| linear_from_srgb(code)));
    let flip = ldr_flip(&reference, &test, PIXELS_PER_DEGREE).unwrap();
    near(flip.mean as f32, 0.354_969_17);
    for ((x, y), expected) in
        [((24, 16), 0.618_651_4), ((0, 0), 0.979_708_9), ((47, 31), 0.264_073), ((5, 10), 0.527_199_5)]
    {
        near(flip.map.channel(x, y, 0), expected);
    }
}

#[test]
fn hdr_agrees_with_the_authors() {
    let [reference, test] = [false, true]
        .map(|damage| picture(damage, |x, code| code * code * 20.0 * (0.05 + x as f32 / SIZE.0 as f32)));
    let flip = hdr_flip(&reference, &test, PIXELS_PER_DEGREE).unwrap();
    near(flip.mean as f32, 0.321_061_5);
    for ((x, y), expected) in
        [((24, 16), 0.609_159_3), ((0, 0), 0.959_299_3), ((47, 31), 0.256_388_1), ((5, 10), 0.490_479_7)]
    {
        near(flip.map.channel(x, y, 0), expected);
    }
}

#[test]
fn flip_of_extreme_pictures() {
    let picture = |color: [f32; 3]| Image::from_fn(20, 10, ["R", "G", "B"], |_, _| color);
    let (green, blue, black) = (picture([0.0, 1.0, 0.0]), picture([0.0, 0.0, 1.0]), picture([0.0; 3]));
    assert_eq!(ldr_flip(&green, &green, PIXELS_PER_DEGREE).unwrap().mean, 0.0);
    near(ldr_flip(&green, &blue, PIXELS_PER_DEGREE).unwrap().mean as f32, 1.0);
    assert_eq!(hdr_flip(&black, &black, PIXELS_PER_DEGREE).unwrap().mean, 0.0);
    assert!(hdr_flip(&black, &green, PIXELS_PER_DEGREE).unwrap().mean > 0.5);
}

#[test]
fn invalid_values_give_finite_errors() {
    let good = Image::from_fn(8, 8, ["Y"], |x, _| [x as f32]);
    let bad = Image::from_fn(8, 8, ["Y"], |x, y| {
        [[f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, 1e30, f32::MIN_POSITIVE, 0.0, 1.0]
            [((x + y) % 8) as usize]]
    });
    for (reference, test) in [(&good, &bad), (&bad, &good), (&bad, &bad)] {
        for flip in
            [ldr_flip(reference, test, PIXELS_PER_DEGREE), hdr_flip(reference, test, PIXELS_PER_DEGREE)]
        {
            let map = flip.unwrap().map;
            assert!(map.values().all(|value| (0.0..=1.0).contains(&value)));
        }
    }
}
