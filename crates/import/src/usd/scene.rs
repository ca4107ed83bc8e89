//! The prims of a stage put together as a scene.

use std::collections::HashMap;

use description::{Handle, InstanceDesc, LightDesc, ObjectDesc, SceneDesc, ShapeDesc, TransformDesc};
use math::{DMat4, DVec3};

use super::instancer;
use super::light::{self, Light};
use super::material::{Material, Materials};
use super::mesh::Mesh;
use super::primvar::{Counts, Primvar};
use super::solid::{self, Solid};
use super::stage::{Prim, Stage, TIMES};
use super::{camera, curves, xform};
use crate::log::{Fault, Log, Result};
use crate::studio::{Lamp, View};

/// Deepest prim that is drawn, and deepest instance in instances.
const DEEPEST: usize = 1000;
const MOST_NESTED: usize = 8;

/// What is drawn together, in one space.
pub(super) struct Group {
    shapes: Vec<ShapeDesc>,
    instances: Vec<InstanceDesc>,
    lights: Vec<LightDesc>,
    /// Two corners of the box around it.
    bounds: [DVec3; 2],
}

impl Default for Group {
    fn default() -> Self {
        let bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        Self { shapes: Vec::new(), instances: Vec::new(), lights: Vec::new(), bounds }
    }
}

/// A group that is drawn at one or more places.
#[derive(Clone)]
pub(super) struct Prototype {
    object: Option<Handle<ObjectDesc>>,
    lights: Vec<LightDesc>,
    bounds: [DVec3; 2],
}

/// What prims inherit from those above.
#[derive(Clone)]
pub(super) struct State<'s> {
    /// From the world to the group.
    group_from_world: DMat4,
    /// From a prim to the group, at both times.
    group_from_prim: [DMat4; 2],
    purpose: Option<String>,
    /// The material, and whether it is stronger than those below.
    material: Option<(Prim<'s>, bool)>,
    depth: usize,
    /// How many instances this is in.
    nesting: usize,
}

/// A scene while it is built.
pub(super) struct Assembly<'a> {
    pub desc: &'a mut SceneDesc,
    pub log: &'a mut Log,
    pub materials: Materials<'a>,
    prototypes: HashMap<String, Prototype>,
    /// The cameras with their paths.
    pub views: Vec<(String, View)>,
    /// The lights with a surface that are in no instance.
    pub lamps: Vec<Lamp>,
}

impl<'a> Assembly<'a> {
    pub fn new(desc: &'a mut SceneDesc, log: &'a mut Log, materials: Materials<'a>) -> Self {
        Self { desc, log, materials, prototypes: HashMap::new(), views: Vec::new(), lamps: Vec::new() }
    }

    /// Adds everything that is drawn but the camera; the corners of the box around all surfaces.
    pub fn add_all(&mut self, stage: &Stage) -> Result<[DVec3; 2]> {
        // y is up in the scene.
        let upright = match stage.is_z_up() {
            true => DMat4::from_rotation_x(-std::f64::consts::FRAC_PI_2),
            false => DMat4::IDENTITY,
        };
        let state = State {
            group_from_world: upright,
            group_from_prim: [upright; 2],
            purpose: None,
            material: None,
            depth: 0,
            nesting: 0,
        };
        let mut world = Group::default();
        for root in stage.roots()? {
            self.prim(&root, &state, &mut world);
        }
        world.shapes.into_iter().for_each(|shape| _ = self.desc.shapes.push(shape));
        world.instances.into_iter().for_each(|instance| _ = self.desc.instances.push(instance));
        world.lights.into_iter().for_each(|light| _ = self.desc.lights.push(light));
        Ok(world.bounds)
    }

    /// Adds a prim and those below it. What is wrong with it is reported.
    fn prim(&mut self, prim: &Prim, above: &State, group: &mut Group) {
        if self.log.is_full() {
            return;
        }
        match prim.is_drawn() {
            Ok(true) => {}
            Ok(false) => return,
            Err(fault) => return self.log.fault(fault),
        }
        if let Err(fault) = self.drawn(prim, above, group) {
            self.log.fault(fault);
        }
    }

