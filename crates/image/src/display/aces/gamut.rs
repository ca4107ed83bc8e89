//! Gamut compression: colours that the display cannot show move along lines towards a point on the
//! grey axis, as far as the boundary of the display's gamut, of which the outer part takes up all
//! that lies beyond.
//!
//! In a plane of equal hue, the display's gamut has a tip (cusp) of greatest colourfulness, and
//! boundaries from it to black and to white. They are approximated by powers J ∝ M^γ, whose
//! intersection with a line has a closed form if the line's start is bent in the same way.

use super::appearance::{Appearance, gamma};
use super::tone::{PEAK, ToneScale};
use super::{AP1, BRIGHTEST, Jmh};

/// The rounding of the cusp.
const ROUNDING: f64 = 0.12;

/// The widening of the cusp that makes up for its rounding.
const WIDENING: f64 = 1.0 + 0.27 * ROUNDING;

/// The weight of the middle of the axis in the focus.
const MIDDLE: f64 = 1.3;

/// From where between cusp and white on lines become flatter, and the power of their distance's
/// logarithm by which they do.
const FLATTENING: [f64; 2] = [0.3, 2.0];

/// The distance of the focus beyond the axis, in units of the greatest lightness.
const DISTANCE: f64 = 1.35;

/// The part of the gamut that is left as it is.
const KEPT: f64 = 0.75;

/// The exponent of the lower boundary.
const LOWER: f64 = 1.14;

/// The greatest exponent of the upper boundary, and the step of the search for it.
const UPPER: [f64; 2] = [5.0, 0.4];

/// The gamut in a plane of equal hue.
#[derive(Clone, Copy, Debug)]
struct Plane {
    hue: f64,
    /// Lightness and colourfulness of the cusp.
    cusp: [f64; 2],
    /// One over the exponent of the upper boundary.
    upper: f64,
}

/// The tables of the compression.
#[derive(Clone, Debug)]
pub struct GamutCompression {
    /// By hue, from below 0 to above 360 degrees.
    planes: Vec<Plane>,
    /// The lightness of the peak.
    peak: f64,
    /// The lightness of middle grey on the display.
    middle: f64,
}

impl GamutCompression {
    /// From colours of the one space, which cover AP1, to those of the other.
    pub fn new(input: &Appearance, display: &Appearance, tone: &ToneScale) -> Self {
        let peak = input.lightness(PEAK);
        let middle = input.lightness(tone.grey());
        let corners = corners(|rgb| display.jmh(rgb));
        let reach = Appearance::new(&AP1);
        let reached = self::corners(|rgb| reach.jmh(at_lightness(&reach, peak, rgb)));
        let mut anchors: Vec<f64> = corners.iter().chain(&reached).map(|(_, corner)| corner.h).collect();
        anchors.sort_by(f64::total_cmp);
        let mut gamut = Self { planes: Vec::new(), peak, middle };
        let plane = |hue| {
            let [j, m] = cusp(display, &corners, hue);
            let cusp = [j, m * WIDENING];
            Plane { hue, cusp, upper: gamut.upper(display, hue, cusp) }
        };
        let mut planes: Vec<Plane> = sampled(&anchors).into_iter().map(plane).collect();
        // Hues wrap around.
        let (first, last) = (planes[0], planes[planes.len() - 1]);
        planes.insert(0, Plane { hue: last.hue - 360.0, ..last });
        planes.push(Plane { hue: first.hue + 360.0, ..first });
        gamut.planes = planes;
        gamut
    }

    /// The gamut at a hue.
    fn plane(&self, hue: f64) -> Plane {
        let next = self.planes.partition_point(|plane| plane.hue <= hue).clamp(1, self.planes.len() - 1);
        let (a, b) = (&self.planes[next - 1], &self.planes[next]);
        let lerp = |x: f64, y: f64| x + (y - x) * (hue - a.hue) / (b.hue - a.hue);
        let cusp = [lerp(a.cusp[0], b.cusp[0]), lerp(a.cusp[1], b.cusp[1])];
        Plane { hue, cusp, upper: lerp(a.upper, b.upper) }
    }

