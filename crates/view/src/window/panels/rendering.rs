//! How fast it is, the algorithm and what it shows.

use std::time::Duration;

use alhazen::film::Layer;
use alhazen::integrator_names;
use eframe::egui::{Color32, ComboBox, Grid, ProgressBar, RichText, Ui};

use super::group;
use crate::window::split::Split;
use crate::window::state::State;
use crate::{Frame, layers};

/// The numbers of the picture, and the choice of the algorithm.
pub fn rendering(ui: &mut Ui, state: &mut State) {
    group(ui, "Rendering", |ui| {
        if let Some((_, frame)) = state.picture.texture() {
            numbers(ui, frame);
        }
        if let Some((numbers, device)) = state.split.as_ref().and_then(Split::summary) {
            ui.label(RichText::new(format!("rasterised: {numbers}")).small()).on_hover_text(device);
        }
        if let Some(problem) = &state.output.problem {
            ui.label(RichText::new(problem).color(Color32::LIGHT_RED));
        }
        let mut has_changed = false;
        Grid::new("algorithm").num_columns(2).show(ui, |ui| {
            ui.label("algorithm");
            let names = ComboBox::from_id_salt("integrator").selected_text(&state.shot.integrator);
            names.width(150.0).show_ui(ui, |ui| {
                for name in integrator_names() {
                    let chosen = &mut state.shot.integrator;
                    has_changed |= ui.selectable_value(chosen, name.to_owned(), name).changed();
                }
            });
            ui.end_row();
            ui.label("samples a pass");
            ui.horizontal(|ui| {
                for samples in [1, 4] {
                    let chosen = &mut state.shot.samples;
                    has_changed |= ui.selectable_value(chosen, samples, samples.to_string()).changed();
                }
            });
            ui.end_row();
            ui.label("shown");
            let name = |layer: Option<Layer>| layer.map_or("colour", Layer::name);
            let shown = ComboBox::from_id_salt("layer").selected_text(name(state.shot.layer));
            shown.width(150.0).show_ui(ui, |ui| {
                for layer in std::iter::once(None).chain(layers().map(Some)) {
                    let chosen = &mut state.shot.layer;
                    has_changed |= ui.selectable_value(chosen, layer, name(layer)).changed();
                }
            });
            ui.end_row();
        });
        if has_changed {
            state.aim();
        }
    });
}

fn numbers(ui: &mut Ui, frame: &Frame) {
    let seconds = frame.time.as_secs_f64().max(1e-9);
    let [width, height] = frame.size;
    let rays = frame.rays as f64 / seconds / 1e6;
    Grid::new("numbers").num_columns(2).show(ui, |ui| {
        let mut row = |name: &str, value: String| {
            ui.label(name);
            ui.monospace(value);
            ui.end_row();
        };
        row("frame", format!("{:.1} ms, {:.1} fps", 1e3 * seconds, 1.0 / seconds));
        row("rays", format!("{rays:.2} M/s"));
        if let Some(stages) = frame.stages {
            let ms = |time: Duration| 1e3 * time.as_secs_f64();
            let [trace, filter, rest] = [stages.trace, stages.filter, stages.rest].map(ms);
            row("of GPU", format!("{trace:.1} + {filter:.1} + {rest:.1} ms"));
        }
        row(
            "pixels",
            match frame.n {
                1 => format!("{width} × {height}"),
                n => format!("{width} × {height} (1/{n})"),
            },
        );
    });
    let (share, text) = match frame.n {
        1 => {
            let (done, planned) = (frame.samples, frame.planned);
            (done as f32 / planned.max(1) as f32, format!("{done} of {planned} samples"))
        }
        _ => (0.0, "draft".into()),
    };
    ui.add(ProgressBar::new(share).text(text));
    ui.add_space(4.0);
}
