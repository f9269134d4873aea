//! Product code stays within its budget, which sinks with it.

use std::fs;

use corniche_tidy::{BUDGET, over_budget, product_bytes, read_budget, root};

#[test]
fn product_code_keeps_to_its_budget() {
    let budget = read_budget(&fs::read_to_string(root().join(BUDGET)).unwrap()).unwrap();
    let found = product_bytes(&root()).unwrap();
    assert!(found.values().sum::<u64>() > 1_000_000, "the count finds too little code: {found:?}");
    let wrong = over_budget(&budget, &found);
    assert!(
        wrong.is_empty(),
        "{}\n`cargo run -p corniche-tidy budget --sink` lowers rows; to raise a row, name the feature and \
         the number of bytes in the commit",
        wrong.join("\n")
    );
}
