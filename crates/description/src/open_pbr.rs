//! The principled surface: its parameters have the names of OpenPBR Surface.

use crate::{FloatParameter, SpectrumDesc, SpectrumParameter, UvImageDesc};

/// A number of [`OpenPbrDesc`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenPbrNumber {
    /// Its name.
    pub name: &'static str,
    /// If it is not given.
    pub default: f32,
    /// The least and the largest value.
    pub range: [f32; 2],
}

const fn number(name: &'static str, default: f32, [least, most]: [f32; 2]) -> OpenPbrNumber {
    OpenPbrNumber { name, default, range: [least, most] }
}

const SHARE: [f32; 2] = [0.0, 1.0];
const INDEX: [f32; 2] = [1.0, 3.0];
const POSITIVE: [f32; 2] = [0.0, f32::MAX];

/// A principled surface.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenPbrDesc {
    /// The values of [`Self::NUMBERS`].
    pub numbers: [FloatParameter; Self::NUMBERS.len()],
    /// The values of [`Self::COLORS`], each in [0, 1].
    pub colors: [SpectrumParameter; Self::COLORS.len()],
    /// Factors on the radius under the surface, each in [0, 1].
    pub subsurface_radius_scale: SpectrumParameter,
    /// The normal map of the coat; without one it is parallel to the surface.
    pub geometry_coat_normal: Option<UvImageDesc>,
    /// Whether it is a sheet without an inside.
    pub thin_walled: bool,
    /// Emitted luminance, in cd/m².
    pub emission_luminance: f32,
    /// Colour of what is emitted.
    pub emission_color: SpectrumDesc,
}

impl OpenPbrDesc {
    /// All numbers but the emitted luminance.
    pub const NUMBERS: [OpenPbrNumber; 24] = [
        number("base_weight", 1.0, SHARE),
        number("base_diffuse_roughness", 0.0, SHARE),
        number("base_metalness", 0.0, SHARE),
        number("specular_weight", 1.0, POSITIVE),
        number("specular_roughness", 0.3, SHARE),
        number("specular_roughness_anisotropy", 0.0, SHARE),
        number("specular_ior", 1.5, INDEX),
        number("transmission_weight", 0.0, SHARE),
        number("transmission_depth", 0.0, POSITIVE),
        number("transmission_dispersion_scale", 0.0, SHARE),
        number("transmission_dispersion_abbe_number", 20.0, [1.0, 1000.0]),
        number("subsurface_weight", 0.0, SHARE),
        number("subsurface_radius", 1.0, POSITIVE),
        number("subsurface_scatter_anisotropy", 0.0, [-1.0, 1.0]),
        number("coat_weight", 0.0, SHARE),
        number("coat_roughness", 0.0, SHARE),
        number("coat_roughness_anisotropy", 0.0, SHARE),
        number("coat_ior", 1.6, INDEX),
        number("coat_darkening", 1.0, SHARE),
        number("fuzz_weight", 0.0, SHARE),
        number("fuzz_roughness", 0.5, SHARE),
        number("thin_film_weight", 0.0, SHARE),
        number("thin_film_thickness", 0.5, POSITIVE),
        number("thin_film_ior", 1.4, INDEX),
    ];

    /// All colours but that of emission, with what they are if they are not given.
    pub const COLORS: [(&'static str, f32); 6] = [
        ("base_color", 0.8),
        ("specular_color", 1.0),
        ("transmission_color", 1.0),
        ("subsurface_color", 0.8),
        ("coat_color", 1.0),
        ("fuzz_color", 1.0),
    ];

    /// Whether paths may be followed under the surface.
    pub fn scatters_under(&self) -> bool {
        let is_zero = |name| {
            let index = Self::NUMBERS.iter().position(|number| number.name == name);
            index.is_some_and(|index| self.numbers[index].value() == Some(&0.0))
        };
        !(self.thin_walled || is_zero("subsurface_weight") || is_zero("subsurface_radius"))
    }
}

impl Default for OpenPbrDesc {
    fn default() -> Self {
        Self {
            numbers: Self::NUMBERS.map(|number| number.default.into()),
            colors: Self::COLORS.map(|(_, default)| default.into()),
            subsurface_radius_scale: SpectrumDesc::rgb(1.0, 0.5, 0.25).into(),
            geometry_coat_normal: None,
            thin_walled: false,
            emission_luminance: 0.0,
            emission_color: SpectrumDesc::rgb(1.0, 1.0, 1.0),
        }
    }
}
