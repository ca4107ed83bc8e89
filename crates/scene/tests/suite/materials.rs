//! The BSDF of every material, and the footprint of a pixel.

use crate::common::*;
use alhazen_scene::{Interfaces, Scene, SurfaceInteraction, View};
use description::{
    CameraDesc, CameraKind, ConductorDesc, ConductorReflectance, Handle, LensDesc, MaterialDesc,
    MaterialKind, RoughnessDesc, SceneDesc, ScreenDesc, ShapeDesc, ShapeKind, SpectrumDesc, TextureDesc,
    TextureKind, TransformDesc, UvImageDesc, WrapMode,
};
use math::{DMat4, DVec3, Frame, Ray, RayDifferential, Vec2, Vec3, Vector3};
use sampling::Sampler;
use sampling::sampler::Independent;
use scattering::{
    Bsdf, BsdfSample, Bxdf, BxdfFlags, Directions, TransportMode, TrowbridgeReitz, reflect, refract,
};
use spectrum::SampledWavelengths;
use testkit::{Moments, Random, t_test};

/// A floor at z = −5 of one material, seen from above.
fn floor(material: impl FnOnce(&mut SceneDesc) -> MaterialDesc) -> SceneDesc {
    let mut desc = SceneDesc::default();
    let material = material(&mut desc);
    let material = Some(desc.materials.push(material));
    desc.shapes.push(ShapeDesc { material, ..disk(-5.0, 100.0).into() });
    desc
}

fn down(x: f32, y: f32) -> Ray {
    ray(Vec3::new(x, y, 0.0), -Vec3::Z)
}

fn bsdf_at<'a>(
    scene: &'a Scene,
    ray: Ray,
    lambda: &mut SampledWavelengths,
) -> (SurfaceInteraction, Option<Bsdf<Bxdf<'a>>>) {
    let mut surface = hit(scene, &ray).expect("a surface");
    let mut sampler = Sampler::Independent(Independent::new(1, 0));
    let bsdf = scene.bsdf(&view(&SceneDesc::default()), &mut surface, &ray.into(), lambda, &mut sampler);
    (surface, bsdf)
}

/// The BxDF of a floor of this material, and whether the secondary wavelengths are terminated.
fn bxdf(kind: MaterialKind) -> (Option<Bxdf<'static>>, bool) {
    // It may refer to tables of the scene.
    let scene = Box::leak(Box::new(scene(&floor(|_| kind.into()))));
    let mut lambda = lambda();
    let (_, bsdf) = bsdf_at(scene, down(0.3, 0.2), &mut lambda);
    (bsdf.map(|bsdf| bsdf.bxdf), lambda.secondary_terminated())
}

fn named(name: &str) -> SpectrumDesc {
    SpectrumDesc::Named(name.into())
}

#[test]
fn diffuse_has_its_reflectance() {
    let (Some(Bxdf::Diffuse(diffuse)), false) = bxdf(MaterialKind::Diffuse { reflectance: 0.4.into() })
    else {
        panic!()
    };
    assert_eq!(diffuse.reflectance.0, [0.4; 4]);
    let too_bright = MaterialKind::Diffuse { reflectance: 1.7.into() };
    let (Some(Bxdf::Diffuse(diffuse)), _) = bxdf(too_bright) else { panic!() };
    assert_eq!(diffuse.reflectance.0, [1.0; 4]);
}

#[test]
fn diffuse_transmission_scales_both_parts() {
    let material =
        MaterialKind::DiffuseTransmission { reflectance: 0.2.into(), transmittance: 0.6.into(), scale: 0.5 };
    let (Some(Bxdf::DiffuseTransmission(bxdf)), false) = bxdf(material) else { panic!() };
    assert_eq!((bxdf.reflectance.0, bxdf.transmittance.0), ([0.1; 4], [0.3; 4]));
}

