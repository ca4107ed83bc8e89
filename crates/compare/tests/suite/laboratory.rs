//! The laboratory: its figures against direct computation, the bias of unbiased and biased
//! integrators, and its page.

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use alhazen::assets::MemoryAssets;
use alhazen::image::{Image, metrics};
use alhazen::import::import;
use alhazen::integrators::{Control, PassError};
use alhazen::{Overrides, render_file, system_clock};
use compare::{Budget, Comparison, Laboratory, Plan, PlanError, ReferenceSource, Run};
use serde_json::Value;

/// Two walls and a light, with diffuse interreflection.
const SCENE: &str = r#"
LookAt 0 0.5 -4  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 32 "integer yresolution" 24
PixelFilter "box"
Sampler "independent" "integer pixelsamples" 4
Integrator "path" "integer maxdepth" 4
WorldBegin
LightSource "infinite" "rgb L" [ 0.2 0.2 0.25 ]
Material "diffuse" "rgb reflectance" [ 0.7 0.6 0.5 ]
Shape "trianglemesh" "point3 P" [ -3 -1 -3  3 -1 -3  3 -1 3  -3 -1 3 ] "integer indices" [ 0 1 2 0 2 3 ]
Shape "trianglemesh" "point3 P" [ -3 -1 2  3 -1 2  3 3 2  -3 3 2 ] "integer indices" [ 0 1 2 0 2 3 ]
AttributeBegin
Translate 0 1.6 0.5
AreaLightSource "diffuse" "rgb L" [ 8 7 6 ]
Shape "sphere" "float radius" 0.4
AttributeEnd
"#;

const NAME: &str = "<walls> & lamp.pbrt";

fn assets() -> MemoryAssets {
    MemoryAssets::default().with(NAME, SCENE)
}

fn plan(contenders: &[&str], budget: Budget) -> Plan {
    Plan {
        title: NAME.into(),
        contenders: contenders.iter().map(|name| name.parse().unwrap()).collect(),
        budget,
        reference: ReferenceSource::Render { by: None, samples_per_pixel: None },
        overrides: Overrides::default(),
        threads: 1,
        #[cfg(feature = "gpu")]
        kernels: None,
    }
}

fn rendered(samples_per_pixel: u32) -> ReferenceSource {
    ReferenceSource::Render { by: None, samples_per_pixel: Some(samples_per_pixel) }
}

fn laboratory(plan: Plan) -> Result<Laboratory, PlanError> {
    let imported = import(Path::new(NAME), &assets());
    assert!(!imported.has_errors(), "{:?}", imported.diagnostics);
    Laboratory::new(&imported.desc, plan).map(|(laboratory, warnings)| {
        assert!(warnings.is_empty(), "{warnings:?}");
        laboratory
    })
}

fn compared(plan: Plan) -> Comparison {
    let control = Control::new(Arc::default(), system_clock());
    laboratory(plan).unwrap().compare(&control, &mut |_, _| ()).unwrap()
}

fn difference(comparison: &Comparison, run: &Run, picture: usize) -> metrics::Difference {
    metrics::compare(&comparison.reference.picture, &run.pictures[picture]).unwrap()
}

#[test]
fn figures_match_direct_computation() {
    let comparison =
        compared(Plan { reference: rendered(64), ..plan(&["path", "simplepath"], Budget::Samples(8)) });
    let json = comparison.to_json();
    let close = |json: &Value, expected: f64| {
        let found = json.as_f64().unwrap();
        assert!((found - expected).abs() <= 1e-9 * expected.abs(), "{found} is not {expected}");
    };
    assert_eq!(json["integrators"].as_array().unwrap().len(), 2);
    for (run, json) in comparison.runs.iter().zip(json["integrators"].as_array().unwrap()) {
        let direct = [0, 1].map(|picture| difference(&comparison, run, picture));
        close(&json["mse"], (direct[0].mse + direct[1].mse) / 2.0);
        close(&json["relmse"], (direct[0].rel_mse + direct[1].rel_mse) / 2.0);
        let mean = |values: [f64; 3]| values.iter().sum::<f64>() / 3.0;
        let error = direct.map(|direct| mean(direct.test_mean) - mean(direct.reference_mean));
        assert!((json["mean_error"].as_f64().unwrap() - (error[0] + error[1]) / 2.0).abs() < 1e-9);
        let apart = metrics::compare(&run.pictures[0], &run.pictures[1]).unwrap();
        close(&json["variance"], apart.mse / 2.0);
        let noise = json["variance"].as_f64().unwrap() + comparison.reference.noise.unwrap().absolute;
        close(&json["mse"], noise + json["bias_squared"].as_f64().unwrap());
        let seconds = json["seconds"].as_f64().unwrap();
        close(&json["efficiency"], 1.0 / (json["relmse"].as_f64().unwrap() * seconds));
        close(&json["rays_per_second"], json["rays"].as_f64().unwrap() / seconds);
        assert!(json["flip"].as_f64().is_some_and(|flip| flip > 0.0 && flip < 1.0));
        let passes: Vec<_> = run.checkpoints.iter().map(|point| point.passes).collect();
        assert_eq!(passes, [1, 2, 3, 4, 6, 8]);
        assert!(
            run.checkpoints
                .windows(2)
                .all(|pair| pair[0].seconds < pair[1].seconds && pair[0].rays < pair[1].rays)
        );
    }
    close(&json["reference"]["mean"], comparison.reference.mean());
    assert_eq!((&json["status"], &json["budget"]["samples_per_pixel"]), (&"done".into(), &8.into()));
}

