//! Pictures: codecs, damaged files and comparison.

mod common;
mod flip;
mod hostile;
mod info;
mod round_trips;
mod zoo;
