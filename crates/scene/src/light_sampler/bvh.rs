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

use super::cluster::{Cluster, NUMBERS};
use super::infinite::{InfiniteLights, separated};
use crate::light::{LightBounds, LightId, LightSampleContext, Lights};
use lanes::{Int, Mask, Real};
use math::{Bounds3, ONE_MINUS_EPSILON, balance, safe_acos, safe_sqrt};
use std::f32::consts::PI;
use std::sync::atomic::{AtomicBool, Ordering};

/// Lights by importance.
#[derive(Clone, Debug)]
pub struct BvhLightSampler {
    /// By node; the left child of a node follows it.
    clusters: Vec<[f32; NUMBERS]>,
    /// By node: [`LEAF`] and the id of its light, or the right child of an interior node.
    kinds: Vec<u32>,
    infinite: InfiniteLights,
    /// By light.
    trails: Trails,
}

/// The places of the lights, each in two words. In the tree: the path from the root, where bit i of
/// word 0 is set for the right child at depth i, and of word 1 at depth 32 + i; trees are less than
/// 64 deep. Elsewhere: word 1 is [`ELSEWHERE`](Self::ELSEWHERE).
#[derive(Clone, Debug)]
struct Trails([Vec<u32>; 2]);

impl Trails {
    /// Word 1 of a light that is not in the tree.
    const ELSEWHERE: u32 = u32::MAX;
    /// Word 0 there of a light whose power is zero, which is never chosen.
    const NOWHERE: u32 = 0;
    /// Word 0 there of a light infinitely far away.
    const INFINITE: u32 = 1;

    fn set(&mut self, light: u32, words: [u32; 2]) {
        self.0.iter_mut().zip(words).for_each(|(words, word)| words[light as usize] = word);
    }
}

/// The bit of a leaf's kind; no node has an index as large.
const LEAF: u32 = 1 << 31;

const BUCKETS: usize = 12;
/// Below this depth splits are at the median, so that every trail fits into its bits.
const MAX_COST_SPLIT_DEPTH: u32 = 32;
/// The two halves of clusters with more lights are built in parallel.
const PARALLEL_LIGHTS: usize = 4096;

impl BvhLightSampler {
    /// The bit of a leaf.
    pub const LEAF: u32 = LEAF;

    /// The most lights: the numbers of their tree are counted in 32 bits.
    pub const MAX_LIGHTS: usize = 1 << 27;

    /// Builds the tree; `None` if `cancel` is set meanwhile.
    ///
    /// # Panics
    /// If there are more than [`MAX_LIGHTS`](Self::MAX_LIGHTS).
    pub fn new(lights: Lights, cancel: &AtomicBool) -> Option<Self> {
        assert!(lights.len() <= Self::MAX_LIGHTS, "too many lights for a tree");
        let (infinite, mut bounded) = separated(lights, cancel)?;
        let mut trails = Trails([Trails::NOWHERE, Trails::ELSEWHERE].map(|word| vec![word; lights.len()]));
        infinite.ids().iter().for_each(|&id| trails.set(id, [Trails::INFINITE, Trails::ELSEWHERE]));
        let count = (2 * bounded.len()).saturating_sub(1);
        let (mut clusters, mut kinds) = (vec![[0.0; NUMBERS]; count], vec![0; count]);
        if count > 0 {
            build(&mut bounded, &mut clusters, &mut kinds, 0, 0, cancel)?;
        }
        let mut sampler = Self { clusters, kinds, infinite, trails };
        sampler.store_trails(0, 0, 0);
        Some(sampler)
    }

    /// The nodes: the numbers of their clusters, which `cluster.rs` lists, and [`LEAF`](Self::LEAF)
    /// with a light or the right child. The left child of a node follows it.
    pub fn nodes(&self) -> impl ExactSizeIterator<Item = (&[f32], u32)> {
        self.clusters.iter().map(|cluster| &cluster[..]).zip(self.kinds.iter().copied())
    }

    /// The trail of each light as two words of bits, from the root on: 1 leads to a right child.
    /// Where the second word is all ones the light is not in the tree, and the first says whether
    /// it is infinitely far away.
    pub fn trails(&self) -> impl ExactSizeIterator<Item = [u32; 2]> {
        self.trails.0[0].iter().zip(&self.trails.0[1]).map(|(&low, &high)| [low, high])
    }

