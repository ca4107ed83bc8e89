//! A photon: the power of a light subpath that arrives at a surface or at a point in a medium.
//!
//! The photons and the camera paths of a pass share one time and the same wavelengths.

use math::{Normal3, Point3, Vector3};
use spectrum::SampledSpectrum;

use crate::bidirectional::Vertex;

/// Power that has arrived at a surface or at a point in a medium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Photon {
    /// Position.
    pub p: Point3,
    /// Geometric normal there; zero in a medium.
    pub n: Normal3,
    /// Unit direction to the previous vertex.
    pub wi: Vector3,
    /// Power, over the density of the subpath and over alpha (in a medium, the coefficient of
    /// scattering); to be divided by the number of subpaths.
    pub beta: SampledSpectrum,
    /// Scattering events on the subpath, this one included.
    pub depth: u32,
    /// Whether all wavelengths but the first are terminated.
    pub hero_only: bool,
}

impl Photon {
    /// The photon at a vertex of a light subpath.
    pub fn at(vertex: &Vertex) -> Self {
        let &Vertex { p, n, wo: wi, depth, hero_only, .. } = vertex;
        Self { p: p.p, n, wi, beta: vertex.photon_beta(), depth, hero_only }
    }

    /// Whether position and power are finite.
    pub fn is_finite(&self) -> bool {
        self.p.is_finite() && self.beta.is_finite()
    }
}
