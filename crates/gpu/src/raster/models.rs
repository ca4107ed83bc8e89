//! The surfaces of a scene as vertices and triangles: a model for each group, which its instances
//! place.

use std::collections::HashMap;
use std::ops::Range;

use geometry::{Geometry, GeometryId, Shape, TriangleMesh};
use math::{Bounds3, Vec2, Vec3};
use rayon::prelude::*;

use super::paint::{Paint, Painter};
use super::placements::geometries_of_groups;

/// A vertex, as `shaders/raster_surfaces.wgsl` reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::NoUninit)]
pub struct Vertex {
    position: [f32; 3],
    /// The normal in 1/32767. The last number is on single-sided surfaces 1 where corners run
    /// counter-clockwise as the front is seen, and -1 where they run clockwise.
    normal: [i16; 4],
    /// Square roots of the shares in ten bits each, and in two bits how they are meant.
    reflectance: u32,
    transmittance: u32,
}

impl Vertex {
    /// A vertex with a paint.
    pub fn new(position: Vec3, normal: Vec3, paint: &Paint) -> Self {
        let n = normal.normalize_or_zero() * f32::from(i16::MAX);
        let bits = |share: Vec3| {
            let bits = share.to_array().map(|x| (x.clamp(0.0, 1.0).sqrt() * 1023.0).round() as u32);
            bits[0] | bits[1] << 10 | bits[2] << 20
        };
        Self {
            position: position.to_array(),
            normal: [n.x, n.y, n.z, 0.0].map(|x| x as i16),
            reflectance: bits(paint.reflectance) | (paint.shading as u32) << 30,
            transmittance: bits(paint.transmittance),
        }
    }

    /// Makes it a vertex of a single-sided surface, whose corners run this way round.
    fn single_sided(&mut self, runs_clockwise: bool) {
        self.normal[3] = if runs_clockwise { -i16::MAX } else { i16::MAX };
    }

    /// Where it is.
    pub fn position(&self) -> Vec3 {
        self.position.into()
    }

    /// Its normal.
    pub fn normal(&self) -> Vec3 {
        let [x, y, z, _] = self.normal.map(f32::from);
        Vec3::new(x, y, z) / f32::from(i16::MAX)
    }
}

/// The surfaces of a group.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// Their corners among all indices.
    pub indices: Range<u32>,
    /// A ball around them.
    pub center: Vec3,
    /// Its radius.
    pub radius: f32,
}

impl Model {
    /// The number of triangles.
    pub fn triangles(&self) -> u64 {
        u64::from(self.indices.end - self.indices.start) / 3
    }
}

/// The models of all groups.
#[derive(Default)]
pub struct Models {
    /// Vertices.
    pub vertices: Vec<Vertex>,
    /// The corners of triangles.
    pub indices: Vec<u32>,
    /// By the ids of groups.
    pub groups: Vec<Model>,
    /// The geometries that have no triangles.
    pub left_out: Vec<GeometryId>,
}

impl Models {
    /// Those of a scene, but for one geometry.
    pub fn new(painter: &Painter, except: Option<GeometryId>) -> Self {
        let world = painter.scene.world();
        let mut models = Self::default();
        for geometries in geometries_of_groups(world) {
            let first = models.indices.len() as u32;
            let first_vertex = models.vertices.len();
            for geometry in geometries.into_iter().filter(|id| Some(*id) != except) {
                models.add(painter, geometry);
            }
            let positions = || models.vertices[first_vertex..].iter().map(Vertex::position);
            let center = Bounds3::around(positions()).centroid();
            let radius = positions().map(|p| (p - center).length()).fold(0.0, f32::max);
            let indices = first..models.indices.len() as u32;
            models.groups.push(Model { indices, center, radius });
        }
        models
    }

    /// Adds the triangles of a geometry.
    pub fn add(&mut self, painter: &Painter, id: GeometryId) {
        let geometry = painter.scene.world().geometry(id);
        if painter.is_nothing(id) || geometry.is_empty() {
            return;
        }
        match geometry {
            Geometry::Mesh(mesh) => self.add_mesh(painter, id, mesh),
            Geometry::Shapes(shapes) => {
                for (shape, primitive) in shapes.iter().zip(0..) {
                    self.add_shape(painter, id, primitive, shape, [48, 24]);
                }
            }
            Geometry::Spheres(set) => {
                // About as many triangles for many as for few.
                let steps = (160 / (set.len() as f32).sqrt() as u32).clamp(6, 48);
                for primitive in 0..set.len() as u32 {
                    let sphere = set.sphere(primitive as usize).into();
                    self.add_shape(painter, id, primitive, &sphere, [steps, steps / 2]);
                }
            }
            Geometry::Curves(_) => self.left_out.push(id),
        }
    }

