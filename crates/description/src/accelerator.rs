//! Acceleration structures for ray intersection. They do not change the picture.

use crate::schema::{at_least, choices, from, settings};

choices! {
    /// How a bounding volume hierarchy is split.
    pub enum BvhSplit {
        /// By the surface area heuristic.
        #[default]
        Sah = "sah",
        /// By Morton codes, with the heuristic above them.
        Hlbvh = "hlbvh",
        /// At the middle of the longest axis.
        Middle = "middle",
        /// Into halves of equal count.
        Equal = "equal",
    }
}

choices! {
    /// How much time the build of a hierarchy may take.
    pub enum BuildQualityDesc {
        /// The shortest build.
        Fast = "fast",
        /// Good rays per second after a short build.
        #[default]
        Balanced = "balanced",
        /// The most rays per second where triangles are long and thin.
        High = "high",
    }
}

settings! {
    /// An acceleration structure.
    #[derive(Clone, Debug, PartialEq)]
    pub enum AcceleratorDesc = Bvh {
        /// A bounding volume hierarchy.
        Bvh = "bvh" {
            /// Maximum number of primitives in a leaf. Part of the format; has no effect.
            max_node_prims: i32 = 4 => ["maxnodeprims": from(1.0, 255.0)];
            /// How nodes are split. `hlbvh` selects the quality `fast`, all others `balanced`.
            split: BvhSplit = BvhSplit::Sah => ["splitmethod"];
            /// How much time the build may take. If absent, `splitmethod` selects it.
            quality: Option<BuildQualityDesc> = None => ["quality"];
        },
        /// A k-d tree. A bounding volume hierarchy is built in its place.
        KdTree = "kdtree" (not drawn) {
            /// Cost of a primitive test.
            intersect_cost: i32 = 5 => ["intersectcost": at_least(0.0)];
            /// Cost of a step down.
            traversal_cost: i32 = 1 => ["traversalcost": at_least(0.0)];
            /// Share of the cost that is saved where one side is empty.
            empty_bonus: f32 = 0.5 => ["emptybonus"];
            /// Maximum number of primitives in a leaf.
            max_prims: i32 = 1 => ["maxprims": at_least(1.0)];
            /// Maximum depth. −1 chooses it by the number of primitives.
            max_depth: i32 = -1 => ["maxdepth": at_least(-1.0)];
            /// How much time the build of the hierarchy that replaces it may take.
            quality: Option<BuildQualityDesc> = None => ["quality"];
        },
        /// No hierarchy: every ray is tested against every primitive, for comparison.
        None = "none",
    }
}

impl AcceleratorDesc {
    /// How much time the build may take: as described, or as the described structure usually takes.
    pub fn quality(&self) -> BuildQualityDesc {
        match self {
            Self::Bvh { quality: Some(quality), .. } | Self::KdTree { quality: Some(quality), .. } => {
                *quality
            }
            Self::Bvh { split: BvhSplit::Hlbvh, .. } => BuildQualityDesc::Fast,
            _ => BuildQualityDesc::Balanced,
        }
    }
}
