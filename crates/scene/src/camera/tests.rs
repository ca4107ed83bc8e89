//! Properties of all cameras.

use super::*;
use description::{
    Arena, CameraDesc, CameraKind, FilmDesc, LensDesc, RealisticCameraDesc, RenderSpace, ScreenDesc,
    SphericalMapping, Stated, TransformDesc,
};
use lanes::Real;
use math::{DMat4, DVec3, Vec3};
use testkit::{LaneFunction, lanes_agree};

pub(super) const RESOLUTION: [u32; 2] = [200, 150];
const LENS: LensDesc = LensDesc { radius: 0.3, focal_distance: 4.0 };

pub(super) fn kinds() -> Vec<(&'static str, CameraKind)> {
    let screen = ScreenDesc::default();
    let cut = ScreenDesc { frame_aspect_ratio: None, window: Some([-0.2, 0.7, 0.1, 0.5]) };
    let pinhole = LensDesc::default();
    vec![
        ("perspective", CameraKind::Perspective { fov: 40.0, screen, lens: pinhole }),
        ("perspective, lens", CameraKind::Perspective { fov: 40.0, screen, lens: LENS }),
        ("perspective, window", CameraKind::Perspective { fov: 70.0, screen: cut, lens: pinhole }),
        ("orthographic", CameraKind::Orthographic { screen, lens: pinhole }),
        ("orthographic, lens", CameraKind::Orthographic { screen: cut, lens: LENS }),
        ("equal area", CameraKind::Spherical { mapping: SphericalMapping::EqualArea }),
        ("equirectangular", CameraKind::Spherical { mapping: SphericalMapping::EquiRectangular }),
    ]
}

pub(super) fn somewhere() -> TransformDesc {
    let turn = DMat4::from_axis_angle(DVec3::new(1.0, 2.0, -1.0).normalize(), 0.8);
    TransformDesc::fixed(turn * DMat4::from_translation(DVec3::new(-50.0, 3.0, 20.0)))
}

pub(super) fn build(kind: CameraKind, camera_from_world: TransformDesc, render_space: RenderSpace) -> Camera {
    let desc = CameraDesc { kind, camera_from_world, ..CameraDesc::default() };
    let film = FilmDesc { resolution: RESOLUTION.map(|n| n as i32), ..FilmDesc::default() };
    let space = world_from_render(&desc.camera_from_world, render_space);
    let mut diagnostics = Vec::new();
    let camera = compile(&desc.into(), &film.into(), &Arena::default(), space, &mut diagnostics);
    assert!(diagnostics.is_empty(), "{diagnostics:?}");
    camera.unwrap()
}

pub(super) fn sample(x: f32, y: f32, lens: Vec2, time: f32) -> CameraSample {
    CameraSample { film: Vec2::new(x, y), lens, time, filter_weight: 1.0 }
}

#[test]
fn coarser_pixels_see_the_same_at_scaled_film_positions() {
    for (name, kind) in kinds() {
        let fine = build(kind, somewhere(), RenderSpace::CameraWorld);
        let coarse = fine.coarser(3);
        let lens = Vec2::new(0.2, 0.7);
        for (x, y) in [(37.3, 20.9), (120.2, 141.6), (199.9, 0.1)] {
            let [seen, same] = [(&fine, 1.0), (&coarse, 3.0)]
                .map(|(camera, n)| camera.generate_ray(&sample(x / n, y / n, lens, 0.4)).unwrap().ray);
            assert!((seen.d - same.d).length() < 1e-6 && (seen.o - same.o).length() < 1e-5, "{name}");
            let (p, n) = (seen.at(2.0), -seen.d);
            let ways = [&fine, &coarse].map(|camera| camera.sample_wi(p, 0.4, lens).unwrap());
            assert!((ways[0].film - 3.0 * ways[1].film).length() < 1e-3, "{name}");
            // A pixel nine times as large has nine times the light.
            assert!((ways[0].we / ways[0].pdf / (ways[1].we / ways[1].pdf) - 9.0).abs() < 1e-3, "{name}");
            let [least, largest] = [&fine, &coarse].map(|camera| camera.approximate_dp_dxy(p, n, 0.4, 1.0));
            for (least, largest) in least.into_iter().zip(largest) {
                assert!((3.0 * least - largest).length() < 0.05 * largest.length() + 1e-6, "{name}");
            }
        }
    }
}