#[test]
fn conductors_by_index_or_reflectance() {
    let roughness = RoughnessDesc { u: 0.25.into(), v: 0.09.into(), remap: true };
    let copper = ConductorDesc { roughness: roughness.clone(), ..ConductorDesc::default() };
    let (Some(Bxdf::Conductor(bxdf_of_copper)), false) = bxdf(MaterialKind::Conductor(copper)) else {
        panic!()
    };
    let eta = spectrum::named("metal-Cu-eta").unwrap().sample(&lambda());
    let k = spectrum::named("metal-Cu-k").unwrap().sample(&lambda());
    assert_eq!((bxdf_of_copper.eta, bxdf_of_copper.k), (eta, k));
    assert_eq!(bxdf_of_copper.distribution, TrowbridgeReitz::new(0.5, 0.3));

    // At normal incidence, η = 1 and k reflect k²/(4 + k²).
    let roughness = RoughnessDesc { remap: false, ..roughness };
    let coloured = ConductorDesc { reflectance: ConductorReflectance::Reflectance(0.7.into()), roughness };
    let (Some(Bxdf::Conductor(bxdf)), false) = bxdf(MaterialKind::Conductor(coloured)) else { panic!() };
    let k2 = bxdf.k[0] * bxdf.k[0];
    assert!(bxdf.eta[0] == 1.0 && (k2 / (4.0 + k2) - 0.7).abs() < 1e-5);
    assert_eq!(bxdf.distribution, TrowbridgeReitz::new(0.25, 0.09));
}

#[test]
fn dispersion_terminates_secondary_wavelengths() {
    let glass = |eta: SpectrumDesc| MaterialKind::Dielectric { eta, roughness: RoughnessDesc::default() };
    let (Some(Bxdf::Dielectric(plain)), false) = bxdf(glass(1.5.into())) else { panic!() };
    assert!(plain.eta == 1.5 && plain.distribution.effectively_smooth());
    let first = spectrum::named("glass-BK7").unwrap().at(lambda().lambda()[0]);
    let (Some(Bxdf::Dielectric(dispersive)), true) = bxdf(glass(named("glass-BK7"))) else { panic!() };
    assert_eq!(dispersive.eta, first);

    let pane = |eta: SpectrumDesc| MaterialKind::ThinDielectric { eta };
    let (Some(Bxdf::ThinDielectric(plain)), false) = bxdf(pane(1.3.into())) else { panic!() };
    assert_eq!(plain.eta, 1.3);
    let (Some(Bxdf::ThinDielectric(dispersive)), true) = bxdf(pane(named("glass-BK7"))) else { panic!() };
    assert_eq!(dispersive.eta, first);

    // Outside the range of its table the index is invalid.
    let blue_only = SpectrumDesc::Samples([(360.0, 1.5), (361.0, 1.5)].into());
    let (Some(Bxdf::Dielectric(nothing)), true) = bxdf(glass(blue_only)) else { panic!() };
    assert_eq!(nothing.eta, 1.0);
}

#[test]
fn an_interface_does_not_scatter_and_occludes_only_on_request() {
    let scene = scene(&floor(|_| MaterialKind::Interface.into()));
    assert!(bsdf_at(&scene, down(0.0, 0.0), &mut lambda()).1.is_none());
    for (interfaces, stops) in [(Interfaces::Pass, false), (Interfaces::Stop, true)] {
        let ray = down(0.0, 0.0);
        assert_eq!(scene.occluded(&ray, f32::INFINITY, interfaces, &mut Default::default()), stops);
    }
}

#[test]
fn mixes_have_their_proportions() {
    let black =
        |desc: &mut SceneDesc| desc.materials.push(MaterialKind::Diffuse { reflectance: 0.0.into() }.into());
    let white =
        |desc: &mut SceneDesc| desc.materials.push(MaterialKind::Diffuse { reflectance: 1.0.into() }.into());
    for amount in [0.0, 0.25, 0.8, 1.0] {
        let scene = scene(&floor(|desc| {
            let materials = [black(desc), white(desc)];
            let inner = desc.materials.push(MaterialKind::Mix { materials, amount: amount.into() }.into());
            // A mix of a mix.
            MaterialKind::Mix { materials: [inner, materials[0]], amount: 0.0.into() }.into()
        }));
        let mut random = Random::new(1);
        let reflectances: Moments = (0..10_000)
            .map(|_| {
                let ray = down(random.get_1d(), random.get_1d());
                let (_, Some(bsdf)) = bsdf_at(&scene, ray, &mut lambda()) else { panic!() };
                let Bxdf::Diffuse(diffuse) = bsdf.bxdf else { panic!() };
                let (_, Some(again)) = bsdf_at(&scene, ray, &mut lambda()) else { panic!() };
                assert!(matches!(again.bxdf, Bxdf::Diffuse(d) if d.reflectance == diffuse.reflectance));
                diffuse.reflectance[0] as f64
            })
            .collect();
        t_test(&reflectances, amount as f64, 4).unwrap();
    }
}

