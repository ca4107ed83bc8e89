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
use super::{OpenPbr, flip, is_off_horizon, mirrored};
use crate::{BsdfSample, TransportMode, fr_dielectric};
use math::{Frame, Vec2, Vec3, Vector3, sqr};

/// The frame of a coat with a normal other than z.
fn frame(normal: Vector3) -> Frame {
    Frame::from_z_and_x(normal, Vec3::X)
}

impl OpenPbr<'_> {
    pub(super) fn is_tilted(&self) -> bool {
        self.coat_normal != Vec3::Z
    }

    /// A direction above, as the coat has it.
    fn on_coat(&self, w: Vector3) -> Vector3 {
        if self.is_tilted() { frame(self.coat_normal).to_local(w) } else { w }
    }

    /// Of two directions above: themselves as the coat has them, and the facets that mirror one
    /// into the other. `None` for smooth coats, and where one is behind the coat.
    fn mirror(&self, wo: Vector3, wi: Vector3) -> Option<(Mirror, [Vector3; 2])> {
        let directions @ [wo, wi] = [wo, wi].map(|w| self.on_coat(w));
        let is_above = directions.iter().all(|w| w.z > 0.0 && is_off_horizon(*w));
        let mirror = is_above.then(|| Mirror::new(&self.stack.coat, wo, wi)).flatten()?;
        Some((mirror, directions))
    }

    /// The share of light from a tilted coat that is mirrored above the base, by its cosine there.
    fn mirrored_above(&self, z: f32) -> f32 {
        let width = 0.5 * (1.0 - sqr(self.coat_normal.z)).sqrt();
        (z / width.max(1e-3)).clamp(0.0, 1.0)
    }

    /// The value for two directions above, of light that has passed the fuzz.
    pub(super) fn coat(&self, wo: Vector3, wi: Vector3, mode: TransportMode) -> f32 {
        let Some((mirror, [coat_wo, coat_wi])) = self.mirror(wo, wi) else { return 0.0 };
        let f = fr_dielectric(mirror.cosine, self.stack.coat_ior) * mirror.f;
        match mode {
            _ if !self.is_tilted() => f,
            TransportMode::Radiance => f * coat_wi.z / wi.z * self.mirrored_above(wi.z),
            TransportMode::Importance => f * coat_wo.z / wo.z * self.mirrored_above(wo.z),
        }
    }

    /// What a smooth coat reflects of the light from a direction above into its mirror image, times
    /// the cosine of that.
    pub(super) fn specular_coat(&self, wo: Vector3, wi: Vector3, mode: TransportMode) -> f32 {
        let reflected = fr_dielectric(self.on_coat(wo).z, self.stack.coat_ior);
        match mode {
            _ if !self.is_tilted() => reflected,
            TransportMode::Radiance => reflected * self.mirrored_above(wi.z),
            TransportMode::Importance => reflected * wi.z / wo.z * self.mirrored_above(wo.z),
        }
    }

    /// A direction in which the coat reflects light, as `mirrored` has it, for one above.
    pub(super) fn sample_coat(&self, wo: Vector3, u: Vec2) -> BsdfSample {
        if !self.is_tilted() {
            return mirrored(&self.stack.coat, wo, u);
        }
        let frame = frame(self.coat_normal);
        let wo = frame.to_local(wo);
        if !(wo.z > 0.0 && is_off_horizon(wo)) {
            return BsdfSample::invalid();
        }
        let sample = mirrored(&self.stack.coat, wo, u);
        let wi = frame.from_local(sample.wi);
        BsdfSample { wi, valid: sample.valid && wi.z > 0.0 && is_off_horizon(wi), ..sample }
    }

    /// The density of [`Self::sample_coat`] for two directions above.
    pub(super) fn pdf_coat(&self, wo: Vector3, wi: Vector3) -> f32 {
        self.mirror(wo, wi).map_or(0.0, |(mirror, _)| mirror.pdf)
    }

    /// The shares of a direction off the horizon, with those of a coat that is tilted.
    pub(super) fn under_coat(&self, shares: Shares, w: Vector3) -> Shares {
        if !self.is_tilted() {
            return shares;
        }
        let w = flip(w.z < 0.0, w);
        let on_coat = self.on_coat(w);
        let mut reflected = 0.0;
        if on_coat.z > 0.0 && is_off_horizon(on_coat) {
            let taken = self.table.taken(&self.numbers, self.waves[0], on_coat);
            reflected = taken.coat / (taken.left + taken.coat).max(f32::MIN_POSITIVE);
            reflected *= self.mirrored_above(2.0 * on_coat.z * self.coat_normal.z - w.z);
        }
        let coat = shares.below_fuzz() * reflected;
        let left = shares.below_fuzz() - coat;
        let taken = &shares.taken;
        let scale = left / taken.left.max(f32::MIN_POSITIVE);
        Shares {
            taken: Taken {
                coat,
                left,
                below_coat: taken.below_coat * scale,
                metal: taken.metal * scale,
                dielectric: taken.dielectric * scale,
                refracted: taken.refracted * scale,
                ..*taken
            },
            dielectric: shares.dielectric * scale,
            diffuse_rest: shares.diffuse_rest * scale,
            reflected: shares.reflected * scale,
            refracted: shares.refracted * scale,
            glass_rest: shares.glass_rest * scale,
        }
    }
}
