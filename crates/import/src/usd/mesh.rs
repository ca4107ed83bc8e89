//! Meshes: their faces and values as shapes of the scene.

use std::collections::HashMap;

use description::{
    ImageDesc, ImageTextureDesc, MeshDesc, SceneDesc, ShapeDesc, ShapeKind, TextureDesc, TextureKind,
};
use math::{DVec3, Vec3};

use super::material::{Material, Materials, diffuse};
use super::primvar::{Interpolation, Primvar};
use super::solid::Solid;
use super::stage::Prim;
use super::subdivision::{Creases, Surface, edge_key, positions};
use super::topology::{Faces, Values, triangulate};
use crate::log::{Log, Result};
use crate::primitives::{self, Look, Vertices};

/// A mesh, and what its shapes are made with.
pub(super) struct Mesh<'m, 's, 'a> {
    pub prim: &'m Prim<'s>,
    /// The material of what no subset has one for.
    pub material: Option<Prim<'s>>,
    /// Subsets of faces by their numbers, with their materials.
    pub subsets: Vec<(Vec<i64>, Prim<'s>)>,
    pub is_two_sided: bool,
    pub materials: &'m mut Materials<'a>,
    pub desc: &'m mut SceneDesc,
    pub log: &'m mut Log,
}

/// The faces that a mesh has at the times that are drawn.
struct Body {
    surface: Surface,
    is_left_handed: bool,
    /// Times that the renderer subdivides triangles.
    loops: i32,
}

impl<'s> Mesh<'_, 's, '_> {
    /// The shapes of the mesh.
    pub fn shapes(&mut self) -> Result<Vec<Solid>> {
        let prim = self.prim;
        let points = self.points(0)?;
        if points.is_empty() {
            return Ok(Vec::new());
        }
        let faces = Faces::read(prim, points.len())?;
        // Which part of the mesh each face is of; the last one is what is left.
        let mut parts = vec![self.subsets.len(); faces.len()];
        for (number, (indices, _)) in self.subsets.iter().enumerate() {
            for &index in indices {
                let part = usize::try_from(index).ok().and_then(|index| parts.get_mut(index));
                *part.ok_or_else(|| {
                    prim.fault("", format!("a subset has a face {index}, which is not there"))
                })? = number;
            }
        }
        for hole in prim.integers("holeIndices")?.unwrap_or_default() {
            if let Some(part) = usize::try_from(hole).ok().and_then(|hole| parts.get_mut(hole)) {
                *part = usize::MAX;
            }
        }
        let later = self.points(1)?;
        let moves = later != points && later.len() == points.len();
        let points = if moves { vec![points, later] } else { vec![points] };
        let mut solids = Vec::new();
        let mut bodies: HashMap<(String, Option<String>), Body> = HashMap::new();
        for part in 0..=self.subsets.len() {
            if !parts.contains(&part) {
                continue;
            }
            let bound =
                self.subsets.get(part).map(|(_, material)| material).or(self.material.as_ref()).cloned();
            let material =
                bound.and_then(|bound| self.materials.get(&bound, self.is_two_sided, self.desc, self.log));
            let set = material.as_ref().map_or("st".to_owned(), |material| material.set.clone());
            let colors = match &material {
                Some(material) => material.colors.clone(),
                None => Some("displayColor".to_owned()),
            };
            let key = (set, colors);
            if !bodies.contains_key(&key) {
                let body = self.body(&faces, &points, &key.0, key.1.as_deref())?;
                bodies.insert(key.clone(), body);
            }
            let body = &bodies[&key];
            solids.extend(self.part(body, material.as_ref(), |face| parts[face as usize] == part)?);
        }
        Ok(solids)
    }

    fn points(&self, time: usize) -> Result<Vec<[f64; 3]>> {
        let points = self.prim.array_at::<3>("points", time)?.unwrap_or_default();
        match points.iter().position(|point| point.iter().any(|v| !v.is_finite())) {
            Some(index) => Err(self.prim.fault("points", format!("the point {index} is not finite"))),
            None => Ok(points),
        }
    }

