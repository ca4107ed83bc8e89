//! Power, irradiance in closed form, falloff, and requested power and illuminance.

use crate::common::lights::*;
use crate::common::*;
use alhazen_scene::light::{Light, LightId};
use description::{
    AreaLightDesc, InfiniteRadiance, LightKind, SceneDesc, ShapeDesc, ShapeKind, SpectrumDesc, TransformDesc,
};
use geometry::GeometryId;
use math::{Vec2, Vec3};
use sampling::warp;
use std::f32::consts::PI;
use testkit::{Moments, Random, t_test};

#[test]
fn power_is_the_emitted_flux() {
    let (areas, lambda) = (area_lights(), lambda());
    let mut random = Random::new(4);
    for case in &areas {
        // The power of an image assumes that (u, v) is uniform by area, which it is not on a disk.
        if case.name == "disk, image" {
            continue;
        }
        // For instanced and moving lights, emitted rays are the test.
        let geometry = case.scene.world().geometry(GeometryId(0));
        if !case.scene.instances().is_empty() || geometry.is_moving() {
            continue;
        }
        let shape = geometry.shape(0).unwrap();
        let leaving: Moments = (0..20_000)
            .map(|_| {
                let s = shape.sample(Vec2::from(random.get_2d())).unwrap();
                // Cosine-distributed to either side.
                let sides = [s.n, -s.n].map(|n| {
                    let local = warp::sample_cosine_hemisphere(Vec2::from(random.get_2d()));
                    let w = math::Frame::from_z(n).from_local(local);
                    case.light().radiance(s.n, s.uv, w, &lambda)[0]
                });
                f64::from((sides[0] + sides[1]) * PI / s.pdf)
            })
            .collect();
        let phi = case.light().phi(&lambda)[0] as f64;
        // The area of a bent patch is known approximately.
        if case.name == "bent patch" {
            assert!((leaving.mean / phi - 1.0).abs() < 0.01, "{}: {} {phi}", case.name, leaving.mean);
        } else if leaving.variance_of_mean().sqrt() < 1e-5 * phi {
            assert!((leaving.mean / phi - 1.0).abs() < 1e-4, "{}: {} {phi}", case.name, leaving.mean);
        } else {
            t_test(&leaving, phi, areas.len()).unwrap_or_else(|e| panic!("{}: {e}", case.name));
        }
    }
}

#[test]
fn power_of_point_lights_is_the_flux_through_a_sphere() {
    let lambda = lambda();
    let mut random = Random::new(5);
    for case in delta_lights().iter().filter(|case| case.name != "distant") {
        let (p, _) = place(case.light());
        let passing: Moments = (0..50_000)
            .map(|_| {
                let from = context(p + 2.0 * uniform_direction(&mut random), Vec3::ZERO);
                let sample = seen_sample(&case.scene, case.light(), &from, [0.0; 2], false);
                sample.map_or(0.0, |s| f64::from(s.l[0] * 4.0 * PI * 4.0))
            })
            .collect();
        let phi = case.light().phi(&lambda)[0] as f64;
        if case.name == "point" {
            assert!((passing.mean / phi - 1.0).abs() < 1e-5);
        } else {
            t_test(&passing, phi, 4).unwrap_or_else(|e| panic!("{}: {e}", case.name));
        }
    }
}

#[test]
fn power_of_infinite_lights_is_the_flux_onto_the_scene() {
    let lambda = lambda();
    let mut random = Random::new(6);
    let cases = infinite_lights();
    for case in &cases {
        let cross_section = PI * case.scene.sphere().radius.powi(2);
        let falling: Moments = (0..50_000)
            .map(|_| {
                let ray = ray(Vec3::ZERO, uniform_direction(&mut random));
                f64::from(case.light().le(&ray, &lambda)[0] * 4.0 * PI * cross_section)
            })
            .collect();
        let phi = case.light().phi(&lambda)[0] as f64;
        if falling.variance_of_mean().sqrt() < 1e-5 * phi {
            assert!((falling.mean / phi - 1.0).abs() < 1e-3, "{}: {} {phi}", case.name, falling.mean);
        } else {
            t_test(&falling, phi, cases.len()).unwrap_or_else(|e| panic!("{}: {e}", case.name));
        }
    }
    let case = &delta_lights()[3];
    let irradiance = seen_sample(&case.scene, case.light(), &references()[0], [0.0; 2], false).unwrap().l[0];
    let phi = case.light().phi(&lambda)[0];
    assert!((phi / (irradiance * PI * case.scene.sphere().radius.powi(2)) - 1.0).abs() < 1e-5);
}

