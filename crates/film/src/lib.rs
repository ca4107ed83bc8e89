//! Radiance samples to pixels: filters, sensors and exact accumulation.
//!
//! [`compile`] makes a [`Film`] of what a scene's author said. An integrator takes its [`Filter`]'s
//! samples, traces, and gives the light to [`Film::add_sample`], or, from many threads, to the
//! tiles of [`Film::tiles_mut`]; light that arrives anywhere goes to a [`Splatter`].
//! [`Film::develop`] gives the picture at any time. A [`FilmFile`] keeps films for later, or for
//! merging with others.
//!
//! Film coordinates have x to the right, y down, pixel (0, 0) at the top left; the centre of pixel
//! (x, y) is at (x + ½, y + ½).

mod compile;
mod file;
mod film;
pub mod filter;
mod passes;
mod sensor;
mod splats;
mod sum;

pub use compile::{Compiled, compile, pixel_bounds};
pub use file::{FilmFile, FilmFileError, FilmHeader, FilmWriter, ReadLimits, State};
pub use film::{Film, FilmSettings, FilmTile, MAX_REJECTED_PIXELS, Rejected, TILE_SIZE};
pub use filter::{Filter, FilterSample};
pub use passes::PassSet;
pub use sensor::PixelSensor;
pub use splats::{SPLAT_BYTES, Splatter};
pub use sum::ExactSum;
