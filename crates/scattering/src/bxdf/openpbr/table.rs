//! What the layers of a material do with light from any direction, in a table.
//!
//! The table has a row for each node of the cosine, and of whatever varies: of the azimuth, where
//! facets are not alike both ways; of the thickness of the film in wavelengths, where there is one;
//! and of each number that is not the same everywhere. Between nodes everything is linear, so that
//! what is left for the last layer and its means fit together as exactly as at the nodes.

use super::OpenPbrParameters;
use super::grid::{Place, nodes};
use super::stack::{Inside, Row, Seen, Stack, Taken};
use math::{Vec3, Vector3, safe_sqrt, sqr};
use spectrum::{LAMBDA_MAX, LAMBDA_MIN, SampledSpectrum};
use std::f32::consts::FRAC_PI_2;
use std::fmt;

/// Cosines, the squares of 0, 1/36, … 1, among which are those of the tables of albedos.
const COSINES: usize = 37;
/// Cosines of the azimuth, where it matters.
const AZIMUTHS: usize = 13;
/// Tables have about so many nodes at most, without those of cosines.
const MOST_NODES: usize = 16384;
/// Nodes of one number.
const NODES: [usize; 2] = [2, 17];
/// The most nodes of a film's thickness where numbers vary.
const FEW_FILMS: usize = 64;
/// A film of more wavelengths counts as one of so many.
const MOST_WAVES: f32 = 8.0;
/// Nodes for each wavelength of a film's thickness, which is 2n periods of its reflectance.
const NODES_PER_WAVE: f32 = 40.0;

/// A number on which the layers depend.
type Number = fn(&mut OpenPbrParameters) -> &mut f32;

/// How many such numbers there are.
pub(super) const NUMBERS: usize = 12;

/// A number and how its range is made [0, 1].
const AXES: [(Number, Scale); NUMBERS] = [
    (|p| &mut p.specular_roughness, Scale::Share),
    (|p| &mut p.specular_weight, Scale::Weight),
    (|p| &mut p.specular_ior, Scale::Index),
    (|p| &mut p.specular_roughness_anisotropy, Scale::Share),
    (|p| &mut p.coat_weight, Scale::Presence(3)),
    (|p| &mut p.coat_roughness, Scale::Share),
    (|p| &mut p.coat_ior, Scale::Index),
    (|p| &mut p.coat_roughness_anisotropy, Scale::Share),
    (|p| &mut p.fuzz_weight, Scale::Presence(2)),
    (|p| &mut p.fuzz_roughness, Scale::Share),
    (|p| &mut p.thin_film_weight, Scale::Presence(2)),
    (|p| &mut p.thin_film_ior, Scale::Index),
];

/// How a number is made one in [0, 1] that its effect is about linear in.
#[derive(Clone, Copy, Debug)]
enum Scale {
    /// It is.
    Share,
    /// It is, more or less exactly, so that so many nodes do.
    Presence(usize),
    /// Any number ≥ 0.
    Weight,
    /// An index of refraction.
    Index,
}

impl Scale {
    /// How many nodes do, if not as many as possible.
    fn nodes(self) -> Option<usize> {
        match self {
            Self::Presence(nodes) => Some(nodes),
            _ => None,
        }
    }

    fn to_unit(self, value: f32) -> f32 {
        match self {
            Self::Share | Self::Presence(_) => value,
            Self::Weight => value.sqrt() / (1.0 + value.sqrt()),
            Self::Index => (value - 1.0) / (value + 1.0),
        }
    }

    fn value(self, unit: f32) -> f32 {
        match self {
            Self::Share | Self::Presence(_) => unit,
            Self::Weight => sqr(unit / (1.0 - unit).max(1e-3)),
            Self::Index => (1.0 + unit) / (1.0 - unit),
        }
    }
}

/// A number that varies: which, in what range of [0, 1], at how many nodes.
#[derive(Clone, Copy, Debug)]
struct Axis {
    number: usize,
    range: [f32; 2],
    len: usize,
}

impl Axis {
    /// The place of a value, in nodes.
    fn place(&self, value: f32) -> f32 {
        let [least, most] = self.range;
        let unit = AXES[self.number].1.to_unit(value);
        ((unit - least) / (most - least)).clamp(0.0, 1.0) * (self.len - 1) as f32
    }

    /// The value of a node.
    fn value(&self, node: usize) -> f32 {
        let t = node as f32 / (self.len - 1) as f32;
        AXES[self.number].1.value(math::lerp(t, self.range[0], self.range[1]))
    }
}

