//! `--serve`: the picture in a browser, and what strangers and hostile clients get.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::common::{Finished, Folder, SCENE};

/// A render that shows its picture.
pub struct Render {
    child: Child,
    /// What the program says to open.
    pub url: String,
}

impl Render {
    pub fn start(folder: &Folder, arguments: &[&str]) -> Self {
        let mut command = folder.command(&["render", "scene.pbrt", "-o", "a.exr", "--json"]);
        command.args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("the program runs");
        let mut line = String::new();
        let mut errors = BufReader::new(child.stderr.take().expect("standard error"));
        errors.read_line(&mut line).expect("a line");
        let url = line.trim_end().strip_prefix("the picture is at ").unwrap_or_else(|| panic!("{line}"));
        Self { url: url.to_owned(), child }
    }

    fn port(&self) -> u16 {
        let host = self.url.split('/').nth(2).expect("a host");
        host.rsplit_once(':').and_then(|(_, port)| port.parse().ok()).expect("a port")
    }

    fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(("127.0.0.1", self.port())).expect("a connection");
        stream.set_read_timeout(Some(Duration::from_secs(30))).expect("a timeout");
        stream
    }

    /// The reply to these lines and a host; `None` if the connection is closed without one.
    fn send(&self, lines: &[&str]) -> Option<Reply> {
        let mut stream = self.connect();
        stream.write_all(format!("{}\r\n\r\n", lines.join("\r\n")).as_bytes()).ok()?;
        let mut bytes = Vec::new();
        stream.read_to_end(&mut bytes).ok()?;
        let end = bytes.windows(4).position(|window| window == b"\r\n\r\n")?;
        let head = String::from_utf8(bytes[..end].to_vec()).expect("UTF-8");
        let status = head.split(' ').nth(1)?.parse().expect("a status");
        Some(Reply { status, head, content: bytes[end + 4..].to_vec() })
    }

    /// The reply to a request of the page itself.
    fn request(&self, method: &str, path: &str) -> Reply {
        self.send(&[&format!("{method} {path} HTTP/1.1"), "Host: localhost"]).expect("a reply")
    }

    fn state(&self, shown: u64) -> Value {
        let reply = self.request("GET", &format!("/state?shown={shown}"));
        serde_json::from_slice(&reply.content).expect("JSON")
    }

    /// The first state of which this is true, asked for as a page does that has shown nothing.
    pub fn wait(&self, is_reached: impl Fn(&Value) -> bool) -> Value {
        let deadline = Instant::now() + Duration::from_secs(60);
        loop {
            let state = self.state(0);
            if is_reached(&state) {
                return state;
            }
            assert!(Instant::now() < deadline, "{state}");
            thread::sleep(Duration::from_millis(20));
        }
    }

    pub fn finish(self) -> Finished {
        self.child.wait_with_output().expect("the program ends").into()
    }

    pub fn stop(self) -> Finished {
        assert_eq!(self.request("POST", "/stop").status, 202);
        self.finish().expect(130)
    }
}

struct Reply {
    status: u16,
    head: String,
    content: Vec<u8>,
}

const ENDLESS: [&str; 2] = ["--spp", "100000000"];