    fn drawn(&mut self, prim: &Prim, above: &State, group: &mut Group) -> Result<()> {
        let kind = prim.kind()?;
        if matches!(kind.as_str(), "Material" | "Shader" | "NodeGraph" | "GeomSubset") {
            return Ok(());
        }
        if prim.word("visibility")?.as_deref() == Some("invisible") {
            return Ok(());
        }
        let state = self.below(prim, above)?;
        if let Some(prototype) = prim.prototype()?.filter(|_| state.nesting < MOST_NESTED) {
            let key = format!("{prototype} {:?} {:?}", state.purpose, state.material.as_ref().map(|m| &m.0));
            let prototype = self.prototype(&key, &state, |assembly, state, group| {
                assembly.content(prim, &kind, state, group)
            })?;
            let placement = self.placement(&state.group_from_prim, prim);
            placement.into_iter().for_each(|placement| place(&prototype, placement, group));
            return Ok(());
        }
        self.content(prim, &kind, &state, group)
    }

    /// Adds what a prim is, and the prims below it.
    fn content(&mut self, prim: &Prim, kind: &str, state: &State, group: &mut Group) -> Result<()> {
        let is_drawn = !matches!(state.purpose.as_deref(), Some("proxy" | "guide"));
        let result = match is_drawn {
            true => self.shape(prim, kind, state, group),
            false => Ok(()),
        };
        // Faults of a shape do not keep those below it from being drawn.
        if let Err(fault) = result {
            self.log.fault(fault);
        }
        if kind != "PointInstancer" {
            for child in prim.children()? {
                self.prim(&child, state, group);
            }
        }
        Ok(())
    }

    /// What prims below a prim inherit.
    fn below<'s>(&mut self, prim: &Prim<'s>, above: &State<'s>) -> Result<State<'s>> {
        if above.depth >= DEEPEST {
            return Err(prim.fault("", format!("prims more than {DEEPEST} deep are not drawn")));
        }
        let mut state = State { depth: above.depth + 1, ..above.clone() };
        for time in TIMES {
            let local = xform::local(prim, time)?;
            if local.is_reset && above.nesting > 0 {
                let message = "transforms that are reset in instances begin at the instance";
                self.log.warn("not-drawn", prim.path(), message);
            }
            state.group_from_prim[time] = match local.is_reset {
                true => above.group_from_world * local.parent_from_prim,
                false => above.group_from_prim[time] * local.parent_from_prim,
            };
        }
        if let Some(purpose) = prim.word("purpose")?.filter(|purpose| purpose != "default") {
            state.purpose = Some(purpose);
        }
        if !above.material.as_ref().is_some_and(|(_, is_stronger)| *is_stronger)
            && let Some(own) = self.binding(prim)?
        {
            state.material = Some(own);
        }
        Ok(state)
    }