    /// The faces with the values of a set of texture coordinates and of colours.
    fn body(
        &mut self,
        faces: &Faces,
        points: &[Vec<[f64; 3]>],
        set: &str,
        colors: Option<&str>,
    ) -> Result<Body> {
        let prim = self.prim;
        let counts = faces.elements(points[0].len());
        // Faulty values are reported, and the mesh drawn without.
        let uvs = self.log.keep(Primvar::of(prim, set, counts)).flatten();
        let colors = colors.and_then(|name| self.log.keep(Primvar::of(prim, name, counts)).flatten());
        let mut values = Values { normals: None, uvs, colors };
        let is_left_handed = prim.word("orientation")?.as_deref() == Some("leftHanded");
        let scheme = prim.word("subdivisionScheme")?.unwrap_or_else(|| "catmullClark".to_owned());
        let surface = |values| Surface {
            faces: faces.clone(),
            points: points.to_vec(),
            values,
            creases: Creases::default(),
        };
        let (surface, loops) = match scheme.as_str() {
            "catmullClark" => {
                let creases = creases(prim)?;
                let mut smooth = Surface { creases, ..surface(values) }.smooth();
                if is_left_handed {
                    let normals = smooth.values.normals.iter_mut().flat_map(|normals| &mut normals.values);
                    normals.for_each(|normal| *normal = normal.map(|v| -v));
                }
                (smooth, 0)
            }
            "loop" => {
                if values.uvs.take().is_some() {
                    let message = "texture coordinates of subdivided triangles are not drawn";
                    self.log.warn("not-drawn", prim.path(), message);
                }
                values.colors =
                    values.colors.filter(|colors| colors.interpolation == Interpolation::Constant);
                (surface(values), 3)
            }
            "none" | "bilinear" => {
                let primvar = self.log.keep(Primvar::of(prim, "normals", counts)).flatten();
                let own = || Primvar::read(prim, "normals", Interpolation::Vertex, counts);
                values.normals = match primvar {
                    Some(normals) => Some(normals),
                    None => self.log.keep(own()).flatten(),
                };
                (surface(values), 0)
            }
            other => {
                let message = format!("`{other}` is not a scheme of subdivision");
                return Err(prim.fault("subdivisionScheme", message));
            }
        };
        Ok(Body { surface, is_left_handed, loops })
    }

    /// The shapes of the faces of one material.
    fn part(
        &mut self,
        body: &Body,
        material: Option<&Material>,
        is_chosen: impl Fn(u32) -> bool,
    ) -> Result<Vec<Solid>> {
        let surface = &body.surface;
        let at: Vec<Vec<Vec3>> = surface.points.iter().map(|points| positions(points)).collect();
        let (mut start, points) =
            triangulate(&at[0], &surface.faces, &surface.values, body.is_left_handed, is_chosen);
        let first = start.colors.first().copied();
        let is_even = start.colors.iter().all(|color| Some(*color) == first);
        let mut image = None;
        let end = at.get(1).map(|later| {
            let mut end = start.clone();
            for (position, &point) in end.positions.iter_mut().zip(&points) {
                *position = later[point as usize];
            }
            end
        });
        let mut end = end;
        if !is_even {
            let (unwrapped, picture) = primitives::unwrapped(&start, [1.0; 3]);
            end = end.map(|end| primitives::unwrapped(&end, [1.0; 3]).0);
            start = unwrapped;
            let name = format!("{}.primvars:displayColor", self.prim.path());
            image = Some(self.desc.images.push(ImageDesc { name, image: picture.into() }));
        }
        let mut surfaces = match (material, image) {
            (Some(material), _) => material.surfaces.clone(),
            (None, None) => {
                let plain = self.materials.plain(first, self.desc);
                [plain.clone(), plain]
            }
            (None, Some(image)) => {
                let texture = TextureKind::Image(ImageTextureDesc::new(image));
                let texture = self.desc.spectrum_textures.push(TextureDesc::new(texture));
                let plain = diffuse(texture.into(), self.desc);
                [plain.clone(), plain]
            }
        };
        if let (Some(_), Some(color)) = (material.and_then(|material| material.colors.as_ref()), first) {
            // A material whose base colour is a primvar is made again for its colours.
            surfaces = surfaces.map(|surface| {
                let base = match image {
                    Some(image) => {
                        let texture = TextureKind::Image(ImageTextureDesc::new(image));
                        self.desc.spectrum_textures.push(TextureDesc::new(texture)).into()
                    }
                    None => description::SpectrumDesc::rgb(color[0], color[1], color[2]).into(),
                };
                let mut desc = self.desc.materials[surface.material].clone();
                if let description::MaterialKind::OpenPbr(principled) = &mut desc.kind {
                    principled.colors[0] = base;
                }
                primitives::Surface { material: self.desc.materials.push(desc), ..surface }
            });
        }
        let has_normals = material.is_some_and(|material| material.has_normals);
        let triangles = std::mem::take(&mut start.triangles);
        let look = Look { has_normals, is_stretched: false, parts: vec![(triangles, surfaces)] };
        let vertices = Vertices { start, end };
        let opacity = match material {
            None => self.opacity()?,
            Some(_) => None,
        };
        let shapes = look.shapes(&vertices, self.desc).into_iter();
        Ok(shapes.filter_map(|shape| solid(shape, opacity, body.loops)).collect())
    }

