//! Participating media.

use std::sync::Arc;

use description::{
    CoefficientsDesc, GridDesc, MediumDesc, MediumInterface, MediumKind, MediumType, Spanned, Stated,
    TemperatureDesc,
};
use math::Vec3;

use super::Builder;
use super::material::substance;
use super::reader::Reader;
use super::volume::GridName;
use crate::pbrt::statement::MediumStatement;

impl Builder<'_> {
    /// Builds a medium; one that cannot be read is replaced by a homogeneous one.
    pub(super) fn medium(&mut self, medium: MediumStatement) -> Stated<MediumDesc> {
        let (read, origin) = self.read(medium.statement, |reader| {
            let g = reader.float("g", 0.0);
            Some((kind(reader)?, g))
        });
        let coefficients = CoefficientsDesc::default();
        let (kind, g) =
            read.unwrap_or((MediumKind::Homogeneous { coefficients, le: None, le_scale: 1.0 }, 0.0));
        let (name, world_from_medium) = (medium.name.value, medium.world_from_medium);
        Stated::new(MediumDesc { name, kind, world_from_medium, g }, origin)
    }

    /// The media on the two sides of a surface.
    pub(super) fn medium_interface(
        &mut self,
        names: Option<&[Spanned<String>; 2]>,
    ) -> Option<MediumInterface> {
        let [inside, outside] = names?;
        Some(MediumInterface { inside: self.named_medium(inside), outside: self.named_medium(outside) })
    }
}

fn kind(reader: &mut Reader) -> Option<MediumKind> {
    let Some(medium) = MediumType::named(&reader.kind.value) else {
        reader.unknown_type("medium", "medium", MediumType::NAMES);
        return None;
    };
    Some(match medium {
        MediumType::Homogeneous => MediumKind::Homogeneous {
            coefficients: coefficients(reader),
            le: reader.spectrum("Le"),
            le_scale: reader.float("Lescale", 1.0),
        },
        MediumType::UniformGrid => uniform_grid(reader)?,
        MediumType::RgbGrid => rgb_grid(reader)?,
        MediumType::Cloud => MediumKind::Cloud {
            bounds: bounds(reader),
            coefficients: coefficients(reader),
            density: reader.float("density", 1.0),
            wispiness: reader.float("wispiness", 1.0),
            frequency: reader.float("frequency", 5.0),
        },
        MediumType::NanoVdb => nano_vdb(reader)?,
    })
}

fn coefficients(reader: &mut Reader) -> CoefficientsDesc {
    let preset = reader.string("preset");
    let (sigma_a, sigma_s) = (reader.spectrum("sigma_a"), reader.spectrum("sigma_s"));
    let scale = reader.float("scale", 1.0);
    if let Some(preset) = preset
        && let Some(name) = substance(reader, preset)
    {
        if sigma_a.is_some() || sigma_s.is_some() {
            reader.ignored("preset", "`sigma_a` and `sigma_s` have no effect beside `preset`");
        }
        return CoefficientsDesc::Preset { name, scale };
    }
    CoefficientsDesc::Given {
        sigma_a: sigma_a.unwrap_or(1.0.into()),
        sigma_s: sigma_s.unwrap_or(1.0.into()),
        scale,
    }
}

fn bounds(reader: &mut Reader) -> [Vec3; 2] {
    [reader.point3("p0", Vec3::ZERO), reader.point3("p1", Vec3::ONE)]
}

fn temperature_scale(reader: &mut Reader) -> TemperatureDesc {
    let cutoff = reader.float("temperaturecutoff", 0.0);
    TemperatureDesc {
        offset: reader.float("temperatureoffset", cutoff),
        scale: reader.float("temperaturescale", 1.0),
    }
}

fn resolution(reader: &mut Reader) -> [i32; 3] {
    ["nx", "ny", "nz"].map(|name| reader.integer(name, 1, 1..=i32::MAX))
}

/// A grid of the given values, if their number is right.
fn grid<T>(
    reader: &mut Reader,
    name: &str,
    resolution: [i32; 3],
    values: Option<Arc<[T]>>,
) -> Option<GridDesc<T>> {
    let values = values?;
    let expected = resolution.map(|count| count as u128).into_iter().product::<u128>();
    if values.len() as u128 != expected {
        let message = format!("`{name}` has {} values, but nx · ny · nz is {expected}", values.len());
        reader.refuse(name, message);
        return None;
    }
    Some(GridDesc { resolution, values })
}

fn uniform_grid(reader: &mut Reader) -> Option<MediumKind> {
    let resolution = resolution(reader);
    let [density, temperature] = ["density", "temperature"].map(|name| {
        let values = reader.floats(name);
        grid(reader, name, resolution, values)
    });
    // One value is a factor, several are a grid of factors.
    let (mut emission_scale, mut le_scale) = (1.0, None);
    match reader.floats("Lescale") {
        Some(values) if values.len() == 1 => emission_scale = values[0],
        Some(values) => le_scale = grid(reader, "Lescale", resolution, Some(values)),
        None => (),
    }
    let kind = MediumKind::UniformGrid {
        bounds: bounds(reader),
        coefficients: coefficients(reader),
        temperature,
        temperature_scale: temperature_scale(reader),
        le: reader.spectrum("Le"),
        le_scale,
        emission_scale,
        density: match density {
            Some(density) => density,
            None => {
                if !reader.has("density") {
                    reader.missing("density");
                }
                return None;
            }
        },
    };
    if let MediumKind::UniformGrid { le: Some(_), temperature: Some(_), .. } = kind {
        reader.refuse("Le", "a medium emits by `Le` or by `temperature`, not by both");
    }
    Some(kind)
}

fn rgb_grid(reader: &mut Reader) -> Option<MediumKind> {
    let resolution = resolution(reader);
    let [sigma_a, sigma_s, le] = ["sigma_a", "sigma_s", "Le"].map(|name| {
        let values = reader.rgbs(name);
        grid(reader, name, resolution, values)
    });
    if !reader.has("sigma_a") && !reader.has("sigma_s") {
        reader.missing("sigma_a` or `sigma_s");
        return None;
    }
    if le.is_some() && sigma_a.is_none() {
        reader.refuse("Le", "a medium that emits by `Le` needs `sigma_a`");
    }
    Some(MediumKind::RgbGrid {
        bounds: bounds(reader),
        sigma_a,
        sigma_s,
        scale: reader.float("scale", 1.0),
        le,
        le_scale: reader.float("Lescale", 1.0),
        space: reader.color_space,
    })
}

fn nano_vdb(reader: &mut Reader) -> Option<MediumKind> {
    let Some(file) = reader.string("filename") else {
        reader.missing("filename");
        return None;
    };
    let [density, temperature] = ["gridname", "temperaturename"].map(|name| reader.string(name));
    let coefficients = coefficients(reader);
    let temperature_scale = temperature_scale(reader);
    let le_scale = reader.float("Lescale", 1.0);
    let grid = |name: Option<Spanned<String>>, default: &str, is_needed| GridName {
        name: name.unwrap_or(Spanned { value: default.into(), span: file.span }),
        is_needed,
    };
    let needs_temperature = temperature.is_some();
    let names = [grid(density, "density", true), grid(temperature, "temperature", needs_temperature)];
    let [density, temperature] = reader.builder.grids(&file, &names)?;
    Some(MediumKind::NanoVdb { density: density?, temperature, coefficients, temperature_scale, le_scale })
}
