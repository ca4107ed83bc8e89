//! Rays through the trees on a GPU, beside the CPU's.

use std::f32::consts::{PI, TAU};
use std::sync::OnceLock;

use alhazen_gpu::{Binding, Buffer, Bvh, BvhError, Device, GpuError, Kernel, Kernels, Trees, shaders};
use geometry::*;
use math::*;
use sampling::warp::sample_uniform_sphere;
use testkit::Random;

/// A kernel that traces rays, of eight numbers each, to hits of eight words. The declarations are
/// those that `trace.wgsl` needs.
pub const KERNEL: &str = "
    fn accepts(hit: Hit, o: vec3f, d: vec3f) -> bool { return true; }
    fn accepts_all() -> bool { return true; }
    const HAS_CURVES = true;
    fn ribbon_normal(geometry: u32, primitive: u32, u: f32) -> vec3f { return vec3f(); }
    const HAS_MOTION = false;
    fn moved_rows(first_key: u32, motions: u32) -> array<vec4f, 3> { return array<vec4f, 3>(); }
    struct World { top: Top }
    @group(0) @binding(0) var<storage, read_write> world: World;
    @group(0) @binding(2) var<storage, read_write> triangles: array<vec4u>;
    @group(0) @binding(3) var<storage, read_write> items: array<vec4u>;
    @group(0) @binding(4) var<storage, read_write> rays: array<array<vec4f, 2>>;
    @group(0) @binding(5) var<storage, read_write> hits: array<array<u32, 8>>;
    @compute @workgroup_size(64)
    fn main(@builtin(global_invocation_id) id: vec3u) {
        if (id.x >= arrayLength(&rays)) { return; }
        let ray = rays[id.x];
        let hit = trace(ray[0].xyz, ray[1].xyz, ray[0].w, false);
        let any = trace(ray[0].xyz, ray[1].xyz, ray[0].w, true);
        hits[id.x] = array(bitcast<u32>(hit.t), bitcast<u32>(hit.uv.x), bitcast<u32>(hit.uv.y),
            hit.geometry, hit.primitive, instance_id(hit), u32(hit.found), u32(any.found));
    }";

/// What rays are traced through.
const NODES: &str = "@group(0) @binding(1) var<storage, read_write> nodes: array<vec4u>;";
const STRUCTURE: &str = "@group(0) @binding(1) var structure: acceleration_structure;";

/// That kernel, which traces rays by a kernel's traversal, or by ray queries.
pub fn sources() -> [String; 2] {
    [
        [&*shaders::tags(), shaders::TRACE, NODES, KERNEL].concat(),
        [shaders::ENABLE_RAY_QUERIES, &*shaders::tags(), shaders::RAY_QUERY, STRUCTURE, KERNEL].concat(),
    ]
}

/// A hit, or none, and whether there is any.
pub type Traced = (Option<Hit>, bool);

/// A device with its kernels, and the kernel above, which is compiled once.
pub type Tracer = (Kernels, Kernel);

fn compiled(device: Device, source: &str) -> Tracer {
    let kernel = device.kernel("trace", source).unwrap_or_else(|error| panic!("{error}"));
    (Kernels::new(device), kernel)
}

pub fn tracer() -> Option<&'static Tracer> {
    static TRACER: OnceLock<Option<Tracer>> = OnceLock::new();
    let make = || Some(compiled(crate::device()?, &sources()[0]));
    TRACER.get_or_init(make).as_ref()
}

/// The same, and one with ray queries.
fn tracers() -> impl Iterator<Item = &'static Tracer> {
    static QUERIES: OnceLock<Option<Tracer>> = OnceLock::new();
    let make = || Some(compiled(crate::device_with_ray_queries()?, &sources()[1]));
    tracer().into_iter().chain(QUERIES.get_or_init(make))
}