/// Means of what is left for the last layer, over directions by their cosine.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Means {
    /// Of what fuzz scatters again.
    pub fuzz: f32,
    /// Of what is left for metal.
    pub metal: f32,
    /// Of what is left for the diffuse base.
    pub diffuse: f32,
    /// Of what is left for glass, above and below.
    pub glass: [f32; 2],
    /// Of what white facets of the base reflect.
    pub white: f32,
}

/// What the layers of a material do with light, for all values of its numbers.
#[derive(Clone)]
pub struct OpenPbrTable {
    axes: Vec<Axis>,
    azimuths: usize,
    /// The thickness of films in wavelengths, and the number of its nodes.
    waves: [f32; 2],
    films: usize,
    /// Whether only the cosine and the film vary.
    is_plain: bool,
    /// The layers, if their numbers are the same everywhere.
    fixed: Option<Stack>,
    /// By axes, film, azimuth and cosine.
    taken: Vec<Row>,
    /// The same for glass; else empty.
    inside: Vec<Inside>,
    /// By axes and film.
    means: Vec<Means>,
}

impl fmt::Debug for OpenPbrTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("OpenPbrTable").field("axes", &self.axes).finish_non_exhaustive()
    }
}

/// A place among the numbers that vary, in nodes of each.
pub(super) type Numbers = [f32; NUMBERS];

impl OpenPbrTable {
    /// Of a material whose numbers lie between those of `least` and of `most`. Colours do not
    /// matter.
    pub fn new(least: &OpenPbrParameters, most: &OpenPbrParameters) -> Self {
        let has = |weight: fn(&OpenPbrParameters) -> f32| weight(most) > 0.0;
        let (has_coat, has_fuzz) = (has(|p| p.coat_weight), has(|p| p.fuzz_weight));
        let has_film = has(|p| p.thin_film_weight) && has(|p| p.thin_film_thickness);
        let has_glass = has(|p| p.transmission_weight) && least.base_metalness < 1.0;
        let is_round =
            !(has(|p| p.specular_roughness_anisotropy) || has_coat && has(|p| p.coat_roughness_anisotropy));
        let (mut low, mut high) = (*least, *most);
        let mut axes = Vec::new();
        for (number, (value, scale)) in AXES.into_iter().enumerate() {
            let range = [*value(&mut low), *value(&mut high)].map(|value| scale.to_unit(value));
            let matters = match number {
                4..8 => has_coat,
                8..10 => has_fuzz,
                10.. => has_film,
                _ => true,
            };
            if matters && range[0] < range[1] {
                axes.push(Axis { number, range, len: 0 });
            }
        }
        let mut waves = [0.0; 2];
        let mut films = 1;
        if has_film {
            waves = [least.thin_film_thickness / LAMBDA_MAX, most.thin_film_thickness / LAMBDA_MIN]
                .map(|waves| (1000.0 * waves).min(MOST_WAVES));
            films = 2 + ((waves[1] - waves[0]) * NODES_PER_WAVE) as usize;
        }
        if !axes.is_empty() {
            films = films.min(FEW_FILMS);
        }
        let azimuths = if is_round { 1 } else { AZIMUTHS };
        let few: usize = axes.iter().filter_map(|axis| AXES[axis.number].1.nodes()).product();
        let others = axes.iter().filter(|axis| AXES[axis.number].1.nodes().is_none()).count();
        let each = (MOST_NODES / (films * azimuths * few)).max(1) as f64;
        let len = (each.powf(1.0 / others.max(1) as f64) as usize).clamp(NODES[0], NODES[1]);
        axes.iter_mut().for_each(|axis| axis.len = AXES[axis.number].1.nodes().unwrap_or(len));
        let fixed = axes.is_empty().then(|| Stack::new(least));
        let is_plain = axes.is_empty() && azimuths == 1;
        let (taken, inside, means) = (Vec::new(), Vec::new(), Vec::new());
        let mut table = Self { axes, azimuths, waves, films, is_plain, fixed, taken, inside, means };
        table.fill(least, has_fuzz, has_glass);
        table
    }

