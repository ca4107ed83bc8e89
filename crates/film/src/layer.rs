//! The layers that a film can have beside its colour.

use std::fmt;

use description::GBufferSpace;

/// A layer beside the colour: a quantity of the samples of a pixel, or of their first hits.
///
/// Alpha, albedo and variance are means as the colour is. The other quantities of a first hit are
/// means over the samples that hit something, without those of negative filter weight: such a mean
/// never lies outside the range of its values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Layer {
    /// Opacity: the fraction of a pixel that is covered.
    Alpha,
    /// Distance from the plane of the camera along its axis, or from a spherical camera, in units
    /// of the scene.
    Depth,
    /// Shading normal in world space, towards the camera.
    Normal,
    /// Reflectance under white light.
    Albedo,
    /// Position in world space.
    Position,
    /// Surface parameters (u, v).
    Uv,
    /// Motion of the point on the film while the shutter is open, in pixels.
    Motion,
    /// Identifiers of the objects in the pixel, and the coverage of each.
    ObjectId,
    /// Identifiers of the materials in the pixel, and the coverage of each.
    MaterialId,
    /// Number of samples.
    Samples,
    /// Estimated variance of the pixel's luminance from samples; that of splats is unknown.
    Variance,
    /// Position in camera space at the time of the sample: x to the right, y up, z forward.
    CameraPosition,
    /// Shading normal in camera space, towards the camera.
    CameraNormal,
    /// Geometric normal in world space, towards the camera.
    GeometricNormal,
    /// Geometric normal in camera space, towards the camera.
    CameraGeometricNormal,
    /// How much world z changes to the right and down, over the footprint of a sample by which
    /// textures are filtered; the absolute value of the mean.
    Slope,
    /// The same of z in camera space.
    CameraSlope,
    /// Variance of the sensor's responses to the samples that hit something, and that variance over
    /// their mean.
    ColorVariance,
}

impl Layer {
    /// Every layer.
    pub const ALL: [Self; 18] = [
        Self::Alpha,
        Self::Depth,
        Self::Normal,
        Self::Albedo,
        Self::Position,
        Self::Uv,
        Self::Motion,
        Self::ObjectId,
        Self::MaterialId,
        Self::Samples,
        Self::Variance,
        Self::CameraPosition,
        Self::CameraNormal,
        Self::GeometricNormal,
        Self::CameraGeometricNormal,
        Self::Slope,
        Self::CameraSlope,
        Self::ColorVariance,
    ];

