//! The realistic camera against closed forms of optics.

use super::aperture::ApertureMask;
use super::exit_pupil::ExitPupils;
use super::lens::{Apertures, LensRay, LensSystem};
use super::tests::{RESOLUTION, Rays, build, sample, somewhere};
use super::{Camera, Vec2, compile};
use description::{
    ApertureDesc, Arena, CameraDesc, CameraKind, FilmDesc, LensElement, RealisticCameraDesc, RenderSpace,
    TransformDesc,
};
use image::Image;
use math::{DMat4, DVec3};
use std::f64::consts::PI;
use testkit::{Random, lanes_agree};

fn elements<const N: usize>(rows: [[f32; 4]; N]) -> Vec<LensElement> {
    rows.map(|[curvature_radius, thickness, eta, aperture_diameter]| LensElement {
        curvature_radius,
        thickness,
        eta,
        aperture_diameter,
    })
    .to_vec()
}

/// A biconvex lens of radii 100 mm, 4 mm thick, with a stop right behind it.
fn biconvex() -> Vec<LensElement> {
    elements([[100.0, 4.0, 1.5, 40.0], [-100.0, 1.0, 1.0, 40.0], [0.0, 100.0, 0.0, 30.0]])
}

/// A triplet with the stop inside, which vignettes the corners of the film.
fn triplet() -> Vec<LensElement> {
    elements([
        [21.0, 3.2, 1.62, 14.0],
        [-420.0, 5.6, 1.0, 14.0],
        [-21.0, 1.0, 1.62, 10.0],
        [20.5, 2.0, 1.0, 10.0],
        [0.0, 3.0, 0.0, 9.0],
        [105.0, 2.8, 1.62, 12.0],
        [-19.0, 42.0, 1.0, 12.0],
    ])
}

fn realistic(lenses: &[LensElement], aperture_diameter: f32, focus_distance: f32) -> CameraKind {
    let aperture = ApertureDesc::Circular;
    let lenses = lenses.into();
    CameraKind::Realistic(RealisticCameraDesc { lenses, aperture_diameter, focus_distance, aperture })
}

fn camera(lenses: &[LensElement], aperture_diameter: f32, focus_distance: f32) -> Camera {
    let place = TransformDesc::fixed(DMat4::IDENTITY);
    build(realistic(lenses, aperture_diameter, focus_distance), place, RenderSpace::World)
}

fn through(a: DVec3, b: DVec3) -> LensRay {
    LensRay { o: a, d: (b - a).normalize() }
}

/// Where the ray from a point of the scene through a point of the front plane meets the film.
fn on_film(lens: &LensSystem, p: DVec3, front: DVec3) -> DVec3 {
    let (ray, _) = lens.trace_from_scene(through(p, front), Apertures::Open).unwrap();
    ray.o - ray.d * (ray.o.z / ray.d.z)
}

#[test]
fn cardinal_points_follow_the_lensmaker_equation() {
    let (n, r, d) = (1.5, 0.1, 0.004);
    let f = 1.0 / ((n - 1.0) * (2.0 / r - (n - 1.0) * d / (n * r * r)));
    let inwards = f * (n - 1.0) * d / (n * r);
    let thick = LensSystem::new(&biconvex(), 30.0, None).thick_lens(1e-5).unwrap();
    assert!((thick.focal_length / f - 1.0).abs() < 1e-6, "{thick:?}");
    assert!((thick.separation - (d - 2.0 * inwards)).abs() < 1e-8, "{thick:?}");
    assert!((thick.film_side - (0.101 + inwards)).abs() < 1e-8, "{thick:?}");
}

