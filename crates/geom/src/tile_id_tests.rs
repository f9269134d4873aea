//! Tile ids are parsed as they are printed, and children know their parent.

use super::*;

#[test]
fn reads_what_it_prints() {
    let id = TileId::new(5, 31, 7).unwrap();
    assert_eq!(id.to_string().parse::<TileId>(), Ok(id));
}

#[test]
fn refuses_text_and_tiles_that_do_not_exist() {
    for text in ["", "1/2", "1/2/3/4", "a/b/c", "1/2/0", "40/0/0"] {
        assert!(text.parse::<TileId>().is_err(), "{text}");
    }
}

#[test]
fn children_know_their_parent() {
    let id = TileId::new(3, 5, 6).unwrap();
    assert_eq!(id.children().count(), 4);
    assert!(id.children().all(|child| child.parent() == Some(id) && child.ancestor(3) == id));
    assert_eq!(TileId::ROOT.parent(), None);
}
