//! How values are stored in files.

/// How values are stored in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SampleDepth {
    /// What suits the format: in EXR the depth of the image in memory (halves for 8-bit images), in
    /// TIFF single floats for floating-point images, else 8 bits where the format has integers.
    #[default]
    Natural,
    /// 8-bit codes.
    U8,
    /// 16-bit codes.
    U16,
    /// Half floats.
    F16,
    /// Single floats.
    F32,
}
