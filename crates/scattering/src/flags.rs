//! The kinds of scattering of a BxDF, and those requested of it.

use lanes::{Int, Real};
use std::ops::{BitAnd, BitOr, BitOrAssign, Not};

/// A set of kinds of scattering, for each lane: where to (reflection, transmission) and how widely
/// (diffuse, glossy, specular).
///
/// The set of a sample names one lobe; that of a BxDF names all of its lobes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BxdfFlags<R: Real = f32>(R::Int);

impl BxdfFlags {
    /// No scattering at all.
    pub const NONE: Self = Self(0);
    /// Reflection: light stays on its side of the surface.
    pub const REFLECTION: Self = Self(1);
    /// Transmission: light passes through the surface.
    pub const TRANSMISSION: Self = Self(1 << 1);
    /// Diffuse: all directions of a hemisphere.
    pub const DIFFUSE: Self = Self(1 << 2);
    /// Glossy: a lobe of directions.
    pub const GLOSSY: Self = Self(1 << 3);
    /// Specular: one direction, a Dirac delta.
    pub const SPECULAR: Self = Self(1 << 4);
    /// Diffuse reflection.
    pub const DIFFUSE_REFLECTION: Self = Self(Self::DIFFUSE.0 | Self::REFLECTION.0);
    /// Diffuse transmission.
    pub const DIFFUSE_TRANSMISSION: Self = Self(Self::DIFFUSE.0 | Self::TRANSMISSION.0);
    /// Glossy reflection.
    pub const GLOSSY_REFLECTION: Self = Self(Self::GLOSSY.0 | Self::REFLECTION.0);
    /// Glossy transmission.
    pub const GLOSSY_TRANSMISSION: Self = Self(Self::GLOSSY.0 | Self::TRANSMISSION.0);
    /// Specular reflection.
    pub const SPECULAR_REFLECTION: Self = Self(Self::SPECULAR.0 | Self::REFLECTION.0);
    /// Specular transmission.
    pub const SPECULAR_TRANSMISSION: Self = Self(Self::SPECULAR.0 | Self::TRANSMISSION.0);
}

impl<R: Real> BxdfFlags<R> {
    /// The same set in all lanes.
    #[inline(always)]
    pub fn splat(flags: BxdfFlags) -> Self {
        Self(R::Int::splat(flags.0))
    }

    /// `flags` where the mask is true, else no scattering.
    #[inline(always)]
    pub fn only_where(mask: R::Mask, flags: BxdfFlags) -> Self {
        Self::choose(mask, flags, BxdfFlags::NONE)
    }

    /// `a` where the mask is true, else `b`.
    #[inline(always)]
    pub fn select(mask: R::Mask, a: Self, b: Self) -> Self {
        Self(R::Int::select(mask, a.0, b.0))
    }

    /// `a` where the mask is true, else `b`, each the same in all lanes.
    #[inline(always)]
    pub fn choose(mask: R::Mask, a: BxdfFlags, b: BxdfFlags) -> Self {
        Self::select(mask, Self::splat(a), Self::splat(b))
    }

    /// Whether every kind of `other` is in this set.
    #[inline(always)]
    pub fn contains(self, other: BxdfFlags) -> R::Mask {
        let other = R::Int::splat(other.0);
        (self.0 & other).eq(other)
    }

    /// Whether some kind of `other` is in this set.
    #[inline(always)]
    pub fn intersects(self, other: BxdfFlags) -> R::Mask {
        !(self.0 & R::Int::splat(other.0)).eq(R::Int::splat(0))
    }

    /// Whether the set is empty.
    #[inline(always)]
    pub fn is_empty(self) -> R::Mask {
        self.0.eq(R::Int::splat(0))
    }

    /// Whether light is reflected.
    #[inline(always)]
    pub fn is_reflective(self) -> R::Mask {
        self.contains(BxdfFlags::REFLECTION)
    }

    /// Whether light is transmitted.
    #[inline(always)]
    pub fn is_transmissive(self) -> R::Mask {
        self.contains(BxdfFlags::TRANSMISSION)
    }

    /// Whether there is a diffuse lobe.
    #[inline(always)]
    pub fn is_diffuse(self) -> R::Mask {
        self.contains(BxdfFlags::DIFFUSE)
    }

    /// Whether there is a glossy lobe.
    #[inline(always)]
    pub fn is_glossy(self) -> R::Mask {
        self.contains(BxdfFlags::GLOSSY)
    }

