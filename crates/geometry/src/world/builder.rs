//! Building a world from geometries and instances.

use super::World;
use super::facets::Facets;
use super::geometry::{Geometry, GeometryId};
use super::group::Group;
use super::instance::{GroupId, Instance, InstanceId, InstancePath, PreparedInstance};
use super::tables::Tables;
use crate::bvh::BuildQuality;
use lanes::InstructionSet;
use rayon::prelude::*;

/// Collects geometries and instances, and builds a world of them.
#[derive(Clone, Debug)]
pub struct WorldBuilder {
    groups: Vec<Members>,
    geometries: Vec<Geometry>,
    instances: Vec<Instance>,
    quality: BuildQuality,
    extents: bool,
}

/// The contents of a group.
#[derive(Clone, Debug, Default)]
struct Members {
    geometries: Vec<GeometryId>,
    instances: Vec<InstanceId>,
}

impl Default for WorldBuilder {
    /// An empty world: the top group alone.
    fn default() -> Self {
        Self {
            groups: vec![Members::default()],
            geometries: Vec::new(),
            instances: Vec::new(),
            quality: BuildQuality::default(),
            extents: true,
        }
    }
}

impl World {
    /// Starts an empty world.
    pub fn builder() -> WorldBuilder {
        WorldBuilder::default()
    }
}

impl WorldBuilder {
    /// Adds an empty group, which instances place.
    pub fn add_group(&mut self) -> GroupId {
        self.groups.push(Members::default());
        GroupId(self.groups.len() as u32 - 1)
    }

    /// Adds a geometry to a group.
    pub fn add_geometry(&mut self, group: GroupId, geometry: impl Into<Geometry>) -> GeometryId {
        let id = GeometryId(self.geometries.len() as u32);
        self.geometries.push(geometry.into());
        self.groups[group.0 as usize].geometries.push(id);
        id
    }

    /// Places a group other than the top group in `group`: the top group, or one that was added
    /// after it.
    ///
    /// # Panics
    /// When it would be placed in itself, or in a group that was added before it.
    pub fn add_instance(&mut self, group: GroupId, instance: Instance) -> InstanceId {
        let inner = instance.group;
        assert!(inner != GroupId::TOP, "the top group is not placed in any");
        assert!(group == GroupId::TOP || inner < group, "a group is placed in later ones only");
        let id = InstanceId(self.instances.len() as u32);
        self.instances.push(instance);
        self.groups[group.0 as usize].instances.push(id);
        id
    }

    /// Sets the trade-off between build time and tracing time.
    pub fn quality(mut self, quality: BuildQuality) -> Self {
        self.quality = quality;
        self
    }

    /// Whether rays are tested against bounding volumes before the primitives in them, as by
    /// default, or against every primitive, which finds the same hits.
    pub fn extents(mut self, used: bool) -> Self {
        self.extents = used;
        self
    }

    /// Bytes of address space that building takes for each primitive, at most: references, ids,
    /// binary nodes, blocks and nodes; twice as many references for spatial splits.
    pub fn bytes_per_primitive(&self) -> usize {
        let references = if self.quality == BuildQuality::High { 2 * 32 } else { 32 };
        references + 8 + 24 + 33 + 5
    }

    /// Builds all trees, in parallel. The result does not depend on the number of threads.
    ///
    /// # Panics
    /// When instances are nested more than [`InstancePath::MAX_DEPTH`] deep.
    pub fn build(self) -> World {
        let Self { groups: members, geometries, instances, quality, extents } = self;
        let instances: Vec<_> = instances.into_iter().map(PreparedInstance::new).collect();
        let mut groups: Vec<Option<Group>> = vec![None; members.len()];
        let levels = levels(&members, &instances);
        // A group has fewer levels of instances than those it is placed in, and is built first.
        for level in 0..=levels[0] {
            let built: Vec<(usize, Group)> = (0..members.len())
                .into_par_iter()
                .filter(|&i| levels[i] == level)
                .map(|i| {
                    let placed = |&id: &InstanceId| {
                        let instance = &instances[id.0 as usize];
                        let inner = groups[instance.group as usize].as_ref();
                        (id, instance, inner.expect("invariant: built before"))
                    };
                    let placed: Vec<_> = members[i].instances.iter().map(placed).collect();
                    (i, Group::build(&members[i].geometries, &geometries, &placed, quality))
                })
                .collect();
            for (i, group) in built {
                groups[i] = Some(group);
            }
        }
        let mut group_of = vec![GroupId::TOP; geometries.len()];
        for (group, members) in (0..).zip(&members) {
            members.geometries.iter().for_each(|id| group_of[id.0 as usize] = GroupId(group));
        }
        let groups = groups.into_iter().flatten().collect();
        let instruction_set = InstructionSet::detect();
        let Members { geometries: top, instances: placed } = &members[GroupId::TOP.0 as usize];
        let facets = if placed.is_empty() { Facets::new(top, &geometries) } else { None };
        World { tables: Tables { groups, geometries, group_of, instances, facets, instruction_set, extents } }
    }
}

/// The number of nested levels of instances in each group; the top group has the most.
fn levels(members: &[Members], instances: &[PreparedInstance]) -> Vec<usize> {
    let mut levels = vec![0; members.len()];
    for i in (1..members.len()).chain([0]) {
        let inner = members[i].instances.iter().map(|id| levels[instances[id.0 as usize].group as usize] + 1);
        levels[i] = inner.max().unwrap_or(0);
        assert!(levels[i] <= InstancePath::MAX_DEPTH, "instances are nested too deep");
        levels[0] = levels[0].max(levels[i]);
    }
    levels
}
