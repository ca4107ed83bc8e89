//! A balanced kd-tree of points, for nearest-neighbour queries.
//!
//! The tree is implicit in the order of one array: the node of a range is its middle point. All
//! points before it lie on one side of it along the node's axis, all after it on the other; both
//! halves are ranges again, down to short leaves, which are searched linearly. Each range is split
//! along the longest axis of its bounds. Halves are built in parallel; ties are broken by the
//! points' order, so that the tree depends on the points only.
//!
//! The search visits the nearer half first, and the other one if its cell is not farther away than
//! the farthest neighbour found, which is at the top of a heap. The distance of a cell is updated
//! incrementally from the planes that were crossed. [Bentley 1975], [Arya 1993]

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::ops::Range;

use math::{Bounds3, Point3, Vec3};

use crate::{Cancelled, Control};

/// Ranges of at most this many points are leaves.
const LEAF: usize = 8;

/// Ranges of more points are built in parallel.
const PARALLEL: usize = 4096;

/// Points in the order of a kd-tree.
#[derive(Debug, Default)]
pub(crate) struct KdTree {
    points: Vec<Point3>,
    /// The split axis of each point that is a node.
    axes: Vec<u8>,
}

/// A neighbour of the query point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Neighbour {
    /// Square of the distance.
    pub distance_squared: f32,
    /// Index into the tree's points.
    pub index: u32,
}

impl Eq for Neighbour {}

impl PartialOrd for Neighbour {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Neighbour {
    /// By distance, and among equals by index.
    fn cmp(&self, other: &Self) -> Ordering {
        self.distance_squared.total_cmp(&other.distance_squared).then(self.index.cmp(&other.index))
    }
}

impl KdTree {
    /// Builds a tree of the finite points. Also returns their original indices, in the order of the
    /// tree's points.
    pub fn build(
        points: impl Iterator<Item = Point3>,
        control: &Control,
    ) -> Result<(Self, Vec<u32>), Cancelled> {
        let mut entries: Vec<_> = points.zip(0..).filter(|(p, _)| p.is_finite()).collect();
        let mut axes = vec![0; entries.len()];
        arrange(&mut entries, &mut axes, control)?;
        let (points, order) = entries.into_iter().unzip();
        Ok((Self { points, axes }, order))
    }

    /// Memory taken, in bytes.
    pub fn memory(&self) -> usize {
        size_of_val(&*self.points) + size_of_val(&*self.axes)
    }

    /// The nearest points to `p` within `radius` for which `accept` is true, at most `count`, in no
    /// particular order.
    pub fn nearest(
        &self,
        p: Point3,
        count: usize,
        radius: f32,
        accept: impl Fn(u32) -> bool,
    ) -> Vec<Neighbour> {
        if count == 0 {
            return Vec::new();
        }
        let found = BinaryHeap::with_capacity(count.min(64));
        let mut search = Search { tree: self, p, count, limit: radius * radius, found, accept };
        search.visit(0..self.points.len(), Vec3::ZERO);
        search.found.into_vec()
    }
}

/// Moves the node of a range to its middle and partitions the other points by it.
fn arrange(entries: &mut [(Point3, u32)], axes: &mut [u8], control: &Control) -> Result<(), Cancelled> {
    if entries.len() <= LEAF {
        return Ok(());
    }
    let axis = Bounds3::around(entries.iter().map(|&(p, _)| p)).longest_axis();
    let middle = entries.len() / 2;
    entries.select_nth_unstable_by(middle, |(a, i), (b, j)| a[axis].total_cmp(&b[axis]).then(i.cmp(j)));
    axes[middle] = axis as u8;
    let parallel = entries.len() > PARALLEL;
    let (before, rest) = entries.split_at_mut(middle);
    let (axes_before, axes_rest) = axes.split_at_mut(middle);
    let mut before = || arrange(before, axes_before, control);
    let mut behind = || arrange(&mut rest[1..], &mut axes_rest[1..], control);
    let (before, behind) = if parallel {
        control.check()?;
        rayon::join(before, behind)
    } else {
        (before(), behind())
    };
    before.and(behind)
}

/// The state of a search.
struct Search<'a, A> {
    tree: &'a KdTree,
    p: Point3,
    count: usize,
    /// Square of the search radius, which shrinks once `count` points are found.
    limit: f32,
    /// The nearest points so far, the farthest of them on top.
    found: BinaryHeap<Neighbour>,
    accept: A,
}

