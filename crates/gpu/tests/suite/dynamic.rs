//! Trees that the GPU builds over what moves, beside the CPU's.

use std::collections::BTreeSet;
use std::sync::Arc;

use alhazen_gpu::{Algorithm, Buffer, Bvh, Moving, MovingError, Realtime, Sorter, Update};
use description::WhittedDesc;
use geometry::*;
use math::*;
use scene::MoveError;
use testkit::Random;

use crate::frames::kernels;
use crate::pictures::Case;
use crate::texts::{FOLLOWING, MOVING};
use crate::trace::{Traced, Tracer, buffers, mesh, random_rays, soup, traced, tracer};

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

/// A world on the device, with trees that the device builds.
struct Animated<'a> {
    tracer: &'a Tracer,
    moving: Moving,
    buffers: [Buffer; 4],
    /// What is in the trees of triangles and of items.
    primitives: [BTreeSet<u32>; 2],
}

impl<'a> Animated<'a> {
    fn new(tracer: &'a Tracer, world: &World) -> Self {
        let kernels = &tracer.0;
        let mut bvh = Bvh::new(world, &|_| false).expect("shapes");
        let nodes: Vec<[u32; 24]> = bytemuck::cast_slice(&bvh.nodes).to_vec();
        let primitives = bvh.top.roots.map(|root| {
            let mut all = BTreeSet::new();
            follow(&nodes, root, "on the CPU", |primitive, _| assert!(all.insert(primitive)));
            all
        });
        let moving = Moving::new(kernels, world, &mut bvh).expect("what moves");
        let buffers = buffers(kernels.device(), &bvh).expect("buffers");
        let mut animated = Self { tracer, moving, buffers, primitives };
        animated.update();
        animated
    }

    fn update(&mut self) {
        let device = self.tracer.0.device();
        let [top, nodes, triangles, items] = &self.buffers;
        device.write(top, &[self.moving.top()]).expect("a write");
        let mut start = |kernel: &_, buffers: &[&Buffer], groups| {
            device.run(kernel, buffers, [groups, 1, 1]).expect("a run");
        };
        self.moving.run(device, [items, triangles, nodes], &mut start).expect("trees");
        self.moving.settle();
    }

    fn place(&mut self, moved: &Moved, update: Update) {
        let device = self.tracer.0.device();
        let points = moved.points.iter().map(|(id, points)| (*id, &**points));
        self.moving.place(device, points, update).expect("points");
        self.moving.place_instances(device, &moved.instances, update).expect("transforms");
        self.update();
    }

    fn trace(&self, rays: &[(Ray, f32)]) -> Vec<Traced> {
        let [a, b, c, d] = &self.buffers;
        traced(self.tracer, [a, b, c, d], rays).expect("hits")
    }

    /// Follows all nodes: boxes are around what is below, and each triangle and item is there once.
    fn check(&self, what: &str) {
        let device = self.tracer.0.device();
        let [_, nodes, triangles, items] = &self.buffers;
        let nodes: Vec<[u32; 24]> = device.read(nodes).expect("nodes");
        let triangles: Vec<[u32; 12]> = device.read(triangles).expect("triangles");
        let items: Vec<[u32; 20]> = device.read(items).expect("items");
        let floats = |words: &[u32]| Vec3::from([0, 1, 2].map(|i| f32::from_bits(words[i])));
        for (i, root) in self.moving.top().roots.into_iter().enumerate() {
            let mut seen = BTreeSet::new();
            follow(&nodes, root, what, |primitive, bounds| {
                assert!(seen.insert(primitive), "{what}: {primitive} is there twice");
                if i == 0 {
                    let corners = triangles[primitive as usize];
                    let within = corners.chunks(4).map(floats).all(|corner| is_in(corner, corner, bounds));
                    assert!(within, "{what}: {corners:?} not in {bounds:?}");
                } else if items[primitive as usize][16] == BALL {
                    let words = items[primitive as usize];
                    let (center, radius) = (floats(&words), Vec3::splat(f32::from_bits(words[3])));
                    let (low, high) = (center - radius, center + radius);
                    assert!(is_in(low, high, bounds), "{what}: {low:?} {high:?} not in {bounds:?}");
                }
            });
            assert_eq!(seen, self.primitives[i], "{what}");
        }
    }
}

/// The kind of the items of whole spheres.
const BALL: u32 = 6;

