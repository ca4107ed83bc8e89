//! Hits grouped by material.

use geometry::HitColumns;
use lanes::{Int, Kernel, Mask, Real};
use scene::material::MaterialId;

use super::indices::Indices;
use super::materials::LaneMaterials;
use super::queues::PathHit;
use super::segment_columns::SegmentColumns;

/// Hits of a batch, grouped by material.
#[derive(Default)]
pub(super) struct Groups {
    /// By material.
    groups: Vec<Group>,
    /// The materials that have hits.
    used: Vec<MaterialId>,
}

/// The hits of a material.
#[derive(Default)]
pub(super) struct Group {
    /// Their indices, and their paths.
    pub hit_indices: Vec<u32>,
    pub rows: Vec<u32>,
}

impl Groups {
    /// Removes all hits. Materials have ids below `materials`.
    pub fn clear(&mut self, materials: usize) {
        for MaterialId(id) in self.used.drain(..) {
            let Group { hit_indices, rows } = &mut self.groups[id as usize];
            hit_indices.clear();
            rows.clear();
        }
        self.groups.resize_with(materials, Group::default);
    }

    /// The group of a material, which will have a hit.
    #[inline(always)]
    fn group(&mut self, MaterialId(id): MaterialId) -> &mut Group {
        let group = &mut self.groups[id as usize];
        if group.hit_indices.is_empty() {
            self.used.push(MaterialId(id));
        }
        group
    }

    /// Adds a hit.
    #[inline]
    pub fn push(&mut self, material: MaterialId, place: PathHit) {
        let Group { hit_indices, rows } = self.group(material);
        hit_indices.push(place.hit);
        rows.push(place.path);
    }

    /// The groups, with their materials.
    pub fn iter(&self) -> impl Iterator<Item = (MaterialId, &Group)> {
        self.used.iter().map(|&material| (material, &self.groups[material.0 as usize]))
    }
}

/// Groups the hits whose geometry alone tells their group, and finds the paths that have left the
/// scene.
pub(super) struct Grouping<'a> {
    pub materials: &'a LaneMaterials,
    pub segments: &'a SegmentColumns,
    /// The geometry of each hit.
    pub geometries: &'a [u32],
    /// Paths of that many scattering events are left.
    pub max_depth: u32,
    pub groups: &'a mut Groups,
    /// The hits of the paths that hit nothing.
    pub escaped: &'a mut Vec<u32>,
    /// Those that are left.
    pub left: &'a mut Vec<u32>,
}

impl Grouping<'_> {
    /// In place of a geometry, for paths that are not at their hits any more.
    pub const GONE: u32 = HitColumns::NONE - 1;
}

impl Kernel for Grouping<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let Self { materials, segments, geometries, max_depth, groups, escaped, left } = self;
        let lanes = R::Int::from_fn(|lane| lane as u32);
        for first in (0..geometries.len()).step_by(R::LANES) {
            let Indices { indices: geometry, active } = Indices::<R>::first(&geometries[first..]);
            let active = active & !geometry.eq(R::Int::splat(Self::GONE));
            let rows = Indices::<R>::first(&segments.rows[first..]);
            let hit_indices = lanes.wrapping_add(R::Int::splat(first as u32));
            let material = materials.of_geometries::<R>(geometry);
            let has_left = active & material.eq(R::Int::splat(LaneMaterials::NOTHING));
            let is_last = R::Int::load(&segments.depth[first..]).eq(R::Int::splat(max_depth));
            let mut grouped = active & !is_last & material.lt(R::Int::splat(LaneMaterials::DEPENDS));
            hit_indices.append(has_left, escaped);
            hit_indices.append(active & !has_left & !grouped, left);
            while grouped.any() {
                let id = material.to_array()[grouped.bits().trailing_zeros() as usize % R::LANES];
                let same = grouped & material.eq(R::Int::splat(id));
                grouped = grouped & !same;
                let group = groups.group(MaterialId(id));
                hit_indices.append(same, &mut group.hit_indices);
                rows.indices.append(same, &mut group.rows);
            }
        }
    }
}
