//! `docs/promises.md` lists all checks, and the fields that none of them tests.

use std::fs;

use corniche_verify::CheckId;

fn document() -> String {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/promises.md");
    fs::read_to_string(path).expect("docs/promises.md")
}

/// The table of the document is the registry, row by row.
#[test]
fn the_document_lists_every_check_and_no_other() {
    let text = document();
    let rows: Vec<&str> = text.lines().filter(|line| line.starts_with("| `")).collect();
    let of_checks = rows.iter().filter(|row| row.matches(" | ").count() == 2);
    let expected: Vec<String> = CheckId::ALL
        .iter()
        .map(|check| {
            format!("| `{}` | {} | {} |", check.id(), check.needs().text(), check.promise())
        })
        .collect();
    assert_eq!(
        of_checks.copied().collect::<Vec<_>>(),
        expected,
        "write these rows:\n{}",
        expected.join("\n")
    );
}
