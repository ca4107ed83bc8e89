//! The contracts of warps and samplers.

mod all_samplers;
mod all_warps;
mod lanes;
