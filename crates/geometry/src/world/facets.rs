//! Few triangles and nearly flat patches, which are tested without a tree.

use super::geometry::{Geometry, GeometryId};
use super::points::PatchTable;
use crate::facet::{FIELDS, Facet, FacetFrame, FacetValues, TWIST_FIELDS, Twist};
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
    /// The twists of plane facets in their planes, for their parameters.
    pub skews: [Vec<f32>; 2],
    /// Whether any is not 0.
    pub is_skewed: bool,
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
            skews: [Vec::new(), Vec::new()],
            is_skewed: false,
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
        facets.skews.iter_mut().for_each(|skews| skews.push(0.0));
        Some(facets)
    }

    /// The number of facets.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    fn push(&mut self, frame: &FacetFrame, geometry: u32, primitive: u32) -> Option<()> {
        let FacetValues { facet: values, twist, skew } = frame.values()?;
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
        self.is_skewed |= skew != [0.0; 2];
        self.skews.iter_mut().zip(skew).for_each(|(skews, skew)| skews.push(skew));
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

/// Facets with each number in all lanes of a vector, so that instructions take them from memory.
pub(super) struct Spread<R: Real> {
    /// Plane facets and their indices.
    pub plane: Vec<(usize, Facet<R>)>,
    /// Other patches.
    pub patches: Vec<(usize, Facet<R>, Twist<R>)>,
}

impl<R: Real> Spread<R> {
    #[inline(always)]
    pub fn of(facets: &Facets) -> Self {
        let (mut plane, mut patches) = (Vec::with_capacity(facets.len()), Vec::new());
        for (index, &(block, lane)) in facets.places.iter().enumerate() {
            let block = &facets.blocks[usize::from(block)];
            let facet = Facet::of(spread(&block.values, lane.into()));
            match &block.twists {
                None => plane.push((index, facet)),
                Some(twists) => patches.push((index, facet, Twist::of(spread(twists, lane.into())))),
            }
        }
        Self { plane, patches }
    }
}

/// The numbers of one lane.
#[inline(always)]
fn spread<R: Real, const N: usize>(fields: &[[f32; MAX_LANES]; N], lane: usize) -> [R; N] {
    let mut values = [R::zero(); N];
    for (value, field) in values.iter_mut().zip(fields) {
        *value = R::splat(field[lane]);
    }
    values
}

/// The numbers of the lanes from `first` on.
#[inline(always)]
fn row<R: Real, const N: usize>(fields: &[[f32; MAX_LANES]; N], first: usize) -> [R; N] {
    let mut values = [R::zero(); N];
    for (value, field) in values.iter_mut().zip(fields) {
        *value = R::load(&field[first..]);
    }
    values
}

impl Block {
    /// The facets from a lane on.
    #[inline(always)]
    pub fn facets<R: Real>(&self, first: usize) -> (Facet<R>, Option<Twist<R>>) {
        let facet = Facet::of(row(&self.values, first));
        match &self.twists {
            None => (facet, None),
            Some(twists) => (facet, Some(Twist::of(row(twists, first)))),
        }
    }
}
