//! Pass 1: the ways of a file, or of some of its blobs, and where nodes are.

use std::io::{Read, Seek};

use corniche_roads::FrcTable;
use corniche_store::Sorter;
use serde::{Deserialize, Serialize};

use crate::{
    Defect, ExtractSummary, ReadOsmError,
    blobs::Decoding,
    block::Block,
    extracts::{Extracts, TOO_MUCH_FOUND},
    id_range::IdRange,
    location::Location,
    outlines::{
        found::Outlines,
        judge::{self, OwnTags, WantedWays},
        wanted::Wanted,
    },
    reading::{Reading, Step},
    records::{Located, WayRecord, age},
    search::Search,
    versions::{History, Versions},
    ways::{Counted, Judge, Ways, add_summary},
};

/// What may be kept of any file, in memory or in scratch space, …
const HELD_BYTES: u64 = 64 << 20;
/// … and on top of it for each of its bytes.
const HELD_BYTES_PER_BYTE: u64 = 64;

/// What the first pass finds of roads, and of ways and blobs of all layers.
pub(crate) struct FoundWays<'a> {
    pub(crate) ways: Sorter<'a, WayRecord>,
    pub(crate) located: Sorter<'a, Located>,
    pub(crate) summary: ExtractSummary,
    pub(crate) looked_at: LookedAt,
    /// What the ways of roads take, by an estimate that is not too low.
    pub(crate) held_bytes: u64,
    /// Numbers of the blobs with ways.
    pub(crate) way_blobs: Vec<usize>,
    roads_count: u64,
    located_count: u64,
}

/// A blob with nodes.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(crate) struct NodeBlob {
    pub(crate) number: usize,
    pub(crate) ids: IdRange,
}

/// What is asked of each block once, whatever else is read of it.
pub(crate) struct Looked {
    versions: Versions,
    ids: Option<IdRange>,
    pub(crate) has_relations: bool,
    has_ways: bool,
}

impl Looked {
    pub(crate) fn scan(message: &[u8], block: &Block<'_>) -> Self {
        Self {
            versions: Versions::scan(message),
            ids: IdRange::scan(message),
            has_relations: block.has_relations(),
            has_ways: block.ways().next().is_some(),
        }
    }
}

/// What is known of all blobs that were looked at.
#[derive(Default)]
pub(crate) struct LookedAt {
    pub(crate) versions: Versions,
    pub(crate) node_blobs: Vec<NodeBlob>,
    /// Numbers of those with nodes or ways.
    pub(crate) with_others_than_relations: Vec<usize>,
    pub(crate) has_relations: bool,
}

impl LookedAt {
    /// Takes what a later blob of an extract holds; fails if the blobs are of more than one point in time.
    pub(crate) fn take(
        &mut self,
        reading: &Reading<'_>,
        [file, number]: [usize; 2],
        looked: Looked,
    ) -> Result<(), ReadOsmError> {
        append_versions(reading, &mut self.versions, looked.versions.of_file(file as u32))?;
        self.node_blobs.extend(looked.ids.map(|ids| NodeBlob { number, ids }));
        if looked.has_ways || looked.ids.is_some() {
            self.with_others_than_relations.push(number);
        }
        self.has_relations |= looked.has_relations;
        Ok(())
    }

    /// Adds what is known of later blobs.
    pub(crate) fn append(
        &mut self,
        reading: &Reading<'_>,
        later: Self,
    ) -> Result<(), ReadOsmError> {
        append_versions(reading, &mut self.versions, later.versions)?;
        self.node_blobs.extend(later.node_blobs);
        self.has_relations |= later.has_relations;
        Ok(())
    }
}

/// What is looked for in some blobs.
pub(crate) struct WaysWanted<'w> {
    /// Which ways are roads, if any are wanted.
    pub(crate) roads: Option<&'w FrcTable>,
    /// What is done with ways that are objects by their own tags.
    pub(crate) own_tags: OwnTags,
    /// Ways that are wanted by their ids, of each kind of objects; ascending.
    pub(crate) way_ids: Vec<Vec<i64>>,
    /// Whether the blobs were not looked at before.
    pub(crate) is_first: bool,
    /// What was read of ways before, and what there is in all, for the progress.
    pub(crate) bytes: [u64; 2],
}

/// What was found in a block.
struct OfBlock {
    looked: Option<Looked>,
    roads: Ways,
    outlines: Vec<judge::OfBlock>,
    has_ways: bool,
}

