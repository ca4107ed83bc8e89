//! Structures that find what a ray hits. They do not change the picture.

/// How a bounding volume hierarchy is split.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BvhSplit {
    /// By the surface area heuristic.
    #[default]
    Sah,
    /// By Morton codes, with the heuristic above them.
    Hlbvh,
    /// At the middle of the longest axis.
    Middle,
    /// Into halves of equal count.
    Equal,
}

/// How much time a hierarchy is worth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BuildQualityDesc {
    /// Built soonest.
    Fast,
    /// Good in little time.
    #[default]
    Balanced,
    /// Traced soonest where triangles are long and thin.
    High,
}

/// An acceleration structure.
#[derive(Clone, Debug, PartialEq)]
pub enum AcceleratorDesc {
    /// A bounding volume hierarchy.
    Bvh {
        /// Most primitives in a leaf.
        max_node_prims: i32,
        /// How nodes are split.
        split: BvhSplit,
        /// How much time it is worth; `None` lets `split` say.
        quality: Option<BuildQualityDesc>,
    },
    /// A k-d tree.
    KdTree {
        /// Cost of a primitive test.
        intersect_cost: i32,
        /// Cost of a step down.
        traversal_cost: i32,
        /// Part of the cost saved where one side is empty, 0 to 1.
        empty_bonus: f32,
        /// Most primitives in a leaf.
        max_prims: i32,
        /// Greatest depth; −1 chooses it from the number of primitives.
        max_depth: i32,
    },
    /// None: every ray is tested against every primitive, so that one sees what the others save.
    None,
}

impl Default for AcceleratorDesc {
    fn default() -> Self {
        Self::Bvh { max_node_prims: 4, split: BvhSplit::Sah, quality: None }
    }
}

impl AcceleratorDesc {
    /// How much time the structure is worth: as said, or as what was asked for takes in other
    /// programs.
    pub fn quality(&self) -> BuildQualityDesc {
        match self {
            Self::Bvh { quality: Some(quality), .. } => *quality,
            Self::Bvh { split: BvhSplit::Hlbvh, .. } => BuildQualityDesc::Fast,
            _ => BuildQualityDesc::Balanced,
        }
    }

    /// Asks for a hierarchy of that quality.
    pub fn set_quality(&mut self, chosen: BuildQualityDesc) {
        if let Self::KdTree { .. } = self {
            *self = Self::default();
        }
        if let Self::Bvh { quality, .. } = self {
            *quality = Some(chosen);
        }
    }
}
