//! What goes from the render to those who watch it: the latest snapshot alone, so that one who is
//! slow misses snapshots instead of delaying the render.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, Weak};

use alhazen::image::PixelSource;
use alhazen::integrators::Progress;

use super::snapshot::Snapshot;

/// The most snapshots in memory: the latest one, and older ones that are still being sent. While
/// there are as many, no further one is taken.
const MOST_SNAPSHOTS: usize = 3;

/// The snapshots of one render.
#[derive(Default)]
pub struct Feed {
    state: Mutex<State>,
    changed: Condvar,
    /// Whether somebody has shown the latest snapshot, and waits for another.
    is_asked: AtomicBool,
}

#[derive(Default)]
struct State {
    latest: Option<Arc<Snapshot>>,
    /// Number of snapshots so far.
    revision: u32,
    /// Snapshots that may still be in memory.
    taken: Vec<Weak<Snapshot>>,
    progress: Option<Progress>,
    has_ended: bool,
    warnings: Vec<String>,
}

/// How far a render is.
pub struct Status {
    /// Its latest snapshot.
    pub latest: Option<Arc<Snapshot>>,
    /// Its progress; `None` before it begins.
    pub progress: Option<Progress>,
    /// Whether the latest snapshot is the last one.
    pub has_ended: bool,
}

impl Feed {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Asks for a snapshot.
    pub fn ask(&self) {
        self.is_asked.store(true, Ordering::Relaxed);
    }

    /// Whether somebody waits for a snapshot.
    pub fn is_asked(&self) -> bool {
        self.is_asked.load(Ordering::Relaxed)
    }

    /// Takes a snapshot of a picture, unless too many are in memory or there is none left.
    pub fn publish(&self, picture: &dyn PixelSource) {
        let is_full = {
            let taken = &mut self.state().taken;
            taken.retain(|snapshot| snapshot.strong_count() > 0);
            taken.len() >= MOST_SNAPSHOTS
        };
        if !is_full {
            self.take(picture);
        }
    }

    /// Takes a snapshot of the last picture, if there is memory for it.
    pub fn finish(&self, picture: &dyn PixelSource) {
        self.take(picture);
        self.state().has_ended = true;
        self.changed.notify_all();
    }

    fn take(&self, picture: &dyn PixelSource) {
        let revision = self.state().revision + 1;
        // Nobody waits for the lock while the picture is copied.
        let Some(snapshot) = Snapshot::take(picture, revision).map(Arc::new) else { return };
        self.is_asked.store(false, Ordering::Relaxed);
        let mut state = self.state();
        state.taken.push(Arc::downgrade(&snapshot));
        (state.latest, state.revision) = (Some(snapshot), revision);
        self.changed.notify_all();
    }

    /// Tells how far the render is.
    pub fn set_progress(&self, progress: Progress) {
        self.state().progress = Some(progress);
    }

    /// How far the render is.
    pub fn status(&self) -> Status {
        let state = self.state();
        Status { latest: state.latest.clone(), progress: state.progress, has_ended: state.has_ended }
    }

    /// Asks for a snapshot that is newer than one, and waits for it; `None` if the render has ended
    /// without.
    pub fn wait_for_newer(&self, revision: u32) -> Option<Arc<Snapshot>> {
        let mut state = self.state();
        loop {
            if state.revision > revision {
                return state.latest.clone();
            }
            if state.has_ended {
                return None;
            }
            self.ask();
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Leaves a warning for the user.
    pub fn warn(&self, warning: String) {
        self.state().warnings.push(warning);
    }

    /// The warnings since the last call.
    pub fn take_warnings(&self) -> Vec<String> {
        std::mem::take(&mut self.state().warnings)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alhazen::image::Image;

    #[test]
    fn those_who_are_slow_miss_snapshots() {
        let feed = Feed::default();
        let picture = |value: f32| Image::from_fn(2, 1, ["Y"], |_, _| [value]);
        let latest = || feed.status().latest.unwrap();
        let value = |snapshot: &Snapshot| {
            let mut row = [0.0; 2];
            snapshot.row(0, &mut row);
            row[1]
        };
        for count in 1..=4 {
            feed.publish(&picture(count as f32));
        }
        let slow = feed.wait_for_newer(0).unwrap();
        assert_eq!((slow.revision, value(&slow)), (4, 4.0));
        // One is being sent, another too; the latest is the third in memory.
        feed.publish(&picture(5.0));
        let other = feed.wait_for_newer(slow.revision).unwrap();
        feed.publish(&picture(6.0));
        feed.publish(&picture(7.0));
        assert_eq!(latest().revision, 6);
        drop(slow);
        feed.publish(&picture(8.0));
        assert_eq!((latest().revision, value(&latest())), (7, 8.0));
        // The last one is always taken.
        let _third = latest();
        feed.publish(&picture(9.0));
        feed.publish(&picture(10.0));
        assert_eq!(latest().revision, 8);
        feed.finish(&picture(11.0));
        let last = feed.wait_for_newer(other.revision).unwrap();
        assert_eq!((last.revision, value(&last)), (9, 11.0));
        assert!(feed.wait_for_newer(last.revision).is_none());
    }
}
