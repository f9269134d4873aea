//! Pass 1: finds the ways of a file, or of some of its blobs, and the blobs that contain nodes.

use std::io::{self, Read, Seek};

use corniche_roads::FrcTable;
use corniche_store::Sorter;

use crate::{
    ExtractDefect, ExtractSummary,
    block::AuditedBlock,
    extracts::{Extracts, TOO_MUCH_FOUND},
    failed::Failed,
    location::Location,
    looked::{BlockSurvey, LookedAt, check_held},
    outlines::found_nodes::{FoundNodes, NodeScan},
    outlines::{
        found::Outlines,
        judge::{self, OwnTags, WantedWays},
        wanted::WantedObjects,
    },
    reading::{ExtractReading, ReadingStep},
    records::{Located, WayRecord},
    search::IdSearch,
    ways::{BlockWays, Counted, WayJudge, add_summary},
};

/// The results of the first pass: roads, and the ways and blobs of all layers.
pub(crate) struct FoundWays<'a> {
    pub(crate) ways: Sorter<'a, WayRecord>,
    pub(crate) located: Sorter<'a, Located>,
    pub(crate) summary: ExtractSummary,
    pub(crate) looked_at: LookedAt,
    /// The memory of the road ways, bytes, by an estimate that is never too low.
    pub(crate) held_bytes: u64,
    /// The number of references to nodes in road ways and in skipped ways; repeated references
    /// count.
    pub(crate) nodes_named: u64,
    roads_count: u64,
    located_count: u64,
}

/// The ways to look for in some blobs.
pub(crate) struct WaysWanted<'w> {
    /// The table that says which ways are roads, if roads are requested.
    pub(crate) roads: Option<&'w FrcTable>,
    /// Whether railways are stored with the roads, because bridges and tunnels are requested.
    pub(crate) are_railways_wanted: bool,
    /// The treatment of ways that are objects by their own tags.
    pub(crate) own_tags: OwnTags,
    /// Ids of requested ways for each kind of objects, ascending.
    pub(crate) way_ids: Vec<Vec<i64>>,
    /// Whether the blobs were not scanned before.
    pub(crate) is_first: bool,
    /// The bytes of ways that were read before, and their total, for progress reports.
    pub(crate) bytes: [u64; 2],
}

/// The findings in a block.
struct OfBlock {
    looked: Option<BlockSurvey>,
    roads: BlockWays,
    outlines: Vec<judge::OfBlock>,
    /// The nodes of layers of points.
    nodes: Vec<judge::OfBlock>,
}

impl OfBlock {
    /// Scans a block. Fails if the findings take more than `most_bytes`, or tags of nodes are
    /// corrupt.
    fn scan(
        message: &[u8],
        wanted: &WaysWanted<'_>,
        (outlines, nodes): (&[WantedObjects<'_>], &NodeScan<'_>),
        (counted, most_bytes): (Counted, u64),
    ) -> Result<Self, &'static str> {
        let block = AuditedBlock::new(message);
        let texts = block.texts();
        // Each way of a block with ways alone is inspected once, for all purposes together.
        let mut of_ways = (wanted.is_first && block.has_ways_alone()).then(BlockSurvey::of_ways);
        let looked = (wanted.is_first && of_ways.is_none()).then(|| BlockSurvey::scan(&block));
        let has_nodes = looked.is_some();
        let nodes = if has_nodes { nodes.scan(&block, most_bytes)? } else { Vec::new() };
        let mut found = Self { looked, roads: BlockWays::default(), outlines: Vec::new(), nodes };
        let of_nodes: u64 = found.nodes.iter().map(|own| own.held_bytes).sum();
        let roads =
            wanted.roads.map(|table| WayJudge::new(&texts, table, wanted.are_railways_wanted));
        let judges: Vec<judge::OutlineJudge<'_>> =
            outlines.iter().map(|&wanted| judge::OutlineJudge::new(&texts, wanted)).collect();
        let mut wanted_ways: Vec<WantedWays<'_>> = wanted
            .way_ids
            .iter()
            .map(|ids| WantedWays { own_tags: wanted.own_tags, ids: IdSearch::new(ids) })
            .collect();
        found.outlines.resize_with(judges.len(), judge::OfBlock::default);
        for way in block.ways() {
            if let Some(looked) = &mut of_ways {
                looked.take_way(&way);
            }
            if let Some(judge) = &roads {
                found.roads.look_at(&way, judge, counted);
            }
            for ((wanted, judge), own) in
                wanted_ways.iter_mut().zip(&judges).zip(&mut found.outlines)
            {
                wanted.look_at(&way, judge, own);
            }
            let of_outlines: u64 = found.outlines.iter().map(|own| own.held_bytes).sum();
            if found.roads.held_bytes + of_outlines + of_nodes > most_bytes {
                return Err(TOO_MUCH_FOUND);
            }
        }
        found.looked = of_ways.or(found.looked);
        Ok(found)
    }
}