    /// The material of a prim itself, and whether it is stronger than those below.
    fn binding<'s>(&mut self, prim: &Prim<'s>) -> Result<Option<(Prim<'s>, bool)>> {
        for property in ["material:binding:full", "material:binding"] {
            if let Some(material) = prim.targets(property)?.into_iter().next() {
                let strength = prim.described(property, "bindMaterialAs")?;
                return Ok(Some((material, strength.as_deref() == Some("strongerThanDescendants"))));
            }
        }
        if prim.properties()?.iter().any(|name| name.starts_with("material:binding:collection")) {
            self.log.warn("not-drawn", prim.path(), "materials of collections are not drawn");
        }
        Ok(None)
    }

    /// Adds what a prim is by itself.
    fn shape(&mut self, prim: &Prim, kind: &str, state: &State, group: &mut Group) -> Result<()> {
        match kind {
            "Mesh" => {
                let Some(placement) = self.placement(&state.group_from_prim, prim) else { return Ok(()) };
                let mut mesh = Mesh {
                    prim,
                    material: state.material.as_ref().map(|(material, _)| material.clone()),
                    subsets: Vec::new(),
                    is_two_sided: prim.flag("doubleSided")?,
                    materials: &mut self.materials,
                    desc: self.desc,
                    log: self.log,
                };
                if !state.material.as_ref().is_some_and(|(_, is_stronger)| *is_stronger) {
                    mesh.subsets = subsets(prim)?;
                }
                let solids = mesh.shapes()?;
                solids.into_iter().for_each(|solid| group.add(solid, placement));
                if prim.has_schema("SkelBindingAPI")? {
                    self.log.warn("not-drawn", prim.path(), "meshes do not follow skeletons");
                }
            }
            "PointInstancer" => self.instancer(prim, state, group)?,
            "BasisCurves" | "Points" => {
                let count = prim.array::<3>("points")?.map_or(0, |points| points.len());
                let faces = prim.integers("curveVertexCounts")?.map_or(1, |counts| counts.len());
                let counts = Counts { faces, points: count, varying: count, corners: count };
                let colors = self.log.keep(Primvar::<3>::of(prim, "displayColor", counts)).flatten();
                let shapes = match kind {
                    "Points" => curves::points(prim, colors.as_ref(), self.log)?,
                    _ => curves::read(prim, self.log)?,
                };
                let color = |number: usize| {
                    let colors = colors.as_ref()?;
                    let value = colors.values.get(number).or(colors.values.first())?;
                    Some(value.map(|v| v as f32))
                };
                for (number, solid) in shapes {
                    self.solid(prim, solid, color(number), state, group)?;
                }
            }
            kind if solid::KINDS.contains(&kind) => {
                let counts = Counts { faces: 1, points: 1, varying: 1, corners: 1 };
                let colors = self.log.keep(Primvar::<3>::of(prim, "displayColor", counts)).flatten();
                let color = colors.and_then(|colors| Some(colors.values.first()?.map(|v| v as f32)));
                for solid in solid::read(prim, kind)? {
                    self.solid(prim, solid, color, state, group)?;
                }
            }
            "Camera" if state.nesting == 0 => {
                let view = camera::view(prim, state.group_from_prim)?;
                self.views.push((prim.path().to_owned(), view));
            }
            kind if light::KINDS.contains(&kind) => {
                let Some(placement) = self.placement(&state.group_from_prim, prim) else { return Ok(()) };
                match light::read(prim, kind, placement, &mut self.materials, self.desc, self.log)? {
                    Some(Light::Light(light)) => group.lights.push(*light),
                    Some(Light::Shapes(solids, intensity)) => {
                        if state.nesting == 0 {
                            self.lamps.push(Lamp { place: placement.start.w_axis.truncate(), intensity });
                        }
                        solids.into_iter().for_each(|solid| group.add(solid, placement));
                    }
                    None => {}
                }
            }
            "NurbsPatch" | "NurbsCurves" | "HermiteCurves" | "TetMesh" | "Volume" | "GeometryLight"
            | "PortalLight" | "PluginLight" => {
                let message = format!("prims of the schema `{kind}` are not drawn");
                self.log.warn("not-drawn", prim.path(), message);
            }
            _ => {}
        }
        Ok(())
    }

    /// Adds a shape of the material of its prim, or of a colour if it has none.
    fn solid(
        &mut self,
        prim: &Prim,
        solid: Solid,
        color: Option<[f32; 3]>,
        state: &State,
        group: &mut Group,
    ) -> Result<()> {
        let Some(placement) = self.placement(&state.group_from_prim, prim) else { return Ok(()) };
        let material = match &state.material {
            Some((material, _)) => {
                self.materials.get(material, prim.flag("doubleSided")?, self.desc, self.log)
            }
            None => None,
        };
        let surface = match material {
            Some(Material { surfaces: [surface, _], .. }) => surface,
            None => self.materials.plain(color, self.desc),
        };
        let shape = ShapeDesc {
            material: Some(surface.material),
            area_light: surface.area_light,
            alpha: surface.alpha,
            ..solid.shape
        };
        group.add(Solid { shape, ..solid }, placement);
        Ok(())
    }

    /// A place by its transforms; `None`, with a message, if it has no inverse.
    fn placement(&mut self, [start, end]: &[DMat4; 2], prim: &Prim) -> Option<TransformDesc> {
        let is_placed = |matrix: &DMat4| matrix.is_finite() && matrix.inverse().is_finite();
        if is_placed(start) && is_placed(end) {
            return Some(TransformDesc { start: *start, end: *end, ..TransformDesc::default() });
        }
        self.log.warn("not-drawn", prim.path(), "what is scaled to nothing is not drawn");
        None
    }

    /// A group that is drawn at several places, made once for a key.
    fn prototype(
        &mut self,
        key: &str,
        state: &State,
        fill: impl FnOnce(&mut Self, &State, &mut Group) -> Result<()>,
    ) -> Result<Prototype> {
        if let Some(known) = self.prototypes.get(key) {
            return Ok(known.clone());
        }
        let inner = State {
            group_from_world: DMat4::IDENTITY,
            group_from_prim: [DMat4::IDENTITY; 2],
            nesting: state.nesting + 1,
            ..state.clone()
        };
        let mut group = Group::default();
        fill(self, &inner, &mut group)?;
        let mut object = ObjectDesc {
            name: key.split(' ').next().unwrap_or_default().to_owned(),
            ..ObjectDesc::default()
        };
        let is_empty = group.shapes.is_empty() && group.instances.is_empty();
        group.shapes.into_iter().for_each(|shape| _ = object.shapes.push(shape));
        group.instances.into_iter().for_each(|instance| _ = object.instances.push(instance));
        let object = (!is_empty).then(|| self.desc.objects.push(object));
        let prototype = Prototype { object, lights: group.lights, bounds: group.bounds };
        self.prototypes.insert(key.to_owned(), prototype.clone());
        Ok(prototype)
    }

    /// Adds the copies of an instancer.
    fn instancer(&mut self, prim: &Prim, state: &State, group: &mut Group) -> Result<()> {
        if state.nesting >= MOST_NESTED {
            return Err(prim.fault("", format!("instances more than {MOST_NESTED} deep are not drawn")));
        }
        let mut prototypes = Vec::new();
        for target in prim.targets("prototypes")? {
            let key =
                format!("{} {:?} {:?}", target.path(), state.purpose, state.material.as_ref().map(|m| &m.0));
            prototypes.push(self.prototype(&key, state, |assembly, state, group| {
                if !target.is_there() {
                    return Err(prim.fault("prototypes", format!("there is no `{}`", target.path())));
                }
                // Prototypes are drawn even where they are no prims of the scene themselves.
                let kind = target.kind()?;
                let state = assembly.below(&target, state)?;
                assembly.content(&target, &kind, &state, group)
            })?);
        }
        let copies =
            [instancer::copies(prim, prototypes.len(), 0)?, instancer::copies(prim, prototypes.len(), 1)?];
        let [first, last] = &copies;
        for (index, (prototype, start)) in first.iter().enumerate() {
            let end = last.get(index).filter(|_| last.len() == first.len()).map_or(*start, |(_, end)| *end);
            let [from, until] = state.group_from_prim;
            if let Some(placement) = self.placement(&[from * *start, until * end], prim) {
                place(&prototypes[*prototype], placement, group);
            }
        }
        Ok(())
    }
}

