//! The layers that a film can have beside its colour.

use std::fmt;

use description::GBufferSpace::{self, Camera, World};
use spectrum::SampledSpectrum;

/// How the numbers of a layer follow from the samples of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Statistic {
    /// A mean as the colour is.
    Mean,
    /// A mean over the samples that hit something, without those of negative filter weight.
    MeanOfHits,
    /// The identifiers that cover most of a pixel, and the coverage of each.
    Ids,
    /// The number of samples.
    Count,
    /// The variance of the mean luminance.
    Variance,
    /// The variance of each response to samples that hit something, also over its mean.
    ColorVariance,
    /// A mean of a part of the light, to which splats add.
    Part,
    /// The same for each group of lights.
    Groups,
}

/// A layer's kind of number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// A share from 0 to 1.
    Opacity,
    /// Colours.
    Light,
    /// A distance; 10¹⁰ where there is none.
    Distance,
    /// A direction of unit length.
    Direction,
    /// Coordinates of points.
    Coordinates,
    /// Numbers that are written without their signs.
    Magnitude,
    /// Any others.
    Number,
}

/// The facts of a layer.
struct Row {
    name: &'static str,
    statistic: Statistic,
    quantity: Quantity,
    /// None where they depend on the pixels or the scene.
    channels: &'static [&'static str],
    /// The spaces whose film `gbuffer` of the format has it.
    spaces: &'static [GBufferSpace],
    /// The format's names of its channels in such a film.
    gbuffer: &'static [&'static str],
    /// Its names in such a film of the other space, if one of the format's is among its own.
    aside: &'static [&'static str],
    /// The name of a layer of identifiers in a picture.
    cryptomatte: &'static str,
}

