//! The house rules that no compiler checks: which module uses which, and how large crates, files
//! and functions are.
//!
//! ```text
//!  crates/*/src ──► source: modules, what they define and import, every path in them
//!                      │
//!                      ├──► uses: which file uses which, through re-exports ──► graph: cycles, ranks
//!                      ├──► names: types, functions, parameters
//!                      └──► figures: lines, functions, public items ──► budget: bytes by crate
//! ```
//!
//! `cargo run -p corniche-tidy` prints the modules of every crate; `tests/` contains the rules.
//!
//! Only paths are analysed. A method called on a value whose type is never named gives no edge, and
//! neither does code that a macro generates, except for the names of types in the macro's text.
//! Test code is excluded: a test may use whatever it tests.
//!
//! This package never changes a file, and no product crate depends on it.

mod budget;
mod figures;
mod files;
mod graph;
mod names;
mod page;
mod source;
mod uses;

pub use budget::{BUDGET, Bytes, over_budget, product_bytes, read_budget, sunk};
pub use figures::{CrateFigures, Function, figures};
pub use files::{files_below, root};
pub use graph::{Cycle, Graph};
pub use names::{Declaration, Declarations, declarations};
pub use page::{PAGE, page_sources};
pub use source::{Crate, Module, attributes_of, crates_of, is_test, read_crate};
pub use uses::{Use, uses};
