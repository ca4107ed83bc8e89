//! Records that Rust writes and shaders read, of one declaration.

pub mod chains;
pub mod photons;
pub mod pixels;
pub mod wavefront;

/// The type in WGSL of a field, or the one that is given.
#[rustfmt::skip]
macro_rules! wgsl_type {
    ($type:tt $wgsl:literal) => { $wgsl };
    (u32) => { "u32" };
    (f32) => { "f32" };
    (Top) => { "Top" };
    (i32) => { "i32" };
    (Eye) => { "Eye" };
    ([u32; 2]) => { "vec2u" };
    ([f32; 2]) => { "vec2f" };
    ([f32; 4]) => { "vec4f" };
    ([f32; 3]) => { "vec3f" };
    ([[u32; 4]; 3]) => { "array<vec4u, 3>" };
    ([[f32; 4]; 3]) => { "array<vec4f, 3>" };
    ([[f32; 4]; 4]) => { "mat4x4f" };
    ([[f32; 4]; 9]) => { "array<vec4f, 9>" };
}
pub(crate) use wgsl_type;

/// Declares a record, and in WGSL a structure with the same name and fields, after which more may
/// follow there.
macro_rules! record {
    (
        $(#[$meta:meta])*
        $vis:vis struct $name:ident {
            $($(#[$of_field:meta])* $field:ident: $type:tt $(as $wgsl:literal)?,)*
        }
        $($rest:literal)?
    ) => {
        $(#[$meta])*
        #[repr(C)]
        #[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
        $vis struct $name {
            $($(#[$of_field])* pub $field: $type),*
        }

        impl $name {
            /// The structure in WGSL.
            pub const TEXT: &str = concat!(
                "struct ", stringify!($name), " {\n",
                $("    ", stringify!($field), ": ", $crate::records::wgsl_type!($type $($wgsl)?), ",\n",)*
                $("    ", $rest, ",\n",)?
                "}\n",
            );
        }
    };
}
pub(crate) use record;
