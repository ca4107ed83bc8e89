//! The rasterised side of the picture: a thread that draws, and the slider between the two.

use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};

use alhazen::image::DisplaySettings;
use alhazen::math::Bounds2i;
use eframe::egui::{Align2, Color32, Context, CursorIcon, FontId, Rect, Sense, Stroke, Ui, pos2, vec2};

use super::picture::Picture;
use crate::{Frame, Rasterized, Shot, World};

/// Half the width in points of where the slider can be taken.
const GRIP: f32 = 8.0;

/// What the thread has found.
#[derive(Clone, Default)]
struct Found {
    frame: Option<Arc<Frame>>,
    /// The triangles and sprites of it.
    counts: [u64; 2],
    /// The GPU.
    device: String,
    problem: Option<String>,
}

/// The rasterised side.
pub struct Split {
    sender: Sender<(Arc<World>, Shot)>,
    found: Arc<Mutex<Found>>,
    picture: Picture,
    /// The scene that was shown last.
    shown: Option<Arc<World>>,
    /// Where the slider is, as a share of the width.
    share: f32,
}

impl Split {
    /// Starts the thread, which calls `wake` after each picture.
    pub fn start(share: f32, wake: impl Fn() + Clone + Send + 'static) -> Self {
        let (sender, receiver) = channel::<(Arc<World>, Shot)>();
        let found = Arc::new(Mutex::new(Found::default()));
        let (told, picture) = (Arc::clone(&found), Picture::start(wake.clone()));
        std::thread::spawn(move || {
            let mut rasterized: Option<Rasterized> = None;
            while let Ok(mut next) = receiver.recv() {
                // The latest counts.
                while let Ok(later) = receiver.try_recv() {
                    next = later;
                }
                let (world, shot) = next;
                let next = draw(&mut rasterized, world, &shot);
                let mut found = told.lock().unwrap_or_else(PoisonError::into_inner);
                match next {
                    Ok(next) => *found = next,
                    Err(problem) => found.problem = Some(problem),
                }
                drop(found);
                wake();
            }
        });
        Self { sender, found, picture, shown: None, share }
    }

    /// Draws a shot.
    pub fn show(&mut self, world: &Arc<World>, shot: &Shot) {
        self.shown = Some(Arc::clone(world));
        // The thread ends only with this.
        let _ = self.sender.send((Arc::clone(world), shot.clone()));
    }

    /// Takes what is new; draws a scene that has changed.
    pub fn refresh(&mut self, context: &Context, world: &Arc<World>, shot: &Shot, display: DisplaySettings) {
        if self.shown.as_ref().is_none_or(|shown| !Arc::ptr_eq(shown, world)) {
            self.show(world, shot);
        }
        let frame = self.found().frame;
        self.picture.refresh(context, frame.as_ref(), display);
    }

    /// Paints the right side over the picture in `place`, and moves the slider.
    pub fn paint(&mut self, ui: &mut Ui, place: Rect, bounds: &Bounds2i) {
        let at = |share: f32| place.left() + share * place.width();
        let grip =
            Rect::from_center_size(pos2(at(self.share), place.center().y), vec2(2.0 * GRIP, place.height()));
        let response = ui.interact(grip, ui.scope_id().with("slider"), Sense::drag());
        if let Some(pointer) = response.interact_pointer_pos().filter(|_| response.dragged()) {
            self.share = ((pointer.x - place.left()) / place.width()).clamp(0.0, 1.0);
        }
        response.on_hover_and_drag_cursor(CursorIcon::ResizeHorizontal);
        let x = at(self.share);
        let right = Rect::from_min_max(pos2(x, place.top()), place.max);
        let painter = ui.painter().with_clip_rect(right);
        match self.picture.texture() {
            Some((texture, frame)) => {
                let [min, max] = frame.part(bounds).map(|[u, v]| pos2(u, v));
                painter.image(texture.id(), place, Rect::from_min_max(min, max), Color32::WHITE);
            }
            None => {
                painter.rect_filled(right, 0.0, Color32::from_gray(28));
            }
        }
        let found = self.found();
        let font = FontId::proportional(13.0);
        let label = |x: f32, align: Align2, text: String| {
            let y = place.top() + 8.0;
            ui.painter().text(pos2(x + 1.0, y + 1.0), align, &text, font.clone(), Color32::BLACK);
            ui.painter().text(pos2(x, y), align, text, font.clone(), Color32::WHITE);
        };
        label(x - 10.0, Align2::RIGHT_TOP, "ray traced".into());
        label(
            x + 10.0,
            Align2::LEFT_TOP,
            match (&found.problem, &found.frame) {
                (Some(problem), _) => problem.clone(),
                (None, Some(frame)) => format!("rasterised, {:.1} ms", frame.time.as_secs_f64() * 1e3),
                (None, None) => "preparing …".into(),
            },
        );
        let line = [pos2(x, place.top()), pos2(x, place.bottom())];
        ui.painter().line_segment(line, Stroke::new(2.0, Color32::WHITE));
    }

    /// What it draws on, and how much, in words.
    pub fn summary(&self) -> Option<(String, String)> {
        let Found { frame, counts: [triangles, sprites], device, .. } = self.found();
        let time = frame?.time.as_secs_f64() * 1e3;
        let millions = triangles as f64 / 1e6;
        Some((format!("{time:.1} ms, {millions:.1} M triangles, {sprites} sprites"), device))
    }

    fn found(&self) -> Found {
        self.found.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// Draws a shot of a scene, which is taken to the GPU if it is another one.
fn draw(rasterized: &mut Option<Rasterized>, world: Arc<World>, shot: &Shot) -> Result<Found, String> {
    let mut scene = match rasterized.take() {
        Some(scene) if Arc::ptr_eq(scene.world(), &world) => scene,
        Some(other) => Rasterized::new(world, Arc::clone(other.device()))?,
        None => Rasterized::new(world, Rasterized::open()?)?,
    };
    let drawn = scene.draw(shot);
    let device = scene.device().name().to_owned();
    *rasterized = Some(scene);
    let drawn = drawn?;
    let counts = [drawn.triangles, drawn.sprites];
    Ok(Found { frame: Some(Arc::new(drawn.frame)), counts, device, problem: None })
}
