//! Subdivision surfaces of polygons [Catmull 1978], with creases [DeRose 1998].
//!
//! A step makes a point for each point, edge and face, and of a face with n corners n
//! quadrilaterals. With the mean F of the points of the faces around a point P, the mean R of the
//! middles of its n edges:
//!
//! - a face's point is the mean of its corners;
//! - an edge's point is the mean of its ends and of the points of its two faces;
//! - a point becomes (F + 2R + (n − 3) P)/n.
//!
//! A sharp edge has its middle instead, a point of two sharp edges (A + 6P + B)/8 with their other
//! ends, and a point of more stays where it is. An edge is sharp for as many steps as its sharpness
//! says, the last part of a step in proportion; those of one face always are.

use std::collections::HashMap;

use math::{DVec3, Vec3};

use super::primvar::{Interpolation, Primvar};
use super::topology::{Faces, Values};

/// Most steps, and most faces of the result.
const STEPS: u32 = 3;
const FACES: usize = 1 << 20;
/// Sharpness that does not end.
const SHARP: f64 = 10.0;

/// Where a surface is sharp.
#[derive(Clone, Debug, Default)]
pub(super) struct Creases {
    /// Of edges by their two points, the lesser first.
    pub edges: HashMap<[u32; 2], f64>,
    pub corners: HashMap<u32, f64>,
    /// Whether points of one face are round.
    pub has_round_corners: bool,
}

/// A surface while it is subdivided.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    pub faces: Faces,
    /// The points, at one or two times.
    pub points: Vec<Vec<[f64; 3]>>,
    pub values: Values,
    pub creases: Creases,
}

/// The sources of a point with their weights.
type Stencil = Vec<(u32, f64)>;

struct Edge {
    ends: [u32; 2],
    faces: Vec<u32>,
    sharpness: f64,
}