#[test]
fn a_mix_with_an_interface_passes_its_fraction_of_rays() {
    let scene = scene(&floor(|desc| {
        let materials = [MaterialKind::Diffuse { reflectance: 0.5.into() }, MaterialKind::Interface];
        let materials = materials.map(|kind| desc.materials.push(kind.into()));
        MaterialKind::Mix { materials, amount: 0.25.into() }.into()
    }));
    let mut random = Random::new(3);
    let stopped: Moments = (0..20_000)
        .map(|_| {
            let ray = down(random.get_1d(), random.get_1d());
            let stops = scene.occluded(&ray, f32::INFINITY, Interfaces::Pass, &mut Default::default());
            assert_eq!(
                stops,
                bsdf_at(&scene, ray, &mut lambda()).1.is_some(),
                "the alpha test of a ray is deterministic"
            );
            f64::from(u8::from(stops))
        })
        .collect();
    t_test(&stopped, 0.75, 1).unwrap();
}

#[test]
fn alpha_is_the_probability_of_a_hit() {
    let mut random = Random::new(2);
    for alpha in [0.0, 0.3, 0.9, 1.0, 2.0] {
        let mut desc = floor(|_| MaterialDesc::default());
        desc.shapes.iter_mut().for_each(|(_, shape)| shape.alpha = Some(alpha.into()));
        let scene = scene(&desc);
        let (mut met, mut stopped) = (Moments::default(), Moments::default());
        for _ in 0..20_000 {
            let ray = down(random.get_1d(), random.get_1d());
            let meets = hit(&scene, &ray).is_some();
            met.push(f64::from(u8::from(meets)));
            let stops = scene.occluded(&ray, f32::INFINITY, Interfaces::Stop, &mut Default::default());
            stopped.push(f64::from(u8::from(stops)));
            assert_eq!(meets, stops, "the alpha test of a ray is deterministic");
        }
        t_test(&met, alpha.min(1.0) as f64, 10).unwrap();
        t_test(&stopped, alpha.min(1.0) as f64, 10).unwrap();
    }
}

#[test]
fn alpha_textures_cut_out() {
    let mut desc = SceneDesc::default();
    let mapping = description::MappingDesc::Uv { scale: [2.0, 2.0], delta: [0.0; 2] };
    let textures = [1.0.into(), 0.0.into()];
    let kind = TextureKind::Checkerboard { textures, mapping: Some(mapping) };
    let texture: Handle<TextureDesc<f32>> = desc.float_textures.push(TextureDesc::new(kind));
    let shape = ShapeDesc { alpha: Some(texture.into()), ..rectangle([0.0, 0.0], [1.0, 1.0]).into() };
    desc.shapes.push(shape);
    let scene = scene(&desc);
    let there = |x, y| hit(&scene, &ray(Vec3::new(x, y, 1.0), -Vec3::Z)).is_some();
    assert!(there(0.2, 0.3) && there(0.7, 0.8) && !there(0.2, 0.8) && !there(0.6, 0.3));
}

fn mapped(rgb: [f32; 3]) -> (SurfaceInteraction, Frame) {
    let scene = scene(&floor(|desc| {
        let image = desc.images.push(rgb_image(2, 2, |_, _| rgb));
        MaterialDesc {
            normal_map: Some(UvImageDesc::new(image, WrapMode::Repeat)),
            ..MaterialDesc::default()
        }
    }));
    let (surface, bsdf) = bsdf_at(&scene, down(1.0, 0.0), &mut lambda());
    (surface, bsdf.expect("a diffuse surface").frame)
}

#[test]
fn a_flat_normal_map_changes_nothing() {
    let (surface, frame) = mapped([0.5, 0.5, 1.0]);
    let shading = surface.surface.shading;
    assert!((shading.n - surface.surface.n).length() < 1e-6);
    assert!((shading.dpdu - surface.surface.dpdu).length() < 1e-4 * surface.surface.dpdu.length());
    assert!((shading.dpdv - surface.surface.dpdv).length() < 1e-4 * surface.surface.dpdv.length());
    assert!((frame.z - surface.surface.n).length() < 1e-6);
}

