//! The schema of settings. A setting is declared once, by `settings!`, with its field, type,
//! default, names, range, unit and help. All code that reads, checks, lists or changes settings
//! uses [`Settings::visit`], independent of the individual settings.

mod choice;
mod declare;
mod domain;
mod members;
mod value;

pub use choice::Choice;
pub(crate) use choice::choices;
pub(crate) use declare::settings;
pub use domain::Domain;
pub(crate) use domain::{
    MEAN_COSINE, SHARE, above, at_least, between, from, index_of_refraction, one_of, vector, with_extension,
};
pub(crate) use members::members;
pub use value::{Kind, SettingType, Slot, Value};

use crate::{Diagnostic, Origin};

/// The declaration of a setting, without its type and value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Field {
    /// Its name; that of the pbrt-v4 format, if the format has the setting.
    pub name: &'static str,
    /// Further names by which a user can set it. Several settings may share one.
    pub aliases: &'static [&'static str],
    /// Its meaning, in complete sentences.
    pub help: &'static str,
    /// The allowed values.
    pub domain: Domain,
}

impl Field {
    /// A parameter with any value.
    pub(crate) const fn new(name: &'static str, help: &'static str) -> Self {
        Self { name, aliases: &[], help, domain: Domain::ANY }
    }

    /// Sets the allowed values.
    pub(crate) const fn within(self, domain: Domain) -> Self {
        Self { domain, ..self }
    }

    /// Whether the name or an alias equals `name`.
    pub fn is_called(&self, name: &str) -> bool {
        self.name == name || self.aliases.contains(&name)
    }

    /// Sets the value. The error describes the allowed values.
    pub fn assign(&self, slot: &mut dyn Slot, value: &Value) -> Result<(), String> {
        if self.domain.contains(value) && slot.set(value) {
            return Ok(());
        }
        Err(self.domain.describe(slot.kind()))
    }

    /// Sets the value from text. The error describes the allowed values.
    pub fn assign_text(&self, slot: &mut dyn Slot, text: &str) -> Result<(), String> {
        match slot.kind().parse(text) {
            Some(value) => self.assign(slot, &value),
            None => Err(self.domain.describe(slot.kind())),
        }
    }
}

/// A setting with its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// Its declaration.
    pub field: &'static Field,
    /// Its type.
    pub kind: Kind,
    /// Its value.
    pub value: Value,
}

/// A member of a closed set, such as one of the integrators.
#[derive(Clone, Copy, Debug)]
pub struct Member {
    /// Its names; the first is displayed.
    pub names: &'static [&'static str],
    /// A description, in complete sentences.
    pub help: &'static str,
    /// Whether it is supported. Others can be described, but are replaced when rendering.
    pub is_drawn: bool,
    /// Whether the format of pbrt-v4 does not have it.
    pub is_extension: bool,
}

/// The callback of [`Settings::visit`].
pub type Visitor<'a> = &'a mut dyn FnMut(&'static Field, &mut dyn Slot);

/// A part of a scene's description that consists of settings.
pub trait Settings {
    /// Calls `visitor` for each setting, in the order of their declaration: the same settings for
    /// each value of a struct or member.
    fn visit(&mut self, visitor: Visitor);

    /// The member of the set; `None` if the type is not a set.
    fn member(&self) -> Option<&'static Member> {
        None
    }

    /// Every member of the set with default settings; one default value if the type is not a set.
    fn members() -> Vec<Self>
    where
        Self: Sized + Default,
    {
        vec![Self::default()]
    }

    /// The member of that name with default settings.
    fn called(name: &str) -> Option<Self>
    where
        Self: Sized + Default,
    {
        Self::members()
            .into_iter()
            .find(|desc| desc.member().is_some_and(|member| member.names.contains(&name)))
    }

    /// The displayed name of the member of the set; empty if the type is not a set.
    fn name(&self) -> &'static str {
        self.member().map_or("", |member| member.names[0])
    }

    /// All settings with their values.
    fn settings(&self) -> Vec<Setting>
    where
        Self: Clone,
    {
        let mut settings = Vec::new();
        self.clone().visit(&mut |field, slot| {
            settings.push(Setting { field, kind: slot.kind(), value: slot.get() });
        });
        settings
    }

    /// Sets every setting of that name from text and returns their [`Field::name`]s, none if there
    /// is no such setting. The error describes the allowed values.
    fn set_text(&mut self, name: &str, text: &str) -> Result<Vec<&'static str>, String> {
        let mut results = Vec::new();
        self.visit(&mut |field, slot| {
            if field.is_called(name) {
                results.push(field.assign_text(slot, text).map(|()| field.name));
            }
        });
        results.into_iter().collect()
    }

    /// An error for every value outside its domain, at the span of the parameter.
    fn check(&self, origin: &Origin) -> Vec<Diagnostic>
    where
        Self: Clone,
    {
        let wrong = |setting: &Setting| !setting.field.domain.contains(&setting.value);
        let error = |Setting { field, kind, value }: Setting| {
            let message = format!("`{}` is {}, not {value}", field.name, field.domain.describe(kind));
            Diagnostic::error("invalid-value", message, origin.parameter(field.name))
        };
        self.settings().into_iter().filter(wrong).map(error).collect()
    }
}

impl<T: Settings + Default> Settings for Box<T> {
    fn visit(&mut self, visitor: Visitor) {
        T::visit(self, visitor);
    }

    fn member(&self) -> Option<&'static Member> {
        T::member(self)
    }

    fn members() -> Vec<Self> {
        T::members().into_iter().map(Box::new).collect()
    }
}

#[cfg(test)]
mod tests;
