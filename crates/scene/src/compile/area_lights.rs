//! Emitting shapes, compiled to rows of the light table.
//!
//! The lights of a group are numbered in the order in which its members were added, lights of its
//! instances included. An emitting geometry becomes one row for each path of instances to it.

use std::collections::HashMap;

use super::Compiler;
use crate::light::{AreaEmission, AreaLight, EmissionId, Light, LightTable, SceneSphere};
use crate::material::Material;
use crate::medium::MediumInterface;
use crate::scene::InstanceEntry;
use crate::texture::{FloatTextureId, UvLookup};
use description::{AreaLightDesc, MaterialKind, Origin, ShapeDesc, Span, Stated};
use geometry::{Geometry, GeometryId, GroupId, Instance, InstanceId, InstancePath, World};

/// The maximum number of lights of a scene; each primitive of each instance counts. The tables of
/// the light samplers take about 150 bytes per light.
const MAX_LIGHTS: u32 = 1 << 28;

/// The emitters of a group.
#[derive(Default)]
pub(super) struct Emitters {
    members: Vec<Member>,
    /// The number of lights in the group.
    len: u32,
}

enum Member {
    Geometry(GeometryId, Emitter),
    Instance(InstanceId, GroupId),
}

/// The emission of a geometry, shared by all its instances.
#[derive(Clone)]
pub(super) struct Emitter {
    emission: EmissionId,
    alpha: Option<FloatTextureId>,
    invisible: bool,
    /// The power of each primitive, if the scene states it.
    power: Option<f32>,
    primitives: u32,
}

