//! Lights by their importance to the shading point: a stochastic descent through a BVH of lights.
//!
//! Each node bounds its lights' positions, directions and power ([`LightBounds`]); at each node a
//! child is chosen in proportion to importance, with one random number that is rescaled after each
//! choice. The path to each light is stored as a trail of bits, from which the probability of a
//! given light is computed. Lights infinitely far away have no bounds: each is chosen with the same
//! probability as the whole tree.
//!
//! The tree is built top-down over 12 buckets per axis by the cost Φ·M_Ω·K_r·A: M_Ω measures the
//! solid angle of emission, K_r penalizes long thin boxes, A is the area of the box. Large clusters
//! are built on several threads; the tree does not depend on their number. Sources: [Conty Estevez
//! & Kulla 2018]; [Pharr 2023 §12.6.3].

use super::cluster::Cluster;
use crate::light::{LightBounds, LightId, LightSampleContext, Lights};
use math::{Bounds3, ONE_MINUS_EPSILON, safe_acos, safe_sqrt};
use std::f32::consts::PI;
use std::sync::atomic::{AtomicBool, Ordering};

/// Lights by importance.
#[derive(Clone, Debug)]
pub struct BvhLightSampler {
    nodes: Vec<Node>,
    infinite: Vec<LightId>,
    /// By light.
    trails: Vec<Trail>,
}

/// The place of a light. In the tree: the path from the root, where bit i is set for the right
/// child at depth i; trees are less than 64 deep. Elsewhere: one of two reserved values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Trail(u64);

impl Trail {
    /// Not in the sampler: its power is zero.
    const NOWHERE: Self = Self(u64::MAX);
    /// Among the lights infinitely far away.
    const INFINITE: Self = Self(u64::MAX - 1);
}

#[derive(Clone, Copy, Debug)]
struct Node {
    cluster: Cluster,
    kind: NodeKind,
}

#[derive(Clone, Copy, Debug)]
enum NodeKind {
    Leaf(LightId),
    /// The left child follows its parent.
    Interior {
        right: u32,
    },
}

const BUCKETS: usize = 12;
/// Below this depth splits are at the median, so that every trail fits into its bits.
const MAX_COST_SPLIT_DEPTH: u32 = 32;
/// The two halves of clusters with more lights are built in parallel.
const PARALLEL_LIGHTS: usize = 4096;

impl BvhLightSampler {
    /// Builds the tree; `None` if `cancel` is set meanwhile.
    pub fn new(lights: Lights, cancel: &AtomicBool) -> Option<Self> {
        let mut infinite = Vec::new();
        let mut bounded = Vec::new();
        let mut trails = vec![Trail::NOWHERE; lights.len()];
        for light in lights.iter() {
            if cancel.load(Ordering::Relaxed) {
                return None;
            }
            let id = light.id();
            match light.bounds() {
                None => {
                    infinite.push(id);
                    trails[id.0 as usize] = Trail::INFINITE;
                }
                Some(bounds) if bounds.phi > 0.0 => bounded.push((id, bounds)),
                Some(_) => {}
            }
        }
        let empty =
            Node { cluster: Cluster::new(&LightBounds::EMPTY), kind: NodeKind::Interior { right: 0 } };
        let mut nodes = vec![empty; (2 * bounded.len()).saturating_sub(1)];
        if !nodes.is_empty() {
            build(&mut bounded, &mut nodes, [0, 0], cancel)?;
        }
        let mut sampler = Self { nodes, infinite, trails };
        sampler.store_trails(0, 0, 0);
        Some(sampler)
    }

    /// Stores the trails of all lights below a node, whose own is `trail`.
    fn store_trails(&mut self, node: usize, trail: u64, depth: u32) {
        match self.nodes.get(node).map(|node| node.kind) {
            None => (),
            Some(NodeKind::Leaf(id)) => self.trails[id.0 as usize] = Trail(trail),
            Some(NodeKind::Interior { right }) => {
                self.store_trails(node + 1, trail, depth + 1);
                self.store_trails(right as usize, trail | (1 << depth), depth + 1);
            }
        }
    }

