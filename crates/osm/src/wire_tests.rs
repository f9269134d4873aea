//! Fields of protocol buffers are told apart, and what is no field is refused.

use super::*;

#[track_caller]
fn check(message: &[u8], expected: Result<&[Field<'_>], WireError>) {
    let found: Result<Vec<_>, _> = fields(message).collect();
    assert_eq!(found.as_deref().map_err(|error| *error), expected);
}

#[test]
fn fields_are_told_apart_and_what_is_no_field_is_refused() {
    let field = |number, value| Field { number, value };
    check(b"", Ok(&[]));
    // The examples of the documentation: a = 150, b = "testing".
    check(b"\x08\x96\x01", Ok(&[field(1, Value::Varint(150))]));
    check(b"\x12\x07testing", Ok(&[field(2, Value::Bytes(b"testing"))]));
    check(b"\x0d....\x11........", Ok(&[field(1, Value::Fixed), field(2, Value::Fixed)]));
    let largest = b"\x08\xff\xff\xff\xff\xff\xff\xff\xff\xff\x01";
    check(largest, Ok(&[field(1, Value::Varint(u64::MAX))]));
    check(b"\x08\xff\xff\xff\xff\xff\xff\xff\xff\xff\x02", Err("a number does not fit 64 bits"));
    check(
        b"\x08\x80\x80\x80\x80\x80\x80\x80\x80\x80\x80\x01",
        Err("a number does not fit 64 bits"),
    );
    check(b"\x08\x80", Err("a number has no end"));
    check(b"\x12\x08testing", Err("a field reaches beyond its message"));
    check(b"\x0d...", Err("a field reaches beyond its message"));
    check(
        b"\x12\xff\xff\xff\xff\xff\xff\xff\xff\xff\x01",
        Err("a field reaches beyond its message"),
    );
    check(b"\x0b", Err("a field is of a kind that is not in use"));
    check(b"\x00\x00", Err("a field has the number 0"));
}
