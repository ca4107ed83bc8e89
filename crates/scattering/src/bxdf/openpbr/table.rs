//! What the layers of a material do with light from any direction, in a table.
//!
//! The table has a row for each node of the cosine, and of whatever varies: of the azimuth, where
//! facets are not alike both ways; of the optical thickness of the film in wavelengths, where there
//! is one; and of each number that is not the same everywhere. Between nodes everything is linear,
//! so that what is left for the last layer and its means fit together as exactly as at the nodes.

use super::OpenPbrParameters;
use super::stack::{Inside, Seen, Stack, Taken};
use crate::grid::{Place, nodes};
use lanes::{Int, Real};
use math::{Vec3, Vector3, safe_sqrt, sqr};
use spectrum::{LAMBDA_MAX, LAMBDA_MIN, N, SampledSpectrum};
use std::f32::consts::FRAC_PI_2;
use std::fmt;

/// Cosines, the squares of 0, 1/36, … 1, among which are those of the tables of albedos.
const COSINES: usize = 37;
/// Cosines of the azimuth, where it matters.
const AZIMUTHS: usize = 13;
/// Tables have so many nodes at most, without those of cosines.
const MOST_NODES: usize = 32768;
/// A film of more wavelengths counts as one of so many.
const MOST_WAVES: f32 = 24.0;
/// Intervals for each wavelength of a film's optical thickness, two periods of its reflectance.
const INTERVALS_PER_WAVE: f32 = 12.0;
/// By how much nodes are closer where there is room for that.
const FINEST: f32 = 2.0;

/// How many numbers the layers depend on.
const NUMBERS: usize = 12;

/// How the range of each is made [0, 1], and the intervals between nodes in which that has an error
/// of about a percent of all light: so many that each number has an equal part in the error of a
/// table of several, whose nodes are closer or farther in the same ratio.
const SCALES: [(Scale, f32); NUMBERS] = [
    (Scale::Share, 8.0),
    (Scale::Weight, 8.0),
    (Scale::Index, 16.0),
    (Scale::Share, 4.0),
    (Scale::Root, 8.0),
    (Scale::Share, 12.0),
    (Scale::Index, 16.0),
    (Scale::Share, 4.0),
    (Scale::Presence, 1.0),
    (Scale::Share, 8.0),
    (Scale::Presence, 1.0),
    (Scale::Index, 16.0),
];

/// One of these numbers.
#[inline(always)]
fn number<R>(p: &mut OpenPbrParameters<R>, number: usize) -> &mut R {
    match number {
        0 => &mut p.specular_roughness,
        1 => &mut p.specular_weight,
        2 => &mut p.specular_ior,
        3 => &mut p.specular_roughness_anisotropy,
        4 => &mut p.coat_weight,
        5 => &mut p.coat_roughness,
        6 => &mut p.coat_ior,
        7 => &mut p.coat_roughness_anisotropy,
        8 => &mut p.fuzz_weight,
        9 => &mut p.fuzz_roughness,
        10 => &mut p.thin_film_weight,
        _ => &mut p.thin_film_ior,
    }
}

/// How a number is made one in [0, 1] that its effect is about linear in.
#[derive(Clone, Copy, Debug)]
enum Scale {
    /// It is.
    Share,
    /// It is, exactly, so that two nodes do.
    Presence,
    /// By its root: under a coat that is hardly there, light meets the base less steeply by that.
    Root,
    /// Any number ≥ 0.
    Weight,
    /// An index of refraction.
    Index,
}

impl Scale {
    #[inline(always)]
    fn to_unit<R: Real>(self, value: R) -> R {
        match self {
            Self::Share | Self::Presence => value,
            Self::Root => value.sqrt(),
            Self::Weight => value.sqrt() / (R::one() + value.sqrt()),
            Self::Index => (value - R::one()) / (value + R::one()),
        }
    }

