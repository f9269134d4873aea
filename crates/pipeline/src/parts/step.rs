//! The steps of a build that a process can run alone.

corniche_roads::listed! {
    /// A step of a build that a process can run alone.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    pub enum PartStep {
        /// Hash the inputs.
        Hashes = "hashes",
        /// Find the road ways in a share of the extract.
        Ways = "ways",
        /// Find the nodes of road ways in a share of the extract.
        Nodes = "nodes",
        /// Cut the extract's roads by tile, from the shares or from the extract itself.
        Roads = "roads",
        /// Read the heights of a subtree.
        Heights = "heights",
        /// Check the heights of all subtrees, and build the coarse tiles above them.
        Top = "top",
        /// Build the tiles of a subtree.
        Tiles = "tiles",
    }

    /// The name of the step on the command line.
    pub fn name() -> &'static str;
}

impl PartStep {
    /// Whether the step can be run for one share of the extract.
    #[must_use]
    pub const fn has_shares(self) -> bool {
        matches!(self, Self::Ways | Self::Nodes)
    }

    /// Whether the step can be run for one subtree.
    #[must_use]
    pub const fn has_subtrees(self) -> bool {
        matches!(self, Self::Heights | Self::Tiles)
    }
}
