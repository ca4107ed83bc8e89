//! The outline of a scene's surfaces as a camera sees it, and the place from which it fills a
//! frame.
//!
//! A point (x, y, z), with z the depth, is seen at most a slope s beside the axis of a camera at
//! (cx, cy, cz) if x − s z ≤ cx − s cz and −x − s z ≤ −cx − s cz. With A and B the largest left
//! sides of all points, the camera may be no deeper than cz = −(A + B)/(2 s), and is then at
//! cx = (A − B)/2; the same holds for y. So the points that matter are those with the largest
//! x − s z, and so on.

use description::{
    Arena, Handle, InstanceDesc, MeshDesc, ObjectDesc, SceneDesc, ShapeDesc, ShapeKind, TransformDesc,
};
use math::{DMat4, DVec3, Point3};

/// How something is looked at: right, up and forwards, as unit vectors.
pub(crate) type Axes = [DVec3; 3];

/// Slopes for which points are kept, on each side.
const STEPS: usize = 8;
/// Instances are nested to this depth.
const DEEPEST: usize = 8;
/// Instances of an object of more points than this together are taken for their boxes.
const MAX_POINTS: usize = 1 << 26;

/// The points at the outline of surfaces, while the shutter is open.
pub(crate) struct Outline {
    axes: Axes,
    /// The largest slopes to the side and upwards.
    slopes: [f64; 2],
    /// The largest value of each step, on both sides, and its point.
    best: [[(f64, DVec3); 2 * STEPS]; 2],
    /// Two corners of the box around all points.
    pub bounds: [DVec3; 2],
}

impl Outline {
    /// The outline of the triangles and patches of a scene; of other shapes there is none.
    pub fn of(desc: &SceneDesc, axes: Axes, slopes: [f64; 2]) -> Self {
        let mut outline = Self::empty(axes, slopes);
        outline.add_all(&desc.shapes, &desc.instances, &desc.objects, &[DMat4::IDENTITY], 0);
        outline
    }

    fn empty(axes: Axes, slopes: [f64; 2]) -> Self {
        let best = [[(f64::NEG_INFINITY, DVec3::ZERO); 2 * STEPS]; 2];
        Self { axes, slopes, best, bounds: [DVec3::INFINITY, DVec3::NEG_INFINITY] }
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.bounds[0].cmpgt(self.bounds[1]).any()
    }

    /// Adds the corners of a box.
    pub fn add_box(&mut self, [low, high]: [DVec3; 2], placements: &[DMat4]) {
        for corner in 0..8 {
            let pick = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
            let point = DVec3::new(pick(0), pick(1), pick(2));
            placements.iter().for_each(|placement| self.add(placement.transform_point3(point)));
        }
    }

    fn add(&mut self, point: DVec3) {
        if !point.is_finite() {
            return;
        }
        self.bounds = [self.bounds[0].min(point), self.bounds[1].max(point)];
        let [x, y, z] = self.axes.map(|axis| axis.dot(point));
        for ((across, slope), best) in [x, y].into_iter().zip(self.slopes).zip(&mut self.best) {
            for (step, best) in best.iter_mut().enumerate() {
                let side = if step % 2 == 0 { across } else { -across };
                let value = side - slope * (step / 2 + 1) as f64 / STEPS as f64 * z;
                if value > best.0 {
                    *best = (value, point);
                }
            }
        }
    }

