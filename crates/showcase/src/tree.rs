//! Trees: broad-leaved ones by space colonisation, spruces by whorls of branches.
//!
//! Space colonisation fills a crown with points that attract growth. Each point pulls the node of
//! the tree that is nearest to it; a node grows by a step towards those that pull it, and a point
//! that a node has come near to is gone. Thickness is that of pipes: the cross-sections of
//! branches, to a power, sum to that of their parent. Source: [Runions 2007].

use std::f32::consts::{PI, TAU};

use math::{Frame, Vec3};
use sampling::Rng;

use super::mesh::Mesh;

/// Wood and leaves.
#[derive(Default)]
pub struct Tree {
    pub wood: Mesh,
    pub leaves: Mesh,
}

/// A broad-leaved species. Lengths are in metres.
pub struct Broadleaf {
    /// Height of the trunk below the crown.
    pub trunk: f32,
    /// Half the width and half the height of the crown, an ellipsoid.
    pub crown: [f32; 2],
    /// Points that attract growth.
    pub points: u32,
    /// Length and width of leaves.
    pub leaf: [f32; 2],
    /// Leaves at each node of a twig.
    pub leaves: u32,
}

/// The golden angle, by which leaves follow each other around a twig.
const GOLDEN: f32 = 2.399_963;
/// The step of growth.
const STEP: f32 = 0.12;
/// Points pull nodes within this distance.
const REACH: f32 = 2.4;
/// Points nearer than this are gone.
const NEAR: f32 = 0.25;
/// The radius of twigs at their ends, and up to which they have leaves.
const TIP: f32 = 0.004;
const TWIG: f32 = 0.012;
/// The power by which thickness adds up.
const PIPES: f32 = 2.3;

struct Node {
    p: Vec3,
    parent: usize,
}

/// A point in a ball.
fn in_ball(rng: &mut Rng) -> Vec3 {
    loop {
        let p = Vec3::new(rng.uniform_f32(), rng.uniform_f32(), rng.uniform_f32()) * 2.0 - Vec3::ONE;
        if p.length_squared() < 1.0 {
            return p;
        }
    }
}

impl Broadleaf {
    pub fn grow(&self, seed: u64) -> Tree {
        let mut rng = Rng::from_sequence(seed);
        let nodes = self.colonise(&mut rng);
        let mut radii = vec![0.0_f32; nodes.len()];
        // Children come after their parents; until the end `radii` has sums of powers.
        for i in (1..nodes.len()).rev() {
            radii[i] = radii[i].max(lanes::pow(TIP, PIPES));
            let above = radii[i];
            radii[nodes[i].parent] += above;
            radii[i] = lanes::pow(above, 1.0 / PIPES);
        }
        radii[0] = radii[1];
        let mut tree = Tree::default();
        wood(&nodes, &radii, &mut tree.wood);
        for i in (1..nodes.len()).filter(|&i| radii[i] < TWIG) {
            let along = (nodes[i].p - nodes[nodes[i].parent].p).normalize_or(Vec3::Z);
            for k in 0..self.leaves {
                let turn = GOLDEN * (i as f32 + k as f32 / self.leaves as f32) + TAU * rng.uniform_f32();
                self.leaf(nodes[i].p, along, turn % TAU, &mut rng, &mut tree.leaves);
            }
        }
        tree
    }

    /// The nodes of the tree, each after its parent.
    fn colonise(&self, rng: &mut Rng) -> Vec<Node> {
        let [wide, high] = self.crown;
        let centre = Vec3::new(0.0, 0.0, self.trunk + high);
        let mut points: Vec<(Vec3, usize, f32)> = (0..self.points)
            .map(|_| (centre + in_ball(rng) * Vec3::new(wide, wide, high), 0, f32::INFINITY))
            .collect();
        let mut nodes = vec![Node { p: Vec3::new(0.0, 0.0, -0.3), parent: 0 }];
        let mut lean = Vec3::ZERO;
        while nodes[nodes.len() - 1].p.z < self.trunk {
            lean = lean * 0.9 + in_ball(rng) * 0.03;
            let (p, parent) = (nodes[nodes.len() - 1].p, nodes.len() - 1);
            nodes.push(Node { p: p + (Vec3::Z + lean).normalize() * STEP, parent });
        }
        let mut grown = 0;
        for _ in 0..300 {
            // The nearest node of each point, of which only new nodes have to be looked at.
            for (point, nearest, distance) in &mut points {
                for (i, node) in nodes.iter().enumerate().skip(grown) {
                    let d = node.p.distance(*point);
                    if d < *distance {
                        (*nearest, *distance) = (i, d);
                    }
                }
            }
            grown = nodes.len();
            points.retain(|(_, _, distance)| *distance > NEAR);
            let mut pulls = vec![Vec3::ZERO; grown];
            for (point, nearest, distance) in &points {
                if *distance < REACH {
                    pulls[*nearest] += (*point - nodes[*nearest].p) / *distance;
                }
            }
            for (parent, pull) in pulls.into_iter().enumerate().filter(|(_, pull)| *pull != Vec3::ZERO) {
                // Twigs rise a little to the light, and no two steps are exactly alike.
                let way = (pull.normalize_or(Vec3::Z) + Vec3::Z * 0.12 + in_ball(rng) * 0.25).normalize();
                let p = nodes[parent].p + way * STEP;
                nodes.push(Node { p, parent });
            }
            if nodes.len() == grown || nodes.len() > 60_000 {
                break;
            }
        }
        nodes
    }