    fn value(self, unit: f32) -> f32 {
        match self {
            Self::Share | Self::Presence => unit,
            Self::Root => sqr(unit),
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
    /// The number of its nodes, which are so many times as close as they need be.
    fn nodes(&self, closeness: f32) -> usize {
        let (scale, intervals) = SCALES[self.number];
        match scale {
            Scale::Presence => 2,
            _ => 1 + ((self.range[1] - self.range[0]) * intervals * closeness).ceil() as usize,
        }
    }

    /// The place of a value, in nodes.
    #[inline(always)]
    fn place<R: Real>(&self, value: R) -> R {
        let [least, most] = self.range;
        let unit = (SCALES[self.number].0.to_unit(value) - R::splat(least)) / R::splat(most - least);
        unit.clamp(R::zero(), R::one()) * R::splat((self.len - 1) as f32)
    }

    /// The value of a node.
    fn value(&self, node: usize) -> f32 {
        let t = node as f32 / (self.len - 1) as f32;
        SCALES[self.number].0.value(math::lerp(t, self.range[0], self.range[1]))
    }
}

/// Means of what is left for the last layer, over directions by their cosine.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Means<R = f32> {
    /// Of what fuzz scatters again.
    pub fuzz: R,
    /// Of what is left for metal.
    pub metal: R,
    /// Of what is left for the diffuse base.
    pub diffuse: R,
    /// Of what white facets of the base reflect.
    pub white: R,
    /// Of what is left for glass, above and below.
    pub glass_above: R,
    pub glass_below: R,
}

/// The numbers of a row of `taken`, of `inside`, and of `means`.
const TAKEN: usize = 8;
const INSIDE: usize = 3;
const MEANS: usize = 6;

/// What the layers of a material do with light, for all values of its numbers.
#[derive(Clone)]
pub struct OpenPbrTable {
    axes: Vec<Axis>,
    azimuths: usize,
    /// The optical thickness of films in wavelengths, and the number of its nodes.
    waves: [f32; 2],
    films: usize,
    /// The numbers of a [`Taken`] by axes, film, azimuth and cosine.
    taken: Vec<f32>,
    /// The same for glass; else empty.
    inside: Vec<f32>,
    /// The numbers of a [`Means`] by axes and film.
    means: Vec<f32>,
}

/// A table as plain data, for an engine that looks it up elsewhere.
#[derive(Clone, Debug)]
pub struct PlainOpenPbrTable<'a> {
    /// The numbers that vary: which of the twelve, whether as it is (0), as a weight
    /// (1), as an index (2) or by its root (3), the nodes, and the range.
    pub axes: Vec<(u32, u32, u32, [f32; 2])>,
    /// How many azimuths there are, and how many films, by their optical thickness in
    /// wavelengths.
    pub azimuths: u32,
    /// See `azimuths`.
    pub films: u32,
    /// The range of their thickness.
    pub waves: [f32; 2],
    /// Rows of eight numbers by axes, film, azimuth and cosine.
    pub taken: &'a [f32],
    /// Rows of three; empty without glass.
    pub inside: &'a [f32],
    /// Rows of six by axes and film.
    pub means: &'a [f32],
}

impl OpenPbrTable {
    /// The table as plain data.
    pub fn plain(&self) -> PlainOpenPbrTable<'_> {
        let axis = |axis: &Axis| {
            let scale = match SCALES[axis.number].0 {
                Scale::Share | Scale::Presence => 0,
                Scale::Weight => 1,
                Scale::Index => 2,
                Scale::Root => 3,
            };
            (axis.number as u32, scale, axis.len as u32, axis.range)
        };
        PlainOpenPbrTable {
            axes: self.axes.iter().map(axis).collect(),
            azimuths: self.azimuths as u32,
            films: self.films as u32,
            waves: self.waves,
            taken: &self.taken,
            inside: &self.inside,
            means: &self.means,
        }
    }
}

impl fmt::Debug for OpenPbrTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("OpenPbrTable").field("axes", &self.axes).finish_non_exhaustive()
    }
}