/// An edge by its points, the lesser first.
pub(super) fn edge_key(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

impl Surface {
    /// The surface after so many steps that it looks smooth, with normals.
    pub fn smooth(mut self) -> Self {
        for _ in 0..STEPS {
            if self.faces.points.len() > FACES {
                break;
            }
            self.refine();
        }
        let normals = self.points.first().map(|points| normals(&self.faces, points)).unwrap_or_default();
        self.values.normals = Some(Primvar { interpolation: Interpolation::Vertex, values: normals });
        self
    }

    /// One step.
    fn refine(&mut self) {
        let count = self.points.first().map_or(0, Vec::len);
        let (edges, around) = self.edges(count);
        let face_stencils: Vec<Stencil> = self.faces.iter().map(|(_, corners)| mean(corners)).collect();
        let mut smooth: Vec<Stencil> =
            (0..count as u32).map(|point| self.point(point, &around, &edges, &face_stencils)).collect();
        let mut linear: Vec<Stencil> = (0..count as u32).map(|point| vec![(point, 1.0)]).collect();
        for edge in &edges {
            let middle = mean(&edge.ends);
            let mut stencil = middle.clone();
            if edge.sharpness < 1.0 {
                let mut round = scaled(&middle, 0.5);
                for &face in &edge.faces {
                    round.extend(scaled(&face_stencils[face as usize], 0.25));
                }
                stencil = blend(&round, &middle, edge.sharpness);
            }
            smooth.push(stencil);
            linear.push(middle);
        }
        smooth.extend(face_stencils.iter().cloned());
        linear.extend(face_stencils);
        for points in &mut self.points {
            *points = applied(&smooth, points);
        }
        refine_values(&mut self.values.uvs, &self.faces, [&smooth, &linear]);
        refine_values(&mut self.values.colors, &self.faces, [&smooth, &linear]);
        self.divide(count as u32, &edges);
    }

    /// All edges in the order of the faces, and those around each point.
    fn edges(&self, count: usize) -> (Vec<Edge>, Vec<Vec<u32>>) {
        let mut known: HashMap<[u32; 2], u32> = HashMap::new();
        let (mut edges, mut around): (Vec<Edge>, _) = (Vec::new(), vec![Vec::new(); count]);
        for (face, (_, corners)) in self.faces.iter().enumerate() {
            for (index, &a) in corners.iter().enumerate() {
                let b = corners[(index + 1) % corners.len()];
                let key = edge_key(a, b);
                let edge = *known.entry(key).or_insert_with(|| {
                    let sharpness = self.creases.edges.get(&key).copied().unwrap_or(0.0);
                    around[a as usize].push(edges.len() as u32);
                    if a != b {
                        around[b as usize].push(edges.len() as u32);
                    }
                    edges.push(Edge { ends: key, faces: Vec::new(), sharpness });
                    edges.len() as u32 - 1
                });
                edges[edge as usize].faces.push(face as u32);
            }
        }
        for edge in &mut edges {
            if edge.faces.len() != 2 {
                edge.sharpness = SHARP;
            }
        }
        (edges, around)
    }

    /// What becomes of a point.
    fn point(&self, point: u32, around: &[Vec<u32>], edges: &[Edge], faces: &[Stencil]) -> Stencil {
        let around = &around[point as usize];
        let stays = vec![(point, 1.0)];
        let n = around.len() as f64;
        if around.is_empty() {
            return stays;
        }
        let other = |edge: &Edge| if edge.ends[0] == point { edge.ends[1] } else { edge.ends[0] };
        let around: Vec<&Edge> = around.iter().map(|&edge| &edges[edge as usize]).collect();
        let mut touching: Vec<u32> = around.iter().flat_map(|edge| edge.faces.iter().copied()).collect();
        touching.sort_unstable();
        touching.dedup();
        let mut round = vec![(point, (n - 3.0) / n)];
        for edge in &around {
            round.extend(scaled(&mean(&edge.ends), 2.0 / (n * n)));
        }
        for &face in &touching {
            round.extend(scaled(&faces[face as usize], 1.0 / (n * touching.len() as f64)));
        }
        let sharp: Vec<&&Edge> = around.iter().filter(|edge| edge.sharpness > 0.0).collect();
        let corner = self.creases.corners.get(&point).copied().unwrap_or(0.0);
        let is_end = touching.len() == 1 && !self.creases.has_round_corners;
        let (special, sharpness) = match sharp.as_slice() {
            _ if is_end => (stays, SHARP),
            _ if corner > 0.0 => (stays, corner),
            [a, b] => {
                let crease = vec![(point, 0.75), (other(a), 0.125), (other(b), 0.125)];
                (crease, (a.sharpness + b.sharpness) / 2.0)
            }
            [] | [_] => return round,
            all => (stays, all.iter().map(|edge| edge.sharpness).sum::<f64>() / all.len() as f64),
        };
        blend(&round, &special, sharpness)
    }

    /// Divides faces at the points of their edges and their own.
    fn divide(&mut self, count: u32, edges: &[Edge]) {
        let numbers: HashMap<[u32; 2], u32> = edges.iter().map(|edge| edge.ends).zip(count..).collect();
        let first_face = count + edges.len() as u32;
        let mut divided = Faces::default();
        for (face, (_, corners)) in self.faces.iter().enumerate() {
            for (index, &point) in corners.iter().enumerate() {
                let before = corners[(index + corners.len() - 1) % corners.len()];
                let after = corners[(index + 1) % corners.len()];
                let edge = |a: u32, b: u32| numbers[&edge_key(a, b)];
                divided.counts.push(4);
                let middle = first_face + face as u32;
                divided.points.extend([point, edge(point, after), middle, edge(before, point)]);
                divided.origins.push(self.faces.origins[face]);
            }
        }
        let mut creases = HashMap::new();
        for edge in edges {
            // Those at the edge of the surface are found again.
            if edge.sharpness > 1.0 && edge.faces.len() == 2 {
                let rest = if edge.sharpness >= SHARP { SHARP } else { edge.sharpness - 1.0 };
                for end in edge.ends {
                    creases.insert(edge_key(end, numbers[&edge.ends]), rest);
                }
            }
        }
        let corners = self.creases.corners.iter().filter(|(_, sharpness)| **sharpness > 1.0);
        let rest = |sharpness: f64| if sharpness >= SHARP { SHARP } else { sharpness - 1.0 };
        self.creases.corners = corners.map(|(&point, &sharpness)| (point, rest(sharpness))).collect();
        self.creases.edges = creases;
        self.faces = divided;
    }
}

fn mean(points: &[u32]) -> Stencil {
    let weight = 1.0 / points.len() as f64;
    points.iter().map(|&point| (point, weight)).collect()
}

fn scaled(stencil: &[(u32, f64)], factor: f64) -> Stencil {
    stencil.iter().map(|&(source, weight)| (source, weight * factor)).collect()
}

/// The second for a sharpness of one or more.
fn blend(round: &[(u32, f64)], sharp: &[(u32, f64)], sharpness: f64) -> Stencil {
    let share = sharpness.clamp(0.0, 1.0);
    let mut sum = if share < 1.0 { scaled(round, 1.0 - share) } else { Vec::new() };
    if share > 0.0 {
        sum.extend(scaled(sharp, share));
    }
    sum
}

fn applied<const N: usize>(stencils: &[Stencil], values: &[[f64; N]]) -> Vec<[f64; N]> {
    let apply = |stencil: &Stencil| {
        let mut sum = [0.0; N];
        for &(source, weight) in stencil {
            for (sum, value) in sum.iter_mut().zip(values[source as usize]) {
                *sum += weight * value;
            }
        }
        sum
    };
    stencils.iter().map(apply).collect()
}

/// Values after a step: smooth for points, linear where they are varying or of corners.
fn refine_values<const N: usize>(
    values: &mut Option<Primvar<N>>,
    faces: &Faces,
    [smooth, linear]: [&[Stencil]; 2],
) {
    let Some(primvar) = values else { return };
    primvar.values = match primvar.interpolation {
        Interpolation::Constant => return,
        Interpolation::Vertex => applied(smooth, &primvar.values),
        Interpolation::Varying => applied(linear, &primvar.values),
        Interpolation::Uniform => {
            let of_face = |(face, (_, corners)): (usize, (usize, &[u32]))| {
                std::iter::repeat_n(primvar.values[face], corners.len())
            };
            faces.iter().enumerate().flat_map(of_face).collect()
        }
        Interpolation::FaceVarying => {
            let mut refined = Vec::with_capacity(4 * primvar.values.len());
            for (first, corners) in faces.iter() {
                let n = corners.len();
                let corner = |index: usize| primvar.values[first + index % n];
                let mix = |a: [f64; N], b: [f64; N]| std::array::from_fn(|i| (a[i] + b[i]) / 2.0);
                let sum = |i: usize| (0..n).map(|index| corner(index)[i]).sum::<f64>();
                let middle = std::array::from_fn(|i| sum(i) / n as f64);
                for index in 0..n {
                    let (here, next, last) = (corner(index), corner(index + 1), corner(index + n - 1));
                    refined.extend([here, mix(here, next), middle, mix(last, here)]);
                }
            }
            refined
        }
    };
}

/// Normals at points: means of those of the faces around, by area.
fn normals(faces: &Faces, points: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let mut sums = vec![DVec3::ZERO; points.len()];
    for (_, corners) in faces.iter() {
        let at = |index: usize| DVec3::from(points[corners[index % corners.len()] as usize]);
        let normal: DVec3 =
            (1..corners.len().max(2) - 1).map(|i| (at(i) - at(0)).cross(at(i + 1) - at(0))).sum();
        for &corner in corners {
            sums[corner as usize] += normal;
        }
    }
    sums.into_iter().map(|sum| sum.normalize_or_zero().to_array()).collect()
}

/// Points as single floats.
pub(super) fn positions(points: &[[f64; 3]]) -> Vec<Vec3> {
    points.iter().map(|point| Vec3::from(DVec3::from(*point).as_vec3())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube() -> Surface {
        let points = (0..8).map(|i| [0, 1, 2].map(|axis| f64::from(i >> axis & 1) * 2.0 - 1.0)).collect();
        let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let faces = Faces { counts: vec![4; 6], points: quads.concat(), origins: (0..6).collect() };
        Surface { faces, points: vec![points], values: Values::default(), creases: Creases::default() }
    }

    #[test]
    fn a_cube_becomes_round() {
        let mut surface = cube();
        surface.refine();
        assert_eq!(surface.faces.len(), 24);
        assert_eq!(surface.points[0].len(), 8 + 12 + 6);
        // A corner has n = 3: (F + 2R)/3 with F = −1/3 and R = −2/3 of it.
        let corner = surface.points[0][0];
        for v in corner {
            assert!((v + (1.0 / 3.0 + 4.0 / 3.0) / 3.0).abs() < 1e-12, "{corner:?}");
        }
        // The point of an edge: the mean of (−1 −1 0) and (−½ −½ 0), where faces have their middles
        // at (−1 0 0) and (0 −1 0).
        let lengths: Vec<_> =
            surface.points[0][8..20].iter().map(|&point| DVec3::from(point).length()).collect();
        assert!(lengths.iter().all(|length| (length - 0.75 * 2.0_f64.sqrt()).abs() < 1e-12), "{lengths:?}");
        let smooth = cube().smooth();
        let normals = smooth.values.normals.unwrap();
        for (point, normal) in smooth.points[0].iter().zip(&normals.values) {
            assert!(DVec3::from(*point).normalize().dot(DVec3::from(*normal)) > 0.95);
        }
    }

    #[test]
    fn sharp_edges_stay() {
        let mut surface = cube();
        for (_, corners) in surface.faces.clone().iter() {
            for index in 0..4 {
                surface.creases.edges.insert(edge_key(corners[index], corners[(index + 1) % 4]), SHARP);
            }
        }
        let smooth = surface.smooth();
        assert_eq!(smooth.points[0][0], [-1.0; 3]);
        assert!(smooth.points[0].iter().all(|point| point.iter().any(|v| v.abs() == 1.0)));
        assert!((0..6).all(|face| smooth.faces.origins.iter().filter(|&&of| of == face).count() == 64));
    }

    #[test]
    fn a_sheet_keeps_its_corners_and_values() {
        let faces = Faces { counts: vec![4], points: vec![0, 1, 2, 3], origins: vec![0] };
        let points = vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let values = points.iter().map(|p| [p[0], p[1]]).collect();
        let uvs = Some(Primvar { interpolation: Interpolation::FaceVarying, values });
        let values = Values { uvs, ..Values::default() };
        let mut surface = Surface { faces, points: vec![points], values, creases: Creases::default() };
        surface.refine();
        assert_eq!(surface.points[0][0], [0.0; 3]);
        let uvs = surface.values.uvs.unwrap().values;
        assert_eq!(uvs[..4], [[0.0, 0.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]]);
    }
}
