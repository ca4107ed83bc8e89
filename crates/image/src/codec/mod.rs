//! File formats: bytes ↔ [`Image`].
//!
//! Each member of [`Format`] is known by its first bytes, then by the extension of its name (TGA
//! has no signature). Input is not trusted: the size in a header is checked against what
//! the file could possibly hold before memory is allocated, and a panic inside a third-party
//! decoder becomes [`ImageError::Invalid`].

mod bmp;
mod exr;
mod hdr;
mod info;
mod jpeg;
mod pfm;
mod png;
mod qoi;
mod raster;
mod tga;
mod tiff;
mod webp;

use std::{
    fs::{self, File, OpenOptions},
    io::{self, Cursor, Read, Seek, Write},
    panic::{AssertUnwindSafe, catch_unwind},
    path::{Path, PathBuf},
};

pub use info::{ImageInfo, LayerInfo, Sample, info};

use crate::{
    depth::SampleDepth, encoding::ColorEncoding, error::ImageError, image::Image, source::PixelSource,
};

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// OpenEXR: half or single floats, any channels, metadata.
    Exr,
    /// Portable Network Graphics: 8 or 16 bits.
    Png,
    /// JPEG: 8 bits, lossy.
    Jpeg,
    /// Radiance RGBE: colours that share an exponent.
    Hdr,
    /// Truevision TGA: 8 bits. The fourth byte of a pixel is opacity, even where the header has no
    /// bits of attributes: this is how the usual readers have it, for many writers leave them out.
    Tga,
    /// Portable float map: single floats, one or three channels.
    Pfm,
    /// Windows bitmap: 8 bits.
    Bmp,
    /// Quite OK Image: 8 bits.
    Qoi,
    /// WebP: 8 bits; read lossy or not, written lossless.
    Webp,
    /// Tagged Image File Format: 8 or 16 bits, or floats.
    Tiff,
}

impl Format {
    /// Every format.
    pub const ALL: [Self; 10] = [
        Self::Exr,
        Self::Png,
        Self::Jpeg,
        Self::Hdr,
        Self::Tga,
        Self::Pfm,
        Self::Bmp,
        Self::Qoi,
        Self::Webp,
        Self::Tiff,
    ];

    /// The extensions of its file names; the first is the usual one.
    pub fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Exr => &["exr"],
            Self::Png => &["png"],
            Self::Jpeg => &["jpg", "jpeg"],
            Self::Hdr => &["hdr", "pic", "rgbe"],
            Self::Tga => &["tga"],
            Self::Pfm => &["pfm"],
            Self::Bmp => &["bmp"],
            Self::Qoi => &["qoi"],
            Self::Webp => &["webp"],
            Self::Tiff => &["tif", "tiff"],
        }
    }

    /// Whether it holds codes for a display, in the encoding of sRGB, rather than linear values.
    pub fn is_for_display(self) -> bool {
        match self {
            Self::Png | Self::Jpeg | Self::Tga | Self::Bmp | Self::Qoi | Self::Webp => true,
            Self::Exr | Self::Hdr | Self::Pfm | Self::Tiff => false,
        }
    }

    /// The format of a name's extension, whatever its case.
    pub fn from_name(name: &str) -> Option<Self> {
        let extension = Path::new(name).extension()?.to_str()?.to_ascii_lowercase();
        Self::ALL.into_iter().find(|format| format.extensions().contains(&extension.as_str()))
    }

    /// The format of a file: by its content, else by its name.
    fn of(bytes: &[u8], name: &str) -> Result<Self, ImageError> {
        Self::from_content(bytes).or_else(|| Self::from_name(name)).ok_or_else(|| {
            ImageError::Unsupported("neither content nor extension is that of a known image format".into())
        })
    }

    /// The format that these first bytes are the signature of; never [`Format::Tga`], which has
    /// none.
    pub fn from_content(bytes: &[u8]) -> Option<Self> {
        match bytes {
            [0x76, 0x2f, 0x31, 0x01, ..] => Some(Self::Exr),
            [0x89, b'P', b'N', b'G', ..] => Some(Self::Png),
            [0xff, 0xd8, 0xff, ..] => Some(Self::Jpeg),
            [b'#', b'?', ..] => Some(Self::Hdr),
            [b'P', b'F' | b'f', space, ..] if space.is_ascii_whitespace() => Some(Self::Pfm),
            [b'B', b'M', ..] => Some(Self::Bmp),
            [b'q', b'o', b'i', b'f', ..] => Some(Self::Qoi),
            [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => Some(Self::Webp),
            [b'I', b'I', 42, 0, ..] | [b'M', b'M', 0, 42, ..] => Some(Self::Tiff),
            _ => None,
        }
    }
}

