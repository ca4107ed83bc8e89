//! The texture graph and its programs: sharing, folding, order and limits.

use super::*;

/// A scene whose texture 0 is an image of numbers that varies over u.
fn with_ramp() -> SceneDesc {
    let mut scene = SceneDesc::default();
    let ramp = Image::from_fn(4, 1, ["Y"], |x, _| [[0.25, 0.75, 0.5, 0.125][x as usize]]);
    let desc = ImageTextureDesc::new(push_image(&mut scene, ramp));
    scene.float_textures.push(FloatTextureDesc::new(TextureKind::Image(desc)));
    scene
}

fn push(scene: &mut SceneDesc, kind: TextureKind<f32>) -> Handle<FloatTextureDesc> {
    scene.float_textures.push(FloatTextureDesc::new(kind))
}

fn push_mix(
    scene: &mut SceneDesc,
    textures: [Parameter<f32>; 2],
    amount: Parameter<f32>,
) -> Handle<FloatTextureDesc> {
    push(scene, TextureKind::Mix { textures, amount })
}

impl Compiled {
    /// The last texture of numbers.
    fn last(&self) -> FloatTextureId {
        *self.floats.last().expect("there is one")
    }

    /// The operations of its program.
    fn operations(&self) -> &[Operation] {
        self.textures.program(self.last().0)
    }
}

#[test]
fn each_node_of_a_shared_graph_is_evaluated_once() {
    let ramp: Handle<FloatTextureDesc> = Handle::new(0);
    let mut scene = with_ramp();
    let mut texture = ramp;
    for i in 0..40 {
        let other = push(&mut scene, TextureKind::Scale { texture: texture.into(), scale: 0.9.into() });
        let amount = push(&mut scene, TextureKind::Scale { texture: ramp.into(), scale: (i as f32).into() });
        texture = push_mix(&mut scene, [texture.into(), other.into()], amount.into());
    }
    let t = sound(&scene);
    let operations = t.operations();
    let lookups = operations.iter().filter(|o| matches!(o.code, Code::FloatImage(_))).count();
    let products = operations.iter().filter(|o| o.code == Code::Scale).count();
    let mixes = operations.iter().filter(|o| o.code == Code::Mix).count();
    // Of the factors 0 to 39, one needs no product.
    assert_eq!((lookups, products, mixes), (1, 40 + 39, 40));
    for (u, x) in [(0.125, 0.25_f32), (0.375, 0.75)] {
        let expected = (0..40).fold(x, |value, i| {
            let amount = x * i as f32;
            if amount == 0.0 {
                value
            } else if amount == 1.0 {
                value * 0.9
            } else {
                value * (1.0 - amount) + value * 0.9 * amount
            }
        });
        assert_eq!(t.textures.float(t.last(), &at(u, 0.5)), expected);
    }
}

#[test]
fn equal_textures_are_shared() {
    let mut scene = with_ramp();
    let ramp = scene.float_textures[Handle::new(0)].clone();
    let again = scene.float_textures.push(ramp);
    for texture in [Handle::new(0), again] {
        push(&mut scene, TextureKind::Scale { texture: texture.into(), scale: 0.5.into() });
    }
    let t = sound(&scene);
    assert_eq!(t.floats[0], t.floats[1]);
    assert_eq!(t.floats[2], t.floats[3]);
    let tables = &t.textures;
    assert_eq!((tables.float_images().len(), tables.mappings().len(), tables.pyramids().len()), (1, 1, 1));
}