#[test]
fn the_first_picture_is_that_of_a_render() {
    let comparison = compared(plan(&["path:maxdepth=2"], Budget::Samples(4)));
    let overrides = Overrides {
        settings: vec![("maxdepth".into(), "2".into()), ("savefp16".into(), "false".into())],
        ..Overrides::default()
    };
    let render = render_file(NAME, &assets(), &overrides, &Control::default()).unwrap();
    let bits = |image: &Image| image.values().map(f32::to_bits).collect::<Vec<_>>();
    assert_eq!(bits(&comparison.runs[0].pictures[0]), bits(&render));
    assert_ne!(bits(&comparison.runs[0].pictures[1]), bits(&render), "the second has another seed");
}

#[test]
fn only_integrators_that_miss_light_are_biased() {
    let contenders = ["path", "simple-path", "path:maxdepth=1"];
    let comparison = compared(Plan { reference: rendered(512), ..plan(&contenders, Budget::Samples(64)) });
    let [path, simple, short] = comparison.runs.as_slice() else { panic!("three runs") };
    assert_eq!(comparison.doubt(), None);
    let z = |run: &Run| run.last().measure.mean_error / run.last().measure.mean_error_deviation;
    for run in [path, simple] {
        let parts = run.last().measure.relative;
        assert!(!parts.is_biased() && z(run).abs() < 4.0, "{}: {:?}", run.name, run.last().measure);
        assert!(
            (parts.error / (parts.variance + comparison.reference.noise.unwrap().relative) - 1.0).abs() < 0.1
        );
    }
    assert!(short.last().measure.relative.is_biased() && z(short) < -10.0, "{:?}", short.last().measure);
    let of_reference = short.last().measure.mean_error / comparison.reference.mean();
    assert!((-0.6..-0.1).contains(&of_reference), "indirect light is missing: {of_reference}");
    // Variance is inversely proportional to the number of samples.
    let variance = |run: &Run, point: usize| run.checkpoints[point].measure.relative.variance;
    let fall = variance(path, 0) / variance(path, path.checkpoints.len() - 1);
    assert!((fall / 64.0).ln().abs() < 0.5, "64 times the samples have 1 / {fall} of the variance");
}

#[test]
fn a_reference_that_misses_light_gives_a_warning() {
    let short =
        ReferenceSource::Render { by: Some("path:maxdepth=1".parse().unwrap()), samples_per_pixel: Some(64) };
    let contenders = ["path:maxdepth=1", "path", "simple-path"];
    let comparison = compared(Plan { reference: short, ..plan(&contenders, Budget::Samples(8)) });
    let doubt = comparison.doubt().unwrap();
    assert!(doubt.contains("path:maxdepth=1 rendered it") && doubt.contains("simple-path "), "{doubt}");
    assert!(comparison.to_html().unwrap().contains("The reference may miss light"));
    assert_eq!(comparison.to_json()["reference"]["doubt"], doubt);
}

#[test]
fn figures_do_not_depend_on_threads() {
    let figures = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let comparison = compared(plan(&["path"], Budget::Samples(4)));
            comparison.runs[0]
                .checkpoints
                .iter()
                .map(|point| (point.passes, point.rays, point.measure))
                .collect::<Vec<_>>()
        })
    };
    assert_eq!(figures(1), figures(3));
}

#[test]
fn every_run_uses_its_budget_of_time() {
    let time = Duration::from_millis(100);
    let comparison =
        compared(Plan { reference: rendered(32), ..plan(&["path", "ray-casting"], Budget::Time(time)) });
    for run in &comparison.runs {
        let last = run.last();
        let pass = last.seconds / f64::from(last.passes);
        assert!(last.seconds >= time.as_secs_f64() || last.passes == 65_536, "{last:?}");
        // Other load on the machine may make a pass longer.
        assert!(last.seconds < time.as_secs_f64() + 100.0 * pass + 1.0, "{last:?}");
    }
    assert_eq!(comparison.to_json()["budget"]["seconds"], 0.1);
}

