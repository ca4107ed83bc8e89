//! Compilation of materials: errors and warnings.

use super::{check, stated, with, with_parameter};
use crate::common::*;
use alhazen_scene::material::{Material, MaterialId};
use alhazen_scene::{Scene, compile};
use description::{
    AreaLightDesc, ConductorDesc, MaterialDesc, MaterialKind, OpenPbrDesc, RoughnessDesc, Severity,
    ShapeDesc, SpectrumDesc, SubsurfaceScattering,
};
use scattering::SubsurfaceMethod;

#[test]
fn a_mix_of_itself_is_an_error() {
    let desc = with(|desc| {
        let other = desc.materials.push(MaterialDesc::default());
        let itself = description::Handle::new(1);
        let kind = MaterialKind::Mix { materials: [other, itself], amount: 0.5.into() };
        desc.materials.push_stated(stated(MaterialDesc { name: "loop".into(), ..kind.into() }, 7));
    });
    check(&desc, Severity::Error, "material-cycle", "material `loop` is a mix of itself", 7);
}

#[test]
fn geometries_refer_to_materials_and_these_to_textures() {
    let desc = with(|desc| {
        let gray = |value: f32| MaterialKind::Diffuse { reflectance: value.into() };
        let parts = [0.25, 0.75].map(|value| desc.materials.push(gray(value).into()));
        let mix = MaterialKind::Mix { materials: parts, amount: 0.5.into() };
        let material = Some(desc.materials.push(mix.into()));
        desc.shapes.push(ShapeDesc { material, ..sphere(1.0).into() });
        desc.shapes.push(sphere(2.0).into());
    });
    let scene = compile(desc).unwrap().scene;
    let reflectance = |scene: &Scene, id: MaterialId| {
        let Material::Diffuse(diffuse) = &scene.materials()[id.0 as usize].material else { panic!("{id:?}") };
        scene.textures().spectrum(diffuse.reflectance, &Default::default(), &lambda())[0]
    };
    let [first, second] = [0, 1].map(|index| scene.geometries()[index].material);
    let Material::Mix(mix) = &scene.materials()[first.0 as usize].material else { panic!("{first:?}") };
    assert_eq!(mix.materials.map(|part| reflectance(&scene, part)), [0.25, 0.75]);
    assert_eq!(second.0 as usize, scene.materials().len() - 1);
    assert_eq!(reflectance(&scene, second), 0.5);
}

#[test]
fn invalid_materials_are_errors() {
    let material = |kind: MaterialKind, name| {
        with(|desc| {
            desc.materials.push_stated(with_parameter(kind.into(), name, 4));
        })
    };
    let message = "an index of refraction must be above 0";
    for eta in [
        0.0.into(),
        SpectrumDesc::from(-1.5),
        SpectrumDesc::rgb(0.0, 0.0, 0.0),
        SpectrumDesc::Samples([(400.0, 1.5), (700.0, 0.0)].into()),
    ] {
        let roughness = RoughnessDesc::default();
        let glass = MaterialKind::Dielectric { eta: eta.clone(), roughness };
        check(&material(glass, "eta"), Severity::Error, "invalid-value", message, 4);
        let thin = MaterialKind::ThinDielectric { eta };
        check(&material(thin, "eta"), Severity::Error, "invalid-value", message, 4);
    }
    let rough = |value: f32| {
        let roughness = RoughnessDesc { u: value.into(), v: 0.5.into(), remap: true };
        MaterialKind::Conductor(ConductorDesc { roughness, ..ConductorDesc::default() })
    };
    let message = "roughness cannot be negative, as -0.1 is";
    for name in ["roughness", "uroughness"] {
        check(&material(rough(-0.1), name), Severity::Error, "invalid-value", message, 4);
    }
    let message = "roughness goes from 0 to 1; 2 is rougher than that";
    check(&material(rough(2.0), "uroughness"), Severity::Warning, "roughness-range", message, 4);
    let leaf = |scale| MaterialKind::DiffuseTransmission {
        reflectance: 0.25.into(),
        transmittance: 0.25.into(),
        scale,
    };
    let message = "a reflectance cannot be scaled by NaN";
    check(&material(leaf(f32::NAN), "scale"), Severity::Error, "invalid-value", message, 4);
    let message = "the values of a spectrum must be at most 1e30";
    let bright = MaterialKind::Diffuse { reflectance: SpectrumDesc::Constant(1e35).into() };
    check(&material(bright, "reflectance"), Severity::Error, "invalid-value", message, 4);
}

#[test]
fn an_interface_does_not_emit() {
    let desc = with(|desc| {
        let area_light = Some(desc.area_lights.push(AreaLightDesc::new(1.0.into())));
        let material = Some(desc.materials.push(MaterialKind::Interface.into()));
        desc.shapes.push_stated(stated(ShapeDesc { area_light, material, ..sphere(1.0).into() }, 2));
    });
    check(&desc, Severity::Warning, "light-ignored", "a shape of material `interface` does not emit", 2);
    assert!(compile(desc).unwrap().scene.lights().is_empty());
}

