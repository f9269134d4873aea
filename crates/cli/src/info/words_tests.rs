//! All words of `info` that need an explanation have one, and no other words do.

use super::*;

/// Words that everybody knows, or that explain themselves.
const PLAIN: [&str; 15] = [
    "m",
    "tiles",
    "triangles",
    "B/triangle",
    "max",
    "stored/true",
    "covered",
    "count",
    "length",
    "bytes",
    "per",
    "tile",
    "points",
    "roads",
    "km",
];

#[test]
fn each_heading_of_a_table_is_explained() {
    let mut manifest = corniche_testing::package::manifest();
    manifest.counts.roads_in = 3;
    let text = super::super::to_text(&manifest, 1, crate::table::Digits::Plain);
    let (tables, words) = text.split_once("\nWords:\n").unwrap();
    let explained: Vec<&str> =
        words.lines().filter_map(|line| line.trim_start().split("  ").next()).collect();
    let mut headings = 0;
    for line in tables.lines().filter(|line| line.starts_with("level  ")) {
        headings += 1;
        for heading in line.split("  ").map(str::trim).filter(|heading| !heading.is_empty()) {
            let is_known = |word: &str| explained.contains(&word) || PLAIN.contains(&word);
            assert!(
                explained.contains(&heading) || heading.split(' ').all(is_known),
                "{heading} is not explained:\n{text}"
            );
        }
    }
    assert!(headings >= 3, "{text}");
}

#[test]
fn only_words_that_are_used_are_explained() {
    let words = words_of("level  cell m\nAn error of RMS 3");
    let explained: Vec<&str> = words.lines().filter(|line| line.starts_with("  ")).collect();
    assert_eq!(explained.len(), 4, "{words}");
    assert!(!uses("terrorism", "error") && uses("(error)", "error") && !uses("", "error"));
    assert!(words.ends_with("docs/conventions.md#terms\n"), "{words}");
}

#[test]
fn reasons_to_look_at_bridges_are_explained() {
    for (reason, meaning) in corniche_spec::span_reasons() {
        let words = words_of(&format!("2 of them: {reason} 3"));
        assert!(words.contains(reason) && words.contains(meaning), "{words}");
    }
}
