//! Camera and film: their settings, and what is not a setting of them.

use std::collections::BTreeSet;

use description::{
    ApertureDesc, CameraDesc, CameraKind, ImageDesc, RealisticCameraDesc, SceneDesc, TransformDesc,
};

use math::{DMat4, DVec3};

use crate::write::ExportError;
use crate::write::files::Files;
use crate::write::names::Names;
use crate::write::number::decimal;
use crate::write::settings::statement;
use crate::write::statement::quoted;
use crate::write::text::Text;

/// The film.
pub(crate) fn film(desc: &SceneDesc, text: &mut Text, extensions: &mut BTreeSet<String>) {
    let film = &desc.film;
    let mut statement = statement("Film", &film.value, extensions);
    statement.space = Some(film.color_space);
    // Otherwise the picture is named after the scene.
    if film.origin.states("filename")
        && !statement.parameters.iter().any(|p| p.declaration == "string filename")
    {
        statement.text("filename", &film.filename);
    }
    if !film.layers.is_empty() {
        extensions.insert("film layers".into());
        statement.texts("layers", film.layers.iter().map(|layer| &*layer.value));
    }
    text.statement(statement);
}

/// The camera and its place.
pub(crate) fn camera(
    desc: &SceneDesc,
    names: &Names,
    files: &mut Files,
    text: &mut Text,
    extensions: &mut BTreeSet<String>,
) {
    let CameraDesc { kind, camera_from_world, shutter_open: _, shutter_close: _, medium, shows: _ } =
        &desc.camera.value;
    text.transform(camera_from_world);
    if let Some(medium) = medium {
        text.line(&format!("MediumInterface \"\" {}", quoted(names.medium(*medium))));
    }
    let mut statement = statement("Camera", &desc.camera.value, extensions);
    match kind {
        CameraKind::Perspective { .. } | CameraKind::Orthographic { .. } | CameraKind::Spherical { .. } => (),
        CameraKind::Realistic(RealisticCameraDesc {
            lenses,
            aperture,
            aperture_diameter: _,
            focus_distance: _,
        }) => {
            let rows = lenses.iter().map(|lens| {
                [lens.curvature_radius, lens.thickness, lens.eta, lens.aperture_diameter]
                    .map(decimal)
                    .join(" ")
            });
            let head = "# radius of curvature, thickness, index of refraction, aperture diameter";
            let rows: Vec<_> = std::iter::once(head.to_owned()).chain(rows).collect();
            let name = files.add("lens", "dat", (rows.join("\n") + "\n").as_bytes());
            statement.text("lensfile", &name);
            match aperture {
                ApertureDesc::Circular => (),
                ApertureDesc::Gaussian => statement.text("aperture", "gaussian"),
                ApertureDesc::Square => statement.text("aperture", "square"),
                ApertureDesc::Pentagon => statement.text("aperture", "pentagon"),
                ApertureDesc::Star => statement.text("aperture", "star"),
                ApertureDesc::Image(image) => {
                    let image: &ImageDesc = &desc.images[*image];
                    let name = files.image(&image.image, image::ColorEncoding::Srgb);
                    statement.text("aperture", &name);
                }
            }
        }
    }
    text.statement(statement);
}

/// A camera alone: the statements that place it where it is when its motion begins, and the camera
/// itself. `LookAt` places it, after a `Scale` if it mirrors; a camera that is not rigid has its
/// matrix. A `realistic` one, whose lens is a file, is placed only.
pub fn export_camera(camera: &CameraDesc) -> Result<String, ExportError> {
    let mut text = Text::new();
    let matrix = camera.camera_from_world.start;
    match LookAt::new(&matrix) {
        Some(look_at) => look_at.write(&mut text),
        None => text.matrix(&matrix),
    }
    if !matches!(camera.kind, CameraKind::Realistic(_)) {
        text.statement(statement("Camera", camera, &mut BTreeSet::new()));
    }
    text.finish().map_err(ExportError::Unsupported)
}

/// A rigid camera, which may mirror.
struct LookAt {
    eye: DVec3,
    target: DVec3,
    up: DVec3,
    mirrors: bool,
}

impl LookAt {
    /// The place of a camera by its transform from world space.
    fn new(camera_from_world: &DMat4) -> Option<Self> {
        let world_from_camera = camera_from_world.inverse();
        let [right, up, forward] = [0, 1, 2].map(|i| world_from_camera.col(i).truncate());
        let is = |a: f64, b: f64| (a - b).abs() < 1e-5;
        let lengths = [right, up, forward].map(DVec3::length);
        let angles = [right.dot(up), up.dot(forward), forward.dot(right)];
        let is_rigid = lengths.into_iter().all(|l| is(l, 1.0)) && angles.into_iter().all(|cos| is(cos, 0.0));
        // The frame of the format has its right where up × forward is.
        let (eye, mirrors) = (world_from_camera.w_axis.truncate(), up.cross(forward).dot(right) < 0.0);
        // Far enough for the precision of floats.
        let target = eye + forward * eye.length().max(1.0);
        is_rigid.then_some(Self { eye, target, up, mirrors })
    }

    fn write(&self, text: &mut Text) {
        if self.mirrors {
            text.line("Scale -1 1 1");
        }
        let numbers = [self.eye, self.target, self.up].map(|v| v.to_array().map(|x| decimal(x as f32 + 0.0)));
        text.line(&format!("LookAt {}", numbers.map(|v| v.join(" ")).join("  ")));
    }
}

/// The times of the first and of the last transform of all motions; an error if they differ.
pub(crate) fn times(desc: &SceneDesc) -> Result<[f32; 2], String> {
    let in_objects = desc.objects.iter().flat_map(|(_, object)| object.shapes.iter());
    let shapes = desc.shapes.iter().chain(in_objects).map(|(_, shape)| {
        let TransformDesc { start, mut end, times } = shape.world_from_object;
        // Vertices move in the same time as transforms.
        if matches!(&shape.kind, description::ShapeKind::Triangles(mesh) if !mesh.later.is_empty()) {
            end.w_axis.w += 1.0;
        }
        TransformDesc { start, end, times }
    });
    let in_objects = desc.objects.iter().flat_map(|(_, object)| object.instances.iter());
    let instances = desc.instances.iter().chain(in_objects).map(|(_, instance)| instance.world_from_object);
    let lights = desc.lights.iter().map(|(_, light)| light.world_from_light);
    let media = desc.media.iter().map(|(_, medium)| medium.world_from_medium);
    let all = shapes.chain(instances).chain(lights).chain(media).chain([desc.camera.camera_from_world]);
    let mut moving = all.filter(TransformDesc::is_animated).map(|transform| transform.times);
    let first = moving.next().unwrap_or(desc.camera.camera_from_world.times);
    match moving.find(|times| *times != first) {
        Some(other) => Err(format!(
            "motions from {} to {} and from {} to {} are in one scene, and the format has one time for all",
            first[0], first[1], other[0], other[1]
        )),
        None => Ok(first),
    }
}