    /// A leaf of four triangles, folded along its midrib.
    fn leaf(&self, at: Vec3, along: Vec3, turn: f32, rng: &mut Rng, mesh: &mut Mesh) {
        let [length, width] = self.leaf.map(|size| size * (0.7 + 0.5 * rng.uniform_f32()));
        let twig = Frame::from_z(along);
        let (sin, cos) = lanes::sin_cos(turn);
        let out = (twig.x * cos + twig.y * sin + along * 0.6 - Vec3::Z * 0.35).normalize();
        let side = out.cross(Vec3::Z + in_ball(rng) * 0.8).normalize_or(twig.x);
        let lift = side.cross(out) * (0.25 * width);
        let base = at + out * (0.25 * length);
        let tip = base + out * length - Vec3::Z * (0.1 * length);
        for hand in [1.0, -1.0] {
            let edge = side * (0.5 * width * hand) + lift;
            let [low, high] = [(0.3, 1.0), (0.7, 0.7)].map(|(t, w)| base + out * (length * t) + edge * w);
            mesh.fan(&[base, low, high, tip]);
        }
    }
}

/// Tubes along chains of nodes, each of which follows its thickest child.
fn wood(nodes: &[Node], radii: &[f32], mesh: &mut Mesh) {
    let mut heir = vec![0; nodes.len()];
    for i in 1..nodes.len() {
        let parent = nodes[i].parent;
        if heir[parent] == 0 || radii[i] > radii[heir[parent]] {
            heir[parent] = i;
        }
    }
    for start in (1..nodes.len()).filter(|&i| heir[nodes[i].parent] != i || nodes[i].parent == 0) {
        let mut chain = vec![(nodes[nodes[start].parent].p, radii[start])];
        let mut i = start;
        while i != 0 {
            chain.push((nodes[i].p, radii[i]));
            i = heir[i];
        }
        let sides = match radii[start] {
            thin if thin < 0.008 => 3,
            medium if medium < 0.04 => 5,
            _ => 12,
        };
        mesh.tube(&chain, sides);
    }
}

/// A spruce of a height in metres.
pub fn spruce(height: f32, seed: u64) -> Tree {
    let mut rng = Rng::from_sequence(seed);
    let mut tree = Tree::default();
    let radius = |z: f32| 0.012 + 0.016 * (height - z).max(0.0);
    let trunk: Vec<_> = (0..=24)
        .map(|i| height * i as f32 / 24.0 - 0.3)
        .map(|z| (Vec3::new(0.02 * lanes::sin(z), 0.02 * lanes::cos(1.3 * z), z), radius(z)))
        .collect();
    tree.wood.tube(&trunk, 12);
    let mut z = 0.8 + 0.4 * rng.uniform_f32();
    while z < height - 0.15 {
        let reach = (0.27 * (height - z) + 0.15).min(2.6);
        let count = 5 + (3.0 * rng.uniform_f32()) as u32;
        let first = TAU * rng.uniform_f32();
        for k in 0..count {
            let turn = first + TAU * (k as f32 + 0.3 * rng.uniform_f32()) / count as f32;
            bough(Vec3::new(0.0, 0.0, z), turn, reach * (0.8 + 0.3 * rng.uniform_f32()), &mut rng, &mut tree);
        }
        // Closer towards the top.
        z += 0.09 + 0.026 * (height - z) + 0.06 * rng.uniform_f32();
    }
    tree
}

