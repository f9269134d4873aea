//! The steps of a build that a process can do alone.

/// A step of a build that a process can do alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Step {
    /// Hash the inputs.
    Hashes,
    /// Find the road ways in a share of the extract.
    Ways,
    /// Find the nodes of road ways in a share of the extract.
    Nodes,
    /// Cut the extract's roads by tile, from the shares or from the extract itself.
    Roads,
    /// Read the heights of a subtree.
    Heights,
    /// Check the heights of all subtrees, and make what lies above them.
    Top,
    /// Make the tiles of a subtree.
    Tiles,
}

impl Step {
    /// All steps, in an order in which they can be done.
    pub const ALL: [Self; 7] =
        [Self::Hashes, Self::Ways, Self::Nodes, Self::Roads, Self::Heights, Self::Top, Self::Tiles];

    /// Its name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hashes => "hashes",
            Self::Ways => "ways",
            Self::Nodes => "nodes",
            Self::Roads => "roads",
            Self::Heights => "heights",
            Self::Top => "top",
            Self::Tiles => "tiles",
        }
    }

    /// Whether it can be done for one share of the extract alone.
    #[must_use]
    pub const fn has_shares(self) -> bool {
        matches!(self, Self::Ways | Self::Nodes)
    }

    /// Whether it can be done for one subtree alone.
    #[must_use]
    pub const fn has_subtrees(self) -> bool {
        matches!(self, Self::Heights | Self::Tiles)
    }
}
