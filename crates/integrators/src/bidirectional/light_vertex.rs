//! The vertices of light subpaths that are stored for merging.

use math::{Point3, Vector3};
use scene::light::LightId;
use spectrum::SampledSpectrum;

use super::{Partial, Vertex};

/// In place of the number of a light: the subpath began in a medium.
const NO_LIGHT: u32 = u32::MAX;

/// A vertex of a light subpath, stored for merging: a photon with its partial MIS weights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LightVertex {
    /// Position.
    pub p: Point3,
    /// Unit direction to the previous vertex.
    pub wo: Vector3,
    /// |cos| of that direction to the geometric normal; 1 in a medium.
    pub cos_theta: f32,
    /// Power that arrives along `wo`, over the density of the subpath and over alpha (in a medium,
    /// σ_s).
    pub beta: SampledSpectrum,
    /// Partial MIS weights.
    pub partial: Partial,
    /// The number of the subpath's light, or [`NO_LIGHT`]: a photon takes 64 bytes.
    pub light: u32,
    /// Scattering events on the subpath, that at the photon included.
    pub depth: u16,
    /// Whether all wavelengths but the first are terminated.
    pub hero_only: bool,
    /// Whether it lies in a medium.
    pub is_in_medium: bool,
}

impl LightVertex {
    /// The light of the subpath; `None` for a medium.
    pub fn light(&self) -> Option<LightId> {
        (self.light != NO_LIGHT).then_some(LightId(self.light))
    }
}

impl From<&Vertex<'_>> for LightVertex {
    fn from(vertex: &Vertex) -> Self {
        let &Vertex { p, wo, partial, light, depth, hero_only, .. } = vertex;
        let (beta, depth) = (vertex.photon_beta(), depth.min(u16::MAX.into()) as u16);
        let cos_theta = vertex.cos_theta(wo);
        let (is_in_medium, light) = (vertex.is_in_medium(), light.map_or(NO_LIGHT, |light| light.0));
        Self { p: p.p, wo, cos_theta, beta, partial, light, depth, hero_only, is_in_medium }
    }
}
