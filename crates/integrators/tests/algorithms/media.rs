//! Participating media against closed forms: Beer's law, emission, single scattering, furnaces.

use alhazen_integrators::{Path, RayCasting, RayIntegrator, Whitted, build};
use description::schema::Settings;
use description::{
    AmbientOcclusionDesc, BdptDesc, CoefficientsDesc, Handle, IntegratorDesc, LightKind, MaterialKind,
    MediumDesc, MediumInterface, MediumKind, PathDesc, RadiosityDesc, SceneDesc, ShapeDesc,
    SimpleVolPathDesc, SpectrumDesc, WhittedDesc,
};
use math::Point3;
use scene::{Interfaces, Scene};

use crate::support::{assert_mean, at, compile, radiance, sphere, v, white_sky};

fn fog(sigma_a: f32, sigma_s: f32, le: f32) -> MediumKind {
    let coefficients =
        CoefficientsDesc::Given { sigma_a: sigma_a.into(), sigma_s: sigma_s.into(), scale: 1.0 };
    MediumKind::Homogeneous { coefficients, le: Some(SpectrumDesc::Constant(le)), le_scale: le }
}

fn medium(desc: &mut SceneDesc, kind: MediumKind, g: f32) -> Handle<MediumDesc> {
    desc.media.push(MediumDesc { name: "m".into(), kind, world_from_medium: Default::default(), g })
}

/// A ball of radius 1 of a medium around a point.
fn ball(desc: &mut SceneDesc, kind: MediumKind, g: f32, centre: Point3) {
    let inside = Some(medium(desc, kind, g));
    let material = Some(desc.materials.push(MaterialKind::Interface.into()));
    let medium_interface = Some(MediumInterface { inside, outside: None });
    desc.shapes.push(ShapeDesc { material, medium_interface, ..at(sphere(1.0), centre) });
}

fn vol_path(max_depth: u32) -> Path {
    Path::new(PathDesc { max_depth, ..PathDesc::default() }, Interfaces::Pass)
}

/// The radiance along a ray at a distance of 0.6 from the centre of a ball at the origin, of which
/// 1.6 lie in the ball.
fn past_the_centre(rays: &mut impl RayIntegrator, scene: &Scene, count: usize) -> testkit::Moments {
    radiance(rays, scene, v(0.6, -3.0, 0.0), v(0.0, 1.0, 0.0), count)
}

#[test]
fn absorption_is_beers_law() {
    let mut desc = SceneDesc::default();
    white_sky(&mut desc);
    ball(&mut desc, fog(0.7, 0.0, 0.0), 0.0, Point3::ZERO);
    let scene = compile(&desc);
    let expected = (-0.7f64 * 1.6).exp();
    assert_mean(&past_the_centre(&mut RayCasting, &scene, 10), expected, 1, "ray casting");
    assert_mean(&past_the_centre(&mut Whitted::default(), &scene, 10), expected, 1, "Whitted");
    assert_mean(&past_the_centre(&mut vol_path(5), &scene, 40_000), expected, 2, "vol-path");
    assert_mean(
        &past_the_centre(&mut Path::without_light_sampling(5), &scene, 40_000),
        expected,
        2,
        "simple-vol-path",
    );
}

#[test]
fn emission_saturates_with_depth() {
    let mut desc = SceneDesc::default();
    ball(&mut desc, fog(0.7, 0.0, 2.0), 0.0, Point3::ZERO);
    let scene = compile(&desc);
    let expected = 2.0 * (1.0 - (-0.7f64 * 1.6).exp());
    // The emission of a homogeneous medium is integrated, not sampled.
    assert_mean(&past_the_centre(&mut RayCasting, &scene, 10), expected, 1, "ray casting");
    assert_mean(
        &past_the_centre(&mut Whitted::new(WhittedDesc { max_depth: 0, ..Default::default() }), &scene, 10),
        expected,
        1,
        "Whitted",
    );
    assert_mean(&past_the_centre(&mut vol_path(0), &scene, 10), expected, 1, "vol-path");
}

