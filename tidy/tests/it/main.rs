//! The house rules, in one binary. The first line of each module states its rule.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

mod budget;
mod comments;
mod files;
mod finds_cycles;
mod invariants;
mod links;
mod module_graph;
mod names;
mod page;
mod pages;
mod tests_are_run;
