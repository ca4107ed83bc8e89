//! Lights and materials.

use eframe::egui::{CollapsingHeader, DragValue, Slider, Ui};

use super::group;
use crate::knobs::{Knob, Thing, Value, lights, materials};
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
    for (index, mut thing) in things.into_iter().enumerate() {
        let head = CollapsingHeader::new(&thing.name).id_salt(index).default_open(is_open);
        head.show(ui, |ui| {
            thing.visit(|knob| {
                ui.horizontal(|ui| has_changed |= turn(ui, knob));
            });
        });
    }
    has_changed
}

/// Shows the control of a value; returns whether it was changed.
fn turn(ui: &mut Ui, mut knob: Knob<'_>) -> bool {
    let changed = match knob.value {
        Value::Color(mut rgb) => ui.color_edit_button_rgb(&mut rgb).changed().then_some(Value::Color(rgb)),
        Value::Light(rgb) => {
            // The button has colours up to 1.
            let most = rgb.into_iter().fold(f32::MIN_POSITIVE, f32::max);
            let mut shown = rgb.map(|part| part / most);
            let has_changed = ui.color_edit_button_rgb(&mut shown).changed();
            has_changed.then(|| Value::Light(shown.map(|part| part * most)))
        }
        Value::Number(mut number) => {
            let [least, most] = knob.field.domain.bounds();
            let response = if most - least <= 1e3 {
                ui.add(Slider::new(&mut number, least..=most))
            } else {
                let speed = 0.01 * number.abs().max(0.01);
                ui.add(DragValue::new(&mut number).range(least.max(-1e9)..=most.min(1e9)).speed(speed))
            };
            response.changed().then_some(Value::Number(number))
        }
    };
    ui.label(knob.field.name).on_hover_text(knob.field.help);
    changed.map(|value| knob.set(value)).is_some()
}