#[test]
fn a_medium_that_does_not_absorb_is_invisible_in_a_furnace() {
    for g in [-0.5, 0.0, 0.8] {
        let mut desc = SceneDesc::default();
        white_sky(&mut desc);
        ball(&mut desc, fog(0.0, 2.0, 0.0), g, Point3::ZERO);
        let scene = compile(&desc);
        assert_mean(&past_the_centre(&mut vol_path(1000), &scene, 10_000), 1.0, 6, "vol-path");
        assert_mean(
            &past_the_centre(&mut Path::without_light_sampling(1000), &scene, 10_000),
            1.0,
            6,
            "simple-vol-path",
        );
    }
}

#[test]
fn single_scattering_of_a_point_light_is_the_integral_along_the_ray() {
    let (sigma_a, sigma_s, g) = (0.3f32, 0.5f32, 0.4f32);
    let mut desc = SceneDesc::default();
    ball(&mut desc, fog(sigma_a, sigma_s, 0.0), g, Point3::ZERO);
    let intensity = SpectrumDesc::Constant(1.0);
    desc.lights.push(LightKind::Point { intensity, power: None, from: Point3::ZERO }.into());
    let scene = compile(&desc);
    let sigma_t = f64::from(sigma_a + sigma_s);
    let phase = scattering::HenyeyGreenstein { g };
    const STEPS: u32 = 2000;
    let unshadowed = |is_attenuated: bool| -> f64 {
        let step = 1.6 / f64::from(STEPS);
        (0..STEPS)
            .map(|i| {
                let s = (f64::from(i) + 0.5) * step;
                let p = v(0.6, s as f32 - 0.8, 0.0);
                let distance = f64::from(p.length());
                let p_phase = f64::from(phase.p(v(0.0, -1.0, 0.0), -p.normalize()));
                let through = if is_attenuated { distance } else { 0.0 };
                (-sigma_t * (s + through)).exp() * f64::from(sigma_s) * p_phase / (distance * distance) * step
            })
            .sum()
    };
    let expected = unshadowed(true);
    assert_mean(&past_the_centre(&mut vol_path(1), &scene, 40_000), expected, 3, "vol-path");
    let whitted = &mut Whitted::new(WhittedDesc { max_depth: 1, ..Default::default() });
    assert_mean(&past_the_centre(whitted, &scene, 40_000), expected, 3, "Whitted");
    // Ray casting takes all lights as if nothing were in between.
    assert_mean(&past_the_centre(&mut RayCasting, &scene, 40_000), unshadowed(false), 3, "ray casting");
}

#[test]
fn no_light_comes_from_infinity_through_endless_fog() {
    let mut desc = SceneDesc::default();
    white_sky(&mut desc);
    desc.camera.medium = Some(medium(&mut desc, fog(0.1, 0.2, 0.0), 0.0));
    let resolution = [8, 8];
    desc.film.resolution = resolution;
    for integrator in [
        IntegratorDesc::VolPath(PathDesc::default()),
        IntegratorDesc::Bdpt(BdptDesc::default()),
        IntegratorDesc::Whitted(WhittedDesc::default()),
    ] {
        desc.integrator.value = integrator;
        let built = build(&desc).ok().unwrap().integrator;
        let session = crate::support::finished(&desc, built);
        let picture = session.state().film.develop().unwrap();
        assert!(picture.values().all(|value| value == 0.0), "{}", desc.integrator.name());
    }
}

#[test]
fn algorithms_that_leave_media_out_say_so() {
    let mut desc = SceneDesc::default();
    white_sky(&mut desc);
    ball(&mut desc, fog(1.0, 1.0, 0.0), 0.0, Point3::ZERO);
    let warnings = |desc: &SceneDesc| build(desc).ok().unwrap().warnings;
    for integrator in [
        IntegratorDesc::Path(PathDesc::default()),
        IntegratorDesc::AmbientOcclusion(AmbientOcclusionDesc::default()),
        IntegratorDesc::Radiosity(RadiosityDesc::default()),
    ] {
        desc.integrator.value = integrator;
        let name = desc.integrator.name();
        let found = warnings(&desc);
        assert_eq!(found.len(), 1);
        assert_eq!(
            found[0].message,
            format!("integrator `{name}` does not know participating media; left out")
        );
    }
    for integrator in [
        IntegratorDesc::VolPath(PathDesc::default()),
        IntegratorDesc::SimpleVolPath(SimpleVolPathDesc::default()),
        IntegratorDesc::Bdpt(BdptDesc::default()),
    ] {
        desc.integrator.value = integrator;
        assert!(warnings(&desc).is_empty());
    }
}
