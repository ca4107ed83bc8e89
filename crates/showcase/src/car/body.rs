//! The control cage of a coupé's body: lines along the car, drawn at stations from nose to tail.
//!
//! x is to the left, y ahead, z up, in metres from the ground between the axles. The cage is a box
//! of four grids, of which the half with x ≥ 0 is drawn: the top, with lines from the middle to the
//! crest of the wings; the side, from the crest down to the sill, with a round hole for each wheel;
//! nose and tail.

use math::Vec3;

use crate::cage::Cage;

/// The axles.
pub const AXLES: [f32; 2] = [1.25, -1.25];
/// The radius of the tyres.
pub const WHEEL: f32 = 0.335;
/// The radius of the wheel arches, of which a spline stays a little inside.
const ARCH: f32 = 0.366 * 1.025;

/// What a face of the body is part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Panel {
    Bonnet,
    Wing,
    Cowl,
    Windscreen,
    Roof,
    Side,
    Door,
    DoorGlass,
    QuarterGlass,
    RearScreen,
    Boot,
    Sill,
    FrontBumper,
    RearBumper,
    Splitter,
    Diffuser,
    Headlamp,
    TailLamp,
    Grille,
    Intake,
}

/// All of them.
pub const PANELS: [Panel; 20] = [
    Panel::Bonnet,
    Panel::Wing,
    Panel::Cowl,
    Panel::Windscreen,
    Panel::Roof,
    Panel::Side,
    Panel::Door,
    Panel::DoorGlass,
    Panel::QuarterGlass,
    Panel::RearScreen,
    Panel::Boot,
    Panel::Sill,
    Panel::FrontBumper,
    Panel::RearBumper,
    Panel::Splitter,
    Panel::Diffuser,
    Panel::Headlamp,
    Panel::TailLamp,
    Panel::Grille,
    Panel::Intake,
];

impl Panel {
    /// Whether one can see through it.
    pub fn is_clear(self) -> bool {
        use Panel::{DoorGlass, Headlamp, QuarterGlass, RearScreen, TailLamp, Windscreen};
        matches!(self, Windscreen | DoorGlass | QuarterGlass | RearScreen | Headlamp | TailLamp)
    }
}

/// The grid that a face is of, which has texture coordinates of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Grid {
    Top,
    Side,
    End,
}

pub type Tag = (Panel, Grid);

const STATIONS: usize = 23;
/// Lines of the top, and rows of side, nose and tail.
const LINES: usize = 6;
const ROWS: usize = 7;

type Line = [f32; STATIONS];

/// y of the crest and of the middle line. Between them lines are swept.
const CREST_Y: Line = [
    1.80, 1.60, 1.50, 1.385, 1.25, 1.115, 1.0, 0.90, 0.66, 0.52, 0.15, -0.18, -0.48, -0.70, -0.90, -1.0,
    -1.115, -1.25, -1.385, -1.50, -1.60, -1.83, -2.0,
];
const MIDDLE_Y: Line = [
    2.03, 1.90, 1.79, 1.66, 1.50, 1.33, 1.17, 1.03, 0.76, 0.67, 0.33, -0.02, -0.34, -0.62, -0.80, -0.92,
    -1.06, -1.22, -1.38, -1.54, -1.66, -1.87, -2.08,
];
const SWEEP: [f32; LINES] = [0.0, 0.1, 0.35, 0.6, 0.85, 1.0];

