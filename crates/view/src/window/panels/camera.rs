//! The camera.

use eframe::egui::{Slider, Ui};

use super::group;
use crate::Mode;
use crate::window::state::State;

/// How the camera is moved, and where it is.
pub fn camera(ui: &mut Ui, state: &mut State) {
    group(ui, "Camera", |ui| {
        ui.horizontal(|ui| {
            for mode in Mode::ALL {
                ui.selectable_value(&mut state.mode, mode, mode.name());
            }
            if ui.button("home").on_hover_text("the scene's own camera (Home)").clicked() {
                state.flight.go_home();
                state.aim();
            }
        });
        if let Some(mut fov) = state.flight.fov()
            && ui.add(Slider::new(&mut fov, 5.0..=150.0).text("field of view").suffix("°")).changed()
        {
            state.flight.set_fov(fov);
            state.aim();
        }
        let around = 0.4 * state.flight.distance().max(1e-3);
        let range = 0.01 * around.min(state.speed)..=100.0 * around.max(state.speed);
        ui.add(Slider::new(&mut state.speed, range).logarithmic(true).text("speed"));
        let [x, y, z] = state.flight.position().to_array();
        ui.monospace(format!("at {x:.2}, {y:.2}, {z:.2}"));
        ui.small(match state.mode {
            Mode::Orbit => "drag: orbit · wheel: nearer · shift-drag: pan",
            Mode::Fly => "drag: look · W A S D Q E: fly · shift: fast",
            Mode::Walk => "drag: look · W A S D: walk · shift: fast",
        });
        ui.small("double click: look there · right click: its paths");
    });
}
