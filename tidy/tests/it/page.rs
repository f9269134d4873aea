//! The page in the program is made from the sources that are here.

use std::fs;

use corniche_tidy::{PAGE, page_sources, root};

#[test]
fn the_page_in_the_program_is_made_from_these_sources() {
    let text = fs::read_to_string(root().join(PAGE)).unwrap();
    let known: toml::Table = text.parse().unwrap();
    assert_eq!(
        known["sources"].as_str().unwrap(),
        page_sources(&root()).unwrap(),
        "what the page is made from changed since it was made: run `scripts/web --update`"
    );
    // A hash of nothing would be the same for ever.
    let other = tempfile::tempdir().unwrap();
    page_sources(other.path()).unwrap_err();
}