impl OfBlock {
    /// `None` if it takes more than `most_bytes`.
    fn scan(
        message: &[u8],
        wanted: &WaysWanted<'_>,
        (outlines, counted): (&[Wanted<'_>], Counted),
        most_bytes: u64,
    ) -> Option<Self> {
        let block = Block::new(message);
        let texts = block.texts();
        let looked = wanted.is_first.then(|| Looked::scan(message, &block));
        let mut found =
            Self { looked, roads: Ways::default(), outlines: Vec::new(), has_ways: false };
        let roads = wanted.roads.map(|table| Judge::new(&texts, table));
        if roads.is_some() {
            found.roads.summary.nodes_seen = block.nodes_count();
        }
        let judges: Vec<judge::Judge<'_>> =
            outlines.iter().map(|&wanted| judge::Judge::new(&texts, wanted)).collect();
        let mut wanted_ways: Vec<WantedWays<'_>> = wanted
            .way_ids
            .iter()
            .map(|ids| WantedWays { own_tags: wanted.own_tags, ids: Search::new(ids) })
            .collect();
        found.outlines.resize_with(judges.len(), judge::OfBlock::default);
        for way in block.ways() {
            found.has_ways = true;
            if let Some(judge) = &roads {
                found.roads.look_at(&way, judge, counted);
            }
            for ((wanted, judge), own) in
                wanted_ways.iter_mut().zip(&judges).zip(&mut found.outlines)
            {
                wanted.look_at(&way, judge, own);
            }
            let of_outlines: u64 = found.outlines.iter().map(|own| own.held_bytes).sum();
            if found.roads.held_bytes + of_outlines > most_bytes {
                return None;
            }
        }
        Some(found)
    }
}

impl<'a> FoundWays<'a> {
    pub(crate) fn new(reading: &Reading<'a>) -> Self {
        let shares = reading.shares();
        Self {
            ways: reading.sorter(shares.ways),
            located: reading.sorter(shares.located),
            summary: ExtractSummary::default(),
            looked_at: LookedAt::default(),
            held_bytes: 0,
            way_blobs: Vec::new(),
            roads_count: 0,
            located_count: 0,
        }
    }

    /// Reads the blobs with these numbers. What is wrong with tags of roads goes to `on_defect`, in the order of the file.
    pub(crate) fn read<R: Read + Seek>(
        &mut self,
        reading: &Reading<'a>,
        file: &mut Extracts<R>,
        numbers: &[usize],
        wanted: &WaysWanted<'_>,
        outlines: &mut [Outlines<'a>],
        on_defect: &mut dyn FnMut(Defect),
    ) -> Result<(), ReadOsmError> {
        let [before, all_bytes] = wanted.bytes;
        let decoding = Decoding {
            pool: reading.request.pool,
            should_stop: reading.should_stop,
            on_bytes: &|bytes| reading.tell(Step::Ways, before + bytes, all_bytes),
        };
        let counted = if reading.is_of_several() { Counted::ByWay } else { Counted::ByBlock };
        let of_outlines: Vec<_> = outlines.iter().map(|outlines| outlines.wanted).collect();
        let scan = |block: Vec<u8>, most_bytes| {
            let how = (of_outlines.as_slice(), counted);
            Ok(OfBlock::scan(&block, wanted, how, most_bytes).ok_or(TOO_MUCH_FOUND)?)
        };
        file.for_each_block(numbers, &decoding, scan, |place, of_block| {
            let [file, number] = place;
            if let Some(looked) = of_block.looked {
                self.looked_at.take(reading, place, looked)?;
            }
            if of_block.has_ways {
                self.way_blobs.push(number);
            }
            self.take_roads(reading, file as u32, of_block.roads, on_defect)?;
            for (outlines, mut own) in outlines.iter_mut().zip(of_block.outlines) {
                self.take_located(reading, std::mem::take(&mut own.located))?;
                outlines.take(reading, file as u32, own, false)?;
            }
            Ok(())
        })
    }

    fn take_roads(
        &mut self,
        reading: &Reading<'_>,
        file: u32,
        of_block: Ways,
        on_defect: &mut dyn FnMut(Defect),
    ) -> Result<(), ReadOsmError> {
        self.held_bytes += of_block.held_bytes;
        check_held(reading, self.held_bytes)?;
        of_block.defects.into_iter().for_each(&mut *on_defect);
        add_summary(&mut self.summary, of_block.summary);
        for mut way in of_block.roads {
            way.order = self.roads_count;
            way.file = file;
            way.age = if reading.is_of_several() { age(way.version) } else { 0 };
            self.roads_count += 1;
            self.ways.push(way).map_err(|error| reading.scratch_failed(error))?;
        }
        self.take_located(reading, of_block.located)
    }

    fn take_located(
        &mut self,
        reading: &Reading<'_>,
        located: Vec<(i64, Location)>,
    ) -> Result<(), ReadOsmError> {
        for (node_id, location) in located {
            let located = Located { node_id, order: self.located_count, location };
            self.located_count += 1;
            self.located.push(located).map_err(|error| reading.scratch_failed(error))?;
        }
        Ok(())
    }
}

/// Adds later blobs; fails if they and those before are of more than one point in time.
pub(crate) fn append_versions(
    reading: &Reading<'_>,
    versions: &mut Versions,
    later: Versions,
) -> Result<(), ReadOsmError> {
    versions.append(later);
    versions.history.take().map_or(Ok(()), |History { file, reason }| {
        Err(ReadOsmError::History { path: reading.request.extract(file), reason })
    })
}

/// Fails if what is found takes more than a file of this size can plausibly hold.
pub(crate) fn check_held(reading: &Reading<'_>, held_bytes: u64) -> Result<(), ReadOsmError> {
    let len_bytes = reading.len_bytes;
    if held_bytes > HELD_BYTES.saturating_add(len_bytes.saturating_mul(HELD_BYTES_PER_BYTE)) {
        return Err(ReadOsmError::TooMuch { path: reading.request.path.to_path_buf(), len_bytes });
    }
    Ok(())
}
