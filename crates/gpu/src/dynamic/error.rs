//! What goes wrong where something is to move.

use std::fmt;

use scene::MoveError;

use crate::device::GpuError;

/// Why something does not move on the device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MovingError {
    /// What is beside it, as a plural or with an article.
    Refused(&'static str),
    /// It cannot be moved anywhere.
    Move(MoveError),
    /// The device failed.
    Gpu(GpuError),
}

impl fmt::Display for MovingError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Refused(what) => write!(f, "the engine for GPUs moves nothing beside {what}"),
            Self::Move(error) => error.fmt(f),
            Self::Gpu(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for MovingError {}

impl From<GpuError> for MovingError {
    fn from(error: GpuError) -> Self {
        Self::Gpu(error)
    }
}

impl From<MoveError> for MovingError {
    fn from(error: MoveError) -> Self {
        Self::Move(error)
    }
}
