//! The motion of a camera: around what it looks at, or freely through the scene.

use std::f64::consts::PI;

use alhazen::description::{CameraDesc, CameraKind, TransformDesc};
use alhazen::math::{DMat4, DVec3};

/// The least angle in radians between the direction of view and the vertical.
const LEAST_TILT: f64 = 0.02;

/// How the mouse and the keys move a camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// Around the point that it looks at.
    #[default]
    Orbit,
    /// Anywhere.
    Fly,
    /// At a constant height.
    Walk,
}

impl Mode {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Orbit, Self::Fly, Self::Walk];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Orbit => "orbit",
            Self::Fly => "fly",
            Self::Walk => "walk",
        }
    }
}

/// A camera that can be moved. Angles are in radians, distances in units of the scene.
#[derive(Clone, Debug)]
pub struct Flight {
    home: CameraDesc,
    camera: CameraDesc,
    home_focus: DVec3,
    focus: DVec3,
    up: DVec3,
}

impl Flight {
    /// A flight that begins at a camera of the scene, which looks at `focus`. Up is the axis of the
    /// world that is closest to its upward direction.
    pub fn new(home: CameraDesc, focus: DVec3) -> Self {
        let upward = home.camera_from_world.inverse().start.y_axis.truncate();
        let axis = upward.abs().max_element();
        let up = DVec3::select(upward.abs().cmpge(DVec3::splat(axis)), upward.signum(), DVec3::ZERO);
        // Where two axes are equally close, the last one counts.
        let up = [DVec3::Z, DVec3::Y, DVec3::X].map(|axis| axis * up.dot(axis));
        let up = up.into_iter().find(|up| *up != DVec3::ZERO).unwrap_or(DVec3::Y);
        Self { camera: home.clone(), home, home_focus: focus, focus, up }
    }

    /// The camera where it is now.
    pub fn camera(&self) -> &CameraDesc {
        &self.camera
    }

    /// The point around which it orbits.
    pub fn focus(&self) -> DVec3 {
        self.focus
    }

    /// Where it is.
    pub fn position(&self) -> DVec3 {
        self.matrix().w_axis.truncate()
    }

    /// Where it looks, as a unit vector.
    pub fn forward(&self) -> DVec3 {
        self.matrix().z_axis.truncate().normalize_or(DVec3::Z)
    }

    /// Its distance from the focus.
    pub fn distance(&self) -> f64 {
        self.position().distance(self.focus)
    }

    /// Back to the scene's camera.
    pub fn go_home(&mut self) {
        (self.camera, self.focus) = (self.home.clone(), self.home_focus);
    }

    /// Around the focus, which it keeps in view: to its right by `angle`, and up by `tilt`.
    pub fn orbit(&mut self, angle: f64, tilt: f64) {
        self.turn(self.focus, -self.hand() * angle, tilt);
    }

    /// Looks to its right by `angle`, and up by `tilt`. The focus moves with it.
    pub fn look(&mut self, angle: f64, tilt: f64) {
        let distance = self.distance();
        self.turn(self.position(), self.hand() * angle, -tilt);
        self.focus = self.position() + self.forward() * distance;
    }

    /// Along its own axes: to the right, up and forward.
    pub fn fly(&mut self, [right, up, forward]: [f64; 3]) {
        let matrix = self.matrix();
        let axis = |column: DVec3| column.normalize_or_zero();
        self.shift(
            axis(matrix.x_axis.truncate()) * right
                + axis(matrix.y_axis.truncate()) * up
                + self.forward() * forward,
        );
    }

    /// To the right and forward at the same height, however it looks.
    pub fn walk(&mut self, right: f64, forward: f64) {
        let level = |v: DVec3| (v - self.up * v.dot(self.up)).normalize_or_zero();
        let matrix = self.matrix();
        self.shift(level(matrix.x_axis.truncate()) * right + level(self.forward()) * forward);
    }

    /// Towards the focus: the distance is multiplied by `factor`.
    pub fn approach(&mut self, factor: f64) {
        let away = self.position() - self.focus;
        self.place(DMat4::from_translation(away * (factor - 1.0)) * self.matrix());
    }

    /// Turns the camera towards a point of the world, which becomes the focus.
    pub fn look_at(&mut self, focus: DVec3) {
        let (position, forward) = (self.position(), self.forward());
        let Some(towards) = (focus - position).try_normalize() else { return };
        self.focus = focus;
        let level = |v: DVec3| v - self.up * v.dot(self.up);
        let sine = self.up.dot(forward.cross(towards));
        let angle = sine.atan2(level(forward).dot(level(towards)));
        self.turn(position, angle, self.height_angle(forward) - self.height_angle(towards));
    }

    /// The field of view in degrees, of cameras that have one.
    pub fn fov(&self) -> Option<f32> {
        match self.camera.kind {
            CameraKind::Perspective { fov, .. } => Some(fov),
            _ => None,
        }
    }

    /// Changes the field of view, if the camera has one.
    pub fn set_fov(&mut self, degrees: f32) {
        if let CameraKind::Perspective { fov, .. } = &mut self.camera.kind {
            *fov = degrees;
        }
    }

    /// World from camera space.
    fn matrix(&self) -> DMat4 {
        self.camera.camera_from_world.start.inverse()
    }

    /// 1 for a camera of the format, whose right is up × forward, −1 for a mirrored one.
    fn hand(&self) -> f64 {
        self.matrix().determinant().signum()
    }

    /// Rotates the camera by `angle` about the vertical through a point, and moves it up by `tilt`
    /// as seen from there. It never looks straight up or down.
    fn turn(&mut self, centre: DVec3, angle: f64, tilt: f64) {
        let matrix = self.matrix();
        let forward = self.forward();
        // A camera that moves up looks more downwards.
        let height = self.height_angle(forward);
        let most = PI / 2.0 - LEAST_TILT;
        let tilt = height - (height - tilt).clamp(-most.max(-height), most.max(height));
        let level = forward.cross(self.up).try_normalize().unwrap_or(matrix.x_axis.truncate());
        let turn = DMat4::from_axis_angle(self.up, angle) * DMat4::from_axis_angle(level, -tilt);
        let about = DMat4::from_translation(centre) * turn * DMat4::from_translation(-centre);
        self.place(about * matrix);
    }

    /// The angle of a direction above the horizontal.
    fn height_angle(&self, direction: DVec3) -> f64 {
        direction.dot(self.up).clamp(-1.0, 1.0).asin()
    }

    fn shift(&mut self, by: DVec3) {
        self.focus += by;
        self.place(DMat4::from_translation(by) * self.matrix());
    }

    /// A camera that was moved does not move by itself any more.
    fn place(&mut self, world_from_camera: DMat4) {
        self.camera.camera_from_world = TransformDesc::fixed(world_from_camera.inverse());
    }
}