/// A bough of a spruce, that hangs and rises at its end, with twigs on both sides.
fn bough(from: Vec3, turn: f32, length: f32, rng: &mut Rng, tree: &mut Tree) {
    let (sin, cos) = lanes::sin_cos(turn);
    let (out, side) = (Vec3::new(cos, sin, 0.0), Vec3::new(-sin, cos, 0.0));
    let at = |t: f32| from + out * (length * t) + Vec3::Z * (length * (0.25 * t * t - 0.36 * t));
    let count = 3 + (length / 0.09) as u32;
    let points: Vec<_> = (0..=count)
        .map(|i| i as f32 / count as f32)
        .map(|t| (at(t), 0.003 + 0.011 * length * (1.0 - t)))
        .collect();
    tree.wood.tube(&points, 4);
    for i in 1..=count {
        let t = i as f32 / count as f32;
        let twig = length * 0.42 * (1.05 - t) * (0.8 + 0.4 * rng.uniform_f32());
        for hand in [1.0, -1.0] {
            let way = (out * 0.75 + side * hand - Vec3::Z * (0.25 + 0.2 * rng.uniform_f32())).normalize();
            needles(at(t), way, twig.max(0.06), rng, &mut tree.leaves);
        }
    }
    needles(at(0.55), (at(1.0) - at(0.55)).normalize(), length * 0.5, rng, &mut tree.leaves);
}

/// Needles around a twig, each one narrow triangle.
fn needles(from: Vec3, way: Vec3, length: f32, rng: &mut Rng, mesh: &mut Mesh) {
    let frame = Frame::from_z(way);
    let count = (length / 0.004) as u32;
    for i in 0..count {
        let t = length * i as f32 / count as f32;
        let (sin, cos) = lanes::sin_cos((GOLDEN * i as f32 + 0.6 * rng.uniform_f32()) % TAU);
        let out = (frame.x * cos + frame.y * sin + way * 0.7).normalize();
        let across = out.cross(way).normalize_or(frame.x) * 0.0024;
        let base = from + way * t - Vec3::Z * (0.1 * t * t / length.max(0.1));
        let tip = base + out * (0.02 + 0.008 * rng.uniform_f32());
        mesh.fan(&[base - across, base + across, tip]);
    }
}

/// A square metre of grass about the origin.
pub fn grass(blades: u32, seed: u64) -> Mesh {
    let mut rng = Rng::from_sequence(seed);
    let mut mesh = Mesh::default();
    for _ in 0..blades {
        let base = Vec3::new(rng.uniform_f32() - 0.5, rng.uniform_f32() - 0.5, -0.02);
        let (height, width) = (0.08 + 0.16 * rng.uniform_f32(), 0.002 + 0.002 * rng.uniform_f32());
        let (sin, cos) = lanes::sin_cos(TAU * rng.uniform_f32());
        let (out, across) = (Vec3::new(cos, sin, 0.0), Vec3::new(-sin, cos, 0.0) * width);
        let bend = height * (0.2 + 0.6 * rng.uniform_f32());
        let at = |t: f32| base + Vec3::Z * (height * lanes::sin(0.5 * PI * t)) + out * (bend * t * t);
        let (middle, tip) = (at(0.55), at(1.0));
        mesh.fan(&[base - across, base + across, middle + across * 0.7, middle - across * 0.7]);
        mesh.fan(&[middle - across * 0.7, middle + across * 0.7, tip]);
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    const BUSH: Broadleaf =
        Broadleaf { trunk: 0.3, crown: [0.6, 0.5], points: 300, leaf: [0.05, 0.03], leaves: 2 };

    /// Lowest and highest points.
    fn extent(mesh: &Mesh) -> [Vec3; 2] {
        let first = mesh.positions[0];
        mesh.positions.iter().fold([first; 2], |[low, high], p| [low.min(*p), high.max(*p)])
    }

    #[test]
    fn a_tree_fills_its_crown() {
        let tree = BUSH.grow(5);
        let [low, high] = extent(&tree.leaves);
        assert!(low.z > 0.0 && high.z > 1.1 && high.z < 1.6, "{low} {high}");
        assert!(low.x < -0.4 && low.x > -1.0 && high.x > 0.4 && high.x < 1.0, "{low} {high}");
        assert!(extent(&tree.wood)[0].z < 0.0);
        assert!(tree.wood.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-4));
    }

    #[test]
    fn a_seed_always_grows_the_same_tree() {
        let [a, b, other] = [5, 5, 6].map(|seed| BUSH.grow(seed).leaves.positions);
        assert_eq!(a, b);
        assert_ne!(a, other);
        assert_eq!(spruce(2.0, 1).leaves.positions, spruce(2.0, 1).leaves.positions);
    }

    #[test]
    fn boughs_of_a_spruce_get_shorter_towards_its_top() {
        let leaves = spruce(5.0, 3).leaves;
        let reach = |low: f32, high: f32| {
            let between = leaves.positions.iter().filter(|p| (low..high).contains(&p.z));
            between.map(|p| p.x.hypot(p.y)).fold(0.0, f32::max)
        };
        assert!(reach(0.5, 1.5) > 0.8 && reach(3.5, 4.0) < 0.75 && reach(4.7, 5.2) < 0.4);
    }
}