#[test]
fn pixels_are_those_of_the_picture() {
    let folder = Folder::with_scene("serve");
    let render = Render::start(&folder, &["--serve=127.0.0.1:0,stay", "--aov", "depth", "--spp", "8"]);
    let page = render.request("GET", "/");
    assert!(page.status == 200 && page.content.starts_with(b"<!DOCTYPE html>"));
    assert!(page.head.to_lowercase().contains("frame-ancestors 'none'"), "{}", page.head);
    let state = render.wait(|state| state["phase"] == "ended");
    assert_eq!(
        (&state["passes"], &state["all_passes"], &state["name"]),
        (&8.into(), &8.into(), &"a.exr".into())
    );
    let shown = &state["picture"];
    assert_eq!(shown["channels"], serde_json::json!(["R", "G", "B", "Z"]));
    let picture = folder.image("a.exr");
    let revision = shown["revision"].as_u64().expect("a number");
    let pixels = |channels: &str| {
        let reply = render.request("GET", &format!("/pixels?revision={revision}&channels={channels}"));
        assert_eq!(reply.status, 200, "{}", reply.head);
        reply
    };
    let [color, depth] = [pixels("2,0"), pixels("3")];
    assert!(color.head.contains("values: f16") && depth.head.contains("values: f32"));
    assert_eq!([color.content.len(), depth.content.len()], [24 * 16 * 2 * 2, 24 * 16 * 4]);
    for i in 0..24 * 16 {
        let (x, y) = (i as u32 % 24, i as u32 / 24);
        for (c, channel) in [2, 0].into_iter().enumerate() {
            let code = &color.content[4 * i + 2 * c..][..2];
            let value = half(u16::from_le_bytes(code.try_into().expect("two bytes")));
            assert_eq!(value, picture.channel(x, y, channel), "{x} {y} {channel}");
        }
        let value = f32::from_le_bytes(depth.content[4 * i..][..4].try_into().expect("four bytes"));
        assert_eq!(value, picture.channel(x, y, 3), "{x} {y}");
    }
    // Tables of views: black and white at their corners.
    let table = render.request("GET", "/view?name=standard").content;
    assert_eq!(
        (table.len(), &table[..3], &table[table.len() - 3..]),
        (3 * 49 * 49 * 49, &[0; 3][..], &[255; 3][..])
    );
    for (path, status) in [
        (format!("/pixels?revision={}&channels=0", revision + 1), 409),
        (format!("/pixels?revision={revision}&channels=4"), 400),
        (format!("/pixels?revision={revision}&channels=0,0,0,0,0"), 400),
        (format!("/pixels?revision={revision}"), 400),
        ("/view?name=nobody".to_owned(), 404),
        ("/../Cargo.toml".to_owned(), 404),
        ("/stop".to_owned(), 405),
    ] {
        assert_eq!(render.request("GET", &path).status, status, "{path}");
    }
    // It stays until it is stopped, but its result is whole.
    assert_eq!(render.request("POST", "/stop").status, 202);
    let json = render.finish().expect(0).json();
    assert_eq!(json["status"], "done");
}

/// The value of a half float.
fn half(code: u16) -> f32 {
    let [exponent, fraction] = [code >> 10 & 31, code & 1023].map(f32::from);
    match exponent {
        0.0 => fraction * 2f32.powi(-24),
        _ => (1.0 + fraction / 1024.0) * 2f32.powf(exponent - 15.0),
    }
}

#[test]
fn a_page_sees_progress_and_saves_and_stops() {
    let folder = Folder::with_scene("serve-stop");
    let save = ["--checkpoint", "a.film", "--every", "1h", "--serve=127.0.0.1:0"];
    let render = Render::start(&folder, &[&ENDLESS[..], &save].concat());
    // Each picture that is shown is followed by another.
    let mut shown = 0;
    while shown < 3 {
        let state = render.state(shown);
        shown = state["picture"]["revision"].as_u64().unwrap_or(0).max(shown);
        thread::sleep(Duration::from_millis(20));
    }
    assert_eq!(render.request("POST", "/save").status, 202);
    let saved = render.wait(|state| state["saved"] != 0)["saved"].clone();
    assert!(folder.files().contains(&"a.film".to_owned()));
    let samples = |folder: &Folder| {
        let info = folder.alhazen(&["image", "info", "a.exr", "--json"]).expect(0).json();
        info.to_string()
    };
    assert!(samples(&folder).contains("samplesPerPixel"), "{}", samples(&folder));
    let json = render.stop().json();
    assert_eq!((&json["status"], &json["ended_by"]), (&"interrupted".into(), &"interrupt".into()));
    assert!(json["passes"].as_u64() >= saved.as_u64(), "{json}");
    assert_eq!(folder.image("a.exr").width(), 24);
}

#[test]
fn a_page_that_stays_outlives_the_render_that_it_ends() {
    let folder = Folder::with_scene("serve-stays");
    let render = Render::start(&folder, &[&ENDLESS[..], &["--serve=127.0.0.1:0,stay"]].concat());
    render.wait(|state| state["picture"]["revision"].is_u64());
    assert_eq!(render.request("POST", "/stop").status, 202);
    let state = render.wait(|state| state["phase"] == "ended");
    let revision = &state["picture"]["revision"];
    let pixels = render.request("GET", &format!("/pixels?revision={revision}&channels=0"));
    assert_eq!(pixels.status, 200, "{}", pixels.head);
    render.stop();
}

