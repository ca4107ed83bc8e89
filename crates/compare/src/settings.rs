//! Settings in reports, by their names in `--set` and the pbrt-v4 format.

use serde_json::{Map, Value as Json};

use alhazen::description::SamplerKind;
use alhazen::description::schema::{self, Value};

/// Names and values, in a fixed order.
pub type Settings = Vec<(&'static str, Value)>;

/// The settings of a part of a scene; first, as `name`, the member of its set.
pub(super) fn listed<T: schema::Settings + Clone + Default>(desc: &T) -> Settings {
    let member = desc.member().map(|member| ("name", Value::Text(member.names[0].to_owned())));
    let settings = desc.settings().into_iter().map(|setting| (setting.field.name, setting.value));
    member.into_iter().chain(settings).collect()
}

/// A sampler's name and its settings, without the number of samples.
pub(super) fn of_sampler(kind: &SamplerKind) -> Settings {
    let mut settings = listed(kind);
    settings.retain(|(name, _)| *name != "pixelsamples");
    settings
}

/// As text: `maxdepth 5, radius automatic`.
pub(super) fn text(settings: &Settings) -> String {
    let texts = settings.iter().map(|(name, value)| match *name {
        "name" => value.to_string(),
        name => format!("{name} {value}"),
    });
    texts.collect::<Vec<_>>().join(", ")
}

/// As a JSON object of numbers, booleans and strings; null for automatic values.
pub(super) fn json(settings: &Settings) -> Json {
    Json::Object(
        settings.iter().map(|(name, value)| ((*name).to_owned(), json_value(value))).collect::<Map<_, _>>(),
    )
}

fn json_value(value: &Value) -> Json {
    match value {
        Value::Bool(value) => (*value).into(),
        Value::Integer(value) => (*value).into(),
        // Converted through text: an `f32` as `f64` would have more digits.
        Value::Number(_) => {
            let text = value.to_string();
            serde_json::from_str(&text).unwrap_or(Json::String(text))
        }
        Value::Text(_)
        | Value::Point(_)
        | Value::Spectrum(_)
        | Value::FloatTexture(_)
        | Value::SpectrumTexture(_) => value.to_string().into(),
        Value::List(values) => values.iter().map(json_value).collect(),
        Value::Automatic => Json::Null,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alhazen::description::FilterDesc;
    use serde_json::json as object;

    #[test]
    fn text_and_json_have_the_same_settings() {
        let settings = listed(&FilterDesc::default());
        assert_eq!(text(&settings), "gaussian, xradius 1.5, yradius 1.5, sigma 0.5");
        let expected = object!({ "name": "gaussian", "xradius": 1.5, "yradius": 1.5, "sigma": 0.5 });
        assert_eq!(json(&settings), expected);
        assert_eq!(text(&of_sampler(&SamplerKind::default())), "zsobol, randomization fastowen");
        let settings = vec![
            ("radius", Value::Automatic),
            ("photons", Value::Integer(7)),
            ("kernel", Value::Text("cone".into())),
            ("far", Value::Number(f32::INFINITY)),
            ("part", Value::List(vec![Value::Number(0.1), Value::Integer(1)])),
            ("fast", Value::Bool(true)),
        ];
        let expected = "radius automatic, photons 7, kernel cone, far inf, part 0.1,1, fast true";
        assert_eq!(text(&settings), expected);
        let expected = object!({
            "radius": null, "photons": 7, "kernel": "cone", "far": "inf", "part": [0.1, 1], "fast": true
        });
        assert_eq!(json(&settings), expected);
    }
}
