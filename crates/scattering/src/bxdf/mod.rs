//! The BxDFs, and the enum of all.
//!
//! Every member is [`Scatter`]; the conventions are those at the head of the crate. A new
//! member needs a file, a variant and a line of [`each_bxdf!`](crate::each_bxdf).

mod body;
mod conductor;
mod dielectric;
mod diffuse;
mod diffuse_transmission;
mod hair;
mod layered;
mod measured;
mod normalized_fresnel;
mod openpbr;
mod scatter;
mod subsurface;
mod thin_dielectric;

pub use body::Body;
pub use conductor::Conductor;
pub use dielectric::Dielectric;
pub use diffuse::Diffuse;
pub use diffuse_transmission::DiffuseTransmission;
pub use hair::Hair;
pub use layered::{CoatedBase, Layered, inner_reflectance};
pub use measured::{Measured, MeasuredData, MeasuredGrid, MeasuredTable};
pub use normalized_fresnel::NormalizedFresnel;
pub use openpbr::{OpenPbr, OpenPbrParameters, OpenPbrTable, PlainOpenPbrTable};
pub use scatter::{BsdfSample, Scatter};
pub use subsurface::{Subsurface, SubsurfacePart};
pub use thin_dielectric::ThinDielectric;

use crate::{BxdfFlags, Directions, TransportMode};
use math::{Vec2, Vector3, closed_set};
use spectrum::SampledSpectrum;

