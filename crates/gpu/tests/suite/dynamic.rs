//! Trees over moving spheres that the GPU builds, beside the CPU's.

use std::sync::Arc;

use alhazen_gpu::{Algorithm, Buffer, Bvh, Moving, MovingError, Realtime, Sorter, Top, Update};
use description::WhittedDesc;
use geometry::*;
use math::*;
use scene::MoveError;
use testkit::Random;

use crate::pictures::Case;
use crate::realtime::kernels;
use crate::texts::MOVING;
use crate::trace::{Traced, Tracer, buffers, random_rays, soup, traced, tracer};

/// The values of keys after the sort, where values are places.
fn sorted(keys: &[u32]) -> Option<Vec<u32>> {
    let (kernels, _) = tracer()?;
    let device = kernels.device();
    let sorter = Sorter::new(kernels, keys.len() as u32).expect("a sorter");
    let places: Vec<u32> = (0..keys.len() as u32).collect();
    sorter.load(device, keys, &places).expect("keys");
    sorter.run(&mut |kernel, buffers, groups| device.run(kernel, buffers, [groups, 1, 1]).expect("a run"));
    let mut sorted: Vec<u32> = device.read(sorter.keys()).expect("keys");
    let mut values: Vec<u32> = device.read(sorter.values()).expect("values");
    // Buffers are not empty.
    sorted.truncate(keys.len());
    values.truncate(keys.len());
    let of_values: Vec<u32> = values.iter().map(|&value| keys[value as usize]).collect();
    assert_eq!(sorted, of_values, "keys stay with their values");
    Some(values)
}

#[test]
fn keys_are_sorted_as_by_the_cpu() {
    let mut random = Random::new(1);
    for count in [0, 1, 2, 255, 256, 257, 2047, 2048, 2049, 100_003] {
        // Any keys, many that are equal, and all equal.
        for mask in [u32::MAX, 0x0003_0001, 0] {
            let key = |_| ((f64::from(random.get_1d()) * 4294967296.0) as u32 ^ 0x5a5a_5a5a) & mask;
            let keys: Vec<u32> = (0..count).map(key).collect();
            let Some(places) = sorted(&keys) else { return };
            let mut expected: Vec<u32> = (0..count).collect();
            expected.sort_by_key(|&place| keys[place as usize]);
            assert_eq!(places, expected, "{count} keys, mask {mask:x}");
        }
    }
}

/// A world on the device, with a tree that the device builds.
struct Animated<'a> {
    tracer: &'a Tracer,
    moving: Moving,
    top: Top,
    buffers: [Buffer; 4],
    /// The number of items.
    items: usize,
}

impl<'a> Animated<'a> {
    fn new(tracer: &'a Tracer, world: &World) -> Self {
        let kernels = &tracer.0;
        let mut bvh = Bvh::new(world, &|_| false).expect("spheres");
        let moving = Moving::new(kernels, world, &mut bvh).expect("spheres that move");
        let buffers = buffers(kernels.device(), &bvh).expect("buffers");
        let items = bvh.items.len() / 5;
        let animated = Self { tracer, moving, top: bvh.top, buffers, items };
        animated.update(Update::Rebuild);
        animated
    }

    fn update(&self, update: Update) {
        let device = self.tracer.0.device();
        let [_, nodes, _, items] = &self.buffers;
        let mut start = |kernel: &_, buffers: &[&Buffer], groups| {
            device.run(kernel, buffers, [groups, 1, 1]).expect("a run");
        };
        self.moving.run(device, update, [items, nodes], &mut start).expect("a tree");
    }

    fn place(&mut self, moved: &[(GeometryId, Vec<Point3>)], update: Update) {
        let device = self.tracer.0.device();
        let moved = moved.iter().map(|(id, centers)| (*id, &**centers));
        self.top.size = self.top.size.max(self.moving.place(device, moved).expect("centres"));
        device.write(&self.buffers[0], &[self.top]).expect("a write");
        self.update(update);
    }

    fn trace(&self, rays: &[(Ray, f32)]) -> Vec<Traced> {
        let [a, b, c, d] = &self.buffers;
        traced(self.tracer, [a, b, c, d], rays).expect("hits")
    }

