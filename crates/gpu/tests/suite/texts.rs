//! Scenes whose pictures are compared.

/// Lights of all kinds that are drawn, meshes with normals and texture coordinates, instances,
/// rough and dispersive glass, and a thin lens.
pub const MEDLEY: &str = r#"
LookAt 0 2 6  0 0.8 0  0 1 0
Camera "orthographic" "float screenwindow" [ -3 3 -2.2 2.2 ] "float lensradius" 0.02 "float focaldistance" 6
Film "rgb"
PixelFilter "triangle"
WorldBegin
LightSource "point" "point3 from" [ 0 3 2 ] "rgb I" [ 6 5 4 ]
LightSource "spot" "point3 from" [ 2 4 2 ] "point3 to" [ 0 0 0 ] "blackbody I" 4000 "float scale" 20
LightSource "distant" "point3 from" [ 1 1 1 ] "rgb L" [ 0.5 0.6 0.7 ]
LightSource "infinite" "rgb L" [ 0.2 0.3 0.5 ]
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 9 7 4 ] "bool twosided" true
    Shape "trianglemesh" "point3 P" [ -2 3 -1  -1 3 -1  -1 3 0 ] "integer indices" [ 0 1 2 ]
    Translate -1.8 1.2 0.5
    Shape "sphere" "float radius" 0.2
AttributeEnd
Texture "squares" "spectrum" "checkerboard" "float uscale" 6 "float vscale" 6
    "rgb tex1" [ 0.8 0.7 0.6 ] "rgb tex2" [ 0.1 0.3 0.2 ]
Material "diffuse" "texture reflectance" "squares"
Shape "bilinearmesh" "point3 P" [ -4 0 -4  -4 0 4  4 0 -4  4 0 4 ]
Material "conductor" "float roughness" 0.2
Shape "trianglemesh" "point3 P" [ -3 0 -2  0 0 -2.5  -3 2 -2  0 2 -2.5 ] "integer indices" [ 0 1 2  1 3 2 ]
    "normal N" [ 0.2 0 1  0 0.1 1  0 -0.1 1  -0.2 0 1 ] "point2 uv" [ 0 0  2 0  0 2  2 2 ]
Material "diffusetransmission" "rgb reflectance" [ 0.3 0.2 0.2 ] "rgb transmittance" [ 0.4 0.5 0.3 ]
Shape "bilinearmesh" "point3 P" [ 0.5 0 -1.5  2.5 0 -1  0.5 2 -1.5  2.5 2 -1 ]
ObjectBegin "pair"
    Material "dielectric" "spectrum eta" "glass-F11"
    Shape "sphere" "float radius" 0.4
    Material "dielectric" "float roughness" 0.3
    Translate 0.9 0 0
    Shape "sphere" "float radius" 0.4
    Material "conductor"
    Translate 0 0 -0.7
    Shape "trianglemesh" "point3 P" [ -0.4 -0.4 0  0.4 -0.4 0  0 0.5 0.1 ] "integer indices" [ 0 1 2 ]
ObjectEnd
Translate -0.8 0.5 1
ObjectInstance "pair"
Translate 2 0.3 0
Rotate 40 1 1 0
Scale 0.8 0.6 0.9
ObjectInstance "pair"
Material "thindielectric"
Shape "disk" "float radius" 0.8 "float height" 1
"#;

/// Parallel camera rays in a space that is stretched, and a plane that hides distant light.
pub const STRETCHED: &str = r#"
Scale 1 1.4 0.7
LookAt 0 -6 2.5  0 0 0.6  0 0 1
Camera "orthographic" "float screenwindow" [ -2.4 2.4 -1.8 1.8 ]
Film "rgb"
WorldBegin
LightSource "distant" "point3 from" [ 1 -1 2 ] "rgb L" [ 1 0.9 0.8 ]
LightSource "spot" "point3 from" [ -2 -2 3 ] "point3 to" [ 0 0 0 ] "float coneangle" 35 "float scale" 30
Material "diffuse" "rgb reflectance" [ 0.6 0.6 0.5 ]
Shape "plane"
Translate 0.3 0 0.8
Material "dielectric"
Shape "sphere" "float radius" 0.7
Translate -1.2 0.4 0
Material "conductor" "float roughness" 0.3
Shape "sphere" "float radius" 0.5
"#;

