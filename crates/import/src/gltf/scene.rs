//! The parts of a file put together as a scene.

use std::collections::BTreeMap;

use description::{ImageDesc, InstanceDesc, ObjectDesc, SceneDesc, ShapeDesc, ShapeKind, TransformDesc};
use math::{DAffine2, DMat4, DQuat, DVec3};

use super::accessor::Accessor;
use super::buffer::Buffers;
use super::charts::Chart;
use super::document::Document;
use super::json::{Place, Result};
use super::light::Light;
use super::material::{AlphaMode, Material};
use super::node::{Nodes, Trs};
use super::pictures::Pictures;
use super::primitive::{self, Reader};
use super::skin::Skin;
use super::surface::{Builder, Painted, coordinates};
use crate::log::Log;
use crate::primitives::{self, Look, Primitive, Surface, Vertices};

/// Nodes at a time, and where they are in the world.
pub(super) struct Pose {
    pub nodes: Nodes,
    pub world: Vec<DMat4>,
}

/// What is drawn of a file.
pub(super) struct Drawn<'a> {
    pub document: Document<'a>,
    pub buffers: &'a Buffers,
    /// Its materials, then the one of surfaces that have none.
    pub materials: &'a [Option<Material>],
    pub lights: &'a [Option<Light>],
    pub skins: &'a [Option<Skin>],
    /// The chosen variant of materials.
    pub variant: Option<usize>,
    /// The nodes as the shutter opens and closes.
    pub poses: [Pose; 2],
    /// The nodes of the scene.
    pub nodes: Vec<usize>,
}

/// Shapes that are drawn together, at one or more places.
#[derive(Default)]
struct Group {
    mesh: usize,
    weights: [Vec<f64>; 2],
    placements: Vec<TransformDesc>,
}

/// A scene while it is built.
pub(super) struct Assembly<'s, 'a> {
    pub drawn: &'s Drawn<'a>,
    pub desc: &'s mut SceneDesc,
    pub pictures: &'s mut Pictures,
    pub log: &'s mut Log,
    /// Two corners of the box around all surfaces.
    pub bounds: [DVec3; 2],
    surfaces: BTreeMap<usize, [Surface; 2]>,
}

impl<'a> Drawn<'a> {
    /// The index of the material of a primitive.
    pub fn material(&self, place: &Place) -> Result<usize> {
        let count = self.document.count("materials");
        if let (Some(variant), Some(extension)) = (self.variant, place.extension("KHR_materials_variants")?) {
            for mapping in extension.array("mappings")? {
                let variants = mapping.array("variants")?;
                let variants = variants.iter().map(Place::as_integer).collect::<Result<Vec<_>>>()?;
                if variants.contains(&variant)
                    && let Some(material) = mapping.index("material", count, "materials")?
                {
                    return Ok(material);
                }
            }
        }
        Ok(self.document.index(place, "material", "materials")?.unwrap_or(count))
    }

    /// The meshes that are drawn, each once.
    pub fn meshes(&self) -> Vec<usize> {
        if self.document.count("nodes") == 0 {
            return (0..self.document.count("meshes")).collect();
        }
        let mut meshes: Vec<_> =
            self.nodes.iter().filter_map(|&node| self.poses[0].nodes.nodes[node].mesh).collect();
        meshes.sort_unstable();
        meshes.dedup();
        meshes
    }

    /// Where a node is while the shutter is open.
    pub fn motion(&self, node: usize) -> TransformDesc {
        let [start, end] = [&self.poses[0], &self.poses[1]].map(|pose| pose.world[node]);
        TransformDesc { start, end, ..TransformDesc::default() }
    }

    /// The weights of the morph targets of a node's mesh.
    fn weights(&self, node: usize, mesh: usize) -> Result<[Vec<f64>; 2]> {
        let place = self.document.item("meshes", mesh);
        let own = place.map_or(Ok(Vec::new()), |place| {
            place.array("weights")?.iter().map(Place::as_number).collect::<Result<Vec<_>>>()
        })?;
        Ok([&self.poses[0], &self.poses[1]]
            .map(|pose| pose.nodes.nodes[node].weights.clone().unwrap_or_else(|| own.clone())))
    }
}

