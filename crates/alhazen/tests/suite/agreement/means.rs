//! Means of whole pictures, with a standard error of one per mille, which agree within three for
//! all integrators.
//!
//! Pictures with successive seeds are rendered until the standard error of each channel's mean is
//! small enough. The mean does not depend on the number of pixels, so each algorithm has the
//! resolution at which it is fastest. All have the same four wavelengths, as colours would only add
//! noise.

use std::sync::OnceLock;
use std::time::Instant;

use alhazen::Overrides;
use testkit::{Moments, welch_test};

use super::scenes::{MEDIA, SCENES, Scene};
use crate::common::{means, render_text};

/// The tolerated difference of means.
const THREE_PER_MILLE: f64 = 3e-3;
/// In media so many standard errors of it, if that is more.
const FOUR_ERRORS: f64 = 4.0;

/// The most pictures of a mean.
const MOST: i32 = 2000;

/// In the pool, path tracing takes many minutes to reach a standard error of one per mille. In the
/// prism a path keeps the first of its wavelengths only, which would have to differ between paths.
const NOT_COMPARED: [&str; 2] = ["a pool", "a prism"];

/// Few paths carry light here: every algorithm takes minutes to reach this standard error.
const DOOR: &str = "a door that is almost closed";
const CAUSTIC: &str = "the caustic of a glass ball";

/// Scenes in which Markov chains reach this standard error in a minute or two. Chains estimate the
/// distribution of light well, but its mean only by the independent paths from which they choose
/// their starts, a fifth of all paths. Elsewhere one per mille would take them from ten minutes to
/// an hour. The results of three to five minutes, all channels: over `path`, mirrors +0.0 ± 0.25 %
/// and door −0.2 to +0.1 ± 0.3 %; over `bdpt`, caustic −0.2 ± 0.3 %, mirrors −0.5 ± 0.6 % and door
/// −0.2 to +0.1 ± 0.3 to 0.5 %.
const FOR_CHAINS: [&str; 8] = [
    "a diffuse box",
    "a glossy box",
    "many small lights",
    "a sky and a sun",
    "a thin lens",
    "parallel rays",
    "all around",
    "motion",
];

/// A light at a point in fog, of which path tracing and light tracing have no finite variance: the
/// square of what vertices near to it, or to the camera, bring grows with the fourth power of the
/// inverse distance. Merging spreads such vertices less well than `bdpt` weights them.
const FOG: &str = "a lamp in fog";

/// An algorithm, with settings that make it fast.
#[derive(Clone, Copy)]
struct Member {
    name: &'static str,
    integrator: &'static str,
    settings: &'static [(&'static str, &'static str)],
    /// Pixels along a side of the picture, and samples of each.
    size: (i32, u32),
    /// The relative standard error to which a mean is estimated.
    tolerance: f64,
    can: fn(&Scene) -> bool,
}

const EVEN: (&str, &str) = ("sampler", "zsobol");

/// Path tracing first, the reference for the others; last those that are not unbiased but
/// consistent: with such small radii, the blur is below the noise, except at a door without
/// thickness, through which photons leak.
const MEMBERS: [Member; 7] = [
    Member {
        name: "path",
        integrator: "path",
        settings: &[EVEN],
        size: (32, 64),
        tolerance: 5e-4,
        can: |_| true,
    },
    Member {
        name: "bdpt",
        integrator: "bdpt",
        settings: &[EVEN],
        size: (32, 32),
        tolerance: 8e-4,
        can: |_| true,
    },
    Member {
        name: "light-tracing",
        integrator: "light-tracing",
        settings: &[EVEN],
        size: (32, 64),
        tolerance: 8e-4,
        can: |scene| !scene.is_hidden_from_light,
    },
    Member {
        name: "mlt over path",
        integrator: "mlt",
        settings: &[("technique", "path")],
        size: (128, 16),
        tolerance: 8e-4,
        can: |scene| FOR_CHAINS.contains(&scene.name) || scene.name == CAUSTIC,
    },
    Member {
        name: "mlt over bdpt",
        integrator: "mlt",
        settings: &[("technique", "bdpt")],
        size: (128, 16),
        tolerance: 8e-4,
        can: |scene| FOR_CHAINS.contains(&scene.name),
    },
    Member {
        name: "vcm",
        integrator: "vcm",
        settings: &[EVEN, ("radius", "0.01")],
        size: (32, 32),
        tolerance: 8e-4,
        can: |scene| scene.name != DOOR,
    },
    Member {
        name: "sppm",
        integrator: "sppm",
        settings: &[EVEN, ("radius", "0.02"), ("photons", "4096")],
        size: (64, 16),
        tolerance: 8e-4,
        can: |scene| !["a plane without end", DOOR].contains(&scene.name),
    },
];

