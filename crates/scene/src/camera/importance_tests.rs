//! Importance agrees with the rays that the camera generates.

use super::tests::{RESOLUTION, build, kinds, sample, somewhere};
use super::{Camera, CameraSample};
use description::{RenderSpace, TransformDesc};
use math::{Bounds2, DMat4, DVec3, Point3, Ray, Vec2, Vec3};
use testkit::{Moments, Random, t_test, welch_test};

/// Cameras at rest, scaled and sheared, and in motion.
fn cameras() -> Vec<(String, Camera)> {
    let mut sheared = DMat4::from_scale(DVec3::new(0.5, -0.4, 0.7));
    sheared.z_axis.x = 0.2;
    let moving = TransformDesc {
        start: DMat4::from_translation(DVec3::new(-1.0, 0.0, 0.0)),
        end: DMat4::from_rotation_y(0.3) * DMat4::from_translation(DVec3::new(-1.2, 0.1, 0.3)),
        times: [0.0, 1.0],
    };
    let places = [("", somewhere()), (", sheared", TransformDesc::fixed(sheared)), (", moving", moving)];
    let mut cameras = Vec::new();
    for (place, transform) in places {
        for (name, kind) in kinds() {
            cameras.push((format!("{name}{place}"), build(kind, transform, RenderSpace::CameraWorld)));
        }
    }
    cameras
}

fn anywhere(random: &mut Random) -> CameraSample {
    let film = Vec2::from(random.get_2d()) * Vec2::from(RESOLUTION.map(|n| n as f32));
    sample(film.x, film.y, random.get_2d().into(), random.get_1d())
}

#[test]
fn importance_returns_the_film_position_of_a_ray() {
    let mut random = Random::new(1);
    for (name, camera) in cameras() {
        for _ in 0..500 {
            let from = anywhere(&mut random);
            let ray = camera.generate_ray(&from).unwrap().ray;
            let (we, film) = camera.we(&ray).unwrap();
            assert!((film - from.film).length() < 2e-3, "{name}: {film} {}", from.film);
            // The same ray, from a point on it.
            let p = ray.at(0.5 + 5.0 * random.get_1d());
            let way = camera.sample_wi(p, ray.time, from.lens).unwrap();
            assert!((way.film - film).length() < 2e-3, "{name}: {} {film}", way.film);
            assert!((way.wi + ray.d).length() < 1e-5 && (way.p - ray.o).length() < 1e-5, "{name}");
            assert!((way.we / we - 1.0).abs() < 1e-3, "{name}: {} {we}", way.we);
            let (position, direction) = camera.pdf_we(&ray);
            let cos_theta = if way.n == Vec3::ZERO { 1.0 } else { way.n.dot(ray.d) };
            assert!((position * direction / cos_theta / we - 1.0).abs() < 1e-3, "{name}");
            let pdf =
                if camera.is_parallel() { 1.0 } else { position * p.distance_squared(ray.o) / cos_theta };
            assert!((way.pdf / pdf - 1.0).abs() < 1e-3, "{name}: {} {pdf}", way.pdf);
        }
    }
}

#[test]
fn film_positions_of_a_ray_generate_the_same_ray() {
    let mut random = Random::new(4);
    let size = Vec2::from(RESOLUTION.map(|n| n as f32));
    let around = Bounds2 { min: size * -0.4, max: size * 1.4 };
    for (name, camera) in cameras() {
        let mut beyond = 0;
        for _ in 0..500 {
            let film = around.lerp(random.get_2d().into());
            let from = sample(film.x, film.y, random.get_2d().into(), random.get_1d());
            let ray = camera.generate_ray(&from).unwrap().ray;
            let (_, found) = camera.we(&ray).unwrap();
            let places: Vec<_> = camera.film_positions(found).within(around).collect();
            assert!(places.iter().any(|&place| (place - film).length() < 2e-3), "{name}: {film} {places:?}");
            for (i, &place) in places.iter().enumerate() {
                let again = camera.generate_ray(&CameraSample { film: place, ..from }).unwrap().ray;
                assert!((again.d - ray.d).length() < 1e-3, "{name}: {film} {place}");
                let is_new = places[..i].iter().all(|&other| (other - place).length() > 1e-3);
                assert!(is_new, "{name}: {place} counts twice");
            }
            beyond += usize::from(places.len() > 1);
        }
        assert_eq!(beyond > 100, name.starts_with("eq"), "{name}: {beyond}");
    }
}