#[test]
fn points_in_focus_converge_on_the_film_at_the_magnification() {
    for lenses in [biconvex(), triplet()] {
        let mut lens = LensSystem::new(&lenses, 30.0, None);
        let distance = 2.0;
        lens.focus(distance, 1e-5).unwrap();
        let thick = lens.thick_lens(1e-5).unwrap();
        let object = distance - thick.film_side - thick.separation;
        let magnification = thick.film_side / object;
        assert!((1.0 / object + 1.0 / thick.film_side - 1.0 / thick.focal_length).abs() < 1e-5);
        let p = DVec3::new(0.02, 0.0, distance);
        for x in [-1e-3, -3e-4, 4e-4, 1e-3] {
            let image = on_film(&lens, p, DVec3::new(x, 0.5 * x, 0.15));
            let expected = DVec3::new(-0.02 * magnification, 0.0, 0.0);
            assert!((image - expected).length() < 3e-6, "{image} instead of {expected}");
        }
    }
}

#[test]
fn a_smaller_stop_blurs_less() {
    let focused = |stop: f32| {
        let mut lens = LensSystem::new(&biconvex(), stop, None);
        lens.focus(2.0, 1e-5).unwrap();
        lens
    };
    let blur = |stop: f32| {
        let lens = focused(stop);
        let p = DVec3::new(0.0, 0.0, 1.2);
        let mut widest: f64 = 0.0;
        for i in 0..2000 {
            let ray = through(p, DVec3::new(f64::from(i) * 2e-6, 0.0, 0.11));
            if let Some((ray, _)) = lens.trace_from_scene(ray, Apertures::Closed) {
                widest = widest.max((ray.o - ray.d * (ray.o.z / ray.d.z)).x.abs());
            }
        }
        widest
    };
    let (wide, narrow) = (blur(4.0), blur(2.0));
    assert!((wide / narrow - 2.0).abs() < 0.05, "{wide} and {narrow}");
    // The circle of confusion of a thin lens: stop × |difference of image distances| / image
    // distance.
    let thick = focused(4.0).thick_lens(1e-5).unwrap();
    let object = 1.2 - thick.film_side - thick.separation;
    let image = 1.0 / (1.0 / thick.focal_length - 1.0 / object);
    let expected = 0.002 * (image - thick.film_side).abs() / image;
    assert!((wide / expected - 1.0).abs() < 0.05, "{wide} instead of {expected}");
}

#[test]
fn tracing_from_either_side_is_inverse() {
    let lens = LensSystem::new(&triplet(), 9.0, None);
    let mut random = Random::new(5);
    let mut next = || f64::from(random.get_1d());
    let mut passed = 0;
    for _ in 0..2000 {
        let film = DVec3::new(next() * 0.01, next() * 0.01, 0.0);
        let rear = DVec3::new(next() - 0.5, next() - 0.5, 0.0) * 0.012;
        let ray = through(film, rear.with_z(lens.rear_z()));
        let Some((out, _)) = lens.trace_from_film(ray, Apertures::Closed) else { continue };
        let back = LensRay { o: out.o + out.d, d: -out.d };
        let (back, _) = lens.trace_from_scene(back, Apertures::Open).unwrap();
        assert!((back.d + ray.d).length() < 1e-11);
        assert!((back.o - back.d * (back.o.z / back.d.z) - film).length() < 1e-11);
        passed += 1;
    }
    assert!(passed > 300, "{passed}");
}

#[test]
fn exit_pupils_contain_all_rays_that_pass() {
    let mut random = Random::new(5);
    let mut next = || f64::from(random.get_1d());
    for (lenses, stop) in [(triplet(), 9.0), (triplet(), 1.0), (biconvex(), 30.0)] {
        let mut lens = LensSystem::new(&lenses, stop, None);
        lens.focus(3.0, 1e-5).unwrap();
        let radius = 0.0175;
        let pupils = ExitPupils::new(&lens, radius as f32);
        let mut passed = 0;
        for _ in 0..20_000 {
            let (distance, turn) = (next() * radius, next() * 2.0 * PI);
            let around = |x: f64, y: f64| {
                DVec3::new(turn.cos() * x - turn.sin() * y, turn.sin() * x + turn.cos() * y, 0.0)
            };
            let reach = 3.0 * lens.rear_radius();
            let [x, y] = [next() - 0.5, next() - 0.5].map(|u| u * reach);
            let ray = through(around(distance, 0.0), around(x, y).with_z(lens.rear_z()));
            if lens.trace_from_film(ray, Apertures::Closed).is_some() {
                let pupil = pupils.at(distance as f32).expect("a pupil");
                assert!(pupil.contains(Vec2::new(x as f32, y as f32)), "({x}, {y}) not in {pupil:?}");
                passed += 1;
            }
        }
        assert!(passed > 20, "{passed}");
    }
}

