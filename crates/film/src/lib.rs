//! Radiance samples to pixels: filters, sensors and exact accumulation.
//!
//! [`compile`] makes a [`Film`] of a scene's description. An integrator draws positions from its
//! [`Filter`], traces rays, and adds a [`Sample`] to the film, or, from many threads, to the tiles
//! of [`Film::tiles_mut`]; light that arrives anywhere goes to a [`Splatter`]. Beside the colours a
//! film may have [`Layer`]s (AOVs). [`Film::develop`] gives the picture at any time, and
//! [`Film::development`] writes colours and layers row by row. A [`FilmFile`] keeps films for
//! later, or for merging with others.
//!
//! Film coordinates have x to the right, y down, pixel (0, 0) at the top left; the centre of pixel
//! (x, y) is at (x + ½, y + ½).

mod buckets;
mod compile;
mod cryptomatte;
mod develop;
mod exposure;
mod file;
mod film;
pub mod filter;
mod grid;
mod layer;
mod parts;
mod passes;
mod rejected;
mod sample;
mod sensor;
mod splats;
mod sum;
mod tile;

pub use buckets::Buckets;
pub use compile::{Compiled, compile, pixel_bounds};
pub use cryptomatte::id_of_name;
pub use develop::Development;
pub use file::{FilmFile, FilmFileError, FilmHeader, FilmWriter, ReadLimits, State};
pub use film::{Film, FilmSettings, PIXEL_BYTES};
pub use filter::{Filter, FilterSample};
pub use grid::TILE_SIZE;
pub use layer::{FirstHit, Layer, LayerSet, Quantity};
pub use parts::{FirstEvent, Parts};
pub use passes::PassSet;
pub use rejected::{MAX_REJECTED_PIXELS, Rejected};
pub use sample::Sample;
pub use sensor::PixelSensor;
pub use splats::{SPLAT_BYTES, Splatter};
pub use tile::FilmTile;
