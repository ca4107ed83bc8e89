//! Few triangles and nearly flat patches, which are tested without a tree.

use super::geometry::{Geometry, GeometryId};
use super::points::PatchTable;
use crate::facet::{FIELDS, Facet, FacetFrame, TWIST_FIELDS, Twist};
use crate::shape::{Shape, Triangle};
use crate::watertight::Sheared;
use lanes::{MAX_LANES, Real};
use math::{Ray, Vec2};

/// The most facets that are tested without a tree.
pub(super) const MOST: usize = 48;

/// The numbers of facets, of which each lane has one.
#[derive(Clone, Debug)]
pub(super) struct Block {
    values: [[f32; MAX_LANES]; FIELDS],
    twists: Option<Box<[[f32; MAX_LANES]; TWIST_FIELDS]>>,
    /// The index of the facet in each lane.
    pub facets: Vec<u32>,
}

/// Few facets.
#[derive(Clone, Debug)]
pub(super) struct Facets {
    /// Geometry and primitive of each facet, in their order; the last row stands for none.
    pub geometries: Vec<u32>,
    pub primitives: Vec<u32>,
    /// Block and lane of each facet.
    pub places: Vec<(u8, u8)>,
    pub blocks: Vec<Block>,
    /// For surface points.
    pub patches: Option<PatchTable>,
}

impl Facets {
    /// All primitives of a group, if they are few facets.
    pub fn new(members: &[GeometryId], geometries: &[Geometry]) -> Option<Self> {
        let primitives = members.iter().map(|id| geometries[id.0 as usize].len()).sum::<usize>();
        if primitives == 0 || primitives > MOST {
            return None;
        }
        let mut facets = Self {
            geometries: Vec::new(),
            primitives: Vec::new(),
            places: Vec::new(),
            blocks: Vec::new(),
            patches: PatchTable::new(members, geometries),
        };
        for &id in members {
            let geometry = &geometries[id.0 as usize];
            for primitive in 0..geometry.len() as u32 {
                let frame = match geometry {
                    Geometry::Mesh(mesh) => Triangle::new(mesh.corners(primitive as usize)).facet(),
                    Geometry::Shapes(shapes) => match &shapes[primitive as usize] {
                        Shape::Triangle(triangle) => triangle.facet(),
                        Shape::BilinearPatch(patch) => patch.facet(),
                        _ => return None,
                    },
                    _ => return None,
                };
                facets.push(&frame, id.0, primitive)?;
            }
        }
        facets.geometries.push(u32::MAX);
        facets.primitives.push(u32::MAX);
        Some(facets)
    }

    /// The number of facets.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    fn push(&mut self, frame: &FacetFrame, geometry: u32, primitive: u32) -> Option<()> {
        let (values, twist) = frame.values()?;
        let has_room =
            |block: &Block| block.twists.is_some() == twist.is_some() && block.facets.len() < MAX_LANES;
        let found = self.blocks.iter().position(has_room);
        let place = found.unwrap_or_else(|| {
            let twists = twist.map(|_| Box::new([[0.0; MAX_LANES]; TWIST_FIELDS]));
            self.blocks.push(Block { values: [[0.0; MAX_LANES]; FIELDS], twists, facets: Vec::new() });
            self.blocks.len() - 1
        });
        let index = self.len() as u32;
        let block = &mut self.blocks[place];
        let lane = block.facets.len();
        block.values.iter_mut().zip(values).for_each(|(field, value)| field[lane] = value);
        if let (Some(fields), Some(twist)) = (&mut block.twists, twist) {
            fields.iter_mut().zip(twist).for_each(|(field, value)| field[lane] = value);
        }
        block.facets.push(index);
        self.places.push((place as u8, lane as u8));
        self.geometries.push(geometry);
        self.primitives.push(primitive);
        Some(())
    }

    /// The hit of a facet by the test of its shape.
    #[cold]
    #[inline(never)]
    pub fn resolve(
        &self,
        facet: usize,
        geometries: &[Geometry],
        ray: &Ray,
        t_max: f32,
    ) -> Option<(f32, Vec2)> {
        let primitive = self.primitives[facet];
        match &geometries[self.geometries[facet] as usize] {
            Geometry::Mesh(mesh) => Sheared::new(ray).triangle(&mesh.corners(primitive as usize), t_max),
            geometry => geometry.shape(primitive)?.intersect(ray, t_max).map(|hit| (hit.t, hit.uv)),
        }
    }
}

impl Block {
    /// The facet of a lane in all lanes.
    #[inline(always)]
    pub fn facet<R: Real>(&self, lane: usize) -> (Facet<R>, Option<Twist<R>>) {
        let (mut values, mut twist) = ([R::zero(); FIELDS], None);
        for (value, field) in values.iter_mut().zip(&self.values) {
            *value = R::splat(field[lane % MAX_LANES]);
        }
        if let Some(fields) = &self.twists {
            let mut values = [R::zero(); TWIST_FIELDS];
            for (value, field) in values.iter_mut().zip(fields.iter()) {
                *value = R::splat(field[lane % MAX_LANES]);
            }
            twist = Some(Twist::of(values));
        }
        (Facet::of(values), twist)
    }

    /// The facets from a lane on.
    #[inline(always)]
    pub fn facets<R: Real>(&self, first: usize) -> (Facet<R>, Option<Twist<R>>) {
        let (mut values, mut twist) = ([R::zero(); FIELDS], None);
        for (value, field) in values.iter_mut().zip(&self.values) {
            *value = R::load(&field[first..]);
        }
        if let Some(fields) = &self.twists {
            let mut values = [R::zero(); TWIST_FIELDS];
            for (value, field) in values.iter_mut().zip(fields.iter()) {
                *value = R::load(&field[first..]);
            }
            twist = Some(Twist::of(values));
        }
        (Facet::of(values), twist)
    }
}