#[test]
fn a_given_reference_must_have_the_size_of_the_picture() {
    let whole = compared(plan(&["path"], Budget::Samples(2))).reference.picture;
    let given = |picture: &Image, crop| Plan {
        reference: ReferenceSource::Picture { name: "r.exr".into(), picture: picture.clone() },
        overrides: Overrides { crop, ..Overrides::default() },
        ..plan(&["path"], Budget::Samples(2))
    };
    let comparison = compared(given(&whole, None));
    assert!(comparison.reference.noise.is_none() && comparison.to_json()["reference"]["variance"].is_null());
    // A picture of the whole image is cropped to the part that is rendered.
    let comparison = compared(given(&whole, Some([0.5, 1.0, 0.0, 0.5])));
    assert_eq!(comparison.reference.picture.rgb(1, 2), whole.rgb(17, 2));
    let small = Image::from_fn(5, 7, ["Y"], |_, _| [0.0]);
    match laboratory(given(&small, None)) {
        Err(PlanError::Reference(message)) => {
            assert_eq!(message, "the reference r.exr has 5 × 7 pixels, not the scene's 32 × 24");
        }
        _ => panic!("a reference of the wrong size was accepted"),
    }
}

#[test]
fn a_cancelled_comparison_reports_completed_runs() {
    let from = |stage: &'static str| {
        let plan = Plan { reference: rendered(2), ..plan(&["path", "whitted"], Budget::Samples(2)) };
        let control = Control::default();
        laboratory(plan).unwrap().compare(&control, &mut |name, _| {
            control.cancel.fetch_or(name == stage, Ordering::Relaxed);
        })
    };
    for nothing in ["reference by path", "path"] {
        assert_eq!(from(nothing).unwrap_err(), PassError::Cancelled);
    }
    let comparison = from("whitted").unwrap();
    assert!(comparison.interrupted());
    assert_eq!(
        (comparison.runs.len(), comparison.missing.as_slice()),
        (1, ["whitted".to_owned()].as_slice())
    );
    assert_eq!(comparison.to_json()["status"], "interrupted");
    assert!(comparison.to_html().unwrap().contains("Interrupted"));
}

#[test]
fn the_page_is_well_formed_and_self_contained() {
    let comparison = compared(plan(&["path", "ray-casting"], Budget::Samples(2)));
    let page = comparison.to_html().unwrap();
    for outside in ["http:", "https:", "url(", "@import", "src=\"/", "<link", "fetch("] {
        assert!(!page.contains(outside), "the page has `{outside}`");
    }
    let ids = check_elements(&page);
    for id in
        ["viewer", "slider", "reference", "picture0", "error0", "blocks0", "picture1", "error1", "blocks1"]
    {
        assert!(ids.contains(id), "no element is called {id}");
    }
    assert_eq!(page.matches("src=\"data:image/png;base64,").count(), 7);
    assert!(page.contains("<h1>&lt;walls&gt; &amp; lamp.pbrt</h1>"), "text is escaped");
    assert_eq!(page.matches("<svg").count(), 2);
}

#[test]
fn black_pictures_and_single_pixels_can_be_reported() {
    let dark = plan(&["ambient-occlusion:maxdistance=0.001", "path:maxdepth=0"], Budget::Samples(1));
    let overrides = Overrides { crop: Some([0.0, 0.1, 0.9, 1.0]), ..Overrides::default() };
    let one = Overrides { pixel: Some([3, 4]), ..Overrides::default() };
    for comparison in [overrides, one].map(|overrides| compared(Plan { overrides, ..dark.clone() })) {
        let page = comparison.to_html().unwrap();
        check_elements(&page);
        assert!(!page.contains("NaN") && !page.contains("inf "), "{page}");
        let point = comparison.runs[0].last();
        assert!(comparison.reference.picture.width() > 1 || !point.measure.relative.is_biased(), "{point:?}");
    }
}

/// Panics unless elements are properly nested and their ids unique; returns the ids.
fn check_elements(page: &str) -> BTreeSet<String> {
    const EMPTY: [&str; 4] = ["!DOCTYPE", "meta", "img", "input"];
    let (mut open, mut ids) = (Vec::new(), BTreeSet::new());
    let mut rest = page;
    while let Some(start) = rest.find('<') {
        let (tag, after) = rest[start + 1..].split_once('>').unwrap();
        rest = after;
        let name = tag.split([' ', '/']).find(|name| !name.is_empty()).unwrap();
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name), "closed before {}", &after[..after.len().min(80)]);
        } else if !tag.ends_with('/') && !EMPTY.contains(&name) {
            open.push(name);
        }
        if let Some((_, id)) = tag.split_once(" id=\"").or_else(|| tag.split_once("id=\"")) {
            assert!(ids.insert(id.split('"').next().unwrap().to_owned()), "two elements are {id}");
        }
        // Scripts and style sheets are not markup.
        if name == "script" || name == "style" {
            rest = &rest[rest.find("</").unwrap()..];
        }
    }
    assert!(open.is_empty(), "{open:?} are not closed");
    ids
}
