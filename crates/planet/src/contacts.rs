//! Contacts of moving spheres, and what they do to velocities and places.
//!
//! Each round, every moving sphere takes the impulses of all its contacts at once, as velocities
//! were before the round. An impulse is weighted by one over the larger number of contacts of the
//! two spheres that change anything: so it counts the same for both, and momentum is kept. As a
//! sphere's weights sum to at most one, its new velocity is a mean of those after each impulse
//! alone, so that kinetic energy does not grow, because no single impulse makes it grow.

use lanes::{MAX_LANES, Real};
use math::{Point3, Vec3, Vector3};

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
    /// The place of the other one's vector, else [`Contact::FIXED`].
    pub partner: u32,
    /// From the other to this one, of unit length.
    pub normal: Vector3,
    /// How fast both may come closer without touching within the step.
    pub room: f32,
    /// This one's share of changes: 1 at a sphere that does not give way.
    pub share: f32,
    /// The centre of a sphere that is fixed.
    pub center: Point3,
    /// The sum of the radii.
    pub reach: f32,
}

impl Contact {
    /// The partner of contacts with spheres that stay where they are.
    pub const FIXED: u32 = u32::MAX;
}

/// A contact of each of as many spheres as a vector has lanes, in columns.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub struct Row {
    pub partner: [u32; MAX_LANES],
    normal: [[f32; MAX_LANES]; 3],
    room: [f32; MAX_LANES],
    share: [f32; MAX_LANES],
    center: [[f32; MAX_LANES]; 3],
    reach: [f32; MAX_LANES],
}

impl Row {
    /// Contacts that change nothing.
    pub const NONE: Self = Self {
        partner: [Contact::FIXED; MAX_LANES],
        normal: [[0.0; MAX_LANES]; 3],
        room: [f32::INFINITY; MAX_LANES],
        share: [0.0; MAX_LANES],
        center: [[0.0; MAX_LANES]; 3],
        reach: [f32::NEG_INFINITY; MAX_LANES],
    };

    /// Replaces a contact.
    pub fn set(&mut self, lane: usize, contact: &Contact) {
        let Contact { partner, normal, room, share, center, reach } = *contact;
        self.partner[lane] = partner;
        for axis in 0..3 {
            self.normal[axis][lane] = normal[axis];
            self.center[axis][lane] = center[axis];
        }
        (self.room[lane], self.share[lane], self.reach[lane]) = (room, share, reach);
    }
}

/// What contacts change: a vector of each sphere.
pub trait Change: Copy + Sync {
    /// The vectors of spheres that are fixed, of lanes of a row from one on.
    fn fixed<R: Real>(self, row: &Row, from: usize) -> Vec3<R>;

    /// Which contacts change a sphere's vector, and how each does alone, given both vectors.
    fn of<R: Real>(self, row: &Row, from: usize, own: Vec3<R>, other: Vec3<R>) -> (R::Mask, Vec3<R>);
}

/// Impulses, which change velocities.
#[derive(Clone, Copy, Debug)]
pub struct Impulses;

impl Change for Impulses {
    #[inline(always)]
    fn fixed<R: Real>(self, _: &Row, _: usize) -> Vec3<R> {
        Vec3::splat(R::zero())
    }

    #[inline(always)]
    fn of<R: Real>(self, row: &Row, from: usize, own: Vec3<R>, other: Vec3<R>) -> (R::Mask, Vec3<R>) {
        let (normal, room) = (columns(&row.normal, from), R::load(&row.room[from..]));
        let relative = own - other;
        let approach = -relative.dot(normal);
        // A sphere that bounces does so at once, another one moves on until both touch.
        let bounces = approach.gt(R::splat(BOUNCE));
        let after = R::select(bounces, R::splat(RESTITUTION) * approach, -room);
        let along = approach + after;
        let sliding = relative + normal * approach;
        let speed = sliding.length();
        let brake = (R::splat(FRICTION) * along / speed).min(R::one());
        let brake = R::select(speed.gt(R::zero()), brake, R::zero());
        (approach.gt(room), (normal * along - sliding * brake) * R::load(&row.share[from..]))
    }
}

/// Motions that take a share of overlaps away, which change centres.
#[derive(Clone, Copy, Debug)]
pub struct Separations;

impl Change for Separations {
    #[inline(always)]
    fn fixed<R: Real>(self, row: &Row, from: usize) -> Vec3<R> {
        columns(&row.center, from)
    }

    #[inline(always)]
    fn of<R: Real>(self, row: &Row, from: usize, own: Vec3<R>, other: Vec3<R>) -> (R::Mask, Vec3<R>) {
        let way = own - other;
        let distance = way.length();
        let depth = R::load(&row.reach[from..]) - distance - R::splat(SLOP);
        let overlaps = depth.gt(R::zero()) & distance.gt(R::zero());
        (overlaps, way * (depth * R::load(&row.share[from..]) / distance))
    }
}

#[inline(always)]
fn columns<R: Real>([x, y, z]: &[[f32; MAX_LANES]; 3], from: usize) -> Vec3<R> {
    Vec3::new(R::load(&x[from..]), R::load(&y[from..]), R::load(&z[from..]))
}
