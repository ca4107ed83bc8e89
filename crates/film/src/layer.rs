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
    /// Light that the first surface reflects, without what its facets mirror.
    Diffuse,
    /// Light that facets of the first surface mirror.
    Specular,
    /// Light that the first surface transmits.
    Transmission,
    /// Light that is scattered first by a participating medium.
    Volume,
    /// Light that is not scattered: of lights that the camera sees.
    Emission,
    /// Light that is scattered once or not at all.
    Direct,
    /// Light that is scattered more than once.
    Indirect,
    /// Light of each group of lights.
    LightGroups,
    /// Identifiers of the assets in the pixel, and the coverage of each.
    AssetId,
}

impl Layer {
    /// Every layer.
    pub const ALL: [Self; 27] = [
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
        Self::Diffuse,
        Self::Specular,
        Self::Transmission,
        Self::Volume,
        Self::Emission,
        Self::Direct,
        Self::Indirect,
        Self::LightGroups,
        Self::AssetId,
    ];

    /// Those that count identifiers.
    pub const IDS: [Self; 3] = [Self::ObjectId, Self::MaterialId, Self::AssetId];

    /// The parts of the light by what paths do. The first five sum to the colour, and so do the
    /// last two.
    pub const OF_PATHS: [Self; 7] = [
        Self::Diffuse,
        Self::Specular,
        Self::Transmission,
        Self::Volume,
        Self::Emission,
        Self::Direct,
        Self::Indirect,
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
            Self::Diffuse => "diffuse",
            Self::Specular => "specular",
            Self::Transmission => "transmission",
            Self::Volume => "volume",
            Self::Emission => "emission",
            Self::Direct => "direct",
            Self::Indirect => "indirect",
            Self::LightGroups => "light-groups",
            Self::AssetId => "asset-id",
        }
    }

    /// The layer of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|layer| layer.name() == name)
    }

    /// The names of its channels in a picture; none where they depend on the pixels or the scene. A
    /// geometry buffer has the format's names.
    pub fn channels(self, gbuffer: Option<GBufferSpace>) -> &'static [&'static str] {
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
            Self::Diffuse => &["diffuse.R", "diffuse.G", "diffuse.B"],
            Self::Specular => &["specular.R", "specular.G", "specular.B"],
            Self::Transmission => &["transmission.R", "transmission.G", "transmission.B"],
            Self::Volume => &["volume.R", "volume.G", "volume.B"],
            Self::Emission => &["emission.R", "emission.G", "emission.B"],
            Self::Direct => &["direct.R", "direct.G", "direct.B"],
            Self::Indirect => &["indirect.R", "indirect.G", "indirect.B"],
            Self::ObjectId | Self::MaterialId | Self::AssetId | Self::LightGroups => &[],
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

    /// The number of its sums per pixel, of a film with this number of groups of lights.
    pub(crate) fn sums(self, groups: usize) -> usize {
        match self {
            Self::LightGroups => 3 * groups,
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

    /// Whether it is a part of the colour.
    pub fn is_part(self) -> bool {
        self == Self::LightGroups || Self::OF_PATHS.contains(&self)
    }

    /// Whether it counts identifiers.
    pub(crate) fn is_id(self) -> bool {
        Self::IDS.contains(&self)
    }

    /// Whether it needs a sample's first hit, or whether there is one.
    fn is_of_first_hit(self) -> bool {
        !(self.is_part() || matches!(self, Self::Samples | Self::Variance))
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
        let mut rest = self.0;
        std::iter::from_fn(move || {
            let layer = Layer::ALL.get(rest.trailing_zeros() as usize).copied()?;
            rest &= rest - 1;
            Some(layer)
        })
    }

    /// Whether some layer needs a sample's first hit, or whether there is one.
    pub fn has_first_hit(self) -> bool {
        self.iter().any(Layer::is_of_first_hit)
    }

    /// Whether some layer is a part of the colour.
    pub fn has_parts(self) -> bool {
        self.iter().any(Layer::is_part)
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
    groups: usize,
    offsets: [usize; Layer::ALL.len()],
    count: usize,
}

impl Layout {
    /// The layout of these layers, with this number of groups of lights.
    pub(crate) fn new(layers: LayerSet, groups: usize) -> Self {
        let coverage = layers.iter().any(|layer| layer.is_mean_of_hits() || layer.is_id());
        let mut count = if coverage { 2 } else { 0 };
        let mut offsets = [0; Layer::ALL.len()];
        for layer in layers.iter() {
            offsets[layer as usize] = count;
            count += layer.sums(groups);
        }
        Self { layers, groups, offsets, count }
    }

    /// The layers.
    pub(crate) fn layers(&self) -> LayerSet {
        self.layers
    }

    /// The number of sums of a layer.
    pub(crate) fn sums(&self, layer: Layer) -> usize {
        layer.sums(self.groups)
    }

    /// The number of groups of lights of its layer.
    pub(crate) fn groups(&self) -> usize {
        self.groups
    }

    /// The layers that are parts of the colour, with the first sum of each.
    pub(crate) fn parts(&self) -> impl Iterator<Item = (Layer, usize)> {
        let parts = Layer::OF_PATHS.into_iter().chain([Layer::LightGroups]);
        parts.filter_map(|layer| Some((layer, self.offset(layer)?)))
    }

    /// The number of these parts, each of three sums; a layer of groups has one for each.
    pub(crate) fn part_count(&self) -> usize {
        self.parts().map(|(layer, _)| self.sums(layer) / 3).sum()
    }

    /// The first part of a layer among all of them.
    pub(crate) fn first_part(&self, layer: Layer) -> usize {
        let before = self.parts().take_while(|&(of, _)| of != layer);
        before.map(|(of, _)| self.sums(of) / 3).sum()
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
