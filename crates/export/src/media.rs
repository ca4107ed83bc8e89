//! Participating media.

use description::{
    CoefficientsDesc, GridDesc, MediumDesc, MediumKind, SceneDesc, TemperatureDesc, TransformDesc,
};
use math::{DMat4, Point3, Vec3};

use crate::files::Files;
use crate::names::Names;
use crate::statement::Statement;
use crate::text::Text;

/// All media.
pub(crate) fn media(desc: &SceneDesc, names: &Names, files: &mut Files, text: &mut Text) {
    for (handle, medium) in desc.media.iter() {
        let MediumDesc { name: _, kind, world_from_medium, g } = &medium.value;
        let mut statement =
            Statement::named("MakeNamedMedium", names.medium(handle), kind.name()).target("medium");
        statement.float("g", *g, 0.0);
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
        MediumKind::Homogeneous { coefficients: matter, le, le_scale } => {
            coefficients(to, matter);
            if let Some(le) = le {
                to.spectrum("Le", le);
            }
            to.float("Lescale", *le_scale, 1.0);
        }
        MediumKind::UniformGrid {
            bounds,
            coefficients: matter,
            density,
            temperature,
            temperature_scale: conversion,
            le,
            le_scale,
            emission_scale,
        } => {
            corners(to, bounds);
            coefficients(to, matter);
            resolution(to, density.resolution);
            grid(to, "density", Some(density), density.resolution);
            grid(to, "temperature", temperature.as_ref(), density.resolution);
            temperature_scale(to, conversion);
            if let Some(le) = le {
                to.spectrum("Le", le);
            }
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
        MediumKind::RgbGrid { bounds, sigma_a, sigma_s, scale, le, le_scale, space } => {
            corners(to, bounds);
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
            to.float("scale", *scale, 1.0);
            to.float("Lescale", *le_scale, 1.0);
        }
        MediumKind::Cloud { bounds, coefficients: matter, density, wispiness, frequency } => {
            corners(to, bounds);
            coefficients(to, matter);
            to.float("density", *density, 1.0);
            to.float("wispiness", *wispiness, 1.0);
            to.float("frequency", *frequency, 5.0);
        }
        MediumKind::NanoVdb {
            density,
            temperature,
            coefficients: matter,
            temperature_scale: conversion,
            le_scale,
        } => {
            to.text("filename", &files.volume(density, temperature.as_ref()));
            coefficients(to, matter);
            temperature_scale(to, conversion);
            to.float("Lescale", *le_scale, 1.0);
        }
    }
}

fn coefficients(to: &mut Statement, coefficients: &CoefficientsDesc) {
    match coefficients {
        CoefficientsDesc::Preset { name, scale } => {
            to.text("preset", name);
            to.float("scale", *scale, 1.0);
        }
        CoefficientsDesc::Given { sigma_a, sigma_s, scale } => {
            to.spectrum_or("sigma_a", sigma_a, 1.0);
            to.spectrum_or("sigma_s", sigma_s, 1.0);
            to.float("scale", *scale, 1.0);
        }
    }
}

fn corners(to: &mut Statement, [low, high]: &[Point3; 2]) {
    to.triple("point3", "p0", *low, Vec3::ZERO);
    to.triple("point3", "p1", *high, Vec3::ONE);
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

fn temperature_scale(to: &mut Statement, conversion: &TemperatureDesc) {
    let TemperatureDesc { offset, scale } = conversion;
    to.float("temperatureoffset", *offset, 0.0);
    to.float("temperaturescale", *scale, 1.0);
}