/// Shapes and instances of meshes with holes, one of which is seen through others, under shadow
/// rays; and lights with holes, or invisible.
pub const HOLES: &str = r#"
LookAt 0 3 5  0 0.8 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb"
WorldBegin
LightSource "infinite" "rgb L" [ 0.4 0.5 0.7 ]
LightSource "point" "point3 from" [ 2 4 2 ] "float scale" 60
Material "diffuse" "rgb reflectance" [ 0.7 0.6 0.5 ]
Shape "bilinearmesh" "point3 P" [ -4 0 -4  -4 0 4  4 0 -4  4 0 4 ]
Texture "tiles" "float" "checkerboard" "float uscale" 8 "float vscale" 6
Texture "holes" "float" "mix" "float tex1" 0 "float tex2" 1 "texture amount" "tiles"
Texture "spots" "float" "checkerboard" "float uscale" 9 "float vscale" 7 "float tex1" 1 "float tex2" 0
Shape "sphere" "float radius" 0.5 "texture alpha" "spots"
Translate -1.2 0.8 0
Shape "sphere" "float radius" 0.7 "texture alpha" "holes"
Translate 2.4 0 0
Shape "cylinder" "float radius" 0.6 "texture alpha" "holes"
ObjectBegin "screen"
    Shape "trianglemesh" "point3 P" [ -1 -0.6 0  1 -0.6 0  -1 0.9 0  1 0.9 0 ] "integer indices" [ 0 1 2  1 3 2 ]
        "point2 uv" [ 0 0  1 0  0 1  1 1 ] "texture alpha" "holes"
    Shape "bilinearmesh" "point3 P" [ -1 -0.6 0.3  1 -0.6 0.3  -1 0.9 0.3  1 0.9 0.8 ] "texture alpha" "spots"
ObjectEnd
Translate -1.2 0.2 1.2
ObjectInstance "screen"
Rotate 30 0 1 0
Translate 0 0.3 -2.4
ObjectInstance "screen"
AreaLightSource "diffuse" "rgb L" [ 5 4 3 ]
Translate -0.8 0.4 2.4
Shape "sphere" "float radius" 0.3 "texture alpha" "spots"
Shape "trianglemesh" "point3 P" [ 1 -0.4 -1  1.8 -0.4 -1  1 0.4 -1.3  1.8 0.4 -1.3 ] "integer indices" [ 0 1 2  1 3 2 ]
    "point2 uv" [ 0 0  0.4 0  0 0.4  0.4 0.5 ] "texture alpha" "holes"
Shape "disk" "float radius" 0.4 "float height" 1.5 "float alpha" 0
"#;

/// Lights of all shapes with an image, which is turned and repeated for the first ones: triangles
/// with texture coordinates and without, a rectangle, a patch, one whose points the image chooses,
/// a sphere, a disk and a cylinder.
pub const PANELS: &str = r#"
LookAt 0 -6 2  0 0 0.8  0 0 1
Camera "perspective" "float fov" 40
Film "rgb"
WorldBegin
Material "diffuse" "rgb reflectance" [ 0.6 0.6 0.5 ]
Shape "bilinearmesh" "point3 P" [ -4 -4 0  4 -4 0  -4 4 0  4 4 0 ]
AreaLightSource "diffuse" "string filename" "panel.pfm" "bool twosided" true "string wrap" "repeat-clamp"
    "string filter" "point" "float columns" [ 1.5 0.2 -0.3 1.2 -0.1 0.1 ]
Shape "trianglemesh" "point3 P" [ -2.6 1 0.2  -1.4 1 0.2  -2.6 1 1.4  -1.4 1 1.4 ] "integer indices" [ 0 1 2  1 3 2 ]
    "point2 uv" [ 0 0  2 0.1  0 1  1.2 1.5 ]
Shape "trianglemesh" "point3 P" [ -1.2 1 0.2  -0.2 1 0.2  -0.7 1.2 1.4 ] "integer indices" [ 0 1 2 ]
Shape "bilinearmesh" "point3 P" [ 0 1 0.2  1 1 0.2  0 1 1.4  1 1 1.4 ]
Shape "bilinearmesh" "point3 P" [ 1.2 1 0.2  2.4 1 0.4  1.2 1.6 1.4  2.6 0.8 1.2 ]
AreaLightSource "diffuse" "string filename" "panel.pfm" "float scale" 2
Shape "bilinearmesh" "point3 P" [ 1 1 1.7  0 1 1.7  1 1 2.4  0 1 2.4 ] "string emissionfilename" "panel.pfm"
Translate -1.4 -1 0.4
Rotate 30 1 0.4 0
Shape "sphere" "float radius" 0.3
Translate 1 0 0
Shape "disk" "float radius" 0.4 "float innerradius" 0.1
Translate 1.4 0 0
ReverseOrientation
Shape "cylinder" "float radius" 0.3 "float zmin" -0.3 "float zmax" 0.4 "float phimax" 200
"#;

