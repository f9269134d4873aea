//! What a simulated disk holds after a loss of power, by chance within what real disks may do.

use super::state::{Content, ContentChange, Node, State};
use crate::Random;

/// Devices write at least so many bytes as a whole.
const SECTOR_BYTES: usize = 512;

/// What a loss of power leaves: all that was synced; each change of a name or of content since with even odds, whatever became of those before;
/// and of the writes among them one in four torn.
pub(crate) fn crashed(state: &State, random: &mut Random) -> State {
    let mut names = state.durable_names.clone();
    for change in &state.changes {
        if random.below(2) == 0 {
            change.apply(&mut names);
        }
    }
    // A name within a folder that was lost is lost with it.
    let folders: Vec<_> = names
        .iter()
        .filter(|(_, node)| **node == Node::Folder)
        .map(|(path, _)| path.clone())
        .collect();
    names.retain(|path, _| {
        path.ancestors().skip(1).all(|folder| folders.iter().any(|known| known == folder))
    });
    let files = state.files.iter().map(|file| crashed_content(file, random)).collect();
    State { durable_names: names.clone(), names, files, ..State::default() }
}

fn crashed_content(file: &Content, random: &mut Random) -> Content {
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
    Content::of(bytes)
}

/// The first part of a write, or all of it with garbage in one sector.
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
