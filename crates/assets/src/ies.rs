//! Photometric distributions of luminaires in the IES format ([IES 2002]: LM-63 of 1986, 1991, 1995
//! and 2002), read as images of intensity in candela.
//!
//! A file is lines of text up to `TILT=`, then numbers: ten of the luminaire, three of its power
//! supply, the vertical and horizontal angles in degrees, and the intensities, all vertical angles
//! of one horizontal angle after the other. Photometry of type C is read: vertical angles go up
//! from straight down, horizontal ones around the vertical axis, counterclockwise as seen from
//! above. The range of the horizontal angles tells the symmetry. Directions beyond the vertical
//! angles have no light.
//!
//! Intensities are multiplied by the candela multiplier and the ballast factor, and before 2002 by
//! the ballast–lamp factor, whose place has other uses since. Factors for tilted lamps
//! (`TILT=INCLUDE`) are read and left out: luminaires hang as they were measured.

use std::f32::consts::{PI, TAU};

use image::{Image, Pixels, Projection};
use math::{Vec2, Vector3};
use rayon::prelude::*;

use crate::number;

/// Intensities of a luminaire by direction.
#[derive(Clone, Debug)]
struct Photometry {
    /// Ascending, in degrees from straight down.
    vertical: Vec<f32>,
    /// Ascending, in degrees.
    horizontal: Vec<f32>,
    symmetry: Symmetry,
    /// In candela, by horizontal, then vertical angle.
    candela: Vec<f32>,
}

/// Which intensities determine the others.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Symmetry {
    /// All horizontal angles are alike.
    Rotation,
    /// Those from 0° to 90°.
    Quadrants,
    /// Those from 0° to 180°.
    Halves,
    /// Those from 90° to 270°.
    Sides,
    /// None.
    None,
}

/// The least and greatest width of an image.
const WIDTHS: [u32; 2] = [128, 1024];

/// The intensities of a file in candela as a square image in the equal-area projection, its z axis
/// up and its x axis at the horizontal angle 0. On failure, the reason and its line.
pub fn read(bytes: &[u8]) -> Result<Image, String> {
    Photometry::read(bytes).map(|photometry| photometry.image())
}

impl Photometry {
    fn read(bytes: &[u8]) -> Result<Self, String> {
        let mut lines = bytes.split(|&byte| byte == b'\n').zip(1..).map(|(line, i)| (line.trim_ascii(), i));
        let mut is_2002 = false;
        let tilt = loop {
            let Some((line, number)) = lines.next() else {
                return Err("it has no line `TILT=`, which precedes the numbers of an IES file".into());
            };
            let start: Vec<u8> = line.iter().take(24).map(u8::to_ascii_uppercase).collect();
            is_2002 |= number == 1 && start.windows(4).any(|year| matches!(year, b"2002" | b"2019"));
            if let Some(tilt) = start.strip_prefix(b"TILT=") {
                break tilt.trim_ascii().to_vec();
            }
        };
        let mut numbers = Numbers { lines, words: Vec::new(), line: 0 };
        match &tilt[..] {
            b"NONE" => {}
            b"INCLUDE" => {
                numbers.next("the geometry of `TILT=INCLUDE`")?;
                let pairs = numbers.count("the number of tilt angles")?;
                numbers.list(pairs.saturating_mul(2), "the angles and factors of `TILT=INCLUDE`")?;
            }
            _ => return Err("`TILT` is neither NONE nor INCLUDE; other files are not read".into()),
        }
        for what in ["the number of lamps", "the lumens per lamp"] {
            numbers.next(what)?;
        }
        let multiplier = numbers.next("the candela multiplier")?;
        let [rows, columns] = [
            numbers.count("the number of vertical angles")?,
            numbers.count("the number of horizontal angles")?,
        ];
        if numbers.next("the photometric type")? != 1.0 {
            return Err(numbers.wrong("the photometry is not of type C (1), the only one that is read"));
        }
        numbers.list(4, "the units and dimensions of the luminaire")?;
        let [ballast, lamp] =
            [numbers.next("the ballast factor")?, numbers.next("the ballast-lamp photometric factor")?];
        numbers.next("the input power")?;
        let factor = multiplier * ballast * if is_2002 { 1.0 } else { lamp };
        if !(factor > 0.0 && factor.is_finite()) {
            return Err(format!(
                "the factors of its intensities multiply to {factor}, which is not above zero"
            ));
        }
        let vertical = numbers.angles(rows, "vertical", 180.0)?;
        let horizontal = numbers.angles(columns, "horizontal", 360.0)?;
        let symmetry = match (horizontal[0], horizontal[columns - 1]) {
            _ if columns == 1 => Symmetry::Rotation,
            (0.0, 90.0) => Symmetry::Quadrants,
            (0.0, 180.0) => Symmetry::Halves,
            (90.0, 270.0) => Symmetry::Sides,
            (0.0, last) if last > 180.0 => Symmetry::None,
            (first, last) => {
                return Err(numbers.wrong(&format!(
                    "horizontal angles go from 0 to 0, 90, 180 or 360, or from 90 to 270 degrees, not from {first} to {last}"
                )));
            }
        };
        let mut candela = numbers.list(rows.saturating_mul(columns), "the intensities")?;
        if candela.iter().any(|&value| value < 0.0) {
            return Err(numbers.wrong("an intensity is negative"));
        }
        candela.iter_mut().for_each(|value| *value *= factor);
        numbers.finish()?;
        Ok(Self { vertical, horizontal, symmetry, candela })
    }

