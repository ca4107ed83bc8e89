//! The picture of the business card ray tracer against that of the original program, or some of its
//! pixels where that is absent.

#[allow(dead_code)]
#[path = "../../examples/minray.rs"]
mod example;

/// The numbers of a plain portable pixmap after its magic number: width, height, maximum, channels.
fn numbers(text: &str) -> Vec<i32> {
    text.split_whitespace().skip(1).map(|word| word.parse().expect("a number")).collect()
}

#[test]
fn the_picture_is_that_of_the_original_program() {
    let Some(path) = testkit::data("../minray/minray.ppm") else { return };
    let text = std::fs::read_to_string(path).expect("the picture is read");
    let expected = numbers(&text);
    assert_eq!(expected[..3], [32, 32, 255]);
    let ours = example::picture(32);
    let differences: Vec<_> = ours
        .as_flattened()
        .iter()
        .zip(&expected[3..])
        .map(|(&ours, &theirs)| (i32::from(ours) - theirs).abs())
        .collect();
    assert_eq!(differences.len(), 3 * 32 * 32);
    let off = differences.iter().filter(|&&difference| difference > 0).count();
    assert!(differences.iter().all(|&difference| difference <= 1), "some channel is off by more than one");
    assert!(off * 100 <= differences.len(), "{off} channels are off");
}

#[test]
fn pixels_on_every_sphere_and_on_the_background() {
    let picture = example::picture(32);
    for ([x, y], expected) in [
        ([0, 0], [5, 5, 5]),
        ([1, 17], [150, 76, 34]),
        ([7, 20], [67, 40, 17]),
        ([12, 20], [8, 6, 5]),
        ([5, 16], [211, 127, 78]),
        ([27, 16], [114, 142, 170]),
        ([27, 18], [111, 112, 140]),
        ([24, 4], [139, 72, 39]),
        ([8, 4], [15, 50, 56]),
        ([15, 4], [36, 40, 42]),
        ([16, 12], [10, 10, 10]),
        ([20, 22], [4, 5, 5]),
    ] {
        let ours = picture[32 * y + x];
        let is_near = ours.iter().zip(expected).all(|(&ours, theirs): (_, u8)| ours.abs_diff(theirs) <= 1);
        assert!(is_near, "pixel ({x}, {y}) is {ours:?}, not {expected:?}");
    }
}

#[test]
fn another_resolution_shows_the_same_scene() {
    let (small, large) = (example::picture(32), example::picture(64));
    assert_eq!(large.len(), 64 * 64);
    let same = (0..32 * 32).filter(|i| small[*i] == large[64 * 2 * (i / 32) + 2 * (i % 32)]).count();
    assert!(same > 1000, "only {same} of 1024 pixels are seen along the same rays");
}
