//! The head as one solid.

use math::Vec3;

use super::blend::join;
use super::ear::Ear;
use super::face::Face;
use super::skull::Skull;

/// A head with neck and shoulders, in millimetres: x to its left, y ahead, z up; the eyes are at
/// the height 0.
pub struct Sculpture {
    skull: Skull,
    face: Face,
    ear: Ear,
}

impl Sculpture {
    pub fn new() -> Self {
        Self { skull: Skull::new(), face: Face::new(), ear: Ear::new() }
    }

    /// About the distance to the skin, positive outside.
    pub fn distance(&self, p: Vec3) -> f32 {
        let p = half(p);
        let bust = self.skull.bust(p);
        if p.z < -150.0 {
            return bust;
        }
        let head = self.ear.on(p, self.face.on(p, self.skull.head(p)));
        join(head, bust, 16.0)
    }

    /// About the distance to the head without its face and ears.
    pub fn scalp_distance(&self, p: Vec3) -> f32 {
        let p = half(p);
        join(self.skull.head(p), self.skull.bust(p), 16.0)
    }

    /// Whether a point of the skin is on an ear.
    pub fn is_ear(&self, p: Vec3) -> bool {
        p.x.abs() > 55.0 && self.scalp_distance(p) > 0.6
    }

    /// The point of the scalp near to one.
    pub fn foot(&self, p: Vec3) -> Vec3 {
        (0..3).fold(p, |p, _| p - self.scalp_normal(p) * self.scalp_distance(p))
    }

    /// The point of the face at x and z.
    pub fn front(&self, x: f32, z: f32) -> Vec3 {
        let mut p = Vec3::new(x, 125.0, z);
        for _ in 0..60 {
            p.y -= 0.7 * self.distance(p);
        }
        p
    }

    /// The direction away from the skin.
    pub fn normal(&self, p: Vec3) -> Vec3 {
        gradient(p, |p| self.distance(p))
    }

    /// The direction away from the scalp.
    pub fn scalp_normal(&self, p: Vec3) -> Vec3 {
        gradient(p, |p| self.scalp_distance(p))
    }
}

/// The point of one half that stands for both; they meet without an edge.
fn half(p: Vec3) -> Vec3 {
    const ROUND: f32 = 1.5;
    Vec3::new(p.x.hypot(ROUND) - 0.5 * ROUND, p.y, p.z)
}

fn gradient(p: Vec3, distance: impl Fn(Vec3) -> f32) -> Vec3 {
    const STEP: f32 = 0.06;
    // The corners of a tetrahedron.
    let corner = |x: f32, y: f32, z: f32| {
        let way = Vec3::new(x, y, z);
        way * distance(p + way * STEP)
    };
    let sum = corner(1.0, -1.0, -1.0) + corner(-1.0, -1.0, 1.0) + corner(-1.0, 1.0, -1.0);
    (sum + corner(1.0, 1.0, 1.0)).normalize_or(Vec3::Z)
}