    /// Follows all nodes: boxes are around what is below, and each item is there once.
    fn check(&self, what: &str) {
        let device = self.tracer.0.device();
        let [_, nodes, _, items] = &self.buffers;
        let nodes: Vec<[u32; 24]> = device.read(nodes).expect("nodes");
        let items: Vec<[u32; 20]> = device.read(items).expect("items");
        let mut seen = vec![0; self.items];
        let all = Bounds3 { min: Vec3::splat(-f32::MAX), max: Vec3::splat(f32::MAX) };
        let mut waiting = vec![(self.top.roots[1], all)];
        while let Some((reference, bounds)) = waiting.pop() {
            if reference & 0x8000_0000 == 0 {
                waiting.extend(children(&nodes[reference as usize], &bounds, what));
                continue;
            }
            let (first, count) = ((reference & 0x3fff_ffff) >> 5, reference & 31);
            for item in first..first + count {
                seen[item as usize] += 1;
                let words = items[item as usize];
                // Of spheres that are not scaled, the centre is the origin.
                if words[16] == 2 {
                    let [x, y, z, radius] = [3, 7, 11, 12].map(|i| f32::from_bits(words[i]));
                    let (center, radius) = (Vec3::new(x, y, z), Vec3::splat(radius));
                    let (low, high) = (center - radius, center + radius);
                    assert!(is_in(low, high, &bounds), "{what}: {low:?} {high:?} not in {bounds:?}");
                }
            }
        }
        assert!(seen.iter().all(|&times| times == 1), "{what}: {seen:?}");
    }
}

fn is_in(low: Vec3, high: Vec3, bounds: &Bounds3) -> bool {
    (0..3).all(|axis| bounds.min[axis] <= low[axis] && high[axis] <= bounds.max[axis])
}

/// The children of a node with their boxes, given the box that its parent has for it.
fn children(words: &[u32; 24], bounds: &Bounds3, what: &str) -> Vec<(u32, Bounds3)> {
    let origin = [0, 1, 2].map(|axis| f32::from_bits(words[axis]));
    let steps = [0, 1, 2].map(|axis| f32::from_bits((words[3] >> (8 * axis) & 255) << 23));
    let plane = |first: usize, child: usize, axis: usize| {
        let byte = words[first + 2 * axis + child / 4] >> (8 * (child % 4)) & 255;
        origin[axis] + byte as f32 * steps[axis]
    };
    let present = (0..8).take_while(|child| words[16 + child] != 0x8000_0000);
    let boxes = present.map(|child| {
        let corner = |first| [0, 1, 2].map(|axis| plane(first, child, axis)).into();
        (words[16 + child], Bounds3 { min: corner(4), max: corner(10) })
    });
    let boxes: Vec<(u32, Bounds3)> = boxes.collect();
    assert!(boxes.len() >= 2, "{what}: a node of {} children", boxes.len());
    for (_, inside) in &boxes {
        assert!(inside.min.is_finite() && inside.max.is_finite(), "{what}: {inside:?}");
    }
    // What is exact is in the node's own box, of which the lowest planes are.
    assert!(is_in(origin.into(), origin.into(), bounds), "{what}: {origin:?} not in {bounds:?}");
    boxes
}

fn spheres(centers: Vec<Point3>, radius: impl Fn(usize) -> f32) -> SphereSet {
    let radii: Vec<f32> = (0..centers.len()).map(radius).collect();
    SphereSet::new(centers.into(), radii.into(), &Transform::IDENTITY, false).expect("spheres")
}

fn scattered(count: usize, size: f32, seed: u64) -> Vec<Point3> {
    let mut random = Random::new(seed);
    let mut point = || {
        let [x, y] = random.get_2d();
        (Vec3::new(x, y, random.get_1d()) - Vec3::splat(0.5)) * size
    };
    (0..count).map(|_| point()).collect()
}

