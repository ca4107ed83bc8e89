//! Water: the largest flat surface of a dielectric, which is drawn as a mirrored view of the scene.
//!
//! What is seen through it is found once for each of its vertices, straight below: the colour of
//! the ground there, and how much light the water lets through on the way. Where there is no ground
//! it is as if it were infinitely deep, and reflects diffusely (1 − γ)/(1 + γ) of the light that
//! enters it, with γ² the share that is absorbed at each collision [Chandrasekhar 1960].

use geometry::{GeometryId, RayStats};
use math::{Ray, Vec3};
use rayon::prelude::*;
use scene::material::Material;

use super::models::{Models, Vertex};
use super::paint::{Paint, Painter};
use super::placements::geometries_of_groups;

/// How much higher or lower than its plane a flat surface may be anywhere, as a share of its
/// extent.
const FLAT: f32 = 0.01;

/// A flat surface that mirrors.
pub struct Pond {
    /// Which one.
    pub geometry: GeometryId,
    /// Its plane, n·p + w = 0.
    pub plane: [f32; 4],
    /// Vertices with what is below as their paint: its reflectance, and the share of light that the
    /// water between lets through.
    pub vertices: Vec<Vertex>,
    /// The corners of triangles.
    pub indices: Vec<u32>,
    /// The index of refraction.
    pub index: f32,
    /// What deep water reflects of the light that enters it.
    pub deep: Vec3,
}

impl Pond {
    /// That of a scene, if it has one that is not instanced.
    pub fn new(painter: &Painter) -> Option<Self> {
        let scene = painter.scene;
        let top = geometries_of_groups(scene.world()).into_iter().next().unwrap_or_default();
        let candidates = top.into_iter().filter_map(|geometry| {
            let material = scene.geometries()[geometry.0 as usize].material;
            let Material::Dielectric(glass) = &scene.materials()[material.0 as usize].material else {
                return None;
            };
            let mut model = Models::default();
            model.add(painter, geometry);
            let (plane, radius) = plane(&model.vertices)?;
            Some((geometry, plane, radius, model, glass.eta.at(550.0)))
        });
        let largest = candidates.max_by(|a, b| a.2.total_cmp(&b.2));
        let (geometry, plane, radius, Models { vertices, indices, .. }, index) = largest?;
        let entry = &scene.geometries()[geometry.0 as usize];
        let medium = entry.media.and_then(|media| media.inside).map(|id| &scene.media()[id.0 as usize]);
        let [mut extinction, mut deep] = [Vec3::ZERO; 2];
        if let Some(medium) = medium {
            let of = |lambda: &_| medium.homogeneous(lambda).unwrap_or_default();
            extinction = painter.colors.factor(|lambda| of(lambda).sigma_t());
            deep = painter.colors.factor(|lambda| {
                of(lambda)
                    .sigma_a
                    .safe_div(of(lambda).sigma_t())
                    .sqrt()
                    .map(|gamma| (1.0 - gamma) / (1.0 + gamma))
            });
        }
        let n = Vec3::new(plane[0], plane[1], plane[2]);
        let below = |vertex: &Vertex| {
            let mut from = vertex.position() - n * (1e-4 * radius);
            let mut paint = Paint::default();
            // The surface itself is passed.
            for _ in 0..4 {
                let ray = Ray::new(from, -n, painter.view.camera.sample_time(0.5));
                let Some(hit) = scene.hit(&ray, f32::INFINITY, &mut RayStats::default()) else { break };
                if hit.geometry == geometry {
                    from -= n * (hit.t + 1e-4 * radius);
                    continue;
                }
                if painter.is_nothing(hit.geometry) {
                    break;
                }
                let depth = n.dot(vertex.position() - from) + hit.t;
                paint.reflectance = painter.of(&hit, scene.world().surface(&ray, &hit)).reflectance;
                paint.transmittance = (extinction * -depth).to_array().map(f32::exp).into();
                break;
            }
            Vertex::new(vertex.position(), vertex.normal(), &paint)
        };
        let vertices = vertices.par_iter().map(below).collect();
        Some(Self { geometry, plane, vertices, indices, index, deep })
    }

    /// Its plane, turned towards a point.
    pub fn plane_towards(&self, p: Vec3) -> [f32; 4] {
        let [x, y, z, w] = self.plane;
        if Vec3::new(x, y, z).dot(p) + w < 0.0 { self.plane.map(|x| -x) } else { self.plane }
    }
}

/// The plane of vertices that are nearly in one, and the radius of them all.
fn plane(vertices: &[Vertex]) -> Option<([f32; 4], f32)> {
    let count = vertices.len() as f32;
    let n = vertices.iter().map(Vertex::normal).sum::<Vec3>().try_normalize()?;
    let center = vertices.iter().map(Vertex::position).sum::<Vec3>() / count;
    let apart = |v: &Vertex| v.position() - center;
    let radius = vertices.iter().map(|v| apart(v).length()).fold(0.0, f32::max);
    let height = vertices.iter().map(|v| n.dot(apart(v)).abs()).fold(0.0, f32::max);
    (height <= FLAT * radius).then_some(([n.x, n.y, n.z, -n.dot(center)], radius))
}