    /// The opacity of a mesh without a material, if it is not opaque.
    fn opacity(&mut self) -> Result<Option<f32>> {
        let values = self.prim.array::<1>("primvars:displayOpacity")?.unwrap_or_default();
        let count = values.len().max(1) as f64;
        let mean = values.iter().map(|[value]| value.clamp(0.0, 1.0)).sum::<f64>() / count;
        if values.is_empty() || !mean.is_finite() || mean >= 1.0 {
            return Ok(None);
        }
        if values.iter().any(|value| *value != values[0]) {
            self.log.warn("not-drawn", self.prim.path(), "opacity that varies is drawn as its mean");
        }
        Ok(Some(mean as f32))
    }
}

/// A shape with the box around its triangles; `None` if it has none.
fn solid(mut shape: ShapeDesc, opacity: Option<f32>, loops: i32) -> Option<Solid> {
    let ShapeKind::Triangles(mesh) = &shape.kind else { return None };
    let corners = mesh.indices.iter().flatten().map(|&vertex| mesh.positions[vertex as usize].as_dvec3());
    let later = mesh.later.iter().flat_map(|key| key.positions.iter().map(|point| point.as_dvec3()));
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for point in corners.chain(later) {
        (low, high) = (low.min(point), high.max(point));
    }
    if loops > 0 {
        let mesh = MeshDesc { normals: [].into(), tangents: [].into(), uvs: [].into(), ..mesh.clone() };
        shape.kind = ShapeKind::LoopSubdivision { mesh, levels: loops };
    }
    if let Some(opacity) = opacity {
        shape.alpha = Some(opacity.into());
    }
    Some(Solid { shape, bounds: [low, high] })
}

/// Where a mesh is sharp.
fn creases(prim: &Prim) -> Result<Creases> {
    let mut creases = Creases {
        has_round_corners: matches!(prim.word("interpolateBoundary")?.as_deref(), Some("edgeOnly" | "none")),
        ..Creases::default()
    };
    let points = prim.integers("creaseIndices")?.unwrap_or_default();
    let lengths = prim.integers("creaseLengths")?.unwrap_or_default();
    let sharpnesses = prim.array::<1>("creaseSharpnesses")?.unwrap_or_default();
    let (mut first, mut edge) = (0_usize, 0);
    let edges: i64 = lengths.iter().map(|length| (length - 1).max(0)).fold(0, i64::saturating_add);
    let is_per_edge = sharpnesses.len() as i64 == edges && sharpnesses.len() != lengths.len();
    for (number, &length) in lengths.iter().enumerate() {
        let length = usize::try_from(length).unwrap_or(0);
        let end = first.checked_add(length).filter(|&end| end <= points.len());
        let Some(end) = end else {
            return Err(prim.fault("creaseLengths", "the creases do not have as many points"));
        };
        for pair in points[first..end].windows(2) {
            let sharpness = sharpnesses.get(if is_per_edge { edge } else { number });
            let Some([sharpness]) = sharpness else {
                return Err(prim.fault("creaseSharpnesses", "there are fewer than creases"));
            };
            let key = edge_key(pair[0].max(0) as u32, pair[1].max(0) as u32);
            creases.edges.insert(key, sharpness.clamp(0.0, 10.0));
            edge += 1;
        }
        first = end;
    }
    let corners = prim.integers("cornerIndices")?.unwrap_or_default();
    let sharpnesses = prim.array::<1>("cornerSharpnesses")?.unwrap_or_default();
    for (corner, [sharpness]) in corners.iter().zip(sharpnesses) {
        creases.corners.insert((*corner).max(0) as u32, sharpness.clamp(0.0, 10.0));
    }
    Ok(creases)
}
