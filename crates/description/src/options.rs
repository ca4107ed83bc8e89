//! Options of the renderer as a whole.

use crate::schema::{above, choices, settings};

choices! {
    /// The coordinate system in which rays are traced. It does not change the picture.
    pub enum RenderSpace {
        /// The camera's.
        Camera = "camera",
        /// The world's, translated so that the camera is at the origin.
        #[default]
        CameraWorld = "cameraworld",
        /// The world's.
        World = "world",
    }
}

choices! {
    /// How rays from the camera are traced. Engines give the same picture within rounding.
    pub enum Engine {
        /// Many paths at once, stage by stage, several in the lanes of vectors.
        #[default]
        Wavefront = "wavefront",
        /// One path after another.
        Scalar = "scalar",
    }
}

choices! {
    /// How a GPU's work on paths is cut into kernels. Schedules give the same picture within
    /// rounding.
    pub enum Schedule {
        /// A thread follows a whole path.
        #[default]
        Megakernel = "megakernel",
        /// Paths go through each stage together, and new ones take the places of those that end.
        Wavefront = "wavefront",
    }
}

settings! {
    /// The values of the `Option` directives.
    #[derive(Clone, Debug, PartialEq)]
    pub struct OptionsDesc {
        /// Contrast of neighbouring pixels, a difference of sRGB codes, from which a pixel takes
        /// all of its samples, down to a sixteenth of them where there is none. Otherwise all
        /// pixels take as many.
        adaptive: Option<f32> = None => ["adaptive": above(0.0)];
        /// Sample every pixel at its centre only.
        disable_pixel_jitter: bool = false => ["disablepixeljitter"];
        /// Evaluate textures at points, without filtering.
        disable_texture_filtering: bool = false => ["disabletexturefiltering"];
        /// Use the same wavelengths for every sample, those of pbrt-v4: 545.9, 616.9, 830 and
        /// 479.2 nm, or of a spectral film 0.5, 0.75, 1 and 0.25 of its range.
        disable_wavelength_jitter: bool = false => ["disablewavelengthjitter"];
        /// Factor on the edge length to which displaced surfaces are tessellated.
        displacement_edge_scale: f32 = 1.0 => ["displacementedgescale": above(0.0)];
        /// How `ray-casting`, `whitted`, `ambient-occlusion`, `path` and `vol-path` trace rays.
        engine: Engine = Engine::Wavefront => ["engine"];
        /// Replace every BSDF by a diffuse one of the same albedo.
        force_diffuse: bool = false => ["forcediffuse"];
        /// Image to measure the error against after each pass.
        mse_reference_image: Option<String> = None => ["msereferenceimage"];
        /// File that receives these errors.
        mse_reference_out: Option<String> = None => ["msereferenceout"];
        /// Write statistics per pixel.
        pixel_stats: bool = false => ["pixelstats"];
        /// The coordinate system in which rays are traced.
        render_space: RenderSpace = RenderSpace::CameraWorld => ["rendercoordsys"];
        /// How a GPU, which `--device` chooses, follows the paths of `path` and `vol-path`.
        schedule: Schedule = Schedule::Megakernel => ["schedule"];
        /// Default seed of samplers.
        seed: i32 = 0 => ["seed"];
        /// Select the wavefront renderer.
        wavefront: bool = false => ["wavefront"];
    }
}
