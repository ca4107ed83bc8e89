//! Shapes, trees and rays against closed forms and against each other.

mod all_shapes;
mod build;
mod common;
mod curves;
mod extents;
mod facets;
mod filters;
mod flat_shapes;
mod implicit;
mod instances;
mod instruction_sets;
mod motion;
mod points;
mod sizes;
mod solids;
mod sphere_sets;
mod tessellation;
mod tree;
mod watertight;