    fn fill(&mut self, parameters: &OpenPbrParameters, has_fuzz: bool, has_glass: bool) {
        let cells: usize = self.axes.iter().map(|axis| axis.len).product();
        for cell in 0..cells {
            let (mut p, mut rest) = (*parameters, cell);
            for axis in &self.axes {
                *AXES[axis.number].0(&mut p) = axis.value(rest % axis.len);
                rest /= axis.len;
            }
            if has_fuzz {
                // What fuzz does is known where there is some.
                p.fuzz_weight = p.fuzz_weight.max(1e-4);
            }
            let stack = Stack::new(&p);
            let above = stack.above();
            let part = |i: usize, len: usize| i as f32 / (len - 1).max(1) as f32;
            let direction = |i: usize| {
                let cosine = sqr(part(i % COSINES, COSINES)).max(1e-4);
                let (sine, cos_phi) = (safe_sqrt(1.0 - sqr(cosine)), part(i / COSINES, self.azimuths));
                Vec3::new(sine * cos_phi, sine * safe_sqrt(1.0 - sqr(cos_phi)), cosine)
            };
            let seen: Vec<_> =
                (0..self.azimuths * COSINES).map(|i| stack.seen(direction(i), has_glass)).collect();
            for film in 0..self.films {
                let waves = math::lerp(part(film, self.films), self.waves[0], self.waves[1]);
                let facing = stack.facing(waves);
                self.taken.extend(seen.iter().map(|seen| stack.taken(seen, &above, &facing, waves).to_row()));
                if has_glass {
                    self.inside.extend(seen.iter().map(|seen| stack.inside(seen, &above, &facing, waves)));
                }
                self.means.push(self.mean(self.means.len(), &seen, stack.is_thin));
            }
        }
    }

    /// The means over the directions of one node.
    fn mean(&self, node: usize, seen: &[Seen], is_thin: bool) -> Means {
        const STEPS: usize = 8;
        let mut means = Means::default();
        let steps = if self.azimuths > 1 { STEPS } else { 1 };
        for i in 0..steps {
            let cos_phi = (FRAC_PI_2 * (i as f32 + 0.5) / steps as f32).cos();
            for (cosine, weight) in nodes() {
                let weight = weight / steps as f32;
                let (mut taken, mut inside) = (Row::default(), Inside::default());
                for (row, share) in self.rows(cos_phi, cosine) {
                    means.white += weight * share * seen[row].white();
                    add(&mut taken, share, &self.taken[node * self.rows_of_node() + row]);
                    if let Some(row) = self.inside.get(node * self.rows_of_node() + row) {
                        inside.add(share, row);
                    }
                }
                let taken = Taken::from_row(taken);
                means.fuzz += weight * taken.fuzz_more;
                means.metal += weight * (taken.left - taken.metal).max(0.0);
                means.diffuse += weight * (taken.left - taken.dielectric).max(0.0);
                let above = (taken.left - taken.dielectric - taken.refracted).max(0.0);
                means.glass[0] += weight * if is_thin { inside.left() } else { above };
                means.glass[1] += weight * inside.left();
            }
        }
        means
    }

    /// The layers of a point's parameters.
    #[inline]
    pub(super) fn stack(&self, p: &OpenPbrParameters) -> Stack {
        self.fixed.unwrap_or_else(|| Stack::new(p))
    }

    /// The place of a point's parameters.
    #[inline]
    pub(super) fn place(&self, p: &OpenPbrParameters) -> Numbers {
        let mut places = [0.0; NUMBERS];
        if !self.axes.is_empty() {
            let mut p = *p;
            for (axis, place) in self.axes.iter().zip(&mut places) {
                *place = axis.place(*AXES[axis.number].0(&mut p));
            }
        }
        places
    }

    /// The place of a film of so many wavelengths, if there is one.
    #[inline]
    fn film(&self, waves: f32) -> Option<Place> {
        let [least, most] = self.waves;
        (self.films > 1).then(|| Place::new((waves - least) / (most - least), self.films))
    }

    /// The nodes around a place and a film of so many wavelengths, with their weights.
    #[inline]
    fn around(&self, numbers: &Numbers, waves: f32, mut node: impl FnMut(usize, f32)) {
        let film = self.film(waves);
        for corner in 0..1usize << self.axes.len() {
            let (mut index, mut stride, mut weight) = (0, self.films, 1.0);
            for (i, axis) in self.axes.iter().enumerate() {
                let lower = (numbers[i] as usize).min(axis.len - 2);
                let t = numbers[i] - lower as f32;
                let upper = corner >> i & 1;
                index += (lower + upper) * stride;
                stride *= axis.len;
                weight *= if upper == 1 { t } else { 1.0 - t };
            }
            match film {
                None => node(index, weight),
                Some(film) => {
                    let [lower, upper] = film.weights();
                    node(index + film.index, weight * lower);
                    node(index + film.index + 1, weight * upper);
                }
            }
        }
    }

