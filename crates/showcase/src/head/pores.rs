//! Pores and fine lines of the skin as displacement: cellular noise [Worley 1996], on a mesh that
//! is refined where they are.

use std::collections::HashMap;

use math::{Vec3, smooth_step};

use super::nets;
use super::sculpture::Sculpture;
use crate::cage::edge;
use crate::mesh::Mesh;

/// Cuts the triangles of the face into four, so many times, and displaces their points.
pub fn add(mesh: &mut Mesh, solid: &Sculpture, steps: u32) {
    for _ in 0..steps {
        refine(mesh, solid);
    }
    let weights: Vec<f32> = mesh.positions.iter().map(|p| weight(*p)).collect();
    for ((p, normal), weight) in mesh.positions.iter_mut().zip(&mesh.normals).zip(&weights) {
        if *weight > 0.0 {
            *p += *normal * (height(*p) * weight);
        }
    }
    let mut sums = vec![Vec3::ZERO; mesh.positions.len()];
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        let normal = (b - a).cross(c - a);
        t.iter().for_each(|&i| sums[i as usize] += normal);
    }
    for ((normal, sum), weight) in mesh.normals.iter_mut().zip(sums).zip(weights) {
        if weight > 0.0 {
            *normal = normal.lerp(sum.normalize_or(*normal), weight.min(1.0)).normalize_or(*normal);
        }
    }
}

/// How strongly a point is displaced: all over the face, not on the lids.
fn weight(p: Vec3) -> f32 {
    let side = 1.0 - smooth_step(p.x.abs(), 46.0, 60.0);
    let face = smooth_step(p.y, 26.0, 42.0) * smooth_step(p.z, -118.0, -104.0);
    let lids = Vec3::new(p.x.abs() - 31.5, 0.0, 1.3 * p.z).length();
    side * face * (1.0 - smooth_step(p.z, 62.0, 74.0)) * (0.15 + 0.85 * smooth_step(lids, 10.0, 19.0))
}

/// Height of the skin in millimetres over its smooth form.
fn height(p: Vec3) -> f32 {
    let x = p.x.abs();
    let lips = lip(p);
    // Pores are deepest on the nose and beside it.
    let nose = 1.0 - smooth_step(x.hypot(0.6 * (p.z + 34.0)), 14.0, 40.0);
    let [nearest, _] = cells(p * (1.0 / 1.05));
    let pore = 1.0 - smooth_step(nearest, 0.0, 0.34 + 0.08 * nose);
    let [first, second] = cells(p * (1.0 / 0.62) + Vec3::splat(31.0));
    let lines = (second - first).min(0.3) / 0.3 - 1.0;
    let skin = -(0.05 + 0.07 * nose) * pore + 0.022 * lines;
    // Lips have furrows from the inside outwards.
    let [first, second] = cells(Vec3::new(p.x / 1.3, p.y / 9.0, p.z / 9.0) + Vec3::splat(57.0));
    let furrow = 0.16 * ((second - first).min(0.5) / 0.5 - 1.0);
    skin * (1.0 - lips) + furrow * lips
}

/// Whether a point is on the lips, from 0 to 1.
pub fn lip(p: Vec3) -> f32 {
    let x = p.x.abs();
    let t = (x / 25.5).min(1.0);
    // The upper border has a dip in the middle, Cupid's bow.
    let bow = 1.6 * smooth_step(x, 0.0, 5.5) * (1.0 - smooth_step(x, 5.5, 12.0));
    let upper = -73.2 + (8.6 + bow) * (1.0 - t * t) + 0.4;
    let lower = -73.2 - 9.6 * (1.0 - t * t * t * t) * (1.0 - 0.25 * t);
    let inside = (upper - p.z).min(p.z - lower);
    smooth_step(inside, -0.7, 0.9) * smooth_step(p.y, 60.0, 70.0)
}

