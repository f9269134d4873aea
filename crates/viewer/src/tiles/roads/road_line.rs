//! Common steps of both methods for the lines of a tile: parts on decks are removed, and lines end
//! flat where they continue as other lines.

use std::borrow::Cow;

use super::{
    RoadKind,
    cut::OffGroundRoads,
    decks::GroundNet,
    flat_ends::{LineEnds, flat_ends},
    parts::{InNet, KnownNet, NetLine, part_lengths_m},
};

/// A line of a road, for one of the two methods.
pub(crate) trait RoadLine: Clone {
    /// OSM's id of the way, and the kind of the road.
    fn road(&self) -> (i64, RoadKind);
    /// Its vertices in plan.
    fn vertices_m(&self) -> Vec<[f64; 2]>;
    /// The ends of the line, if it was not cut within the tile.
    fn ends(&self) -> LineEnds;
    /// The parts of the line that are not on a deck.
    fn off_decks(&self, decks: &OffGroundRoads<'_>) -> Vec<Cow<'_, Self>>;
}

impl<'a, L: RoadLine> InNet<'a, L> {
    /// The parts of the lines of a tile, and of a margin around it, that are not on a deck. Network
    /// parts are those of the whole lines: bridges connect them.
    pub(crate) fn all_of(
        lines: &'a [L],
        decks: &OffGroundRoads<'_>,
        margin_m: f64,
    ) -> (Vec<Self>, GroundNet) {
        let in_net = |line: &L| NetLine { kind: line.road().1, vertices_m: line.vertices_m() };
        let net: Vec<NetLine> = lines.iter().map(in_net).collect();
        let known = KnownNet { margin_m, ..KnownNet::within(decks.tile) };
        let lines = lines.iter().zip(part_lengths_m(&net, known));
        let parts_m = lines.clone().map(|(line, part_m)| (line.road().0, part_m)).collect();
        let on_ground: Vec<Self> = lines
            .flat_map(|(line, part_m)| {
                line.off_decks(decks).into_iter().map(move |line| InNet { line, part_m })
            })
            .collect();
        let ends = on_ground.iter().map(|in_net| in_net.line.ends()).collect();
        (on_ground, GroundNet { ends, parts_m })
    }

    /// Each line, the length of its part of the network, and whether it is flat at its start and at
    /// its end even if roads have caps.
    pub(crate) fn with_flat_ends<'l>(
        lines: &'l [Self],
        decks: &OffGroundRoads<'_>,
    ) -> Vec<(&'l L, f32, [bool; 2])> {
        let ends: Vec<LineEnds> =
            lines.iter().map(|in_net| in_net.line.ends()).chain(decks.ends()).collect();
        let flat = flat_ends(&ends, decks.tile).into_iter().zip(&ends);
        let with_flat = lines.iter().zip(flat).map(|(InNet { line, part_m }, (flat, ends))| {
            // A bore ends flat where it emerges from the ground, and has its tick there.
            let flat = if line.road().1.look.is_bore() { decks.portals(ends) } else { flat };
            (line.as_ref(), *part_m, flat)
        });
        with_flat.collect()
    }
}
