//! Scenes built by hand, and means of radiance along a ray. Everything is grey, and radiance is in
//! units of a light of scale 1.

use std::sync::Arc;

use alhazen_integrators::{
    Cancelled, Control, Integrator, Limits, Path, RandomWalk, RayIntegrator, Session, SessionState,
    SimplePath, Tracer,
};
use description::{
    AreaLightDesc, ConductorDesc, ConductorReflectance, Handle, InfiniteRadiance, LightKind,
    LightSamplerDesc, MaterialDesc, MaterialKind, MeshDesc, PathDesc, RandomWalkDesc, RoughnessDesc,
    SceneDesc, ShapeDesc, ShapeKind, SimplePathDesc, SpectrumDesc, TransformDesc,
};
use geometry::RayStats;
use math::{Point3, Ray, RayDifferential, Vec3, Vector3};
use sampling::Sampler;
use sampling::sampler::Independent;
use scene::{Interfaces, Scene, View};
use spectrum::{CIE_Y_INTEGRAL, SampledWavelengths};
use testkit::{Moments, t_test};

pub fn v(x: f32, y: f32, z: f32) -> Vec3 {
    Vec3::new(x, y, z)
}

pub fn compile(desc: &SceneDesc) -> Scene {
    scene::compile(desc.clone()).unwrap().scene
}

/// The compiled scene and view of a valid description.
pub fn viewed(desc: &SceneDesc) -> (Scene, View) {
    (compile(desc), View::compile(desc, scene::world_from_render(desc)).unwrap().view)
}

/// A session of a description before its first pass.
pub fn session(desc: &SceneDesc, integrator: Box<dyn Integrator>) -> Session {
    let ((scene, view), film) = (viewed(desc), film::compile(desc).unwrap().film);
    Session::new(Arc::new(scene), view, integrator, SessionState::new(film))
}

/// A session after all its passes.
pub fn finished(desc: &SceneDesc, integrator: Box<dyn Integrator>) -> Session {
    let mut session = session(desc, integrator);
    let passes = 0..session.integrator().passes();
    session.run(passes, &Limits::default(), &Control::default(), &mut |_| ()).unwrap();
    session
}

pub fn diffuse(desc: &mut SceneDesc, reflectance: f32) -> Option<Handle<MaterialDesc>> {
    Some(desc.materials.push(MaterialKind::Diffuse { reflectance: reflectance.into() }.into()))
}

pub fn glass(desc: &mut SceneDesc) -> Option<Handle<MaterialDesc>> {
    let eta = SpectrumDesc::Constant(1.5);
    Some(desc.materials.push(MaterialKind::Dielectric { eta, roughness: RoughnessDesc::default() }.into()))
}

/// Metal that absorbs almost nothing.
pub fn mirror(desc: &mut SceneDesc, roughness: f32) -> Option<Handle<MaterialDesc>> {
    let reflectance = ConductorReflectance::Index { eta: 1.0.into(), k: 1e4.into() };
    let conductor = ConductorDesc { reflectance, roughness: RoughnessDesc::isotropic(roughness) };
    Some(desc.materials.push(MaterialKind::Conductor(conductor).into()))
}

pub fn emission(desc: &mut SceneDesc, scale: f32) -> Option<Handle<AreaLightDesc>> {
    let light = AreaLightDesc { scale, ..AreaLightDesc::new(SpectrumDesc::Constant(1.0)) };
    Some(desc.area_lights.push(light))
}

pub fn sphere(radius: f32) -> ShapeKind {
    ShapeKind::Sphere { radius, z_min: -radius, z_max: radius, phi_max: 360.0 }
}

/// A parallelogram of two triangles, its normal along side_x × side_y.
pub fn quad(corner: Point3, side_x: Vector3, side_y: Vector3) -> ShapeKind {
    ShapeKind::Triangles(MeshDesc {
        indices: Arc::new([[0, 1, 2], [0, 2, 3]]),
        positions: Arc::new([corner, corner + side_x, corner + side_x + side_y, corner + side_y]),
        ..MeshDesc::default()
    })
}

