//! Buffers, and the views of them.

use std::cell::Cell;
use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use super::document::Document;
use super::json::{Fault, Place, Result};
use super::{meshopt, uri};
use crate::log::Log;
use assets::AssetSource;

/// The bytes of a file, and what may be made of them.
pub(super) struct Buffers {
    views: Vec<Option<View>>,
    /// Bytes that may still be decoded.
    budget: Cell<u64>,
}

/// A part of a buffer.
pub(super) struct View {
    bytes: Arc<[u8]>,
    offset: usize,
    length: usize,
    /// Bytes from one element to the next, if they are not beside each other.
    pub stride: Option<usize>,
}

impl View {
    pub fn bytes(&self) -> &[u8] {
        &self.bytes[self.offset..self.offset + self.length]
    }
}

/// The least budget, and bytes of it for each byte of the buffers. A text may refer to the same
/// bytes any number of times.
const ALWAYS_ALLOWED: u64 = 64 << 20;
const GREATEST_RATIO: u64 = 64;

impl Buffers {
    /// Reads all buffers of a text. What cannot be read is reported.
    pub fn read(
        document: &Document,
        binary: Option<Vec<u8>>,
        path: &Path,
        assets: &dyn AssetSource,
        log: &mut Log,
    ) -> Self {
        let mut binary = binary.map(Arc::from);
        let mut known = HashMap::new();
        let mut buffers = Vec::new();
        for (index, place) in
            (0..document.count("buffers")).map(|index| (index, document.item("buffers", index)))
        {
            let bytes = place.map(|place| {
                let binary = if index == 0 { binary.take() } else { None };
                buffer(&place, binary, path, assets, &mut known)
            });
            buffers.push(bytes.and_then(|bytes| log.keep(bytes)).flatten());
        }
        let total: u64 =
            known.values().chain(buffers.iter().flatten()).map(|bytes: &Arc<[u8]>| bytes.len() as u64).sum();
        let budget = Cell::new((total * GREATEST_RATIO).max(ALWAYS_ALLOWED));
        let mut views = Vec::new();
        for index in 0..document.count("bufferViews") {
            let view = document.item("bufferViews", index).map(|place| view(&place, &buffers, &budget));
            views.push(view.and_then(|view| log.keep(view)).flatten());
        }
        Self { views, budget }
    }

    /// The view that a member of an object refers to; `None` if it is absent.
    pub fn view(&self, place: &Place, key: &str) -> Result<Option<&View>> {
        let Some(index) = place.index(key, self.views.len(), "bufferViews")? else { return Ok(None) };
        match &self.views[index] {
            Some(view) => Ok(Some(view)),
            None => Err(place.invalid_member(key, format!("the buffer view {index} cannot be read"))),
        }
    }

    /// How many bytes may still be decoded.
    #[cfg(feature = "draco")]
    pub fn left(&self) -> u64 {
        self.budget.get()
    }

    /// Takes bytes that are about to be decoded from the budget.
    pub fn spend(&self, place: &Place, bytes: u64) -> Result<()> {
        spend(&self.budget, place, bytes)
    }
}

fn spend(budget: &Cell<u64>, place: &Place, bytes: u64) -> Result<()> {
    match budget.get().checked_sub(bytes) {
        Some(left) => {
            budget.set(left);
            Ok(())
        }
        None => {
            let message = "the file describes more data than its length suggests";
            Err(Fault::new("too-large", &place.pointer, message))
        }
    }
}

/// The bytes of a buffer; `None` for one that has none, which only compressed views may refer to.
fn buffer(
    place: &Place,
    binary: Option<Arc<[u8]>>,
    path: &Path,
    assets: &dyn AssetSource,
    known: &mut HashMap<String, Arc<[u8]>>,
) -> Result<Option<Arc<[u8]>>> {
    let length = place.integer("byteLength")?.ok_or_else(|| place.invalid("`byteLength` is missing"))?;
    if length == 0 {
        return Err(place.invalid_member("byteLength", "a buffer has at least one byte"));
    }
    let bytes = match (place.string("uri")?, binary) {
        (Some(uri), _) => {
            if let Some(bytes) = known.get(uri) {
                bytes.clone()
            } else {
                let read = uri::read(uri, path, assets);
                let read =
                    read.map_err(|message| Fault::new("unreadable-file", place.pointer_to("uri"), message))?;
                let bytes: Arc<[u8]> = read.into();
                known.insert(uri.to_owned(), bytes.clone());
                bytes
            }
        }
        (None, Some(binary)) => binary,
        (None, None) => return Ok(None),
    };
    if bytes.len() < length {
        return Err(
            place.invalid_member("byteLength", format!("there are only {} bytes, not {length}", bytes.len()))
        );
    }
    Ok(Some(bytes))
}

fn view(place: &Place, buffers: &[Option<Arc<[u8]>>], budget: &Cell<u64>) -> Result<Option<View>> {
    let (index, offset, length) = range(place, buffers.len())?;
    let stride = place.integer("byteStride")?;
    let compressed =
        [place.extension("EXT_meshopt_compression")?, place.extension("KHR_meshopt_compression")?];
    if let Some(compressed) = compressed.into_iter().flatten().next() {
        let (index, offset, length) = range(&compressed, buffers.len())?;
        let Some(bytes) = &buffers[index] else { return Ok(None) };
        let bytes = part(&compressed, bytes, offset, length)?;
        let layout = meshopt::Layout::parse(&compressed)?;
        spend(budget, &compressed, layout.byte_length())?;
        let bytes: Arc<[u8]> = layout
            .decode(bytes)
            .map_err(|message| Fault::new("invalid-gltf", &compressed.pointer, message))?
            .into();
        let length = bytes.len();
        return Ok(Some(View { bytes, offset: 0, length, stride }));
    }
    if let Some(stride) = stride.filter(|stride| !(4..=252).contains(stride) || stride % 4 != 0) {
        let message = format!("a stride is a multiple of 4 between 4 and 252, not {stride}");
        return Err(place.invalid_member("byteStride", message));
    }
    if length == 0 || stride.is_some_and(|stride| stride > length) {
        return Err(place.invalid_member("byteLength", "a view is at least as long as one of its elements"));
    }
    let Some(bytes) = &buffers[index] else {
        return Err(place.invalid_member("buffer", "this buffer has no data"));
    };
    part(place, bytes, offset, length)?;
    Ok(Some(View { bytes: bytes.clone(), offset, length, stride }))
}

/// The buffer of a view, and its offset and length there.
fn range(place: &Place, buffers: usize) -> Result<(usize, usize, usize)> {
    let index =
        place.index("buffer", buffers, "buffers")?.ok_or_else(|| place.invalid("`buffer` is missing"))?;
    let length = place.integer("byteLength")?.ok_or_else(|| place.invalid("`byteLength` is missing"))?;
    Ok((index, place.integer("byteOffset")?.unwrap_or(0), length))
}

fn part<'a>(place: &Place, bytes: &'a [u8], offset: usize, length: usize) -> Result<&'a [u8]> {
    bytes.get(offset..offset.saturating_add(length)).ok_or_else(|| {
        let message = format!(
            "bytes {offset} to {} reach beyond the buffer, which has {}",
            offset.saturating_add(length),
            bytes.len()
        );
        place.invalid(message)
    })
}
