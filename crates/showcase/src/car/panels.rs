//! A body that was subdivided as one smooth surface is cut into panels, so that reflections run on
//! across the gaps between them.
//!
//! The border of a panel draws back by half of the gap, and with it, less and less, what is near to
//! it. There the sheet is bent inwards: a quarter of a small circle, then a flange.

use std::collections::HashMap;
use std::f32::consts::FRAC_PI_2;

use math::{Vec2, Vec3};

use super::body::{Grid, Panel, Tag};
use super::paint::SCALE;
use crate::cage::{Cage, edge};
use crate::mesh::Mesh;

/// How a panel ends, in metres.
#[derive(Clone, Copy)]
pub struct Edge {
    /// Half of the gap.
    pub gap: f32,
    /// The radius of the bend.
    pub bend: f32,
    /// The depth of the flange.
    pub flange: f32,
    /// How far the panel lies under the surface.
    pub depth: f32,
}

/// The body after subdivision.
pub struct Surface {
    pub cage: Cage<Tag>,
    pub normals: Vec<Vec3>,
}

impl Surface {
    pub fn new(cage: Cage<Tag>) -> Self {
        let normals = cage.normals();
        Self { cage, normals }
    }

    /// The faces of some panels.
    fn faces(&self, is_chosen: impl Fn(Panel) -> bool) -> Vec<usize> {
        (0..self.cage.faces.len()).filter(|&face| is_chosen(self.cage.tags[face].0)).collect()
    }