#[test]
fn normal_maps_tilt_towards_their_tangents() {
    // Red leans along ∂p/∂u, green along z × ∂p/∂u, both by 45°.
    for (rgb, local) in [([1.0, 0.5, 1.0], Vec3::X), ([0.5, 1.0, 1.0], Vec3::Y), ([0.0, 0.5, 1.0], -Vec3::X)]
    {
        let (surface, frame) = mapped(rgb);
        let s = &surface.surface;
        let expected = Frame::from_z_and_x(s.n, s.dpdu).from_local((local + Vec3::Z).normalize());
        let shading = surface.surface.shading;
        assert!((shading.n - expected).length() < 1e-5, "{rgb:?}: {} {expected}", shading.n);
        assert!((frame.z - expected).length() < 1e-5);
        assert!((shading.dpdu.length() / s.dpdu.length() - 1.0).abs() < 1e-4);
        assert!(shading.dpdu.dot(shading.n).abs() < 1e-4 * shading.dpdu.length());
    }
}

/// A camera at the origin that looks along +z, with small pixels.
fn observed(shapes: impl IntoIterator<Item = ShapeDesc>) -> (Scene, View) {
    let mut desc = SceneDesc::default();
    desc.film.resolution = [2000, 2000];
    desc.options.disable_pixel_jitter = true;
    let kind =
        CameraKind::Perspective { fov: 60.0, screen: ScreenDesc::default(), lens: LensDesc::default() };
    desc.camera = CameraDesc { kind, ..CameraDesc::default() }.into();
    shapes.into_iter().for_each(|shape| {
        desc.shapes.push(shape);
    });
    (scene(&desc), view(&desc))
}

fn placed(kind: ShapeKind, z: f64, turn: f64) -> ShapeDesc {
    let turn = DMat4::from_axis_angle(DVec3::new(1.0, 0.6, 0.0).normalize(), turn);
    let world_from_object = TransformDesc::fixed(DMat4::from_translation(DVec3::new(0.0, 0.0, z)) * turn);
    ShapeDesc { world_from_object, ..kind.into() }
}

fn through(view: &View, x: f32, y: f32) -> RayDifferential {
    let film = Vec2::new(x, y);
    let sample =
        alhazen_scene::camera::CameraSample { film, lens: Vec2::splat(0.5), time: 0.0, filter_weight: 1.0 };
    view.camera.generate_ray_differential(&sample).expect("a ray").ray
}

fn met((scene, view): &(Scene, View), ray: &RayDifferential) -> SurfaceInteraction {
    let mut surface = hit(scene, &ray.ray).expect("a surface");
    surface.compute_footprint(ray, view);
    surface
}

const FILM: [[f32; 2]; 3] = [[1000.0, 1000.0], [930.0, 1040.0], [1020.0, 890.0]];

fn assert_near(a: Vector3, b: Vector3, tolerance: f32) {
    assert!((a - b).length() <= tolerance * b.length(), "{a} {b}");
}

#[test]
fn footprints_equal_distances_of_neighbouring_hits() {
    for shape in [placed(rectangle([-9.0, -9.0], [9.0, 9.0]), 5.0, 0.7), placed(sphere(1.0), 4.0, 0.3)] {
        let observed = observed([shape]);
        for [x, y] in FILM {
            let at = |x, y| met(&observed, &through(&observed.1, x, y));
            let (here, right, below) = (at(x, y), at(x + 1.0, y), at(x, y + 1.0));
            let f = here.footprint;
            assert_near(f.dpdx, right.p() - here.p(), 0.02);
            assert_near(f.dpdy, below.p() - here.p(), 0.02);
            let size = Vec2::new(f.dudx, f.dvdx).length() + Vec2::new(f.dudy, f.dvdy).length();
            for (uv, duv) in [(right, [f.dudx, f.dvdx]), (below, [f.dudy, f.dvdy])] {
                let difference = uv.surface.uv - here.surface.uv;
                assert!((difference - Vec2::from(duv)).length() < 0.03 * size, "{difference} {duv:?}");
            }
        }
    }
}

#[test]
fn footprints_without_differentials_are_those_of_the_camera() {
    let observed = observed([placed(rectangle([-9.0, -9.0], [9.0, 9.0]), 5.0, 0.3)]);
    let with = through(&observed.1, 1000.0, 1000.0);
    let seen = met(&observed, &with).footprint;
    let guessed = met(&observed, &with.ray.into()).footprint;
    // The minimum over the film: at most that of the centre, and not much less.
    let ratio = guessed.dpdx.length() / seen.dpdx.length();
    assert!(ratio > 0.5 && ratio < 1.05, "{ratio}");
}

