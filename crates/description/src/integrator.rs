//! Light transport algorithms and their settings.
//!
//! The depth of a path is the number of its scattering events: 0 shows emission only, 1 adds direct
//! light.

use crate::SamplerKind;
use crate::schema::{
    SettingType, Settings, above, at_least, between, choices, from, settings, with_extension,
};

/// Facts of an algorithm that do not depend on its settings.
#[derive(Clone, Copy, Debug)]
pub struct IntegratorFacts {
    /// Whether it draws participating media.
    pub knows_media: bool,
    /// Whether it draws scattering under surfaces, or no scattering at all.
    pub knows_subsurface: bool,
    /// Whether it estimates pixels one by one, with nothing else.
    pub estimates_pixels: bool,
    /// Whether it makes layers of parts of the light.
    pub makes_parts: bool,
    /// Whether it takes the numbers of paths from the lights from a sampler.
    pub samples_light_paths: bool,
    /// Whether it stores photons.
    pub stores_photons: bool,
    /// Whether a scene without light has a picture, too.
    pub needs_no_light: bool,
    /// The light that it finds only by connections of light paths to the camera.
    pub connected: Connected,
}

/// Light that an algorithm finds only by connections of light paths to the camera.
#[derive(Clone, Copy, Debug)]
pub enum Connected {
    /// None.
    Nothing,
    /// Some of it; a clause says how the picture is without them.
    Some(&'static str),
    /// All of it.
    All,
}

impl IntegratorFacts {
    const NONE: Self = Self {
        knows_media: false,
        knows_subsurface: false,
        estimates_pixels: false,
        makes_parts: false,
        samples_light_paths: false,
        stores_photons: false,
        needs_no_light: false,
        connected: Connected::Nothing,
    };
}

/// No other strategy finds light of a delta light that is scattered by deltas only until it reaches
/// the first surface.
const CAUSTICS: Connected = Connected::Some("caustics of point, spot and distant lights are missing");

settings! {
    /// An algorithm with its settings.
    #[derive(Clone, Debug, PartialEq)]
    pub enum IntegratorDesc: IntegratorFacts = VolPath {
        /// Primary rays only; lights are added without shadows.
        RayCasting = "ray-casting" | "raycasting" [knows_media, estimates_pixels],
        /// Primary and shadow rays, mirror reflection and refraction.
        Whitted(WhittedDesc) = "whitted" [knows_media, estimates_pixels],
        /// The unoccluded share of the hemisphere over each point.
        AmbientOcclusion(AmbientOcclusionDesc) = "ambient-occlusion" | "ambientocclusion"
            [knows_subsurface, estimates_pixels, needs_no_light],
        /// Paths in uniform directions, without next-event estimation.
        RandomWalk(RandomWalkDesc) = "random-walk" | "randomwalk" [estimates_pixels],
        /// Paths that sample lights or the BSDF, without weighting one against the other.
        SimplePath(SimplePathDesc) = "simple-path" | "simplepath" [estimates_pixels],
        /// Path tracing with next-event estimation and multiple importance sampling.
        Path(PathDesc) = "path" [knows_subsurface, estimates_pixels, makes_parts],
        /// Path tracing through participating media; without media, like `path`: the format's
        /// default.
        VolPath(PathDesc) = "vol-path" | "volpath"
            [knows_media, knows_subsurface, estimates_pixels, makes_parts],
        /// Paths from lights, each vertex connected to the camera.
        LightTracing(LightTracingDesc) = "light-tracing" | "lighttracing" | "lightpath"
            [knows_media, knows_subsurface, samples_light_paths, connected: Connected::All],
        /// Bidirectional path tracing.
        Bdpt(BdptDesc) = "bdpt"
            [knows_media, knows_subsurface, makes_parts, samples_light_paths, connected: CAUSTICS],
        /// Metropolis light transport in primary sample space.
        Mlt(MltDesc) = "mlt" [knows_media, knows_subsurface, connected: CAUSTICS],
        /// Photon mapping with a caustic and a global map.
        PhotonMapping(PhotonMappingDesc) = "photon-mapping" | "photonmapping"
            [knows_media, knows_subsurface, stores_photons],
        /// Stochastic progressive photon mapping.
        Sppm(SppmDesc) = "sppm" [knows_media, knows_subsurface, stores_photons],
        /// Vertex connection and merging.
        Vcm(VcmDesc) = "vcm" [
            knows_media, knows_subsurface, makes_parts, samples_light_paths, stores_photons,
            connected: Connected::Some("photons take their place")
        ],
        /// Radiosity by progressive shooting.
        Radiosity(RadiosityDesc) = "radiosity" [],
        /// Path tracing through participating media, without next-event estimation.
        SimpleVolPath(SimpleVolPathDesc) = "simple-vol-path" | "simplevolpath"
            [knows_media, knows_subsurface, estimates_pixels, makes_parts],
        /// The integral of an analytic function over the unit square instead of a scene, for the
        /// study of samplers.
        // Path tracing takes the place of functions.
        Function(FunctionDesc) = "function" [knows_subsurface],
    }
}

impl IntegratorDesc {
    /// The names of the algorithms with some fact, as a list in a sentence.
    pub fn names_with(fact: impl Fn(&IntegratorFacts) -> bool) -> String {
        let members = Self::members().into_iter().filter(|desc| fact(desc.facts()));
        let names: Vec<_> = members.map(|desc| format!("`{}`", desc.name())).collect();
        match names.split_last() {
            Some((last, others)) if !others.is_empty() => format!("{} and {last}", others.join(", ")),
            _ => names.concat(),
        }
    }

