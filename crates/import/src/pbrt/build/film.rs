//! Options, film, filter and accelerator.

use description::{
    AcceleratorDesc, BuildQualityDesc, BvhSplit, Diagnostic, FilmDesc, FilmKind, FilterDesc, GBufferSpace,
    OptionsDesc, RenderSpace, SensorDesc, Span, Spanned, Stated,
};

use super::Builder;
use crate::pbrt::reader::Reader;
use crate::pbrt::statement::{Statement, Statements};

const SENSORS: [&str; 18] = [
    "cie1931",
    "canon_eos_100d",
    "canon_eos_1dx_mkii",
    "canon_eos_200d_mkii",
    "canon_eos_200d",
    "canon_eos_5d",
    "canon_eos_5d_mkii",
    "canon_eos_5d_mkiii",
    "canon_eos_5d_mkiv",
    "canon_eos_5ds",
    "canon_eos_m",
    "hasselblad_l1d_20c",
    "nikon_d810",
    "nikon_d850",
    "sony_ilce_6400",
    "sony_ilce_7m3",
    "sony_ilce_7rm3",
    "sony_ilce_9",
];

impl Builder<'_> {
    /// All `Option` statements, read as the parameters of one.
    pub(super) fn options(&mut self, statements: &mut Statements) -> Stated<OptionsDesc> {
        let parameters = std::mem::take(&mut statements.options);
        let span = parameters.first().map_or(Span::NONE, |first| first.span);
        let kind = Spanned::new("Option".to_owned(), span);
        let statement = Statement {
            span,
            kind,
            parameters,
            defaults: Default::default(),
            color_space: Default::default(),
        };
        let string = |reader: &mut Reader, name| reader.string(name).map(|path| path.value);
        self.read_or_default(statement, |reader| {
            Some(OptionsDesc {
                disable_pixel_jitter: reader.boolean("disablepixeljitter", false),
                disable_texture_filtering: reader.boolean("disabletexturefiltering", false),
                disable_wavelength_jitter: reader.boolean("disablewavelengthjitter", false),
                displacement_edge_scale: reader.positive("displacementedgescale", 1.0),
                force_diffuse: reader.boolean("forcediffuse", false),
                mse_reference_image: string(reader, "msereferenceimage"),
                mse_reference_out: string(reader, "msereferenceout"),
                pixel_stats: reader.boolean("pixelstats", false),
                render_space: reader.choice(
                    "rendercoordsys",
                    RenderSpace::CameraWorld,
                    &[
                        ("camera", RenderSpace::Camera),
                        ("cameraworld", RenderSpace::CameraWorld),
                        ("world", RenderSpace::World),
                    ],
                ),
                seed: reader.optional_integer("seed").unwrap_or(0),
                wavefront: reader.boolean("wavefront", false),
            })
        })
    }

    pub(super) fn film(&mut self, statement: Statement) -> Stated<FilmDesc> {
        self.read_or_default(statement, film)
    }

    pub(super) fn filter(&mut self, statement: Statement) -> Stated<FilterDesc> {
        self.read_or_default(statement, filter)
    }

    pub(super) fn accelerator(&mut self, statement: Statement) -> Stated<AcceleratorDesc> {
        self.read_or_default(statement, accelerator)
    }
}

fn film(reader: &mut Reader) -> Option<FilmDesc> {
    let default = FilmDesc::default();
    let kind = match reader.kind.value.as_str() {
        "rgb" => FilmKind::Rgb,
        "gbuffer" => FilmKind::GBuffer {
            space: reader.choice(
                "coordinatesystem",
                GBufferSpace::Camera,
                &[("camera", GBufferSpace::Camera), ("world", GBufferSpace::World)],
            ),
        },
        "spectral" => FilmKind::Spectral {
            buckets: reader.integer("nbuckets", 16, 1..=100_000),
            lambda_min: reader.positive("lambdamin", 360.0),
            lambda_max: reader.positive("lambdamax", 830.0),
        },
        _ => {
            reader.unknown_type("film", "film", &["rgb", "gbuffer", "spectral"]);
            return None;
        }
    };
    if let FilmKind::Spectral { lambda_min, lambda_max, .. } = kind
        && lambda_min >= lambda_max
    {
        reader.refuse("lambdamax", "`lambdamax` must be above `lambdamin`");
    }
    let resolution = [
        reader.integer("xresolution", default.resolution[0], 1..=1_000_000),
        reader.integer("yresolution", default.resolution[1], 1..=1_000_000),
    ];
    let pixel_bounds = reader.integer_array::<4>("pixelbounds");
    let crop_window = reader
        .float_array::<4>("cropwindow")
        .map(|[x0, x1, y0, y1]| [x0.min(x1), x0.max(x1), y0.min(y1), y0.max(y1)]);
    if pixel_bounds.is_some() && crop_window.is_some() {
        reader.ignored("pixelbounds", "`pixelbounds` has no effect beside `cropwindow`");
    }
    if let Some([x0, x1, y0, y1]) = pixel_bounds
        && (x0.max(0) >= x1.min(resolution[0]) || y0.max(0) >= y1.min(resolution[1]))
    {
        reader.refuse("pixelbounds", "`pixelbounds` (x0, x1, y0, y1) holds no pixel of the image");
    }
    if let Some([x0, x1, y0, y1]) = crop_window
        && (x0.max(0.0) >= x1.min(1.0) || y0.max(0.0) >= y1.min(1.0))
    {
        reader.refuse("cropwindow", "`cropwindow` (x0, x1, y0, y1) holds nothing of the image");
    }
    Some(FilmDesc {
        kind,
        resolution,
        pixel_bounds,
        crop_window,
        diagonal: reader.positive("diagonal", default.diagonal),
        filename: reader.string("filename").unwrap_or(default.filename),
        save_fp16: reader.boolean("savefp16", default.save_fp16),
        max_component_value: reader
            .optional_float("maxcomponentvalue")
            .unwrap_or(default.max_component_value),
        sensor: sensor(reader),
        color_space: reader.color_space,
        layers: reader.strings("layers").unwrap_or_default(),
    })
}