impl<'s, 'a> Assembly<'s, 'a> {
    pub fn new(
        drawn: &'s Drawn<'a>,
        desc: &'s mut SceneDesc,
        pictures: &'s mut Pictures,
        log: &'s mut Log,
    ) -> Self {
        let bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        Self { drawn, desc, pictures, log, bounds, surfaces: BTreeMap::new() }
    }

    /// Adds everything that is drawn but the camera.
    pub fn add_all(&mut self) {
        let mut groups = BTreeMap::new();
        if self.drawn.document.count("nodes") == 0 {
            for mesh in self.drawn.meshes() {
                groups.insert(
                    (mesh, String::new()),
                    Group { mesh, placements: vec![TransformDesc::default()], ..Group::default() },
                );
            }
        }
        for &index in &self.drawn.nodes {
            if self.log.is_full() {
                return;
            }
            if let Err(fault) = self.node(index, &mut groups) {
                self.log.fault(fault);
            }
        }
        for group in groups.into_values() {
            if let Err(fault) = self.group(group) {
                self.log.fault(fault);
            }
        }
    }

    /// Adds the light of a node, its mesh if a skin moves it, and its mesh to the groups if not.
    fn node(&mut self, index: usize, groups: &mut BTreeMap<(usize, String), Group>) -> Result<()> {
        let drawn = self.drawn;
        let node = &drawn.poses[0].nodes.nodes[index];
        let motion = drawn.motion(index);
        if let Some(light) = node.light.and_then(|light| drawn.lights[light].as_ref()) {
            if light.has_range {
                self.log.warn(
                    "not-drawn",
                    format!("{}/range", light.pointer),
                    "the light of a lamp does not end at a range",
                );
            }
            let desc = light.desc(motion).filter(|_| is_placed(&motion));
            desc.map(|desc| self.desc.lights.push(desc));
        }
        let Some(mesh) = node.mesh else { return Ok(()) };
        let weights = drawn.weights(index, mesh)?;
        if let Some(skin) = node.skin.and_then(|skin| drawn.skins[skin].as_ref()) {
            return self.skinned(mesh, &weights, skin);
        }
        let pointer = format!("/nodes/{index}");
        let place = drawn.document.item("nodes", index).unwrap_or(Place::empty(pointer.clone()));
        let mut placements = vec![motion];
        if let Some(extension) = place.extension("EXT_mesh_gpu_instancing")? {
            let copies = self.copies(&extension)?;
            let at = |copy: &DMat4| TransformDesc {
                start: motion.start * *copy,
                end: motion.end * *copy,
                ..motion
            };
            placements = copies.iter().map(at).collect();
        }
        let all = placements.len();
        placements.retain(is_placed);
        if placements.len() < all {
            self.log.warn("not-drawn", &pointer, "what is scaled to nothing is not drawn");
        }
        if placements.is_empty() {
            return Ok(());
        }
        let key = (mesh, format!("{weights:?}"));
        let group = groups.entry(key).or_insert_with(|| Group { mesh, weights, placements: Vec::new() });
        group.placements.extend(placements);
        Ok(())
    }

