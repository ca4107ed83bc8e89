//! Files that statements name: images, spectra, lens tables.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use description::{Arena, Diagnostic, EncodingDesc, Handle, ImageDesc, Origin, Span, Spanned, Stated};
use rayon::prelude::*;
use scattering::MeasuredTable;

use super::{Builder, Samples};
use assets::read_unpacked;

use crate::read::search::find;
use assets::number;

/// The images of the scene, each path and encoding once. They are decoded together, in parallel.
#[derive(Default)]
pub(super) struct ImageRequests {
    requests: Vec<(PathBuf, Option<EncodingDesc>, Span)>,
    handles: HashMap<(PathBuf, String), Handle<ImageDesc>>,
}

impl Builder<'_> {
    /// The path of a file that a scene file names.
    pub(crate) fn path(&self, name: &Spanned<String>) -> PathBuf {
        let naming_file = self.sources.name(name.span.file);
        let first_file = self.sources.name(description::FileId(0));
        find(self.assets, &name.value, naming_file, first_file)
    }

    /// An image file, to be decoded later.
    pub(crate) fn image(
        &mut self,
        file: &Spanned<String>,
        encoding: Option<EncodingDesc>,
    ) -> Handle<ImageDesc> {
        let path = self.path(file);
        let key = (path, format!("{encoding:?}"));
        if let Some(&handle) = self.images.handles.get(&key) {
            return handle;
        }
        let handle = Handle::new(self.images.requests.len() as u32);
        self.images.requests.push((key.0.clone(), encoding, file.span));
        self.images.handles.insert(key, handle);
        handle
    }

    /// Decodes all images of the scene. One that cannot be decoded is reported and replaced by one
    /// black pixel.
    pub(super) fn decode_images(&mut self) -> Arena<ImageDesc> {
        let requests = std::mem::take(&mut self.images.requests);
        let decoded: Vec<_> = requests
            .par_iter()
            .map(|(path, encoding, _)| assets::decode_image(self.assets, path, *encoding))
            .collect();
        let mut images = Arena::default();
        for ((path, _, span), decoded) in requests.into_iter().zip(decoded) {
            let name = path.to_string_lossy().into_owned();
            let image = decoded.unwrap_or_else(|message| {
                self.report.error(
                    "unreadable-image",
                    format!("cannot read the image `{name}`: {message}"),
                    span,
                );
                assets::black_pixel()
            });
            images.push_stated(Stated::new(ImageDesc { name, image: Arc::new(image) }, Origin::new(span)));
        }
        images
    }

    /// The numbers of a text file in which `#` begins comments.
    fn number_file(&mut self, path: &Path, code: &'static str, span: Span) -> Option<Vec<f32>> {
        let text = match read_unpacked(self.assets, path) {
            Ok(text) => text,
            Err(error) => {
                self.report.error(code, format!("cannot read `{}`: {error}", path.display()), span);
                return None;
            }
        };
        let mut numbers = Vec::new();
        for (index, line) in text.split(|&byte| byte == b'\n').enumerate() {
            let line = line.split(|&byte| byte == b'#').next().unwrap_or(&[]);
            let words = line
                .split(|byte| byte.is_ascii_whitespace() || *byte == b',')
                .filter(|word| !word.is_empty());
            for word in words {
                let Some(value) = number::float(word).filter(|value| value.is_finite()) else {
                    let word = String::from_utf8_lossy(word);
                    let message = format!(
                        "line {} of `{}` has `{word:.40}`, which is not a number",
                        index + 1,
                        path.display()
                    );
                    self.report.error(code, message, span);
                    return None;
                };
                numbers.push(value);
            }
        }
        Some(numbers)
    }

    /// A file of pairs of wavelength and value.
    pub(super) fn spectrum_file(&mut self, path: &Path, span: Span) -> Option<Samples> {
        let numbers = self.number_file(path, "unreadable-spectrum", span)?;
        let (pairs, rest) = numbers.as_chunks::<2>();
        let increasing = pairs.windows(2).all(|pair| pair[0][0] < pair[1][0]);
        if pairs.is_empty() || !rest.is_empty() || !increasing {
            let message =
                format!("`{}` does not hold pairs of increasing wavelength and value", path.display());
            self.report.error("unreadable-spectrum", message, span);
            return None;
        }
        Some(pairs.iter().map(|&[lambda, value]| (lambda, value)).collect())
    }

    /// A file of a measured surface, which is read once.
    pub(super) fn measured_file(&mut self, file: &Spanned<String>) -> Option<Arc<MeasuredTable>> {
        let path = self.path(file);
        if let Some(known) = self.measurements.get(&path) {
            return known.clone();
        }
        let bytes = self.assets.read(&path).map_err(|error| error.to_string());
        let table = match bytes.and_then(|bytes| assets::read_measured(&bytes)) {
            Ok(table) => Some(Arc::new(table)),
            Err(reason) => {
                let message = format!("cannot read the measurements `{}`: {reason}", path.display());
                self.report.error("unreadable-measurements", message, file.span);
                None
            }
        };
        self.measurements.insert(path, table.clone());
        table
    }

    /// A file with four numbers per lens element.
    pub(super) fn lens_file(&mut self, file: &Spanned<String>) -> Option<Vec<[f32; 4]>> {
        let path = self.path(file);
        let numbers = self.number_file(&path, "unreadable-lens", file.span)?;
        let (elements, rest) = numbers.as_chunks::<4>();
        if elements.is_empty() || !rest.is_empty() {
            let message = format!("`{}` does not hold four numbers per lens element", path.display());
            let diagnostic = Diagnostic::error("unreadable-lens", message, file.span);
            self.report.push(
                diagnostic.with_help("they are radius of curvature, thickness, index and aperture diameter"),
            );
            return None;
        }
        Some(elements.to_vec())
    }
}