fn sensor(reader: &mut Reader) -> SensorDesc {
    let default = SensorDesc::default();
    let name = reader.string("sensor").unwrap_or(default.name);
    if !SENSORS.contains(&name.value.as_str()) {
        let message = format!("there is no sensor `{}`", name.value);
        reader.builder.report.push(Diagnostic {
            help: crate::suggest::did_you_mean(&name.value, SENSORS),
            ..Diagnostic::error("unknown-choice", message, name.span)
        });
    }
    SensorDesc {
        name,
        iso: reader.positive("iso", default.iso),
        white_balance: reader.float("whitebalance", default.white_balance),
    }
}

fn filter(reader: &mut Reader) -> Option<FilterDesc> {
    let radius = |reader: &mut Reader, default| {
        [reader.positive("xradius", default), reader.positive("yradius", default)]
    };
    Some(match reader.kind.value.as_str() {
        "box" => FilterDesc::Box { radius: radius(reader, 0.5) },
        "triangle" => FilterDesc::Triangle { radius: radius(reader, 2.0) },
        "gaussian" => {
            FilterDesc::Gaussian { radius: radius(reader, 1.5), sigma: reader.positive("sigma", 0.5) }
        }
        "mitchell" => FilterDesc::Mitchell {
            radius: radius(reader, 2.0),
            b: reader.float("B", 1.0 / 3.0),
            c: reader.float("C", 1.0 / 3.0),
        },
        "sinc" => FilterDesc::LanczosSinc { radius: radius(reader, 4.0), tau: reader.positive("tau", 3.0) },
        _ => {
            reader.unknown_type(
                "filter",
                "pixel filter",
                &["box", "triangle", "gaussian", "mitchell", "sinc"],
            );
            return None;
        }
    })
}

fn accelerator(reader: &mut Reader) -> Option<AcceleratorDesc> {
    Some(match reader.kind.value.as_str() {
        "bvh" => AcceleratorDesc::Bvh {
            max_node_prims: reader.integer("maxnodeprims", 4, 1..=255),
            split: reader.choice(
                "splitmethod",
                BvhSplit::Sah,
                &[
                    ("sah", BvhSplit::Sah),
                    ("hlbvh", BvhSplit::Hlbvh),
                    ("middle", BvhSplit::Middle),
                    ("equal", BvhSplit::Equal),
                ],
            ),
            quality: reader.choice(
                "quality",
                None,
                &[
                    ("fast", Some(BuildQualityDesc::Fast)),
                    ("balanced", Some(BuildQualityDesc::Balanced)),
                    ("high", Some(BuildQualityDesc::High)),
                ],
            ),
        },
        "kdtree" => AcceleratorDesc::KdTree {
            intersect_cost: reader.integer("intersectcost", 5, 0..=i32::MAX),
            traversal_cost: reader.integer("traversalcost", 1, 0..=i32::MAX),
            empty_bonus: reader.float("emptybonus", 0.5),
            max_prims: reader.integer("maxprims", 1, 1..=i32::MAX),
            max_depth: reader.integer("maxdepth", -1, -1..=i32::MAX),
        },
        "none" => AcceleratorDesc::None,
        _ => {
            reader.unknown_type("accelerator", "accelerator", &["bvh", "kdtree", "none"]);
            return None;
        }
    })
}
