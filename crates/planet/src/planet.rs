//! A planet that moves: gravity, collisions, rest.

use lanes::InstructionSet;
use math::{Frame, Point3, Vec3, Vector3};
use rayon::prelude::*;

use crate::Substance;
use crate::bodies::{Bodies, State};
use crate::contacts::{Contact, Impulses, Separations};
use crate::grid::{Entry, Grid, Near, Query};
use crate::land::{Land, MOON, core_radius};
use crate::rounds::{CHUNK, Contacts, Vectors, first_constant};

/// Gravity, in metres per second squared: the same at all heights, so that nothing escapes.
const GRAVITY: f32 = 9.0;
/// The pull of the moon where it is strongest: on the ground below it. Nearer to the moon it grows
/// weaker, unlike Newton's, so that balls are lifted, but not kept.
const PULL: f32 = 16.0;
/// By how much farther or nearer the moon has no pull, as a share of its distance from the ground.
const PULL_RANGE: f32 = 0.5;
/// The time in which the moon goes around the planet, in seconds.
const MONTH: f32 = 30.0;
/// The largest speed in metres per second.
const FASTEST: f32 = 14.0;
/// Spheres within this distance of each other are in contact, as well as those that come closer
/// within a step.
const NEAR: f32 = 0.01;
/// A resting sphere that is touched at this speed moves.
const WAKE: f32 = 0.35;
/// A sphere that has been slower than this for some steps rests.
const STILL: f32 = 0.16;
const STEPS_TO_REST: u8 = 20;
/// Rounds of impulses, and of separation.
const ROUNDS: usize = 8;
const SEPARATIONS: usize = 8;

/// The energy of what is loose, relative to that of a ball of one metre.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Of motion.
    pub kinetic: f64,
    /// Of height over the core's surface.
    pub potential: f64,
}

/// A sphere that moves as it likes, and gives way to none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mover {
    /// Its centre.
    pub center: Point3,
    /// Its radius in metres.
    pub radius: f32,
    /// Its velocity in metres per second.
    pub velocity: Vector3,
}

/// A planet of spheres.
#[derive(Clone, Debug)]
pub struct Planet {
    bodies: Bodies,
    radius: f32,
    /// Seconds since the beginning.
    time: f32,
    moon: Option<usize>,
    /// Steps for which each body has been slow.
    still: Vec<u8>,
    /// The bodies that move.
    moving: Vec<u32>,
    /// The place of each body among those that move.
    place: Vec<u32>,
    /// What lay where it does when the grid was made.
    settled: Grid,
    /// Whether a body has moved since.
    is_stirred: Vec<bool>,
    stirred: Vec<u32>,
    stirred_grid: Grid,
    instruction_set: InstructionSet,
}

impl Planet {
    /// A planet of as many spheres, at least 64.
    pub fn new(count: usize) -> Self {
        let count = count.max(64);
        let radius = core_radius(count);
        let bodies = Bodies::new(Land::new(radius).spheres(count));
        Self::of(bodies, radius, true)
    }

    /// A planet with a core of this radius, without a moon, on which loose balls of these centres
    /// and radii move.
    pub fn with_balls(radius: f32, balls: impl IntoIterator<Item = (Point3, f32)>) -> Self {
        let core = (Substance::Ice, Vec3::ZERO, radius, State::Held);
        let balls =
            balls.into_iter().map(|(center, radius)| (Substance::White, center, radius, State::Moving));
        Self::of(Bodies::new(std::iter::once(core).chain(balls)), radius, false)
    }

    fn of(bodies: Bodies, radius: f32, has_moon: bool) -> Self {
        let count = bodies.len();
        // The moon is the largest sphere of its substance, which it is the first of.
        let moon = has_moon.then(|| bodies.range(Substance::Silver).start);
        let moving = (0..count as u32).filter(|&i| bodies.state[i as usize] == State::Moving).collect();
        let mut planet = Self {
            bodies,
            radius,
            time: 0.0,
            moon,
            still: vec![0; count],
            moving,
            place: vec![Contact::FIXED; count],
            settled: Grid::default(),
            is_stirred: vec![false; count],
            stirred: Vec::new(),
            stirred_grid: Grid::default(),
            instruction_set: InstructionSet::detect(),
        };
        planet.settle();
        planet
    }

    /// Computes with an instruction set instead of the best one. The results are the same.
    #[must_use]
    pub fn with_instruction_set(self, instruction_set: InstructionSet) -> Self {
        Self { instruction_set, ..self }
    }

