//! Subdivision surfaces and displaced meshes: invariants, limits, and invalid meshes.

use crate::common::*;
use alhazen_geometry::*;
use math::*;
use sampling::Rng;
use std::collections::HashMap;

const OCTAHEDRON: [[u32; 3]; 8] =
    [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
const CORNERS: [Vec3; 6] = [
    Vec3::X,
    Vec3::Y,
    Vec3::Z,
    Vec3::new(-1.0, 0.0, 0.0),
    Vec3::new(0.0, -1.0, 0.0),
    Vec3::new(0.0, 0.0, -1.0),
];

/// A closed mesh with vertices of valence three to seven: an octahedron with pyramids on some of
/// its faces.
fn closed(rng: &mut Rng) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut positions: Vec<Vec3> = CORNERS.iter().map(|&p| p + point_in(rng, 0.1)).collect();
    let mut indices = OCTAHEDRON[3..].to_vec();
    for &[a, b, c] in &OCTAHEDRON[..3] {
        let top = positions.len() as u32;
        positions.push([a, b, c].iter().map(|&i| CORNERS[i as usize]).sum::<Vec3>() * 0.5);
        indices.extend([[a, b, top], [b, c, top], [c, a, top]]);
    }
    (positions, indices)
}

/// A fan of `n` triangles around the boundary vertex 0; its other vertices have valence two or
/// three.
fn fan(n: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let spoke = |i: u32| {
        let angle = i as f32 / n as f32 * 2.5;
        Vec3::new(angle.cos(), angle.sin(), 0.1 * angle * angle)
    };
    let positions = std::iter::once(Vec3::new(0.0, -0.1, 0.05)).chain((0..=n).map(spoke)).collect();
    (positions, (1..=n).map(|i| [0, i, i + 1]).collect())
}

/// The number of triangles at each edge.
fn edges(indices: &[[u32; 3]]) -> HashMap<[u32; 2], u32> {
    let mut edges = HashMap::new();
    for &[a, b, c] in indices {
        for [i, j] in [[a, b], [b, c], [c, a]] {
            *edges.entry([i.min(j), i.max(j)]).or_default() += 1;
        }
    }
    edges
}

fn area(mesh: &MeshArrays) -> f32 {
    let corners = |t: &[u32; 3]| t.map(|i| mesh.positions[i as usize]);
    mesh.indices.iter().map(corners).map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum()
}

#[test]
fn the_limit_surface_does_not_depend_on_the_levels() {
    let (positions, indices) = closed(&mut Rng::new(1, 0));
    let coarse = loop_subdivision(&positions, &indices, 0).unwrap();
    for levels in 1..5 {
        let fine = loop_subdivision(&positions, &indices, levels).unwrap();
        assert_eq!(fine.indices.len(), indices.len() << (2 * levels));
        assert!(edges(&fine.indices).values().all(|&n| n == 2), "it stays closed");
        for (a, b) in coarse.positions.iter().zip(&fine.positions) {
            assert!(a.distance(*b) < 1e-6, "{levels} levels: {a} and {b}");
        }
    }
}

/// The outside is where triangles are clockwise.
#[test]
fn normals_are_those_of_the_surface() {
    let meshes = (1..8).map(fan).chain([closed(&mut Rng::new(2, 0))]);
    for (positions, indices) in meshes {
        let coarse = loop_subdivision(&positions, &indices, 2).unwrap();
        let fine = loop_subdivision(&positions, &indices, 5).unwrap();
        let mut means = vec![Vec3::ZERO; fine.positions.len()];
        for triangle in &fine.indices {
            let [a, b, c] = triangle.map(|i| fine.positions[i as usize]);
            triangle.iter().for_each(|&i| means[i as usize] -= (b - a).cross(c - a).normalize());
        }
        for (i, n) in coarse.normals.iter().enumerate() {
            let agreement = n.normalize().dot(means[i].normalize());
            assert!(agreement > 0.97, "vertex {i} of {}: {agreement}", positions.len());
        }
        for (i, n) in fine.normals.iter().enumerate() {
            assert!(n.normalize().dot(means[i].normalize()) > 0.97, "vertex {i} of {}", positions.len());
        }
    }
}