/// z of the middle line, and x and z of the others but the second, which is between its neighbours.
const MIDDLE: Line = [
    0.72, 0.768, 0.797, 0.825, 0.85, 0.869, 0.883, 0.892, 0.904, 0.94, 1.105, 1.235, 1.272, 1.255, 1.222,
    1.196, 1.162, 1.119, 1.074, 1.028, 0.995, 0.955, 0.958,
];
/// The edge of windscreen and rear screen.
const SCREEN: [Line; 2] = [
    [
        0.46, 0.48, 0.492, 0.505, 0.52, 0.532, 0.54, 0.546, 0.555, 0.60, 0.595, 0.56, 0.545, 0.545, 0.55,
        0.555, 0.56, 0.56, 0.553, 0.54, 0.525, 0.50, 0.48,
    ],
    [
        0.703, 0.765, 0.792, 0.819, 0.842, 0.858, 0.869, 0.876, 0.886, 0.925, 1.092, 1.215, 1.247, 1.229,
        1.197, 1.173, 1.141, 1.102, 1.061, 1.019, 0.988, 0.953, 0.947,
    ],
];
/// The edge of the bonnet and the rail over the side windows.
const RAIL: [Line; 2] = [
    [
        0.60, 0.625, 0.638, 0.65, 0.665, 0.675, 0.682, 0.687, 0.692, 0.70, 0.675, 0.635, 0.622, 0.625, 0.632,
        0.638, 0.645, 0.65, 0.645, 0.63, 0.615, 0.595, 0.575,
    ],
    [
        0.69, 0.753, 0.78, 0.805, 0.826, 0.842, 0.852, 0.858, 0.868, 0.892, 1.06, 1.185, 1.212, 1.195, 1.165,
        1.143, 1.112, 1.075, 1.037, 1.0, 0.973, 0.943, 0.936,
    ],
];
/// The belt line under the side windows.
const BELT: [Line; 2] = [
    [
        0.745, 0.785, 0.80, 0.812, 0.82, 0.818, 0.81, 0.802, 0.79, 0.786, 0.785, 0.785, 0.786, 0.788, 0.785,
        0.77, 0.735, 0.735, 0.735, 0.725, 0.715, 0.69, 0.67,
    ],
    [
        0.668, 0.748, 0.778, 0.808, 0.832, 0.842, 0.846, 0.848, 0.862, 0.872, 0.893, 0.905, 0.912, 0.925,
        0.948, 0.985, 1.035, 1.022, 1.002, 0.98, 0.962, 0.935, 0.925,
    ],
];
/// The crest of the wings, where the side begins.
const CREST: [Line; 2] = [
    [
        0.83, 0.872, 0.885, 0.895, 0.90, 0.897, 0.885, 0.872, 0.855, 0.85, 0.845, 0.845, 0.85, 0.86, 0.878,
        0.89, 0.905, 0.915, 0.915, 0.90, 0.885, 0.835, 0.77,
    ],
    [
        0.64, 0.715, 0.745, 0.775, 0.80, 0.808, 0.81, 0.81, 0.812, 0.815, 0.825, 0.833, 0.838, 0.848, 0.868,
        0.885, 0.905, 0.922, 0.93, 0.928, 0.92, 0.90, 0.885,
    ],
];

/// The side below the crest: heights of its rows, and how far they are outside the crest.
const SIDE_Z: [f32; ROWS] = [0.0, 0.775, 0.66, 0.53, 0.38, 0.225, 0.135];
const SIDE_OUT: [f32; ROWS] = [0.0, 0.014, 0.024, 0.006, -0.012, 0.006, -0.06];

/// Nose and tail: x and z of the lines in the rows below the first.
const NOSE: [[[f32; 2]; LINES]; ROWS - 1] = [
    [[0.0, 0.668], [0.24, 0.667], [0.47, 0.655], [0.58, 0.643], [0.73, 0.631], [0.848, 0.614]],
    [[0.0, 0.606], [0.26, 0.602], [0.50, 0.556], [0.565, 0.592], [0.72, 0.575], [0.858, 0.556]],
    [[0.0, 0.50], [0.28, 0.50], [0.56, 0.488], [0.64, 0.49], [0.755, 0.475], [0.865, 0.455]],
    [[0.0, 0.372], [0.26, 0.374], [0.47, 0.408], [0.58, 0.375], [0.775, 0.405], [0.868, 0.36]],
    [[0.0, 0.235], [0.22, 0.235], [0.38, 0.24], [0.50, 0.225], [0.785, 0.235], [0.862, 0.215]],
    [[0.0, 0.135], [0.23, 0.135], [0.45, 0.135], [0.59, 0.135], [0.73, 0.137], [0.82, 0.14]],
];
const TAIL: [[[f32; 2]; LINES]; ROWS - 1] = [
    [[0.0, 0.90], [0.24, 0.898], [0.47, 0.888], [0.60, 0.876], [0.71, 0.862], [0.792, 0.842]],
    [[0.0, 0.815], [0.21, 0.813], [0.46, 0.803], [0.60, 0.792], [0.725, 0.778], [0.812, 0.758]],
    [[0.0, 0.66], [0.23, 0.66], [0.46, 0.652], [0.61, 0.64], [0.735, 0.625], [0.825, 0.605]],
    [[0.0, 0.455], [0.23, 0.455], [0.44, 0.445], [0.58, 0.37], [0.73, 0.325], [0.832, 0.305]],
    [[0.0, 0.30], [0.23, 0.30], [0.42, 0.29], [0.56, 0.245], [0.71, 0.225], [0.822, 0.215]],
    [[0.0, 0.185], [0.22, 0.185], [0.42, 0.18], [0.56, 0.165], [0.68, 0.155], [0.76, 0.15]],
];

