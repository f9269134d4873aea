//! The page in the program was generated from the current sources.

use std::fs;

use corniche_tidy::{PAGE, page_sources, root};

#[test]
fn the_page_in_the_program_is_made_from_these_sources() {
    let text = fs::read_to_string(root().join(PAGE)).unwrap();
    let known: toml::Table = text.parse().unwrap();
    assert_eq!(
        known["sources"].as_str().unwrap(),
        page_sources(&root()).unwrap(),
        "the sources of the page have changed since it was generated; run `scripts/web --update`"
    );
    // The hash of nothing would never change.
    let other = tempfile::tempdir().unwrap();
    page_sources(other.path()).unwrap_err();
}
