//! A balanced kd-tree of points, for the nearest ones to a place.
//!
//! The tree has no pointers: its points are one array, and the node of a range of it is the range's middle. All points before it
//! lie on one side of it along the node's axis, all behind it on the other; both halves are ranges again, down to short ones that are
//! looked through in order. Each range is cut across the longest side of its bounds. Halves are built in parallel; ties are broken by
//! the points' order, so that the tree depends on the points alone.
//!
//! The search goes to the nearer half first, and to the other one if its cell is not beyond the farthest of the neighbours that are kept, whose
//! distance the heap has at its top. A cell's distance is known from the planes that were crossed to get there. [Bentley 1975],
//! [Arya 1993]

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::ops::Range;

use math::{Bounds3, Point3, Vec3};

use crate::{Cancelled, Control};

/// Ranges of no more points have no node.
const LEAF: usize = 8;

/// Ranges of more points are built in parallel.
const PARALLEL: usize = 4096;

/// Points, arranged to be found.
#[derive(Debug, Default)]
pub(crate) struct KdTree {
    points: Vec<Point3>,
    /// For each point the axis that it cuts its range across, if it is a node.
    axes: Vec<u8>,
}

/// A point near the one that was asked about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Neighbour {
    /// Square of the distance.
    pub distance_squared: f32,
    /// Which of the tree's points.
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
    /// Of the points that are finite; and, in the order of the tree's points, which ones they were.
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

    /// Bytes that it takes.
    pub fn memory(&self) -> usize {
        size_of_val(&*self.points) + size_of_val(&*self.axes)
    }

    /// The nearest points to `p` that are no farther than `radius` and that `accept` takes, at most `count`, in no order.
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
        let found = BinaryHeap::with_capacity(count.min(self.points.len()));
        let mut search = Search { tree: self, p, count, limit: radius * radius, found, accept };
        search.visit(0..self.points.len(), Vec3::ZERO);
        search.found.into_vec()
    }
}

/// Puts the range's node into its middle, and what is on its sides to its sides.
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

/// A search on its way.
struct Search<'a, A> {
    tree: &'a KdTree,
    p: Point3,
    count: usize,
    /// Square of the distance beyond which nothing counts.
    limit: f32,
    /// The nearest so far, the farthest of them on top.
    found: BinaryHeap<Neighbour>,
    accept: A,
}

impl<A: Fn(u32) -> bool> Search<'_, A> {
    /// Looks through a range whose cell is `away` from the point along each axis.
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
