//! Planes that split space, and the clipping of primitives that straddle them.
//!
//! A triangle is clipped at the plane, and each part bounded, within the box that the reference had
//! before; of other primitives the box is clipped. The point where an edge of a triangle crosses
//! the plane is rounded, and the box is widened by the error, so that no part of the triangle is
//! outside of both boxes.

use super::reference::{Extent, Reference, in_parts};
use super::tree::Blocks;
use math::{Vec3, Vec4, gamma};

/// Intervals along each axis at whose borders planes are tried.
const INTERVALS: usize = 16;

/// The corners of a reference to a triangle; `None` for other primitives.
pub(crate) trait Corners: Fn(&Reference) -> Option<[Vec3; 3]> + Sync + Send {}

impl<T: Fn(&Reference) -> Option<[Vec3; 3]> + Sync + Send> Corners for T {}

/// A plane perpendicular to an axis.
pub(super) struct Plane {
    axis: usize,
    at: f32,
    /// As [`super::bins::ObjectSplit::cost`].
    pub cost: f32,
    /// The box and the number of the references on either side.
    sides: [(Extent, u32); 2],
}

impl Plane {
    /// The cheapest plane through a set with the box `extent`; `None` where no plane has a finite
    /// cost.
    pub fn best(
        references: &[Reference],
        extent: &Extent,
        corners: &impl Corners,
        blocks: Blocks,
    ) -> Option<Self> {
        let grid = Grid::new(extent);
        let serial = |part: &[Reference]| Intervals::of(part, &grid, corners);
        in_parts(references, serial, Intervals::merge).cheapest(&grid, blocks)
    }

    /// The cheaper side (0 left, 1 right) for a primitive across the plane that goes to one side
    /// alone, and whether that costs less than both sides.
    pub fn one_side(&self, r: &Reference) -> (usize, bool) {
        let cost = |(extent, count): (Extent, u32)| extent.half_area() * count as f32;
        let alone = |side: usize| {
            let [(here, n), (there, m)] = [self.sides[side], self.sides[1 - side]];
            cost((here.union(r.extent()), n)) + cost((there, m - 1))
        };
        let (left, right) = (alone(0), alone(1));
        let both = cost(self.sides[0]) + cost(self.sides[1]);
        ((right < left) as usize, left.min(right) < both)
    }

    /// The parts of a primitive to the left and to the right.
    pub fn split(&self, r: &Reference, corners: &impl Corners) -> [Option<Reference>; 2] {
        if r.extent().high()[self.axis] <= self.at {
            return [Some(*r), None];
        }
        if r.extent().low()[self.axis] >= self.at {
            return [None, Some(*r)];
        }
        let [left, right] = cut(r, corners(r), self.axis, self.at);
        match (left.is_empty(), right.is_empty()) {
            (true, true) => [Some(*r), None],
            (left_is_empty, right_is_empty) => {
                [(!left_is_empty).then(|| r.within(left)), (!right_is_empty).then(|| r.within(right))]
            }
        }
    }
}

/// The boxes of the parts of a reference on both sides of a plane.
fn cut(r: &Reference, corners: Option<[Vec3; 3]>, axis: usize, at: f32) -> [Extent; 2] {
    let whole = r.extent();
    let [left, right] = [whole.below(axis, at), whole.above(axis, at)];
    let Some(corners) = corners else { return [left, right] };
    let mut around = [Extent::EMPTY; 2];
    for i in 0..3 {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        for (side, is_here) in around.iter_mut().zip([a[axis] <= at, a[axis] >= at]) {
            if is_here {
                *side = side.union(Extent::point(a.extend(0.0)));
            }
        }
        if (a[axis] < at) != (b[axis] < at) {
            let t = ((at - a[axis]) / (b[axis] - a[axis])).clamp(0.0, 1.0);
            let p = a + (b - a) * t;
            let error = (a.abs() + b.abs()) * gamma(4);
            let crossing =
                Extent::point((p - error).extend(0.0)).union(Extent::point((p + error).extend(0.0)));
            around = around.map(|side| side.union(crossing));
        }
    }
    [left.intersection(around[0]), right.intersection(around[1])]
}

/// Where the intervals of a box lie.
struct Grid {
    low: Vec4,
    width: Vec4,
    scale: Vec4,
}

impl Grid {
    fn new(extent: &Extent) -> Self {
        let width = (extent.high() - extent.low()) / INTERVALS as f32;
        let scale = width.recip();
        let scale = Vec4::select(scale.is_finite_mask(), scale, Vec4::ZERO);
        Self { low: extent.low(), width, scale }
    }

    fn interval(&self, at: Vec4, axis: usize) -> usize {
        (((at[axis] - self.low[axis]) * self.scale[axis]) as usize).min(INTERVALS - 1)
    }

    /// Where an interval begins.
    fn border(&self, interval: usize, axis: usize) -> f32 {
        self.low[axis] + self.width[axis] * interval as f32
    }
}

/// For each axis and interval, the box around the parts in it, and the numbers of references that
/// begin and end there.
struct Intervals {
    boxes: [[Extent; INTERVALS]; 3],
    begin: [[u32; INTERVALS]; 3],
    end: [[u32; INTERVALS]; 3],
}

impl Intervals {
    fn of(references: &[Reference], grid: &Grid, corners: &impl Corners) -> Self {
        let mut all = Self {
            boxes: [[Extent::EMPTY; INTERVALS]; 3],
            begin: [[0; INTERVALS]; 3],
            end: [[0; INTERVALS]; 3],
        };
        for r in references {
            let corners = corners(r);
            for axis in 0..3 {
                let first = grid.interval(r.extent().low(), axis);
                let last = grid.interval(r.extent().high(), axis).max(first);
                all.begin[axis][first] += 1;
                all.end[axis][last] += 1;
                let mut rest = *r;
                for interval in first..last {
                    let [left, right] = cut(&rest, corners, axis, grid.border(interval + 1, axis));
                    all.boxes[axis][interval] = all.boxes[axis][interval].union_unless_empty(left);
                    rest = r.within(right);
                }
                all.boxes[axis][last] = all.boxes[axis][last].union_unless_empty(rest.extent());
            }
        }
        all
    }

    fn merge(mut self, other: Self) -> Self {
        for axis in 0..3 {
            for i in 0..INTERVALS {
                self.boxes[axis][i] = self.boxes[axis][i].union(other.boxes[axis][i]);
                self.begin[axis][i] += other.begin[axis][i];
                self.end[axis][i] += other.end[axis][i];
            }
        }
        self
    }

    fn cheapest(&self, grid: &Grid, blocks: Blocks) -> Option<Plane> {
        let mut best: Option<Plane> = None;
        for axis in 0..3 {
            let around = |boxes: &[Extent]| boxes.iter().fold(Extent::EMPTY, |all, &b| all.union(b));
            for i in 1..INTERVALS {
                let (left, right) = self.boxes[axis].split_at(i);
                let begun = self.begin[axis][..i].iter().sum();
                let ended = self.end[axis][i..].iter().sum();
                let sides = [(around(left), begun), (around(right), ended)];
                let cost = sides.map(|(extent, n)| extent.half_area() * blocks.count(n) as f32).iter().sum();
                // NaN, of an empty side, is never cheaper.
                if cost < best.as_ref().map_or(f32::INFINITY, |b| b.cost) {
                    best = Some(Plane { axis, at: grid.border(i, axis), cost, sides });
                }
            }
        }
        best
    }
}
