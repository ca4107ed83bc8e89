//! The contract of emission from all lights: densities, power, and agreement with light sampling.

use crate::common::lights::*;
use crate::common::*;
use alhazen_scene::light::{Light, LightId, LightLeSample};
use alhazen_scene::light_sampler::PowerLightSampler;
use alhazen_scene::{Interfaces, RayStats};
use description::TransformDesc;
use math::{DMat4, DVec3, Frame, Ray, Vec2, Vec3};
use std::f32::consts::{PI, TAU};
use testkit::{Chi2, Moments, Random, t_test, welch_test};

fn all_lights() -> Vec<Case> {
    let mut lights = hittable_lights();
    lights.extend(delta_lights());
    lights
}

fn emit(case: &Case, random: &mut Random) -> Option<LightLeSample> {
    let [u, v] = [(); 2].map(|()| random.get_2d().into());
    case.light().sample_le(u, v, TIME, &lambda())
}

#[test]
fn emitted_rays_carry_the_power() {
    let cases = all_lights();
    let mut random = Random::new(1);
    for case in &cases {
        // The power of an image assumes that (u, v) is uniform by area, which it is not on a disk.
        if case.name == "disk, image" {
            continue;
        }
        let carried: Moments = (0..20_000)
            .map(|_| emit(case, &mut random).map_or(0.0, |ray| f64::from(ray.beta()[0])))
            .collect();
        let phi = f64::from(case.light().phi(&lambda())[0]);
        // The area of a bent patch is known approximately.
        if case.name == "bent patch" || carried.variance_of_mean().sqrt() < 1e-5 * phi {
            let tolerance = if case.name == "bent patch" { 0.01 } else { 1e-4 };
            assert!((carried.mean / phi - 1.0).abs() < tolerance, "{}: {} {phi}", case.name, carried.mean);
        } else {
            t_test(&carried, phi, cases.len()).unwrap_or_else(|e| panic!("{}: {e}", case.name));
        }
    }
}

#[test]
fn emitted_rays_have_their_densities() {
    let mut random = Random::new(2);
    let same = |a: f32, b: f32| (a - b).abs() <= 1e-4 * a.max(b);
    for case in all_lights() {
        let light = case.light();
        for _ in 0..500 {
            let Some(sample) = emit(&case, &mut random) else { continue };
            assert!((sample.ray.d.length() - 1.0).abs() < 1e-5 && sample.ray.time == TIME, "{}", case.name);
            assert!(sample.pdf_position > 0.0 && sample.pdf_direction > 0.0, "{}", case.name);
            assert_eq!(light.is_distant(), sample.p.is_none(), "{}", case.name);
            // The ray in the opposite direction.
            let back = Ray::new(sample.ray.at(10.0), -sample.ray.d, TIME);
            let far = light.pdf_le_infinite(&back);
            let Some(p) = sample.p else {
                let direction = if light.is_delta() { 0.0 } else { sample.pdf_direction };
                assert!(same(far.0, sample.pdf_position) && same(far.1, direction), "{}: {far:?}", case.name);
                assert_eq!(
                    light.pdf_le(Vec3::ZERO, Vec3::Z, sample.ray.d, TIME),
                    (0.0, 0.0),
                    "{}",
                    case.name
                );
                continue;
            };
            assert_eq!(far, (0.0, 0.0), "{}", case.name);
            let near = light.pdf_le(p.p, sample.n, sample.ray.d, TIME);
            let position = if light.is_delta() { 0.0 } else { sample.pdf_position };
            assert!(same(near.0, position), "{}: {near:?} {sample:?}", case.name);
            // A cosine near 0 has a large relative error.
            let same_direction = (near.1 - sample.pdf_direction).abs() < 1e-4 * near.1 + 1e-6;
            assert!(same_direction, "{}: {near:?} {sample:?}", case.name);
        }
    }
}

#[test]
fn emitted_directions_have_their_density() {
    let cases = area_lights();
    for (i, case) in cases.iter().enumerate() {
        let light = case.light();
        let mut random = Random::new(i as u64);
        // Around the normal the distribution does not depend on the position.
        let direction = |u: [f32; 2]| {
            let place = random.get_2d().into();
            let sample = light.sample_le(place, u.into(), TIME, &lambda())?;
            Some(Frame::from_z(sample.n).to_local(sample.ray.d).to_array())
        };
        let chi2 = Chi2 { samples: 50_000, tests: cases.len(), ..Chi2::default() };
        chi2.sphere(direction, |w| f64::from(light.pdf_le(Vec3::ZERO, Vec3::Z, w.into(), TIME).1))
            .unwrap_or_else(|e| panic!("{}: {e}", case.name));
    }
}

