//! The algorithms of light transport and the one driver that runs them.
//!
//! An [`Integrator`] fills a film in passes; a [`Session`] runs the passes until a limit is reached
//! or it is cancelled. An algorithm that only has to answer how much light comes along one ray is a
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

mod bidirectional;
mod build;
mod camera_paths;
mod control;
mod integrator;
mod light_paths;
mod metropolis;
mod photons;
mod radiosity;
mod session;
mod transport;

pub use bidirectional::Bdpt;
pub use build::{Built, build};
pub use camera_paths::{
    AmbientOcclusion, Path, PixelLoop, RandomWalk, RayCasting, RayIntegrator, SimplePath, Whitted,
};
pub use control::{Cancelled, Clock, Control, PassError};
pub use integrator::{Integrator, OutputFile};
pub use light_paths::LightTracing;
pub use metropolis::Mlt;
pub use photons::{MAX_PHOTON_PATHS, PhotonMapping, Sppm, Vcm};
pub use radiosity::Radiosity;
pub use session::{Limits, Progress, Session, SessionState, Stop};
pub use transport::Tracer;
