//! What is known of a parameter that a statement's reader looked up. Only its name is used when
//! scenes are read; a test makes `docs/formats/pbrt-v4.md` from the rest.

use std::fmt::{self, Display};
use std::ops::RangeInclusive;

use description::schema::{Field, Slot};

use crate::read::parameter::ParameterType;

/// A parameter that was looked up, whether it is given or not.
#[derive(Clone)]
pub(crate) struct Asked {
    pub(crate) name: &'static str,
    #[cfg(test)]
    pub(super) reference: Reference,
}

/// What the documentation says of a parameter.
#[cfg(test)]
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Reference {
    pub(super) types: &'static [ParameterType],
    pub(super) default: String,
    pub(super) values: String,
    /// The text of the schema, for settings.
    pub(super) help: &'static str,
    pub(super) is_required: bool,
}

#[cfg_attr(not(test), expect(unused_variables, clippy::unused_self, clippy::needless_pass_by_ref_mut))]
impl Asked {
    pub(super) fn new(name: &'static str, types: &'static [ParameterType]) -> Self {
        Self {
            name,
            #[cfg(test)]
            reference: Reference { types, ..Reference::default() },
        }
    }

    /// Notes the default and the allowed values.
    pub(super) fn note(&mut self, default: &dyn Display, values: &dyn Display) {
        #[cfg(test)]
        {
            self.reference.default = default.to_string();
            self.reference.values = values.to_string();
        }
    }

    /// Notes what the schema declares.
    pub(super) fn note_setting(&mut self, field: &Field, slot: &dyn Slot) {
        #[cfg(test)]
        {
            use description::schema::{Kind, Value};
            let default = match slot.get() {
                Value::Automatic => String::new(),
                value @ Value::List(_) => value.to_string().replace(',', " "),
                value => value.to_string(),
            };
            let values = match slot.kind() {
                Kind::Choice(_) | Kind::Count | Kind::List(..) => field.domain.describe(slot.kind()),
                // The type of the parameter says it already.
                _ if field.domain.is_any() => String::new(),
                kind => field.domain.describe(kind),
            };
            let unit = if values.is_empty() || field.domain.unit.is_empty() { "" } else { ", " };
            let values = values + unit + field.domain.unit;
            self.reference = Reference { default, values, help: field.help, ..self.reference };
        }
    }

    /// Notes that a statement without it is an error.
    pub(super) fn require(&mut self) {
        #[cfg(test)]
        {
            self.reference.is_required = true;
        }
    }
}

/// Integers from the first to the last.
pub(super) struct Within(pub(super) RangeInclusive<i32>);

impl Display for Within {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.0.start(), self.0.end()) {
            (start, &i32::MAX) => write!(f, "at least {start}"),
            (start, end) => write!(f, "between {start} and {end}"),
        }
    }
}

/// Names of values.
pub(super) struct Listed<'a>(pub(super) &'a [&'a str]);

impl Display for Listed<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "one of {}", self.0.join(", "))
    }
}
