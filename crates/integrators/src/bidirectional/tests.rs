//! MIS weights from the recursion equal those from the densities of all strategies.

use std::sync::Arc;

use description::{
    AreaLightDesc, CameraKind, LensDesc, MaterialKind, MeshDesc, RoughnessDesc, SceneDesc, ScreenDesc,
    ShapeDesc, ShapeKind, SpectrumDesc, SubsurfaceScattering, TransformDesc,
};
use geometry::RayStats;
use math::{Bounds2, Normal3, Point2, Point3, Vec2, Vec3};
use sampling::Sampler;
use sampling::sampler::Independent;
use scattering::{SubsurfaceMethod, TransportMode};
use scene::camera::{CameraRayDifferential, CameraSample};
use scene::light::LightId;
use scene::{Scene, View};
use spectrum::SampledWavelengths;

use super::{Arrival, Balance, Bidirectional, Interaction, LightVertex, Lights, Vertex, Walk};
use crate::{Control, Tracer};

const LIGHT_PATHS: usize = 37;

/// The inside of a cube with two lamps, whose walls are diffuse, rough glass, or bodies that
/// scatter light under their surface, some of them with an alpha below 1.
fn room() -> (Scene, View) {
    let mut desc = SceneDesc::default();
    let rough = || RoughnessDesc::isotropic(0.6);
    let materials = [
        MaterialKind::Diffuse { reflectance: 0.7.into() },
        MaterialKind::Dielectric { eta: SpectrumDesc::Constant(1.5), roughness: rough() },
        MaterialKind::Subsurface {
            scattering: SubsurfaceScattering::Coefficients { sigma_a: 0.1.into(), sigma_s: 4.0.into() },
            scale: 1.0,
            eta: 1.33,
            g: 0.0,
            roughness: rough(),
            method: SubsurfaceMethod::Diffusion,
        },
    ]
    .map(|kind| desc.materials.push(kind.into()));
    let mut quad = |corner: Vec3, x: Vec3, y: Vec3, material: usize, alpha: f32, light: Option<f32>| {
        let mesh = MeshDesc {
            indices: Arc::new([[0, 1, 2], [0, 2, 3]]),
            positions: Arc::new([corner, corner + x, corner + x + y, corner + y]),
            ..MeshDesc::default()
        };
        let area_light = light.map(|scale| {
            let light = AreaLightDesc { scale, ..AreaLightDesc::new(SpectrumDesc::Constant(1.0)) };
            desc.area_lights.push(light)
        });
        let (material, alpha) = (Some(materials[material]), Some(alpha.into()));
        desc.shapes.push(ShapeDesc { material, alpha, area_light, ..ShapeKind::Triangles(mesh).into() });
    };
    let (x, y, z) = (Vec3::X * 2.0, Vec3::Y * 2.0, Vec3::Z * 2.0);
    let (low, high) = (Vec3::splat(-1.0), Vec3::splat(1.0));
    for (i, (corner, side_x, side_y)) in
        [(low, x, y), (low, y, z), (low, z, x), (high, -y, -x), (high, -z, -y), (high, -x, -z)]
            .into_iter()
            .enumerate()
    {
        let alpha = [1.0, 1.0, 0.3, 0.6, 1.0, 1.0][i];
        quad(corner, side_x, side_y, i % 3, alpha, None);
    }
    quad(Vec3::new(-0.5, -0.5, 0.9), Vec3::Y, Vec3::X, 0, 1.0, Some(5.0));
    quad(Vec3::new(-0.8, -0.2, -0.6), Vec3::Y * 0.2, Vec3::Z * 0.7, 1, 1.0, Some(2.0));
    desc.film.resolution = [100, 100];
    desc.camera.kind =
        CameraKind::Perspective { fov: 80.0, screen: ScreenDesc::default(), lens: LensDesc::default() };
    desc.camera.camera_from_world = TransformDesc::translation(0.0, 0.0, 0.9);
    let scene = scene::compile(desc.clone()).expect("a scene").scene;
    let view = View::compile(&desc, scene.world_from_render()).expect("a view").view;
    (scene, view)
}

