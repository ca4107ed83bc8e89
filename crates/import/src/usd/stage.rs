//! The composed scene: prims, and values of their attributes at the times that are drawn.

use std::fmt::Display;

use openusd::sdf::{Specifier, Value};
use openusd::{pcp, usd};

use super::files::Resolver;
use super::value;
use crate::log::{Fault, Result};

/// A scene that is open, at the times when the shutter opens and closes.
pub(super) struct Stage {
    inner: usd::Stage,
    /// Time codes; `None` for values that do not vary.
    times: [Option<f64>; 2],
    /// Where the animation starts.
    start: f64,
}

/// The two times at which moving things are read.
pub(super) const TIMES: [usize; 2] = [0, 1];

/// The code of faults in what a file says.
pub(super) const INVALID: &str = "invalid-usd";

impl Stage {
    /// Opens a scene at a number of seconds, for as long as the shutter is open.
    pub fn open(path: &str, resolver: Resolver, seconds: Option<f64>, shutter: f64) -> Result<Self> {
        let inner = usd::Stage::builder().resolver(resolver).open(path);
        let inner = inner.map_err(|error| Fault::new(INVALID, "", message(&error)))?;
        let rate = inner.time_codes_per_second();
        if !(rate.is_finite() && rate > 0.0) {
            return Err(Fault::new(INVALID, "timeCodesPerSecond", format!("{rate} is not above 0")));
        }
        let code = |seconds: f64| seconds * rate;
        let times = [seconds.map(code), seconds.map(|seconds| code(seconds + shutter))];
        let start = inner.start_time_code();
        Ok(Self { inner, times, start })
    }

    /// What is wrong with references, payloads and layers that were met until now, and what is only
    /// left out: targets and values that a layer says in vain.
    pub fn composition(&self) -> (Vec<Fault>, Vec<String>) {
        use pcp::Error::*;
        let is_left_out = |error: &pcp::Error| {
            matches!(
                error,
                InvalidExternalTargetPath { .. }
                    | InvalidInstanceTargetPath { .. }
                    | InconsistentPropertyType { .. }
                    | OpinionAtRelocationSource { .. }
                    | ProhibitedRelocationSource { .. }
            )
        };
        let (left_out, wrong): (Vec<_>, Vec<_>) =
            self.inner.composition_errors().into_iter().partition(is_left_out);
        let sorted = |errors: Vec<pcp::Error>| {
            let mut texts: Vec<_> = errors.iter().map(|error| error.to_string()).collect();
            texts.sort();
            texts.dedup();
            texts
        };
        let fault = |text| Fault::new("unreadable-file", "", text);
        (sorted(wrong).into_iter().map(fault).collect(), sorted(left_out))
    }

    /// Whether +z is up, not +y.
    pub fn is_z_up(&self) -> bool {
        let axis = self.inner.stage_metadata("upAxis").ok().flatten();
        axis.and_then(value::words).is_some_and(|words| words.first().is_some_and(|word| word == "Z"))
    }

    /// The prims at the top.
    pub fn roots(&self) -> Result<Vec<Prim<'_>>> {
        let names = self.inner.root_prims().map_err(|error| Fault::new(INVALID, "/", message(&error)))?;
        Ok(names.iter().map(|name| self.prim(&format!("/{name}"))).collect())
    }

    /// The prim of a path.
    pub fn prim(&self, path: &str) -> Prim<'_> {
        Prim { stage: self, inner: self.inner.prim(path) }
    }
}

/// A prim.
#[derive(Clone)]
pub(super) struct Prim<'s> {
    pub stage: &'s Stage,
    inner: usd::Prim,
}

impl<'s> Prim<'s> {
    pub fn path(&self) -> &str {
        self.inner.path().as_str()
    }

    pub fn name(&self) -> &str {
        self.inner.path().name().unwrap_or_default()
    }

    /// A fault of a property; of the prim as a whole if the name is empty.
    pub fn fault(&self, property: &str, text: impl Into<String>) -> Fault {
        let dot = if property.is_empty() { "" } else { "." };
        Fault::new(INVALID, format!("{}{dot}{property}", self.path()), text)
    }