/// Rays through the tree of the device hit what those through the CPU's tree do: on the device the
/// same bits, as the same kernel meets the same spheres, and on the CPU the same up to rounding,
/// which decides where a ray grazes. Of spheres at one place any may be hit.
fn agree(animated: &Animated, world: &World, rays: &[(Ray, f32)], what: &str) {
    let bvh = Bvh::new(world, &|_| false).expect("spheres");
    let [a, b, c, d] = &buffers(animated.tracer.0.device(), &bvh).expect("buffers");
    let expected = traced(animated.tracer, [a, b, c, d], rays).expect("hits");
    let (mut hits, mut grazing) = (0, 0);
    for (((ray, end), (hit, any)), (expected, _)) in rays.iter().zip(animated.trace(rays)).zip(expected) {
        assert_eq!(any, hit.is_some(), "{what}: {ray:?}");
        assert_eq!(hit.map(|hit| hit.t), expected.map(|hit| hit.t), "{what}: {ray:?}");
        let exact = world.intersect(ray, *end, &|_: &Hit, _: &Ray| true, &mut RayStats::default());
        hits += exact.is_some() as usize;
        let is_same = match (hit, exact) {
            (None, None) => true,
            (Some(a), Some(b)) => (a.t - b.t).abs() < 1e-4 * b.t.max(1.0),
            _ => false,
        };
        grazing += !is_same as usize;
    }
    println!("{what}: {hits} of {} rays hit, {grazing} graze", rays.len());
    assert!(grazing <= 2 + rays.len() / 2000, "{what}: {grazing} rays differ");
}

/// Sets of small and of large spheres, among triangles and a disk.
fn medley() -> World {
    let mut builder = World::builder();
    builder.add_geometry(GroupId::TOP, soup(50));
    builder.add_geometry(GroupId::TOP, spheres(scattered(3000, 4.0, 2), |i| [0.01, 0.03, 0.1][i % 3]));
    let disk = Disk::new(&Transform::translate(Vec3::new(0.0, 0.0, -1.0)), false, 0.1, 1.0, 0.3, 250.0);
    builder.add_geometry(GroupId::TOP, Shape::from(disk));
    builder.add_geometry(GroupId::TOP, spheres(scattered(20, 3.0, 3), |_| 0.3));
    builder.build()
}

#[test]
fn rays_hit_what_they_hit_on_the_cpu_wherever_spheres_move() {
    let Some(tracer) = tracer() else { return };
    let mut world = medley();
    let mut animated = Animated::new(tracer, &world);
    let rays = random_rays(1500, 6.0);
    animated.check("at first");
    agree(&animated, &world, &rays, "at first");
    let moves = [(Update::Refit, 4.5, 4), (Update::Rebuild, 9.0, 5), (Update::Refit, 3.0, 6)];
    for (update, size, seed) in moves {
        let what = format!("{update:?} in {size}");
        let moved: Vec<_> = [(GeometryId(1), 3000), (GeometryId(3), 20)]
            .map(|(id, count)| (id, scattered(count, size, seed)))
            .into_iter()
            .collect();
        animated.place(&moved, update);
        let sets = moved.iter().map(|(id, centers)| {
            let Geometry::Spheres(set) = world.geometry(*id) else { panic!("no spheres") };
            (*id, Geometry::from(set.moved(centers.as_slice().into()).expect("as many centres")))
        });
        let sets: Vec<_> = sets.collect();
        world.refit(sets).expect("the same spheres");
        animated.check(&what);
        agree(&animated, &world, &rays, &what);
    }
}

/// The centre of each sphere.
type Centers<'a> = &'a dyn Fn(usize) -> Vec3;

#[test]
fn any_spheres_have_a_tree() {
    let Some(tracer) = tracer() else { return };
    let line = |i: usize| Vec3::new(i as f32 / 500.0 - 1.0, 0.25, 0.0);
    // Each half as far from the origin as the one before: codes differ in one bit after another.
    let halved = |i: usize| Vec3::splat(1.0 / (1u64 << (i / 20).min(40)) as f32);
    let far = |i: usize| Vec3::splat(if i == 0 { 1e30 } else { i as f32 / 1000.0 });
    let worlds: [(&str, usize, Centers, f32); 7] = [
        ("one sphere", 1, &line, 0.5),
        ("two spheres", 2, &line, 0.5),
        ("nine spheres", 9, &line, 0.5),
        ("all at one point", 1000, &|_| Vec3::splat(0.1), 0.3),
        ("all on a line", 1000, &line, 0.01),
        ("nearer and nearer", 800, &halved, 0.01),
        ("one far away", 300, &far, 0.1),
    ];
    for (what, count, center, radius) in worlds {
        let mut builder = World::builder();
        builder.add_geometry(GroupId::TOP, spheres((0..count).map(center).collect(), |_| radius));
        let world = builder.build();
        let animated = Animated::new(tracer, &world);
        animated.check(what);
        // From around the origin, to spheres and closely past them.
        let rays = scattered(300, 3.0, 7).into_iter().zip(scattered(300, 2.4 * radius, 8));
        let ray = |(i, (o, by)): (usize, (Vec3, Vec3))| (Ray::new(o, center(i % count) + by - o, 0.0), 2.0);
        agree(&animated, &world, &rays.enumerate().map(ray).collect::<Vec<_>>(), what);
    }
    let nothing = World::builder().build();
    agree(&Animated::new(tracer, &nothing), &nothing, &random_rays(10, 3.0), "nothing");
}