impl Compiler<'_> {
    /// Compiles the emission of all area lights; `None` where it is invalid.
    pub(super) fn area_emissions(&mut self) {
        let desc = self.desc;
        for (_, light) in desc.area_lights.iter() {
            let emission = self.area_emission(light, &light.origin);
            self.area_emissions.push(emission);
        }
        for (_, material) in desc.materials.iter() {
            let emission = self.material_emission(&material.kind, &material.origin);
            self.material_emissions
                .push(emission.is_some().then_some(EmissionId(self.area_emissions.len() as u32)));
            self.area_emissions.extend(emission.map(Some));
        }
    }

    /// What shapes of a material emit without an area light of their own; `None` if nothing.
    fn material_emission(&mut self, material: &MaterialKind, origin: &Origin) -> Option<AreaEmission> {
        let MaterialKind::OpenPbr(desc) = material else { return None };
        let (luminance, span) = (desc.emission_luminance, origin.parameter("emission_luminance"));
        if luminance == 0.0 {
            return None;
        }
        if !(luminance > 0.0 && luminance.is_finite()) {
            let message = format!("a luminance is finite and not negative, as {luminance} is not");
            self.error("invalid-value", message, span);
        }
        let radiance = self.emission(&desc.emission_color, luminance, origin.parameter("emission_color"));
        Some(AreaEmission { radiance, image: None, two_sided: false })
    }

    /// The emission of a shape, and its power if the scene states it.
    fn emission_of(&self, shape: &ShapeDesc) -> Option<(EmissionId, Option<f32>)> {
        if let Some(handle) = shape.area_light {
            self.area_emissions[handle.index()].as_ref()?;
            return Some((EmissionId(handle.index() as u32), self.desc.area_lights[handle].power));
        }
        let id = self.material_emissions[shape.material?.index()]?;
        Some((id, None))
    }

    fn area_emission(&mut self, desc: &AreaLightDesc, origin: &Origin) -> Option<AreaEmission> {
        self.check_brightness(origin, &[("scale", Some(desc.scale)), ("power", desc.power)]);
        let mut radiance = self.emission(&desc.radiance, desc.scale, origin.parameter("L"));
        let mut image = None;
        if let Some(map) = desc.image {
            let span = origin.parameter("filename");
            let (pixels, scale) = self.emission_image(map.image, desc.scale, span)?;
            radiance.scale = scale;
            image = Some((pixels, UvLookup::new(&map)));
        }
        Some(AreaEmission { radiance, image, two_sided: desc.two_sided })
    }

    /// The emitter of a shape of `geometry`, if the shape can emit.
    pub(super) fn emitter(
        &mut self,
        shape: &Stated<ShapeDesc>,
        geometry: &Geometry,
        alpha: Option<FloatTextureId>,
    ) -> Option<Emitter> {
        let (emission, power) = self.emission_of(shape)?;
        let span = shape.origin.span;
        if !shape.kind.traits().can_emit {
            let message = "solids and surfaces given by formulas do not emit; drawn without light";
            self.warn("not-drawn", message, span);
            return None;
        }
        let material = self.material_id(shape.material);
        if matches!(self.materials[material.0 as usize].material, Material::Interface) {
            self.warn("light-ignored", "a shape of material `interface` does not emit", span);
            return None;
        }
        let Some(first) = geometry.shape(0) else {
            self.warn("light-ignored", "curves do not emit; drawn without light", span);
            return None;
        };
        if first.bounds().is_none() {
            let message = "an infinite plane cannot emit: its power would be infinite";
            self.error("infinite-light", message, span);
            return None;
        }
        let invisible = alpha.and_then(|id| self.constant_alpha(id)).is_some_and(|alpha| alpha <= 0.0);
        Some(Emitter { emission, alpha, invisible, power, primitives: geometry.len() as u32 })
    }

    /// Adds the emitter of a geometry of a group. Returns the index of its first light in the
    /// group.
    pub(super) fn add_emitter(
        &mut self,
        group: GroupId,
        geometry: GeometryId,
        emitter: Emitter,
        span: Span,
    ) -> Option<u32> {
        let first = self.count_lights(group, emitter.primitives, span)?;
        self.emitters[group.0 as usize].members.push(Member::Geometry(geometry, emitter));
        Some(first)
    }

    /// Adds a group to the world.
    pub(super) fn add_group(&mut self) -> GroupId {
        self.emitters.push(Emitters::default());
        self.world.add_group()
    }

    /// Adds an instance and its lights to a group of the world.
    pub(super) fn add_instance(&mut self, group: GroupId, instance: Instance, span: Span) {
        let placed = instance.group;
        let id = self.world.add_instance(group, instance);
        let first_light = match self.emitters[placed.0 as usize].len {
            0 => None,
            len => self.count_lights(group, len, span),
        };
        if first_light.is_some() {
            self.emitters[group.0 as usize].members.push(Member::Instance(id, placed));
        }
        self.instances.push(InstanceEntry { first_light: first_light.unwrap_or(0), span });
    }

    fn count_lights(&mut self, group: GroupId, count: u32, span: Span) -> Option<u32> {
        let first = self.emitters[group.0 as usize].len;
        match first.checked_add(count).filter(|&len| len <= MAX_LIGHTS) {
            Some(len) => {
                self.emitters[group.0 as usize].len = len;
                Some(first)
            }
            None => {
                let message = format!("a scene has at most {MAX_LIGHTS} emitting primitives");
                self.error("too-large", message, span);
                None
            }
        }
    }

    /// All lights: the area lights of `world`, then the lights without a surface. `sphere` bounds
    /// the scene.
    pub(super) fn light_table(&mut self, world: &World, sphere: SceneSphere) -> LightTable {
        let emissions = std::mem::take(&mut self.area_emissions).into_iter().map(|emission| {
            // Invalid emission is replaced by black, so that ids stay valid.
            emission.unwrap_or_else(AreaEmission::black)
        });
        let mut table = LightTable::new(emissions.collect());
        let desc = self.desc;
        let groups: HashMap<_, _> = desc.light_groups().into_iter().zip(0..).collect();
        let group = |name: &Option<String>| name.as_ref().map_or(0, |name| groups[name.as_str()]);
        // Emissions of materials, which follow those of area lights, have no group.
        let of_emissions: Vec<_> = desc.area_lights.iter().map(|(_, light)| group(&light.group)).collect();
        self.add_rows(GroupId::TOP, InstancePath::TOP, world, &of_emissions, &mut table);
        for (light, medium, group, span) in self.lights(sphere, group) {
            table.push(light, 1, MediumInterface { inside: medium, outside: medium }, group, span);
        }
        table
    }

    /// Adds the rows of the emitters of a group of the world. `light_groups` has the groups of
    /// emissions.
    fn add_rows(
        &self,
        group: GroupId,
        path: InstancePath,
        world: &World,
        light_groups: &[u32],
        table: &mut LightTable,
    ) {
        for member in &self.emitters[group.0 as usize].members {
            match member {
                &Member::Instance(id, placed) => {
                    self.add_rows(placed, path.into(id), world, light_groups, table)
                }
                Member::Geometry(geometry, emitter) => {
                    let &Emitter { emission, alpha, invisible, power, primitives } = emitter;
                    let mut light = AreaLight {
                        geometry: *geometry,
                        instance: path,
                        emission,
                        alpha,
                        invisible,
                        scales: None,
                    };
                    light.scales = power.map(|power| {
                        let scale = |primitive| {
                            let area = light.area(world, primitive);
                            table.emissions()[emission.0 as usize].scale_for_power(power, area)
                        };
                        (0..primitives).map(scale).collect()
                    });
                    let entry = &self.entries[geometry.0 as usize];
                    let media = entry.media.unwrap_or_default();
                    let group = light_groups.get(emission.0 as usize).copied().unwrap_or(0);
                    table.push(Light::Area(light), primitives, media, group, entry.span);
                }
            }
        }
    }
}
