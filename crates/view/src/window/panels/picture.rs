//! How colours are shown, and files.

use alhazen::image::DisplayView;
use eframe::egui::{Color32, ComboBox, RichText, Slider, TextEdit, Ui};

use super::group;
use crate::window::state::State;

/// Exposure and display view, and the files of picture and camera.
pub fn picture(ui: &mut Ui, state: &mut State) {
    group(ui, "Picture", |ui| {
        ui.add(Slider::new(&mut state.display.exposure, -8.0..=8.0).text("exposure").suffix(" EV"));
        ui.horizontal(|ui| {
            let chosen = &mut state.display.view;
            ComboBox::from_id_salt("view").width(150.0).selected_text(chosen.name()).show_ui(ui, |ui| {
                for view in DisplayView::ALL {
                    ui.selectable_value(chosen, view, view.name());
                }
            });
            ui.label("view");
        });
    });
    group(ui, "Save", |ui| {
        ui.add(TextEdit::singleline(&mut state.file).desired_width(f32::INFINITY));
        ui.horizontal(|ui| {
            if ui.button("picture").on_hover_text("in the format of the name's extension").clicked() {
                state.save_picture();
            }
            if ui.button("camera").on_hover_text("as pbrt text, beside the picture").clicked() {
                state.save_camera();
            }
        });
        let note = state.note.clone().or(state.output.note.clone().map(Ok));
        match note {
            Some(Ok(note)) => drop(ui.small(note)),
            Some(Err(problem)) => drop(ui.label(RichText::new(problem).color(Color32::LIGHT_RED))),
            None => (),
        }
    });
}
