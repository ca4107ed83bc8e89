//! Options of the renderer as a whole.

use crate::schema::{above, choices, settings};

choices! {
    /// The coordinate system in which rays are traced. It does not change the picture.
    pub enum RenderSpace {
        /// The camera's.
        Camera = "camera",
        /// The world's, moved so that the camera stands at the origin.
        #[default]
        CameraWorld = "cameraworld",
        /// The world's.
        World = "world",
    }
}

settings! {
    /// The values of the `Option` directives.
    #[derive(Clone, Debug, PartialEq)]
    pub struct OptionsDesc {
        /// Sample every pixel at its centre only.
        disable_pixel_jitter: bool = false => ["disablepixeljitter"];
        /// Look textures up at points, without filtering.
        disable_texture_filtering: bool = false => ["disabletexturefiltering"];
        /// Use the same wavelengths for every sample.
        disable_wavelength_jitter: bool = false => ["disablewavelengthjitter"];
        /// Factor on the edge length to which displaced surfaces are cut.
        displacement_edge_scale: f32 = 1.0 => ["displacementedgescale": above(0.0)];
        /// Draw every surface as if it were diffuse.
        force_diffuse: bool = false => ["forcediffuse"];
        /// Image to measure the error against after each pass.
        mse_reference_image: Option<String> = None => ["msereferenceimage"];
        /// File that receives these errors.
        mse_reference_out: Option<String> = None => ["msereferenceout"];
        /// Write statistics per pixel.
        pixel_stats: bool = false => ["pixelstats"];
        /// The coordinate system in which rays are traced.
        render_space: RenderSpace = RenderSpace::CameraWorld => ["rendercoordsys"];
        /// Seed of samplers that do not name their own.
        seed: i32 = 0 => ["seed"];
        /// Ask for the wavefront renderer.
        wavefront: bool = false => ["wavefront"];
    }
}
