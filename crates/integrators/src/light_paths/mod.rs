//! Algorithms that trace paths from the lights only.

mod light_tracing;
pub(crate) mod unbounded;

pub use light_tracing::LightTracing;
