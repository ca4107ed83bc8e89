//! Layers of parts of the light: by first event, by the number of events, and by groups of lights.

use alhazen_integrators::build;
use description::{
    BdptDesc, CoatedDiffuseDesc, CoefficientsDesc, Handle, InfiniteRadiance, IntegratorDesc, LightDesc,
    LightKind, MaterialDesc, MaterialKind, MediumDesc, MediumInterface, MediumKind, OpenPbrDesc, PathDesc,
    RoughnessDesc, SamplerDesc, SamplerKind, SceneDesc, ShapeDesc, Span, Spanned, SubsurfaceScattering,
    VcmDesc,
};
use film::Layer;
use image::{Format, Image, ReadOptions, WriteOptions, encode, read};
use scattering::SubsurfaceMethod;
use testkit::{Moments, t_test};

use crate::support::{at, diffuse, emission, finished, glass, mirror, quad, sphere, v};

const SIDE: u32 = 24;
const BY_EVENT: [&str; 5] = ["diffuse", "specular", "transmission", "volume", "emission"];
const BY_LENGTH: [&str; 2] = ["direct", "indirect"];
const BY_GROUP: [&str; 3] = ["lights.default", "lights.sky", "lights.lamp"];

fn settings(integrator: IntegratorDesc, samples: u32, seed: i32) -> SceneDesc {
    let parts = Layer::OF_PATHS.into_iter().chain([Layer::LightGroups]);
    let mut desc = SceneDesc::default();
    desc.film.resolution = [SIDE as i32; 2];
    desc.film.save_fp16 = false;
    desc.film.layers = parts.map(|layer| Spanned::new(layer.name().into(), Span::NONE)).collect();
    let kind = SamplerKind::Independent { pixel_samples: samples };
    desc.sampler.value = SamplerDesc { kind, seed: Some(seed) };
    desc.integrator.value = integrator;
    desc
}

fn path(max_depth: u32) -> IntegratorDesc {
    IntegratorDesc::Path(PathDesc { max_depth, ..PathDesc::default() })
}

fn vol_path(max_depth: u32) -> IntegratorDesc {
    IntegratorDesc::VolPath(PathDesc { max_depth, ..PathDesc::default() })
}

fn bdpt(max_depth: u32) -> IntegratorDesc {
    IntegratorDesc::Bdpt(BdptDesc { max_depth, ..BdptDesc::default() })
}

fn vcm(max_depth: u32) -> IntegratorDesc {
    IntegratorDesc::Vcm(VcmDesc { max_depth, ..VcmDesc::default() })
}

fn sky(desc: &mut SceneDesc) {
    let radiance = InfiniteRadiance::Constant(1.0.into());
    let kind = LightKind::Infinite { radiance, illuminance: None, portal: None };
    desc.lights.push(LightDesc { group: Some("sky".into()), ..kind.into() });
}

fn lamp(desc: &mut SceneDesc) {
    let light = emission(desc, 8.0).unwrap();
    desc.area_lights[light].group = Some("lamp".into());
    let shape = quad(v(-2.0, 2.5, 3.0), v(2.0, 0.0, 0.0), v(0.0, 0.0, 2.0));
    desc.shapes.push(ShapeDesc { area_light: Some(light), ..shape.into() });
}

fn wall(desc: &mut SceneDesc, material: Option<Handle<MaterialDesc>>) {
    let wall = quad(v(-9.0, -9.0, 4.0), v(0.0, 18.0, 0.0), v(18.0, 0.0, 0.0));
    desc.shapes.push(ShapeDesc { material, ..wall.into() });
}

/// A ball of a medium that scatters and emits, and which may fill the whole picture.
fn fog(desc: &mut SceneDesc, radius: f32) {
    let coefficients = CoefficientsDesc::Given { sigma_a: 0.1.into(), sigma_s: 1.0.into(), scale: 1.0 };
    let kind = MediumKind::Homogeneous { coefficients, le: Some(0.2.into()), le_scale: 1.0 };
    let medium = MediumDesc { name: "fog".into(), kind, world_from_medium: Default::default(), g: 0.3 };
    let inside = Some(desc.media.push(medium));
    let medium_interface = Some(MediumInterface { inside, outside: None });
    let material = Some(desc.materials.push(MaterialKind::Interface.into()));
    desc.shapes.push(ShapeDesc { material, medium_interface, ..at(sphere(radius), v(0.5, 0.5, 2.5)) });
}

fn skin() -> MaterialKind {
    let scattering = SubsurfaceScattering::Reflectance { reflectance: 0.6.into(), mfp: 0.3.into() };
    let (roughness, method) = (RoughnessDesc::default(), SubsurfaceMethod::Diffusion);
    MaterialKind::Subsurface { scattering, scale: 1.0, eta: 1.33, g: 0.0, roughness, method }
}