#[test]
fn strangers_are_refused() {
    let folder = Folder::with_scene("serve-strangers");
    let refused = |render: &Render, lines: &[&str]| {
        let reply = render.send(lines).expect("a reply");
        assert_eq!(reply.status, 403, "{lines:?}: {}", reply.head);
    };
    let render = Render::start(&folder, &[&ENDLESS[..], &["--serve=127.0.0.1:0"]].concat());
    refused(&render, &["POST /stop HTTP/1.1", "Host: evil.org"]);
    refused(&render, &["POST /stop HTTP/1.0"]);
    refused(&render, &["POST http://evil.org/stop HTTP/1.1", "Host: evil.org"]);
    let origin = format!("Origin: http://localhost:{}", render.port() + 1);
    refused(&render, &["POST /stop HTTP/1.1", &format!("Host: localhost:{}", render.port()), &origin]);
    refused(&render, &["POST /stop HTTP/1.1", "Host: localhost", "Origin: null"]);
    refused(&render, &["GET /state HTTP/1.1", "Host: 10.0.0.1"]);
    render.wait(|state| state["phase"] == "rendering");
    render.stop();

    // Other machines reach this one, so that it has a token; and one that has one anyway.
    for serve in [&["--serve=0.0.0.0:0"][..], &["--serve=127.0.0.1:0", "--serve-token", "open-sesame"]] {
        let render = Render::start(&folder, &[&ENDLESS[..], serve].concat());
        let (_, token) = render.url.split_once("/?token=").expect("a token");
        assert!(token.len() >= 8, "{token}");
        for path in ["/", "/state", "/pixels", "/state?token=", "/state?token=open-sesam", "/nothing"] {
            refused(&render, &[&format!("GET {path} HTTP/1.1"), "Host: localhost"]);
        }
        refused(&render, &["POST /stop HTTP/1.1", "Host: localhost"]);
        assert_eq!(render.request("GET", &format!("/state?token={token}")).status, 200);
        let deadline = Instant::now() + Duration::from_secs(60);
        while render.request("POST", &format!("/stop?token={token}")).status == 409 {
            assert!(Instant::now() < deadline, "the render does not begin");
            thread::sleep(Duration::from_millis(20));
        }
        render.finish().expect(130);
    }
}

#[test]
fn hostile_clients_do_not_slow_the_render() {
    let folder = Folder::with_scene("serve-hostile");
    let layers = "depth,normal,camera-normal,position,camera-position,albedo,uv,motion,variance,alpha";
    let render = Render::start(
        &folder,
        &["--serve=127.0.0.1:0", "--resolution", "600x400", "--time", "3s", "--aov", layers],
    );
    let revision = render.wait(|state| state["picture"]["revision"].is_u64())["picture"]["revision"].clone();
    let pixels =
        format!("GET /pixels?revision={revision}&channels=0,1,2,3 HTTP/1.1\r\nHost: localhost\r\n\r\n");
    let long = format!("GET / HTTP/1.1\r\nHost: localhost\r\nA: {}", "a".repeat(1 << 20));
    // None of them reads.
    let mut clients = Vec::new();
    for _ in 0..30 {
        for text in ["", "GET / HTTP/1.1\r\nHost: ", &pixels, &long, "\0\u{1}nonsense\r\n\r\n"] {
            let mut client = render.connect();
            client.set_write_timeout(Some(Duration::from_millis(10))).expect("a timeout");
            // The server may have closed the connection.
            let _ = client.write_all(text.as_bytes());
            clients.push(client);
        }
    }
    let json = render.finish().expect(0).json();
    assert!(json["seconds"]["render"].as_f64().expect("seconds") < 5.0, "{json}");
    assert_eq!((&json["status"], &json["ended_by"]), (&"done".into(), &"time".into()));
    assert_eq!(folder.image("a.exr").width(), 600);
}

