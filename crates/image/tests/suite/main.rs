//! Pictures: codecs, damaged files and comparison.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod common;
mod flip;
mod hostile;
mod info;
mod round_trips;
mod zoo;
