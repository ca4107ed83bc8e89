//! alhazen, a physically based renderer, as a library.
//!
//! The crates of the house under their names, and what joins them into a program: [`Overrides`]
//! change a scene before it is rendered, a [`Job`] takes it from description to picture,
//! [`write_picture`] puts that into a file, a [`RenderOrder`] saves it so that it can go on later
//! as a [`SavedRender`]. [`render_file`] does all of it but the last. [`compare`] renders one scene
//! by several algorithms and measures them.

pub use description;
pub use film;
pub use geometry;
pub use image;
pub use import;
pub use integrators;
pub use math;
pub use sampling;
pub use scattering;
pub use scene;
pub use spectrum;

mod clock;
pub mod compare;
mod film_file;
mod fingerprint;
mod header;
mod job;
mod names;
mod overrides;
mod picture;
mod settings;
mod sketch;
mod values;

pub use clock::system_clock;
pub use film_file::{RenderOrder, SavedRender, Shard};
pub use fingerprint::Fingerprint;
pub use header::Header;
pub use job::{CompiledJob, Job, RenderError, render_file};
pub use names::{INTEGRATORS, integrator_name, sampler_name};
pub use overrides::{OverrideError, Overrides};
pub use picture::write_picture;
pub use settings::{SETTINGS, Setting};
