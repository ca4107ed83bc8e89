//! The parts of the ray engine, one by one: building a tree, a query, each shape.

use alhazen_bench::building;
use alhazen_bench::mesh::{BenchMesh, spheres};
use alhazen_bench::rays::{BenchRay, Query, RaySet, ray_sets};
use alhazen_bench::tracing::{closest, trace};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use geometry::{BilinearPatch, BuildQuality, Cylinder, Disk, Plane, Shape, Sphere, Triangle, World};
use math::{Ray, Transform, Vec3};

/// A million triangles or spheres, balanced.
fn build(c: &mut Criterion) {
    let mut group = c.benchmark_group("build");
    group.sample_size(10);
    for mesh in meshes() {
        let triangles = mesh.triangles().expect("a mesh");
        group.throughput(Throughput::Elements(mesh.indices.len() as u64));
        group.bench_function(mesh.name, |b| {
            b.iter(|| building::world(triangles.clone(), BuildQuality::Balanced))
        });
    }
    let set = spheres(1_000_000).expect("spheres");
    group.throughput(Throughput::Elements(set.len() as u64));
    group.bench_function("spheres", |b| b.iter(|| building::world(set.clone(), BuildQuality::Balanced)));
}

/// The nearest hit and any hit, by sets of rays.
fn queries(c: &mut Criterion) {
    for mesh in meshes() {
        let world = building::world(mesh.triangles().expect("a mesh"), BuildQuality::Balanced);
        for set in sets(&mesh, &world) {
            let query = match set.query {
                Query::Closest => "closest hit",
                Query::Any => "any hit",
            };
            let mut group = c.benchmark_group(format!("{query}/{}", mesh.name));
            group.throughput(Throughput::Elements(set.rays.len() as u64));
            group.bench_function(set.name, |b| b.iter(|| trace(&world, &set)));
        }
    }
}

/// Rays through a million spheres, from side to side.
fn spheres_hit(c: &mut Criterion) {
    let world = building::world(spheres(1_000_000).expect("spheres"), BuildQuality::Balanced);
    let middle = Vec3::splat(0.5);
    let ray = |(o, p)| BenchRay { ray: Ray::new(middle + o, p - o, 0.0), t_max: f32::INFINITY };
    let rays: Vec<BenchRay> = pairs(16_384).map(ray).collect();
    let mut group = c.benchmark_group("closest hit");
    group.throughput(Throughput::Elements(rays.len() as u64));
    group
        .bench_function("spheres", |b| b.iter(|| rays.iter().filter_map(|ray| closest(&world, ray)).count()));
}

/// Rays from a sphere's surface towards points in each shape's box, half of which or so meet it.
fn shapes(c: &mut Criterion) {
    let m = &Transform::rotate(0.7, Vec3::new(0.3, 1.0, -0.2));
    let patch = [-Vec3::X - Vec3::Y, Vec3::X - Vec3::Y, Vec3::Y - Vec3::X, Vec3::ONE];
    let shapes: [(&str, Shape); 6] = [
        ("sphere", Sphere::whole(m, false, 1.0).into()),
        ("cylinder", Cylinder::new(m, false, 0.7, [-1.0, 0.5], 300.0).into()),
        ("disk", Disk::new(m, false, 0.0, 1.0, 0.2, 360.0).into()),
        ("plane", Plane::new(m, false).into()),
        ("bilinear patch", BilinearPatch::new(patch, None, None, m, false).into()),
        ("triangle", Triangle::new([-Vec3::ONE, Vec3::X, Vec3::Y]).into()),
    ];
    let mut group = c.benchmark_group("intersect");
    let rays: Vec<Ray> = pairs(1024).map(|(o, p)| Ray::new(3.0 * o, p - 3.0 * o, 0.0)).collect();
    group.throughput(Throughput::Elements(rays.len() as u64));
    for (name, shape) in &shapes {
        group.bench_function(*name, |b| {
            b.iter(|| rays.iter().filter_map(|ray| shape.intersect(ray, f32::INFINITY)).count())
        });
    }
}

/// Pairs of points spread over the unit sphere.
fn pairs(n: usize) -> impl Iterator<Item = (Vec3, Vec3)> {
    let point = move |i: usize| {
        let z = 1.0 - (2 * i + 1) as f32 / n as f32;
        let (sin, cos) = (2.399_963 * i as f32).sin_cos();
        Vec3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt() + Vec3::Z * z
    };
    (0..n).map(move |i| (point(i), point(i * 7919 % n)))
}

fn meshes() -> impl Iterator<Item = BenchMesh> {
    BenchMesh::NAMES.into_iter().filter_map(BenchMesh::named)
}

fn sets(mesh: &BenchMesh, world: &World) -> [RaySet; 5] {
    ray_sets(mesh, 256, |ray: &BenchRay| closest(world, ray).map(|hit| (hit.t, hit.primitive as usize)))
}

criterion_group!(parts, build, queries, spheres_hit, shapes);
criterion_main!(parts);