/// Declares the layers, each by a row: its name, statistic, channels, quantity of [`FirstHit`],
/// kind of number and further columns of [`Row`].
macro_rules! layers {
    ($(
        $(#[doc = $about:literal])+
        $layer:ident = $name:literal: $statistic:ident $([$($channel:literal),+])? $(of $hit:ident)?,
        $quantity:ident $(, $column:ident: $value:expr)*;
    )+) => {
        /// A layer beside the colour: a quantity of the samples of a pixel, or of their first hits.
        ///
        /// Alpha, albedo and variance are means as the colour is. The other quantities of a first
        /// hit are means over the samples that hit something, without those of negative filter
        /// weight: such a mean never lies outside the range of its values.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Layer {
            $($(#[doc = $about])+ $layer,)+
        }

        static ROWS: [Row; [$($name),+].len()] = [$(Row {
            $($column: $value,)*
            ..Row::new($name, Statistic::$statistic, Quantity::$quantity, &[$($($channel),+)?])
        },)+];

        impl Layer {
            /// Every layer.
            pub const ALL: [Self; ROWS.len()] = [$(Self::$layer),+];
        }

        /// The first hit of a sample.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct FirstHit {
            $($(
                #[doc = concat!("Of the layer `", $name, "`.")]
                pub $hit: [f32; Layer::$layer.row().channels.len()],
            )?)+
            /// Reflectance at the sample's first group of wavelengths.
            pub albedo: SampledSpectrum,
            /// Identifiers of the object, the material and the asset, as [`Layer::IDS`] has them;
            /// [`id_of_name`](crate::id_of_name) makes one of a name.
            pub ids: [u32; Layer::IDS.len()],
        }

        impl FirstHit {
            /// The numbers of a layer of means of hits.
            pub(crate) fn numbers(&self, layer: Layer) -> &[f32] {
                match layer {
                    $($(Layer::$layer => &self.$hit,)?)+
                    _ => &[],
                }
            }
        }
    };
}

// Films have the sums of layers in this order.
layers! {
    /// Opacity: the fraction of a pixel that is covered.
    Alpha = "alpha": Mean ["A"], Opacity;
    /// Distance from the plane of the camera along its axis, or from a spherical camera, in units
    /// of the scene.
    Depth = "depth": MeanOfHits ["Z"] of depth, Distance;
    /// Shading normal in world space, towards the camera.
    Normal = "normal": MeanOfHits ["N.X", "N.Y", "N.Z"] of normal, Direction, spaces: &[World],
        gbuffer: &["Ns.X", "Ns.Y", "Ns.Z"], aside: &["Nsworld.X", "Nsworld.Y", "Nsworld.Z"];
    /// Reflectance under white light.
    Albedo = "albedo": Mean ["albedo.R", "albedo.G", "albedo.B"], Light, spaces: &[Camera, World],
        gbuffer: &["Albedo.R", "Albedo.G", "Albedo.B"];
    /// Position in world space.
    Position = "position": MeanOfHits ["P.X", "P.Y", "P.Z"] of position, Coordinates, spaces: &[World],
        gbuffer: &["P.X", "P.Y", "P.Z"], aside: &["Pworld.X", "Pworld.Y", "Pworld.Z"];
    /// Surface parameters (u, v).
    Uv = "uv": MeanOfHits ["uv.U", "uv.V"] of uv, Coordinates, spaces: &[Camera, World],
        gbuffer: &["u", "v"];
    /// Motion of the point on the film while the shutter is open, in pixels.
    Motion = "motion": MeanOfHits ["motion.X", "motion.Y"] of motion, Number;
    /// Identifiers of the objects in the pixel, and the coverage of each.
    ObjectId = "object-id": Ids, Number, cryptomatte: "CryptoObject";
    /// Identifiers of the materials in the pixel, and the coverage of each.
    MaterialId = "material-id": Ids, Number, cryptomatte: "CryptoMaterial";
    /// Number of samples.
    Samples = "samples": Count ["samples"], Number;
    /// Estimated variance of the pixel's luminance from samples; that of splats is unknown.
    Variance = "variance": Variance ["variance"], Number;
    /// Position in camera space at the time of the sample: x to the right, y up, z forward.
    CameraPosition = "camera-position": MeanOfHits ["Pcam.X", "Pcam.Y", "Pcam.Z"] of camera_position,
        Coordinates, spaces: &[Camera], gbuffer: &["P.X", "P.Y", "P.Z"];
    /// Shading normal in camera space, towards the camera.
    CameraNormal = "camera-normal": MeanOfHits ["Ncam.X", "Ncam.Y", "Ncam.Z"] of camera_normal,
        Direction, spaces: &[Camera], gbuffer: &["Ns.X", "Ns.Y", "Ns.Z"];
    /// Geometric normal in world space, towards the camera.
    GeometricNormal = "geometric-normal": MeanOfHits ["Ng.X", "Ng.Y", "Ng.Z"] of geometric_normal,
        Direction, spaces: &[World], gbuffer: &["N.X", "N.Y", "N.Z"];
    /// Geometric normal in camera space, towards the camera.
    CameraGeometricNormal = "camera-geometric-normal": MeanOfHits ["Ngcam.X", "Ngcam.Y", "Ngcam.Z"]
        of camera_geometric_normal, Direction, spaces: &[Camera], gbuffer: &["N.X", "N.Y", "N.Z"];
    /// How much world z changes to the right and down, over the footprint of a sample by which
    /// textures are filtered; the absolute value of the mean.
    Slope = "slope": MeanOfHits ["slope.X", "slope.Y"] of slope, Magnitude, spaces: &[World],
        gbuffer: &["dzdx", "dzdy"];
    /// The same of z in camera space.
    CameraSlope = "camera-slope": MeanOfHits ["slopecam.X", "slopecam.Y"] of camera_slope, Magnitude,
        spaces: &[Camera], gbuffer: &["dzdx", "dzdy"];
    /// Variance of the sensor's responses to the samples that hit something, and that variance over
    /// their mean.
    ColorVariance = "color-variance": ColorVariance [
        "variance.R", "variance.G", "variance.B",
        "relativeVariance.R", "relativeVariance.G", "relativeVariance.B"
    ], Number, spaces: &[Camera, World], gbuffer: &[
        "Variance.R", "Variance.G", "Variance.B",
        "RelativeVariance.R", "RelativeVariance.G", "RelativeVariance.B",
    ];
    /// Light that the first surface reflects, without what its facets mirror.
    Diffuse = "diffuse": Part ["diffuse.R", "diffuse.G", "diffuse.B"], Light;
    /// Light that facets of the first surface mirror.
    Specular = "specular": Part ["specular.R", "specular.G", "specular.B"], Light;
    /// Light that the first surface transmits.
    Transmission = "transmission": Part ["transmission.R", "transmission.G", "transmission.B"], Light;
    /// Light that is scattered first by a participating medium.
    Volume = "volume": Part ["volume.R", "volume.G", "volume.B"], Light;
    /// Light that is not scattered: of lights that the camera sees.
    Emission = "emission": Part ["emission.R", "emission.G", "emission.B"], Light;
    /// Light that is scattered once or not at all.
    Direct = "direct": Part ["direct.R", "direct.G", "direct.B"], Light;
    /// Light that is scattered more than once.
    Indirect = "indirect": Part ["indirect.R", "indirect.G", "indirect.B"], Light;
    /// Light of each group of lights.
    LightGroups = "light-groups": Groups, Light;
    /// Identifiers of the assets in the pixel, and the coverage of each.
    AssetId = "asset-id": Ids, Number, cryptomatte: "CryptoAsset";
}

impl Row {
    const fn new(
        name: &'static str,
        statistic: Statistic,
        quantity: Quantity,
        channels: &'static [&'static str],
    ) -> Self {
        Self { name, statistic, quantity, channels, spaces: &[], gbuffer: &[], aside: &[], cryptomatte: "" }
    }
}

