//! Surfaces with textures at several sets of texture coordinates, as parts that need one set.
//!
//! Within a triangle each set is an affine function of any other one. Triangles with the same
//! functions are a chart, in which the textures of all sets have mappings from the first.

use std::collections::BTreeMap;

use math::{DAffine2, DMat2, DVec2, Point2};

use crate::primitives::Primitive;

/// Primitives of more charts than this are drawn with one set of texture coordinates.
const MOST: usize = 256;
/// How far texture coordinates may be from those of the file: a tenth of a texel of an image of
/// 1024.
const TOLERANCE: f64 = 1e-4;

/// Triangles in which the sets of texture coordinates are the same functions of the first.
#[derive(Clone, Debug, Default)]
pub(super) struct Chart {
    pub triangles: Vec<[u32; 3]>,
    /// From the first set to others, by their numbers; v is up in all.
    pub maps: BTreeMap<usize, DAffine2>,
}

impl Chart {
    /// The charts of a primitive, each triangle in one; `None` if there are too many.
    pub fn of(primitive: &Primitive) -> Option<Vec<Self>> {
        if primitive.other_uvs.is_empty() || primitive.uvs.is_empty() {
            return Some(vec![Self { triangles: primitive.triangles.clone(), maps: BTreeMap::new() }]);
        }
        // The largest triangles fix functions best, and others follow them.
        let mut order: Vec<usize> = (0..primitive.triangles.len()).collect();
        let area = |triangle: &usize| {
            let [a, b, c] = corners(&primitive.uvs, primitive.triangles[*triangle]);
            (b - a).perp_dot(c - a).abs()
        };
        order.sort_by(|a, b| area(b).total_cmp(&area(a)));
        let mut charts: Vec<(Self, Vec<usize>)> = Vec::new();
        let mut last = 0;
        for index in order {
            let triangle = primitive.triangles[index];
            let fits = |(chart, _): &(Self, Vec<usize>)| chart.fits(primitive, triangle);
            let found = match charts.get(last).is_some_and(fits) {
                true => Some(last),
                false => charts.iter().position(fits),
            };
            last = match found {
                Some(found) => found,
                None if charts.len() == MOST => return None,
                None => {
                    charts
                        .push((Self { triangles: Vec::new(), maps: maps(primitive, triangle) }, Vec::new()));
                    charts.len() - 1
                }
            };
            charts[last].1.push(index);
        }
        // In the order of the file.
        let mut charts: Vec<_> = charts
            .into_iter()
            .map(|(chart, mut indices)| {
                indices.sort_unstable();
                (
                    indices[0],
                    Self { triangles: indices.iter().map(|&i| primitive.triangles[i]).collect(), ..chart },
                )
            })
            .collect();
        charts.sort_by_key(|(first, _)| *first);
        Some(charts.into_iter().map(|(_, chart)| chart).collect())
    }

    fn fits(&self, primitive: &Primitive, triangle: [u32; 3]) -> bool {
        let from = corners(&primitive.uvs, triangle);
        primitive.other_uvs.iter().all(|(set, uvs)| {
            let (map, to) = (self.maps[set], corners(uvs, triangle));
            (0..3).all(|i| (map.transform_point2(from[i]) - to[i]).abs().max_element() < TOLERANCE)
        })
    }
}

/// The functions of a triangle. One without an area in the first set has one value of each other.
fn maps(primitive: &Primitive, triangle: [u32; 3]) -> BTreeMap<usize, DAffine2> {
    let [a, b, c] = corners(&primitive.uvs, triangle);
    let edges = DMat2::from_cols(b - a, c - a);
    let map = |(set, uvs): &(usize, Vec<Point2>)| {
        let [p, q, r] = corners(uvs, triangle);
        let matrix = match edges.determinant().abs() > 1e-14 {
            true => DMat2::from_cols(q - p, r - p) * edges.inverse(),
            false => DMat2::ZERO,
        };
        (*set, DAffine2::from_mat2_translation(matrix, p - matrix * a))
    };
    primitive.other_uvs.iter().map(map).collect()
}

/// The texture coordinates of a triangle, with v up.
fn corners(uvs: &[Point2], triangle: [u32; 3]) -> [DVec2; 3] {
    triangle.map(|vertex| {
        let uv = uvs[vertex as usize];
        DVec2::new(uv.x.into(), 1.0 - f64::from(uv.y))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A strip of squares, of which each has the second set turned by a quarter more.
    fn strip(squares: u32, turns: u32) -> Primitive {
        let mut primitive = Primitive::default();
        let mut other = Vec::new();
        for i in 0..squares {
            let turn = DAffine2::from_angle(f64::from(i % turns) * std::f64::consts::TAU / f64::from(turns));
            for (u, v) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
                let uv = DVec2::new(f64::from(i + u), f64::from(v));
                primitive.uvs.push(uv.as_vec2().into());
                other.push(turn.transform_point2(uv).as_vec2().into());
            }
            let first = 4 * i;
            primitive.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
        primitive.other_uvs = vec![(3, other)];
        primitive
    }

    #[test]
    fn triangles_of_the_same_function_are_one_chart() {
        let primitive = strip(10, 4);
        let charts = Chart::of(&primitive).unwrap();
        assert_eq!(charts.iter().map(|chart| chart.triangles.len()).collect::<Vec<_>>(), [6, 6, 4, 4]);
        for chart in &charts {
            for &triangle in &chart.triangles {
                let (from, to) =
                    (corners(&primitive.uvs, triangle), corners(&primitive.other_uvs[0].1, triangle));
                for (from, to) in from.into_iter().zip(to) {
                    assert!((chart.maps[&3].transform_point2(from) - to).length() < 1e-5);
                }
            }
        }
        assert!(Chart::of(&strip(300, 300)).is_none());
        assert_eq!(Chart::of(&strip(MOST as u32, MOST as u32)).unwrap().len(), MOST);
    }

    #[test]
    fn triangles_without_an_area_are_in_some_chart() {
        let mut primitive = strip(1, 1);
        primitive.uvs.fill(Point2::new(0.5, 0.5));
        let charts = Chart::of(&primitive).unwrap();
        assert_eq!(charts.iter().map(|chart| chart.triangles.len()).sum::<usize>(), 2);
        assert!(charts.iter().all(|chart| chart.maps[&3].is_finite()));
    }
}