    /// Its spheres.
    pub fn bodies(&self) -> &Bodies {
        &self.bodies
    }

    /// The radius of its core in metres.
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// How many spheres move.
    pub fn moving(&self) -> usize {
        self.moving.len()
    }

    /// Upwards at a point.
    pub fn up(&self, p: Point3) -> Vector3 {
        p.normalize_or(Vec3::Z)
    }

    /// The acceleration of what is loose: towards the core, and towards the moon.
    pub fn gravity(&self, p: Point3) -> Vector3 {
        let down = -self.up(p) * GRAVITY;
        let Some(moon) = self.moon else { return down };
        let way = self.bodies.center[moon] - p;
        let off = (way.length() / ((MOON[0] - 1.0) * self.radius) - 1.0) / PULL_RANGE;
        down + way.normalize_or(Vec3::Z) * (PULL * (1.0 - off * off).max(0.0))
    }

    /// The energy of what is loose, without the moon's pull.
    pub fn energy(&self) -> Energy {
        let mut energy = Energy::default();
        for (i, state) in self.bodies.state.iter().enumerate().filter(|(_, state)| **state != State::Held) {
            let mass = f64::from(self.bodies.mass(i));
            let height = f64::from(self.bodies.center[i].length());
            energy.potential += mass * f64::from(GRAVITY) * (height - f64::from(self.radius));
            if *state == State::Moving {
                energy.kinetic += 0.5 * mass * f64::from(self.bodies.velocity[i].length_squared());
            }
        }
        energy
    }

    /// The centre of a walker's body over a meadow in the sun, as far as there is one.
    pub(crate) fn landing(&self) -> Point3 {
        let land = Land::new(self.radius);
        let frame = Frame::from_z(Vec3::new(0.62, -0.66, 0.42).normalize());
        let around = |i: u32| {
            let (sin, cos) = lanes::sin_cos(0.61 * i as f32);
            let out = 0.006 * i as f32;
            frame.from_local(Vec3::new(out * cos, out * sin, 1.0)).normalize()
        };
        let direction = (0..400).map(around).find(|&d| land.is_open(d)).unwrap_or(around(0));
        direction * (self.radius + land.height(direction).max(0.0) + 1.5)
    }

    /// Calls `visit` with centre and radius of the spheres within a distance of a point that do not
    /// give way.
    pub(crate) fn firm_around(&self, p: Point3, distance: f32, mut visit: impl FnMut(Point3, f32)) {
        visit(Vec3::ZERO, self.radius);
        if let Some(moon) = self.moon {
            visit(self.bodies.center[moon], self.bodies.radius[moon]);
        }
        self.settled.around(p, distance, |entry| {
            if self.bodies.state[entry.body as usize] == State::Held {
                visit(entry.center, entry.radius);
            }
        });
    }

    /// Tears everything loose within a distance of a point, and throws it away from there with up
    /// to a speed in metres per second.
    pub fn blast(&mut self, p: Point3, distance: f32, speed: f32) {
        let mut struck = Vec::new();
        let mut strike = |entry: Entry| struck.push(entry.body);
        self.settled.around(p, distance, &mut strike);
        self.stirred_grid.around(p, distance, &mut strike);
        struck.sort_unstable();
        struck.dedup();
        let up = self.up(p);
        for &body in &struck {
            let i = body as usize;
            let way = self.bodies.center[i] - p;
            let share = (1.0 - way.length() / (distance + self.bodies.radius[i])).max(0.0);
            let throw = (way.normalize_or(up) + up).normalize_or(up);
            self.bodies.velocity[i] += throw * (speed * share);
        }
        self.wake(struck);
    }

    /// Moves everything by a time in seconds, at most a thirtieth; what is loose makes way for who
    /// walks there.
    pub fn step(&mut self, walker: Option<Mover>, dt: f32) {
        self.time += dt;
        let mut movers = Vec::from_iter(walker);
        movers.extend(self.move_moon(dt));
        self.wake_around(&movers);
        self.sort_moving();
        self.fall(dt);
        self.sort_stirred(dt);
        let (contacts, struck) = self.contacts(&movers, dt);
        self.collide(&contacts, &movers);
        let before: Vec<Point3> = self.moving.iter().map(|&i| self.bodies.center[i as usize]).collect();
        self.advance(dt);
        self.separate(&contacts, &movers);
        self.hold_back(&before, dt);
        self.wake(struck);
        self.rest(&contacts);
    }

