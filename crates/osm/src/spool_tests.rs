//! Records are read in their order with any memory limit.

use corniche_testing::MemoryScratch;
use proptest::prelude::*;

use super::*;

fn decode(bytes: &mut &[u8]) -> Option<Vec<u8>> {
    let (&length, rest) = bytes.split_first()?;
    let (record, rest) = rest.split_at_checked(length.into())?;
    *bytes = rest;
    Some(record.to_vec())
}

proptest! {
    #[test]
    fn records_come_back_in_their_order_with_any_memory(
        records in prop::collection::vec(prop::collection::vec(any::<u8>(), 0..40), 0..200),
        memory_bytes in prop_oneof![Just(0_u64), 1_u64..2000, Just(u64::MAX)],
    ) {
        let scratch = MemoryScratch::default();
        let mut spool = Spool::new(&scratch, memory_bytes);
        for record in &records {
            spool.push(|bytes| {
                bytes.push(record.len() as u8);
                bytes.extend(record);
            }).unwrap();
            prop_assert!(spool.held_bytes as u64 <= memory_bytes);
        }
        let is_spilled = spool.pages.iter().any(|page| matches!(page, Page::Kept(_)));
        prop_assert!(memory_bytes != u64::MAX || !is_spilled);
        let total_bytes: usize = records.iter().map(|record| record.len() + 1).sum();
        prop_assert!(is_spilled || total_bytes as u64 <= memory_bytes.saturating_add(41).saturating_mul(2));
        let mut reader = spool.read();
        for record in &records {
            let found = reader.next(decode).unwrap();
            prop_assert_eq!(found.as_ref(), Some(record));
        }
        for _ in 0..2 {
            prop_assert_eq!(reader.next(decode).unwrap(), None);
        }
    }
}

#[test]
fn bytes_that_are_no_record_are_an_error() {
    let scratch = MemoryScratch::default();
    let mut spool = Spool::new(&scratch, 1000);
    spool.push(|bytes| bytes.extend([7, 1])).unwrap();
    let error = spool.read().next(decode).unwrap_err();
    assert_eq!(error.kind(), io::ErrorKind::InvalidData);
}
