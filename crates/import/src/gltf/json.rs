//! Values of the JSON text with their places, so that every message can name one.

use serde_json::Value;

pub(super) use crate::log::{Fault, Result};

/// A value with its place.
#[derive(Clone, Debug)]
pub(super) struct Place<'a> {
    /// The value.
    pub value: &'a Value,
    /// Its JSON pointer.
    pub pointer: String,
}

static NOTHING: Value = Value::Null;

impl<'a> Place<'a> {
    /// An object without members.
    pub fn empty(pointer: impl Into<String>) -> Self {
        Self { value: &NOTHING, pointer: pointer.into() }
    }

    /// The whole text.
    pub fn root(value: &'a Value) -> Self {
        Self { value, pointer: String::new() }
    }

    pub fn invalid(&self, message: impl Into<String>) -> Fault {
        Fault::new("invalid-gltf", &self.pointer, message)
    }

    /// The pointer of a member.
    pub fn pointer_to(&self, key: &str) -> String {
        format!("{}/{}", self.pointer, key.replace('~', "~0").replace('/', "~1"))
    }

    /// A fault of a member, whether it is there or not.
    pub fn invalid_member(&self, key: &str, message: impl Into<String>) -> Fault {
        Fault::new("invalid-gltf", self.pointer_to(key), message)
    }

    /// A member of an object; `None` if it is absent, or this is no object.
    pub fn get(&self, key: &str) -> Option<Self> {
        self.value.get(key).map(|value| Self { value, pointer: self.pointer_to(key) })
    }

    /// A member that must be there.
    pub fn required(&self, key: &str) -> Result<Self> {
        self.get(key).ok_or_else(|| self.invalid(format!("`{key}` is missing")))
    }

    /// The object of an extension.
    pub fn extension(&self, name: &str) -> Result<Option<Self>> {
        let Some(extensions) = self.object("extensions")? else { return Ok(None) };
        extensions.object(name)
    }

    /// A member that is an object.
    pub fn object(&self, key: &str) -> Result<Option<Self>> {
        match self.get(key) {
            Some(place) if place.value.is_object() => Ok(Some(place)),
            Some(place) => Err(place.invalid("this must be an object")),
            None => Ok(None),
        }
    }

    /// The elements of a member that is an array; none if it is absent.
    pub fn array(&self, key: &str) -> Result<Vec<Self>> {
        let Some(place) = self.get(key) else { return Ok(Vec::new()) };
        let Value::Array(items) = place.value else { return Err(place.invalid("this must be an array")) };
        let element = |(index, value)| Self { value, pointer: format!("{}/{index}", place.pointer) };
        Ok(items.iter().enumerate().map(element).collect())
    }

    pub fn string(&self, key: &str) -> Result<Option<&'a str>> {
        match self.get(key) {
            Some(place) => match place.value.as_str() {
                Some(text) => Ok(Some(text)),
                None => Err(place.invalid("this must be a string")),
            },
            None => Ok(None),
        }
    }

    pub fn boolean(&self, key: &str, default: bool) -> Result<bool> {
        match self.get(key) {
            Some(place) => place.value.as_bool().ok_or_else(|| place.invalid("this must be true or false")),
            None => Ok(default),
        }
    }

    /// This value as a finite number.
    pub fn as_number(&self) -> Result<f64> {
        self.value
            .as_f64()
            .filter(|number| number.is_finite())
            .ok_or_else(|| self.invalid("this must be a number"))
    }

    /// This value as an integer that is not negative.
    pub fn as_integer(&self) -> Result<usize> {
        let whole =
            |number: f64| (number.fract() == 0.0 && (0.0..9e15).contains(&number)).then_some(number as u64);
        self.value
            .as_u64()
            .or_else(|| self.value.as_f64().and_then(whole))
            .and_then(|number| usize::try_from(number).ok())
            .ok_or_else(|| self.invalid("this must be an integer that is not negative"))
    }

    /// This value as an index into an array of `count` `things`.
    pub fn as_index(&self, count: usize, things: &str) -> Result<usize> {
        let index = self.as_integer()?;
        if index < count {
            return Ok(index);
        }
        Err(self.invalid(format!("there is no element {index} in `{things}`, which has {count}")))
    }

    pub fn number(&self, key: &str) -> Result<Option<f64>> {
        self.get(key).map(|place| place.as_number()).transpose()
    }

    /// A number of a range, with its value if it is absent. One that is outside by rounding is the
    /// end of the range.
    pub fn number_in(&self, key: &str, default: f64, [least, most]: [f64; 2]) -> Result<f32> {
        let number = self.number(key)?.unwrap_or(default);
        if let Some(number) = rounded_into(number, [least, most]) {
            return Ok(number);
        }
        let range = match most {
            f64::INFINITY => format!("{least} or more"),
            _ => format!("between {least} and {most}"),
        };
        Err(self.invalid_member(key, format!("this must be {range}, not {number}")))
    }

    pub fn integer(&self, key: &str) -> Result<Option<usize>> {
        self.get(key).map(|place| place.as_integer()).transpose()
    }

    pub fn index(&self, key: &str, count: usize, things: &str) -> Result<Option<usize>> {
        self.get(key).map(|place| place.as_index(count, things)).transpose()
    }

    /// A member that is an array of `N` numbers.
    pub fn numbers<const N: usize>(&self, key: &str) -> Result<Option<[f64; N]>> {
        if self.get(key).is_none() {
            return Ok(None);
        }
        let items = self.array(key)?;
        if items.len() != N {
            return Err(self.invalid_member(key, format!("this must have {N} numbers, not {}", items.len())));
        }
        let mut numbers = [0.0; N];
        for (number, item) in numbers.iter_mut().zip(&items) {
            *number = item.as_number()?;
        }
        Ok(Some(numbers))
    }

    /// A colour whose components lie in a range.
    pub fn color<const N: usize>(&self, key: &str, default: [f32; N], most: f64) -> Result<[f32; N]> {
        let Some(numbers) = self.numbers::<N>(key)? else { return Ok(default) };
        let mut color = [0.0; N];
        for (component, number) in color.iter_mut().zip(numbers) {
            *component = rounded_into(number, [0.0, most]).ok_or_else(|| {
                self.invalid_member(key, format!("{number} is out of the range of a colour"))
            })?;
        }
        Ok(color)
    }
}

