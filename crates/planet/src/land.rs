//! The land: where spheres are in the beginning.
//!
//! The core is a ball of ice. Where the land is higher than its surface, spheres cover it densely,
//! each a bit larger than the gaps between its neighbours; on them there are rocks, trees, flowers,
//! and loose balls, most of which fall from above. All is a function of the number of spheres.

use std::f32::consts::TAU;

use math::{Frame, Point3, Vec3};
use sampling::Rng;

use crate::noise::fbm;
use crate::tree::{broadleaf, spruce};
use crate::{State, Substance};

/// A sphere in the beginning.
pub type Sphere = (Substance, Point3, f32, State);

/// The planet's radius in metres is the root of the number of spheres times this.
const RADIUS: f32 = 0.09;
/// Of all spheres, as many would cover the whole planet as this share.
const COVER: f32 = 0.6;
/// Of all spheres, those of trees.
const TREES: f32 = 0.3;
/// Of all spheres, flowers and stones.
const FLOWERS: f32 = 0.05;
const STONES: f32 = 0.015;
/// The distance of the moon and its radius, in radii of the planet.
pub const MOON: [f32; 2] = [1.75, 0.11];

/// The radius of the core of a planet of as many spheres.
pub fn core_radius(count: usize) -> f32 {
    RADIUS * (count as f32).sqrt()
}

/// A number of directions, spread evenly.
fn directions(count: u32) -> impl Iterator<Item = Vec3> {
    (0..count).map(move |i| {
        let z = 1.0 - 2.0 * (i as f32 + 0.5) / count as f32;
        let across = (1.0 - z * z).max(0.0).sqrt();
        // The golden section of a turn, exactly enough for any number.
        let turn = (f64::from(i) * 0.618_033_988_749_894_9).fract() as f32;
        let (sin, cos) = lanes::sin_cos(TAU * turn);
        Vec3::new(across * cos, across * sin, z)
    })
}

fn any_direction(rng: &mut Rng) -> Vec3 {
    let z = 1.0 - 2.0 * rng.uniform_f32();
    let across = (1.0 - z * z).max(0.0).sqrt();
    let (sin, cos) = lanes::sin_cos(TAU * rng.uniform_f32());
    Vec3::new(across * cos, across * sin, z)
}

/// The land of a planet.
pub struct Land {
    radius: f32,
}

impl Land {
    /// With a core of this radius.
    pub fn new(radius: f32) -> Self {
        Self { radius }
    }

    /// The height of the land over the ice in metres, which is below zero in lakes.
    pub fn height(&self, direction: Vec3) -> f32 {
        let p = direction * self.radius;
        let hills = 2.3 * fbm(p * 0.085 + Vec3::splat(3.1), 4);
        0.35 + hills + 0.9 * (hills - 0.6).max(0.0)
    }

    /// How dense the forest is: trees stand where it is above zero.
    fn forest(&self, direction: Vec3) -> f32 {
        fbm(direction * self.radius * 0.11 + Vec3::splat(40.0), 2) + 0.12
    }

    /// Whether the land in a direction is a meadow without trees.
    pub fn is_open(&self, direction: Vec3) -> bool {
        (0.4..1.6).contains(&self.height(direction)) && self.forest(direction) < -0.12
    }

    /// All spheres: the core, the moon, and others, `count` in all.
    pub fn spheres(&self, count: usize) -> Vec<Sphere> {
        let [distance, size] = MOON.map(|radii| radii * self.radius);
        let mut all = vec![
            (Substance::Ice, Vec3::ZERO, self.radius, State::Held),
            (Substance::Silver, Vec3::new(0.0, 0.0, distance), size, State::Held),
        ];
        let mut rng = Rng::from_sequence(11);
        self.cover(count, &mut rng, &mut all);
        self.stones(count, &mut rng, &mut all);
        self.trees(count, &mut rng, &mut all);
        self.flowers(count, &mut rng, &mut all);
        all.truncate(count);
        let left = count - all.len();
        self.balls(left, &mut rng, &mut all);
        all
    }