    /// A colour that the display can show; `reach` is the greatest colourfulness of the input at
    /// its hue, at the lightness of the peak.
    pub fn compress(&self, Jmh { j, m, h }: Jmh, reach: f64) -> Jmh {
        if j <= 0.0 {
            return Jmh { j: 0.0, m: 0.0, h };
        } else if m <= 0.0 || j > self.peak {
            return Jmh { j, m: 0.0, h };
        }
        let plane = self.plane(h);
        let line = self.line(j, m, plane.cusp[0]);
        let boundary = self.boundary(&plane, &line);
        if boundary <= 0.0 {
            return Jmh { j, m: 0.0, h };
        }
        let reached = intersection(&line, 1.0 / gamma(), [self.peak, reach], self.peak);
        let m = remapped(m, boundary, reached);
        Jmh { j: line.start + m * line.slope, m, h }
    }

    /// The line through a colour towards the focus, for a cusp of this lightness.
    fn line(&self, j: f64, m: f64, cusp: f64) -> Line {
        let focus = cusp + (self.middle - cusp) * (MIDDLE - cusp / self.peak).min(1.0);
        let bend = cusp + (self.peak - cusp) * FLATTENING[0];
        let gain = match j > bend {
            true => {
                libm::pow(
                    libm::log10((self.peak - bend) / (self.peak - j.min(self.peak)).max(0.0001)),
                    FLATTENING[1],
                ) + 1.0
            }
            false => 1.0,
        };
        let gain = self.peak * DISTANCE * gain;
        let origin = self.start(j, m, focus, gain);
        let scale = if origin < focus { origin } else { self.peak - origin };
        Line { start: origin, slope: scale * (origin - focus) / (focus * gain), focus, gain }
    }

    /// The colourfulness at which a line leaves the display's gamut.
    fn boundary(&self, plane: &Plane, line: &Line) -> f64 {
        let [j, m] = plane.cusp;
        let through_cusp = self.start(j, m, line.focus, line.gain);
        let lower = intersection(line, 1.0 / LOWER, [j, m], through_cusp);
        // The upper boundary is a power when seen from the peak.
        let flipped = Line { start: self.peak - line.start, slope: -line.slope, ..*line };
        let upper = intersection(&flipped, plane.upper, [self.peak - j, m], self.peak - through_cusp);
        let width = ROUNDING * m;
        let h = (width - (lower - upper).abs()).max(0.0) / width;
        lower.min(upper) - h * h * h * width / 6.0
    }

    /// Where the line through (j, m) that belongs to a focus of this lightness and distance meets
    /// the axis.
    fn start(&self, j: f64, m: f64, focus: f64, gain: f64) -> f64 {
        let a = m / (focus * gain);
        if j < focus {
            let (b, c) = (1.0 - m / gain, -j);
            2.0 * c / (-b - (b * b - 4.0 * a * c).sqrt())
        } else {
            let (b, c) = (-(1.0 + m / gain + self.peak * a), self.peak * m / gain + j);
            2.0 * c / (-b + (b * b - 4.0 * a * c).sqrt())
        }
    }

    /// One over the smallest exponent of the upper boundary for which the boundary lies outside of
    /// the gamut at five lightnesses.
    fn upper(&self, display: &Appearance, hue: f64, cusp: [f64; 2]) -> f64 {
        let fits = |exponent: f64| {
            let plane = Plane { hue, cusp, upper: 1.0 / exponent };
            [0.01, 0.1, 0.5, 0.8, 0.99].into_iter().all(|part| {
                let line = self.line(cusp[0] + (self.peak - cusp[0]) * part, cusp[1], cusp[0]);
                let m = self.boundary(&plane, &line);
                let j = line.start + line.slope * m;
                display.rgb(Jmh { j, m, h: hue }).iter().any(|c| *c > 1.0)
            })
        };
        let (mut low, mut high) = (0.0, UPPER[1]);
        while high < UPPER[0] && !fits(high) {
            (low, high) = (high, high + UPPER[1]);
        }
        for _ in 0..16 {
            let middle = 0.5 * (low + high);
            if fits(middle) { high = middle } else { low = middle }
        }
        1.0 / high
    }
}

