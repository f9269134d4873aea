//! Pages stay short: a newcomer reads the first one to its end, and there are few manual pages.

use std::{fs, ops::RangeInclusive, path::Path};

use corniche_tidy::{files_below, root};

/// The number of words that a page may have: enough to state its purpose, few enough to be read.
const WORDS: [(&str, RangeInclusive<usize>); 3] =
    [("README.md", 700..=900), ("ARCHITECTURE.md", 2000..=3000), ("CONTRIBUTING.md", 100..=1500)];
/// The largest number of table rows in the first page, including the header.
const MOST_ROWS: usize = 11;
/// The largest number of pages for users in `docs/`; measurements are in `docs/lab/`, decisions in
/// `docs/decisions/`.
const MOST_PAGES: usize = 15;
/// The largest number of words of all pages together, without those that a command writes.
const MOST_WORDS_TOGETHER: usize = 95_000;
/// The largest number of words of all pages of measurements together; their tables are CSV files.
const MOST_WORDS_OF_MEASUREMENTS: usize = 20_000;
/// A page that a command writes from the declarations of options.
const GENERATED: &str = "docs/options.md";
/// The largest number of words of a decision and its reason; tables do not count.
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
    for (page, range) in WORDS {
        let words = read(page).split_whitespace().count();
        assert!(range.contains(&words), "{page} has {words} words; it may have {range:?}");
    }
    let rows = read("README.md").lines().filter(|line| line.starts_with("| ")).count();
    assert!(rows <= MOST_ROWS, "README.md has {rows} rows; it may have {MOST_ROWS}");
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

#[test]
fn pages_together_stay_short() {
    let [mut all, mut measurements] = [0; 2];
    for page in files_below(&root(), "md").unwrap() {
        let name = page.strip_prefix(root()).unwrap();
        if name == Path::new(GENERATED) {
            continue;
        }
        let words = fs::read_to_string(&page).unwrap().split_whitespace().count();
        all += words;
        measurements += if name.starts_with("docs/lab") { words } else { 0 };
    }
    assert!((50_000..=MOST_WORDS_TOGETHER).contains(&all), "all pages have {all} words");
    let most = MOST_WORDS_OF_MEASUREMENTS;
    assert!((5_000..=most).contains(&measurements), "docs/lab has {measurements} words");
}
