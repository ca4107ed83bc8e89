//! Decoded images.

use std::sync::Arc;

use image::Image;

/// A decoded image file.
#[derive(Clone, Debug)]
pub struct ImageDesc {
    /// The path it was read from, or any name for an image made by a program.
    pub name: String,
    /// The pixels.
    pub image: Arc<Image>,
}