/// Options for reading.
#[derive(Clone, Debug)]
pub struct ReadOptions {
    /// The encoding of integer codes; `None` means sRGB. Floating-point files are always linear.
    pub encoding: Option<ColorEncoding>,
    /// The most bytes that a decoded image may take; 16 GiB by default.
    pub max_bytes: u64,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self { encoding: None, max_bytes: 16 << 30 }
    }
}

impl ReadOptions {
    fn encoding(&self) -> ColorEncoding {
        self.encoding.unwrap_or_default()
    }

    /// The most bytes that a decoded image may take, given the length of its file. No format here
    /// packs more than some thousand bytes into one, so a small file with a huge size in its
    /// header is damaged.
    fn byte_limit(&self, file_length: usize) -> u64 {
        const GREATEST_RATIO: u64 = 4096;
        const ALWAYS_ALLOWED: u64 = 64 << 20;
        self.max_bytes.min((file_length as u64).saturating_mul(GREATEST_RATIO).max(ALWAYS_ALLOWED))
    }

    /// Refuses `width` × `height` pixels of `pixel_bytes` where they exceed the limit.
    fn check_size(
        &self,
        width: usize,
        height: usize,
        pixel_bytes: usize,
        file_length: usize,
    ) -> Result<(), ImageError> {
        let needed = width as u128 * height as u128 * pixel_bytes as u128;
        let limit = self.byte_limit(file_length);
        if needed > u128::from(limit) {
            return Err(ImageError::Limits(format!(
                "{width} × {height} pixels need {needed} bytes; for a file of {file_length} bytes at most {limit} are allowed"
            )));
        }
        Ok(())
    }
}

/// Options for writing.
#[derive(Clone, Debug, Default)]
pub struct WriteOptions {
    /// How values are stored; a depth that the format does not have is refused.
    pub depth: SampleDepth,
}

impl WriteOptions {
    /// The depth in which a format of these depths is written, the first where any suits; refused
    /// where it lacks the one asked for.
    fn depth_among(&self, format: Format, depths: &[SampleDepth]) -> Result<SampleDepth, ImageError> {
        match self.depth {
            SampleDepth::Natural => Ok(depths[0]),
            depth if depths.contains(&depth) => Ok(depth),
            depth => {
                Err(ImageError::Unsupported(format!("{format:?} does not hold samples of depth {depth:?}")))
            }
        }
    }
}

/// A file, or bytes in memory, that a format is written to.
trait Output: Read + Write + Seek {}

impl<T: Read + Write + Seek> Output for T {}

/// Decodes the bytes of a file. `name` is used where the content does not determine the format, and
/// may be empty.
pub fn read(bytes: &[u8], name: &str, options: &ReadOptions) -> Result<Image, ImageError> {
    let format = Format::of(bytes, name)?;
    let decode = || match format {
        Format::Exr => exr::decode(bytes, options),
        Format::Png => png::decode(bytes, options),
        Format::Jpeg => jpeg::decode(bytes, options),
        Format::Hdr => hdr::decode(bytes, options),
        Format::Tga => tga::decode(bytes, options),
        Format::Pfm => pfm::decode(bytes, options),
        Format::Bmp => bmp::decode(bytes, options),
        Format::Qoi => qoi::decode(bytes, options),
        Format::Webp => webp::decode(bytes, options),
        Format::Tiff => tiff::Tiff::open(bytes)?.decode(options),
    };
    // The decoders of other crates may panic on damaged files, which must not end a render.
    catch_unwind(AssertUnwindSafe(decode))
        .unwrap_or_else(|_| Err(ImageError::Invalid(format!("damaged {format:?} data"))))
}

/// Reads a file; the format is found from its content, then its extension.
pub fn open(path: impl AsRef<Path>) -> Result<Image, ImageError> {
    let path = path.as_ref();
    read(&fs::read(path)?, &path.to_string_lossy(), &ReadOptions::default())
}