impl Group {
    /// Adds a shape at a place.
    fn add(&mut self, solid: Solid, placement: TransformDesc) {
        let own = solid.shape.world_from_object.start;
        let (start, end) = (placement.start * own, placement.end * own);
        let world_from_object = TransformDesc { start, end, ..placement };
        self.enclose(solid.bounds, &world_from_object);
        self.shapes.push(ShapeDesc { world_from_object, ..solid.shape });
    }

    /// Grows the box by another one.
    fn enclose(&mut self, [low, high]: [DVec3; 2], placement: &TransformDesc) {
        if !low.cmple(high).all() {
            return;
        }
        for matrix in [placement.start, placement.end] {
            for corner in 0..8 {
                let pick = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
                let point = matrix.transform_point3(DVec3::new(pick(0), pick(1), pick(2)));
                self.bounds = [self.bounds[0].min(point), self.bounds[1].max(point)];
            }
        }
    }
}

/// Adds a prototype at a place.
fn place(prototype: &Prototype, placement: TransformDesc, group: &mut Group) {
    for light in &prototype.lights {
        let own = light.world_from_light;
        let (start, end) = (placement.start * own.start, placement.end * own.end);
        let world_from_light = TransformDesc { start, end, ..placement };
        group.lights.push(LightDesc { world_from_light, ..light.clone() });
    }
    if let Some(object) = prototype.object {
        group.instances.push(InstanceDesc { object, world_from_object: placement });
        group.enclose(prototype.bounds, &placement);
    }
}

/// The subsets of the faces of a mesh that have materials.
fn subsets<'s>(prim: &Prim<'s>) -> Result<Vec<(Vec<i64>, Prim<'s>)>> {
    let mut subsets = Vec::new();
    for child in prim.children()? {
        if child.kind()? != "GeomSubset"
            || child.word("elementType")?.is_some_and(|kind| kind != "face")
            || child.word("familyName")?.is_some_and(|name| name != "materialBind" && !name.is_empty())
        {
            continue;
        }
        if let Some(material) = child.targets("material:binding")?.into_iter().next() {
            subsets.push((child.integers("indices")?.unwrap_or_default(), material));
        }
    }
    Ok(subsets)
}

/// The view that is looked through: that of the chosen camera, else the first.
pub(super) fn chosen(
    views: Vec<(String, View)>,
    choice: Option<&crate::selection::Choice>,
) -> Result<Option<View>> {
    let index = match choice {
        None => 0,
        Some(choice) => {
            let names: Vec<&str> = views.iter().map(|(path, _)| path.as_str()).collect();
            let by_name = names.iter().position(|path| path.rsplit('/').next() == Some(&choice.0));
            match by_name {
                Some(index) => index,
                None => choice.index("camera", &names).map_err(|fault| Fault { ..fault })?,
            }
        }
    };
    Ok(views.into_iter().nth(index).map(|(_, view)| view))
}