#[test]
fn irradiance_in_closed_form() {
    // Lights above the origin that face down; the receiver faces up.
    let above = |shape: ShapeKind, height: f64| {
        area(shape, |light, shape| {
            light.two_sided = true;
            shape.world_from_object = TransformDesc::translation(0.0, 0.0, height);
        })
    };
    let corner = |a: f32, b: f32| {
        let term = |a: f32, b: f32| {
            let root = (1.0 + a * a).sqrt();
            a / root * (b / root).atan()
        };
        0.5 * (term(a, b) + term(b, a))
    };
    let two_triangles = triangles(
        &[[0.0, 0.0, 0.0], [1.5, 0.0, 0.0], [1.5, 0.8, 0.0], [0.0, 0.8, 0.0]],
        &[[0, 1, 2], [0, 2, 3]],
    );
    let [right, up] = [Vec3::X * 1.5, Vec3::Y * 0.8];
    let aperture = LightKind::Infinite {
        radiance: InfiniteRadiance::Constant(white()),
        illuminance: None,
        portal: Some([Vec3::ZERO, up, up + right, right].map(|p| p + Vec3::Z * 1.2)),
    };
    let cases = [
        ("disk", above(disk(0.0, 0.7), 1.3), PI * 0.7f32.powi(2) / (0.7f32.powi(2) + 1.3f32.powi(2))),
        ("sphere", above(sphere(0.7), 1.3), PI * (0.7f32 / 1.3).powi(2)),
        ("rectangle", above(rectangle([0.0, 0.0], [1.5, 0.8]), 1.2), corner(1.5 / 1.2, 0.8 / 1.2)),
        ("triangles", above(two_triangles, 1.2), corner(1.5 / 1.2, 0.8 / 1.2)),
        ("sky", free(sky(None)), PI),
        ("portal", free(aperture), corner(1.5 / 1.2, 0.8 / 1.2)),
    ];
    let from = context(Vec3::new(0.0, 0.0, 0.0), Vec3::Z);
    let from_space = context(Vec3::ZERO, Vec3::ZERO);
    let mut random = Random::new(7);
    for (name, desc, over_radiance) in &cases {
        let scene = scene(desc);
        let radiance = 100.0 / spectrum::Spectrum::Constant(100.0).to_photometric();
        for from in [from, from_space] {
            // One sample of every light is one estimate of the sum.
            let estimates: Moments = (0..20_000)
                .map(|_| {
                    let one = |light| match seen_sample(&scene, light, &from, random.get_2d(), false) {
                        Some(s) => f64::from(s.l[0] * s.wi.z.max(0.0) / s.pdf),
                        None => 0.0,
                    };
                    scene.lights().iter().map(one).sum::<f64>()
                })
                .collect();
            let expected = (radiance * over_radiance) as f64;
            if estimates.variance_of_mean().sqrt() < 1e-5 * expected {
                assert!((estimates.mean / expected - 1.0).abs() < 1e-4, "{name}");
            } else {
                t_test(&estimates, expected, 2 * cases.len()).unwrap_or_else(|e| panic!("{name}: {e}"));
            }
        }
    }
}

