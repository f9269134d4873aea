use super::*;

#[test]
fn an_error_of_the_system_is_told_without_where_in_the_source_it_came_up() {
    let told = "os error at /x/winit/src/mod.rs:788: Failed to open connection: no";
    assert_eq!(without_source_place(told), "Failed to open connection: no");
    assert_eq!(without_source_place("neither is set"), "neither is set");
}

#[test]
fn a_device_may_be_lost_now_and_then_but_not_twice_in_a_row() {
    assert!(!is_soon_after(None, 3.0), "the first time");
    assert!(is_soon_after(Some(3.0), 4.0));
    assert!(!is_soon_after(Some(3.0), 3.0 + 2.0 * SOON_S));
}
