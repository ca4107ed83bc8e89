//! The coat: a dielectric layer, whose normal may be another than that of the base.
//!
//! A coat that is tilted reflects light about its own normal, as normal maps do: its value has the
//! cosine of the light's direction to the coat instead of that to the base. What it would mirror
//! below the base is mirrored by that, so that it reflects
//!
//! ```text
//! R(ωo) = h(ωo) E(ωo·n_coat)        E: as a coat that is not tilted, h: its share of the surface
//! ```
//!
//! to a viewer at ωo. h falls to zero where the mirror image of ωo nears the horizon of the base:
//! there the base is seen alone. The base scatters as under a coat that is not tilted, times what
//! the tilted coat leaves over what that one leaves for ωo: light comes in through the coat on
//! average, and out through the coat that is seen. So nothing is lost or gained of what a viewer
//! sees in uniform light; of the light from one direction a tilted coat scatters more or less, as
//! all normal maps do, and f is not reciprocal. From inside glass tilts are not seen.

use super::mirror::Mirror;
use super::shares::Shares;
use super::{OpenPbr, is_off_horizon, mirrored, turned, upright};
use crate::{BsdfSample, TransportMode, fr_dielectric};
use lanes::{Mask, Real};
use math::{Frame, Vec2, Vec3, Vector3, lerp, sqr};

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

    /// h: the share of the surface that a tilted coat is for a viewer above.
    #[inline(always)]
    fn coat_share(&self, w: Vector3<R>, on_coat: Vector3<R>) -> R {
        let mirrored = R::splat(2.0) * on_coat.z * self.coat_normal.z - w.z;
        let width = R::splat(0.5) * (R::one() - sqr(self.coat_normal.z)).sqrt();
        let share = (mirrored / width.max(R::splat(1e-3))).clamp(R::zero(), R::one());
        R::select(is_above(on_coat), share, R::zero())
    }

    /// What facets of the coat reflect between two directions as the coat has them, if they are
    /// above it.
    #[inline(always)]
    fn coat_facets(&self, wo: Vector3<R>, wi: Vector3<R>) -> R {
        let mirror = Mirror::new(&self.stack.coat, wo, wi);
        let f = fr_dielectric(mirror.cosine, self.stack.coat_ior) * mirror.f;
        R::select(is_above(wo) & is_above(wi), f, R::zero())
    }

    /// The value for two directions above, of light that has passed the fuzz.
    #[inline(always)]
    pub(super) fn coat(&self, wo: Vector3<R>, wi: Vector3<R>, mode: TransportMode) -> R {
        let f = self.coat_facets(self.on_coat(wo), self.on_coat(wi));
        let is_tilted = self.is_tilted();
        if !is_tilted.any() {
            return f;
        }
        let tilted = match mode {
            TransportMode::Radiance => self.tilted_coat(wo, wi),
            TransportMode::Importance => self.tilted_coat(wi, wo),
        };
        R::select(is_tilted, tilted, f)
    }

    /// The value of a tilted coat for a viewer and light from another direction, both above.
    #[inline(always)]
    fn tilted_coat(&self, viewer: Vector3<R>, light: Vector3<R>) -> R {
        let on_coat = self.on_coat(viewer);
        let (direct, mirrored) = (self.on_coat(light), self.on_coat(turned(light)));
        let direct = self.coat_facets(on_coat, direct) * direct.z;
        let mirrored = self.coat_facets(on_coat, mirrored) * mirrored.z;
        (direct + mirrored) / light.z * self.coat_share(viewer, on_coat)
    }

    /// What a smooth coat reflects of the light from a direction above into its mirror image, times
    /// the cosine of that.
    #[inline(always)]
    pub(super) fn specular_coat(&self, wo: Vector3<R>, wi: Vector3<R>, mode: TransportMode) -> R {
        let on_coat = self.on_coat(wo);
        let reflected = fr_dielectric(on_coat.z, self.stack.coat_ior);
        let is_tilted = self.is_tilted();
        if !is_tilted.any() {
            return reflected;
        }
        let tilted = match mode {
            TransportMode::Radiance => reflected * self.coat_share(wo, on_coat),
            TransportMode::Importance => reflected * wi.z / wo.z * self.coat_share(wi, self.on_coat(wi)),
        };
        R::select(is_tilted, tilted, reflected)
    }

    /// The probability that light from a direction above meets a tilted coat there, and not from
    /// where the base mirrors it.
    #[inline(always)]
    fn meets_coat(&self, w: Vector3<R>) -> R {
        let direct = self.on_coat(w).z.max(R::zero());
        let mirrored = self.on_coat(turned(w)).z.max(R::zero());
        let is_smooth = self.stack.coat.effectively_smooth();
        let chance = direct / (direct + mirrored).max(R::splat(f32::MIN_POSITIVE));
        R::select(is_smooth, R::one(), chance)
    }

    /// A direction in which the coat reflects light, as `mirrored` has it, for one above.
    #[inline(always)]
    pub(super) fn sample_coat(
        &self,
        wo: Vector3<R>,
        uc: R,
        u: Vec2<R>,
        mode: TransportMode,
    ) -> BsdfSample<R> {
        let is_tilted = self.is_tilted();
        let mut coat_wo = self.on_coat(wo);
        if is_tilted.any() && mode == TransportMode::Importance {
            let is_direct = !is_tilted | uc.lt(self.meets_coat(wo));
            coat_wo = Vec3::select(is_direct, coat_wo, self.on_coat(turned(wo)));
        }
        let sample = mirrored(&self.stack.coat, coat_wo, u);
        if !is_tilted.any() {
            return sample;
        }
        let mut wi = self.coat_frame().from_local(sample.wi);
        if mode == TransportMode::Radiance {
            let is_rough = !self.stack.coat.effectively_smooth();
            wi = Vec3::select(is_rough & wi.z.lt(R::zero()), turned(wi), wi);
        }
        let valid = sample.valid & (!is_tilted | is_above(coat_wo) & is_above(wi));
        BsdfSample { wi: Vec3::select(is_tilted, wi, sample.wi), valid, ..sample }
    }

    /// The density of [`Self::sample_coat`] for two directions above.
    #[inline(always)]
    pub(super) fn pdf_coat(&self, wo: Vector3<R>, wi: Vector3<R>, mode: TransportMode) -> R {
        let (coat_wo, coat_wi) = (self.on_coat(wo), self.on_coat(wi));
        let direct = self.pdf_on_coat(coat_wo, coat_wi);
        let is_tilted = self.is_tilted();
        if !is_tilted.any() {
            return direct;
        }
        let tilted = match mode {
            TransportMode::Radiance => direct + self.pdf_on_coat(coat_wo, self.on_coat(turned(wi))),
            TransportMode::Importance => {
                let mirrored = self.pdf_on_coat(self.on_coat(turned(wo)), coat_wi);
                lerp(self.meets_coat(wo), mirrored, direct)
            }
        };
        R::select(is_tilted, tilted, direct)
    }

    /// The density of the facets of the coat for two directions as the coat has them.
    #[inline(always)]
    fn pdf_on_coat(&self, wo: Vector3<R>, wi: Vector3<R>) -> R {
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
        let passed = at_coat.below_coat / (at_coat.left + at_coat.coat).max(least);
        let reflected = (R::one() - passed) * self.coat_share(w, on_coat);
        let coat = R::select(is_tilted, shares.below_fuzz() * reflected, shares.coat);
        let left = shares.below_fuzz() * (R::one() - reflected);
        let seen = R::select(is_tilted, left / shares.taken.left.max(least), R::one());
        Shares { coat, seen, ..shares }
    }
}

/// Whether a direction is above a surface, and off its horizon.
#[inline(always)]
fn is_above<R: Real>(w: Vector3<R>) -> R::Mask {
    w.z.gt(R::zero()) & is_off_horizon(w)
}