    /// Its name, as the command line and film files have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Alpha => "alpha",
            Self::Depth => "depth",
            Self::Normal => "normal",
            Self::Albedo => "albedo",
            Self::Position => "position",
            Self::Uv => "uv",
            Self::Motion => "motion",
            Self::ObjectId => "object-id",
            Self::MaterialId => "material-id",
            Self::Samples => "samples",
            Self::Variance => "variance",
            Self::CameraPosition => "camera-position",
            Self::CameraNormal => "camera-normal",
            Self::GeometricNormal => "geometric-normal",
            Self::CameraGeometricNormal => "camera-geometric-normal",
            Self::Slope => "slope",
            Self::CameraSlope => "camera-slope",
            Self::ColorVariance => "color-variance",
        }
    }

    /// The layer of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|layer| layer.name() == name)
    }

    /// The names of its channels in a picture; none where they depend on the pixels. A geometry
    /// buffer has the format's names.
    pub(crate) fn channels(self, gbuffer: Option<GBufferSpace>) -> &'static [&'static str] {
        match gbuffer {
            Some(space) => self.format_channels(space).unwrap_or(self.own_channels()),
            None => self.own_channels(),
        }
    }

    fn own_channels(self) -> &'static [&'static str] {
        match self {
            Self::Alpha => &["A"],
            Self::Depth => &["Z"],
            Self::Normal => &["N.X", "N.Y", "N.Z"],
            Self::Albedo => &["albedo.R", "albedo.G", "albedo.B"],
            Self::Position => &["P.X", "P.Y", "P.Z"],
            Self::Uv => &["uv.U", "uv.V"],
            Self::Motion => &["motion.X", "motion.Y"],
            Self::Samples => &["samples"],
            Self::Variance => &["variance"],
            Self::CameraPosition => &["Pcam.X", "Pcam.Y", "Pcam.Z"],
            Self::CameraNormal => &["Ncam.X", "Ncam.Y", "Ncam.Z"],
            Self::GeometricNormal => &["Ng.X", "Ng.Y", "Ng.Z"],
            Self::CameraGeometricNormal => &["Ngcam.X", "Ngcam.Y", "Ngcam.Z"],
            Self::Slope => &["slope.X", "slope.Y"],
            Self::CameraSlope => &["slopecam.X", "slopecam.Y"],
            Self::ColorVariance => &[
                "variance.R",
                "variance.G",
                "variance.B",
                "relativeVariance.R",
                "relativeVariance.G",
                "relativeVariance.B",
            ],
            Self::ObjectId | Self::MaterialId => &[],
        }
    }

    /// The names of the format's film `gbuffer` in this space. Layers of the other space that would
    /// have the same names have others.
    fn format_channels(self, space: GBufferSpace) -> Option<&'static [&'static str]> {
        let (p, n, ns) = (&["P.X", "P.Y", "P.Z"], &["N.X", "N.Y", "N.Z"], &["Ns.X", "Ns.Y", "Ns.Z"]);
        let slopes = &["dzdx", "dzdy"];
        Some(match (self, space) {
            (Self::Albedo, _) => &["Albedo.R", "Albedo.G", "Albedo.B"],
            (Self::Uv, _) => &["u", "v"],
            (Self::ColorVariance, _) => &[
                "Variance.R",
                "Variance.G",
                "Variance.B",
                "RelativeVariance.R",
                "RelativeVariance.G",
                "RelativeVariance.B",
            ],
            (Self::CameraPosition, GBufferSpace::Camera) | (Self::Position, GBufferSpace::World) => p,
            (Self::CameraNormal, GBufferSpace::Camera) | (Self::Normal, GBufferSpace::World) => ns,
            (Self::CameraGeometricNormal, GBufferSpace::Camera)
            | (Self::GeometricNormal, GBufferSpace::World) => n,
            (Self::CameraSlope, GBufferSpace::Camera) | (Self::Slope, GBufferSpace::World) => slopes,
            (Self::Position, GBufferSpace::Camera) => &["Pworld.X", "Pworld.Y", "Pworld.Z"],
            (Self::Normal, GBufferSpace::Camera) => &["Nsworld.X", "Nsworld.Y", "Nsworld.Z"],
            _ => return None,
        })
    }

    /// The number of its sums per pixel.
    pub(crate) fn sums(self) -> usize {
        match self {
            // Σ w², Σ w² y and Σ w² y² of the luminance y.
            Self::Variance => 3,
            // Samples are counted in any case.
            Self::Samples => 0,
            // The number of samples that hit, Σ c and Σ c² of each response c.
            Self::ColorVariance => 7,
            _ => self.own_channels().len(),
        }
    }

    /// Whether it is a mean over the samples that hit something.
    pub(crate) fn is_mean_of_hits(self) -> bool {
        matches!(
            self,
            Self::Depth
                | Self::Normal
                | Self::Position
                | Self::Uv
                | Self::Motion
                | Self::CameraPosition
                | Self::CameraNormal
                | Self::GeometricNormal
                | Self::CameraGeometricNormal
                | Self::Slope
                | Self::CameraSlope
        )
    }

    /// Whether it is a normal.
    pub(crate) fn is_normal(self) -> bool {
        matches!(
            self,
            Self::Normal | Self::CameraNormal | Self::GeometricNormal | Self::CameraGeometricNormal
        )
    }

    /// Whether it counts identifiers.
    pub(crate) fn is_id(self) -> bool {
        matches!(self, Self::ObjectId | Self::MaterialId)
    }

    /// Whether it needs a sample's first hit, or whether there is one.
    fn is_of_first_hit(self) -> bool {
        !matches!(self, Self::Samples | Self::Variance)
    }
}

impl fmt::Display for Layer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A set of layers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LayerSet(u32);

impl LayerSet {
    /// No layers.
    pub const NONE: Self = Self(0);

    /// Whether the layer is in the set.
    pub fn has(self, layer: Layer) -> bool {
        self.0 >> layer as u16 & 1 == 1
    }

    /// The set with this layer.
    #[must_use]
    pub fn with(self, layer: Layer) -> Self {
        Self(self.0 | 1 << layer as u16)
    }

    /// The layers, in their order.
    pub fn iter(self) -> impl Iterator<Item = Layer> {
        Layer::ALL.into_iter().filter(move |&layer| self.has(layer))
    }

    /// Whether some layer needs a sample's first hit, or whether there is one.
    pub fn has_first_hit(self) -> bool {
        self.iter().any(Layer::is_of_first_hit)
    }
}

impl FromIterator<Layer> for LayerSet {
    fn from_iter<I: IntoIterator<Item = Layer>>(layers: I) -> Self {
        layers.into_iter().fold(Self::NONE, Self::with)
    }
}

/// Where the sums of each layer are among those of a pixel. The first two are the weights of the
/// samples that hit something, and of all, where a layer needs them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout {
    layers: LayerSet,
    offsets: [usize; Layer::ALL.len()],
    count: usize,
}

impl Layout {
    /// The layout of these layers.
    pub(crate) fn new(layers: LayerSet) -> Self {
        let coverage = layers.iter().any(|layer| layer.is_mean_of_hits() || layer.is_id());
        let mut count = if coverage { 2 } else { 0 };
        let mut offsets = [0; Layer::ALL.len()];
        for layer in layers.iter() {
            offsets[layer as usize] = count;
            count += layer.sums();
        }
        Self { layers, offsets, count }
    }

    /// The layers.
    pub(crate) fn layers(&self) -> LayerSet {
        self.layers
    }

    /// The number of sums per pixel.
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// Whether the sums begin with the weights of samples.
    pub(crate) fn has_coverage(&self) -> bool {
        self.layers.iter().any(|layer| layer.is_mean_of_hits() || layer.is_id())
    }

    /// The first sum of a layer, if the film has it.
    pub(crate) fn offset(&self, layer: Layer) -> Option<usize> {
        self.layers.has(layer).then(|| self.offsets[layer as usize])
    }
}