    /// The result of the crate, or a fault of a property.
    fn kept<T>(&self, property: &str, result: std::result::Result<T, impl Display>) -> Result<T> {
        result.map_err(|error| self.fault(property, message(&error)))
    }

    /// The name of its schema; empty for none.
    pub fn kind(&self) -> Result<String> {
        Ok(self.kept("", self.inner.type_name())?.map(String::from).unwrap_or_default())
    }

    /// Whether it is there to be drawn: active, and defined as no class. What is above it is not
    /// asked.
    pub fn is_drawn(&self) -> Result<bool> {
        let specifier = self.kept("", self.inner.specifier())?;
        Ok(specifier == Some(Specifier::Def) && self.kept("", self.inner.is_active())?)
    }

    /// The path of the prototype that it is an instance of.
    pub fn prototype(&self) -> Result<Option<String>> {
        match self.kept("", self.inner.is_instance())? {
            true => Ok(self.kept("", self.inner.prototype())?.map(|path| path.as_str().to_owned())),
            false => Ok(None),
        }
    }

    pub fn has_schema(&self, name: &str) -> Result<bool> {
        let names = self.kept("apiSchemas", self.inner.api_schemas())?;
        Ok(names.iter().any(|known| known.as_str().split(':').next() == Some(name)))
    }