#[test]
fn differentials_are_finite_differences() {
    for (name, kind) in kinds() {
        let camera = build(kind, somewhere(), RenderSpace::CameraWorld);
        let lens = Vec2::new(0.2, 0.7);
        for (x, y) in [(37.3, 20.9), (120.2, 141.6), (88.0, 61.5)] {
            let at = |dx: f32, dy: f32| camera.generate_ray(&sample(x + dx, y + dy, lens, 0.4)).unwrap().ray;
            let full = camera.generate_ray_differential(&sample(x, y, lens, 0.4)).unwrap().ray;
            let d = full.differentials.unwrap();
            assert!((full.ray.d - at(0.0, 0.0).d).length() < 1e-6 && full.ray.o == at(0.0, 0.0).o, "{name}");
            let h = 0.5;
            for (origin, direction, plus, minus) in [
                (d.rx_origin, d.rx_direction, at(h, 0.0), at(-h, 0.0)),
                (d.ry_origin, d.ry_direction, at(0.0, h), at(0.0, -h)),
            ] {
                // Over a pixel, the second derivative is a small part of the first.
                let (dd, dd_fd) = (direction - full.ray.d, (plus.d - minus.d) / (2.0 * h));
                assert!((dd - dd_fd).length() < 0.03 * dd_fd.length() + 1e-6, "{name}: {dd} {dd_fd}");
                let (d_o, do_fd) = (origin - full.ray.o, (plus.o - minus.o) / (2.0 * h));
                assert!((d_o - do_fd).length() < 0.01 * do_fd.length() + 1e-6, "{name}: {d_o} {do_fd}");
            }
        }
    }
}

#[test]
fn differentials_of_a_flat_film_equal_the_neighbouring_rays() {
    for (name, kind) in kinds().into_iter().take(5) {
        let camera = build(kind, somewhere(), RenderSpace::CameraWorld);
        let lens = Vec2::new(0.9, 0.1);
        let full = camera.generate_ray_differential(&sample(10.0, 20.0, lens, 0.0)).unwrap().ray;
        let right = camera.generate_ray(&sample(11.0, 20.0, lens, 0.0)).unwrap().ray;
        let below = camera.generate_ray(&sample(10.0, 21.0, lens, 0.0)).unwrap().ray;
        let d = full.differentials.unwrap();
        for (o, direction, neighbour) in
            [(d.rx_origin, d.rx_direction, right), (d.ry_origin, d.ry_direction, below)]
        {
            assert!((o - neighbour.o).length() < 1e-6 && (direction - neighbour.d).length() < 1e-6, "{name}");
        }
    }
}

#[test]
fn rays_through_a_lens_meet_on_the_focal_plane() {
    for kind in [
        CameraKind::Perspective { fov: 60.0, screen: ScreenDesc::default(), lens: LENS },
        CameraKind::Orthographic { screen: ScreenDesc::default(), lens: LENS },
    ] {
        let camera = build(kind, TransformDesc::default(), RenderSpace::Camera);
        let ray = |u, v| camera.generate_ray(&sample(30.0, 110.0, Vec2::new(u, v), 0.0)).unwrap().ray;
        let focus = |r: Ray| r.at((LENS.focal_distance - r.o.z) / r.d.z);
        let (a, b) = (ray(0.1, 0.3), ray(0.8, 0.9));
        assert!((a.o - b.o).length() > 0.1 && a.o.length() <= LENS.radius && b.o.length() <= LENS.radius);
        assert!((focus(a) - focus(b)).length() < 1e-5);
        assert!(
            (focus(ray(0.5, 0.5)) - focus(a)).length() < 1e-5,
            "the ray through the centre of the lens is not refracted"
        );
    }
}

