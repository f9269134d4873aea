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

#[test]
fn tiles_beside_each_other_touch_on_the_level_of_the_larger() {
    let id = |text: &str| text.parse::<TileId>().unwrap();
    for (a, b, expected) in [
        ("3/4/4", "3/4/4", true),
        ("3/4/4", "3/5/5", true),
        ("3/4/4", "3/4/6", false),
        ("3/4/4", "0/0/0", true),
        // 5/22/16 lies in 3/5/4, and 5/24/16 in 3/6/4.
        ("3/4/4", "5/22/16", true),
        ("3/4/4", "5/24/16", false),
    ] {
        assert_eq!(id(a).is_beside(id(b)), expected, "{a} {b}");
        assert_eq!(id(b).is_beside(id(a)), expected, "{b} {a}");
    }
}