/// Irradiance on a plane at a known distance and angle.
#[test]
fn irradiance_of_delta_lights_in_closed_form() {
    let unit = 100.0 / spectrum::Spectrum::Constant(100.0).to_photometric();
    let even = |value: f32| rgb_image(4, 4, move |_, _| [value; 3]);
    let flat = free_with_image(even(3.0), |image| LightKind::Goniometric {
        intensity: white(),
        power: None,
        image: Some(image),
    });
    let slide = |power| {
        free_with_image(even(3.0), |image| LightKind::Projection { image: Some(image), power, fov: 90.0 })
    };
    let illuminant = spectrum::RgbColorSpace::srgb();
    let day = spectrum::Spectrum::rgb_illuminant(illuminant, spectrum::Rgb::new(3.0, 3.0, 3.0));
    let day = day.sample(&lambda())[0] / day.to_photometric();
    // A quarter of a square pyramid with the slope 1: a side of a cube.
    let side_of_cube = 4.0 * PI / 6.0;
    let watt = day / 3.0 * 60.0 / side_of_cube;
    for (name, desc, intensity) in [
        ("point", free(point(None)), unit),
        ("point of a power", free(point(Some(60.0))), unit * 60.0 / (4.0 * PI)),
        ("spot", free(spot(40.0, 15.0, None)), unit),
        ("goniometric", flat, 3.0 * unit),
        ("projection", slide(None), day),
        ("projection of a power", slide(Some(60.0)), watt),
    ] {
        let scene = scene(&desc);
        let light = scene.light(LightId(0));
        let (p, axis) = place(light);
        let n = (-axis + 0.3 * Vec3::X).normalize();
        for distance in [0.5, 3.0] {
            let from = context(p + axis * distance, n);
            let sample = seen_sample(&scene, light, &from, [0.0; 2], false).unwrap();
            let expected = intensity * n.dot(-axis) / (distance * distance);
            let irradiance = sample.l[0] * n.dot(sample.wi);
            assert!((irradiance / expected - 1.0).abs() < 2e-3, "{name}: {irradiance} {expected}");
        }
    }
    let sun = scene(&free(distant(Some(500.0))));
    let sample = seen_sample(&sun, sun.light(LightId(0)), &context(Vec3::ZERO, Vec3::Z), [0.0; 2], false);
    assert!((sample.unwrap().l[0] / (500.0 * unit) - 1.0).abs() < 1e-4);
}

#[test]
fn point_lights_fall_off_with_squared_distance() {
    for case in delta_lights().iter().filter(|case| case.name != "distant") {
        let (p, axis) = place(case.light());
        let at = |distance: f32| {
            let from = context(p + axis * distance, Vec3::ZERO);
            seen_sample(&case.scene, case.light(), &from, [0.0; 2], false).unwrap().l[0] * distance * distance
        };
        for distance in [0.3, 2.0, 70.0] {
            assert!((at(distance) / at(1.0) - 1.0).abs() < 1e-5, "{}", case.name);
        }
        // At the position of the light the radiance is zero rather than infinite.
        let inside = context(p, Vec3::ZERO);
        assert!(seen_sample(&case.scene, case.light(), &inside, [0.0; 2], false).is_none());
    }
}

#[test]
fn spots_fall_off_smoothly_within_their_cone() {
    let [soft, hard] = [1, 2].map(|i| delta_lights().remove(i));
    for (case, start, end) in [(soft, 25f32, 40f32), (hard, 60.0, 60.0)] {
        let Light::Spot(light) = case.light().row() else { unreachable!() };
        let frame = math::Frame::from_z(light.axis);
        let at = |degrees: f32| {
            let theta = degrees.to_radians();
            let w = frame.from_local(math::spherical_direction(theta.sin(), theta.cos(), 1.0));
            let from = context(light.p + w, Vec3::ZERO);
            seen_sample(&case.scene, case.light(), &from, [0.0; 2], false).map_or(0.0, |s| s.l[0])
        };
        let (full, cos) = (at(0.0), |degrees: f32| degrees.to_radians().cos());
        for degrees in [5.0, 24.0, 26.0, 30.0, 35.0, 39.0, 41.0, 59.0, 61.0, 120.0] {
            let t = if start == end {
                if degrees < end { 1.0 } else { 0.0 }
            } else {
                ((cos(degrees) - cos(end)) / (cos(start) - cos(end))).clamp(0.0, 1.0)
            };
            let expected = full * t * t * (3.0 - 2.0 * t);
            assert!((at(degrees) - expected).abs() < 1e-4 * full, "{} at {degrees}°", case.name);
        }
    }
}

