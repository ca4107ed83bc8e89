//! Keyword arguments of compile() and render(), checked. The rest of their errors is the engine's.

use alhazen::most_threads;
use pyo3::prelude::*;
use pyo3::types::PyString;

use crate::errors::{wrong_type, wrong_value};

/// The form of a crop.
pub const CROP: &str = "four fractions of the picture's width and height from 0 to 1, (x0, x1, y0, y1) \
     with x0 < x1 and y0 < y1, such as (0.25, 0.75, 0, 1)";

/// A whole number of a range; `None` for Python's None.
fn whole(value: &Bound<'_, PyAny>, name: &str, [least, most]: [i64; 2]) -> PyResult<Option<i64>> {
    if value.is_none() {
        return Ok(None);
    }
    let wanted = format!("a whole number from {least} to {most}");
    // Integers of numpy are numbers, too; those beyond 64 bits are out of range.
    if !value.hasattr("__index__")? {
        return Err(wrong_type(name, &wanted, value));
    }
    match value.extract::<i64>() {
        Ok(number) if (least..=most).contains(&number) => Ok(Some(number)),
        _ => Err(wrong_value(name, &wanted, value)),
    }
}

/// A number that must be given.
fn counted(value: &Bound<'_, PyAny>, name: &str) -> PyResult<u32> {
    let most = i64::from(u32::MAX);
    let none = || wrong_type(name, "a whole number", value);
    whole(value, name, [1, most])?.map(|number| number as u32).ok_or_else(none)
}

/// The number of a shard.
pub fn index(value: &Bound<'_, PyAny>) -> PyResult<u32> {
    counted(value, "index")
}

/// The number of shards.
pub fn count(value: &Bound<'_, PyAny>) -> PyResult<u32> {
    counted(value, "count")
}

/// The type of a material, shape and the like.
pub fn kind(value: &Bound<'_, PyAny>) -> PyResult<String> {
    value.extract().map_err(|_| wrong_type("kind", "the name of a type, a text such as \"sphere\"", value))
}

/// Whether a crop is a part of the picture.
pub fn is_part([x0, x1, y0, y1]: [f32; 4]) -> bool {
    0.0 <= x0 && x0 < x1 && x1 <= 1.0 && 0.0 <= y0 && y0 < y1 && y1 <= 1.0
}

/// Samples per pixel.
pub fn spp(value: &Bound<'_, PyAny>) -> PyResult<Option<u32>> {
    Ok(whole(value, "spp", [1, i32::MAX.into()])?.map(|number| number as u32))
}

/// The seed of all random numbers.
pub fn seed(value: &Bound<'_, PyAny>) -> PyResult<Option<i32>> {
    Ok(whole(value, "seed", [i32::MIN.into(), i32::MAX.into()])?.map(|number| number as i32))
}

/// A number of threads.
pub fn threads(value: &Bound<'_, PyAny>) -> PyResult<Option<usize>> {
    Ok(whole(value, "threads", [1, most_threads() as i64])?.map(|number| number as usize))
}

/// Width and height of a picture.
pub fn resolution(value: &Bound<'_, PyAny>) -> PyResult<Option<[i32; 2]>> {
    const WANTED: &str = "width and height in pixels, two whole numbers from 1 to 1000000 such as (640, 480)";
    if value.is_none() {
        return Ok(None);
    }
    let Ok(sides) = value.extract::<[i64; 2]>() else {
        return Err(wrong_type("resolution", WANTED, value));
    };
    match sides.iter().all(|side| (1..=1_000_000).contains(side)) {
        true => Ok(Some(sides.map(|side| side as i32))),
        false => Err(wrong_value("resolution", WANTED, value)),
    }
}

/// A part of a picture.
pub fn crop(value: &Bound<'_, PyAny>) -> PyResult<Option<[f32; 4]>> {
    if value.is_none() {
        return Ok(None);
    }
    let Ok(fractions) = value.extract::<[f32; 4]>() else {
        return Err(wrong_type("crop", CROP, value));
    };
    if is_part(fractions) {
        return Ok(Some(fractions));
    }
    let are_pixels =
        fractions.iter().all(|value| *value >= 0.0) && fractions.iter().any(|value| *value >= 2.0);
    let wanted = match are_pixels {
        true => format!("{CROP} (pixels are divided by the width or the height)"),
        false => CROP.to_owned(),
    };
    Err(wrong_value("crop", &wanted, value))
}

/// Names of layers.
pub fn layers(value: &Bound<'_, PyAny>) -> PyResult<Option<Vec<String>>> {
    if value.is_none() {
        return Ok(None);
    }
    // A text is a sequence of texts, too.
    let names = match value.is_instance_of::<PyString>() {
        true => None,
        false => value.extract::<Vec<String>>().ok(),
    };
    match names {
        Some(names) => Ok(Some(names)),
        None => Err(wrong_type("layers", "a list of names such as [\"depth\"]", value)),
    }
}

/// Seconds of a render.
pub fn time(value: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    let is_time = |seconds: f64| (0.0..1e15).contains(&seconds);
    number(value, "time", "seconds, a number of 0 or more", is_time)
}

/// A relative standard error.
pub fn noise(value: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    let is_noise = |noise: f64| noise > 0.0 && noise.is_finite();
    number(value, "noise", "a relative error, a number above 0 such as 0.02", is_noise)
}

fn number(
    value: &Bound<'_, PyAny>,
    name: &str,
    wanted: &str,
    is_right: impl Fn(f64) -> bool,
) -> PyResult<Option<f64>> {
    if value.is_none() {
        return Ok(None);
    }
    match value.extract::<f64>() {
        Ok(number) if is_right(number) => Ok(Some(number)),
        Ok(_) => Err(wrong_value(name, wanted, value)),
        Err(_) => Err(wrong_type(name, wanted, value)),
    }
}
