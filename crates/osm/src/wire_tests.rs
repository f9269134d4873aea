//! Fields of protocol buffers are distinguished, and invalid fields are rejected.

use super::*;

#[track_caller]
fn check(message: &[u8], expected: Result<&[WireField<'_>], WireError>) {
    let found: Result<Vec<_>, _> = fields(message).collect();
    assert_eq!(found.as_deref().map_err(|error| *error), expected);
}

#[test]
fn fields_are_told_apart_and_what_is_no_field_is_refused() {
    let field = |number, value| WireField { number, value };
    check(b"", Ok(&[]));
    // These are the examples of the documentation: a = 150, b = "testing".
    check(b"\x08\x96\x01", Ok(&[field(1, WireValue::Varint(150))]));
    check(b"\x12\x07testing", Ok(&[field(2, WireValue::Bytes(b"testing"))]));
    check(b"\x0d....\x11........", Ok(&[field(1, WireValue::Fixed), field(2, WireValue::Fixed)]));
    let largest = b"\x08\xff\xff\xff\xff\xff\xff\xff\xff\xff\x01";
    check(largest, Ok(&[field(1, WireValue::Varint(u64::MAX))]));
    check(
        b"\x08\xff\xff\xff\xff\xff\xff\xff\xff\xff\x02",
        Err("a number does not fit into 64 bits"),
    );
    check(
        b"\x08\x80\x80\x80\x80\x80\x80\x80\x80\x80\x80\x01",
        Err("a number does not fit into 64 bits"),
    );
    check(b"\x08\x80", Err("a number is truncated"));
    check(b"\x12\x08testing", Err("a field extends beyond its message"));
    check(b"\x0d...", Err("a field extends beyond its message"));
    check(
        b"\x12\xff\xff\xff\xff\xff\xff\xff\xff\xff\x01",
        Err("a field extends beyond its message"),
    );
    check(b"\x0b", Err("a field has an unknown wire type"));
    check(b"\x00\x00", Err("a field has the number 0"));
}
