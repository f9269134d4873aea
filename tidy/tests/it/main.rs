//! The house rules, in one binary. The first line of each module says what holds.

mod files;
mod finds_cycles;
mod links;
mod module_graph;
mod tests_are_run;
