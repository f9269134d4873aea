//! Pass 1: the road ways of a file, or of some of its blobs, and where nodes are.

use std::io::{Read, Seek};

use corniche_store::Sorter;
use serde::{Deserialize, Serialize};

use crate::{
    Defect, ExtractSummary, ReadOsmError,
    blobs::Decoding,
    block::Block,
    extracts::{Extracts, TOO_MUCH_FOUND},
    id_range::IdRange,
    reading::{Reading, Step},
    records::{Located, WayRecord, age},
    versions::{History, Versions},
    ways::{Counted, Ways, add_summary},
};

/// What may be kept of any file, in memory or in scratch space, …
const HELD_BYTES: u64 = 64 << 20;
/// … and on top of it for each of its bytes.
const HELD_BYTES_PER_BYTE: u64 = 64;

/// What the first pass finds.
pub(crate) struct FoundWays<'a> {
    pub(crate) ways: Sorter<'a, WayRecord>,
    pub(crate) located: Sorter<'a, Located>,
    pub(crate) node_blobs: Vec<NodeBlob>,
    pub(crate) summary: ExtractSummary,
    pub(crate) versions: Versions,
    /// What all this takes, by an estimate that is not too low.
    pub(crate) held_bytes: u64,
}

/// A blob with nodes.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(crate) struct NodeBlob {
    pub(crate) number: usize,
    pub(crate) ids: IdRange,
}

/// Reads the blobs with these numbers. What is wrong with tags goes to `on_defect`, in the order of the file.
pub(crate) fn find_ways<'a, R: Read + Seek>(
    reading: &Reading<'a>,
    file: &mut Extracts<R>,
    numbers: &[usize],
    on_defect: &mut dyn FnMut(Defect),
) -> Result<FoundWays<'a>, ReadOsmError> {
    let (request, shares) = (reading.request, reading.shares());
    let mut found = FoundWays {
        ways: reading.sorter(shares.ways),
        located: reading.sorter(shares.located),
        node_blobs: Vec::new(),
        summary: ExtractSummary::default(),
        versions: Versions::default(),
        held_bytes: 0,
    };
    let (mut roads, mut locations) = (0, 0);
    let data_bytes = file.bytes_of(numbers);
    let (table, is_of_several) = (request.table, reading.is_of_several());
    let counted = if is_of_several { Counted::ByWay } else { Counted::ByBlock };
    let decoding = Decoding {
        pool: request.pool,
        should_stop: reading.should_stop,
        on_bytes: &|bytes| reading.tell(Step::Ways, bytes, data_bytes),
    };
    file.for_each_block(
        numbers,
        &decoding,
        |block, most_bytes| {
            let ways = Ways::scan(&Block::new(&block), table, counted, most_bytes);
            let looked = (Versions::scan(&block), IdRange::scan(&block));
            Ok((looked, ways.ok_or(TOO_MUCH_FOUND)?))
        },
        |[file, number], ((versions_of_block, ids), of_block)| {
            let file = file as u32;
            append_versions(reading, &mut found.versions, versions_of_block.of_file(file))?;
            found.held_bytes += of_block.held_bytes;
            check_held(reading, found.held_bytes)?;
            found.node_blobs.extend(ids.map(|ids| NodeBlob { number, ids }));
            of_block.defects.into_iter().for_each(&mut *on_defect);
            add_summary(&mut found.summary, of_block.summary);
            for mut way in of_block.roads {
                way.order = roads;
                way.file = file;
                way.age = if is_of_several { age(way.version) } else { 0 };
                roads += 1;
                found.ways.push(way).map_err(|error| reading.scratch_failed(error))?;
            }
            for (node_id, location) in of_block.located {
                let located = Located { node_id, order: locations, location };
                locations += 1;
                found.located.push(located).map_err(|error| reading.scratch_failed(error))?;
            }
            Ok(())
        },
    )?;
    Ok(found)
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
