//! Who walks on a planet.

use math::{Point3, Vector3};

use crate::{Mover, Planet, Viewpoint};

/// The radius of the walker's body in metres, the height of its centre when it stands, and that of
/// the eyes.
const RADIUS: f32 = 0.4;
const EYES: f32 = 1.6;
/// In metres per second.
const WALK: f32 = 3.0;
const RUN: f32 = 7.0;
const JUMP: f32 = 5.5;
/// How steep ground may be to be stood on, as the cosine of its slope.
const STEEPEST: f32 = 0.45;

/// What a walker is told to do during a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Input {
    /// Forward, from −1 to 1.
    pub forward: f32,
    /// To the right, from −1 to 1.
    pub right: f32,
    /// Whether to run.
    pub runs: bool,
    /// Whether to jump, from the ground.
    pub jumps: bool,
}

/// A person: a ball that slides over the ground, with eyes above it.
#[derive(Clone, Debug)]
pub struct Walker {
    center: Point3,
    velocity: Vector3,
    forward: Vector3,
    /// Angle of view above the horizontal, in radians.
    tilt: f32,
    stands: bool,
}

impl Walker {
    /// Over a meadow, and about to land there.
    pub fn new(planet: &Planet) -> Self {
        let center = planet.landing();
        let forward = planet.up(center).cross(Vector3::X).normalize_or(Vector3::Y);
        Self { center, velocity: Vector3::ZERO, forward, tilt: -0.08, stands: false }
    }

    /// Where the eyes are.
    pub fn eyes(&self, planet: &Planet) -> Point3 {
        self.center + planet.up(self.center) * (EYES - RADIUS)
    }

    /// Upwards, as a unit vector.
    pub fn up(&self, planet: &Planet) -> Vector3 {
        planet.up(self.center)
    }

    /// Where it looks, as a unit vector.
    pub fn gaze(&self, planet: &Planet) -> Vector3 {
        let (sin, cos) = lanes::sin_cos(self.tilt);
        self.forward * cos + self.up(planet) * sin
    }

    /// The centre of its body.
    pub fn center(&self) -> Point3 {
        self.center
    }

    /// Its body, for which others make way.
    pub fn body(&self) -> Mover {
        Mover { center: self.center, radius: RADIUS, velocity: self.velocity }
    }

    /// Whether there is ground under it.
    pub fn stands(&self) -> bool {
        self.stands
    }

    /// What it sees.
    pub fn viewpoint(&self, planet: &Planet) -> Viewpoint {
        Viewpoint { eyes: self.eyes(planet), gaze: self.gaze(planet), up: self.up(planet), fov: 62.0 }
    }

    /// Turns to the right, and looks up, by angles in radians.
    pub fn turn(&mut self, planet: &Planet, right: f32, up: f32) {
        let (sin, cos) = lanes::sin_cos(right);
        let side = self.forward.cross(planet.up(self.center));
        self.forward = (self.forward * cos + side * sin).normalize_or(self.forward);
        self.tilt = (self.tilt + up).clamp(-1.5, 1.5);
    }

    /// Moves for a time in seconds.
    pub fn step(&mut self, planet: &Planet, input: &Input, dt: f32) {
        let up = planet.up(self.center);
        let side = self.forward.cross(up);
        let way = self.forward * input.forward + side * input.right;
        let speed = if input.runs { RUN } else { WALK };
        let wanted = way.normalize_or_zero() * (speed * way.length().min(1.0));
        let rise = self.velocity.dot(up);
        let along = self.velocity - up * rise;
        // On the ground steps follow at once what is wanted, in the air hardly.
        let grip = if self.stands { (12.0 * dt).min(1.0) } else { (1.5 * dt).min(1.0) };
        let rise = if input.jumps && self.stands { JUMP } else { rise };
        self.velocity = along + (wanted - along) * grip + up * rise + planet.gravity(self.center) * dt;
        self.center += self.velocity * dt;
        self.stands = false;
        for _ in 0..4 {
            self.leave_overlaps(planet);
        }
        let up = planet.up(self.center);
        let level = self.forward - up * self.forward.dot(up);
        self.forward = level.normalize_or(side.cross(up));
    }

    /// Leaves the deepest of the spheres that do not give way.
    fn leave_overlaps(&mut self, planet: &Planet) {
        let mut deepest = (0.0, Vector3::ZERO);
        planet.firm_around(self.center, RADIUS, |center, radius| {
            let way = self.center - center;
            let depth = radius + RADIUS - way.length();
            if depth > deepest.0 {
                deepest = (depth, way.normalize_or(planet.up(self.center)));
            }
        });
        let (depth, normal) = deepest;
        if depth <= 0.0 {
            return;
        }
        self.center += normal * depth;
        self.velocity -= normal * self.velocity.dot(normal).min(0.0);
        self.stands |= normal.dot(planet.up(self.center)) > STEEPEST;
    }
}