/// A line J = start + slope · M in a plane of equal hue.
#[derive(Clone, Copy, Debug)]
struct Line {
    start: f64,
    slope: f64,
    /// The lightness of the focus.
    focus: f64,
    /// The distance of the focus.
    gain: f64,
}

/// Where a line meets the boundary J = j (M/m)^(1/inverse), about: `reference` is the start of the
/// line through (j, m).
fn intersection(line: &Line, inverse: f64, [j, m]: [f64; 2], reference: f64) -> f64 {
    let start = reference * libm::pow(line.start / reference, inverse);
    start / (j / m - line.slope)
}

/// The colourfulness `m` moved inside of `boundary`, so that `reach` comes to lie on it.
fn remapped(m: f64, boundary: f64, reach: f64) -> f64 {
    let part = (boundary / reach).max(KEPT);
    let kept = part * boundary;
    if part >= 1.0 || m <= kept {
        return m;
    }
    let (inside, beyond) = (boundary - kept, reach - kept);
    let scale = beyond / (beyond / inside - 1.0);
    let x = (m - kept) / scale;
    kept + scale * x / (1.0 + x)
}

/// The corners of a cube of RGB without black and white, with their appearance, by hue.
fn corners(appearance: impl Fn([f64; 3]) -> Jmh) -> Vec<([f64; 3], Jmh)> {
    let corner = |bits: u32| [0, 1, 2].map(|c| f64::from(bits >> c & 1));
    let mut corners: Vec<_> = (1..7).map(|bits| (corner(bits), appearance(corner(bits)))).collect();
    corners.sort_by(|a, b| a.1.h.total_cmp(&b.1.h));
    corners
}

/// About every degree of hue, where the samples nearest to `anchors` are moved to them, and those
/// between are spaced evenly.
fn sampled(anchors: &[f64]) -> Vec<f64> {
    let mut places: Vec<usize> = Vec::new();
    for (i, &hue) in anchors.iter().enumerate() {
        let last = places.last().copied();
        let mut place = (hue.round() as usize).clamp(last.unwrap_or(1), 359);
        if last == Some(place) {
            // Two of the same sample: one takes the next to it.
            if i > 1 && places[i - 2] + 1 != place { places[i - 1] -= 1 } else { place += 1 }
        }
        places.push(place.min(359));
    }
    let ends = places.iter().copied().zip(anchors.iter().copied()).chain([(360, 360.0)]);
    let mut hues = Vec::new();
    let mut begin = (0, 0.0);
    for end in ends {
        let count = end.0 - begin.0;
        hues.extend((0..count).map(|i| begin.1 + (end.1 - begin.1) * i as f64 / count as f64));
        begin = end;
    }
    hues
}

/// A multiple of a colour that has this lightness.
fn at_lightness(space: &Appearance, j: f64, rgb: [f64; 3]) -> [f64; 3] {
    let (mut low, mut high) = (0.0, BRIGHTEST);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if space.jmh(rgb.map(|c| c * middle)).j < j { low = middle } else { high = middle }
    }
    rgb.map(|c| c * high)
}

/// Lightness and colourfulness of the most colourful colour of the display with this hue, which
/// lies on an edge between two corners.
fn cusp(display: &Appearance, corners: &[([f64; 3], Jmh)], hue: f64) -> [f64; 2] {
    let next = corners.iter().position(|(_, corner)| corner.h > hue).unwrap_or(0);
    let (a, b) = (&corners[(next + corners.len() - 1) % corners.len()], &corners[next]);
    // Hues from that of the first corner on.
    let turn = |h: f64| (h - a.1.h).rem_euclid(360.0);
    let (mut low, mut high) = (0.0, 1.0);
    let at = |t: f64| display.jmh([0, 1, 2].map(|c| a.0[c] + (b.0[c] - a.0[c]) * t));
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        // Rounding may put the first corner just before itself.
        let turned = turn(at(middle).h);
        if turned > turn(hue) && turned < 300.0 { high = middle } else { low = middle }
    }
    let found = at(0.5 * (low + high));
    [found.j, found.m]
}
