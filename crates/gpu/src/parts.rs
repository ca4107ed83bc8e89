//! The parts of kernels that not all scenes need.

/// Declares the parts, each of which is a constant of shaders: `HAS_` and its name.
macro_rules! parts {
    ($($(#[$meta:meta])* $part:ident)*) => {
        /// Parts that kernels have only for scenes that need them, because they are much code.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct Parts {
            $($(#[$meta])* pub $part: bool),*
        }

        impl Parts {
            /// The names of the parts.
            pub const NAMES: &[&str] = &[$(stringify!($part)),*];

            /// The parts whose names are chosen.
            pub fn from_fn(is_chosen: impl Fn(&str) -> bool) -> Self {
                Self { $($part: is_chosen(stringify!($part))),* }
            }

            /// The constants of shaders.
            pub(crate) fn text(self) -> String {
                let line = |name: &str, is: bool| format!("const HAS_{} = {is};\n", name.to_uppercase());
                [$(line(stringify!($part), self.$part)),*].concat()
            }
        }
    };
}

parts! {
    /// Textures that are neither a number nor a spectrum.
    programs
    /// Maps of normals and of heights.
    bumps
    /// Surfaces with an alpha.
    holes
    /// Surfaces whose backs the camera does not see.
    single_sided
    /// Textures of images.
    images
    /// Lights at points.
    point_lights
    /// Infinite lights with images.
    sky_images
    /// Lights with surfaces.
    surface_lights
    /// Lights whose surfaces are neither triangles nor rectangles.
    round_lights
    /// Lights with surfaces whose images are their emission, or choose their points.
    emission_images
    /// Lights with surfaces in instances.
    placed_lights
    /// Lights with surfaces that have holes.
    light_holes
    /// Infinite lights behind portals.
    portals
    /// Textures of noise.
    noise
    /// Metals and glass.
    facets
    /// Coated materials.
    coats
    /// Principled surfaces.
    principled
    /// Curves.
    curves
    /// A camera with a system of lenses.
    lenses
    /// Instances that move.
    motion
    /// The material of hair.
    hair
    /// Measured surfaces.
    measured
    /// Bodies under whose surface light is scattered.
    subsurface
    /// Sampler `zsobol`.
    zsobol
    /// Samplers other than that and `independent`, which all kernels have.
    rare_samplers
    /// Participating media, or interfaces, which paths pass.
    media
    /// Diffuse surfaces instead of all others.
    forced_diffuse
    /// Rays by the ray queries of the hardware.
    ray_queries
}