#[test]
fn densities_are_those_of_neighbouring_rays() {
    let mut random = Random::new(2);
    for (name, camera) in cameras() {
        for _ in 0..50 {
            let from = anywhere(&mut random);
            let ray = |film, lens| camera.generate_ray(&CameraSample { film, lens, ..from }).unwrap().ray;
            let middle = ray(from.film, from.lens);
            let (position, direction) = camera.pdf_we(&middle);
            let h = 0.5;
            let across =
                |axis: Vec2| (ray(from.film + axis * h, from.lens), ray(from.film - axis * h, from.lens));
            let [x, y] = [Vec2::X, Vec2::Y].map(across);
            let near = |a: f32, b: f32| assert!((a / b - 1.0).abs() < 0.02, "{name}: {a} {b} {from:?}");
            if camera.is_parallel() {
                near(position, 1.0 / (x.0.o - x.1.o).cross(y.0.o - y.1.o).length());
                assert_eq!(direction, 1.0, "{name}");
                continue;
            }
            // Near a pole directions change quickly; at a fold of the octahedron their derivative
            // is discontinuous.
            let solid_angle = (x.0.d - x.1.d).cross(y.0.d - y.1.d).length();
            let is_even = !name.starts_with("eq") || (middle.d.y.abs() < 0.9 && !near_a_fold(&from));
            if is_even {
                near(direction, 1.0 / solid_angle);
            }
            if camera.we(&middle).is_some() && ray(from.film, Vec2::ZERO).o == middle.o {
                assert_eq!(position, 1.0, "{name}");
            } else {
                // Within one quarter of the concentric mapping, areas of the lens and of its square
                // are proportional.
                let lens = |u: f32, v: f32| ray(from.film, Vec2::new(u, v)).o;
                let (right, up) = (lens(0.9, 0.51) - lens(0.9, 0.49), lens(0.91, 0.5) - lens(0.89, 0.5));
                near(position, 0.02 * 0.02 / right.cross(up).length());
            }
        }
    }
}

/// Whether a film position is near the diamond or the axes along which the equal-area map is
/// folded.
fn near_a_fold(from: &CameraSample) -> bool {
    let st = from.film / Vec2::from(RESOLUTION.map(|n| n as f32)) * 2.0 - 1.0;
    let edge = (st.x.abs() + st.y.abs() - 1.0).abs();
    edge.min(st.x.abs()).min(st.y.abs()) < 0.03
}

#[test]
fn the_integral_of_importance_is_the_number_of_pixels() {
    let cameras = cameras();
    let mut random = Random::new(3);
    let pixels = (RESOLUTION[0] * RESOLUTION[1]) as f64;
    for (name, camera) in cameras.iter().filter(|(_, camera)| !camera.is_parallel()) {
        let first = camera.generate_ray(&sample(0.0, 0.0, Vec2::splat(0.4), 0.7)).unwrap().ray;
        let seen: Moments = (0..100_000)
            .map(|_| {
                let d = sampling::warp::sample_uniform_sphere(random.get_2d().into());
                let ray = Ray { d, ..first };
                let on_film = camera.we(&ray).is_some_and(|(_, film)| is_on_film(film));
                let density = if on_film { camera.pdf_we(&ray).1 } else { 0.0 };
                f64::from(density * 4.0 * std::f32::consts::PI)
            })
            .collect();
        if seen.variance_of_mean().sqrt() < 1e-5 * pixels {
            assert!((seen.mean / pixels - 1.0).abs() < 1e-4, "{name}: {}", seen.mean);
        } else {
            t_test(&seen, pixels, cameras.len()).unwrap_or_else(|e| panic!("{name}: {e}"));
        }
    }
}

