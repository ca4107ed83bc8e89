//! What the observer sees through.