/// The buffers of a world: where rays begin, nodes, triangles and items.
pub fn buffers(device: &Device, bvh: &Bvh) -> Result<[Buffer; 4], GpuError> {
    Ok([
        device.buffer("world", &[bvh.top])?,
        device.buffer("nodes", &bvh.nodes)?,
        device.buffer("triangles", &bvh.triangles)?,
        device.buffer("items", &bvh.items)?,
    ])
}

fn on_gpu(tracer: &Tracer, world: &World, rays: &[(Ray, f32)]) -> Result<Vec<Traced>, GpuError> {
    let device = tracer.0.device();
    if !device.has_ray_queries() {
        let bvh = Bvh::new(world, &|_| false).expect("a world of triangles");
        let [a, b, c, d] = &buffers(device, &bvh)?;
        return traced(tracer, [a, b, c, d], rays);
    }
    let bvh = Bvh::for_ray_queries(world, &|_| false).expect("a world at rest");
    let [a, _, c, d] = &buffers(device, &bvh)?;
    traced(tracer, [a, &Trees::new(device, &bvh, c)?, c, d], rays)
}

/// The hits of rays through a world: where they begin, what they are traced through, triangles and
/// items.
pub fn traced(
    (kernels, kernel): &Tracer,
    [a, b, c, d]: [&dyn Binding; 4],
    rays: &[(Ray, f32)],
) -> Result<Vec<Traced>, GpuError> {
    let device = kernels.device();
    let numbers = |(ray, end): &(Ray, f32)| [ray.o.x, ray.o.y, ray.o.z, *end, ray.d.x, ray.d.y, ray.d.z, 0.0];
    let [e, f] = [
        &device.buffer("rays", &rays.iter().map(numbers).collect::<Vec<_>>())?,
        &device.buffer("hits", &vec![[0u32; 8]; rays.len()])?,
    ];
    device.run(kernel, &[a, b, c, d, e as &dyn Binding, f], [rays.len().div_ceil(64) as u32, 1, 1])?;
    let hit = |[t, u, v, geometry, primitive, instance, found, any]: [u32; 8]| {
        let path = if instance == u32::MAX {
            InstancePath::TOP
        } else {
            InstancePath::TOP.into(InstanceId(instance))
        };
        let uv = Vec2::new(f32::from_bits(u), f32::from_bits(v));
        let (t, geometry) = (f32::from_bits(t), GeometryId(geometry));
        ((found != 0).then_some(Hit { t, uv, geometry, primitive, instance: path }), any != 0)
    };
    Ok(device.read(f)?.into_iter().map(hit).collect())
}

/// How the hits of rays compare.
#[derive(Debug, Default)]
struct Comparison {
    hits: usize,
    /// Rays that meet another primitive, or none, on one side.
    other: usize,
    /// The largest difference of distances, relative to those above 1.
    distance: f32,
}

fn compare(tracer: &Tracer, world: &World, rays: &[(Ray, f32)]) -> Comparison {
    let mut comparison = Comparison::default();
    let results = on_gpu(tracer, world, rays).unwrap_or_else(|error| panic!("{error}"));
    for ((ray, end), (hit, any)) in rays.iter().zip(results) {
        let expected = world.intersect(ray, *end, &|_: &Hit, _: &Ray| true, &mut RayStats::default());
        assert_eq!(any, hit.is_some(), "{ray:?}");
        // Of instances within others the GPU knows the innermost.
        let place = |hit: &Hit| (hit.geometry, hit.primitive, hit.instance.ids().last().copied());
        let is_same = |a: &Hit, b: &Hit| place(a) == place(b);
        comparison.hits += expected.is_some() as usize;
        match (expected, hit) {
            (None, None) => {}
            (Some(a), Some(b)) => {
                comparison.distance = comparison.distance.max((a.t - b.t).abs() / a.t.max(1.0));
                if !is_same(&a, &b) {
                    println!("{ray:?}: {a:?} by the CPU, {b:?} by the GPU");
                    comparison.other += 1;
                }
            }
            _ => comparison.other += 1,
        }
    }
    println!("{} rays: {comparison:?}", rays.len());
    comparison
}