    /// The panels for which `is_chosen` holds as one sheet of metal.
    pub fn panel(&self, is_chosen: impl Fn(Panel) -> bool, end: Edge) -> Mesh {
        let faces = self.faces(is_chosen);
        let rim = Rim::new(&self.cage, &self.normals, &faces);
        let shifts = rim.shifts(&self.cage, &faces, end.gap + end.bend);
        let mut mesh = Mesh::default();
        let mut known: HashMap<(u32, Grid), u32> = HashMap::new();
        let place = |point: u32| {
            let shift = shifts.get(&point).copied().unwrap_or(Vec3::ZERO);
            self.cage.points[point as usize] + shift - self.normals[point as usize] * end.depth
        };
        for &face in &faces {
            let grid = self.cage.tags[face].1;
            let [a, b, c, d] = self.cage.faces[face].map(|point| {
                *known.entry((point, grid)).or_insert_with(|| {
                    let p = place(point);
                    vertex(&mut mesh, p, self.normals[point as usize], grid)
                })
            });
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
        // The bend and the flange, in rows of the border's points.
        let bends = if end.bend > 0.0 { 3 } else { 0 };
        let mut rows: HashMap<(u32, Grid), Vec<u32>> = HashMap::new();
        for &(a, b, grid) in &rim.edges {
            let [a, b] = [a, b].map(|point| {
                let row = rows.entry((point, grid)).or_insert_with(|| {
                    let n = self.normals[point as usize];
                    let out = -rim.inward[&point];
                    let out = (out - n * out.dot(n)).normalize_or(Vec3::X);
                    let centre = place(point) - n * end.bend;
                    let mut row: Vec<u32> = (0..=bends)
                        .map(|i| {
                            let turn = FRAC_PI_2 * i as f32 / bends.max(1) as f32;
                            let (sin, cos) = lanes::sin_cos(if bends > 0 { turn } else { FRAC_PI_2 });
                            let way = n * cos + out * sin;
                            let p = if bends > 0 { centre + way * end.bend } else { place(point) };
                            vertex(&mut mesh, p, way, grid)
                        })
                        .collect();
                    let last = mesh.positions[row[bends] as usize];
                    row.push(vertex(&mut mesh, last - n * end.flange, out, grid));
                    row
                });
                row.clone()
            });
            for i in 1..a.len() {
                mesh.triangles.extend([[a[i - 1], a[i], b[i]], [a[i - 1], b[i], b[i - 1]]]);
            }
        }
        mesh
    }

    /// The panels as a bare sheet at a depth under the surface.
    pub fn sheet(&self, is_chosen: impl Fn(Panel) -> bool, depth: f32) -> Mesh {
        self.panel(is_chosen, Edge { gap: 0.0, bend: 0.0, flange: 0.0, depth })
    }

    /// Where a ray along an axis (0: x, 1: y, 2: z) from outside meets some panels: the outermost
    /// point on the side of a `sign`, and its normal. `at` has the other two coordinates in order.
    pub fn project(
        &self,
        is_chosen: impl Fn(Panel) -> bool,
        axis: usize,
        sign: f32,
        at: Vec2,
    ) -> Option<[Vec3; 2]> {
        let [u, v] = [[1, 2], [0, 2], [0, 1]][axis];
        let flat = |p: Vec3| Vec2::new(p[u], p[v]) - at;
        let mut best: Option<[Vec3; 2]> = None;
        for face in self.faces(is_chosen) {
            let corners = self.cage.faces[face];
            for [a, b, c] in [[0, 1, 2], [0, 2, 3]].map(|t| t.map(|i: usize| corners[i] as usize)) {
                let [p, q, r] = [a, b, c].map(|i| flat(self.cage.points[i]));
                let weights = [q.perp_dot(r), r.perp_dot(p), p.perp_dot(q)];
                let sum: f32 = weights.iter().sum();
                if sum == 0.0 || weights.iter().any(|w| w * sum < 0.0) {
                    continue;
                }
                let mix = |values: &[Vec3]| {
                    (values[a] * weights[0] + values[b] * weights[1] + values[c] * weights[2]) / sum
                };
                let point = mix(&self.cage.points);
                if best.is_none_or(|[other, _]| (point[axis] - other[axis]) * sign > 0.0) {
                    best = Some([point, mix(&self.normals).normalize_or(Vec3::Z)]);
                }
            }
        }
        best
    }
}

/// Texture coordinates are lengths as seen from where a grid looks.
fn vertex(mesh: &mut Mesh, p: Vec3, n: Vec3, grid: Grid) -> u32 {
    mesh.positions.push(p);
    mesh.normals.push(n);
    let flat = match grid {
        Grid::Top => Vec2::new(p.x, p.y),
        Grid::Side => Vec2::new(p.y, p.z),
        Grid::End => Vec2::new(p.x, p.z),
    };
    mesh.uvs.push(flat * SCALE);
    mesh.positions.len() as u32 - 1
}

/// The border of some faces.
struct Rim {
    /// Edges with the faces on their left.
    edges: Vec<(u32, u32, Grid)>,
    /// The way from a point of the border into the panel, along the surface; longer at corners, so
    /// that both edges there move equally far.
    inward: HashMap<u32, Vec3>,
}

impl Rim {
    fn new(cage: &Cage<Tag>, normals: &[Vec3], faces: &[usize]) -> Self {
        let mut count: HashMap<[u32; 2], u32> = HashMap::new();
        let sides = |face: usize| {
            let corners = cage.faces[face];
            [0, 1, 2, 3].map(|i| (corners[i], corners[(i + 1) % 4]))
        };
        for &face in faces {
            for (a, b) in sides(face) {
                *count.entry(edge(a, b)).or_insert(0) += 1;
            }
        }
        let mut edges = Vec::new();
        let mut ways: HashMap<u32, Vec<Vec3>> = HashMap::new();
        for &face in faces {
            for (a, b) in sides(face).into_iter().filter(|&(a, b)| count[&edge(a, b)] == 1) {
                edges.push((a, b, cage.tags[face].1));
                let along = cage.points[b as usize] - cage.points[a as usize];
                for end in [a, b] {
                    let way = normals[end as usize].cross(along).normalize_or_zero();
                    ways.entry(end).or_default().push(way);
                }
            }
        }
        let inward = |(point, ways): (u32, Vec<Vec3>)| {
            let mean = ways.iter().fold(Vec3::ZERO, |sum, way| sum + *way).normalize_or_zero();
            let cosine = ways.iter().map(|way| way.dot(mean)).fold(1.0, f32::min);
            (point, mean / cosine.max(0.5))
        };
        Self { edges, inward: ways.into_iter().map(inward).collect() }
    }

