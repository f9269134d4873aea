//! What a person is told of a stage of any command: its names and what it counts.

use corniche_pipeline::{Stage, Unit};

/// A stage of a command, as it is told of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Task {
    /// Its name for programs, which does not change.
    pub(crate) id: &'static str,
    /// Its name for people; at most 22 characters, one column of a table.
    pub(crate) title: &'static str,
    pub(crate) counts: Counts,
}

/// What a stage counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Counts {
    /// Bytes, which have units of their own.
    Bytes,
    /// Things, by the name of several of them, which ends in s.
    Things(&'static str),
}

impl Counts {
    /// Several of what is counted.
    pub(crate) fn plural(self) -> &'static str {
        match self {
            Self::Bytes => "bytes",
            Self::Things(name) => name,
        }
    }
}

impl Task {
    /// The comparison of a package with an image.
    pub(crate) const MATCH: Self =
        Self { id: "match", title: "comparing tiles", counts: Counts::Things("tiles") };
    /// The frames of a flight, of one way of drawing.
    pub(crate) const FLY: Self =
        Self { id: "fly", title: "drawing frames", counts: Counts::Things("frames") };
}

impl From<Stage> for Task {
    fn from(stage: Stage) -> Self {
        let counts = match stage.unit() {
            Unit::Bytes => Counts::Bytes,
            Unit::Blocks => Counts::Things("blocks"),
            Unit::Patches => Counts::Things("areas"),
            Unit::Tiles => Counts::Things("tiles"),
        };
        Self { id: stage.id(), title: stage.title(), counts }
    }
}

impl From<corniche_export::Stage> for Task {
    fn from(stage: corniche_export::Stage) -> Self {
        let (id, title, counted) = match stage {
            corniche_export::Stage::Tiles => ("export-tiles", "reading tiles", "tiles"),
            corniche_export::Stage::Blocks => ("export-blocks", "writing blocks", "blocks"),
            corniche_export::Stage::Pieces => ("export-features", "writing features", "pieces"),
        };
        Self { id, title, counts: Counts::Things(counted) }
    }
}