    fn add_mesh(&mut self, painter: &Painter, id: GeometryId, mesh: &TriangleMesh) {
        let one = painter.at(id, 0, Vec2::splat(1.0 / 3.0));
        let varies = painter.varies(id);
        // Triangles share the vertices where all is the same. Those without normals have their own.
        let (mut corners, mut known) = (Vec::new(), HashMap::new());
        let first = self.vertices.len() as u32;
        for i in 0..mesh.len() as u32 {
            let triangle = mesh.triangle(i as usize);
            let n = (triangle.p[1] - triangle.p[0]).cross(triangle.p[2] - triangle.p[0]);
            for corner in 0..3 {
                let next = first + corners.len() as u32;
                let p = triangle.p[corner];
                let (index, n) = match triangle.n {
                    Some(normals) => {
                        let n = normals[corner];
                        let numbers =
                            [p.to_array(), n.to_array(), [triangle.uv[corner].x, triangle.uv[corner].y, 0.0]];
                        (*known.entry(numbers.map(|v| v.map(f32::to_bits))).or_insert(next), n)
                    }
                    None => (next, n),
                };
                if index == next {
                    corners.push((p, n, i, corner));
                }
                self.indices.push(index);
            }
        }
        self.vertices.par_extend(corners.into_par_iter().map(|(p, n, triangle, corner)| {
            let uv = [Vec2::ZERO, Vec2::X, Vec2::Y][corner];
            Vertex::new(p, n, &if varies { painter.at(id, triangle, uv) } else { one })
        }));
        if painter.scene.geometries()[id.0 as usize].single_sided {
            let clockwise = mesh.triangle(0).flips;
            self.vertices[first as usize..].iter_mut().for_each(|vertex| vertex.single_sided(clockwise));
        }
    }

    /// Adds a curved shape as a grid over its parameters.
    fn add_shape(
        &mut self,
        painter: &Painter,
        id: GeometryId,
        primitive: u32,
        shape: &Shape,
        steps: [u32; 2],
    ) {
        let time = painter.view.camera.sample_time(0.5);
        let is_triangle = matches!(shape, Shape::Triangle(_) | Shape::MovingTriangle(_));
        let [columns, rows] = if is_triangle { [1, 1] } else { steps };
        let varies = painter.varies(id);
        let one = painter.at(id, primitive, Vec2::splat(0.5));
        let first = self.vertices.len() as u32;
        for i in 0..(columns + 1) * (rows + 1) {
            let uv = Vec2::new(
                (i % (columns + 1)) as f32 / columns as f32,
                (i / (columns + 1)) as f32 / rows as f32,
            );
            let Some(surface) = shape.surface_at(uv, time) else {
                self.left_out.push(id);
                return;
            };
            let paint = if varies { painter.at(id, primitive, uv) } else { one };
            self.vertices.push(Vertex::new(surface.p.p, surface.shading.n, &paint));
        }
        let cell = |i: u32| {
            let a = first + i / columns * (columns + 1) + i % columns;
            [a, a + 1, a + columns + 1, a + columns + 2]
        };
        if painter.scene.geometries()[id.0 as usize].single_sided {
            // Cells in the middle are not at a pole.
            let middle = rows / 2 * columns + columns / 2;
            let [a, b, c, _] = cell(middle).map(|i| self.vertices[i as usize].position());
            let uv = Vec2::new((columns / 2) as f32 / columns as f32, (rows / 2) as f32 / rows as f32);
            let front = shape.surface_at(uv, time).map_or(Vec3::ZERO, |surface| surface.front());
            let clockwise = (b - a).cross(c - a).dot(front) < 0.0;
            self.vertices[first as usize..].iter_mut().for_each(|vertex| vertex.single_sided(clockwise));
        }
        for i in 0..columns * rows {
            let [a, b, c, d] = cell(i);
            self.indices.extend([a, b, c]);
            if !is_triangle {
                self.indices.extend([b, d, c]);
            }
        }
    }
}
