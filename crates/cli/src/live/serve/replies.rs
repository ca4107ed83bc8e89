//! The replies to requests: the page, the state of the render, pixels, and what the page can ask
//! for.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::time::Instant;

use alhazen::image::{Display, DisplaySettings, DisplayView, PixelSource};
use alhazen::spectrum::RgbColorSpace;
use hyper::body::Incoming;
use hyper::header::{CACHE_CONTROL, CONTENT_SECURITY_POLICY, CONTENT_TYPE, HeaderValue, REFERRER_POLICY};
use hyper::{Method, Request, Response, StatusCode};
use serde_json::{Value, json};

use super::access::Access;
use super::content::{Content, Pixels};
use crate::interrupt::Interrupt;
use crate::live::feed::{Feed, Status};
use crate::live::snapshot::Snapshot;

const PAGE: &str = include_str!("page.html");

/// The page has its script and style inside, and connects to its server alone; no other page can
/// show it in a frame.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; \
                      connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// The most channels of a reply.
const MOST_CHANNELS: usize = 4;

/// The values of a display view's table along each axis, of which value i is for the light
/// (2^(24 i / (n − 1)) − 1) / 4096.
const TABLE: usize = 49;

/// What replies are made of.
pub struct Served {
    /// The pictures.
    pub feed: Arc<Feed>,
    /// The name of the picture.
    pub name: String,
    /// Who gets a reply.
    pub access: Access,
    /// Ends the render.
    pub interrupt: Interrupt,
    /// Whether the picture is to be written to its files.
    pub is_save_asked: AtomicBool,
    /// The passes of the picture that was written last because it was asked for.
    pub saved: AtomicU32,
    /// When a page that lacks the latest picture last asked for news.
    pub waiting: std::sync::Mutex<Option<Instant>>,
}

type Reply = Response<Content>;

/// The reply to a request.
pub fn reply(served: &Served, request: &Request<Incoming>) -> Reply {
    let query = request.uri().query().unwrap_or_default();
    let parameter = |name: &str| {
        let pairs = query.split('&').filter_map(|pair| pair.split_once('='));
        pairs.filter(|(key, _)| *key == name).map(|(_, value)| value).next()
    };
    if let Some(refusal) = served.access.refusal(request.headers(), parameter("token")) {
        return text(StatusCode::FORBIDDEN, refusal);
    }
    match (request.method(), request.uri().path()) {
        (&Method::GET, "/") => with_type(PAGE.into(), "text/html; charset=utf-8"),
        (&Method::GET, "/state") => {
            let shown = parameter("shown").and_then(|shown| shown.parse().ok()).unwrap_or(0);
            let state = state(served, shown).to_string();
            with_type(Content::Text(Some(state.into())), "application/json")
        }
        (&Method::GET, "/pixels") => pixels(served, parameter("revision"), parameter("channels")),
        (&Method::GET, "/view") => view(served, parameter("name")),
        (&Method::POST, "/stop") if served.interrupt.cancel_rendering() => accepted(),
        (&Method::POST, "/stop") => text(StatusCode::CONFLICT, "nothing is being rendered yet"),
        (&Method::POST, "/save") => {
            served.is_save_asked.store(true, Ordering::Relaxed);
            accepted()
        }
        (_, "/" | "/state" | "/pixels" | "/view" | "/stop" | "/save") => {
            text(StatusCode::METHOD_NOT_ALLOWED, "this is asked for otherwise")
        }
        _ => text(StatusCode::NOT_FOUND, "there is nothing of this name"),
    }
}

fn state(served: &Served, shown: u32) -> Value {
    let Status { latest, progress, has_ended } = served.feed.status();
    let revision = latest.as_ref().map_or(0, |latest| latest.revision);
    if shown >= revision && !has_ended {
        served.feed.ask();
    }
    if shown < revision || !has_ended {
        *super::locked(&served.waiting) = Some(Instant::now());
    }
    let passes = progress.map(|progress| progress.passes).filter(|&passes| passes != u32::MAX);
    json!({
        "name": served.name,
        "phase": match progress {
            _ if has_ended => "ended",
            None => "preparing",
            Some(_) => "rendering",
        },
        "passes": progress.map_or(0, |progress| progress.pass),
        "all_passes": passes,
        "seconds": progress.map(|progress| progress.elapsed.as_secs_f64()),
        "rays": progress.map(|progress| progress.stats.rays),
        "noise": progress.and_then(|progress| progress.noise),
        "saved": served.saved.load(Ordering::Relaxed),
        "views": DisplayView::ALL.map(DisplayView::name),
        "picture": latest.as_deref().map(picture),
    })
}

