//! Algorithms that follow paths from the lights alone.

pub(crate) mod endless;
mod light_tracing;

pub use light_tracing::LightTracing;
