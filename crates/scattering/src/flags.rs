//! The kinds of scattering of a BxDF, and those requested of it.

use std::ops::{BitAnd, BitOr, BitOrAssign, Not};

/// A set of kinds of scattering: where to (reflection, transmission) and how widely (diffuse,
/// glossy, specular).
///
/// The set of a sample names one lobe; that of a BxDF names all of its lobes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct BxdfFlags(u8);

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

    /// Whether every kind of `other` is in this set.
    #[inline]
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Whether some kind of `other` is in this set.
    #[inline]
    pub const fn intersects(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Whether the set is empty.
    #[inline]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether light is reflected.
    #[inline]
    pub const fn is_reflective(self) -> bool {
        self.contains(Self::REFLECTION)
    }

    /// Whether light is transmitted.
    #[inline]
    pub const fn is_transmissive(self) -> bool {
        self.contains(Self::TRANSMISSION)
    }

    /// Whether there is a diffuse lobe.
    #[inline]
    pub const fn is_diffuse(self) -> bool {
        self.contains(Self::DIFFUSE)
    }

    /// Whether there is a glossy lobe.
    #[inline]
    pub const fn is_glossy(self) -> bool {
        self.contains(Self::GLOSSY)
    }

    /// Whether there is a specular lobe.
    #[inline]
    pub const fn is_specular(self) -> bool {
        self.contains(Self::SPECULAR)
    }

    /// Whether there is a lobe for which `f` is not zero: a diffuse or glossy one.
    #[inline]
    pub const fn is_non_specular(self) -> bool {
        self.0 & (Self::DIFFUSE.0 | Self::GLOSSY.0) != 0
    }
}

impl BitOr for BxdfFlags {
    type Output = Self;

    #[inline]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl BitOrAssign for BxdfFlags {
    #[inline]
    fn bitor_assign(&mut self, other: Self) {
        *self = *self | other;
    }
}

impl BitAnd for BxdfFlags {
    type Output = Self;

    #[inline]
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
    pub const fn reflection(self) -> bool {
        !matches!(self, Self::Transmission)
    }

    /// Whether transmission may be sampled.
    #[inline]
    pub const fn transmission(self) -> bool {
        !matches!(self, Self::Reflection)
    }

    /// Whether a BxDF with `flags` scatters to some of these directions.
    #[inline]
    pub const fn meet(self, flags: BxdfFlags) -> bool {
        self.reflection() && flags.is_reflective() || self.transmission() && flags.is_transmissive()
    }

    /// The probability of reflection, where reflection has the weight `r` and transmission `t`, and
    /// lobes that are not requested the weight 0; `None` if all weights are 0.
    #[inline]
    pub fn probability_of_reflection(self, r: f32, t: f32) -> Option<f32> {
        let r = if self.reflection() { r } else { 0.0 };
        let t = if self.transmission() { t } else { 0.0 };
        (r + t > 0.0).then(|| r / (r + t))
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
        assert_eq!(Directions::All.probability_of_reflection(1.0, 3.0), Some(0.25));
        assert_eq!(Directions::Reflection.probability_of_reflection(1.0, 3.0), Some(1.0));
        assert_eq!(Directions::Transmission.probability_of_reflection(1.0, 3.0), Some(0.0));
        assert_eq!(Directions::Transmission.probability_of_reflection(1.0, 0.0), None);
    }
}
