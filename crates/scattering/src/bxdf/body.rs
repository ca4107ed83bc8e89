//! Bodies: what paths that are followed under surfaces ask of a BxDF.

use super::{BsdfSample, Bxdf, OpenPbr, Subsurface, SubsurfacePart};
use crate::{Bssrdf, BxdfFlags, Interior, Scatter, SubsurfaceMethod, fr_dielectric};
use math::Vector3;

/// A BxDF of a surface under which light is scattered, to leave elsewhere.
#[derive(Clone, Copy, Debug)]
pub enum Body<'b, 'a> {
    /// Under a dielectric boundary.
    Subsurface(&'b Subsurface<'a>),
    /// Under a principled surface.
    OpenPbr(&'b OpenPbr<'a>),
}

impl<'a> Bxdf<'a> {
    /// The body under the surface, if there is one.
    #[inline]
    pub fn body(&self) -> Option<Body<'_, 'a>> {
        match self {
            Self::Subsurface(body) => Some(Body::Subsurface(body)),
            Self::OpenPbr(surface) if surface.interior().is_some() => Some(Body::OpenPbr(surface)),
            _ => None,
        }
    }

    /// Leaves of a body the boundary, by samples of which paths enter it.
    pub fn keep_boundary(&mut self) {
        match self {
            Self::Subsurface(body) => body.part = SubsurfacePart::Boundary,
            Self::OpenPbr(surface) => *surface = surface.boundary_part(),
            _ => (),
        }
    }

    /// Leaves of a body what light passes which comes from there: in all directions alike, or from
    /// a direction inside, which can be sampled only. `None` for other BxDFs.
    pub fn keep_leaving(&mut self, is_diffused: bool) -> Option<()> {
        match self {
            Self::Subsurface(body) if is_diffused => body.part = SubsurfacePart::Diffused,
            Self::Subsurface(body) => body.part = SubsurfacePart::Leaving,
            Self::OpenPbr(surface) => *surface = surface.leaving(),
            _ => return None,
        }
        Some(())
    }
}

impl<'a> Body<'_, 'a> {
    /// The profile by which light is followed; `None`: by a random walk.
    pub fn profile(&self) -> Option<&Bssrdf<'a>> {
        match self {
            Self::Subsurface(body) if body.method == SubsurfaceMethod::Diffusion => Some(&body.bssrdf),
            Self::Subsurface(_) | Self::OpenPbr(_) => None,
        }
    }

    /// Whether light leaves in all directions alike, whatever its direction inside.
    pub fn diffuses(&self) -> bool {
        matches!(self, Self::OpenPbr(_)) || self.profile().is_some()
    }

    /// Whether its boundary refracts light into one direction.
    pub fn is_smooth(&self) -> bool {
        match self {
            Self::Subsurface(body) => body.boundary.flags().is_specular(),
            Self::OpenPbr(_) => false,
        }
    }

    /// The medium.
    ///
    /// # Panics
    /// Never: bodies of principled surfaces have one.
    pub fn interior(&self) -> Interior {
        match self {
            Self::Subsurface(body) => body.bssrdf.interior(),
            Self::OpenPbr(surface) => *surface.interior().expect("invariant: it is a body"),
        }
    }

    /// The index of refraction by which paths enter, below over above.
    pub fn eta(&self) -> f32 {
        match self {
            Self::Subsurface(body) => body.boundary.eta,
            Self::OpenPbr(_) => 1.0,
        }
    }

    /// The lobe by which light enters, over all that does; a path from the camera leaves by it.
    pub fn exit(&self) -> Bxdf<'a> {
        match self {
            Self::Subsurface(body) => body.bssrdf.exit().into(),
            Self::OpenPbr(surface) => surface.entering().into(),
        }
    }

    /// Whether a path from the camera enters by a sample of the boundary.
    pub fn is_entered_by(&self, sample: &BsdfSample) -> bool {
        match self {
            Self::Subsurface(_) => sample.flags.is_transmissive(),
            Self::OpenPbr(_) => sample.flags.contains(BxdfFlags::DIFFUSE_TRANSMISSION),
        }
    }

    /// The probability with which a light path from `wo`, above, in the local frame, does not go
    /// under the surface.
    pub fn boundary_probability(&self, wo: Vector3) -> f32 {
        match self {
            Self::Subsurface(body) => fr_dielectric(wo.z, body.boundary.eta),
            Self::OpenPbr(surface) => 1.0 - surface.chance_under(wo),
        }
    }
}
