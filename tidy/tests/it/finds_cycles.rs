//! The check for cycles finds existing cycles, and none where there is none.

use std::fs;

use corniche_tidy::{Cycle, Graph, read_crate, uses};

/// The cycles of a crate of these files; cycles between files come first.
fn cycles_of(files: &[(&str, &str)]) -> Vec<Cycle> {
    let folder = tempfile::tempdir().expect("temporary folder");
    for (name, text) in files {
        let path = folder.path().join("src").join(name);
        fs::create_dir_all(path.parent().expect("has a folder")).expect("folder");
        fs::write(path, text).expect("file");
    }
    let read = read_crate(folder.path()).expect("the files are Rust");
    let found = uses(&read);
    let mut cycles = Graph::of_files(&read, &found).cycles();
    cycles.extend(Graph::of_children(&read, &found).iter().flat_map(Graph::cycles));
    cycles
}

/// The nodes of every cycle, without the crate or module.
fn nodes_of(cycles: &[Cycle]) -> Vec<Vec<&str>> {
    cycles.iter().map(|cycle| cycle.nodes.iter().map(String::as_str).collect()).collect()
}

#[test]
fn two_files_that_use_each_other_are_a_cycle() {
    let cycles = cycles_of(&[
        ("lib.rs", "mod a; mod b;"),
        ("a.rs", "use crate::b::B; pub(crate) struct A(B);"),
        (
            "b.rs",
            "pub(crate) struct B; impl B { fn a(&self) -> Option<Box<super::a::A>> { None } }",
        ),
    ]);
    assert_eq!(nodes_of(&cycles), [vec!["a.rs", "b.rs"], vec!["a", "b"]]);
}

#[test]
fn a_re_export_at_the_root_hides_no_cycle() {
    let cycles = cycles_of(&[
        ("lib.rs", "mod a; mod b; pub use a::A; pub use b::*;"),
        ("a.rs", "use crate::B; pub struct A(pub B);"),
        ("b.rs", "pub struct B; pub fn f() { drop(crate::A(B)); }"),
    ]);
    assert_eq!(nodes_of(&cycles), [vec!["a.rs", "b.rs"], vec!["a", "b"]]);
}

#[test]
fn a_child_that_uses_what_its_parent_defines_is_a_cycle() {
    let cycles = cycles_of(&[
        ("lib.rs", "mod a;"),
        ("a.rs", "mod child; pub(crate) struct A; fn f() { child::g(); }"),
        ("a/child.rs", "pub(crate) fn g() { println!(\"{:?}\", size_of::<super::A>()); }"),
    ]);
    assert_eq!(nodes_of(&cycles), [["a.rs", "a/child.rs"]]);
}

#[test]
fn two_folders_that_use_each_other_are_a_cycle_though_no_two_files_are() {
    let cycles = cycles_of(&[
        ("lib.rs", "mod a; mod b;"),
        ("a/mod.rs", "pub(crate) mod high; pub(crate) mod low;"),
        ("a/high.rs", "use crate::b::B; fn f(_: B) {}"),
        ("a/low.rs", "pub(crate) struct Low;"),
        ("b.rs", "use crate::a::low::Low; pub(crate) struct B(Low);"),
    ]);
    assert_eq!(nodes_of(&cycles), [["a", "b"]]);
}

#[test]
fn three_files_in_a_ring_are_one_cycle() {
    let cycles = cycles_of(&[
        ("main.rs", "mod a; mod b; mod c; fn main() {}"),
        ("a.rs", "use crate::b; pub(crate) fn a() { b::b(); }"),
        ("b.rs", "pub(crate) fn b() { crate::c::c(); }"),
        ("c.rs", "pub(crate) fn c() { if false { super::a::a(); } }"),
    ]);
    assert_eq!(nodes_of(&cycles), [vec!["a.rs", "b.rs", "c.rs"], vec!["a", "b", "c"]]);
}

#[test]
fn uses_in_one_direction_and_uses_by_tests_are_no_cycle() {
    let cycles = cycles_of(&[
        ("lib.rs", "mod a; mod b; pub use b::B;"),
        ("a.rs", "pub(crate) struct A; #[cfg(test)] #[path = \"a_tests.rs\"] mod tests;"),
        ("a_tests.rs", "use crate::b::B; use super::A;"),
        ("b.rs", "use crate::a::A; pub struct B(A); #[cfg(test)] fn only_for_tests() {}"),
    ]);
    assert_eq!(cycles, []);
}

#[test]
fn types_that_macros_write_are_seen() {
    let cycles = cycles_of(&[
        ("lib.rs", "mod a; mod b; mod c;"),
        (
            "a.rs",
            "macro_rules! m { ($x:ident) => { pub(crate) enum A { $x } }; } m!(X); fn f(_: crate::b::B) {}",
        ),
        ("b.rs", "crate::c::m2! { pub(crate) struct B; } fn g(_: crate::a::A) {}"),
        ("c.rs", "macro_rules! m2 { ($($t:tt)*) => { $($t)* }; } pub(crate) use m2;"),
    ]);
    assert_eq!(nodes_of(&cycles), [vec!["a.rs", "b.rs"], vec!["a", "b"]]);
}
