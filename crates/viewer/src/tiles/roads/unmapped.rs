//! Roads that are laid on nothing, to compare with the papers.

use super::{DeckLine, GroundLine};

impl DeckLine {
    /// A road on the ground as a line that is laid on nothing: straight in space from each point of its source line, or of the tile's border, to the
    /// next.
    pub(crate) fn unmapped(line: &GroundLine) -> Self {
        let GroundLine { way_id, kind, ref points_m, ref sources_m, .. } = *line;
        // Vertices within a source segment are where it crosses edges of triangles.
        let is_source = |at: usize| at == 0 || sources_m.get(at - 1) != sources_m.get(at);
        let points_m = (0..points_m.len()).filter(|at| is_source(*at)).map(|at| points_m[at]);
        Self { way_id, kind, points_m: points_m.collect(), on_ground: [false; 2] }
    }
}

#[cfg(test)]
#[path = "unmapped_tests.rs"]
mod tests;