    /// Probability of choosing among the infinite lights.
    fn infinite_probability(&self) -> f32 {
        let infinite = self.infinite.len() as f32;
        let tree = if self.nodes.is_empty() { 0.0 } else { 1.0 };
        if infinite == 0.0 { 0.0 } else { infinite / (infinite + tree) }
    }

    fn importance(&self, node: usize, context: &LightSampleContext) -> f32 {
        self.nodes[node].cluster.importance(context.p.p, context.ns)
    }

    /// Probability of choosing the tree: zero if its root is a leaf of importance zero.
    fn tree_probability(&self, context: &LightSampleContext) -> f32 {
        // Below an interior root the descent finds importances of zero.
        match self.nodes.first() {
            Some(Node { kind: NodeKind::Leaf(_), .. }) if self.importance(0, context) == 0.0 => 0.0,
            _ => 1.0 - self.infinite_probability(),
        }
    }

    pub(super) fn sample(&self, context: &LightSampleContext, u: f32) -> Option<(LightId, f32)> {
        let share = self.infinite_probability();
        if u < share {
            let count = self.infinite.len();
            let i = ((u / share * count as f32) as usize).min(count - 1);
            return Some((self.infinite[i], share / count as f32));
        }
        let mut u = ((u - share) / (1.0 - share)).min(ONE_MINUS_EPSILON);
        let mut pmf = self.tree_probability(context);
        let mut index = 0;
        loop {
            match self.nodes.get(index)?.kind {
                NodeKind::Interior { right } => {
                    let (left, right) = (index + 1, right as usize);
                    let [a, b] = [left, right].map(|child| self.importance(child, context));
                    if a == 0.0 && b == 0.0 {
                        return None;
                    }
                    let [p, q] = [a / (a + b), b / (a + b)];
                    (index, u, pmf) =
                        if u < p { (left, u / p, pmf * p) } else { (right, (u - p) / q, pmf * q) };
                    u = u.clamp(0.0, ONE_MINUS_EPSILON);
                }
                NodeKind::Leaf(id) => return (pmf > 0.0).then_some((id, pmf)),
            }
        }
    }

    pub(super) fn pmf(&self, context: &LightSampleContext, light: LightId) -> f32 {
        let mut trail = match self.trails[light.0 as usize] {
            Trail::NOWHERE => return 0.0,
            Trail::INFINITE => return self.infinite_probability() / self.infinite.len() as f32,
            Trail(trail) => trail,
        };
        let (mut pmf, mut index) = (self.tree_probability(context), 0);
        while let NodeKind::Interior { right } = self.nodes[index].kind {
            let children = [index + 1, right as usize];
            let importances = children.map(|child| self.importance(child, context));
            let way = (trail & 1) as usize;
            if importances[way] == 0.0 {
                return 0.0;
            }
            pmf *= importances[way] / (importances[0] + importances[1]);
            index = children[way];
            trail >>= 1;
        }
        pmf
    }
}

/// Builds the tree of n ≥ 1 lights in 2n − 1 nodes. The first node has the given index and depth in
/// the whole tree. `None` if `cancel` is set meanwhile.
fn build(
    lights: &mut [(LightId, LightBounds)],
    nodes: &mut [Node],
    [index, depth]: [u32; 2],
    cancel: &AtomicBool,
) -> Option<LightBounds> {
    if let [(id, bounds)] = lights {
        nodes[0] = Node { cluster: Cluster::new(bounds), kind: NodeKind::Leaf(*id) };
        return Some(*bounds);
    }
    if cancel.load(Ordering::Relaxed) {
        return None;
    }
    let is_large = lights.len() > PARALLEL_LIGHTS;
    let middle = split(lights, depth);
    let (left, right) = lights.split_at_mut(middle);
    let (node, below) = nodes.split_first_mut()?;
    let (left_nodes, right_nodes) = below.split_at_mut(2 * middle - 1);
    let right_index = index + 2 * middle as u32;
    let mut left = || build(left, left_nodes, [index + 1, depth + 1], cancel);
    let mut right = || build(right, right_nodes, [right_index, depth + 1], cancel);
    let (left, right) = if is_large { rayon::join(left, right) } else { (left(), right()) };
    let bounds = left?.union(right?);
    *node = Node { cluster: Cluster::new(&bounds), kind: NodeKind::Interior { right: right_index } };
    Some(bounds)
}

