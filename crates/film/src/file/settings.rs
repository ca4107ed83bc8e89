//! A film's settings in a film file.

use description::GBufferSpace;
use math::Bounds2i;
use spectrum::{Matrix3, RgbColorSpace};

use super::FilmFileError;
use super::ReadLimits;
use super::section::{Fields, put_text};
use crate::{Buckets, Film, FilmSettings, Filter, Layer, LayerSet, PixelSensor};

/// The layers of every film's pixels: colour of samples, and splats.
const COLOR: &str = "color";
const SPLATS: &str = "splats";

/// Appends the settings of a film, and the names of its layers.
pub fn put(payload: &mut Vec<u8>, film: &Film) {
    let settings = film.settings();
    let Bounds2i { min, max } = settings.pixel_bounds;
    let corners = [settings.full_resolution, min, max];
    payload.extend(corners.into_iter().flatten().flat_map(i32::to_le_bytes));
    payload.extend(settings.diagonal.to_le_bytes());
    let (kind, parameters) = settings.filter.to_numbers();
    payload.push(kind);
    payload.extend(parameters.into_iter().flat_map(f32::to_le_bytes));
    put_text(payload, settings.sensor.name());
    let (scale, Matrix3(matrix)) = (settings.sensor.scale(), settings.sensor.xyz_from_sensor_rgb());
    payload.extend(scale.to_le_bytes());
    payload.extend(matrix.into_iter().flatten().flat_map(f64::to_le_bytes));
    payload.extend(settings.max_component_value.to_le_bytes());
    put_text(payload, settings.color_space.name());
    payload.push(settings.half_floats.into());
    payload.extend((settings.buckets.map_or(0, |buckets| buckets.count() as u32)).to_le_bytes());
    if let Some(buckets) = settings.buckets {
        payload.extend(buckets.range().into_iter().flat_map(f32::to_le_bytes));
    }
    payload.push(match settings.gbuffer {
        None => 0,
        Some(GBufferSpace::Camera) => 1,
        Some(GBufferSpace::World) => 2,
    });
    let color = (!film.counts.is_empty()).then_some(COLOR);
    let splats = (!film.splats.is_empty()).then_some(SPLATS);
    let layers: Vec<_> =
        color.into_iter().chain(settings.layers.iter().map(Layer::name)).chain(splats).collect();
    payload.push(layers.len() as u8);
    layers.iter().for_each(|name| put_text(payload, name));
    if settings.layers.has(Layer::LightGroups) {
        payload.extend((settings.light_groups.len() as u32).to_le_bytes());
        settings.light_groups.iter().for_each(|name| put_text(payload, name));
    }
}

/// Reads what [`put`] has written, and makes a film of it without light.
pub fn read(fields: &mut Fields, limits: &mut ReadLimits) -> Result<Film, FilmFileError> {
    let mut corner = || Ok::<_, FilmFileError>([fields.i32()?, fields.i32()?]);
    let (full_resolution, min, max) = (corner()?, corner()?, corner()?);
    // Invalid sizes would overflow below.
    let inside = |axis: usize| 0 <= min[axis] && min[axis] < max[axis] && max[axis] <= full_resolution[axis];
    if !(inside(0) && inside(1)) {
        return Err(fields.wrong(&format!("pixels {min:?} to {max:?} of {full_resolution:?}")));
    }
    let diagonal = fields.f32()?;
    let kind = fields.u8()?;
    let parameters = [fields.f32()?, fields.f32()?, fields.f32()?, fields.f32()?];
    let filter = Filter::from_numbers(kind, parameters).ok_or_else(|| fields.wrong("an unknown filter"))?;
    let sensor = fields.text()?;
    let scale = fields.f32()?;
    let mut matrix = [[0.0; 3]; 3];
    for value in matrix.iter_mut().flatten() {
        *value = fields.f64()?;
    }
    let sensor = PixelSensor::of_parts(sensor, scale, Matrix3(matrix))
        .ok_or_else(|| fields.wrong(&format!("an unknown sensor `{sensor}`")))?;
    let max_component_value = fields.array().map(f32::from_le_bytes)?;
    let color_space = fields.text()?;
    let color_space = RgbColorSpace::named(color_space)
        .ok_or_else(|| fields.wrong(&format!("an unknown colour space `{color_space}`")))?;
    let half_floats = fields.u8()? != 0;
    let buckets = match fields.u32()? {
        0 => None,
        count => {
            let (min, max) = (fields.f32()?, fields.f32()?);
            let wrong = || fields.wrong(&format!("{count} buckets from {min} to {max} nm"));
            Some(Buckets::new(count, min, max).ok_or_else(wrong)?)
        }
    };
    let gbuffer = match fields.u8()? {
        0 => None,
        1 => Some(GBufferSpace::Camera),
        2 => Some(GBufferSpace::World),
        space => return Err(fields.wrong(&format!("a geometry buffer in the space {space}"))),
    };
    let (mut color, mut splats, mut layers) = (false, false, LayerSet::NONE);
    for _ in 0..fields.u8()? {
        match fields.text()? {
            COLOR => color = true,
            SPLATS => splats = true,
            name => {
                let unknown = || fields.wrong(&format!("an unknown layer `{name}`"));
                layers = layers.with(Layer::from_name(name).ok_or_else(unknown)?);
            }
        }
    }
    let mut light_groups = Vec::new();
    if layers.has(Layer::LightGroups) {
        for _ in 0..fields.u32()? {
            light_groups.push(fields.text()?.to_owned());
        }
    }
    let settings = FilmSettings {
        full_resolution,
        pixel_bounds: Bounds2i { min, max },
        diagonal,
        filter,
        sensor,
        max_component_value,
        color_space,
        half_floats,
        layers,
        buckets,
        gbuffer,
        light_groups: light_groups.into(),
    };
    let pixels = settings.pixel_bounds.area() as u64;
    limits.take(pixels.saturating_mul(Film::pixel_bytes(&settings, color, splats)), "a film")?;
    let mut film = if color { Film::new(settings) } else { Film::of_splats(settings) }?;
    if splats {
        film.reserve_splats()?;
    }
    Ok(film)
}

/// Reads what [`put`] has written, and refuses settings that are not those of this film.
pub fn check(fields: &mut Fields, film: &Film) -> Result<(), FilmFileError> {
    let mut own = Vec::new();
    put(&mut own, film);
    if fields.bytes(own.len()).is_ok_and(|other| other == own) {
        return Ok(());
    }
    Err(FilmFileError::Mismatch("the settings of the films differ".into()))
}
