//! The paths of a pixel.

use alhazen::trace::SampleTrace;
use eframe::egui::{CollapsingHeader, Color32, Sense, Slider, Ui, vec2};

use super::group;
use crate::lines::vertices;
use crate::window::state::State;

/// The paths of the pixel that was clicked, vertex by vertex.
pub fn paths(ui: &mut Ui, state: &mut State) {
    group(ui, "Paths of a pixel", |ui| {
        let mut has_changed = ui.add(Slider::new(&mut state.paths, 1..=64).text("paths")).changed();
        let Some(pixel) = state.pixel else {
            ui.weak("right click on the picture");
            return;
        };
        ui.horizontal(|ui| {
            ui.monospace(format!("{}, {}", pixel[0], pixel[1]));
            has_changed |= ui.button("again").clicked();
            if ui.button("clear").clicked() {
                state.trace(None);
            }
        });
        if has_changed && state.pixel.is_some() {
            state.trace(Some(pixel));
        }
        for sample in state.output.trace.iter().flat_map(|trace| &trace.samples) {
            let head = CollapsingHeader::new(format!("path {}", sample.index + 1)).id_salt(sample.index);
            head.default_open(sample.index == 0).show(ui, |ui| path(ui, sample));
        }
    });
}

fn path(ui: &mut Ui, sample: &SampleTrace) {
    for vertex in vertices(sample) {
        ui.horizontal_wrapped(|ui| {
            swatch(ui, vertex.rgb);
            ui.small(format!("{} {}", vertex.number, vertex.what));
            if vertex.rgb != [0.0; 3] {
                ui.small(format!("+ {}", numbers(vertex.rgb)));
            }
        });
    }
    ui.horizontal(|ui| {
        swatch(ui, sample.rgb);
        ui.small(format!("together {}", numbers(sample.rgb)));
    });
}

fn numbers(rgb: [f32; 3]) -> String {
    // Adding zero makes −0 a 0.
    rgb.map(|part| format!("{:.3}", (part * 1e3).round() / 1e3 + 0.0)).join(" ")
}

/// A square of a colour.
fn swatch(ui: &mut Ui, rgb: [f32; 3]) {
    let (rect, _) = ui.allocate_exact_size(vec2(10.0, 10.0), Sense::hover());
    let [r, g, b] = rgb.map(|part| part.clamp(0.0, 1.0));
    ui.painter().rect_filled(rect, 2.0, Color32::from(eframe::egui::Rgba::from_rgb(r, g, b)));
}
