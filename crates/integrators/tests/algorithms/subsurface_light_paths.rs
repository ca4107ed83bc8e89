//! Scattering under surfaces by algorithms with light paths, against path tracing.

use alhazen_integrators::build;
use description::{
    BdptDesc, CameraKind, IntegratorDesc, LensDesc, LightKind, LightTracingDesc, MaterialKind, MltDesc,
    OpenPbrDesc, PathDesc, PhotonMappingDesc, RoughnessDesc, SamplerDesc, SamplerKind, SceneDesc, ScreenDesc,
    ShapeDesc, SppmDesc, SubsurfaceScattering, TransformDesc, VcmDesc,
};
use math::{DMat4, DVec3};
use scattering::SubsurfaceMethod::{self, Diffusion, RandomWalk};
use testkit::Moments;

use crate::support::{at, diffuse, emission, finished, quad, sphere, v};

/// Maximum number of scattering events.
const DEPTH: u32 = 4;

/// The radius of photons.
const RADIUS: f32 = 0.06;

/// Samples of each pixel, with which all means of a scene are known to less than two per cent.
struct Samples {
    path: u32,
    bdpt: u32,
    light_tracing: u32,
    /// Mutations per pixel.
    mlt: u32,
    vcm: u32,
    sppm: u32,
    photon_mapping: u32,
    gathered: u32,
}

const ROOM: Samples = Samples {
    path: 100,
    bdpt: 80,
    light_tracing: 100,
    mlt: 100,
    vcm: 25,
    sppm: 22,
    photon_mapping: 18,
    gathered: 22,
};

/// Few light paths leave a smooth boundary towards the camera.
const BALL: Samples = Samples { light_tracing: 500, mlt: 500, ..ROOM };

/// Few photons reach what is behind the surface.
const BEHIND: Samples = Samples { mlt: 400, sppm: 45, photon_mapping: 35, gathered: 30, ..ROOM };

fn body(method: SubsurfaceMethod, roughness: f32) -> MaterialKind {
    let scattering = SubsurfaceScattering::Coefficients { sigma_a: 0.3.into(), sigma_s: 6.0.into() };
    let roughness = RoughnessDesc::isotropic(roughness);
    MaterialKind::Subsurface { scattering, scale: 1.0, eta: 1.33, g: 0.0, roughness, method }
}

/// A principled surface with all kinds of lobes, most of which scatters under its surface.
fn principled() -> MaterialKind {
    let mut desc = OpenPbrDesc::default();
    let given = [
        ("subsurface_weight", 0.8),
        ("subsurface_radius", 0.15),
        ("subsurface_scatter_anisotropy", 0.3),
        ("base_metalness", 0.1),
        ("specular_roughness", 0.6),
        ("coat_weight", 0.5),
        ("coat_roughness", 0.5),
        ("fuzz_weight", 0.3),
    ];
    for (number, value) in OpenPbrDesc::NUMBERS.iter().zip(&mut desc.numbers) {
        if let Some((_, given)) = given.iter().find(|(name, _)| *name == number.field.name) {
            *value = (*given).into();
        }
    }
    MaterialKind::OpenPbr(Box::new(desc))
}

/// A view of the origin from above.
fn view() -> SceneDesc {
    let mut desc = SceneDesc::default();
    let (eye, target) = (DVec3::new(0.0, -3.0, 1.6), DVec3::new(0.0, 0.0, 0.4));
    let forward = (target - eye).normalize();
    let right = forward.cross(DVec3::Z).normalize();
    let axes = [(right, 0.0), (right.cross(forward), 0.0), (forward, 0.0), (eye, 1.0)];
    let [x, y, z, p] = axes.map(|(axis, w)| axis.extend(w));
    desc.camera.camera_from_world = TransformDesc::fixed(DMat4::from_cols(x, y, z, p).inverse());
    desc.film.resolution = [12, 12];
    desc.film.save_fp16 = false;
    desc
}

