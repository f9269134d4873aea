//! Product code keeps to its budget, which sinks with it.

use std::fs;

use corniche_tidy::{BUDGET, over_budget, product_bytes, read_budget, root};

#[test]
fn product_code_keeps_to_its_budget() {
    let budget = read_budget(&fs::read_to_string(root().join(BUDGET)).unwrap()).unwrap();
    let found = product_bytes(&root()).unwrap();
    assert!(found.values().sum::<u64>() > 1_000_000, "the count does not see much: {found:?}");
    let wrong = over_budget(&budget, &found);
    assert!(
        wrong.is_empty(),
        "{}\n`cargo run -p corniche-tidy budget --sink` lowers rows; to raise one, say in the commit for which feature, \
         and by how much",
        wrong.join("\n")
    );
}
