//! Tests of planets.

mod motion;