    /// The transforms of the copies of a mesh.
    fn copies(&self, extension: &Place) -> Result<Vec<DMat4>> {
        let (document, buffers) = (&self.drawn.document, self.drawn.buffers);
        let attributes =
            extension.object("attributes")?.ok_or_else(|| extension.invalid("`attributes` is missing"))?;
        let three = |name: &str| match Accessor::of(document, &attributes, name)? {
            Some(accessor) => accessor.vectors::<3>(buffers).map(Some),
            None => Ok(None),
        };
        let (translations, scales) = (three("TRANSLATION")?, three("SCALE")?);
        let rotations = match Accessor::of(document, &attributes, "ROTATION")? {
            Some(accessor) => Some(accessor.vectors::<4>(buffers)?),
            None => None,
        };
        let counts = [
            translations.as_ref().map(Vec::len),
            scales.as_ref().map(Vec::len),
            rotations.as_ref().map(Vec::len),
        ];
        let count = counts.into_iter().flatten().next().unwrap_or(0);
        if counts.into_iter().flatten().any(|other| other != count) {
            return Err(attributes.invalid("all attributes have as many elements"));
        }
        self.drawn.buffers.spend(extension, 300 * count as u64)?;
        let vector = |values: &Option<Vec<[f32; 3]>>, index: usize, default: DVec3| {
            values.as_ref().map_or(default, |values| DVec3::from(values[index].map(f64::from)))
        };
        let copy = |index: usize| {
            let rotation = rotations.as_ref().map_or(DQuat::IDENTITY, |values| {
                let rotation = DQuat::from_array(values[index].map(f64::from));
                if rotation.length_squared() > 1e-12 { rotation.normalize() } else { DQuat::IDENTITY }
            });
            let translation = vector(&translations, index, DVec3::ZERO);
            Trs { translation, rotation, scale: vector(&scales, index, DVec3::ONE) }.matrix()
        };
        Ok((0..count).map(copy).collect())
    }

    /// Adds a mesh at its places: as shapes if there is one, else as instances of an object.
    fn group(&mut self, group: Group) -> Result<()> {
        let [start, end] = &group.weights;
        let shapes = self.mesh(group.mesh, &mut |primitive| {
            let moved = (start != end).then(|| primitive.morphed(end));
            Some(Vertices { start: primitive.morphed(start), end: moved })
        })?;
        for placement in &group.placements {
            for shape in &shapes {
                self.enclose(shape, placement);
            }
        }
        match group.placements.as_slice() {
            [placement] => {
                for shape in shapes {
                    self.desc.shapes.push(ShapeDesc { world_from_object: *placement, ..shape });
                }
            }
            placements => {
                let mut object = ObjectDesc::default();
                for shape in shapes {
                    object.shapes.push(shape);
                }
                if object.shapes.is_empty() {
                    return Ok(());
                }
                let object = self.desc.objects.push(object);
                for &world_from_object in placements {
                    self.desc.instances.push(InstanceDesc { object, world_from_object });
                }
            }
        }
        Ok(())
    }

    /// Adds a mesh that follows a skin, at the place of its joints.
    fn skinned(&mut self, mesh: usize, weights: &[Vec<f64>; 2], skin: &Skin) -> Result<()> {
        let drawn = self.drawn;
        let [start, end] = [&drawn.poses[0], &drawn.poses[1]];
        let shapes = self.mesh(mesh, &mut |primitive| {
            let posed = |weights: &[f64], world| skin.posed(&primitive.morphed(weights), world);
            let (first, last) = (posed(&weights[0], &start.world)?, posed(&weights[1], &end.world)?);
            let moves = first.positions != last.positions;
            Some(Vertices { start: first, end: moves.then_some(last) })
        })?;
        for shape in shapes {
            self.enclose(&shape, &TransformDesc::default());
            self.desc.shapes.push(shape);
        }
        Ok(())
    }

