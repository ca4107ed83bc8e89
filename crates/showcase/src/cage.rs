//! Control cages: meshes of quadrilaterals that are subdivided until they look smooth
//! [Catmull 1978], with creases [DeRose 1998].
//!
//! A step moves each point with n edges to (F + 2R + (n − 3) P)/n, for the mean F of the middles of
//! its faces and the mean R of the middles of its edges. The point of an edge is the mean of its
//! ends and of the middles of its two faces. Borders and sharp edges are cubic B-splines: their
//! edges have their middles, and their points become (A + 6P + B)/8. A point of more than two sharp
//! edges stays, and so does one of a border with a single face. An edge is sharp for as many steps
//! as its sharpness says, the last part of a step in proportion.

use std::collections::HashMap;

use math::Vec3;

use super::mesh::Mesh;

/// Sharpness that does not end.
pub const SHARP: f32 = 100.0;

/// A mesh of quadrilaterals, counter-clockwise as seen from outside, each with a tag.
#[derive(Clone)]
pub struct Cage<T> {
    pub points: Vec<Vec3>,
    pub faces: Vec<[u32; 4]>,
    pub tags: Vec<T>,
    /// The sharpness of edges by their two points, the lesser first.
    pub creases: HashMap<[u32; 2], f32>,
}

/// An edge by its points, the lesser first.
pub fn edge(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

struct Edge {
    ends: [u32; 2],
    /// The sum of the middles of its faces, and their number.
    middles: Vec3,
    faces: u32,
    sharpness: f32,
}

impl<T> Default for Cage<T> {
    fn default() -> Self {
        Self { points: Vec::new(), faces: Vec::new(), tags: Vec::new(), creases: HashMap::new() }
    }
}

impl<T: Copy> Cage<T> {
    pub fn add(&mut self, point: Vec3) -> u32 {
        self.points.push(point);
        self.points.len() as u32 - 1
    }

    pub fn face(&mut self, corners: [u32; 4], tag: T) {
        self.faces.push(corners);
        self.tags.push(tag);
    }

    pub fn crease(&mut self, a: u32, b: u32, sharpness: f32) {
        self.creases.insert(edge(a, b), sharpness);
    }

    /// Makes all edges of the faces from a number on sharper than they are.
    pub fn sharpen(&mut self, first: usize, sharpness: f32) {
        for i in first..self.faces.len() {
            let face = self.faces[i];
            (0..4).for_each(|k| self.crease(face[k], face[(k + 1) % 4], sharpness));
        }
    }

    /// A block of cells in rows, columns and layers, whose outer faces are the cage; `point` places
    /// its points.
    pub fn block(&mut self, cells: [u32; 3], tag: T, point: impl Fn([u32; 3]) -> Vec3) {
        let mut known: HashMap<[u32; 3], u32> = HashMap::new();
        for axis in 0..3 {
            let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
            for end in [0, cells[axis]] {
                for i in 0..cells[u] {
                    for j in 0..cells[v] {
                        let mut corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(|[a, b]| {
                            let mut at = [0; 3];
                            (at[axis], at[u], at[v]) = (end, a, b);
                            *known.entry(at).or_insert_with(|| {
                                self.points.push(point(at));
                                self.points.len() as u32 - 1
                            })
                        });
                        if end == 0 {
                            corners.reverse();
                        }
                        self.face(corners, tag);
                    }
                }
            }
        }
    }

    /// Adds the other half of what is on one side of the plane x = 0; points on it are of both.
    pub fn mirror(&mut self) {
        let mut twins = Vec::with_capacity(self.points.len());
        for i in 0..self.points.len() {
            let p = self.points[i];
            twins.push(if p.x == 0.0 { i as u32 } else { self.add(Vec3::new(-p.x, p.y, p.z)) });
        }
        for i in 0..self.faces.len() {
            let [a, b, c, d] = self.faces[i].map(|point| twins[point as usize]);
            self.face([d, c, b, a], self.tags[i]);
        }
        let twin = |(&[a, b], &sharpness): (&[u32; 2], &f32)| {
            (edge(twins[a as usize], twins[b as usize]), sharpness)
        };
        let creases: Vec<_> = self.creases.iter().map(twin).collect();
        self.creases.extend(creases);
    }

    /// The cage after so many steps.
    pub fn subdivided(mut self, steps: u32) -> Self {
        for _ in 0..steps {
            self = self.refined();
        }
        self
    }

    /// One step.
    fn refined(&self) -> Self {
        let count = self.points.len();
        let middles: Vec<Vec3> = self.faces.iter().map(|face| self.middle(face)).collect();
        let mut numbers: HashMap<[u32; 2], u32> = HashMap::with_capacity(2 * self.faces.len());
        let mut edges: Vec<Edge> = Vec::with_capacity(2 * self.faces.len());
        let mut face_edges = Vec::with_capacity(self.faces.len());
        for (face, middle) in self.faces.iter().zip(&middles) {
            face_edges.push([0, 1, 2, 3].map(|i| {
                let ends = edge(face[i], face[(i + 1) % 4]);
                let number = *numbers.entry(ends).or_insert_with(|| {
                    let sharpness = self.creases.get(&ends).copied().unwrap_or(0.0);
                    edges.push(Edge { ends, middles: Vec3::ZERO, faces: 0, sharpness });
                    edges.len() as u32 - 1
                });
                let edge = &mut edges[number as usize];
                edge.middles += *middle;
                edge.faces += 1;
                number
            }));
        }
        for edge in &mut edges {
            if edge.faces == 1 {
                edge.sharpness = SHARP;
            }
        }
        let mut points = self.moved(&edges, &middles);
        for edge in &edges {
            let [a, b] = edge.ends.map(|end| self.points[end as usize]);
            let middle = (a + b) * 0.5;
            let round = if edge.faces == 2 { (a + b + edge.middles) * 0.25 } else { middle };
            points.push(round.lerp(middle, edge.sharpness.min(1.0)));
        }
        points.extend(&middles);
        let first_middle = (count + edges.len()) as u32;
        let mut refined = Self { points, ..Self::default() };
        for (i, (face, around)) in self.faces.iter().zip(&face_edges).enumerate() {
            for k in 0..4 {
                let [next, last] = [around[k], around[(k + 3) % 4]].map(|edge| count as u32 + edge);
                refined.face([face[k], next, first_middle + i as u32, last], self.tags[i]);
            }
        }
        for (i, half) in edges.iter().enumerate().filter(|(_, edge)| edge.sharpness > 1.0 && edge.faces == 2)
        {
            for end in half.ends {
                let rest = if half.sharpness >= SHARP { SHARP } else { half.sharpness - 1.0 };
                refined.crease(end, (count + i) as u32, rest);
            }
        }
        refined
    }

    fn middle(&self, face: &[u32; 4]) -> Vec3 {
        face.iter().map(|&i| self.points[i as usize]).fold(Vec3::ZERO, |sum, p| sum + p) * 0.25
    }

    /// Where the points of the cage move in a step.
    fn moved(&self, edges: &[Edge], middles: &[Vec3]) -> Vec<Vec3> {
        #[derive(Clone, Copy, Default)]
        struct Around {
            faces: f32,
            middles: Vec3,
            edges: f32,
            others: Vec3,
            sharp: u32,
            sharpness: f32,
            sharp_others: Vec3,
        }
        let mut around = vec![Around::default(); self.points.len()];
        for (face, middle) in self.faces.iter().zip(middles) {
            for &point in face {
                around[point as usize].faces += 1.0;
                around[point as usize].middles += *middle;
            }
        }
        for edge in edges {
            for [point, other] in [edge.ends, [edge.ends[1], edge.ends[0]]] {
                let (sum, other) = (&mut around[point as usize], self.points[other as usize]);
                sum.edges += 1.0;
                sum.others += other;
                if edge.sharpness > 0.0 {
                    sum.sharp += 1;
                    sum.sharpness += edge.sharpness;
                    sum.sharp_others += other;
                }
            }
        }
        let moved = |(&p, a): (&Vec3, &Around)| {
            let n = a.edges;
            if n == 0.0 {
                return p;
            }
            // R is the mean of (P + other)/2.
            let round = (a.middles / a.faces + a.others / n + p * (n - 2.0)) / n;
            let (special, sharpness) = match a.sharp {
                0 | 1 => return round,
                2 if a.faces == 1.0 => (p, SHARP),
                2 => ((p * 6.0 + a.sharp_others) * 0.125, a.sharpness / 2.0),
                count => (p, a.sharpness / count as f32),
            };
            round.lerp(special, sharpness.min(1.0))
        };
        self.points.iter().zip(&around).map(moved).collect()
    }

    /// The cage as it is, with smooth normals.
    pub fn mesh(&self) -> Mesh {
        let split = |[a, b, c, d]: &[u32; 4]| [[*a, *b, *c], [*a, *c, *d]];
        Mesh {
            positions: self.points.clone(),
            normals: self.normals(),
            uvs: Vec::new(),
            triangles: self.faces.iter().flat_map(split).collect(),
        }
    }

    /// Normals at points: means of those of the faces around, by area.
    pub fn normals(&self) -> Vec<Vec3> {
        let mut sums = vec![Vec3::ZERO; self.points.len()];
        for face in &self.faces {
            let [a, b, c, d] = face.map(|i| self.points[i as usize]);
            let normal = (c - a).cross(d - b);
            for &point in face {
                sums[point as usize] += normal;
            }
        }
        sums.into_iter().map(|sum| sum.normalize_or(Vec3::Z)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube() -> Cage<u8> {
        let mut cage = Cage::default();
        cage.block([1; 3], 7, |at| Vec3::from_array(at.map(|v| 2.0 * v as f32 - 1.0)));
        cage
    }

    #[test]
    fn a_cube_becomes_round() {
        let once = cube().subdivided(1);
        assert_eq!((once.points.len(), once.faces.len()), (26, 24));
        // A corner has n = 3: (F + 2R)/3 with F = 1/3 and R = 2/3 of it.
        assert!((once.points[0].abs() - Vec3::splat(5.0 / 9.0)).length() < 1e-6);
        let smooth = cube().subdivided(4);
        assert!(smooth.points.iter().zip(smooth.normals()).all(|(p, n)| p.normalize().dot(n) > 0.95));
        assert!(smooth.tags.iter().all(|&tag| tag == 7));
    }

    #[test]
    fn sharp_edges_stay() {
        let mut cage = cube();
        cage.sharpen(0, SHARP);
        let smooth = cage.subdivided(3);
        assert!(smooth.points.iter().all(|p| p.abs().max_element() == 1.0));
    }

    #[test]
    fn halves_share_the_points_between_them() {
        let mut half = Cage::default();
        half.block([2, 1, 1], 0_u8, |[x, y, z]| Vec3::new(x as f32, y as f32, z as f32));
        // Without the faces between the halves.
        let inner: Vec<_> = (0..half.faces.len())
            .filter(|&i| half.faces[i].iter().any(|&p| half.points[p as usize].x != 0.0))
            .map(|i| half.faces[i])
            .collect();
        (half.tags, half.faces) = (vec![0; inner.len()], inner);
        half.mirror();
        assert_eq!((half.points.len(), half.faces.len()), (20, 18));
        let smooth = half.subdivided(2);
        let volume: f32 = smooth
            .faces
            .iter()
            .map(|face| {
                let [a, b, c, d] = face.map(|i| smooth.points[i as usize]);
                (a.dot(b.cross(c)) + a.dot(c.cross(d))) / 6.0
            })
            .sum();
        assert!(volume > 1.5 && volume < 4.0, "{volume}");
    }
}
