//! The algorithms of light transport and the one loop that runs them.
//!
//! An [`Integrator`] fills a film in passes; [`render`] runs the passes, tells of each and stops
//! when asked to. An algorithm that only has to answer how much light comes along one ray is a
//! [`RayIntegrator`], and [`PixelLoop`] makes an integrator of it. [`build`] chooses the algorithm
//! that a scene names.
//!
//! | algorithm | what it follows |
//! |---|---|
//! | [`RayCasting`] | the camera's ray; lights shine through everything |
//! | [`Whitted`] | shadow rays, perfect mirrors and smooth glass |
//! | [`AmbientOcclusion`] | how much of the sky each point sees |
//! | [`RandomWalk`] | paths in uniform directions that meet light by chance |
//! | [`SimplePath`] | paths by light sampling and BSDF sampling, each to be switched off |
//! | [`Path`] | paths by both, weighed against each other, with Russian roulette |
//! | [`LightTracing`] | paths from the lights, each vertex connected to the camera |
//! | [`Bdpt`] | paths from both ends, connected in all ways |
//! | [`Mlt`] | a walk through paths that lingers where they are bright |
//! | [`PhotonMapping`] | photons from the lights, and camera rays that pick up the nearest |
//! | [`Sppm`] | paths to the first diffuse surface, and the photons there |
//! | [`Vcm`] | paths from both ends, connected and merged |
//! | [`Radiosity`] | light between diffuse patches, from the brightest first |
//!
//! Everywhere, L is the radiance that arrives at the camera along the ray, β (`beta`) the share of
//! light at the end of a path that reaches the camera, and the depth of a path the number of its
//! scattering events: depth 0 shows lights alone, depth 1 adds direct light.

mod ambient_occlusion;
mod bdpt;
mod bidirectional;
mod build;
mod control;
mod direct;
mod endless;
mod glints;
mod integrator;
mod light_tracing;
mod merging;
mod mlt;
mod path;
mod photon;
mod photon_grid;
mod photon_map;
mod photon_mapping;
mod pixel_loop;
mod radiosity;
mod random_walk;
mod ray_casting;
mod render;
mod simple_path;
mod sppm;
mod vcm;
mod whitted;

pub use ambient_occlusion::AmbientOcclusion;
pub use bdpt::{Bdpt, BdptSettings};
pub use build::{Built, build};
pub use control::{Cancelled, Control, FilmSink, Progress, ProgressSink};
pub use integrator::{ByProduct, Integrator};
pub use light_tracing::LightTracing;
pub use mlt::{Mlt, MltSettings};
pub use path::{Path, PathSettings};
pub use photon_map::Kernel;
pub use photon_mapping::{PhotonMapping, PhotonMappingSettings};
pub use pixel_loop::{PixelLoop, RayIntegrator};
pub use radiosity::{FormFactors, Radiosity, RadiositySettings};
pub use random_walk::RandomWalk;
pub use ray_casting::RayCasting;
pub use render::{RenderReport, render};
pub use simple_path::SimplePath;
pub use sppm::{Sppm, SppmSettings};
pub use vcm::{Vcm, VcmSettings};
pub use whitted::Whitted;
