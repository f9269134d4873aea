//! The lengths of roads are read back block by block.

use corniche_spec::artifacts::ArtifactError;
use corniche_store::MemoryStore;

use super::*;

#[test]
fn lengths_come_back_block_by_block() {
    let store = MemoryStore::default();
    let length = |k: u64| RoadLength {
        way_id: -(k as i64),
        structure: Structure::ALL[k as usize % 3],
        length_um: 3 * k,
        outside_um: k,
        padding_um: k / 3,
        beyond_um: k / 2,
    };
    let mut writer = lengths_writer(&store);
    let count = BLOCK_ROADS + 1;
    for k in 0..count {
        writer.push(length(k)).unwrap();
    }
    writer.finish().unwrap();
    assert_eq!(store.items(ArtifactKind::RoadLengths as u8), [0, 1]);
    let first = lengths_of_block(&store, 0, BLOCK_ROADS).unwrap();
    assert_eq!((first[0], first[BLOCK_ROADS as usize - 1]), (length(0), length(BLOCK_ROADS - 1)));
    assert_eq!(lengths_of_block(&store, 1, 1).unwrap(), [length(BLOCK_ROADS)]);
    for (block, roads) in [(0, 1), (1, 2), (2, 1)] {
        let error = lengths_of_block(&store, block, roads).unwrap_err();
        assert!(matches!(error, ExtractError::Artifact(ArtifactError::Damaged { .. })), "{error}");
    }
}

#[test]
fn a_whole_number_of_blocks_has_no_empty_one() {
    let store = MemoryStore::default();
    lengths_writer(&store).finish().unwrap();
    assert!(store.items(ArtifactKind::RoadLengths as u8).is_empty());
}
