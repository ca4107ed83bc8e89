//! When a picture is shown while it is rendered.

use std::time::{Duration, Instant};

/// The first preview.
const FIRST: Duration = Duration::from_millis(500);

/// The longest time between two previews.
const LONGEST: Duration = Duration::from_secs(60);

/// The shortest time between two of them.
const SHORTEST: Duration = Duration::from_millis(250);

/// The least ratio of the time between two previews to the time that showing one takes.
const SHARE: u32 = 20;

/// The times of previews: after the first pass that ends more than half a second after the start,
/// and then whenever the time of rendering has doubled, or a minute has passed; and when one is
/// asked for. They take at most a twentieth of the time.
#[derive(Debug)]
pub struct PreviewSchedule {
    begin: Instant,
    /// When the next one is due.
    next: Duration,
    /// When the next one may be shown if somebody asks for it.
    soonest: Duration,
}

impl PreviewSchedule {
    /// Of a render that begins now.
    pub fn begin() -> Self {
        Self { begin: Instant::now(), next: FIRST, soonest: Duration::ZERO }
    }

    /// Shows the picture if that is due; to be called after each pass. `is_asked` says whether
    /// somebody asks for it.
    pub fn after_pass(&mut self, is_asked: bool, show: impl FnOnce()) {
        let elapsed = self.begin.elapsed();
        if elapsed < if is_asked { self.soonest } else { self.next } {
            return;
        }
        show();
        let end = self.begin.elapsed();
        let rest = SHARE * (end - elapsed);
        self.soonest = end + rest.max(SHORTEST);
        self.next = end + elapsed.min(LONGEST).max(rest);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_preview_is_shown_when_it_is_due_or_asked_for() {
        let mut schedule = PreviewSchedule::begin();
        let mut shown = 0;
        schedule.after_pass(false, || shown += 1);
        assert_eq!(shown, 0);
        schedule.after_pass(true, || shown += 1);
        assert_eq!(shown, 1);
        // Asking again and again does not slow the render.
        schedule.after_pass(true, || shown += 1);
        assert_eq!(shown, 1);
        schedule.next = schedule.begin.elapsed();
        schedule.after_pass(false, || std::thread::sleep(Duration::from_millis(20)));
        assert!(schedule.soonest >= Duration::from_millis(420) && schedule.next >= schedule.soonest);
    }
}