/// The same in media, without chains and `sppm`, which would take many times as long.
const IN_MEDIA: [Member; 4] =
    [Member { name: "vol-path", integrator: "vol-path", ..MEMBERS[0] }, MEMBERS[1], MEMBERS[2], MEMBERS[5]];

impl Member {
    /// The relative standard error to which the scene's mean is estimated.
    fn tolerance(&self, scene: &Scene) -> f64 {
        match (scene.name, self.integrator) {
            (DOOR, "path") => 1e-3,
            (DOOR, _) | (CAUSTIC, "mlt") => 1.2e-3,
            (FOG, "vcm") => 1.6e-3,
            _ => self.tolerance,
        }
    }

    /// Means of the channels of as many pictures as are needed.
    ///
    /// # Panics
    /// If the most pictures do not reach the standard error.
    fn means(&self, scene: &Scene, first_seed: i32) -> [Moments; 3] {
        const FEWEST: i32 = 16;
        let start = Instant::now();
        let text = format!("Option \"disablewavelengthjitter\" true\n{}", scene.text());
        let max_depth = scene.max_depth.to_string();
        let settings = self.settings.iter().copied().chain([("maxdepth", &*max_depth)]);
        let settings: Vec<_> = settings.map(|(name, value)| (name.into(), value.into())).collect();
        let (side, samples) = self.size;
        let mut found = [Moments::default(); 3];
        for run in 0..MOST {
            let overrides = Overrides {
                integrator: Some(self.integrator.into()),
                settings: settings.clone(),
                samples_per_pixel: Some(samples),
                resolution: Some([side; 2]),
                seed: Some(first_seed + run),
                ..Overrides::default()
            };
            let means = means(&render_text(&text, &overrides));
            found.iter_mut().zip(means).for_each(|(moments, mean)| moments.push(mean));
            if run + 1 >= FEWEST && found.iter().all(|m| error(m) < self.tolerance(scene)) {
                break;
            }
        }
        let [worst, means] = [found.map(|m| error(&m)), found.map(|m| m.mean)];
        let worst = worst.into_iter().fold(0.0, f64::max);
        println!(
            "{}, {}: {means:.5?} ± {:.3} % in {} pictures of {:.0} s",
            scene.name,
            self.name,
            100.0 * worst,
            found[0].count,
            start.elapsed().as_secs_f64(),
        );
        assert!(worst < self.tolerance(scene), "{}, {}: {MOST} pictures are too few", scene.name, self.name);
        found
    }

    fn is_unbiased(&self) -> bool {
        !["vcm", "sppm"].contains(&self.integrator)
    }
}

/// The relative standard error of a mean.
fn error(moments: &Moments) -> f64 {
    moments.variance_of_mean().sqrt() / moments.mean
}