#[test]
fn wrong_values_of_principled_materials_are_errors() {
    let material = |change: &dyn Fn(&mut OpenPbrDesc), name| {
        let mut openpbr = OpenPbrDesc::default();
        change(&mut openpbr);
        let kind = MaterialKind::OpenPbr(Box::new(openpbr));
        with(|desc| desc.materials.push_stated(with_parameter(kind.into(), name, 4)))
    };
    let number = |name: &str| OpenPbrDesc::number(name).unwrap();
    for (name, value, message) in [
        ("base_metalness", 1.5, "`base_metalness` lies between 0 and 1, as 1.5 does not"),
        ("specular_ior", 0.7, "`specular_ior` lies between 1 and 3, as 0.7 does not"),
        ("thin_film_thickness", -0.2, "`thin_film_thickness` cannot be negative, as -0.2 is"),
    ] {
        let desc = material(&|desc| desc.numbers[number(name)] = value.into(), name);
        check(&desc, Severity::Error, "invalid-value", message, 4);
    }
    let message = "a luminance is finite and not negative, as -1 is not";
    let desc = material(&|desc| desc.emission_luminance = -1.0, "emission_luminance");
    check(&desc, Severity::Error, "invalid-value", message, 4);
}

/// Shapes without an area light emit what their material does, those with one what it does.
#[test]
fn principled_materials_emit() {
    let desc = with(|desc| {
        let openpbr = OpenPbrDesc { emission_luminance: 3.0, ..OpenPbrDesc::default() };
        let area_light = Some(desc.area_lights.push(AreaLightDesc::new(SpectrumDesc::Constant(2.0))));
        let material = Some(desc.materials.push(MaterialKind::OpenPbr(Box::new(openpbr)).into()));
        desc.shapes.push(ShapeDesc { material, ..sphere(1.0).into() });
        desc.shapes.push(ShapeDesc { material, area_light, ..sphere(2.0).into() });
        desc.shapes.push(sphere(3.0).into());
    });
    let scene = compile(desc).unwrap().scene;
    assert_eq!(scene.lights().len(), 2);
    let lights = [0, 1, 2].map(|index| scene.geometries()[index].first_light);
    assert!(lights[0].is_some() && lights[1].is_some() && lights[0] != lights[1] && lights[2].is_none());
}

#[test]
fn a_displacement_must_be_a_number() {
    let bumpy = MaterialDesc { displacement: Some(f32::NAN.into()), ..MaterialDesc::default() };
    let desc = with(|desc| desc.materials.push_stated(with_parameter(bumpy, "displacement", 6)));
    check(&desc, Severity::Error, "invalid-value", "NaN is not a valid value for a texture", 6);
}

fn subsurface(scattering: SubsurfaceScattering, [scale, eta, g]: [f32; 3]) -> MaterialKind {
    let (roughness, method) = (RoughnessDesc::default(), SubsurfaceMethod::Diffusion);
    MaterialKind::Subsurface { scattering, scale, eta, g, roughness, method }
}

#[test]
fn wrong_values_of_subsurface_materials_are_errors() {
    let white = || SubsurfaceScattering::Reflectance { reflectance: 1.0.into(), mfp: 1.0.into() };
    let potion = SubsurfaceScattering::Named("potion".into());
    for (scattering, numbers, name, message) in [
        (white(), [-1.0, 1.33, 0.0], "scale", "scattering cannot be scaled by -1"),
        (white(), [1.0, 0.0, 0.0], "eta", "an index of refraction must be finite and above 0, as 0 is not"),
        (white(), [1.0, 1.33, 1.0], "g", "an asymmetry lies between −1 and 1, as 1 does not"),
        (potion, [1.0, 1.33, 0.0], "name", "there is no measured substance `potion`"),
    ] {
        let material = with_parameter(subsurface(scattering, numbers).into(), name, 6);
        let desc = with(|desc| desc.materials.push_stated(material));
        check(&desc, Severity::Error, "invalid-value", message, 6);
    }
}

/// A substance is its coefficients; materials of one index of refraction share a table, whatever
/// the asymmetry that a substance is given.
#[test]
fn subsurface_materials_scatter_by_their_parameters() {
    let substance = description::Substance::named("Skin1").unwrap();
    let rgb = |[r, g, b]: [f32; 3]| SpectrumDesc::rgb(r, g, b).into();
    let given = SubsurfaceScattering::Coefficients {
        sigma_a: rgb(substance.sigma_a),
        sigma_s: rgb(substance.sigma_s),
    };
    let desc = with(|desc| {
        let named = SubsurfaceScattering::Named("Skin1".into());
        for kind in [subsurface(named, [2.0, 1.4, 0.5]), subsurface(given, [2.0, 1.4, 0.0])] {
            desc.materials.push(kind.into());
        }
        let reflectance = SubsurfaceScattering::Reflectance { reflectance: 0.4.into(), mfp: 0.25.into() };
        desc.materials.push(subsurface(reflectance, [2.0, 1.4, 0.0]).into());
    });
    let scene = compile(desc).unwrap().scene;
    let bodies: Vec<_> = scene.materials()[..3]
        .iter()
        .map(|entry| {
            let Material::Subsurface(body) = &entry.material else { panic!("{entry:?}") };
            body
        })
        .collect();
    assert!(bodies.iter().all(|body| std::sync::Arc::ptr_eq(&body.table, &bodies[0].table)));
    let [skin, same, grey] =
        [0, 1, 2].map(|i| bodies[i].bxdf(scene.textures(), &Default::default(), &lambda()).bssrdf);
    assert_eq!(skin.profiles().at(0.1), same.profiles().at(0.1));
    assert!(skin.profiles().at(0.1).min_component() > 0.0);
    assert!((grey.effective_albedo()[0] - 0.4).abs() < 1e-3);
    let ones = spectrum::SampledSpectrum::ONE;
    let (table, method) = (&bodies[0].table, SubsurfaceMethod::Diffusion);
    let facets = scattering::TrowbridgeReitz::new(0.0, 0.0);
    let expected = scattering::Bssrdf::from_reflectance(table, method, &facets, ones * 0.4, ones * 0.5);
    assert!((grey.profiles().at(0.2) - expected.profiles().at(0.2)).max_component() < 1e-3);
}
