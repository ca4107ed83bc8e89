//! Comparisons of algorithms against direct computation.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod laboratory;