/// The six faces of the cube [-r, r]³, normals inwards.
pub fn walls(r: f32) -> [ShapeKind; 6] {
    let (x, y, z) = (v(2.0 * r, 0.0, 0.0), v(0.0, 2.0 * r, 0.0), v(0.0, 0.0, 2.0 * r));
    let (low, high) = (v(-r, -r, -r), v(r, r, r));
    [
        quad(low, x, y),
        quad(low, y, z),
        quad(low, z, x),
        quad(high, -y, -x),
        quad(high, -z, -y),
        quad(high, -x, -z),
    ]
}

pub fn at(kind: ShapeKind, p: Point3) -> ShapeDesc {
    let world_from_object = TransformDesc::translation(p.x.into(), p.y.into(), p.z.into());
    ShapeDesc { world_from_object, ..kind.into() }
}

/// A sky of radiance 1.
pub fn white_sky(desc: &mut SceneDesc) {
    let radiance = InfiniteRadiance::Constant(SpectrumDesc::Constant(1.0));
    desc.lights.push(LightKind::Infinite { radiance, illuminance: None, portal: None }.into());
}

/// The radiance that arrives at `o` from the direction `d`, by `count` independent samples.
pub fn radiance(
    rays: &mut impl RayIntegrator,
    scene: &Scene,
    o: Point3,
    d: Vector3,
    count: usize,
) -> Moments {
    let ((_, view), control) = (viewed(&SceneDesc::default()), Control::default());
    rays.prepare(scene, &view, &control).expect("nobody cancels it");
    let mut stats = RayStats::default();
    let mut sampler = Sampler::Independent(Independent::new(1, 7));
    let samples = (0..count).map(|i| {
        sampler.start_pixel_sample([i as i32, 0], 0, 0);
        let mut lambda = SampledWavelengths::sample_visible(sampler.get_1d());
        let ray = RayDifferential::from(Ray::new(o, d.normalize(), 0.0));
        let mut tracer = Tracer::new(scene, &view, &control, &mut sampler, &mut stats);
        let l = rays.li(&mut tracer, ray, &mut lambda);
        f64::from(l[0] * CIE_Y_INTEGRAL)
    });
    samples.collect()
}

/// Asserts a mean by a t-test, one of `tests`, with a tolerance of 3e-5 for single precision.
#[track_caller]
pub fn assert_mean(found: &Moments, expected: f64, tests: usize, what: &str) {
    if (found.mean - expected).abs() > 3e-5 * expected {
        t_test(found, expected, tests).unwrap_or_else(|difference| panic!("{what}: {difference}"));
    }
}

pub const LIGHT_SAMPLERS: [LightSamplerDesc; 3] =
    [LightSamplerDesc::Uniform, LightSamplerDesc::Power, LightSamplerDesc::Bvh];

/// The algorithms that are complete for rough surfaces, with settings that give the same result.
pub enum Unbiased {
    Path(Path),
    SimplePath(SimplePath),
    RandomWalk(RandomWalk),
}

impl Unbiased {
    pub fn all(max_depth: u32) -> Vec<(String, Self)> {
        let mut all = Vec::new();
        for light_sampler in LIGHT_SAMPLERS {
            let settings = PathDesc { max_depth, regularize: false, light_sampler };
            all.push((format!("{settings:?}"), Self::Path(Path::new(settings, Interfaces::Stop))));
        }
        for (sample_lights, sample_bsdf) in [(true, true), (true, false), (false, true), (false, false)] {
            let simple = SimplePath(SimplePathDesc { max_depth, sample_lights, sample_bsdf });
            all.push((format!("{simple:?}"), Self::SimplePath(simple)));
        }
        all.push(("random walk".into(), Self::RandomWalk(RandomWalk(RandomWalkDesc { max_depth }))));
        all
    }
}

impl RayIntegrator for Unbiased {
    fn prepare(&mut self, scene: &Scene, view: &View, control: &Control) -> Result<(), Cancelled> {
        match self {
            Self::Path(path) => path.prepare(scene, view, control),
            Self::SimplePath(_) | Self::RandomWalk(_) => Ok(()),
        }
    }

    fn li(
        &self,
        tracer: &mut Tracer,
        ray: RayDifferential,
        lambda: &mut SampledWavelengths,
    ) -> spectrum::SampledSpectrum {
        match self {
            Self::Path(rays) => rays.li(tracer, ray, lambda),
            Self::SimplePath(rays) => rays.li(tracer, ray, lambda),
            Self::RandomWalk(rays) => rays.li(tracer, ray, lambda),
        }
    }
}
