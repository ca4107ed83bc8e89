//! The tests of `lanes`.

#![allow(unsafe_code)]

mod numbers;
mod reals;
mod slices;
mod vectors;
