//! The exit pupil: the part of the rear lens through which a point of the film sees the scene.
//!
//! A lens system is symmetric about its axis, so that the pupil of a film point depends on its
//! distance from the axis alone: rectangles are computed for intervals of that distance, for film
//! points on the x axis, and turned with the film point. They lie in the plane of the rear vertex.
//! A grid of rays over the rear lens finds the pupil of each distance, and finer grids over what
//! the last one found enclose it. The rectangle of an interval covers the pupils at both its ends
//! and in its middle. [Pharr 2023 §5.4.4]
//!
//! A stop of another shape than a disk is not symmetric, yet its rectangles are turned as well, and
//! have the margin of pbrt-v4: parts of the shape are cut off where the film point is not on the x
//! axis, as they are in its pictures.

use super::lens::{Apertures, LensRay, LensSystem};
use math::{Bounds2, DVec3, Vec2};
use rayon::prelude::*;

/// The number of intervals of the distance from the axis.
const INTERVALS: usize = 64;

/// The rectangles of all film points.
#[derive(Clone, Debug)]
pub(super) struct ExitPupils {
    /// `None` where nothing passes.
    rectangles: Vec<Option<Bounds2>>,
    /// The greatest distance of a film point from the axis.
    radius: f32,
}

impl ExitPupils {
    /// The pupils of a film whose corners have the distance `radius` from the axis.
    pub fn new(lens: &LensSystem, radius: f32) -> Self {
        let places = 2 * INTERVALS;
        let distance = |i: usize| f64::from(radius) * i as f64 / places as f64;
        let pupils: Vec<_> = (0..=places).into_par_iter().map(|i| pupil(lens, distance(i))).collect();
        let rectangles = (0..INTERVALS)
            .map(|i| pupils[2 * i..=2 * i + 2].iter().flatten().copied().reduce(union))
            .collect();
        Self { rectangles, radius }
    }

    /// The rectangles of equal intervals of the distance from the axis.
    pub fn rectangles(&self) -> &[Option<Bounds2>] {
        &self.rectangles
    }

    /// The greatest distance of a film point from the axis.
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// Whether nothing passes the lens.
    pub fn are_empty(&self) -> bool {
        self.rectangles.iter().all(Option::is_none)
    }

    /// The rectangle of film points at a distance from the axis, for one on the positive x axis.
    pub fn at(&self, distance: f32) -> Option<Bounds2> {
        let interval = (distance / self.radius * INTERVALS as f32) as usize;
        self.rectangles[interval.min(INTERVALS - 1)]
    }
}

/// The rectangle around the pupil of the film point (x, 0).
fn pupil(lens: &LensSystem, x: f64) -> Option<Bounds2> {
    // The plane of the rear vertex is not that of the rear lens's border.
    let reach = 1.5 * lens.rear_radius() as f32;
    let all = Bounds2::new(Vec2::splat(-reach), Vec2::splat(reach));
    let coarse = [32, 128, 512].into_iter().find_map(|n| passing(lens, x, all, n))?;
    let fine = passing(lens, x, coarse, 48)?;
    if lens.has_mask() {
        let finest = passing(lens, x, fine, 256)?;
        let margin = 2.0 * all.diagonal().length() / 1024.0;
        return Some(Bounds2 { min: finest.min - margin, max: finest.max + margin });
    }
    passing(lens, x, fine, 64)
}

/// The rectangle around those points of a grid of n × n over `within` through which the film point
/// (x, 0) sees the scene, with a margin of the grid's spacing.
fn passing(lens: &LensSystem, x: f64, within: Bounds2, n: u32) -> Option<Bounds2> {
    let film = DVec3::new(x, 0.0, 0.0);
    let spacing = within.diagonal() / n as f32;
    let mut found: Option<Bounds2> = None;
    for i in 0..n * n {
        let p = within.min + spacing * (Vec2::new((i % n) as f32, (i / n) as f32) + 0.5);
        if found.is_some_and(|found| found.contains(p)) {
            continue;
        }
        let d = (DVec3::new(f64::from(p.x), f64::from(p.y), lens.rear_z()) - film).normalize();
        if lens.trace_from_film(LensRay { o: film, d }, Apertures::Closed).is_some() {
            let point = Bounds2 { min: p, max: p };
            found = Some(found.map_or(point, |found| union(found, point)));
        }
    }
    found.map(|found| Bounds2 { min: found.min - spacing, max: found.max + spacing })
}

fn union(a: Bounds2, b: Bounds2) -> Bounds2 {
    Bounds2 { min: a.min.min(b.min), max: a.max.max(b.max) }
}
