//! Names by which statements refer to each other: those of the description, made unique.

use std::collections::HashSet;

use description::{
    Arena, FloatTextureDesc, Handle, MaterialDesc, MediumDesc, ObjectDesc, SceneDesc, SpectrumTextureDesc,
};

/// The names of all things that have one.
pub(crate) struct Names {
    float_textures: Vec<String>,
    spectrum_textures: Vec<String>,
    materials: Vec<String>,
    media: Vec<String>,
    objects: Vec<String>,
}

impl Names {
    pub(crate) fn new(desc: &SceneDesc) -> Self {
        Self {
            float_textures: names(&desc.float_textures, "texture", |texture| &texture.name),
            spectrum_textures: names(&desc.spectrum_textures, "texture", |texture| &texture.name),
            // The names by which layers of the picture call them, too.
            materials: names(&desc.materials, "material", |material| &material.name),
            media: names(&desc.media, "medium", |medium| &medium.name),
            objects: names(&desc.objects, "object", |object| &object.name),
        }
    }

    pub(crate) fn float_texture(&self, handle: Handle<FloatTextureDesc>) -> &str {
        &self.float_textures[handle.index()]
    }

    pub(crate) fn spectrum_texture(&self, handle: Handle<SpectrumTextureDesc>) -> &str {
        &self.spectrum_textures[handle.index()]
    }

    pub(crate) fn material(&self, handle: Handle<MaterialDesc>) -> &str {
        &self.materials[handle.index()]
    }

    pub(crate) fn medium(&self, handle: Handle<MediumDesc>) -> &str {
        &self.media[handle.index()]
    }

    /// The name of a medium; that of empty space is empty.
    pub(crate) fn space(&self, handle: Option<Handle<MediumDesc>>) -> &str {
        handle.map_or("", |handle| self.medium(handle))
    }

    pub(crate) fn object(&self, handle: Handle<ObjectDesc>) -> &str {
        &self.objects[handle.index()]
    }
}

/// The name of each item, or a kind and its index; with a number after it where an earlier item has
/// it already, or a later one by its own right.
fn names<T>(items: &Arena<T>, kind: &str, name: impl Fn(&T) -> &str) -> Vec<String> {
    let given: HashSet<&str> = items.iter().map(|(_, item)| name(item)).collect();
    let mut used = HashSet::new();
    let mut names = Vec::with_capacity(items.len());
    for (index, (_, item)) in items.iter().enumerate() {
        let own = name(item);
        let is_new = |candidate: &str| !used.contains(candidate) && !given.contains(candidate);
        let chosen = if !own.is_empty() && !used.contains(own) {
            own.to_owned()
        } else {
            let base = if own.is_empty() { format!("{kind}-{index}") } else { own.to_owned() };
            let numbered = (2_u64..).map(|number| format!("{base}-{number}"));
            std::iter::once(base.clone()).chain(numbered).find(|name| is_new(name)).unwrap_or(base)
        };
        used.insert(chosen.clone());
        names.push(chosen);
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_kept_where_they_are_unique() {
        let given = ["a", "", "b", "a", "a-2", "thing-1", "", "a"];
        let items = given.into_iter().map(|name| name.to_owned().into()).collect::<Arena<String>>();
        let expected = ["a", "thing-1-2", "b", "a-3", "a-2", "thing-1", "thing-6", "a-4"];
        assert_eq!(names(&items, "thing", |name| name), expected);
    }
}