    /// The moon on its way, if there is one.
    fn move_moon(&mut self, dt: f32) -> Option<Mover> {
        let moon = self.moon?;
        let (sin, cos) = lanes::sin_cos(std::f32::consts::TAU * (self.time / MONTH).fract());
        let at = Vec3::new(0.45 * sin, 0.9 * sin, cos).normalize_or(Vec3::Z);
        let before = self.bodies.center[moon];
        let center = at * (MOON[0] * self.radius);
        self.bodies.center[moon] = center;
        Some(Mover { center, radius: self.bodies.radius[moon], velocity: (center - before) / dt })
    }

    /// Wakes what rests near what moves by itself, and what the moon lifts.
    fn wake_around(&mut self, movers: &[Mover]) {
        let mut woken = Vec::new();
        for mover in movers {
            self.settled.around(mover.center, mover.radius + NEAR, |entry| woken.push(entry.body));
            self.stirred_grid.around(mover.center, mover.radius + NEAR, |entry| woken.push(entry.body));
        }
        if self.moon.is_some() {
            let state = &self.bodies.state;
            let is_lifted = |&i: &u32| {
                let (state, p) = (state[i as usize], self.bodies.center[i as usize]);
                state == State::Resting && self.gravity(p).dot(p) > 0.0
            };
            woken.par_extend((0..state.len() as u32).into_par_iter().with_min_len(4096).filter(is_lifted));
        }
        woken.retain(|&body| self.bodies.state[body as usize] == State::Resting);
        self.wake(woken);
    }

    /// Gravity.
    fn fall(&mut self, dt: f32) {
        let fallen = |&i: &u32| {
            let i = i as usize;
            let velocity = self.bodies.velocity[i] + self.gravity(self.bodies.center[i]) * dt;
            let speed = velocity.length();
            if speed > FASTEST { velocity * (FASTEST / speed) } else { velocity }
        };
        let velocities = self.moving.par_iter().with_min_len(CHUNK).map(fallen).collect();
        self.set_velocities(velocities);
    }

    /// Replaces the velocities of those that move.
    fn set_velocities(&mut self, velocities: Vec<Vector3>) {
        for (&body, velocity) in self.moving.iter().zip(velocities) {
            self.bodies.velocity[body as usize] = velocity;
        }
    }

    /// Puts all bodies that do not move into the grid of those that have settled.
    fn settle(&mut self) {
        self.is_stirred.fill(false);
        self.stirred.clone_from(&self.moving);
        self.moving.iter().for_each(|&i| self.is_stirred[i as usize] = true);
        let is_settled = |i: &usize| !self.is_stirred[*i] && *i != 0 && Some(*i) != self.moon;
        let entries: Vec<Entry> =
            (0..self.bodies.len()).filter(is_settled).map(|i| self.entry(i, 0.0)).collect();
        self.settled.rebuild(&entries);
    }

    /// Puts the others into a grid of their own.
    fn sort_stirred(&mut self, dt: f32) {
        let resting = self.stirred.len() - self.moving.len();
        if resting > 2000.max(self.bodies.len() / 16) {
            self.settle();
        }
        let stirred = self.stirred.par_iter().with_min_len(CHUNK);
        let entries: Vec<Entry> = stirred.map(|&i| self.entry(i as usize, dt)).collect();
        self.stirred_grid.rebuild(&entries);
    }

    /// A body that is found where it may come to within `dt`.
    fn entry(&self, body: usize, dt: f32) -> Entry {
        let Bodies { center, radius, velocity, .. } = &self.bodies;
        let reach = radius[body] + dt * velocity[body].length();
        Entry { center: center[body], radius: radius[body], reach, body: body as u32 }
    }

    /// The contacts of all bodies that move, and the bodies that are struck so hard that they will.
    fn contacts(&mut self, movers: &[Mover], dt: f32) -> (Vec<Contacts>, Vec<u32>) {
        for (place, &body) in self.moving.iter().enumerate() {
            self.place[body as usize] = place as u32;
        }
        let chunks = self.moving.par_chunks(CHUNK);
        let found: Vec<_> = chunks.map(|bodies| self.contacts_of(bodies, movers, dt)).collect();
        let (contacts, struck): (Vec<_>, Vec<_>) = found.into_iter().unzip();
        (contacts, struck.concat())
    }

