//! `--tev`: the picture in an image viewer, of which the tests play the part.

use std::collections::BTreeMap;
use std::io::Read;
use std::net::{TcpListener, TcpStream};
use std::thread::{self, JoinHandle};

use crate::common::Folder;

/// What a packet has after its length, read from its start on.
struct Packet<'a>(&'a [u8]);

impl<'a> Packet<'a> {
    fn bytes<const N: usize>(&mut self) -> [u8; N] {
        let (taken, rest) = self.0.split_first_chunk().expect("a complete packet");
        self.0 = rest;
        *taken
    }

    fn text(&mut self) -> &'a str {
        let end = self.0.iter().position(|&byte| byte == 0).expect("the end of a text");
        let text = std::str::from_utf8(&self.0[..end]).expect("UTF-8");
        self.0 = &self.0[end + 1..];
        text
    }

    fn integer(&mut self) -> usize {
        i32::from_le_bytes(self.bytes()).try_into().expect("a size")
    }

    fn long(&mut self) -> usize {
        i64::from_le_bytes(self.bytes()).try_into().expect("an index")
    }
}

/// An image in the viewer.
#[derive(Default)]
struct Shown {
    width: usize,
    height: usize,
    channels: BTreeMap<String, Vec<f32>>,
    updates: u32,
}

/// Plays the viewer for one connection, until it is closed.
fn view(mut connection: TcpStream) -> BTreeMap<String, Shown> {
    let mut images = BTreeMap::new();
    let mut length = [0; 4];
    while connection.read_exact(&mut length).is_ok() {
        let mut packet = vec![0; u32::from_le_bytes(length) as usize - 4];
        connection.read_exact(&mut packet).expect("a packet");
        let mut packet = Packet(&packet);
        let [kind, is_selected] = packet.bytes();
        assert!(is_selected <= 1);
        let name = packet.text().to_owned();
        match kind {
            4 => {
                let [width, height, count] = [0; 3].map(|_| packet.integer());
                let channels = (0..count).map(|_| (packet.text().to_owned(), vec![f32::NAN; width * height]));
                let channels = channels.collect();
                images.insert(name, Shown { width, height, channels, updates: 0 });
            }
            6 => {
                let image: &mut Shown = images.get_mut(&name).expect("an image that was created");
                let count = packet.integer();
                let channels: Vec<&str> = (0..count).map(|_| packet.text()).collect();
                let [x, y, width, height] = [0; 4].map(|_| packet.integer());
                assert!(x + width <= image.width && y + height <= image.height);
                let offsets: Vec<usize> = (0..count).map(|_| packet.long()).collect();
                let strides: Vec<usize> = (0..count).map(|_| packet.long()).collect();
                let values: Vec<f32> =
                    packet.0.chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect();
                packet.0 = &[];
                for (c, channel) in channels.iter().enumerate() {
                    let shown = image.channels.get_mut(*channel).expect("a channel that was created");
                    for (row, column) in
                        (0..height).flat_map(|row| (0..width).map(move |column| (row, column)))
                    {
                        let value = values[offsets[c] + (row * width + column) * strides[c]];
                        shown[(y + row) * image.width + x + column] = value;
                    }
                }
                image.updates += 1;
            }
            _ => panic!("packets of kind {kind} are not sent"),
        }
        assert!(packet.0.is_empty(), "a packet has nothing after its end");
    }
    images
}

/// A viewer that does `work` with its first connection; and the option that names it.
fn viewer<T: Send + 'static>(work: impl FnOnce(TcpStream) -> T + Send + 'static) -> (String, JoinHandle<T>) {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let option = format!("--tev={}", listener.local_addr().expect("an address"));
    (option, thread::spawn(move || work(listener.accept().expect("a connection").0)))
}

