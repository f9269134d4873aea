//! Which lines count as product code, and what a budget allows.

use super::*;

#[test]
fn comments_tests_and_indentation_do_not_count() {
    let rust = "//! Docs.\n\n/* a\n b */\nfn a() {\n    b(); // why\n}\n#[cfg(test)]\nmod t {}\n";
    let parsed = syn::parse_file(rust).unwrap();
    assert_eq!(test_lines(&parsed), [[8, 9]]);
    assert_eq!(code_bytes(rust, "//", &test_lines(&parsed)), 9 + 12 + 2);
    let python = "\"\"\"One line.\"\"\"\n\"\"\"Two\nlines.\"\"\"\n# why\n    x = 1\n";
    assert_eq!(code_bytes(python, "#", &[]), 6);
}

#[test]
fn a_budget_only_sinks() {
    let budget = read_budget("# about\na = 1_000\n\"b\" = 500\ngone = 1\n").unwrap();
    let found = Bytes::from([("a".into(), 900), ("b".into(), 501), ("new".into(), 3)]);
    let wrong = over_budget(&budget, &found);
    assert_eq!(wrong.len(), 4, "{wrong:?}");
    let text = sunk(&budget, &found).unwrap();
    assert_eq!(read_budget(&text).unwrap(), Bytes::from([("a".into(), 900), ("b".into(), 500)]));
}