    /// The lights infinitely far away, and the probability of choosing among them.
    pub fn infinite(&self) -> (&[u32], f32) {
        (self.infinite.ids(), self.infinite.probability())
    }

    /// Stores the trails of all lights below a node, whose own is `trail`.
    fn store_trails(&mut self, node: usize, trail: u64, depth: u32) {
        match self.kinds.get(node) {
            None => (),
            Some(&kind) if kind >= LEAF => {
                self.trails.set(kind & !LEAF, [trail as u32, (trail >> 32) as u32]);
            }
            Some(&right) => {
                self.store_trails(node + 1, trail, depth + 1);
                self.store_trails(right as usize, trail | (1 << depth), depth + 1);
            }
        }
    }

    #[inline(always)]
    fn importance<R: Real>(&self, nodes: R::Int, context: &LightSampleContext<R>) -> R {
        Cluster::<R>::gather(self.clusters.as_flattened(), nodes).importance(context.p.p, context.ns)
    }

    /// Probability of choosing the tree.
    fn tree_probability(&self) -> f32 {
        1.0 - self.infinite.probability()
    }

    /// See [`LightSampler::sample_lanes`](super::LightSampler::sample_lanes).
    #[inline(always)]
    pub(super) fn sample_lanes<R: Real>(
        &self,
        context: &LightSampleContext<R>,
        u: R,
        active: R::Mask,
    ) -> (R::Int, R, R::Mask) {
        let is_infinite = u.lt(R::splat(self.infinite.probability())) & active;
        let (mut lights, mut pmf, mut valid) = (R::Int::splat(0), R::zero(), is_infinite);
        if is_infinite.any() {
            (lights, pmf) = (self.infinite.choose(u), R::splat(self.infinite.pmf()));
        }
        let in_tree = active & !is_infinite;
        if in_tree.any() && !self.kinds.is_empty() {
            let chosen = self.descend(context, self.infinite.rest(u), in_tree);
            lights = R::Int::select(in_tree, chosen.0, lights);
            pmf = R::select(in_tree, chosen.1, pmf);
            valid = valid | chosen.2;
        }
        (lights, pmf, valid)
    }

    /// Chooses a light of the tree, which has a node, for each lane of `active`.
    #[inline(always)]
    fn descend<R: Real>(
        &self,
        context: &LightSampleContext<R>,
        mut u: R,
        active: R::Mask,
    ) -> (R::Int, R, R::Mask) {
        let zero = R::zero();
        let mut pmf = R::splat(self.tree_probability());
        let mut valid = active;
        let mut node = R::Int::splat(0);
        loop {
            let kind = R::Int::gather(&self.kinds, node);
            let descends = valid & kind.lt(R::Int::splat(LEAF));
            if !descends.any() {
                return (kind & R::Int::splat(!LEAF), pmf, valid & pmf.gt(zero));
            }
            // Lanes that have arrived read the first node, and keep their own.
            let left = R::Int::select(descends, node.wrapping_add(R::Int::splat(1)), R::Int::splat(0));
            let right = R::Int::select(descends, kind, R::Int::splat(0));
            let (a, b) = (self.importance(left, context), self.importance(right, context));
            valid = valid & !(descends & a.eq(zero) & b.eq(zero));
            let (p, q) = (a / (a + b), b / (a + b));
            let goes_left = u.lt(p);
            let chosen = R::select(goes_left, p, q);
            let rest = R::select(goes_left, u, u - p) / chosen;
            u = R::select(descends, rest.clamp(zero, R::splat(ONE_MINUS_EPSILON)), u);
            pmf = R::select(descends, pmf * chosen, pmf);
            node = R::Int::select(descends, R::Int::select(goes_left, left, right), node);
        }
    }

    pub(super) fn sample(&self, context: &LightSampleContext, u: f32) -> Option<(LightId, f32)> {
        let (light, pmf, valid) = self.sample_lanes::<f32>(context, u, true);
        valid.then_some((LightId(light), pmf))
    }

