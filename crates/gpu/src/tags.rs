//! Tags: the words by which records say what they are, and bits of words.
//!
//! Each set is declared here alone. What shaders have of it is made from the declaration, named as
//! the translation of laws names members of enums: `Enum_Member`.

/// Declares sets of tags, and makes their text in WGSL.
macro_rules! tags {
    ($($(#[$meta:meta])* $set:ident { $($tag:ident $(= $value:expr)?),* $(,)? })*) => {
        $(
            $(#[$meta])*
            #[derive(Clone, Copy, Debug, PartialEq, Eq)]
            #[repr(u32)]
            pub(crate) enum $set { $($tag $(= $value)?),* }

            impl $set {
                /// All tags.
                pub(crate) const ALL: &[Self] = &[$(Self::$tag),*];
            }

            impl From<$set> for u32 {
                fn from(tag: $set) -> Self {
                    tag as Self
                }
            }
        )*

        /// The constants of shaders.
        pub(crate) fn text() -> String {
            let mut text = String::new();
            $(for tag in $set::ALL {
                text += &format!("const {}_{tag:?} = {}u;\n", stringify!($set), *tag as u32);
            })*
            text
        }
    };
}

tags! {
    /// Materials. Of a body, its boundary alone, where paths enter it, and where they leave it, are
    /// kinds of what shaders sample, but not of records.
    MaterialTag {
        Diffuse, DiffuseTransmission, Conductor, Dielectric, ThinDielectric, Mix, CoatedDiffuse,
        CoatedConductor, Principled, Interface, Hair, Measured, Subsurface, Boundary, Exit,
    }
    /// Parameters that give the absorption of hair.
    AbsorptionTag { Coefficient, Color, Pigments }
    /// Lights.
    LightTag {
        Point, Spot, Distant, Triangle, Rectangle, Sphere, UniformInfinite, ImageInfinite, Disk,
        Cylinder, Goniometric, Projection, Patch, PortalInfinite, Placed, SpherePart,
    }
    /// Choices of lights.
    ChoiceTag { Uniform, Power, Tree }
    /// Sources of random numbers.
    SamplerTag { Independent, ZSobol, PaddedSobol, Sobol, Halton, Stratified, Pmj02Bn }
    /// Pixel filters.
    FilterTag { Box, Triangle, Table }
    /// Cameras.
    CameraTag { Perspective, Orthographic, EquiRectangular, EqualArea, Realistic }
    /// Media.
    MediumTag { Homogeneous, Densities, Colours, Cloud, Voxels }
    /// Spectra.
    SpectrumTag { Constant, Linear, Dense, Rgb, RgbLight }
    /// The types of spectra that RGB values become.
    SpectrumTypeTag { Albedo, Unbounded, Illuminant }
    /// Textures.
    TextureTag { Number, Spectrum, Program }
    /// Operations of programs.
    CodeTag {
        Number, Spectrum, Squares, Cubes, Facing, Step, Scale, Mix, Bilerp, Image, Dots, Fbm, Wrinkled,
        Windy, Marble,
    }
    /// Mappings to the plane.
    MappingTag { Linear, Spherical, Cylindrical, Planar }
    /// Filters of image textures.
    LookupTag { Point, Bilinear, Trilinear, Ewa }
    /// How texels are stored.
    StorageTag { Bytes, Halves, Floats }
    /// Lookups beyond the edges of images.
    WrapTag { Repeat, Black, Clamp, Sphere, LatitudeLongitude, Axes }
    /// Projections of the sphere on images of lights.
    ProjectionTag { EqualArea, LatitudeLongitude }
    /// Instances, and shapes that are not triangles. A ball is a whole sphere that is not rotated,
    /// for spheres by the million.
    ItemTag { Instance, Patch, Sphere, Cylinder, Disk, Plane, Ball, FlatCurve, Tube, Ribbon }
    /// Bits of an item: the outside is turned over, hits are asked whether they count.
    ItemBit { Flips = 1, Marked = 2 }
    /// Bits: what the vertices of a mesh have.
    AttributeBit { Normals = 1, Coordinates = 2, Tangents = 4 }
    /// Bits of the settings of algorithms: surfaces are roughened after scattering, lights are
    /// sampled; and of `simple-path`: directions are by BSDFs, others are on the sides to which
    /// surfaces scatter.
    SettingBit { Regularizes = 1, SamplesLights = 2, SamplesBsdfs = 4, MirrorsDirections = 8 }
    /// Masks of instances for ray queries.
    MaskBit { Triangles = 1, Shapes = 2 }
    /// Bits of the reuse of reservoirs.
    ReuseBit { IsBiased = 1, HasBefore = 2 }
    /// Rows of the table of chains: the scalar contribution of the current point, the candidate
    /// where the chain starts, the weight of the current point so far, its film position,
    /// wavelength and light, and the rays of the chain. The point follows.
    ChainRow {
        Scalar = 0, Start = 1, Weight = 2, Film = 3, Wavelength = 5, Light = 6, Rays = 10, Point = 11,
    }
}

/// A bit where something is so, and 0 elsewhere.
pub(crate) fn bit(is: bool, bit: impl Into<u32>) -> u32 {
    if is { bit.into() } else { 0 }
}
