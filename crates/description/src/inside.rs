//! The inside of fibres and translucent bodies, each given in one of several ways.

use scattering::SubsurfaceMethod;

use crate::schema::{Field, Kind, SHARE, SettingType, Settings, Value, Visitor};
use crate::{FloatParameter, Parameter, SpectrumDesc, SpectrumParameter};

/// The absorption in a fibre.
#[derive(Clone, Debug, PartialEq)]
pub enum HairColor {
    /// Coefficient per fibre diameter.
    SigmaA(SpectrumParameter),
    /// The colour of a volume of hair.
    Reflectance(SpectrumParameter),
    /// Concentrations of pigment.
    Melanin {
        /// Brown.
        eumelanin: FloatParameter,
        /// Red.
        pheomelanin: FloatParameter,
    },
}

/// Brown hair.
impl Default for HairColor {
    fn default() -> Self {
        Self::Melanin { eumelanin: 1.3.into(), pheomelanin: 0.0.into() }
    }
}

impl Settings for HairColor {
    fn visit(&mut self, visitor: Visitor) {
        const FIELDS: &[Field; 4] = &[
            Field::new("sigma_a", "Absorption within the fibre, per radius of it."),
            Field::new("reflectance", "The colour of a mass of such hair.").within(SHARE),
            Field::new("eumelanin", "Concentration of the brown pigment. If no colour is given, 1.3."),
            Field::new("pheomelanin", "Concentration of the red pigment. If absent, 0."),
        ];
        let (mut sigma_a, mut reflectance, mut melanin) = (None, None, [None, None]);
        match &*self {
            color if *color == Self::default() => (),
            Self::SigmaA(value) => sigma_a = Some(value.clone()),
            Self::Reflectance(value) => reflectance = Some(value.clone()),
            Self::Melanin { eumelanin, pheomelanin } => {
                melanin = [Some(eumelanin.clone()), Some(pheomelanin.clone())];
            }
        }
        visitor(&FIELDS[0], &mut sigma_a);
        visitor(&FIELDS[1], &mut reflectance);
        visitor(&FIELDS[2], &mut melanin[0]);
        visitor(&FIELDS[3], &mut melanin[1]);
        *self = match (sigma_a, reflectance, melanin) {
            (Some(sigma_a), ..) => Self::SigmaA(sigma_a),
            (None, Some(reflectance), _) => Self::Reflectance(reflectance),
            (None, None, [None, None]) => Self::default(),
            (None, None, melanin) => {
                let [eumelanin, pheomelanin] = melanin.map(|share| share.unwrap_or(Parameter::Value(0.0)));
                Self::Melanin { eumelanin, pheomelanin }
            }
        };
    }
}

/// The scattering inside a subsurface material.
#[derive(Clone, Debug, PartialEq)]
pub enum SubsurfaceScattering {
    /// A predefined measured substance of the format.
    Named(String),
    /// Coefficients in 1/mm.
    Coefficients {
        /// Absorption.
        sigma_a: SpectrumParameter,
        /// Scattering.
        sigma_s: SpectrumParameter,
    },
    /// Effective reflectance.
    Reflectance {
        /// The colour.
        reflectance: SpectrumParameter,
        /// Mean free path in mm.
        mfp: SpectrumParameter,
    },
}

/// Whole milk [Jensen 2001].
impl Default for SubsurfaceScattering {
    fn default() -> Self {
        Self::Coefficients {
            sigma_a: SpectrumDesc::rgb(0.0011, 0.0024, 0.014).into(),
            sigma_s: SpectrumDesc::rgb(2.55, 3.21, 3.77).into(),
        }
    }
}

/// A name has precedence over coefficients, and those over a reflectance.
impl Settings for SubsurfaceScattering {
    fn visit(&mut self, visitor: Visitor) {
        const FIELDS: &[Field; 5] = &[
            Field::new("name", "A measured substance."),
            Field::new("sigma_a", "Absorption, 1/mm. Without any of the four, whole milk's."),
            Field::new("sigma_s", "Scattering, 1/mm; needed with `sigma_a`."),
            Field::new(
                "reflectance",
                "Diffuse reflectance of the substance, if neither `name` nor `sigma_a` is given.",
            )
            .within(SHARE),
            Field::new("mfp", "Mean free path, mm, with `reflectance`. If absent, 1."),
        ];
        let (mut name, mut coefficients, mut effective) = (None, [None, None], [None, None]);
        match &*self {
            scattering if *scattering == Self::default() => (),
            Self::Named(known) => name = Some(known.clone()),
            Self::Coefficients { sigma_a, sigma_s } => {
                coefficients = [Some(sigma_a.clone()), Some(sigma_s.clone())];
            }
            Self::Reflectance { reflectance, mfp } => {
                effective = [Some(reflectance.clone()), Some(mfp.clone())];
            }
        }
        visitor(&FIELDS[0], &mut name);
        visitor(&FIELDS[1], &mut coefficients[0]);
        visitor(&FIELDS[2], &mut coefficients[1]);
        visitor(&FIELDS[3], &mut effective[0]);
        visitor(&FIELDS[4], &mut effective[1]);
        *self = match (name, coefficients, effective) {
            (Some(name), ..) => Self::Named(name),
            (None, [Some(sigma_a), Some(sigma_s)], _) => Self::Coefficients { sigma_a, sigma_s },
            (None, _, [Some(reflectance), mfp]) => {
                Self::Reflectance { reflectance, mfp: mfp.unwrap_or(1.0.into()) }
            }
            _ => Self::default(),
        };
    }
}

const METHODS: [(&str, SubsurfaceMethod); 2] =
    [("diffusion", SubsurfaceMethod::Diffusion), ("random-walk", SubsurfaceMethod::RandomWalk)];

impl SettingType for SubsurfaceMethod {
    const KIND: Kind = Kind::Choice(&[METHODS[0].0, METHODS[1].0]);

    fn to_value(&self) -> Value {
        let found = METHODS.iter().find(|(_, method)| method == self);
        Value::Text(found.map_or("", |(name, _)| name).to_owned())
    }

    fn from_value(value: &Value) -> Option<Self> {
        let Value::Text(text) = value else { return None };
        METHODS.iter().find(|(name, _)| name == text).map(|&(_, method)| method)
    }
}