impl<'a> FoundWays<'a> {
    pub(crate) fn new(reading: &ExtractReading<'a>) -> Self {
        let shares = reading.shares();
        Self {
            ways: reading.sorter(shares.ways),
            located: reading.sorter(shares.located),
            summary: ExtractSummary::default(),
            looked_at: LookedAt::default(),
            held_bytes: 0,
            nodes_named: 0,
            roads_count: 0,
            located_count: 0,
        }
    }

    /// Reads the blobs with these numbers. Defects in the tags of roads go to `on_defect`, in the
    /// order of the file.
    pub(crate) fn read<R: Read + Seek>(
        &mut self,
        reading: &ExtractReading<'a>,
        file: &mut Extracts<R>,
        numbers: &[usize],
        wanted: &WaysWanted<'_>,
        (outlines, nodes): (&mut [Outlines<'a>], &mut FoundNodes<'a>),
        on_defect: &mut dyn FnMut(ExtractDefect),
    ) -> Result<(), Failed> {
        let [before, all_bytes] = wanted.bytes;
        let on_bytes = &|bytes| reading.tell(ReadingStep::Ways, before + bytes, all_bytes);
        let counted = if reading.is_of_several() { Counted::ByWay } else { Counted::ByBlock };
        let of_outlines: Vec<_> = outlines.iter().map(|outlines| outlines.wanted).collect();
        let of_nodes = nodes.scanned();
        let scan = |block: Vec<u8>, most_bytes| {
            let of_layers = (of_outlines.as_slice(), &of_nodes);
            Ok(OfBlock::scan(&block, wanted, of_layers, (counted, most_bytes))?)
        };
        file.for_each_block(reading, numbers, on_bytes, scan, |place, of_block| {
            let [file, _] = place;
            if let Some(looked) = of_block.looked {
                self.looked_at.take(reading, place, looked)?;
            }
            nodes.take(reading, file as u32, of_block.nodes)?;
            // Layers are numbered in their order: roads come last.
            let place = [file as u32, of_outlines.len() as u32];
            self.take_roads(reading, place, of_block.roads, on_defect)?;
            for (layer, (outlines, mut own)) in
                (0..).zip(outlines.iter_mut().zip(of_block.outlines))
            {
                self.take_located(layer, std::mem::take(&mut own.located))?;
                outlines.take(reading, file as u32, own, false)?;
            }
            Ok(())
        })
    }

    fn take_roads(
        &mut self,
        reading: &ExtractReading<'_>,
        [file, layer]: [u32; 2],
        of_block: BlockWays,
        on_defect: &mut dyn FnMut(ExtractDefect),
    ) -> Result<(), Failed> {
        self.held_bytes += of_block.held_bytes;
        check_held(reading, self.held_bytes)?;
        self.nodes_named += of_block.nodes_named;
        of_block.defects.into_iter().for_each(&mut *on_defect);
        add_summary(&mut self.summary, of_block.summary);
        for mut way in of_block.roads {
            way.origin.place(reading, file, &mut self.roads_count);
            self.ways.push(way)?;
        }
        Ok(self.take_located(layer as u8, of_block.located)?)
    }

    fn take_located(&mut self, layer: u8, located: Vec<(i64, Location)>) -> io::Result<()> {
        for (node_id, location) in located {
            let located = Located { node_id, order: self.located_count, location, layer };
            self.located_count += 1;
            self.located.push(located)?;
        }
        Ok(())
    }
}