    /// Samples per pixel: for Metropolis, mutations; else those for which the sampler arranges its
    /// points.
    pub fn samples_per_pixel(&self, sampler: &SamplerKind) -> u32 {
        match self {
            Self::Mlt(mlt) => mlt.mutations_per_pixel.max(1),
            _ => sampler.arranged_samples(),
        }
    }

    /// Sets the samples per pixel that are not the sampler's.
    pub fn set_samples_per_pixel(&mut self, samples: u32) {
        if let Self::Mlt(mlt) = self {
            mlt.mutations_per_pixel = samples;
        }
    }

    /// The seed of what it draws beside the numbers of its samplers, if it has a setting for that.
    pub fn seed_mut(&mut self) -> Option<&mut Option<i32>> {
        match self {
            Self::Sppm(sppm) => Some(&mut sppm.seed),
            _ => None,
        }
    }

    /// The files that it writes beside the picture.
    pub fn files(&self) -> Vec<String> {
        match self {
            Self::Radiosity(radiosity) => radiosity.mesh_out.iter().cloned().collect(),
            Self::Function(function) => {
                std::iter::once(function.error_file()).chain(function.image_filename.clone()).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Turns off outputs other than the picture; returns whether there were any.
    pub fn remove_extra_outputs(&mut self) -> bool {
        match self {
            Self::Bdpt(BdptDesc { visualize_strategies, visualize_weights, .. }) => {
                std::mem::take(visualize_strategies) | std::mem::take(visualize_weights)
            }
            Self::Radiosity(radiosity) => radiosity.mesh_out.take().is_some(),
            _ => false,
        }
    }
}

choices! {
    /// Where the light of mirror reflections is from.
    pub enum ReflectionsDesc {
        /// Traced rays.
        #[default]
        Traced = "traced",
        /// A picture of the surroundings of the reflecting object from its place.
        Environment = "environment",
        /// Traced rays nearby, that picture far away.
        Hybrid = "hybrid",
    }
}

settings! {
    /// Settings of Whitted's ray tracing.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct WhittedDesc {
        /// Maximum number of scattering events of a path.
        max_depth: u32 = 5 => ["maxdepth"];
        /// Light of a sky of one colour reaches all surfaces, as if nothing were in between: no
        /// rays look for its shadows.
        ambient: bool = false => ["ambient"];
        /// Where the light of mirror reflections is from.
        reflections: ReflectionsDesc = ReflectionsDesc::Traced => ["reflections"];
        /// With `hybrid`, the distance from which on the picture is used; from half of it on it is
        /// blended in. If absent, a quarter of the scene's radius.
        reflection_distance: Option<f32> = None => ["reflectiondistance": above(0.0).unit("scene units")];
        /// Resolution of the picture of an object's surroundings along an edge.
        reflection_resolution: u32 = 256 => ["reflectionresolution": from(2.0, 4096.0).unit("pixels")];
    }
}

settings! {
    /// Settings of ambient occlusion.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct AmbientOcclusionDesc {
        /// Sample directions by the cosine (less noise) instead of uniformly.
        cos_sample: bool = true => ["cossample"];
        /// Surfaces farther away than this do not occlude.
        max_distance: f32 = f32::INFINITY
            => ["maxdistance": above(0.0).at_most(f64::INFINITY).unit("scene units")];
    }
}

settings! {
    /// Settings of the random walk.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct RandomWalkDesc {
        /// Maximum number of scattering events of a path.
        max_depth: u32 = 5 => ["maxdepth"];
    }
}

settings! {
    /// Settings of the simple path tracer.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct SimplePathDesc {
        /// Maximum number of scattering events of a path.
        max_depth: u32 = 5 => ["maxdepth"];
        /// Sample lights at each vertex.
        sample_lights: bool = true => ["samplelights"];
        /// Sample directions from the BSDF instead of uniformly.
        sample_bsdf: bool = true => ["samplebsdf"];
    }
}

