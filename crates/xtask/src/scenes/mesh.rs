//! Triangle meshes, written as binary PLY.

use std::f32::consts::TAU;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use math::{Frame, Vec3};

/// A mesh of triangles, with a normal at each vertex or none at all.
#[derive(Default)]
pub struct Mesh {
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
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
        for ring in 1..points.len() as u32 {
            for side in 0..sides {
                let (upper, next) = (first + ring * sides, (side + 1) % sides);
                let (a, b, c, d) = (upper - sides + side, upper - sides + next, upper + side, upper + next);
                self.triangles.extend([[a, b, d], [a, d, c]]);
            }
        }
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
        write!(file, "ply\nformat binary_little_endian 1.0\nelement vertex {}\n", self.positions.len())?;
        write!(file, "property float x\nproperty float y\nproperty float z\n")?;
        if has_normals {
            write!(file, "property float nx\nproperty float ny\nproperty float nz\n")?;
        }
        writeln!(file, "element face {}", self.triangles.len())?;
        write!(file, "property list uchar uint vertex_indices\nend_header\n")?;
        for (i, p) in self.positions.iter().enumerate() {
            let n = has_normals.then(|| self.normals[i].to_array());
            for v in p.to_array().into_iter().chain(n.into_iter().flatten()) {
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
