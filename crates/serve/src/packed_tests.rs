//! The right clients get compressed files, the right files are compressed, and nothing is lost.

use std::io::Read as _;

use super::*;

fn headers(all: &[(&'static str, &'static str)]) -> HeaderMap {
    all.iter().map(|&(name, value)| (name.parse().unwrap(), value.parse().unwrap())).collect()
}

#[test]
fn clients_say_what_they_unpack() {
    for wanted in ["br", "gzip, deflate, br, zstd", "gzip;q=0.5,BR;q=0.1"] {
        assert!(is_wanted(&headers(&[("accept-encoding", wanted)])), "{wanted}");
    }
    for other in ["gzip", "br;q=0", "br;Q=0", "br; q=0.0, gzip", "brotli", "*;q=1", ""] {
        assert!(!is_wanted(&headers(&[("accept-encoding", other)])), "{other}");
    }
    assert!(!is_wanted(&headers(&[])));
    assert!(!is_wanted(&headers(&[("accept-encoding", "br"), ("range", "bytes=0-9")])));
}

#[test]
fn packed_bytes_are_those_of_the_file() {
    let bytes: Bytes = "The road climbs the cliff, turn by turn. ".repeat(1000).into();
    let packed = CompressedFile::default();
    let found = packed.compressed(&bytes).unwrap();
    assert!(found.len() < bytes.len() / 10);
    assert_eq!(packed.compressed(&bytes), Some(found.clone()));
    let mut unpacked = Vec::new();
    brotli::Decompressor::new(&*found, 4096).read_to_end(&mut unpacked).unwrap();
    assert_eq!(unpacked, bytes);
}

#[test]
fn what_does_not_become_shorter_stays() {
    // A multiplicative generator, whose output brotli cannot compress.
    let mut state = 1_u32;
    let noise: Vec<u8> = (0..5000)
        .map(|_| {
            state = state.wrapping_mul(48_271) % 0x7fff_ffff;
            (state >> 16) as u8
        })
        .collect();
    assert_eq!(CompressedFile::default().compressed(&noise.into()), None);
}

#[test]
fn texts_and_programs_are_worth_it() {
    assert!(is_worth_it("application/wasm", 1 << 20));
    assert!(is_worth_it("text/javascript; charset=utf-8", 1 << 20));
    assert!(!is_worth_it("text/javascript; charset=utf-8", 100));
    assert!(!is_worth_it("image/png", 1 << 20));
    assert!(!is_worth_it("application/vnd.pmtiles", 1 << 20));
}

#[test]
fn tags_differ() {
    assert_eq!(tag_of("\"0123\""), "\"0123-br\"");
}