#[test]
fn many_connections_end_and_make_room() {
    let folder = Folder::with_scene("serve-many");
    let render = Render::start(&folder, &[&ENDLESS[..], &["--serve=127.0.0.1:0"]].concat());
    render.wait(|state| state["phase"] == "rendering");
    // Beyond the limit, connections are closed at once.
    let mut idle: Vec<TcpStream> = (0..64).map(|_| render.connect()).collect();
    idle[63].set_read_timeout(Some(Duration::from_secs(3))).expect("a timeout");
    match idle[63].read(&mut [0]) {
        Ok(count) => assert_eq!(count, 0),
        Err(error) => assert_eq!(error.kind(), std::io::ErrorKind::ConnectionReset),
    }
    // Those that send nothing are closed in time.
    let deadline = Instant::now() + Duration::from_secs(20);
    let state = ["GET /state HTTP/1.1", "Host: localhost"];
    while render.send(&state).is_none_or(|reply| reply.status != 200) {
        assert!(Instant::now() < deadline, "idle connections are kept");
        thread::sleep(Duration::from_millis(200));
    }
    drop(idle);
    render.stop();
}

#[test]
fn the_server_ends_with_the_render() {
    let folder = Folder::with_scene("serve-end");
    let render = Render::start(&folder, &["--serve=127.0.0.1:0", "--spp", "4"]);
    let port = render.port();
    let begin = Instant::now();
    render.finish().expect(0);
    assert!(begin.elapsed() < Duration::from_secs(5), "nobody watches, so it does not wait");
    assert!(TcpStream::connect(("127.0.0.1", port)).is_err());

    let taken = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let serve = format!("--serve={}", taken.local_addr().expect("an address"));
    let finished = folder.alhazen(&["render", "scene.pbrt", "-o", "b.exr", &serve]).expect(1);
    assert!(
        finished.err.contains("cannot serve at") && finished.err.contains("names another"),
        "{finished:?}"
    );
    assert!(!folder.path().join("b.exr").exists());
    for wrong in
        [&["--serve=nonsense"][..], &["--serve", "--serve-token", "short"], &["--serve-token", "open-sesame"]]
    {
        folder.alhazen(&[&["render", "scene.pbrt"][..], wrong].concat()).expect(2);
    }
}

/// Headless Chromium, by the name that it has here.
fn browser() -> Option<&'static str> {
    let names = ["chromium", "chromium-browser", "google-chrome"];
    names.into_iter().find(|name| Command::new(name).arg("--version").output().is_ok())
}

#[test]
fn a_browser_shows_the_picture() {
    let Some(browser) = browser() else {
        return eprintln!("skipped: there is no Chromium to show the page");
    };
    let folder = Folder::new("serve-browser");
    // Nothing but light of one colour.
    let light = SCENE.split("Material").next().expect("a start").replace("[ 1 1 1 ]", "[ 0.1 0.6 0.3 ]");
    folder.write("scene.pbrt", &light);
    let arguments = ["-o", "a.png", "--aov", "depth", "--serve=127.0.0.1:0"];
    let render = Render::start(&folder, &[&ENDLESS[..], &arguments].concat());
    render.wait(|state| state["picture"]["revision"].is_u64());
    let browse = |what: &str| -> Finished {
        let mut command = Command::new(browser);
        command.current_dir(folder.path()).env("HOME", folder.path());
        command.args(["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-quic"]);
        command.args(["--disable-background-networking", "--user-data-dir=profile", "--window-size=800,600"]);
        command.args(["--virtual-time-budget=4000", what, &render.url]);
        command.stdin(Stdio::null()).output().expect("the browser runs").into()
    };
    let page = browse("--dump-dom").expect(0).out;
    for text in ["rendering: pass ", ">a.exr<", "value=\"RGB\"", "value=\"Z\"", "value=\"agx\"", "M rays/s"] {
        assert!(page.contains(text), "{text}: {page}");
    }
    browse("--screenshot=page.png").expect(0);
    render.stop();
    let (page, picture) = (folder.image("page.png"), folder.image("a.png"));
    let expected = picture.rgb(5, 5);
    let pixels = (0..page.height()).flat_map(|y| (0..page.width()).map(move |x| (x, y)));
    let is_shown = |&(x, y): &(u32, u32)| (0..3).all(|c| (page.rgb(x, y)[c] - expected[c]).abs() < 0.1);
    let share = pixels.filter(is_shown).count() as f64 / f64::from(page.width() * page.height());
    assert!(share > 0.6, "{share} of the page has the colour {expected:?}");
}
