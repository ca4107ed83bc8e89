//! The picture in the image viewer tev [Müller 2025], by the packets that it takes from other
//! programs over TCP.
//!
//! A packet has its own length in bytes, a byte for its kind, and what belongs to the kind.
//! Integers and floats are little-endian, and a text ends with a zero byte. Two kinds are used:
//!
//! | | create an image | update a part of it |
//! |---|---|---|
//! | length | u32 | u32 |
//! | kind | u8: 4 | u8: 6 |
//! | whether to select it | u8 | u8 |
//! | name | text | text |
//! | | width, height: i32 | |
//! | channels | their number: i32, their names: texts | the same |
//! | | | x, y, width, height of the part: i32 |
//! | | | index of the first value of each channel: i64 |
//! | | | distance of two values of each channel: i64 |
//! | | | values: f32 |
//!
//! An image that is created replaces the one of the same name.

use std::io::{self, ErrorKind, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::Duration;

use alhazen::InSrgb;
use alhazen::image::{DisplaySettings, Format, PixelSource};

use super::feed::Feed;

/// How long the viewer may take to accept a connection.
const CONNECTING: Duration = Duration::from_secs(2);

/// How long a write may take. One that has sent a part counts as done, so that a viewer that stops
/// reading is noticed after twice the time.
const PATIENCE: Duration = Duration::from_secs(3);

/// The bytes of values in a packet, if they are more than a row.
const BAND: usize = 1 << 20;

/// Shows the snapshots of a render as the image `name` of the viewer at `address`, until the render
/// ends. If that fails, it ends with a warning.
pub fn stream(address: &str, name: &str, feed: &Feed) {
    if let Err(error) = send_all(address, name, feed) {
        let problem = match error.kind() {
            ErrorKind::WouldBlock | ErrorKind::TimedOut => "it does not read the picture".to_owned(),
            _ => error.to_string(),
        };
        feed.warn(format!("the viewer tev at {address}: {problem}; the render goes on without it"));
    }
}

fn send_all(address: &str, name: &str, feed: &Feed) -> io::Result<()> {
    let mut viewer = connect(address)?;
    viewer.set_write_timeout(Some(PATIENCE))?;
    let mut shown = 0;
    let mut created = Vec::new();
    while let Some(snapshot) = feed.wait_for_newer(shown) {
        let picture = InSrgb::new(&*snapshot, Format::Pfm, &DisplaySettings::default());
        let channels: Vec<String> = picture.channels().into_iter().map(|channel| channel.name).collect();
        if created != channels {
            // The first snapshot may be a sketch, which has no layers.
            viewer.write_all(&create(name, &picture, &channels))?;
            created = channels;
        }
        let row = 4 * picture.width() as usize * created.len();
        let rows = (BAND / row).max(1) as u32;
        for y in (0..picture.height()).step_by(rows as usize) {
            viewer.write_all(&update(name, &picture, &created, y..picture.height().min(y + rows)))?;
        }
        shown = snapshot.revision;
    }
    Ok(())
}

fn connect(address: &str) -> io::Result<TcpStream> {
    let mut problem = io::Error::other("the name has no address");
    for address in address.to_socket_addrs()? {
        match TcpStream::connect_timeout(&address, CONNECTING) {
            Ok(viewer) => return Ok(viewer),
            Err(error) => problem = error,
        }
    }
    Err(problem)
}

/// A packet under construction.
struct Packet(Vec<u8>);

impl Packet {
    fn new(kind: u8, is_selected: bool, name: &str) -> Self {
        let mut packet = Self(vec![0, 0, 0, 0, kind, u8::from(is_selected)]);
        packet.text(name);
        packet
    }

    fn text(&mut self, text: &str) {
        self.0.extend(text.bytes().filter(|&byte| byte != 0));
        self.0.push(0);
    }

    fn integers(&mut self, integers: &[u32]) {
        integers.iter().for_each(|integer| self.0.extend(integer.to_le_bytes()));
    }

    fn channels(&mut self, channels: &[String]) {
        self.integers(&[channels.len() as u32]);
        channels.iter().for_each(|channel| self.text(channel));
    }

    fn finish(mut self) -> Vec<u8> {
        let length = self.0.len() as u32;
        self.0[..4].copy_from_slice(&length.to_le_bytes());
        self.0
    }
}

fn create(name: &str, picture: &dyn PixelSource, channels: &[String]) -> Vec<u8> {
    let mut packet = Packet::new(4, true, name);
    packet.integers(&[picture.width(), picture.height()]);
    packet.channels(channels);
    packet.finish()
}

fn update(name: &str, picture: &dyn PixelSource, channels: &[String], rows: std::ops::Range<u32>) -> Vec<u8> {
    let mut packet = Packet::new(6, false, name);
    packet.channels(channels);
    packet.integers(&[0, rows.start, picture.width(), rows.end - rows.start]);
    let count = channels.len() as u64;
    (0..count).for_each(|first| packet.0.extend(first.to_le_bytes()));
    (0..count).for_each(|_| packet.0.extend(count.to_le_bytes()));
    let mut values = vec![0.0; picture.width() as usize * channels.len()];
    for y in rows {
        picture.row(y, &mut values);
        values.iter().for_each(|value| packet.0.extend(value.to_le_bytes()));
    }
    packet.finish()
}
