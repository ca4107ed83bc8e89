//! Metropolis light transport beside independent paths: the same mean, by chains of any kind.

use std::path::Path;

use alhazen_gpu::{Algorithm, Renderer};
use assets::{Files, MemoryAssets};
use description::{MltDesc, PathDesc};
use image::Image;
use sampling::Sampler;
use sampling::sampler::Independent;

use crate::direct_light::{apart, means, moments};
use crate::frames::colors;
use crate::pictures::Case;
use crate::texts::MEDLEY;

/// As many pixels as mutations of eight chains, which a driver in software runs at once.
const SIZE: [u32; 2] = [56, 40];
const MAX_DEPTH: u32 = 4;

/// Passes of the chains, each of which is a picture of its own.
const PASSES: u32 = 48;

/// Pictures by paths, and the samples of each pixel of them.
const PICTURES: u32 = 32;
const SAMPLES: u32 = 8;

/// A pass by the GPU.
fn pass(case: &Case, renderer: &Renderer, index: u32) -> Image {
    let mut film = case.film();
    let rays = renderer.pass(index, &case.view, &mut film, &|_, _, _| None, || false).expect("a pass");
    // A path for each mutation, and a ray for each pixel.
    assert!(rays > Some(2 * u64::from(SIZE[0] * SIZE[1])), "{rays:?}");
    film.develop().expect("a picture")
}

/// The means of blocks of pixels, by chains and by paths of the CPU, agree.
fn assert_mean(name: &str, mut case: Case, settings: MltDesc) {
    let Some(renderer) = case.renderer(&Algorithm::Mlt(settings, 5)) else { return };
    let width = SIZE[0] as usize;
    let chains = moments((0..PASSES).map(|index| means(&colors(&pass(&case, &renderer, index)), width)));
    let path = Algorithm::Path(PathDesc { max_depth: MAX_DEPTH, ..case.path() });
    let paths = moments((0..PICTURES).map(|seed| {
        case.sampler = Sampler::Independent(Independent::new(SAMPLES, 100 + seed));
        means(&colors(&case.on_cpu(&path, SAMPLES)), width)
    }));
    let [of_chains, of_paths] = [&chains, &paths].map(|list| list[list.len() - 1]);
    let error = (of_chains.variance_of_mean() + of_paths.variance_of_mean()).sqrt();
    println!("{name}: {:+.4} ± {:.4} of paths", of_chains.mean / of_paths.mean - 1.0, error / of_paths.mean);
    let wrong = apart(&chains, &paths);
    assert!(wrong.is_empty(), "{name}: {}", wrong.join("\n"));
}

/// One of the repository's scenes.
fn named(name: &str) -> Case {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes");
    Case::sized(&Path::new(folder).join(name).with_extension("pbrt"), &Files, SIZE)
}

#[test]
fn chains_have_the_mean_of_paths() {
    let settings = MltDesc { max_depth: MAX_DEPTH, ..Default::default() };
    assert_mean("cornell-box", named("cornell-box"), settings);
    let path = Path::new("scene.pbrt");
    let medley = Case::sized(path, &MemoryAssets::default().with(path, MEDLEY), SIZE);
    // Small steps are as large as they can be without being independent, and seldom are large ones.
    let other = MltDesc { large_step_probability: 0.1, sigma: 0.1, chains: 2, ..settings };
    assert_mean("medley", medley, other);
}

/// A pass has the same bits whenever it is rendered and whatever was before, so that renders go on
/// and are split.
#[test]
fn passes_depend_on_their_number_alone() {
    let case = named("cornell-box");
    let settings = MltDesc { max_depth: MAX_DEPTH, ..Default::default() };
    let Some(renderer) = case.renderer(&Algorithm::Mlt(settings, 5)) else { return };
    let bits = |renderer: &Renderer, index| colors(&pass(&case, renderer, index));
    let (first, second) = (bits(&renderer, 0), bits(&renderer, 1));
    let again = case.renderer(&Algorithm::Mlt(settings, 5)).expect("another renderer");
    assert!(bits(&again, 1) == second && bits(&renderer, 0) == first && first != second);
}
