//! A tile that is loaded without threads comes in a later frame, and nothing waits for it.

use corniche_testing::package;

use super::*;

#[test]
fn a_tile_comes_in_a_later_frame_and_nothing_waits_for_it() {
    let mut loader = PolledLoader::new(&late_package(package::written()));
    loader.request(&[TileId::ROOT]);
    for _ in 0..POLLS {
        assert!(loader.arrivals().is_empty());
    }
    assert_eq!(loader.arrivals().len(), 1);
    loader.request(&[TileId::ROOT]);
    loader.forget();
    assert!(loader.arrivals().is_empty() && loader.under_way.is_empty());
}
