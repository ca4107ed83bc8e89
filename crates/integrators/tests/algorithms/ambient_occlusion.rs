//! Ambient occlusion of points with a known visibility.

use alhazen_integrators::{AmbientOcclusion, Control, RayIntegrator, Tracer};
use description::{AmbientOcclusionDesc, SceneDesc, ShapeKind};
use geometry::RayStats;
use math::{Ray, RayDifferential};
use sampling::Sampler;
use sampling::sampler::Independent;
use scene::Scene;
use spectrum::{CIE_Y_INTEGRAL, RgbColorSpace, SampledWavelengths};
use testkit::Moments;

use crate::support::{assert_mean, compile, quad, v, viewed};

/// A floor with objects on it.
fn on_a_floor(shapes: impl IntoIterator<Item = ShapeKind>) -> Scene {
    let mut desc = SceneDesc::default();
    desc.shapes.push(quad(v(-0.1, -0.1, 0.0), v(0.2, 0.0, 0.0), v(0.0, 0.2, 0.0)).into());
    for shape in shapes {
        desc.shapes.push(shape.into());
    }
    compile(&desc)
}

/// The brightness of the floor's centre, 1 being white of the colour space.
fn brightness(scene: &Scene, cos_sample: bool, max_distance: f32) -> Moments {
    let space = RgbColorSpace::rec2020();
    let rays = AmbientOcclusion::new(AmbientOcclusionDesc { cos_sample, max_distance }, space);
    let ((_, view), control) = (viewed(&SceneDesc::default()), Control::default());
    let mut stats = RayStats::default();
    let mut sampler = Sampler::Independent(Independent::new(1, 3));
    let samples = (0..20_000).map(|i| {
        sampler.start_pixel_sample([i, 0], 0, 0);
        let mut lambda = SampledWavelengths::sample_visible(sampler.get_1d());
        let ray =
            RayDifferential::from(Ray::new(v(-0.3, 0.0, 0.3), v(0.5f32.sqrt(), 0.0, -(0.5f32.sqrt())), 0.0));
        let mut tracer = Tracer::new(scene, &view, &control, &mut sampler, &mut stats);
        let l = rays.li(&mut tracer, ray, &mut lambda);
        f64::from(l[0] / space.illuminant().sample(&lambda)[0] * CIE_Y_INTEGRAL)
    });
    samples.collect()
}

#[test]
fn ambient_occlusion_equals_the_closed_form() {
    let free = on_a_floor([]);
    let beside_a_wall = on_a_floor([quad(v(1e-3, -1e3, 1e-4), v(0.0, 2e3, 0.0), v(0.0, 0.0, 1e3))]);
    // With the maximum distance D, a ceiling at height 1 occludes the directions with cos θ > 1/D.
    let under_a_ceiling = on_a_floor([quad(v(-50.0, -50.0, 1.0), v(100.0, 0.0, 0.0), v(0.0, 100.0, 0.0))]);
    let views = [
        ("free", &free, f32::INFINITY, 1.0),
        ("beside a wall", &beside_a_wall, f32::INFINITY, 0.5),
        ("under a far ceiling", &under_a_ceiling, 0.9, 1.0),
        ("under a near ceiling", &under_a_ceiling, 2.0, 0.25),
    ];
    for (name, scene, max_distance, expected) in views {
        for cos_sample in [true, false] {
            let found = brightness(scene, cos_sample, max_distance);
            assert_mean(&found, expected, 2 * views.len(), &format!("{name}, cosine {cos_sample}"));
        }
    }
}