choices! {
    /// How a light is chosen among many.
    pub enum LightSamplerDesc {
        /// With equal probability.
        Uniform = "uniform",
        /// By power.
        Power = "power",
        /// By a tree of bounds on emission.
        #[default]
        Bvh = "bvh",
        /// By a bound on what each light contributes, evaluated for all of them.
        Exhaustive = "exhaustive",
    }
}

settings! {
    /// Settings of path tracing.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct PathDesc {
        /// Maximum number of scattering events of a path.
        max_depth: u32 = 5 => ["maxdepth"];
        /// Roughen surfaces after the first bounce that is not specular.
        regularize: bool = false => ["regularize"];
        /// How a light is chosen for next-event estimation.
        light_sampler: LightSamplerDesc = LightSamplerDesc::Bvh => ["lightsampler"];
    }
}

settings! {
    /// Settings of the simple path tracer for media.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct SimpleVolPathDesc {
        /// Maximum number of scattering events of a path.
        max_depth: u32 = 5 => ["maxdepth"];
    }
}

settings! {
    /// Settings of light tracing.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct LightTracingDesc {
        /// Maximum number of scattering events of a path.
        max_depth: u32 = 5 => ["maxdepth"];
    }
}

settings! {
    /// Settings of bidirectional path tracing.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct BdptDesc {
        /// Maximum number of scattering events of a path.
        max_depth: u32 = 5 => ["maxdepth"];
        /// Roughen surfaces after the first bounce that is not specular.
        regularize: bool = false => ["regularize"];
        /// Write a picture of each strategy of up to 8 scattering events. All of them take 2.4 KiB
        /// per pixel at a depth of 5.
        visualize_strategies: bool = false => ["visualizestrategies" | "techniques"];
        /// Write a weighted picture of each strategy of up to 8 scattering events.
        visualize_weights: bool = false => ["visualizeweights" | "techniques"];
    }
}

choices! {
    /// The path space that Metropolis light transport explores.
    pub enum MltTechnique {
        /// Path tracing.
        Path = "path",
        /// Bidirectional path tracing, one strategy at a time.
        #[default]
        Bdpt = "bdpt",
    }
}

settings! {
    /// Settings of Metropolis light transport.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct MltDesc {
        /// The sampling technique whose paths the chains mutate.
        technique: MltTechnique = MltTechnique::Bdpt => ["technique"];
        /// Maximum number of scattering events of a path.
        max_depth: u32 = 5 => ["maxdepth"];
        /// Maximum number of candidate paths for the starts of the chains of a pass.
        bootstrap_samples: u32 = 100_000 => ["bootstrapsamples": at_least(1.0)];
        /// Maximum number of Markov chains of a pass, which has as many mutations as there are
        /// pixels.
        chains: u32 = 1000 => ["chains": at_least(1.0)];
        /// Mutations per pixel on average. `--spp` sets it, too.
        mutations_per_pixel: u32 = 100 => ["mutationsperpixel": at_least(1.0)];
        /// Probability of a large step: a mutation to an independent path.
        large_step_probability: f32 = 0.3 => ["largestepprobability": from(0.0, 1.0)];
        /// Standard deviation of a small step in the unit cube of random numbers.
        sigma: f32 = 0.01 => ["sigma": above(0.0)];
        /// Roughen surfaces after the first bounce that is not specular.
        regularize: bool = false => ["regularize"];
    }
}