/// Around a wheel, from ahead below the axle over its top to behind: the hole's points by their
/// angles in degrees, and those of the ring around it with their distance from the hole.
const HOLE: [f32; 13] =
    [-32.0, -10.0, 12.0, 31.5, 51.0, 70.5, 90.0, 109.5, 129.0, 148.5, 168.0, 190.0, 212.0];
const RING: [[f32; 2]; 15] = [
    [-29.0, 0.045],
    [-9.0, 0.045],
    [12.0, 0.042],
    [29.0, 0.042],
    [43.0, 0.05],
    [51.0, 0.09],
    [59.0, 0.048],
    [73.0, 0.036],
    [90.0, 0.034],
    [107.0, 0.036],
    [121.0, 0.048],
    [129.0, 0.09],
    [137.0, 0.05],
    [151.0, 0.042],
    [168.0, 0.042],
];

/// The whole cage.
pub fn cage() -> Cage<Tag> {
    let mut cage = Cage::default();
    let top: Vec<[u32; STATIONS]> =
        (0..LINES).map(|line| std::array::from_fn(|s| cage.add(top(line, s)))).collect();
    let mut side = vec![top[LINES - 1]];
    // Nothing is within the arches.
    let is_void = |row: usize, s: usize| row > 2 && matches!(s, 3..=5 | 16..=18);
    side.extend((1..ROWS).map(|row| {
        std::array::from_fn(|s| if is_void(row, s) { u32::MAX } else { cage.add(side_point(row, s)) })
    }));
    for (station, axle) in [(4, AXLES[0]), (17, AXLES[1])] {
        arch(&mut cage, &side, station, axle);
    }
    let nose = end(&mut cage, &top, &side, 0);
    let tail = end(&mut cage, &top, &side, STATIONS - 1);

    for line in 0..LINES - 1 {
        for s in 0..STATIONS - 1 {
            let corners = [top[line][s], top[line][s + 1], top[line + 1][s + 1], top[line + 1][s]];
            cage.face(corners, (top_panel(line, s), Grid::Top));
        }
    }
    for row in 0..ROWS - 1 {
        for s in 0..STATIONS - 1 {
            if row >= 2 && ((2..6).contains(&s) || (15..19).contains(&s)) {
                continue;
            }
            let corners = [side[row][s], side[row][s + 1], side[row + 1][s + 1], side[row + 1][s]];
            cage.face(corners, (side_panel(row, s), Grid::Side));
        }
        for line in 0..LINES - 1 {
            let [a, b] = [line, line + 1];
            let corners = [nose[row][a], nose[row][b], nose[row + 1][b], nose[row + 1][a]];
            cage.face(corners, (nose_panel(row, line), Grid::End));
            let corners = [tail[row][b], tail[row][a], tail[row + 1][a], tail[row + 1][b]];
            cage.face(corners, (tail_panel(row, line), Grid::End));
        }
    }
    // The crest is a soft edge, and so is that of the tail.
    for s in 1..STATIONS {
        cage.crease(side[0][s - 1], side[0][s], 0.7);
    }
    for line in 1..LINES {
        cage.crease(tail[0][line - 1], tail[0][line], 0.9);
    }
    for s in 1..9 {
        cage.crease(top[2][s - 1], top[2][s], 0.35);
    }
    cage.mirror();
    cage
}

fn top(line: usize, s: usize) -> Vec3 {
    let y = MIDDLE_Y[s] + SWEEP[line] * (CREST_Y[s] - MIDDLE_Y[s]);
    let [x, z] = match line {
        0 => [0.0, MIDDLE[s]],
        1 => [0.5 * SCREEN[0][s], MIDDLE[s] + 0.22 * (SCREEN[1][s] - MIDDLE[s])],
        2 => SCREEN.map(|line| line[s]),
        3 => RAIL.map(|line| line[s]),
        4 => BELT.map(|line| line[s]),
        _ => CREST.map(|line| line[s]),
    };
    Vec3::new(x, y, z)
}