#[test]
fn equal_area_directions_are_uniform() {
    let kind = CameraKind::Spherical { mapping: SphericalMapping::EqualArea };
    let camera = build(kind, somewhere(), RenderSpace::CameraWorld);
    let n = 400;
    let mut counts = [0u32; 64];
    for i in 0..n * n {
        let film = Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32
            * Vec2::new(RESOLUTION[0] as f32, RESOLUTION[1] as f32);
        let d = camera.generate_ray(&sample(film.x, film.y, Vec2::ZERO, 0.0)).unwrap().ray.d;
        let height = ((d.z * 0.5 + 0.5) * 8.0).clamp(0.0, 7.0) as usize;
        let around = (math::spherical_phi(d) / std::f32::consts::TAU * 8.0).min(7.0) as usize;
        counts[height * 8 + around] += 1;
    }
    let expected = (n * n) as f32 / 64.0;
    for count in counts {
        assert!((count as f32 / expected - 1.0).abs() < 0.03, "{count} of {expected}");
    }
}

#[test]
fn the_equirectangular_poles_are_up_and_down() {
    let kind = CameraKind::Spherical { mapping: SphericalMapping::EquiRectangular };
    let camera = build(kind, TransformDesc::default(), RenderSpace::Camera);
    let [w, h] = RESOLUTION.map(|n| n as f32);
    for (x, y, d) in [
        (50.0, 0.0, Vec3::Y),
        (50.0, h, -Vec3::Y),
        (0.0, h / 2.0, Vec3::X),
        (w / 4.0, h / 2.0, Vec3::Z),
        (w / 2.0, h / 2.0, -Vec3::X),
    ] {
        let ray = camera.generate_ray(&sample(x, y, Vec2::ZERO, 0.0)).unwrap().ray;
        assert!((ray.d - d).length() < 1e-6, "({x}, {y}): {}", ray.d);
    }
}

#[test]
fn the_film_has_x_to_the_right_and_y_down() {
    for (name, kind) in kinds().into_iter().take(1).chain(kinds().into_iter().skip(3).take(1)) {
        let camera = build(kind, TransformDesc::default(), RenderSpace::Camera);
        let at = |x, y| camera.generate_ray(&sample(x, y, Vec2::ZERO, 0.0)).unwrap().ray.at(1.0);
        assert!(at(150.0, 75.0).x > 0.1 && at(150.0, 75.0).y.abs() < 1e-6, "{name}");
        assert!(at(100.0, 30.0).y > 0.1 && at(100.0, 30.0).x.abs() < 1e-6, "{name}");
    }
    let screen = ScreenDesc { frame_aspect_ratio: Some(0.5), window: None };
    let tall = CameraKind::Orthographic { screen, lens: LensDesc::default() };
    let camera = build(tall, TransformDesc::default(), RenderSpace::Camera);
    let corner = camera.generate_ray(&sample(0.0, 0.0, Vec2::ZERO, 0.0)).unwrap().ray.o;
    assert!((corner - Vec3::new(-1.0, 2.0, 0.0)).length() < 1e-6);
}

#[test]
fn a_moving_camera_is_interpolated_in_time() {
    let moving = TransformDesc {
        start: DMat4::from_translation(DVec3::new(-1.0, 0.0, 0.0)),
        end: DMat4::from_translation(DVec3::new(-5.0, 2.0, 0.0)),
        times: [0.0, 2.0],
    };
    let desc = CameraDesc {
        camera_from_world: moving,
        shutter_open: 0.5,
        shutter_close: 1.5,
        ..CameraDesc::default()
    };
    for render_space in [RenderSpace::World, RenderSpace::CameraWorld, RenderSpace::Camera] {
        let space = world_from_render(&desc.camera_from_world, render_space);
        let camera = compile(
            &desc.clone().into(),
            &FilmDesc::default().into(),
            &Arena::default(),
            space,
            &mut Vec::new(),
        )
        .unwrap();
        for (u, time, x) in [(0.0, 0.5, 2.0), (0.5, 1.0, 3.0), (1.0, 1.5, 4.0)] {
            let ray = camera.generate_ray(&sample(9.0, 9.0, Vec2::ZERO, u)).unwrap().ray;
            assert_eq!(ray.time, time);
            let o = camera.transform().world_from_render().transform_point3(ray.o.as_dvec3());
            assert!((o - DVec3::new(x, 0.5 - 0.5 * x, 0.0)).length() < 1e-5, "{render_space:?}: {o}");
        }
    }
}

