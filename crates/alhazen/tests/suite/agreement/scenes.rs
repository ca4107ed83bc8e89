//! Small scenes, each with its own difficulty.

/// A scene as text, without film and algorithm.
pub struct Scene {
    pub name: &'static str,
    /// Most scattering events.
    pub max_depth: u32,
    /// Samples that path tracing needs to be a reference.
    pub path_samples: u32,
    /// Whether the camera looks into mirrors, through glass, or beyond the scene's bounds, where
    /// light paths cannot find it; or has lenses itself.
    pub is_hidden_from_light: bool,
    camera: &'static str,
    world: &'static str,
}

impl Scene {
    pub fn text(&self) -> String {
        format!(
            "{}\nFilm \"rgb\" \"integer xresolution\" 20 \"integer yresolution\" 20 \"bool savefp16\" false\n\
             PixelFilter \"box\" \"float xradius\" 0.5 \"float yradius\" 0.5\n\
             Sampler \"independent\" \"integer pixelsamples\" 1\nWorldBegin\n{}",
            self.camera, self.world
        )
    }
}

macro_rules! above {
    () => {
        "LookAt 0 -4 3  0 0 0.3  0 0 1 Camera \"perspective\" \"float fov\" 40"
    };
}

const IN_A_BOX: &str = "LookAt 0 -0.95 0  0 0 -0.1  0 0 1 Camera \"perspective\" \"float fov\" 80";
const ABOVE: &str = above!();

macro_rules! walls {
    () => {
        r#"
        Material "diffuse" "rgb reflectance" [0.7 0.7 0.7]
        Shape "bilinearmesh" "point3 P" [-1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1]
        Shape "bilinearmesh" "point3 P" [-1 1 -1  1 1 -1  -1 1 1  1 1 1]
        Shape "bilinearmesh" "point3 P" [-1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1]
        Shape "bilinearmesh" "point3 P" [-1 -1 1  1 -1 1  -1 1 1  1 1 1]
        Material "diffuse" "rgb reflectance" [0.6 0.1 0.1]
        Shape "bilinearmesh" "point3 P" [-1 -1 -1  -1 1 -1  -1 -1 1  -1 1 1]
        Material "diffuse" "rgb reflectance" [0.1 0.5 0.2]
        Shape "bilinearmesh" "point3 P" [1 -1 -1  1 1 -1  1 -1 1  1 1 1]
        "#
    };
}

macro_rules! ceiling_lamp {
    () => {
        r#"
        AttributeBegin AreaLightSource "diffuse" "rgb L" [8 7 6]
        Shape "bilinearmesh" "point3 P" [-0.3 -0.3 0.95  -0.3 0.3 0.95  0.3 -0.3 0.95  0.3 0.3 0.95]
        AttributeEnd
        "#
    };
}

macro_rules! floor {
    () => {
        r#"
        Material "diffuse" "rgb reflectance" [0.6 0.6 0.5]
        Shape "bilinearmesh" "point3 P" [-3 -3 0  3 -3 0  -3 3 0  3 3 0]
        "#
    };
}