fn side_point(row: usize, s: usize) -> Vec3 {
    match s {
        0 | 22 => end_point(row, LINES - 1, s),
        _ => {
            let z = if row == 1 { CREST[1][s] - 0.055 } else { SIDE_Z[row] };
            Vec3::new(CREST[0][s] + SIDE_OUT[row], CREST_Y[s], z)
        }
    }
}

/// Moves the points around a wheel on circles.
fn arch(cage: &mut Cage<Tag>, side: &[[u32; STATIONS]], middle: usize, axle: f32) {
    let polar = |angle: f32, radius: f32| {
        let (sin, cos) = lanes::sin_cos(angle.to_radians());
        (axle + radius * cos, WHEEL + radius * sin)
    };
    let out = if axle > 0.0 { 0.925 } else { 0.945 };
    let rim = (0..5).map(|i| (6 - i, middle - 2)).chain((0..3).map(|i| (2, middle - 1 + i)));
    let rim = rim.chain((0..5).map(|i| (2 + i, middle + 2)));
    for ((row, s), angle) in rim.zip(HOLE) {
        let (y, z) = polar(angle, ARCH);
        // The lower ends turn in a little.
        let x = out - 0.10 * (0.30 - z).max(0.0);
        cage.points[side[row][s] as usize] = Vec3::new(x, y, z);
    }
    let ring = (0..5).map(|i| (6 - i, middle - 3)).chain((0..7).map(|i| (1, middle - 3 + i)));
    let ring = ring.chain((0..5).map(|i| (2 + i, middle + 3)));
    let mirrored = RING.iter().take(2).rev().map(|&[angle, distance]| [180.0 - angle, distance]);
    for ((row, s), [angle, distance]) in ring.zip(RING.into_iter().chain(mirrored)) {
        let (y, z) = polar(angle, ARCH + distance);
        let up = ((z - 0.2) / 0.5).clamp(0.0, 1.0);
        let x = out - 0.026 + 0.012 * up - 0.12 * (0.28 - z).max(0.0);
        cage.points[side[row][s] as usize] = Vec3::new(x, y, z);
    }
}

/// A point of nose or tail, which are bent in both directions.
fn end_point(row: usize, line: usize, s: usize) -> Vec3 {
    let is_nose = s == 0;
    let [x, z] = if is_nose { NOSE } else { TAIL }[row - 1][line];
    let y = if is_nose {
        2.13 - 1.2 * (z - 0.48) * (z - 0.48) - 0.30 * lanes::pow(x / 0.86, 2.6)
    } else {
        // The tail leans under its edge, and the bumper stands out.
        let bumper = 0.05 * lanes::exp(-((z - 0.47) / 0.17) * ((z - 0.47) / 0.17));
        let under = 1.5 * (0.40 - z).max(0.0) * (0.40 - z).max(0.0);
        -2.075 - 0.25 * (0.93 - z) * (z - 0.55).max(0.0) - bumper + under + 0.10 * lanes::pow(x / 0.80, 2.8)
    };
    Vec3::new(x, y, z)
}

/// The points of nose or tail, by rows and lines.
fn end(
    cage: &mut Cage<Tag>,
    top: &[[u32; STATIONS]],
    side: &[[u32; STATIONS]],
    s: usize,
) -> Vec<[u32; LINES]> {
    let mut rows = vec![std::array::from_fn(|line| top[line][s])];
    for (row, side) in side.iter().enumerate().skip(1) {
        rows.push(std::array::from_fn(|line| {
            if line == LINES - 1 { side[s] } else { cage.add(end_point(row, line, s)) }
        }));
    }
    rows
}

fn top_panel(line: usize, s: usize) -> Panel {
    match (line, s) {
        (0..=2, ..=7) => Panel::Bonnet,
        (_, ..=7) => Panel::Wing,
        (4, 8..=12) => Panel::Door,
        (0..=1, 8) => Panel::Cowl,
        (0..=1, 9..=10) => Panel::Windscreen,
        (0..=1, 11..=12) => Panel::Roof,
        (0..=1, 13..=18) => Panel::RearScreen,
        (0..=1, _) => Panel::Boot,
        (3, 9..=12) => Panel::DoorGlass,
        (3, 13..=15) => Panel::QuarterGlass,
        _ => Panel::Side,
    }
}

