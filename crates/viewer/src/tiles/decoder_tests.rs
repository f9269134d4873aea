//! A tile from a worker equals the tile that was sent.

use corniche_testing::package::{encoded, ids, manifest};

use super::*;

#[test]
fn a_tile_comes_from_a_worker_as_it_was_sent() {
    let manifest = manifest();
    let mut has_ground = false;
    for id in ids() {
        let bytes = encoded(id);
        let tile =
            TileDecoder::default().tile(Some(&bytes), id, &manifest).expect("the tile is valid");
        has_ground |= tile.summary.is_some();
        let sent = tile.to_bytes().expect("memory is sufficient");
        let come = TileGeometry::from_bytes(&sent).expect("the bytes are complete");
        assert!(come == tile, "{id}");
        for wrong in [&sent[..sent.len() - 1], &[&sent[..], &[0]].concat(), &[]] {
            assert!(TileGeometry::from_bytes(wrong).is_err(), "{id}: {} bytes", wrong.len());
        }
    }
    assert!(has_ground);
}
