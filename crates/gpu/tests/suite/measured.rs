//! Measured surfaces by both engines.

use std::f32::consts::{FRAC_PI_2, PI};
use std::path::Path;
use std::sync::Arc;

use alhazen_gpu::Algorithm;
use assets::MemoryAssets;
use description::{MaterialKind, PathDesc};
use scattering::{MeasuredData, MeasuredGrid, MeasuredTable};

use crate::pictures::{Case, imported};
use crate::texts::MEASURED;

/// Measurements of a surface that were made up, of spectra or of colours.
fn measurements(phi: &[f32], wavelengths: Option<Vec<f32>>) -> Arc<MeasuredTable> {
    let theta = vec![0.0, 0.7, 1.2, FRAC_PI_2];
    let directions = phi.len() * theta.len();
    let grid = |[width, height]: [usize; 2], layers: usize, value: fn(f32, f32, f32) -> f32| {
        let part = |i: usize, n: usize| i as f32 / (n - 1) as f32;
        let point = |i: usize| {
            let layer = (i / (width * height)) as f32;
            value(part(i % width, width), part(i / width % height, height), layer)
        };
        MeasuredGrid { size: [width, height], values: (0..layers * width * height).map(point).collect() }
    };
    let channels = wavelengths.as_ref().map_or(3, Vec::len);
    let data = MeasuredData {
        ndf: grid([9, 8], 1, |x, _, _| 2.0 * (1.0 - x) * (1.0 - x)),
        sigma: grid([9, 8], 1, |x, _, _| 1.0 - 0.8 * x),
        vndf: grid([17, 8], directions, |x, y, layer| {
            x * (x * x * FRAC_PI_2).sin() * (1.0 - x) * (1.2 + (9.0 * y + layer).sin())
        }),
        luminance: grid([9, 5], directions, |x, y, layer| 1.5 + (7.0 * x + 5.0 * y + layer).sin()),
        values: grid([6, 7], directions * channels, |x, y, layer| {
            0.5 + 0.4 * (5.0 * x + 8.0 * y + layer).sin()
        }),
        phi: phi.to_vec(),
        theta,
        wavelengths,
    };
    Arc::new(MeasuredTable::new(data).expect("tables that fit"))
}

#[test]
fn measured_surfaces_have_the_picture_of_the_cpu() {
    let path = Path::new("scene.pbrt");
    let mut desc = imported(path, &MemoryAssets::default().with(path, MEASURED));
    let tables = [
        measurements(&[0.0], Some(vec![400.0, 500.0, 530.0, 700.0])),
        measurements(&[-PI, -1.0, 0.5, PI], None),
    ];
    let is_plastic = |kind: &MaterialKind| matches!(kind, MaterialKind::CoatedDiffuse(_));
    let materials = desc.materials.iter_mut().filter(|(_, material)| is_plastic(&material.value.kind));
    for ((_, material), table) in materials.zip(tables) {
        material.value.kind = MaterialKind::Measured { table };
    }
    let case = Case::described(desc, [64, 48]);
    let settings = PathDesc { max_depth: 3, ..PathDesc::default() };
    assert_eq!(case.compare("measured", &Algorithm::Path(settings)), None);
}
