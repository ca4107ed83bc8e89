//! What rays are traced through on a device: nodes that a kernel traverses, or what its driver has
//! built for the ray queries of the hardware.

use wgpu::{
    AccelerationStructureFlags, AccelerationStructureGeometryFlags, AccelerationStructureUpdateMode,
    BindingResource, Blas, BlasAABBGeometrySizeDescriptor, BlasAabbGeometry, BlasBuildEntry, BlasGeometries,
    BlasGeometrySizeDescriptors, BlasTriangleGeometry, BlasTriangleGeometrySizeDescriptor,
    CreateBlasDescriptor, CreateTlasDescriptor, Tlas, TlasInstance, VertexFormat,
};

use crate::bvh::{Bvh, Plan};
use crate::device::{Binding, Buffer, Device, GpuError};
use crate::tags::MaskBit;

/// The bytes of a corner of a triangle.
const CORNER: u64 = 16;

/// The bytes of a box.
const BOX: u64 = 24;

/// What rays are traced through.
#[derive(Debug)]
pub enum Trees {
    /// The nodes of a [`Bvh`].
    Nodes(Buffer),
    /// The driver's, for ray queries.
    Structure(Tlas),
}

impl Binding for Trees {
    fn resource(&self) -> BindingResource<'_> {
        match self {
            Self::Nodes(nodes) => nodes.resource(),
            Self::Structure(structure) => structure.as_binding(),
        }
    }
}

impl Trees {
    /// Those of a world, given its triangles on the device.
    pub fn new(device: &Device, bvh: &Bvh, triangles: &Buffer) -> Result<Self, GpuError> {
        match &bvh.plan {
            None => Ok(Self::Nodes(device.buffer("nodes of the scene's trees", &bvh.nodes)?)),
            Some(plan) => Ok(Self::Structure(structure(device, plan, triangles)?)),
        }
    }
}

/// How the driver builds.
const FLAGS: AccelerationStructureFlags = AccelerationStructureFlags::PREFER_FAST_TRACE;
const MODE: AccelerationStructureUpdateMode = AccelerationStructureUpdateMode::Build;

/// Builds what a plan has.
fn structure(device: &Device, plan: &Plan, triangles: &Buffer) -> Result<Tlas, GpuError> {
    let (driver, queue) = device.wgpu();
    let boxes = device.buffer("boxes of the scene's shapes", &plan.boxes)?;
    let blas = |sizes: BlasGeometrySizeDescriptors| {
        driver.create_blas(&CreateBlasDescriptor { label: None, flags: FLAGS, update_mode: MODE }, sizes)
    };
    // What is in each group, where there is any.
    let of_triangles: Vec<Option<(Blas, BlasTriangleGeometrySizeDescriptor)>> = plan
        .bodies
        .iter()
        .map(|body| {
            let opaque = AccelerationStructureGeometryFlags::OPAQUE;
            let size = BlasTriangleGeometrySizeDescriptor {
                vertex_format: VertexFormat::Float32x3,
                vertex_count: 3 * body.triangles.len() as u32,
                index_format: None,
                index_count: None,
                flags: if body.is_opaque { opaque } else { AccelerationStructureGeometryFlags::empty() },
            };
            let sizes = BlasGeometrySizeDescriptors::Triangles { descriptors: vec![size.clone()] };
            (!body.triangles.is_empty()).then(|| (blas(sizes), size))
        })
        .collect();
    let of_boxes: Vec<Option<(Blas, BlasAABBGeometrySizeDescriptor)>> = plan
        .bodies
        .iter()
        .map(|body| {
            let flags = AccelerationStructureGeometryFlags::empty();
            let size = BlasAABBGeometrySizeDescriptor { primitive_count: body.boxes.len() as u32, flags };
            let sizes = BlasGeometrySizeDescriptors::AABBs { descriptors: vec![size.clone()] };
            (!body.boxes.is_empty()).then(|| (blas(sizes), size))
        })
        .collect();
    let instances: Vec<TlasInstance> = plan
        .places
        .iter()
        .flat_map(|place| {
            let triangles = of_triangles[place.group].as_ref().map(|(blas, _)| blas);
            let boxes = of_boxes[place.group].as_ref().map(|(blas, _)| blas);
            let all = triangles
                .map(|blas| (blas, MaskBit::Triangles as u8))
                .into_iter()
                .chain(boxes.map(|blas| (blas, MaskBit::Shapes as u8)));
            all.map(|(blas, mask)| TlasInstance::new(blas, place.rows, place.item, mask))
        })
        .collect();
    let mut tlas = driver.create_tlas(&CreateTlasDescriptor {
        label: None,
        max_instances: instances.len().max(1) as u32,
        flags: FLAGS,
        update_mode: MODE,
    });
    for (i, instance) in instances.into_iter().enumerate() {
        tlas[i] = Some(instance);
    }
    let triangle_entries = plan.bodies.iter().zip(&of_triangles).filter_map(|(body, built)| {
        let (blas, size) = built.as_ref()?;
        let geometry = BlasTriangleGeometry {
            size,
            vertex_buffer: &triangles.0,
            first_vertex: 3 * body.triangles.start as u32,
            vertex_stride: CORNER,
            index_buffer: None,
            first_index: None,
            transform_buffer: None,
            transform_buffer_offset: None,
        };
        Some(BlasBuildEntry { blas, geometry: BlasGeometries::TriangleGeometries(vec![geometry]) })
    });
    let box_entries = plan.bodies.iter().zip(&of_boxes).filter_map(|(body, built)| {
        let (blas, size) = built.as_ref()?;
        let geometry = BlasAabbGeometry {
            size,
            stride: BOX,
            aabb_buffer: &boxes.0,
            primitive_offset: body.boxes.start as u32 * BOX as u32,
        };
        Some(BlasBuildEntry { blas, geometry: BlasGeometries::AabbGeometries(vec![geometry]) })
    });
    let entries: Vec<BlasBuildEntry> = triangle_entries.chain(box_entries).collect();
    let mut encoder = driver.create_command_encoder(&Default::default());
    encoder.build_acceleration_structures(&entries, [&tlas]);
    queue.submit([encoder.finish()]);
    device.checked(tlas)
}
