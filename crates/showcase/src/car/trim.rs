//! Strips of chrome along the borders of panels.

use std::collections::HashMap;

use math::Vec3;

use super::body::Panel;
use super::panels::Surface;
use crate::cage::edge;
use crate::mesh::Mesh;

/// Tubes of a radius around some panels, raised over the surface by a height.
pub fn strips(body: &Surface, is_chosen: impl Fn(Panel) -> bool, radius: f32, height: f32) -> Mesh {
    let mut mesh = Mesh::default();
    for border in borders(body, is_chosen) {
        let at = |point: u32| body.cage.points[point as usize] + body.normals[point as usize] * height;
        let mut points: Vec<(Vec3, f32)> = border.iter().map(|&point| (at(point), radius)).collect();
        // The tube ends where it began, a little inside of itself.
        points.push(points[0]);
        points.push(points[1]);
        mesh.tube(&points, 12);
    }
    mesh
}

/// The closed borders of some panels, in the order of their least points.
fn borders(body: &Surface, is_chosen: impl Fn(Panel) -> bool) -> Vec<Vec<u32>> {
    let mut count: HashMap<[u32; 2], u32> = HashMap::new();
    let chosen = || (0..body.cage.faces.len()).filter(|&face| is_chosen(body.cage.tags[face].0));
    let sides = |face: usize| {
        let corners = body.cage.faces[face];
        [0, 1, 2, 3].map(|i| (corners[i], corners[(i + 1) % 4]))
    };
    for (a, b) in chosen().flat_map(sides) {
        *count.entry(edge(a, b)).or_insert(0) += 1;
    }
    let mut next: HashMap<u32, u32> =
        chosen().flat_map(sides).filter(|&(a, b)| count[&edge(a, b)] == 1).collect();
    let mut starts: Vec<u32> = next.keys().copied().collect();
    starts.sort_unstable();
    let mut borders = Vec::new();
    for start in starts {
        let (mut border, mut point) = (Vec::new(), start);
        while let Some(after) = next.remove(&point) {
            border.push(point);
            point = after;
        }
        if border.len() > 2 {
            borders.push(border);
        }
    }
    borders
}