#[test]
fn the_picture_does_not_depend_on_the_render_space() {
    for (name, kind) in kinds() {
        let rays = [RenderSpace::World, RenderSpace::CameraWorld, RenderSpace::Camera].map(|space| {
            let camera = build(kind.clone(), somewhere(), space);
            let world = camera.transform().world_from_render();
            let ray = camera.generate_ray(&sample(70.0, 31.0, Vec2::new(0.3, 0.8), 0.0)).unwrap().ray;
            let p = camera.transform().camera_from_world(0.0).inverse().transform_point3(DVec3::Z * 3.0);
            let p = camera.transform().world_from_render().inverse().transform_point3(p).as_vec3().into();
            let [dpdx, dpdy] = camera.approximate_dp_dxy(p, ray.d, 0.0, 0.5);
            (
                world.transform_point3(ray.o.as_dvec3()),
                [ray.d, dpdx, dpdy].map(|v| world.transform_vector3(v.as_dvec3())),
            )
        });
        for (o, vectors) in &rays[1..] {
            assert!((*o - rays[0].0).length() < 2e-5, "{name}");
            assert!(vectors.iter().zip(rays[0].1).all(|(a, b)| (*a - b).length() < 2e-5), "{name}");
        }
    }
}

#[test]
fn a_scaling_transform_leaves_directions_of_unit_length() {
    let scaled = TransformDesc::fixed(DMat4::from_scale(DVec3::new(0.1, 0.1, 0.1)));
    for (name, kind) in kinds() {
        let camera = build(kind.clone(), scaled, RenderSpace::World);
        let plain = build(kind, TransformDesc::default(), RenderSpace::World);
        let s = sample(70.0, 31.0, Vec2::new(0.3, 0.8), 0.0);
        let (a, b) =
            (camera.generate_ray_differential(&s).unwrap(), plain.generate_ray_differential(&s).unwrap());
        assert!((a.ray.ray.d - b.ray.ray.d).length() < 1e-6, "{name}");
        let (da, db) = (a.ray.differentials.unwrap(), b.ray.differentials.unwrap());
        assert!((da.rx_direction - db.rx_direction).length() < 1e-6, "{name}");
    }
}

#[test]
fn the_footprint_is_never_wider_than_a_pixel() {
    for (name, kind) in kinds() {
        let camera = build(kind, TransformDesc::default(), RenderSpace::CameraWorld);
        let mut narrowest = f32::INFINITY;
        for (x, y) in [(0.5, 0.5), (100.0, 75.0), (150.2, 30.7), (199.5, 149.5)] {
            let full = camera.generate_ray_differential(&sample(x, y, Vec2::splat(0.5), 0.0)).unwrap().ray;
            let d = full.differentials.unwrap();
            // A surface 4 away that faces the ray.
            let (n, p) = (full.ray.d, full.ray.at(4.0));
            let seen = |o: Vec3, direction: Vec3| o + direction * ((p - o).dot(n) / direction.dot(n)) - p;
            let exact = [seen(d.rx_origin, d.rx_direction), seen(d.ry_origin, d.ry_direction)];
            let approximate = camera.approximate_dp_dxy(p, n, 0.0, 1.0);
            for (exact, approximate) in exact.into_iter().zip(approximate) {
                let ratio = approximate.length() / exact.length();
                assert!(ratio < 1.02, "{name}: {approximate} {exact}");
                narrowest = narrowest.min((ratio - 1.0).abs());
            }
        }
        assert!(narrowest < 0.05 || name.starts_with("eq"), "{name}: somewhere it is attained");
    }
}

#[test]
fn an_edge_on_surface_has_no_footprint() {
    let camera = build(kinds()[0].1.clone(), TransformDesc::default(), RenderSpace::CameraWorld);
    for p in [Vec3::ZERO, Vec3::Z] {
        assert!(camera.approximate_dp_dxy(p, Vec3::ZERO, 0.0, 1.0).iter().all(|v| v.is_finite()));
    }
}

