//! The contract of all lights, on one list of configurations: samples, densities and radiance
//! agree.

use crate::common::lights::*;
use crate::common::*;
use alhazen_scene::Interfaces;
use alhazen_scene::light::{Light, LightId, LightSampleContext};
use description::{EdgeMode, SceneDesc, ShapeDesc, ShapeKind, TransformDesc, UvImageDesc, WrapMode};
use image::Projection;
use math::{Normal3, Transform, Vec2, Vec3};
use std::f32::consts::PI;
use testkit::{Chi2, Moments, Random, assert_complete, welch_test};

#[test]
fn every_light_is_tested() {
    let (hittable, delta) = (hittable_lights(), delta_lights());
    let table = hittable.iter().chain(&delta).map(|case| case.light().row().member());
    assert_complete(Light::MEMBERS, table);
}

#[test]
fn samples_have_their_density() {
    let (mut cases, references) = (area_lights(), references());
    cases.extend(portal_lights());
    let tests = cases.len() * references.len();
    for case in &cases {
        let light = case.light();
        for (i, from) in references.iter().enumerate() {
            // Directions without radiance are not samples.
            let density = |w: [f32; 3]| {
                let w = Vec3::from(w).normalize();
                let pdf = light.pdf_li(from, w, None, false) as f64;
                if pdf > 0.0 && arriving(&case.scene, from, w) > 0.0 { pdf } else { 0.0 }
            };
            let sample = |u| Some(seen_sample(&case.scene, light, from, u, false)?.wi.to_array());
            let mut random = Random::new(1);
            if (0..64).all(|_| sample(random.get_2d()).is_none()) {
                assert!((0..64).all(|_| density(uniform_direction(&mut random).to_array()) == 0.0));
                continue;
            }
            check_directions(sample, density, i as u64, tests)
                .unwrap_or_else(|e| panic!("{}, point {i}: {e}", case.name));
        }
    }
}

#[test]
fn samples_of_environments_have_their_density() {
    let from = references()[0];
    let light_from_render = Transform::from_f64(placement()).unwrap().inverse();
    let cases = infinite_lights();
    for case in &cases {
        let (projection, bins) = if case.name.starts_with("panorama") {
            (Projection::LatitudeLongitude, [16, 8])
        } else {
            (Projection::EqualArea, [8, 8])
        };
        for incomplete in [false, true] {
            let light = case.light();
            let sample = |u| {
                let sample = seen_sample(&case.scene, light, &from, u, incomplete)?;
                Some(projection.position(light_from_render.vector(sample.wi)).to_array())
            };
            if case.name == "sky" && incomplete {
                assert!(sample([0.5; 2]).is_none() && light.pdf_li(&from, Vec3::Z, None, true) == 0.0);
                continue;
            }
            // A cell of the square for each pixel: within it the density is constant.
            let density = |p: [f32; 2]| {
                let w = light_from_render.inverse().vector(projection.direction(p.into()));
                let solid_angle = 4.0 * PI as f64 * projection.solid_angle_density(p.into()) as f64;
                solid_angle * light.pdf_li(&from, w.normalize(), None, incomplete) as f64
            };
            Chi2 { bins, samples: 50_000, tests: 2 * cases.len(), ..Chi2::default() }
                .rectangle([[0.0, 1.0]; 2], sample, density)
                .unwrap_or_else(|e| panic!("{}, incomplete {incomplete}: {e}", case.name));
        }
    }
}