    fn cover(&self, count: usize, rng: &mut Rng, all: &mut Vec<Sphere>) {
        let cover = (COVER * count as f32) as u32;
        let spacing = (4.0 * std::f32::consts::PI * self.radius * self.radius / cover.max(1) as f32).sqrt();
        for direction in directions(cover) {
            let (height, u) = (self.height(direction), rng.uniform_f32());
            if height < 0.0 {
                continue;
            }
            let shade = fbm(direction * self.radius * 0.5, 2) + 0.25 * (u - 0.5);
            let substance = match height + 0.5 * shade {
                h if h < 0.35 => Substance::Sand,
                h if h > 3.2 => Substance::Snow,
                h if h > 2.5 => Substance::Stone,
                _ if shade > 0.05 => Substance::Moss,
                _ => Substance::Grass,
            };
            let radius = spacing * (0.78 + 0.12 * rng.uniform_f32());
            let out = self.radius + height - 0.6 * radius;
            all.push((substance, direction * out, radius, State::Held));
        }
    }

    fn stones(&self, count: usize, rng: &mut Rng, all: &mut Vec<Sphere>) {
        for _ in 0..(STONES * count as f32) as u32 / 6 {
            let direction = any_direction(rng);
            let frame = Frame::from_z(direction);
            let height = self.height(direction);
            for _ in 0..6 {
                let [x, y, u] = [0; 3].map(|_| rng.uniform_f32());
                let at = Vec3::new(x - 0.5, y - 0.5, 0.0) * 1.1;
                let foot = (direction * self.radius + frame.from_local(at)).normalize();
                let center = foot * (self.radius + height.max(-0.1) + 0.08);
                all.push((Substance::Stone, center, 0.18 + 0.34 * u * u, State::Held));
            }
        }
    }

    fn trees(&self, count: usize, rng: &mut Rng, all: &mut Vec<Sphere>) {
        let most = all.len() + (TREES * count as f32) as usize;
        let mut feet: Vec<Point3> = Vec::new();
        for _ in 0..count / 4 {
            if all.len() + 64 > most {
                break;
            }
            let direction = any_direction(rng);
            let height = self.height(direction);
            let is_thin = self.forest(direction) < 0.5 * rng.uniform_f32();
            if !(0.3..2.6).contains(&height) || is_thin {
                continue;
            }
            let foot = direction * (self.radius + height - 0.05);
            let is_high = height > 1.5;
            let space: f32 = if is_high { 1.8 } else { 2.5 };
            if feet.iter().any(|other| other.distance_squared(foot) < space * space) {
                continue;
            }
            feet.push(foot);
            let frame = Frame::from_z(direction);
            let put = |substance, center, radius| all.push((substance, center, radius, State::Held));
            if is_high || rng.uniform_f32() < 0.2 {
                spruce(&frame, foot, rng, put);
                continue;
            }
            let leaves = match rng.uniform_f32() {
                u if u < 0.5 => Substance::Leaves,
                u if u < 0.78 => Substance::AutumnLeaves,
                _ => Substance::Blossom,
            };
            broadleaf(&frame, foot, leaves, rng, put);
        }
    }

    fn flowers(&self, count: usize, rng: &mut Rng, all: &mut Vec<Sphere>) {
        for _ in 0..(FLOWERS * count as f32) as u32 / 5 {
            let middle = any_direction(rng);
            let height = self.height(middle);
            if !(0.35..2.2).contains(&height) {
                continue;
            }
            let substance = match rng.uniform_f32() {
                u if u < 0.4 => Substance::Yellow,
                u if u < 0.7 => Substance::White,
                u if u < 0.9 => Substance::Red,
                _ => Substance::Blue,
            };
            for _ in 0..5 {
                let [x, y, u] = [0; 3].map(|_| rng.uniform_f32());
                let at = Frame::from_z(middle).from_local(Vec3::new(x - 0.5, y - 0.5, 0.0) * 1.6);
                let direction = (middle * self.radius + at).normalize();
                let out = self.radius + self.height(direction) + 0.16;
                all.push((substance, direction * out, 0.055 + 0.035 * u, State::Held));
            }
        }
    }

    fn balls(&self, count: usize, rng: &mut Rng, all: &mut Vec<Sphere>) {
        for _ in 0..count {
            let direction = any_direction(rng);
            let substance = match rng.uniform_f32() {
                u if u < 0.22 => Substance::Red,
                u if u < 0.42 => Substance::Blue,
                u if u < 0.62 => Substance::Yellow,
                u if u < 0.82 => Substance::White,
                u if u < 0.90 => Substance::Silver,
                u if u < 0.95 => Substance::Gold,
                _ => Substance::Glass,
            };
            let [u, fall] = [0; 2].map(|_| rng.uniform_f32());
            let radius = 0.09 + 0.12 * u * u;
            let out = self.radius + self.height(direction).max(0.0) + 0.5 + 6.0 * fall * fall;
            all.push((substance, direction * out, radius, State::Moving));
        }
    }
}
