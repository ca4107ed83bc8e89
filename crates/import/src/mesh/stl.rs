//! STL, the format of stereolithography: triangles without shared vertices, as text or as 50 bytes
//! each [Burns 1993].
//!
//! Triangles keep the order of their corners, counter-clockwise seen from outside. Corners at the
//! same place become one vertex. Normals of the file are those of its flat triangles and not read;
//! nor are the two bytes after each, into which some programs put a colour.

use std::collections::HashMap;

use math::Vec3;

use super::{Mesh, MeshError, invalid};
use crate::number;

/// The bytes before the number of triangles.
const HEADER: usize = 80;
/// The bytes of a triangle: its normal, its corners, and two more.
const TRIANGLE: usize = 50;

/// Reads an STL file.
pub fn read_stl(bytes: &[u8]) -> Result<Mesh, MeshError> {
    // Headers of binary files may begin as texts do, so that the length decides first.
    let count = bytes.get(HEADER..).and_then(|rest| rest.first_chunk());
    let count = count.map(|count| u32::from_le_bytes(*count) as usize);
    let triangles = bytes.get(HEADER + 4..).unwrap_or_default();
    let needed = count.map(|count| count as u64 * TRIANGLE as u64);
    let is_text = bytes.trim_ascii_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    let mut mesh = Welded::default();
    match (count, needed) {
        (Some(count), Some(needed)) if !is_text || needed == triangles.len() as u64 => {
            if needed > triangles.len() as u64 {
                let text = format!("{count} triangles do not fit in {} bytes", triangles.len());
                return Err(MeshError::Limits(text));
            }
            read_binary(&triangles[..needed as usize], &mut mesh)?;
        }
        _ if is_text => read_text(bytes, &mut mesh)?,
        _ => return invalid("it is neither text that begins with `solid` nor long enough for a binary file"),
    }
    if mesh.mesh.triangles.is_empty() {
        return Err(MeshError::Unsupported("it has no faces".into()));
    }
    Ok(mesh.mesh)
}

fn read_binary(triangles: &[u8], mesh: &mut Welded) -> Result<(), MeshError> {
    for (index, triangle) in triangles.as_chunks::<TRIANGLE>().0.iter().enumerate() {
        let number = |at: usize| f32::from_le_bytes(std::array::from_fn(|i| triangle[at + i]));
        let corners = [12, 24, 36].map(|at| Vec3::new(number(at), number(at + 4), number(at + 8)));
        if !corners.iter().all(|corner| corner.is_finite()) {
            let at = HEADER + 4 + TRIANGLE * index;
            return invalid(format!("triangle {index}, at byte {at}, has a corner that is not finite"));
        }
        mesh.push(corners);
    }
    Ok(())
}

fn read_text(bytes: &[u8], mesh: &mut Welded) -> Result<(), MeshError> {
    let mut corners = Vec::with_capacity(3);
    // How many of `solid`, `facet` and `outer` are open.
    let mut depth = 0;
    for (line, text) in bytes.split(|&byte| byte == b'\n').enumerate() {
        let wrong = |what: &str| invalid(format!("line {}: {what}", line + 1));
        let mut words = text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        let Some(keyword) = words.next() else { continue };
        match (keyword.to_ascii_lowercase().as_slice(), depth) {
            (b"solid", 0) | (b"facet", 1) | (b"outer", 2) => depth += 1,
            (b"vertex", 3) if corners.len() < 3 => {
                let mut corner = [0.0; 3];
                for value in &mut corner {
                    let number = words.next().and_then(number::float).filter(|value| value.is_finite());
                    match number {
                        Some(number) => *value = number,
                        None => return wrong("a vertex is three finite numbers"),
                    }
                }
                corners.push(Vec3::from_array(corner));
            }
            (b"vertex", 3) => return wrong("a facet has more than three vertices"),
            (b"endloop", 3) => {
                let Ok(triangle) = corners.as_slice().try_into() else {
                    return wrong("a facet has fewer than three vertices");
                };
                mesh.push(triangle);
                corners.clear();
                depth = 2;
            }
            (b"endfacet", 2) => depth = 1,
            (b"endsolid", 1) => depth = 0,
            (word, _) => {
                let word = String::from_utf8_lossy(word);
                return wrong(&format!("`{word:.40}` is not expected here"));
            }
        }
    }
    if depth > 0 {
        return invalid("the file ends before `endsolid`");
    }
    Ok(())
}