pub const SCENES: [Scene; 21] = [
    Scene {
        name: "a diffuse box",
        max_depth: 4,
        path_samples: 16,
        is_hidden_from_light: false,
        camera: IN_A_BOX,
        world: concat!(
            walls!(),
            ceiling_lamp!(),
            r#"Material "diffuse" "rgb reflectance" [0.5 0.5 0.7]
            Translate 0.3 0.3 -0.6 Shape "sphere" "float radius" 0.4"#
        ),
    },
    Scene {
        name: "backs that the camera does not see",
        max_depth: 3,
        path_samples: 64,
        is_hidden_from_light: false,
        camera: ABOVE,
        world: concat!(
            floor!(),
            r#"AttributeBegin AreaLightSource "diffuse" "rgb L" [9 8 8] Translate 0.8 0.5 2.5 ReverseOrientation
            Shape "disk" "float radius" 0.4 AttributeEnd
            AttributeBegin AreaLightSource "diffuse" "rgb L" [3 5 8] Translate -0.6 -2 0.9
            Shape "sphere" "float radius" 0.2 AttributeEnd
            AttributeBegin AreaLightSource "diffuse" "rgb L" [6 2 1] "bool twosided" true
            Shape "bilinearmesh" "point3 P" [0.2 0.4 0.1  0.2 0.4 0.9  1 0.4 0.1  1 0.4 0.9] "bool singlesided" true
            AttributeEnd
            Material "diffuse" "rgb reflectance" [0.4 0.6 0.7]
            Shape "bilinearmesh" "point3 P" [-2 -1.2 0  -2 -1.2 1.8  2 -1.2 0  2 -1.2 1.8] "bool singlesided" true
            ObjectBegin "roof"
                Shape "trianglemesh" "point3 P" [0.3 0 1  1.3 0 1  1.3 0.8 1.2] "integer indices" [0 2 1]
                    "normal N" [0 0 1  0 0.1 1  0 0 1] "bool singlesided" true
                Shape "trianglemesh" "point3 P" [0.3 -0.7 0.5  1.3 -0.7 0.5  1.3 -0.1 0.7] "integer indices" [0 1 2]
                    "bool singlesided" true
            ObjectEnd
            Scale -1 1 1 ObjectInstance "roof""#
        ),
    },
    Scene {
        name: "a glossy box",
        max_depth: 3,
        path_samples: 32,
        is_hidden_from_light: false,
        camera: IN_A_BOX,
        world: concat!(
            walls!(),
            ceiling_lamp!(),
            r#"Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k" "float roughness" 0.4
            Shape "bilinearmesh" "point3 P" [-0.99 -1 -0.99  0.99 -1 -0.99  -0.99 0.9 -0.9  0.99 0.9 -0.9]
            Material "dielectric" "float roughness" 0.5
            Translate -0.3 0.2 -0.3 Shape "sphere" "float radius" 0.4"#
        ),
    },
    Scene {
        name: "the caustic of a glass ball",
        max_depth: 4,
        path_samples: 256,
        is_hidden_from_light: true,
        camera: ABOVE,
        world: concat!(
            floor!(),
            r#"Material "dielectric" AttributeBegin Translate 0 0 0.7 Shape "sphere" "float radius" 0.5 AttributeEnd
            AreaLightSource "diffuse" "rgb L" [10 10 10] Translate 0.8 0.5 2.5 ReverseOrientation
            Shape "disk" "float radius" 0.5"#
        ),
    },
    Scene {
        name: "a room of mirrors",
        max_depth: 5,
        path_samples: 64,
        is_hidden_from_light: true,
        camera: IN_A_BOX,
        world: concat!(
            walls!(),
            ceiling_lamp!(),
            r#"Material "conductor" "float roughness" 0
            Shape "bilinearmesh" "point3 P" [-0.9 0.95 -0.9  0.9 0.95 -0.9  -0.9 0.95 0.9  0.9 0.95 0.9]
            Shape "bilinearmesh" "point3 P" [0.95 -0.9 -0.9  0.95 0.9 -0.9  0.95 -0.9 0.9  0.95 0.9 0.9]
            Translate -0.3 0.2 -0.5 Shape "sphere" "float radius" 0.4"#
        ),
    },
    Scene {
        name: "many small lights",
        max_depth: 3,
        path_samples: 64,
        is_hidden_from_light: false,
        camera: ABOVE,
        world: concat!(
            floor!(),
            r#"Material "diffuse" Translate 0 0 0.3
            AreaLightSource "diffuse" "rgb L" [30 10 3] AttributeBegin Translate 0.9 0 0.2 Shape "sphere" "float radius" 0.05 AttributeEnd
            AreaLightSource "diffuse" "rgb L" [3 10 30] AttributeBegin Translate -0.9 0 0.5 Shape "sphere" "float radius" 0.1 AttributeEnd
            AreaLightSource "diffuse" "rgb L" [3 30 3] AttributeBegin Translate 0 0.9 0.3 Shape "cylinder" "float radius" 0.05 AttributeEnd
            AreaLightSource "diffuse" "rgb L" [20 20 20] AttributeBegin Translate 0 -0.9 0.1 Rotate 40 1 0 0 Shape "disk" "float radius" 0.2 AttributeEnd
            AreaLightSource "diffuse" "rgb L" [9 2 9] "bool twosided" true AttributeBegin Translate 0 0 0.8 Rotate 90 1 0 0 Shape "disk" "float radius" 0.2 AttributeEnd
            LightSource "point" "point3 from" [1.5 1.5 1] "rgb I" [0.2 0.3 0.4]
            LightSource "spot" "point3 from" [-1.5 1.5 1] "point3 to" [0 0 0] "float coneangle" 25 "rgb I" [3 1 1]"#
        ),
    },
    Scene {
        name: "a sky and a sun",
        max_depth: 3,
        path_samples: 32,
        is_hidden_from_light: false,
        camera: ABOVE,
        world: concat!(
            floor!(),
            r#"LightSource "infinite" "rgb L" [0.3 0.4 0.6]
            LightSource "distant" "point3 from" [1 -1 2] "point3 to" [0 0 0] "rgb L" [1 0.9 0.7]
            Material "diffuse" "rgb reflectance" [0.8 0.3 0.3]
            Translate 0 0 0.5 Shape "sphere" "float radius" 0.5"#
        ),
    },
    Scene {
        name: "light through a portal",
        max_depth: 3,
        path_samples: 32,
        is_hidden_from_light: false,
        camera: ABOVE,
        world: concat!(
            floor!(),
            r#"LightSource "infinite" "rgb L" [6 7 9]
            "point3 portal" [-0.5 -0.4 1.8  -0.5 0.6 1.8  0.7 0.6 1.8  0.7 -0.4 1.8]
            Material "diffuse" "rgb reflectance" [0.8 0.3 0.3]
            AttributeBegin Translate 0.3 0 0.5 Shape "sphere" "float radius" 0.5 AttributeEnd
            # Beyond the portal, half before it.
            Translate -0.4 0.1 2.2 Shape "sphere" "float radius" 0.3"#
        ),
    },
    Scene {
        name: "a luminaire and a slide",
        max_depth: 3,
        path_samples: 32,
        is_hidden_from_light: false,
        camera: ABOVE,
        world: concat!(
            floor!(),
            r#"AttributeBegin Translate 0 0 2 Rotate 90 1 0 0
            LightSource "goniometric" "float scale" 0.004 "string filename" ""#,
            concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/assets/petals.ies"),
            r#"" AttributeEnd
            AttributeBegin Translate 0.3 -0.2 2.5 Rotate 170 1 0.3 0
            LightSource "projection" "float fov" 50 "float scale" 12 "string filename" ""#,
            concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/assets/leaf.png"),
            r#"" AttributeEnd
            Material "diffuse" "rgb reflectance" [0.8 0.3 0.3]
            Translate 0.3 0 0.5 Shape "sphere" "float radius" 0.5"#
        ),
    },
    Scene {
        name: "a door that is almost closed",
        max_depth: 4,
        path_samples: 512,
        is_hidden_from_light: false,
        camera: IN_A_BOX,
        world: concat!(
            walls!(),
            r#"Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
            Shape "bilinearmesh" "point3 P" [0.2 0.1 -1  0.2 1 -1  0.2 0.1 1  0.2 1 1]
            Shape "bilinearmesh" "point3 P" [0.2 0.1 -1  0.85 0.1 -1  0.2 0.1 1  0.85 0.1 1]
            AreaLightSource "diffuse" "rgb L" [60 60 50]
            Shape "bilinearmesh" "point3 P" [0.4 0.5 0.5  0.4 0.9 0.5  0.8 0.5 0.5  0.8 0.9 0.5]"#
        ),
    },
    Scene {
        name: "a thin lens",
        max_depth: 2,
        path_samples: 64,
        is_hidden_from_light: false,
        camera: "LookAt 0 -4 3  0 0 0.3  0 0 1\n\
            Camera \"perspective\" \"float fov\" 40 \"float lensradius\" 0.3 \"float focaldistance\" 4",
        world: concat!(
            floor!(),
            r#"LightSource "point" "point3 from" [1 1 2] "rgb I" [3 3 2]
            AttributeBegin Translate 0 -1.5 0.3 Shape "sphere" "float radius" 0.3 AttributeEnd
            AreaLightSource "diffuse" "rgb L" [5 5 9] Translate 0.5 1.5 0.5 Shape "sphere" "float radius" 0.3"#
        ),
    },
    Scene {
        name: "a system of lenses",
        max_depth: 2,
        path_samples: 64,
        is_hidden_from_light: true,
        camera: concat!(
            "LookAt 0 -4 3  0 0 0.3  0 0 1\nCamera \"realistic\" \"string lensfile\" \"",
            env!("CARGO_MANIFEST_DIR"),
            "/../../scenes/assets/triplet.dat\" \"float aperturediameter\" 9 \"float focusdistance\" 4",
        ),
        world: concat!(
            floor!(),
            r#"LightSource "point" "point3 from" [1 1 2] "rgb I" [3 3 2]
            AttributeBegin Translate 0 -0.5 0.3 Shape "sphere" "float radius" 0.3 AttributeEnd
            AreaLightSource "diffuse" "rgb L" [5 5 9] Translate 0.2 0.7 0.5 Shape "sphere" "float radius" 0.3"#
        ),
    },
    Scene {
        name: "a prism",
        max_depth: 4,
        path_samples: 256,
        is_hidden_from_light: true,
        camera: ABOVE,
        world: concat!(
            floor!(),
            r#"AttributeBegin Material "dielectric" "spectrum eta" "glass-F11" Translate 0 0 0.7
            Shape "sphere" "float radius" 0.5 AttributeEnd
            AreaLightSource "diffuse" "rgb L" [10 10 10] Translate 0.8 0.5 2.5 ReverseOrientation
            Shape "disk" "float radius" 0.6"#
        ),
    },
    Scene {
        name: "parallel rays",
        max_depth: 3,
        path_samples: 16,
        is_hidden_from_light: false,
        camera: "LookAt 0 -4 3  0 0 0.3  0 0 1 Camera \"orthographic\" \"float screenwindow\" [-1.5 1.5 -1.5 1.5]",
        world: concat!(
            floor!(),
            r#"Translate 0 0 0.5 Shape "sphere" "float radius" 0.5
            AreaLightSource "diffuse" "rgb L" [5 5 9] Translate 0.8 0 0.6 Shape "sphere" "float radius" 0.2"#
        ),
    },
    Scene {
        name: "all around",
        max_depth: 2,
        path_samples: 32,
        is_hidden_from_light: false,
        camera: "LookAt 0 0 0  0 1 0  0 0 1 Camera \"spherical\" \"string mapping\" \"equirectangular\"",
        world: concat!(walls!(), ceiling_lamp!()),
    },
    Scene {
        name: "motion",
        max_depth: 3,
        path_samples: 32,
        is_hidden_from_light: false,
        camera: "TransformTimes 0 1 LookAt 0 -4 3  0 0 0.3  0 0 1\n\
            Camera \"perspective\" \"float fov\" 40 \"float shutteropen\" 0 \"float shutterclose\" 1",
        world: concat!(
            floor!(),
            r#"AttributeBegin AreaLightSource "diffuse" "rgb L" [5 5 9]
            Translate 0.8 0.6 1.6 Shape "sphere" "float radius" 0.2 AttributeEnd
            Material "diffuse" ActiveTransform EndTime Translate 1 0 0.5 ActiveTransform All
            Translate -0.5 0 0.5 Shape "sphere" "float radius" 0.4"#
        ),
    },
    Scene {
        name: "bent normals",
        max_depth: 3,
        path_samples: 64,
        is_hidden_from_light: false,
        camera: ABOVE,
        world: concat!(
            floor!(),
            r#"Material "diffuse" "rgb reflectance" [0.8 0.8 0.8]
            Shape "trianglemesh" "point3 P" [-1 -1 0.2  1 -1 0.2  1 1 0.2  -1 1 0.2]
            "normal N" [-0.5 -0.5 1  0.5 -0.5 1  0.5 0.5 1  -0.5 0.5 1] "integer indices" [0 1 2 0 2 3]
            AreaLightSource "diffuse" "rgb L" [10 10 10] Translate 0.8 0.5 1.5 ReverseOrientation
            Shape "disk" "float radius" 0.4"#
        ),
    },
    Scene {
        name: "a pool",
        max_depth: 5,
        path_samples: 256,
        is_hidden_from_light: true,
        camera: ABOVE,
        world: concat!(
            floor!(),
            r#"AttributeBegin Material "dielectric" "float eta" 1.33
            Shape "bilinearmesh" "point3 P" [-1 -1 0.5  1 -1 0.5  -1 1 0.5  1 1 0.5] AttributeEnd
            AreaLightSource "diffuse" "rgb L" [4 4 4] Translate 0.8 0.5 2.5 ReverseOrientation
            Shape "disk" "float radius" 1"#
        ),
    },
    Scene {
        name: "interfaces and cut out surfaces",
        max_depth: 3,
        path_samples: 64,
        is_hidden_from_light: false,
        camera: ABOVE,
        world: concat!(
            floor!(),
            r#"AttributeBegin Material "interface" Translate 0 0 1 Shape "sphere" "float radius" 0.9 AttributeEnd
            AttributeBegin Translate 0 0 1 Shape "disk" "float alpha" 0.5 "float radius" 0.8 AttributeEnd
            LightSource "point" "point3 from" [-0.9 -0.9 2] "rgb I" [2 2 4]
            AreaLightSource "diffuse" "rgb L" [10 10 10] Translate 0.3 0.2 1.5 ReverseOrientation
            Shape "disk" "float radius" 0.3"#
        ),
    },
    Scene {
        name: "a wall on a plane without end",
        max_depth: 1,
        path_samples: 16,
        is_hidden_from_light: false,
        camera: "LookAt 0 -9 4  0 0 0.7  0 0 1 Camera \"perspective\" \"float fov\" 60",
        world: r#"LightSource "infinite" "rgb L" [0.35 0.42 0.55]
            Material "diffuse" "rgb reflectance" [0.5 0.5 0.5] Shape "plane"
            Shape "bilinearmesh" "point3 P" [-8 2 0  8 2 0  -8 2 9  8 2 9]
            Shape "sphere" "float radius" 1"#,
    },
    Scene {
        name: "a plane without end",
        max_depth: 2,
        path_samples: 32,
        is_hidden_from_light: true,
        camera: ABOVE,
        world: r#"LightSource "infinite" "rgb L" [0.3 0.4 0.6]
            LightSource "distant" "point3 from" [1 -1 2] "point3 to" [0 0 0] "rgb L" [1 0.9 0.7]
            Material "diffuse" "rgb reflectance" [0.6 0.6 0.5] Shape "plane"
            Shape "bilinearmesh" "point3 P" [-1 0.8 0  1 0.8 0  -1 0.8 1  1 0.8 1]
            Material "diffuse" "rgb reflectance" [0.8 0.3 0.3]
            Translate 0.3 0 0.2 Shape "sphere" "float radius" 0.5"#,
    },
];

