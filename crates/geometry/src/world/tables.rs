//! The tables of a world, joined by ids.

use super::facets::Facets;
use super::geometry::{Geometry, GeometryId};
use super::group::Group;
use super::instance::{GroupId, PreparedInstance};
use lanes::InstructionSet;

/// The tables that rays are traced against.
#[derive(Clone, Debug)]
pub(super) struct Tables {
    /// By [`GroupId`].
    pub groups: Vec<Group>,
    /// By [`GeometryId`].
    pub geometries: Vec<Geometry>,
    /// The group of each geometry.
    pub group_of: Vec<GroupId>,
    /// By [`super::InstanceId`].
    pub instances: Vec<PreparedInstance>,
    /// The top group, if it is so small that no tree is of use.
    pub facets: Option<Facets>,
    /// Rays are traced with it; the processor has it.
    pub instruction_set: InstructionSet,
    /// Whether rays are tested against bounding volumes before primitives.
    pub extents: bool,
}

impl Tables {
    pub fn geometry(&self, id: GeometryId) -> &Geometry {
        &self.geometries[id.0 as usize]
    }

    /// The group that rays start in.
    pub fn top(&self) -> &Group {
        &self.groups[GroupId::TOP.0 as usize]
    }
}
