//! Triangle meshes, written as binary PLY.

use std::f32::consts::TAU;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use math::{Frame, Vec2, Vec3};

/// A mesh of triangles, with a normal at each vertex or none at all, and likewise texture
/// coordinates.
#[derive(Default)]
pub struct Mesh {
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub uvs: Vec<Vec2>,
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Adds a grid of `columns` × `rows` points, of which `point` gives position and normal.
    pub fn grid(&mut self, [columns, rows]: [u32; 2], point: impl Fn(u32, u32) -> [Vec3; 2]) {
        let first = self.positions.len() as u32;
        for y in 0..rows {
            for x in 0..columns {
                let [p, n] = point(x, y);
                self.positions.push(p);
                self.normals.push(n);
            }
        }
        for y in 1..rows {
            for x in 1..columns {
                let d = first + y * columns + x;
                let [a, b, c] = [d - columns - 1, d - columns, d - 1];
                self.triangles.extend([[a, b, d], [a, d, c]]);
            }
        }
    }

    /// Adds a tube about a polyline of at least two points with their radii.
    pub fn tube(&mut self, points: &[(Vec3, f32)], sides: u32) {
        let mut frame = Frame::from_z((points[1].0 - points[0].0).normalize_or(Vec3::Z));
        let first = self.positions.len() as u32;
        for (i, &(p, radius)) in points.iter().enumerate() {
            let (before, after) = (points[i.saturating_sub(1)].0, points[(i + 1).min(points.len() - 1)].0);
            let along = (after - before).normalize_or(frame.z);
            // The frame turns as little as it can, so that the tube is not twisted.
            frame = Frame::from_z_and_x(along, frame.x);
            for side in 0..sides {
                let (sin, cos) = lanes::sin_cos(TAU * side as f32 / sides as f32);
                let out = frame.x * cos + frame.y * sin;
                self.positions.push(p + out * radius);
                self.normals.push(out);
            }
        }
        self.rings(first, points.len() as u32, sides, true);
    }

    /// Adds what a polyline makes that turns about the axis x, from points with their x and their
    /// distance from the axis. The outside is on the left of the line. It has an edge where a point
    /// is given twice.
    pub fn lathe(&mut self, points: &[[f32; 2]], sides: u32) {
        let first = self.positions.len() as u32;
        let normal = |i: usize, j: usize| {
            let [a, b] = [i, j].map(|i| Vec2::from_array(points[i.min(points.len() - 1)]));
            Vec2::new(a.y - b.y, b.x - a.x).normalize_or_zero()
        };
        for (i, &[x, radius]) in points.iter().enumerate() {
            let n = (normal(i.saturating_sub(1), i) + normal(i, i + 1)).normalize_or(Vec2::Y);
            for side in 0..sides {
                let (sin, cos) = lanes::sin_cos(TAU * side as f32 / sides as f32);
                self.positions.push(Vec3::new(x, radius * cos, radius * sin));
                self.normals.push(Vec3::new(n.x, n.y * cos, n.y * sin));
            }
        }
        self.rings(first, points.len() as u32, sides, false);
    }

    /// Adds a grid that is closed in its columns, whose normals are those of its own faces.
    pub fn ring(&mut self, [columns, rows]: [u32; 2], point: impl Fn(u32, u32) -> Vec3) {
        let at = |i: u32, j: u32| point(i % columns, j.min(rows - 1));
        let first = self.positions.len() as u32;
        for row in 0..rows {
            for column in 0..columns {
                let along = at(column + 1, row) - at(column + columns - 1, row);
                let across = at(column, row + 1) - at(column, row.saturating_sub(1));
                self.positions.push(at(column, row));
                self.normals.push(along.cross(across).normalize_or(Vec3::X));
            }
        }
        self.rings(first, rows, columns, true);
    }

    /// Triangles between rings of points that follow each other.
    fn rings(&mut self, first: u32, rings: u32, sides: u32, is_turned: bool) {
        for ring in 1..rings {
            for side in 0..sides {
                let (upper, next) = (first + ring * sides, (side + 1) % sides);
                let (a, b, c, d) = (upper - sides + side, upper - sides + next, upper + side, upper + next);
                let triangles = if is_turned { [[a, b, d], [a, d, c]] } else { [[a, d, b], [a, c, d]] };
                self.triangles.extend(triangles);
            }
        }
    }

    /// Adds another mesh, moved.
    pub fn add(&mut self, other: &Self, point: impl Fn(Vec3) -> Vec3, way: impl Fn(Vec3) -> Vec3) {
        let first = self.positions.len() as u32;
        self.positions.extend(other.positions.iter().map(|p| point(*p)));
        self.normals.extend(other.normals.iter().map(|n| way(*n)));
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|i| first + i)));
    }

    /// Adds a triangle fan without normals.
    pub fn fan(&mut self, points: &[Vec3]) {
        let first = self.positions.len() as u32;
        self.positions.extend(points);
        self.triangles.extend((2..points.len() as u32).map(|i| [first, first + i - 1, first + i]));
    }

    pub fn write(&self, path: &Path) -> io::Result<()> {
        let mut file = BufWriter::new(File::create(path)?);
        let has_normals = self.normals.len() == self.positions.len();
        let has_uvs = self.uvs.len() == self.positions.len();
        write!(file, "ply\nformat binary_little_endian 1.0\nelement vertex {}\n", self.positions.len())?;
        write!(file, "property float x\nproperty float y\nproperty float z\n")?;
        if has_normals {
            write!(file, "property float nx\nproperty float ny\nproperty float nz\n")?;
        }
        if has_uvs {
            write!(file, "property float u\nproperty float v\n")?;
        }
        writeln!(file, "element face {}", self.triangles.len())?;
        write!(file, "property list uchar uint vertex_indices\nend_header\n")?;
        for (i, p) in self.positions.iter().enumerate() {
            let n = has_normals.then(|| self.normals[i].to_array());
            let uv = has_uvs.then(|| self.uvs[i].to_array());
            for v in p.to_array().into_iter().chain(n.into_iter().flatten()).chain(uv.into_iter().flatten()) {
                file.write_all(&v.to_le_bytes())?;
            }
        }
        for triangle in &self.triangles {
            file.write_all(&[3])?;
            for index in triangle {
                file.write_all(&index.to_le_bytes())?;
            }
        }
        file.flush()
    }
}