/// A camera that turns, moves and stretches while its shutter is open, before the motion is over.
pub const PAN: &str = r#"
TransformTimes 1 4
ActiveTransform EndTime
Rotate 25 0.1 0.2 1
Translate 0.4 0.3 0
Scale 1.2 0.9 1
ActiveTransform All
LookAt 0 -6 2  0 0 0.6  0 0 1
Camera "perspective" "float fov" 40 "float shutteropen" 0.5 "float shutterclose" 3 "float lensradius" 0.1
    "float focaldistance" 6
Film "rgb"
WorldBegin
LightSource "infinite" "rgb L" [ 0.4 0.5 0.7 ]
LightSource "point" "point3 from" [ 2 -4 4 ] "float scale" 90
Texture "squares" "spectrum" "checkerboard" "float uscale" 8 "float vscale" 8
    "rgb tex1" [ 0.7 0.6 0.5 ] "rgb tex2" [ 0.2 0.3 0.4 ]
Material "diffuse" "texture reflectance" "squares"
Shape "bilinearmesh" "point3 P" [ -4 -4 0  4 -4 0  -4 4 0  4 4 0 ]
Translate -0.7 0 0.6
Material "conductor"
Shape "sphere" "float radius" 0.6
Translate 1.4 0 0
Material "dielectric"
Shape "sphere" "float radius" 0.6
"#;

/// Principled surfaces of all kinds: metal with a textured roughness, brushed metal, coats, fuzz,
/// films, frosted glass, and a window.
pub const PRINCIPLED: &str = r#"
LookAt 0 -6 2.4  0 0 0.5  0 0 1
Camera "perspective" "float fov" 36
Film "rgb"
WorldBegin
LightSource "infinite" "rgb L" [ 0.5 0.6 0.8 ]
LightSource "point" "point3 from" [ 2 -4 4 ] "float scale" 90
Texture "tiles" "float" "checkerboard" "float uscale" 8 "float vscale" 8 "float tex1" 0.3 "float tex2" 0.7
Texture "squares" "spectrum" "checkerboard" "float uscale" 8 "float vscale" 8
    "rgb tex1" [ 0.7 0.6 0.5 ] "rgb tex2" [ 0.2 0.3 0.4 ]
Material "openpbr" "texture base_color" "squares" "texture specular_roughness" "tiles"
Shape "bilinearmesh" "point3 P" [ -4 -4 -0.5  4 -4 -0.5  -4 4 -0.5  4 4 -0.5 ]
Translate -2 0 0
Material "openpbr" "float base_metalness" 1 "rgb base_color" [ 0.9 0.6 0.3 ] "float specular_roughness" 0.5
    "float specular_roughness_anisotropy" 0.6
Shape "sphere" "float radius" 0.45
Translate 1 0 0
Material "openpbr" "float coat_weight" 1 "rgb coat_color" [ 0.9 0.4 0.3 ] "float base_metalness" 0.4
    "float coat_roughness" 0.1
Shape "sphere" "float radius" 0.45
Translate 1 0 0
Material "openpbr" "float transmission_weight" 1 "float specular_roughness" 0.4
Shape "sphere" "float radius" 0.45
Translate 1 0 0
Material "openpbr" "float fuzz_weight" 0.8 "rgb fuzz_color" [ 0.6 0.3 0.8 ] "float base_diffuse_roughness" 1
Shape "sphere" "float radius" 0.45
Translate 1 0 0
Material "openpbr" "float thin_film_weight" 1 "float base_metalness" 1 "float specular_roughness" 0.3
Shape "sphere" "float radius" 0.45
Translate -2 -1.2 0
Material "openpbr" "float transmission_weight" 0.8 "bool geometry_thin_walled" true
    "rgb transmission_color" [ 0.5 0.9 0.6 ] "float subsurface_weight" 0.5
Shape "disk" "float radius" 0.6 "float height" 0.2
Translate 1.2 0 0
Material "openpbr" "float transmission_weight" 1 "float transmission_dispersion_scale" 1
    "float transmission_dispersion_abbe_number" 20
Shape "sphere" "float radius" 0.3
Translate 0.7 0 0
Material "openpbr" "float coat_weight" 1 "float coat_roughness" 0.2 "string geometry_coat_normal" "normals.pfm"
    "string geometry_coat_normal_wrap" "clamp-black" "float geometry_coat_normal_columns" [ 0.7 0 0.2 0.6 0.1 0.1 ]
