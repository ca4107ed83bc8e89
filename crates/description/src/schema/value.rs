//! Values of settings, and their types.

use std::fmt;

use math::Point3;

use super::choice::Choice;
use crate::{Handle, SpectrumDesc};

/// A value of a setting.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A flag.
    Bool(bool),
    /// A whole number.
    Integer(i64),
    /// A number.
    Number(f32),
    /// A text, or the name of a choice.
    Text(String),
    /// A point.
    Point(Point3),
    /// A spectrum.
    Spectrum(SpectrumDesc),
    /// A texture in place of a number.
    FloatTexture(Handle<()>),
    /// A texture in place of a spectrum.
    SpectrumTexture(Handle<()>),
    /// Several values.
    List(Vec<Value>),
    /// Chosen by the renderer.
    Automatic,
}

impl fmt::Display for Value {
    /// In the syntax of [`Kind::parse`]; `automatic` for values chosen by the renderer.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bool(value) => value.fmt(f),
            Self::Integer(value) => value.fmt(f),
            Self::Number(value) => value.fmt(f),
            Self::Text(value) => value.fmt(f),
            Self::Point(Point3 { x, y, z }) => write!(f, "{x} {y} {z}"),
            Self::Spectrum(SpectrumDesc::Constant(value)) => value.fmt(f),
            Self::Spectrum(SpectrumDesc::Illuminant(_)) => "white".fmt(f),
            Self::Spectrum(SpectrumDesc::Rgb { rgb: [r, g, b], .. }) => write!(f, "{r} {g} {b}"),
            Self::Spectrum(SpectrumDesc::Named(name)) => name.fmt(f),
            Self::Spectrum(_) => "a spectrum".fmt(f),
            Self::FloatTexture(_) | Self::SpectrumTexture(_) => "a texture".fmt(f),
            Self::List(values) => {
                let texts: Vec<String> = values.iter().map(ToString::to_string).collect();
                texts.join(",").fmt(f)
            }
            Self::Automatic => "automatic".fmt(f),
        }
    }
}

/// The type of a setting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// True or false.
    Bool,
    /// A whole number.
    Integer,
    /// A whole number that is not negative.
    Count,
    /// A number.
    Number,
    /// One of some names.
    Choice(&'static [&'static str]),
    /// A text.
    Text,
    /// A point.
    Point,
    /// A spectrum.
    Spectrum,
    /// A number or a texture.
    FloatParameter,
    /// A spectrum or a texture.
    SpectrumParameter,
    /// A fixed count of values.
    List(&'static Kind, usize),
}

impl Kind {
    /// Parses a value of this type from user input; the values of a list are separated by commas.
    pub fn parse(self, text: &str) -> Option<Value> {
        let text = text.trim();
        match self {
            Self::Bool => text.parse().ok().map(Value::Bool),
            Self::Integer | Self::Count => text.parse::<i32>().ok().map(|value| Value::Integer(value.into())),
            Self::Number => text.parse().ok().map(Value::Number),
            // Members of a scene are not set by users' texts.
            Self::Point | Self::Spectrum | Self::FloatParameter | Self::SpectrumParameter => None,
            Self::Choice(names) => names.contains(&text).then(|| Value::Text(text.to_owned())),
            Self::Text => Some(Value::Text(text.to_owned())),
            Self::List(kind, count) => {
                let values: Option<Vec<Value>> = text.split(',').map(|part| kind.parse(part)).collect();
                values.filter(|values| values.len() == count).map(Value::List)
            }
        }
    }
}

/// A type that a setting can have.
pub trait SettingType: Sized {
    /// The type.
    const KIND: Kind;

    /// Converts the value to a [`Value`].
    fn to_value(&self) -> Value;

    /// Converts from a [`Value`]; `None` if it has another type.
    fn from_value(value: &Value) -> Option<Self>;
}

/// A setting's value, independent of its type.
pub trait Slot {
    /// The type of the setting.
    fn kind(&self) -> Kind;

    /// The value.
    fn get(&self) -> Value;

    /// Replaces the value if the new one has the right type; returns whether it has.
    fn set(&mut self, value: &Value) -> bool;
}

impl<T: SettingType> Slot for T {
    fn kind(&self) -> Kind {
        T::KIND
    }

    fn get(&self) -> Value {
        self.to_value()
    }

    fn set(&mut self, value: &Value) -> bool {
        T::from_value(value).map(|value| *self = value).is_some()
    }
}

macro_rules! setting_types {
    ($($type:ty: $kind:ident = $variant:ident($to:expr, $from:expr),)*) => {$(
        impl SettingType for $type {
            const KIND: Kind = Kind::$kind;

            fn to_value(&self) -> Value {
                Value::$variant($to(self))
            }

            fn from_value(value: &Value) -> Option<Self> {
                match value {
                    Value::$variant(value) => $from(value),
                    _ => None,
                }
            }
        }
    )*};
}

setting_types! {
    bool: Bool = Bool(|&value: &bool| value, |&value: &bool| Some(value)),
    i32: Integer = Integer(|&value: &i32| value.into(), |&value: &i64| value.try_into().ok()),
    u32: Count = Integer(|&value: &u32| value.into(), |&value: &i64| value.try_into().ok()),
    f32: Number = Number(|&value: &f32| value, |&value: &f32| Some(value)),
    Point3: Point = Point(|&value: &Point3| value, |&value: &Point3| Some(value)),
    SpectrumDesc: Spectrum = Spectrum(SpectrumDesc::clone, |value: &SpectrumDesc| Some(value.clone())),
    String: Text = Text(String::clone, |value: &String| Some(value.clone())),
}

impl<T: Choice> SettingType for T {
    const KIND: Kind = Kind::Choice(T::NAMES);

    fn to_value(&self) -> Value {
        Value::Text(self.name().to_owned())
    }

    fn from_value(value: &Value) -> Option<Self> {
        match value {
            Value::Text(text) => T::named(text),
            _ => None,
        }
    }
}

impl<T: SettingType> SettingType for Option<T> {
    const KIND: Kind = T::KIND;

    fn to_value(&self) -> Value {
        self.as_ref().map_or(Value::Automatic, T::to_value)
    }

    fn from_value(value: &Value) -> Option<Self> {
        match value {
            Value::Automatic => Some(None),
            value => T::from_value(value).map(Some),
        }
    }
}

impl<T: SettingType, const N: usize> SettingType for [T; N] {
    const KIND: Kind = Kind::List(&T::KIND, N);

    fn to_value(&self) -> Value {
        Value::List(self.iter().map(T::to_value).collect())
    }

    fn from_value(value: &Value) -> Option<Self> {
        let Value::List(values) = value else { return None };
        let values: Option<Vec<T>> = values.iter().map(T::from_value).collect();
        values?.try_into().ok()
    }
}
