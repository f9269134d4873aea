use super::*;

fn needed(step: &str, scope: &str, parts: &[&str]) -> Vec<bool> {
    let scope = scope.parse().unwrap();
    parts.iter().map(|part| is_needed(step, scope, part)).collect()
}

#[test]
fn tiles_read_the_heights_around_their_subtree_and_no_tiles_of_others() {
    let near =
        ["heights-2-1-1", "heights-2-2-2", "heights-2-0-0", "heights-1-0-0", "heights-0-0-0"];
    assert_eq!(needed("tiles", "2/1/1", &near), [true; 5]);
    // Of a subtree beneath, what holds it on this level counts; beside a large subtree all are near.
    assert_eq!(needed("tiles", "2/1/1", &["heights-4-11-4", "heights-4-12-4"]), [true, false]);
    assert_eq!(needed("tiles", "2/1/1", &["heights-1-1-1"]), [true]);
    assert_eq!(needed("tiles", "2/0/0", &["heights-2-2-0", "heights-2-0-3"]), [false; 2]);
    let others = ["roads", "top", "tiles-2-1-1", "tiles-3-2-3", "tiles-1-0-0"];
    assert_eq!(needed("tiles", "2/1/1", &others), [true; 5]);
    let not = ["hashes", "ways-1-4", "nodes-1-4", "tiles-2-1-2", "tiles-3-4-3"];
    assert_eq!(needed("tiles", "2/1/1", &not), [false; 5]);
}

#[test]
fn other_steps_read_what_they_are_made_from() {
    let all = [
        "hashes",
        "ways-2-4",
        "nodes-1-4",
        "roads",
        "heights-1-0-0",
        "heights-1-1-0",
        "top",
        "tiles-1-0-0",
    ];
    for (step, scope, expected) in [
        ("hashes", "0/0/0", [1, 0, 0, 0, 0, 0, 0, 0]),
        ("ways", "0/0/0", [0, 1, 1, 1, 0, 0, 0, 0]),
        ("nodes", "0/0/0", [0, 1, 1, 1, 0, 0, 0, 0]),
        ("roads", "0/0/0", [0, 1, 1, 1, 0, 0, 0, 0]),
        ("heights", "1/0/0", [0, 0, 0, 0, 1, 0, 0, 0]),
        ("heights", "0/0/0", [0, 0, 0, 0, 1, 1, 0, 0]),
        ("top", "0/0/0", [0, 0, 0, 0, 1, 1, 1, 0]),
        ("merge", "0/0/0", [1; 8]),
    ] {
        assert_eq!(needed(step, scope, &all), expected.map(|is| is == 1), "{step} {scope}");
    }
}

/// What is not understood is read: a part of a later version, or a name that is no tile's.
#[test]
fn parts_with_other_names_are_read_by_all_steps() {
    for part in ["build", "areas-1-0-0"] {
        for step in ["hashes", "roads", "heights", "top", "tiles"] {
            assert!(is_needed(step, "1/0/0".parse().unwrap(), part), "{step} {part}");
        }
    }
    let odd = ["heights-1-5-0", "heights-1-0", "heights-a-b-c", "heights-40-0-0"];
    assert_eq!(needed("tiles", "1/0/0", &odd), [true; 4]);
}
