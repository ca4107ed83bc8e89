//! The tests of `lanes`.

#![allow(unsafe_code)]

mod functions;
mod numbers;
mod reals;
mod slices;
mod vectors;
mod wide;
