//! Compiles the description of a camera.

use super::aperture::ApertureMask;
use super::lens::{FocusError, LensSystem};
use super::{Camera, CameraTransform, Orthographic, Perspective, Projection, Realistic, Screen, Spherical};
use description::schema::Settings;
use description::{
    ApertureDesc, Arena, CameraDesc, CameraKind, Diagnostic, FilmDesc, ImageDesc, LensElement, Origin,
    RealisticCameraDesc, ScreenDesc, Stated,
};
use math::{Bounds2, DMat4};

/// Places the described camera in the render space given by `world_from_render`; `images` are those
/// of the description. Errors and warnings are added to `diagnostics`; `None` if there was an
/// error.
pub fn compile(
    camera: &Stated<CameraDesc>,
    film: &Stated<FilmDesc>,
    images: &Arena<ImageDesc>,
    world_from_render: DMat4,
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<Camera> {
    let origin = &camera.origin;
    let before = diagnostics.len();
    diagnostics.extend(camera.check(origin));
    let resolution = resolution(film, diagnostics);
    let projection = match &camera.kind {
        // A lens with settings out of range would be reported twice.
        CameraKind::Realistic(_) if diagnostics[before..].iter().any(Diagnostic::is_error) => None,
        CameraKind::Realistic(desc) => {
            realistic(desc, origin, film.diagonal, resolution, images, diagnostics)
        }
        CameraKind::Perspective { fov, screen, lens } => {
            let window = window(screen, origin, resolution, diagnostics);
            Some(Projection::Perspective(Perspective::new(*fov, window, (*lens).into(), resolution)))
        }
        CameraKind::Orthographic { screen, lens } => {
            let window = window(screen, origin, resolution, diagnostics);
            Some(Projection::Orthographic(Orthographic::new(window, (*lens).into(), resolution)))
        }
        CameraKind::Spherical { mapping } => {
            Some(Projection::Spherical(Spherical::new(*mapping, resolution)))
        }
    };
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
    Some(Camera::new(projection?, transform?, shutter, resolution))
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

/// A focused system of lenses in front of a film of the given diagonal, in millimetres.
fn realistic(
    desc: &RealisticCameraDesc,
    origin: &Origin,
    diagonal: f32,
    resolution: [u32; 2],
    images: &Arena<ImageDesc>,
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<Projection> {
    if let Err(message) = check_lens(&desc.lenses) {
        diagnostics.push(invalid(message, origin, "lensfile"));
        return None;
    }
    let stops = desc.lenses.iter().filter(|element| element.curvature_radius == 0.0);
    if let Some(widest) = stops.map(|stop| stop.aperture_diameter).reduce(f32::min)
        && desc.aperture_diameter > widest
    {
        let message = format!(
            "an aperture of {} mm is wider than the stop of the lens; {widest} mm used",
            desc.aperture_diameter
        );
        diagnostics.push(Diagnostic::warning("aperture", message, origin.parameter("aperturediameter")));
    }
    let mask = match &desc.aperture {
        ApertureDesc::Circular => None,
        ApertureDesc::Gaussian => Some(ApertureMask::gaussian()),
        ApertureDesc::Square => Some(ApertureMask::square()),
        ApertureDesc::Pentagon => Some(ApertureMask::pentagon()),
        ApertureDesc::Star => Some(ApertureMask::star()),
        ApertureDesc::Image(image) => {
            let mask = ApertureMask::picture(&images[*image].image);
            if mask.is_none() {
                diagnostics.push(invalid("the image of the aperture is black", origin, "aperture"));
                return None;
            }
            mask
        }
    };
    let mut lens = LensSystem::new(&desc.lenses, desc.aperture_diameter, mask);
    let diagonal = diagonal * 1e-3;
    if let Err(error) = lens.focus(f64::from(desc.focus_distance), f64::from(diagonal) * 1e-3) {
        let (message, parameter) = match error {
            FocusError::NotConverging => {
                ("parallel light does not converge behind the lens".to_owned(), "lensfile")
            }
            FocusError::TooNear(least) => {
                (format!("the lens cannot be focused nearer than {least:.3} m"), "focusdistance")
            }
            FocusError::InsideLens => {
                let message = "at this distance of focus the film would be inside the lens";
                (message.to_owned(), "focusdistance")
            }
        };
        diagnostics.push(invalid(message, origin, parameter));
        return None;
    }
    let projection = Realistic::new(lens, diagonal, resolution);
    if projection.is_none() {
        let help = "its elements' diameters, radii of curvature or distances do not fit each other";
        diagnostics.push(invalid("no light passes the lens", origin, "lensfile").with_help(help));
    }
    projection.map(Projection::Realistic)
}

/// Says what is wrong with the elements of a lens file, if anything is.
fn check_lens(elements: &[LensElement]) -> Result<(), String> {
    for (i, element) in elements.iter().enumerate() {
        let LensElement { curvature_radius, thickness, eta, aperture_diameter } = *element;
        let number = i + 1;
        if !(curvature_radius.is_finite() && thickness.is_finite()) {
            return Err(format!("lens element {number} has no finite radius of curvature and thickness"));
        }
        if !(eta >= 0.0 && eta.is_finite()) {
            return Err(format!("lens element {number} has the index of refraction {eta}"));
        }
        if !(aperture_diameter > 0.0 && aperture_diameter.is_finite()) {
            return Err(format!("lens element {number} has the diameter {aperture_diameter} mm"));
        }
    }
    if elements.iter().all(|element| element.curvature_radius == 0.0) {
        return Err("the lens has no interface that refracts light".to_owned());
    }
    Ok(())
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
