//! Roads that are not draped on the ground, for comparison with the papers.

use super::{DeckLine, GroundLine};

impl DeckLine {
    /// Returns a road on the ground as an undraped line: straight in space from each point of its
    /// source line, or of the tile's border, to the next.
    pub(crate) fn unmapped(line: &GroundLine) -> Self {
        let GroundLine { way_id, kind, ref points_m, ref sources_m, .. } = *line;
        // Vertices within a source segment are its crossings with edges of triangles.
        let is_source = |at: usize| at == 0 || sources_m.get(at - 1) != sources_m.get(at);
        let points_m = (0..points_m.len()).filter(|at| is_source(*at)).map(|at| points_m[at]);
        Self { way_id, kind, is_road: true, points_m: points_m.collect(), on_ground: [false; 2] }
    }
}

#[cfg(test)]
#[path = "unmapped_tests.rs"]
mod tests;
