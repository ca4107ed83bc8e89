//! A photon: power of a light subpath that has arrived at a surface.
//!
//! The photons of a pass and all camera rays that look for them have one time and the same
//! wavelengths, so that light which one carries is light at the wavelengths of the other.

use math::{Normal3, Point3, Vector3};
use spectrum::SampledSpectrum;

use crate::bidirectional::Vertex;

/// Light that has arrived at a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Photon {
    /// Where.
    pub p: Point3,
    /// Geometric normal there.
    pub n: Normal3,
    /// Unit direction to where it came from.
    pub wi: Vector3,
    /// Power, over the density of the subpath, if the surface is there for every ray; to be divided
    /// by the number of subpaths.
    pub beta: SampledSpectrum,
    /// Scattering events on the subpath, the one here included.
    pub depth: u32,
    /// Whether only the first wavelength is left.
    pub hero_only: bool,
}

impl Photon {
    /// The one that a vertex of a light subpath leaves.
    pub fn at(vertex: &Vertex) -> Self {
        let &Vertex { p, n, wo: wi, depth, hero_only, .. } = vertex;
        Self { p: p.p, n, wi, beta: vertex.photon_beta(), depth, hero_only }
    }

    /// Whether it is somewhere, with a finite power.
    pub fn is_finite(&self) -> bool {
        self.p.is_finite() && self.beta.is_finite()
    }
}
