//! A step opens the sealed parts that it can read, and no others.

use super::*;

fn tile(z: u8, x: u32, y: u32) -> TileId {
    TileId::new(z, x, y).unwrap()
}

fn share(number: u16, of: u16) -> Share {
    Share::new(number, of).unwrap()
}

#[test]
fn every_name_is_read_as_it_is_made() {
    for step in PartStep::ALL {
        let (scope, own) = (tile(5, 17, 3), share(2, 7));
        let name = part_name(step, scope, own);
        let read = PartName::parse(&name).unwrap();
        assert_eq!(read.step, step, "{name}");
        if step.has_subtrees() {
            assert_eq!(read.subtree, scope, "{name}");
        }
        if step.has_shares() {
            assert_eq!(read.share, own, "{name}");
        }
        // Its own part is always read, because existing artifacts are not computed again.
        assert!(is_needed(step, scope, own, &name), "{name}");
    }
    // Parts with unknown names may contain anything.
    for name in
        ["", "build", "merge", "heights", "heights-1-9-9", "ways-3-2", "tiles-1-0-0-0", "top-1"]
    {
        assert!(PartName::parse(name).is_none(), "{name}");
        assert!(is_needed(PartStep::Hashes, TileId::ROOT, Share::WHOLE, name), "{name}");
        assert!(is_merged(name) && has_roads(name), "{name}");
    }
}

#[test]
fn a_step_opens_what_it_can_read_and_nothing_else() {
    let needs = |step, name| is_needed(step, tile(3, 2, 2), share(1, 4), name);
    let names = [
        "hashes",
        "ways-1-4",
        "ways-2-4",
        "ways-1-2",
        "nodes-1-4",
        "nodes-2-4",
        "roads",
        "top",
        "heights-3-2-2",
        "heights-3-3-1",
        "heights-3-4-2",
        "heights-1-0-0",
        "heights-1-1-0",
        "heights-2-3-1",
        "heights-5-8-8",
        "heights-5-7-12",
        "heights-5-6-8",
        "tiles-3-2-2",
        "tiles-3-3-2",
        "tiles-4-4-5",
        "tiles-0-0-0",
    ];
    let opened = |step| names.into_iter().filter(|name| needs(step, name)).collect::<Vec<_>>();
    assert_eq!(opened(PartStep::Hashes), ["hashes"]);
    assert_eq!(opened(PartStep::Ways), ["ways-1-4", "roads"]);
    assert_eq!(opened(PartStep::Nodes), ["ways-1-4", "ways-2-4", "nodes-1-4", "roads"]);
    assert_eq!(
        opened(PartStep::Roads),
        ["ways-1-4", "ways-2-4", "ways-1-2", "nodes-1-4", "nodes-2-4", "roads"]
    );
    assert_eq!(opened(PartStep::Heights), ["heights-3-2-2", "heights-1-0-0", "heights-5-8-8"]);
    assert_eq!(opened(PartStep::Top).len(), 10);
    assert_eq!(
        opened(PartStep::Tiles),
        [
            "roads",
            "top",
            "heights-3-2-2",
            "heights-3-3-1",
            "heights-1-0-0",
            "heights-1-1-0",
            "heights-5-8-8",
            "heights-5-7-12",
            "tiles-3-2-2",
            "tiles-4-4-5",
            "tiles-0-0-0",
        ]
    );
    assert_eq!(names.into_iter().filter(|name| !is_merged(name)).count(), 5);
    assert_eq!(names.into_iter().filter(|name| has_roads(name)).collect::<Vec<_>>(), ["roads"]);
}