/// The mean weight of rays from a film position: the irradiance there under the radiance 1.
fn irradiance(camera: &Camera, film: Vec2) -> f64 {
    const SIDE: u16 = 300;
    let mut sum = 0.0;
    for i in 0..SIDE {
        for j in 0..SIDE {
            let [u, v] = [i, j].map(|i| (f32::from(i) + 0.5) / f32::from(SIDE));
            let ray = camera.generate_ray(&sample(film.x, film.y, Vec2::new(u, v), 0.0));
            sum += ray.map_or(0.0, |ray| f64::from(ray.weight));
        }
    }
    sum / f64::from(SIDE).powi(2)
}

#[test]
fn irradiance_at_the_centre_follows_the_f_number() {
    let middle = Vec2::from(RESOLUTION.map(|n| n as f32 * 0.5));
    for stop in [2.0, 10.0, 30.0] {
        let mut lens = LensSystem::new(&biconvex(), stop, None);
        lens.focus(4.0, 35e-6).unwrap();
        // The stop is the last interface, so that its own distance gives the angle of the light.
        let n = lens.rear_z() / (f64::from(stop) * 1e-3);
        let expected = PI / (1.0 + 4.0 * n * n);
        let found = irradiance(&camera(&biconvex(), stop, 4.0), middle);
        assert!((found / expected - 1.0).abs() < 0.01, "{found} instead of {expected}");
    }
    let corner = irradiance(&camera(&triplet(), 9.0, 4.0), Vec2::ZERO);
    let centre = irradiance(&camera(&triplet(), 9.0, 4.0), middle);
    assert!(corner < 0.8 * centre, "{corner} and {centre}");
}

#[test]
fn shapes_of_stops_let_equal_light_through() {
    let picture = Image::from_fn(4, 2, ["R", "G", "B"], |x, y| [x as f32, y as f32, 1.0]);
    let black = Image::from_fn(4, 2, ["Y"], |_, _| [0.0]);
    assert!(ApertureMask::picture(&black).is_none());
    let masks = [
        ApertureMask::gaussian(),
        ApertureMask::square(),
        ApertureMask::pentagon(),
        ApertureMask::star(),
        ApertureMask::picture(&picture).unwrap(),
    ];
    for mask in masks {
        let mut sum = 0.0;
        for i in 0..400 {
            for j in 0..400 {
                let [x, y] = [i, j].map(|i| (f64::from(i) + 0.5) / 200.0 - 1.0);
                sum += f64::from(mask.share([x, y]));
            }
        }
        // Beyond the border an image is black, which dims its outermost half pixels.
        let mean = sum / 160_000.0;
        assert!(mean < PI / 4.0 + 1e-3 && mean > 0.6 * PI / 4.0, "{mask:?}: {mean}");
    }
    let is_open = |mask: &ApertureMask, x, y| mask.share([x, y]) > 0.0;
    let (square, star, pentagon) = (ApertureMask::square(), ApertureMask::star(), ApertureMask::pentagon());
    assert!(is_open(&square, 0.45, -0.45) && !is_open(&square, 0.55, 0.0));
    assert!(is_open(&star, -0.9, 0.0) && !is_open(&star, 0.9, 0.0));
    assert!(is_open(&pentagon, 0.0, -0.75) && !is_open(&pentagon, 0.0, 0.75));
    let top = ApertureMask::picture(&Image::from_fn(1, 2, ["Y"], |_, y| [1.0 - y as f32])).unwrap();
    assert!(top.share([0.0, 0.5]) > top.share([0.0, -0.5]));
}