pub fn mesh(positions: Vec<Vec3>, indices: Vec<[u32; 3]>) -> TriangleMesh {
    let attributes = MeshAttributes::default();
    TriangleMesh::new(positions.into(), indices.into(), attributes, &Transform::IDENTITY, false)
        .expect("a mesh")
}

/// A closed, bumpy sphere.
fn ball(n: u32) -> TriangleMesh {
    let point = |i: u32, j: u32| {
        // All vertices of a pole are at one place.
        let turn = if i.is_multiple_of(n) { 0 } else { j };
        let (theta, phi) = (i as f32 / n as f32 * PI, turn as f32 / n as f32 * TAU);
        let r = 1.0 + 0.2 * (5.0 * theta).sin() * (7.0 * phi).cos();
        spherical_direction(theta.sin(), theta.cos(), phi) * r
    };
    let positions = (0..=n).flat_map(|i| (0..n).map(move |j| point(i, j)));
    let at = |i: u32, j: u32| i * n + j % n;
    let quad = |(i, j): (u32, u32)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    let indices = (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).flat_map(quad);
    mesh(positions.collect(), indices.collect())
}

/// A field of separate triangles, of which some are long and some tiny.
pub fn soup(count: usize) -> TriangleMesh {
    let mut random = Random::new(3);
    let mut point = |scale: f32| {
        let [a, b] = random.get_2d();
        (Vec3::new(a, b, random.get_1d()) - Vec3::splat(0.5)) * scale
    };
    let mut positions = Vec::new();
    for i in 0..count {
        let center = point(3.0);
        let size = [0.01, 0.1, 1.0][i % 3];
        positions.extend([center, center + point(size), center + point(size)]);
    }
    let indices = (0..count as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
    mesh(positions, indices.collect())
}

pub fn random_rays(count: usize, scale: f32) -> Vec<(Ray, f32)> {
    let mut random = Random::new(5);
    let ray = |_| {
        let [a, b] = random.get_2d();
        let o = (Vec3::new(a, b, random.get_1d()) - Vec3::splat(0.5)) * scale;
        let end = if random.get_1d() < 0.2 { random.get_1d() * scale } else { f32::INFINITY };
        (Ray::new(o, sample_uniform_sphere(random.get_2d().into()), 0.0), end)
    };
    (0..count).map(ray).collect()
}

fn world(meshes: impl IntoIterator<Item = TriangleMesh>) -> World {
    let mut builder = World::builder();
    for mesh in meshes {
        builder.add_geometry(GroupId::TOP, mesh);
    }
    builder.build()
}

#[test]
fn random_rays_meet_the_triangles_that_they_meet_on_the_cpu() {
    let worlds = [world([ball(300)]), world([soup(5000), ball(10)]), world([soup(3)]), world([])];
    for (tracer, world) in tracers().flat_map(|tracer| worlds.iter().map(move |world| (tracer, world))) {
        let found = compare(tracer, world, &random_rays(20_000, 4.0));
        assert!(found.other <= 2 && found.distance < 1e-5, "{found:?}");
    }
}

#[test]
fn rays_with_small_stacks_meet_the_same_triangles() {
    let Some(device) = crate::device() else { return };
    let [source, _] = sources();
    let (stack, small) = ("const STACK = 24u;", "const STACK = 12u;");
    assert!(source.contains(stack), "{stack}");
    let tracer = compiled(device, &source.replace(stack, small));
    let found = compare(&tracer, &world([soup(20_000)]), &random_rays(20_000, 4.0));
    assert!(found.other <= 2 && found.distance < 1e-5, "{found:?}");
}

#[test]
fn rays_through_edges_and_vertices_do_not_leak() {
    let mesh = ball(40);
    let mut random = Random::new(7);
    let ray = |i: usize| {
        let corners = mesh.corners(i % mesh.len());
        let t = if i.is_multiple_of(2) { 0.0 } else { random.get_1d() };
        let (target, [a, b]) = (corners[0].lerp(corners[1], t), random.get_2d());
        let o = (Vec3::new(a, b, random.get_1d()) - Vec3::splat(0.5)) * 0.2;
        (Ray::new(o, target - o, 0.0), f32::INFINITY)
    };
    let rays: Vec<_> = (0..60_000).map(ray).collect();
    for tracer in tracers() {
        let results = on_gpu(tracer, &world([mesh.clone()]), &rays).unwrap_or_else(|error| panic!("{error}"));
        let mut leaks = 0;
        for ((ray, _), (hit, any)) in rays.iter().zip(results) {
            // Beyond a leak is the other side, or nothing.
            let is_there = hit.is_some_and(|hit| (hit.t - 1.0).abs() < 1e-4);
            assert!(!is_there || any, "{ray:?}");
            leaks += usize::from(!is_there);
        }
        println!("{leaks} of {} rays leak", rays.len());
        // Vulkan does not forbid leaks of ray queries. Of Mesa's lavapipe 0.7 % leak.
        let most = if tracer.0.device().has_ray_queries() { rays.len() / 100 } else { 0 };
        assert!(leaks <= most, "{leaks} of {} rays leak", rays.len());
    }
}

#[test]
fn of_triangles_at_one_place_the_first_is_hit() {
    let Some(tracer) = tracer() else { return };
    let found = compare(tracer, &world([ball(12), ball(12)]), &random_rays(5000, 4.0));
    assert!(found.hits > 500 && found.other <= 2, "{found:?}");
}

#[test]
fn instances_are_met() {
    let mut builder = World::builder();
    builder.add_geometry(GroupId::TOP, soup(500));
    let groups = [builder.add_group(), builder.add_group()];
    builder.add_geometry(groups[0], ball(20));
    builder.add_geometry(groups[1], soup(300));
    for i in 0..40 {
        let angle = i as f32;
        let place = Transform::translate(Vec3::new(angle.sin(), angle.cos(), angle / 20.0 - 1.0) * 2.0);
        let turn = Transform::rotate(angle, Vec3::new(1.0, 2.0, 3.0));
        let transform = place.after(&turn).after(&Transform::scale(Vec3::new(0.3, 0.5, 0.2)));
        let instance = Instance { group: groups[i % 2], render_from_instance: transform.into() };
        builder.add_instance(GroupId::TOP, instance);
    }
    // The CPU transforms rays in doubles.
    let world = builder.build();
    for tracer in tracers() {
        let found = compare(tracer, &world, &random_rays(20_000, 6.0));
        assert!(found.hits > 1000 && found.other <= 4 && found.distance < 1e-4, "{found:?}");
    }
}

/// A wood of trees, each of branches with leaves, and an object that is nothing but instances.
#[test]
fn instances_within_instances_are_met() {
    let mut builder = World::builder();
    builder.add_geometry(GroupId::TOP, soup(100));
    let groups = [builder.add_group(), builder.add_group(), builder.add_group()];
    builder.add_geometry(groups[0], ball(8));
    builder.add_geometry(groups[1], soup(40));
    builder.add_geometry(groups[1], Shape::from(Sphere::whole(&Transform::IDENTITY, false, 0.4)));
    let mut random = Random::new(9);
    for (outer, inner, count, scale) in
        [(groups[1], groups[0], 6, 0.3), (groups[2], groups[1], 4, 0.5), (GroupId::TOP, groups[2], 12, 0.8)]
    {
        for _ in 0..count {
            let [[a, b], [c, angle]] = [random.get_2d(), random.get_2d()];
            let place = Transform::translate((Vec3::new(a, b, c) - Vec3::splat(0.5)) * 3.0);
            let turn = Transform::rotate(360.0 * angle, Vec3::new(1.0, 2.0, 3.0));
            let transform =
                place.after(&turn).after(&Transform::scale(Vec3::new(scale, -scale, 0.7 * scale)));
            builder.add_instance(outer, Instance { group: inner, render_from_instance: transform.into() });
        }
    }
    let world = builder.build();
    for tracer in tracers() {
        let found = compare(tracer, &world, &random_rays(20_000, 6.0));
        assert!(found.hits > 1000 && found.other <= 10 && found.distance < 1e-4, "{found:?}");
    }
}

/// Spheres, cylinders, disks and patches, some of them parts, and a plane below.
fn shapes() -> Vec<Shape> {
    let place = |x: f32, angle: f32| {
        let scale = Transform::scale(Vec3::new(0.5, 0.4, 0.6));
        let turn = Transform::rotate(angle, Vec3::new(1.0, 2.0, 3.0));
        Transform::translate(Vec3::new(x, x * x - 1.0, 0.3 * x)).after(&turn).after(&scale)
    };
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 0.0)];
    vec![
        Sphere::whole(&Transform::translate(Vec3::new(0.2, 0.1, -0.8)), false, 0.5).into(),
        Sphere::new(&place(-1.5, 40.0), true, 1.0, [-0.5, 0.8], 200.0).into(),
        Cylinder::new(&place(-0.7, 80.0), false, 0.6, [-0.6, 0.5], 300.0).into(),
        Disk::new(&place(0.5, 120.0), false, 0.1, 1.0, 0.3, 250.0).into(),
        BilinearPatch::new(corners, None, None, &place(1.2, 10.0), false).into(),
        Plane::new(&Transform::translate(Vec3::new(0.0, 0.0, -2.0)), false).into(),
    ]
}

