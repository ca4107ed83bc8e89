//! Every shader is valid WGSL. Needs no GPU.

use std::fmt::Debug;

use alhazen_gpu::Algorithm;
use alhazen_gpu::shaders::{self, Parts};
use rayon::prelude::*;
use spectrum::RgbColorSpace;
use wgpu::naga::Module;
use wgpu::naga::front::wgsl;
use wgpu::naga::valid::{Capabilities, ValidationFlags, Validator};

/// All of a source.
fn validate(source: &str) -> Result<(), String> {
    validate_module(source, &wgsl::parse_str(source).map_err(|error| error.emit_to_string(source))?)
}

/// What a driver gets of the source of a kernel.
fn validate_kernel(source: &str) -> Result<(), String> {
    validate_module(source, &shaders::parsed(source)?)
}

fn validate_module(source: &str, module: &Module) -> Result<(), String> {
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::RAY_QUERY);
    validator.validate(module).map(|_| ()).map_err(|error| error.emit_to_string(source))
}

#[test]
fn all_laws_are_valid() {
    validate(&shaders::with_laws(&[])).unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn shaders_have_all_laws() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/law");
    let all = shaders::with_laws(&[&shaders::principled(), shaders::MEASURED]);
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        assert!(all.contains(&std::fs::read_to_string(&path).unwrap()), "{}", path.display());
    }
}

#[test]
fn traversal_is_valid() {
    for source in crate::trace::sources() {
        validate(&source).unwrap_or_else(|error| panic!("{error}"));
    }
}

/// Parts that are tested beside others, not in all pairs.
const RARE: [&str; 10] = [
    "placed_lights",
    "light_holes",
    "portals",
    "lenses",
    "motion",
    "subsurface",
    "zsobol",
    "media",
    "forced_diffuse",
    "ray_queries",
];

/// No parts, all, and six sets so that each two parts are there together, each without the other,
/// and neither: each part is in another three of the six.
fn sets() -> [Parts; 8] {
    let paired: Vec<&str> = Parts::NAMES.iter().copied().filter(|name| !RARE.contains(name)).collect();
    let threes: Vec<u32> =
        (0..64u32).filter(|bits| bits.count_ones() == 3).map(|bits| bits << 2 | 2).collect();
    assert!(paired.len() <= threes.len(), "parts have no threes of their own");
    let is_in = |set: usize, name: &str| {
        paired.iter().zip(&threes).any(|(part, bits)| *part == name && bits >> set & 1 == 1)
    };
    std::array::from_fn(|set| Parts::from_fn(|name| is_in(set, name)))
}

#[test]
fn kernels_are_valid() {
    let occlusion = Algorithm::AmbientOcclusion(Default::default(), RgbColorSpace::srgb());
    let path = Algorithm::Path(Default::default());
    let vol_path = Algorithm::VolPath(Default::default());
    let simple = Algorithm::SimplePath(Default::default());
    let algorithms = [
        simple.clone(),
        Algorithm::RayCasting,
        Algorithm::Whitted(Default::default()),
        occlusion,
        path.clone(),
        Algorithm::LightTracing(Default::default()),
        Algorithm::Bdpt(Default::default()),
        Algorithm::Mlt(Default::default(), 1),
        Algorithm::Sppm(Default::default(), 1),
    ];
    let mut sources = Vec::new();
    for parts in sets() {
        let mut add = |name: &dyn Debug, source| sources.push((format!("{name:?}, {parts:?}"), source));
        for algorithm in &algorithms {
            add(algorithm, shaders::pixels(algorithm, parts));
            if !algorithm.begins_at_lights() {
                add(algorithm, shaders::surfaces(algorithm, parts));
                add(algorithm, shaders::light(algorithm, parts, false));
            }
        }
        for algorithm in [&path, &vol_path, &simple] {
            add(&"media", shaders::pixels(algorithm, Parts { media: true, ..parts }));
        }
        add(&"ray queries", shaders::pixels(&path, Parts { ray_queries: true, ..parts }));
        add(&"motion", shaders::pixels(&path, Parts { motion: true, ..parts }));
        add(&"portals", shaders::pixels(&path, Parts { portals: true, ..parts }));
        let lights = Parts { placed_lights: true, light_holes: true, ..parts };
        for algorithm in [&path, &Algorithm::Bdpt(Default::default())] {
            add(&"placed lights", shaders::pixels(algorithm, lights));
        }
        for algorithm in [&path, &Algorithm::Bdpt(Default::default())] {
            add(&"zsobol", shaders::pixels(algorithm, Parts { zsobol: true, ..parts }));
        }
        add(&"lenses", shaders::pixels(&path, Parts { lenses: true, ..parts }));
        let bodies = Parts { subsurface: true, ..parts };
        add(&"bodies", shaders::pixels(&path, bodies));
        add(&"bodies", shaders::pixels(&simple, bodies));
        add(&"bodies among media", shaders::pixels(&vol_path, Parts { media: true, ..bodies }));
        add(&"bodies", shaders::surfaces(&path, bodies));
        add(&"forced diffuse", shaders::pixels(&simple, Parts { forced_diffuse: true, ..parts }));
        add(&"chains", shaders::chains(parts));
        shaders::wavefront(parts).into_iter().for_each(|source| add(&"wavefront", source));
        add(&"other light", shaders::light(&path, parts, true));
        shaders::reservoirs(parts).into_iter().for_each(|source| add(&"reservoirs", source));
    }
    let error = |(name, source): &(String, String)| {
        validate_kernel(source).err().map(|error| format!("{name}: {error}"))
    };
    assert_eq!(sources.par_iter().find_map_any(error), None);
}

