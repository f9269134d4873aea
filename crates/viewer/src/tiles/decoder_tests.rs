//! A tile comes from a worker as it was sent.

use corniche_testing::package::{encoded, ids, manifest};

use super::*;

#[test]
fn a_tile_comes_from_a_worker_as_it_was_sent() {
    let manifest = manifest();
    let mut has_ground = false;
    for id in ids() {
        let bytes = encoded(id);
        let tile = TileDecoder::default().tile(Some(&bytes), id, &manifest).expect("it is whole");
        has_ground |= tile.summary.is_some();
        let sent = tile.to_bytes().expect("there is memory");
        let come = TileGeometry::from_bytes(&sent).expect("it is whole");
        assert!(come == tile, "{id}");
        for wrong in [&sent[..sent.len() - 1], &[&sent[..], &[0]].concat(), &[]] {
            assert!(TileGeometry::from_bytes(wrong).is_err(), "{id}: {} bytes", wrong.len());
        }
    }
    assert!(has_ground);
}
