//! All film positions of one ray.
//!
//! The film of a spherical camera is periodic: beyond its border, where reconstruction filters
//! reach, the picture continues with another part of itself. A ray thus has many film positions,
//! one on the film and others around it, and contributes to the pixels near each of them. The plane
//! of film positions covers the sphere periodically, for a film of W × H pixels:
//!
//! | mapping | (x, y) is seen at | repeated every |
//! |---|---|---|
//! | equirectangular | (x, y) and, beyond a pole, (x + W/2, −y) | W, 2H |
//! | equal areas | (x, y), (x + W, y + H), and turned round the middle of an edge (W − x, −y), (−x, H − y) | 2W, 2H |

use super::{Camera, Projection};
use description::SphericalMapping;
use math::{Bounds2, Point2, Vec2};

/// The film positions of one ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmPositions {
    first: Point2,
    around: Option<Around>,
}

/// The continuation of a film beyond its border.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Around {
    mapping: SphericalMapping,
    resolution: Vec2,
}

impl From<Point2> for FilmPositions {
    /// One position alone.
    fn from(film: Point2) -> Self {
        Self { first: film, around: None }
    }
}

impl Camera {
    /// All film positions of the ray of `film`.
    pub fn film_positions(&self, film: Point2) -> FilmPositions {
        let around = match &self.projection {
            Projection::Perspective(_) | Projection::Orthographic(_) | Projection::Realistic(_) => None,
            Projection::Spherical(s) => Some(Around { mapping: s.mapping(), resolution: s.resolution() }),
        };
        FilmPositions { first: film, around }
    }
}

impl FilmPositions {
    /// The positions within `bounds`.
    pub fn within(&self, bounds: Bounds2) -> impl Iterator<Item = Point2> {
        let (x, y) = (self.first.x, self.first.y);
        let (positions, count, period) = match self.around {
            None => ([self.first; 4], 1, None),
            Some(Around { mapping, resolution }) => {
                let Vec2 { x: w, y: h } = resolution;
                match mapping {
                    SphericalMapping::EquiRectangular => {
                        let beyond_pole = Vec2::new(x + 0.5 * w, -y);
                        ([self.first, beyond_pole, self.first, beyond_pole], 2, Some(Vec2::new(w, 2.0 * h)))
                    }
                    SphericalMapping::EqualArea => {
                        let turned = [Vec2::new(w - x, -y), Vec2::new(-x, h - y)];
                        let positions = [self.first, self.first + resolution, turned[0], turned[1]];
                        (positions, 4, Some(2.0 * resolution))
                    }
                }
            }
        };
        let positions = positions.into_iter().take(count);
        positions
            .flat_map(move |position| repeated(position, period, bounds))
            .filter(move |&p| bounds.contains(p))
    }
}

/// A position and, where there is a period, its repetitions that may lie within the bounds.
fn repeated(position: Point2, period: Option<Vec2>, bounds: Bounds2) -> impl Iterator<Item = Point2> {
    let (low, high, period) = match period {
        None => (Vec2::ZERO, Vec2::ZERO, Vec2::ZERO),
        Some(period) => {
            let low = (bounds.min - position) / period;
            let high = (bounds.max - position) / period;
            (low.map(f32::ceil), high.map(f32::floor), period)
        }
    };
    let columns = move || (low.x as i32)..=(high.x as i32);
    let rows = (low.y as i32)..=(high.y as i32);
    rows.flat_map(move |j| columns().map(move |i| position + period * Vec2::new(i as f32, j as f32)))
}
