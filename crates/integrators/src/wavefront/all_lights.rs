//! Direct light in lanes by one sample of every light, of ray casting and Whitted's ray tracing.

use scene::Interfaces;

use crate::transport::direct::DirectLighting;

/// Direct light by one sample of every light.
pub(super) struct AllLights {
    /// Whether surfaces cast shadows. Then specular surfaces reflect and refract rays, too.
    pub casts_shadows: bool,
    /// Whether skies of one colour cast none.
    pub has_ambient: bool,
    /// Light that rays find, which counts fully.
    pub direct: DirectLighting,
}

impl AllLights {
    /// Without shadows.
    pub fn without_shadows() -> Self {
        Self { casts_shadows: false, has_ambient: false, direct: DirectLighting::none(Interfaces::Pass) }
    }

    /// With shadows; `has_ambient` says that skies of one colour cast none.
    pub fn with_shadows(has_ambient: bool) -> Self {
        Self { casts_shadows: true, has_ambient, ..Self::without_shadows() }
    }
}