/// The distances to the two nearest of points of which each unit cube has one.
fn cells(p: Vec3) -> [f32; 2] {
    let base = p.to_array().map(|v| v.floor());
    let mut nearest = [f32::INFINITY; 2];
    for k in 0..27 {
        let cell = [0, 1, 2].map(|a| base[a] + [(k % 3), (k / 3 % 3), (k / 9)][a] as f32 - 1.0);
        let bits = sampling::hash(&cell.map(|c| c as i32 as u32));
        let jitter = [0, 21, 42].map(|shift| (bits >> shift & 0xf_ffff) as f32 / (1 << 20) as f32);
        let distance = p.distance(Vec3::from_array(cell) + Vec3::from_array(jitter));
        if distance < nearest[0] {
            nearest = [distance, nearest[0]];
        } else if distance < nearest[1] {
            nearest[1] = distance;
        }
    }
    nearest
}

/// Cuts the triangles that are displaced into four each.
fn refine(mesh: &mut Mesh, solid: &Sculpture) {
    let weights: Vec<bool> = mesh.positions.iter().map(|p| weight(*p) > 0.0).collect();
    let is_cut = |t: &[u32; 3]| t.iter().all(|&i| weights[i as usize]);
    // The triangles of edges. Between one that is cut and one that is not, the middle stays on the
    // edge.
    let mut uses: HashMap<[u32; 2], (u32, u32)> = HashMap::new();
    for t in mesh.triangles.iter().filter(|t| is_cut(t)) {
        (0..3).for_each(|i| uses.entry(edge(t[i], t[(i + 1) % 3])).or_insert((0, u32::MAX)).0 += 1);
    }
    let mut triangles = Vec::with_capacity(4 * mesh.triangles.len());
    for t in &mesh.triangles {
        if !is_cut(t) {
            triangles.push(*t);
            continue;
        }
        let [ab, bc, ca] = [0, 1, 2].map(|i| {
            let ends = edge(t[i], t[(i + 1) % 3]);
            let (count, middle) = uses.get_mut(&ends).map_or((0, u32::MAX), |(count, middle)| {
                if *middle == u32::MAX {
                    *middle = mesh.positions.len() as u32;
                    return (*count, u32::MAX);
                }
                (*count, *middle)
            });
            if middle != u32::MAX {
                return middle;
            }
            let [a, b] = ends.map(|i| i as usize);
            let centre = (mesh.positions[a] + mesh.positions[b]) * 0.5;
            let normal = (mesh.normals[a] + mesh.normals[b]).normalize_or(Vec3::Y);
            let far = 0.25 * mesh.positions[a].distance(mesh.positions[b]);
            let (p, n) = if count > 1 { nets::near(solid, centre, far) } else { (centre, normal) };
            mesh.positions.push(p);
            mesh.normals.push(n);
            mesh.positions.len() as u32 - 1
        });
        let [a, b, c] = *t;
        triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    mesh.triangles = triangles;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refined_mesh_has_no_gaps() {
        let solid = Sculpture::new();
        let all = [Vec3::new(-120.0, -120.0, -140.0), Vec3::new(120.0, 125.0, 130.0)];
        let mut mesh = nets::mesh(&solid, all, 6.0);
        let before = mesh.triangles.len();
        refine(&mut mesh, &solid);
        assert!(mesh.triangles.len() > before * 5 / 4, "{before}");
        assert!(mesh.triangles.iter().all(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0]));
        // Points that halve edges of larger triangles are in their middles.
        let used: std::collections::HashSet<u32> = mesh.triangles.iter().flatten().copied().collect();
        assert_eq!(used.len(), mesh.positions.len());
    }

    #[test]
    fn pores_are_shallow_pits() {
        let mut heights: Vec<f32> = (0..4000)
            .map(|i| height(Vec3::new(20.0 + 0.013 * i as f32, 80.0, -30.0 + 0.0071 * i as f32)))
            .collect();
        heights.sort_by(f32::total_cmp);
        assert!(heights[0] < -0.03 && heights[0] > -0.2 && heights[3999] <= 0.0, "{heights:?}");
    }
}