choices! {
    /// How photons are weighted by their distance.
    pub enum PhotonKernel {
        /// Linear, zero at the maximum distance.
        Cone = "cone",
        /// Quadratic, zero at the maximum distance.
        #[default]
        Epanechnikov = "epanechnikov",
    }
}

choices! {
    /// The output of photon mapping.
    pub enum PhotonMappingShow {
        /// Radiance.
        #[default]
        Radiance = "radiance",
        /// The photons themselves, as dots.
        Photons = "photons",
    }
}

settings! {
    /// Settings of photon mapping.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct PhotonMappingDesc {
        /// Maximum number of scattering events of a path.
        max_depth: u32 = 5 => ["maxdepth"];
        /// Light paths for the global map in each pass.
        photons: u32 = 200_000 => ["photons"];
        /// Light paths for the caustic map in each pass.
        caustic_photons: u32 = 100_000 => ["causticphotons"];
        /// Maximum number of photons in an estimate, the nearest ones.
        nearest: u32 = 50 => ["nearest": at_least(1.0)];
        /// Maximum distance of photons in an estimate. If absent, a share of the scene's size.
        radius: Option<f32> = None => ["radius": above(0.0).unit("scene units")];
        /// How photons are weighted by their distance.
        kernel: PhotonKernel = PhotonKernel::Epanechnikov => ["kernel"];
        /// Rays of a final gather at the first diffuse surface. 0 is none.
        gather: u32 = 0 => ["gather"];
        /// What the picture shows.
        show: PhotonMappingShow = PhotonMappingShow::Radiance => ["show"];
    }
}

settings! {
    /// Settings of stochastic progressive photon mapping.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct SppmDesc {
        /// Maximum number of scattering events of a path.
        max_depth: u32 = 5 => ["maxdepth"];
        /// Light paths in each pass. If absent, as many as pixels.
        photons_per_iteration: Option<u32> = None => ["photonsperiteration" | "photons": at_least(1.0)];
        /// Maximum distance of photons in the first pass. If absent, 5/√n of the radius of a scene
        /// with n light paths, at most 0.05 of it (in pbrt-v4: 1).
        radius: Option<f32> = None => ["radius": above(0.0).unit("scene units")];
        /// Seed of the photons. If absent, that of the sampler.
        seed: Option<i32> = None => ["seed"];
    }
}

impl SppmDesc {
    /// The default radius of the first pass is this times that of the scene over √n, for n light
    /// paths in a pass. About thirty photons then lie within the radius of a point of a room, so
    /// that few points are black.
    const SPACING: f32 = 5.0;

    /// Limit on the default radius, as a fraction of that of the scene.
    const LARGEST_SHARE: f32 = 0.05;

    /// The α by which the radius shrinks.
    pub const ALPHA: f32 = 2.0 / 3.0;

    /// The number of light paths in each pass, for a picture of so many pixels.
    pub fn light_paths(&self, pixels: usize) -> usize {
        self.photons_per_iteration.map_or(pixels, |count| count as usize)
    }

    /// The radius of the first pass, with so many light paths in a scene of this radius.
    pub fn first_radius(&self, light_paths: usize, scene_radius: f32) -> f32 {
        let share = (Self::SPACING / (light_paths as f32).sqrt()).min(Self::LARGEST_SHARE);
        self.radius.unwrap_or(share * scene_radius)
    }
}

/// The radius within which photons are merged in a pass, counted from 0, given that of the first
/// pass: r²ₙ₊₁ = r²ₙ (n + α)/(n + 1) ([Knaus 2011]).
pub fn merging_radius(first: f32, alpha: f32, pass: u32) -> f32 {
    let alpha = f64::from(alpha);
    let shrunk: f64 = (1..=pass).map(|i| (f64::from(i) + alpha) / (f64::from(i) + 1.0)).product();
    (f64::from(first) * shrunk.sqrt()) as f32
}

