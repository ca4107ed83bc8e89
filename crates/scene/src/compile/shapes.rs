//! Shapes, compiled to geometries of the world.

use super::Compiler;
use super::curves::are_strands;
use super::solids::Assembly;
use crate::scene::GeometryEntry;
use crate::texture::FloatTextureId;
use crate::traits::Occurrence;
use description::{
    Arena, Diagnostic, Handle, ImageDesc, MeshDesc, Origin, PatchMeshDesc, ShapeDesc, ShapeKind, Span,
    Spanned, Stated, TransformDesc,
};
use geometry::{
    BilinearPatch, Cone, Cylinder, Disk, Formula, FormulaError, Geometry, GroupId, Hyperboloid, Implicit,
    Instance, MeshAttributes, MovingMesh, Paraboloid, Plane, Shape, Sphere, TriangleMesh,
};
use image::require_memory;
use math::{AnimatedTransform, Bounds2, Bounds3, DMat4, Normal3, Point3, Transform};
use sampling::PiecewiseConstant2d;
use spectrum::Rgb;
use std::sync::Arc;

impl Compiler<'_> {
    /// Compiles the shapes of the world.
    pub(super) fn shapes(&mut self, shapes: &Arena<ShapeDesc>) {
        let shapes: Vec<_> = shapes.iter().map(|(_, shape)| shape).collect();
        let mut index = 0;
        for run in shapes.chunk_by(|a, b| are_strands(a, b)) {
            self.shape(run);
            self.names.add_shape(index, self.entries.len(), self.instances.len());
            index += run.len();
        }
    }

    /// Adds a shape (or strands) to the world: in render space if it is static, in a group of its
    /// own if it moves.
    fn shape(&mut self, run: &[&Stated<ShapeDesc>]) {
        let shape = run[0];
        if !shape.world_from_object.is_animated() {
            return match Transform::from_f64(self.render_from_world * shape.world_from_object.start) {
                Some(transform) => self.resting(run, GroupId::TOP, &transform),
                None => self.singular("shape", &shape.origin),
            };
        }
        let render_from_world = self.render_from_world;
        if let Some(instance) = self.moving(run, &render_from_world) {
            self.add_instance(GroupId::TOP, instance, shape.origin.span);
        }
    }

    /// Compiles a moving shape (or strands) to an instance of its own group, in a space.
    pub(super) fn moving(
        &mut self,
        run: &[&Stated<ShapeDesc>],
        space_from_world: &DMat4,
    ) -> Option<Instance> {
        let shape = run[0];
        let TransformDesc { start, end, times } = shape.world_from_object;
        let [start, end] = [start, end].map(|moved| *space_from_world * moved);
        let Some(render_from_instance) = AnimatedTransform::new(start, end, times) else {
            self.singular("shape", &shape.origin);
            return None;
        };
        let group = self.add_group();
        self.resting(run, group, &Transform::IDENTITY);
        Some(Instance { group, render_from_instance })
    }

    /// Adds a shape (or strands) that is static within a group.
    pub(super) fn resting(&mut self, run: &[&Stated<ShapeDesc>], group: GroupId, transform: &Transform) {
        let shape = run[0];
        let (material, alpha) = (self.material_id(shape.material), self.alpha(shape));
        let media = self.medium_interface(shape.medium_interface.as_ref());
        let geometries = self.geometries(run, transform);
        self.primitives += geometries.iter().map(Geometry::len).sum::<usize>();
        let bytes = self.primitives.saturating_mul(self.world.bytes_per_primitive());
        if require_memory(bytes).is_err() {
            let primitives = self.primitives;
            let message = format!("no memory for the acceleration structure of {primitives} primitives");
            self.error("out-of-memory", message, shape.origin.span);
            return;
        }
        self.shape_traits(run, &geometries);
        for geometry in geometries {
            let emitter = self.emitter(shape, &geometry, alpha);
            let id = self.world.add_geometry(group, geometry);
            let span = shape.origin.span;
            let first_light = emitter.and_then(|emitter| self.add_emitter(group, id, emitter, span));
            let single_sided = shape.single_sided;
            self.entries.push(GeometryEntry { material, alpha, single_sided, first_light, media, span });
        }
    }

    /// Records the traits of a shape that was compiled to these geometries.
    fn shape_traits(&mut self, run: &[&Stated<ShapeDesc>], geometries: &[Geometry]) {
        let kind = &run[0].kind;
        // An unbounded shape is the only one of its geometry.
        let has_no_bounds = |geometry: &Geometry| match geometry {
            Geometry::Shapes(shapes) => shapes.first().is_some_and(|shape| shape.bounds().is_none()),
            Geometry::Mesh(_) | Geometry::Spheres(_) | Geometry::Curves(_) => false,
        };
        if geometries.iter().any(has_no_bounds) {
            Occurrence::add(&mut self.traits.unbounded_shapes, kind.name(), run[0].origin.span);
        }
        if !kind.traits().has_patches {
            for shape in run {
                Occurrence::add(&mut self.traits.shapes_without_patches, kind.name(), shape.origin.span);
            }
        }
    }

    pub(super) fn singular(&mut self, what: &str, origin: &Origin) {
        self.error("singular-transform", format!("the transform of the {what} has no inverse"), origin.span);
    }

    pub(super) fn motion(&self, t: &TransformDesc) -> Option<AnimatedTransform> {
        AnimatedTransform::new(self.render_from_world * t.start, self.render_from_world * t.end, t.times)
    }

    fn alpha(&mut self, shape: &Stated<ShapeDesc>) -> Option<FloatTextureId> {
        let texture = self.float_texture(shape.alpha.as_ref()?, shape.origin.parameter("alpha"));
        self.constant_alpha(texture).is_none_or(|alpha| alpha < 1.0).then_some(texture)
    }

    pub(super) fn constant_alpha(&self, texture: FloatTextureId) -> Option<f32> {
        self.textures.textures().constant(texture)
    }

    fn geometries(&mut self, run: &[&Stated<ShapeDesc>], transform: &Transform) -> Vec<Geometry> {
        let shape = run[0];
        let reverse = shape.reverse_orientation;
        let one = |shape: Shape| vec![Geometry::from(shape)];
        match &shape.kind {
            ShapeKind::Sphere { radius, z_min, z_max, phi_max } => {
                one(Sphere::new(transform, reverse, *radius, [*z_min, *z_max], *phi_max).into())
            }
            ShapeKind::Cylinder { radius, z_min, z_max, phi_max } => {
                one(Cylinder::new(transform, reverse, *radius, [*z_min, *z_max], *phi_max).into())
            }
            ShapeKind::Cone { radius, height, phi_max } => {
                one(Cone::new(transform, reverse, *radius, *height, *phi_max).into())
            }
            ShapeKind::Paraboloid { radius, z_min, z_max, phi_max } => {
                one(Paraboloid::new(transform, reverse, *radius, [*z_min, *z_max], *phi_max).into())
            }
            ShapeKind::Hyperboloid { ends, phi_max } => {
                one(Hyperboloid::new(transform, reverse, *ends, *phi_max).into())
            }
            ShapeKind::Disk { height, radius, inner_radius, phi_max } => {
                one(Disk::new(transform, reverse, *height, *radius, *inner_radius, *phi_max).into())
            }
            ShapeKind::Plane => one(Plane::new(transform, reverse).into()),
            ShapeKind::Spheres(spheres) => self.spheres(spheres, shape, transform).into_iter().collect(),
            ShapeKind::Implicit { formula, bounds: [min, max] } => {
                let bounds = Bounds3 { min: *min, max: *max };
                let Some(formula) = self.formula(formula, &bounds) else { return Vec::new() };
                one(Implicit::new(transform, reverse, formula, &bounds).into())
            }
            ShapeKind::Solid { .. } => {
                let solid = self.solid(shape, transform, &mut Assembly::new(shape.origin.span));
                let Some(mut solid) = solid else { return Vec::new() };
                if reverse != transform.swaps_handedness() {
                    solid.turn_round();
                }
                one(solid.into())
            }
            ShapeKind::Triangles(mesh) => self.mesh(mesh, shape, transform).into_iter().collect(),
            ShapeKind::Patches(patches) => self.patches(patches, shape, transform).into_iter().collect(),
            ShapeKind::PlyMesh { triangles, patches, displacement: Some(height), edge_length } => {
                let mesh = self.displaced(triangles, patches, height, *edge_length, shape, transform);
                mesh.into_iter().collect()
            }
            ShapeKind::PlyMesh { triangles, patches, displacement: None, .. } => {
                let triangles = self.mesh(triangles, shape, transform);
                triangles.into_iter().chain(self.patches(patches, shape, transform)).collect()
            }
            ShapeKind::Curve(_) => vec![self.curves(run, transform).into()],
            ShapeKind::LoopSubdivision { mesh, levels } => {
                self.loop_subdivision(mesh, *levels, shape, transform).into_iter().collect()
            }
        }
    }

    /// Parses a formula. Warns if it certainly has no zero in the box.
    pub(super) fn formula(&mut self, text: &Spanned<String>, bounds: &Bounds3) -> Option<Formula> {
        let formula = match Formula::parse(&text.value) {
            Ok(formula) => formula,
            Err(FormulaError { place, message, help }) => {
                // The text starts after the opening quote.
                let Span { file, start, end } = text.span;
                let at = |offset: usize| (start + 1 + offset as u32).min(end);
                let span = if text.span.is_none() {
                    text.span
                } else {
                    Span::new(file, at(place.start), at(place.end))
                };
                self.diagnostics
                    .push(Diagnostic { help, ..Diagnostic::error("invalid-formula", message, span) });
                return None;
            }
        };
        let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
        if reach > Formula::MAX_COORDINATE {
            let limit = Formula::MAX_COORDINATE;
            let message = format!("the bounds reach to {reach:e}; at most {limit:e} is supported");
            self.error("invalid-bounds", message, text.span);
            return None;
        }
        if formula.has_no_zero(bounds) {
            self.warn("empty-shape", "the formula has no zero within its bounds", text.span);
        }
        Some(formula)
    }

    fn mesh(
        &mut self,
        mesh: &MeshDesc,
        shape: &Stated<ShapeDesc>,
        transform: &Transform,
    ) -> Option<Geometry> {
        if mesh.indices.is_empty() {
            return None;
        }
        let key = |positions: &Arc<[Point3]>, normals: &Arc<[Normal3]>| {
            let attributes = MeshAttributes {
                normals: given(normals),
                tangents: given(&mesh.tangents),
                uvs: given(&mesh.uvs),
            };
            let (positions, indices) = (positions.clone(), mesh.indices.clone());
            TriangleMesh::new(positions, indices, attributes, transform, shape.reverse_orientation)
        };
        let later = mesh.later.iter().map(|later| key(&later.positions, &later.normals));
        let keys = std::iter::once(key(&mesh.positions, &mesh.normals)).chain(later);
        match keys.collect::<Result<Vec<_>, _>>() {
            Ok(mut keys) if keys.len() == 1 => keys.pop().map(Geometry::from),
            Ok(keys) => {
                let mesh = MovingMesh::new(keys, shape.world_from_object.times);
                Some(Geometry::Shapes(mesh.triangles().map(Shape::from).collect()))
            }
            Err(error) => {
                self.error("invalid-mesh", error.to_string(), shape.origin.span);
                None
            }
        }
    }

    fn patches(
        &mut self,
        mesh: &PatchMeshDesc,
        shape: &Stated<ShapeDesc>,
        transform: &Transform,
    ) -> Option<Geometry> {
        if mesh.indices.is_empty() {
            return None;
        }
        let vertices = mesh.positions.len();
        let missing = mesh.indices.iter().flatten().any(|&i| i as usize >= vertices);
        let uneven = [mesh.normals.len(), mesh.uvs.len()].iter().any(|&n| n != 0 && n != vertices);
        if missing || uneven {
            let message = if missing {
                "a patch refers to a vertex that does not exist"
            } else {
                "a patch mesh needs as many normals and texture coordinates as vertices, or none"
            };
            self.error("invalid-mesh", message, shape.origin.span);
            return None;
        }
        // The image is mapped to the patch's own parameters, which texture coordinates would
        // replace.
        let image = mesh.emission_image.filter(|_| mesh.uvs.is_empty());
        let image = image.map(|handle| self.emission_distribution(handle));
        let patches = mesh.indices.iter().map(|corners| {
            let at = corners.map(|i| i as usize);
            let patch = BilinearPatch::new(
                at.map(|i| mesh.positions[i]),
                (!mesh.normals.is_empty()).then(|| at.map(|i| mesh.normals[i])),
                (!mesh.uvs.is_empty()).then(|| at.map(|i| mesh.uvs[i])),
                transform,
                shape.reverse_orientation,
            );
            Shape::from(match &image {
                Some(image) => patch.with_image(image.clone()),
                None => patch,
            })
        });
        Some(Geometry::Shapes(patches.collect()))
    }

    /// The distribution of a patch's emission over its (u, v).
    fn emission_distribution(&self, handle: Handle<ImageDesc>) -> Arc<PiecewiseConstant2d> {
        let image = &self.desc.images[handle].image;
        let (width, height) = (image.width(), image.height());
        let rows = (0..height).rev();
        let values: Vec<f32> = rows
            .flat_map(|y| (0..width).map(move |x| (x, y)))
            .map(|(x, y)| Rgb::from(image.rgb(x, y)).clamp_zero().average())
            .collect();
        Arc::new(PiecewiseConstant2d::new(&values, width as usize, Bounds2::UNIT))
    }
}

fn given<T>(values: &Arc<[T]>) -> Option<Arc<[T]>> {
    (!values.is_empty()).then(|| values.clone())
}
