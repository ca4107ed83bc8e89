//! Wavefront OBJ meshes and the materials of MTL files.
//!
//! Read: `v`, `vt`, `vn`, `f` (corners `v`, `v/t`, `v//n`, `v/t/n`; negative indices count
//! backwards), `usemtl`, `mtllib`, and lines continued by a backslash. `p` and `l` are checked and
//! ignored; everything else is skipped.

use std::collections::HashMap;

use math::{Vec2, Vec3};

use super::{Mesh, MeshError, invalid};
use crate::number;

/// An OBJ file: one mesh per material.
#[derive(Debug, Default)]
pub(crate) struct Obj {
    /// Names of material files.
    pub(crate) libraries: Vec<String>,
    /// Material names (empty for none) and the faces with each.
    pub(crate) parts: Vec<(String, Mesh)>,
}

/// A material of an MTL file; parameters that are not given are absent.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct ObjMaterial {
    pub(crate) name: String,
    pub(crate) diffuse: Option<[f32; 3]>,
    pub(crate) specular: Option<[f32; 3]>,
    pub(crate) emission: Option<[f32; 3]>,
    /// Phong exponent.
    pub(crate) shininess: Option<f32>,
    pub(crate) index_of_refraction: Option<f32>,
    /// 1 is opaque.
    pub(crate) opacity: Option<f32>,
    pub(crate) diffuse_map: Option<String>,
    pub(crate) illumination: Option<i32>,
}

/// Reads an OBJ file as one mesh, whatever its materials.
pub fn read_obj(bytes: &[u8]) -> Result<Mesh, MeshError> {
    let mut parts = read(bytes, false)?.parts;
    Ok(parts.remove(0).1)
}

/// Reads an OBJ file as one mesh per material.
pub(crate) fn read_obj_parts(bytes: &[u8]) -> Result<Obj, MeshError> {
    read(bytes, true)
}

/// A corner of a face: indices of position, texture coordinates and normal.
type Corner = (u32, Option<u32>, Option<u32>);

/// A mesh being built, with the vertex of each distinct corner.
#[derive(Default)]
struct Part {
    mesh: Mesh,
    vertices: HashMap<Corner, u32>,
    /// Whether some corner has no normal, or no texture coordinates: then the part has none.
    lacks_normals: bool,
    lacks_uvs: bool,
}

fn read(bytes: &[u8], by_material: bool) -> Result<Obj, MeshError> {
    let mut obj = Obj::default();
    let (mut positions, mut uvs, mut normals) = (Vec::<Vec3>::new(), Vec::<Vec2>::new(), Vec::<Vec3>::new());
    let mut parts: Vec<(String, Part)> = Vec::new();
    let mut places: HashMap<String, usize> = HashMap::new();
    let mut material = String::new();
    let mut corners: Vec<Corner> = Vec::new();
    for line in lines(bytes) {
        let mut words = words(line);
        match words.next() {
            Some(b"v") => positions.push(Vec3::from_array(floats(words)?)),
            Some(b"vn") => normals.push(Vec3::from_array(floats(words)?)),
            Some(b"vt") => {
                let [u] = floats(words.clone())?;
                let v = words.nth(1).and_then(number::float).unwrap_or(0.0);
                uvs.push(Vec2::new(u, v));
            }
            Some(keyword @ (b"f" | b"p" | b"l")) => {
                corners.clear();
                for word in words {
                    corners.push(corner(word, [positions.len(), uvs.len(), normals.len()])?);
                }
                if keyword != b"f" {
                    continue;
                }
                let place = *places.entry(material.clone()).or_insert_with(|| {
                    parts.push((material.clone(), Part::default()));
                    parts.len() - 1
                });
                parts[place].1.push_face(&corners, &positions, &uvs, &normals);
            }
            Some(b"usemtl") if by_material => material = rest_of_line(line, 6),
            Some(b"mtllib") => {
                obj.libraries.extend(rest_of_line(line, 6).split_whitespace().map(str::to_owned));
            }
            _ => (),
        }
    }
    obj.parts = parts.into_iter().map(|(material, part)| (material, part.finish())).collect();
    obj.parts.retain(|(_, mesh)| !mesh.triangles.is_empty() || !mesh.quads.is_empty());
    if obj.parts.is_empty() {
        return Err(MeshError::Unsupported("it has no faces".into()));
    }
    Ok(obj)
}

