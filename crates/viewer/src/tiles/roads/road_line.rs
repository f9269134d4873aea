//! What both methods do with the lines of a tile: what is on decks is taken away, and lines end
//! flat where they go on.

use std::borrow::Cow;

use super::{
    RoadKind,
    cut::OffGround,
    decks::GroundNet,
    flat_ends::{LineEnds, flat_ends},
    parts::{InNet, KnownNet, NetLine, part_lengths_m},
};

/// A line of a road, as one of both methods has it.
pub(crate) trait RoadLine: Clone {
    /// OSM's id of the way.
    fn way_id(&self) -> i64;
    /// What it is.
    fn kind(&self) -> RoadKind;
    /// It as a line of the network.
    fn in_net(&self) -> NetLine;
    /// Its ends, where it was not cut within the tile.
    fn ends(&self) -> LineEnds;
    /// What of it is on no deck.
    fn off_decks(&self, decks: &OffGround<'_>) -> Vec<Cow<'_, Self>>;
}

impl<'a, L: RoadLine> InNet<'a, L> {
    /// What of the lines of a tile, and of a margin around it, is on no deck. Parts of the network
    /// are those of whole lines: bridges join them.
    pub(crate) fn all_of(
        lines: &'a [L],
        decks: &OffGround<'_>,
        margin_m: f64,
    ) -> (Vec<Self>, GroundNet) {
        let net: Vec<NetLine> = lines.iter().map(L::in_net).collect();
        let known = KnownNet { margin_m, ..KnownNet::within(decks.tile) };
        let lines = lines.iter().zip(part_lengths_m(&net, known));
        let parts_m = lines.clone().map(|(line, part_m)| (line.way_id(), part_m)).collect();
        let on_ground: Vec<Self> = lines
            .flat_map(|(line, part_m)| {
                line.off_decks(decks).into_iter().map(move |line| InNet { line, part_m })
            })
            .collect();
        let ends = on_ground.iter().map(|in_net| in_net.line.ends()).collect();
        (on_ground, GroundNet { ends, parts_m })
    }

    /// Each line, how long its part of the network is, and whether it is flat at its beginning and
    /// at its end, also where roads have caps.
    pub(crate) fn with_flat_ends<'l>(
        lines: &'l [Self],
        decks: &OffGround<'_>,
    ) -> Vec<(&'l L, f32, [bool; 2])> {
        let ends: Vec<LineEnds> =
            lines.iter().map(|in_net| in_net.line.ends()).chain(decks.ends()).collect();
        let flat = flat_ends(&ends, decks.tile).into_iter().zip(&ends);
        let with_flat = lines.iter().zip(flat).map(|(InNet { line, part_m }, (flat, ends))| {
            // A bore ends flat where it comes out of the ground, and its tick is there.
            let flat = if line.kind().look.is_bore() { decks.portals(ends) } else { flat };
            (line.as_ref(), *part_m, flat)
        });
        with_flat.collect()
    }
}