#[test]
fn samples_agree_with_pdf_and_radiance() {
    let mut random = Random::new(1);
    for case in hittable_lights() {
        let light = case.light();
        for from in references() {
            for incomplete in [false, true] {
                for _ in 0..500 {
                    let u = random.get_2d();
                    let Some(sample) = seen_sample(&case.scene, light, &from, u, incomplete) else {
                        continue;
                    };
                    assert!((sample.wi.length() - 1.0).abs() < 1e-5, "{}", case.name);
                    let pdf = light.pdf_li(&from, sample.wi, None, incomplete);
                    let arriving = arriving(&case.scene, &from, sample.wi);
                    // At an edge, rounding decides whether the direction hits.
                    if pdf == 0.0 || arriving == 0.0 {
                        continue;
                    }
                    // The error of a density grows at grazing angles.
                    let cos = if light.is_infinite() { 1.0 } else { sample.n.dot(sample.wi).abs() as f64 };
                    let same = |a: f64, b: f64| (a - b).abs() <= 5e-4 / cos * a.max(b);
                    assert!(same(pdf as f64, sample.pdf as f64), "{}: {pdf} {sample:?}", case.name);
                    assert!(same(arriving, sample.l[0] as f64), "{}: {arriving} {sample:?}", case.name);
                }
            }
        }
    }
}

#[test]
fn only_delta_lights_cannot_be_hit() {
    for case in hittable_lights() {
        assert!(!case.light().is_delta(), "{}", case.name);
    }
    for case in delta_lights() {
        assert!(case.light().is_delta() && !case.light().is_infinite(), "{}", case.name);
        assert_eq!(case.light().pdf_li(&references()[0], Vec3::Z, None, false), 0.0, "{}", case.name);
    }
}

/// Irradiance at a point by sampling the light, at the first wavelength.
fn by_light(case: &Case, from: &LightSampleContext, n: Normal3, count: u32, random: &mut Random) -> Moments {
    (0..count)
        .map(|_| match seen_sample(&case.scene, case.light(), from, random.get_2d(), false) {
            Some(s) => f64::from(s.l[0] * n.dot(s.wi).max(0.0) / s.pdf),
            None => 0.0,
        })
        .collect()
}

#[test]
fn irradiance_by_light_and_direction_sampling_agree() {
    let cases = hittable_lights();
    let normals = [Vec3::new(-0.2, 0.1, -1.0).normalize(), Vec3::new(0.1, 0.3, 1.0).normalize()];
    let tests = cases.len() * references().len() * normals.len();
    let mut random = Random::new(2);
    for case in &cases {
        for from in references() {
            for n in normals {
                let by_light = by_light(case, &from, n, 6000, &mut random);
                let by_direction: Moments = (0..12_000)
                    .map(|_| {
                        let w = uniform_direction(&mut random);
                        let cos = n.dot(w).max(0.0) as f64;
                        if cos == 0.0 { 0.0 } else { arriving(&case.scene, &from, w) * cos * 4.0 * PI as f64 }
                    })
                    .collect();
                if by_light.mean == 0.0 && by_direction.mean == 0.0 {
                    continue;
                }
                welch_test(&by_light, &by_direction, tests).unwrap_or_else(|e| panic!("{}: {e}", case.name));
            }
        }
    }
}

#[test]
fn latitude_longitude_and_octahedral_maps_agree() {
    // A brightness that distinguishes directions, also when mirrored or with swapped axes.
    let brightness = |w: Vec3| 2.0 + w.x + 0.5 * w.y + 0.2 * w.z;
    let size = [128, 64];
    let panorama = rgb_image(size[0], size[1], |x, y| {
        let st = Vec2::new((x as f32 + 0.5) / size[0] as f32, (y as f32 + 0.5) / size[1] as f32);
        [brightness(Projection::LatitudeLongitude.direction(st)); 3]
    });
    let square = panorama.image.reproject(Projection::EqualArea).unwrap();
    let back = square.reproject(Projection::LatitudeLongitude).unwrap();
    let cases = [&panorama.image, &square, &back].map(|image| {
        let pixel = |x, y| image.rgb(x, y);
        let scene = scene(&image_sky_of([image.width(), image.height()], None, pixel));
        Case { name: "panorama", scene }
    });
    let from = references()[0];
    let mut random = Random::new(7);
    let light_from_render = Transform::from_f64(placement()).unwrap().inverse();
    let white = arriving(&scene(&image_sky(1, None, |_, _| [1.0; 3])), &from, Vec3::Z);
    for _ in 0..200 {
        let w = uniform_direction(&mut random);
        let expected = f64::from(brightness(light_from_render.vector(w).normalize()));
        let radiance = cases.each_ref().map(|case| arriving(&case.scene, &from, w) / white);
        // Neighbouring pixels differ by 0.06 at most.
        assert!(radiance.iter().all(|found| (found - expected).abs() < 0.1), "{w}: {expected} {radiance:?}");
    }
    for n in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(-1.0, -1.0, -1.0).normalize()] {
        let [original, square, back] =
            cases.each_ref().map(|case| by_light(case, &from, n, 20_000, &mut random));
        welch_test(&original, &square, 8).unwrap_or_else(|e| panic!("{n}: {e}"));
        welch_test(&original, &back, 8).unwrap_or_else(|e| panic!("{n}: {e}"));
    }
}

