//! The panels beside the picture: a file for each group of controls.

mod camera;
mod paths;
mod picture;
mod rendering;
mod scene;

pub use camera::camera;
pub use paths::paths;
pub use picture::picture;
pub use rendering::rendering;
pub use scene::scene;

use eframe::egui::{CollapsingHeader, RichText, Ui};

/// A group of controls under a head.
fn group(ui: &mut Ui, name: &str, contents: impl FnOnce(&mut Ui)) {
    ui.push_id(name, |ui| {
        let head = CollapsingHeader::new(RichText::new(name).strong()).default_open(true);
        head.show_unindented(ui, |ui| {
            ui.add_space(2.0);
            contents(ui);
            ui.add_space(6.0);
        });
    });
}
