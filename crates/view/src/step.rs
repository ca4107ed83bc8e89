//! A step of a renderer.

use std::time::Duration;

use alhazen::integrators::PassError;

/// The shortest time between two pictures of a camera at rest.
pub(crate) const SHORTEST: Duration = Duration::from_millis(40);

/// Why a step has no picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StepError {
    /// It was cancelled.
    Cancelled,
    /// It cannot be rendered; the text says why.
    Problem(String),
}

impl From<PassError> for StepError {
    fn from(error: PassError) -> Self {
        match error {
            PassError::Cancelled => Self::Cancelled,
            PassError::OutOfMemory(problem) | PassError::Device(problem) => Self::Problem(problem),
        }
    }
}

impl From<String> for StepError {
    fn from(problem: String) -> Self {
        Self::Problem(problem)
    }
}
