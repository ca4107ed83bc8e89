//! The values of options, as they are written on the command line.

use std::path::PathBuf;
use std::time::Duration;

use alhazen::Shard;
use alhazen::image::{DisplayView, DisplayWhite};

/// A pair of name and value.
pub fn key_value(text: &str) -> Result<(String, String), String> {
    let (key, value) = text.split_once('=').ok_or("expected KEY=VALUE")?;
    Ok((key.trim().to_owned(), value.trim().to_owned()))
}

/// A duration as it is written on the command line.
pub fn time(text: &str) -> Result<Duration, String> {
    let number = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let unit = match text[number.len()..].trim() {
        "" | "s" => Some(1.0),
        "ms" => Some(1e-3),
        "min" | "m" => Some(60.0),
        "h" => Some(3600.0),
        _ => None,
    };
    let seconds = unit.zip(number.trim().parse().ok()).map(|(unit, number): (f64, f64)| unit * number);
    seconds
        .filter(|&seconds| seconds > 0.0)
        .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok())
        .ok_or_else(|| "expected a duration such as 30s, 1.5min or 2h".into())
}

/// A display view.
pub fn view(text: &str) -> Result<DisplayView, String> {
    let known = || DisplayView::ALL.map(DisplayView::name).join(", ");
    DisplayView::from_name(text).ok_or_else(|| format!("there are {}", known()))
}

/// An exposure in stops.
pub fn stops(text: &str) -> Result<f32, String> {
    let stops = text.parse().ok().filter(|stops: &f32| stops.abs() <= 64.0);
    stops.ok_or_else(|| "expected a number of stops from -64 to 64".into())
}

/// A share, such as where a slider is.
pub fn share(text: &str) -> Result<f32, String> {
    let share = text.parse().ok().filter(|share: &f32| (0.0..=1.0).contains(share));
    share.ok_or_else(|| "expected a number from 0 to 1".into())
}

/// A light that becomes white: kelvin, or x and y.
pub fn white(text: &str) -> Result<DisplayWhite, String> {
    let numbers: Option<Vec<f32>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    let white = match numbers.as_deref() {
        Some([kelvin]) if (500.0..=100_000.0).contains(kelvin) => Some(DisplayWhite::Kelvin(*kelvin)),
        Some([x, y]) if *x > 0.0 && *y > 0.0 && x + y <= 1.0 => Some(DisplayWhite::Chromaticity([*x, *y])),
        _ => None,
    };
    white.ok_or_else(|| "expected kelvin from 500 to 100000, or x,y such as 0.3127,0.329".into())
}

/// A relative standard error.
pub fn noise(text: &str) -> Result<f64, String> {
    let noise = text.parse().ok().filter(|&noise: &f64| noise > 0.0 && noise.is_finite());
    noise.ok_or_else(|| "expected a number above 0, such as 0.02".into())
}

/// The name of a film file.
pub fn film_file(text: &str) -> Result<PathBuf, String> {
    // A mistake such as the scene's own name must not overwrite a file.
    if text.ends_with(".film") { Ok(text.into()) } else { Err("expected a name that ends in .film".into()) }
}

/// A shard: its index and the number of parts.
pub fn shard(text: &str) -> Result<Shard, String> {
    let numbers = text
        .split_once('/')
        .and_then(|(index, count)| Some(Shard { index: index.parse().ok()?, count: count.parse().ok()? }));
    numbers
        .filter(|shard| (1..=shard.count).contains(&shard.index))
        .ok_or_else(|| "expected INDEX/COUNT, such as 3/8".into())
}

/// The address of a server.
pub fn address(text: &str) -> Result<String, String> {
    let port = text.rsplit_once(':').filter(|(host, _)| !host.is_empty());
    match port.and_then(|(_, port)| port.parse().ok()) {
        Some(1_u16..) => Ok(text.to_owned()),
        _ => Err("expected HOST:PORT, such as 127.0.0.1:14158".into()),
    }
}

/// Where a picture is served.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ServeAt {
    /// Host and port; port 0 is any that is free.
    pub address: String,
    /// Whether it is served until Ctrl-C, not only while it is rendered.
    pub stays: bool,
}

/// Where a picture is served.
pub fn serve(text: &str) -> Result<ServeAt, String> {
    let (address, stays) = text.strip_suffix(",stay").map_or((text, false), |address| (address, true));
    let port = address.rsplit_once(':').filter(|(host, _)| !host.is_empty());
    match port.map(|(_, port)| port.parse::<u16>()) {
        Some(Ok(_)) => Ok(ServeAt { address: address.to_owned(), stays }),
        _ => Err("expected ADDR:PORT or ADDR:PORT,stay, such as 127.0.0.1:8642".into()),
    }
}

/// A token of a server, which is part of an address.
pub fn token(text: &str) -> Result<String, String> {
    let is_plain = text.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'-' || byte == b'_');
    match is_plain && text.len() >= 8 {
        true => Ok(text.to_owned()),
        false => Err("expected eight or more of A to Z, a to z, 0 to 9, - and _".into()),
    }
}

/// Width and height in pixels.
pub fn resolution(text: &str) -> Result<[i32; 2], String> {
    let numbers =
        text.split_once('x').and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]));
    numbers
        .filter(|sides| sides.iter().all(|&side| side > 0))
        .ok_or_else(|| "expected WIDTHxHEIGHT, such as 640x480".into())
}

fn numbers<T: std::str::FromStr, const N: usize>(text: &str) -> Option<[T; N]> {
    let numbers: Option<Vec<T>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    numbers?.try_into().ok()
}

/// Fractions of the picture: x0, x1, y0, y1.
pub fn crop(text: &str) -> Result<[f32; 4], String> {
    numbers(text)
        .filter(|&[x0, x1, y0, y1]: &[f32; 4]| {
            0.0 <= x0 && x0 < x1 && x1 <= 1.0 && 0.0 <= y0 && y0 < y1 && y1 <= 1.0
        })
        .ok_or_else(|| "expected four fractions from 0 to 1, such as 0.25,0.75,0,1".into())
}

/// Column and row of a pixel.
pub fn pixel(text: &str) -> Result<[i32; 2], String> {
    numbers(text)
        .filter(|pixel: &[i32; 2]| pixel.iter().all(|&coordinate| coordinate >= 0))
        .ok_or_else(|| "expected a column and a row, such as 120,45".into())
}