    fn add_all(
        &mut self,
        shapes: &Arena<ShapeDesc>,
        instances: &Arena<InstanceDesc>,
        objects: &Arena<ObjectDesc>,
        placements: &[DMat4],
        depth: usize,
    ) {
        for (_, shape) in shapes.iter() {
            let placements = joined(placements, &shape.world_from_object);
            match &shape.kind {
                ShapeKind::Triangles(mesh) => self.add_mesh(mesh, &placements),
                ShapeKind::PlyMesh { triangles, patches, .. } => {
                    self.add_mesh(triangles, &placements);
                    self.add_corners(patches.indices.as_flattened(), &patches.positions, &placements);
                }
                _ => (),
            }
        }
        if depth == DEEPEST {
            return;
        }
        let mut counts = vec![0_usize; objects.len()];
        instances.iter().for_each(|(_, instance)| counts[instance.object.index()] += 1);
        for (index, count) in counts.into_iter().enumerate().filter(|&(_, count)| count > 0) {
            let handle = Handle::new(index as u32);
            let ObjectDesc { shapes, instances: inside, .. } = &objects[handle];
            let of_object = instances.iter().filter(|(_, instance)| instance.object == handle);
            let whole = (count.saturating_mul(point_count(shapes)) > MAX_POINTS).then(|| {
                let mut outline = Self::empty(self.axes, self.slopes);
                outline.add_all(shapes, inside, objects, &[DMat4::IDENTITY], depth + 1);
                outline
            });
            for (_, instance) in of_object {
                let placements = joined(placements, &instance.world_from_object);
                match &whole {
                    Some(whole) if whole.is_empty() => (),
                    Some(whole) => self.add_box(whole.bounds, &placements),
                    None => self.add_all(shapes, inside, objects, &placements, depth + 1),
                }
            }
        }
    }

    fn add_mesh(&mut self, mesh: &MeshDesc, placements: &[DMat4]) {
        let keys = std::iter::once(&mesh.positions).chain(mesh.later.iter().map(|key| &key.positions));
        keys.for_each(|positions| self.add_corners(mesh.indices.as_flattened(), positions, placements));
    }

    /// Adds those of positions that indices refer to.
    fn add_corners(&mut self, indices: &[u32], positions: &[Point3], placements: &[DMat4]) {
        let mut is_used = vec![false; positions.len()];
        indices.iter().for_each(|&index| is_used[index as usize] = true);
        for position in positions.iter().zip(is_used).filter_map(|(position, used)| used.then_some(position))
        {
            placements.iter().for_each(|at| self.add(at.transform_point3(position.as_dvec3())));
        }
    }

    /// The place of a camera from which the points are between the slopes, exactly for one pair
    /// of sides, and in the middle of the other; and the slopes at which they are seen.
    pub fn eye(mut self) -> (DVec3, [f64; 2]) {
        let [low, high] = self.bounds;
        let least = 1e-6 * (1.0 + low.abs().max(high.abs()).max_element());
        if (high - low).max_element() < least {
            self.add_box([low - least, high + least], &[DMat4::IDENTITY]);
        }
        // The largest of across − slope·z to the one and to the other side.
        let sides = |axis: usize, slope: f64| {
            let points = self.best[axis].iter().map(|(_, point)| self.axes.map(|axis| axis.dot(*point)));
            points.fold([f64::NEG_INFINITY; 2], |[a, b], point| {
                [a.max(point[axis] - slope * point[2]), b.max(-point[axis] - slope * point[2])]
            })
        };
        let depth = |axis: usize, slope: f64| {
            let [a, b] = sides(axis, slope);
            -(a + b) / (2.0 * slope)
        };
        let deepest = depth(0, self.slopes[0]).min(depth(1, self.slopes[1]));
        let across = [0, 1].map(|axis| {
            // The slopes on both sides are the same where the outline is in the middle.
            let [mut low, mut high] = [0.0, self.slopes[axis]];
            for _ in 0..50 {
                let middle = (low + high) / 2.0;
                if depth(axis, middle) < deepest { low = middle } else { high = middle }
            }
            let [a, b] = sides(axis, high);
            ((a - b) / 2.0, high)
        });
        let ([right, up, forwards], [(x, width), (y, height)]) = (self.axes, across);
        (x * right + y * up + deepest * forwards, [width, height])
    }
}

/// Placements within others, at the start and at the end of a motion.
fn joined(outer: &[DMat4], inner: &TransformDesc) -> Vec<DMat4> {
    let ends = if inner.is_animated() { &[inner.start, inner.end][..] } else { &[inner.start] };
    outer.iter().flat_map(|outer| ends.iter().map(move |inner| *outer * *inner)).collect()
}

/// About how many points the shapes of an object have.
fn point_count(shapes: &Arena<ShapeDesc>) -> usize {
    let count = |shape: &ShapeDesc| match &shape.kind {
        ShapeKind::Triangles(mesh) | ShapeKind::PlyMesh { triangles: mesh, .. } => mesh.positions.len(),
        _ => 0,
    };
    shapes.iter().map(|(_, shape)| count(shape)).sum()
}