    /// How far points move where the border moves by an inset: points at the distance d from it by
    /// inset (1 − d/D) for D = 4 inset, so that no face is turned over.
    fn shifts(&self, cage: &Cage<Tag>, faces: &[usize], inset: f32) -> HashMap<u32, Vec3> {
        let reach = 4.0 * inset;
        let mut neighbours: HashMap<u32, Vec<u32>> = HashMap::new();
        for &face in faces {
            let corners = cage.faces[face];
            for i in 0..4 {
                neighbours.entry(corners[i]).or_default().push(corners[(i + 1) % 4]);
                neighbours.entry(corners[i]).or_default().push(corners[(i + 3) % 4]);
            }
        }
        // The nearest point of the border for each point near to it.
        let mut nearest: HashMap<u32, (u32, f32)> = HashMap::new();
        let mut front: Vec<u32> = self.inward.keys().copied().collect();
        front.sort_unstable();
        nearest.extend(front.iter().map(|&point| (point, (point, 0.0))));
        while !front.is_empty() {
            let mut next = Vec::new();
            for point in front {
                let source = nearest[&point].0;
                for &other in neighbours.get(&point).into_iter().flatten() {
                    let step = cage.points[other as usize] - cage.points[source as usize];
                    let way = self.inward[&source].normalize_or_zero();
                    // The distance from the border, if the source is nearest.
                    let (reached, distance) = (step.length(), step.dot(way).max(0.0));
                    let known = nearest.get(&other).map(|&(source, _)| {
                        (cage.points[other as usize] - cage.points[source as usize]).length()
                    });
                    if distance < reach
                        && reached < 2.0 * reach + 0.02
                        && known.is_none_or(|known| reached < known)
                    {
                        nearest.insert(other, (source, distance));
                        next.push(other);
                    }
                }
            }
            front = next;
        }
        let shift = |(point, (source, distance)): (u32, (u32, f32))| {
            (point, self.inward[&source] * (inset * (1.0 - distance / reach).max(0.0)))
        };
        nearest.into_iter().map(shift).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::car::body;

    const END: Edge = Edge { gap: 0.002, bend: 0.002, flange: 0.01, depth: 0.0 };

    fn surface() -> Surface {
        Surface::new(body::cage().subdivided(3))
    }

    fn triangles(mesh: &Mesh) -> impl Iterator<Item = [Vec3; 3]> {
        mesh.triangles.iter().map(|t| t.map(|i| mesh.positions[i as usize]))
    }

    #[test]
    fn a_gap_is_as_wide_as_both_its_halves() {
        let surface = surface();
        let door = surface.panel(|p| p == Panel::Door, END);
        let wing = surface.panel(|p| p == Panel::Wing, END);
        // The gap at the height of the handle, in front of the left door.
        let is_near = |p: &&Vec3| p.x > 0.0 && (p.z - 0.6).abs() < 0.2 && (p.y - 0.65).abs() < 0.1;
        let near: Vec<&Vec3> = wing.positions.iter().filter(is_near).collect();
        let distance = |p: &Vec3| near.iter().map(|q| p.distance(**q)).fold(9.0, f32::min);
        let gap = door.positions.iter().filter(is_near).map(distance).fold(9.0, f32::min);
        assert!((gap - 2.0 * END.gap).abs() < 0.1 * END.gap, "{gap}");
    }

    #[test]
    fn no_face_of_a_panel_is_turned_over() {
        let surface = surface();
        for panel in body::PANELS {
            let mesh = surface.panel(|p| p == panel, END);
            let turned = mesh.triangles.iter().zip(triangles(&mesh)).filter(|(t, [a, b, c])| {
                let n = t.iter().fold(Vec3::ZERO, |sum, &i| sum + mesh.normals[i as usize]);
                (*b - *a).cross(*c - *a).dot(n) < 0.0
            });
            assert_eq!(turned.count(), 0, "{panel:?}");
            assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-4));
            assert_eq!(mesh.uvs.len(), mesh.positions.len());
        }
    }

    #[test]
    fn a_sheet_has_the_faces_of_its_panels() {
        let surface = surface();
        let sheet = surface.sheet(|_| true, 0.02);
        assert!(sheet.triangles.len() >= 2 * surface.cage.faces.len());
        let [p, n] = surface.project(|p| p == Panel::Roof, 2, 1.0, Vec2::new(0.1, -0.3)).unwrap();
        assert!(p.z > 1.2 && p.z < 1.3 && n.z > 0.95 && (p.x - 0.1).abs() < 1e-4, "{p} {n}");
        assert!(surface.project(|p| p == Panel::Roof, 2, 1.0, Vec2::new(0.1, 1.5)).is_none());
    }
}
