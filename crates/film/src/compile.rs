//! From the description of film and filter to a [`Film`].

use std::sync::Arc;

use description::schema::Settings;
use description::{ColorSpaceDesc, Diagnostic, FilmDesc, FilmKind, SceneDesc, Spanned};
use math::Bounds2i;
use spectrum::RgbColorSpace;

use crate::{Buckets, Film, FilmSettings, Filter, Layer, LayerSet, PixelSensor};

/// The range of white balance temperatures in kelvin.
const WHITE_BALANCE: std::ops::RangeInclusive<f32> = 500.0..=100_000.0;

/// The result of [`compile`].
#[derive(Debug)]
pub struct Compiled {
    /// The film, without light.
    pub film: Film,
    /// Warnings about what is rendered differently from its description.
    pub warnings: Vec<Diagnostic>,
}

/// Makes the film of a scene, or returns all its errors and warnings.
pub fn compile(desc: &SceneDesc) -> Result<Compiled, Vec<Diagnostic>> {
    let mut diagnostics = desc.film.check(&desc.film.origin);
    diagnostics.extend(desc.filter.check(&desc.filter.origin));
    if !diagnostics.is_empty() {
        return Err(diagnostics);
    }
    let film = settings(desc, &mut diagnostics).and_then(|settings| {
        let refused = |error: image::ImageError| {
            diagnostics.push(Diagnostic::error("invalid-film", error.to_string(), desc.film.origin.span));
        };
        Film::new(settings).map_err(refused).ok()
    });
    match film {
        Some(film) if !diagnostics.iter().any(Diagnostic::is_error) => {
            Ok(Compiled { film, warnings: diagnostics })
        }
        _ => Err(diagnostics),
    }
}

fn settings(desc: &SceneDesc, diagnostics: &mut Vec<Diagnostic>) -> Option<FilmSettings> {
    let film = &desc.film;
    let mut layers = layers(&film.layers, diagnostics);
    let (mut buckets, mut gbuffer) = (None, None);
    match film.kind {
        FilmKind::Rgb => {}
        FilmKind::GBuffer { space } => {
            let geometry = Layer::ALL.into_iter().filter(|layer| layer.is_in_gbuffer(space));
            layers = geometry.fold(layers, LayerSet::with);
            gbuffer = Some(space);
        }
        FilmKind::Spectral { buckets: count, lambda_min, lambda_max } => {
            buckets = u32::try_from(count).ok().and_then(|count| Buckets::new(count, lambda_min, lambda_max));
            if buckets.is_none() {
                let message = format!("no {count} buckets go from {lambda_min} to {lambda_max} nm");
                let span = film.origin.parameter("lambdamax");
                diagnostics.push(Diagnostic::error("invalid-film", message, span));
            }
        }
    }
    let light_groups = match layers.has(Layer::LightGroups) {
        true => desc.light_groups().into_iter().map(str::to_owned).collect(),
        false => Arc::default(),
    };
    let color_space = match film.color_space {
        ColorSpaceDesc::Srgb => RgbColorSpace::srgb(),
        ColorSpaceDesc::DciP3 => RgbColorSpace::dci_p3(),
        ColorSpaceDesc::Rec2020 => RgbColorSpace::rec2020(),
        ColorSpaceDesc::Aces2065_1 => RgbColorSpace::aces2065_1(),
    };
    let filter = Filter::new(&desc.filter).map_err(|(parameter, message)| {
        let span = desc.filter.origin.parameter(parameter);
        diagnostics.push(Diagnostic::error("invalid-filter", message, span));
    });
    let sensor = sensor(desc, color_space, diagnostics);
    Some(FilmSettings {
        full_resolution: film.resolution,
        pixel_bounds: pixel_bounds(film),
        diagonal: film.diagonal * 1e-3,
        filter: filter.ok()?,
        sensor: sensor?,
        max_component_value: film.max_component_value,
        color_space,
        half_floats: film.save_fp16,
        layers,
        buckets,
        gbuffer,
        light_groups,
    })
}

/// The layers of these names.
fn layers(names: &[Spanned<String>], diagnostics: &mut Vec<Diagnostic>) -> LayerSet {
    let layer = |name: &Spanned<String>| {
        let layer = Layer::from_name(&name.value);
        if layer.is_none() {
            let known = Layer::ALL.map(Layer::name).join(", ");
            let message = format!("no layer is called `{}`; known are {known}", name.value);
            diagnostics.push(Diagnostic::error("invalid-film", message, name.span));
        }
        layer
    };
    names.iter().filter_map(layer).collect()
}

/// The pixels to render, clipped to the whole image. A crop window takes precedence over pixel
/// bounds.
pub fn pixel_bounds(film: &FilmDesc) -> Bounds2i {
    let full = Bounds2i::new([0, 0], film.resolution);
    let bounds = match (film.pixel_bounds, film.crop_window) {
        (Some([x0, x1, y0, y1]), None) => Bounds2i::new([x0, y0], [x1, y1]),
        (_, Some([x0, x1, y0, y1])) => {
            let pixel = |x: f32, y: f32| {
                [x * film.resolution[0] as f32, y * film.resolution[1] as f32]
                    .map(|pixel| pixel.ceil() as i32)
            };
            Bounds2i::new(pixel(x0, y0), pixel(x1, y1))
        }
        (None, None) => full,
    };
    bounds.intersection(&full)
}

fn sensor(
    desc: &SceneDesc,
    color_space: &RgbColorSpace,
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<PixelSensor> {
    let (sensor, origin) = (&desc.film.sensor, &desc.film.origin);
    let exposure_time = desc.camera.shutter_close - desc.camera.shutter_open;
    let imaging_ratio = exposure_time * sensor.iso / 100.0;
    let count = diagnostics.len();
    let mut error =
        |span, message: String| diagnostics.push(Diagnostic::error("invalid-sensor", message, span));
    if !(exposure_time > 0.0 && exposure_time.is_finite()) {
        let span = desc.camera.origin.parameter("shutterclose");
        error(span, format!("the shutter is open for {exposure_time} seconds, so that the picture is black"));
    } else if !(imaging_ratio > 0.0 && imaging_ratio.is_finite()) {
        error(origin.parameter("iso"), format!("`iso` is a number above 0, not {}", sensor.iso));
    }
    let white = sensor.white_balance;
    if white != 0.0 && !WHITE_BALANCE.contains(&white) {
        let (low, high) = (WHITE_BALANCE.start(), WHITE_BALANCE.end());
        let message =
            format!("`whitebalance` is 0 or a temperature from {low} to {high} kelvin, not {white}");
        error(origin.parameter("whitebalance"), message);
    }
    if diagnostics.len() > count {
        return None;
    }
    let compiled =
        PixelSensor::new(&sensor.name, color_space, (white != 0.0).then_some(white), imaging_ratio);
    if compiled.is_none() {
        let message = format!("no sensor is called `{}`", sensor.name);
        diagnostics.push(Diagnostic::error("invalid-sensor", message, origin.parameter("sensor")));
    }
    compiled
}