/// A path from a light to the camera: its scattering vertices, from the light's side.
struct Path<'a> {
    light: (LightId, Point3, Normal3),
    surfaces: Vec<&'a Vertex<'a>>,
    camera: Point3,
}

/// Converts a density per solid angle at `from` to one per area at `to`.
fn per_area(pdf: f32, from: Point3, to: Point3, n: Normal3) -> f64 {
    let way = to - from;
    f64::from(pdf * n.dot(way.normalize()).abs() / way.length_squared())
}

impl Path<'_> {
    fn place(&self, index: usize) -> (Point3, Normal3) {
        let vertex = self.surfaces[index];
        (vertex.p.p, vertex.n)
    }

    /// The density of scattering at a surface, for light or importance from `from` to `to`.
    fn scattered(&self, index: usize, from: Point3, to: Point3, n: Normal3, mode: TransportMode) -> f64 {
        let vertex = self.surfaces[index];
        let (wo, wi) = ((from - vertex.p.p).normalize(), (to - vertex.p.p).normalize());
        let wo = if vertex.is_exit { vertex.wo } else { wo };
        per_area(vertex.law.pdf(wo, wi, mode), vertex.p.p, to, n)
    }

    /// The position of the vertex before or after a surface, seen from the light: index 0 is the
    /// light.
    fn before(&self, index: usize) -> Point3 {
        if index == 0 { self.light.1 } else { self.place(index - 1).0 }
    }

    fn after(&self, index: usize) -> Point3 {
        if index + 1 == self.surfaces.len() { self.camera } else { self.place(index + 1).0 }
    }

    /// The density, per area, with which a light subpath of `s` vertices samples the path's first
    /// ones.
    fn light_density(&self, paths: &Bidirectional, s: usize) -> f64 {
        let (light, p, n) = self.light;
        if s == 0 {
            return 1.0;
        }
        let first = self.place(0);
        let context = self.surfaces[0].light_context();
        let wi = (p - first.0).normalize();
        let source = paths.scene.light(light);
        if s == 1 {
            let pmf = paths.lights.seen_from.pmf(&context, light);
            return per_area(pmf * source.pdf_li(&context, wi, Some((p, n)), false), first.0, p, n);
        }
        let (pdf_position, pdf_direction) = source.pdf_le(p, n, -wi, context.time);
        let mut density = f64::from(paths.lights.emitting.pmf(light) * pdf_position)
            * per_area(pdf_direction, p, first.0, first.1);
        for index in 0..s - 2 {
            let (to, n) = self.place(index + 1);
            density *= self.scattered(index, self.before(index), to, n, TransportMode::Importance);
        }
        density
    }

    /// The same for a camera subpath, including the lens, whose film position is uniform in a
    /// pixel.
    fn camera_density(&self, paths: &Bidirectional, t: usize) -> f64 {
        if t == 1 {
            return LIGHT_PATHS as f64;
        }
        let last = self.surfaces.len() - 1;
        let to = self.place(last);
        let ray = math::Ray::new(self.camera, (to.0 - self.camera).normalize(), 0.0);
        let mut density = per_area(paths.view.camera.pdf_we(&ray).1, self.camera, to.0, to.1);
        for index in ((last + 3 - t).max(1)..=last).rev() {
            if self.surfaces[index - 1].is_exit {
                // The way under the surface, which all strategies have.
                continue;
            }
            let (to, n) = self.place(index - 1);
            density *= self.scattered(index, self.after(index), to, n, TransportMode::Radiance);
        }
        if t == self.surfaces.len() + 2 {
            let (_, p, n) = self.light;
            density *= self.scattered(0, self.after(0), p, n, TransportMode::Radiance);
        }
        density
    }

    fn density(&self, paths: &Bidirectional, strategy: Strategy) -> f64 {
        let vertices = self.surfaces.len() + 2;
        let last_of_light = match strategy {
            Strategy::Connect(s) => s,
            Strategy::Merge(s) => s - 1,
        };
        // Light subpaths do not leave a vertex under its surface.
        if self.surfaces[..last_of_light.saturating_sub(1).min(self.surfaces.len())]
            .iter()
            .any(|surface| surface.is_exit)
        {
            return 0.0;
        }
        match strategy {
            Strategy::Connect(s) => self.light_density(paths, s) * self.camera_density(paths, vertices - s),
            // No merging beyond a diffuse surface, seen from the camera.
            Strategy::Merge(s) if self.surfaces[s - 1..].iter().any(|surface| surface.is_diffuse()) => 0.0,
            Strategy::Merge(s) => {
                // Both subpaths hit the surface, in other strategies only one does.
                let eta = f64::from(paths.balance.merging * self.surfaces[s - 2].alpha);
                eta * self.light_density(paths, s) * self.camera_density(paths, vertices + 1 - s)
            }
        }
    }

    /// The weight of a strategy from the densities of all.
    fn weight(&self, paths: &Bidirectional, strategy: Strategy) -> f64 {
        let vertices = self.surfaces.len() + 2;
        let all = (0..vertices).map(Strategy::Connect).chain((3..vertices).map(Strategy::Merge));
        self.density(paths, strategy) / all.map(|each| self.density(paths, each)).sum::<f64>()
    }
}