#[test]
fn flat_meshes_stay_flat() {
    let grid = |i: u32| Vec3::new((i % 5) as f32, (i / 5) as f32, 0.0);
    let positions: Vec<Vec3> = (0..25).map(grid).collect();
    let cell = |i: u32| [[i, i + 1, i + 6], [i, i + 6, i + 5]];
    let indices: Vec<[u32; 3]> = (0..20).filter(|i| i % 5 != 4).flat_map(cell).collect();
    let fine = loop_subdivision(&positions, &indices, 3).unwrap();
    assert!(fine.positions.iter().all(|p| p.z == 0.0));
    assert!(fine.normals.iter().all(|n| n.z < 0.0 && n.x == 0.0 && n.y == 0.0));
    // Regular interior vertices do not move.
    assert!(fine.positions[12].distance(positions[12]) < 1e-6);
    // The boundary is a curve that does not depend on interior vertices.
    let mut raised = positions.clone();
    for i in [6, 7, 8, 11, 12, 13, 16, 17, 18] {
        raised[i].z = 1.0;
    }
    let raised = loop_subdivision(&raised, &indices, 3).unwrap();
    let border = edges(&raised.indices).into_iter().filter(|(_, n)| *n == 1).flat_map(|(ends, _)| ends);
    let mut met = 0;
    for i in border {
        assert_eq!(raised.positions[i as usize], fine.positions[i as usize]);
        met += 1;
    }
    assert_eq!(met, 2 * 16 * 8);
}

#[test]
fn invalid_meshes_are_errors() {
    let p = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, Vec3::ONE];
    let error = |indices: &[[u32; 3]], levels| loop_subdivision(&p, indices, levels).unwrap_err();
    assert_eq!(error(&[[0, 1, 2], [0, 9, 2]], 1), MeshError::Index { triangle: 1, vertex: 9 });
    assert_eq!(error(&[[4, 3, 3]], 1), MeshError::Edge([3, 3]));
    assert_eq!(error(&[[0, 1, 2], [1, 0, 3], [0, 1, 4]], 1), MeshError::Edge([0, 1]), "three on an edge");
    assert_eq!(error(&[[2, 3, 4], [3, 4, 1]], 1), MeshError::Edge([3, 4]), "opposite orientations");
    assert_eq!(error(&[[0, 1, 4], [2, 3, 4]], 1), MeshError::Vertex(4), "a bow tie");
    for levels in [13, 40, u32::MAX] {
        assert_eq!(error(&[[0, 1, 2]], levels), MeshError::TooLarge);
    }
    assert_eq!(loop_subdivision(&[], &[], 12).unwrap(), MeshArrays::default());
    assert_eq!(loop_subdivision(&p, &[], 3).unwrap().positions.len(), 0, "unused vertices are left out");
    let nan = [Vec3::NAN, Vec3::X, Vec3::INFINITY];
    assert_eq!(loop_subdivision(&nan, &[[0, 1, 2]], 3).unwrap().indices.len(), 64);
    // Two triangles back to back are closed.
    assert_eq!(loop_subdivision(&p, &[[0, 1, 2], [0, 2, 1]], 2).unwrap().indices.len(), 32);
}

fn octahedron() -> MeshArrays {
    MeshArrays {
        positions: CORNERS.to_vec(),
        indices: OCTAHEDRON.to_vec(),
        normals: Vec::new(),
        uvs: CORNERS.iter().map(|p| Vec2::new(p.x, p.y)).collect(),
    }
}

