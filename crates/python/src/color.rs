//! Colours that cannot be meant.

use alhazen::description::OpenPbrDesc;
use alhazen::pbrt::{Argument, ArgumentValues};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Names of reflectances, beside those of an OpenPBR surface.
const REFLECTANCES: [&str; 4] = ["reflectance", "transmittance", "albedo", "color"];
/// The largest component of a reflectance: 1, up to the rounding of conversions.
const MOST: f32 = 1.001;

/// Refuses reflectances of a material that are not from 0 to 1.
pub fn check_material(arguments: &[Argument]) -> PyResult<()> {
    let is_reflectance = |name: &str| {
        REFLECTANCES.contains(&name) || OpenPbrDesc::COLORS.iter().any(|color| color.0.name == name)
    };
    arguments.iter().filter(|argument| is_reflectance(&argument.name)).try_for_each(|argument| {
        let values = components(argument).unwrap_or_default();
        match values.iter().all(|value| (0.0..=MOST).contains(value)) {
            true => Ok(()),
            false => Err(refusal(&argument.name, &values)),
        }
    })
}

/// Refuses codes from 0 to 255 for colours of a texture, which may have any real numbers.
pub fn check_texture(arguments: &[Argument]) -> PyResult<()> {
    arguments.iter().try_for_each(|argument| match (&argument.values, components(argument)) {
        (ArgumentValues::Integers(_), Some(values))
            if values.len() == 3 && values.iter().any(|&v| v > 1.0) =>
        {
            Err(refusal(&argument.name, &values))
        }
        _ => Ok(()),
    })
}

/// A grey, or red, green and blue.
fn components(argument: &Argument) -> Option<Vec<f32>> {
    if !matches!(argument.type_name.as_deref(), None | Some("rgb")) {
        return None;
    }
    let values: Vec<f32> = match &argument.values {
        ArgumentValues::Floats(values) => values.to_vec(),
        ArgumentValues::Integers(values) => values.iter().map(|&value| value as f32).collect(),
        _ => return None,
    };
    matches!(values.len(), 1 | 3).then_some(values)
}

fn refusal(name: &str, values: &[f32]) -> PyErr {
    let values = values.iter().map(f32::to_string).collect::<Vec<_>>().join(", ");
    PyValueError::new_err(format!(
        "`{name}` is linear red, green and blue from 0 to 1, not ({values}); a code from 0 to 255 of sRGB \
         is about (code / 255) ** 2.2"
    ))
}
