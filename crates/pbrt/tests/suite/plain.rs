//! Comparison of descriptions by what is rendered of them: without places in texts, without the
//! order in which images were read, and without differences of form, as a mesh in a file has.

use std::fmt::{Debug, Write};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

use description::{
    ApertureDesc, Arena, CameraKind, Handle, ImageDesc, InfiniteRadiance, InstanceDesc, LightKind,
    MaterialKind, MediumKind, PatchMeshDesc, SceneDesc, ShapeDesc, ShapeKind, Span, Stated, TextureKind,
    TransformDesc, VoxelsDesc,
};

/// A line for each thing in a scene: its debug output, or the hash of that if it is long.
fn lines(desc: &SceneDesc) -> Vec<String> {
    let desc = &plain(desc);
    let mut lines = vec![
        line("options", &desc.options.value),
        line("film", &desc.film.value),
        line("camera", &desc.camera.value),
        line("filter", &desc.filter.value),
        line("sampler", &desc.sampler.value),
        line("integrator", &desc.integrator.value),
        line("accelerator", &desc.accelerator.value),
    ];
    lines.extend(arena("float texture", &desc.float_textures));
    lines.extend(arena("spectrum texture", &desc.spectrum_textures));
    lines.extend(arena("material", &desc.materials));
    let measured = desc.materials.iter().filter_map(|(_, material)| match &material.kind {
        MaterialKind::Measured { table } => Some(line("measurements", table.data())),
        _ => None,
    });
    lines.extend(measured);
    lines.extend(arena("medium", &desc.media));
    lines.extend(arena("light", &desc.lights));
    lines.extend(shapes(desc, &desc.shapes));
    for (_, object) in desc.objects.iter() {
        lines.push(line("object", &object.name));
        lines.extend(shapes(desc, &object.shapes));
        lines.extend(arena("instance within", &object.instances));
    }
    lines.extend(arena("instance", &desc.instances));
    lines
}

/// The first thing that differs between two scenes, as it is in both.
pub fn difference(before: &SceneDesc, after: &SceneDesc) -> Option<String> {
    let [before, after] = [before, after].map(lines);
    let pair = before.iter().zip(&after).find(|(before, after)| before != after);
    match pair {
        Some((before, after)) => Some(format!("{before:.3000}\n{after:.3000}")),
        None if before.len() != after.len() => {
            Some(format!("{} things become {}", before.len(), after.len()))
        }
        None => None,
    }
}

fn line(what: &str, value: &impl Debug) -> String {
    struct Sink {
        hasher: DefaultHasher,
        start: String,
    }

    impl Write for Sink {
        fn write_str(&mut self, text: &str) -> std::fmt::Result {
            self.hasher.write(text.as_bytes());
            if self.start.len() < 2000 {
                self.start += text;
            }
            Ok(())
        }
    }

    let mut sink = Sink { hasher: DefaultHasher::new(), start: String::new() };
    write!(sink, "{value:?}").unwrap();
    let Sink { hasher, start } = sink;
    if start.len() < 2000 {
        format!("{what} {start}")
    } else {
        format!("{what} {:x} {start:.300}", hasher.finish())
    }
}

fn arena<T: Debug>(what: &str, items: &Arena<T>) -> Vec<String> {
    items.iter().map(|(_, item)| line(what, &item.value)).collect()
}

fn shapes(desc: &SceneDesc, shapes: &Arena<ShapeDesc>) -> Vec<String> {
    let light = |shape: &ShapeDesc| shape.area_light.map(|light| &desc.area_lights[light]);
    let one = |shape: &ShapeDesc| {
        let unlit = ShapeDesc { area_light: None, ..shape.clone() };
        line("shape", &(unlit, light(shape)))
    };
    shapes.iter().map(|(_, shape)| one(shape)).collect()
}

/// A handle that is the same for the same pixels.
fn picture(images: &Arena<ImageDesc>, handle: Handle<ImageDesc>) -> Handle<ImageDesc> {
    let image = &images[handle].image;
    let mut hasher = DefaultHasher::new();
    for (x, y) in (0..image.height()).flat_map(|y| (0..image.width()).map(move |x| (x, y))) {
        let opacity = image.alpha_index().map(|c| image.channel(x, y, c).to_bits());
        (image.rgb(x, y).map(f32::to_bits), image.channel(x, y, 0).to_bits(), opacity).hash(&mut hasher);
    }
    (image.width(), image.height()).hash(&mut hasher);
    line("space", &image.metadata.chromaticities).hash(&mut hasher);
    Handle::new(hasher.finish() as u32)
}