/// The layers of a statistic, of which there are `N`.
const fn all_of<const N: usize>(statistic: Statistic) -> [Layer; N] {
    let (mut layers, mut count, mut i) = ([Layer::Alpha; N], 0, 0);
    while i < ROWS.len() {
        if ROWS[i].statistic as u8 == statistic as u8 {
            layers[count] = Layer::ALL[i];
            count += 1;
        }
        i += 1;
    }
    assert!(count == N);
    layers
}

impl Layer {
    /// Those that count identifiers.
    pub const IDS: [Self; 3] = all_of(Statistic::Ids);

    /// The parts of the light by what paths do. The first five sum to the colour, and so do the
    /// last two.
    pub const OF_PATHS: [Self; 7] = all_of(Statistic::Part);

    const fn row(self) -> &'static Row {
        &ROWS[self as usize]
    }

    /// Its name, as the command line and film files have it.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// The layer of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|layer| layer.name() == name)
    }

    /// The names of its channels in a picture; none where they depend on the pixels or the scene. A
    /// geometry buffer has the format's names, and layers of the other space that would have the
    /// same names have others.
    pub fn channels(self, gbuffer: Option<GBufferSpace>) -> &'static [&'static str] {
        let row = self.row();
        match gbuffer {
            Some(space) if self.is_in_gbuffer(space) => row.gbuffer,
            Some(_) if !row.aside.is_empty() => row.aside,
            _ => row.channels,
        }
    }

    /// Whether the format's film `gbuffer` in this space has it.
    pub(crate) fn is_in_gbuffer(self, space: GBufferSpace) -> bool {
        self.row().spaces.contains(&space)
    }

    /// The name of a layer of identifiers in a picture, with which those of its channels begin;
    /// empty for other layers.
    pub fn cryptomatte(self) -> &'static str {
        self.row().cryptomatte
    }

    /// How it follows from samples.
    pub(crate) fn statistic(self) -> Statistic {
        self.row().statistic
    }

    /// The kind of its numbers.
    pub fn quantity(self) -> Quantity {
        self.row().quantity
    }

    /// The number of its sums per pixel, of a film with this number of groups of lights.
    pub(crate) fn sums(self, groups: usize) -> usize {
        match self.statistic() {
            Statistic::Mean | Statistic::MeanOfHits | Statistic::Part => self.row().channels.len(),
            Statistic::Groups => 3 * groups,
            // Σ w², Σ w² y and Σ w² y² of the luminance y.
            Statistic::Variance => 3,
            // The number of samples that hit, Σ c and Σ c² of each response c.
            Statistic::ColorVariance => 7,
            // Samples are counted in any case.
            Statistic::Count | Statistic::Ids => 0,
        }
    }

    /// Whether it needs the weights of the samples that hit something, and of all.
    fn is_of_coverage(self) -> bool {
        matches!(self.statistic(), Statistic::MeanOfHits | Statistic::Ids)
    }

    /// Whether it is a part of the colour.
    pub fn is_part(self) -> bool {
        matches!(self.statistic(), Statistic::Part | Statistic::Groups)
    }

    /// Whether it counts identifiers.
    pub(crate) fn is_id(self) -> bool {
        self.statistic() == Statistic::Ids
    }

    /// Whether it needs a sample's first hit, or whether there is one.
    fn is_of_first_hit(self) -> bool {
        !self.is_part() && !matches!(self.statistic(), Statistic::Count | Statistic::Variance)
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
        let coverage = layers.iter().any(Layer::is_of_coverage);
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
        self.layers.iter().any(Layer::is_of_coverage)
    }

    /// The first sum of a layer, if the film has it.
    pub(crate) fn offset(&self, layer: Layer) -> Option<usize> {
        self.layers.has(layer).then(|| self.offsets[layer as usize])
    }
}