fn point(desc: &mut SceneDesc, from: math::Point3, intensity: f32) {
    desc.lights.push(LightKind::Point { intensity: intensity.into(), power: None, from }.into());
}

/// A ball and a slab on the floor under a lamp, before and behind lights at points. The boundaries
/// are rough, as no camera path finds what a smooth one reflects of those.
fn room(body: MaterialKind) -> SceneDesc {
    let mut desc = view();
    let area_light = emission(&mut desc, 5.0);
    let lamp = quad(v(-1.0, -0.5, 2.5), v(0.0, 1.0, 0.0), v(2.0, 0.0, 0.0));
    desc.shapes.push(ShapeDesc { area_light, ..lamp.into() });
    point(&mut desc, v(1.0, -1.5, 2.0), 3.0);
    point(&mut desc, v(0.5, 1.5, 1.0), 3.0);
    let material = diffuse(&mut desc, 0.5);
    let floor = quad(v(-3.0, -3.0, 0.0), v(6.0, 0.0, 0.0), v(0.0, 6.0, 0.0));
    desc.shapes.push(ShapeDesc { material, ..floor.into() });
    let material = Some(desc.materials.push(body.into()));
    desc.shapes.push(ShapeDesc { material, ..at(sphere(0.45), v(-0.5, 0.0, 0.5)) });
    let (low, high) = (v(0.2, 0.0, 0.05), v(0.9, 0.12, 0.9));
    let (x, y, z) = (v(high.x - low.x, 0.0, 0.0), v(0.0, high.y - low.y, 0.0), v(0.0, 0.0, high.z - low.z));
    for side in [
        quad(low, y, x),
        quad(low, z, y),
        quad(low, x, z),
        quad(high, -x, -y),
        quad(high, -y, -z),
        quad(high, -z, -x),
    ] {
        desc.shapes.push(ShapeDesc { material, ..side.into() });
    }
    desc
}

/// A ball with a smooth boundary, alone with a light at a point, that fills the picture.
fn ball(method: SubsurfaceMethod) -> SceneDesc {
    let mut desc = view();
    let (screen, lens) = (ScreenDesc::default(), LensDesc::default());
    desc.camera.kind = CameraKind::Perspective { screen, lens, fov: 25.0 };
    point(&mut desc, v(1.0, -1.5, 2.0), 3.0);
    let material = Some(desc.materials.push(body(method, 0.0).into()));
    desc.shapes.push(ShapeDesc { material, ..at(sphere(0.6), v(0.0, 0.0, 0.4)) });
    desc
}

/// A floor under a body without thickness: light shines through it from outside to below.
fn behind(body: MaterialKind) -> SceneDesc {
    let mut desc = view();
    point(&mut desc, v(0.3, -0.4, 4.0), 20.0);
    let material = diffuse(&mut desc, 0.5);
    let floor = quad(v(-3.0, -3.0, 0.0), v(6.0, 0.0, 0.0), v(0.0, 6.0, 0.0));
    desc.shapes.push(ShapeDesc { material, ..floor.into() });
    let material = Some(desc.materials.push(body.into()));
    let roof = quad(v(-1.5, -1.0, 0.9), v(3.0, 0.0, 0.0), v(0.0, 2.0, 0.6));
    desc.shapes.push(ShapeDesc { material, ..roof.into() });
    desc
}

/// The mean of the picture, by several seeds.
fn means(desc: &SceneDesc, integrator: &IntegratorDesc, pixel_samples: u32) -> Moments {
    let mean = |seed| {
        let sampler = SamplerDesc { kind: SamplerKind::Independent { pixel_samples }, seed: Some(seed) };
        let integrator = integrator.clone().into();
        let desc = SceneDesc { integrator, sampler: sampler.into(), ..desc.clone() };
        let built = build(&desc).unwrap();
        assert_eq!(built.warnings, []);
        let film = finished(&desc, built.integrator).into_state().film;
        let picture = film.develop().unwrap();
        picture.values().map(f64::from).sum::<f64>() / picture.values().count() as f64
    };
    (0..16).map(mean).collect()
}

