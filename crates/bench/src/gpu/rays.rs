//! Rays in a second through a million triangles.

use std::sync::Arc;
use std::time::Instant;

use alhazen::device::{Device, Kernels};
use alhazen_bench::mesh::BenchMesh;
use alhazen_bench::rays::{BenchRay, Query, ray_sets};
use geometry::{GroupId, Hit, RayStats, World};
use gpu::{Binding, Bvh, GpuError, Trees, shaders};
use math::Ray;
use serde_json::{Map, Value, json};

use crate::{Size, median};

/// Of how many runs the median is reported.
const RUNS: usize = 5;

/// A kernel that traces rays, of eight numbers each, to distances: 0 where nothing is hit. An end
/// below 0 is that of a ray which any hit ends.
const KERNEL: &str = "
    fn accepts(hit: Hit, o: vec3f, d: vec3f) -> bool { return true; }
    const HAS_CURVES = false;
    fn ribbon_normal(geometry: u32, primitive: u32, u: f32) -> vec3f { return vec3f(); }
    const HAS_MOTION = false;
    fn moved_rows(first_key: u32, motions: u32) -> array<vec4f, 3> { return array<vec4f, 3>(); }
    struct World { top: Top }
    @group(0) @binding(0) var<storage, read_write> world: World;
    @group(0) @binding(2) var<storage, read_write> triangles: array<vec4u>;
    @group(0) @binding(3) var<storage, read_write> items: array<vec4u>;
    @group(0) @binding(4) var<storage, read_write> rays: array<array<vec4f, 2>>;
    @group(0) @binding(5) var<storage, read_write> hits: array<f32>;
    @compute @workgroup_size(64)
    fn main(@builtin(global_invocation_id) id: vec3u) {
        if (id.x >= arrayLength(&rays)) { return; }
        let ray = rays[id.x];
        let hit = trace(ray[0].xyz, ray[1].xyz, abs(ray[0].w), ray[0].w < 0);
        hits[id.x] = select(0, hit.t, hit.found);
    }";

/// What rays are traced through.
const NODES: &str = "@group(0) @binding(1) var<storage, read_write> nodes: array<vec4u>;";
const STRUCTURE: &str = "@group(0) @binding(1) var structure: acceleration_structure;";

/// Millions of rays of each set in a second, for both meshes; by kernels, and by ray queries if
/// there are any.
pub fn measure(kernels: &Arc<Kernels>, size: &Size) -> Result<Value, String> {
    let device = kernels.device();
    let source = [&*shaders::tags(), shaders::TRACE, NODES, KERNEL].concat();
    let mut report = by(device, &source, size)?;
    let device = Device::for_ray_queries(device.name()).map_err(|error| error.to_string())?;
    if device.has_ray_queries() {
        let source =
            [shaders::ENABLE_RAY_QUERIES, &*shaders::tags(), shaders::RAY_QUERY, STRUCTURE, KERNEL].concat();
        report.insert("by ray queries".into(), by(&device, &source, size)?.into());
    }
    Ok(report.into())
}

/// The rates of a device by a kernel.
fn by(device: &Device, source: &str, size: &Size) -> Result<Map<String, Value>, String> {
    let kernel = device.kernel("rays", source).map_err(|error| error.to_string())?;
    let mut report = Map::new();
    for mesh in BenchMesh::NAMES.into_iter().filter_map(BenchMesh::named) {
        let mut builder = World::builder();
        builder.add_geometry(GroupId::TOP, mesh.triangles().map_err(|error| error.to_string())?);
        let world = builder.build();
        let closest = |BenchRay { ray, t_max }: &BenchRay| {
            let hit = world.intersect(ray, *t_max, &|_: &Hit, _: &Ray| true, &mut RayStats::default())?;
            Some((hit.t, hit.primitive as usize))
        };
        let bvh = if device.has_ray_queries() {
            Bvh::for_ray_queries(&world, &|_| false).ok_or("too many triangles for ray queries")?
        } else {
            Bvh::new(&world, &|_| false).map_err(|error| format!("{error:?}"))?
        };
        let mut rates = Map::new();
        for set in ray_sets(&mesh, size.rays, closest) {
            let sign = if set.query == Query::Any { -1.0 } else { 1.0 };
            let numbers = |BenchRay { ray, t_max }: &BenchRay| {
                let (o, d) = (ray.o, ray.d);
                [o.x, o.y, o.z, sign * t_max.min(f32::MAX), d.x, d.y, d.z, 0.0]
            };
            let made = (|| {
                let world = device.buffer("heads", &[bvh.top])?;
                let triangles = device.buffer("triangles", &bvh.triangles)?;
                let trees = Trees::new(device, &bvh, &triangles)?;
                let items = device.buffer("items", &bvh.items)?;
                let rays = device.buffer("rays", &set.rays.iter().map(numbers).collect::<Vec<_>>())?;
                let hits = device.zeros("hits", 4 * set.rays.len() as u64)?;
                let buffers: [&dyn Binding; 6] = [&world, &trees, &triangles, &items, &rays, &hits];
                let groups = [set.rays.len().div_ceil(64) as u32, 1, 1];
                let run = || {
                    let begin = Instant::now();
                    for _ in 0..size.repeats {
                        device.run(&kernel, &buffers, groups)?;
                    }
                    device.read_part::<f32>(&hits, 0, 1)?;
                    Ok(begin.elapsed())
                };
                // The clock of a GPU that had nothing to do rises for some tenths of a second.
                let begin = Instant::now();
                while begin.elapsed() < size.warming {
                    run()?;
                }
                let times = (0..RUNS).map(|_| run().map(|time| time.as_secs_f64()));
                let seconds = median(times.collect::<Result<_, _>>()?);
                let hits = device.read::<f32>(&hits)?.iter().filter(|t| **t > 0.0).count();
                Ok((hits, seconds))
            })();
            let (hits, seconds) = made.map_err(|error: GpuError| error.to_string())?;
            let traced = set.rays.len() as f64 * f64::from(size.repeats);
            rates.insert(
                set.name.into(),
                json!({
                    "million_rays_per_second": traced / seconds / 1e6,
                    "rays": set.rays.len(),
                    "hits": hits,
                }),
            );
        }
        report.insert(mesh.name.into(), json!({ "triangles": mesh.indices.len(), "sets": rates }));
    }
    Ok(report)
}
