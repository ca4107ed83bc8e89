//! Participating media.

use std::sync::Arc;

use super::Builder;
use super::material::substance;
use super::reader::Reader;
use super::volume::GridName;
use crate::read::statement::MediumStatement;
use description::{
    CoefficientsDesc, GridDesc, MediumDesc, MediumInterface, MediumKind, MediumType, Spanned, Stated,
    TemperatureDesc, VoxelsDesc,
};

impl Builder<'_> {
    /// Builds a medium; one that cannot be read is replaced by a homogeneous one.
    pub(super) fn medium(&mut self, medium: MediumStatement) -> Stated<MediumDesc> {
        let mut stated = self.read_or_default(medium.statement, read_medium);
        stated.name = medium.name.value;
        stated.world_from_medium = medium.world_from_medium;
        stated
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

fn read_medium(reader: &mut Reader) -> Option<MediumDesc> {
    let Some(kind) = MediumType::named(&reader.kind.value).and_then(MediumKind::new) else {
        reader.unknown_type("medium", "medium", MediumType::NAMES);
        return None;
    };
    let mut medium = MediumDesc { kind, ..MediumDesc::default() };
    reader.settings(&mut medium);
    match &mut medium.kind {
        MediumKind::Homogeneous { coefficients, .. } | MediumKind::Cloud { coefficients, .. } => {
            check_preset(reader, coefficients);
        }
        MediumKind::UniformGrid {
            coefficients,
            density,
            temperature,
            temperature_scale,
            le,
            le_scale,
            emission_scale,
            ..
        } => {
            check_preset(reader, coefficients);
            cutoff(reader, temperature_scale);
            let resolution = resolution(reader);
            let [given, hot] = ["density", "temperature"].map(|name| {
                let values = reader.floats(name);
                grid(reader, name, resolution, values)
            });
            *temperature = hot;
            // One value is a factor, several are a grid of factors.
            match reader.floats("Lescale") {
                Some(values) if values.len() == 1 => *emission_scale = values[0],
                values => *le_scale = grid(reader, "Lescale", resolution, values),
            }
            if given.is_none() && !reader.has("density") {
                reader.missing("density");
            }
            *density = given?;
            if le.is_some() && temperature.is_some() {
                reader.refuse("Le", "a medium emits by `Le` or by `temperature`, not by both");
            }
        }
        MediumKind::RgbGrid { sigma_a, sigma_s, le, space, .. } => {
            let resolution = resolution(reader);
            [*sigma_a, *sigma_s, *le] = ["sigma_a", "sigma_s", "Le"].map(|name| {
                let values = reader.rgbs(name);
                grid(reader, name, resolution, values)
            });
            *space = reader.color_space;
            if !reader.has("sigma_a") && !reader.has("sigma_s") {
                reader.missing("sigma_a` or `sigma_s");
                return None;
            }
            if le.is_some() && sigma_a.is_none() {
                reader.refuse("Le", "a medium that emits by `Le` needs `sigma_a`");
            }
        }
        MediumKind::NanoVdb { density, temperature, coefficients, temperature_scale, .. } => {
            check_preset(reader, coefficients);
            cutoff(reader, temperature_scale);
            let [given, hot] = voxels(reader)?;
            (*density, *temperature) = (given?, hot);
        }
    }
    Some(medium)
}

/// Checks that a substance exists, and that nothing else is given; one that does not is replaced by
/// the default.
fn check_preset(reader: &mut Reader, coefficients: &mut CoefficientsDesc) {
    let CoefficientsDesc::Preset { name, .. } = &*coefficients else { return };
    if substance(reader, Spanned::new(name.clone(), reader.place("preset"))).is_none() {
        *coefficients = CoefficientsDesc::default();
    } else if reader.has("sigma_a") || reader.has("sigma_s") {
        reader.ignored("preset", "`sigma_a` and `sigma_s` have no effect beside `preset`");
    }
}

/// The old name of the offset.
fn cutoff(reader: &mut Reader, temperature: &mut TemperatureDesc) {
    let cutoff = reader.float("temperaturecutoff", 0.0);
    if !reader.has("temperatureoffset") {
        temperature.offset = cutoff;
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

/// The grids of densities and of temperatures of a file.
fn voxels(reader: &mut Reader) -> Option<[Option<VoxelsDesc>; 2]> {
    let file = reader.needed("filename", Reader::string)?;
    let [density, temperature] = ["gridname", "temperaturename"].map(|name| reader.string(name));
    let grid = |name: Option<Spanned<String>>, default: &str, is_needed| GridName {
        name: name.unwrap_or(Spanned { value: default.into(), span: file.span }),
        is_needed,
    };
    let needs_temperature = temperature.is_some();
    let names = [grid(density, "density", true), grid(temperature, "temperature", needs_temperature)];
    reader.builder.grids(&file, &names)
}
