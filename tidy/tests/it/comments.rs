//! Doc comments of products begin as whole sentences, not as halves of sentences.

use std::{
    fs,
    path::{Path, PathBuf},
};

use corniche_tidy::{files_below, root};

/// Words at the beginning of comments that only make sense together with the item's name, as in "Of
/// its frame." Write what the item is.
const HALVES: [&str; 7] = ["As", "By", "Of", "That", "Their", "Those", "To"];

/// Each of these words was once a whole comment.
const SINGLE: [&str; 11] = [
    "All.", "Done.", "Heights.", "How.", "It.", "None.", "Nothing.", "Stored.", "Where.", "Why.",
    "Written.",
];

/// Files with doc comments that become help and schemas, which people read next to the option or
/// field.
const TOLD_TO_USERS: [&str; 5] = [
    "crates/cli/src/args",
    "crates/cli/src/documents",
    "crates/presets/src/build_options.rs",
    "crates/presets/src/files.rs",
    "crates/settings/src/table.rs",
];

/// Files of products, without their tests and without the files of help and schemas.
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

/// Returns the forbidden beginning of a doc comment, if it has one.
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
    assert!(
        halves.is_empty(),
        "these comments do not begin as whole sentences:\n{}",
        halves.join("\n")
    );
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

/// How wide comments may be, in characters: as wide as the code.
const MOST_COLUMNS: usize = 100;

/// The comments of a file that are wider than the code: neither drawings nor tables nor lines with
/// a link.
fn wide_comments(text: &str) -> Vec<usize> {
    let mut is_drawing = false;
    let mut wide = Vec::new();
    for (number, line) in (1..).zip(text.lines()) {
        let Some(comment) = line.trim_start().strip_prefix("//") else {
            is_drawing = false;
            continue;
        };
        let comment = comment.trim_start_matches(['/', '!']);
        is_drawing ^= comment.trim_start().starts_with("```");
        let is_kept = is_drawing
            || comment.starts_with("     ")
            || comment.trim_start().starts_with(['|', '`'])
            || comment.contains("](")
            || comment.contains("://");
        if !is_kept && line.chars().count() > MOST_COLUMNS {
            wide.push(number);
        }
    }
    wide
}

#[test]
fn comments_are_as_wide_as_code() {
    let mut wide = Vec::new();
    let mut files = 0;
    for folder in ["crates", "tests", "tidy", "fuzz", "config"] {
        for language in ["rs", "wgsl", "js", "mjs"] {
            for file in files_below(&root().join(folder), language).unwrap() {
                // The page in the program is made.
                if file.starts_with(root().join("crates/cli/page")) {
                    continue;
                }
                files += 1;
                let text = fs::read_to_string(&file).unwrap();
                let lines = wide_comments(&text);
                wide.extend(lines.iter().map(|line| format!("{}:{line}", file.display())));
            }
        }
    }
    assert!(files > 1000, "only {files} files were read");
    assert!(wide.is_empty(), "comments wrap at {MOST_COLUMNS} columns:\n{}", wide.join("\n"));
}

#[test]
fn wide_comments_are_seen() {
    let words = "word ".repeat(20);
    let text =
        format!("/// {words}\n// short\n/// ```text\n/// {words}\n/// ```\n//! | {words}|\n");
    assert_eq!(wide_comments(&text), [1]);
}