/// The differences of the means of a member from those of a reference, as one of so many tests;
/// so many standard errors are tolerated, if they are more than three per mille.
fn differences(
    scene: &Scene,
    member: &Member,
    [found, expected]: [&[Moments; 3]; 2],
    (tests, errors): (usize, f64),
) -> Vec<String> {
    let mut failures = Vec::new();
    for (channel, (found, expected)) in found.iter().zip(expected).enumerate() {
        let difference = found.mean / expected.mean - 1.0;
        let error = error(found).hypot(error(expected));
        let line = format!(
            "{}, {}, channel {channel}: {:+.3} ± {:.3} % from the reference",
            scene.name,
            member.name,
            100.0 * difference,
            100.0 * error,
        );
        println!("{line}");
        let differs = member.is_unbiased() && welch_test(found, expected, tests).is_err();
        if differs || difference.abs() > THREE_PER_MILLE.max(errors * error) {
            failures.push(line);
        }
    }
    failures
}

/// Tests the means of all members in each scene against those of the first.
fn assert_means_agree(scenes: &[Scene], members: &[Member]) {
    let tests = 3 * (members.len() - 1) * scenes.len();
    let mut failures = Vec::new();
    for (scene, i) in scenes.iter().zip(0..).filter(|(scene, _)| !NOT_COMPARED.contains(&scene.name)) {
        let can = members.iter().zip(0..).filter(|(member, _)| (member.can)(scene));
        let mut reference = None;
        for (member, k) in can {
            // No two means share a seed.
            let found = member.means(scene, MOST * (members.len() as i32 * i + k));
            let reference = reference.get_or_insert(found);
            failures.extend(differences(scene, member, [&found, reference], (tests, 0.0)));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
#[ignore = "slow: half an hour of one core; cargo test -p alhazen --test suite means_agree -- --ignored --nocapture"]
fn means_agree_within_three_per_mille() {
    assert_means_agree(&SCENES, &MEMBERS);
}

/// Tests the mean of a member in a scene with media against that of another, which all tests of the
/// scene share.
fn assert_mean_agrees(scene: &str, reference: &str, member: &str) {
    static REFERENCES: [OnceLock<[Moments; 3]>; MEDIA.len()] = [const { OnceLock::new() }; MEDIA.len()];
    let scene = scene.replace('_', " ");
    let i = MEDIA.iter().position(|other| other.name == scene).unwrap();
    let scene = &MEDIA[i];
    let place = |name: &str| IN_MEDIA.iter().position(|other| other.name.replace('-', "_") == name).unwrap();
    // No two means share a seed.
    let means = |k: usize| IN_MEDIA[k].means(scene, MOST * (IN_MEDIA.len() * i + k) as i32);
    let expected = REFERENCES[i].get_or_init(|| means(place(reference)));
    let k = place(member);
    let found = means(k);
    let failures = differences(scene, &IN_MEDIA[k], [&found, expected], (TESTS_IN_MEDIA, FOUR_ERRORS));
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// A test of each member in each scene with media against its reference.
macro_rules! in_media {
    ($($scene:ident by $reference:ident: $($member:ident)*;)*) => {
        /// The means that are compared.
        const TESTS_IN_MEDIA: usize = [$($(stringify!($scene $member)),*),*].len() * 3;

        mod means_in_media_agree {
            $(mod $scene {
                $(#[test]
                #[ignore = "slow: up to half an hour; cargo test -p alhazen --test suite means_in_media_agree -- --ignored --nocapture"]
                fn $member() {
                    let [scene, reference] = [stringify!($scene), stringify!($reference)];
                    super::super::assert_mean_agrees(scene, reference, stringify!($member));
                })*
            })*
        }
    };
}

// Light tracing has no finite variance where the camera is in a medium.
in_media! {
    a_lamp_in_fog by bdpt: vcm;
    a_cloud by vol_path: bdpt light_tracing vcm;
    smoke_that_glows by vol_path: bdpt light_tracing vcm;
    a_coloured_liquid by vol_path: bdpt vcm;
    a_caustic_in_fog by vol_path: bdpt vcm;
    a_translucent_slab by vol_path: bdpt vcm;
    a_camera_in_a_dense_medium by vol_path: bdpt vcm;
    a_liquid_in_glass by vol_path: bdpt vcm;
}
