//! The same numbers through a law on the CPU and through its translation on the GPU.

use crate::laws::LAWS;
use alhazen_gpu::{Buffer, Device, GpuError, shaders};
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
const TABLES: &str = "@group(0) @binding(2) var<storage, read_write> tables: array<vec4u>;";

/// Starts laws on the GPU, which are functions of one shader; those of principled surfaces have
/// tables. What they find is in the buffers that are returned.
fn on_gpu(
    device: &Device,
    laws: &[Law],
    inputs: &[[f32; INPUTS]],
    tables: Option<&[u32]>,
) -> Result<Vec<Buffer>, GpuError> {
    let mut source = format!(
        "@group(0) @binding(0) var<storage, read_write> inputs: array<array<f32, {INPUTS}>>;
        @group(0) @binding(1) var<storage, read_write> outputs: array<array<f32, {OUTPUTS}>>;"
    );
    if tables.is_some() {
        source += TABLES;
        source += shaders::TABLES;
        source += &shaders::principled();
    }
    let names: Vec<String> = (0..laws.len()).map(|i| format!("law_{i}")).collect();
    for (name, law) in names.iter().zip(laws) {
        let body = law.wgsl;
        source += &format!(
            "@compute @workgroup_size(64)
            fn {name}(@builtin(global_invocation_id) id: vec3u) {{
                let x = inputs[id.x];
                let wo = vec3f(x[0], x[1], x[2]);
                let wi = vec3f(x[3], x[4], x[5]);
                let u = vec2f(x[6], x[7]);
                var y: array<f32, {OUTPUTS}>;
                {body}
                outputs[id.x] = y;
            }}"
        );
    }
    let kernels = device.kernels("laws", &shaders::with_laws(&[&source]), &names)?;
    let given = device.buffer("inputs", inputs)?;
    let words = tables.map(|words| device.buffer("tables", words)).transpose()?;
    let started = kernels.iter().map(|kernel| -> Result<Buffer, GpuError> {
        let results = device.zeros("results", (size_of::<[f32; OUTPUTS]>() * inputs.len()) as u64)?;
        let buffers: Vec<&Buffer> = [&given, &results].into_iter().chain(&words).collect();
        device.run(kernel, &buffers, [(inputs.len() / 64) as u32, 1, 1])?;
        Ok(results)
    });
    started.collect()
}

/// The difference of two results as a law's bound counts it.
fn difference(a: f32, b: f32) -> f32 {
    if a == b || a.is_nan() && b.is_nan() { 0.0 } else { (a - b).abs() / a.abs().max(0.01) }
}

/// Compares all results of a law; what is wrong, if anything.
fn compare(law: &Law, inputs: &[[f32; INPUTS]], results: Vec<[f32; OUTPUTS]>) -> Result<(), String> {
    let mut largest = 0f32;
    let mut flips = Vec::new();
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
    // While some are compared the driver compiles the next.
    let results = on_gpu(&device, laws, &inputs, tables).unwrap_or_else(|error| panic!("{error}"));
    let wrong = laws.iter().zip(&results).filter_map(|(law, results)| {
        let results = device.read(results).unwrap_or_else(|error| panic!("{}: {error}", law.name));
        compare(law, &inputs, results).err()
    });
    let wrong: Vec<String> = wrong.collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn laws_agree_with_their_translations() {
    agree(&LAWS, None);
}