/// A mesh in which corners at the same place are one vertex.
#[derive(Default)]
struct Welded {
    mesh: Mesh,
    vertices: HashMap<[u32; 3], u32>,
}

impl Welded {
    /// Adds a triangle, unless it has two corners at the same place.
    fn push(&mut self, corners: [Vec3; 3]) {
        let triangle = corners.map(|corner| {
            // Zeros of both signs are the same.
            let key = (corner + Vec3::ZERO).to_array().map(f32::to_bits);
            *self.vertices.entry(key).or_insert_with(|| {
                self.mesh.positions.push(corner);
                self.mesh.positions.len() as u32 - 1
            })
        });
        let [a, b, c] = triangle;
        if a != b && b != c && c != a {
            self.mesh.triangles.push(triangle);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "solid a facet\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\r\n   VERTEX 1e0 0 0\n\
        \tvertex 0 1 -0\n  endloop\n endfacet\n\n facet normal 0 0 1\n outer loop\n vertex 1 0 0\n vertex 1 1 0\n\
        vertex 0 1 0\n endloop\n endfacet\nendsolid a facet\n";

    fn binary(corners: &[[f32; 9]]) -> Vec<u8> {
        let mut bytes = b"solid header of eighty bytes".to_vec();
        bytes.resize(HEADER, b' ');
        bytes.extend((corners.len() as u32).to_le_bytes());
        for triangle in corners {
            bytes.extend([0; 12]);
            bytes.extend(triangle.iter().flat_map(|value| value.to_le_bytes()));
            bytes.extend([0xff, 0x83]);
        }
        bytes
    }

    const SQUARE: [[f32; 9]; 2] =
        [[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, -0.0], [1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0]];

    #[test]
    fn both_encodings_give_the_same_mesh() {
        let mesh = read_stl(TEXT.as_bytes()).unwrap();
        assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 0.0)]);
        assert_eq!(mesh.triangles, [[0, 1, 2], [1, 3, 2]]);
        assert!(mesh.normals.is_empty());
        assert_eq!(read_stl(&binary(&SQUARE)), Ok(mesh.clone()));
        // Bytes beyond the triangles are of no use, and triangles without an area not either.
        let mut longer = binary(&[SQUARE[0], [1.0; 9], SQUARE[1]]);
        longer[..5].copy_from_slice(b"SOLID");
        assert_eq!(read_stl(&longer).unwrap().triangles.len(), 2);
        longer[0] = b'-';
        longer.push(0);
        assert_eq!(read_stl(&longer).unwrap().triangles.len(), 2);
    }

    #[test]
    fn faults_have_their_places() {
        let message = |bytes: &[u8]| read_stl(bytes).unwrap_err().to_string();
        for (from, to, expected) in [
            ("VERTEX 1e0 0 0", "vertex 1 0", "line 5: a vertex is three finite numbers"),
            ("VERTEX 1e0 0 0", "vertex 1 0 inf", "line 5: a vertex is three finite numbers"),
            ("endloop", "vertex 0 0 0\nendloop", "line 7: a facet has more than three"),
            ("\tvertex 0 1 -0\n", "", "line 6: a facet has fewer than three"),
            (" outer loop", "", "line 4: `vertex` is not expected here"),
            ("endsolid a facet", "", "ends before `endsolid`"),
        ] {
            let text = TEXT.replacen(from, to, 1);
            let found = message(text.as_bytes());
            assert!(found.contains(expected), "{found}, not {expected}");
        }
        let good = binary(&SQUARE);
        for length in 0..good.len() {
            assert!(read_stl(&good[..length]).is_err(), "{length}");
        }
        let mut bad = good.clone();
        bad[84 + 50 + 12..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
        assert!(message(&bad).contains("triangle 1, at byte 134, has a corner"), "{}", message(&bad));
        let mut many = good;
        (many[0], many[HEADER + 3]) = (b'-', 0xff);
        assert!(matches!(read_stl(&many), Err(MeshError::Limits(_))));
        assert!(message(b"solid\nendsolid").contains("no faces"));
    }
}