    pub fn children(&self) -> Result<Vec<Prim<'s>>> {
        let children = self.kept("", self.inner.children())?;
        Ok(children.into_iter().map(|inner| Self { stage: self.stage, inner }).collect())
    }

    /// The prim above it.
    pub fn parent(&self) -> Option<Prim<'s>> {
        let parent = self.inner.path().parent().filter(|parent| !parent.is_abs_root())?;
        Some(self.stage.prim(parent.as_str()))
    }

    /// The names of its properties.
    pub fn properties(&self) -> Result<Vec<String>> {
        let names = self.kept("", self.inner.property_names())?;
        Ok(names.into_iter().map(String::from).collect())
    }

    /// The value of an attribute at one of the [`TIMES`].
    fn value(&self, name: &str, time: usize) -> Result<Option<Value>> {
        let attribute = self.inner.attribute(name);
        let at = |code: f64| self.kept(name, attribute.get_at::<Value>(usd::TimeCode::new(code)));
        let value = match self.stage.times[time] {
            Some(code) => at(code)?,
            None => match self.kept(name, attribute.get_at::<Value>(None))? {
                None => at(self.stage.start)?,
                known => known,
            },
        };
        Ok(value.filter(|value| !matches!(value, Value::None | Value::ValueBlock)))
    }

    fn wrong_type(&self, name: &str, value: &Value, wanted: &str) -> Fault {
        let kind: &'static str = value.into();
        self.fault(name, format!("this must be {wanted}, not a value of the type `{kind}`"))
    }

    /// The elements of an attribute at a time, of `N` numbers each; those of one value, too.
    pub fn array_at<const N: usize>(&self, name: &str, time: usize) -> Result<Option<Vec<[f64; N]>>> {
        let Some(value) = self.value(name, time)? else { return Ok(None) };
        if let Value::ValueVec(values) = &value
            && values.is_empty()
        {
            return Ok(Some(Vec::new()));
        }
        let wanted = || self.wrong_type(name, &value, &format!("elements of {N} numbers"));
        match value::numbers(value.clone()) {
            Some(numbers) if numbers.width == N => {
                let (chunks, _) = numbers.values.as_chunks::<N>();
                Ok(Some(chunks.to_vec()))
            }
            _ => Err(wanted()),
        }
    }

    /// [`Self::array_at`] the first time.
    pub fn array<const N: usize>(&self, name: &str) -> Result<Option<Vec<[f64; N]>>> {
        self.array_at(name, 0)
    }

    /// One element of an attribute at a time, which is finite.
    pub fn numbers_at<const N: usize>(&self, name: &str, time: usize) -> Result<Option<[f64; N]>> {
        let Some(values) = self.array_at::<N>(name, time)? else { return Ok(None) };
        match values.as_slice() {
            [value] if value.iter().all(|v| v.is_finite()) => Ok(Some(*value)),
            [_] => Err(self.fault(name, "this must be finite")),
            _ => Err(self.fault(name, "this must be one value")),
        }
    }

    pub fn numbers<const N: usize>(&self, name: &str) -> Result<Option<[f64; N]>> {
        self.numbers_at(name, 0)
    }

    pub fn number(&self, name: &str) -> Result<Option<f64>> {
        Ok(self.numbers::<1>(name)?.map(|[value]| value))
    }

    /// A number that is not negative.
    pub fn positive(&self, name: &str, otherwise: f64) -> Result<f64> {
        match self.number(name)?.unwrap_or(otherwise) {
            value if value >= 0.0 => Ok(value),
            value => Err(self.fault(name, format!("this must not be negative, but is {value}"))),
        }
    }

    pub fn flag(&self, name: &str) -> Result<bool> {
        Ok(self.number(name)?.is_some_and(|value| value != 0.0))
    }

    /// Whole numbers.
    pub fn integers(&self, name: &str) -> Result<Option<Vec<i64>>> {
        let values = self.array::<1>(name)?;
        Ok(values.map(|values| values.into_iter().map(|[value]| value as i64).collect()))
    }

    pub fn words(&self, name: &str) -> Result<Option<Vec<String>>> {
        let Some(value) = self.value(name, 0)? else { return Ok(None) };
        let fault = self.wrong_type(name, &value, "a token");
        value::words(value).map(Some).ok_or(fault)
    }

    pub fn word(&self, name: &str) -> Result<Option<String>> {
        Ok(self.words(name)?.and_then(|words| words.into_iter().next()))
    }

    /// The file that an attribute names: where it is, if it was found, and what it is called.
    pub fn file(&self, name: &str) -> Result<Option<(Option<String>, String)>> {
        match self.value(name, 0)? {
            Some(Value::AssetPath(path)) if !path.is_empty() => {
                Ok(Some((path.resolved_path().map(str::to_owned), path.asset_path().to_owned())))
            }
            Some(Value::AssetPath(_)) | None => Ok(None),
            Some(value) => Err(self.wrong_type(name, &value, "the name of a file")),
        }
    }

    /// Where a property is inherited or drawn from, and the like: a token that describes it.
    pub fn described(&self, property: &str, key: &str) -> Result<Option<String>> {
        let value = self.inner.attribute(property).get_metadata::<Value>(key);
        Ok(self.kept(property, value)?.and_then(value::words).and_then(|words| words.into_iter().next()))
    }

    /// The prims that a relationship names.
    pub fn targets(&self, name: &str) -> Result<Vec<Prim<'s>>> {
        let paths = self.kept(name, self.inner.relationship(name).forwarded_targets())?;
        Ok(paths.into_iter().map(|path| self.stage.prim(path.as_str())).collect())
    }

    /// The prim and the property that an attribute has its value from.
    pub fn connection(&self, name: &str) -> Result<Option<(Prim<'s>, String)>> {
        let sources = self.kept(name, self.inner.attribute(name).connections())?;
        let Some(source) = sources.first() else { return Ok(None) };
        let Some((_, property)) = source.split_property() else {
            return Err(self.fault(name, format!("`{source}` is no property")));
        };
        Ok(Some((self.stage.prim(source.prim_path().as_str()), property.to_owned())))
    }

    /// Whether the prim is there at all.
    pub fn is_there(&self) -> bool {
        self.inner.is_valid().unwrap_or(false)
    }

    /// Ids that are switched off in lists of instances.
    pub fn inactive_ids(&self) -> Vec<i64> {
        let handle = self.stage.inner.attribute(self.inner.path().clone());
        match handle.get_metadata::<Value>("inactiveIds") {
            Ok(Some(Value::Int64ListOp(list))) => list.flatten(),
            _ => Vec::new(),
        }
    }
}

/// An error with all its causes.
fn message(error: &impl Display) -> String {
    format!("{error:#}")
}
