//! Lights and materials.

use eframe::egui::{CollapsingHeader, DragValue, Slider, Ui};

use super::group;
use crate::knobs::{Thing, Value, lights, materials};
use crate::window::state::State;

/// What can be changed of the scene. Changes show as soon as it is compiled again.
pub fn scene(ui: &mut Ui, state: &mut State) {
    let mut has_changed = false;
    group(ui, "Lights", |ui| has_changed |= things(ui, lights(&mut state.desc)));
    group(ui, "Materials", |ui| has_changed |= things(ui, materials(&mut state.desc)));
    let compiled_in = 1e3 * state.output.world.compiled_in.as_secs_f64();
    ui.small(format!("the scene was compiled in {compiled_in:.0} ms"));
    if has_changed {
        state.edit();
    }
}

fn things(ui: &mut Ui, things: Vec<Thing<'_>>) -> bool {
    if things.is_empty() {
        ui.weak("none");
    }
    let is_open = things.len() <= 6;
    let mut has_changed = false;
    for (index, Thing { name, knobs }) in things.into_iter().enumerate() {
        let head = CollapsingHeader::new(name).id_salt(index).default_open(is_open);
        head.show(ui, |ui| {
            for knob in knobs {
                ui.horizontal(|ui| has_changed |= turn(ui, knob.label, knob.value));
            }
        });
    }
    has_changed
}

/// Shows the control of a value; returns whether it was changed.
fn turn(ui: &mut Ui, label: &str, value: Value<'_>) -> bool {
    let has_changed = match value {
        Value::Color(mut color) => {
            let mut rgb = color.rgb();
            let has_changed = ui.color_edit_button_rgb(&mut rgb).changed();
            if has_changed {
                color.set(rgb);
            }
            has_changed
        }
        Value::Light(mut color) => {
            let rgb = color.rgb();
            // The button has colours up to 1.
            let most = rgb.into_iter().fold(f32::MIN_POSITIVE, f32::max);
            let mut shown = rgb.map(|part| part / most);
            let has_changed = ui.color_edit_button_rgb(&mut shown).changed();
            if has_changed {
                color.set(shown.map(|part| part * most));
            }
            has_changed
        }
        Value::Scale(scale) => {
            let speed = 0.01 * scale.max(0.01);
            ui.add(DragValue::new(scale).range(0.0..=1e9).speed(speed)).changed()
        }
        Value::Share(share) => ui.add(Slider::new(share, 0.0..=1.0)).changed(),
    };
    ui.label(label);
    has_changed
}
