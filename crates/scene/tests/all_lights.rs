//! What every light must do, on one list of configured lights.

mod common;

use alhazen_scene::Scene;
use alhazen_scene::light::{Light, LightSampleContext};
use common::*;
use description::{
    AreaLightDesc, InfiniteRadiance, LightDesc, LightKind, SceneDesc, ShapeDesc, ShapeKind, SpectrumDesc,
    TransformDesc,
};
use geometry::GeometryId;
use math::{DMat4, DVec3, Normal3, Transform, Vec2, Vec3};
use sampling::warp;
use std::f32::consts::PI;
use testkit::{Chi2, Moments, Random, t_test, welch_test};

/// A scene of one light.
struct Case {
    name: &'static str,
    scene: Scene,
}

impl Case {
    fn light(&self) -> &Light {
        &self.scene.lights()[0]
    }
}

fn white() -> SpectrumDesc {
    SpectrumDesc::Constant(100.0)
}

/// An emitting shape, turned and moved so that nothing is special about its axes.
fn area(shape: ShapeKind, change: impl Fn(&mut AreaLightDesc, &mut ShapeDesc)) -> SceneDesc {
    let mut light = AreaLightDesc::new(white());
    let mut shape = ShapeDesc::from(shape);
    let turn = DMat4::from_axis_angle(DVec3::new(1.0, 2.0, -1.0).normalize(), 0.3);
    shape.world_from_object =
        TransformDesc::fixed(DMat4::from_translation(DVec3::new(0.1, -0.2, 0.3)) * turn);
    change(&mut light, &mut shape);
    let mut desc = SceneDesc::default();
    shape.area_light = Some(desc.area_lights.push(light));
    desc.shapes.push(shape);
    desc
}

fn both_sides(light: &mut AreaLightDesc, _: &mut ShapeDesc) {
    light.two_sided = true;
}

fn one_side(_: &mut AreaLightDesc, _: &mut ShapeDesc) {}

fn colours(x: u32, y: u32) -> [f32; 3] {
    [0.2 + x as f32, 0.4 + (x * y % 5) as f32, 1.0 + 0.5 * y as f32]
}

/// An emitting shape with an image over its (u, v).
fn with_image(shape: ShapeKind) -> SceneDesc {
    let mut desc = area(shape, both_sides);
    let image = desc.images.push(rgb_image(6, 4, colours));
    for (_, light) in desc.area_lights.iter_mut() {
        light.image = Some(image);
    }
    desc
}

fn triangle() -> ShapeKind {
    triangles(&[[-1.0, -0.7, 0.0], [1.3, -0.4, 0.2], [0.1, 1.2, -0.1]], &[[0, 1, 2]])
}

fn placement() -> DMat4 {
    DMat4::from_translation(DVec3::new(0.1, 0.2, 0.3)) * DMat4::from_rotation_x(0.8)
}

/// A light without a surface, and a ball far away that gives the scene an extent.
fn free(kind: LightKind) -> SceneDesc {
    let mut desc = SceneDesc::default();
    let far_away = TransformDesc::translation(0.0, 0.0, -1e3);
    desc.shapes.push(ShapeDesc { world_from_object: far_away, ..sphere(0.01).into() });
    let world_from_light = TransformDesc::fixed(placement());
    desc.lights.push(LightDesc { world_from_light, ..kind.into() });
    desc
}

fn spot(cone_angle: f32, cone_delta_angle: f32, power: Option<f32>) -> LightKind {
    LightKind::Spot {
        intensity: white(),
        power,
        from: Vec3::ZERO,
        to: Vec3::new(0.1, 0.2, 1.0),
        cone_angle,
        cone_delta_angle,
    }
}

fn point(power: Option<f32>) -> LightKind {
    LightKind::Point { intensity: white(), power, from: Vec3::new(0.0, 0.5, 0.0) }
}

fn distant(illuminance: Option<f32>) -> LightKind {
    LightKind::Distant { radiance: white(), illuminance, from: Vec3::new(1.0, 0.3, 2.0), to: Vec3::ZERO }
}

fn sky(illuminance: Option<f32>) -> LightKind {
    LightKind::Infinite { radiance: InfiniteRadiance::Constant(white()), illuminance, portal: None }
}

fn image_sky(size: u32, illuminance: Option<f32>, pixel: impl FnMut(u32, u32) -> [f32; 3]) -> SceneDesc {
    let mut desc = free(sky(illuminance));
    let image = desc.images.push(rgb_image(size, size, pixel));
    for (_, light) in desc.lights.iter_mut() {
        let LightKind::Infinite { radiance, .. } = &mut light.kind else { continue };
        *radiance = InfiniteRadiance::Image(image);
    }
    desc
}