#[test]
fn shapes_are_met() {
    let mut builder = World::builder();
    builder.add_geometry(GroupId::TOP, soup(30));
    let inner = builder.add_group();
    for shape in shapes() {
        if shape.bounds().is_some() {
            builder.add_geometry(inner, shape.clone());
        }
        builder.add_geometry(GroupId::TOP, shape);
    }
    let render_from_instance = Transform::translate(Vec3::new(0.0, 0.5, 1.5)).into();
    builder.add_instance(GroupId::TOP, Instance { group: inner, render_from_instance });
    // Rays that graze an edge may miss it on one side.
    let world = builder.build();
    for tracer in tracers() {
        let found = compare(tracer, &world, &random_rays(20_000, 6.0));
        assert!(found.hits > 5000 && found.other <= 20 && found.distance < 1e-3, "{found:?}");
    }
}

/// Curves that bend, of both profiles that face the ray, whole and in parts.
#[test]
fn curves_are_met() {
    let mut random = Random::new(11);
    let mut point = |scale: f32| {
        let [a, b] = random.get_2d();
        (Vec3::new(a, b, random.get_1d()) - Vec3::splat(0.5)) * scale
    };
    let segments: Vec<CurveSegment> = (0..60)
        .map(|i| {
            let start = point(3.0);
            let points = [start, start + point(1.0), start + point(1.5), start + point(2.0)];
            CurveSegment { points, width: [0.05 + 0.002 * i as f32, 0.1] }
        })
        .collect();
    let mut builder = World::builder();
    for (profile, split, angle) in [(CurveProfile::Flat, 0, 50.0), (CurveProfile::Cylinder, 2, 140.0)] {
        let scale = Transform::scale(Vec3::splat(0.8));
        let turn = Transform::rotate(angle, Vec3::new(1.0, 2.0, 3.0)).after(&scale);
        builder.add_geometry(GroupId::TOP, Curves::new(segments.clone(), profile, split, &turn, false));
    }
    // Where a curve recedes from the ray, hits are known to within its width.
    let world = builder.build();
    for tracer in tracers() {
        let found = compare(tracer, &world, &random_rays(20_000, 5.0));
        assert!(found.hits > 1000 && found.other <= 4 && found.distance < 0.1, "{found:?}");
    }
}

#[test]
fn what_kernels_do_not_intersect_is_refused() {
    let mut builder = World::builder();
    let cone = Shape::from(Cone::new(&Transform::IDENTITY, false, 1.0, 1.0, 360.0));
    let id = builder.add_geometry(GroupId::TOP, cone);
    assert_eq!(Bvh::new(&builder.build(), &|_| false).err(), Some(BvhError::Shape(id)));
}
