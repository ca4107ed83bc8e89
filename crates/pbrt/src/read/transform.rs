//! Directives that change the current transform.
//!
//! All but `Transform`, `Identity` and `CoordSysTransform` are applied to what follows: the current
//! transform is multiplied by theirs from the right. They change the transforms that
//! `ActiveTransform` chose.

use description::{Diagnostic, Span};
use math::{DMat4, DVec3};

use super::interpreter::{Abandoned, Interpreter, Step};
use super::token::Tokens;
use description::did_you_mean;

impl Interpreter<'_> {
    /// Runs a directive about transforms.
    pub(super) fn transform(&mut self, name: &str, span: Span, tokens: &mut Tokens) -> Step {
        match name {
            "Identity" => self.state.change_ctm(|_| DMat4::IDENTITY),
            "Transform" => {
                let matrix = self.matrix(span, tokens)?;
                self.state.change_ctm(|_| matrix);
            }
            "ConcatTransform" => {
                let matrix = self.matrix(span, tokens)?;
                self.state.change_ctm(|ctm| ctm * matrix);
            }
            "Translate" => {
                let offset = DVec3::from_array(self.numbers(tokens)?);
                self.state.change_ctm(|ctm| ctm * DMat4::from_translation(offset));
            }
            "Scale" => {
                let factors = DVec3::from_array(self.numbers(tokens)?);
                let matrix = self.invertible(DMat4::from_scale(factors), span)?;
                self.state.change_ctm(|ctm| ctm * matrix);
            }
            "Rotate" => {
                let [degrees, x, y, z] = self.numbers(tokens)?;
                let axis = DVec3::new(x, y, z).try_normalize();
                let Some(axis) = axis else {
                    return self.singular("the axis of this rotation has no direction", span);
                };
                self.state.change_ctm(|ctm| ctm * DMat4::from_axis_angle(axis, degrees.to_radians()));
            }
            "LookAt" => {
                let [ex, ey, ez, lx, ly, lz, ux, uy, uz] = self.numbers(tokens)?;
                let (eye, target, up) =
                    (DVec3::new(ex, ey, ez), DVec3::new(lx, ly, lz), DVec3::new(ux, uy, uz));
                let Some(matrix) = look_at(eye, target, up) else {
                    return self
                        .singular("eye, target and up vector of this `LookAt` do not define a frame", span);
                };
                self.state.change_ctm(|ctm| ctm * matrix);
            }
            "CoordinateSystem" => {
                let system = self.string(tokens, "the name of a coordinate system")?;
                self.coordinate_systems.insert(system.value, self.state.ctm);
            }
            "CoordSysTransform" => {
                let system = self.string(tokens, "the name of a coordinate system")?;
                let Some(&ctm) = self.coordinate_systems.get(&system.value) else {
                    let message = format!("there is no coordinate system `{}` yet", system.value);
                    let known = self.coordinate_systems.keys().map(String::as_str);
                    let help = did_you_mean(&system.value, known);
                    let diagnostic = Diagnostic::error("unknown-reference", message, system.span);
                    self.report.push(Diagnostic { help, ..diagnostic });
                    return Err(Abandoned);
                };
                self.state.ctm = ctm;
            }
            "ActiveTransform" => {
                let token = tokens.peek();
                self.state.active = match tokens.bytes(token) {
                    b"All" => [true, true],
                    b"StartTime" => [true, false],
                    b"EndTime" => [false, true],
                    _ => return self.unexpected(tokens, token, "`All`, `StartTime` or `EndTime`"),
                };
                tokens.next();
            }
            _ => {
                debug_assert_eq!(name, "TransformTimes", "every other directive has its arm");
                let times: [f64; 2] = self.numbers(tokens)?;
                if times[0] > times[1] {
                    let message = "the second of the `TransformTimes` lies before the first";
                    self.report.error("parameter-value", message, span);
                    return Err(Abandoned);
                }
                self.statements.transform_times = Some(times.map(|time| time as f32));
            }
        }
        Ok(())
    }

    fn matrix(&mut self, span: Span, tokens: &mut Tokens) -> Step<DMat4> {
        let columns = self.numbers(tokens)?;
        self.invertible(DMat4::from_cols_array(&columns), span)
    }

    fn invertible(&mut self, matrix: DMat4, span: Span) -> Step<DMat4> {
        if matrix.inverse().is_finite() && matrix.determinant() != 0.0 {
            return Ok(matrix);
        }
        self.singular("this transform is singular: it has no inverse", span)
    }

    fn singular<T>(&mut self, message: &str, span: Span) -> Step<T> {
        self.report.error("singular-transform", message, span);
        Err(Abandoned)
    }
}

/// From world space to that of a camera at `eye` with `target` along +z and `up` towards +y;
/// left-handed, as all camera spaces of the format.
fn look_at(eye: DVec3, target: DVec3, up: DVec3) -> Option<DMat4> {
    let direction = (target - eye).try_normalize()?;
    let right = up.try_normalize()?.cross(direction).try_normalize()?;
    let up = direction.cross(right);
    let world_from_camera =
        DMat4::from_cols(right.extend(0.0), up.extend(0.0), direction.extend(0.0), eye.extend(1.0));
    Some(world_from_camera.inverse())
}