Shape "sphere" "float radius" 0.3
"#;

/// A slide, thrown through a stretched space at a wall and a sphere.
pub const PROJECTOR: &str = r#"
LookAt 0 -6 1  0 0 1  0 0 1
Camera "perspective" "float fov" 40
Film "rgb"
WorldBegin
AttributeBegin
    Translate 1 -4 2
    Rotate 110 1 0 0
    Scale 1 1.3 -0.8
    LightSource "projection" "string filename" "slide.pfm" "float fov" 40 "float scale" 30
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.7 0.6 0.5 ]
Shape "bilinearmesh" "point3 P" [ -4 2 -3  4 2 -3  -4 2 4  4 2 4 ]
Translate 0.6 0 0.8
Shape "sphere" "float radius" 0.6
"#;

/// Sets of spheres, of which some are mirrors and some are glass, a mesh, and instances of a mesh
/// and a sphere, with sun and sky.
pub const MOVING: &str = r#"
LookAt 0 -6 2.5   0 0 0.4   0 0 1
Camera "perspective" "float fov" 40
WorldBegin
LightSource "distant" "rgb L" [ 3.1 2.85 2.5 ] "point3 from" [ 0.75 -0.9 0.62 ] "point3 to" [ 0 0 0 ]
LightSource "infinite" "rgb L" [ 0.2 0.3 0.47 ]
Material "diffuse" "rgb reflectance" [ 0.4 0.5 0.3 ]
Shape "spheres" "float radius" 50 "point3 P" [ 0 0 -50 ]
Material "diffuse" "rgb reflectance" [ 0.7 0.3 0.2 ]
Shape "spheres" "float radius" [ 0.3 0.4 0.2 0.35 0.25 0.3 ]
    "point3 P" [ -1.5 0 0.3  -0.6 1.2 0.4  0.2 -1 0.2  1.1 0.6 0.35  1.8 -0.4 0.25  0.4 0.4 0.9 ]
Material "conductor" "spectrum eta" "metal-Ag-eta" "spectrum k" "metal-Ag-k" "float roughness" 0
Shape "spheres" "float radius" 0.5 "point3 P" [ -0.7 -0.6 0.5  0.9 1.6 0.5 ]
Material "dielectric"
Shape "spheres" "float radius" 0.4 "point3 P" [ 0.7 -0.8 0.6 ]
Material "diffuse" "rgb reflectance" [ 0.3 0.3 0.8 ]
Shape "trianglemesh" "integer indices" [ 0 1 2  1 3 2  2 3 4  0 2 4 ]
    "point3 P" [ -2 1 0.2  -1.2 0.6 0.3  -1.7 1.2 1.1  -0.9 1.3 0.9  -1.9 2 0.6 ]
ObjectBegin "toy"
    Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3  0 3 1  1 3 2 ]
        "point3 P" [ 0 0 0.7  0.4 0 0  -0.2 0.35 0  -0.2 -0.35 0 ]
    Shape "spheres" "float radius" 0.15 "point3 P" [ 0 0 0.8 ]
ObjectEnd
Translate 1.6 -1 0
ObjectInstance "toy"
Translate -3 0 0
ObjectInstance "toy"
"#;

/// A mesh with normals and one that shines; and instances: at rest, of what shines, and moving.
pub const FOLLOWING: &str = r#"
WorldBegin
Shape "trianglemesh" "integer indices" [ 0 1 2 ]
    "point3 P" [ 0 0 0  1 0 0  0 1 0 ] "normal N" [ 0 0 1  0 0 1  0 0 1 ]
AttributeBegin
    AreaLightSource "diffuse"
    Shape "trianglemesh" "integer indices" [ 0 1 2 ] "point3 P" [ 0 0 0  1 0 0  0 1 0 ]
AttributeEnd
ObjectBegin "dark"
    Shape "sphere"
ObjectEnd
ObjectBegin "lamp"
    AreaLightSource "diffuse"
    Shape "sphere"
ObjectEnd
ObjectInstance "dark"
ObjectInstance "lamp"
ActiveTransform EndTime
Translate 1 0 0
ActiveTransform All
ObjectInstance "dark"
"#;

