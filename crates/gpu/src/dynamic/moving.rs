//! What moves in a world, on the device.

use geometry::{Geometry, GeometryId, InstanceId, World};
use math::{Bounds3, Point3, Transform, Vec3};
use scene::MoveError;

use super::error::MovingError;
use super::instances::Instances;
use super::part::{AT_REST, Part};
use super::points::{PlacedPoints, Points};
use super::tree::{MOST_ITEMS, Place, fits_stack, most_nodes};
use super::{Start, Update};
use crate::bvh::{Bvh, ITEMS, Placed, TRIANGLES, Top};
use crate::device::{Buffer, Device, GpuError};
use crate::renderer::Kernels;
use crate::shaders;

/// The items and triangles of a world's top group, and the trees over them.
pub struct Moving {
    top: Top,
    items: Part,
    instances: Option<Instances>,
    /// If any mesh may move. Rays are traced through the world's own tree until one has.
    triangles: Option<Triangles>,
    points: PlacedPoints,
}

/// The triangles, and the reference of the tree's root.
struct Triangles {
    part: Part,
    root: u32,
}

impl Moving {
    /// For a world and its buffers, which get room for the trees: they are taken to the device
    /// after this, and before [`run`](Self::run) builds the tree of items.
    ///
    /// # Errors
    /// The top group has too many items, or instances of too many shapes; or the device fails.
    pub fn new(kernels: &Kernels, world: &World, bvh: &mut Bvh) -> Result<Self, MovingError> {
        let mut points = Points::default();
        let placed = bvh.placed(world);
        let (mut items, boxes) = items(kernels, world, bvh, &placed, &mut points)?;
        items.plan(Update::Rebuild);
        let triangles = triangles(kernels, world, bvh, &mut points)?;
        let instances = if placed.is_empty() {
            None
        } else {
            let transform = |id| *world.render_from_instance(id).start();
            let first_item = bvh.bounded.start as u32;
            Some(Instances::new(kernels, placed, transform, first_item, &boxes)?)
        };
        Ok(Self { top: bvh.top, items, instances, triangles, points: points.placed(kernels.device())? })
    }

    /// Where rays begin: in trees that [`run`](Self::run) updates. It has changed after what has
    /// moved.
    pub fn top(&self) -> Top {
        self.top
    }

    /// Tells the device where the spheres of some sets and the vertices of some meshes are, each
    /// given by its geometry and all its centres or vertices in render space.
    ///
    /// # Errors
    /// A geometry has no points of the top group that may move, or the points do not fit; or the
    /// device fails. Those before it have moved.
    pub fn place<'a>(
        &mut self,
        device: &Device,
        moved: impl IntoIterator<Item = (GeometryId, &'a [Point3])>,
        update: Update,
    ) -> Result<(), MovingError> {
        for (id, points) in moved {
            let (set, reach) = self.points.place(device, id, points)?;
            self.top.size = self.top.size.max(reach);
            match &mut self.triangles {
                Some(Triangles { part, root }) if set.is_mesh => {
                    self.top.roots[0] = *root;
                    part.plan(update);
                }
                None if set.is_mesh => return Err(MovingError::Refused("as many triangles")),
                _ => self.items.plan(update),
            }
        }
        Ok(())
    }

    /// Gives instances of the top group, which are at rest, other transforms to render space.
    ///
    /// # Errors
    /// There is no such instance, or its transform has no inverse, and nothing has moved; or the
    /// device fails.
    pub fn place_instances(
        &mut self,
        device: &Device,
        moved: &[(InstanceId, Transform)],
        update: Update,
    ) -> Result<(), MovingError> {
        let Some((id, _)) = moved.first() else { return Ok(()) };
        let instances = self.instances.as_mut().ok_or(MoveError::Instance(*id))?;
        self.top.size = self.top.size.max(instances.place(moved)?);
        instances.load(device)?;
        self.items.plan(update);
        Ok(())
    }