#[test]
fn mis_compensated_sampling_is_unbiased() {
    let mut cases = infinite_lights();
    cases.extend(stretched_environments());
    let (n, from) = (Vec3::new(0.1, 0.3, 1.0).normalize(), references()[0]);
    let mut random = Random::new(3);
    for case in &cases {
        let light = case.light();
        let uniform = 1.0 / (4.0 * PI);
        let combined: Moments = (0..40_000)
            .map(|_| {
                let sample = seen_sample(&case.scene, light, &from, random.get_2d(), true);
                let by_light =
                    sample.map_or(0.0, |s| s.l[0] * n.dot(s.wi).max(0.0) / (s.pdf + uniform)) as f64;
                let w = uniform_direction(&mut random);
                let density = uniform + light.pdf_li(&from, w, None, true);
                by_light + arriving(&case.scene, &from, w) * f64::from(n.dot(w).max(0.0) / density)
            })
            .collect();
        let whole = by_light(case, &from, n, 40_000, &mut random);
        welch_test(&combined, &whole, cases.len()).unwrap_or_else(|e| panic!("{}: {e}", case.name));
    }
}

#[test]
fn emission_images_are_upright() {
    // Red at the lower left (u, v) = (0, 0), which is the first pixel of the last row.
    let mut desc = area(rectangle([0.0, 0.0], [1.0, 1.0]), one_side);
    let red = |x, y| if (x, y) == (0, 1) { [1.0, 0.0, 0.0] } else { [0.0; 3] };
    let image = desc.images.push(rgb_image(2, 2, red));
    for (_, light) in desc.area_lights.iter_mut() {
        light.image = Some(UvImageDesc::new(image, WrapMode::Clamp));
    }
    let scene = scene(&desc);
    let at = |u, v| {
        let radiance = scene.light(LightId(0)).radiance(Vec3::Z, Vec2::new(u, v), Vec3::Z, &lambda());
        radiance.max_component()
    };
    assert!(at(0.1, 0.1) > 0.0);
    assert_eq!([at(0.9, 0.1), at(0.1, 0.9), at(0.9, 0.9)], [0.0; 3]);
}

