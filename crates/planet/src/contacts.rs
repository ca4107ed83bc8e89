//! Contacts of moving spheres, and what they do to velocities and places.
//!
//! Each round, every moving sphere takes the impulses of all its contacts at once, as velocities
//! were before the round. An impulse is weighted by one over the larger number of contacts of the
//! two spheres that change anything: so it counts the same for both, and momentum is kept. As a
//! sphere's weights sum to at most one, its new velocity is a mean of those after each impulse
//! alone, so that kinetic energy does not grow, because no single impulse makes it grow.

use math::{Point3, Vector3};

/// Of the speed of approach, what is left after a bounce.
const RESTITUTION: f32 = 0.45;
/// Slower spheres do not bounce, in metres per second.
const BOUNCE: f32 = 0.7;
/// The friction of rolling, as a share of the impulse along the normal.
const FRICTION: f32 = 0.12;
/// The depth in metres that is not corrected.
const SLOP: f32 = 0.002;

/// A sphere that another one may touch within a step.
#[derive(Clone, Copy, Debug)]
pub struct Contact {
    /// Who: the index of a body, or what moves it is not known to be one of.
    pub other: u32,
    /// The place among moving bodies of a sphere that moves, else [`Contact::FIXED`].
    pub partner: u32,
    /// From the other to this one, of unit length.
    pub normal: Vector3,
    /// The distance of the surfaces, which is below zero where they overlap.
    pub gap: f32,
    /// This one's share of changes: 1 at a sphere that does not give way.
    pub share: f32,
    /// The velocity of a sphere that does not give way.
    pub velocity: Vector3,
    /// Centre of it.
    pub center: Point3,
    /// The sum of the radii.
    pub reach: f32,
}

impl Contact {
    /// The partner of contacts with spheres that do not give way.
    pub const FIXED: u32 = u32::MAX;

    /// How fast both come closer, given both velocities.
    #[inline]
    pub fn approach(&self, velocity: Vector3, other: Vector3) -> f32 {
        -(velocity - other).dot(self.normal)
    }

    /// The change of this sphere's velocity by the contact alone, given both velocities, within
    /// `dt`.
    #[inline]
    pub fn impulse(&self, velocity: Vector3, other: Vector3, dt: f32) -> Vector3 {
        let relative = velocity - other;
        let approach = -relative.dot(self.normal);
        let room = self.gap.max(0.0) / dt;
        if approach <= room {
            return Vector3::ZERO;
        }
        // A sphere that bounces does so at once, another one moves on until both touch.
        let after = if approach > BOUNCE { RESTITUTION * approach } else { -room };
        let along = approach + after;
        let sliding = relative + self.normal * approach;
        let speed = sliding.length();
        let brake = if speed > 0.0 { (FRICTION * along / speed).min(1.0) } else { 0.0 };
        (self.normal * along - sliding * brake) * self.share
    }

    /// The motion that takes a share of an overlap away, given both centres.
    #[inline]
    pub fn separation(&self, center: Point3, other: Point3) -> Vector3 {
        let way = center - other;
        let distance = way.length();
        let depth = self.reach - distance - SLOP;
        if depth <= 0.0 || distance == 0.0 {
            return Vector3::ZERO;
        }
        way * (depth * self.share / distance)
    }
}
