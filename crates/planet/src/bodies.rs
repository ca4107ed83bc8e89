//! The spheres of a planet, in columns.

use std::ops::Range;

use math::{Point3, Vector3};

use crate::Substance;

/// Whether a sphere moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// It is a part of the land, until it is torn off.
    Held,
    /// It is loose, and lies still.
    Resting,
    /// It is loose, and moves.
    Moving,
}

/// The spheres of a planet, ordered by substance. The first is the core, around the origin.
#[derive(Clone, Debug, Default)]
pub struct Bodies {
    /// Their centres, in metres.
    pub center: Vec<Point3>,
    /// Their radii, in metres.
    pub radius: Vec<f32>,
    /// Their velocities, in metres per second.
    pub velocity: Vec<Vector3>,
    /// Whether they move.
    pub state: Vec<State>,
    substance: Vec<Substance>,
}

impl Bodies {
    /// Spheres with their substance, at rest.
    pub(crate) fn new(spheres: impl IntoIterator<Item = (Substance, Point3, f32, State)>) -> Self {
        let mut spheres: Vec<_> = spheres.into_iter().collect();
        spheres.sort_by_key(|sphere| sphere.0);
        let mut bodies = Self::default();
        for (substance, center, radius, state) in spheres {
            bodies.substance.push(substance);
            bodies.center.push(center);
            bodies.radius.push(radius);
            bodies.velocity.push(Vector3::ZERO);
            bodies.state.push(state);
        }
        bodies
    }

    /// The number of spheres.
    pub fn len(&self) -> usize {
        self.center.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.center.is_empty()
    }

    /// What a sphere is made of.
    pub fn substance(&self, body: usize) -> Substance {
        self.substance[body]
    }

    /// The spheres of a substance.
    pub fn range(&self, substance: Substance) -> Range<usize> {
        let begin = self.substance.partition_point(|other| *other < substance);
        let end = self.substance.partition_point(|other| *other <= substance);
        begin..end
    }

    /// The mass of a sphere, relative to that of one with a radius of a metre.
    pub fn mass(&self, body: usize) -> f32 {
        let radius = self.radius[body];
        radius * radius * radius
    }
}