    /// Whether there is a specular lobe.
    #[inline(always)]
    pub fn is_specular(self) -> R::Mask {
        self.contains(BxdfFlags::SPECULAR)
    }

    /// Whether there is a lobe for which `f` is not zero: a diffuse or glossy one.
    #[inline(always)]
    pub fn is_non_specular(self) -> R::Mask {
        self.intersects(BxdfFlags::DIFFUSE | BxdfFlags::GLOSSY)
    }
}

impl<R: Real> BitOr for BxdfFlags<R> {
    type Output = Self;

    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl<R: Real> BitOrAssign for BxdfFlags<R> {
    #[inline(always)]
    fn bitor_assign(&mut self, other: Self) {
        *self = *self | other;
    }
}

impl<R: Real> BitAnd for BxdfFlags<R> {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

/// Which sides of the surface a sample may go to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[doc(alias = "BxDFReflTransFlags")]
pub enum Directions {
    /// Both sides.
    #[default]
    All,
    /// The side of `wo` alone.
    Reflection,
    /// The other side alone.
    Transmission,
}

impl Directions {
    /// Whether reflection may be sampled.
    #[inline]
    pub fn reflection(self) -> bool {
        self != Self::Transmission
    }

    /// Whether transmission may be sampled.
    #[inline]
    pub fn transmission(self) -> bool {
        self != Self::Reflection
    }

    /// Whether a BxDF with `flags` scatters to some of these directions.
    #[inline(always)]
    pub fn meet<R: Real>(self, flags: BxdfFlags<R>) -> R::Mask {
        match self {
            Self::All => flags.intersects(BxdfFlags::REFLECTION | BxdfFlags::TRANSMISSION),
            Self::Reflection => flags.is_reflective(),
            Self::Transmission => flags.is_transmissive(),
        }
    }

    /// The probability of reflection, where reflection has the weight `r` and transmission `t`, and
    /// lobes that are not requested the weight 0; and where there is one: not where all weights are
    /// 0.
    #[inline(always)]
    pub fn probability_of_reflection<R: Real>(self, r: R, t: R) -> (R, R::Mask) {
        let r = if self.reflection() { r } else { R::zero() };
        let t = if self.transmission() { t } else { R::zero() };
        (r / (r + t), (r + t).gt(R::zero()))
    }
}

/// What travels along the path that a BxDF continues.
///
/// Radiance is scaled by (η_i/η_t)² where it is refracted, because the solid angle that holds it
/// changes; importance is not. [Veach 1997 §5.2], [Pharr 2023 §9.5.2]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TransportMode {
    /// The path starts at the camera and transports radiance.
    #[default]
    Radiance,
    /// The path starts at a light and carries its power.
    Importance,
}

impl Not for TransportMode {
    type Output = Self;

    /// The mode of paths from the other end.
    #[inline]
    fn not(self) -> Self {
        match self {
            Self::Radiance => Self::Importance,
            Self::Importance => Self::Radiance,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flag_sets() {
        let glass = BxdfFlags::REFLECTION | BxdfFlags::TRANSMISSION | BxdfFlags::SPECULAR;
        assert!(glass.is_reflective() && glass.is_transmissive() && glass.is_specular());
        assert!(!glass.is_non_specular() && !glass.is_empty() && BxdfFlags::NONE.is_empty());
        assert!(glass.intersects(BxdfFlags::SPECULAR | BxdfFlags::DIFFUSE));
        assert!(!glass.contains(BxdfFlags::SPECULAR | BxdfFlags::DIFFUSE));
        assert_eq!(glass & BxdfFlags::SPECULAR, BxdfFlags::SPECULAR);
    }

    #[test]
    fn directions_match_lobes() {
        let mirror = BxdfFlags::REFLECTION | BxdfFlags::SPECULAR;
        assert!(Directions::All.meet(mirror) && Directions::Reflection.meet(mirror));
        assert!(!Directions::Transmission.meet(mirror) && !Directions::All.meet(BxdfFlags::NONE));
    }

    #[test]
    fn lobe_probabilities_exclude_other_lobes() {
        assert_eq!(Directions::All.probability_of_reflection(1.0, 3.0), (0.25, true));
        assert_eq!(Directions::Reflection.probability_of_reflection(1.0, 3.0), (1.0, true));
        assert_eq!(Directions::Transmission.probability_of_reflection(1.0, 3.0), (0.0, true));
        assert!(!Directions::Transmission.probability_of_reflection(1.0, 0.0).1);
    }
}
