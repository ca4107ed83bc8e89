//! Majorants along rays: upper bounds of the extinction, constant over each segment.
//!
//! A medium within a box has a coarse grid of the largest density in each cell, and a ray visits
//! the cells that it crosses one by one [Amanatides 1987; Pharr 2023 §11.4.2]. Where the grid says
//! that a cell is empty, the ray has no segment.

use math::{Bounds3, Point3, Ray, Transform, Vec3};
use spectrum::SampledSpectrum;

/// A part of a ray with a constant majorant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Where it begins and ends. Segments of a ray do not overlap.
    pub t: [f32; 2],
    /// At least the extinction anywhere on it, per unit of length.
    pub majorant: SampledSpectrum,
}

/// The position of a medium's box.
#[derive(Clone, Debug)]
pub struct Placement {
    unit_from_render: Transform,
}

impl Placement {
    /// From render space to the unit cube, which is the box.
    pub fn new(unit_from_render: Transform) -> Self {
        Self { unit_from_render }
    }

    /// From render space to the unit cube, which is the box.
    pub fn unit_from_render(&self) -> &Transform {
        &self.unit_from_render
    }

    /// Bounds of the box.
    pub(super) fn bounds(&self) -> Bounds3 {
        self.unit_from_render.inverse().bounds(&Bounds3::new(Vec3::ZERO, Vec3::ONE))
    }

    /// A point in the coordinates of the unit cube; `None` outside.
    #[inline]
    pub(super) fn point(&self, p: Point3) -> Option<Point3> {
        let p = self.unit_from_render.affine_point(p);
        let is_inside = p.x.min(p.y).min(p.z) >= 0.0 && p.x.max(p.y).max(p.z) <= 1.0;
        is_inside.then_some(p)
    }
}

/// The largest densities in the cells of a regular grid over a medium's box.
#[derive(Clone, Debug)]
pub struct MajorantGrid {
    resolution: [usize; 3],
    /// x fastest.
    values: Vec<f32>,
}

impl MajorantGrid {
    /// The bound of the whole box in one cell.
    pub fn uniform(largest: f32) -> Self {
        Self { resolution: [1; 3], values: vec![largest] }
    }

    /// Of a medium with this many values along each axis. `largest` returns an upper bound of the
    /// density within a box in the unit cube.
    pub fn new(values: [usize; 3], largest: impl Fn(Bounds3) -> f32) -> Self {
        // Cells of a few values bound well; more of them cost steps and memory.
        const VALUES_PER_CELL: usize = 4;
        const MOST_CELLS: usize = 64;
        let resolution = values.map(|n| n.div_ceil(VALUES_PER_CELL).clamp(1, MOST_CELLS));
        let [nx, ny, nz] = resolution;
        let size = Vec3::from_array(resolution.map(|n| n as f32)).recip();
        let mut values = Vec::with_capacity(nx * ny * nz);
        for z in 0..nz {
            for y in 0..ny {
                for x in 0..nx {
                    let low = Vec3::from_array([x, y, z].map(|i| i as f32));
                    values.push(largest(Bounds3::new(low * size, (low + Vec3::ONE) * size)));
                }
            }
        }
        Self { resolution, values }
    }

    /// The numbers of cells in x, y and z.
    pub fn resolution(&self) -> [usize; 3] {
        self.resolution
    }

    /// The bound of each cell, x fastest.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// The majorants on a ray up to `t_max`; `per_density` is the extinction where the density is
    /// 1.
    pub(super) fn along(
        &self,
        placement: &Placement,
        ray: &Ray,
        t_max: f32,
        per_density: SampledSpectrum,
    ) -> Majorants<'_> {
        let ray = placement.unit_from_render.ray(ray);
        let cube = Bounds3::new(Vec3::ZERO, Vec3::ONE);
        let Some((t, t_end)) = cube.intersect(&ray, t_max) else { return Majorants(State::Done) };
        let entry = ray.at(t);
        let mut cells =
            Cells { grid: self, per_density, t, t_end, next: [0.0; 3], delta: [0.0; 3], cell: [0; 3] };
        for axis in 0..3 {
            let n = self.resolution[axis];
            let cell = ((entry[axis] * n as f32).max(0.0) as usize).min(n - 1);
            cells.cell[axis] = cell;
            // The sign of delta is that of the step.
            cells.delta[axis] = 1.0 / (ray.d[axis] * n as f32);
            let wall = if ray.d[axis] > 0.0 { cell + 1 } else { cell } as f32 / n as f32;
            cells.next[axis] =
                if ray.d[axis] == 0.0 { f32::INFINITY } else { t + (wall - entry[axis]) / ray.d[axis] };
        }
        Majorants(State::Cells(cells))
    }
}

/// The segments of a ray, in order. Between them there is nothing.
pub struct Majorants<'a>(State<'a>);

enum State<'a> {
    Done,
    One(Segment),
    Cells(Cells<'a>),
}

/// The cells of a grid along a ray.
struct Cells<'a> {
    grid: &'a MajorantGrid,
    per_density: SampledSpectrum,
    /// Where the ray enters the cell.
    t: f32,
    t_end: f32,
    /// Where it leaves the cell across each axis.
    next: [f32; 3],
    /// From one cell to the next across each axis, negative against the axis.
    delta: [f32; 3],
    cell: [usize; 3],
}

impl Cells<'_> {
    /// The density bound of the cell and its end; moves on to the next cell, if there is one.
    fn step(&mut self) -> (f32, f32, bool) {
        let [nx, ny, _] = self.grid.resolution;
        let [x, y, z] = self.cell;
        let density = self.grid.values[(z * ny + y) * nx + x];
        let [a, b, c] = self.next;
        let axis = if a <= b && a <= c {
            0
        } else if b <= c {
            1
        } else {
            2
        };
        let end = self.next[axis].clamp(self.t, self.t_end);
        let goes_on = self.next[axis] < self.t_end;
        self.next[axis] += self.delta[axis].abs();
        let cell = &mut self.cell[axis];
        let next = if self.delta[axis] > 0.0 { Some(*cell + 1) } else { cell.checked_sub(1) };
        match next.filter(|&next| goes_on && next < self.grid.resolution[axis]) {
            Some(next) => *cell = next,
            None => return (density, end, false),
        }
        (density, end, true)
    }
}

impl Majorants<'_> {
    /// One segment.
    pub(super) fn one(segment: Segment) -> Self {
        Self(State::One(segment))
    }
}

impl Iterator for Majorants<'_> {
    type Item = Segment;

    fn next(&mut self) -> Option<Segment> {
        loop {
            match &mut self.0 {
                State::Done => return None,
                State::One(segment) => {
                    let segment = *segment;
                    self.0 = State::Done;
                    return Some(segment);
                }
                State::Cells(cells) => {
                    let (start, (density, end, goes_on)) = (cells.t, cells.step());
                    cells.t = end;
                    let segment = Segment { t: [start, end], majorant: cells.per_density * density };
                    if !goes_on {
                        self.0 = State::Done;
                    }
                    if density > 0.0 && end > start {
                        return Some(segment);
                    }
                }
            }
        }
    }
}
