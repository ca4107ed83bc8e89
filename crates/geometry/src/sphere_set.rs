//! Many whole spheres, as arrays of centres and radii.
//!
//! They stand in render space, so that a similarity is the only transform that leaves them spheres.
//! Rays meet sphere i where the distance |o + t·d − cᵢ| = rᵢ, solved in doubles. One sphere as a
//! [`Sphere`] has the very centre and radius that the set has, and its poles on the object's z
//! axis.

use crate::placement::Placement;
use crate::shape::{Sphere, first_root};
use math::{Bounds3, DMat3, MACHINE_EPSILON, Point3, Ray, Transform};
use std::fmt;
use std::sync::Arc;

/// Why arrays are no set of spheres.
#[derive(Clone, Debug, PartialEq)]
pub enum SphereSetError {
    /// There is neither one radius for all nor one for each.
    RadiusCount {
        /// How many radii there are.
        radii: usize,
        /// How many centres there are.
        centers: usize,
    },
    /// A radius that is not above zero, or not finite.
    Radius {
        /// Which one.
        index: usize,
        /// What it is.
        radius: f32,
    },
    /// A centre that is not finite.
    Center {
        /// Which one.
        index: usize,
    },
    /// There are more spheres than an index of 32 bits can tell apart.
    TooLarge,
    /// The transform makes ellipsoids of spheres.
    NotSimilar,
}

impl fmt::Display for SphereSetError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::RadiusCount { radii, centers } => {
                write!(f, "{radii} radii for {centers} spheres: give one, or one for each")
            }
            Self::Radius { index, radius } => {
                write!(f, "radius {index} is {radius}; it must be finite and above zero")
            }
            Self::Center { index } => write!(f, "the centre of sphere {index} is not finite"),
            Self::TooLarge => write!(f, "too many spheres"),
            Self::NotSimilar => write!(f, "the transform makes ellipsoids of spheres"),
        }
    }
}

impl std::error::Error for SphereSetError {}

/// Spheres in render space.
#[derive(Clone, Debug)]
pub struct SphereSet {
    centers: Arc<[Point3]>,
    /// One for all, or one for each.
    radii: Arc<[f32]>,
    /// Turns (and may mirror) the axes of all spheres.
    turn: DMat3,
    flips: bool,
}

impl SphereSet {
    /// Brings an object's spheres into render space. `radii` has one radius for all or one for
    /// each. Arrays that the transform leaves alone are shared, not copied.
    ///
    /// Normals point outwards; with `reverse_orientation`, inwards.
    pub fn new(
        centers: Arc<[Point3]>,
        radii: Arc<[f32]>,
        render_from_object: &Transform,
        reverse_orientation: bool,
    ) -> Result<Self, SphereSetError> {
        if radii.len() != 1 && radii.len() != centers.len() {
            return Err(SphereSetError::RadiusCount { radii: radii.len(), centers: centers.len() });
        }
        if centers.len() >= u32::MAX as usize {
            return Err(SphereSetError::TooLarge);
        }
        if let Some(index) = radii.iter().position(|r| !(*r > 0.0 && r.is_finite())) {
            return Err(SphereSetError::Radius { index, radius: radii[index] });
        }
        if let Some(index) = centers.iter().position(|c| !c.is_finite()) {
            return Err(SphereSetError::Center { index });
        }
        let (scale, turn) = similarity(render_from_object).ok_or(SphereSetError::NotSimilar)?;
        let moved = !render_from_object.is_identity();
        let moved_center = |&c: &Point3| render_from_object.point(c);
        let scaled_radius = |&r: &f32| (f64::from(r) * scale) as f32;
        Ok(Self {
            centers: if moved { centers.iter().map(moved_center).collect() } else { centers },
            radii: if moved { radii.iter().map(scaled_radius).collect() } else { radii },
            turn,
            flips: reverse_orientation != render_from_object.swaps_handedness(),
        })
    }

    /// How many spheres there are.
    pub fn len(&self) -> usize {
        self.centers.len()
    }

    /// Whether there is no sphere.
    pub fn is_empty(&self) -> bool {
        self.centers.is_empty()
    }

    /// The centre of a sphere.
    #[inline]
    pub fn center(&self, sphere: usize) -> Point3 {
        self.centers[sphere]
    }

    /// The radius of a sphere.
    #[inline]
    pub fn radius(&self, sphere: usize) -> f32 {
        if self.radii.len() == 1 { self.radii[0] } else { self.radii[sphere] }
    }

    /// A box around a sphere, rounding included.
    #[inline]
    pub fn bounds(&self, sphere: usize) -> Bounds3 {
        Self::bounds_of(self.center(sphere), self.radius(sphere))
    }

    /// A box around the sphere with this centre and radius.
    #[inline]
    pub(crate) fn bounds_of(center: Point3, radius: f32) -> Bounds3 {
        let reach = radius + (center.abs() + radius) * (2.0 * MACHINE_EPSILON);
        Bounds3 { min: center - reach, max: center + reach }
    }

    /// One sphere as a shape of its own.
    pub fn sphere(&self, sphere: usize) -> Sphere {
        let placement = Placement::rigid(self.turn, self.center(sphere).as_dvec3());
        Sphere::ball(placement, self.flips, self.radius(sphere))
    }

    /// Where the ray meets a sphere first, at 0 < t < `t_max`.
    #[inline]
    pub(crate) fn intersect(center: Point3, radius: f32, ray: &Ray, t_max: f32) -> Option<f32> {
        let o = ray.o.as_dvec3() - center.as_dvec3();
        first_root(o, ray.d.as_dvec3(), f64::from(radius), t_max)
    }

    /// Bytes of memory that the arrays take.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.centers) + size_of_val(&*self.radii)
    }
}

/// Scale and turn of a similarity, the turn orthonormal to the last bits of doubles; `None` for
/// other transforms.
fn similarity(transform: &Transform) -> Option<(f64, DMat3)> {
    let scale = Placement::new(transform).uniform_scale()?;
    let m = transform.matrix().as_dmat4();
    let x = m.x_axis.truncate().try_normalize()?;
    let y = m.y_axis.truncate();
    let y = (y - x * x.dot(y)).try_normalize()?;
    let z = x.cross(y);
    let z = if z.dot(m.z_axis.truncate()) < 0.0 { -z } else { z };
    Some((scale, DMat3::from_cols(x, y, z)))
}
