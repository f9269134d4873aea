//! The random content of a simulated disk after a loss of power, within the behaviour of real
//! disks.

use super::state::{ContentChange, DiskContent, DiskNode, State};
use crate::Random;

/// Devices write at least this many bytes as a whole.
const SECTOR_BYTES: usize = 512;

/// Returns the content after a loss of power: everything that was synced; each later change of a
/// name or of content with even odds, whatever happened to the earlier ones; and one in four of the
/// writes among them is torn.
pub(crate) fn crashed(state: &State, random: &mut Random) -> State {
    let mut names = state.durable_names.clone();
    for change in &state.changes {
        if random.below(2) == 0 {
            change.apply(&mut names);
        }
    }
    // A name in a folder that was lost is lost, too.
    let folders: Vec<_> = names
        .iter()
        .filter(|(_, node)| **node == DiskNode::Folder)
        .map(|(path, _)| path.clone())
        .collect();
    names.retain(|path, _| {
        path.ancestors().skip(1).all(|folder| folders.iter().any(|known| known == folder))
    });
    let files = state.files.iter().map(|file| crashed_content(file, random)).collect();
    State { durable_names: names.clone(), names, files, ..State::default() }
}

fn crashed_content(file: &DiskContent, random: &mut Random) -> DiskContent {
    let mut bytes = file.durable.clone();
    for change in &file.changes {
        if random.below(2) == 0 {
            continue;
        }
        match change {
            ContentChange::Write { offset, bytes: written } if random.below(4) == 0 => {
                torn(*offset, written, random).apply(&mut bytes);
            }
            change => change.apply(&mut bytes),
        }
    }
    DiskContent::from_bytes(bytes)
}

/// Returns the first part of a write, or all of it with garbage in one sector.
fn torn(offset: usize, written: &[u8], random: &mut Random) -> ContentChange {
    let mut bytes = written.to_vec();
    let at = random.below(bytes.len().max(1) as i64) as usize;
    if random.below(2) == 0 {
        bytes.truncate(at);
    } else {
        let from = at / SECTOR_BYTES * SECTOR_BYTES;
        let to = bytes.len().min(from + SECTOR_BYTES);
        bytes[from..to].fill_with(|| random.bits() as u8);
    }
    ContentChange::Write { offset, bytes }
}
