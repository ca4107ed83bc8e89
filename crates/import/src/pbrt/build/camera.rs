//! Cameras.

use description::{
    ApertureDesc, CameraDesc, CameraKind, LensDesc, LensElement, RealisticCameraDesc, ScreenDesc,
    SphericalMapping, Stated,
};

use super::Builder;
use crate::pbrt::reader::Reader;
use crate::pbrt::statement::CameraStatement;

impl Builder<'_> {
    pub(super) fn camera(&mut self, camera: CameraStatement, times: [f32; 2]) -> Stated<CameraDesc> {
        let medium = camera.medium.as_ref().and_then(|name| self.named_medium(name));
        let camera_from_world = camera.camera_from_world.over(times);
        let mut stated = self.read_or_default(camera.statement, |reader| {
            let kind = kind(reader)?;
            let [mut shutter_open, mut shutter_close] =
                [reader.float("shutteropen", 0.0), reader.float("shutterclose", 1.0)];
            if shutter_close < shutter_open {
                reader.ignored(
                    "shutterclose",
                    "the shutter closes before it opens: the two times are exchanged",
                );
                std::mem::swap(&mut shutter_open, &mut shutter_close);
            }
            Some(CameraDesc { kind, shutter_open, shutter_close, ..CameraDesc::default() })
        });
        stated.camera_from_world = camera_from_world;
        stated.medium = medium;
        stated
    }
}

fn kind(reader: &mut Reader) -> Option<CameraKind> {
    Some(match reader.kind.value.as_str() {
        "perspective" => {
            let (screen, lens) = (screen(reader), lens(reader));
            let mut fov = reader.float("fov", 90.0);
            if let Some(half) = reader.optional_float("halffov") {
                fov = 2.0 * half;
            }
            if !(fov > 0.0 && fov < 180.0) {
                reader.refuse("fov", "`fov` must lie between 0 and 180 degrees");
                fov = 90.0;
            }
            CameraKind::Perspective { fov, screen, lens }
        }
        "orthographic" => CameraKind::Orthographic { screen: screen(reader), lens: lens(reader) },
        "spherical" => {
            // The format lets a spherical camera have a screen and a lens, and ignores them.
            let _ = (screen(reader), lens(reader));
            CameraKind::Spherical {
                mapping: reader.choice(
                    "mapping",
                    SphericalMapping::EqualArea,
                    &[
                        ("equalarea", SphericalMapping::EqualArea),
                        ("equirectangular", SphericalMapping::EquiRectangular),
                    ],
                ),
            }
        }
        "realistic" => CameraKind::Realistic(realistic(reader)?),
        _ => {
            let known = ["perspective", "orthographic", "spherical", "realistic"];
            reader.unknown_type("camera", "camera", &known);
            return None;
        }
    })
}

fn screen(reader: &mut Reader) -> ScreenDesc {
    let frame_aspect_ratio =
        if reader.has("frameaspectratio") { Some(reader.positive("frameaspectratio", 1.0)) } else { None };
    let window = reader.float_array::<4>("screenwindow");
    if let Some([x0, x1, y0, y1]) = window
        && (x0 == x1 || y0 == y1)
    {
        reader.refuse("screenwindow", "`screenwindow` (x0, x1, y0, y1) is empty");
    }
    ScreenDesc { frame_aspect_ratio, window }
}

fn lens(reader: &mut Reader) -> LensDesc {
    let default = LensDesc::default();
    LensDesc {
        radius: reader.float("lensradius", default.radius),
        focal_distance: reader.positive("focaldistance", default.focal_distance),
    }
}

fn realistic(reader: &mut Reader) -> Option<RealisticCameraDesc> {
    let aperture_diameter = reader.positive("aperturediameter", 1.0);
    let focus_distance = reader.positive("focusdistance", 10.0);
    let aperture = match reader.string("aperture") {
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
    let Some(file) = reader.string("lensfile") else {
        reader.missing("lensfile");
        return None;
    };
    let element = |[curvature_radius, thickness, eta, aperture_diameter]: [f32; 4]| LensElement {
        curvature_radius,
        thickness,
        eta,
        aperture_diameter,
    };
    let lenses = reader.builder.lens_file(&file)?.into_iter().map(element).collect();
    Some(RealisticCameraDesc { lenses, aperture_diameter, focus_distance, aperture })
}
