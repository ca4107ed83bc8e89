//! Compiles the description of a camera.

use super::{Camera, CameraTransform, Orthographic, Perspective, Projection, Screen, Spherical, ThinLens};
use description::{CameraDesc, CameraKind, Diagnostic, FilmDesc, LensDesc, Origin, ScreenDesc, Stated};
use math::{Bounds2, DMat4};

/// Places the described camera in the render space given by `world_from_render`. Errors and
/// warnings are added to `diagnostics`; `None` if there was an error.
pub fn compile(
    camera: &Stated<CameraDesc>,
    film: &Stated<FilmDesc>,
    world_from_render: DMat4,
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<Camera> {
    let origin = &camera.origin;
    let before = diagnostics.len();
    let resolution = resolution(film, diagnostics);
    let projection = projection(&camera.kind, origin, resolution, diagnostics);
    let transform = CameraTransform::new(&camera.camera_from_world, world_from_render);
    if transform.is_none() {
        let message = "the transform of the camera has no inverse";
        diagnostics.push(
            Diagnostic::error("singular-transform", message, origin.span)
                .with_help("the position and the target of LookAt must differ, and no Scale may be zero"),
        );
    }
    let mut shutter = [camera.shutter_open, camera.shutter_close];
    if !shutter.iter().all(|t| t.is_finite()) {
        diagnostics.push(invalid("the shutter must open and close at finite times", origin, "shutteropen"));
    } else if shutter[1] < shutter[0] {
        let message =
            format!("the shutter closes at {} before it opens at {}; exchanged", shutter[1], shutter[0]);
        diagnostics.push(Diagnostic::warning("shutter", message, origin.parameter("shutterclose")));
        shutter.reverse();
    }
    if diagnostics[before..].iter().any(Diagnostic::is_error) {
        return None;
    }
    Some(Camera::new(projection, transform?, shutter, resolution))
}

fn resolution(film: &Stated<FilmDesc>, diagnostics: &mut Vec<Diagnostic>) -> [u32; 2] {
    let mut side = |pixels: i32, parameter| match u32::try_from(pixels) {
        Ok(pixels) if pixels > 0 => pixels,
        _ => {
            let message = format!("a film cannot be {pixels} pixels wide or high");
            diagnostics.push(invalid(message, &film.origin, parameter));
            1
        }
    };
    [side(film.resolution[0], "xresolution"), side(film.resolution[1], "yresolution")]
}

fn projection(
    kind: &CameraKind,
    origin: &Origin,
    resolution: [u32; 2],
    diagnostics: &mut Vec<Diagnostic>,
) -> Projection {
    match kind {
        CameraKind::Perspective { fov, screen, lens } => {
            if !(*fov > 0.0 && *fov < 180.0) {
                let message = format!("the field of view must lie between 0 and 180 degrees, not be {fov}");
                diagnostics.push(invalid(message, origin, "fov"));
            }
            let window = window(screen, origin, resolution, diagnostics);
            let lens = thin_lens(*lens, origin, diagnostics);
            Projection::Perspective(Perspective::new(*fov, window, lens, resolution))
        }
        CameraKind::Orthographic { screen, lens } => {
            let window = window(screen, origin, resolution, diagnostics);
            let lens = thin_lens(*lens, origin, diagnostics);
            Projection::Orthographic(Orthographic::new(window, lens, resolution))
        }
        CameraKind::Spherical { mapping } => Projection::Spherical(Spherical::new(*mapping, resolution)),
        CameraKind::Realistic(_) => {
            let message =
                "camera `realistic` is not drawn yet; drawn as a `perspective` pinhole of 90 degrees";
            diagnostics.push(Diagnostic::warning("not-drawn", message, origin.span));
            let window = Screen::window(&ScreenDesc::default(), resolution);
            Projection::Perspective(Perspective::new(90.0, window, LensDesc::default().into(), resolution))
        }
    }
}

fn window(
    screen: &ScreenDesc,
    origin: &Origin,
    resolution: [u32; 2],
    diagnostics: &mut Vec<Diagnostic>,
) -> Bounds2 {
    if screen.window.is_none() && screen.frame_aspect_ratio.is_some_and(|a| !(a > 0.0 && a.is_finite())) {
        let message = "the aspect ratio of the frame must be above zero";
        diagnostics.push(invalid(message, origin, "frameaspectratio"));
    }
    let window = Screen::window(screen, resolution);
    if !window.diagonal().is_finite() || window.diagonal().abs().min_element() == 0.0 {
        diagnostics.push(invalid("the screen window has no area", origin, "screenwindow"));
    }
    window
}

fn thin_lens(desc: LensDesc, origin: &Origin, diagnostics: &mut Vec<Diagnostic>) -> ThinLens {
    if !(desc.radius >= 0.0 && desc.radius.is_finite()) {
        let message = format!("the radius of a lens cannot be {}", desc.radius);
        diagnostics.push(invalid(message, origin, "lensradius"));
    } else if desc.radius > 0.0 && !(desc.focal_distance > 0.0 && desc.focal_distance.is_finite()) {
        let message = format!("a lens cannot be focused at the distance {}", desc.focal_distance);
        diagnostics.push(invalid(message, origin, "focaldistance"));
    }
    desc.into()
}

fn invalid(message: impl Into<String>, origin: &Origin, parameter: &str) -> Diagnostic {
    Diagnostic::error("invalid-value", message, origin.parameter(parameter))
}
