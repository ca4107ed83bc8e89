//! The world: objects, shapes and instances, with what is in force for them.

use std::collections::BTreeSet;

use description::{
    AreaLightDesc, Arena, Handle, InstanceDesc, MaterialDesc, MediumInterface, SceneDesc, ShapeDesc,
    TransformDesc,
};
use math::DMat4;

use crate::write::files::Files;
use crate::write::lights::area_light;
use crate::write::names::Names;
use crate::write::shapes::shape;
use crate::write::statement::quoted;
use crate::write::text::Text;

/// What is in force for a shape. Successive shapes of the same are in one block.
#[derive(PartialEq)]
struct Attributes<'a> {
    transform: [&'a DMat4; 2],
    reverse_orientation: bool,
    material: Option<Handle<MaterialDesc>>,
    area_light: Option<Handle<AreaLightDesc>>,
    media: Option<MediumInterface>,
}

impl<'a> Attributes<'a> {
    fn of(shape: &'a ShapeDesc) -> Self {
        let ShapeDesc {
            kind: _,
            world_from_object: TransformDesc { start, end, times: _ },
            reverse_orientation,
            single_sided: _,
            material,
            area_light,
            alpha: _,
            medium_interface,
        } = shape;
        Self {
            transform: [start, end],
            reverse_orientation: *reverse_orientation,
            material: *material,
            area_light: *area_light,
            media: *medium_interface,
        }
    }
}

pub(crate) struct World<'a, 'f> {
    pub(crate) desc: &'a SceneDesc,
    pub(crate) names: &'a Names,
    pub(crate) files: &'a mut Files<'f>,
    pub(crate) text: &'a mut Text,
    pub(crate) extensions: &'a mut BTreeSet<String>,
}

impl World<'_, '_> {
    /// All objects, then the shapes and instances outside of objects.
    pub(crate) fn write(&mut self) {
        let desc = self.desc;
        for (handle, object) in desc.objects.iter() {
            self.text.begin(&format!("ObjectBegin {}", quoted(self.names.object(handle))));
            self.shapes(&object.shapes);
            if !object.instances.is_empty() {
                self.extensions.insert("instances within objects".into());
            }
            self.instances(&object.instances);
            self.text.end("ObjectEnd");
        }
        self.text.paragraph();
        self.shapes(&desc.shapes);
        self.text.paragraph();
        self.instances(&desc.instances);
    }

    fn shapes(&mut self, shapes: &Arena<ShapeDesc>) {
        let shapes: Vec<&ShapeDesc> = shapes.iter().map(|(_, shape)| &shape.value).collect();
        for run in shapes.chunk_by(|a, b| Attributes::of(a) == Attributes::of(b)) {
            let directives = self.directives(run[0]);
            let place = &run[0].world_from_object;
            let is_placed = [&place.start, &place.end] != [&DMat4::IDENTITY; 2];
            let in_block = is_placed || !directives.is_empty() || run[0].area_light.is_some();
            if in_block {
                self.text.begin("AttributeBegin");
            }
            self.text.transform(place);
            directives.iter().for_each(|line| self.text.line(line));
            if let Some(light) = run[0].area_light {
                let light = &self.desc.area_lights[light];
                let light = area_light(self.desc, light, self.names, self.files, self.extensions);
                self.text.statement(light);
            }
            for desc in run {
                let statement = shape(self.desc, desc, self.names, self.files, self.extensions);
                self.text.statement(statement);
            }
            if in_block {
                self.text.end("AttributeEnd");
            }
        }
    }

    /// The directives before a shape that take no parameters.
    fn directives(&self, shape: &ShapeDesc) -> Vec<String> {
        let mut lines = Vec::new();
        if shape.reverse_orientation {
            lines.push("ReverseOrientation".to_owned());
        }
        if let Some(material) = shape.material {
            lines.push(format!("NamedMaterial {}", quoted(self.names.material(material))));
        }
        // The camera's medium is in force on the outside of all shapes.
        let camera = self.desc.camera.medium;
        let in_force = camera.map(|outside| MediumInterface { inside: None, outside: Some(outside) });
        let wanted = match shape.medium_interface {
            None => camera.map(|medium| MediumInterface { inside: Some(medium), outside: Some(medium) }),
            given => given,
        };
        if let Some(MediumInterface { inside, outside }) = wanted.filter(|_| wanted != in_force) {
            let [inside, outside] = [inside, outside].map(|medium| quoted(self.names.space(medium)));
            lines.push(format!("MediumInterface {inside} {outside}"));
        }
        lines
    }

    fn instances(&mut self, instances: &Arena<InstanceDesc>) {
        for (_, instance) in instances.iter() {
            let InstanceDesc { object, world_from_object } = &instance.value;
            let TransformDesc { start, end, times: _ } = world_from_object;
            let line = format!("ObjectInstance {}", quoted(self.names.object(*object)));
            self.text.block([start, end] != [&DMat4::IDENTITY; 2], |text| {
                text.transform(world_from_object);
                text.line(&line);
            });
        }
    }
}
