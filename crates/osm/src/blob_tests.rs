//! A blob unpacks to the promised size or is rejected.

use corniche_testing::pbf::{field, number, zlib};

use super::*;

/// Checks a blob; `expected` is the block, or words of the reason.
#[track_caller]
fn check(blob: &[Vec<u8>], expected: Result<&[u8], &str>) {
    match (unpack(&blob.concat(), 101), expected) {
        (Ok(block), Ok(expected)) => assert_eq!(block, expected),
        (Err(BlobRefusal::Damaged(reason)), Err(words)) => {
            assert!(reason.contains(words), "{reason}");
        }
        (Err(BlobRefusal::Compression(method)), Err(words)) => assert_eq!(method, words),
        (found, expected) => panic!("{found:?}, not {expected:?}"),
    }
}

#[test]
fn a_blob_unpacks_to_what_it_promises_or_is_refused() {
    let text = [b"corniche".as_slice(); 5].concat();
    let packed = zlib(&text);
    check(&[field(1, &text)], Ok(&text));
    check(&[field(1, b"")], Ok(b""));
    check(&[number(2, 40), field(3, &packed)], Ok(&text));
    check(&[field(3, &packed), number(2, 40)], Ok(&text));
    check(&[field(3, &packed)], Ok(&text));
    check(&[number(2, 40), field(3, &packed), field(15, b"later")], Ok(&text));

    check(&[number(2, 39), field(3, &packed)], Err("more than 39"));
    check(&[number(2, 41), field(3, &packed)], Err("promises 41 bytes but unpacks to 40"));
    check(&[number(2, 41), field(1, &text)], Err("promises 41 bytes but unpacks to 40"));
    check(&[number(2, 101), field(3, &packed)], Err("101 bytes long; the limit is 100"));
    check(&[number(2, -1), field(3, &packed)], Err("-1 bytes long"));
    check(&[number(2, i64::MAX), field(3, &packed)], Err("the limit is 100"));
    check(&[field(1, &[7; 100])], Ok(&[7; 100]));
    check(&[field(1, &[7; 101])], Err("101 bytes long"));
    check(&[field(3, &zlib(&[7; 100]))], Ok(&[7; 100]));
    check(&[field(3, &zlib(&[7; 101]))], Err("more than 100"));
    check(&[field(3, &zlib(&vec![7; 10 << 20]))], Err("more than 100"));

    check(&[], Err("no data"));
    check(&[number(2, 40)], Err("no data"));
    check(&[field(1, &text), field(3, &packed)], Err("data twice"));
    check(&[field(3, &[&packed[..], b"x"].concat())], Err("continues after its end"));
    check(&[field(3, b"")], Err("truncated"));
    check(&[field(3, b"not zlib")], Err("not a valid zlib stream"));
    for (number, method) in [(4, "LZMA"), (5, "bzip2"), (6, "LZ4"), (7, "zstd")] {
        check(&[field(number, &packed)], Err(method));
    }
}

#[test]
fn a_packed_stream_cut_anywhere_or_with_any_bit_flipped_never_passes_for_another() {
    let text: Vec<u8> = (0..90).map(|number: u8| number.wrapping_mul(number)).collect();
    let packed = zlib(&text);
    for len in 0..packed.len() {
        check(&[field(3, &packed[..len])], Err("truncated"));
    }
    for bit in 0..8 * packed.len() {
        let mut flipped = packed.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        // The first two bytes also contain the compression level, which does not affect the data.
        if let Ok(block) = unpack(&field(3, &flipped), 101) {
            assert_eq!(block, text, "bit {bit}");
        }
    }
}

#[test]
fn a_header_names_a_type_and_a_size_within_the_limit() {
    #[track_caller]
    fn check(header: &[Vec<u8>], expected: Result<u64, &str>) {
        match (BlobHeader::parse(&header.concat()), expected) {
            (Ok(header), Ok(size)) => assert_eq!(header.blob_bytes, size),
            (Err(BlobRefusal::Damaged(reason)), Err(words)) => {
                assert!(reason.contains(words), "{reason}");
            }
            (found, expected) => panic!("{found:?}, not {expected:?}"),
        }
    }
    let kind = field(1, b"OSMData");
    check(&[kind.clone(), number(3, 0)], Ok(0));
    check(&[number(3, 7), field(2, b"index"), kind.clone()], Ok(7));
    check(&[kind.clone(), number(3, 32 << 20)], Ok(32 << 20));
    check(&[kind.clone(), number(3, (32 << 20) + 1)], Err("claims to be 33554433 bytes long"));
    check(&[kind.clone(), number(3, -1)], Err("claims to be -1 bytes long"));
    check(&[kind.clone(), number(3, i64::MIN)], Err("claims to be -9223372036854775808"));
    check(&[kind], Err("has no size"));
    check(&[number(3, 7)], Err("has no type"));
    check(&[field(1, b"\xff"), number(3, 7)], Err("is not valid UTF-8"));
    check(&[number(1, 7), number(3, 7)], Err("has the wrong wire type"));
    check(&[], Err("has no type"));
}