fn plain(desc: &SceneDesc) -> SceneDesc {
    let mut desc = desc.clone();
    let images = desc.images.clone();
    let fixed = |handle: &mut Handle<ImageDesc>| *handle = picture(&images, *handle);
    desc.film.layers.iter_mut().for_each(|layer| layer.span = Span::NONE);
    still(&mut desc.camera.camera_from_world);
    // The camera of a file that has none is written for the size of its film.
    desc.camera.shows = None;
    if let CameraKind::Realistic(camera) = &mut desc.camera.kind
        && let ApertureDesc::Image(image) = &mut camera.aperture
    {
        fixed(image);
    }
    for (_, texture) in desc.float_textures.iter_mut() {
        texture.name = String::new();
        if let TextureKind::Image(image) = &mut texture.kind {
            fixed(&mut image.image);
        }
    }
    for (_, texture) in desc.spectrum_textures.iter_mut() {
        texture.name = String::new();
        if let TextureKind::Image(image) = &mut texture.kind {
            fixed(&mut image.image);
        }
    }
    for (handle, material) in desc.materials.iter_mut() {
        if material.name.is_empty() {
            material.name = format!("material-{}", handle.index());
        }
        if let Some(map) = &mut material.normal_map {
            fixed(&mut map.image);
        }
        if let MaterialKind::OpenPbr(surface) = &mut material.kind
            && let Some(map) = &mut surface.geometry_coat_normal
        {
            fixed(&mut map.image);
        }
    }
    for (_, medium) in desc.media.iter_mut() {
        still(&mut medium.world_from_medium);
        if let MediumKind::NanoVdb { density, temperature, .. } = &mut medium.kind {
            [Some(density), temperature.as_mut()].into_iter().flatten().for_each(in_order);
        }
    }
    for (_, light) in desc.lights.iter_mut() {
        still(&mut light.world_from_light);
        match &mut light.kind {
            LightKind::Goniometric { image: Some(image), .. }
            | LightKind::Projection { image: Some(image), .. }
            | LightKind::Infinite { radiance: InfiniteRadiance::Image(image), .. } => fixed(image),
            _ => (),
        }
    }
    for (_, light) in desc.area_lights.iter_mut() {
        if let Some(image) = &mut light.image {
            fixed(&mut image.image);
            light.radiance = 1.0.into();
        }
    }
    let SceneDesc { shapes, objects, instances, .. } = &mut desc;
    for (_, shape) in shapes.iter_mut() {
        plain_shape(shape, fixed);
    }
    for (_, object) in objects.iter_mut() {
        for (_, shape) in object.shapes.iter_mut() {
            plain_shape(shape, fixed);
        }
        object.instances.iter_mut().for_each(place);
    }
    instances.iter_mut().for_each(place);
    desc
}

fn place((_, instance): (Handle<InstanceDesc>, &mut Stated<InstanceDesc>)) {
    still(&mut instance.world_from_object);
}

/// The times of what does not move do not matter.
fn still(transform: &mut TransformDesc) {
    if !transform.is_animated() {
        transform.times = [0.0, 1.0];
    }
}

fn plain_shape(shape: &mut ShapeDesc, fixed: impl Fn(&mut Handle<ImageDesc>)) {
    if !matches!(&shape.kind, ShapeKind::Triangles(mesh) if !mesh.later.is_empty()) {
        still(&mut shape.world_from_object);
    }
    match &mut shape.kind {
        ShapeKind::Implicit { formula, .. } => formula.span = Span::NONE,
        ShapeKind::Solid { operands, .. } => operands.iter_mut().for_each(|one| one.span = Span::NONE),
        ShapeKind::Patches(mesh) => mesh.emission_image.iter_mut().for_each(fixed),
        ShapeKind::PlyMesh { triangles, patches, displacement: None, .. } if patches.indices.is_empty() => {
            shape.kind = ShapeKind::Triangles(triangles.clone());
        }
        ShapeKind::PlyMesh { patches: PatchMeshDesc { indices, .. }, edge_length, displacement, .. } => {
            assert!(!indices.is_empty() || displacement.is_some());
            if displacement.is_none() {
                *edge_length = 1.0;
            }
        }
        _ => (),
    }
}

/// The bricks of a volume in the order of its table, the background first.
fn in_order(voxels: &mut VoxelsDesc) {
    let mut values = voxels.values[..512].to_vec();
    for &brick in voxels.table.iter() {
        values.extend_from_slice(&voxels.values[512 * brick as usize..][..512]);
    }
    voxels.table = (1..=voxels.table.len() as u32).collect();
    voxels.values = Arc::from(values);
}