#[test]
fn what_does_not_move_is_refused() {
    let Some(tracer) = tracer() else { return };
    let world = medley();
    let animated = Animated::new(tracer, &world);
    let place = |id: u32, centers: &[Point3]| {
        animated.moving.place(tracer.0.device(), [(GeometryId(id), centers)]).err()
    };
    let refused = |error: fn(GeometryId) -> MoveError, id| Some(MovingError::Move(error(GeometryId(id))));
    assert_eq!(place(0, &[]), refused(MoveError::NoSpheres, 0), "a mesh");
    assert_eq!(place(2, &[Vec3::ZERO]), refused(MoveError::NoSpheres, 2), "a disk");
    assert_eq!(place(9, &[]), refused(MoveError::NoSpheres, 9), "nothing");
    assert_eq!(place(3, &[Vec3::ZERO]), refused(MoveError::Centers, 3), "too few");
    assert_eq!(place(3, &[Vec3::NAN; 20]), refused(MoveError::Centers, 3), "no numbers");
    assert_eq!(place(3, &[Vec3::splat(3e38); 20]), refused(MoveError::Centers, 3), "too far away");
    let mut builder = World::builder();
    let group = builder.add_group();
    builder.add_geometry(group, soup(3));
    builder.add_instance(GroupId::TOP, Instance { group, render_from_instance: Transform::IDENTITY.into() });
    let world = builder.build();
    let mut bvh = Bvh::new(&world, &|_| false).expect("an instance");
    let made = Moving::new(&tracer.0, &world, &mut bvh).err();
    assert_eq!(made, Some(MovingError::Refused("instances")));
}

/// Pictures of spheres that move are those of the CPU's scene, moved.
#[test]
fn pictures_of_moving_spheres_are_those_of_the_cpu() {
    let Some(kernels) = kernels() else { return };
    let mut case = Case::of_text(MOVING);
    let algorithm = Algorithm::Whitted(WhittedDesc { max_depth: 2, ambient: true, ..WhittedDesc::default() });
    let flat = case.flatten(&algorithm).unwrap_or_else(|refusals| panic!("{refusals:?}"));
    let mut realtime = Realtime::animated(kernels, flat, case.scene.world(), &algorithm).expect("a scene");
    let sets: Vec<GeometryId> = case.scene.sphere_sets().map(|(id, _)| id).collect();
    for (frame, update) in [None, Some(Update::Rebuild), Some(Update::Refit)].into_iter().enumerate() {
        if let Some(update) = update {
            let moved = |id: &GeometryId| {
                let Geometry::Spheres(set) = case.scene.world().geometry(*id) else { panic!("no spheres") };
                let by = scattered(set.len(), 0.4, frame as u64);
                let moved = (0..set.len()).zip(by).map(|(i, by)| set.center(i) + by);
                (*id, moved.collect::<Vec<_>>())
            };
            let moved: Vec<_> = sets.iter().map(moved).collect();
            let borrowed = moved.iter().map(|(id, centers)| (*id, &**centers));
            realtime.move_spheres(borrowed, update).expect("centres");
            let shared = moved.into_iter().map(|(id, centers)| (id, centers.into()));
            Arc::make_mut(&mut case.scene).move_spheres(shared).expect("centres");
        }
        realtime.aim(&case.view, case.film().pixel_bounds()).expect("a camera");
        let shown = realtime.resting(1, true).expect("a frame").expect("a picture");
        let cpu: Vec<f32> = case.on_cpu(&algorithm, 1).values().collect();
        let mean = cpu.iter().sum::<f32>() / cpu.len() as f32;
        let pairs = shown.pixels.as_flattened().iter().zip(&cpu);
        let apart = |(a, b): &(&f32, &f32)| (*a - *b).abs() > 1e-3 * b.abs().max(mean / 10.0);
        let other = pairs.filter(apart).count() as f32 / cpu.len() as f32;
        println!("frame {frame}: mean {mean:.3}, {other:.4} apart, {:?}", shown.stages);
        assert!(mean > 0.0 && other < 0.005, "frame {frame}: {other} apart");
    }
}
