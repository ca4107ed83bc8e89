//! Paths by stages: what is found for a sample is that of the megakernel, and does not depend on
//! the paths around it.

use std::path::Path;

use alhazen_gpu::{Algorithm, FindFirstHit, Renderer};
use assets::MemoryAssets;
use description::Schedule;
use image::Image;
use sampling::Sampler;
use sampling::sampler::Independent;
use scene::View;

use crate::motion::LANTERNS;
use crate::pictures::Case;
use crate::texts::MEDLEY;

/// Asserts that the pictures of both schedules are the same but for some values. Stages are
/// functions of the megakernel, but compilers may round their sums otherwise.
fn assert_same(name: &str, case: &Case) {
    let algorithm = Algorithm::Path(case.path());
    let both = [Schedule::Megakernel, Schedule::Wavefront];
    let [Some(mega), Some(wave)] = both.map(|schedule| case.scheduled(&algorithm, schedule)) else {
        return;
    };
    let pictures = [&mega, &wave].map(|renderer| case.drawn(renderer));
    assert!(mega.occupancy().is_none() && wave.occupancy().is_some_and(|share| share > 0.0 && share <= 1.0));
    let [mega, wave] = pictures;
    let apart = mega.values().zip(wave.values()).filter(|(a, b)| (a - b).abs() > 1e-4 * a.max(0.01));
    let share = apart.count() as f64 / mega.values().count() as f64;
    println!("{name}: {share:.1e} apart");
    assert!(share <= 0.002 && mega.values().sum::<f32>() > 0.0, "{name}: {share}");
}

/// A scene of five kinds of materials.
fn medley(resolution: [u32; 2]) -> Case {
    let path = Path::new("scene.pbrt");
    Case::sized(path, &MemoryAssets::default().with(path, MEDLEY), resolution)
}

/// More samples than a device in software has places for paths.
const LARGE: [u32; 2] = [160, 120];

#[test]
fn a_wavefront_has_the_picture_of_the_megakernel() {
    assert_same("cornell-box", &Case::named("cornell-box"));
    assert_same("medley", &medley(LARGE));
}

#[test]
fn a_wavefront_has_the_motion_and_the_lights_of_the_megakernel() {
    assert_same("lanterns", &Case::of_text(LANTERNS));
}

/// The samples of a part of the picture begin, and are sorted, among others than in the whole.
#[test]
fn samples_do_not_depend_on_the_paths_around_them() {
    let bits = |image: &Image, x, y| [0, 1, 2].map(|channel| image.channel(x, y, channel).to_bits());
    let draw = |case: &Case| {
        let renderer = case.scheduled(&Algorithm::Path(case.path()), Schedule::Wavefront)?;
        Some(case.drawn(&renderer))
    };
    let mut case = medley(LARGE);
    let Some(whole) = draw(&case) else { return };
    let [left, right, top, bottom] = [31, 140, 50, 97];
    case.desc.film.pixel_bounds = Some([left, right, top, bottom]);
    case.view = View::compile(&case.desc, case.scene.world_from_render()).expect("a view").view;
    let Some(part) = draw(&case) else { return };
    assert_eq!([part.width() as i32, part.height() as i32], [right - left, bottom - top]);
    for (y, x) in (0..part.height()).flat_map(|y| (0..part.width()).map(move |x| (y, x))) {
        assert_eq!(bits(&part, x, y), bits(&whole, x + left as u32, y + top as u32), "{x}, {y}");
    }
}

/// Those of a small picture are made for several passes at once.
#[test]
fn samples_do_not_depend_on_what_is_made_with_them() {
    let case = Case::named("cornell-box");
    let algorithm = Algorithm::Path(case.path());
    let draw = |indices: [u32; 4]| {
        let renderer = case.scheduled(&algorithm, Schedule::Wavefront)?;
        let mut film = case.film();
        let find: &FindFirstHit = &|_, _, _| None;
        for index in indices {
            renderer.pass(index, &case.view, &mut film, find, || false).expect("a pass");
        }
        Some(film.develop().expect("a picture").values().map(f32::to_bits).collect::<Vec<_>>())
    };
    assert_eq!(draw([0, 1, 2, 3]), draw([3, 1, 0, 2]));
}

#[test]
fn paths_take_no_more_memory_for_more_samples() {
    let mut case = Case::named("cornell-box");
    let algorithm = Algorithm::Path(case.path());
    let mut bytes = |samples: u32| {
        case.sampler = Sampler::Independent(Independent::new(samples, 7));
        case.scheduled(&algorithm, Schedule::Wavefront).as_ref().map(Renderer::bytes)
    };
    assert_eq!(bytes(1 << 12), bytes(1 << 20));
}