    /// The rows of a node around a direction, with their weights.
    #[inline]
    fn rows(&self, cos_phi: f32, cosine: f32) -> impl Iterator<Item = (usize, f32)> + use<> {
        let across = Place::new(safe_sqrt(cosine), COSINES);
        let azimuth = (self.azimuths > 1).then(|| Place::new(cos_phi, self.azimuths));
        (0..if azimuth.is_some() { 4 } else { 2 }).map(move |i| {
            let weight = across.weights()[i & 1];
            let row = across.index + (i & 1);
            match azimuth {
                None => (row, weight),
                Some(azimuth) => {
                    ((azimuth.index + (i >> 1)) * COSINES + row, weight * azimuth.weights()[i >> 1])
                }
            }
        })
    }

    fn rows_of_node(&self) -> usize {
        self.azimuths * COSINES
    }

    /// |cos φ| of a direction, where it matters.
    #[inline]
    fn cos_phi(&self, w: Vector3) -> f32 {
        if self.azimuths == 1 {
            return 0.0;
        }
        w.x.abs() / (sqr(w.x) + sqr(w.y)).sqrt().max(f32::MIN_POSITIVE)
    }

    /// What the layers take of the light from a direction above, or from its opposite.
    #[inline]
    pub(super) fn taken(&self, numbers: &Numbers, waves: f32, w: Vector3) -> Taken {
        if self.is_plain {
            let place = Place::new(safe_sqrt(w.z.abs()), COSINES);
            let row = |film: usize| {
                let rows = &self.taken[film * COSINES + place.index..][..2];
                mix(place.weights(), &rows[0], &rows[1])
            };
            let Some(film) = self.film(waves) else { return Taken::from_row(row(0)) };
            return Taken::from_row(mix(film.weights(), &row(film.index), &row(film.index + 1)));
        }
        let mut sum = Row::default();
        let (cosine, cos_phi) = (w.z.abs(), self.cos_phi(w));
        self.around(numbers, waves, |node, weight| {
            for (row, share) in self.rows(cos_phi, cosine) {
                add(&mut sum, weight * share, &self.taken[node * self.rows_of_node() + row]);
            }
        });
        Taken::from_row(sum)
    }

    /// What glass does with light from a direction below or, if it is a sheet, from either side.
    pub(super) fn inside(&self, numbers: &Numbers, waves: &SampledSpectrum, w: Vector3) -> Inside {
        let mut sum = Inside::default();
        let (cosine, cos_phi) = (w.z.abs(), self.cos_phi(w));
        let mut add = |waves: f32, part: f32| {
            self.around(numbers, waves, |node, weight| {
                for (row, share) in self.rows(cos_phi, cosine) {
                    sum.add(part * weight * share, &self.inside[node * self.rows_of_node() + row]);
                }
            });
        };
        if self.films == 1 {
            add(0.0, 1.0);
        } else {
            waves.0.into_iter().for_each(|waves| add(waves, 1.0 / spectrum::N as f32));
        }
        sum
    }

    /// What the layers over the base pass on at a cosine, for a middle azimuth.
    pub(super) fn passed(&self, numbers: &Numbers, cosine: f32) -> f32 {
        let across = safe_sqrt(0.5 * (1.0 - sqr(cosine)));
        self.taken(numbers, self.waves[0], Vec3::new(across, across, cosine)).below_coat
    }

    /// The means at a place.
    #[inline]
    pub(super) fn means(&self, numbers: &Numbers, waves: f32) -> Means {
        let mut sum = Means::default();
        if self.is_plain {
            let Some(film) = self.film(waves) else { return self.means[0] };
            let [lower, upper] = film.weights();
            sum.add(lower, &self.means[film.index]);
            sum.add(upper, &self.means[film.index + 1]);
            return sum;
        }
        self.around(numbers, waves, |node, weight| sum.add(weight, &self.means[node]));
        sum
    }

    /// Whether there may be a film.
    #[inline]
    pub(super) fn has_film(&self) -> bool {
        self.films > 1
    }
}

/// The weighted sum of two rows.
#[inline]
fn mix([lower, upper]: [f32; 2], a: &Row, b: &Row) -> Row {
    std::array::from_fn(|i| lower * a[i] + upper * b[i])
}

#[inline]
fn add(sum: &mut Row, weight: f32, row: &Row) {
    sum.iter_mut().zip(row).for_each(|(sum, value)| *sum += weight * value);
}

impl Means {
    #[inline]
    fn add(&mut self, weight: f32, means: &Self) {
        self.fuzz += weight * means.fuzz;
        self.metal += weight * means.metal;
        self.diffuse += weight * means.diffuse;
        self.glass[0] += weight * means.glass[0];
        self.glass[1] += weight * means.glass[1];
        self.white += weight * means.white;
    }
}