    /// The intensity in a direction, z up, by linear interpolation between angles.
    fn candela(&self, w: Vector3) -> f32 {
        let vertical = libm::atan2f(libm::hypotf(w.x, w.y), -w.z) * (180.0 / PI);
        let around = (libm::atan2f(w.y, w.x) / TAU).rem_euclid(1.0) * 360.0;
        let (first, last) = (self.vertical[0], self.vertical[self.vertical.len() - 1]);
        if vertical < first || vertical > last {
            return 0.0;
        }
        let (row, down) = place(&self.vertical, vertical);
        let row_after = (row + 1).min(self.vertical.len() - 1);
        let angle = match self.symmetry {
            Symmetry::Rotation => self.horizontal[0],
            Symmetry::Quadrants => (around % 180.0).min(180.0 - around % 180.0),
            Symmetry::Halves => around.min(360.0 - around),
            Symmetry::Sides if (90.0..=270.0).contains(&around) => around,
            Symmetry::Sides => (180.0 - around).rem_euclid(360.0),
            Symmetry::None => around,
        };
        let (column, across) = place(&self.horizontal, angle);
        let columns = self.horizontal.len();
        let (column_after, across) = match self.symmetry {
            // Between the last angle and the first, a turn later.
            Symmetry::None if column == columns - 1 => {
                let last = self.horizontal[column];
                (0, (angle - last) / (360.0 - last).max(f32::MIN_POSITIVE))
            }
            _ => ((column + 1).min(columns - 1), across),
        };
        let at = |column: usize, row: usize| self.candela[column * self.vertical.len() + row];
        let along = |column| math::lerp(down, at(column, row), at(column, row_after));
        math::lerp(across.clamp(0.0, 1.0), along(column), along(column_after))
    }

    /// Three to seven pixels across the least step between angles; each is the mean of four places.
    fn image(&self) -> Image {
        let steps = self.vertical.windows(2).chain(self.horizontal.windows(2)).map(|pair| pair[1] - pair[0]);
        let least = steps.fold(90.0, f32::min).to_radians();
        let width = (16.0 / least) as u32;
        let width = width.clamp(WIDTHS[0], WIDTHS[1]).next_power_of_two();
        let pixel = |i: u32| {
            let corner = Vec2::new((i % width) as f32, (i / width) as f32);
            let places = [[0.25, 0.25], [0.75, 0.25], [0.25, 0.75], [0.75, 0.75]];
            let sum: f32 = places
                .map(|place| {
                    let st = (corner + Vec2::from(place)) / width as f32;
                    self.candela(Projection::EqualArea.direction(st))
                })
                .iter()
                .sum();
            sum / places.len() as f32
        };
        let pixels = (0..width * width).into_par_iter().map(pixel).collect();
        Image::new(width, width, ["Y"], Pixels::F32(pixels)).expect("invariant: one value per pixel")
    }
}

/// The last angle that is not above one, and how far that lies on the way to the next.
fn place(angles: &[f32], angle: f32) -> (usize, f32) {
    let i = angles.partition_point(|&a| a <= angle).saturating_sub(1);
    match angles.get(i + 1) {
        Some(next) => (i, ((angle - angles[i]) / (next - angles[i])).clamp(0.0, 1.0)),
        None => (i, 0.0),
    }
}