/// Scenes with participating media.
pub const MEDIA: [Scene; 8] = [
    Scene {
        name: "a lamp in fog",
        max_depth: 6,
        path_samples: 32,
        is_hidden_from_light: false,
        camera: concat!(
            r#"MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0.05 0.1 0.2]
            "rgb sigma_s" [0.4 0.3 0.2] "float g" 0.4 MediumInterface "" "fog" "#,
            above!()
        ),
        world: concat!(
            r#"MediumInterface "fog" "fog" "#,
            floor!(),
            r#"AttributeBegin AreaLightSource "diffuse" "rgb L" [8 8 8] Translate 0.3 0.2 1.5
            Shape "sphere" "float radius" 0.2 AttributeEnd
            LightSource "point" "point3 from" [-0.9 -0.9 2] "rgb I" [2 2 4]
            Material "diffuse" Translate -0.5 0 0.4 Shape "sphere" "float radius" 0.4"#
        ),
    },
    Scene {
        name: "a cloud",
        max_depth: 6,
        path_samples: 32,
        is_hidden_from_light: false,
        camera: ABOVE,
        world: concat!(
            floor!(),
            r#"LightSource "distant" "point3 from" [1 -1 2] "point3 to" [0 0 0] "rgb L" [2 1.8 1.5]
            LightSource "infinite" "rgb L" [0.3 0.4 0.6]
            AttributeBegin Translate -1 1 0.2 Rotate 90 1 0 0 Scale 2 1 2
            MakeNamedMedium "cloud" "string type" "cloud" "rgb sigma_a" [0.2 0.4 0.8] "rgb sigma_s" [4 4 4]
            "float density" 3 "float g" 0.5 AttributeEnd
            MediumInterface "cloud" "" Material "interface" Translate 0 0 0.8 Shape "sphere" "float radius" 0.75"#
        ),
    },
    Scene {
        name: "smoke that glows",
        max_depth: 4,
        path_samples: 64,
        is_hidden_from_light: false,
        camera: ABOVE,
        world: concat!(
            floor!(),
            r#"LightSource "infinite" "rgb L" [0.1 0.1 0.1]
            AttributeBegin Translate -0.6 -0.6 0 Scale 1.2 1.2 1.5
            MakeNamedMedium "smoke" "string type" "uniformgrid" "integer nx" 2 "integer ny" 2 "integer nz" 4
            "float density" [1 2 2 1 2 4 3 2 4 3 2 4 1 0 0 2] "rgb sigma_a" [1 1.2 2] "rgb sigma_s" [1 0.8 0.5]
            "rgb Le" [3 1.5 0.5] "float Lescale" [1 1 2 2 1 1 0 0 0 0 0.5 1 1 0 0 0.2] AttributeEnd
            MediumInterface "smoke" "" Material "interface" Translate 0 0 0.8 Shape "sphere" "float radius" 0.75"#
        ),
    },
    Scene {
        name: "a coloured liquid",
        max_depth: 6,
        path_samples: 128,
        is_hidden_from_light: true,
        camera: ABOVE,
        world: concat!(
            floor!(),
            r#"LightSource "infinite" "rgb L" [1 1 1]
            MakeNamedMedium "juice" "string type" "homogeneous" "rgb sigma_a" [0.2 1 3] "rgb sigma_s" [0.6 0.3 0.1]
            MediumInterface "juice" "" Material "dielectric" "float eta" 1.33 Translate 0 0 0.7
            Shape "sphere" "float radius" 0.7"#
        ),
    },
    Scene {
        name: "a caustic in fog",
        max_depth: 5,
        path_samples: 512,
        is_hidden_from_light: true,
        camera: concat!(
            r#"MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0.05 0.05 0.05]
            "rgb sigma_s" [0.4 0.4 0.4] MediumInterface "" "fog" "#,
            above!()
        ),
        world: concat!(
            r#"MediumInterface "fog" "fog" "#,
            floor!(),
            r#"AttributeBegin AreaLightSource "diffuse" "rgb L" [8 8 8] Translate 0 0 2.6 ReverseOrientation
            Shape "disk" "float radius" 0.5 AttributeEnd
            MediumInterface "" "fog" Material "dielectric" Translate 0 0 1.3 Shape "sphere" "float radius" 0.5"#
        ),
    },
    Scene {
        name: "a translucent slab",
        max_depth: 12,
        path_samples: 64,
        is_hidden_from_light: true,
        camera: ABOVE,
        world: concat!(
            floor!(),
            r#"LightSource "infinite" "rgb L" [0.6 0.6 0.6]
            MakeNamedMedium "wax" "string type" "homogeneous" "rgb sigma_a" [0.05 0.2 0.5] "rgb sigma_s" [8 6 4]
            MediumInterface "wax" "" Material "dielectric" "float roughness" 0.3 "float eta" 1.3
            Translate 0 0 0.5 Scale 1 1 0.3 Shape "sphere" "float radius" 1"#
        ),
    },
    Scene {
        name: "a camera in a dense medium",
        max_depth: 8,
        path_samples: 64,
        is_hidden_from_light: false,
        camera: r#"Translate 0 0 1 MakeNamedMedium "grid" "string type" "rgbgrid" "point3 p0" [-2 -2 -2]
            "point3 p1" [2 2 2] "integer nx" 2 "integer ny" 1 "integer nz" 1 "rgb sigma_a" [0.1 0.1 0.3 0.4 0.1 0.1]
            "rgb sigma_s" [2 1 0.5 0.5 1 2] Identity
            MediumInterface "" "grid" LookAt 0 -0.9 1  0 0 1  0 0 1 Camera "perspective" "float fov" 80"#,
        world: concat!(
            r#"MediumInterface "grid" "grid" "#,
            floor!(),
            r#"AttributeBegin AreaLightSource "diffuse" "rgb L" [6 6 6] Translate 0.3 0.6 1.5
            Shape "sphere" "float radius" 0.3 AttributeEnd
            LightSource "infinite" "rgb L" [0.2 0.3 0.5]"#
        ),
    },
    Scene {
        name: "a liquid in glass",
        max_depth: 8,
        path_samples: 256,
        is_hidden_from_light: true,
        camera: ABOVE,
        world: concat!(
            floor!(),
            r#"LightSource "infinite" "rgb L" [1 1 1]
            MakeNamedMedium "milk" "string type" "homogeneous" "rgb sigma_a" [0.1 0.2 0.4] "rgb sigma_s" [3 3 2]
            MakeNamedMedium "tint" "string type" "homogeneous" "rgb sigma_a" [0.5 0.2 0.4] "rgb sigma_s" [0 0 0]
            Translate 0 0 0.8 MediumInterface "tint" "" Material "dielectric" "float eta" 1.5
            Shape "sphere" "float radius" 0.8
            MediumInterface "milk" "tint" Material "dielectric" "float eta" 0.9 Shape "sphere" "float radius" 0.6"#
        ),
    },
];

/// A scene whose light only light paths find.
pub const POINT_LIGHT_IN_GLASS: Scene = Scene {
    name: "a point light in glass",
    max_depth: 5,
    path_samples: 0,
    is_hidden_from_light: false,
    camera: ABOVE,
    world: concat!(
        floor!(),
        r#"LightSource "point" "point3 from" [0.1 0.5 3.2] "rgb I" [9 8 7]
        AttributeBegin Material "dielectric" Translate 0 0.5 3.2 Shape "sphere" "float radius" 0.4 AttributeEnd
        Material "diffuse" Translate 0 0 0.5 Shape "sphere" "float radius" 0.4"#
    ),
};