fn side_panel(row: usize, s: usize) -> Panel {
    match (row, s) {
        (0..=1, 0) => Panel::Headlamp,
        (5, 0) => Panel::Splitter,
        (_, 0) => Panel::FrontBumper,
        (5, 8..=13) => Panel::Sill,
        (5, 7) => Panel::Sill,
        (_, 1..=7) => Panel::Wing,
        (_, 8..=12) => Panel::Door,
        (1, 21) => Panel::TailLamp,
        (5, 20..) => Panel::Diffuser,
        (2.., 20..) => Panel::RearBumper,
        _ => Panel::Side,
    }
}

fn nose_panel(row: usize, line: usize) -> Panel {
    match (row, line) {
        (0..=1, 3..=4) => Panel::Headlamp,
        (2..=3, 0..=1) => Panel::Grille,
        (4, 3) => Panel::Intake,
        (5, _) => Panel::Splitter,
        _ => Panel::FrontBumper,
    }
}

fn tail_panel(row: usize, line: usize) -> Panel {
    match (row, line) {
        (1, 1..) => Panel::TailLamp,
        (0, 2..) => Panel::Side,
        (0..=1, _) => Panel::Boot,
        (4..=5, _) => Panel::Diffuser,
        _ => Panel::RearBumper,
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::*;
    use crate::cage::edge;

    #[test]
    fn the_cage_is_one_sheet_with_one_border() {
        let cage = cage();
        let mut edges: HashMap<[u32; 2], u32> = HashMap::new();
        for face in &cage.faces {
            for i in 0..4 {
                *edges.entry(edge(face[i], face[(i + 1) % 4])).or_insert(0) += 1;
            }
        }
        assert!(edges.values().all(|&faces| faces <= 2));
        // Each point of the border has two of its edges, and all of them are one line, along sills
        // and wheel arches.
        let border: Vec<[u32; 2]> = edges.iter().filter(|(_, faces)| **faces == 1).map(|(e, _)| *e).collect();
        let mut around: HashMap<u32, Vec<u32>> = HashMap::new();
        for [a, b] in &border {
            around.entry(*a).or_default().push(*b);
            around.entry(*b).or_default().push(*a);
        }
        assert!(around.values().all(|others| others.len() == 2));
        let start = border[0][0];
        let (mut before, mut at, mut length) = (start, around[&start][0], 1);
        while at != start {
            let next = around[&at].iter().copied().find(|&other| other != before).unwrap();
            (before, at, length) = (at, next, length + 1);
        }
        assert_eq!(length, border.len());
        assert!(around.keys().all(|&point| cage.points[point as usize].z < 0.8));
    }

    #[test]
    fn it_has_the_proportions_of_a_coupe() {
        let smooth = cage().subdivided(3);
        let low = smooth.points.iter().copied().reduce(Vec3::min).unwrap();
        let high = smooth.points.iter().copied().reduce(Vec3::max).unwrap();
        let [width, length, height] = (high - Vec3::new(low.x, low.y, 0.0)).to_array();
        assert!((4.1..4.4).contains(&length) && (1.8..1.95).contains(&width), "{length} {width}");
        assert!((1.22..1.3).contains(&height), "{height}");
        // A wheel is half as high as the car, and almost three of them fit between the wheels.
        assert!((0.48..0.56).contains(&(2.0 * WHEEL / height)));
        let between = (AXLES[0] - AXLES[1]) / (2.0 * WHEEL) - 1.0;
        assert!((2.6..3.0).contains(&between), "{between}");
        // The body stays out of the way of the wheels.
        let nearest = |p: &Vec3| AXLES.map(|y| (p.y - y).hypot(p.z - WHEEL)).into_iter().fold(9.0, f32::min);
        let close = smooth.points.iter().map(nearest).fold(9.0, f32::min);
        assert!(close > WHEEL + 0.01, "{close}");
    }

    #[test]
    fn every_panel_is_somewhere() {
        let cage = cage();
        assert!(PANELS.iter().all(|panel| cage.tags.iter().any(|tag| tag.0 == *panel)));
        // Both halves are the same.
        let mirrored = |p: &Vec3| Vec3::new(-p.x, p.y, p.z);
        let bits = |p: Vec3| (p + Vec3::ZERO).to_array().map(f32::to_bits);
        let points: std::collections::HashSet<_> = cage.points.iter().map(|p| bits(*p)).collect();
        assert!(cage.points.iter().all(|p| points.contains(&bits(mirrored(p)))));
    }
}
