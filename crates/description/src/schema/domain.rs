//! The values that a setting can have, of those of its type.

use super::{Kind, Value};

/// The values that a setting can have, of those of its type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Domain {
    /// Bounds of numbers.
    least: f64,
    most: f64,
    has_least: bool,
    has_most: bool,
    /// Bounds that numbers usually have, though others are allowed.
    usual: Option<[f32; 2]>,
    /// The unit of numbers; empty where they have none.
    pub unit: &'static str,
    /// Texts that are allowed; empty if all are.
    pub names: &'static [&'static str],
    /// The ending of texts.
    extension: &'static str,
    /// Whether spectra are indices of refraction, for which a number may be given.
    pub is_index: bool,
    /// Whether points are vectors.
    pub is_vector: bool,
}

/// Numbers and colours that are shares, usually from 0 to 1.
pub(crate) const SHARE: Domain = Domain::ANY.usually(0.0, 1.0);

/// Mean cosines, usually from -1 to 1.
pub(crate) const MEAN_COSINE: Domain = Domain::ANY.usually(-1.0, 1.0);

/// Numbers from `least` on.
pub(crate) const fn at_least(least: f64) -> Domain {
    Domain { least, has_least: true, ..Domain::ANY }
}

/// Numbers above `least`.
pub(crate) const fn above(least: f64) -> Domain {
    Domain { least, ..Domain::ANY }
}

/// Numbers between two others, exclusive.
pub(crate) const fn between(least: f64, most: f64) -> Domain {
    Domain { least, most, ..Domain::ANY }
}

/// Numbers from `least` to `most`, inclusive.
pub(crate) const fn from(least: f64, most: f64) -> Domain {
    at_least(least).at_most(most)
}

/// The given texts.
pub(crate) const fn one_of(names: &'static [&'static str]) -> Domain {
    Domain { names, ..Domain::ANY }
}

/// Spectra and numbers.
pub(crate) const fn index_of_refraction() -> Domain {
    Domain { is_index: true, ..Domain::ANY }
}

/// Vectors.
pub(crate) const fn vector() -> Domain {
    Domain { is_vector: true, ..Domain::ANY }
}

/// Names of files with an extension, including the dot.
pub(crate) const fn with_extension(extension: &'static str) -> Domain {
    Domain { extension, ..Domain::ANY }
}

impl Domain {
    /// All texts, and all numbers but NaN and infinity.
    pub(crate) const ANY: Self = Self {
        least: f64::NEG_INFINITY,
        most: f64::INFINITY,
        has_least: false,
        has_most: false,
        usual: None,
        unit: "",
        names: &[],
        extension: "",
        is_index: false,
        is_vector: false,
    };

    /// Whether it excludes no value.
    pub fn is_any(&self) -> bool {
        Self { usual: None, unit: "", is_index: false, is_vector: false, ..*self } == Self::ANY
    }

    /// Excludes numbers above `most`, which may be infinity.
    pub(crate) const fn at_most(self, most: f64) -> Self {
        Self { most, has_most: true, ..self }
    }

    /// Sets the bounds that numbers usually have.
    pub(crate) const fn usually(self, least: f32, most: f32) -> Self {
        Self { usual: Some([least, most]), ..self }
    }

    /// The bounds that a control of a number has: the usual ones, or those of all values.
    pub fn bounds(&self) -> [f32; 2] {
        self.usual.unwrap_or([self.least as f32, self.most as f32])
    }

    /// Sets the unit of the numbers.
    pub(crate) const fn unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    /// Whether the domain contains a value; always true for [`Value::Automatic`].
    pub fn contains(&self, value: &Value) -> bool {
        match value {
            Value::Integer(value) => self.contains_number(*value as f64),
            Value::Number(value) => self.contains_number(f64::from(*value)),
            Value::Text(text) => {
                (self.names.is_empty() || self.names.contains(&text.as_str()))
                    && text.to_ascii_lowercase().ends_with(self.extension)
            }
            Value::List(values) => values.iter().all(|value| self.contains(value)),
            Value::Bool(_)
            | Value::Point(_)
            | Value::Spectrum(_)
            | Value::FloatTexture(_)
            | Value::SpectrumTexture(_)
            | Value::Automatic => true,
        }
    }

    fn contains_number(&self, value: f64) -> bool {
        let least = value > self.least || (self.has_least && value == self.least);
        least && (value < self.most || (self.has_most && value == self.most))
    }

    /// A description of the values, as in “a number above 0”.
    pub fn describe(&self, kind: Kind) -> String {
        let range = self.range(kind);
        let range = if range.is_empty() { range } else { format!(" {range}") };
        match kind {
            Kind::Bool => "true or false".into(),
            Kind::Integer | Kind::Count => format!("a whole number{range}"),
            Kind::Number | Kind::FloatParameter if range.is_empty() => "a finite number".into(),
            Kind::Number | Kind::FloatParameter => format!("a number{range}"),
            Kind::Choice(names) => format!("one of {}", names.join(", ")),
            Kind::Text if !self.names.is_empty() => format!("one of {}", self.names.join(", ")),
            Kind::Text if !self.extension.is_empty() => format!("a name that ends in {}", self.extension),
            Kind::Text => "a text".into(),
            Kind::Point => "a point".into(),
            Kind::Spectrum | Kind::SpectrumParameter => "a spectrum".into(),
            Kind::List(kind, count) => {
                format!("{count} values separated by commas, each {}", self.describe(*kind))
            }
        }
    }

    /// The bounds of numbers, as in “above 0”; empty if there are none.
    pub fn range(&self, kind: Kind) -> String {
        let any = self.least == f64::NEG_INFINITY && kind == Kind::Count;
        let (least, has_least) = if any { (0.0, true) } else { (self.least, self.has_least) };
        match (least.is_finite(), self.most.is_finite()) {
            (false, false) => String::new(),
            (true, false) if has_least => format!("of {least} or more"),
            (true, false) => format!("above {least}"),
            (true, true) => match (has_least, self.has_most) {
                (true, true) => format!("from {least} to {}", self.most),
                (true, false) => format!("of at least {least} and below {}", self.most),
                (false, true) => format!("above {least} and at most {}", self.most),
                (false, false) => format!("between {least} and {}", self.most),
            },
            (false, true) => format!("of at most {}", self.most),
        }
    }
}