    /// The shapes of a mesh, of whose primitives `pose` gives the vertices.
    fn mesh(
        &mut self,
        mesh: usize,
        pose: &mut dyn FnMut(&Primitive) -> Option<Vertices>,
    ) -> Result<Vec<ShapeDesc>> {
        let drawn = self.drawn;
        let mut shapes = Vec::new();
        for place in primitive::places(&drawn.document, mesh)? {
            if let Some(kind) = primitive::not_drawn(&place)? {
                self.log.warn("not-drawn", &place.pointer, format!("{kind} are not drawn"));
                continue;
            }
            let index = drawn.material(&place)?;
            let Some(material) = drawn.materials.get(index).and_then(Option::as_ref) else { continue };
            let set = coordinates(material).set;
            let mut others: Vec<_> = material.textures().iter().map(|(texture, _)| texture.set).collect();
            others.sort_unstable();
            others.dedup();
            others.retain(|&other| other != set);
            let read = Reader::new(&drawn.document, drawn.buffers, &place).and_then(|reader| {
                let stale = reader.stale_counts(&place)?;
                Ok((reader.primitive(&place, set, &others)?, stale))
            });
            let primitive = match read {
                Ok((primitive, stale)) => {
                    if let Some((pointer, message)) = stale {
                        self.log.warn("stale-count", pointer, message);
                    }
                    primitive
                }
                Err(fault) => {
                    self.log.fault(fault);
                    continue;
                }
            };
            self.not_honoured(&place, material, &primitive, set);
            let Some(vertices) = pose(&primitive) else {
                self.log.fault(
                    place.invalid_member(
                        "attributes/JOINTS_0",
                        "there are joints that the skin does not have",
                    ),
                );
                continue;
            };
            shapes.extend(self.shapes(&place, index, material, vertices));
        }
        Ok(shapes)
    }

    /// The shapes of a primitive, whose vertices may have colours.
    fn shapes(
        &mut self,
        place: &Place,
        index: usize,
        material: &Material,
        mut vertices: Vertices,
    ) -> Vec<ShapeDesc> {
        if material.alpha_mode == AlphaMode::Opaque {
            vertices.start.opacities.clear();
        }
        let (colors, opacities) = (&vertices.start.colors, &vertices.start.opacities);
        let (mut tinted, mut painted) = (None, None);
        if colors.iter().any(|color| *color != [1.0; 3]) || opacities.iter().any(|opacity| *opacity != 1.0) {
            let tinted = tinted.insert(material.clone());
            let color = colors.iter().all(|color| *color == colors[0]).then(|| colors[0]);
            let opacity = opacities.iter().all(|opacity| *opacity == opacities[0]);
            let opacity = opacity.then(|| opacities.first().copied().unwrap_or(1.0));
            if let (Some(color), Some(opacity)) = (color, opacity) {
                tinted.base.factor = std::array::from_fn(|i| tinted.base.factor[i] * color[i]);
                tinted.opacity *= opacity;
            } else if material.textures().is_empty() {
                painted = Some(self.paint(place, material, &mut vertices));
            } else {
                tinted.opacity *= opacity.unwrap_or(1.0);
                let message = "colours of vertices are not drawn on surfaces with textures";
                self.log.warn("not-drawn", format!("{}/attributes/COLOR_0", place.pointer), message);
            }
        }
        let charts = Chart::of(&vertices.start).unwrap_or_else(|| {
            let message =
                "sets of texture coordinates that belong to each other in too many ways are drawn as one";
            self.log.warn("not-drawn", format!("{}/attributes", place.pointer), message);
            vec![Chart { triangles: vertices.start.triangles.clone(), maps: BTreeMap::new() }]
        });
        let parts = charts.into_iter().map(|Chart { triangles, maps }| {
            let surfaces = match &tinted {
                None if maps.is_empty() => self.surfaces(index, material),
                _ => {
                    let material = tinted.as_ref().unwrap_or(material);
                    self.builder(&maps).both(material, painted)
                }
            };
            (triangles, surfaces)
        });
        let parts = parts.collect();
        let (has_normals, is_stretched) = (material.has_normal_map(), material.anisotropy.is_some());
        Look { has_normals, is_stretched, parts }.shapes(&vertices, self.desc)
    }

