//! Metadata of pictures.

use std::collections::BTreeMap;

use math::Mat4;

/// The CIE xy chromaticities of a colour space's primaries and white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chromaticities {
    /// The red primary.
    pub red: [f32; 2],
    /// The green primary.
    pub green: [f32; 2],
    /// The blue primary.
    pub blue: [f32; 2],
    /// The white point.
    pub white: [f32; 2],
}

/// A rectangle of pixels: x right, y down, `min` inside, `max` outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// The first column and row.
    pub min: [i32; 2],
    /// One past the last column and row.
    pub max: [i32; 2],
}

impl Window {
    /// The window of a whole image of this size.
    pub fn of_size(width: u32, height: u32) -> Self {
        Self { min: [0, 0], max: [width as i32, height as i32] }
    }

    /// Number of columns; 0 where `max` lies before `min`.
    pub fn width(&self) -> u32 {
        (i64::from(self.max[0]) - i64::from(self.min[0])).clamp(0, i64::from(u32::MAX)) as u32
    }

    /// Number of rows; 0 where `max` lies before `min`.
    pub fn height(&self) -> u32 {
        (i64::from(self.max[1]) - i64::from(self.min[1])).clamp(0, i64::from(u32::MAX)) as u32
    }
}

/// A value in an image's header.
#[derive(Clone, Debug, PartialEq)]
pub enum Attribute {
    /// Text.
    Text(String),
    /// Several texts.
    TextList(Vec<String>),
    /// A whole number.
    Integer(i32),
    /// A real number.
    Float(f32),
    /// Two or three real numbers are written as a vector, others cannot be written.
    Vector(Vec<f32>),
    /// A transform of column vectors; OpenEXR files hold its transpose, as their convention is row
    /// vectors.
    Matrix(Mat4),
}

/// Metadata of a picture. Only EXR files keep all of it.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageMetadata {
    /// The colour space of the R, G and B channels; `None` means sRGB's primaries.
    pub chromaticities: Option<Chromaticities>,
    /// Where the pixels lie in the coordinates of `display_window`; `None` means from (0, 0).
    pub data_window: Option<Window>,
    /// The full frame of which the pixels may be a part; `None` means the pixels are all.
    pub display_window: Option<Window>,
    /// Width of a pixel over its height.
    pub pixel_aspect: f32,
    /// Everything else, by name. [`Self::WORLD_TO_CAMERA`] and [`Self::WORLD_TO_NDC`] are the names
    /// of the camera's matrices.
    pub attributes: BTreeMap<String, Attribute>,
}

impl ImageMetadata {
    /// The attribute that holds the camera-from-world matrix.
    pub const WORLD_TO_CAMERA: &'static str = "worldToCamera";
    /// The attribute that holds the matrix from world space to normalized device coordinates.
    pub const WORLD_TO_NDC: &'static str = "worldToNDC";
    /// The attribute that names the program that made the picture.
    pub const SOFTWARE: &'static str = "software";
    /// The attribute that names the [display view](crate::DisplayView) of a picture of codes.
    pub const VIEW: &'static str = "view";
    /// The attribute for free text.
    pub const COMMENTS: &'static str = "comments";

    /// Sets an attribute.
    pub fn set(&mut self, name: &str, value: Attribute) {
        self.attributes.insert(name.to_owned(), value);
    }

    /// An attribute by its name.
    pub fn get(&self, name: &str) -> Option<&Attribute> {
        self.attributes.get(name)
    }
}

impl Default for ImageMetadata {
    fn default() -> Self {
        Self {
            chromaticities: None,
            data_window: None,
            display_window: None,
            pixel_aspect: 1.0,
            attributes: BTreeMap::new(),
        }
    }
}
