//! Participating media.

use description::{GridDesc, MediumDesc, MediumKind, SceneDesc, TransformDesc};
use math::DMat4;

use crate::write::files::Files;
use crate::write::names::Names;
use crate::write::settings::parameters;
use crate::write::statement::Statement;
use crate::write::text::Text;

/// All media.
pub(crate) fn media(desc: &SceneDesc, names: &Names, files: &mut Files, text: &mut Text) {
    for (handle, medium) in desc.media.iter() {
        let MediumDesc { name: _, kind, world_from_medium, g: _ } = &medium.value;
        let mut statement =
            Statement::named("MakeNamedMedium", names.medium(handle), kind.name()).target("medium");
        parameters(&mut statement, &medium.value, names);
        write(&mut statement, kind, files);
        let TransformDesc { start, end, times: _ } = world_from_medium;
        text.block([start, end] != [&DMat4::IDENTITY; 2], |text| {
            text.transform(world_from_medium);
            text.statement(statement);
        });
    }
}

fn write(to: &mut Statement, kind: &MediumKind, files: &mut Files) {
    match kind {
        MediumKind::Homogeneous { .. } | MediumKind::Cloud { .. } => (),
        MediumKind::UniformGrid { density, temperature, le_scale, emission_scale, .. } => {
            resolution(to, density.resolution);
            grid(to, "density", Some(density), density.resolution);
            grid(to, "temperature", temperature.as_ref(), density.resolution);
            // One number is a factor, several are a grid of factors.
            match le_scale {
                Some(factors) => {
                    let values = factors.values.iter().map(|factor| factor * emission_scale).collect();
                    let factors = GridDesc { resolution: factors.resolution, values };
                    grid(to, "Lescale", Some(&factors), density.resolution);
                }
                None => to.float("Lescale", *emission_scale, 1.0),
            }
        }
        MediumKind::RgbGrid { sigma_a, sigma_s, le, space, .. } => {
            let grids = [("sigma_a", sigma_a), ("sigma_s", sigma_s), ("Le", le)];
            let mut given = grids.iter().filter_map(|(_, grid)| grid.as_ref());
            let size = given.next().map_or([1; 3], |grid| grid.resolution);
            resolution(to, size);
            for (name, grid) in grids {
                let Some(grid) = grid else { continue };
                if grid.resolution != size {
                    to.fail("its grids have different numbers of cells");
                }
                to.colors(name, &grid.values, *space);
            }
        }
        MediumKind::NanoVdb { density, temperature, .. } => {
            to.text("filename", &files.volume(density, temperature.as_ref()));
        }
    }
}

fn resolution(to: &mut Statement, resolution: [i32; 3]) {
    for (name, count) in ["nx", "ny", "nz"].into_iter().zip(resolution) {
        to.integer(name, count, 1);
    }
}

fn grid(to: &mut Statement, name: &str, grid: Option<&GridDesc<f32>>, resolution: [i32; 3]) {
    let Some(grid) = grid else { return };
    if grid.resolution != resolution {
        to.fail("its grids have different numbers of cells");
    }
    to.floats(name, grid.values.iter().copied());
}