#[test]
fn samples_scale_differentials_down_to_an_eighth() {
    assert_eq!([0, 1, 4, 64, 1024].map(differential_scale), [1.0, 1.0, 0.5, 0.125, 0.125]);
}

#[test]
fn invalid_cameras_are_reported() {
    let codes = |desc: CameraDesc, resolution: [i32; 2]| {
        let film = FilmDesc { resolution, ..FilmDesc::default() };
        let mut diagnostics = Vec::new();
        let images = Arena::default();
        let camera = compile(&Stated::from(desc), &film.into(), &images, DMat4::IDENTITY, &mut diagnostics);
        (camera.is_some(), diagnostics.iter().map(|d| d.code).collect::<Vec<_>>())
    };
    let perspective = |fov, lens, window| CameraDesc {
        kind: CameraKind::Perspective { fov, screen: ScreenDesc { frame_aspect_ratio: None, window }, lens },
        ..CameraDesc::default()
    };
    let singular = CameraDesc {
        camera_from_world: TransformDesc::fixed(DMat4::from_scale(DVec3::new(1.0, 0.0, 1.0))),
        ..CameraDesc::default()
    };
    let late = CameraDesc { shutter_open: 2.0, ..CameraDesc::default() };
    let realistic = RealisticCameraDesc {
        lenses: [].into(),
        aperture_diameter: 1.0,
        focus_distance: 10.0,
        aperture: Default::default(),
    };
    let realistic = CameraDesc { kind: CameraKind::Realistic(realistic), ..CameraDesc::default() };
    let pinhole = LensDesc::default();
    let bad_lens = LensDesc { radius: -1.0, focal_distance: 1.0 };
    for (desc, resolution, expected) in [
        (CameraDesc::default(), [8, 8], (true, vec![])),
        (CameraDesc::default(), [0, -3], (false, vec!["invalid-value"; 2])),
        (perspective(180.0, bad_lens, Some([0.0, 0.0, 1.0, 2.0])), [8, 8], (false, vec!["invalid-value"; 3])),
        (perspective(f32::NAN, pinhole, None), [8, 8], (false, vec!["invalid-value"])),
        (singular, [8, 8], (false, vec!["singular-transform"])),
        (late, [8, 8], (true, vec!["shutter"])),
        (realistic, [8, 8], (false, vec!["invalid-value"])),
    ] {
        assert_eq!(codes(desc, resolution), expected);
    }
}

/// A ray of a camera.
pub(super) struct Rays<'a>(pub &'a Camera);

impl LaneFunction for Rays<'_> {
    #[inline(always)]
    fn results<R: Real>(&self, u: &[R]) -> Vec<R> {
        let film = Vec2::new(u[0] * R::splat(200.0), u[1] * R::splat(150.0));
        let sample = CameraSample { film, lens: Vec2::new(u[2], u[3]), time: u[4], filter_weight: R::one() };
        let (ray, weight) = self.0.ray(&sample);
        let mut results = vec![ray.o.x, ray.o.y, ray.o.z, ray.d.x, ray.d.y, ray.d.z, ray.time, weight];
        let (ray, mut near, _) = self.0.ray_and_neighbours(&sample);
        near.scale(&ray, R::splat(0.25));
        let across = self.0.approximate_dp_dxy(ray.at(R::splat(3.0)), -ray.d, ray.time, 0.5);
        let rays = [ray.o, ray.d, near.rx_origin, near.rx_direction, near.ry_origin, near.ry_direction];
        results.extend(rays.iter().chain(&across).flat_map(|v| v.to_array()));
        results
    }
}

#[test]
fn rays_do_not_depend_on_the_number_of_lanes() {
    let still = somewhere();
    let end = still.start * DMat4::from_rotation_y(0.3) * DMat4::from_translation(DVec3::new(1.0, 0.0, 2.0));
    let moving = TransformDesc { end, times: [0.2, 0.8], ..still };
    for (_, kind) in kinds() {
        for place in [still, moving] {
            let camera = build(kind.clone(), place, RenderSpace::CameraWorld);
            lanes_agree(&Rays(&camera), 5, 50);
        }
    }
}