/// Asserts that the algorithms with light paths have the mean of path tracing; those with photons
/// blur light.
fn assert_agreement(desc: &SceneDesc, samples: &Samples) {
    let path = IntegratorDesc::VolPath(PathDesc { max_depth: DEPTH, ..PathDesc::default() });
    let expected = means(desc, &path, samples.path);
    let photons = PhotonMappingDesc {
        max_depth: DEPTH,
        photons: 3000,
        caustic_photons: 3000,
        radius: Some(RADIUS),
        ..PhotonMappingDesc::default()
    };
    let max_depth = DEPTH;
    for (integrator, pixel_samples, bias) in [
        (IntegratorDesc::Bdpt(BdptDesc { max_depth, ..BdptDesc::default() }), samples.bdpt, 0.0),
        (IntegratorDesc::LightTracing(LightTracingDesc { max_depth }), samples.light_tracing, 0.0),
        (
            IntegratorDesc::Mlt(MltDesc {
                max_depth,
                mutations_per_pixel: samples.mlt,
                chains: 100,
                ..MltDesc::default()
            }),
            1,
            0.0,
        ),
        (
            IntegratorDesc::Vcm(VcmDesc { max_depth, radius: Some(RADIUS), ..VcmDesc::default() }),
            samples.vcm,
            0.01,
        ),
        (
            IntegratorDesc::Sppm(SppmDesc {
                max_depth,
                photons_per_iteration: Some(3000),
                radius: Some(RADIUS),
                seed: None,
            }),
            samples.sppm,
            0.02,
        ),
        (IntegratorDesc::PhotonMapping(photons), samples.photon_mapping, 0.02),
        (IntegratorDesc::PhotonMapping(PhotonMappingDesc { gather: 4, ..photons }), samples.gathered, 0.02),
    ] {
        let found = means(desc, &integrator, pixel_samples);
        let error = (found.variance_of_mean() + expected.variance_of_mean()).sqrt();
        let difference = (found.mean - expected.mean).abs();
        assert!(error < 0.02 * expected.mean, "{integrator:?}: the error {error} is too large for a test");
        assert!(
            difference < 5.0 * error + bias * expected.mean,
            "{integrator:?}: {} ± {error} for {}",
            found.mean,
            expected.mean
        );
    }
}

#[test]
fn algorithms_agree_on_a_ball_and_a_slab() {
    assert_agreement(&room(body(Diffusion, 0.4)), &ROOM);
}

#[test]
#[ignore = "slow: ten seconds; other tests have each method, boundary and surface"]
fn algorithms_agree_on_walks_in_a_ball_and_a_slab() {
    assert_agreement(&room(body(RandomWalk, 0.4)), &ROOM);
}

#[test]
#[ignore = "slow: ten seconds; other tests have each method, boundary and surface"]
fn algorithms_agree_on_a_smooth_ball() {
    assert_agreement(&ball(Diffusion), &BALL);
}

#[test]
fn algorithms_agree_on_walks_in_a_smooth_ball() {
    assert_agreement(&ball(RandomWalk), &BALL);
}

#[test]
#[ignore = "slow: ten seconds; other tests have each method, boundary and surface"]
fn algorithms_agree_behind_a_surface() {
    assert_agreement(&behind(body(Diffusion, 0.4)), &BEHIND);
}

#[test]
#[ignore = "slow: ten seconds; other tests have each method, boundary and surface"]
fn algorithms_agree_on_principled_bodies() {
    assert_agreement(&room(principled()), &ROOM);
}

#[test]
fn algorithms_agree_behind_a_principled_surface() {
    assert_agreement(&behind(principled()), &BEHIND);
}
