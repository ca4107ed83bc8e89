//! Paul Heckbert's business card ray tracer, with the geometry of alhazen
//! ([Heckbert 1994]).
//!
//! Five spheres under the faint light of a uniform sky. At each hit a ray splits into a reflected
//! and a refracted one, and a shadow ray is traced to the centre of every emitting sphere.
//! `cargo run --release --example minray -- 256 > minray.ppm` draws it larger than the card's 32 ×
//! 32 pixels.

use alhazen::geometry::{Shape, Sphere, SurfacePoint};
use alhazen::math::{Point3, Ray, Transform, Vec3};

/// The maximum depth of the ray tree.
const LEVELS: u32 = 3;
/// The radiance of rays that hit nothing.
const AMBIENT: Vec3 = Vec3::splat(0.02);
/// Angle of view in degrees.
const FIELD_OF_VIEW: f32 = 25.0;

/// A sphere, with its diffuse and specular reflection, transmission and emission.
struct Ball {
    shape: Shape,
    center: Point3,
    color: Vec3,
    diffuse: f32,
    specular: f32,
    transmission: f32,
    light: f32,
    /// Index of refraction.
    index: f32,
}

#[rustfmt::skip]
fn balls() -> [Ball; 5] {
    let ball = |center, color, radius, [diffuse, specular, transmission, light, index]: [f32; 5]| {
        let center = Vec3::from_array(center);
        let shape = Shape::Sphere(Box::new(Sphere::whole(&Transform::translate(center), false, radius)));
        Ball { shape, center, color: Vec3::from_array(color), diffuse, specular, transmission, light, index }
    };
    [
        ball([ 0.0,  6.0,  0.5], [1.0, 1.0, 1.0], 0.9, [0.05, 0.2, 0.85, 0.0,  1.7]),
        ball([-1.0,  8.0, -0.5], [1.0, 0.5, 0.2], 1.0, [0.7,  0.3, 0.0,  0.05, 1.2]),
        ball([ 1.0,  8.0, -0.5], [0.1, 0.8, 0.8], 1.0, [0.3,  0.7, 0.0,  0.0,  1.2]),
        ball([ 3.0, -6.0, 15.0], [1.0, 0.8, 1.0], 7.0, [0.0,  0.0, 0.0,  0.6,  1.5]),
        ball([-3.0, -3.0, 12.0], [0.8, 1.0, 1.0], 5.0, [0.0,  0.0, 0.0,  0.5,  1.5]),
    ]
}

/// The first sphere that a ray hits, and the hit.
fn nearest<'a>(balls: &'a [Ball], ray: &Ray) -> Option<(&'a Ball, SurfacePoint)> {
    let hits = balls.iter().filter_map(|ball| Some((ball, ball.shape.intersect(ray, f32::INFINITY)?)));
    let (ball, hit) = hits.min_by(|(_, a), (_, b)| a.t.total_cmp(&b.t))?;
    Some((ball, ball.shape.surface(ray, &hit)))
}

/// The light that comes back along a ray of unit direction.
fn trace(balls: &[Ball], ray: &Ray, levels: u32) -> Vec3 {
    if levels == 0 {
        return Vec3::ZERO;
    }
    let Some((ball, point)) = nearest(balls, ray) else { return AMBIENT };
    let outside = point.n.dot(ray.d) < 0.0;
    let (n, eta) = if outside { (point.n, 1.0 / ball.index) } else { (-point.n, ball.index) };
    let cosine = -n.dot(ray.d);

    let lit_by = |source: &Ball| {
        let to_light = (source.center - point.p.p).normalize();
        let strength = source.light * n.dot(to_light);
        let (first, _) = nearest(balls, &point.spawn_ray(to_light))?;
        (strength > 0.0 && std::ptr::eq(first, source)).then_some(strength * source.color)
    };
    let direct = AMBIENT + balls.iter().filter_map(lit_by).sum::<Vec3>();

    let onwards = |d: Vec3| trace(balls, &point.spawn_ray(d), levels - 1);
    let reflected = onwards(ray.d + 2.0 * cosine * n);
    let cosine2_transmitted = 1.0 - eta * eta * (1.0 - cosine * cosine);
    let bent = || eta * ray.d + (eta * cosine - cosine2_transmitted.sqrt()) * n;
    let refracted = if cosine2_transmitted > 0.0 { onwards(bent()) } else { Vec3::ZERO };
    let own = (ball.diffuse * direct + ball.light) * ball.color;
    own + ball.specular * reflected + ball.transmission * refracted
}

/// The picture of `size` × `size` pixels, from the top left, as red, green and blue from 0 to 255.
pub fn picture(size: u32) -> Vec<[u8; 3]> {
    let (balls, middle) = (balls(), size as f32 / 2.0);
    let distance = middle / (0.5 * FIELD_OF_VIEW.to_radians()).tan();
    let pixel = |index: u32| {
        let (column, row) = ((index % size) as f32, (index / size) as f32);
        let d = Vec3::new(column - middle, distance, middle - row).normalize();
        trace(&balls, &Ray::new(Point3::ZERO, d, 0.0), LEVELS).to_array().map(|c| (255.0 * c).round() as u8)
    };
    (0..size * size).map(pixel).collect()
}

/// Prints the picture as a plain portable pixmap.
pub fn main() {
    let size = std::env::args().nth(1).unwrap_or("32".into());
    let Ok(size) = size.parse::<u16>() else { return eprintln!("usage: minray [SIZE IN PIXELS]") };
    println!("P3\n{size} {size}\n255");
    picture(size.into()).iter().for_each(|[r, g, b]| println!("{r} {g} {b}"));
}
