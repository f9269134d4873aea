//! Records round-trip one after another, and truncated or damaged ones are rejected.

use super::{append_record, record_bytes, take_record};

type Record = (i64, String, Option<u8>);

#[test]
fn records_come_back_and_cut_ones_do_not() {
    let records: [Record; 2] =
        [(-7, "Großer Weg".to_owned(), None), (1 << 40, String::new(), Some(3))];
    let mut bytes = Vec::new();
    for record in &records {
        append_record(&mut bytes, record);
    }
    let mut rest = bytes.as_slice();
    assert_eq!(take_record::<Record>(&mut rest).as_ref(), Some(&records[0]));
    assert_eq!(rest, record_bytes(&records[1]));
    assert_eq!(take_record::<Record>(&mut rest).as_ref(), Some(&records[1]));
    assert!(rest.is_empty());
    let whole = record_bytes(&records[0]);
    for length in 0..whole.len() {
        assert_eq!(take_record::<Record>(&mut &whole[..length]), None, "{length}");
    }
}

/// A length of four thousand million is rejected.
#[test]
fn a_length_that_lies_is_refused() {
    let mut bytes = record_bytes(0_i64);
    bytes.extend([252, 0xff, 0xff, 0xff, 0xff]);
    assert_eq!(take_record::<Record>(&mut bytes.as_slice()), None);
}
