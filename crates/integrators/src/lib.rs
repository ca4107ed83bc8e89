//! The algorithms of light transport and the session that runs them.
//!
//! An [`Integrator`] fills a film in passes; a [`Session`] runs the passes until a limit is reached
//! or it is cancelled. An algorithm that only estimates the radiance along a ray is a
//! [`RayIntegrator`], and [`PixelLoop`] turns it into an integrator. Some of them are also a
//! [`WaveIntegrator`], which a [`Wavefront`] does to many rays at once, in the lanes of vectors.
//! [`build`] builds the algorithm that a scene names.
//!
//! | algorithm | what it traces |
//! |---|---|
//! | [`RayCasting`] | camera rays, without shadow rays |
//! | [`Whitted`] | shadow rays, perfect mirrors and smooth glass |
//! | [`AmbientOcclusion`] | rays over the hemisphere of the first surface, for its visibility |
//! | [`RandomWalk`] | paths in uniform directions, without next-event estimation |
//! | [`SimplePath`] | paths by light sampling and BSDF sampling, each optional |
//! | [`Path`] | paths by both with multiple importance sampling, and Russian roulette; in media, too |
//! | [`LightTracing`] | paths from the lights, each vertex connected to the camera |
//! | [`Bdpt`] | paths from both ends, connected at all pairs of vertices |
//! | [`Mlt`] | Markov chains of paths, distributed in proportion to their contribution |
//! | [`PhotonMapping`] | photons from the lights, and camera rays that gather the nearest |
//! | [`Sppm`] | paths to the first diffuse surface, and the photons there |
//! | [`Vcm`] | paths from both ends, connected and merged |
//! | [`Radiosity`] | light between diffuse patches, the brightest shooting first |
//! | [`Function`] | nothing: it integrates a function of the sampler's points |
//!
//! Everywhere, L is the radiance that arrives at the camera along the ray, β (`beta`) the path
//! throughput, and the depth of a path the number of its scattering events: depth 0 is emission,
//! depth 1 adds direct light.

mod adaptive;
mod bidirectional;
mod build;
mod camera_paths;
mod control;
mod function;
mod integrator;
mod light_paths;
mod metropolis;
mod photons;
mod radiosity;
mod session;
mod transport;
mod wavefront;

pub use bidirectional::Bdpt;
pub use build::{Built, build, light_sampler, sampler, seed_of_integrator};
pub use camera_paths::{
    AmbientOcclusion, Path, PixelLoop, RandomWalk, RayCasting, RayIntegrator, SimplePath, Whitted,
};
pub use control::{Cancelled, Clock, Control, PassError};
pub use function::Function;
pub use integrator::{Integrator, OutputFile};
pub use light_paths::LightTracing;
pub use metropolis::Mlt;
pub use photons::{MAX_PHOTON_PATHS, PhotonMapping, Sppm, Vcm};
pub use radiosity::Radiosity;
pub use session::{Limits, Progress, Session, SessionState, Stop, noise};
pub use transport::{FirstHits, Record, Step, Tracer};
pub use wavefront::{WaveIntegrator, Wavefront};
