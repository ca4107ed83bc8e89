//! The window: the picture between two panels. It asks the engine for what it shows, and never
//! waits for it.

mod panels;
mod picture;
mod planet;
mod split;
mod stage;
mod state;

use alhazen::description::SceneDesc;
use alhazen::image::DisplaySettings;
use eframe::egui::{CentralPanel, Color32, Frame, Margin, Panel, ScrollArea, Ui, ViewportBuilder, Visuals};

use crate::Renderer;
use crate::planet::Outing;
use planet::PlanetWindow;
use state::State;

/// The width of a panel in points.
const PANEL: f32 = 270.0;

/// Behind the picture.
const BACKGROUND: Color32 = Color32::from_gray(18);

/// Opens a window that shows a scene, as it is rendered and as its description for changes, until
/// it is closed. With `split`, the scene is rasterised to the right of a slider at this share of
/// the width. The error says why there is no window.
pub fn open(
    title: &str,
    renderer: Renderer,
    desc: SceneDesc,
    display: DisplaySettings,
    split: Option<f32>,
) -> Result<(), String> {
    let options = eframe::NativeOptions {
        viewport: ViewportBuilder::default().with_inner_size([1280.0, 800.0]).with_title(title),
        ..eframe::NativeOptions::default()
    };
    let create: eframe::AppCreator<'_> = Box::new(move |context| {
        context.egui_ctx.set_visuals(Visuals::dark());
        let repaint = context.egui_ctx.clone();
        let wake = move || repaint.request_repaint();
        Ok(Box::new(Window { state: State::new(renderer, desc, display, split, wake) }))
    });
    eframe::run_native("alhazen", options, create).map_err(|error| reason(&error))
}

/// Opens a window in which a planet is walked on, until it is closed. The error says why there is
/// no window.
pub fn open_planet(outing: Outing, display: DisplaySettings) -> Result<(), String> {
    let options = eframe::NativeOptions {
        viewport: ViewportBuilder::default().with_inner_size([1000.0, 750.0]).with_title("planet · alhazen"),
        ..eframe::NativeOptions::default()
    };
    let create: eframe::AppCreator<'_> = Box::new(move |context| {
        context.egui_ctx.set_visuals(Visuals::dark());
        let repaint = context.egui_ctx.clone();
        let wake = move || repaint.request_repaint();
        Ok(Box::new(PlanetWindow::new(outing, display, wake)))
    });
    eframe::run_native("alhazen", options, create).map_err(|error| reason(&error))
}

fn reason(error: &eframe::Error) -> String {
    let text = error.to_string();
    let reason = match error {
        // Before what the system says there is the place in the source of the library.
        eframe::Error::Winit(_) | eframe::Error::WinitEventLoop(_) => {
            text.rsplit(": ").next().unwrap_or_default().trim_end_matches('.')
        }
        _ => &text,
    };
    format!("cannot open a window: {reason}")
}

struct Window {
    state: State,
}

impl eframe::App for Window {
    fn ui(&mut self, ui: &mut Ui, _: &mut eframe::Frame) {
        let state = &mut self.state;
        state.refresh(ui.ctx());
        stage::keys(ui, state);
        let left = Panel::left("left").exact_size(PANEL).resizable(false);
        left.show(ui, |ui| {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                panels::rendering(ui, state);
                panels::camera(ui, state);
                panels::picture(ui, state);
            });
        });
        let right = Panel::right("right").exact_size(PANEL).resizable(false);
        right.show(ui, |ui| {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                panels::paths(ui, state);
                panels::scene(ui, state);
            });
        });
        let frame = Frame::NONE.fill(BACKGROUND).inner_margin(Margin::same(8));
        CentralPanel::default().frame(frame).show(ui, |ui| stage::stage(ui, state));
    }
}