/// Encodes a picture as the bytes of a file. Integer formats hold sRGB codes of the colour clamped
/// to [0, 1].
pub fn encode(
    picture: &dyn PixelSource,
    format: Format,
    options: &WriteOptions,
) -> Result<Vec<u8>, ImageError> {
    let mut bytes = Cursor::new(Vec::new());
    encode_to(picture, format, options, &mut bytes)?;
    Ok(bytes.into_inner())
}

fn encode_to(
    picture: &dyn PixelSource,
    format: Format,
    options: &WriteOptions,
    output: &mut dyn Output,
) -> Result<(), ImageError> {
    match format {
        Format::Exr => exr::encode(picture, options, output),
        Format::Png => png::encode(picture, options, output),
        Format::Jpeg => jpeg::encode(picture, options, output),
        Format::Hdr => hdr::encode(picture, options, output),
        Format::Tga => tga::encode(picture, options, output),
        Format::Pfm => pfm::encode(picture, options, output),
        Format::Bmp => bmp::encode(picture, options, output),
        Format::Qoi => qoi::encode(picture, options, output),
        Format::Webp => webp::encode(picture, options, output),
        Format::Tiff => tiff::encode(picture, options, output),
    }
}

/// Writes a picture to a file in the format of its extension, by [`replace_file_with`].
pub fn write(
    picture: &dyn PixelSource,
    path: impl AsRef<Path>,
    options: &WriteOptions,
) -> Result<(), ImageError> {
    let path = path.as_ref();
    let Some(format) = Format::from_name(&path.to_string_lossy()) else {
        let known = Format::ALL.map(|format| format.extensions()[0]).join(", ");
        return Err(ImageError::Unsupported(format!(
            "cannot tell the format of {}; known are {known}",
            path.display()
        )));
    };
    if is_special(path) {
        // A pipe cannot be written in two directions.
        return Ok(replace_file(path, &encode(picture, format, options)?)?);
    }
    replace_file_with(path, |file| encode_to(picture, format, options, file))
}

/// Writes a file that appears whole or not at all; see [`replace_file_with`].
pub fn replace_file(path: &Path, bytes: &[u8]) -> io::Result<()> {
    replace_file_with(path, |file| file.write_all(bytes))
}

/// Writes a file that appears whole or not at all: it is written beside its final place and then
/// moved there. Symbolic links are followed: their target is replaced, and they stay. Anything but
/// a regular file, such as a pipe, is written in place. `write` is given the file without a buffer.
pub fn replace_file_with<E: From<io::Error>>(
    path: &Path,
    write: impl FnOnce(&mut File) -> Result<(), E>,
) -> Result<(), E> {
    let path = &link_target(path)?;
    if is_special(path) {
        return write(&mut OpenOptions::new().write(true).open(path)?);
    }
    let (mut file, temporary) = create_beside(path)?;
    let written = write(&mut file).and_then(|()| {
        file.sync_all()?;
        Ok(fs::rename(&temporary, path)?)
    });
    if written.is_err() {
        // The first error is reported, whether or not the leftover can be removed.
        let _ = fs::remove_file(&temporary);
    }
    written
}

/// Whether the path is something other than a file.
fn is_special(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|existing| !existing.is_file())
}

/// The file that a path leads to through symbolic links, whether it exists or not; the path itself
/// where it is no link. An error where links lead to each other in a circle.
pub fn link_target(path: &Path) -> io::Result<PathBuf> {
    /// As many links as Linux follows.
    const MAX_LINKS: usize = 40;
    let mut target = path.to_owned();
    for _ in 0..MAX_LINKS {
        let Ok(next) = fs::read_link(&target) else { return Ok(target) };
        // A relative link starts at the folder that it is in.
        target = target.parent().unwrap_or(Path::new("")).join(next);
    }
    Err(io::Error::other("too many symbolic links"))
}

/// Creates a new file in the folder of `path`, so that it can be renamed to it.
fn create_beside(path: &Path) -> io::Result<(File, PathBuf)> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let mut attempt = 0;
    loop {
        let temporary = path.with_file_name(format!(".{name}.{}-{attempt}.part", std::process::id()));
        match OpenOptions::new().read(true).write(true).create_new(true).open(&temporary) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => attempt += 1,
            result => return result.map(|file| (file, temporary)),
        }
    }
}
