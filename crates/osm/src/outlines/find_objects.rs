//! Finds the objects in blobs that are read before the ways: relations, and also nodes and ways if
//! the extract is not sorted.

use std::io::{Read, Seek};

use super::{
    found::Outlines,
    judge::{OfBlock, OutlineJudge},
};
use crate::{
    blobs::decode,
    block::AuditedBlock,
    extracts::{Extracts, TOO_MUCH_FOUND},
    failed::Failed,
    looked::{BlockSurvey, LookedAt},
    outlines::found_nodes::FoundNodes,
    reading::{ExtractReading, ReadingStep},
};

/// Reads the blobs with these numbers, and returns the facts of the blobs. With `with_ways`, ways
/// that are objects by their own tags are included. `later_bytes` is the size of the blobs with
/// ways that are read afterwards, for progress reports.
pub(crate) fn find_objects<R: Read + Seek>(
    reading: &ExtractReading<'_>,
    file: &mut Extracts<R>,
    numbers: &[usize],
    (outlines, nodes): (&mut [Outlines<'_>], &mut FoundNodes<'_>),
    with_ways: bool,
    later_bytes: u64,
) -> Result<LookedAt, Failed> {
    let mut looked_at = LookedAt::default();
    let all_bytes = file.bytes_of(numbers) + later_bytes;
    let on_bytes = &|bytes| reading.tell(ReadingStep::Ways, bytes, all_bytes);
    let wanted: Vec<_> = outlines.iter().map(|outlines| outlines.wanted).collect();
    let of_nodes = nodes.scanned();
    let scan = |message: Vec<u8>, most_bytes| {
        let block = AuditedBlock::new(&message);
        let texts = block.texts();
        let judges: Vec<OutlineJudge<'_>> =
            wanted.iter().map(|&wanted| OutlineJudge::new(&texts, wanted)).collect();
        let mut found: Vec<OfBlock> = judges.iter().map(|_| OfBlock::default()).collect();
        let looked = BlockSurvey::scan(&block);
        if with_ways {
            for way in block.ways() {
                for (found, judge) in found.iter_mut().zip(&judges) {
                    found.look_at_object(&way, judge);
                }
            }
        }
        if looked.has_relations {
            let decoded = decode(&message)?;
            for (found, judge) in found.iter_mut().zip(&judges) {
                found.look_at_relations(&decoded, judge);
            }
        }
        let of_nodes = of_nodes.scan(&block, most_bytes)?;
        let held_bytes: u64 = found.iter().chain(&of_nodes).map(|found| found.held_bytes).sum();
        if held_bytes > most_bytes {
            return Err(TOO_MUCH_FOUND.into());
        }
        Ok((looked, found, of_nodes))
    };
    file.for_each_block(reading, numbers, on_bytes, scan, |[file, number], of_block| {
        let (looked, found, of_nodes) = of_block;
        looked_at.take(reading, [file, number], looked)?;
        nodes.take(reading, file as u32, of_nodes)?;
        for (outlines, of_block) in outlines.iter_mut().zip(found) {
            outlines.take(reading, file as u32, of_block, true)?;
        }
        Ok(())
    })?;
    Ok(looked_at)
}