/// A place among the numbers that vary, in nodes of each.
#[derive(Clone, Copy, Debug)]
pub(super) struct Location<R = f32>([R; 12]);

/// The rows of a node around a direction.
struct Rows<R: Real> {
    across: Place<R>,
    around: Place<R>,
    /// How many.
    count: usize,
}

impl<R: Real> Rows<R> {
    /// One of them, and its weight.
    #[inline(always)]
    fn get(&self, i: usize) -> (R::Int, R) {
        let (row, weight) = self.across.node(i & 1 == 1);
        if self.count == 2 {
            return (row, weight);
        }
        let (azimuth, share) = self.around.node(i & 2 == 2);
        (azimuth.wrapping_mul(R::Int::splat(COSINES as u32)).wrapping_add(row), weight * share)
    }
}

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
        for (axis, (scale, _)) in SCALES.into_iter().enumerate() {
            let range = [*number(&mut low, axis), *number(&mut high, axis)].map(|value| scale.to_unit(value));
            let matters = match axis {
                4..8 => has_coat,
                8..10 => has_fuzz,
                10.. => has_film,
                _ => true,
            };
            if matters && range[0] < range[1] {
                axes.push(Axis { number: axis, range, len: 0 });
            }
        }
        let mut waves = [0.0; 2];
        if has_film {
            let optical = |p: &OpenPbrParameters| 1000.0 * p.thin_film_thickness * p.thin_film_ior;
            waves = [optical(least) / LAMBDA_MAX, optical(most) / LAMBDA_MIN].map(|w| w.min(MOST_WAVES));
            waves[1] = waves[1].max(waves[0] + 1e-3);
        }
        let films = |closeness: f32| match has_film {
            true => 2 + ((waves[1] - waves[0]) * INTERVALS_PER_WAVE * closeness) as usize,
            false => 1,
        };
        let azimuths = if is_round { 1 } else { AZIMUTHS };
        let count = |closeness: f32| {
            let nodes = axes.iter().map(|axis| axis.nodes(closeness)).product::<usize>();
            nodes * films(closeness) * azimuths
        };
        let mut closeness = FINEST;
        while count(closeness) > MOST_NODES && closeness > 0.02 {
            closeness *= 0.95;
        }
        let films = films(closeness);
        axes.iter_mut().for_each(|axis| axis.len = axis.nodes(closeness));
        let (taken, inside, means) = (Vec::new(), Vec::new(), Vec::new());
        let mut table = Self { axes, azimuths, waves, films, taken, inside, means };
        table.fill(least, has_fuzz, has_glass);
        table
    }

    fn fill(&mut self, parameters: &OpenPbrParameters, has_fuzz: bool, has_glass: bool) {
        let cells: usize = self.axes.iter().map(|axis| axis.len).product();
        for cell in 0..cells {
            let (mut p, mut rest) = (*parameters, cell);
            for axis in &self.axes {
                *number(&mut p, axis.number) = axis.value(rest % axis.len);
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
                for seen in &seen {
                    let taken = stack.taken(seen, &above, &facing, waves);
                    self.taken.extend([taken.fuzz_once, taken.fuzz_more, taken.coat, taken.below_coat]);
                    self.taken.extend([taken.metal, taken.dielectric, taken.refracted, taken.left]);
                    if has_glass {
                        let Inside { reflected, refracted, left } =
                            stack.inside(seen, &above, &facing, waves);
                        self.inside.extend([reflected, refracted, left]);
                    }
                }
                let node = self.means.len() / MEANS;
                let means = self.mean(node, &seen, stack.is_thin);
                let Means { fuzz, metal, diffuse, white, glass_above, glass_below } = means;
                self.means.extend([fuzz, metal, diffuse, white, glass_above, glass_below]);
            }
        }
    }

    /// The means over the directions of one node.
    fn mean(&self, node: usize, seen: &[Seen], is_thin: bool) -> Means {
        const STEPS: usize = 8;
        let mut means = Means::default();
        let steps = if self.azimuths > 1 { STEPS } else { 1 };
        for i in 0..steps {
            let cos_phi = lanes::cos(FRAC_PI_2 * (i as f32 + 0.5) / steps as f32);
            for (cosine, weight) in nodes() {
                let weight = weight / steps as f32;
                let (mut taken, mut inside) = (Taken::default(), Inside::default());
                let rows: Rows<f32> = self.rows(cos_phi, cosine);
                for i in 0..rows.count {
                    let (row, share) = rows.get(i);
                    means.white += weight * share * seen[row as usize].white();
                    let row = node as u32 * self.rows_of_node() + row;
                    self.add_taken(&mut taken, row, share);
                    if !self.inside.is_empty() {
                        self.add_inside(&mut inside, row, share);
                    }
                }
                means.fuzz += weight * taken.fuzz_more;
                means.metal += weight * (taken.left - taken.metal).max(0.0);
                means.diffuse += weight * (taken.left - taken.dielectric).max(0.0);
                let above = (taken.left - taken.dielectric - taken.refracted).max(0.0);
                let below = inside.left.max(0.0);
                means.glass_above += weight * if is_thin { below } else { above };
                means.glass_below += weight * below;
            }
        }
        means
    }

    /// The place of a point's parameters.
    #[inline(always)]
    pub(super) fn locate<R: Real>(&self, p: &OpenPbrParameters<R>) -> Location<R> {
        let mut places = [R::zero(); 12];
        if !self.axes.is_empty() {
            let mut p = *p;
            for (i, axis) in self.axes.iter().enumerate() {
                places[i] = axis.place(*number(&mut p, axis.number));
            }
        }
        Location(places)
    }

    /// The place of a film of so many wavelengths.
    #[inline(always)]
    fn film<R: Real>(&self, waves: R) -> Place<R> {
        let [least, most] = self.waves;
        Place::new((waves - R::splat(least)) / R::splat(most - least), self.films.max(2))
    }

    /// The number of nodes around a place.
    #[inline(always)]
    fn corners(&self) -> usize {
        let films = if self.has_film() { 2 } else { 1 };
        films << self.axes.len()
    }

    /// One of the nodes around a place and a film, and its weight.
    #[inline(always)]
    fn corner<R: Real>(&self, location: &Location<R>, film: Place<R>, corner: usize) -> (R::Int, R) {
        let (mut node, mut weight) = (R::Int::splat(0), R::one());
        let mut corner = corner;
        if self.has_film() {
            (node, weight) = film.node(corner & 1 == 1);
            corner >>= 1;
        }
        let mut stride = self.films;
        for i in 0..self.axes.len() {
            let len = self.axes[i].len;
            let (index, share) = Place::among(location.0[i], len).node(corner >> i & 1 == 1);
            node = node.wrapping_add(index.wrapping_mul(R::Int::splat(stride as u32)));
            weight *= share;
            stride *= len;
        }
        (node, weight)
    }

    /// The rows of a node around a direction.
    #[inline(always)]
    fn rows<R: Real>(&self, cos_phi: R, cosine: R) -> Rows<R> {
        Rows {
            across: Place::new(safe_sqrt(cosine), COSINES),
            around: Place::new(cos_phi, self.azimuths.max(2)),
            count: if self.azimuths > 1 { 4 } else { 2 },
        }
    }

    #[inline(always)]
    fn rows_of_node(&self) -> u32 {
        (self.azimuths * COSINES) as u32
    }

    /// |cos φ| of a direction, where it matters.
    #[inline(always)]
    fn cos_phi<R: Real>(&self, w: Vector3<R>) -> R {
        if self.azimuths == 1 {
            return R::zero();
        }
        w.x.abs() / (sqr(w.x) + sqr(w.y)).sqrt().max(R::splat(f32::MIN_POSITIVE))
    }

    #[inline(always)]
    fn add_taken<R: Real>(&self, sum: &mut Taken<R>, row: R::Int, weight: R) {
        let first = row.wrapping_mul(R::Int::splat(TAKEN as u32));
        let [fuzz_once, fuzz_more, coat, below_coat] = R::gather_rows(&self.taken, first);
        sum.fuzz_once += weight * fuzz_once;
        sum.fuzz_more += weight * fuzz_more;
        sum.coat += weight * coat;
        sum.below_coat += weight * below_coat;
        let [metal, dielectric, refracted, left] =
            R::gather_rows(&self.taken, first.wrapping_add(R::Int::splat(4)));
        sum.metal += weight * metal;
        sum.dielectric += weight * dielectric;
        sum.refracted += weight * refracted;
        sum.left += weight * left;
    }

    #[inline(always)]
    fn add_inside<R: Real>(&self, sum: &mut Inside<R>, row: R::Int, weight: R) {
        let first = row.wrapping_mul(R::Int::splat(INSIDE as u32));
        let [reflected, refracted, left] = R::gather_rows(&self.inside, first);
        sum.reflected += weight * reflected;
        sum.refracted += weight * refracted;
        sum.left += weight * left;
    }

    /// What the layers take of the light from a direction above, or from its opposite.
    #[inline(always)]
    pub(super) fn taken<R: Real>(&self, location: &Location<R>, waves: R, w: Vector3<R>) -> Taken<R> {
        let rows = self.rows(self.cos_phi(w), w.z.abs());
        let film = self.film(waves);
        let mut sum = Taken::default();
        for corner in 0..self.corners() {
            let (node, weight) = self.corner(location, film, corner);
            let first = node.wrapping_mul(R::Int::splat(self.rows_of_node()));
            for i in 0..rows.count {
                let (row, share) = rows.get(i);
                self.add_taken(&mut sum, first.wrapping_add(row), weight * share);
            }
        }
        sum
    }

    /// What glass does with light from a direction below or, if it is a sheet, from either side.
    #[inline(always)]
    pub(super) fn inside<R: Real>(
        &self,
        location: &Location<R>,
        waves: &SampledSpectrum<R>,
        w: Vector3<R>,
    ) -> Inside<R> {
        let rows = self.rows(self.cos_phi(w), w.z.abs());
        let mut sum = Inside::default();
        let count = if self.has_film() { N } else { 1 };
        let part = R::splat(1.0 / count as f32);
        for wave in 0..count {
            let film = self.film(waves[wave]);
            for corner in 0..self.corners() {
                let (node, weight) = self.corner(location, film, corner);
                let first = node.wrapping_mul(R::Int::splat(self.rows_of_node()));
                for i in 0..rows.count {
                    let (row, share) = rows.get(i);
                    self.add_inside(&mut sum, first.wrapping_add(row), part * weight * share);
                }
            }
        }
        Inside { left: sum.left.max(R::zero()), ..sum }
    }

    /// The means at a place.
    #[inline(always)]
    pub(super) fn means<R: Real>(&self, location: &Location<R>, waves: R) -> Means<R> {
        let film = self.film(waves);
        let mut sum = Means::default();
        for corner in 0..self.corners() {
            let (node, weight) = self.corner(location, film, corner);
            let first = node.wrapping_mul(R::Int::splat(MEANS as u32));
            let [fuzz, metal, diffuse, white] = R::gather_rows(&self.means, first);
            sum.fuzz += weight * fuzz;
            sum.metal += weight * metal;
            sum.diffuse += weight * diffuse;
            sum.white += weight * white;
            let [above, below] = R::gather_rows(&self.means, first.wrapping_add(R::Int::splat(4)));
            sum.glass_above += weight * above;
            sum.glass_below += weight * below;
        }
        sum
    }

    /// Whether there may be a film.
    #[inline(always)]
    pub(super) fn has_film(&self) -> bool {
        self.films > 1
    }
}
