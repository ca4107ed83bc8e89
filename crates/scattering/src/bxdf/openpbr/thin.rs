//! Thin walls: sheets of glass, of paper, of leaves, the same on both sides and without an inside.
//!
//! Light that glass transmits goes on in its direction; between the sides of the sheet it is
//! reflected again and again. With the reflectance F of a side and the transmittance a of what is
//! between them, the sheet
//!
//! ```text
//! reflects R = F + a² F (1 − F)²/(1 − a² F²)        and transmits T = a (1 − F)²/(1 − a² F²)
//! ```
//!
//! by facets as `Stack::sheet` has them. The share of the base that scatters under its surface
//! reflects (1 − g)/2 and transmits (1 + g)/2 of it diffusely. Metal and the rest of the base are
//! opaque. Coat and fuzz lie on both sides, but take light only once, as for reflection: by what
//! they pass on in the direction in which they pass less. Source: [OpenPBR 2024].

use super::mirror::Mirror;
use super::oren_nayar::oren_nayar;
use super::shares::{Rests, Shares};
use super::{OpenPbr, mirrored, of_viewer, turned};
use crate::{BsdfSample, BxdfFlags, TransportMode};
use lanes::{Mask, Real};
use math::{Vec2, Vector3};
use spectrum::SampledSpectrum;
use std::f32::consts::PI;

impl<R: Real> OpenPbr<'_, R> {
    /// What a smooth sheet reflects and transmits of light at a cosine.
    #[inline(always)]
    pub(super) fn sheet_shares(&self, cosine: R) -> [SampledSpectrum<R>; 2] {
        let one = SampledSpectrum::splat(R::one());
        let f = self.stack.dielectrics(cosine, &self.waves);
        let a = self.transmission_color;
        let passed = (one - f) * (one - f);
        // Both are 1 where a side reflects everything.
        let sum = (one - a * a * f * f).max(SampledSpectrum::splat(R::splat(1e-6)));
        [f + a * a * f * passed / sum, a * passed / sum]
    }

    /// The value of a share of what is scattered within the wall, for two directions above.
    #[inline(always)]
    pub(super) fn scattered(&self, share: R, wo: Vector3<R>, wi: Vector3<R>) -> SampledSpectrum<R> {
        let white = SampledSpectrum::splat(R::one());
        self.diffuse_base.scattered * oren_nayar(white, self.diffuse_base.roughness, wo, wi) * share
    }

    /// The value of a thin wall for a direction above and one below.
    #[inline(always)]
    pub(super) fn passed_through(
        &self,
        [o, i]: [&Shares<R>; 2],
        rests: &Rests<R>,
        [wo, wi]: [Vector3<R>; 2],
        mode: TransportMode,
    ) -> SampledSpectrum<R> {
        let wi = turned(wi);
        let weights = self.weights(R::one());
        let mut f = SampledSpectrum::zero();
        if weights.glass.gt(R::zero()).any() {
            let mirror = Mirror::new(&self.stack.sheet(), wo, wi);
            let white = mirror.f * o.taken.below_coat.min(i.taken.below_coat);
            let [_, passed] = self.sheet_shares(mirror.cosine);
            f += passed * (white * weights.glass);
            let has_rest = rests.glass_above.gt(R::zero());
            let left = o.glass_rest * i.glass_rest / (R::splat(PI) * rests.glass_above);
            let again = R::select(has_rest, left * rests.through_above, R::zero());
            f += self.transmission_color * (again * weights.glass);
        }
        let is_diffuse = weights.diffuse.gt(R::zero()) & self.transmits_diffusely();
        if is_diffuse.any() {
            let left = (o.diffuse_rest * i.diffuse_rest).safe_div(rests.diffuse);
            f += self.scattered(self.diffuse_base.forward, wo, wi) * left * self.darkening * weights.diffuse;
        }
        let seen = of_viewer([o.seen, i.seen], mode);
        f * self.absorbed(self.coat_length(wo.z) + self.coat_length(wi.z)) * seen
    }

    /// A direction in which a sheet of glass transmits light from one above, without its value, and
    /// of the density only that of a smooth sheet.
    #[inline(always)]
    pub(super) fn sample_sheet(&self, wo: Vector3<R>, u: Vec2<R>) -> BsdfSample<R> {
        let sample = mirrored(&self.stack.sheet(), wo, u);
        let flags = BxdfFlags::choose(
            sample.flags.is_specular(),
            BxdfFlags::SPECULAR_TRANSMISSION,
            BxdfFlags::GLOSSY_TRANSMISSION,
        );
        BsdfSample { wi: turned(sample.wi), flags, ..sample }
    }

    /// The density of [`Self::sample_sheet`] for a direction above and one below.
    #[inline(always)]
    pub(super) fn pdf_sheet(&self, wo: Vector3<R>, wi: Vector3<R>) -> R {
        Mirror::new(&self.stack.sheet(), wo, turned(wi)).pdf
    }
}
