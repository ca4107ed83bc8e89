//! Options of the renderer as a whole.

/// The coordinate system in which rays are traced. It does not change the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RenderSpace {
    /// The camera's.
    Camera,
    /// The world's, moved so that the camera stands at the origin.
    #[default]
    CameraWorld,
    /// The world's.
    World,
}

/// What the `Option` directives said.
#[derive(Clone, Debug, PartialEq)]
pub struct OptionsDesc {
    /// Sample every pixel at its centre only.
    pub disable_pixel_jitter: bool,
    /// Look textures up at points, without filtering.
    pub disable_texture_filtering: bool,
    /// Use the same wavelengths for every sample.
    pub disable_wavelength_jitter: bool,
    /// Factor on the edge length to which displaced surfaces are cut.
    pub displacement_edge_scale: f32,
    /// Draw every surface as if it were diffuse.
    pub force_diffuse: bool,
    /// Image to measure the error against after each pass.
    pub mse_reference_image: Option<String>,
    /// File that receives these errors.
    pub mse_reference_out: Option<String>,
    /// Write statistics per pixel.
    pub pixel_stats: bool,
    /// The coordinate system in which rays are traced.
    pub render_space: RenderSpace,
    /// Seed of samplers that do not name their own.
    pub seed: i32,
    /// Ask for the wavefront renderer.
    pub wavefront: bool,
}

impl Default for OptionsDesc {
    fn default() -> Self {
        Self {
            disable_pixel_jitter: false,
            disable_texture_filtering: false,
            disable_wavelength_jitter: false,
            displacement_edge_scale: 1.0,
            force_diffuse: false,
            mse_reference_image: None,
            mse_reference_out: None,
            pixel_stats: false,
            render_space: RenderSpace::default(),
            seed: 0,
            wavefront: false,
        }
    }
}