closed_set! {
    /// Any BxDF, by value: made at each hit, without allocation. It may refer to tables of the
    /// scene.
    #[derive(Clone, Copy, Debug)]
    pub enum Bxdf<'a> {
        /// Lambertian reflection.
        Diffuse(Diffuse),
        /// Lambertian reflection and transmission.
        DiffuseTransmission(DiffuseTransmission),
        /// Metal, smooth or rough.
        Conductor(Conductor),
        /// Glass, smooth or rough.
        Dielectric(Dielectric),
        /// A smooth pane of glass without volume.
        ThinDielectric(ThinDielectric),
        /// A diffuse surface under a coat.
        CoatedDiffuse(Layered<Diffuse>),
        /// Metal under a coat.
        CoatedConductor(Layered<Conductor>),
        /// A fibre.
        Hair(Hair),
        /// A measured surface.
        Measured(Measured<'a>),
        /// A body that scatters light under its surface.
        Subsurface(Subsurface<'a>),
        /// Light that enters such a body.
        NormalizedFresnel(NormalizedFresnel),
        /// A principled surface.
        OpenPbr(OpenPbr<'a>),
    }
}

/// Evaluates an expression with the member of a [`Bxdf`](crate::Bxdf), whichever it is, under a
/// name.
///
/// ```
/// use alhazen_scattering::{Bxdf, Scatter, each_bxdf};
/// fn scatters(bxdf: &Bxdf) -> bool {
///     each_bxdf!(bxdf, member => !member.flags().is_empty())
/// }
/// ```
#[macro_export]
macro_rules! each_bxdf {
    ($bxdf:expr, $member:ident => $body:expr) => {
        match $bxdf {
            $crate::Bxdf::Diffuse($member) => $body,
            $crate::Bxdf::DiffuseTransmission($member) => $body,
            $crate::Bxdf::Conductor($member) => $body,
            $crate::Bxdf::Dielectric($member) => $body,
            $crate::Bxdf::ThinDielectric($member) => $body,
            $crate::Bxdf::CoatedDiffuse($member) => $body,
            $crate::Bxdf::CoatedConductor($member) => $body,
            $crate::Bxdf::Hair($member) => $body,
            $crate::Bxdf::Measured($member) => $body,
            $crate::Bxdf::Subsurface($member) => $body,
            $crate::Bxdf::NormalizedFresnel($member) => $body,
            $crate::Bxdf::OpenPbr($member) => $body,
        }
    };
}

impl Bxdf<'_> {
    /// The share of f that is diffuse, from 0 to 1, for two directions on the same side: what
    /// fibres scatter, or comes out of the depth of a surface. Facets mirror the rest. Fibres of
    /// hair and measured surfaces count as facets.
    pub fn diffuse_share(&self, wo: Vector3, wi: Vector3, mode: TransportMode) -> SampledSpectrum {
        let mirrored = match self {
            Self::Diffuse(_) | Self::DiffuseTransmission(_) | Self::NormalizedFresnel(_) => {
                return SampledSpectrum::ONE;
            }
            Self::Conductor(_)
            | Self::Dielectric(_)
            | Self::ThinDielectric(_)
            | Self::CoatedConductor(_)
            | Self::Hair(_)
            | Self::Measured(_) => return SampledSpectrum::ZERO,
            Self::OpenPbr(surface) => {
                let share = surface.diffused(wo, wi, mode).safe_div(self.f(wo, wi, mode));
                return share.map(|share| share.clamp(0.0, 1.0));
            }
            Self::CoatedDiffuse(layers) => layers.interface.f(wo, wi, mode),
            Self::Subsurface(body) => body.boundary.f(wo, wi, mode),
        };
        let share = mirrored.safe_div(self.f(wo, wi, mode));
        share.map(|share| 1.0 - share.clamp(0.0, 1.0))
    }

    /// The same for a sample in the local frame, on the side of `wo`. Where its value is that of
    /// one of many ways in which light takes its direction, it is the share of this one.
    pub fn diffuse_share_of(&self, wo: Vector3, sample: &BsdfSample, mode: TransportMode) -> SampledSpectrum {
        match self {
            _ if sample.flags.is_specular() => SampledSpectrum::ZERO,
            Self::CoatedDiffuse(_) if sample.pdf_is_proportional => {
                SampledSpectrum::splat(if sample.flags.is_diffuse() { 1.0 } else { 0.0 })
            }
            _ => self.diffuse_share(wo, sample.wi, mode),
        }
    }
}

// What has the code of all members is not inlined, which would copy it to each crate that calls it.
impl Scatter for Bxdf<'_> {
    #[inline]
    fn flags(&self) -> BxdfFlags {
        each_bxdf!(self, bxdf => bxdf.flags())
    }

    fn f(&self, wo: Vector3, wi: Vector3, mode: TransportMode) -> SampledSpectrum {
        each_bxdf!(self, bxdf => bxdf.f(wo, wi, mode))
    }

    fn sample_f(
        &self,
        wo: Vector3,
        uc: f32,
        u: Vec2,
        mode: TransportMode,
        directions: Directions,
    ) -> BsdfSample {
        each_bxdf!(self, bxdf => bxdf.sample_f(wo, uc, u, mode, directions))
    }

    fn pdf(&self, wo: Vector3, wi: Vector3, mode: TransportMode, directions: Directions) -> f32 {
        each_bxdf!(self, bxdf => bxdf.pdf(wo, wi, mode, directions))
    }

    #[inline]
    fn regularize(&mut self, mask: bool) {
        each_bxdf!(self, bxdf => bxdf.regularize(mask))
    }

    #[inline]
    fn seed(&mut self, seed: u32) {
        each_bxdf!(self, bxdf => Scatter::<f32>::seed(bxdf, seed))
    }
}

/// Makes each member a [`Bxdf`].
macro_rules! into_bxdf {
    ($($variant:ident($member:ty))*) => {$(
        impl<'a> From<$member> for Bxdf<'a> {
            #[inline]
            fn from(bxdf: $member) -> Self {
                Self::$variant(bxdf)
            }
        }
    )*};
}

into_bxdf! {
    Diffuse(Diffuse)
    DiffuseTransmission(DiffuseTransmission)
    Conductor(Conductor)
    Dielectric(Dielectric)
    ThinDielectric(ThinDielectric)
    CoatedDiffuse(Layered<Diffuse>)
    CoatedConductor(Layered<Conductor>)
    Hair(Hair)
    Measured(Measured<'a>)
    Subsurface(Subsurface<'a>)
    NormalizedFresnel(NormalizedFresnel)
    OpenPbr(OpenPbr<'a>)
}
