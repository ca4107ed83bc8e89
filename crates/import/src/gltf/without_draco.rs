//! Primitives packed by Draco where the program was built without the feature `draco`: refused.

use std::convert::Infallible;

use super::accessor::Accessor;
use super::buffer::Buffers;
use super::document::built_without;
use super::json::{Fault, Place, Result};

/// The vertices and triangles of one primitive, of which there are none.
pub(super) struct Packed<'a> {
    pub place: Place<'a>,
    never: Infallible,
}

impl<'a> Packed<'a> {
    /// Refuses packed data; `None` if a primitive has none.
    pub fn of(primitive: &Place<'a>, _: &Buffers) -> Result<Option<Self>> {
        const NAME: &str = "KHR_draco_mesh_compression";
        match primitive.extension(NAME)? {
            Some(place) => {
                let message = format!("the extension `{NAME}` {}", built_without("draco"));
                Err(Fault::new("unknown-extension", place.pointer, message))
            }
            None => Ok(None),
        }
    }

    pub fn counts(&self) -> [usize; 2] {
        match self.never {}
    }

    pub fn triangles(&self) -> Vec<[u32; 3]> {
        match self.never {}
    }

    pub fn attribute(&self, _: &str, _: &Accessor) -> Result<Option<Vec<u8>>> {
        match self.never {}
    }
}