/// The lookups of an image whose left half is red.
#[test]
fn emission_images_are_wrapped_filtered_and_moved() {
    use EdgeMode::{Black, Clamp, Repeat};
    let lit = |change: &dyn Fn(UvImageDesc) -> UvImageDesc| {
        let mut desc = area(rectangle([0.0, 0.0], [1.0, 1.0]), one_side);
        let red = |x, _| if x < 2 { [1.0, 0.0, 0.0] } else { [0.0; 3] };
        let image = desc.images.push(rgb_image(4, 4, red));
        for (_, light) in desc.area_lights.iter_mut() {
            light.image = Some(change(UvImageDesc::new(image, WrapMode::Clamp)));
        }
        let scene = scene(&desc);
        move |u, v| {
            let light = scene.light(LightId(0));
            light.radiance(Vec3::Z, Vec2::new(u, v), Vec3::Z, &lambda()).max_component() > 0.0
        }
    };
    let wrapped = |wrap: WrapMode| lit(&move |map| UvImageDesc { wrap, ..map });
    let clamped = wrapped(WrapMode::Clamp);
    assert!(clamped(-0.7, 3.2) && !clamped(1.2, 0.5));
    let repeated = wrapped(WrapMode::Repeat);
    assert!(repeated(1.2, 7.4) && !repeated(-0.3, 0.5));
    let by_axis = wrapped(WrapMode::Axes([Repeat, Black]));
    assert!(by_axis(1.2, 0.5) && !by_axis(1.2, 1.3));
    let by_axis = wrapped(WrapMode::Axes([Clamp, Black]));
    assert!(by_axis(-0.2, 0.5) && !by_axis(1.2, 0.5) && !by_axis(0.2, -0.3));
    // Interpolated, red goes on for half a texel.
    assert!(clamped(0.6, 0.5));
    let nearest = lit(&|map| UvImageDesc { is_nearest: true, ..map });
    assert!(nearest(0.49, 0.5) && !nearest(0.51, 0.5));
    // Turned by a quarter.
    let turned = lit(&|map| UvImageDesc { columns: [[0.0, 1.0], [1.0, 0.0], [0.0, 0.0]], ..map });
    assert!(turned(0.9, 0.2) && !turned(0.2, 0.9));
}

#[test]
fn emission_is_scaled_by_alpha() {
    let alpha = |value: f32| area(disk(0.0, 1.0), move |_, shape| shape.alpha = Some(value.into()));
    let from = context(Vec3::new(0.1, 0.2, 1.5), Vec3::ZERO);
    let mut random = Random::new(8);
    let mut irradiance = |desc: &SceneDesc, count| {
        let case = Case { name: "alpha", scene: scene(desc) };
        // Without the light's own surface, which would occlude some of its samples.
        (0..count)
            .map(|_| {
                let u = random.get_2d();
                let sample = case.light().sample_li(&from, u.into(), &lambda(), false);
                sample.map_or(0.0, |s| f64::from(s.l[0] / s.pdf))
            })
            .collect::<Moments>()
    };
    let whole = irradiance(&alpha(1.0), 10_000);
    let part: Moments = irradiance(&alpha(0.3), 10_000);
    assert!((part.mean / whole.mean - 0.3).abs() < 0.03, "{} {}", part.mean, whole.mean);
    // With alpha 0 it is invisible, but still emits.
    let invisible = scene(&alpha(0.0));
    assert!(invisible.light(LightId(0)).is_delta());
    assert!(hit(&invisible, &ray(from.p.p, -Vec3::Z)).is_none());
    welch_test(&irradiance(&alpha(0.0), 10_000), &whole, 1).unwrap();
}

#[test]
fn infinite_planes_occlude_infinite_lights() {
    // An infinite floor and ceiling, and a small sphere: both planes occlude the sun.
    for ceiling in [false, true] {
        let mut desc = free(distant(None));
        desc.shapes.push(ShapeDesc {
            world_from_object: TransformDesc::translation(0.0, 0.0, -5.0),
            ..ShapeKind::Plane.into()
        });
        if ceiling {
            desc.shapes.push(ShapeDesc {
                world_from_object: TransformDesc::translation(0.0, 0.0, 500.0),
                ..ShapeKind::Plane.into()
            });
        }
        let scene = scene(&desc);
        let floor = hit(&scene, &ray(Vec3::new(3.0, 3.0, 0.0), -Vec3::Z)).unwrap();
        let light = alhazen_scene::light::LightId(0);
        let sample = scene.sample_light(light, &floor.light_context(), Vec2::ZERO, &lambda(), false).unwrap();
        let (ray, t_max) = sample.shadow_ray(&floor.light_context());
        assert_eq!(
            scene.occluded(&ray, t_max, Interfaces::Stop, &mut Default::default()),
            ceiling || sample.wi.z <= 0.0
        );
    }
}
