//! Wavefront OBJ meshes.
//!
//! Read: `v` with colours, `vt`, `vn`, `f` (corners `v`, `v/t`, `v//n`, `v/t/n`; negative indices
//! count backwards), `s`, `usemtl`, `mtllib`, and lines continued by a backslash. Names of groups
//! and objects have no effect; all other statements are named in a warning.

use std::collections::HashMap;

use math::{DVec3, Vec2, Vec3};

use super::notes::Notes;
use super::text::{name, statements, unmarked, words};
use super::{Mesh, MeshError, decode_colors, invalid, polygon};
use crate::number;

/// An OBJ file: one mesh per material.
#[derive(Debug, Default)]
pub struct Obj {
    /// Names of material files: each a line, which may name several.
    pub libraries: Vec<String>,
    /// Material names (empty for none) and the faces with each.
    pub parts: Vec<(String, Mesh)>,
    /// Parts of the file that are not in the meshes.
    pub warnings: Vec<String>,
}

/// Reads an OBJ file as one mesh, whatever its materials.
pub fn read_obj(bytes: &[u8]) -> Result<Mesh, MeshError> {
    let Obj { mut parts, warnings, .. } = read(bytes, false)?;
    Ok(Mesh { warnings, ..parts.remove(0).1 })
}

/// Reads an OBJ file as one mesh per material.
pub fn read_obj_parts(bytes: &[u8]) -> Result<Obj, MeshError> {
    read(bytes, true)
}

/// The normal of a corner.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum NormalOf {
    /// The normal of its face alone.
    Face,
    /// One of the file.
    Given(u32),
    /// The mean over the faces of a smoothing group around the vertex.
    Group(i32),
}

/// A corner of a face, of indices into the arrays of the file.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Corner {
    position: u32,
    uv: Option<u32>,
    normal: NormalOf,
}

/// The arrays of a file, and its state at a statement.
#[derive(Default)]
struct Reader {
    positions: Vec<Vec3>,
    /// sRGB codes; empty as long as no vertex has any.
    colors: Vec<[f32; 3]>,
    uvs: Vec<Vec2>,
    normals: Vec<Vec3>,
    material: String,
    /// The smoothing group; 0 for none.
    group: i32,
    /// Sums of the normals of a group's faces around a vertex.
    smooth: HashMap<(i32, u32), DVec3>,
    parts: Vec<(String, Part)>,
    places: HashMap<String, usize>,
    libraries: Vec<String>,
    notes: Notes,
}

/// A mesh being built, with the vertex of each distinct corner.
#[derive(Default)]
struct Part {
    mesh: Mesh,
    /// The corner of each vertex.
    corners: Vec<Corner>,
    vertices: HashMap<Corner, u32>,
}

fn read(bytes: &[u8], by_material: bool) -> Result<Obj, MeshError> {
    let text = unmarked(bytes);
    let mut reader = Reader::default();
    for (line, statement) in statements(&text) {
        reader.statement(line, &statement, by_material).or_else(|error| match error {
            MeshError::Invalid(text) => invalid(format!("line {line}: {text}")),
            error => Err(error),
        })?;
    }
    let (parts, smooth) = (std::mem::take(&mut reader.parts), std::mem::take(&mut reader.smooth));
    if decode_colors(&mut reader.colors) {
        reader.notes.add_at("vertices", "colours beyond 1 are taken as codes up to 255");
    }
    let mut parts: Vec<_> =
        parts.into_iter().map(|(material, part)| (material, part.finish(&reader, &smooth))).collect();
    parts.retain(|(_, mesh)| !mesh.triangles.is_empty() || !mesh.quads.is_empty());
    if parts.is_empty() {
        return Err(MeshError::Unsupported("it has no faces".into()));
    }
    Ok(Obj { libraries: reader.libraries, parts, warnings: reader.notes.into_texts() })
}

impl Reader {
    fn statement(&mut self, line: usize, statement: &[u8], by_material: bool) -> Result<(), MeshError> {
        let mut words = words(statement);
        match words.next() {
            Some(b"v") => self.vertex(line, words)?,
            Some(b"vn") => {
                let normal = self.lenient(line, words, 3)?;
                self.normals.push(Vec3::from_array(normal));
            }
            Some(b"vt") => {
                let [u, v, _] = self.lenient(line, words, 1)?;
                self.uvs.push(Vec2::new(u, v));
            }
            Some(keyword @ (b"f" | b"fo" | b"p" | b"l")) => {
                let corners = words.map(|word| self.corner(line, word)).collect::<Result<Vec<_>, _>>()?;
                match keyword {
                    b"p" | b"l" => self.notes.add(line, "points and lines are not drawn"),
                    _ => self.face(line, corners),
                }
            }
            Some(b"s") => {
                let group = words.next().unwrap_or(b"off");
                self.group = if group == b"off" { 0 } else { number::integer(group).unwrap_or(1) };
            }
            Some(b"usemtl") if by_material => self.material = name(statement),
            Some(b"usemtl") => (),
            Some(b"mtllib") => self.libraries.push(name(statement)),
            Some(b"g" | b"o") | None => (),
            Some(keyword) => {
                self.notes.add(line, format!("`{:.40}` is not read", String::from_utf8_lossy(keyword)));
            }
        }
        Ok(())
    }

