//! An error of the window system is reported without positions in source code.

use super::*;

#[test]
fn an_error_of_the_system_is_told_without_where_in_the_source_it_came_up() {
    let told = "os error at /x/winit/src/mod.rs:788: Failed to open connection: no";
    assert_eq!(without_source_place(told), "Failed to open connection: no");
    assert_eq!(without_source_place("neither is set"), "neither is set");
}