/// Strands of three kinds of hair.
pub const HAIR: &str = r#"
LookAt 0 -3 0.4  0 0 0.4  0 0 1
Camera "perspective" "float fov" 40
Film "rgb"
WorldBegin
LightSource "infinite" "rgb L" [ 0.5 0.6 0.7 ]
LightSource "point" "point3 from" [ 2 -2 3 ] "float scale" 30
ObjectBegin "strands"
    Shape "curve" "string type" "cylinder" "float width0" 0.12 "float width1" 0.06
        "point3 P" [ -0.15 0 -0.4  -0.3 0 0.4  0.1 -0.2 0.6  0 0.1 1.2 ]
    Shape "curve" "string type" "cylinder" "float width" 0.1 "integer splitdepth" 1
        "point3 P" [ 0.15 0 -0.4  0.1 0.3 0.4  0.35 -0.2 0.6  0.2 0.1 1.1 ]
ObjectEnd
Material "hair" "float eumelanin" 1.3 "float pheomelanin" 0.2
Shape "curve" "string type" "flat" "float width" 0.2 "point3 P" [ -1 0 -0.4  -0.9 0 0.4  -1.1 -0.2 0.6  -0.9 0.1 1.2 ]
Translate -0.5 0 0
ObjectInstance "strands"
Material "hair" "rgb reflectance" [ 0.7 0.4 0.2 ] "float beta_m" 0.2 "float beta_n" 0.5
Shape "curve" "string type" "cylinder" "float width" 0.15
    "point3 P" [ 0.5 0 -0.4  0.4 0 0.4  0.6 -0.2 0.6  0.5 0.1 1.2 ]
Material "hair" "rgb sigma_a" [ 0.2 0.4 0.9 ] "float alpha" 4 "float eta" 1.4
Shape "curve" "string type" "cylinder" "float width" 0.15
    "point3 P" [ 0.9 0 -0.4  0.8 0 0.4  1 -0.2 0.6  0.9 0.1 1.2 ]
"#;

/// Two spheres over the ground, whose coated surfaces a test replaces with measured ones.
pub const MEASURED: &str = r#"
LookAt 0 -4 1.5  0 0 0.5  0 0 1
Camera "perspective" "float fov" 40
Film "rgb"
WorldBegin
LightSource "infinite" "rgb L" [ 0.5 0.6 0.7 ]
LightSource "point" "point3 from" [ 2 -2 3 ] "float scale" 30
Material "diffuse"
Shape "disk" "float radius" 3
Material "coateddiffuse"
Translate -0.6 0 0.5
Shape "sphere" "float radius" 0.5
Material "coateddiffuse" "float roughness" 0.1
Translate 1.2 0 0
Shape "sphere" "float radius" 0.5
"#;

/// A room seen in all directions, by the mapping that is given.
pub const AROUND: &str = r#"
LookAt 0.3 -0.2 0.4  1 0.5 0.6  0 0 1
Camera "spherical" "string mapping" "MAPPING"
PixelFilter "triangle" "float xradius" 2 "float yradius" 2
Film "rgb"
WorldBegin
LightSource "infinite" "rgb L" [ 0.3 0.4 0.6 ]
LightSource "point" "point3 from" [ 0 0 1.5 ] "float scale" 9
Texture "tiles" "spectrum" "checkerboard" "float uscale" 8 "float vscale" 8
    "rgb tex1" [ 0.7 0.6 0.5 ] "rgb tex2" [ 0.2 0.3 0.4 ]
Material "diffuse" "texture reflectance" "tiles"
Shape "disk" "float radius" 3
Shape "bilinearmesh" "point3 P" [ -1 1.5 -1  1.5 1.5 -1  -1 1.5 1.2  1.5 1.5 1.2 ]
Material "conductor" "float roughness" 0.1
Translate 1 -0.8 0.6
Shape "sphere" "float radius" 0.4
"#;

/// Lamps whose points are sampled by area: parts of a disk and of a cylinder, and a bent patch.
pub const LAMPS: &str = r#"
LookAt 0 -4 2  0 0 0.6  0 0 1
Camera "perspective" "float fov" 50
Film "rgb"
WorldBegin
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 4 3 2 ] "bool twosided" true
    Shape "bilinearmesh" "point3 P" [ -1.6 0.5 0.6  -0.7 0.6 0.8  -1.5 0.7 1.8  -0.8 0.2 1.5 ]
AttributeEnd
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 2 3 4 ]
    Translate 0 0.3 1.9
    Rotate 160 1 0 0
    Shape "disk" "float radius" 0.5 "float innerradius" 0.2 "float phimax" 250
AttributeEnd
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [ 3 2 2 ] "bool twosided" true
    Translate 1.2 0.4 0.7
    Shape "cylinder" "float radius" 0.3 "float zmin" -0.4 "float zmax" 0.5 "float phimax" 200
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.7 0.6 0.5 ]
Shape "disk" "float radius" 3
Translate 0 -0.3 0.5
Shape "sphere" "float radius" 0.4
"#;
