//! Changes of lights and materials.

use std::sync::Arc;
use std::time::Duration;

use alhazen::description::{MaterialKind, RoughnessDesc, SceneDesc, SpectrumDesc, TextureDesc, TextureKind};
use alhazen::integrators::Control;
use alhazen_view::knobs::{Thing, Value, lights, materials};
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

#[test]
fn lights_become_brighter_and_coloured() {
    let mut desc = desc("cornell-box.pbrt", 4);
    let before = mean(&desc);
    for knob in lights(&mut desc).into_iter().flat_map(|light| light.knobs) {
        if let Value::Scale(scale) = knob.value {
            *scale *= 2.0;
        }
    }
    let brighter = mean(&desc);
    assert!((0..3).all(|c| (brighter[c] / before[c] - 2.0).abs() < 1e-2), "{before:?} {brighter:?}");
    for knob in lights(&mut desc).into_iter().flat_map(|light| light.knobs) {
        if let Value::Light(mut color) = knob.value {
            let [r, g, b] = color.rgb();
            color.set([r, 0.1 * g, 0.01 * b]);
            assert_eq!(color.rgb(), [r, 0.1 * g, 0.01 * b]);
        }
    }
    let red = mean(&desc);
    assert!(red[1] < 0.5 * brighter[1] && red[2] < 0.5 * brighter[2], "{red:?}");
}

#[test]
fn measured_spectra_become_the_colours_that_they_look_like() {
    let mut desc = desc("cornell-box.pbrt", 16);
    let before = mean(&desc);
    let mut count = 0;
    let mut replace = |things: Vec<Thing<'_>>| {
        for knob in things.into_iter().flat_map(|thing| thing.knobs) {
            if let Value::Color(mut color) | Value::Light(mut color) = knob.value {
                let rgb = color.rgb();
                color.set(rgb);
                assert_eq!(color.rgb(), rgb);
                count += 1;
            }
        }
    };
    replace(lights(&mut desc));
    replace(materials(&mut desc));
    assert!(count >= 4);
    let after = mean(&desc);
    assert!((0..3).all(|c| (after[c] / before[c] - 1.0).abs() < 0.15), "{before:?} {after:?}");
}

#[test]
fn every_constant_of_a_material_can_be_changed() {
    let mut desc = SceneDesc::default();
    let texture = desc.spectrum_textures.push(TextureDesc::new(TextureKind::Constant(0.5.into())));
    desc.materials.push(MaterialKind::Diffuse { reflectance: texture.into() }.into());
    desc.materials.push(MaterialKind::Diffuse { reflectance: 0.25.into() }.into());
    let eta = SpectrumDesc::Constant(1.5);
    desc.materials.push(MaterialKind::Dielectric { eta, roughness: RoughnessDesc::isotropic(0.5) }.into());
    desc.materials.push(MaterialKind::Interface.into());
    let found = materials(&mut desc);
    let names: Vec<_> = found.iter().map(|Thing { name, knobs }| (name.as_str(), knobs.len())).collect();
    assert_eq!(names, [("material-1 (diffuse)", 1), ("material-2 (dielectric)", 2)]);
    for knob in found.into_iter().flat_map(|thing| thing.knobs) {
        match knob.value {
            Value::Color(mut color) => {
                assert_eq!(color.rgb(), [0.25; 3]);
                color.set([0.5, 0.25, 0.125]);
            }
            Value::Share(share) => *share = 0.0,
            Value::Light(_) | Value::Scale(_) => panic!("a material has none"),
        }
    }
    let kinds: Vec<_> = desc.materials.iter().map(|(_, material)| &material.kind).collect();
    let color = SpectrumDesc::rgb(0.5, 0.25, 0.125);
    assert!(matches!(kinds[1], MaterialKind::Diffuse { reflectance } if reflectance.value() == Some(&color)));
    let smooth = RoughnessDesc::isotropic(0.0);
    assert!(matches!(kinds[2], MaterialKind::Dielectric { roughness, .. } if *roughness == smooth));
}
