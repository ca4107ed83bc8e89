//! The window of a planet: its picture, the speed, and the keys of the walk.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Instant;

use alhazen::image::DisplaySettings;
use alhazen::integrators::Control;
use alhazen::system_clock;
use eframe::egui::{
    Align2, CentralPanel, Color32, FontId, Frame as Margins, Key, PointerButton, Rect, Sense, Ui, pos2, vec2,
};

use super::picture::Picture;
use crate::Frame;
use crate::planet::{Input, Outing, STEP};

/// Radians per point that the mouse moves, and per second that a key is held.
const TURN: f32 = 0.005;
const KEY_TURN: f32 = 1.8;

/// The most steps between two pictures: where they take longer, time passes more slowly.
const MOST_STEPS: u32 = 2;

const HELP: &str = "W A S D walk · arrows, drag: look around · shift runs · space jumps · F throws";

/// What the walker is told, and the latest picture.
#[derive(Default)]
struct Exchange {
    input: Input,
    turn: [f32; 2],
    blasts: bool,
    frame: Option<Arc<Frame>>,
    moving: usize,
    problem: Option<String>,
}

fn locked(exchange: &Mutex<Exchange>) -> MutexGuard<'_, Exchange> {
    exchange.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A thread on which the planet moves and is rendered, picture by picture. It ends when this is
/// dropped.
struct Walk {
    exchange: Arc<Mutex<Exchange>>,
    cancel: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Walk {
    fn start(mut outing: Outing, wake: impl Fn() + Send + 'static) -> Self {
        let (exchange, cancel) = (Arc::<Mutex<Exchange>>::default(), Arc::<AtomicBool>::default());
        let control = Control::new(Arc::clone(&cancel), system_clock());
        let (shared, stop) = (Arc::clone(&exchange), Arc::clone(&cancel));
        let run = move || {
            let (mut last, mut left) = (Instant::now(), 0.0);
            while !stop.load(Ordering::SeqCst) {
                let (input, [right, up], blasts) = {
                    let mut exchange = locked(&shared);
                    let turn = std::mem::take(&mut exchange.turn);
                    (exchange.input, turn, std::mem::take(&mut exchange.blasts))
                };
                outing.turn(right, up);
                if blasts {
                    outing.blast();
                }
                let now = Instant::now();
                left += (now - last).as_secs_f32();
                last = now;
                let steps = (left / STEP) as u32;
                left = if steps > MOST_STEPS { 0.0 } else { left - steps as f32 * STEP };
                let rendered = outing.frame(&input, steps.min(MOST_STEPS), &control);
                let mut exchange = locked(&shared);
                exchange.moving = outing.planet().moving();
                match rendered {
                    Ok((frame, _)) => exchange.frame = Some(Arc::new(frame)),
                    Err(crate::StepError::Problem(problem)) => exchange.problem = Some(problem),
                    Err(crate::StepError::Cancelled) => (),
                }
                let has_failed = exchange.problem.is_some();
                drop(exchange);
                wake();
                if has_failed {
                    break;
                }
            }
        };
        Self { exchange, cancel, thread: Some(std::thread::spawn(run)) }
    }
}

impl Drop for Walk {
    fn drop(&mut self) {
        self.cancel.store(true, Ordering::SeqCst);
        // A panic of the thread has been reported by it.
        let _ = self.thread.take().map(JoinHandle::join);
    }
}

/// The window.
pub(super) struct PlanetWindow {
    walk: Walk,
    picture: Picture,
    display: DisplaySettings,
    spheres: usize,
}

impl PlanetWindow {
    /// Begins the walk; `wake` is called when there is a new picture.
    pub fn new(outing: Outing, display: DisplaySettings, wake: impl Fn() + Clone + Send + 'static) -> Self {
        let spheres = outing.planet().bodies().len();
        let walk = Walk::start(outing, wake.clone());
        Self { walk, picture: Picture::start(wake), display, spheres }
    }

    /// Tells the walker what keys and mouse say.
    fn tell(&self, ui: &Ui, drag: [f32; 2]) {
        let (input, turn, blasts) = ui.input(|input| {
            let held = |key| if input.key_down(key) { 1.0 } else { 0.0 };
            let keys =
                [held(Key::ArrowRight) - held(Key::ArrowLeft), held(Key::ArrowUp) - held(Key::ArrowDown)];
            let seconds = input.stable_dt.min(0.1);
            let walk = Input {
                forward: held(Key::W) - held(Key::S),
                right: held(Key::D) - held(Key::A),
                runs: input.modifiers.shift,
                jumps: input.key_down(Key::Space),
            };
            let turn = [
                drag[0] * TURN + keys[0] * KEY_TURN * seconds,
                keys[1] * KEY_TURN * seconds - drag[1] * TURN,
            ];
            (walk, turn, input.key_pressed(Key::F))
        });
        let mut exchange = locked(&self.walk.exchange);
        exchange.input = input;
        exchange.turn = [exchange.turn[0] + turn[0], exchange.turn[1] + turn[1]];
        exchange.blasts |= blasts;
    }

    fn status(&self, frame: &Frame) -> String {
        let (seconds, exchange) = (frame.time.as_secs_f64().max(1e-9), locked(&self.walk.exchange));
        format!(
            "{:.0} fps, {:.1} ms · {} spheres, {} move · {:.1} M rays/s",
            1.0 / seconds,
            1e3 * seconds,
            self.spheres,
            exchange.moving,
            frame.rays as f64 / seconds / 1e6,
        )
    }
}

impl eframe::App for PlanetWindow {
    fn ui(&mut self, ui: &mut Ui, _: &mut eframe::Frame) {
        let frame = locked(&self.walk.exchange).frame.clone();
        self.picture.refresh(ui.ctx(), frame.as_ref(), self.display);
        CentralPanel::default().frame(Margins::NONE.fill(Color32::BLACK)).show(ui, |ui| {
            let space = ui.available_rect_before_wrap();
            let response = ui.allocate_rect(space, Sense::click_and_drag());
            let by = if response.dragged_by(PointerButton::Primary) {
                response.drag_delta()
            } else {
                vec2(0.0, 0.0)
            };
            self.tell(ui, [by.x, by.y]);
            let font = FontId::proportional(15.0);
            let text = |at, align, text: &str| {
                ui.painter().text(at + vec2(1.0, 1.0), align, text, font.clone(), Color32::BLACK);
                ui.painter().text(at, align, text, font.clone(), Color32::WHITE);
            };
            let problem = locked(&self.walk.exchange).problem.clone();
            match self.picture.texture() {
                Some((texture, frame)) => {
                    let size = vec2(frame.size[0] as f32, frame.size[1] as f32);
                    let scale = (space.width() / size.x).min(space.height() / size.y);
                    let rect = Rect::from_center_size(space.center(), size * scale);
                    let all = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
                    ui.painter().image(texture.id(), rect, all, Color32::WHITE);
                    text(space.left_top() + vec2(10.0, 8.0), Align2::LEFT_TOP, &self.status(frame));
                    text(space.left_bottom() + vec2(10.0, -8.0), Align2::LEFT_BOTTOM, HELP);
                }
                None => text(space.center(), Align2::CENTER_CENTER, "rendering …"),
            }
            if let Some(problem) = problem {
                text(space.center(), Align2::CENTER_CENTER, &problem);
            }
        });
        ui.ctx().request_repaint();
    }
}
