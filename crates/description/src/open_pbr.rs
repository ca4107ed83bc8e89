//! The principled surface: its parameters have the names of OpenPBR Surface.

use crate::schema::{self, Domain, Field, Settings, Visitor};
use crate::{FloatParameter, SpectrumDesc, SpectrumParameter, UvImageDesc};

/// A number of [`OpenPbrDesc`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenPbrNumber {
    /// Its name and meaning.
    pub field: Field,
    /// If it is not given.
    pub default: f32,
    /// The least and the largest value.
    pub range: [f32; 2],
}

const fn number(name: &'static str, default: f32, range: [f32; 2], help: &'static str) -> OpenPbrNumber {
    let field = Field::new(name, help).within(Domain::ANY.usually(range[0], range[1]));
    OpenPbrNumber { field, default, range }
}

const fn color(name: &'static str, default: f32, help: &'static str) -> (Field, f32) {
    (Field::new(name, help).within(schema::SHARE), default)
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
        number("base_weight", 1.0, SHARE, "Factor on `base_color`, 0 to 1."),
        number("base_diffuse_roughness", 0.0, SHARE, "Roughness of the diffuse base, 0 to 1."),
        number("base_metalness", 0.0, SHARE, "The share of metal, 0 to 1."),
        number("specular_weight", 1.0, POSITIVE, "Factor on the base's reflectance along the normal."),
        number(
            "specular_roughness",
            0.3,
            SHARE,
            "Roughness of the base's boundary, 0 to 1; α is its square.",
        ),
        number(
            "specular_roughness_anisotropy",
            0.0,
            SHARE,
            "From a round highlight, 0, to a stroke along u, 1.",
        ),
        number("specular_ior", 1.5, INDEX, "Index of refraction of the dielectric base, 1 to 3."),
        number(
            "transmission_weight",
            0.0,
            SHARE,
            "The share of the dielectric base that is transparent, 0 to 1.",
        ),
        number(
            "transmission_depth",
            0.0,
            POSITIVE,
            "If above 0, the boundary does not tint; what is inside absorbs by its medium.",
        ),
        number(
            "transmission_dispersion_scale",
            0.0,
            SHARE,
            "Dispersion, 0 to 1: 1 over it is a factor on the Abbe number.",
        ),
        number("transmission_dispersion_abbe_number", 20.0, [1.0, 1000.0], "The Abbe number."),
        number(
            "subsurface_weight",
            0.0,
            SHARE,
            "The share of the opaque dielectric base that has `subsurface_color`, 0 to 1.",
        ),
        number(
            "subsurface_radius",
            1.0,
            POSITIVE,
            "Mean free path under the surface, by which light leaves elsewhere; 0: where it entered.",
        ),
        number(
            "subsurface_scatter_anisotropy",
            0.0,
            [-1.0, 1.0],
            "Mean cosine of scattering under the surface; with `geometry_thin_walled`: from all that is scattered reflected, -1, to all of it transmitted, 1.",
        ),
        number("coat_weight", 0.0, SHARE, "Presence of the coat, 0 to 1."),
        number("coat_roughness", 0.0, SHARE, "Roughness of the coat, 0 to 1."),
        number("coat_roughness_anisotropy", 0.0, SHARE, "Its anisotropy, 0 to 1."),
        number("coat_ior", 1.6, INDEX, "Its index of refraction, 1 to 3."),
        number("coat_darkening", 1.0, SHARE, "How far reflections inside the coat darken the base, 0 to 1."),
        number("fuzz_weight", 0.0, SHARE, "Presence of fuzz, 0 to 1."),
        number(
            "fuzz_roughness",
            0.5,
            SHARE,
            "From fibres along the normal, 0, to flakes of any direction, 1.",
        ),
        number("thin_film_weight", 0.0, SHARE, "Presence of a thin film on the base, 0 to 1."),
        number("thin_film_thickness", 0.5, POSITIVE, "Its thickness in micrometres."),
        number("thin_film_ior", 1.4, INDEX, "Its index of refraction, 1 to 3."),
    ];

    /// All colours but that of emission, with what they are if they are not given.
    pub const COLORS: [(Field, f32); 6] = [
        color("base_color", 0.8, "Albedo of the diffuse base; reflectance of metal along the normal."),
        color(
            "specular_color",
            1.0,
            "Tint of the reflection by the base's boundary; of metal, near grazing angles.",
        ),
        color(
            "transmission_color",
            1.0,
            "Factor on transmitted light at each boundary, unless `transmission_depth` is above 0; with `geometry_thin_walled`, of a crossing of the sheet.",
        ),
        color("subsurface_color", 0.8, "Albedo, under uniform light, of what scatters under its surface."),
        color("coat_color", 1.0, "Factor on light that crosses the coat twice along the normal."),
        color("fuzz_color", 1.0, "Albedo of its fibres."),
    ];

    /// The index of a number by its name.
    pub fn number(name: &str) -> Option<usize> {
        Self::NUMBERS.iter().position(|number| number.field.name == name)
    }

    /// The index of a colour by its name.
    pub fn color(name: &str) -> Option<usize> {
        Self::COLORS.iter().position(|(field, _)| field.name == name)
    }

    /// Whether paths may be followed under the surface.
    pub fn scatters_under(&self) -> bool {
        let is_zero =
            |name| Self::number(name).is_some_and(|index| self.numbers[index].value() == Some(&0.0));
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

impl Settings for OpenPbrDesc {
    fn visit(&mut self, visitor: Visitor) {
        const NUMBERS: &[OpenPbrNumber] = &OpenPbrDesc::NUMBERS;
        const COLORS: &[(Field, f32)] = &OpenPbrDesc::COLORS;
        const FIELDS: &[Field; 3] = &[
            Field::new("subsurface_radius_scale", "Factors on `subsurface_radius`.").within(schema::SHARE),
            Field::new("geometry_thin_walled", "Whether the surface is a sheet without an inside."),
            Field::new(
                "emission_luminance",
                "Luminance that shapes emit, cd/m², unless they have an area light.",
            ),
        ];
        for (number, value) in NUMBERS.iter().zip(&mut self.numbers) {
            visitor(&number.field, value);
        }
        for ((field, _), value) in COLORS.iter().zip(&mut self.colors) {
            visitor(field, value);
        }
        visitor(&FIELDS[0], &mut self.subsurface_radius_scale);
        visitor(&FIELDS[1], &mut self.thin_walled);
        visitor(&FIELDS[2], &mut self.emission_luminance);
    }
}
