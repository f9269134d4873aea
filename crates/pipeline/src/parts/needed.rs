//! Which parts a step reads: a process must not open those of the whole country for one subtree.
//!
//! Parts are told by their names, `STEP`, `STEP-Z-X-Y` or `STEP-SHARE-OF`. A part whose name says nothing is read, so that nothing is missed.
//!
//! | to make | are read |
//! |---|---|
//! | hashes | hashes |
//! | ways, nodes, roads | ways, nodes, roads |
//! | heights of a subtree | heights of this subtree, of what lies in it and of what it lies in |
//! | top | heights, top |
//! | tiles of a subtree | roads, top; tiles of this subtree, of what lies in it and of what it lies in; heights of all these and of its neighbours |
//! | anything else | all |
//!
//! A coarse tile needs the rasters of its eight neighbours. Those of a subtree's tiles lie in the subtree or in its neighbours; those of the tiles above
//! it lie beside these tiles, and thus in the part of top or in heights of larger subtrees beside them.

use corniche_geom::TileId;

/// Whether the part of this name is read to make a step for the tiles beneath `scope`.
pub(crate) fn is_needed(step: &str, scope: TileId, part: &str) -> bool {
    let (of, rest) = part.split_once('-').map_or((part, None), |(of, rest)| (of, Some(rest)));
    // None where the name does not tell; of a step that is done at once, all.
    let subtree = || rest.map_or(Some(TileId::ROOT), |rest| rest.replace('-', "/").parse().ok());
    let is_around = |subtree: TileId| {
        let level = subtree.z().min(scope.z());
        subtree.ancestor(level) == scope.ancestor(level)
    };
    match (step, of) {
        ("hashes", "ways" | "nodes" | "roads" | "heights" | "top" | "tiles")
        | ("ways" | "nodes" | "roads", "hashes" | "heights" | "top" | "tiles")
        | ("heights", "hashes" | "ways" | "nodes" | "roads" | "top" | "tiles")
        | ("top", "hashes" | "ways" | "nodes" | "roads" | "tiles")
        | ("tiles", "hashes" | "ways" | "nodes") => false,
        ("heights", "heights") | ("tiles", "tiles") => subtree().is_none_or(is_around),
        ("tiles", "heights") => subtree().is_none_or(|subtree| subtree.is_beside(scope)),
        _ => true,
    }
}

#[cfg(test)]
#[path = "needed_tests.rs"]
mod tests;
