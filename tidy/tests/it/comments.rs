//! Doc comments of products begin as sentences that stand alone, and not as halves of one.

use std::{
    fs,
    path::{Path, PathBuf},
};

use corniche_tidy::{files_below, root};

/// With these words begins what only makes sense beside the name of the item: "Of its frame." Say what it is of.
const HALVES: [&str; 7] = ["As", "By", "Of", "That", "Their", "Those", "To"];

/// Each of these was a whole comment once.
const SINGLE: [&str; 11] = [
    "All.", "Done.", "Heights.", "How.", "It.", "None.", "Nothing.", "Stored.", "Where.", "Why.",
    "Written.",
];

/// Doc comments that become help and schemas, which people read beside the option or field.
const TOLD_TO_USERS: [&str; 5] = [
    "crates/cli/src/args",
    "crates/cli/src/documents",
    "crates/presets/src/build_options.rs",
    "crates/presets/src/files.rs",
    "crates/settings/src/table.rs",
];

/// Files of products, without their tests and without what is told to users.
fn product_files() -> Vec<PathBuf> {
    let is_product = |file: &PathBuf| {
        let name = file.strip_prefix(root()).unwrap().to_string_lossy().replace('\\', "/");
        let (_, inside) = name.split_once("/src/").unwrap_or_default();
        !inside.is_empty()
            && !inside.contains("_tests")
            && !name.starts_with("crates/testing/")
            && !TOLD_TO_USERS.iter().any(|told| name.starts_with(told))
    };
    let mut files = files_below(&root().join("crates"), "rs").unwrap();
    files.retain(is_product);
    assert!(files.len() > 400, "only {} files were found", files.len());
    files
}

/// The first line of each doc comment of items, with the number of the line.
fn beginnings(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut is_inside = false;
    text.lines().enumerate().filter_map(move |(index, line)| {
        let comment = line.trim_start().strip_prefix("///");
        let was_inside = std::mem::replace(&mut is_inside, comment.is_some());
        comment.filter(|_| !was_inside).map(|comment| (index + 1, comment.trim()))
    })
}

/// What is wrong with a beginning of a doc comment.
fn half_of(beginning: &str) -> Option<&str> {
    let first = beginning.split(' ').next().unwrap_or_default();
    (HALVES.contains(&first) || SINGLE.contains(&beginning)).then_some(first)
}

fn told(file: &Path, line: usize, beginning: &str) -> String {
    format!("{}:{line}: {beginning:?}", file.display())
}

#[test]
fn doc_comments_stand_alone() {
    let mut halves = Vec::new();
    for file in product_files() {
        let text = fs::read_to_string(&file).unwrap();
        let found = beginnings(&text).filter(|(_, beginning)| half_of(beginning).is_some());
        halves.extend(found.map(|(line, beginning)| told(&file, line, beginning)));
    }
    assert!(halves.is_empty(), "comments begin as halves of sentences:\n{}", halves.join("\n"));
}

#[test]
fn halves_are_seen() {
    for half in ["Of its frame.", "As it was given.", "Why.", "Those of a tile.", "To draw."] {
        assert!(half_of(half).is_some(), "{half}");
    }
    for whole in ["Often there is none.", "The tile's frame.", "Whyever it failed.", "All tiles."] {
        assert!(half_of(whole).is_none(), "{whole}");
    }
    let text = "/// First\n/// Of it.\nfn f() {}\n    /// Of it.\n    fn g() {}\n";
    assert_eq!(beginnings(text).collect::<Vec<_>>(), [(1, "First"), (4, "Of it.")]);
}