    /// See [`LightSampler::pmf_lanes`](super::LightSampler::pmf_lanes).
    #[inline(always)]
    pub(super) fn pmf_lanes<R: Real>(
        &self,
        context: &LightSampleContext<R>,
        lights: R::Int,
        active: R::Mask,
    ) -> R {
        let (zero, root) = (R::zero(), R::Int::splat(0));
        if !active.any() {
            return zero;
        }
        let lights = R::Int::select(active, lights, root);
        let [low, high] =
            [R::Int::gather(&self.trails.0[0], lights), R::Int::gather(&self.trails.0[1], lights)];
        let in_tree = active & high.lt(R::Int::splat(Trails::ELSEWHERE));
        let is_infinite = low.eq(R::Int::splat(Trails::INFINITE));
        let mut pmf = R::select(is_infinite, R::splat(self.infinite.pmf()), zero);
        if !in_tree.any() {
            return pmf;
        }
        pmf = R::select(in_tree, R::splat(self.tree_probability()), pmf);
        let (mut descends, mut node, mut trail, mut depth) = (in_tree, root, low, 0);
        loop {
            let kind = R::Int::gather(&self.kinds, node);
            descends = descends & kind.lt(R::Int::splat(LEAF));
            if !descends.any() {
                return pmf;
            }
            // Lanes that have arrived read the first node, and keep their own.
            let left = R::Int::select(descends, node.wrapping_add(R::Int::splat(1)), root);
            let right = R::Int::select(descends, kind, root);
            let goes_left = (trail & R::Int::splat(1)).eq(R::Int::splat(0));
            let (a, b) = (self.importance(left, context), self.importance(right, context));
            let importance = R::select(goes_left, a, b);
            let chosen = R::select(importance.eq(zero), zero, importance / (a + b));
            pmf = R::select(descends, pmf * chosen, pmf);
            descends = descends & chosen.gt(zero);
            node = R::Int::select(descends, R::Int::select(goes_left, left, right), node);
            depth += 1;
            trail = if depth == 32 { high } else { trail.shr(1) };
        }
    }
}

/// Builds the tree of n ≥ 1 lights in 2n − 1 nodes, given by their clusters and kinds. The first
/// node has the given index and depth in the whole tree. `None` if `cancel` is set meanwhile.
fn build(
    lights: &mut [(LightId, LightBounds)],
    clusters: &mut [[f32; NUMBERS]],
    kinds: &mut [u32],
    index: u32,
    depth: u32,
    cancel: &AtomicBool,
) -> Option<LightBounds> {
    if let [(id, bounds)] = lights {
        (clusters[0], kinds[0]) = (Cluster::row(bounds), LEAF | id.0);
        return Some(*bounds);
    }
    if cancel.load(Ordering::Relaxed) {
        return None;
    }
    let is_large = lights.len() > PARALLEL_LIGHTS;
    let middle = split(lights, depth);
    let (left, right) = lights.split_at_mut(middle);
    let (cluster, below) = clusters.split_first_mut()?;
    let (left_clusters, right_clusters) = below.split_at_mut(2 * middle - 1);
    let (kind, below) = kinds.split_first_mut()?;
    let (left_kinds, right_kinds) = below.split_at_mut(2 * middle - 1);
    let right_index = index + 2 * middle as u32;
    let mut left = || build(left, left_clusters, left_kinds, index + 1, depth + 1, cancel);
    let mut right = || build(right, right_clusters, right_kinds, right_index, depth + 1, cancel);
    let (left, right) = if is_large { rayon::join(left, right) } else { (left(), right()) };
    let bounds = left?.union(right?);
    (*cluster, *kind) = (Cluster::row(&bounds), right_index);
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
            * (2.0 * theta_w * sin_o - lanes::cos(theta_o - 2.0 * theta_w) - 2.0 * theta_o * sin_o
                + b.cos_theta_o);
    let d = parent.diagonal();
    let regular = d.max_element() / d[axis];
    // Areas relative to the parent: power times area would vanish or overflow.
    let side = b.bounds.diagonal() * balance(d.max_element());
    let area = 2.0 * (side.x * side.y + side.y * side.z + side.z * side.x);
    b.phi * solid_angle * regular * area
}
