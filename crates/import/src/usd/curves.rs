//! Curves and points with widths. Curves of every basis become cubic Bézier segments; a width is
//! carried through as a fourth coordinate.

use std::sync::Arc;

use description::{CurveBasis, CurveDesc, CurveProfile, ShapeDesc, ShapeKind, SpheresDesc};
use math::{DVec3, DVec4, Vec3};

use super::primvar::{Counts, Interpolation, Primvar};
use super::solid::Solid;
use super::stage::Prim;
use crate::log::{Log, Result};

/// Width of curves and points that have none, as a part of the box around them.
const WIDTH: f64 = 1.0 / 500.0;

/// A shape with the number of the curve or point whose colour it has.
pub(super) type Numbered = (usize, Solid);

/// The control points of one curve: how many there are, and how they are joined.
#[derive(Clone, Copy)]
struct Kind<'k> {
    basis: &'k str,
    is_periodic: bool,
    is_pinned: bool,
}

/// The curves of a prim.
pub(super) fn read(prim: &Prim, log: &mut Log) -> Result<Vec<Numbered>> {
    const COUNTS: &str = "curveVertexCounts";
    let points = prim.array::<3>("points")?.unwrap_or_default();
    let lengths = prim.integers(COUNTS)?.unwrap_or_default();
    let lengths: Option<Vec<usize>> = lengths.iter().map(|&length| usize::try_from(length).ok()).collect();
    let lengths = lengths.ok_or_else(|| prim.fault(COUNTS, "there is a number below 0"))?;
    let sum = lengths.iter().try_fold(0_usize, |sum, &length| sum.checked_add(length));
    if sum != Some(points.len()) {
        return Err(prim.fault(COUNTS, format!("the curves do not have the {} points", points.len())));
    }
    let word = |name: &str, otherwise: &str| Ok(prim.word(name)?.unwrap_or_else(|| otherwise.to_owned()));
    let (degree, wrap) = (word("type", "cubic")?, word("wrap", "nonperiodic")?);
    let basis = if degree == "linear" { degree } else { word("basis", "bezier")? };
    if !matches!(basis.as_str(), "linear" | "bezier" | "bspline" | "catmullRom") {
        return Err(prim.fault("basis", format!("`{basis}` is not a basis of curves")));
    }
    let kind = Kind { basis: &basis, is_periodic: wrap == "periodic", is_pinned: wrap == "pinned" };
    let ends = |length: usize| match (kind.segments(length), kind.is_periodic) {
        (segments, true) => segments,
        (segments, false) => segments + 1,
    };
    let varying = lengths.iter().map(|&length| ends(length)).sum();
    let counts = Counts { faces: lengths.len(), points: points.len(), varying, corners: points.len() };
    let widths = widths(prim, counts, &points, log)?;
    if prim.array::<3>("normals")?.is_some_and(|normals| !normals.is_empty()) {
        log.warn("not-drawn", prim.path(), "ribbons are drawn as round curves");
    }
    let mut curves = Vec::new();
    let (mut first, mut first_end) = (0, 0);
    for (number, &length) in lengths.iter().enumerate() {
        let is_vertex = widths.interpolation == Interpolation::Vertex;
        let width = |point: usize| if is_vertex { widths.values[point][0] } else { 0.0 };
        let control: Vec<DVec4> =
            (first..first + length).map(|point| DVec3::from(points[point]).extend(width(point))).collect();
        let mut segments = kind.bezier(&control);
        for (index, segment) in segments.iter_mut().enumerate() {
            let width = |end: usize| match widths.interpolation {
                Interpolation::Uniform => widths.values[number][0],
                Interpolation::Varying => widths.values[first_end + (index + end) % ends(length)][0],
                _ => widths.values[0][0],
            };
            if !is_vertex {
                (segment[0].w, segment[3].w) = (width(0), width(1));
            }
        }
        if segments.iter().flatten().all(|point| point.is_finite()) {
            curves.extend(strands(&segments).map(|solid| (number, solid)));
        } else {
            return Err(prim.fault("points", format!("the curve {number} is not finite")));
        }
        first += length;
        first_end += ends(length);
    }
    Ok(curves)
}

