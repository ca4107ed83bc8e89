//! The same numbers through a law on the CPU and through its translation on the GPU.

use crate::laws::LAWS;
use alhazen_gpu::{Device, GpuError, shaders};
use testkit::Random;

/// Numbers given to a law: directions `wo` and `wi`, `u` and `v`, `uc`, and three more.
pub const INPUTS: usize = 12;

/// Results of a law, zeros at the end.
pub const OUTPUTS: usize = 8;

/// How many inputs each law gets.
const ROWS: usize = 1 << 16;

/// A law on both sides.
pub struct Law {
    pub name: &'static str,
    /// The largest difference of a result, over its magnitude or a hundredth, whichever is larger.
    pub bound: f32,
    /// The share of rows that may differ by more, because rounding decides a comparison.
    pub flips: f32,
    /// In Rust.
    pub rust: fn(&[f32; INPUTS]) -> Vec<f32>,
    /// In WGSL: the statements after which `y` has the results.
    pub wgsl: &'static str,
}

/// Uniform directions and numbers; a quarter of the numbers are multiples of ¼, so that special
/// cases occur.
fn inputs() -> Vec<[f32; INPUTS]> {
    let mut random = Random::new(1);
    let mut number = || match random.get_2d() {
        [choice, u] if choice < 0.25 => (4.0 * u).floor() / 4.0,
        [_, u] => u,
    };
    let row = |_| {
        let mut row = [0.0; INPUTS];
        row.fill_with(&mut number);
        for direction in [0, 3] {
            let u = math::Vec2::new(row[direction], row[direction + 1]);
            let w = sampling::warp::sample_uniform_sphere(u);
            row[direction..direction + 3].copy_from_slice(&w.to_array());
        }
        row
    };
    (0..ROWS).map(row).collect()
}

/// What laws of principled surfaces read.
const TABLES: &str = "@group(0) @binding(2) var<storage, read_write> tables: array<u32>;
    fn number(at: u32) -> f32 { return bitcast<f32>(tables[at]); }
    fn vector(at: u32) -> vec3f { return vec3f(number(at), number(at + 1), number(at + 2)); }";

/// The results of a law on the GPU; those of principled surfaces have tables.
fn on_gpu(
    device: &Device,
    law: &Law,
    inputs: &[[f32; INPUTS]],
    tables: Option<&[u32]>,
) -> Result<Vec<[f32; OUTPUTS]>, GpuError> {
    let body = law.wgsl;
    let kernel = format!(
        "@group(0) @binding(0) var<storage, read_write> inputs: array<array<f32, {INPUTS}>>;
        @group(0) @binding(1) var<storage, read_write> outputs: array<array<f32, {OUTPUTS}>>;
        @compute @workgroup_size(64)
        fn main(@builtin(global_invocation_id) id: vec3u) {{
            let x = inputs[id.x];
            let wo = vec3f(x[0], x[1], x[2]);
            let wi = vec3f(x[3], x[4], x[5]);
            let u = vec2f(x[6], x[7]);
            var y: array<f32, {OUTPUTS}>;
            {body}
            outputs[id.x] = y;
        }}"
    );
    let others = tables.map_or(String::new(), |_| format!("{TABLES}{}", shaders::principled()));
    let kernel = device.kernel(law.name, &shaders::with_laws(&[&others, &kernel]))?;
    let given = device.buffer("inputs", inputs)?;
    let results = device.buffer("results", &vec![[0f32; OUTPUTS]; inputs.len()])?;
    let groups = [(ROWS / 64) as u32, 1, 1];
    match tables {
        None => device.run(&kernel, &[&given, &results], groups)?,
        Some(words) => {
            let words = device.buffer("tables", words)?;
            device.run(&kernel, &[&given, &results, &words], groups)?;
        }
    }
    device.read(&results)
}

/// The difference of two results as a law's bound counts it.
fn difference(a: f32, b: f32) -> f32 {
    if a == b || a.is_nan() && b.is_nan() { 0.0 } else { (a - b).abs() / a.abs().max(0.01) }
}

/// Compares all results of a law; what is wrong, if anything.
fn compare(
    device: &Device,
    law: &Law,
    inputs: &[[f32; INPUTS]],
    tables: Option<&[u32]>,
) -> Result<(), String> {
    let mut largest = 0f32;
    let mut flips = Vec::new();
    let results = on_gpu(device, law, inputs, tables).map_err(|error| format!("{}: {error}", law.name))?;
    for (x, y) in inputs.iter().zip(results) {
        let mut expected = (law.rust)(x);
        expected.resize(OUTPUTS, 0.0);
        // NaN is not below the bound either.
        let row = expected
            .iter()
            .zip(y)
            .map(|(&a, b)| difference(a, b))
            .fold(0.0, |a: f32, b| if b <= a { a } else { b });
        if row <= law.bound {
            largest = largest.max(row);
        } else {
            flips.push((row, *x, expected, y));
        }
    }
    let share = flips.len() as f32 / inputs.len() as f32;
    println!("{:28} {largest:.1e} of {:.0e}, {:.1e} of {:.0e} flips", law.name, law.bound, share, law.flips);
    match flips.first() {
        Some((row, x, a, b)) if share > law.flips => Err(format!(
            "{}: {} of {} rows differ, the first by {row}: {x:?}\n  Rust {a:?}\n  WGSL {b:?}",
            law.name,
            flips.len(),
            inputs.len()
        )),
        _ => Ok(()),
    }
}

/// Compares some laws.
pub fn agree(laws: &[Law], tables: Option<&[u32]>) {
    let Some(device) = crate::device() else { return };
    println!("{}", device.name());
    let inputs = inputs();
    let wrong: Vec<String> =
        laws.iter().filter_map(|law| compare(&device, law, &inputs, tables).err()).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn laws_agree_with_their_translations() {
    agree(&LAWS, None);
}
