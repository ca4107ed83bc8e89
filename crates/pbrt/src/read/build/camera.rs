//! Cameras.

use description::{
    ApertureDesc, CameraDesc, CameraKind, LensDesc, LensElement, RealisticCameraDesc, ScreenDesc, Stated,
};

use super::Builder;
use super::reader::Reader;
use crate::read::statement::CameraStatement;

impl Builder<'_> {
    pub(super) fn camera(&mut self, camera: CameraStatement, times: [f32; 2]) -> Stated<CameraDesc> {
        let medium = camera.medium.as_ref().and_then(|name| self.named_medium(name));
        let camera_from_world = camera.camera_from_world.over(times);
        let mut stated = self.read_or_default(camera.statement, |reader| {
            let mut camera: CameraDesc = reader.member("camera", "camera")?;
            complete(&mut camera.kind, reader)?;
            if camera.shutter_close < camera.shutter_open {
                reader.ignored(
                    "shutterclose",
                    "the shutter closes before it opens: the two times are exchanged",
                );
                std::mem::swap(&mut camera.shutter_open, &mut camera.shutter_close);
            }
            Some(camera)
        });
        stated.camera_from_world = camera_from_world;
        stated.medium = medium;
        stated
    }
}

/// Reads the parameters that are no settings, and checks rules that concern several settings.
fn complete(kind: &mut CameraKind, reader: &mut Reader) -> Option<()> {
    match kind {
        CameraKind::Perspective { screen, fov, .. } => {
            window(screen, reader);
            if let Some(half) = reader.optional_float("halffov") {
                *fov = 2.0 * half;
                if !(*fov > 0.0 && *fov < 180.0) {
                    reader.refuse("halffov", format!("`halffov` is a number between 0 and 90, not {half}"));
                }
            }
        }
        CameraKind::Orthographic { screen, .. } => window(screen, reader),
        CameraKind::Spherical { .. } => {
            // The format allows a spherical camera a screen and a lens, and ignores them.
            reader.settings(&mut ScreenDesc::default());
            reader.settings(&mut LensDesc::default());
        }
        CameraKind::Realistic(camera) => realistic(camera, reader)?,
    }
    Some(())
}

fn window(screen: &ScreenDesc, reader: &mut Reader) {
    if let Some([x0, x1, y0, y1]) = screen.window
        && (x0 == x1 || y0 == y1)
    {
        reader.refuse("screenwindow", "`screenwindow` (x0, x1, y0, y1) is empty");
    }
}

fn realistic(camera: &mut RealisticCameraDesc, reader: &mut Reader) -> Option<()> {
    camera.aperture = match reader.string("aperture") {
        None => ApertureDesc::Circular,
        Some(name) => match name.value.as_str() {
            "" | "circular" => ApertureDesc::Circular,
            "gaussian" => ApertureDesc::Gaussian,
            "square" => ApertureDesc::Square,
            "pentagon" => ApertureDesc::Pentagon,
            "star" => ApertureDesc::Star,
            _ => ApertureDesc::Image(reader.builder.image(&name, None)),
        },
    };
    let file = reader.needed("lensfile", Reader::string)?;
    let element = |[curvature_radius, thickness, eta, aperture_diameter]: [f32; 4]| LensElement {
        curvature_radius,
        thickness,
        eta,
        aperture_diameter,
    };
    camera.lenses = reader.builder.lens_file(&file)?.into_iter().map(element).collect();
    Some(())
}