/// The numbers of a file, with their lines.
struct Numbers<'a, L> {
    lines: L,
    /// The rest of the current line, last word first.
    words: Vec<&'a [u8]>,
    line: usize,
}

impl<'a, L: Iterator<Item = (&'a [u8], usize)>> Numbers<'a, L> {
    fn word(&mut self) -> Option<&'a [u8]> {
        while self.words.is_empty() {
            let (line, number) = self.lines.next()?;
            // Some files end with the end-of-file character of DOS.
            let is_between = |byte: &u8| byte.is_ascii_whitespace() || matches!(byte, b',' | 0x1a);
            self.words = line.split(is_between).filter(|word| !word.is_empty()).rev().collect();
            self.line = number;
        }
        self.words.pop()
    }

    fn wrong(&self, message: &str) -> String {
        format!("line {}: {message}", self.line)
    }

    fn next(&mut self, what: &str) -> Result<f32, String> {
        let Some(word) = self.word() else { return Err(format!("it ends before {what}")) };
        let number = number::float(word).filter(|number| number.is_finite());
        number.ok_or_else(|| {
            let word = String::from_utf8_lossy(word);
            self.wrong(&format!("`{word:.40}` stands for {what}, which is a number"))
        })
    }

    fn count(&mut self, what: &str) -> Result<usize, String> {
        let count = self.next(what)?;
        if count >= 1.0 && count.fract() == 0.0 {
            Ok(count as usize)
        } else {
            Err(self.wrong(&format!("{what} is {count}, not a number above zero")))
        }
    }

    fn list(&mut self, count: usize, what: &str) -> Result<Vec<f32>, String> {
        // Grows with the words that are read, as a damaged count may be large.
        let mut list = Vec::new();
        for _ in 0..count {
            list.push(self.next(what)?);
        }
        Ok(list)
    }

    fn angles(&mut self, count: usize, what: &str, most: f32) -> Result<Vec<f32>, String> {
        let angles = self.list(count, &format!("the {what} angles"))?;
        let is_ascending = angles.windows(2).all(|pair| pair[0] < pair[1]);
        if !is_ascending || angles[0] < 0.0 || angles[count - 1] > most {
            let message = format!("the {what} angles do not increase from 0 to {most} degrees at most");
            return Err(self.wrong(&message));
        }
        Ok(angles)
    }

    fn finish(mut self) -> Result<(), String> {
        match self.word() {
            None => Ok(()),
            Some(_) => Err(self.wrong("there are more numbers than its angles need")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use math::Vec3;

    fn file(head: &str, angles: &str, candela: &str) -> String {
        format!("{head}\n[TEST] made up\nTILT=NONE\n{angles}\n{candela}\n")
    }

    /// A direction by its angles in degrees.
    fn toward(vertical: f32, horizontal: f32) -> Vector3 {
        let (v, h) = (vertical.to_radians(), horizontal.to_radians());
        Vec3::new(v.sin() * h.cos(), v.sin() * h.sin(), -v.cos())
    }

    fn near(a: f32, b: f32) -> bool {
        (a - b).abs() < 1e-3 * (1.0 + b.abs())
    }

    #[test]
    fn a_rotational_distribution_is_interpolated() {
        let text = file("IESNA:LM-63-2002", "1 -1 2 3 1 1 2 0 0 0\n0.5 7 60\n0, 45, 90\n0", "100 50 0");
        let photometry = Photometry::read(text.as_bytes()).unwrap();
        for horizontal in [0.0, 77.0, 200.0] {
            for (vertical, expected) in [(0.0, 100.0), (22.5, 75.0), (45.0, 50.0), (67.5, 25.0), (100.0, 0.0)]
            {
                assert!(near(photometry.candela(toward(vertical, horizontal)), expected), "{vertical}");
            }
        }
        // Until 1995 the third factor counts.
        let text = text.replace("LM-63-2002", "LM-63-1995");
        assert!(near(Photometry::read(text.as_bytes()).unwrap().candela(-Vec3::Z), 700.0));
    }

    #[test]
    fn horizontal_angles_tell_the_symmetry() {
        let around = |count: usize, angles: &str, values: &str| {
            let numbers = format!("1 -1 1 1 {count} 1 2 0 0 0 1 1 60 90 {angles}");
            Photometry::read(file("IESNA91", &numbers, values).as_bytes()).unwrap()
        };
        let at = |photometry: &Photometry, horizontal: f32| photometry.candela(toward(90.0, horizontal));
        let quadrants = around(2, "0 90", "10 20");
        for (angle, expected) in [(0.1, 10.0), (45.0, 15.0), (135.0, 15.0), (180.0, 10.0), (270.0, 20.0)] {
            assert!((at(&quadrants, angle) - expected).abs() < 0.1, "{angle}");
        }
        let halves = around(3, "0 90 180", "10 20 40");
        for (angle, expected) in [(45.0, 15.0), (135.0, 30.0), (225.0, 30.0), (315.0, 15.0)] {
            assert!((at(&halves, angle) - expected).abs() < 0.1, "{angle}");
        }
        let sides = around(3, "90 180 270", "10 20 40");
        for (angle, expected) in [(135.0, 15.0), (45.0, 15.0), (225.0, 30.0), (315.0, 30.0), (0.0, 20.0)] {
            assert!((at(&sides, angle) - expected).abs() < 0.1, "{angle}");
        }
        for all in [around(4, "0 90 180 270", "10 20 40 30"), around(5, "0 90 180 270 360", "10 20 40 30 10")]
        {
            for (angle, expected) in [(45.0, 15.0), (225.0, 35.0), (315.0, 20.0), (359.9, 10.0)] {
                assert!((at(&all, angle) - expected).abs() < 0.1, "{angle}");
            }
        }
    }

    #[test]
    fn the_image_has_the_intensities() {
        let numbers = "1 -1 1 19 4 1 2 0 0 0 1 1 60 0 10 20 30 40 50 60 70 80 90 100 110 120 130 140 150 160 170 180 0 90 180 270";
        let values = |h: f32| {
            let row = (0..19).map(|i| format!("{} ", 100.0 + h + i as f32));
            row.collect::<String>()
        };
        let text = file("IESNA91", numbers, &[0.0, 10.0, 20.0, 30.0].map(values).join("\n"));
        let photometry = Photometry::read(text.as_bytes()).unwrap();
        let image = photometry.image();
        assert_eq!((image.width(), image.width()), (128, image.height()));
        for i in 0..image.width() {
            let [x, y] = [i, (i * 37) % image.width()];
            let st = (Vec2::new(x as f32, y as f32) + 0.5) / image.width() as f32;
            let expected = photometry.candela(Projection::EqualArea.direction(st));
            assert!((image.channel(x, y, 0) - expected).abs() < 2.0, "{x} {y}");
        }
    }

    #[test]
    fn tilt_factors_are_left_out() {
        let text = "IESNA91\nTILT=INCLUDE\n1\n3\n0 45 90\n1 .9 .8\n1 1000 1 2 1 1 2 0 0 0\n1 1 60\n0 90\n0\n100 20\n\x1a";
        assert!(near(Photometry::read(text.as_bytes()).unwrap().candela(-Vec3::Z), 100.0));
    }

    #[test]
    fn damaged_files_are_errors_with_a_line() {
        let good = file("IESNA91", "1 -1 1 2 1 1 2 0 0 0\n1 1 60\n0 90\n0", "100 20");
        assert!(read(good.as_bytes()).is_ok());
        for (from, to, message) in [
            ("TILT=NONE", "tilt", "it has no line `TILT=`"),
            ("TILT=NONE", "TILT=lamp.tlt", "neither NONE nor INCLUDE"),
            ("100 20", "100", "it ends before the intensities"),
            ("100 20", "100 bright", "line 8: `bright` stands for the intensities"),
            ("100 20", "100 -20", "line 8: an intensity is negative"),
            ("100 20", "100 20 3", "line 8: there are more numbers"),
            ("0 90", "90 0", "line 6: the vertical angles do not increase"),
            ("1 -1 1 2 1 1", "1 -1 1 2 1 2", "line 4: the photometry is not of type C"),
            ("1 -1 1 2 1 1", "1 -1 1 2.5 1 1", "line 4: the number of vertical angles is 2.5"),
            ("1 -1 1 2 1 1", "1 -1 0 2 1 1", "multiply to 0"),
            ("1 -1 1 2 1 1", "1 -1 1 3e9 1 1", "it ends before the vertical angles"),
            ("1 -1 1 2 1 1", "1 -1 1 2 3e9 1", "it ends before the horizontal angles"),
        ] {
            let error = read(good.replacen(from, to, 1).as_bytes()).unwrap_err();
            assert!(error.contains(message), "{error}");
        }
    }
}
