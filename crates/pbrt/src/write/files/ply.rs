//! Meshes as binary PLY files [Turk 1994], as pbrt-v4 reads them.

use std::fmt::Write;

use description::{MeshDesc, PatchMeshDesc};

/// A file of triangles and of patches as quadrilaterals; an error if they do not share their
/// vertices.
pub(super) fn bytes(triangles: &MeshDesc, patches: &PatchMeshDesc) -> Result<Vec<u8>, &'static str> {
    let same = triangles.positions == patches.positions
        && triangles.normals == patches.normals
        && triangles.uvs == patches.uvs;
    let (positions, normals, uvs) = if patches.indices.is_empty() {
        (&triangles.positions, &triangles.normals, &triangles.uvs)
    } else if triangles.indices.is_empty() || same {
        (&patches.positions, &patches.normals, &patches.uvs)
    } else {
        return Err("its triangles and patches do not share their vertices");
    };
    let faces = triangles.indices.len() + patches.indices.len();
    let is_numbered = !triangles.face_indices.is_empty() || !patches.face_indices.is_empty();

    let mut header = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\n\
         property float x\nproperty float y\nproperty float z\n",
        positions.len()
    );
    if !normals.is_empty() {
        header += "property float nx\nproperty float ny\nproperty float nz\n";
    }
    if !uvs.is_empty() {
        header += "property float u\nproperty float v\n";
    }
    // A text takes every write.
    let _ = write!(header, "element face {faces}\nproperty list uchar int vertex_indices\n");
    if is_numbered {
        header += "property int face_indices\n";
    }
    let mut bytes = (header + "end_header\n").into_bytes();
    let floats =
        |bytes: &mut Vec<u8>, values: &[f32]| bytes.extend(values.iter().flat_map(|v| v.to_le_bytes()));
    for (i, position) in positions.iter().enumerate() {
        floats(&mut bytes, &position.to_array());
        if let Some(normal) = normals.get(i) {
            floats(&mut bytes, &normal.to_array());
        }
        if let Some(uv) = uvs.get(i) {
            floats(&mut bytes, &[uv.x, uv.y]);
        }
    }
    let mut face = |corners: &[u32], number: Option<&i32>| {
        bytes.push(corners.len() as u8);
        bytes.extend(corners.iter().flat_map(|corner| corner.to_le_bytes()));
        if is_numbered {
            bytes.extend(number.copied().unwrap_or_default().to_le_bytes());
        }
    };
    for (i, triangle) in triangles.indices.iter().enumerate() {
        face(triangle, triangles.face_indices.get(i));
    }
    for (i, &[a, b, c, d]) in patches.indices.iter().enumerate() {
        // The corners of a patch go in rows, those of a quadrilateral around it.
        face(&[a, b, d, c], patches.face_indices.get(i));
    }
    Ok(bytes)
}