/// Something of everything, lit by a sky and a lamp.
fn still_life(desc: &mut SceneDesc) {
    let coated = MaterialKind::CoatedDiffuse(CoatedDiffuseDesc::default());
    let coated = Some(desc.materials.push(coated.into()));
    wall(desc, coated);
    let openpbr = MaterialKind::OpenPbr(OpenPbrDesc::default().into());
    let skin = skin();
    let [openpbr, skin] = [openpbr, skin].map(|kind| Some(desc.materials.push(kind.into())));
    let (glass, mirror) = (glass(desc), mirror(desc, 0.2));
    for (material, p) in [
        (glass, v(-1.0, -1.0, 4.0)),
        (mirror, v(1.0, -1.0, 4.0)),
        (openpbr, v(-1.2, 1.0, 4.0)),
        (skin, v(0.0, 0.0, 3.5)),
    ] {
        desc.shapes.push(ShapeDesc { material, ..at(sphere(0.8), p) });
    }
}

fn rendered(desc: &SceneDesc) -> Image {
    let film = finished(desc, build(desc).unwrap().integrator).into_state().film;
    let bytes = encode(&film.development(), Format::Exr, &WriteOptions::default()).unwrap();
    read(&bytes, "", &ReadOptions::default()).unwrap()
}

/// Red, green and blue of a part at a pixel; of the whole for an empty name.
fn rgb(image: &Image, part: &str, [x, y]: [u32; 2]) -> [f32; 3] {
    ["R", "G", "B"].map(|c| {
        let name = if part.is_empty() { c.to_owned() } else { format!("{part}.{c}") };
        image.channel(x, y, image.channel_index(&name).unwrap())
    })
}

fn pixels() -> impl Iterator<Item = [u32; 2]> {
    (0..SIDE * SIDE).map(|i| [i % SIDE, i / SIDE])
}

/// The mean luminance-like value of a part over the picture.
fn mean(image: &Image, part: &str) -> f64 {
    let sum: f32 = pixels().map(|pixel| rgb(image, part, pixel)[1]).sum();
    f64::from(sum) / f64::from(SIDE * SIDE)
}

#[test]
fn parts_sum_to_the_picture() {
    let [bdpt, vcm] = [bdpt(5), vcm(5)].map(|both| [(both.clone(), true), (both, false)]);
    let others = [(path(5), false), (vol_path(5), true), (vol_path(5), false)];
    for (integrator, in_fog) in others.into_iter().chain(bdpt).chain(vcm) {
        let mut desc = settings(integrator, 16, 1);
        still_life(&mut desc);
        sky(&mut desc);
        lamp(&mut desc);
        if in_fog {
            fog(&mut desc, 0.9);
        }
        let image = rendered(&desc);
        for parts in [&BY_EVENT[..], &BY_LENGTH, &BY_GROUP] {
            for pixel in pixels() {
                let whole = rgb(&image, "", pixel);
                for c in 0..3 {
                    let sum: f32 = parts.iter().map(|part| rgb(&image, part, pixel)[c]).sum();
                    let error = (sum - whole[c]).abs();
                    assert!(error < 1e-4 * whole[c].max(0.1), "{parts:?} at {pixel:?}: {error} of {whole:?}");
                }
            }
        }
        let parts = BY_EVENT.into_iter().chain(BY_LENGTH).chain(BY_GROUP);
        let missing: Vec<_> = parts.filter(|part| mean(&image, part) < 1e-4).collect();
        let expected = if in_fog { &[][..] } else { &["volume", "lights.default"] };
        assert_eq!(missing, expected);
    }
}

#[test]
fn the_light_of_a_group_is_that_of_the_scene_with_this_group_alone() {
    [vol_path(4), bdpt(4), vcm(4)].into_iter().for_each(check_groups);
}

fn check_groups(integrator: IntegratorDesc) {
    let scene = |seed, lights: &[fn(&mut SceneDesc)]| {
        let mut desc = settings(integrator.clone(), 64, seed);
        still_life(&mut desc);
        fog(&mut desc, 0.9);
        // The medium emits, which belongs to neither group.
        lights.iter().for_each(|light| light(&mut desc));
        rendered(&desc)
    };
    let both = scene(1, &[sky, lamp]);
    for (i, (group, light)) in
        [("lights.sky", sky as fn(&mut _)), ("lights.lamp", lamp)].into_iter().enumerate()
    {
        let alone = scene(2 + i as i32, &[light]);
        let difference = |pixel| f64::from(rgb(&both, group, pixel)[1] - rgb(&alone, group, pixel)[1]);
        let moments: Moments = pixels().map(difference).collect();
        t_test(&moments, 0.0, 2).unwrap_or_else(|error| panic!("{group}: {error}"));
    }
}

