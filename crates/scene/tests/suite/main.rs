//! Compiled scenes: lights, materials, motion and views.

mod all_lights;
mod bump_maps;
mod common;
mod compile;
mod emission;
mod instances;
mod light_choice_lanes;
mod light_samplers;
mod light_table;
mod light_totals;
mod materials;
mod media;
mod motion;
mod single_sided;
mod solids;
mod spheres;
mod views;
