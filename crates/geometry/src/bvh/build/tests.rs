//! Invariants of all trees, for any input and builder.

use super::{BuildQuality, Built, Extent, Primitives, Reference, build};
use crate::bvh::node::WideNode;
use math::{Bounds3, Vec3};
use sampling::Rng;

const QUALITIES: [BuildQuality; 3] = [BuildQuality::Fast, BuildQuality::Balanced, BuildQuality::High];

fn point(rng: &mut Rng, size: f32) -> Vec3 {
    (Vec3::new(rng.uniform_f32(), rng.uniform_f32(), rng.uniform_f32()) * 2.0 - 1.0) * size
}

/// Triangles of many kinds.
fn inputs() -> Vec<(&'static str, Vec<[Vec3; 3]>)> {
    let rng = &mut Rng::new(11, 0);
    let mut soup = |n: usize, spread: f32, size: &dyn Fn(&mut Rng, usize) -> f32| -> Vec<[Vec3; 3]> {
        (0..n)
            .map(|i| {
                let (center, size) = (point(rng, spread), size(rng, i));
                [0; 3].map(|_| center + point(rng, size))
            })
            .collect()
    };
    let mut inputs = vec![
        ("one", soup(1, 1.0, &|_, _| 0.1)),
        ("a block", soup(4, 1.0, &|_, _| 0.1)),
        ("five", soup(5, 1.0, &|_, _| 0.1)),
        ("random", soup(20_000, 1.0, &|_, _| 0.02)),
        ("large", soup(300, 0.1, &|_, _| 10.0)),
        ("points", soup(3000, 1.0, &|_, _| 0.0)),
        ("of all sizes", soup(5000, 1.0, &|rng, _| 10f32.powf(rng.uniform_f32() * 60.0 - 30.0))),
        ("nested", soup(5000, 0.0, &|_, i| 0.99f32.powi(i as i32))),
        ("beyond floats", soup(500, 2e38, &|_, _| 1e38)),
    ];
    let mut clusters = soup(2000, 1e-6, &|_, _| 1e-8);
    clusters.extend(soup(2000, 1e-6, &|_, _| 1e-8).iter().map(|t| t.map(|p| p + Vec3::splat(1000.0))));
    inputs.push(("two clusters", clusters));
    inputs.push(("duplicates", vec![[Vec3::ZERO, Vec3::X, Vec3::Y]; 10_000]));
    let line = |i: usize| Vec3::X * i as f32;
    inputs.push(("on a line", (0..3000).map(|i| [line(i), line(i + 1), line(i + 2)]).collect()));
    inputs
}

struct Triangles<'a> {
    corners: &'a [[Vec3; 3]],
    width: usize,
    /// The capacity of a block.
    room: usize,
}

type Block = [Option<Reference>; 8];

impl Primitives for Triangles<'_> {
    type Block = Block;
    const COST: f32 = 0.5;

    fn width(&self) -> usize {
        self.width
    }

    fn geometries(&self) -> Vec<(u32, usize)> {
        vec![(3, 0), (7, self.corners.len())]
    }

    fn extent(&self, _: u32, triangle: u32) -> Option<Extent> {
        Extent::around_finite(self.corners[triangle as usize])
    }

    fn corners(&self, _: u32, triangle: u32) -> Option<[Vec3; 3]> {
        Some(self.corners[triangle as usize])
    }

    /// Whole triangles, or parts of them where they are known.
    fn block(&self, triangles: &[Reference]) -> (Block, usize, Extent) {
        let part = |r: &Reference| match r.extent().is_empty() {
            true => {
                Reference::new(self.extent(7, r.primitive()).expect("finite"), r.geometry(), r.primitive())
            }
            false => *r,
        };
        let parts: Vec<_> = triangles.iter().take(self.room).map(part).collect();
        (std::array::from_fn(|i| parts.get(i).copied()), parts.len(), Extent::around(&parts))
    }
}

fn built(corners: &[[Vec3; 3]], quality: BuildQuality, width: usize, room: usize) -> Built<Block> {
    build(&Triangles { corners, width, room }, quality)
}

fn contains(outer: &Bounds3, inner: &Bounds3) -> bool {
    inner.is_empty() || outer.contains(inner.min) && outer.contains(inner.max)
}