fn delta_lights() -> Vec<Case> {
    let cases = [
        ("point", free(point(None))),
        ("spot", free(spot(40.0, 15.0, None))),
        ("spot, hard edge", free(spot(60.0, 0.0, None))),
        ("distant", free(distant(None))),
    ];
    cases.map(|(name, desc)| Case { name, scene: scene(&desc) }).into()
}

fn area_lights() -> Vec<Case> {
    let flat = rectangle([-1.0, -0.5], [0.8, 0.7]);
    let bent = patch([[-1.0, -1.0, 0.0], [1.0, -0.8, 0.5], [-0.9, 1.0, 0.4], [1.1, 1.2, -0.3]]);
    let cases = [
        ("sphere", area(sphere(0.8), one_side)),
        ("sphere, both sides", area(sphere(0.8), both_sides)),
        ("cylinder", area(cylinder(0.5, -0.6, 0.9), one_side)),
        ("cylinder, both sides", area(cylinder(0.5, -0.6, 0.9), both_sides)),
        ("disk", area(disk(0.2, 0.9), one_side)),
        ("disk, both sides", area(disk(0.2, 0.9), both_sides)),
        ("disk, reversed", area(disk(0.2, 0.9), |_, shape| shape.reverse_orientation = true)),
        ("triangle", area(triangle(), one_side)),
        ("triangle, both sides", area(triangle(), both_sides)),
        ("rectangle", area(flat.clone(), one_side)),
        ("rectangle, both sides", area(flat.clone(), both_sides)),
        ("rectangle, image", with_image(flat)),
        ("bent patch", area(bent, both_sides)),
        ("disk, image", with_image(disk(0.0, 0.9))),
    ];
    cases.map(|(name, desc)| Case { name, scene: scene(&desc) }).into()
}

fn infinite_lights() -> Vec<Case> {
    // One bright pixel, as a sun.
    let sun = |x, y| if (x, y) == (5, 2) { [40.0, 35.0, 30.0] } else { colours(x, y) };
    let cases = [
        ("sky", free(sky(None))),
        ("image sky", image_sky(8, None, colours)),
        ("image sky with a sun", image_sky(8, None, sun)),
        ("image sky of one colour", image_sky(8, None, |_, _| [0.5; 3])),
    ];
    cases.map(|(name, desc)| Case { name, scene: scene(&desc) }).into()
}

fn hittable_lights() -> Vec<Case> {
    let mut lights = area_lights();
    lights.extend(infinite_lights());
    lights
}

/// Points before, behind, beside and near the lights; on surfaces and in space.
fn references() -> Vec<LightSampleContext> {
    vec![
        context(Vec3::new(0.3, 0.2, 2.0), Vec3::ZERO),
        context(Vec3::new(-0.5, 0.4, -1.9), Vec3::new(0.3, 0.0, 1.0).normalize()),
        context(Vec3::new(1.1, -0.9, 1.0), Vec3::new(-0.5, 0.4, -0.9).normalize()),
        context(Vec3::new(0.1, -0.1, 0.6), Vec3::ZERO),
    ]
}

/// Holds samples against a density with edges, which is measured by the midpoint rule on cells of equal solid angle. Cells
/// that are mostly dark count as one with the samples that fail, as their share is not measured well.
fn check_directions(
    sample: impl Fn([f32; 2]) -> Option<[f32; 3]>,
    density: impl Fn([f32; 3]) -> f64,
    seed: u64,
    tests: usize,
) -> Result<(), String> {
    let (rows, columns, fine, count) = (8, 16, 48, 5_000);
    let mut cells = vec![(0.0, 0); rows * columns];
    for i in 0..rows * fine {
        for j in 0..columns * fine {
            let z = 1.0 - 2.0 * (i as f32 + 0.5) / (rows * fine) as f32;
            let phi = 2.0 * PI * (j as f32 + 0.5) / (columns * fine) as f32;
            let pdf = density(math::spherical_direction((1.0 - z * z).sqrt(), z, phi).to_array());
            let (sum, lit) = &mut cells[i / fine * columns + j / fine];
            *sum += pdf;
            *lit += usize::from(pdf > 0.0);
        }
    }
    let weight = 4.0 * PI as f64 / (cells.len() * fine * fine) as f64;
    let total: f64 = cells.iter().map(|(sum, _)| sum * weight).sum();
    if total > 1.005 {
        return Err(format!("the density integrates to {total}"));
    }
    let is_dark = |cell: usize| cells[cell].1 * 8 < fine * fine;
    let cell_count = |(sum, _): &(f64, usize)| sum * weight * count as f64;
    let mut expected: Vec<f64> = cells.iter().map(cell_count).collect();
    (0..expected.len()).filter(|&cell| is_dark(cell)).for_each(|cell| expected[cell] = 0.0);
    expected.push((count as f64 - expected.iter().sum::<f64>()).max(1e-3));
    let mut observed = vec![0; expected.len()];
    let mut random = Random::new(seed);
    for _ in 0..count {
        let cell = sample(random.get_2d()).map(|w| {
            let row = ((1.0 - w[2]) / 2.0 * rows as f32) as usize;
            let phi = w[1].atan2(w[0]).rem_euclid(2.0 * PI);
            let column = (phi / (2.0 * PI) * columns as f32) as usize;
            row.min(rows - 1) * columns + column.min(columns - 1)
        });
        observed[cell.filter(|&cell| !is_dark(cell)).unwrap_or(cells.len())] += 1;
    }
    Chi2 { tests, ..Chi2::default() }.counts(&observed, &expected)
}

