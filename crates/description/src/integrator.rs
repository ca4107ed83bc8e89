//! Light transport algorithms and their settings. `max_depth` counts the edges of a path after the
//! camera's: 0 shows emission only, 1 adds direct light.

/// How a light is chosen among many.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LightSamplerDesc {
    /// All alike.
    Uniform,
    /// By power.
    Power,
    /// By a tree of bounds on emission.
    #[default]
    Bvh,
    /// Every light in turn.
    Exhaustive,
}

/// An algorithm with its settings.
#[derive(Clone, Debug, PartialEq)]
pub enum IntegratorDesc {
    /// Primary rays only; lights are added without shadows.
    RayCasting,
    /// Primary and shadow rays, mirror reflection and refraction.
    Whitted {
        /// Most reflections and refractions.
        max_depth: i32,
    },
    /// How much of the sky each point sees.
    AmbientOcclusion {
        /// Sample directions by the cosine instead of uniformly.
        cos_sample: bool,
        /// Hits farther than this do not count.
        max_distance: f32,
    },
    /// Paths that only find light by chance, directions uniform.
    RandomWalk {
        /// See above.
        max_depth: i32,
    },
    /// Paths that can be told what to sample.
    SimplePath {
        /// See above.
        max_depth: i32,
        /// Sample lights at each vertex.
        sample_lights: bool,
        /// Sample directions from the BSDF instead of uniformly.
        sample_bsdf: bool,
    },
    /// Paths with light sampling and multiple importance sampling.
    Path {
        /// See above.
        max_depth: i32,
        /// Roughen surfaces after the first non-specular bounce.
        regularize: bool,
        /// How lights are chosen.
        light_sampler: LightSamplerDesc,
    },
    /// Paths through media that only find light by chance.
    SimpleVolPath {
        /// See above.
        max_depth: i32,
    },
    /// `Path` with participating media: the format's default.
    VolPath {
        /// See above.
        max_depth: i32,
        /// Roughen surfaces after the first non-specular bounce.
        regularize: bool,
        /// How lights are chosen.
        light_sampler: LightSamplerDesc,
    },
    /// Paths from lights only.
    LightTracing {
        /// See above.
        max_depth: i32,
    },
    /// Bidirectional path tracing.
    Bdpt {
        /// See above.
        max_depth: i32,
        /// Roughen surfaces after the first non-specular bounce.
        regularize: bool,
        /// Write one image per strategy.
        visualize_strategies: bool,
        /// Write one image per strategy, weighted.
        visualize_weights: bool,
    },
    /// Metropolis light transport in primary sample space.
    Mlt(MltDesc),
    /// Photon maps.
    PhotonMapping(PhotonMappingDesc),
    /// Stochastic progressive photon mapping.
    Sppm(SppmDesc),
    /// Vertex connection and merging.
    Vcm(VcmDesc),
    /// Radiosity by progressive shooting.
    Radiosity(RadiosityDesc),
    /// Integrates an analytic function over the unit square instead of a scene: for the study of
    /// samplers.
    Function {
        /// The function's name.
        function: String,
        /// Leave sample counts out for which the sampler is not made.
        skip_bad: bool,
        /// A picture to integrate instead.
        image_filename: Option<String>,
    },
}

/// What Metropolis light transport asks for paths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MltTechnique {
    /// Path tracing.
    Path,
    /// Bidirectional path tracing, one strategy at a time.
    #[default]
    Bdpt,
}

/// Settings of Metropolis light transport.
#[derive(Clone, Debug, PartialEq)]
pub struct MltDesc {
    /// Where paths come from.
    pub technique: MltTechnique,
    /// Greatest depth of a path.
    pub max_depth: i32,
    /// Most samples among which the chains of a pass choose where to start.
    pub bootstrap_samples: i32,
    /// Most chains of a pass; it has as many mutations as there are pixels.
    pub chains: i32,
    /// Mutations per pixel on average.
    pub mutations_per_pixel: i32,
    /// Probability of a large step.
    pub large_step_probability: f32,
    /// Standard deviation of a small step.
    pub sigma: f32,
    /// Roughen surfaces after the first non-specular bounce.
    pub regularize: bool,
}

impl Default for MltDesc {
    fn default() -> Self {
        Self {
            technique: MltTechnique::default(),
            max_depth: 5,
            bootstrap_samples: 100_000,
            chains: 1000,
            mutations_per_pixel: 100,
            large_step_probability: 0.3,
            sigma: 0.01,
            regularize: false,
        }
    }
}