    /// Moves items and triangles to where they are, and builds or refits their trees; one that was
    /// not built is built.
    ///
    /// # Errors
    /// Those of the device.
    pub fn run(
        &self,
        device: &Device,
        [items, triangles, nodes]: [&Buffer; 3],
        start: &mut Start,
    ) -> Result<(), GpuError> {
        let points = &self.points.buffer;
        if let (Some(_), Some(instances)) = (self.items.update(), &self.instances) {
            instances.run([items, self.items.boxes()], start);
        }
        self.items.run(device, [items, points, nodes], start)?;
        match &self.triangles {
            Some(Triangles { part, .. }) => part.run(device, [triangles, points, nodes], start),
            None => Ok(()),
        }
    }

    /// After a picture for which all of it was run: what has moved since counts for the next one.
    pub fn settle(&mut self) {
        self.items.settle();
        if let Some(Triangles { part, .. }) = &mut self.triangles {
            part.settle();
        }
    }
}

/// The items, with their boxes.
fn items(
    kernels: &Kernels,
    world: &World,
    bvh: &mut Bvh,
    placed: &[Placed],
    points: &mut Points,
) -> Result<(Part, Vec<Bounds3>), MovingError> {
    let (count, first) = (bvh.bounded.len(), bvh.bounded.start);
    if count > MOST_ITEMS as usize {
        return Err(MovingError::Refused("as many others"));
    }
    let leaf_stack = bvh.stack_within();
    if leaf_stack > 0 && !fits_stack(count as u32, leaf_stack) {
        return Err(MovingError::Refused("instances of as many shapes"));
    }
    let mut boxes = vec![Bounds3::EMPTY; count];
    for placed in placed {
        boxes[placed.item as usize - first] = placed.bounds(world.render_from_instance(placed.instance));
    }
    let mut spheres = Vec::new();
    for (item, bounds) in bvh.bounded.clone().zip(&mut boxes) {
        let Some((id, primitive)) = bvh.shape(item) else { continue };
        *bounds = world.geometry(id).shape(primitive).and_then(|shape| shape.bounds()).unwrap_or(*bounds);
        spheres.resize(spheres.len().max(id.0 as usize + 1), AT_REST);
        spheres[id.0 as usize] = points.first(world, id);
    }
    let (count, first_item) = (count as u32, first as u32);
    let first_node = if count < 2 { 0 } else { bvh.make_room(most_nodes(count)) };
    let place = Place { count, first_item, first_node, leaf_bits: ITEMS, leaf_stack };
    let kernel = kernels.get("place_spheres", shaders::place_spheres())?;
    Ok((Part::new(kernels, kernel, place, &spheres, &boxes)?, boxes))
}

/// The triangles, if any of them may move.
fn triangles(
    kernels: &Kernels,
    world: &World,
    bvh: &mut Bvh,
    points: &mut Points,
) -> Result<Option<Triangles>, MovingError> {
    let range = bvh.triangles_of_top.clone();
    let ids = |triangle: usize| {
        let words = &bvh.triangles[3 * triangle..];
        (GeometryId(words[0][3]), words[1][3])
    };
    let firsts: Vec<u32> = range.clone().map(|triangle| points.first(world, ids(triangle).0)).collect();
    if firsts.iter().all(|&first| first == AT_REST) || firsts.len() > MOST_ITEMS as usize {
        return Ok(None);
    }
    let (mut corners, mut boxes) = (Vec::new(), Vec::new());
    for (triangle, first) in range.clone().zip(firsts) {
        let (id, primitive) = ids(triangle);
        corners.extend(match world.geometry(id) {
            Geometry::Mesh(mesh) if first != AT_REST => mesh.indices(primitive as usize).map(|i| first + i),
            _ => [AT_REST; 3],
        });
        let corner = |&[x, y, z, _]: &[u32; 4]| Vec3::from([x, y, z].map(f32::from_bits));
        boxes.push(Bounds3::around(bvh.triangles[3 * triangle..][..3].iter().map(corner)));
    }
    let (count, first_item) = (boxes.len() as u32, range.start as u32);
    let is_tree = count > 1;
    let first_node = if is_tree { bvh.add_room(most_nodes(count)) } else { 0 };
    let place = Place { count, first_item, first_node, leaf_bits: TRIANGLES, leaf_stack: 0 };
    let kernel = kernels.get("place_triangles", shaders::place_triangles())?;
    let part = Part::new(kernels, kernel, place, &corners, &boxes)?;
    Ok(Some(Triangles { part, root: if is_tree { first_node } else { bvh.top.roots[0] } }))
}