#[test]
fn samples_have_the_density_that_is_claimed() {
    let (cases, references) = (area_lights(), references());
    let tests = cases.len() * references.len();
    for case in &cases {
        let light = case.light();
        for (i, from) in references.iter().enumerate() {
            // Directions from which nothing comes are no samples.
            let density = |w: [f32; 3]| {
                let w = Vec3::from(w).normalize();
                let pdf = light.pdf_li(from, w, false) as f64;
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
fn samples_of_skies_have_the_density_that_is_claimed() {
    let from = references()[0];
    let light_from_render = Transform::from_f64(placement()).unwrap().inverse();
    for case in infinite_lights() {
        for incomplete in [false, true] {
            let light = case.light();
            let sample = |u| {
                let sample = seen_sample(&case.scene, light, &from, u, incomplete)?;
                Some(math::equal_area_sphere_to_square(light_from_render.vector(sample.wi)).to_array())
            };
            if case.name == "sky" && incomplete {
                assert!(sample([0.5; 2]).is_none() && light.pdf_li(&from, Vec3::Z, true) == 0.0);
                continue;
            }
            // A cell of the square for each pixel: within it the density is constant.
            let density = |p: [f32; 2]| {
                let w = light_from_render.inverse().vector(math::equal_area_square_to_sphere(p.into()));
                4.0 * PI as f64 * light.pdf_li(&from, w.normalize(), incomplete) as f64
            };
            Chi2 { bins: [8, 8], samples: 50_000, tests: 8, ..Chi2::default() }
                .rectangle([[0.0, 1.0]; 2], sample, density)
                .unwrap_or_else(|e| panic!("{}, incomplete {incomplete}: {e}", case.name));
        }
    }
}

#[test]
fn samples_say_their_density_and_radiance() {
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
                    let pdf = light.pdf_li(&from, sample.wi, incomplete);
                    let arriving = arriving(&case.scene, &from, sample.wi);
                    // At an edge, rounding decides on which side the direction lies.
                    if pdf == 0.0 || arriving == 0.0 {
                        continue;
                    }
                    // A density is the less certain the more obliquely it looks at the light.
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
fn only_delta_lights_cannot_be_met() {
    for case in hittable_lights() {
        assert!(!case.light().is_delta(), "{}", case.name);
    }
    for case in delta_lights() {
        assert!(case.light().is_delta() && !case.light().is_infinite(), "{}", case.name);
        assert_eq!(case.light().pdf_li(&references()[0], Vec3::Z, false), 0.0, "{}", case.name);
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
fn irradiance_is_the_same_by_light_and_by_direction() {
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
fn incomplete_samples_and_directions_make_a_whole() {
    let cases = infinite_lights();
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
                let density = uniform + light.pdf_li(&from, w, true);
                by_light + arriving(&case.scene, &from, w) * f64::from(n.dot(w).max(0.0) / density)
            })
            .collect();
        let whole = by_light(case, &from, n, 40_000, &mut random);
        welch_test(&combined, &whole, cases.len()).unwrap_or_else(|e| panic!("{}: {e}", case.name));
    }
}

#[test]
fn power_is_what_leaves() {
    let (areas, lambda) = (area_lights(), lambda());
    let mut random = Random::new(4);
    for case in &areas {
        // An image is taken as spread evenly over the surface, which on a disk it is not.
        if case.name == "disk, image" {
            continue;
        }
        let shape = case.scene.world().geometry(GeometryId(0)).shape(0);
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
fn power_of_lights_at_a_point_is_what_passes_a_sphere_around_them() {
    let lambda = lambda();
    let mut random = Random::new(5);
    for case in delta_lights().iter().filter(|case| case.name != "distant") {
        let p = match case.light() {
            Light::Point(light) => light.p,
            Light::Spot(light) => light.p,
            _ => unreachable!(),
        };
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
            t_test(&passing, phi, 2).unwrap_or_else(|e| panic!("{}: {e}", case.name));
        }
    }
}

#[test]
fn power_of_lights_far_away_is_what_falls_on_the_scene() {
    let lambda = lambda();
    let mut random = Random::new(6);
    for case in infinite_lights() {
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
            t_test(&falling, phi, 4).unwrap_or_else(|e| panic!("{}: {e}", case.name));
        }
    }
    let case = &delta_lights()[3];
    let irradiance = seen_sample(&case.scene, case.light(), &references()[0], [0.0; 2], false).unwrap().l[0];
    let phi = case.light().phi(&lambda)[0];
    assert!((phi / (irradiance * PI * case.scene.sphere().radius.powi(2)) - 1.0).abs() < 1e-5);
}

#[test]
fn irradiance_has_its_closed_forms() {
    // Lights above the origin, which faces up; they shine down.
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
    let cases = [
        ("disk", above(disk(0.0, 0.7), 1.3), PI * 0.7f32.powi(2) / (0.7f32.powi(2) + 1.3f32.powi(2))),
        ("sphere", above(sphere(0.7), 1.3), PI * (0.7f32 / 1.3).powi(2)),
        ("rectangle", above(rectangle([0.0, 0.0], [1.5, 0.8]), 1.2), corner(1.5 / 1.2, 0.8 / 1.2)),
        ("triangles", above(two_triangles, 1.2), corner(1.5 / 1.2, 0.8 / 1.2)),
        ("sky", free(sky(None)), PI),
    ];
    let from = context(Vec3::new(0.0, 0.0, 0.0), Vec3::Z);
    let from_space = context(Vec3::ZERO, Vec3::ZERO);
    let mut random = Random::new(7);
    for (name, desc, over_radiance) in &cases {
        let scene = scene(desc);
        let radiance = 100.0 / spectrum::Spectrum::Constant(100.0).to_photometric();
        for from in [from, from_space] {
            // One sample of every light makes one estimate of the whole.
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

#[test]
fn point_lights_fall_off_by_the_square_of_the_distance() {
    for case in delta_lights().iter().filter(|case| case.name != "distant") {
        let (p, axis) = match case.light() {
            Light::Point(light) => (light.p, Vec3::Z),
            Light::Spot(light) => (light.p, light.axis),
            _ => unreachable!(),
        };
        let at = |distance: f32| {
            let from = context(p + axis * distance, Vec3::ZERO);
            seen_sample(&case.scene, case.light(), &from, [0.0; 2], false).unwrap().l[0] * distance * distance
        };
        for distance in [0.3, 2.0, 70.0] {
            assert!((at(distance) / at(1.0) - 1.0).abs() < 1e-5, "{}", case.name);
        }
        // Nothing, rather than infinity, arrives in the light itself.
        let inside = context(p, Vec3::ZERO);
        assert!(seen_sample(&case.scene, case.light(), &inside, [0.0; 2], false).is_none());
    }
}

#[test]
fn spots_fall_off_smoothly_within_their_cone() {
    let [soft, hard] = [1, 2].map(|i| delta_lights().remove(i));
    for (case, start, end) in [(soft, 25f32, 40f32), (hard, 60.0, 60.0)] {
        let Light::Spot(light) = case.light() else { unreachable!() };
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

/// ∫ f(λ) ȳ(λ) dλ of what `f` gives at four wavelengths.
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
        photometric(|lambda| scene.lights()[0].radiance(Vec3::Z, Vec2::splat(0.5), Vec3::Z, lambda))
    };
    assert!((of(&desc) / 2.5 - 1.0).abs() < 1e-3);
    // The components of a colour are factors on white.
    for (_, light) in desc.area_lights.iter_mut() {
        light.radiance = SpectrumDesc::rgb(3.0, 3.0, 3.0);
    }
    assert!((of(&desc) / 7.5 - 1.0).abs() < 2e-3);
}

#[test]
fn power_and_illuminance_are_met() {
    let power = |desc: &SceneDesc| {
        let scene = scene(desc);
        photometric(|lambda| scene.lights()[0].phi(lambda))
    };
    let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 2e-3, "{a} {b}");
    near(power(&free(point(Some(60.0)))), 60.0);
    near(power(&free(spot(50.0, 20.0, Some(60.0)))), 60.0);
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
    // As well as spectra made from colours keep their luminance.
    assert!((power(&image) / 60.0 - 1.0).abs() < 1e-2, "{}", power(&image));

    let facing = |desc: &SceneDesc| {
        let scene = scene(desc);
        let light = &scene.lights()[0];
        photometric(|lambda| light.le(&ray(Vec3::ZERO, Vec3::Z), lambda)) * PI as f64
    };
    near(facing(&free(sky(Some(500.0)))), 500.0);
    // The format counts half of the illuminance of images; see `upward_illuminance`.
    near(facing(&image_sky(64, Some(500.0), |_, _| [0.3; 3])), 1000.0);
    let sun = scene(&free(distant(Some(500.0))));
    near(
        photometric(|lambda| {
            let from = context(Vec3::ZERO, Vec3::ZERO);
            sun.lights()[0].sample_li(&from, Vec2::ZERO, lambda, false, &Default::default()).unwrap().l
        }),
        500.0,
    );
}

#[test]
fn what_cannot_shine_has_no_power_rather_than_an_infinite_one() {
    let degenerate = triangles(&[[0.0; 3], [1.0; 3], [0.0, 1.0, 0.0]], &[[0, 1, 1], [0, 1, 2]]);
    let scene = scene(&area(degenerate, |light, _| light.power = Some(10.0)));
    let [flat, whole] = [0, 1].map(|i| scene.lights()[i].phi(&lambda())[0]);
    assert_eq!(flat, 0.0);
    assert!(whole.is_finite() && whole > 0.0);
}

#[test]
fn an_image_lies_upright_on_its_surface() {
    // Red at the lower left (u, v) = (0, 0), which is the first pixel of the last row.
    let mut desc = area(rectangle([0.0, 0.0], [1.0, 1.0]), one_side);
    let red = |x, y| if (x, y) == (0, 1) { [1.0, 0.0, 0.0] } else { [0.0; 3] };
    let image = desc.images.push(rgb_image(2, 2, red));
    for (_, light) in desc.area_lights.iter_mut() {
        light.image = Some(image);
    }
    let scene = scene(&desc);
    let at = |u, v| {
        let radiance = scene.lights()[0].radiance(Vec3::Z, Vec2::new(u, v), Vec3::Z, &lambda());
        radiance.max_component()
    };
    assert!(at(0.1, 0.1) > 0.0);
    assert_eq!([at(0.9, 0.1), at(0.1, 0.9), at(0.9, 0.9)], [0.0; 3]);
}

#[test]
fn a_light_that_is_cut_out_shines_by_its_alpha() {
    let alpha = |value: f32| area(disk(0.0, 1.0), move |_, shape| shape.alpha = Some(value.into()));
    let from = context(Vec3::new(0.1, 0.2, 1.5), Vec3::ZERO);
    let mut random = Random::new(8);
    let mut irradiance = |desc: &SceneDesc, count| {
        let case = Case { name: "alpha", scene: scene(desc) };
        // Not through the light's own surface: it would hide some of its own samples.
        (0..count)
            .map(|_| {
                let u = random.get_2d();
                let sample = case.light().sample_li(&from, u.into(), &lambda(), false, case.scene.textures());
                sample.map_or(0.0, |s| f64::from(s.l[0] / s.pdf))
            })
            .collect::<Moments>()
    };
    let whole = irradiance(&alpha(1.0), 10_000);
    let part: Moments = irradiance(&alpha(0.3), 10_000);
    assert!((part.mean / whole.mean - 0.3).abs() < 0.03, "{} {}", part.mean, whole.mean);
    // Entirely cut out, it is invisible, but shines.
    let invisible = scene(&alpha(0.0));
    assert!(invisible.lights()[0].is_delta());
    assert!(hit(&invisible, &ray(from.p.p, -Vec3::Z)).is_none());
    welch_test(&irradiance(&alpha(0.0), 10_000), &whole, 1).unwrap();
}

#[test]
fn lights_far_away_are_hidden_by_what_is_far_away() {
    // A floor and a ceiling without end, and a small ball: the sun comes through neither.
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
        assert_eq!(scene.unoccluded(&floor, &sample, &mut Default::default()), !ceiling && sample.wi.z > 0.0);
    }
}
