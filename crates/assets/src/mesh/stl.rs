//! STL, the format of stereolithography: triangles without shared vertices, as text or as 50 bytes
//! each [Burns 1993].
//!
//! Triangles keep the order of their corners, counter-clockwise seen from outside. Corners at the
//! same place become one vertex. Normals of the file are those of its flat triangles and not read.
//! Colours, for which programs have ways of their own, are named in a warning.

use std::collections::HashMap;

use math::Vec3;

use super::notes::Notes;
use super::text::{lines, unmarked};
use super::{Mesh, MeshError, invalid};
use crate::number;

/// The bytes before the number of triangles.
const HEADER: usize = 80;
/// The bytes of a triangle: its normal, its corners, and two more.
const TRIANGLE: usize = 50;

/// Reads an STL file.
pub fn read_stl(bytes: &[u8]) -> Result<Mesh, MeshError> {
    let text = unmarked(bytes);
    let first = text.trim_ascii_start().get(..5).unwrap_or_default().to_ascii_lowercase();
    let is_text = matches!(first.as_slice(), b"solid" | b"facet");
    let count = bytes.get(HEADER..).and_then(|rest| rest.first_chunk());
    let count = count.map(|count| u32::from_le_bytes(*count) as usize);
    let triangles = bytes.get(HEADER + 4..).unwrap_or_default();
    let needed = count.map(|count| count as u64 * TRIANGLE as u64);
    let fits = needed.is_some_and(|needed| needed > 0 && needed <= triangles.len() as u64);
    // Headers of binary files may begin as texts do, and bytes may follow their triangles: what is
    // a text is read as one, unless the length is exactly that of a binary file.
    let mesh = match (count, needed) {
        (Some(_), Some(needed)) if is_text && needed != triangles.len() as u64 => {
            // A text has no zeros, so that a binary file is not called a damaged text.
            let is_binary = fits || text[..text.len().min(HEADER + 4 + TRIANGLE)].contains(&0);
            match read_text(&text) {
                Ok(mesh) if !mesh.triangles.is_empty() || !is_binary => Ok(mesh),
                Err(error) if !is_binary => Err(error),
                _ => read_binary(triangles, count.unwrap_or(0)),
            }
        }
        (Some(count), Some(_)) => read_binary(triangles, count),
        _ if is_text => read_text(&text),
        _ => invalid("it is neither text that begins with `solid` nor long enough for a binary file"),
    }?;
    if mesh.triangles.is_empty() {
        return Err(MeshError::Unsupported("it has no faces".into()));
    }
    Ok(mesh)
}

fn read_binary(bytes: &[u8], count: usize) -> Result<Mesh, MeshError> {
    let triangles = bytes.as_chunks::<TRIANGLE>().0;
    let Some(triangles) = triangles.get(..count) else {
        return Err(MeshError::Limits(format!("{count} triangles do not fit in {} bytes", bytes.len())));
    };
    let (mut mesh, mut notes) = (Welded::default(), Notes::default());
    for (index, triangle) in triangles.iter().enumerate() {
        let number = |at: usize| f32::from_le_bytes(std::array::from_fn(|i| triangle[at + i]));
        let corners = [12, 24, 36].map(|at| Vec3::new(number(at), number(at + 4), number(at + 8)));
        if !corners.iter().all(|corner| corner.is_finite()) {
            let at = HEADER + 4 + TRIANGLE * index;
            return invalid(format!("triangle {index}, at byte {at}, has a corner that is not finite"));
        }
        if triangle[48..] != [0; 2] {
            let message = "the two bytes after it, which some programs make its colour, are not read";
            notes.add_at(format_args!("triangle {index}"), message);
        }
        mesh.push(corners);
    }
    Ok(Mesh { warnings: notes.into_texts(), ..mesh.mesh })
}