fn picture(snapshot: &Snapshot) -> Value {
    let channels = snapshot.channels().into_iter().map(|channel| channel.name);
    json!({
        "revision": snapshot.revision,
        "width": snapshot.width(),
        "height": snapshot.height(),
        "origin": snapshot.data_window().min,
        "channels": channels.collect::<Vec<_>>(),
        "srgb": color_space(snapshot).convert(RgbColorSpace::srgb()).0,
    })
}

/// The colour space of a picture.
fn color_space(snapshot: &Snapshot) -> &'static RgbColorSpace {
    let chromaticities = snapshot.metadata().chromaticities;
    let known =
        chromaticities.and_then(|c| RgbColorSpace::from_chromaticities([c.red, c.green, c.blue], c.white));
    known.unwrap_or(RgbColorSpace::srgb())
}

fn pixels(served: &Served, revision: Option<&str>, channels: Option<&str>) -> Reply {
    let channels = channels.unwrap_or_default().split(',').take(MOST_CHANNELS + 1);
    let channels: Option<Vec<usize>> = channels.map(|channel| channel.parse().ok()).collect();
    let Some(channels) = channels.filter(|channels| channels.len() <= MOST_CHANNELS) else {
        return text(StatusCode::BAD_REQUEST, "expected the numbers of up to four channels");
    };
    // The page knows the channels of one picture; another may have others.
    let latest = served.feed.status().latest;
    let Some(latest) = latest.filter(|latest| revision == Some(latest.revision.to_string().as_str())) else {
        return text(StatusCode::CONFLICT, "there is a newer picture");
    };
    match Pixels::new(latest, channels) {
        Some(pixels) => {
            let kind = pixels.kind();
            let mut reply = with_type(Content::Pixels(pixels), "application/octet-stream");
            reply.headers_mut().insert("values", HeaderValue::from_static(kind));
            reply
        }
        None => text(StatusCode::BAD_REQUEST, "there is no such channel"),
    }
}

/// A display view as a table of codes from 0 to 255: red changes fastest, then green, then blue.
fn view(served: &Served, name: Option<&str>) -> Reply {
    let Some(view) = name.and_then(DisplayView::from_name) else {
        return text(StatusCode::NOT_FOUND, "there is no view of this name");
    };
    let Some(latest) = served.feed.status().latest else {
        return text(StatusCode::CONFLICT, "there is no picture yet");
    };
    let settings = DisplaySettings { view, ..DisplaySettings::default() };
    let display = Display::new(&settings, color_space(&latest));
    let light = |i: usize| ((24.0 * i as f32 / (TABLE - 1) as f32).exp2() - 1.0) / 4096.0;
    let codes = (0..TABLE.pow(3)).flat_map(|i| {
        let rgb = [i % TABLE, i / TABLE % TABLE, i / TABLE / TABLE].map(light);
        display.show(rgb).map(|c| (255.0 * alhazen::image::srgb_from_linear(c)).round() as u8)
    });
    let codes: Vec<u8> = codes.collect();
    with_type(Content::Text(Some(codes.into())), "application/octet-stream")
}

impl From<&'static str> for Content {
    fn from(text: &'static str) -> Self {
        Self::Text(Some(text.into()))
    }
}

fn text(status: StatusCode, text: &'static str) -> Reply {
    let mut reply = with_type(text.into(), "text/plain; charset=utf-8");
    *reply.status_mut() = status;
    reply
}

fn accepted() -> Reply {
    text(StatusCode::ACCEPTED, "")
}

fn with_type(content: Content, kind: &'static str) -> Reply {
    let mut reply = Response::new(content);
    let headers = reply.headers_mut();
    for (name, value) in [
        (CONTENT_TYPE, kind),
        (CACHE_CONTROL, "no-store"),
        (CONTENT_SECURITY_POLICY, POLICY),
        (REFERRER_POLICY, "no-referrer"),
        (hyper::header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    ] {
        headers.insert(name, HeaderValue::from_static(value));
    }
    reply
}