settings! {
    /// Settings of vertex connection and merging.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct VcmDesc {
        /// Maximum number of scattering events of a path.
        max_depth: u32 = 5 => ["maxdepth"];
        /// The distance within which vertices are merged in the first pass. If absent, 0.003 of the
        /// scene's radius.
        radius: Option<f32> = None => ["radius": above(0.0).unit("scene units")];
        /// The α by which the radius shrinks: after i passes its square is about i^(α − 1) times
        /// the initial one.
        alpha: f32 = 0.75 => ["alpha": above(0.0).at_most(1.0)];
    }
}

choices! {
    /// How radiosity computes form factors.
    pub enum FormFactorsDesc {
        /// By the closed form for polygons, with rays for visibility.
        #[default]
        Analytic = "analytic",
        /// By a hemicube.
        Hemicube = "hemicube",
    }
}

settings! {
    /// Settings of radiosity.
    #[derive(Clone, Debug, PartialEq)]
    pub struct RadiosityDesc {
        /// Maximum number of scattering events of light.
        max_depth: u32 = 5 => ["maxdepth": from(0.0, 100.0)];
        /// How form factors are computed.
        form_factors: FormFactorsDesc = FormFactorsDesc::Analytic => ["formfactors"];
        /// Resolution of a hemicube along an edge.
        hemicube_resolution: u32 = 128 => ["hemicuberesolution": from(2.0, 1024.0).unit("pixels")];
        /// Longest side of a patch. If absent, a tenth of the scene's radius.
        patch_size: Option<f32> = None => ["patchsize": above(0.0).unit("scene units")];
        /// Maximum number of subdivisions of an element, into quarters.
        subdivision: u32 = 3 => ["subdivision": from(0.0, 10.0)];
        /// The relative change of radiosity across an element above which it is subdivided.
        gradient: f32 = 0.1 => ["gradient": above(0.0)];
        /// Maximum number of elements, which limits memory.
        max_patches: u32 = 50_000 => ["maxpatches": from(1.0, 1e6)];
        /// Share of the light that may remain unshot.
        tolerance: f32 = 0.002 => ["tolerance": between(0.0, 1.0)];
        /// Passes in which light is shot.
        steps: u32 = 8 => ["steps": at_least(1.0)];
        /// Rays of a final gather for each sample of a pixel. 0 interpolates the elements instead.
        gather: u32 = 0 => ["gather"];
        /// A PLY file for the elements with their radiosity as vertex colours.
        mesh_out: Option<String> = None => ["mesh-out": with_extension(".ply")];
    }
}

choices! {
    /// A function over the unit square, whose integral is 1.
    pub enum FunctionKind {
        /// 2 in the left half.
        #[default]
        Step = "step",
        /// 2 below the diagonal x + y = 1.
        Diagonal = "diagonal",
        /// 4/π in the disk that touches the sides.
        Disk = "disk",
        /// 2 in half of 10 × 10 squares.
        Checkerboard = "checkerboard",
        /// The squares of the same size, turned by 45° around the origin.
        RotatedCheckerboard = "rotatedcheckerboard",
        /// A Gaussian around the centre with the standard deviation 1/4.
        Gaussian = "gaussian",
    }
}

settings! {
    /// Settings of the integration of a function.
    #[derive(Clone, Debug, PartialEq)]
    pub struct FunctionDesc {
        /// The function.
        function: FunctionKind = FunctionKind::Step => ["function"];
        /// A text file for the mean square error of the pixels after each number of samples. If
        /// absent, the function's name with `-mse.txt`.
        filename: Option<String> = None => ["filename"];
        /// Leave out the error after numbers of samples that the sampler does not stratify.
        skip_bad: bool = true => ["skipbad"];
        /// A picture file for the function itself, at the film's resolution.
        image_filename: Option<String> = None => ["imagefilename"];
    }
}

impl FunctionDesc {
    /// The text file of the errors.
    pub fn error_file(&self) -> String {
        self.filename.clone().unwrap_or_else(|| format!("{}-mse.txt", self.function.to_value()))
    }
}