    /// A vertex: a position, and after it a weight, a colour, or a colour and its opacity.
    fn vertex<'a>(
        &mut self,
        line: usize,
        words: impl Iterator<Item = &'a [u8]> + Clone,
    ) -> Result<(), MeshError> {
        self.positions.push(Vec3::from_array(floats(words.clone())?));
        let mut more = [0.0; 5];
        let mut count = 0;
        for word in words.skip(3) {
            match number::float(word) {
                Some(number) if count < more.len() => more[count] = number,
                _ => {
                    self.notes.add(line, "what stands after a position is not a colour");
                    count = 0;
                    break;
                }
            }
            count += 1;
        }
        let color = (count >= 3).then_some([more[0], more[1], more[2]]);
        match count {
            1 if more[0] != 1.0 => self.notes.add(line, "weights of vertices are not read"),
            4 if more[3] != 1.0 => self.notes.add(line, "opacity of vertices is not drawn"),
            2 | 5 => self.notes.add(line, "a vertex has more numbers than a position and a colour"),
            _ => (),
        }
        if color.is_some() && self.colors.is_empty() {
            if self.positions.len() > 1 {
                self.notes.add(line, "only some vertices have colours: the others are white");
            }
            self.colors.resize(self.positions.len() - 1, [1.0; 3]);
        }
        if color.is_some() || !self.colors.is_empty() {
            self.colors.push(color.unwrap_or([1.0; 3]));
        }
        Ok(())
    }

    /// Numbers of a normal or of texture coordinates, of which some are optional; 0 where one is
    /// not finite, as programs write normals of faces without an area.
    fn lenient<'a>(
        &mut self,
        line: usize,
        mut words: impl Iterator<Item = &'a [u8]>,
        needed: usize,
    ) -> Result<[f32; 3], MeshError> {
        let mut values = [0.0; 3];
        for (index, value) in values.iter_mut().enumerate() {
            let Some(word) = words.next().or((index < needed).then_some(b"")) else { break };
            match number::lenient(word).map(|value| value as f32) {
                Some(number) if number.is_finite() => *value = number,
                Some(_) => self.notes.add(line, "numbers that are not finite are read as 0"),
                None => return not_a_number(word),
            }
        }
        Ok(values)
    }

    fn corner(&mut self, line: usize, word: &[u8]) -> Result<Corner, MeshError> {
        let counts = [self.positions.len(), self.uvs.len(), self.normals.len()];
        let shown = || format!("`{:.40}`", String::from_utf8_lossy(word));
        let mut indices = [None; 3];
        for (place, text) in word.split(|&byte| byte == b'/').enumerate() {
            if place > 0 && text.is_empty() {
                continue;
            }
            let Some(index) = number::integer(text).map(i64::from).filter(|_| place < 3) else {
                return invalid(format!("{} is not a face corner", shown()));
            };
            let count = counts[place] as i64;
            let index = match index {
                1.. if index <= count => index - 1,
                ..=-1 if -index <= count => count + index,
                _ if place == 0 => {
                    return invalid(format!("a corner has index `{index}`, but only {count} are defined"));
                }
                _ => {
                    let what = ["", "texture coordinates", "normal"][place];
                    let message = format!("a corner whose {what} is not defined before it has none");
                    self.notes.add_at(format_args!("line {line}, {}", shown()), message);
                    continue;
                }
            };
            indices[place] = u32::try_from(index).ok();
        }
        match indices {
            [Some(position), uv, normal] => {
                Ok(Corner { position, uv, normal: normal.map_or(NormalOf::Face, NormalOf::Given) })
            }
            _ => invalid(format!("{} is not a face corner", shown())),
        }
    }

    fn face(&mut self, line: usize, mut corners: Vec<Corner>) {
        // A repeated corner adds nothing to the face.
        corners.dedup_by_key(|corner| self.positions[corner.position as usize].to_array());
        if corners.len() < 3 {
            return;
        }
        let lacking = |has: &dyn Fn(&Corner) -> bool| corners.iter().filter(|corner| !has(corner)).count();
        let (no_uv, no_normal) =
            (lacking(&|corner| corner.uv.is_some()), lacking(&|corner| corner.normal != NormalOf::Face));
        if (no_uv > 0 && no_uv < corners.len()) || (no_normal > 0 && no_normal < corners.len()) {
            let message =
                "texture coordinates and normals that only some corners of a face have are not used";
            self.notes.add(line, message);
        }
        if no_uv > 0 {
            corners.iter_mut().for_each(|corner| corner.uv = None);
        }
        if no_normal > 0 {
            let group = self.group;
            let normal = if group == 0 { NormalOf::Face } else { NormalOf::Group(group) };
            corners.iter_mut().for_each(|corner| corner.normal = normal);
            if group != 0 {
                let positions: Vec<u32> = corners.iter().map(|corner| corner.position).collect();
                let normal = polygon::normal(&self.positions, &positions);
                for position in positions {
                    *self.smooth.entry((group, position)).or_default() += normal;
                }
            }
        }
        let place = *self.places.entry(self.material.clone()).or_insert_with(|| {
            self.parts.push((self.material.clone(), Part::default()));
            self.parts.len() - 1
        });
        self.parts[place].1.push_face(&corners, &self.positions);
    }
}

