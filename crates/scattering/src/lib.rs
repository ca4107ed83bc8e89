//! Scattering: BxDFs, Fresnel equations, microfacets, phase functions.
//!
//! A material at a point becomes a [`Bxdf`], by value; with the shading frame of the point it is a
//! [`Bsdf`], for directions in render space.
//!
//! Conventions, here and in every member: directions are unit vectors that point away from the
//! surface; in the local frame the shading normal is +z, so that `w.z` is a cosine and its sign the
//! side of the surface. `f` excludes the cosine of the incident direction. Densities are per solid
//! angle. `eta` is the index of refraction of the side below (z < 0) over that of the side above.
//! Random numbers lie in [0, 1): `uc` chooses among lobes, `u` a direction.

mod bsdf;
mod bssrdf;
mod bxdf;
mod flags;
mod fresnel;
mod grid;
mod interior;
mod microfacet;
mod phase;

pub use bsdf::Bsdf;
pub use bssrdf::{Bssrdf, BssrdfTable, PlainBssrdfTable, Probe, Profiles, SubsurfaceMethod};
pub use bxdf::{
    Body, BsdfSample, Bxdf, CoatedBase, Conductor, Dielectric, Diffuse, DiffuseTransmission, Hair, Layered,
    Measured, MeasuredData, MeasuredGrid, MeasuredTable, NormalizedFresnel, OpenPbr, OpenPbrParameters,
    OpenPbrTable, PlainOpenPbrTable, Scatter, Subsurface, SubsurfacePart, ThinDielectric, inner_reflectance,
};
pub use flags::{BxdfFlags, Directions, TransportMode};
pub use fresnel::{fr_complex, fr_conductor, fr_dielectric, reflect, refract};
pub use interior::Interior;
pub use microfacet::TrowbridgeReitz;
pub use phase::HenyeyGreenstein;