#[test]
fn constants_are_folded() {
    let mut scene = SceneDesc::default();
    let product = push(&mut scene, TextureKind::Scale { texture: 0.1.into(), scale: 0.7.into() });
    push_mix(&mut scene, [product.into(), 0.3.into()], 0.9.into());
    let t = sound(&scene);
    let expected = 0.1_f32 * 0.7 * (1.0 - 0.9_f32) + 0.3 * 0.9;
    assert_eq!(t.textures.constant(t.last()), Some(expected));
    assert_eq!(t.textures.float(t.last(), &at(0.1, 0.2)), expected);

    let mut scene = with_ramp();
    let product = push(&mut scene, TextureKind::Scale { texture: Handle::new(0).into(), scale: 1.0.into() });
    push_mix(&mut scene, [product.into(), 0.3.into()], 0.0.into());
    let t = sound(&scene);
    assert_eq!(t.last(), t.floats[0], "nothing but the image is left");

    let mut scene = SceneDesc::default();
    let huge = push(&mut scene, TextureKind::Scale { texture: 1e30.into(), scale: 1e30.into() });
    assert_eq!(compiled(&scene).codes(), ["invalid-value"]);
    assert_eq!(compiled(&scene).diagnostics[0].span(), scene.float_textures.origin(huge).span);
}

/// A chain of mixes, each with the previous texture as operand `place` of three.
fn chain(length: u32, place: usize) -> SceneDesc {
    let mut scene = with_ramp();
    let mut texture: Handle<FloatTextureDesc> = Handle::new(0);
    for i in 0..length {
        let mut operands: [Parameter<f32>; 3] = [(0.5 / (i + 2) as f32).into(), 0.25.into(), 0.5.into()];
        operands[place] = texture.into();
        let [first, second, amount] = operands;
        texture = push_mix(&mut scene, [first, second], amount);
    }
    scene
}

#[test]
fn long_chains_need_few_slots() {
    for place in 0..3 {
        let length = 300;
        let t = sound(&chain(length, place));
        let slots = t.operations().iter().map(|operation| operation.target).max();
        assert_eq!(slots, Some(2), "operand {place}");
        let expected = (0..length).fold(0.25_f32, |value, i| {
            let mut operands = [0.5 / (i + 2) as f32, 0.25, 0.5];
            operands[place] = value;
            let [first, second, amount] = operands;
            first * (1.0 - amount) + second * amount
        });
        assert_eq!(t.textures.float(t.last(), &at(0.125, 0.5)), expected);
    }
}

#[test]
fn a_program_that_is_too_long_is_an_error_where_it_is_used() {
    for place in 0..3 {
        let scene = chain(100_000, place);
        let mut diagnostics = Vec::new();
        let mut compiler = TextureCompiler::new(&scene, &DMat4::IDENTITY, &mut diagnostics);
        let mut sources = description::SourceMap::default();
        let span = Span { file: sources.add("a.pbrt", *b"0123456789"), start: 2, end: 5 };
        let last: Parameter<f32> = Handle::new(100_000).into();
        let id = compiler.float_parameter(&last, span, &mut diagnostics);
        let [error] = &diagnostics[..] else { panic!("{diagnostics:?}") };
        assert_eq!((error.code, error.span()), ("texture-size", span));
        assert_eq!(compiler.textures().float(id, &at(0.1, 0.1)), 0.0);
    }
}

#[test]
fn a_program_that_needs_too_many_values_at_once_is_an_error() {
    // Each product is read by two sums far apart, so that all are kept in between.
    let sums = |count: usize| {
        let mut scene = with_ramp();
        let ramp: Handle<FloatTextureDesc> = Handle::new(0);
        let products: Vec<_> = (0..count)
            .map(|i| {
                let scale = (i as f32 + 2.0).into();
                push(&mut scene, TextureKind::Scale { texture: ramp.into(), scale })
            })
            .collect();
        let mut sum = ramp;
        for amount in [0.25, 0.75] {
            for &product in &products {
                sum = push_mix(&mut scene, [sum.into(), product.into()], amount.into());
            }
        }
        compiled(&scene)
    };
    assert!(sums(MAX_SLOTS / 2).diagnostics.is_empty());
    assert_eq!(sums(2 * MAX_SLOTS).codes().last(), Some(&"texture-size"));
}

#[test]
fn forward_references_are_errors() {
    for index in [0, 1, 7] {
        let mut scene = SceneDesc::default();
        push(&mut scene, TextureKind::Scale { texture: Handle::new(index).into(), scale: 1.0.into() });
        assert_eq!(compiled(&scene).codes(), ["texture-cycle"]);
    }
}