/// What moves somewhere.
#[derive(Default)]
struct Moved {
    points: Vec<(GeometryId, Vec<Point3>)>,
    instances: Vec<(InstanceId, Transform)>,
}

/// Follows all nodes below a reference, to each primitive with the box of its leaf.
fn follow(nodes: &[[u32; 24]], root: u32, what: &str, mut leaf: impl FnMut(u32, &Bounds3)) {
    let all = Bounds3 { min: Vec3::splat(-f32::MAX), max: Vec3::splat(f32::MAX) };
    let mut waiting = vec![(root, all)];
    while let Some((reference, bounds)) = waiting.pop() {
        if reference & 0x8000_0000 == 0 {
            waiting.extend(children(&nodes[reference as usize], &bounds, what));
            continue;
        }
        let (first, count) = ((reference & 0x3fff_ffff) >> 5, reference & 31);
        (first..first + count).for_each(|primitive| leaf(primitive, &bounds));
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
    let bvh = Bvh::new(world, &|_| false).expect("shapes");
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

/// A world, and groups that are placed in it.
struct Medley {
    world: World,
    mesh: GeometryId,
    sets: [GeometryId; 2],
    /// A disk, and a mesh within instances.
    others: [GeometryId; 2],
    /// In the top group, and one that is placed in others.
    instances: Vec<InstanceId>,
    inner: InstanceId,
}

/// Triangles, sets of small and of large spheres, a disk, and instances of such, one of which has
/// others in it.
fn medley() -> Medley {
    let mut builder = World::builder();
    let mesh = builder.add_geometry(GroupId::TOP, soup(50));
    let small = spheres(scattered(3000, 4.0, 2), |i| [0.01, 0.03, 0.1][i % 3]);
    let disk = Disk::new(&Transform::translate(Vec3::new(0.0, 0.0, -1.0)), false, 0.1, 1.0, 0.3, 250.0);
    let small = builder.add_geometry(GroupId::TOP, small);
    let disk = builder.add_geometry(GroupId::TOP, Shape::from(disk));
    let large = builder.add_geometry(GroupId::TOP, spheres(scattered(20, 3.0, 3), |_| 0.3));
    let [group, outer] = [builder.add_group(), builder.add_group()];
    let placed = builder.add_geometry(group, soup(40));
    builder.add_geometry(group, spheres(scattered(10, 3.0, 4), |_| 0.2));
    builder.add_geometry(outer, soup(10));
    let mut place = |at, group, by: f32| {
        let render_from_instance = Transform::translate(Vec3::new(by, 0.5, -by)).into();
        builder.add_instance(at, Instance { group, render_from_instance })
    };
    let inner = place(outer, group, 1.0);
    let top = GroupId::TOP;
    let instances = vec![place(top, group, 0.0), place(top, outer, -1.0), place(top, group, 2.0)];
    let (sets, others) = ([small, large], [disk, placed]);
    Medley { world: builder.build(), mesh, sets, others, instances, inner }
}

/// The same geometry with all its points elsewhere.
fn moved(geometry: &Geometry, points: &[Point3]) -> Geometry {
    match geometry {
        Geometry::Spheres(set) => set.moved(points.into()).expect("as many centres").into(),
        Geometry::Mesh(mesh) => mesh.moved(points.into(), None).expect("as many vertices").into(),
        Geometry::Shapes(_) | Geometry::Curves(_) => panic!("no points"),
    }
}

/// All points of a geometry.
fn points(geometry: &Geometry) -> Vec<Point3> {
    match geometry {
        Geometry::Spheres(set) => (0..set.len()).map(|sphere| set.center(sphere)).collect(),
        Geometry::Mesh(mesh) => mesh.positions().to_vec(),
        Geometry::Shapes(_) | Geometry::Curves(_) => panic!("no points"),
    }
}

/// Points with others added.
fn added(points: Vec<Point3>, others: Vec<Point3>) -> Vec<Point3> {
    points.into_iter().zip(others).map(|(point, other)| point + other).collect()
}

/// A turn and a stretch to somewhere.
fn turned(seed: u64, size: f32) -> Transform {
    let points = scattered(2, 1.0, seed);
    let turn = Transform::rotate(7.0 * points[0].x, points[0] + Vec3::X);
    let stretch = Transform::scale(Vec3::new(1.0 + points[0].x, 0.7, -1.2));
    Transform::translate(points[1] * size).after(&turn.after(&stretch))
}

#[test]
fn rays_hit_what_they_hit_on_the_cpu_wherever_things_move() {
    let Some(tracer) = tracer() else { return };
    let Medley { mut world, mesh, sets, instances, .. } = medley();
    let mut animated = Animated::new(tracer, &world);
    let rays = random_rays(1500, 6.0);
    animated.check("at first");
    agree(&animated, &world, &rays, "at first");
    // All at once, and each alone: spheres, vertices, instances.
    let moves = [
        (Update::Refit, 4.5, [true, false, false]),
        (Update::Refit, 1.0, [false, true, false]),
        (Update::Rebuild, 9.0, [true, true, true]),
        (Update::Refit, 4.0, [false, false, true]),
        (Update::Refit, 3.0, [true, true, true]),
        (Update::Rebuild, 2.0, [false, true, true]),
    ];
    for (seed, (update, size, [spheres, vertices, placements])) in (4..).zip(moves) {
        let what = format!("{update:?} in {size}");
        let mut now = Moved::default();
        if spheres {
            now.points.extend(sets.map(|id| (id, scattered(world.geometry(id).len(), size, seed))));
        }
        if vertices {
            let by = scattered(3 * world.geometry(mesh).len(), 0.1 * size, seed);
            now.points.push((mesh, added(points(world.geometry(mesh)), by)));
        }
        if placements {
            // One of them stays.
            now.instances.extend(instances[1..].iter().map(|&id| (id, turned(seed + u64::from(id.0), size))));
        }
        animated.place(&now, update);
        let geometries = now.points.iter().map(|(id, points)| (*id, moved(world.geometry(*id), points)));
        let geometries: Vec<_> = geometries.collect();
        world.refit(geometries).expect("the same primitives");
        world.place_instances(now.instances).expect("the same instances");
        animated.check(&what);
        agree(&animated, &world, &rays, &what);
        // Past vertices and through them, where rays graze edges.
        let vertices = points(world.geometry(mesh));
        let ray = |(i, (o, by)): (usize, (Vec3, Vec3))| (Ray::new(o, vertices[i % 150] + by - o, 0.0), 2.0);
        let near = scattered(600, 6.0, seed).into_iter().zip(scattered(600, 2e-3, seed + 1));
        agree(&animated, &world, &near.enumerate().map(ray).collect::<Vec<_>>(), &what);
    }
}

/// The centre of each sphere.
type Centers<'a> = &'a dyn Fn(usize) -> Vec3;

#[test]
fn any_primitives_have_a_tree() {
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
        let rays: Vec<_> = rays.enumerate().map(ray).collect();
        agree(&animated, &world, &rays, what);
        // As many triangles instead.
        let corners = |i: usize| [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| center(i) + axis * radius);
        let positions: Vec<Point3> = (0..count).flat_map(corners).collect();
        let triangles =
            mesh(positions.clone(), (0..count as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect());
        let mut builder = World::builder();
        let id = builder.add_geometry(GroupId::TOP, triangles);
        let world = builder.build();
        let mut animated = Animated::new(tracer, &world);
        animated.place(&Moved { points: vec![(id, positions)], ..Moved::default() }, Update::Refit);
        animated.check(what);
        agree(&animated, &world, &rays, what);
    }
    let nothing = World::builder().build();
    agree(&Animated::new(tracer, &nothing), &nothing, &random_rays(10, 3.0), "nothing");
}

#[test]
fn what_does_not_move_is_refused() {
    let Some(tracer) = tracer() else { return };
    let Medley { world, mesh, sets: [_, set], others: [disk, placed], instances, inner } = medley();
    let mut animated = Animated::new(tracer, &world);
    let device = tracer.0.device();
    let mut place =
        |id, points: &[Point3]| animated.moving.place(device, [(id, points)], Update::Rebuild).err();
    let refused = |error| Some(MovingError::Move(error));
    assert_eq!(place(disk, &[Vec3::ZERO]), refused(MoveError::NoPoints(disk)), "a disk");
    assert_eq!(place(placed, &[]), refused(MoveError::NoPoints(placed)), "a mesh in instances");
    let nothing = GeometryId(99);
    assert_eq!(place(nothing, &[]), refused(MoveError::NoPoints(nothing)), "nothing");
    for (id, count) in [(set, 20), (mesh, 150)] {
        let misfit = refused(MoveError::Points(id));
        assert_eq!(place(id, &[Vec3::ZERO]), misfit, "too few");
        assert_eq!(place(id, &vec![Vec3::NAN; count]), misfit, "no numbers");
        assert_eq!(place(id, &vec![Vec3::splat(3e38); count]), misfit, "too far away");
    }
    let mut place = |id, transform| {
        let moved = [(instances[0], Transform::IDENTITY), (id, transform)];
        animated.moving.place_instances(device, &moved, Update::Rebuild).err()
    };
    assert_eq!(place(inner, Transform::IDENTITY), refused(MoveError::Instance(inner)), "in another one");
    let nothing = InstanceId(99);
    assert_eq!(place(nothing, Transform::IDENTITY), refused(MoveError::Instance(nothing)), "nothing");
    let id = instances[1];
    let flat = Transform::from_parts(Mat4::from_scale(Vec3::new(1.0, 0.0, 1.0).into()), Mat4::IDENTITY);
    let far = Transform::translate(Vec3::splat(3e38));
    for (transform, what) in [(flat, "without inverse"), (far, "too far away")] {
        assert_eq!(place(id, transform), refused(MoveError::Transform(id)), "{what}");
    }
    animated.update();
    agree(&animated, &world, &random_rays(300, 6.0), "unmoved");
}

/// Scenes do not move what shines, or what would have other normals.
#[test]
fn scenes_refuse_what_does_not_follow() {
    let mut scene = Case::of_text(FOLLOWING).scene;
    let scene = Arc::make_mut(&mut scene);
    let [smooth, shining] = [0, 1].map(GeometryId);
    let [dark, lamp, moving] = [0, 1, 2].map(InstanceId);
    let points: Arc<[Point3]> = [Vec3::ZERO; 3].into();
    let mut place = |id| scene.move_points([(id, points.clone())]).err();
    assert_eq!(place(smooth), Some(MoveError::Normals(smooth)));
    assert_eq!(place(shining), Some(MoveError::Lights(shining)));
    let mut place = |id| scene.move_instances([(id, Transform::IDENTITY)]).err();
    assert_eq!(place(dark), None);
    assert_eq!(place(lamp), Some(MoveError::LightsWithin(lamp)));
    assert_eq!(place(moving), Some(MoveError::Instance(moving)));
}

/// Pictures of what moves are those of the CPU's scene, moved.
#[test]
fn pictures_of_moving_things_are_those_of_the_cpu() {
    let Some(kernels) = kernels() else { return };
    let mut case = Case::of_text(MOVING);
    let algorithm = Algorithm::Whitted(WhittedDesc { max_depth: 2, ambient: true, ..WhittedDesc::default() });
    let flat = case.flatten(&algorithm).unwrap_or_else(|refusals| panic!("{refusals:?}"));
    let mut realtime = Realtime::animated(kernels, flat, case.scene.world(), &algorithm).expect("a scene");
    let all = case.scene.world().placed_geometries();
    let geometries: Vec<GeometryId> =
        all.iter().filter(|(_, path)| path.is_top()).map(|(id, _)| *id).collect();
    let instances: BTreeSet<InstanceId> =
        all.iter().filter_map(|(_, path)| path.ids().first().copied()).collect();
    assert_eq!((geometries.len(), instances.len()), (5, 2));
    for (frame, update) in [None, Some(Update::Rebuild), Some(Update::Refit)].into_iter().enumerate() {
        if let Some(update) = update {
            let world = case.scene.world();
            let moved = |&id: &GeometryId| {
                let points = points(world.geometry(id));
                let by = scattered(points.len(), 0.4, frame as u64);
                (id, added(points, by))
            };
            let moved: Vec<_> = geometries.iter().map(moved).collect();
            let borrowed = moved.iter().map(|(id, points)| (*id, &**points));
            realtime.move_points(borrowed, update).expect("points");
            let placed = |&id: &InstanceId| {
                let before = world.render_from_instance(id).start();
                (id, before.after(&turned(frame as u64 + u64::from(id.0), 0.4)))
            };
            let placed: Vec<_> = instances.iter().map(placed).collect();
            realtime.move_instances(&placed, update).expect("transforms");
            let shared = moved.into_iter().map(|(id, points)| (id, points.into()));
            let scene = Arc::make_mut(&mut case.scene);
            scene.move_points(shared).expect("points");
            scene.move_instances(placed).expect("transforms");
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