/// The number of visits of each node and block, and the boxes of the leaves that hold each
/// triangle.
struct Visits {
    nodes: Vec<u32>,
    blocks: Vec<u32>,
    boxes: Vec<Vec<Bounds3>>,
}

/// Visits a whole tree over a number of triangles.
fn visited(built: &Built<Block>, triangles: usize) -> Visits {
    let mut visits = Visits {
        nodes: vec![0; built.nodes.len()],
        blocks: vec![0; built.blocks.len()],
        boxes: vec![Vec::new(); triangles],
    };
    visit(built, 0, &mut visits, &built.bounds);
    visits
}

/// Visits a subtree, whose boxes lie in that of its parent.
fn visit(built: &Built<Block>, node: usize, visits: &mut Visits, bounds: &Bounds3) {
    visits.nodes[node] += 1;
    let wide: &WideNode = &built.nodes[node];
    for lane in 0..wide.len() {
        let (child, inside) = (wide.children()[lane], wide.bounds_of(lane));
        assert!(contains(bounds, &inside));
        if !child.is_leaf() {
            visit(built, child.index(), visits, &inside);
            continue;
        }
        for block in child.blocks() {
            visits.blocks[block] += 1;
            for r in built.blocks[block].iter().flatten() {
                assert_eq!(r.geometry(), 7);
                visits.boxes[r.primitive() as usize].push(inside);
            }
        }
    }
}

#[test]
fn every_primitive_is_in_the_boxes_above_it() {
    for (name, triangles) in inputs() {
        for quality in QUALITIES {
            for (width, room) in [(1, 1), (4, 4), (4, 2), (8, 8)] {
                let built = built(&triangles, quality, width, room);
                let Visits { nodes, blocks, boxes } = visited(&built, triangles.len());
                assert!(nodes.iter().chain(&blocks).all(|&n| n == 1), "{name} {quality:?} {width}");
                for (boxes, triangle) in boxes.iter().zip(&triangles) {
                    let all = boxes.iter().fold(Bounds3::EMPTY, |all, &part| all.union(part));
                    assert!(contains(&all, &Bounds3::around(*triangle)), "{name} {quality:?} {width}");
                }
                let most = if quality == BuildQuality::High { 2 * triangles.len() } else { triangles.len() };
                let counts: Vec<_> =
                    built.blocks.iter().map(|block| block.iter().flatten().count()).collect();
                assert!(counts.iter().sum::<usize>() <= most, "{name} {quality:?} {width}");
                assert!(counts.iter().all(|count| (1..=room).contains(count)));
            }
        }
    }
}

/// Points of triangles are in the box of some leaf, also where triangles were cut.
#[test]
fn cut_triangles_have_no_gaps() {
    let rng = &mut Rng::new(5, 0);
    let along = Vec3::new(0.7, 1.0, 0.8);
    let strip = |i: usize| {
        let start = Vec3::X * i as f32 * 0.01 + point(rng, 0.01);
        [start, start + point(rng, 0.01), start + along]
    };
    let triangles: Vec<[Vec3; 3]> = (0..500).map(strip).collect();
    let built = built(&triangles, BuildQuality::High, 4, 4);
    let count = built.blocks.iter().flatten().flatten().count();
    assert!(count > 600, "{count} parts of 500 triangles");
    let parts = visited(&built, triangles.len()).boxes;
    for (parts, [a, b, c]) in parts.iter().zip(&triangles) {
        for _ in 0..200 {
            let (u, v) = (rng.uniform_f32(), rng.uniform_f32());
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let p = *a * (1.0 - u - v) + *b * u + *c * v;
            assert!(parts.iter().any(|part| part.expand(2e-7).contains(p)), "{p} {parts:?}");
        }
    }
}

#[test]
fn any_number_of_threads_builds_the_same_tree() {
    let rng = &mut Rng::new(8, 0);
    let triangles: Vec<[Vec3; 3]> = (0..150_000)
        .map(|_| {
            let center = point(rng, 1.0);
            [0; 3].map(|_| center + point(rng, 0.02))
        })
        .collect();
    for quality in QUALITIES {
        let bytes = [1, 2, 7].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let built = pool.install(|| built(&triangles, quality, 4, 3));
            format!("{:?} {:?}", built.nodes, built.blocks)
        });
        assert!(bytes[0] == bytes[1] && bytes[1] == bytes[2], "{quality:?}");
    }
}