#[test]
fn directions_of_images_have_their_density() {
    let stretch = DMat4::from_scale(DVec3::new(1.5, -0.7, 1.0)) * DMat4::from_rotation_y(0.4);
    let mut stretched = [goniometric(None), projection(None)];
    for (_, light) in stretched.iter_mut().flat_map(|desc| desc.lights.iter_mut()) {
        light.world_from_light = TransformDesc::fixed(placement() * stretch);
    }
    let mut cases: Vec<Case> =
        stretched.iter().map(|desc| Case { name: "stretched", scene: scene(desc) }).collect();
    cases.extend(delta_lights().drain(4..));
    cases.extend(portal_lights());
    for (i, case) in cases.iter().enumerate() {
        let light = case.light();
        let sample = |u: [f32; 2]| {
            let sample = light.sample_le(Vec2::splat(0.5), u.into(), TIME, &lambda())?;
            Some((if light.is_distant() { -sample.ray.d } else { sample.ray.d }).to_array())
        };
        let density = |w: [f32; 3]| {
            let w = Vec3::from(w).normalize();
            let (_, pdf) = if light.is_distant() {
                // Through the middle of the portal.
                light.pdf_le_infinite(&Ray::new(Vec3::new(0.0, 0.25, 3.15) - 0.1 * w, w, TIME))
            } else {
                light.pdf_le(Vec3::ZERO, Vec3::ZERO, w, TIME)
            };
            f64::from(pdf)
        };
        check_directions(sample, density, i as u64, cases.len())
            .unwrap_or_else(|e| panic!("{}: {e}", case.name));
    }
}

#[test]
fn light_enters_uniformly_through_a_portal() {
    for (i, case) in portal_lights().iter().enumerate() {
        let mut random = Random::new(i as u64);
        let position = |u: [f32; 2]| {
            let sample = case.light().sample_le(u.into(), random.get_2d().into(), TIME, &lambda())?;
            let o = sample.ray.o - Vec3::new(-1.5, -1.0, 3.0);
            assert!((o.z - 0.1 * o.x).abs() < 1e-5, "{o}");
            Some([o.x / 3.0, o.y / 2.5])
        };
        Chi2 { samples: 50_000, tests: 3, ..Chi2::default() }
            .rectangle([[0.0, 1.0]; 2], position, |_| 1.0)
            .unwrap_or_else(|e| panic!("{}: {e}", case.name));
        // No light passes beside the portal, or from beyond it.
        for (o, w) in [(Vec3::X * 9.0, Vec3::Z), (Vec3::Z * 4.0, Vec3::Z), (Vec3::ZERO, -Vec3::Z)] {
            let ray = Ray::new(o, w, TIME);
            assert_eq!(case.light().pdf_le_infinite(&ray), (0.0, 0.0), "{}", case.name);
            assert!(case.light().le(&ray, &lambda()).is_black(), "{}", case.name);
        }
    }
}

#[test]
fn directions_of_spots_have_their_density() {
    for case in &delta_lights()[1..3] {
        let Light::Spot(light) = case.light().row() else { unreachable!() };
        let frame = Frame::from_z(light.axis);
        let direction = |u: [f32; 2]| {
            let sample = case.light().sample_le(Vec2::ZERO, u.into(), TIME, &lambda())?;
            let w = frame.to_local(sample.ray.d);
            Some([w.z, w.y.atan2(w.x).rem_euclid(TAU)])
        };
        let density = |[z, phi]: [f32; 2]| {
            let w = math::spherical_direction((1.0 - z * z).max(0.0).sqrt(), z, phi);
            f64::from(case.light().pdf_le(light.p, Vec3::ZERO, frame.from_local(w), TIME).1)
        };
        Chi2 { samples: 50_000, tests: 2, ..Chi2::default() }
            .rectangle([[light.cos_falloff_end, 1.0], [0.0, TAU]], direction, density)
            .unwrap_or_else(|e| panic!("{}: {e}", case.name));
    }
}

