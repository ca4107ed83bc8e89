//! Changes of lights and materials.

use std::sync::Arc;
use std::time::Duration;

use alhazen::description::{MaterialKind, RoughnessDesc, SceneDesc, SpectrumDesc, TextureDesc, TextureKind};
use alhazen::integrators::Control;
use alhazen_view::knobs::{Knob, Thing, Value, lights, materials};
use alhazen_view::{Renderer, World};

use crate::desc;

/// The mean of the finished picture.
fn mean(desc: &SceneDesc) -> [f64; 3] {
    let mut renderer = Renderer::new(Arc::new(World::new(desc.clone()).unwrap()), Duration::from_millis(33));
    let mut last = None;
    while !renderer.is_at_rest() {
        last = renderer.step(&Control::default()).unwrap().or(last);
    }
    let pixels = last.unwrap().pixels;
    let sum = |c: usize| pixels.iter().map(|pixel| f64::from(pixel[c])).sum::<f64>();
    [0, 1, 2].map(|c| sum(c) / pixels.len() as f64)
}

fn for_each(things: Vec<Thing>, mut visitor: impl FnMut(Knob)) {
    for mut thing in things {
        thing.visit(&mut visitor);
    }
}

#[test]
fn lights_become_brighter_and_coloured() {
    let mut desc = desc("cornell-box.pbrt", 4);
    let before = mean(&desc);
    for_each(lights(&mut desc), |mut knob| {
        if let ("scale", Value::Number(scale)) = (knob.field.name, knob.value) {
            knob.set(Value::Number(2.0 * scale));
        }
    });
    let brighter = mean(&desc);
    assert!((0..3).all(|c| (brighter[c] / before[c] - 2.0).abs() < 1e-2), "{before:?} {brighter:?}");
    for_each(lights(&mut desc), |mut knob| {
        if let Value::Light([r, g, b]) = knob.value {
            knob.set(Value::Light([r, 0.1 * g, 0.01 * b]));
        }
    });
    let red = mean(&desc);
    assert!(red[1] < 0.5 * brighter[1] && red[2] < 0.5 * brighter[2], "{red:?}");
}

#[test]
fn measured_spectra_become_the_colours_that_they_look_like() {
    let mut desc = desc("cornell-box.pbrt", 16);
    let before = mean(&desc);
    let mut count = 0;
    let mut replace = |mut knob: Knob| {
        if let value @ (Value::Color(_) | Value::Light(_)) = knob.value {
            knob.set(value);
            count += 1;
        }
    };
    for_each(lights(&mut desc), &mut replace);
    for_each(materials(&mut desc), &mut replace);
    assert!(count >= 4);
    let after = mean(&desc);
    assert!((0..3).all(|c| (after[c] / before[c] - 1.0).abs() < 0.15), "{before:?} {after:?}");
}

#[test]
fn every_constant_of_a_material_can_be_changed() {
    let mut desc = SceneDesc::default();
    let texture = desc.spectrum_textures.push(TextureDesc::new(TextureKind::Constant { value: 0.5.into() }));
    desc.materials.push(MaterialKind::Diffuse { reflectance: texture.into() }.into());
    desc.materials.push(MaterialKind::Diffuse { reflectance: 0.25.into() }.into());
    let eta = SpectrumDesc::Constant(1.5);
    desc.materials.push(MaterialKind::Dielectric { eta, roughness: RoughnessDesc::isotropic(0.5) }.into());
    desc.materials.push(MaterialKind::Interface.into());
    let (mut names, mut labels) = (Vec::new(), Vec::new());
    for mut thing in materials(&mut desc) {
        names.push(thing.name.clone());
        thing.visit(|mut knob| {
            labels.push(knob.field.name);
            match knob.value {
                Value::Color(rgb) => {
                    assert_eq!(rgb, [0.25; 3]);
                    knob.set(Value::Color([0.5, 0.25, 0.125]));
                }
                Value::Number(_) if knob.field.name == "eta" => knob.set(Value::Number(1.25)),
                Value::Number(_) => knob.set(Value::Number(0.0)),
                Value::Light(_) => panic!("a material has none"),
            }
        });
    }
    assert_eq!(names, ["material-1 (diffuse)", "material-2 (dielectric)"]);
    assert_eq!(labels, ["reflectance", "eta", "roughness"]);
    let kinds: Vec<_> = desc.materials.iter().map(|(_, material)| &material.kind).collect();
    let color = SpectrumDesc::rgb(0.5, 0.25, 0.125);
    assert!(matches!(kinds[1], MaterialKind::Diffuse { reflectance } if reflectance.value() == Some(&color)));
    let smooth = RoughnessDesc::isotropic(0.0);
    let MaterialKind::Dielectric { eta, roughness } = kinds[2] else { panic!("{:?}", kinds[2]) };
    assert_eq!((eta, roughness), (&1.25.into(), &smooth));
}
