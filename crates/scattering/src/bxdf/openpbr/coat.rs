//! The coat: a dielectric layer, whose normal may be another than that of the base.
//!
//! A coat that is tilted reflects light about its own normal, as normal maps do: its value has the
//! cosine of the light's direction to the coat instead of that to the base. What it takes of a
//! direction is what it takes at the angle to its normal, and the base gets the rest; the means of
//! what is left are those of a coat that is not tilted: one that is by 20° gains up to 4 % of
//! light, at grazing angles a sixth. Light that it would mirror below the base meets the base
//! alone; near to that a part does.

use super::mirror::Mirror;
use super::shares::Shares;
use super::stack::Taken;
use super::{OpenPbr, is_off_horizon, mirrored, upright};
use crate::{BsdfSample, TransportMode, fr_dielectric};
use lanes::{Mask, Real};
use math::{Frame, Vec2, Vec3, Vector3, sqr};

impl<R: Real> OpenPbr<'_, R> {
    /// Whether the normal of the coat is another than that of the base.
    #[inline(always)]
    pub(super) fn is_tilted(&self) -> R::Mask {
        let Vec3 { x, y, z } = self.coat_normal;
        x.ne(R::zero()) | y.ne(R::zero()) | z.ne(R::one())
    }

    /// The frame of a tilted coat.
    #[inline(always)]
    fn coat_frame(&self) -> Frame<R> {
        Frame::from_z_and_x(self.coat_normal, Vec3::broadcast(Vec3::X))
    }

    /// A direction above, as the coat has it.
    #[inline(always)]
    fn on_coat(&self, w: Vector3<R>) -> Vector3<R> {
        let is_tilted = self.is_tilted();
        if !is_tilted.any() {
            return w;
        }
        Vec3::select(is_tilted, self.coat_frame().to_local(w), w)
    }

    /// The share of light from a tilted coat that is mirrored above the base, by its cosine there.
    #[inline(always)]
    fn mirrored_above(&self, z: R) -> R {
        let width = R::splat(0.5) * (R::one() - sqr(self.coat_normal.z)).sqrt();
        (z / width.max(R::splat(1e-3))).clamp(R::zero(), R::one())
    }

    /// The value for two directions above, of light that has passed the fuzz.
    #[inline(always)]
    pub(super) fn coat(&self, wo: Vector3<R>, wi: Vector3<R>, mode: TransportMode) -> R {
        let (coat_wo, coat_wi) = (self.on_coat(wo), self.on_coat(wi));
        let is_above = is_above(coat_wo) & is_above(coat_wi);
        let mirror = Mirror::new(&self.stack.coat, coat_wo, coat_wi);
        let f = fr_dielectric(mirror.cosine, self.stack.coat_ior) * mirror.f;
        let f = R::select(is_above, f, R::zero());
        let is_tilted = self.is_tilted();
        if !is_tilted.any() {
            return f;
        }
        let tilted = match mode {
            TransportMode::Radiance => f * coat_wi.z / wi.z * self.mirrored_above(wi.z),
            TransportMode::Importance => f * coat_wo.z / wo.z * self.mirrored_above(wo.z),
        };
        R::select(is_tilted, tilted, f)
    }

    /// What a smooth coat reflects of the light from a direction above into its mirror image, times
    /// the cosine of that.
    #[inline(always)]
    pub(super) fn specular_coat(&self, wo: Vector3<R>, wi: Vector3<R>, mode: TransportMode) -> R {
        let reflected = fr_dielectric(self.on_coat(wo).z, self.stack.coat_ior);
        let is_tilted = self.is_tilted();
        if !is_tilted.any() {
            return reflected;
        }
        let tilted = match mode {
            TransportMode::Radiance => reflected * self.mirrored_above(wi.z),
            TransportMode::Importance => reflected * wi.z / wo.z * self.mirrored_above(wo.z),
        };
        R::select(is_tilted, tilted, reflected)
    }

    /// A direction in which the coat reflects light, as `mirrored` has it, for one above.
    #[inline(always)]
    pub(super) fn sample_coat(&self, wo: Vector3<R>, u: Vec2<R>) -> BsdfSample<R> {
        let is_tilted = self.is_tilted();
        let coat_wo = self.on_coat(wo);
        let sample = mirrored(&self.stack.coat, coat_wo, u);
        if !is_tilted.any() {
            return sample;
        }
        let wi = Vec3::select(is_tilted, self.coat_frame().from_local(sample.wi), sample.wi);
        let valid = sample.valid & (!is_tilted | is_above(coat_wo) & is_above(wi));
        BsdfSample { wi, valid, ..sample }
    }

    /// The density of [`Self::sample_coat`] for two directions above.
    #[inline(always)]
    pub(super) fn pdf_coat(&self, wo: Vector3<R>, wi: Vector3<R>) -> R {
        let (wo, wi) = (self.on_coat(wo), self.on_coat(wi));
        let mirror = Mirror::new(&self.stack.coat, wo, wi);
        R::select(is_above(wo) & is_above(wi), mirror.pdf, R::zero())
    }

    /// The shares of a direction off the horizon, with those of a coat that is tilted.
    #[inline(always)]
    pub(super) fn under_coat(&self, shares: Shares<R>, w: Vector3<R>) -> Shares<R> {
        let is_tilted = self.is_tilted();
        if !is_tilted.any() {
            return shares;
        }
        let w = upright(w.z.lt(R::zero()), w);
        let on_coat = self.on_coat(w);
        let least = R::splat(f32::MIN_POSITIVE);
        let at_coat = self.table.taken(&self.location, self.waves[0], on_coat);
        let mirrored = self.mirrored_above(R::splat(2.0) * on_coat.z * self.coat_normal.z - w.z);
        let reflected = at_coat.coat / (at_coat.left + at_coat.coat).max(least) * mirrored;
        let reflected = R::select(is_above(on_coat), reflected, R::zero());
        let taken = shares.taken;
        let coat = R::select(is_tilted, shares.below_fuzz() * reflected, taken.coat);
        let left = R::select(is_tilted, shares.below_fuzz() - coat, taken.left);
        let scale = R::select(is_tilted, left / taken.left.max(least), R::one());
        let taken = Taken {
            coat,
            left,
            below_coat: taken.below_coat * scale,
            metal: taken.metal * scale,
            dielectric: taken.dielectric * scale,
            refracted: taken.refracted * scale,
            ..taken
        };
        Shares {
            taken,
            dielectric: shares.dielectric * scale,
            diffuse_rest: shares.diffuse_rest * scale,
            reflected: shares.reflected * scale,
            refracted: shares.refracted * scale,
            glass_rest: shares.glass_rest * scale,
            ..shares
        }
    }
}

/// Whether a direction is above a surface, and off its horizon.
#[inline(always)]
fn is_above<R: Real>(w: Vector3<R>) -> R::Mask {
    w.z.gt(R::zero()) & is_off_horizon(w)
}