    /// The same of bodies that follow each other.
    fn contacts_of(&self, bodies: &[u32], movers: &[Mover], dt: f32) -> (Contacts, Vec<u32>) {
        let Bodies { center, radius, velocity, state, .. } = &self.bodies;
        let query = |&body: &u32| {
            let i = body as usize;
            Query { point: center[i], distance: radius[i] + NEAR + dt * velocity[i].length() }
        };
        let queries: Vec<Query> = bodies.iter().map(query).collect();
        let near = |grid| self.instruction_set.dispatch(Near { grid, queries: &queries });
        let (settled, stirred) = (near(&self.settled), near(&self.stirred_grid));
        let (mut contacts, mut counts, mut struck) = (Vec::with_capacity(8 * CHUNK), Vec::new(), Vec::new());
        for (query, &body) in bodies.iter().enumerate() {
            let first = contacts.len();
            let i = body as usize;
            let (p, size, v, mass) = (center[i], radius[i], velocity[i], self.bodies.mass(i));
            let contact = |q: Point3, reach: f32, velocity: Vector3, is_first: bool| {
                let way = p - q;
                let (distance, reach) = (way.length(), size + reach);
                let gap = distance - reach;
                if gap > NEAR + dt * (v - velocity).length() {
                    return None;
                }
                // The same for both: which is the first decides where both centres are one.
                let aside = if is_first { Vec3::Z } else { -Vec3::Z };
                let normal = if distance > 0.0 { way / distance } else { aside };
                let (partner, room) = (Contact::FIXED, gap.max(0.0) / dt);
                Some(Contact { partner, normal, room, share: 1.0, center: q, reach })
            };
            contacts.extend(contact(Vec3::ZERO, self.radius, Vector3::ZERO, false));
            for (mover, partner) in movers.iter().zip(first_constant(self.moving.len()) as u32..) {
                let contact = contact(mover.center, mover.radius, mover.velocity, true);
                contacts.extend(contact.map(|contact| Contact { partner, ..contact }));
            }
            for &place in settled.of(query) {
                let Entry { center, radius, body: other, .. } = self.settled.entry(place);
                // Those that have moved since are in the other grid.
                if self.is_stirred[other as usize] {
                    continue;
                }
                if let Some(contact) = contact(center, radius, Vector3::ZERO, body < other) {
                    if self.is_struck(other as usize, size, -v.dot(contact.normal)) {
                        struck.push(other);
                    }
                    contacts.push(contact);
                }
            }
            for &place in stirred.of(query) {
                let Entry { center, radius, body: other, .. } = self.stirred_grid.entry(place);
                if other == body {
                    continue;
                }
                let j = other as usize;
                if let Some(contact) = contact(center, radius, velocity[j], body < other) {
                    let moves = state[j] == State::Moving;
                    let share = if moves { self.share(mass, j) } else { 1.0 };
                    if self.is_struck(j, size, -v.dot(contact.normal)) {
                        struck.push(other);
                    }
                    contacts.push(Contact { partner: self.place[j], share, ..contact });
                }
            }
            counts.push((contacts.len() - first) as u32);
        }
        (Contacts::new(&contacts, counts), struck)
    }

    /// Whether a body that does not move will, when one of this radius comes at a speed.
    fn is_struck(&self, body: usize, radius: f32, speed: f32) -> bool {
        match self.bodies.state[body] {
            State::Resting => speed > WAKE,
            State::Held => {
                let ratio = radius / self.bodies.radius[body];
                speed * ratio * ratio * ratio > self.bodies.substance(body).firmness()
            }
            State::Moving => false,
        }
    }

    /// The share of changes of a body of this mass, beside another one that moves.
    fn share(&self, mass: f32, other: usize) -> f32 {
        let others = self.bodies.mass(other);
        others / (mass + others)
    }

    /// Changes velocities by impulses.
    fn collide(&mut self, contacts: &[Contacts], movers: &[Mover]) {
        let of_bodies = self.moving.iter().map(|&i| self.bodies.velocity[i as usize]);
        let mut velocities = Vectors::new(of_bodies, movers.iter().map(|mover| mover.velocity));
        velocities.relax(self.instruction_set, ROUNDS, contacts, Impulses);
        for (&body, velocity) in self.moving.iter().zip(velocities.iter()) {
            self.bodies.velocity[body as usize] = velocity;
        }
    }

    fn advance(&mut self, dt: f32) {
        for &i in &self.moving {
            let i = i as usize;
            self.bodies.center[i] += self.bodies.velocity[i] * dt;
        }
    }