#[test]
fn neighbours_meet_the_plane_of_focus_a_pixel_away() {
    let camera = camera(&triplet(), 9.0, 2.0);
    for film in [Vec2::new(100.0, 75.0), Vec2::new(60.0, 40.0), Vec2::new(130.0, 90.0)] {
        let lens = Vec2::new(0.4, 0.6);
        let at = |film: Vec2| sample(film.x, film.y, lens, 0.0);
        let full = camera.generate_ray_differential(&at(film)).unwrap().ray;
        let near = full.differentials.unwrap();
        let focus = |o: math::Point3, d: math::Vector3| o + d * ((2.0 - o.z) / d.z);
        let here = focus(full.ray.o, full.ray.d);
        for (o, d, axis) in
            [(near.rx_origin, near.rx_direction, Vec2::X), (near.ry_origin, near.ry_direction, Vec2::Y)]
        {
            let next = camera.generate_ray(&at(film + axis)).unwrap().ray;
            let (expected, found) = (focus(next.o, next.d) - here, focus(o, d) - here);
            assert!((found - expected).length() < 0.1 * expected.length(), "{found} {expected}");
            // The picture is upright: right and down on the film are right and down in the scene.
            assert!(found.x * axis.x - found.y * axis.y > 0.0, "{found}");
        }
    }
}

#[test]
fn lens_rays_do_not_depend_on_the_number_of_lanes() {
    let camera = build(realistic(&triplet(), 6.0, 3.0), somewhere(), RenderSpace::CameraWorld);
    lanes_agree(&Rays(&camera), 5, 20);
}

#[test]
fn lenses_that_cannot_be_used_are_reported() {
    let said = |kind: CameraKind| {
        let mut diagnostics = Vec::new();
        let desc = CameraDesc { kind, ..CameraDesc::default() };
        let images = Arena::default();
        let film = FilmDesc::default().into();
        let camera = compile(&desc.into(), &film, &images, DMat4::IDENTITY, &mut diagnostics);
        (camera.is_some(), diagnostics.into_iter().map(|d| d.message).collect::<Vec<_>>())
    };
    let concave = elements([[-100.0, 4.0, 1.5, 40.0], [100.0, 100.0, 1.0, 40.0]]);
    let mut blind = biconvex();
    blind[0].aperture_diameter = 1e-4;
    let broken = |change: fn(&mut LensElement)| {
        let mut elements = biconvex();
        change(&mut elements[1]);
        realistic(&elements, 1.0, 2.0)
    };
    for (kind, works, expected) in [
        (realistic(&biconvex(), 50.0, 2.0), true, "wider than the stop of the lens; 30 mm used"),
        (realistic(&biconvex(), 5.0, 0.3), false, "cannot be focused nearer than 0."),
        (realistic(&concave, 5.0, 3.0), false, "does not converge"),
        (realistic(&biconvex()[2..], 5.0, 3.0), false, "no interface"),
        (realistic(&blind, 1.0, 3.0), false, "no light passes the lens"),
        (broken(|element| element.eta = -1.0), false, "element 2 has the index of refraction -1"),
        (broken(|element| element.aperture_diameter = 0.0), false, "element 2 has the diameter 0 mm"),
        (broken(|element| element.curvature_radius = f32::NAN), false, "element 2 has no finite"),
    ] {
        let (is_built, messages) = said(kind);
        assert_eq!(is_built, works, "{messages:?}");
        assert!(messages.len() == 1 && messages[0].contains(expected), "{messages:?} for {expected:?}");
    }
}
