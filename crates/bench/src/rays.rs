//! Five sets of rays, as a path tracer traces them.
//!
//! - *primary*: one through the centre of each pixel, by rows;
//! - *diffuse*: from each primary hit, 10⁻⁴ above the surface, along a cosine-distributed
//!   direction;
//! - *shuffled*: the same in random order, so that consecutive rays are incoherent;
//! - *shadow*: from the same points to random points of the light, t from 0 to 0.999 of the way;
//! - *any-hit diffuse*: the diffuse rays again, as any-hit queries.

use crate::mesh::{BenchMesh, SplitMix64};
use geometry::RayBuffer;
use math::{Ray, Vec3};
use std::f32::consts::PI;
use std::sync::Arc;

/// A ray with an end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BenchRay {
    /// The ray.
    pub ray: Ray,
    /// Its end.
    pub t_max: f32,
}

/// The query of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Query {
    /// The nearest hit.
    Closest,
    /// Whether there is any hit.
    Any,
}

/// A set of rays.
#[derive(Clone, Debug)]
pub struct RaySet {
    /// Name.
    pub name: &'static str,
    /// Query.
    pub query: Query,
    /// Rays.
    pub rays: Arc<[BenchRay]>,
    /// The same for batches.
    pub columns: RayBuffer,
}

impl RaySet {
    fn new(name: &'static str, query: Query, rays: impl Into<Arc<[BenchRay]>>) -> Self {
        let rays = rays.into();
        let columns = rays.iter().map(|of| (of.ray, of.t_max)).collect();
        Self { name, query, columns, rays }
    }
}

/// The result of tracing a set.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Answer {
    /// Number of rays that hit something.
    pub hits: u64,
    /// Sum of the distances of nearest hits.
    pub sum_t: f64,
}

impl Answer {
    /// Adds the nearest hit of a ray.
    #[inline]
    pub fn add(&mut self, t: f32) {
        self.hits += 1;
        self.sum_t += f64::from(t);
    }

    /// Whether the results of two engines agree up to rounding, which matters at silhouettes and
    /// edges that are not watertight.
    pub fn agrees(&self, other: &Self) -> bool {
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-4 * a.max(b);
        close(self.hits as f64, other.hits as f64) && close(self.sum_t, other.sum_t)
    }
}

/// The five sets for a mesh, from `width`² primary rays. `closest` gives distance and triangle of
/// the nearest hit.
pub fn ray_sets(
    mesh: &BenchMesh,
    width: usize,
    closest: impl Fn(&BenchRay) -> Option<(f32, usize)>,
) -> [RaySet; 5] {
    let primary = primary(mesh, width);
    let (mut diffuse, mut shadow) = (Vec::new(), Vec::new());
    for (pixel, primary) in primary.iter().enumerate() {
        let Some((t, triangle)) = closest(primary) else { continue };
        let Ray { o: eye, d, .. } = primary.ray;
        let n = facing_normal(mesh.indices[triangle].map(|i| mesh.positions[i as usize]), d);
        let random = &mut SplitMix64(2 * pixel as u64);
        let [u1, u2, l1, l2] = [0; 4].map(|_| random.uniform() as f32);
        let o = eye + d * t + n * 1e-4;
        let bounce = Ray::new(o, cosine_direction(n, u1, u2), 0.0);
        diffuse.push(BenchRay { ray: bounce, t_max: f32::INFINITY });
        let [corner, a, b] = mesh.light;
        let ray = Ray::new(o, corner + a * l1 + b * l2 - o, 0.0);
        shadow.push(BenchRay { ray, t_max: 0.999 });
    }
    let shuffled = shuffled(diffuse.clone());
    let diffuse: Arc<[BenchRay]> = diffuse.into();
    [
        RaySet::new("primary", Query::Closest, primary),
        RaySet::new("diffuse", Query::Closest, diffuse.clone()),
        RaySet::new("shuffled", Query::Closest, shuffled),
        RaySet::new("shadow", Query::Any, shadow),
        RaySet::new("any-hit diffuse", Query::Any, diffuse),
    ]
}

fn primary(mesh: &BenchMesh, width: usize) -> Vec<BenchRay> {
    let view = &mesh.view;
    let forward = (view.target - view.eye).normalize();
    let right = forward.cross(view.up).normalize();
    let up = right.cross(forward);
    let half = (view.fov * PI / 360.0).tan();
    let place = |pixel: usize| (2.0 * (pixel as f32 + 0.5) / width as f32 - 1.0) * half;
    let through =
        |pixel: usize| (forward + right * place(pixel % width) - up * place(pixel / width)).normalize();
    let ray = |pixel| BenchRay { ray: Ray::new(view.eye, through(pixel), 0.0), t_max: f32::INFINITY };
    (0..width * width).map(ray).collect()
}

/// The unit normal of a triangle on the side that a ray along `d` comes from.
fn facing_normal([a, b, c]: [Vec3; 3], d: Vec3) -> Vec3 {
    let n = (b - a).cross(c - a).normalize();
    if n.dot(d) > 0.0 { -n } else { n }
}

fn cosine_direction(n: Vec3, u1: f32, u2: f32) -> Vec3 {
    let s = n.cross(if n.x.abs() > 0.5 { Vec3::Y } else { Vec3::X }).normalize();
    let t = n.cross(s);
    let (r, phi) = (u1.sqrt(), 2.0 * PI * u2);
    s * (r * phi.cos()) + t * (r * phi.sin()) + n * (1.0 - u1).sqrt()
}

/// Fisher–Yates shuffle.
fn shuffled(mut rays: Vec<BenchRay>) -> Vec<BenchRay> {
    let random = &mut SplitMix64(42);
    for i in (1..rays.len()).rev() {
        rays.swap(i, (random.bits() % (i as u64 + 1)) as usize);
    }
    rays
}