/// How photons near a point are weighed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PhotonKernel {
    /// Linearly to zero at the greatest distance.
    Cone,
    /// Quadratically to zero at the greatest distance.
    #[default]
    Epanechnikov,
}

/// What photon mapping shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PhotonMappingShow {
    /// Radiance.
    #[default]
    Radiance,
    /// The photons themselves, as dots.
    Photons,
}

/// Settings of photon mapping.
#[derive(Clone, Debug, PartialEq)]
pub struct PhotonMappingDesc {
    /// Greatest depth of a path.
    pub max_depth: i32,
    /// Photon paths for the global map, in each pass.
    pub photons: i32,
    /// Photon paths for the caustic map, in each pass.
    pub caustic_photons: i32,
    /// How many of the nearest photons make an estimate.
    pub nearest: i32,
    /// The farthest that a photon may be away, in world units; if absent, a share of the scene's
    /// size.
    pub radius: Option<f32>,
    /// How photons are weighed.
    pub kernel: PhotonKernel,
    /// Rays of a final gather at the first diffuse surface; 0 for none.
    pub gather: i32,
    /// What the picture shows.
    pub show: PhotonMappingShow,
}

impl Default for PhotonMappingDesc {
    fn default() -> Self {
        Self {
            max_depth: 5,
            photons: 200_000,
            caustic_photons: 100_000,
            nearest: 50,
            radius: None,
            kernel: PhotonKernel::default(),
            gather: 0,
            show: PhotonMappingShow::default(),
        }
    }
}

/// Settings of vertex connection and merging.
#[derive(Clone, Debug, PartialEq)]
pub struct VcmDesc {
    /// Greatest depth of a path.
    pub max_depth: i32,
    /// Distance within which vertices are merged in the first pass, in world units; if absent, a
    /// share of the scene's size.
    pub radius: Option<f32>,
    /// How slowly the radius shrinks, in (0, 1]: after i passes its square is about i^(α − 1) of
    /// what it was.
    pub alpha: f32,
}

impl Default for VcmDesc {
    fn default() -> Self {
        Self { max_depth: 5, radius: None, alpha: 0.75 }
    }
}

/// Settings of stochastic progressive photon mapping.
#[derive(Clone, Debug, PartialEq)]
pub struct SppmDesc {
    /// Greatest depth of a path.
    pub max_depth: i32,
    /// Photons per pass; as many as pixels if absent.
    pub photons_per_iteration: Option<i32>,
    /// First search radius in world units; if absent, a share of the scene's size (1 in pbrt-v4).
    pub radius: Option<f32>,
    /// Seed of the photons; the scene's if absent.
    pub seed: Option<i32>,
}

impl Default for SppmDesc {
    fn default() -> Self {
        Self { max_depth: 5, photons_per_iteration: None, radius: None, seed: None }
    }
}

/// How radiosity finds form factors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FormFactorsDesc {
    /// By the closed form for polygons, with rays for what lies between.
    #[default]
    Analytic,
    /// By a hemicube.
    Hemicube,
}

/// Settings of radiosity.
#[derive(Clone, Debug, PartialEq)]
pub struct RadiosityDesc {
    /// See above.
    pub max_depth: i32,
    /// How form factors are found.
    pub form_factors: FormFactorsDesc,
    /// Pixels along an edge of a hemicube.
    pub hemicube_resolution: i32,
    /// Longest side of a patch in scene units; a tenth of the scene's radius if absent.
    pub patch_size: Option<f32>,
    /// How often an element may be quartered.
    pub subdivision: i32,
    /// The change of light across an element, in parts of what is there, above which it is
    /// quartered.
    pub gradient: f32,
    /// Most elements.
    pub max_patches: i32,
    /// Share of light that need not be sent.
    pub tolerance: f32,
    /// Passes in which light is sent.
    pub steps: i32,
    /// Rays of a final gather for each sample of a pixel; 0 shows by interpolation instead.
    pub gather: i32,
    /// File for the elements with their radiosity as vertex colours.
    pub mesh_out: Option<String>,
}

impl Default for RadiosityDesc {
    fn default() -> Self {
        Self {
            max_depth: 5,
            form_factors: FormFactorsDesc::Analytic,
            hemicube_resolution: 128,
            patch_size: None,
            subdivision: 3,
            gradient: 0.1,
            max_patches: 50_000,
            tolerance: 0.002,
            steps: 8,
            gather: 0,
            mesh_out: None,
        }
    }
}

impl Default for IntegratorDesc {
    fn default() -> Self {
        Self::VolPath { max_depth: 5, regularize: false, light_sampler: LightSamplerDesc::Bvh }
    }
}