/// Reads a text: words, of which lines matter only for names.
fn read_text(text: &[u8]) -> Result<Mesh, MeshError> {
    let (mut mesh, mut notes) = (Welded::default(), Notes::default());
    let mut corners = Vec::with_capacity(3);
    // How many of `solid`, `facet` and `outer` are open.
    let mut depth = 0;
    for (line, text) in lines(text) {
        let wrong = |what: &str| invalid(format!("line {line}: {what}"));
        let mut words = text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        while let Some(word) = words.next() {
            let mut keyword = word.to_ascii_lowercase();
            if keyword == b"end" {
                keyword.extend(words.next().unwrap_or_default().to_ascii_lowercase());
            }
            match (keyword.as_slice(), depth) {
                // A name follows. The ends of a solid may be missing.
                (b"solid", 0 | 1) => {
                    depth = 1;
                    break;
                }
                (b"endsolid", 0 | 1) => {
                    depth = 0;
                    break;
                }
                (b"color" | b"colour", _) => {
                    notes.add(line, "colours are not read");
                    break;
                }
                (b"facet", 0 | 1) => depth = 2,
                (b"outer", 2) => depth = 3,
                (b"normal", 2) | (b"loop", 3) => (),
                (word, 2) if number::lenient(word).is_some() => (),
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
                (word, _) => {
                    let word = String::from_utf8_lossy(word);
                    return wrong(&format!("`{word:.40}` is not expected here"));
                }
            }
        }
    }
    if depth > 1 {
        return invalid("the file ends before `endfacet`");
    }
    Ok(Mesh { warnings: notes.into_texts(), ..mesh.mesh })
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
        let packed = read_stl(&binary(&SQUARE)).unwrap();
        assert_eq!(packed.warnings.len(), 1, "colours");
        assert_eq!(Mesh { warnings: Vec::new(), ..packed }, mesh);
        // Bytes beyond the triangles are of no use, and triangles without an area not either.
        let mut longer = binary(&[SQUARE[0], [1.0; 9], SQUARE[1]]);
        longer[..5].copy_from_slice(b"SOLID");
        assert_eq!(read_stl(&longer).unwrap().triangles.len(), 2);
        longer[0] = b'-';
        longer.push(0);
        assert_eq!(read_stl(&longer).unwrap().triangles.len(), 2);
    }

    #[test]
    fn texts_of_other_programs_are_read() {
        let mesh = read_stl(TEXT.as_bytes()).unwrap();
        let one_line = TEXT.replacen('\n', "\r", 1).replace('\n', " ").replace('\r', "\n");
        let colored = TEXT.replacen(" facet", "color 1 0 0\n facet", 2).replacen("color 1 0 0\n", "", 1);
        for text in [
            TEXT.replace("endsolid", "end solid")
                .replace("endfacet", "END  FACET")
                .replace("endloop", "end loop"),
            TEXT.replace("endsolid a facet\n", ""),
            TEXT.replacen("solid a facet\n", "", 1),
            TEXT.replacen("endfacet\n", "endfacet\nendsolid\nsolid b\n", 1),
            TEXT.replacen("endfacet\n", "endfacet\nsolid b\n", 1),
            TEXT.replace("facet normal 0 0 1\n", "facet\tnormal  nan -nan(ind) 0 "),
            TEXT.replace("\r\n", "\n").replace('\n', "\r"),
            TEXT.to_uppercase(),
            format!("\u{feff}{TEXT}"),
            format!("\n  {TEXT}"),
            one_line,
        ] {
            assert_eq!(read_stl(text.as_bytes()), Ok(mesh.clone()), "{text}");
        }
        let warnings = vec!["line 2: colours are not read".to_owned()];
        assert_eq!(read_stl(colored.as_bytes()), Ok(Mesh { warnings, ..mesh }));
    }

    #[test]
    fn binary_files_may_begin_as_texts_and_have_more_bytes() {
        let mesh = read_stl(&binary(&SQUARE)).unwrap();
        for header in [&b"solid "[..], b"solid\nfacet normal 0 0 1\n", b"SOLID a\0", b"solid\n\n"] {
            for more in 0..3 {
                let mut bytes = binary(&SQUARE);
                bytes[..header.len()].copy_from_slice(header);
                bytes.extend(vec![b'\n'; more]);
                assert_eq!(read_stl(&bytes), Ok(mesh.clone()), "{more}");
                assert!(matches!(read_stl(&bytes[..150]), Err(MeshError::Limits(_))));
            }
        }
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
            (" endfacet\nendsolid a facet", "", "ends before `endfacet`"),
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
