//! Names of the objects and materials of a scene.

use crate::material::MaterialId;
use description::{InstanceDesc, SceneDesc};
use geometry::Hit;

/// Names of the objects and materials of a scene, for AOVs that identify them.
///
/// An object is a shape of the world, or an instance with everything in it. The n-th instance of
/// the object `tree` is `tree/n`, counted from 0. All instances of it are the asset `tree`; a shape
/// of the world is an asset of its own. Unnamed shapes and materials are numbered in the
/// order of the description: `shape-7`, `material-7`.
#[derive(Clone, Debug, Default)]
pub struct Names {
    objects: Vec<Object>,
    /// The instanced objects.
    prototypes: Vec<Prototype>,
    materials: Vec<String>,
    /// The object of each geometry outside of instances.
    of_geometries: Vec<u32>,
    /// The object of each instance outside of other instances.
    of_instances: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
enum Object {
    /// A shape of the world by its index in the description.
    Shape(u32),
    /// The n-th instance of a prototype.
    Instance { prototype: u32, n: u32 },
}

#[derive(Clone, Debug)]
struct Prototype {
    name: String,
    instances: u32,
}

impl Names {
    /// The names of a description's materials, without objects yet.
    pub(crate) fn new(desc: &SceneDesc) -> Self {
        let materials = desc.materials.iter().enumerate().map(|(i, (_, material))| match &*material.name {
            "" => format!("material-{i}"),
            name => name.to_owned(),
        });
        let prototypes =
            desc.objects.iter().map(|(_, object)| Prototype { name: object.name.clone(), instances: 0 });
        Self {
            materials: materials.chain(["default".to_owned()]).collect(),
            prototypes: prototypes.collect(),
            ..Self::default()
        }
    }

    /// Names a shape of the world. Its geometries and instances are those added to the world last,
    /// up to these total counts.
    pub(crate) fn add_shape(&mut self, index: usize, geometries: usize, instances: usize) {
        self.add(Object::Shape(index as u32), geometries, instances);
    }

    /// Names an instance of the world, like [`Self::add_shape`].
    pub(crate) fn add_instance(&mut self, desc: &InstanceDesc, geometries: usize, instances: usize) {
        let prototype = desc.object.index();
        let count = &mut self.prototypes[prototype].instances;
        let object = Object::Instance { prototype: prototype as u32, n: *count };
        *count += 1;
        self.add(object, geometries, instances);
    }

    fn add(&mut self, object: Object, geometries: usize, instances: usize) {
        let id = self.objects.len() as u32;
        self.objects.push(object);
        self.of_geometries.resize(geometries, id);
        self.of_instances.resize(instances, id);
    }

    /// The names of the object that a ray has hit, and of its asset.
    pub fn object(&self, hit: &Hit) -> [String; 2] {
        let id = match hit.instance.ids().first() {
            Some(instance) => self.of_instances[instance.0 as usize],
            None => self.of_geometries[hit.geometry.0 as usize],
        };
        let object = self.objects[id as usize];
        [self.object_name(object), self.asset_name(object)]
    }

    /// The name of a material.
    pub fn material(&self, id: MaterialId) -> &str {
        &self.materials[id.0 as usize]
    }

    /// The names of all objects, in the order of the description.
    pub fn objects(&self) -> impl Iterator<Item = String> {
        self.objects.iter().map(|&object| self.object_name(object))
    }

    /// The names of all assets, in the order of the description.
    pub fn assets(&self) -> impl Iterator<Item = String> {
        let first = |object: &&Object| !matches!(object, Object::Instance { n: 1.., .. });
        self.objects.iter().filter(first).map(|&object| self.asset_name(object))
    }

    /// The names of all materials, in the order of the description; then that of the default one.
    pub fn materials(&self) -> impl Iterator<Item = &str> {
        self.materials.iter().map(String::as_str)
    }

    fn asset_name(&self, object: Object) -> String {
        match object {
            Object::Shape(_) => self.object_name(object),
            Object::Instance { prototype, .. } => self.prototypes[prototype as usize].name.clone(),
        }
    }

    fn object_name(&self, object: Object) -> String {
        match object {
            Object::Shape(index) => format!("shape-{index}"),
            Object::Instance { prototype, n } => format!("{}/{n}", self.prototypes[prototype as usize].name),
        }
    }
}