impl<A: Fn(u32) -> bool> Search<'_, A> {
    /// Searches a range whose cell is at the distance `away` from the point along each axis.
    fn visit(&mut self, range: Range<usize>, away: Vec3) {
        if range.len() <= LEAF {
            range.for_each(|i| self.consider(i));
            return;
        }
        let middle = range.start + range.len() / 2;
        let axis = usize::from(self.tree.axes[middle]);
        let offset = self.p[axis] - self.tree.points[middle][axis];
        let (before, behind) = (range.start..middle, middle + 1..range.end);
        let (near, far) = if offset < 0.0 { (before, behind) } else { (behind, before) };
        self.visit(near, away);
        self.consider(middle);
        let mut beyond = away;
        beyond[axis] = offset;
        if beyond.length_squared() <= self.limit {
            self.visit(far, beyond);
        }
    }

    fn consider(&mut self, index: usize) {
        let distance_squared = self.p.distance_squared(self.tree.points[index]);
        let neighbour = Neighbour { distance_squared, index: index as u32 };
        if distance_squared > self.limit || !(self.accept)(neighbour.index) {
            return;
        }
        if self.found.len() < self.count {
            self.found.push(neighbour);
        } else if let Some(mut farthest) = self.found.peek_mut()
            && neighbour < *farthest
        {
            *farthest = neighbour;
        }
        if self.found.len() == self.count
            && let Some(farthest) = self.found.peek()
        {
            self.limit = farthest.distance_squared;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::Random;

    fn tree(points: &[Point3]) -> (KdTree, Vec<u32>) {
        KdTree::build(points.iter().copied(), &Control::default()).expect("nobody cancels it")
    }

    /// Typical and degenerate sets of points.
    fn clouds() -> Vec<(&'static str, Vec<Point3>)> {
        let mut random = Random::new(3);
        let mut next = move || random.get_1d();
        let mut cloud = |count: usize, make: &mut dyn FnMut(&mut dyn FnMut() -> f32) -> Point3| {
            (0..count).map(|_| make(&mut next)).collect::<Vec<_>>()
        };
        let nan = f32::NAN;
        vec![
            ("none", Vec::new()),
            ("one", vec![Point3::ONE]),
            ("in a cube", cloud(700, &mut |u| Point3::new(u(), u(), u()))),
            ("many", cloud(9000, &mut |u| Point3::new(u(), u(), u() * u()))),
            ("on a line", cloud(300, &mut |u| Point3::new(0.5, u(), 0.5))),
            ("on a grid", cloud(600, &mut |u| Point3::new(u(), u(), u()).map(|x| (x * 4.0).floor() / 4.0))),
            ("in one point", vec![Point3::new(0.5, 0.2, 0.1); 100]),
            (
                "far apart",
                cloud(200, &mut |u| Point3::new(u(), u(), u()).map(|x| (1.0 / (x + 1e-6)).powi(4))),
            ),
            (
                "not all finite",
                cloud(300, &mut |u| {
                    let p = Point3::new(u(), u(), u());
                    match (u() * 6.0) as u32 {
                        0 => Point3 { x: nan, ..p },
                        1 => Point3 { y: f32::INFINITY, ..p },
                        2 => Point3 { z: f32::NEG_INFINITY, ..p },
                        _ => p,
                    }
                }),
            ),
        ]
    }

    #[test]
    fn queries_find_the_same_points_as_brute_force() {
        let mut random = Random::new(8);
        for (name, points) in clouds() {
            let (tree, order) = tree(&points);
            let mut kept = order.clone();
            kept.sort_unstable();
            let finite = (0..points.len() as u32).filter(|&i| points[i as usize].is_finite());
            assert_eq!(kept, finite.collect::<Vec<_>>(), "{name}");
            for trial in 0..150 {
                let p = match points.get(trial / 3) {
                    Some(p) if trial % 3 == 0 && p.is_finite() => *p,
                    _ => Point3::new(random.get_1d(), random.get_1d(), random.get_1d()) * 1.4 - 0.2,
                };
                let count = [0, 1, 2, 7, 50, 1000][trial % 6];
                let radius = [0.0, 0.01, 0.1, 0.3, 2.0, f32::INFINITY, 1e30][trial % 7];
                let accept = |i: u32| trial % 2 == 0 || i % 3 != 1;
                let mut expected: Vec<_> = (0..order.len() as u32)
                    .map(|index| {
                        let q = points[order[index as usize] as usize];
                        Neighbour { distance_squared: p.distance_squared(q), index }
                    })
                    .filter(|n| n.distance_squared <= radius * radius && accept(n.index))
                    .collect();
                expected.sort_unstable();
                expected.truncate(count);
                let mut found = tree.nearest(p, count, radius, accept);
                found.sort_unstable();
                assert_eq!(found, expected, "{name}, {count} nearest to {p} within {radius}");
            }
        }
    }

    #[test]
    fn the_tree_does_not_depend_on_threads() {
        let (_, points) = clouds().swap_remove(3);
        let build = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| tree(&points)).1
        };
        assert_eq!(build(1), build(7));
    }

    #[test]
    fn building_can_be_cancelled() {
        let (_, points) = clouds().swap_remove(3);
        let control = Control::default();
        control.cancel.store(true, std::sync::atomic::Ordering::Relaxed);
        assert!(KdTree::build(points.into_iter(), &control).is_err());
    }
}