/// Traces a ray over one smooth surface to the next; returns the footprint there and the exact
/// distances.
fn after_scattering(
    observed: &(Scene, View),
    film: [f32; 2],
    scatter: impl Fn(Vector3, &SurfaceInteraction) -> BsdfSample,
) -> [[Vector3; 2]; 2] {
    let follow = |x, y| {
        let ray = through(&observed.1, x, y);
        let first = met(observed, &ray);
        let sample = scatter(first.surface.wo, &first);
        met(observed, &first.spawn_scattered(&ray, &sample))
    };
    let [x, y] = film;
    let (here, right, below) = (follow(x, y), follow(x + 1.0, y), follow(x, y + 1.0));
    [[here.footprint.dpdx, here.footprint.dpdy], [right.p() - here.p(), below.p() - here.p()]]
}

fn specular(wi: Vector3, lobe: BxdfFlags) -> BsdfSample {
    BsdfSample::new(spectrum::SampledSpectrum::ONE, wi, 1.0, lobe)
}

#[test]
fn differentials_follow_mirrors() {
    let behind = || placed(rectangle([-90.0, -90.0], [90.0, 90.0]), -6.0, 0.2);
    for mirror in [placed(rectangle([-9.0, -9.0], [9.0, 9.0]), 5.0, 0.4), placed(sphere(1.0), 4.0, 0.3)] {
        let observed = observed([mirror, behind()]);
        for film in FILM {
            let [claimed, true_distances] = after_scattering(&observed, film, |wo, surface| {
                let wi = reflect(wo, surface.surface.shading.n);
                specular(wi, BxdfFlags::SPECULAR | BxdfFlags::REFLECTION)
            });
            for (a, b) in claimed.into_iter().zip(true_distances) {
                assert_near(a, b, 0.05);
            }
        }
    }
}

#[test]
fn differentials_follow_refractions() {
    let behind = || placed(rectangle([-90.0, -90.0], [90.0, 90.0]), 9.0, 0.2);
    for body in [placed(rectangle([-9.0, -9.0], [9.0, 9.0]), 5.0, 0.4), placed(sphere(1.0), 4.0, 0.3)] {
        let observed = observed([body, behind()]);
        for film in FILM {
            let [claimed, true_distances] = after_scattering(&observed, film, |wo, surface| {
                let n = surface.surface.shading.n;
                let n = if wo.dot(n) < 0.0 { -n } else { n };
                let (wi, eta, _) = refract(wo, n, 1.5);
                let mut sample = specular(wi, BxdfFlags::SPECULAR | BxdfFlags::TRANSMISSION);
                sample.eta = eta;
                sample
            });
            for (a, b) in claimed.into_iter().zip(true_distances) {
                assert_near(a, b, 0.05);
            }
        }
    }
}

#[test]
fn rough_scattering_drops_differentials() {
    let observed = observed([placed(rectangle([-9.0, -9.0], [9.0, 9.0]), 5.0, 0.4)]);
    let ray = through(&observed.1, 1000.0, 1000.0);
    let mut surface = met(&observed, &ray);
    let mut sampler = Sampler::Independent(Independent::new(1, 0));
    let bsdf = observed.0.bsdf(&observed.1, &mut surface, &ray, &mut lambda(), &mut sampler).unwrap();
    let wo = surface.surface.wo;
    let sample = bsdf.sample_f(wo, 0.5, Vec2::splat(0.3), TransportMode::Radiance, Directions::All).unwrap();
    assert!(surface.spawn_scattered(&ray, &sample).differentials.is_none());
}

#[test]
fn all_materials_can_be_forced_diffuse() {
    let mut desc = floor(|_| MaterialKind::Conductor(ConductorDesc::default()).into());
    desc.options.force_diffuse = true;
    let scene = scene(&desc);
    let mut surface = hit(&scene, &down(0.0, 0.0)).expect("a surface");
    let (ray, mut sampler) = (down(0.0, 0.0).into(), Sampler::Independent(Independent::new(1, 0)));
    let bsdf = scene.bsdf(&view(&desc), &mut surface, &ray, &mut lambda(), &mut sampler);
    let Bxdf::Diffuse(diffuse) = bsdf.unwrap().bxdf else { panic!() };
    assert!(diffuse.reflectance.min_component() > 0.3);
}
