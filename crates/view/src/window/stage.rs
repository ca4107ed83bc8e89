//! The picture in the middle, with the paths of a pixel, and the motions of mouse and keys.

use eframe::egui::{
    Align2, Color32, FontId, Key, PointerButton, Pos2, Rect, Response, Sense, Stroke, Ui, Vec2, pos2, vec2,
};

use super::state::State;
use crate::Mode;
use crate::lines::{Projector, vertices};

/// Radians per point that the mouse moves.
const TURN: f64 = 0.006;

/// Where the picture is on the screen.
struct Place {
    rect: Rect,
    /// Film position of its upper left corner, and points per pixel of the film.
    first: [f32; 2],
    scale: f32,
}

impl Place {
    /// As large as fits, with the right proportions.
    fn new(space: Rect, state: &State) -> Self {
        let bounds = state.bounds();
        let [width, height] = [bounds.width().max(1) as f32, bounds.height().max(1) as f32];
        let scale = (space.width() / width).min(space.height() / height);
        let rect = Rect::from_center_size(space.center(), vec2(width, height) * scale);
        Self { rect, first: bounds.min.map(|x| x as f32), scale }
    }

    fn film(&self, at: Pos2) -> [f32; 2] {
        let from = (at - self.rect.min) / self.scale;
        [self.first[0] + from.x, self.first[1] + from.y]
    }

    fn point(&self, film: [f32; 2]) -> Pos2 {
        self.rect.min + vec2(film[0] - self.first[0], film[1] - self.first[1]) * self.scale
    }
}

/// The picture, which takes the motions of the mouse.
pub fn stage(ui: &mut Ui, state: &mut State) {
    let place = Place::new(ui.available_rect_before_wrap(), state);
    let response = ui.allocate_rect(place.rect, Sense::click_and_drag());
    if let Some((texture, frame)) = state.picture.texture() {
        let [min, max] = frame.part(&state.bounds()).map(|[u, v]| pos2(u, v));
        ui.painter().image(texture.id(), place.rect, Rect::from_min_max(min, max), Color32::WHITE);
    } else {
        let font = FontId::proportional(16.0);
        ui.painter().text(place.rect.center(), Align2::CENTER_CENTER, "rendering …", font, Color32::GRAY);
    }
    paths(ui, state, &place);
    let bounds = state.bounds();
    if let Some(split) = &mut state.split {
        split.paint(ui, place.rect, &bounds);
    }
    mouse(ui, state, &place, &response);
}

/// Draws the paths of the pixel over the picture.
fn paths(ui: &Ui, state: &State, place: &Place) {
    let (Some(trace), Some((_, frame))) = (&state.output.trace, state.picture.texture()) else { return };
    let painter = ui.painter().with_clip_rect(place.rect);
    let projector = Projector::new(state.output.world.scene(), frame);
    for (ends, kind) in projector.lines(trace) {
        let ends = ends.map(|end| place.point(end));
        let [r, g, b] = kind.color();
        painter.line_segment(ends, Stroke::new(3.0, Color32::from_black_alpha(90)));
        // Brighter than on paper.
        let color = Color32::from_rgb(r.saturating_add(60), g.saturating_add(60), b.saturating_add(60));
        painter.line_segment(ends, Stroke::new(1.5, color));
    }
    for vertex in trace.samples.iter().flat_map(vertices) {
        let Some(film) = vertex.p.and_then(|p| projector.film(p)) else { continue };
        let at = place.point(film);
        painter.circle_filled(at, 7.0, Color32::from_black_alpha(170));
        let (font, number) = (FontId::proportional(10.0), vertex.number.to_string());
        painter.text(at, Align2::CENTER_CENTER, number, font, Color32::WHITE);
    }
}

fn mouse(ui: &Ui, state: &mut State, place: &Place, response: &Response) {
    let by = response.drag_delta();
    let [x, y] = [by.x, by.y].map(|points| f64::from(points) * TURN);
    let (is_shifted, scroll) = ui.input(|input| (input.modifiers.shift, input.smooth_scroll_delta.y));
    let mut has_moved = by != Vec2::ZERO;
    if has_moved {
        let pans = is_shifted || response.dragged_by(PointerButton::Middle);
        match state.mode {
            _ if pans => {
                let shift = state.flight.distance() * 0.3;
                state.flight.fly([-x * shift, y * shift, 0.0]);
            }
            Mode::Orbit => state.flight.orbit(-x, y),
            Mode::Fly | Mode::Walk => state.flight.look(x, -y),
        }
    }
    if response.hovered() && scroll != 0.0 {
        let factor = (-0.002 * f64::from(scroll)).exp();
        match state.mode {
            Mode::Orbit => {
                state.flight.approach(factor);
                has_moved = true;
            }
            Mode::Fly | Mode::Walk => state.speed /= factor,
        }
    }
    if has_moved {
        state.aim();
    }
    let Some(at) = response.interact_pointer_pos() else { return };
    if response.double_clicked() {
        state.look_at(place.film(at));
    }
    if response.secondary_clicked() {
        state.trace(Some(place.film(at).map(|x| x.floor() as i32)));
    }
}

/// Moves the camera by the keys that are held.
pub fn keys(ui: &Ui, state: &mut State) {
    if ui.ctx().egui_wants_keyboard_input() {
        return;
    }
    let (way, seconds, is_fast, goes_home) = ui.input(|input| {
        let held = |key| if input.key_down(key) { 1.0 } else { 0.0 };
        let way = [
            held(Key::D) - held(Key::A),
            held(Key::E) - held(Key::Q),
            held(Key::W) - held(Key::S) + held(Key::ArrowUp) - held(Key::ArrowDown),
        ];
        let turn = held(Key::ArrowRight) - held(Key::ArrowLeft);
        let seconds = f64::from(input.stable_dt.min(0.1));
        ((way, turn), seconds, input.modifiers.shift, input.key_pressed(Key::Home))
    });
    if goes_home {
        state.flight.go_home();
        state.aim();
    }
    let (way, turn) = way;
    if way == [0.0; 3] && turn == 0.0 {
        return;
    }
    let step = state.speed * seconds * if is_fast { 4.0 } else { 1.0 };
    let [right, up, forward] = way.map(|share| share * step);
    match state.mode {
        Mode::Walk => state.flight.walk(right, forward),
        Mode::Orbit | Mode::Fly => state.flight.fly([right, up, forward]),
    }
    state.flight.look(turn * seconds, 0.0);
    state.aim();
    ui.ctx().request_repaint();
}
