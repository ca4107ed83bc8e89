//! Settings as a report tells them: by the names that `--set` and the pbrt-v4 format have for them.

use description::{FilterDesc, Randomization, SamplerKind};
use serde_json::{Map, Value};

use crate::names::filter_name;
use crate::sampler_name;

/// Names and values as text, in a fixed order; `None` is what an algorithm chooses by itself.
pub type Settings = Vec<(&'static str, Option<String>)>;

/// A pixel filter: its name, and its parameters.
pub(super) fn filter(desc: &FilterDesc) -> Settings {
    let (radius, more) = match *desc {
        FilterDesc::Box { radius } | FilterDesc::Triangle { radius } => (radius, vec![]),
        FilterDesc::Gaussian { radius, sigma } => (radius, vec![("sigma", sigma)]),
        FilterDesc::Mitchell { radius, b, c } => (radius, vec![("B", b), ("C", c)]),
        FilterDesc::LanczosSinc { radius, tau } => (radius, vec![("tau", tau)]),
    };
    let numbers = [("xradius", radius[0]), ("yradius", radius[1])].into_iter().chain(more);
    let mut settings = vec![("name", Some(filter_name(desc).to_owned()))];
    settings.extend(numbers.map(|(name, value)| (name, Some(value.to_string()))));
    settings
}

/// A sampler: its name, and its parameters but for the number of samples.
pub(super) fn sampler(kind: &SamplerKind) -> Settings {
    let mut settings = vec![("name", Some(sampler_name(kind).to_owned()))];
    match *kind {
        SamplerKind::Independent | SamplerKind::Pmj02Bn => (),
        SamplerKind::Stratified { strata, jitter } => settings.extend([
            ("xsamples", Some(strata[0].to_string())),
            ("ysamples", Some(strata[1].to_string())),
            ("jitter", Some(jitter.to_string())),
        ]),
        SamplerKind::Halton { randomization }
        | SamplerKind::PaddedSobol { randomization }
        | SamplerKind::Sobol { randomization }
        | SamplerKind::ZSobol { randomization } => {
            let name = match randomization {
                Randomization::None => "none",
                Randomization::PermuteDigits => "permutedigits",
                Randomization::FastOwen => "fastowen",
                Randomization::Owen => "owen",
            };
            settings.push(("randomization", Some(name.to_owned())));
        }
    }
    settings
}

/// For people: `maxdepth 5, radius by itself`.
pub(super) fn text(settings: &Settings) -> String {
    let told = settings.iter().map(|(name, value)| match value {
        Some(value) if *name == "name" => value.clone(),
        Some(value) => format!("{name} {value}"),
        None => format!("{name} by itself"),
    });
    told.collect::<Vec<_>>().join(", ")
}

/// For programs: an object of numbers, booleans and texts; null for what an algorithm chooses by
/// itself.
pub(super) fn json(settings: &Settings) -> Value {
    let value = |text: &String| serde_json::from_str(text).unwrap_or_else(|_| Value::String(text.clone()));
    let entry = |(name, told): &(&str, Option<String>)| {
        ((*name).to_owned(), told.as_ref().map_or(Value::Null, value))
    };
    Value::Object(settings.iter().map(entry).collect::<Map<_, _>>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json as object;

    #[test]
    fn both_say_the_same() {
        let settings = filter(&FilterDesc::default());
        assert_eq!(text(&settings), "gaussian, xradius 1.5, yradius 1.5, sigma 0.5");
        let expected = object!({ "name": "gaussian", "xradius": 1.5, "yradius": 1.5, "sigma": 0.5 });
        assert_eq!(json(&settings), expected);
        let settings = vec![
            ("radius", None),
            ("photons", Some("7".into())),
            ("kernel", Some("cone".into())),
            ("far", Some("inf".into())),
            ("fast", Some("true".into())),
        ];
        assert_eq!(text(&settings), "radius by itself, photons 7, kernel cone, far inf, fast true");
        let expected =
            object!({ "radius": null, "photons": 7, "kernel": "cone", "far": "inf", "fast": true });
        assert_eq!(json(&settings), expected);
    }
}