fn widths(prim: &Prim, counts: Counts, points: &[[f64; 3]], log: &mut Log) -> Result<Primvar<1>> {
    let widths = Primvar::<1>::read(prim, "widths", Interpolation::Vertex, counts)?;
    Ok(match widths.map_or_else(|| Primvar::of(prim, "widths", counts), |widths| Ok(Some(widths)))? {
        Some(widths) => widths,
        None => {
            log.warn("not-drawn", prim.path(), "curves and points without widths are drawn as thin ones");
            let points = points.iter().map(|point| DVec3::from(*point));
            let low = points.clone().fold(DVec3::INFINITY, DVec3::min);
            let size = (points.fold(DVec3::NEG_INFINITY, DVec3::max) - low).length();
            let width = if size.is_finite() { size * WIDTH } else { 0.0 };
            Primvar { interpolation: Interpolation::Constant, values: vec![[width]] }
        }
    })
}

impl Kind<'_> {
    /// How many segments a number of points makes.
    fn segments(&self, points: usize) -> usize {
        match (self.basis, self.is_periodic) {
            ("linear", true) if points > 1 => points,
            ("linear", _) => points.saturating_sub(1),
            ("bezier", true) => points / 3,
            ("bezier", false) => points.saturating_sub(1) / 3,
            (_, true) => points,
            (_, false) if self.is_pinned => points.saturating_sub(1),
            (_, false) => points.saturating_sub(3),
        }
    }

    /// The segments of control points.
    fn bezier(&self, points: &[DVec4]) -> Vec<[DVec4; 4]> {
        let n = points.len();
        let count = self.segments(n);
        // Beyond the ends, points are those of the other end or, of pinned curves, go straight on.
        let at = |index: isize| match usize::try_from(index) {
            Ok(index) if index < n => points[index],
            _ if self.is_periodic => points[index.rem_euclid(n as isize) as usize],
            Ok(_) => 2.0 * points[n - 1] - points[n.saturating_sub(2)],
            Err(_) => 2.0 * points[0] - points[1.min(n - 1)],
        };
        let segment = |index: usize| {
            let i = index as isize;
            let first = if self.is_pinned { i - 1 } else { i };
            let [a, b, c, d] = [first, first + 1, first + 2, first + 3];
            match self.basis {
                "linear" => {
                    [at(i), at(i).lerp(at(i + 1), 1.0 / 3.0), at(i).lerp(at(i + 1), 2.0 / 3.0), at(i + 1)]
                }
                "bezier" => [at(3 * i), at(3 * i + 1), at(3 * i + 2), at(3 * i + 3)],
                "bspline" => [
                    (at(a) + 4.0 * at(b) + at(c)) / 6.0,
                    (4.0 * at(b) + 2.0 * at(c)) / 6.0,
                    (2.0 * at(b) + 4.0 * at(c)) / 6.0,
                    (at(b) + 4.0 * at(c) + at(d)) / 6.0,
                ],
                _ => [at(b), at(b) + (at(c) - at(a)) / 6.0, at(c) - (at(d) - at(b)) / 6.0, at(c)],
            }
        };
        (0..count).map(segment).collect()
    }
}

/// Segments as shapes: one if the width is linear over all of them, else one for each.
fn strands(segments: &[[DVec4; 4]]) -> impl Iterator<Item = Solid> {
    let ends = segments.first().zip(segments.last()).map(|(first, last)| [first[0].w, last[3].w]);
    let [start, end] = ends.unwrap_or_default();
    let count = segments.len() as f64;
    let is_linear = segments.iter().enumerate().all(|(index, segment)| {
        let expected = start + (end - start) * (index + 1) as f64 / count;
        (segment[3].w - expected).abs() <= 1e-4 * (start.abs() + end.abs())
    });
    let size = if is_linear { segments.len().max(1) } else { 1 };
    segments.chunks(size).map(strand)
}