/// How a path is built from a light subpath and a camera subpath, by the number of vertices of the
/// first.
#[derive(Clone, Copy, Debug)]
enum Strategy {
    /// By an edge between the two.
    Connect(usize),
    /// By a vertex that is the last of both.
    Merge(usize),
}

#[test]
fn weights_equal_the_balance_heuristic() {
    assert_weights(Balance::connecting(LIGHT_PATHS as f32), Balance::connecting(LIGHT_PATHS as f32));
}

#[test]
fn weights_equal_the_balance_heuristic_with_merging() {
    for radius in [0.01, 0.1, 1.0] {
        let balance = Balance::merging(LIGHT_PATHS, 2 * LIGHT_PATHS, radius);
        assert_weights(balance, balance);
    }
}

#[test]
#[should_panic(expected = " of ")]
fn weights_for_another_radius_differ() {
    let of = |radius| Balance::merging(LIGHT_PATHS, LIGHT_PATHS, radius);
    assert_weights(of(0.2), of(0.201));
}

/// Asserts that the recursion with `balance` gives the weights from the densities of `expected`.
fn assert_weights(balance: Balance, expected: Balance) {
    let (scene, view) = room();
    let lights = Lights::of(&scene, &Control::default()).unwrap();
    let paths = Bidirectional {
        scene: &scene,
        view: &view,
        lights: &lights,
        balance,
        max_depth: 4,
        light_goes_under: false,
        regularize: false,
    };
    let lambda = SampledWavelengths::sample_visible(0.4);
    let mut sampler = Sampler::Independent(Independent::new(1, 3));
    let (control, stats) = (Control::default(), &mut RayStats::default());
    let mut seen = [0; 5];
    let slow = Bidirectional { balance: expected, ..paths };
    let everywhere = Bounds2 { min: Vec2::NEG_INFINITY, max: Vec2::INFINITY };
    let mut check = |path: &Path, strategy: Strategy, weight: f32, kind: usize| {
        let expected = path.weight(&slow, strategy);
        let difference = (f64::from(weight) - expected).abs();
        let surfaces = path.surfaces.len();
        assert!(difference < 2e-3 * expected + 1e-6, "{strategy:?} of {surfaces}: {weight} {expected}");
        seen[kind] += 1;
    };
    let connect = |s: u32| Strategy::Connect(s as usize);
    for index in 0..6000 {
        sampler.start_pixel_sample([index, 0], 0, 0);
        let tracer = &mut Tracer::new(&scene, &view, &control, &mut sampler, stats);
        // The sampler's next numbers choose the light and its ray.
        let mut replay = tracer.sampler.clone();
        let (light, _) = lights.emitting.sample(replay.get_1d()).expect("a light");
        let sample = scene
            .sample_emission(light, replay.get_2d(), replay.get_2d(), 0.0, &lambda, tracer.stats)
            .expect("a ray");
        let start = (light, sample.p.expect("a place").p, sample.n);
        let mut light_subpath = Vec::new();
        paths.light_subpath(0.0, &lambda, tracer, |vertex, _| light_subpath.push(*vertex));

        let film = Point2::from(tracer.sampler.get_2d()) * 100.0;
        let sample = CameraSample { film, lens: Vec2::ZERO, time: 0.0, filter_weight: 1.0 };
        let ray = view.camera.generate_ray(&sample).expect("a ray");
        let camera = ray.ray.o;
        let ray = CameraRayDifferential { ray: ray.ray.into(), weight: ray.weight };

        for (i, vertex) in light_subpath.iter().enumerate() {
            let surfaces = light_subpath[..=i].iter().collect();
            if let Some(found) = paths.connect_to_camera(vertex, Vec2::ZERO, everywhere, &lambda, tracer) {
                check(
                    &Path { light: start, surfaces, camera },
                    connect(found.found.s),
                    found.found.weight,
                    0,
                );
            }
        }

        let mut walk = Walk::from_camera(&paths, &ray, lambda);
        let mut camera_subpath: Vec<Vertex> = Vec::new();
        while let Arrival::At(mut interaction) = walk.intersect(tracer) {
            let from_light = |count: usize| camera_subpath[..count].iter().rev().collect::<Vec<_>>();
            if let Some(found) = paths.emitted(&walk, &interaction, camera_subpath.last())
                && !camera_subpath.is_empty()
                && let Interaction::Surface(surface) = &interaction
            {
                let light = (surface.area_light.expect("a light"), surface.p(), surface.surface.n);
                let surfaces = from_light(camera_subpath.len());
                check(&Path { light, surfaces, camera }, connect(found.s), found.weight, 1);
            }
            if walk.depth == paths.max_depth {
                break;
            }
            let vertex = walk.arrive(&mut interaction, tracer).expect("no interfaces here");
            camera_subpath.push(vertex);
            let from_light = |count: usize| camera_subpath[..count].iter().rev().collect::<Vec<_>>();

            let mut replay = tracer.sampler.clone();
            if let Some(found) = paths.direct(&vertex, &lambda, tracer) {
                let (u, u_light) = (replay.get_1d(), replay.get_2d());
                let context = vertex.light_context();
                let (light, _) = lights.seen_from.sample(&context, u).expect("a light");
                let sample = scene.sample_light(light, &context, u_light, &lambda, false).expect("a point");
                let light = (light, sample.p.expect("a place").p, sample.n);
                let surfaces = from_light(camera_subpath.len());
                check(&Path { light, surfaces, camera }, connect(found.s), found.weight, 2);
            }
            for (i, light) in light_subpath.iter().enumerate() {
                if let Some(found) = paths.connect(&vertex, light, &lambda, tracer) {
                    let mut surfaces: Vec<_> = light_subpath[..=i].iter().collect();
                    surfaces.extend(from_light(camera_subpath.len()));
                    let path = Path { light: start, surfaces, camera };
                    check(&path, connect(found.s), found.weight, 3);
                    if balance.merging > 0.0 && light.can_merge() {
                        let stepped = stepped(&paths.balance, &vertex, light);
                        if stepped.can_merge() {
                            let merged = paths.merge(&stepped, &LightVertex::from(light), tracer);
                            check(&path, Strategy::Merge(found.s as usize), merged.weight, 4);
                        }
                    }
                }
            }
            if !walk.leave(&vertex, &interaction, tracer) {
                break;
            }
        }
    }
    let kinds = if balance.merging > 0.0 { 5 } else { 4 };
    assert!(seen[..kinds].iter().all(|&count| count > 50), "{seen:?}");
}

/// The vertex of a camera subpath that continues from `before` to the position of `at`.
fn stepped<'a>(balance: &Balance, before: &Vertex, at: &Vertex<'a>) -> Vertex<'a> {
    let way = at.p.p - before.p.p;
    let wi = way.normalize();
    let partial = balance
        .leave(&before.partial, before.pdf(wi), before.pdf_back(wi), before.cos_theta(wi), before.merges())
        .arrive(way.length_squared(), at.cos_theta(wi));
    let after_diffuse = before.after_diffuse || before.is_diffuse();
    Vertex { wo: -wi, partial, mode: before.mode, depth: before.depth + 1, after_diffuse, ..*at }
}