#[test]
fn the_viewer_gets_the_picture_with_its_layers() {
    let folder = Folder::with_scene("tev");
    let (option, viewer) = viewer(view);
    // More than one packet for a picture, and more pixels than a sketch has.
    let size = ["--resolution", "300x250", "--spp", "8", "--aov", "depth,normal", "--set", "savefp16=false"];
    let render = ["render", "scene.pbrt", "-o", "a.exr", "--json", &option];
    let finished = folder.alhazen(&[&render[..], &size].concat()).expect(0);
    assert_eq!(finished.err, "");
    let mut images = viewer.join().expect("a viewer");
    let (name, shown) = images.pop_first().expect("an image");
    assert_eq!((name.as_str(), images.len(), shown.updates > 1), ("a.exr", 0, true));
    let picture = folder.image("a.exr");
    assert_eq!([shown.width, shown.height], [picture.width() as usize, picture.height() as usize]);
    assert_eq!(shown.channels.len(), picture.channel_count());
    for (name, values) in &shown.channels {
        let channel = picture.channel_index(name).expect(name);
        for (i, value) in values.iter().enumerate() {
            let written = picture.channel((i % shown.width) as u32, (i / shown.width) as u32, channel);
            assert_eq!(*value, written, "{name} {i}");
        }
    }
}

#[test]
fn a_resumed_render_is_shown_too() {
    let folder = Folder::with_scene("tev-resume");
    folder.alhazen(&["render", "scene.pbrt", "--checkpoint", "a.film", "--quiet"]).expect(0);
    let (option, viewer) = viewer(view);
    folder.alhazen(&["resume", "a.film", "--spp", "4", "-o", "b.exr", &option]).expect(0);
    let images = viewer.join().expect("a viewer");
    assert!(images["b.exr"].channels["R"].iter().all(|value| value.is_finite()));
}

#[test]
fn a_viewer_that_fails_costs_one_warning() {
    let folder = Folder::with_scene("tev-fails");
    let render = |option: &str| {
        let finished =
            folder.alhazen(&["render", "scene.pbrt", "-o", "a.exr", "--spp", "64", option]).expect(0);
        assert_eq!(folder.image("a.exr").width(), 24);
        assert_eq!(finished.err.matches("warning").count(), 1, "{finished:?}");
        assert!(finished.err.contains("the render goes on without it"), "{finished:?}");
    };
    // One that is not there.
    let free = TcpListener::bind("127.0.0.1:0").and_then(|listener| listener.local_addr()).expect("a port");
    render(&format!("--tev={free}"));
    // One that closes the connection, which only a second picture shows.
    let (option, viewer) = viewer(|mut connection| connection.read_exact(&mut [0; 16]).expect("16 bytes"));
    folder.write("scene.pbrt", &crate::common::SCENE.replace("24", "1200").replace("16", "800"));
    let arguments = ["render", "scene.pbrt", "-o", "b.exr", "--spp", "2", &option];
    let finished = folder.alhazen(&arguments).expect(0);
    assert_eq!(finished.err.matches("warning").count(), 1, "{finished:?}");
    viewer.join().expect("a viewer");
    folder.alhazen(&["render", "scene.pbrt", "--tev=nonsense"]).expect(2);
}

#[test]
fn a_viewer_that_does_not_read_does_not_slow_the_render() {
    let folder = Folder::with_scene("tev-stuck");
    let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let option = format!("--tev={}", listener.local_addr().expect("an address"));
    // 35 channels: more than the buffers of the connection hold.
    let layers = "depth,normal,camera-normal,geometric-normal,camera-geometric-normal,position,camera-position,\
                  albedo,uv,motion,slope,camera-slope,variance,alpha";
    let arguments = ["--resolution", "400x300", "--time", "1s", "--aov", layers, "--json", &option];
    let finished =
        folder.alhazen(&[&["render", "scene.pbrt", "-o", "a.exr"][..], &arguments].concat()).expect(0);
    let json = finished.json();
    assert!(json["seconds"]["render"].as_f64().unwrap() < 3.0, "{json}");
    assert_eq!(json["ended_by"], "time");
    assert!(finished.err.contains("it does not read the picture"), "{finished:?}");
    assert_eq!(folder.image("a.exr").width(), 400);
}