/// In parallel projection along some direction, a density p per area becomes p/|cos θ| per
/// projected area, summed over all layers. At the silhouettes of curved surfaces, where it is
/// unbounded, cells are not tested one by one.
#[test]
fn emitted_positions_have_their_density() {
    let cases = area_lights();
    let view = Frame::from_z(Vec3::new(0.8, -0.5, 0.7).normalize());
    let (side, fine, size, count) = (12, 40, 4.0, 5_000);
    let is_oblique = |n: Vec3| n.dot(view.z).abs() < 0.2;
    for (i, case) in cases.iter().enumerate() {
        let mut expected = vec![0.0; side * side + 1];
        for y in 0..side * fine {
            for x in 0..side * fine {
                let at = |i: usize| ((i as f32 + 0.5) / (side * fine) as f32 - 0.5) * size;
                let mut ray = ray(view.from_local(Vec3::new(at(x), at(y), -3.0)), view.z);
                while let Some(surface) = hit(&case.scene, &ray) {
                    let s = &surface.surface;
                    if !is_oblique(s.n) {
                        let density = case.light().pdf_le(s.p.p, s.n, s.n, TIME).0 / s.n.dot(view.z).abs();
                        expected[y / fine * side + x / fine] += f64::from(density);
                    }
                    ray = surface.spawn_ray(view.z);
                }
            }
        }
        let area = f64::from(size).powi(2) / ((side * fine) as f64).powi(2);
        expected.iter_mut().for_each(|e| *e *= area * f64::from(count));
        let rest = f64::from(count) - expected.iter().sum::<f64>();
        let most = if case.name.starts_with(['s', 'c']) { 0.25 } else { 0.005 };
        let share: f64 = rest / f64::from(count);
        assert!((-0.005..most).contains(&share), "{}: the density leaves {share}", case.name);
        expected[side * side] = rest.max(1e-3);
        let mut observed = vec![0; expected.len()];
        let mut random = Random::new(i as u64);
        for _ in 0..count {
            let Some(LightLeSample { p: Some(p), n, .. }) = emit(case, &mut random) else { continue };
            let p = view.to_local(p.p);
            let cell = |x: f32| ((x / size + 0.5) * side as f32) as usize;
            observed[if is_oblique(n) { side * side } else { cell(p.y) * side + cell(p.x) }] += 1;
        }
        Chi2 { tests: cases.len(), ..Chi2::default() }
            .counts(&observed, &expected)
            .unwrap_or_else(|e| panic!("{}: {e}", case.name));
    }
}

#[test]
fn distant_light_is_uniform_over_the_scene_disk() {
    let mut cases = infinite_lights();
    cases.push(delta_lights().remove(3));
    for (i, case) in cases.iter().enumerate() {
        let (sphere, mut random) = (case.scene.sphere(), Random::new(i as u64));
        let position = |u: [f32; 2]| {
            let direction = random.get_2d().into();
            let sample = case.light().sample_le(u.into(), direction, TIME, &lambda())?;
            let o = Frame::from_z(-sample.ray.d).to_local(sample.ray.o - sphere.center) / sphere.radius;
            assert!((o.z - 1.0).abs() < 1e-4, "{}: rays start beyond the sphere", case.name);
            let radius = o.truncate().length();
            Some([radius * radius, o.y.atan2(o.x).rem_euclid(TAU)])
        };
        Chi2 { samples: 50_000, tests: cases.len(), ..Chi2::default() }
            .rectangle([[0.0, 1.0], [0.0, TAU]], position, |_| f64::from(0.5 / PI))
            .unwrap_or_else(|e| panic!("{}: {e}", case.name));
        let beside = Ray::new(sphere.center + Vec3::X * (1.01 * sphere.radius), Vec3::Z, TIME);
        let before = Ray::new(sphere.center - Vec3::Z * (1.01 * sphere.radius), -Vec3::Z, TIME);
        for ray in [beside, before] {
            assert_eq!(case.light().pdf_le_infinite(&ray).0, 0.0, "{}: light does not pass there", case.name);
        }
    }
}

