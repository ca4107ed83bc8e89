//! Groups, their instances, and paths through nested instances.

use crate::placement::Placement;
use math::AnimatedTransform;

/// A group of geometries, in the order of
/// [`WorldBuilder::add_group`](crate::WorldBuilder::add_group).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct GroupId(pub u32);

impl GroupId {
    /// The group that rays start in.
    pub const TOP: Self = Self(0);
}

/// An instance, in the order of [`WorldBuilder::add_instance`](crate::WorldBuilder::add_instance).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct InstanceId(pub u32);

/// A group placed in another one.
#[derive(Clone, Debug)]
pub struct Instance {
    /// The group that is placed.
    pub group: GroupId,
    /// From the space of that group to the space of the group it is placed in.
    pub render_from_instance: AnimatedTransform,
}

/// An instance prepared for rays.
#[derive(Clone, Debug)]
pub(super) struct PreparedInstance {
    /// The index of the group that is placed.
    pub group: u32,
    pub motion: AnimatedTransform,
    /// Inverted once, where nothing moves.
    at_rest: Option<Placement>,
}

impl PreparedInstance {
    pub fn new(instance: Instance) -> Self {
        let motion = instance.render_from_instance;
        let at_rest = (!motion.is_moving()).then(|| Placement::new(motion.start()));
        Self { group: instance.group.0, motion, at_rest }
    }

    /// Calls `f` with the placement at a time.
    #[inline]
    pub fn with_placement<T>(&self, time: f32, f: impl FnOnce(&Placement) -> T) -> T {
        match &self.at_rest {
            Some(placement) => f(placement),
            None => f(&Placement::new(&self.motion.at(time))),
        }
    }
}

/// The nested instances that a ray has entered, the outermost first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct InstancePath([InstanceId; InstancePath::MAX_DEPTH]);

impl InstancePath {
    /// How deep instances may be nested.
    pub const MAX_DEPTH: usize = 8;

    const NONE: InstanceId = InstanceId(u32::MAX);

    /// No instance: the top group itself.
    pub const TOP: Self = Self([Self::NONE; Self::MAX_DEPTH]);

    /// Whether there is no instance.
    #[inline]
    pub fn is_top(&self) -> bool {
        self.0[0] == Self::NONE
    }

    /// The instances, the outermost first.
    pub fn ids(&self) -> &[InstanceId] {
        let len = self.0.iter().position(|&id| id == Self::NONE).unwrap_or(Self::MAX_DEPTH);
        &self.0[..len]
    }

    /// This path followed by one more instance.
    ///
    /// # Panics
    /// When the path has [`MAX_DEPTH`](Self::MAX_DEPTH) instances already.
    pub fn into(mut self, id: InstanceId) -> Self {
        let len = self.ids().len();
        self.0[len] = id;
        self
    }
}
