//! Primitives packed by Draco (`KHR_draco_mesh_compression`), decoded by the crate `draco-core`.

use std::collections::HashMap;
use std::panic::{AssertUnwindSafe, catch_unwind};

use draco_core::{DataType, DecodeLimits, DecoderBuffer, Mesh, MeshDecoder, PointAttribute, PointIndex};

use super::accessor::{Accessor, Component};
use super::buffer::Buffers;
use super::json::{Place, Result};

/// The vertices and triangles of one primitive.
pub(super) struct Packed<'a> {
    pub place: Place<'a>,
    mesh: Mesh,
    /// The numbers of attributes by their names.
    ids: HashMap<String, u32>,
}

impl<'a> Packed<'a> {
    /// The packed data of a primitive; `None` if it has none.
    pub fn of(primitive: &Place<'a>, buffers: &Buffers) -> Result<Option<Self>> {
        let Some(place) = primitive.extension("KHR_draco_mesh_compression")? else { return Ok(None) };
        let view =
            buffers.view(&place, "bufferView")?.ok_or_else(|| place.invalid("`bufferView` is missing"))?;
        let attributes =
            place.object("attributes")?.ok_or_else(|| place.invalid("`attributes` is missing"))?;
        let mut ids = HashMap::new();
        for name in attributes.value.as_object().into_iter().flat_map(|object| object.keys()) {
            let id = attributes.integer(name)?.and_then(|id| u32::try_from(id).ok());
            let id =
                id.ok_or_else(|| attributes.invalid_member(name, "this is no number of an attribute"))?;
            ids.insert(name.clone(), id);
        }
        // The stream says how much there is, whatever the accessors say, within what the file may
        // take: at least 4 bytes for each vertex and 12 for each triangle.
        let bytes = buffers.left();
        let limits = DecodeLimits::default()
            .with_max_points(bytes / 4)
            .with_max_faces(bytes / 12)
            .with_max_decoded_bytes(bytes);
        let unpack = || {
            let mut mesh = Mesh::new();
            let mut buffer = DecoderBuffer::new(view.bytes()).with_limits(limits);
            MeshDecoder::new().decode(&mut buffer, &mut mesh).map(|()| mesh)
        };
        let mesh = match catch_unwind(AssertUnwindSafe(unpack)) {
            Ok(Ok(mesh)) => mesh,
            Ok(Err(error)) => return Err(place.invalid(format!("cannot unpack the primitive: {error}"))),
            // A panic in another crate must not end a render.
            Err(_) => return Err(place.invalid("the packed primitive is damaged")),
        };
        // Attributes have at most 16 bytes for each vertex.
        let bytes = 16 * mesh.num_points() as u64 * ids.len() as u64;
        buffers.spend(&place, bytes + 12 * mesh.num_faces() as u64)?;
        Ok(Some(Self { place, mesh, ids }))
    }

    /// The numbers of vertices and of indices.
    pub fn counts(&self) -> [usize; 2] {
        [self.mesh.num_points(), 3 * self.mesh.num_faces()]
    }

    /// The triangles, which are no strips or fans, whatever the mode of the primitive.
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        self.mesh.faces().iter().map(|face| face.map(|corner| corner.0)).collect()
    }

    /// The bytes of an attribute as an accessor has them without packing; `None` if it is not
    /// packed.
    pub fn attribute(&self, name: &str, accessor: &Accessor) -> Result<Option<Vec<u8>>> {
        let Some(&id) = self.ids.get(name) else { return Ok(None) };
        let attribute = self.mesh.attribute_by_unique_id(id).filter(|attribute| {
            usize::from(attribute.num_components()) == accessor.width
                && is_of(accessor.component, attribute.data_type())
        });
        let Some(attribute) = attribute else {
            let message = format!("no attribute {id} of the accessor's type is packed");
            return Err(self.place.invalid_member("attributes", message));
        };
        let bytes = bytes(attribute, self.mesh.num_points(), accessor.width * accessor.component.size());
        let short = || self.place.invalid_member("attributes", format!("`{name}` is cut off"));
        bytes.map(Some).ok_or_else(short)
    }
}

fn is_of(component: Component, data: DataType) -> bool {
    match component {
        Component::I8 => data == DataType::Int8,
        Component::U8 => data == DataType::Uint8,
        Component::I16 => data == DataType::Int16,
        Component::U16 => data == DataType::Uint16,
        Component::U32 => data == DataType::Uint32,
        Component::F32 => data == DataType::Float32,
    }
}

/// The values of all points, of some bytes each.
fn bytes(attribute: &PointAttribute, points: usize, size: usize) -> Option<Vec<u8>> {
    let (data, stride) = (attribute.buffer().data(), usize::try_from(attribute.byte_stride()).ok()?);
    let mut bytes = Vec::with_capacity(points * size);
    for point in 0..points as u32 {
        let at = (attribute.mapped_index(PointIndex(point)).0 as usize).checked_mul(stride)?;
        bytes.extend(data.get(at..at.checked_add(size)?)?);
    }
    Some(bytes)
}
