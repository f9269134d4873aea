//! No two served packages have the same name.

use std::path::PathBuf;

use super::{Shown, list, names};

fn named(files: &[&str]) -> Vec<String> {
    names(&files.iter().map(PathBuf::from).collect::<Vec<_>>())
}

#[test]
fn no_two_packages_have_one_name() {
    assert_eq!(named(&["a/pass.pmtiles", "b/city.PMTILES", "c"]), ["pass", "city", "c"]);
    assert_eq!(named(&["a/pass.pmtiles", "b/pass.pmtiles", "pass"]), ["pass", "pass-2", "pass-3"]);
    assert_eq!(named(&["a/Pass.pmtiles", "b/pass.pmtiles"]), ["Pass", "pass-2"]);
    // A package whose own name ends in a number keeps its name.
    assert_eq!(named(&["a/x.pmtiles", "b/x.pmtiles", "x-2.pmtiles"]), ["x", "x-3", "x-2"]);
}

#[test]
fn the_list_has_names_for_people_and_addresses_for_programs() {
    let shown = [("Zürich 50 %", None), ("a#b?c&d", Some("none"))].map(|(name, layers)| Shown {
        name: name.to_owned(),
        file: PathBuf::new(),
        layers: layers.map(str::to_owned),
    });
    let expected = r#"[{"name":"Zürich 50 %","src":"packages/Z%C3%BCrich%2050%20%25.pmtiles"},{"name":"a#b?c&d","src":"packages/a%23b%3Fc%26d.pmtiles","layers":"none"}]"#;
    assert_eq!(list(&shown), format!("{expected}\n"));
    assert_eq!(shown[0].path(), "packages/Zürich 50 %.pmtiles");
}