/// A number of a range, or the end of the range that it misses by no more than a few roundings in
/// single precision; `None` outside.
fn rounded_into(number: f64, [least, most]: [f64; 2]) -> Option<f32> {
    let slack = |end: f64| 1e-6 * end.abs().max(1.0);
    let range = least - slack(least)..=most + slack(most);
    range.contains(&number).then(|| number.clamp(least, most) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_name_their_place() {
        let value: Value = serde_json::from_str(r#"{"a": [{"b/c": 5}, 7], "n": [1, 2.5]}"#).unwrap();
        let root = Place::root(&value);
        let items = root.array("a").unwrap();
        assert_eq!(items[0].get("b/c").unwrap().pointer, "/a/0/b~1c");
        assert_eq!(items[1].as_index(7, "nodes").unwrap_err().place, "/a/1");
        assert_eq!(items[1].as_index(8, "nodes"), Ok(7));
        assert_eq!(root.numbers("n"), Ok(Some([1.0, 2.5])));
        let fault = root.numbers::<3>("n").unwrap_err();
        assert_eq!(fault.message, "this must have 3 numbers, not 2");
        assert_eq!(root.array("n").unwrap()[1].as_integer().unwrap_err().place, "/n/1");
        assert_eq!(root.object("n").unwrap_err().place, "/n");
        assert_eq!(root.required("q").unwrap_err().message, "`q` is missing");
        assert_eq!(root.number_in("q", 0.5, [0.0, 1.0]), Ok(0.5));
    }

    #[test]
    fn what_single_precision_rounds_out_of_a_range_is_its_end() {
        use std::f64::consts::FRAC_PI_2;
        for (number, range, end) in [
            (1.570_796_370_506_286_6, [0.0, FRAC_PI_2], FRAC_PI_2 as f32),
            (1.570_796_4, [0.0, FRAC_PI_2], FRAC_PI_2 as f32),
            (1.000_000_119_209_289_6, [0.0, 1.0], 1.0),
            (-5.96e-8, [0.0, f64::INFINITY], 0.0),
            (0.999_999_94, [1.0, f64::INFINITY], 1.0),
            (7.5, [0.0, f64::INFINITY], 7.5),
        ] {
            assert_eq!(rounded_into(number, range), Some(end), "{number}");
        }
        for (number, range) in [(1.0001, [0.0, 1.0]), (-0.001, [0.0, 1.0]), (1.571, [0.0, FRAC_PI_2])] {
            assert_eq!(rounded_into(number, range), None, "{number}");
        }
        let value: Value = serde_json::from_str(r#"{"c": [1.0000001192092896, 0, 0.5]}"#).unwrap();
        assert_eq!(Place::root(&value).color("c", [0.0; 3], 1.0), Ok([1.0, 0.0, 0.5]));
    }
}
