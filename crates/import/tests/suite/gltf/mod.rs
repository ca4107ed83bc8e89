//! Files of glTF: made by hand for what each part of the format means, and of other authors.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod files;
mod geometry;
mod lights;
mod materials;
mod motion;
mod packed;

use alhazen_import::import;
use assets::MemoryAssets;
use description::Imported;
use description::{Diagnostic, SceneDesc, Severity};
use serde_json::{Value, json};

/// A file while it is written: the text, and the bytes of its one buffer.
pub struct File {
    pub json: Value,
    bytes: Vec<u8>,
}

impl File {
    /// A file with nothing in it.
    pub fn empty() -> Self {
        let json = json!({"asset": {"version": "2.0"}, "bufferViews": [], "accessors": []});
        Self { json, bytes: Vec::new() }
    }

    /// A scene of the quadrilateral (±1, ±1, 0) with its normal along z and with the material.
    pub fn quad(material: Value) -> Self {
        let mut file = Self::empty();
        let positions = file.floats("VEC3", &[-1., -1., 0., 1., -1., 0., 1., 1., 0., -1., 1., 0.]);
        let normals = file.floats("VEC3", &[0., 0., 1.].repeat(4));
        let uvs = file.floats("VEC2", &[0., 1., 1., 1., 1., 0., 0., 0.]);
        let indices = file.indices(&[0, 1, 2, 0, 2, 3]);
        file.json["meshes"] = json!([{"primitives": [{
            "attributes": {"POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs},
            "indices": indices,
            "material": 0,
        }]}]);
        file.json["nodes"] = json!([{"mesh": 0}]);
        file.json["scenes"] = json!([{"nodes": [0]}]);
        file.json["materials"] = json!([material]);
        file
    }

    /// Adds a picture of one row of colours, as texture 0.
    pub fn textured(mut self, colors: &[[u8; 4]]) -> Self {
        let codes = colors.as_flattened().iter().map(|&code| f32::from(code) / 255.0);
        let pixels = image::Pixels::F32(codes.collect());
        let picture = image::Image::new(colors.len() as u32, 1, ["R", "G", "B", "A"], pixels).unwrap();
        let linear = picture.to_u8(image::ColorEncoding::Linear);
        let image::Pixels::U8(codes, _) = linear.pixels() else { unreachable!() };
        let stored = image::Pixels::U8(codes.clone(), image::ColorEncoding::Srgb);
        let stored = image::Image::new(colors.len() as u32, 1, ["R", "G", "B", "A"], stored).unwrap();
        let png = image::encode(&stored, image::Format::Png, &image::WriteOptions::default()).unwrap();
        let view = self.view(&png);
        self.json["images"] = json!([{"bufferView": view, "mimeType": "image/png"}]);
        self.json["textures"] = json!([{"source": 0}]);
        self
    }

    /// Adds bytes as a view.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let view = json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()});
        self.bytes.extend(bytes);
        push(&mut self.json["bufferViews"], view)
    }

    /// Adds vectors of floats as an accessor.
    pub fn floats(&mut self, kind: &str, values: &[f32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        let widths = [("SCALAR", 1), ("VEC2", 2), ("VEC3", 3), ("VEC4", 4), ("MAT4", 16)];
        let width = widths.iter().find(|(name, _)| *name == kind).unwrap().1;
        let view = self.view(&bytes);
        let accessor =
            json!({"bufferView": view, "componentType": 5126, "count": values.len() / width, "type": kind});
        push(&mut self.json["accessors"], accessor)
    }

    /// Adds indices of 16 bits as an accessor.
    pub fn indices(&mut self, values: &[u16]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        let view = self.view(&bytes);
        let accessor =
            json!({"bufferView": view, "componentType": 5123, "count": values.len(), "type": "SCALAR"});
        push(&mut self.json["accessors"], accessor)
    }

    /// The file as one of the binary container.
    pub fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        let mut bytes = self.bytes.clone();
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        if !bytes.is_empty() {
            json["buffers"] = json!([{"byteLength": bytes.len()}]);
        }
        let mut text = json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let length = (28 + text.len() + bytes.len()) as u32;
        let chunk =
            |kind: &[u8; 4], data: &[u8]| [&(data.len() as u32).to_le_bytes()[..], kind, data].concat();
        [&b"glTF\x02\0\0\0"[..], &length.to_le_bytes(), &chunk(b"JSON", &text), &chunk(b"BIN\0", &bytes)]
            .concat()
    }

    /// Reads the file.
    pub fn read(&self) -> Imported {
        self.read_as("a.glb")
    }

    /// Reads the file by a path that begins with `a.glb`.
    pub fn read_as(&self, path: &str) -> Imported {
        import(path, &MemoryAssets::default().with("a.glb", self.glb()))
    }

    /// The scene of the file, which has no errors.
    pub fn scene(&self) -> SceneDesc {
        self.scene_of("a.glb")
    }

    /// [`Self::scene`] by a path that begins with `a.glb`.
    pub fn scene_of(&self, path: &str) -> SceneDesc {
        let imported = self.read_as(path);
        assert!(!imported.has_errors(), "{:#?}", imported.diagnostics);
        imported.desc
    }

    /// The messages of the file of a severity.
    pub fn messages(&self, severity: Severity) -> Vec<String> {
        let of_severity = |diagnostic: &Diagnostic| diagnostic.severity == severity;
        self.read().diagnostics.into_iter().filter(of_severity).map(|diagnostic| diagnostic.message).collect()
    }
}

fn push(array: &mut Value, item: Value) -> usize {
    let items = array.as_array_mut().unwrap();
    items.push(item);
    items.len() - 1
}

/// The triangles of a shape.
pub fn mesh(shape: &description::ShapeDesc) -> &description::MeshDesc {
    match &shape.kind {
        description::ShapeKind::Triangles(mesh) => mesh,
        kind => panic!("{kind:?}"),
    }
}
