//! Those who watch a render while it runs. Each has a thread of its own and gets the latest
//! snapshot alone, so that none of them delays the render.

#[cfg_attr(not(feature = "serve"), allow(dead_code, reason = "the server alone asks for all of it"))]
mod feed;
#[cfg_attr(not(feature = "serve"), path = "without_server.rs")]
mod serve;
mod snapshot;
mod tev;

use std::path::Path;
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use alhazen::image::PixelSource;
use alhazen::integrators::Session;
use alhazen::{Header, PreviewSchedule};

use crate::args::LiveOptions;
use crate::console::warn;
use crate::failure::Failure;
use crate::interrupt::Interrupt;

use self::feed::Feed;
use self::serve::Server;

/// How long the end of the program may wait for the last picture to arrive.
const LAST: Duration = Duration::from_secs(10);

/// Those who watch a render.
pub struct Live {
    feed: Arc<Feed>,
    schedule: PreviewSchedule,
    tev: Option<JoinHandle<()>>,
    server: Option<Server>,
    stays: bool,
}

impl Live {
    /// Starts what the options ask for; the picture is named after a file. Those who watch can
    /// interrupt the render.
    pub fn start(options: &LiveOptions, file: &Path, interrupt: &Interrupt) -> Result<Self, Failure> {
        let feed = Arc::new(Feed::default());
        let name = file.file_name().unwrap_or(file.as_os_str()).to_string_lossy();
        let tev = options.tev.clone().map(|address| {
            let (feed, name) = (Arc::clone(&feed), name.clone().into_owned());
            spawn("tev", move || tev::stream(&address, &name, &feed))
        });
        let tev = tev.transpose()?;
        let token = options.serve_token.as_deref();
        let server =
            options.serve.as_ref().map(|at| Server::start(&at.address, token, &name, &feed, interrupt));
        let server = server.transpose()?;
        if let Some(server) = &server {
            warn(format_args!("the picture is at {}", server.url()))?;
        }
        let stays = options.serve.as_ref().is_some_and(|at| at.stays);
        Ok(Self { feed, schedule: PreviewSchedule::begin(), tev, server, stays })
    }

    /// Whether anybody watches, or may do so.
    pub fn is_watched(&self) -> bool {
        self.server.is_some() || self.is_sending()
    }

    fn is_sending(&self) -> bool {
        self.tev.as_ref().is_some_and(|tev| !tev.is_finished())
    }

    /// Tells that the render begins.
    pub fn begin(&self, session: &Session) {
        self.feed.set_progress(session.progress());
    }

    /// Shows a picture before the first pass.
    pub fn show(&self, picture: &dyn PixelSource) {
        if self.is_watched() {
            self.feed.publish(picture);
        }
    }

    /// Shows the picture after a pass, if somebody waits for it or it is time.
    pub fn after_pass(&mut self, session: &Session, header: &Header) {
        if self.is_watched() {
            let feed = &self.feed;
            feed.set_progress(session.progress());
            let show = || feed.publish(&header.development(session.state()));
            self.schedule.after_pass(feed.is_asked(), show);
        }
    }

    /// Shows the last picture, and waits for a while until it has arrived. Where a page has ended
    /// the render of a server that stays, only the render has ended.
    pub fn finish(&self, picture: &dyn PixelSource, interrupt: &Interrupt) {
        if self.stays {
            interrupt.forget_request();
        }
        if !self.is_watched() {
            return;
        }
        self.feed.finish(picture);
        let deadline = Instant::now() + LAST;
        let is_awaited = || self.is_sending() || self.server.as_ref().is_some_and(Server::is_awaited);
        while is_awaited() && Instant::now() < deadline {
            thread::sleep(Duration::from_millis(5));
        }
        if self.is_sending() {
            self.feed.warn("the viewer tev is too slow to have got the last picture".into());
        }
    }

    /// Shows the last picture until Ctrl-C, if that is what the options ask for.
    pub fn stay(&self, interrupt: &Interrupt) {
        while self.stays && !interrupt.is_interrupted() {
            thread::sleep(Duration::from_millis(50));
        }
    }

    /// Whether somebody asks for the picture to be written to its files.
    pub fn is_save_asked(&self) -> bool {
        self.server.as_ref().is_some_and(Server::is_save_asked)
    }

    /// The picture of so many passes has been written.
    pub fn note_saved(&self, passes: u32) {
        if let Some(server) = &self.server {
            server.note_saved(passes);
        }
    }

    /// The warnings since the last call.
    pub fn take_warnings(&self) -> Vec<String> {
        self.feed.take_warnings()
    }
}

fn spawn(name: &str, work: impl FnOnce() + Send + 'static) -> Result<JoinHandle<()>, Failure> {
    let thread = thread::Builder::new().name(name.to_owned()).spawn(work);
    thread.map_err(|error| Failure::Input(format!("cannot start a thread: {error}")))
}