    /// The colours of vertices as images, to which their triangles are mapped.
    fn paint(&mut self, place: &Place, material: &Material, vertices: &mut Vertices) -> Painted {
        let opacities = std::mem::take(&mut vertices.start.opacities);
        let opacity = (!opacities.is_empty()).then(|| {
            let colors = opacities.iter().map(|&opacity| [opacity; 3]).collect();
            let grey = Primitive { colors, ..vertices.start.clone() };
            primitives::unwrapped(&grey, [material.opacity; 3]).1
        });
        let (start, color) = primitives::unwrapped(&vertices.start, material.base.factor);
        vertices.end = vertices.end.take().map(|end| primitives::unwrapped(&end, [1.0; 3]).0);
        vertices.start = start;
        let mut add = |image: image::Image| {
            let name = place.pointer_to("attributes/COLOR_0");
            self.desc.images.push(ImageDesc { name, image: image.into() })
        };
        Painted { color: add(color), opacity: opacity.map(add) }
    }

    /// Makes surfaces of triangles with maps between sets of texture coordinates.
    fn builder<'b>(&'b mut self, maps: &'b BTreeMap<usize, DAffine2>) -> Builder<'b> {
        Builder { desc: self.desc, pictures: self.pictures, log: self.log, maps }
    }

    /// The surfaces of a material.
    fn surfaces(&mut self, index: usize, material: &Material) -> [Surface; 2] {
        if let Some(known) = self.surfaces.get(&index) {
            return known.clone();
        }
        let surfaces = self.builder(&BTreeMap::new()).both(material, None);
        self.surfaces.insert(index, surfaces.clone());
        surfaces
    }

    /// Says what of a primitive is not drawn.
    fn not_honoured(&mut self, place: &Place, material: &Material, primitive: &Primitive, set: usize) {
        let Some(attributes) = place.get("attributes") else { return };
        if let Some(attribute) = attributes.get("JOINTS_1") {
            let message = "more than four joints of a vertex are not followed";
            self.log.warn("not-drawn", attribute.pointer, message);
        }
        if let Ok(Some(colors)) = Accessor::of(&self.drawn.document, &attributes, "COLOR_0")
            && !colors.is_float()
            && !colors.is_normalized()
        {
            let message = "integers of colours are normalised, though the accessor does not say so";
            self.log.warn("not-drawn", attributes.pointer_to("COLOR_0"), message);
        }
        for target in place.array("targets").unwrap_or_default() {
            let names = target.value.as_object().into_iter().flat_map(|target| target.keys());
            let is_drawn = |name: &String| matches!(name.as_str(), "POSITION" | "NORMAL" | "TANGENT");
            if let Some(name) = names.into_iter().find(|name| !is_drawn(name)) {
                let message = "colours and texture coordinates of morph targets are not drawn";
                self.log.warn("not-drawn", target.pointer_to(name), message);
            }
        }
        let mut missing: Vec<_> = material.textures().iter().map(|(texture, _)| texture.set).collect();
        let is_there = |wanted: usize| match wanted == set {
            true => !primitive.uvs.is_empty(),
            false => primitive.other_uvs.iter().any(|&(other, _)| other == wanted),
        };
        missing.retain(|&wanted| !is_there(wanted));
        if let Some(missing) = missing.first() {
            let message = format!("there is no `TEXCOORD_{missing}` for the textures of the material");
            self.log.warn("not-drawn", attributes.pointer, message);
        }
    }

    /// Grows the box around all surfaces.
    fn enclose(&mut self, shape: &ShapeDesc, placement: &TransformDesc) {
        let ShapeKind::Triangles(mesh) = &shape.kind else { return };
        let corners = mesh.indices.iter().flatten();
        let [mut low, mut high] = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        for &vertex in corners {
            let point = mesh.positions[vertex as usize].as_dvec3();
            (low, high) = (low.min(point), high.max(point));
        }
        for corner in 0..8 {
            let pick = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
            let point = placement.start.transform_point3(DVec3::new(pick(0), pick(1), pick(2)));
            self.bounds = [self.bounds[0].min(point), self.bounds[1].max(point)];
        }
    }
}

/// Whether a transform has an inverse.
fn is_placed(placement: &TransformDesc) -> bool {
    [placement.start, placement.end].iter().all(|m| m.is_finite() && m.inverse().is_finite())
}
