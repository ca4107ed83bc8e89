//! Lights by what they may contribute to the point at hand: a walk down a tree of clusters.
//!
//! Each node bounds its lights' positions, directions and power ([`LightBounds`]); at each step the two children's
//! importances decide with one random number, rescaled on the way. To find the probability of a given light again, the way
//! to it is stored as a trail of bits. Lights infinitely far away have no bounds; they are chosen among themselves alike, and
//! together count as much each as the whole tree.
//!
//! The tree is built top-down over 12 buckets per axis by the cost Φ·M_Ω·K_r·A: M_Ω measures the solid angle of emission, K_r
//! punishes long thin boxes, A is the area of the box. Sources: [Conty Estevez & Kulla 2018]; [Pharr 2023 §12.6.3].

use crate::light::{Light, LightBounds, LightId, LightSampleContext};
use math::{Bounds3, ONE_MINUS_EPSILON, safe_acos, safe_sqrt};
use std::collections::HashMap;
use std::f32::consts::PI;

/// Lights by importance.
#[derive(Clone, Debug)]
pub struct BvhLightSampler {
    nodes: Vec<Node>,
    infinite: Vec<LightId>,
    /// The way from the root: bit i says right at depth i. Lights of no power have none.
    trails: HashMap<LightId, u64>,
    is_infinite: Vec<bool>,
}

#[derive(Clone, Debug)]
struct Node {
    bounds: LightBounds,
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
/// Below this depth splits are by the middle, so that a trail always fits into its bits.
const DEEPEST_CHOICE: u32 = 32;

impl BvhLightSampler {
    /// For these lights.
    pub fn new(lights: &[Light]) -> Self {
        let mut infinite = Vec::new();
        let mut bounded = Vec::new();
        for (i, light) in lights.iter().enumerate() {
            let id = LightId(i as u32);
            match light.bounds() {
                None => infinite.push(id),
                Some(bounds) if bounds.phi > 0.0 => bounded.push((id, bounds)),
                Some(_) => {}
            }
        }
        let mut sampler = Self {
            nodes: Vec::with_capacity(2 * bounded.len()),
            is_infinite: lights.iter().map(|l| l.bounds().is_none()).collect(),
            infinite,
            trails: HashMap::with_capacity(bounded.len()),
        };
        if !bounded.is_empty() {
            sampler.build(&mut bounded, 0, 0);
        }
        sampler
    }

    fn build(&mut self, lights: &mut [(LightId, LightBounds)], trail: u64, depth: u32) -> LightBounds {
        let index = self.nodes.len();
        if let [(id, bounds)] = lights {
            self.trails.insert(*id, trail);
            self.nodes.push(Node { bounds: *bounds, kind: NodeKind::Leaf(*id) });
            return *bounds;
        }
        let middle = split(lights, depth);
        self.nodes.push(Node { bounds: LightBounds::EMPTY, kind: NodeKind::Interior { right: 0 } });
        let (left, right) = lights.split_at_mut(middle);
        let left = self.build(left, trail, depth + 1);
        let right_index = self.nodes.len() as u32;
        let right = self.build(right, trail | (1 << depth), depth + 1);
        let bounds = left.union(right);
        self.nodes[index] = Node { bounds, kind: NodeKind::Interior { right: right_index } };
        bounds
    }

    /// Probability of choosing among the infinite lights.
    fn infinite_share(&self) -> f32 {
        let infinite = self.infinite.len() as f32;
        let tree = if self.nodes.is_empty() { 0.0 } else { 1.0 };
        if infinite == 0.0 { 0.0 } else { infinite / (infinite + tree) }
    }

    fn child_importances(&self, left: usize, right: u32, context: &LightSampleContext) -> [f32; 2] {
        [left, right as usize].map(|i| self.nodes[i].bounds.importance(context.p.p, context.ns))
    }

    pub(super) fn sample(&self, context: &LightSampleContext, u: f32) -> Option<(LightId, f32)> {
        let share = self.infinite_share();
        if u < share {
            let count = self.infinite.len();
            let i = ((u / share * count as f32) as usize).min(count - 1);
            return Some((self.infinite[i], share / count as f32));
        }
        let mut u = ((u - share) / (1.0 - share)).min(ONE_MINUS_EPSILON);
        let mut pmf = 1.0 - share;
        let mut index = 0;
        loop {
            match self.nodes.get(index)?.kind {
                NodeKind::Interior { right } => {
                    let [a, b] = self.child_importances(index + 1, right, context);
                    if a == 0.0 && b == 0.0 {
                        return None;
                    }
                    let p = a / (a + b);
                    if u < p {
                        (index, u, pmf) = (index + 1, (u / p).min(ONE_MINUS_EPSILON), pmf * p);
                    } else {
                        let q = b / (a + b);
                        (index, u, pmf) =
                            (right as usize, ((u - p) / q).clamp(0.0, ONE_MINUS_EPSILON), pmf * q);
                    }
                }
                NodeKind::Leaf(id) => {
                    let matters =
                        index > 0 || self.nodes[index].bounds.importance(context.p.p, context.ns) > 0.0;
                    return (matters && pmf > 0.0).then_some((id, pmf));
                }
            }
        }
    }

    pub(super) fn pmf(&self, context: &LightSampleContext, light: LightId) -> f32 {
        let share = self.infinite_share();
        if self.is_infinite.get(light.0 as usize).copied().unwrap_or(false) {
            return share / self.infinite.len() as f32;
        }
        let Some(&trail) = self.trails.get(&light) else { return 0.0 };
        let (mut trail, mut pmf, mut index) = (trail, 1.0 - share, 0);
        while let NodeKind::Interior { right } = self.nodes[index].kind {
            let importances = self.child_importances(index + 1, right, context);
            let way = (trail & 1) as usize;
            let sum = importances[0] + importances[1];
            if sum == 0.0 {
                return 0.0;
            }
            pmf *= importances[way] / sum;
            index = if way == 0 { index + 1 } else { right as usize };
            trail >>= 1;
        }
        pmf
    }
}

/// Reorders the lights and returns where the second half starts.
fn split(lights: &mut [(LightId, LightBounds)], depth: u32) -> usize {
    let middle = lights.len() / 2;
    if depth >= DEEPEST_CHOICE {
        return middle;
    }
    let bounds = lights.iter().fold(Bounds3::EMPTY, |b, l| b.union(l.1.bounds));
    let centroids = Bounds3::around(lights.iter().map(|l| l.1.bounds.centroid()));
    let mut best: Option<(f32, usize, usize)> = None;
    for axis in 0..3 {
        let extent = centroids.diagonal()[axis];
        if extent <= 0.0 {
            continue;
        }
        let mut buckets = [LightBounds::EMPTY; BUCKETS];
        for (_, b) in lights.iter() {
            let i = bucket(b, &centroids, axis);
            buckets[i] = buckets[i].union(*b);
        }
        for i in 1..BUCKETS {
            let below = buckets[..i].iter().fold(LightBounds::EMPTY, |a, &b| a.union(b));
            let above = buckets[i..].iter().fold(LightBounds::EMPTY, |a, &b| a.union(b));
            let cost = cost(&below, &bounds, axis) + cost(&above, &bounds, axis);
            if cost > 0.0 && best.is_none_or(|(c, ..)| cost < c) {
                best = Some((cost, axis, i));
            }
        }
    }
    let Some((_, axis, first)) = best else { return middle };
    let mut count = 0;
    for i in 0..lights.len() {
        if bucket(&lights[i].1, &centroids, axis) < first {
            lights.swap(i, count);
            count += 1;
        }
    }
    if count == 0 || count == lights.len() { middle } else { count }
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