#[test]
fn shaders_of_the_raster_pipeline_are_valid() {
    validate(&shaders::raster()).unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn kernels_of_frames_are_valid() {
    for source in shaders::filters() {
        validate_kernel(&source).unwrap_or_else(|error| panic!("{error}"));
    }
}

#[test]
fn kernels_of_moving_spheres_are_valid() {
    let tree = shaders::tree().map(|(_, source)| source);
    let place = [shaders::place_spheres(), shaders::place_triangles(), shaders::place_instances()];
    for source in shaders::sort().into_iter().chain(tree).chain(place) {
        validate_kernel(&source).unwrap_or_else(|error| panic!("{error}"));
    }
}

#[test]
fn what_is_wrong_is_found() {
    assert!(validate("fn f() -> f32 { return 1u; }").is_err());
}

/// Whether operators, all between the same brackets, may follow each other by the grammar of WGSL:
/// bitwise ones are alone but for others of their kind, shifts have no sums and no shifts as
/// operands, and of `&&` and `||` there is one kind. naga takes all of them, browsers do not.
fn is_grammatical(operators: &[&str]) -> bool {
    let has = |some: &[&str]| operators.iter().any(|operator| some.contains(operator));
    if has(&["&", "|", "^"]) {
        return operators.iter().all(|operator| *operator == operators[0]);
    }
    let sums = operators.split(|operator| ["&&", "||", "==", "!=", "<", ">", "<=", ">="].contains(operator));
    let is_shift = |operator: &&str| ["<<", ">>"].contains(operator);
    !(has(&["&&"]) && has(&["||"])) && sums.into_iter().all(|sum| sum.len() < 2 || !sum.iter().any(is_shift))
}

/// The lines where operators lack parentheses. Binary operators have spaces around them.
fn ungrammatical(source: &str) -> Vec<&str> {
    const OPERATORS: [&str; 18] =
        ["&", "|", "^", "<<", ">>", "+", "-", "*", "/", "%", "&&", "||", "==", "!=", "<", ">", "<=", ">="];
    let (mut open, mut wrong) = (vec![Vec::new()], Vec::new());
    for line in source.lines() {
        let code = line.split("//").next().unwrap_or_default();
        let spaced: String =
            code.chars().map(|c| if "(){}[],;".contains(c) { format!(" {c} ") } else { c.into() }).collect();
        for word in spaced.split_whitespace() {
            let ends = [")", "]", "}", ",", ";", "=", "return"].contains(&word)
                || word.ends_with("=") && !OPERATORS.contains(&word);
            if ends {
                let operators = open.last_mut().map(std::mem::take).unwrap_or_default();
                wrong.extend((!is_grammatical(&operators)).then_some(line));
            }
            match word {
                "(" | "[" | "{" => open.push(Vec::new()),
                ")" | "]" | "}" => drop(open.pop()),
                _ => {
                    let operator = OPERATORS.into_iter().find(|operator| *operator == word);
                    open.last_mut().expect("brackets in pairs").extend(operator);
                }
            }
        }
    }
    wrong
}

#[test]
fn operators_have_the_parentheses_of_the_grammar() {
    let wrong = ["a << 2 | b", "a & b == c", "a || b && c", "a + b << 2", "a & b | c"];
    for code in wrong {
        assert_eq!(ungrammatical(&format!("let x = f({code});")).len(), 1, "{code}");
    }
    let right = "let x = (a << 2) | ((b & 3) | c); if (-a < b * c && d >> 1 == e) { x &= y; }";
    assert!(ungrammatical(right).is_empty());
    for folder in ["", "dynamic", "law", "realtime", "wavefront"] {
        let folder = format!("{}/shaders/{folder}", env!("CARGO_MANIFEST_DIR"));
        for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_file() {
                let source = std::fs::read_to_string(&path).unwrap();
                assert_eq!(ungrammatical(&source), [""; 0], "{}", path.display());
            }
        }
    }
}
