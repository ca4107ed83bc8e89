//! Roughness of microfacet surfaces, and the reflectance of metals.

use crate::schema::{Field, Kind, SettingType, Settings, Slot, Value, Visitor, settings};
use crate::{FloatParameter, Parameter, SpectrumDesc, SpectrumParameter};

/// The parameters of a roughness, whose names begin with a prefix: both axes, u and v.
macro_rules! roughness_fields {
    ($prefix:literal, $what:literal) => {
        [
            $crate::schema::Field::new(
                concat!($prefix, "roughness"),
                concat!("Roughness", $what, ", 0 (smooth) to 1."),
            )
            .within($crate::schema::SHARE),
            $crate::schema::Field::new(
                concat!($prefix, "uroughness"),
                concat!("Roughness", $what, " along u. If absent, `", $prefix, "roughness`."),
            )
            .within($crate::schema::SHARE),
            $crate::schema::Field::new(
                concat!($prefix, "vroughness"),
                concat!("Roughness", $what, " along v. If absent, `", $prefix, "roughness`."),
            )
            .within($crate::schema::SHARE),
        ]
    };
}

/// The parameters of a metal, whose index of refraction has a prefix.
macro_rules! conductor_fields {
    ($prefix:literal) => {
        [
            $crate::schema::Field::new(
                concat!($prefix, "eta"),
                "Real part of the metal's index of refraction.",
            )
            .within($crate::schema::index_of_refraction()),
            $crate::schema::Field::new(
                concat!($prefix, "k"),
                "Imaginary part of the metal's index of refraction.",
            )
            .within($crate::schema::index_of_refraction()),
            $crate::schema::Field::new(
                "reflectance",
                concat!(
                    "Reflectance at normal incidence instead of `",
                    $prefix,
                    "eta` and `",
                    $prefix,
                    "k`."
                ),
            )
            .within($crate::schema::SHARE),
        ]
    };
}

pub(crate) use {conductor_fields, roughness_fields};

/// Whether roughness is perceptual.
pub(crate) const REMAP: &Field = &Field::new(
    "remaproughness",
    "Whether α of the microfacets is the square root of the roughness, or the roughness itself.",
);

/// Roughness of a microfacet surface.
#[derive(Clone, Debug, PartialEq)]
pub struct RoughnessDesc {
    /// Along the surface's u direction.
    pub u: FloatParameter,
    /// Along v.
    pub v: FloatParameter,
    /// The values are perceptual: α is their square root.
    pub remap: bool,
}

impl RoughnessDesc {
    /// The same roughness both ways, remapped.
    pub fn isotropic(roughness: f32) -> Self {
        Self { u: roughness.into(), v: roughness.into(), remap: true }
    }

    /// Whether both axes are constants of 0.
    pub fn is_smooth(&self) -> bool {
        self.u == Parameter::Value(0.0) && self.v == Parameter::Value(0.0)
    }

    /// Visits the axes under their names.
    pub(crate) fn visit_axes(&mut self, [both, u, v]: &'static [Field; 3], visitor: Visitor) {
        visitor(both, &mut Axes(&mut self.u, &mut self.v));
        let is_given = self.u != self.v;
        visitor(u, &mut Axis { value: &mut self.u, is_given });
        visitor(v, &mut Axis { value: &mut self.v, is_given });
    }
}

impl Default for RoughnessDesc {
    fn default() -> Self {
        Self::isotropic(0.0)
    }
}

impl Settings for RoughnessDesc {
    fn visit(&mut self, visitor: Visitor) {
        const FIELDS: &[Field; 3] = &roughness_fields!("", "");
        self.visit_axes(FIELDS, visitor);
        visitor(REMAP, &mut self.remap);
    }
}

/// The roughness of both axes, where they do not differ.
struct Axes<'a>(&'a mut FloatParameter, &'a mut FloatParameter);

impl Slot for Axes<'_> {
    fn kind(&self) -> Kind {
        FloatParameter::KIND
    }

    fn get(&self) -> Value {
        if self.0 == self.1 { self.0.to_value() } else { Value::Automatic }
    }

    fn set(&mut self, value: &Value) -> bool {
        self.0.set(value) && self.1.set(value)
    }
}

/// The roughness of one axis, given where it is not that of both.
struct Axis<'a> {
    value: &'a mut FloatParameter,
    is_given: bool,
}

impl Slot for Axis<'_> {
    fn kind(&self) -> Kind {
        FloatParameter::KIND
    }

    fn get(&self) -> Value {
        if self.is_given { self.value.to_value() } else { Value::Automatic }
    }

    fn set(&mut self, value: &Value) -> bool {
        self.value.set(value)
    }
}

settings! {
    /// A metal.
    #[derive(Clone, Debug, PartialEq)]
    pub struct ConductorDesc {
        /// Its reflectance.
        reflectance: ConductorReflectance = ConductorReflectance::default() => ..;
        /// Its roughness.
        roughness: RoughnessDesc = RoughnessDesc::default() => ..;
    }
}

/// Reflectance of a conductor.
#[derive(Clone, Debug, PartialEq)]
pub enum ConductorReflectance {
    /// By its complex index of refraction.
    Index {
        /// Real part.
        eta: SpectrumParameter,
        /// Imaginary part.
        k: SpectrumParameter,
    },
    /// By its reflectance at normal incidence.
    Reflectance(SpectrumParameter),
}

/// Copper.
impl Default for ConductorReflectance {
    fn default() -> Self {
        Self::Index {
            eta: SpectrumDesc::Named("metal-Cu-eta".into()).into(),
            k: SpectrumDesc::Named("metal-Cu-k".into()).into(),
        }
    }
}

impl ConductorReflectance {
    /// Visits η, k and the reflectance under their names. The reflectance has precedence.
    pub(crate) fn visit_as(&mut self, fields: &'static [Field; 3], visitor: Visitor) {
        let (mut index, mut reflectance) = match std::mem::take(self) {
            Self::Index { eta, k } => ([Some(eta), Some(k)], None),
            Self::Reflectance(reflectance) => ([None, None], Some(reflectance)),
        };
        visitor(&fields[0], &mut index[0]);
        visitor(&fields[1], &mut index[1]);
        visitor(&fields[2], &mut reflectance);
        *self = match (reflectance, index) {
            (Some(reflectance), _) => Self::Reflectance(reflectance),
            (None, [Some(eta), Some(k)]) => Self::Index { eta, k },
            (None, _) => Self::default(),
        };
    }
}

impl Settings for ConductorReflectance {
    fn visit(&mut self, visitor: Visitor) {
        const FIELDS: &[Field; 3] = &conductor_fields!("");
        self.visit_as(FIELDS, visitor);
    }
}
