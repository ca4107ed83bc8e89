//! The way into instances that lie in each other.

use super::InstanceId;

/// The instances through which a ray came to where it is, the outermost first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct InstancePath([InstanceId; InstancePath::MOST]);

impl InstancePath {
    /// The most instances that lie in each other.
    pub const MOST: usize = 8;

    const NONE: InstanceId = InstanceId(u32::MAX);

    /// In the top group.
    pub const TOP: Self = Self([Self::NONE; Self::MOST]);

    /// The instances, the outermost first.
    pub fn ids(&self) -> &[InstanceId] {
        let len = self.0.iter().position(|&id| id == Self::NONE).unwrap_or(Self::MOST);
        &self.0[..len]
    }

    /// The path on into an instance.
    ///
    /// # Panics
    /// When the path has [`MOST`](Self::MOST) instances already.
    pub fn into(mut self, id: InstanceId) -> Self {
        let len = self.ids().len();
        self.0[len] = id;
        self
    }
}