impl Part {
    fn push_face(&mut self, corners: &[Corner], positions: &[Vec3], uvs: &[Vec2], normals: &[Vec3]) {
        let mut face: Vec<u32> = Vec::with_capacity(corners.len());
        for &corner in corners {
            let (position, uv, normal) = corner;
            // A repeated corner adds nothing to the face.
            let repeats =
                |&earlier: &u32| self.mesh.positions[earlier as usize] == positions[position as usize];
            if face.last().is_some_and(repeats) {
                continue;
            }
            let mesh = &mut self.mesh;
            let vertex = *self.vertices.entry(corner).or_insert_with(|| {
                mesh.positions.push(positions[position as usize]);
                mesh.uvs.push(uv.map_or(Vec2::ZERO, |uv| uvs[uv as usize]));
                mesh.normals.push(normal.map_or(Vec3::ZERO, |normal| normals[normal as usize]));
                mesh.positions.len() as u32 - 1
            });
            self.lacks_uvs |= uv.is_none();
            self.lacks_normals |= normal.is_none();
            face.push(vertex);
        }
        self.mesh.push_face(&face, None);
    }

    fn finish(mut self) -> Mesh {
        if self.lacks_uvs {
            self.mesh.uvs = Vec::new();
        }
        if self.lacks_normals {
            self.mesh.normals = Vec::new();
        }
        self.mesh
    }
}

/// The lines of a file without comments; a backslash at the end of a line joins it to the next.
fn lines(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    // Joined lines are rare: a file without them is searched once, and its lines are slices of it.
    let mut rest = bytes;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        let mut end = 0;
        loop {
            end += rest[end..].iter().position(|&byte| byte == b'\n').unwrap_or(rest.len() - end);
            let before = rest[..end].strip_suffix(b"\r").unwrap_or(&rest[..end]);
            if end < rest.len() && before.ends_with(b"\\") {
                end += 1;
            } else {
                break;
            }
        }
        let line = &rest[..end];
        rest = &rest[(end + 1).min(rest.len())..];
        let is_comment = |at: &usize| line[*at] == b'#' && (*at == 0 || line[*at - 1].is_ascii_whitespace());
        Some(&line[..(0..line.len()).find(is_comment).unwrap_or(line.len())])
    })
}

/// The words of a line, without the backslashes that join lines.
fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> + Clone {
    line.split(|&byte| byte.is_ascii_whitespace() || byte == b'\\').filter(|word| !word.is_empty())
}

/// The rest of a line after its keyword.
fn rest_of_line(line: &[u8], keyword: usize) -> String {
    String::from_utf8_lossy(&line.trim_ascii_start()[keyword..]).trim().to_owned()
}

fn floats<'a, const N: usize>(mut words: impl Iterator<Item = &'a [u8]>) -> Result<[f32; N], MeshError> {
    let mut values = [0.0; N];
    for value in &mut values {
        let word = words.next().unwrap_or(b"");
        match number::float(word).filter(|value| value.is_finite()) {
            Some(number) => *value = number,
            None => return invalid(format!("`{:.40}` is not a number", String::from_utf8_lossy(word))),
        }
    }
    Ok(values)
}

fn corner(word: &[u8], counts: [usize; 3]) -> Result<Corner, MeshError> {
    let mut indices = [None; 3];
    for (place, text) in word.split(|&byte| byte == b'/').enumerate() {
        if place == 3 {
            return invalid(format!("`{:.40}` is not a face corner", String::from_utf8_lossy(word)));
        }
        if text.is_empty() && place > 0 {
            continue;
        }
        let count = counts[place] as i64;
        let index = match number::integer(text).map(i64::from) {
            Some(index @ 1..) if index <= count => index - 1,
            Some(index @ ..=-1) if -index <= count => count + index,
            _ => {
                let text = String::from_utf8_lossy(text);
                return invalid(format!("a corner has index `{text:.40}`, but only {count} are defined"));
            }
        };
        indices[place] = u32::try_from(index).ok();
    }
    match indices {
        [Some(position), uv, normal] => Ok((position, uv, normal)),
        _ => invalid(format!("`{:.40}` is not a face corner", String::from_utf8_lossy(word))),
    }
}

