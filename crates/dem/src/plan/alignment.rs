//! Where the samples of a raster lie exactly on nodes of the grid: the rule from nodes to samples.

use corniche_geom::NodeIndex;

/// Sample (column, row) = (`way[0]` · (`every` · i − `first[0]`), `way[1]` · (`every` · j − `first[1]`)).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Alignment {
    /// Index of sample (0, 0), counted in samples from node (0, 0).
    pub(crate) first: [i64; 2],
    pub(crate) way: [i64; 2],
    pub(crate) every: i64,
}

impl Alignment {
    /// The sample under a node.
    pub(crate) fn sample(&self, node: NodeIndex) -> [i64; 2] {
        [
            self.way[0] * (self.every * node.i - self.first[0]),
            self.way[1] * (self.every * node.j - self.first[1]),
        ]
    }
}
