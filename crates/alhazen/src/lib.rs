//! alhazen, a physically based renderer, as a library.
//!
//! Re-exports the other crates, and joins them into a renderer: [`Overrides`] change a scene before
//! it is rendered, a [`Job`] renders a description to a picture, [`write_picture`] writes that to a
//! file. A [`RenderOrder`] saves a render, so that it can be continued as a [`SavedRender`].
//! [`render_file`] does all but the last. A [`trace::PixelTrace`] shows what happens along the
//! paths of a pixel.

pub use assets;
pub use description;
pub use film;
pub use geometry;
pub use image;
pub use import;
pub use integrators;
pub use lanes;
pub use math;
pub use pbrt;
pub use sampling;
pub use scattering;
pub use scene;
pub use spectrum;

mod arrangement;
mod clock;
mod coarse;
#[cfg(feature = "gpu")]
pub mod device;
mod film_file;
mod fingerprint;
mod header;
mod job;
mod overrides;
mod pack;
mod picture;
#[cfg(feature = "gpu")]
pub mod realtime;
mod schedule;
mod settings;
mod sketch;
mod threads;
pub mod trace;

pub use clock::system_clock;
pub use film_file::{RenderOrder, SavedRender, Shard};
pub use fingerprint::Fingerprint;
pub use header::Header;
pub use job::{CompiledJob, Job, RenderError, render_file};
pub use overrides::{OverrideError, Overrides};
pub use pack::{ConvertError, PackError, Packed, pack, pack_converted};
pub use picture::{InSrgb, data_uri, write_picture};
pub use schedule::PreviewSchedule;
pub use settings::{Group, PARTS, Part, integrator_names};
pub use sketch::draft;
pub use threads::{available_threads, most_threads};
