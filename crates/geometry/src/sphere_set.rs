//! Many whole spheres, as arrays of centres and radii.
//!
//! They are in render space, so that only similarities are allowed as transforms. Rays hit sphere i
//! where |o + t·d − cᵢ| = rᵢ, solved in doubles. A single sphere as a [`Sphere`] has exactly the
//! centre and radius of the set, and its poles on the object's z axis.

use crate::placement::Placement;
use crate::shape::Sphere;
use crate::triples::{triples, vector};
use lanes::{Int, Real};
use math::{Bounds3, DMat3, MACHINE_EPSILON, Point3, Transform, Vector3};
use std::fmt;
use std::sync::Arc;

/// Errors of the arrays of a sphere set.
#[derive(Clone, Debug, PartialEq)]
pub enum SphereSetError {
    /// The number of radii is neither one nor that of the spheres.
    RadiusCount {
        /// The number of radii.
        radii: usize,
        /// The number of centres.
        centers: usize,
    },
    /// A radius is not positive and finite.
    Radius {
        /// The index of the sphere.
        index: usize,
        /// The radius.
        radius: f32,
    },
    /// A centre is not finite.
    Center {
        /// The index of the sphere.
        index: usize,
    },
    /// There are more spheres than indices of 32 bits.
    TooLarge,
    /// The transform is no similarity.
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
    /// One for all spheres, or one for each.
    radii: Arc<[f32]>,
    /// The axes of all spheres: a rotation, or a rotation and reflection.
    turn: DMat3,
    flips: bool,
}

impl SphereSet {
    /// Transforms an object's spheres to render space. `radii` has one radius for all or one for
    /// each. Arrays that do not change are shared, not copied.
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

    /// The number of spheres.
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

    /// The axes of all spheres, of unit length.
    pub(crate) fn axes(&self) -> [Vector3; 3] {
        [self.turn.x_axis, self.turn.y_axis, self.turn.z_axis].map(|axis| axis.as_vec3().into())
    }

    /// Whether normals point inwards.
    pub(crate) fn flips(&self) -> bool {
        self.flips
    }

    /// Centres and radii of spheres, one in each lane.
    #[inline(always)]
    pub(crate) fn gather<R: Real>(&self, sphere: R::Int) -> (Point3<R>, R) {
        let center = vector(triples(&self.centers), sphere.wrapping_mul(R::Int::splat(3)));
        let radius = match &*self.radii {
            [radius] => R::splat(*radius),
            radii => R::gather(radii, sphere),
        };
        (center, radius)
    }

    /// The same set with its spheres elsewhere; the axes stay. `None` if the number of centres
    /// differs, or one is not finite.
    pub fn moved(&self, centers: Arc<[Point3]>) -> Option<Self> {
        let fits = centers.len() == self.len() && centers.iter().all(|center| center.is_finite());
        fits.then(|| Self { centers, ..self.clone() })
    }

    /// Bytes of memory of the arrays.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.centers) + size_of_val(&*self.radii)
    }
}

/// Scale and rotation of a similarity, the rotation orthonormal in double precision; `None` for
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