#[test]
fn dicing_leaves_short_edges_and_no_cracks() {
    for (m, edge_length) in [
        (Transform::IDENTITY, 0.31),
        (Transform::scale(Vec3::new(1.0, 3.0, 0.5)), 0.4),
        (Transform::translate(Vec3::splat(100.0)), 2.0),
    ] {
        let fine = displaced(octahedron(), &m, edge_length, |_, _, _| 0.0).unwrap();
        let edges = edges(&fine.indices);
        assert!(edges.values().all(|&n| n == 2), "it stays closed");
        for [a, b] in edges.keys().map(|ends| ends.map(|i| m.point(fine.positions[i as usize]))) {
            assert!(a.distance(b) < edge_length);
        }
        assert!((area(&fine) / area(&octahedron()) - 1.0).abs() < 1e-5);
        for (p, uv) in fine.positions.iter().zip(&fine.uvs) {
            assert!(uv.distance(Vec2::new(p.x, p.y)) < 1e-6);
        }
        assert!(edge_length < 1.0 || fine.indices.len() == OCTAHEDRON.len());
    }
}

#[test]
fn vertices_move_along_their_normals() {
    // From the octahedron to a sphere of radius 2, with the normals of the sphere.
    let mesh = MeshArrays { normals: CORNERS.map(|n| n * 3.0).to_vec(), ..octahedron() };
    let to_sphere = |p: Vec3, n: Vec3, _| {
        assert!((n.length() - 1.0).abs() < 1e-6);
        let b = p.dot(n);
        (b * b + 4.0 - p.length_squared()).sqrt() - b
    };
    let sphere = displaced(mesh, &Transform::IDENTITY, 0.1, to_sphere).unwrap();
    assert!(sphere.indices.len() > 1000);
    for (p, n) in sphere.positions.iter().zip(&sphere.normals) {
        assert!((p.length() - 2.0).abs() < 1e-5 && (n.length() - 1.0).abs() < 1e-5);
        assert!(n.dot(*p) > 1.98, "{n} at {p}");
    }
    // Without normals, those of the triangles are used: all vertices move outwards.
    let grown = displaced(octahedron(), &Transform::IDENTITY, 9.0, |_, _, uv| 0.5 + uv.x).unwrap();
    assert!(grown.positions[0].distance(Vec3::X * 2.5) < 1e-6);
    assert!(grown.positions[3].distance(Vec3::X * -0.5) < 1e-6);
    assert!(grown.positions[5].distance(Vec3::Z * -1.5) < 1e-6);
}

#[test]
fn meshes_that_cannot_be_displaced_are_errors() {
    let result = |mesh, edge_length| displaced(mesh, &Transform::IDENTITY, edge_length, |_, _, _| 0.0);
    let attribute = |attribute, values| MeshError::AttributeLength { attribute, values, vertices: 6 };
    let bare = MeshArrays { uvs: Vec::new(), ..octahedron() };
    assert_eq!(result(bare, 1.0), Err(attribute("texture coordinates", 0)));
    let uneven = MeshArrays { normals: vec![Vec3::X], ..octahedron() };
    assert_eq!(result(uneven, 1.0), Err(attribute("normals", 1)));
    let broken = MeshArrays { indices: vec![[0, 6, 1]], ..octahedron() };
    assert_eq!(result(broken, 1.0), Err(MeshError::Index { triangle: 0, vertex: 6 }));
    for edge_length in [1e-4, 1e-30, 0.0, -1.0] {
        assert_eq!(result(octahedron(), edge_length), Err(MeshError::TooLarge), "{edge_length}");
    }
    let nan = MeshArrays { positions: vec![Vec3::NAN; 6], ..octahedron() };
    assert_eq!(result(nan, 1e-3).unwrap().indices.len(), 8);
    let flat = MeshArrays { positions: vec![Vec3::X; 6], ..octahedron() };
    assert_eq!(result(flat, 1e-3).unwrap().indices.len(), 8);
    let infinite = displaced(octahedron(), &Transform::IDENTITY, 1.0, |_, _, _| f32::INFINITY).unwrap();
    assert!(infinite.positions.iter().all(|p| !p.is_finite()));
}
