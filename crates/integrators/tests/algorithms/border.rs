//! The film of a spherical camera is periodic, also for splats of light paths.

use alhazen_integrators::build;
use description::{
    BdptDesc, CameraKind, FilterDesc, IntegratorDesc, LightSamplerDesc, LightTracingDesc, MltDesc,
    MltTechnique, PathDesc, SamplerDesc, SamplerKind, SceneDesc, ShapeDesc, SphericalMapping, VcmDesc,
};
use testkit::{Moments, welch_test};

use crate::support::{diffuse, emission, finished, quad, v, walls};

const RESOLUTION: [i32; 2] = [12, 8];

/// A box with a lamp and walls of different albedos, seen by a spherical camera with a wide filter.
fn all_around(mapping: SphericalMapping) -> SceneDesc {
    let mut desc = SceneDesc::default();
    for (wall, rho) in walls(1.0).into_iter().zip([0.7, 0.1, 0.5, 0.9, 0.2, 0.6]) {
        let material = diffuse(&mut desc, rho);
        desc.shapes.push(ShapeDesc { material, ..wall.into() });
    }
    let area_light = emission(&mut desc, 5.0);
    let lamp = quad(v(0.9, -0.4, 0.1), v(0.0, 0.0, 0.8), v(0.0, 0.8, 0.0));
    desc.shapes.push(ShapeDesc { area_light, ..lamp.into() });
    desc.camera.kind = CameraKind::Spherical { mapping };
    desc.film.resolution = RESOLUTION;
    desc.film.save_fp16 = false;
    desc.filter.value = FilterDesc::Gaussian { radius: [2.5, 2.5], sigma: 1.2 };
    desc
}

/// Means of the rows and columns at the border.
fn borders(desc: &SceneDesc, integrator: &IntegratorDesc, samples: u32, seed: i32) -> [f64; 4] {
    let mut desc = SceneDesc { integrator: integrator.clone().into(), ..desc.clone() };
    let kind = SamplerKind::Independent { pixel_samples: samples };
    desc.sampler.value = SamplerDesc { kind, seed: Some(seed) };
    let image = finished(&desc, build(&desc).unwrap().integrator).state().film.develop().unwrap();
    let [width, height] = RESOLUTION.map(|n| n as u32);
    let row = |y| (0..width).map(|x| f64::from(image.rgb(x, y)[1])).sum::<f64>() / f64::from(width);
    let column = |x| (0..height).map(|y| f64::from(image.rgb(x, y)[1])).sum::<f64>() / f64::from(height);
    [row(0), row(height - 1), column(0), column(width - 1)]
}

#[test]
fn pixels_at_the_border_receive_light_from_both_sides() {
    let light_sampler = LightSamplerDesc::Bvh;
    let path = IntegratorDesc::Path(PathDesc { max_depth: 2, regularize: false, light_sampler });
    let mlt = MltDesc {
        technique: MltTechnique::Bdpt,
        max_depth: 2,
        mutations_per_pixel: 400,
        ..MltDesc::default()
    };
    let algorithms = [
        (IntegratorDesc::LightTracing(LightTracingDesc { max_depth: 2 }), 32),
        (
            IntegratorDesc::Bdpt(BdptDesc {
                max_depth: 2,
                regularize: false,
                visualize_strategies: false,
                visualize_weights: false,
            }),
            32,
        ),
        (IntegratorDesc::Vcm(VcmDesc { max_depth: 2, radius: Some(0.01), ..VcmDesc::default() }), 32),
        (IntegratorDesc::Mlt(mlt), 1),
    ];
    for mapping in [SphericalMapping::EquiRectangular, SphericalMapping::EqualArea] {
        let desc = all_around(mapping);
        let moments = |integrator: &IntegratorDesc, samples, first_seed: i32| {
            let mut moments = [Moments::default(); 4];
            for seed in first_seed..first_seed + 12 {
                let found = borders(&desc, integrator, samples, seed);
                moments.iter_mut().zip(found).for_each(|(moments, mean)| moments.push(mean));
            }
            moments
        };
        let expected = moments(&path, 64, 100);
        for (integrator, samples) in &algorithms {
            let found = moments(integrator, *samples, 0);
            for (side, (found, expected)) in found.iter().zip(&expected).enumerate() {
                let error = found.variance_of_mean().sqrt() / expected.mean;
                assert!(
                    error < 0.06,
                    "{mapping:?}, {integrator:?}: the error {error} is too large for a test"
                );
                welch_test(found, expected, 32)
                    .unwrap_or_else(|e| panic!("{mapping:?}, {integrator:?}, side {side}: {e}"));
            }
        }
    }
}