/// ∫ f(λ) ȳ(λ) dλ of `f`, which is evaluated at four wavelengths.
fn photometric(f: impl Fn(&spectrum::SampledWavelengths) -> spectrum::SampledSpectrum) -> f64 {
    let count = 2000;
    let sum: f64 = (0..count)
        .map(|i| {
            let lambda = spectrum::SampledWavelengths::sample_uniform((i as f32 + 0.5) / count as f32);
            spectrum::y_from(&f(&lambda), &lambda) as f64
        })
        .sum();
    sum / count as f64 * spectrum::CIE_Y_INTEGRAL as f64
}

#[test]
fn a_scale_of_one_is_a_luminance_of_one() {
    let warm = SpectrumDesc::Blackbody(3000.0);
    let mut desc = area(disk(0.0, 1.0), |light, _| {
        light.radiance = warm.clone();
        light.scale = 2.5;
    });
    let of = |desc: &SceneDesc| {
        let scene = scene(desc);
        photometric(|lambda| scene.light(LightId(0)).radiance(Vec3::Z, Vec2::splat(0.5), Vec3::Z, lambda))
    };
    assert!((of(&desc) / 2.5 - 1.0).abs() < 1e-3);
    // The components of a colour are factors on white.
    for (_, light) in desc.area_lights.iter_mut() {
        light.radiance = SpectrumDesc::rgb(3.0, 3.0, 3.0);
    }
    assert!((of(&desc) / 7.5 - 1.0).abs() < 2e-3);
}

#[test]
fn requested_power_and_illuminance_are_met() {
    let power = |desc: &SceneDesc| {
        let scene = scene(desc);
        photometric(|lambda| scene.light(LightId(0)).phi(lambda))
    };
    let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 2e-3, "{a} {b}");
    near(power(&free(point(Some(60.0)))), 60.0);
    near(power(&free(spot(50.0, 20.0, Some(60.0)))), 60.0);
    near(power(&goniometric(Some(60.0))), 60.0);
    let powerful = |light: &mut AreaLightDesc, _: &mut ShapeDesc| light.power = Some(60.0);
    near(power(&area(sphere(0.7), powerful)), 60.0);
    let both = area(disk(0.0, 0.7), |light, shape| {
        powerful(light, shape);
        light.two_sided = true;
    });
    near(power(&both), 60.0);
    let mut image = with_image(rectangle([-1.0, -1.0], [1.0, 1.0]));
    for (_, light) in image.area_lights.iter_mut() {
        light.power = Some(60.0);
    }
    // Spectra from colours keep their luminance only approximately.
    for desc in [image, projection(Some(60.0))] {
        assert!((power(&desc) / 60.0 - 1.0).abs() < 1e-2, "{}", power(&desc));
    }

    let facing = |desc: &SceneDesc| {
        let scene = scene(desc);
        let light = &scene.light(LightId(0));
        photometric(|lambda| light.le(&ray(Vec3::ZERO, Vec3::Z), lambda)) * PI as f64
    };
    near(facing(&free(sky(Some(500.0)))), 500.0);
    // The format halves the illuminance of images; see `upward_illuminance`.
    near(facing(&image_sky(64, Some(500.0), |_, _| [0.3; 3])), 1000.0);
    let sun = scene(&free(distant(Some(500.0))));
    near(
        photometric(|lambda| {
            let from = context(Vec3::ZERO, Vec3::ZERO);
            sun.light(LightId(0)).sample_li(&from, Vec2::ZERO, lambda, false).unwrap().l
        }),
        500.0,
    );
}

#[test]
fn degenerate_lights_have_zero_power() {
    let degenerate = triangles(&[[0.0; 3], [1.0; 3], [0.0, 1.0, 0.0]], &[[0, 1, 1], [0, 1, 2]]);
    let scene = scene(&area(degenerate, |light, _| light.power = Some(10.0)));
    let [flat, whole] = [0, 1].map(|i| scene.light(LightId(i)).phi(&lambda())[0]);
    assert_eq!(flat, 0.0);
    assert!(whole.is_finite() && whole > 0.0);
}