/// Reorders the lights and returns where the second half starts.
fn split(lights: &mut [(LightId, LightBounds)], depth: u32) -> usize {
    let bounds = lights.iter().fold(Bounds3::EMPTY, |b, l| b.union(l.1.bounds));
    let centroids = Bounds3::around(lights.iter().map(|l| l.1.bounds.centroid()));
    let is_below =
        |(axis, first): (usize, usize), light: &LightBounds| bucket(light, &centroids, axis) < first;
    if depth < MAX_COST_SPLIT_DEPTH
        && lights.len() > 2
        && let Some(best) = best_split(lights, &bounds, &centroids)
    {
        let mut count = 0;
        for i in 0..lights.len() {
            if is_below(best, &lights[i].1) {
                lights.swap(i, count);
                count += 1;
            }
        }
        if count > 0 && count < lights.len() {
            return count;
        }
    }
    let axis = centroids.diagonal().max_position();
    let middle = lights.len() / 2;
    lights.select_nth_unstable_by(middle, |a, b| {
        a.1.bounds.centroid()[axis].total_cmp(&b.1.bounds.centroid()[axis])
    });
    middle
}

/// The axis and the first bucket of the upper side with the least cost; `None` where no split has a
/// positive cost, as for points on one line.
fn best_split(
    lights: &[(LightId, LightBounds)],
    bounds: &Bounds3,
    centroids: &Bounds3,
) -> Option<(usize, usize)> {
    let mut best: Option<(f32, (usize, usize))> = None;
    for axis in (0..3).filter(|&axis| centroids.diagonal()[axis] > 0.0) {
        let mut buckets = [LightBounds::EMPTY; BUCKETS];
        for (_, light) in lights {
            let i = bucket(light, centroids, axis);
            buckets[i] = buckets[i].union(*light);
        }
        // above[i] bounds the buckets from i on.
        let mut above = buckets;
        for i in (0..BUCKETS - 1).rev() {
            above[i] = above[i].union(above[i + 1]);
        }
        let mut below = LightBounds::EMPTY;
        for i in 1..BUCKETS {
            below = below.union(buckets[i - 1]);
            let cost = cost(&below, bounds, axis) + cost(&above[i], bounds, axis);
            if cost > 0.0 && best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, (axis, i)));
            }
        }
    }
    best.map(|(_, split)| split)
}

fn bucket(b: &LightBounds, centroids: &Bounds3, axis: usize) -> usize {
    let offset = (b.bounds.centroid()[axis] - centroids.min[axis]) / centroids.diagonal()[axis];
    ((offset * BUCKETS as f32) as usize).min(BUCKETS - 1)
}

fn cost(b: &LightBounds, parent: &Bounds3, axis: usize) -> f32 {
    if b.phi == 0.0 {
        return 0.0;
    }
    let theta_o = safe_acos(b.cos_theta_o);
    let theta_e = safe_acos(b.cos_theta_e);
    let theta_w = (theta_o + theta_e).min(PI);
    let sin_o = safe_sqrt(1.0 - b.cos_theta_o * b.cos_theta_o);
    let solid_angle = 2.0 * PI * (1.0 - b.cos_theta_o)
        + PI / 2.0
            * (2.0 * theta_w * sin_o - (theta_o - 2.0 * theta_w).cos() - 2.0 * theta_o * sin_o
                + b.cos_theta_o);
    let d = parent.diagonal();
    let regular = d.max_element() / d[axis];
    b.phi * solid_angle * regular * b.bounds.surface_area()
}