impl Part {
    fn push_face(&mut self, corners: &[Corner], positions: &[Vec3]) {
        let mut face: Vec<u32> = Vec::with_capacity(corners.len());
        for &corner in corners {
            let vertex = *self.vertices.entry(corner).or_insert_with(|| {
                self.mesh.positions.push(positions[corner.position as usize]);
                self.corners.push(corner);
                self.corners.len() as u32 - 1
            });
            face.push(vertex);
        }
        self.mesh.push_face(&face, None);
    }

    /// The mesh with what its vertices have. Faces without texture coordinates have the origin
    /// where others have some, and faces without normals their own.
    fn finish(self, file: &Reader, smooth: &HashMap<(i32, u32), DVec3>) -> Mesh {
        let Self { mut mesh, corners, .. } = self;
        if corners.iter().any(|corner| corner.uv.is_some()) {
            let uv = |corner: &Corner| corner.uv.map_or(Vec2::ZERO, |uv| file.uvs[uv as usize]);
            mesh.uvs = corners.iter().map(uv).collect();
        }
        if !file.colors.is_empty() {
            mesh.colors = corners.iter().map(|corner| file.colors[corner.position as usize]).collect();
        }
        if corners.iter().any(|corner| corner.normal != NormalOf::Face) {
            let normal = |corner: &Corner| match corner.normal {
                NormalOf::Face => Vec3::ZERO,
                NormalOf::Given(normal) => file.normals[normal as usize],
                NormalOf::Group(group) => unit(smooth[&(group, corner.position)]),
            };
            mesh.normals = corners.iter().map(normal).collect();
            let is_flat = |vertex: u32| corners[vertex as usize].normal == NormalOf::Face;
            let mut triangles = std::mem::take(&mut mesh.triangles);
            triangles.iter_mut().filter(|face| is_flat(face[0])).for_each(|face| flatten(&mut mesh, face));
            let mut quads = std::mem::take(&mut mesh.quads);
            quads.iter_mut().filter(|face| is_flat(face[0])).for_each(|face| flatten(&mut mesh, face));
            (mesh.triangles, mesh.quads) = (triangles, quads);
        }
        mesh
    }
}

/// Gives a face vertices of its own, with its normal.
fn flatten(mesh: &mut Mesh, face: &mut [u32]) {
    let normal = unit(polygon::normal(&mesh.positions, face));
    for corner in face {
        let vertex = mesh.copy_vertex(*corner);
        mesh.normals[vertex as usize] = normal;
        *corner = vertex;
    }
}

fn unit(normal: DVec3) -> Vec3 {
    normal.normalize_or_zero().as_vec3().into()
}

fn floats<'a, const N: usize>(mut words: impl Iterator<Item = &'a [u8]>) -> Result<[f32; N], MeshError> {
    let mut values = [0.0; N];
    for value in &mut values {
        let word = words.next().unwrap_or(b"");
        match number::float(word).filter(|value| value.is_finite()) {
            Some(number) => *value = number,
            None => return not_a_number(word),
        }
    }
    Ok(values)
}

fn not_a_number<T>(word: &[u8]) -> Result<T, MeshError> {
    invalid(format!("`{:.40}` is not a number", String::from_utf8_lossy(word)))
}