#[test]
fn emitted_rays_do_not_hit_their_own_surface() {
    let mut random = Random::new(5);
    for case in area_lights() {
        for _ in 0..2_000 {
            let Some(sample) = emit(&case, &mut random) else { continue };
            let is_outside = sample.n.dot(sample.ray.d) > 0.0;
            let met = hit(&case.scene, &sample.ray).map(|surface| surface.p().distance(sample.ray.o));
            match case.name {
                "bent patch" => {}
                // Across the sphere, by the chord.
                "sphere, both sides" if !is_outside => {
                    let chord = -1.6 * sample.n.dot(sample.ray.d);
                    assert!((met.unwrap() - chord).abs() < 1e-4, "{met:?} {chord}");
                }
                "cylinder, both sides" | "cone" | "stretched sphere" if !is_outside => {}
                _ => assert_eq!(met, None, "{}: {sample:?}", case.name),
            }
        }
    }
}

/// The flux onto a disk by emitted rays equals that by light sampling from its points.
#[test]
fn emitted_and_sampled_irradiance_agree() {
    let cases = all_lights();
    for (i, case) in cases.iter().enumerate() {
        let (light, sphere) = (case.light(), case.scene.sphere());
        let mut random = Random::new(100 + i as u64);
        let n = Vec3::new(-0.2, 0.1, -1.0).normalize();
        let enters_portal = case.name.starts_with("portal");
        let (center, radius, n) = if enters_portal {
            (Vec3::new(0.3, 0.2, 2.0), 1.0, -n)
        } else if light.is_distant() {
            (sphere.center + Vec3::new(0.2, -0.1, 0.3) * sphere.radius, 0.5 * sphere.radius, -n)
        } else {
            (Vec3::new(0.3, 0.2, 2.0), 1.0, n)
        };
        let by_rays: Moments = (0..40_000)
            .map(|_| {
                let Some(sample) = emit(case, &mut random) else { return 0.0 };
                let ray = &sample.ray;
                let t = n.dot(center - ray.o) / n.dot(ray.d);
                let falls_in = n.dot(ray.d) < 0.0 && t > 0.0 && ray.at(t).distance(center) < radius;
                let stats = &mut RayStats::default();
                let arrives =
                    falls_in && (light.is_distant() || !case.scene.occluded(ray, t, Interfaces::Stop, stats));
                if arrives { f64::from(sample.beta()[0]) / f64::from(PI * radius * radius) } else { 0.0 }
            })
            .collect();
        let frame = Frame::from_z(n);
        let by_points: Moments = (0..20_000)
            .map(|_| {
                let place = sampling::warp::sample_uniform_disk_concentric(random.get_2d().into());
                let from = context(center + frame.from_local(place.extend(0.0)) * radius, Vec3::ZERO);
                let sample = seen_sample(&case.scene, light, &from, random.get_2d(), false);
                sample.map_or(0.0, |s| f64::from(s.l[0] * n.dot(s.wi).max(0.0) / s.pdf))
            })
            .collect();
        welch_test(&by_rays, &by_points, cases.len()).unwrap_or_else(|e| panic!("{}: {e}", case.name));
        let expects_light = !case.name.contains("reversed");
        assert_eq!(by_points.mean > 0.0, expects_light, "{}", case.name);
    }
}

#[test]
fn emission_is_scaled_by_alpha() {
    let mut random = Random::new(6);
    let mut power = |alpha: f32| -> Moments {
        let desc = area(disk(0.0, 1.0), |_, shape| shape.alpha = Some(alpha.into()));
        let case = Case { name: "alpha", scene: scene(&desc) };
        (0..20_000).map(|_| emit(&case, &mut random).map_or(0.0, |ray| f64::from(ray.beta()[0]))).collect()
    };
    let whole = power(1.0).mean;
    t_test(&power(0.3), 0.3 * whole, 1).unwrap();
    // With alpha 0 it is invisible, but emits.
    assert!((power(0.0).mean / whole - 1.0).abs() < 1e-4);
}

#[test]
fn dark_and_empty_light_tables_emit_nothing() {
    let none = PowerLightSampler::default();
    assert!(none.sample(0.5).is_none());
    let dark = scene(&area(disk(0.0, 1.0), |light, _| light.scale = 0.0));
    let sampler = PowerLightSampler::new(dark.lights());
    assert_eq!(sampler.sample(0.5), Some((LightId(0), 1.0)));
    let case = Case { name: "dark", scene: dark };
    assert!(emit(&case, &mut Random::new(8)).is_none());
}
