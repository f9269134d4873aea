//! Names with commas and quotes are quoted in CSV.

use super::*;

#[test]
fn names_with_commas_and_quotes_are_quoted() {
    for (name, cell) in [
        ("a b.pmtiles", "a b.pmtiles"),
        ("a,b.pmtiles", "\"a,b.pmtiles\""),
        ("a\"b.pmtiles", "\"a\"\"b.pmtiles\""),
    ] {
        assert_eq!(quoted(name), cell);
        let manifest = corniche_testing::package::manifest();
        let text = to_csv_of_several([(name, &manifest)]);
        let mut lines = text.lines();
        assert!(lines.next().is_some_and(|headings| headings.starts_with("package,level,class,")));
        assert!(lines.all(|line| line.starts_with(&format!("{cell},"))), "{text}");
    }
}
