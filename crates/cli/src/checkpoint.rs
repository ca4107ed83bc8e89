//! Checkpoints: the film file of a render, saved again and again while it runs.

use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use alhazen::film::{FilmFile, FilmHeader, ReadLimits};
use alhazen::image::replace_file_with;
use alhazen::integrators::Session;
use alhazen::{Header, RenderOrder, SavedRender};

use crate::failure::{Failure, about_file};

/// A pass that takes this many times as long as saving is saved at once.
const LONG_PASS: u32 = 20;

/// Saves a render.
pub struct Checkpoint {
    path: PathBuf,
    every: Duration,
    order: RenderOrder,
    header: Header,
    saved_at: Instant,
    last_pass_at: Instant,
    /// The time that the last save took.
    saving: Duration,
    /// Passes at the last attempt to save, and its result.
    last: (u32, Result<(), Failure>),
}

impl Checkpoint {
    /// For a render that holds `passes` passes, as does the file if it exists.
    pub fn new(path: PathBuf, every: Duration, order: RenderOrder, header: Header, passes: u32) -> Self {
        remove_leftovers(&path);
        let now = Instant::now();
        Self {
            path,
            every,
            order,
            header,
            saved_at: now,
            last_pass_at: now,
            saving: Duration::ZERO,
            last: (passes, Ok(())),
        }
    }

    /// The film file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Saves the render after a pass that took much longer than saving does, or if the interval
    /// would be exceeded at the end of the next one. Returns whether all passes that are done are
    /// saved. A failure is reported by [`finish`](Self::finish), if it persists until then.
    pub fn after_pass(&mut self, session: &Session) -> bool {
        let now = Instant::now();
        let pass = now - self.last_pass_at;
        self.last_pass_at = now;
        if pass >= LONG_PASS * self.saving || now - self.saved_at + pass >= self.every {
            self.save(session);
        }
        self.has(session)
    }

    /// Saves the whole render at its end.
    pub fn finish(&mut self, session: &Session) -> Result<(), Failure> {
        if !self.has(session) || !self.path.exists() {
            self.save(session);
        }
        std::mem::replace(&mut self.last.1, Ok(()))
    }

    fn has(&self, session: &Session) -> bool {
        self.last.0 == session.state().done.count() && self.last.1.is_ok()
    }

    /// Saves the render.
    pub fn save(&mut self, session: &Session) {
        let begin = Instant::now();
        let saved = replace_file_with(&self.path, |file| {
            self.order.write(session, &self.header, BufWriter::new(file)).map(|_| ())
        });
        let saved = saved.map_err(|error| about_file(&self.path, error));
        self.last = (session.state().done.count(), saved);
        // The time that saving takes does not count for the interval.
        self.saved_at = Instant::now();
        self.last_pass_at = self.saved_at;
        self.saving = self.saved_at - begin;
    }
}

/// Reads a film file.
pub fn read(path: &Path) -> Result<SavedRender, Failure> {
    let (file, limits) = open(path)?;
    SavedRender::read(file, &limits).map_err(|error| about_file(path, error))
}

/// The header of a film file.
pub fn header(path: &Path) -> Result<FilmHeader, Failure> {
    FilmFile::read_header(open(path)?.0).map_err(|error| about_file(path, error))
}

/// Opens a film file, with the limits that its length sets.
pub fn open(path: &Path) -> Result<(BufReader<File>, ReadLimits), Failure> {
    let open = || {
        let file = File::open(path)?;
        let limits = ReadLimits::for_file(file.metadata()?.len());
        Ok((BufReader::new(file), limits))
    };
    open().map_err(|error: std::io::Error| about_file(path, error))
}

/// Removes the temporary files of programs that were killed while saving the film file.
fn remove_leftovers(path: &Path) {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let start = format!(".{}.", path.file_name().unwrap_or_default().to_string_lossy());
    for entry in folder.read_dir().into_iter().flatten().flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let id = name.strip_prefix(&start).and_then(|rest| rest.strip_suffix(".part"));
        if id.is_some_and(|id| id.bytes().all(|byte| byte.is_ascii_digit() || byte == b'-')) {
            // A leftover does no harm.
            let _ = std::fs::remove_file(entry.path());
        }
    }
}