fn is_on_film(film: Vec2) -> bool {
    film.cmpge(Vec2::ZERO).all() && film.cmplt(Vec2::from(RESOLUTION.map(|n| n as f32))).all()
}

/// A parallelogram of radiance 1 on one side.
struct Lamp {
    corner: Point3,
    sides: [Vec3; 2],
}

impl Lamp {
    fn cross(&self) -> Vec3 {
        self.sides[0].cross(self.sides[1])
    }

    fn is_met(&self, ray: &Ray) -> bool {
        let cross = self.cross();
        let t = cross.dot(self.corner - ray.o) / cross.dot(ray.d);
        let q = ray.at(t) - self.corner;
        let [u, v] =
            [q.cross(self.sides[1]), self.sides[0].cross(q)].map(|c| c.dot(cross) / cross.dot(cross));
        t > 0.0 && cross.dot(ray.d) < 0.0 && (0.0..1.0).contains(&u) && (0.0..1.0).contains(&v)
    }
}

#[test]
fn a_lamp_is_as_bright_by_camera_rays_as_by_light_rays() {
    let cameras = cameras();
    let pixels = (RESOLUTION[0] * RESOLUTION[1]) as f32;
    for (i, (name, camera)) in cameras.iter().enumerate() {
        let mut random = Random::new(10 + i as u64);
        let place = camera.transform().render_from_camera(0.5);
        // Partly beside the film.
        let sides = [Vec3::new(-0.2, 1.0, 0.3), Vec3::new(1.4, 0.3, 0.5)].map(|side| place.vector(side));
        let mut lamp = Lamp { corner: place.point(Vec3::new(-0.4, -0.6, 3.5)), sides };
        if lamp.cross().dot(place.vector(Vec3::Z)) > 0.0 {
            lamp.sides.swap(0, 1);
        }
        let seen: Moments = (0..200_000)
            .map(|_| {
                let ray = camera.generate_ray(&anywhere(&mut random)).unwrap();
                if lamp.is_met(&ray.ray) { f64::from(ray.weight * pixels) } else { 0.0 }
            })
            .collect();
        let sent: Moments = (0..200_000)
            .map(|_| {
                let [u, v] = random.get_2d();
                let p = lamp.corner + lamp.sides[0] * u + lamp.sides[1] * v;
                let way = camera.sample_wi(p, camera.sample_time(random.get_1d()), random.get_2d().into());
                let Some(way) = way.filter(|way| is_on_film(way.film)) else { return 0.0 };
                // The cosine times the area.
                f64::from(way.we * lamp.cross().dot(way.wi).max(0.0) / way.pdf)
            })
            .collect();
        assert!(seen.mean > 0.0, "{name}: the lamp is not seen");
        welch_test(&seen, &sent, cameras.len()).unwrap_or_else(|e| panic!("{name}: {e}"));
    }
}

#[test]
fn points_behind_the_camera_are_not_seen() {
    for (name, camera) in cameras() {
        let behind = camera.transform().render_from_camera(0.0).point(Vec3::new(0.1, 0.2, -1.0));
        let seen = camera.sample_wi(behind, 0.0, Vec2::splat(0.3));
        assert_eq!(seen.is_some(), name.starts_with("eq"), "{name}");
        let back = camera.transform().render_from_camera(0.0).vector(-Vec3::Z).normalize();
        let ray = Ray::new(Vec3::ZERO, back, 0.0);
        assert_eq!(camera.pdf_we(&ray).1 > 0.0, name.starts_with("eq"), "{name}");
        assert!(camera.sample_wi(Vec3::NAN, 0.0, Vec2::ZERO).is_none(), "{name}");
    }
}
