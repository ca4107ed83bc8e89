//! Compiles the description of a camera.

use super::{Camera, CameraTransform, Orthographic, Perspective, Projection, Screen, Spherical};
use description::schema::Settings;
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
    diagnostics.extend(camera.check(origin));
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
    if shutter[1] < shutter[0] {
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
            let window = window(screen, origin, resolution, diagnostics);
            Projection::Perspective(Perspective::new(*fov, window, (*lens).into(), resolution))
        }
        CameraKind::Orthographic { screen, lens } => {
            let window = window(screen, origin, resolution, diagnostics);
            Projection::Orthographic(Orthographic::new(window, (*lens).into(), resolution))
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
    let window = Screen::window(screen, resolution);
    if !window.diagonal().is_finite() || window.diagonal().abs().min_element() == 0.0 {
        diagnostics.push(invalid("the screen window has no area", origin, "screenwindow"));
    }
    window
}

fn invalid(message: impl Into<String>, origin: &Origin, parameter: &str) -> Diagnostic {
    Diagnostic::error("invalid-value", message, origin.parameter(parameter))
}
