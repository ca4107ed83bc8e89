//! Meshes of solids that are given by signed distances.
//!
//! Space is cut into cells. A cell whose corners are on both sides of the surface has one vertex,
//! and an edge whose ends are has a quadrilateral between the vertices of the four cells around it
//! [Gibson 1998]. Vertices are then moved along the gradient onto the surface. Blocks of cells
//! that are farther from the surface than their extent are skipped.

use std::collections::HashMap;
use std::thread;

use math::Vec3;

use super::sculpture::Sculpture;
use crate::mesh::Mesh;

/// Cells of a block along an edge.
const BLOCK: i32 = 16;
/// Columns of blocks are made by that many threads.
const THREADS: usize = 4;

/// The surface within a box, with cells of a size.
pub fn mesh(solid: &Sculpture, [low, high]: [Vec3; 2], size: f32) -> Mesh {
    let extent = ((high - low) / (size * BLOCK as f32)).to_array().map(|n| n.ceil() as i32);
    let columns: Vec<[i32; 2]> = (0..extent[0]).flat_map(|x| (0..extent[1]).map(move |y| [x, y])).collect();
    // Parts are put together in the order of the columns, whatever the number of threads.
    let mut parts: Vec<Part> = Vec::new();
    thread::scope(|scope| {
        let share = columns.len().div_ceil(THREADS).max(1);
        let work = |columns: &[[i32; 2]]| {
            let mut part = Part::default();
            for &[x, y] in columns {
                (0..extent[2]).for_each(|z| part.block(solid, low, size, [x, y, z]));
            }
            part
        };
        let handles: Vec<_> =
            columns.chunks(share).map(|columns| scope.spawn(move || work(columns))).collect();
        parts.extend(handles.into_iter().filter_map(|handle| handle.join().ok()));
    });
    let (mut mesh, mut numbers) = (Mesh::default(), HashMap::new());
    for part in &parts {
        for (cell, position, normal) in &part.vertices {
            numbers.insert(*cell, mesh.positions.len() as u32);
            mesh.positions.push(*position);
            mesh.normals.push(*normal);
        }
    }
    for quad in parts.iter().flat_map(|part| &part.quads) {
        // Where the box cuts the surface, there are no cells beyond.
        let corners = quad.map(|cell| numbers.get(&cell).copied());
        if let [Some(a), Some(b), Some(c), Some(d)] = corners {
            mesh.triangles.extend(split(&mesh.positions, [a, b, c, d]));
        }
    }
    mesh
}

/// Two triangles of a quadrilateral, by its shorter diagonal.
fn split(positions: &[Vec3], [a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
    let length = |i: u32, j: u32| positions[i as usize].distance(positions[j as usize]);
    if length(a, c) <= length(b, d) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
}

/// What a thread makes.
#[derive(Default)]
struct Part {
    vertices: Vec<([i32; 3], Vec3, Vec3)>,
    /// Cells around edges, counter-clockwise as seen from outside.
    quads: Vec<[[i32; 3]; 4]>,
}

impl Part {
    fn block(&mut self, solid: &Sculpture, low: Vec3, size: f32, block: [i32; 3]) {
        let first = block.map(|b| b * BLOCK);
        let at = |cell: [i32; 3]| {
            let [x, y, z] = cell.map(|i| i as f32 * size);
            low + Vec3::new(x, y, z)
        };
        let half = 0.5 * size * BLOCK as f32;
        // Distances of blends may be a little too large.
        if solid.distance(at(first) + Vec3::splat(half)).abs() > 2.6 * half {
            return;
        }
        let count = BLOCK as usize + 1;
        let index = |[x, y, z]: [usize; 3]| (z * count + y) * count + x;
        let mut distances = Vec::with_capacity(count * count * count);
        for z in 0..=BLOCK {
            for y in 0..=BLOCK {
                for x in 0..=BLOCK {
                    distances.push(solid.distance(at([first[0] + x, first[1] + y, first[2] + z])));
                }
            }
        }
        for i in 0..BLOCK.pow(3) as usize {
            let n = BLOCK as usize;
            let local = [i % n, i / n % n, i / (n * n)];
            let cell = [0, 1, 2].map(|k| first[k] + local[k] as i32);
            let corner = |k: usize| {
                let offset = [k & 1, k >> 1 & 1, k >> 2];
                (distances[index([0, 1, 2].map(|a| local[a] + offset[a]))], offset)
            };
            let inside = (0..8).filter(|&k| corner(k).0 < 0.0).count();
            if inside == 0 || inside == 8 {
                continue;
            }
            let (mut sum, mut crossings) = (Vec3::ZERO, 0.0);
            for k in 0..8 {
                for axis in 0..3 {
                    let other = k | 1 << axis;
                    let ((a, offset), (b, _)) = (corner(k), corner(other));
                    if other != k && (a < 0.0) != (b < 0.0) {
                        let mut p = offset.map(|o| o as f32);
                        p[axis] = a / (a - b);
                        sum += Vec3::from_array(p);
                        crossings += 1.0;
                    }
                }
            }
            let start = at(cell) + sum * (size / crossings);
            let (p, normal) = onto(solid, start, size);
            self.vertices.push((cell, p, normal));
            self.edges(cell, [corner(0).0, corner(1).0, corner(2).0, corner(4).0]);
        }
    }

    /// Quadrilaterals about the edges that leave the lowest corner of a cell.
    fn edges(&mut self, cell: [i32; 3], [here, x, y, z]: [f32; 4]) {
        for (axis, there) in [x, y, z].into_iter().enumerate() {
            if (here < 0.0) == (there < 0.0) {
                continue;
            }
            let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
            let around = [[0, 0], [-1, 0], [-1, -1], [0, -1]].map(|[a, b]| {
                let mut other = cell;
                other[u] += a;
                other[v] += b;
                other
            });
            let [a, b, c, d] = around;
            self.quads.push(if here < 0.0 { [a, b, c, d] } else { [d, c, b, a] });
        }
    }
}

/// The point of the surface near to one, at most a distance away, with its normal.
fn onto(solid: &Sculpture, start: Vec3, far: f32) -> (Vec3, Vec3) {
    let mut p = start;
    for _ in 0..3 {
        let next = p - solid.normal(p) * solid.distance(p).clamp(-0.5 * far, 0.5 * far);
        if next.distance(start) > far {
            break;
        }
        p = next;
    }
    (p, solid.normal(p))
}

/// The same for a point that is nearly on the surface.
pub fn near(solid: &Sculpture, p: Vec3, far: f32) -> (Vec3, Vec3) {
    let normal = solid.normal(p);
    (p - normal * solid.distance(p).clamp(-far, far), normal)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_are_on_the_skin_and_triangles_face_outwards() {
        let solid = Sculpture::new();
        let all = [Vec3::new(-120.0, -120.0, -140.0), Vec3::new(120.0, 125.0, 130.0)];
        let mesh = mesh(&solid, all, 5.0);
        assert!(mesh.positions.len() > 5000, "{}", mesh.positions.len());
        let far = mesh.positions.iter().filter(|p| solid.distance(**p).abs() > 0.05).count();
        assert!(far * 100 < mesh.positions.len(), "{far}");
        let outwards = |t: &&[u32; 3]| {
            let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
            (b - a).cross(c - a).dot(mesh.normals[t[0] as usize]) > 0.0
        };
        let count = mesh.triangles.iter().filter(outwards).count();
        assert!(count * 100 > mesh.triangles.len() * 97, "{count} of {}", mesh.triangles.len());
    }
}
