//! `--serve` where the program was built without the feature `serve`: refused.

use std::sync::Arc;

use super::feed::Feed;
use crate::failure::Failure;
use crate::interrupt::Interrupt;

/// A server of the picture of one render, of which there is none.
pub enum Server {}

impl Server {
    /// Refuses to start.
    pub fn start(_: &str, _: Option<&str>, _: &str, _: &Arc<Feed>, _: &Interrupt) -> Result<Self, Failure> {
        Err(Failure::Usage(
            "this program was built without the server of --serve, which the cargo feature `serve` adds"
                .into(),
        ))
    }

    pub fn url(&self) -> &str {
        match *self {}
    }

    pub fn is_save_asked(&self) -> bool {
        match *self {}
    }

    pub fn note_saved(&self, _: u32) {
        match *self {}
    }

    pub fn is_awaited(&self) -> bool {
        match *self {}
    }
}
