//! Participating media: absorption, scattering and emission between surfaces.
//!
//! Along a ray, radiance L changes by
//!
//! ```text
//! dL/dt = −σ_t L + σ_a L_e + σ_s ∫ p(ω_o, ω_i) L(ω_i) dω_i        σ_t = σ_a + σ_s
//! ```
//!
//! with the coefficients of absorption σ_a and of scattering σ_s per unit of length in the world,
//! the emitted radiance L_e and the phase function p, which is that of Henyey and Greenstein. All
//! but p depend on wavelength, and on position unless the medium is homogeneous.
//!
//! Where a medium varies, algorithms do not integrate it. They sample collisions with a medium
//! that has the coefficient σ_maj ≥ σ_t instead, constant over each [`Segment`] of the ray
//! ([`Medium::majorants`]), and decide at each collision whether it was one with the real medium:
//! null scattering ([Miller 2019]; [Pharr 2023 §11.2.1, §14.1.1]).
//!
//! A [`MediumInterface`] names the media on the two sides of a surface. A path carries its medium
//! along and exchanges it where it crosses such a surface.

mod cloud;
mod coefficients;
mod grid;
mod homogeneous;
mod majorants;
mod nano_vdb;
mod rgb_grid;
mod temperature;
mod uniform_grid;

pub use crate::id::MediumId;
pub use cloud::CloudMedium;
pub use coefficients::Coefficients;
pub use grid::Grid;
pub use homogeneous::HomogeneousMedium;
pub use majorants::{MajorantGrid, Majorants, Placement, Segment};
pub(crate) use nano_vdb::LargestVoxels;
pub use nano_vdb::{NanoVdbMedium, Voxels};
pub use rgb_grid::RgbGridMedium;
pub use temperature::Temperature;
pub use uniform_grid::{EmissionSource, GridEmission, UniformGridMedium};

use math::{Bounds3, Normal3, Point3, Ray, Vector3, closed_set};
use scattering::HenyeyGreenstein;
use spectrum::{SampledSpectrum, SampledWavelengths};

/// A row of the table of media.
#[derive(Clone, Debug)]
pub struct Medium {
    /// The member of the set.
    pub kind: MediumKind,
    /// Its phase function.
    pub phase: HenyeyGreenstein,
}

closed_set! {
    /// The kinds of media.
    #[derive(Clone, Debug)]
    pub enum MediumKind {
        /// See [`HomogeneousMedium`].
        Homogeneous(HomogeneousMedium),
        /// See [`UniformGridMedium`].
        UniformGrid(Box<UniformGridMedium>),
        /// See [`RgbGridMedium`].
        RgbGrid(Box<RgbGridMedium>),
        /// See [`CloudMedium`].
        Cloud(Box<CloudMedium>),
        /// See [`NanoVdbMedium`].
        NanoVdb(Box<NanoVdbMedium>),
    }
    each each_medium $
}

/// The interface of a kind of medium. Points and rays are in render space.
pub(crate) trait MediumModel {
    /// Whether it emits anywhere.
    fn is_emissive(&self) -> bool;

    /// The bounds of its box; `None` if it has none.
    fn bounds(&self) -> Option<Bounds3>;

    /// Its properties at a point.
    fn at(&self, p: Point3, lambda: &SampledWavelengths) -> MediumProperties;

    /// Its majorants on the ray up to `t_max`, which may be infinite.
    fn majorants<'a>(&'a self, ray: &Ray, t_max: f32, lambda: &SampledWavelengths) -> Majorants<'a>;
}

/// The properties of a medium at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MediumProperties {
    /// Coefficient of absorption, per unit of length.
    pub sigma_a: SampledSpectrum,
    /// Coefficient of scattering, per unit of length.
    pub sigma_s: SampledSpectrum,
    /// Emitted radiance, of which σ_a L_e is added per unit of length.
    pub le: SampledSpectrum,
}

impl MediumProperties {
    /// The coefficient of extinction.
    #[inline]
    pub fn sigma_t(&self) -> SampledSpectrum {
        self.sigma_a + self.sigma_s
    }
}

impl Medium {
    /// Whether it emits anywhere.
    pub fn is_emissive(&self) -> bool {
        each_medium!(&self.kind, medium => medium.is_emissive())
    }

    /// Bounds of the box outside of which there is nothing; `None` if it has none.
    pub fn bounds(&self) -> Option<Bounds3> {
        each_medium!(&self.kind, medium => medium.bounds())
    }

    /// Whether its properties differ from place to place.
    pub fn varies(&self) -> bool {
        !matches!(self.kind, MediumKind::Homogeneous(_))
    }

    /// The properties that it has everywhere, if it is homogeneous.
    pub fn homogeneous(&self, lambda: &SampledWavelengths) -> Option<MediumProperties> {
        match &self.kind {
            MediumKind::Homogeneous(medium) => Some(medium.at(Point3::ZERO, lambda)),
            _ => None,
        }
    }

    /// Its properties at a point.
    #[doc(alias = "SamplePoint")]
    pub fn at(&self, p: Point3, lambda: &SampledWavelengths) -> MediumProperties {
        each_medium!(&self.kind, medium => medium.at(p, lambda))
    }

    /// Its majorants on a ray of unit direction up to `t_max`, which may be infinite.
    #[doc(alias = "SampleRay")]
    pub fn majorants<'a>(&'a self, ray: &Ray, t_max: f32, lambda: &SampledWavelengths) -> Majorants<'a> {
        each_medium!(&self.kind, medium => medium.majorants(ray, t_max, lambda))
    }
}

/// The media on the two sides of a surface; `None` is empty space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MediumInterface {
    /// Behind the surface normal.
    pub inside: Option<MediumId>,
    /// Before it.
    pub outside: Option<MediumId>,
}

impl MediumInterface {
    /// Whether the media differ. Paths keep their medium at other surfaces.
    #[inline]
    pub fn is_transition(&self) -> bool {
        self.inside != self.outside
    }

    /// The medium on the side of a surface with normal `n` to which `w` points.
    #[inline]
    pub fn towards(&self, w: Vector3, n: Normal3) -> Option<MediumId> {
        if w.dot(n) > 0.0 { self.outside } else { self.inside }
    }
}