/// Reads an MTL file. Parameters that cannot be read are ignored: a mesh is not refused for its
/// materials.
pub(crate) fn read_materials(bytes: &[u8]) -> Vec<ObjMaterial> {
    let mut materials: Vec<ObjMaterial> = Vec::new();
    for line in lines(bytes) {
        let mut words = words(line);
        let Some(keyword) = words.next() else { continue };
        if keyword == b"newmtl" {
            materials.push(ObjMaterial { name: rest_of_line(line, 6), ..ObjMaterial::default() });
            continue;
        }
        let Some(material) = materials.last_mut() else { continue };
        let number = |mut words: std::iter::Peekable<_>| words.next().and_then(number::float);
        match keyword {
            b"Kd" => material.diffuse = color(words),
            b"Ks" => material.specular = color(words),
            b"Ke" => material.emission = color(words),
            b"Ns" => material.shininess = number(words.peekable()),
            b"Ni" => material.index_of_refraction = number(words.peekable()),
            b"d" => material.opacity = number(words.peekable()),
            b"Tr" if material.opacity.is_none() => {
                material.opacity = number(words.peekable()).map(|transparency| 1.0 - transparency);
            }
            b"illum" => material.illumination = words.next().and_then(number::integer),
            b"map_Kd" => {
                let file = rest_of_line(line, 6);
                // Options before the name begin with a dash; the name is then the last word.
                let name = if file.starts_with('-') { file.rsplit(' ').next().unwrap_or("") } else { &file };
                material.diffuse_map = Some(name.replace('\\', "/"));
            }
            _ => (),
        }
    }
    materials
}

/// A colour of three numbers, or of one that holds for all three.
fn color<'a>(words: impl Iterator<Item = &'a [u8]>) -> Option<[f32; 3]> {
    let values: Vec<f32> = words.map_while(number::float).filter(|value| value.is_finite()).collect();
    match values[..] {
        [r, g, b, ..] => Some([r, g, b]),
        [value] => Some([value; 3]),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_share_vertices_and_concave_faces_are_cut() {
        let text = b"v 0 0 0\nv 2 -1 0\nv 0.5 0 0\nv 2 1 0\r\nvt 0 0\nf 1/1 2/1 3/1 4/1 # arrow\nf -4/1 \\\n-3/1 -2/1\n";
        let mesh = read_obj(text).unwrap();
        assert_eq!((mesh.positions.len(), mesh.uvs.len(), mesh.normals.len()), (4, 4, 0));
        assert_eq!((mesh.triangles.len(), mesh.quads.len()), (3, 0));
    }

    #[test]
    fn indices_must_be_defined_already() {
        for text in [
            "v 0 0 0\nf 1 2 3",
            "v 0 0 0\nf 0 1 1",
            "v 0 0 0\nf -2 1 1",
            "v 0 0 0\nf 1/1 1 1",
            "v 0 0 0\np 2",
            "v 0 x 0",
        ] {
            assert!(matches!(read_obj(text.as_bytes()), Err(MeshError::Invalid(_))), "{text}");
        }
    }

    #[test]
    fn faces_are_grouped_by_material() {
        let text = b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red paint\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl red paint\nf 3 2 1";
        let obj = read_obj_parts(text).unwrap();
        let sizes: Vec<_> =
            obj.parts.iter().map(|(name, mesh)| (name.as_str(), mesh.triangles.len())).collect();
        assert_eq!(sizes, [("red paint", 2), ("b", 1)]);
        assert_eq!(obj.libraries, ["a.mtl"]);
    }

    #[test]
    fn materials_are_read_leniently() {
        let text = b"newmtl red paint\nKd 1 0 0\nKe nonsense\nNs 20\nTr 0.25\nmap_Kd -s 2 2 2 tex\\a.png\nnewmtl b\nKd .5";
        let materials = read_materials(text);
        assert_eq!(materials[0].name, "red paint");
        assert_eq!((materials[0].diffuse, materials[0].emission), (Some([1.0, 0.0, 0.0]), None));
        assert_eq!(
            (materials[0].opacity, materials[0].diffuse_map.as_deref()),
            (Some(0.75), Some("tex/a.png"))
        );
        assert_eq!(materials[1].diffuse, Some([0.5; 3]));
    }
}