    /// Takes overlaps away, which velocities do not feel.
    fn separate(&mut self, contacts: &[Contacts], movers: &[Mover]) {
        let of_bodies = self.moving.iter().map(|&i| self.bodies.center[i as usize]);
        let mut centers = Vectors::new(of_bodies, movers.iter().map(|mover| mover.center));
        centers.relax(self.instruction_set, SEPARATIONS, contacts, Separations);
        for (&body, center) in self.moving.iter().zip(centers.iter()) {
            self.bodies.center[body as usize] = center;
        }
    }

    /// Takes speed from bodies that have not come as far as it says: those below others in a heap,
    /// whose impulses the rounds have not balanced.
    fn hold_back(&mut self, before: &[Point3], dt: f32) {
        let held = |(&body, before): (&u32, &Point3)| {
            let (center, velocity) = (self.bodies.center[body as usize], self.bodies.velocity[body as usize]);
            let (moved, speed) = (center.distance(*before) / dt, velocity.length());
            if moved < speed { velocity * (moved / speed) } else { velocity }
        };
        let velocities = self.moving.par_iter().zip(before).with_min_len(CHUNK).map(held).collect();
        self.set_velocities(velocities);
    }

    /// Lets bodies move, and what they carry: what touches them from above.
    fn wake(&mut self, mut woken: Vec<u32>) {
        let mut next = 0;
        while next < woken.len() {
            let i = woken[next] as usize;
            next += 1;
            if i == 0 || Some(i) == self.moon || self.bodies.state[i] == State::Moving {
                continue;
            }
            let was_held = self.bodies.state[i] == State::Held;
            self.bodies.state[i] = State::Moving;
            self.still[i] = 0;
            self.moving.push(i as u32);
            if !self.is_stirred[i] {
                self.is_stirred[i] = true;
                self.stirred.push(i as u32);
            }
            let (p, size, bodies) = (self.bodies.center[i], self.bodies.radius[i], &self.bodies);
            let height = p.length();
            let mut carry = |entry: Entry| {
                let other = entry.body as usize;
                let is_carried = match bodies.state[other] {
                    State::Held => was_held && grows(bodies.substance(other)),
                    State::Resting => true,
                    State::Moving => false,
                };
                if is_carried && bodies.center[other].length() > height {
                    woken.push(entry.body);
                }
            };
            self.settled.around(p, size + NEAR, &mut carry);
            self.stirred_grid.around(p, size + NEAR, &mut carry);
        }
    }

    /// Brings the bodies that move into an order in which near ones follow each other, so that what
    /// is around them is in the cache.
    fn sort_moving(&mut self) {
        let center = &self.bodies.center;
        let key = |&i: &u32| u64::from(place_on_curve(center[i as usize])) << 32 | u64::from(i);
        let mut keys: Vec<u64> = self.moving.par_iter().with_min_len(CHUNK).map(key).collect();
        keys.par_sort_unstable();
        self.moving.clear();
        self.moving.extend(keys.into_iter().map(|key| key as u32));
    }

    /// Lets bodies rest that have been slow for some time and touch something.
    fn rest(&mut self, contacts: &[Contacts]) {
        let Bodies { velocity, state, .. } = &mut self.bodies;
        // Those woken in this step come later, and have no contacts yet.
        let touching: Vec<(usize, bool)> = {
            let mut counts = contacts.iter().flat_map(|contacts| &contacts.counts);
            let with_contacts = self.moving.iter().map(|&i| {
                let i = i as usize;
                let is_old = self.place[i] != Contact::FIXED;
                (i, is_old && counts.next().is_some_and(|&count| count > 0))
            });
            with_contacts.collect()
        };
        for (i, touches) in touching {
            let is_slow = touches && velocity[i].length_squared() < STILL * STILL;
            self.still[i] = if is_slow { self.still[i] + 1 } else { 0 };
            if self.still[i] >= STEPS_TO_REST {
                (state[i], velocity[i]) = (State::Resting, Vector3::ZERO);
            }
            self.place[i] = Contact::FIXED;
        }
        self.moving.retain(|&i| state[i as usize] == State::Moving);
    }
}

/// The place of a point's cell of a metre on a Z-order curve.
fn place_on_curve(p: Point3) -> u32 {
    let [x, y, z] = p.to_array().map(|x| x.floor() as i32 as u32);
    (0..10).fold(0, |code, bit| {
        code | (x >> bit & 1) << (3 * bit) | (y >> bit & 1) << (3 * bit + 1) | (z >> bit & 1) << (3 * bit + 2)
    })
}

/// Whether a held sphere falls when another one is torn off that it touches from above.
fn grows(substance: Substance) -> bool {
    substance >= Substance::Wood
}