fn strand(segments: &[[DVec4; 4]]) -> Solid {
    let first = segments[0][0];
    let rest = segments.iter().flat_map(|segment| &segment[1..]);
    let points: Vec<DVec4> = std::iter::once(first).chain(rest.copied()).collect();
    let width = [first.w, segments[segments.len() - 1][3].w].map(|width| width.max(0.0));
    let control_points: Arc<[Vec3]> =
        points.iter().map(|point| Vec3::from(point.truncate().as_vec3())).collect();
    let curve = CurveDesc {
        control_points,
        degree: 3,
        basis: CurveBasis::Bezier,
        profile: CurveProfile::Cylinder,
        normals: Arc::default(),
        width: width.map(|width| width as f32),
        split_depth: 3,
    };
    let thick = DVec3::splat(width[0].max(width[1]) / 2.0);
    let low = points.iter().fold(DVec3::INFINITY, |low, point| low.min(point.truncate())) - thick;
    let high = points.iter().fold(DVec3::NEG_INFINITY, |high, point| high.max(point.truncate())) + thick;
    Solid { shape: ShapeKind::Curve(curve).into(), bounds: [low, high] }
}

/// The points of a prim, as spheres of its own colours: those of each colour are one shape. Points
/// of more colours than a scene has use for are of the first.
pub(super) fn points(prim: &Prim, colors: Option<&Primvar<3>>, log: &mut Log) -> Result<Vec<Numbered>> {
    const MOST_COLORS: usize = 1024;
    let points = prim.array::<3>("points")?.unwrap_or_default();
    let counts = Counts { faces: 1, points: points.len(), varying: points.len(), corners: points.len() };
    let widths = widths(prim, counts, &points, log)?;
    if let Some(index) = points.iter().position(|point| point.iter().any(|v| !v.is_finite())) {
        return Err(prim.fault("points", format!("the point {index} is not finite")));
    }
    let mut parts: Vec<(usize, Vec<usize>)> = Vec::new();
    let mut known = std::collections::HashMap::new();
    for point in 0..points.len() {
        let color = colors.map_or([0.0; 3], |colors| colors.at(point, point, 0)).map(f64::to_bits);
        let part = *known.entry(color).or_insert_with(|| {
            if parts.len() < MOST_COLORS {
                parts.push((point, Vec::new()));
                parts.len() - 1
            } else {
                let message = format!("points of more than {MOST_COLORS} colours are of the first");
                log.warn("not-drawn", prim.path(), message);
                0
            }
        });
        parts[part].1.push(point);
    }
    let spheres = parts.into_iter().map(|(first, part)| {
        let radius = |&point: &usize| (widths.at(point, point, 0)[0].max(0.0) / 2.0) as f32;
        let center = |&point: &usize| DVec3::from(points[point]);
        let part: Vec<usize> = part.into_iter().filter(|point| radius(point) > 0.0).collect();
        let low = |low: DVec3, point| low.min(center(point) - f64::from(radius(point)));
        let high = |high: DVec3, point| high.max(center(point) + f64::from(radius(point)));
        let bounds = [part.iter().fold(DVec3::INFINITY, low), part.iter().fold(DVec3::NEG_INFINITY, high)];
        let kind = ShapeKind::Spheres(SpheresDesc {
            centers: part.iter().map(|point| Vec3::from(center(point).as_vec3())).collect(),
            radii: part.iter().map(radius).collect(),
        });
        (first, Solid { shape: ShapeDesc::from(kind), bounds }, part.is_empty())
    });
    Ok(spheres.filter(|&(_, _, is_empty)| !is_empty).map(|(first, solid, _)| (first, solid)).collect())
}
