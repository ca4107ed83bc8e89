//! Parts of a primitive's parameter domain.

use geometry::{Geometry, Hit, Shape, World};
use math::{Point3, Vec2};

/// A triangle or rectangle in parameter space, its corners in order.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Domain {
    Triangle([Vec2; 3]),
    Rectangle([Vec2; 4]),
}

impl Domain {
    /// The parameters of a whole primitive.
    pub fn of(world: &World, hit: &Hit) -> Self {
        let is_triangle = match world.geometry(hit.geometry) {
            Geometry::Mesh(_) => true,
            Geometry::Shapes(shapes) => {
                matches!(shapes[hit.primitive as usize], Shape::Triangle(_) | Shape::MovingTriangle(_))
            }
            Geometry::Spheres(_) | Geometry::Curves(_) => false,
        };
        if is_triangle {
            Self::Triangle([Vec2::ZERO, Vec2::X, Vec2::Y])
        } else {
            Self::Rectangle([Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y])
        }
    }

    /// Three or four corners, in order.
    pub fn corners(&self) -> &[Vec2] {
        match self {
            Self::Triangle(corners) => corners,
            Self::Rectangle(corners) => corners,
        }
    }

    /// Its area on the surface `position`; for a rectangle to second order.
    pub fn area(&self, position: impl Fn(Vec2) -> Point3) -> f32 {
        let p = |uv| position(uv).as_dvec3();
        let area = match *self {
            Self::Triangle([a, b, c]) => 0.5 * (p(b) - p(a)).cross(p(c) - p(a)).length(),
            Self::Rectangle([a, b, c, d]) => {
                let mid = |a: Vec2, b: Vec2| p((a + b) * 0.5);
                (mid(b, c) - mid(d, a)).cross(mid(c, d) - mid(a, b)).length()
            }
        };
        area as f32
    }

    /// The middle.
    pub fn center(&self) -> Vec2 {
        match self {
            Self::Triangle([a, b, c]) => (*a + *b + *c) / 3.0,
            Self::Rectangle([a, b, c, d]) => (*a + *b + *c + *d) / 4.0,
        }
    }

    /// Its four congruent parts.
    pub fn quarters(&self) -> [Self; 4] {
        let mid = |a: Vec2, b: Vec2| (a + b) * 0.5;
        match *self {
            Self::Triangle([a, b, c]) => {
                let (ab, bc, ca) = (mid(a, b), mid(b, c), mid(c, a));
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [bc, ca, ab]].map(Self::Triangle)
            }
            Self::Rectangle([a, b, c, d]) => {
                let (ab, bc, cd, da, m) = (mid(a, b), mid(b, c), mid(c, d), mid(d, a), self.center());
                [[a, ab, m, da], [ab, b, bc, m], [m, bc, c, cd], [da, m, cd, d]].map(Self::Rectangle)
            }
        }
    }

    /// The weights with which values at the centres of the four quarters give their linear
    /// least-squares fit at a point.
    pub fn weights(&self, uv: Vec2) -> [f32; 4] {
        match self {
            Self::Triangle([a, b, c]) => {
                let whole = (*b - *a).perp_dot(*c - *a);
                let outer = |a: Vec2, b: Vec2| 2.0 * (a - uv).perp_dot(b - uv) / whole - 2.0 / 3.0 + 0.25;
                [outer(*b, *c), outer(*c, *a), outer(*a, *b), 0.25]
            }
            Self::Rectangle([a, b, _, d]) => {
                let along = |side: Vec2| (uv - *a).dot(side) / side.length_squared() - 0.5;
                let (x, y) = (along(*b - *a), along(*d - *a));
                [0.25 - x - y, 0.25 + x - y, 0.25 + x + y, 0.25 - x + y]
            }
        }
    }

    /// The index of the quarter that contains a point.
    pub fn quarter_of(&self, uv: Vec2) -> usize {
        match self {
            Self::Triangle([a, b, c]) => {
                let whole = (*b - *a).perp_dot(*c - *a);
                let weights =
                    [(*b - uv).perp_dot(*c - uv), (*c - uv).perp_dot(*a - uv), (*a - uv).perp_dot(*b - uv)];
                weights.iter().position(|w| w / whole > 0.5).unwrap_or(3)
            }
            Self::Rectangle([a, b, _, d]) => {
                let along = |side: Vec2| (uv - *a).dot(side) > 0.5 * side.length_squared();
                match (along(*b - *a), along(*d - *a)) {
                    (false, false) => 0,
                    (true, false) => 1,
                    (true, true) => 2,
                    (false, true) => 3,
                }
            }
        }
    }
}