#[test]
fn paths_from_both_ends_have_the_parts_of_paths_from_the_camera() {
    let scene = |integrator, seed| {
        let mut desc = settings(integrator, 64, seed);
        still_life(&mut desc);
        sky(&mut desc);
        lamp(&mut desc);
        fog(&mut desc, 0.9);
        rendered(&desc)
    };
    let (from_camera, from_both) = (scene(vol_path(4), 1), scene(bdpt(4), 2));
    let parts = BY_EVENT.into_iter().chain(BY_LENGTH).chain(BY_GROUP);
    for part in parts {
        let difference =
            |pixel| f64::from(rgb(&from_both, part, pixel)[1] - rgb(&from_camera, part, pixel)[1]);
        let moments: Moments = pixels().map(difference).collect();
        t_test(&moments, 0.0, 10).unwrap_or_else(|error| panic!("{part}: {error}"));
    }
}

/// The part of the light that there is beside those of zero, each within a tolerance.
fn expect(image: &Image, expected: &[(&str, f64)], what: &str) {
    for part in BY_EVENT.into_iter().chain(BY_LENGTH) {
        let expected = expected.iter().find(|(name, _)| *name == part).map_or(0.0, |(_, value)| *value);
        let found = mean(image, part);
        assert!((found - expected).abs() <= 0.03 * expected, "{what}: {part} is {found}, not {expected}");
    }
}

#[test]
fn events_are_told_apart() {
    check_events(path, vol_path);
    check_events(bdpt, bdpt);
    check_events(vcm, vcm);
}

fn check_events(integrator: fn(u32) -> IntegratorDesc, in_media: fn(u32) -> IntegratorDesc) {
    // White has this value in the film's units.
    let mut empty = settings(integrator(1), 64, 1);
    sky(&mut empty);
    let white = mean(&rendered(&empty), "");
    expect(&rendered(&empty), &[("emission", white), ("direct", white)], "the sky");
    let before_a_wall = |make: &dyn Fn(&mut SceneDesc) -> Option<Handle<MaterialDesc>>| {
        let mut desc = settings(integrator(5), 64, 1);
        sky(&mut desc);
        let material = make(&mut desc);
        wall(&mut desc, material);
        rendered(&desc)
    };
    let plaster = before_a_wall(&|desc| diffuse(desc, 0.5));
    expect(&plaster, &[("diffuse", 0.5 * white), ("direct", 0.5 * white)], "plaster");
    for roughness in [0.0, 0.3] {
        let metal = before_a_wall(&|desc| mirror(desc, roughness));
        let all = mean(&metal, "");

        assert!(all > 0.5 * white, "{all} of {white}");
        expect(&metal, &[("specular", all), ("direct", all)], "metal");
    }
    let pane = before_a_wall(&|desc| {
        Some(desc.materials.push(MaterialKind::ThinDielectric { eta: 1.5.into() }.into()))
    });
    let mirrored = mean(&pane, "specular");
    assert!((0.07..0.11).contains(&(mirrored / white)), "a pane mirrors 8 %, not {mirrored}");
    expect(
        &pane,
        &[("specular", mirrored), ("transmission", white - mirrored), ("direct", white)],
        "a pane of glass",
    );
    // The facets of a surface mirror the same, whatever is below them.
    let [black, grey] = [0.0, 0.8].map(|reflectance: f32| {
        let roughness = RoughnessDesc::isotropic(0.3);
        let coated =
            CoatedDiffuseDesc { reflectance: reflectance.into(), roughness, ..CoatedDiffuseDesc::default() };
        let image = before_a_wall(&|desc| {
            Some(desc.materials.push(MaterialKind::CoatedDiffuse(coated.clone()).into()))
        });
        (mean(&image, "specular"), mean(&image, "diffuse"))
    });
    assert!(black.1 < 1e-3 * white && grey.1 > 0.3 * white, "diffuse: {black:?} {grey:?}");
    assert!((black.0 - grey.0).abs() < 0.03 * black.0, "specular: {black:?} {grey:?}");
    // Within a fog there is nothing else.
    let mut foggy = settings(in_media(1), 64, 1);
    sky(&mut foggy);
    fog(&mut foggy, 90.0);
    foggy.camera.medium = foggy.media.iter().map(|(handle, _)| handle).next();
    let image = rendered(&foggy);
    let parts = ["diffuse", "specular", "transmission"].map(|part| mean(&image, part));
    assert_eq!(parts, [0.0; 3]);
    assert!(mean(&image, "volume") > 0.0 && mean(&image, "emission") > 0.0);
}

#[test]
fn algorithms_without_parts_refuse_their_layers() {
    let mut desc = settings(IntegratorDesc::RayCasting, 1, 1);
    sky(&mut desc);
    let errors = build(&desc).map(|_| ()).unwrap_err();
    assert_eq!(errors.len(), 8);
    assert!(
        errors[0].message.contains("`ray-casting` does not make the layer `diffuse`"),
        "{}",
        errors[0].message
    );
}
