//! Pages stay as short as they were made: a page that grows needs another one to shrink.

use std::fs;

use corniche_tidy::{files_below, root};

/// The most words that a page may have.
const MOST_WORDS: [(&str, usize); 3] =
    [("README.md", 700), ("ARCHITECTURE.md", 3000), ("CONTRIBUTING.md", 1100)];
/// The most pages for users in `docs/`; measurements are in `docs/lab/`, decisions in `docs/decisions/`.
const MOST_PAGES: usize = 15;
/// The most words of a decision and its reason; tables do not count.
const MOST_WORDS_OF_A_DECISION: usize = 120;

fn read(page: &str) -> String {
    fs::read_to_string(root().join(page)).unwrap_or_else(|error| panic!("{page}: {error}"))
}

/// The pages of a folder.
fn pages(folder: &str) -> Vec<String> {
    let folder_path = root().join(folder);
    let pages = files_below(&folder_path, "md").unwrap();
    let own = pages.into_iter().filter(|page| page.parent() == Some(&folder_path));
    own.map(|page| format!("{folder}/{}", page.file_name().unwrap().to_string_lossy())).collect()
}

#[test]
fn pages_stay_short() {
    for (page, most) in MOST_WORDS {
        let words = read(page).split_whitespace().count();
        assert!((100..=most).contains(&words), "{page} has {words} words; it may have {most}");
    }
    let rows = read("README.md").lines().filter(|line| line.starts_with("| ")).count();
    // One of them is the head.
    assert!(rows <= 11, "README.md has {rows} rows");
    let pages = pages("docs").len();
    assert!((5..=MOST_PAGES).contains(&pages), "docs/ has {pages} pages; it may have {MOST_PAGES}");
}

#[test]
fn decisions_stay_short() {
    let mut decisions = 0;
    for page in pages("docs/decisions") {
        for decision in read(&page).split("\n## ").skip(1) {
            let (title, text) = decision.split_once('\n').unwrap_or((decision, ""));
            let lines = text.lines().filter(|line| !line.starts_with('|'));
            let words: usize = lines.map(|line| line.split_whitespace().count()).sum();
            assert!(words <= MOST_WORDS_OF_A_DECISION, "{page}, {title}: {words} words");
            decisions += 1;
        }
    }
    assert!(decisions > 100, "only {decisions} decisions were read");
}
